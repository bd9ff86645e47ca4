//! Diagnostics and other problems: for people on standard error, for machines as JSON.

use crate::problem::{Diagnosed, Message, Problem};
use crate::write::printable;
use ariadne::{CharSet, Color, Config, IndexType, Label, Report, ReportKind};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{self, Diagnostic, Severity};
use obverse_syntax::source::LineIndex;
use obverse_syntax::sources::{Place, Sources};
use obverse_syntax::span::Span;
use serde_json::{Value, json};
use std::borrow::Cow;
use std::io::{IsTerminal, Write};

/// Lines longer than these, in bytes, are not drawn.
const DRAWN_MAX: usize = 400;

/// What ends a line for the drawing and for nothing else.
const LINE_ENDS: [char; 2] = ['\u{2028}', '\u{2029}'];

/// Show why a command was not carried out.
pub(crate) fn problem(problem: &Problem) {
    if let Some(diagnosed) = &problem.source {
        diagnostics(diagnosed);
    }
    let messages: Vec<String> =
        problem.messages.iter().map(|message| format!("{}: {message}\n", error(message))).collect();
    to_stderr(printable(&messages.concat()).as_bytes());
}

/// `error`, with the code if the message has one.
fn error(message: &Message) -> String {
    message.code.map_or_else(|| "error".to_owned(), |code| format!("error[{code}]"))
}

/// Show the diagnostics of a program, and how many there are.
pub(crate) fn diagnostics(diagnosed: &Diagnosed) {
    let total = counted(&diagnosed.diagnostics);
    if total.is_empty() {
        return;
    }
    let mut shown = Vec::new();
    let is_coloured = is_coloured(&std::io::stderr());
    let texts = texts(diagnosed);
    let files = Files::of(diagnosed, &texts);
    let mut cache = ariadne::sources(
        texts.iter().map(|(name, text)| (name.clone(), text.clone().into_owned())),
    );
    for diagnostic in &diagnosed.diagnostics {
        match files.is_drawn(diagnostic) {
            true => draw(&files, &mut cache, diagnostic, is_coloured, &mut shown),
            false => write_out(&files, diagnostic, &mut shown),
        }
    }
    shown.extend_from_slice(format!("{}: {total}\n", diagnosed.name(0)).as_bytes());
    to_stderr(&shown);
}

/// The files of a program by the name that people know, printable.
fn texts(diagnosed: &Diagnosed) -> Vec<(String, Cow<'_, str>)> {
    let sources = &diagnosed.sources;
    let text = |file| match printable(sources.text(file)) {
        text if text.contains(LINE_ENDS) => Cow::Owned(text.replace(LINE_ENDS, "???")),
        text => text,
    };
    let file = |file| (diagnosed.name(file), text(file));
    (0..sources.len()).map(file).collect()
}

/// Where things are in the files of a program.
struct Files<'d> {
    sources: &'d Sources,
    /// By file, its name and its lines.
    files: Vec<(&'d str, LineIndex<'d>)>,
}

