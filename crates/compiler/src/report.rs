//! Where what is wrong with a program is gathered. Knows nothing of what can be wrong.

use crate::allow::Allows;
use obverse_syntax::LeftOut;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{Diagnostic, Severity};
use obverse_syntax::span::Span;

/// More errors than these are not kept, nor more warnings: a text with so many is not meant as a
/// program.
const MAX_KEPT: usize = 200;

/// How many words are compared in search of the one that was meant, in all of a program.
const MAX_COMPARED: usize = 100_000;

/// What has been found so far.
#[derive(Debug)]
pub(crate) struct Reports {
    errors: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
    /// What the tree lacks; none of a whole one.
    left_out: Option<LeftOut>,
    allows: Allows,
    compared: usize,
}

/// What may be a consequence of a part that the parser has left out.
const OF_ABSENCE: [Code; 7] = [
    Code::UnknownCheckpoint,
    Code::NoMain,
    Code::MissingClause,
    Code::BreakOutsideLoop,
    Code::NoNamedPosition,
    Code::ArgumentCount,
    Code::ForkBranches,
];

impl Reports {
    /// Nothing yet. What may follow from what the tree lacks is not kept.
    pub(crate) fn new(left_out: Option<LeftOut>, mut allows: Allows) -> Self {
        let errors = allows.take_mistakes();
        Self { errors, warnings: Vec::new(), left_out, allows, compared: 0 }
    }

    /// Keep that there is nothing of this name, unless it may have been left out.
    pub(crate) fn add_unknown(&mut self, name: &str, diagnostic: Diagnostic) {
        let may_be_there = |left_out: &LeftOut| left_out.may_declare(name);
        if !self.left_out.as_ref().is_some_and(may_be_there) {
            self.add(diagnostic);
        }
    }

    /// Keep a diagnostic.
    pub(crate) fn add(&mut self, diagnostic: Diagnostic) {
        let is_warning = diagnostic.severity == Severity::Warning;
        if !self.is_whole() && (is_warning || OF_ABSENCE.contains(&diagnostic.code)) {
            return;
        }
        let is_meant =
            is_warning && self.allows.permits(diagnostic.code, diagnostic.primary.span.start);
        if is_meant {
            return;
        }
        let kept = if is_warning { &mut self.warnings } else { &mut self.errors };
        if kept.len() < MAX_KEPT {
            kept.push(diagnostic);
        }
    }

    /// Whether no further error is kept.
    pub(crate) fn is_full(&self) -> bool {
        self.errors.len() >= MAX_KEPT
    }

    /// Keep an error that needs no more than one place and a sentence.
    pub(crate) fn error(&mut self, code: Code, span: Span, message: String, at: &str) {
        self.add(Diagnostic::error(code, span, message, at));
    }

    /// Whether the program cannot be compiled.
    pub(crate) fn has_errors(&self) -> bool {
        !self.errors.is_empty()
    }

    /// The one of `words` that was probably meant by `word`.
    pub(crate) fn meant<'w>(
        &mut self,
        word: &str,
        words: impl Iterator<Item = &'w str>,
    ) -> Option<&'w str> {
        if self.is_full() {
            return None;
        }
        let budget = MAX_COMPARED.saturating_sub(self.compared);
        let compared = &mut self.compared;
        obverse_syntax::nearest(word, words.take(budget).inspect(|_| *compared += 1))
    }

    /// Whether a warning of this code at this place is meant.
    pub(crate) fn permits(&mut self, code: Code, at: u32) -> bool {
        self.allows.permits(code, at)
    }

    /// Whether the tree is whole.
    pub(crate) fn is_whole(&self) -> bool {
        self.left_out.is_none()
    }

    /// Whether there may have been warnings that were not kept.
    pub(crate) fn drops_warnings(&self) -> bool {
        self.warnings.len() >= MAX_KEPT
    }

    /// Warn of each `allow` that allows nothing, now that all warnings have come. With a mistake
    /// in the program not all of them have.
    pub(crate) fn warn_of_useless(&mut self) {
        if self.is_whole() && !self.has_errors() {
            let useless = self.allows.useless();
            useless.into_iter().for_each(|diagnostic| self.add(diagnostic));
        }
    }

    /// All of them.
    pub(crate) fn into_diagnostics(self) -> Vec<Diagnostic> {
        let mut all = self.errors;
        all.extend(self.warnings);
        all
    }
}

/// A warning of this kind at a place.
pub(crate) fn warning(
    code: Code,
    span: Span,
    message: impl Into<String>,
    at: impl Into<String>,
) -> Diagnostic {
    Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, span, message, at) }
}
