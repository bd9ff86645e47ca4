//! Diagnostics as data: a code, places, a reason, help. Shown to people elsewhere.

use crate::span::Span;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The program compiles.
    Warning,
    /// It does not.
    Error,
}

/// A further place that belongs to a diagnostic, and what is to be seen there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is to be seen there.
    pub text: String,
}

/// A change of the text that mends what is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suggestion {
    /// What is replaced; where it is empty, the text is put in there.
    pub span: Span,
    /// What takes its place; where it is empty, the span is taken out.
    pub text: String,
}

/// Something wrong with a source text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Its kind, with the stable code and the page that explains it.
    pub code: crate::codes::Code,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, in a sentence without a full stop.
    pub message: String,
    /// The place that is wrong, and what is wrong there.
    pub primary: Label,
    /// Further places: where it was declared, where it was asked for.
    pub labels: Vec<Label>,
    /// Why it is wrong, and facts.
    pub notes: Vec<String>,
    /// What to do.
    pub help: Option<String>,
    /// The change of the text that does it, where there is one plain one.
    pub suggestion: Option<Suggestion>,
    /// The changes of which each does it, where a person must choose between several.
    pub choices: Vec<Suggestion>,
}

impl Diagnostic {
    /// An error of this kind at a place.
    pub fn error(
        code: crate::codes::Code,
        span: Span,
        message: impl Into<String>,
        at: impl Into<String>,
    ) -> Self {
        Self {
            code,
            severity: Severity::Error,
            message: message.into(),
            primary: Label { span, text: at.into() },
            labels: Vec::new(),
            notes: Vec::new(),
            help: None,
            suggestion: None,
            choices: Vec::new(),
        }
    }

    /// With a further place.
    #[must_use]
    pub fn with_label(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    /// With a fact or a reason.
    #[must_use]
    pub fn with_note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// With what to do.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// With the word that was probably meant in place of another.
    #[must_use]
    pub fn did_you_mean(self, span: Span, meant: &str) -> Self {
        self.with_help(format!("did you mean `{meant}`?")).replacing(span, meant)
    }

    /// With what is to be written in place of a span.
    #[must_use]
    pub fn write_instead(self, span: Span, text: &str) -> Self {
        self.with_help(format!("write `{text}`")).replacing(span, text)
    }

    /// With the change of the text that does what the help says.
    #[must_use]
    pub fn replacing(mut self, span: Span, text: impl Into<String>) -> Self {
        self.suggestion = Some(Suggestion { span, text: text.into() });
        self
    }

    /// With the texts of which one is to be written in place of a span.
    #[must_use]
    pub fn with_choices(
        mut self,
        span: Span,
        texts: impl IntoIterator<Item = impl Into<String>>,
    ) -> Self {
        self.choices =
            texts.into_iter().map(|text| Suggestion { span, text: text.into() }).collect();
        self
    }
}