impl<'d> Files<'d> {
    fn of(diagnosed: &'d Diagnosed, texts: &'d [(String, Cow<'d, str>)]) -> Self {
        let file = |(name, text): &'d (String, Cow<'d, str>)| (name.as_str(), LineIndex::new(text));
        Self { sources: &diagnosed.sources, files: texts.iter().map(file).collect() }
    }

    /// The name of the file that a span is in, its lines, and where in it.
    fn at(&self, span: Span) -> (&str, &LineIndex<'d>, Span) {
        let Place { file, span } = self.sources.locate(span);
        let (name, lines) = &self.files[file];
        (name, lines, span)
    }

    /// Whether a diagnostic can be drawn into its source: there is one, with lines that fit a
    /// screen.
    fn is_drawn(&self, diagnostic: &Diagnostic) -> bool {
        let is_short = |label: &diagnostic::Label| {
            let (_, lines, span) = self.at(label.span);
            let (start, end) = (lines.position(span.start), lines.position(span.end));
            let length = |line| lines.line_text(line).len();
            length(start.line) <= DRAWN_MAX && length(end.line) <= DRAWN_MAX
        };
        let mut labels = std::iter::once(&diagnostic.primary).chain(&diagnostic.labels);
        diagnostic.code != Code::NotText && labels.all(is_short)
    }
}

/// How many diagnostics there are of a severity.
pub(crate) fn count(diagnostics: &[Diagnostic], severity: Severity) -> usize {
    diagnostics.iter().filter(|one| one.severity == severity).count()
}

/// `2 errors, 1 warning`; empty where there are none.
pub(crate) fn counted(diagnostics: &[Diagnostic]) -> String {
    let words = [(Severity::Error, "error"), (Severity::Warning, "warning")];
    let counts = words.map(|(severity, word)| (count(diagnostics, severity), word));
    let total: Vec<String> = counts
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, word)| format!("{count} {word}{}", if *count == 1 { "" } else { "s" }))
        .collect();
    total.join(", ")
}

/// Whether what is written there is coloured: on a terminal that can show it, unless `NO_COLOR` is
/// set (<https://no-color.org>).
pub(crate) fn is_coloured(stream: &impl IsTerminal) -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let is_dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    stream.is_terminal() && !is_set("NO_COLOR") && !is_dumb
}

fn to_stderr(bytes: &[u8]) {
    // There is nowhere left to say that standard error is closed.
    let _ = std::io::stderr().lock().write_all(bytes);
}

/// A line on standard error.
pub(crate) fn note(text: &str) {
    to_stderr(printable(&format!("{text}\n")).as_bytes());
}

/// The diagnostics of a program as text without the source, one each.
pub(crate) fn diagnostic_lines(diagnosed: &Diagnosed) -> Vec<String> {
    let texts = texts(diagnosed);
    let files = Files::of(diagnosed, &texts);
    let told = |diagnostic: &Diagnostic| {
        let mut shown = Vec::new();
        write_out(&files, diagnostic, &mut shown);
        String::from_utf8_lossy(&shown).trim_end().to_owned()
    };
    diagnosed.diagnostics.iter().map(told).collect()
}

/// A diagnostic without the source: message, places, notes and help, a line each.
fn write_out(files: &Files<'_>, diagnostic: &Diagnostic, shown: &mut Vec<u8>) {
    let kind = match diagnostic.severity {
        Severity::Error => "Error",
        Severity::Warning => "Warning",
    };
    let mut told = format!("[{}] {kind}: {}\n", diagnostic.code, diagnostic.message);
    for label in std::iter::once(&diagnostic.primary).chain(&diagnostic.labels) {
        let (name, lines, span) = files.at(label.span);
        told += &format!("   {name}:{}: {}\n", lines.position(span.start), label.text);
    }
    diagnostic.notes.iter().for_each(|note| told += &format!("   Note: {note}\n"));
    diagnostic.help.iter().for_each(|help| told += &format!("   Help: {help}\n"));
    shown.extend_from_slice(told.as_bytes());
}

