//! Diagnostics and other problems, shown to people on standard error.

use ariadne::{CharSet, Color, Config, IndexType, Label, Report, ReportKind, Source};
use obverse_syntax::diagnostic::{Diagnostic, Severity};
use std::io::{IsTerminal, Write};

/// Why a command was not carried out.
#[derive(Debug)]
pub(crate) struct Problem {
    /// What is wrong, one message a line; places first.
    messages: Vec<String>,
    /// Diagnostics of a source text.
    source: Option<(String, String, Vec<Diagnostic>)>,
}

impl Problem {
    /// One message.
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { messages: vec![message.into()], source: None }
    }

    /// Several messages.
    pub(crate) fn several(messages: Vec<String>) -> Self {
        Self { messages, source: None }
    }

    /// What is wrong with a source text.
    pub(crate) fn in_source(name: &str, text: &str, diagnostics: Vec<Diagnostic>) -> Self {
        let source = Some((name.to_owned(), text.to_owned(), diagnostics));
        Self { messages: Vec::new(), source }
    }
}

/// Show why a command was not carried out.
pub(crate) fn problem(problem: &Problem) {
    if let Some((name, text, all)) = &problem.source {
        diagnostics(name, text, all);
    }
    let mut text = String::new();
    for message in &problem.messages {
        text.push_str(&format!("error: {message}\n"));
    }
    to_stderr(text.as_bytes());
}

/// Show the diagnostics of a source text, and how many there are.
pub(crate) fn diagnostics(name: &str, text: &str, diagnostics: &[Diagnostic]) {
    let mut shown = Vec::new();
    let is_terminal = std::io::stderr().is_terminal();
    for diagnostic in diagnostics {
        render(name, text, diagnostic, is_terminal, &mut shown);
    }
    let count = |severity| diagnostics.iter().filter(|one| one.severity == severity).count();
    let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
    let words = [(errors, "error"), (warnings, "warning")];
    let total: Vec<String> = words
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, word)| format!("{count} {word}{}", if *count == 1 { "" } else { "s" }))
        .collect();
    if !total.is_empty() {
        shown.extend_from_slice(format!("{name}: {}\n", total.join(", ")).as_bytes());
    }
    to_stderr(&shown);
}

fn to_stderr(bytes: &[u8]) {
    // There is nowhere left to say that standard error is closed.
    let _ = std::io::stderr().lock().write_all(bytes);
}

fn render(name: &str, text: &str, diagnostic: &Diagnostic, color: bool, shown: &mut Vec<u8>) {
    let (kind, main_color) = match diagnostic.severity {
        Severity::Error => (ReportKind::Error, Color::Red),
        Severity::Warning => (ReportKind::Warning, Color::Yellow),
    };
    let config = Config::default()
        .with_color(color)
        .with_char_set(CharSet::Unicode)
        .with_index_type(IndexType::Byte)
        .with_compact(false);
    let at = |span: obverse_syntax::span::Span| (name, span.start as usize..span.end as usize);
    let mut report = Report::build(kind, at(diagnostic.primary.span))
        .with_config(config)
        .with_code(diagnostic.code.as_str())
        .with_message(&diagnostic.message)
        .with_label(
            Label::new(at(diagnostic.primary.span))
                .with_message(&diagnostic.primary.text)
                .with_color(main_color)
                .with_order(-1),
        );
    for label in &diagnostic.labels {
        report = report.with_label(
            Label::new(at(label.span)).with_message(&label.text).with_color(Color::Blue),
        );
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
