//! What is said of what has no inverse.

use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::Span;

/// How many refusals are reported of a program.
const MAX_REFUSALS: usize = 20;

/// A diagnostic of something that has no inverse: `why` is what is to be seen at the place.
pub(super) fn refusal(span: Span, message: &str, why: &str) -> Diagnostic {
    Diagnostic::error(Code::NotInvertible, span, message, why)
}

/// How many calls that lead to a refusal are shown.
const MAX_CALLS: usize = 4;

/// All refusals, each place once.
#[derive(Debug, Default)]
pub(super) struct Refusals(Vec<Diagnostic>);

impl Refusals {
    /// Adds one that these calls lead to, the innermost first.
    pub(super) fn add(&mut self, diagnostic: Diagnostic, calls: impl Iterator<Item = Span>) {
        let is_known = self.0.iter().any(|known| known.primary.span == diagnostic.primary.span);
        if !is_known && self.0.len() < MAX_REFUSALS {
            let labelled =
                |diagnostic: Diagnostic, call| diagnostic.with_label(call, "called here");
            self.0.push(calls.take(MAX_CALLS).fold(diagnostic, labelled));
        }
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// All of them by place, or nothing if there are none.
    pub(super) fn into_result(mut self) -> Result<(), Vec<Diagnostic>> {
        self.0.sort_by_key(|diagnostic| diagnostic.primary.span);
        if self.0.is_empty() { Ok(()) } else { Err(self.0) }
    }
}
