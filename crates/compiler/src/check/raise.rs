//! `throw`: whether what follows it is reached. What follows from an error is checked with its
//! declaration.

use super::Checker;
use super::names::Meaning;
use super::statement::Checked;
use crate::response::goes_on_after_throw;
use crate::tree::StatementKind;
use obverse_syntax::ast::Name;
use obverse_syntax::span::Span;

impl<'s> Checker<'s> {
    pub(super) fn throw(&mut self, name: Name<'s>, span: Span) -> Checked {
        if self.movers.may_move_after(name.value) {
            self.lose_position("recovering from this error may move the arm", span);
        }
        let is_error = |meaning| matches!(meaning, Meaning::Error(_));
        let Meaning::Error(id) = self.resolve(name, "an error", is_error)? else { return None };
        let goes_on = goes_on_after_throw(self.module.errors.get(id.index())?);
        Some((self.done(StatementKind::Throw(id), span), goes_on))
    }
}