fn draw(
    files: &Files<'_>,
    cache: &mut impl ariadne::Cache<String>,
    diagnostic: &Diagnostic,
    color: bool,
    shown: &mut Vec<u8>,
) {
    let (kind, main_color) = match diagnostic.severity {
        Severity::Error => (ReportKind::Error, Color::Red),
        Severity::Warning => (ReportKind::Warning, Color::Yellow),
    };
    let config = Config::default()
        .with_color(color)
        .with_char_set(CharSet::Unicode)
        .with_index_type(IndexType::Byte)
        .with_compact(false);
    let at = |span: Span| {
        let (name, _, span) = files.at(span);
        (name.to_owned(), span.start as usize..span.end as usize)
    };
    let mut report = Report::build(kind, at(diagnostic.primary.span))
        .with_config(config)
        .with_code(diagnostic.code.as_str())
        .with_message(&diagnostic.message);
    let primary = (&diagnostic.primary, main_color);
    let others = diagnostic.labels.iter().map(|label| (label, Color::Blue));
    let mut labels: Vec<_> = std::iter::once(primary).chain(others).collect();
    // The file of the mistake first, and in a file in the order of the text, but what spans lines
    // last: it is then drawn in one piece.
    let file = |span: Span| files.sources.locate(span).file;
    let its_file = file(diagnostic.primary.span);
    let spans_lines = |span: Span| {
        let text = files.sources.whole().get(span.start as usize..span.end as usize);
        text.is_some_and(|text| text.contains('\n'))
    };
    labels.sort_by_key(|(label, _)| {
        (file(label.span) != its_file, spans_lines(label.span), label.span.start)
    });
    for (label, color) in labels {
        let drawn = Label::new(at(label.span)).with_message(&label.text);
        report = report.with_label(drawn.with_color(color));
    }
    for note in &diagnostic.notes {
        report = report.with_note(note);
    }
    if let Some(help) = &diagnostic.help {
        report = report.with_help(help);
    }
    // Writing to memory does not fail.
    let _ = report.finish().write(cache, &mut *shown);
}

/// The diagnostics of a source text for machines, one object each.
pub(crate) fn diagnostics_json(diagnosed: &Diagnosed) -> Vec<Value> {
    let sources = &diagnosed.sources;
    let lines: Vec<LineIndex<'_>> =
        (0..sources.len()).map(|file| LineIndex::new(sources.text(file))).collect();
    let label = |span: Span, text: &str| {
        let Place { file, span } = sources.locate(span);
        let lines = &lines[file];
        let (start, end) = (lines.position(span.start), lines.position(span.end));
        json!({
            "file": diagnosed.name(file),
            "line": start.line,
            "column": start.column,
            "end_line": end.line,
            "end_column": end.column,
            "text": text,
        })
    };
    let object = |diagnostic: &Diagnostic| {
        let primary = &diagnostic.primary;
        let mut object = label(primary.span, &primary.text);
        object["type"] = json!("diagnostic");
        object["code"] = json!(diagnostic.code.as_str());
        object["severity"] = json!(match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        });
        object["message"] = json!(diagnostic.message);
        let labels = diagnostic.labels.iter().map(|one| label(one.span, &one.text));
        object["labels"] = labels.collect();
        object["notes"] = json!(diagnostic.notes);
        object["help"] = json!(diagnostic.help);
        object["suggestion"] = match &diagnostic.suggestion {
            Some(suggestion) => {
                let mut change = label(suggestion.span, &suggestion.text);
                let Place { span, .. } = sources.locate(suggestion.span);
                change["start_byte"] = json!(span.start);
                change["end_byte"] = json!(span.end);
                change
            }
            None => Value::Null,
        };
        object
    };
    diagnosed.diagnostics.iter().map(object).collect()
}

/// A message that is no diagnostic of a source text, for machines.
fn message_json(message: &Message) -> Value {
    let label = |also: &Message| {
        let (line, column) = also.place.unzip();
        json!({ "file": also.file, "line": line, "column": column, "text": also.text })
    };
    let labels: Vec<Value> = message.also.iter().map(label).collect();
    json!({
        "type": "diagnostic",
        "file": message.file,
        "line": message.place.map(|(line, _)| line),
        "column": message.place.map(|(_, column)| column),
        "code": message.code,
        "severity": "error",
        "message": message.text,
        "labels": labels,
        "notes": [],
        "help": null,
        "suggestion": null,
    })
}

/// What is wrong, for machines: an object a diagnostic of a source text, and one a message.
pub(crate) fn problem_json(problem: &Problem) -> Vec<Value> {
    let diagnostics = problem.source.iter().flat_map(diagnostics_json);
    diagnostics.chain(problem.messages.iter().map(message_json)).collect()
}
