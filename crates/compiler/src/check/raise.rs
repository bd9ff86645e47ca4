//! Statements that raise errors of the program. What follows from an error is checked with its
//! declaration.

use super::Checker;
use super::expression::Need;
use super::names::Meaning;
use super::statement::Checked;
use crate::response::goes_on_after_throw;
use crate::tree::StatementKind;
use crate::types::ValueType;
use obverse_syntax::ast::{self, Name};
use obverse_syntax::span::Span;

impl<'s> Checker<'s> {
    /// `requires CONDITION else throw NAME`
    pub(super) fn requires(
        &mut self,
        condition: &ast::Expression<'s>,
        error: Name<'s>,
        span: Span,
    ) -> Option<StatementKind> {
        let condition = self.value(condition, &Need::new(ValueType::Bool, "`requires`"));
        self.warn_of_constant(&condition, "leave the statement out, or ask for a reading");
        if self.movers.may_move_after(error.value) {
            self.lose_position("recovering from this error may move the arm", span);
        }
        let is_error = |meaning| matches!(meaning, Meaning::Error(_));
        match self.resolve(error, "an error", is_error)? {
            Meaning::Error(id) => Some(StatementKind::Requires(condition, id)),
            _ => None,
        }
    }

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
