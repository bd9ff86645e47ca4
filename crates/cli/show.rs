//! Diagnostics and other problems: for people on standard error, for machines as JSON.

use crate::problem::{Diagnosed, Message, Problem};
use crate::write::printable;
use ariadne::{CharSet, Color, Config, IndexType, Label, Report, ReportKind, Source};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{self, Diagnostic, Severity};
use obverse_syntax::source::LineIndex;
use obverse_syntax::span::Span;
use serde_json::{Value, json};
use std::io::{IsTerminal, Write};

/// Lines longer than these, in bytes, are not drawn.
const DRAWN_MAX: usize = 400;

/// Show why a command was not carried out.
pub(crate) fn problem(problem: &Problem) {
    if let Some(diagnosed) = &problem.source {
        diagnostics(diagnosed);
    }
    let messages: Vec<String> =
        problem.messages.iter().map(|message| format!("error: {message}\n")).collect();
    to_stderr(printable(&messages.concat()).as_bytes());
}

/// Show the diagnostics of a source text, and how many there are.
pub(crate) fn diagnostics(diagnosed: &Diagnosed) {
    let mut shown = Vec::new();
    let is_coloured = is_coloured(&std::io::stderr());
    // These end a line for the drawing and for nothing else.
    let text = printable(&diagnosed.text).replace(['\u{2028}', '\u{2029}'], "???");
    let lines = LineIndex::new(&text);
    for diagnostic in &diagnosed.diagnostics {
        match is_drawn(&lines, diagnostic) {
            true => draw(&diagnosed.name, &text, diagnostic, is_coloured, &mut shown),
            false => write_out(&diagnosed.name, &lines, diagnostic, &mut shown),
        }
    }
    let total = counted(&diagnosed.diagnostics);
    if !total.is_empty() {
        shown.extend_from_slice(format!("{}: {total}\n", diagnosed.name).as_bytes());
    }
    to_stderr(&shown);
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

/// Whether a diagnostic can be drawn into its source: there is one, with lines that fit a screen.
fn is_drawn(lines: &LineIndex<'_>, diagnostic: &Diagnostic) -> bool {
    let is_short = |label: &diagnostic::Label| {
        let (start, end) = (lines.position(label.span.start), lines.position(label.span.end));
        let length = |line| lines.line_text(line).len();
        length(start.line) <= DRAWN_MAX && length(end.line) <= DRAWN_MAX
    };
    let mut labels = std::iter::once(&diagnostic.primary).chain(&diagnostic.labels);
    diagnostic.code != Code::NotText && labels.all(is_short)
}

/// A diagnostic without the source: message, places, notes and help, a line each.
fn write_out(name: &str, lines: &LineIndex<'_>, diagnostic: &Diagnostic, shown: &mut Vec<u8>) {
    let kind = match diagnostic.severity {
        Severity::Error => "Error",
        Severity::Warning => "Warning",
    };
    let mut told = format!("[{}] {kind}: {}\n", diagnostic.code, diagnostic.message);
    for label in std::iter::once(&diagnostic.primary).chain(&diagnostic.labels) {
        told += &format!("   {name}:{}: {}\n", lines.position(label.span.start), label.text);
    }
    diagnostic.notes.iter().for_each(|note| told += &format!("   Note: {note}\n"));
    diagnostic.help.iter().for_each(|help| told += &format!("   Help: {help}\n"));
    shown.extend_from_slice(told.as_bytes());
}

fn draw(name: &str, text: &str, diagnostic: &Diagnostic, color: bool, shown: &mut Vec<u8>) {
    let (kind, main_color) = match diagnostic.severity {
        Severity::Error => (ReportKind::Error, Color::Red),
        Severity::Warning => (ReportKind::Warning, Color::Yellow),
    };
    let config = Config::default()
        .with_color(color)
        .with_char_set(CharSet::Unicode)
        .with_index_type(IndexType::Byte)
        .with_compact(false);
    let at = |span: Span| (name, span.start as usize..span.end as usize);
    let mut report = Report::build(kind, at(diagnostic.primary.span))
        .with_config(config)
        .with_code(diagnostic.code.as_str())
        .with_message(&diagnostic.message);
    let primary = (&diagnostic.primary, main_color);
    let others = diagnostic.labels.iter().map(|label| (label, Color::Blue));
    let mut labels: Vec<_> = std::iter::once(primary).chain(others).collect();
    // In the order of the text, and what spans lines last: it is then drawn in one piece.
    let spans_lines = |span: Span| {
        text.get(span.start as usize..span.end as usize).is_some_and(|text| text.contains('\n'))
    };
    labels.sort_by_key(|(label, _)| (spans_lines(label.span), label.span.start));
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
    let _ = report.finish().write((name, Source::from(text)), &mut *shown);
}

/// The diagnostics of a source text for machines, one object each.
pub(crate) fn diagnostics_json(diagnosed: &Diagnosed) -> Vec<Value> {
    let lines = LineIndex::new(&diagnosed.text);
    let label = |span: Span, text: &str| {
        let (start, end) = (lines.position(span.start), lines.position(span.end));
        json!({
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
        object["file"] = json!(diagnosed.name);
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
                change["start_byte"] = json!(suggestion.span.start);
                change["end_byte"] = json!(suggestion.span.end);
                change
            }
            None => Value::Null,
        };
        object
    };
    diagnosed.diagnostics.iter().map(object).collect()
}

/// A message that is no diagnostic of a source text, for machines: without a code.
fn message_json(message: &Message) -> Value {
    json!({
        "type": "diagnostic",
        "file": message.file,
        "line": message.place.map(|(line, _)| line),
        "column": message.place.map(|(_, column)| column),
        "code": null,
        "severity": "error",
        "message": message.text,
        "labels": [],
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
