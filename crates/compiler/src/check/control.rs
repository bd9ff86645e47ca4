//! Branches and loops: their blocks, their assertions, and which ways come together.

use super::Checker;
use super::expression::{MAX_COMPUTED, Need};
use super::frame::Around;
use super::names::Meaning;
use super::operators::binary;
use super::statement::Checked;
use crate::tree::{Block, Expression, ExpressionKind, Prepared, Statement, StatementKind};
use crate::types::ValueType;
use obverse_isa::{CounterId, Instr};
use obverse_syntax::ast::{self, Name, StatementKind as Written};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::Span;

/// The name of a loop's counter, if it has one, and what it means.
type Counted<'s> = Option<(Name<'s>, fn(CounterId) -> Meaning)>;

impl<'s> Checker<'s> {
    /// A branch or a loop.
    pub(super) fn control(&mut self, written: &ast::Statement<'s>) -> Checked {
        let start = written.span.start;
        match &written.kind {
            Written::If { condition, then, otherwise, ending_when } => {
                let header = Span::new(start, condition.span.end);
                let branches = (then, otherwise.as_ref());
                Some(self.branch(condition, branches, ending_when.as_ref(), header))
            }
            Written::While { condition, entered_when, body } => {
                Some(self.while_loop(condition, entered_when.as_ref(), body, start))
            }
            Written::Repeat { times, body } => {
                let first = Expression::int(1, times.span);
                let last = self.value(times, &Need::new(ValueType::Int, "`repeat`"));
                let header = Span::new(start, times.span.end);
                self.warn_of_empty_count(&first, false, &last);
                Some(self.counted(None, (first, last), body, header))
            }
            Written::For { name, first, down, last, body } => {
                let need = Need::new(ValueType::Int, "`for`");
                let header = Span::new(start, last.span.end);
                let first = self.value(first, &need);
                let last = self.value(last, &need);
                self.warn_of_empty_count(&first, *down, &last);
                let (ends, meaning): (_, fn(CounterId) -> Meaning) = match *down {
                    false => ((first, last), Meaning::Counter),
                    true => ((complement(first), complement(last)), Meaning::CountDown),
                };
                Some(self.counted(Some((*name, meaning)), ends, body, header))
            }
            Written::Loop(body) => {
                let header = self.header(start, body.span);
                let (block, breaks) = self.body(body, header);
                Some((self.done(StatementKind::Loop(block), header), breaks))
            }
            _ => None,
        }
    }

    fn branch(
        &mut self,
        condition: &ast::Expression<'s>,
        (then, otherwise): (&ast::Block<'s>, Option<&ast::Block<'s>>),
        ending_when: Option<&ast::Expression<'s>>,
        header: Span,
    ) -> (Statement, bool) {
        let condition = self.condition(condition, "`if`");
        self.warn_of_constant(&condition, "leave it out, with the block that is never run");
        let hoists = self.frame.take_hoists();
        let named = self.frame.named;
        let then = self.block(then);
        let after_then = std::mem::replace(&mut self.frame.named, named);
        let otherwise = otherwise.map(|block| self.block(block));
        let else_falls = otherwise.as_ref().is_none_or(|block| block.falls_through);
        match (then.falls_through, else_falls) {
            (true, true) => self.join_position(after_then, header),
            (true, false) => self.frame.named = after_then,
            (false, _) => {}
        }
        let ending_when = ending_when.map(|written| {
            let assertion = self.assertion(written, "`ending when`");
            if !then.falls_through || !else_falls {
                self.report_useless(written.span, header);
            }
            assertion
        });
        let falls_through = then.falls_through || else_falls;
        let kind = StatementKind::If { condition, then, otherwise, ending_when };
        (Statement { hoists, kind, span: header }, falls_through)
    }

    fn while_loop(
        &mut self,
        condition: &ast::Expression<'s>,
        entered_when: Option<&ast::Expression<'s>>,
        body: &ast::Block<'s>,
        start: u32,
    ) -> (Statement, bool) {
        let header = Span::new(start, condition.span.end);
        let condition = self.prepared_condition(condition);
        let help = match condition.value.kind {
            ExpressionKind::Bool(false) => "leave it out, with the block that is never run",
            _ => "a loop for ever is written `loop { .. }`",
        };
        self.warn_of_constant(&condition.value, help);
        let entered = entered_when.map(|written| self.assertion(written, "`entered when`"));
        let (body, _) = self.body(body, header);
        if let (Some(written), false) = (entered_when, body.falls_through) {
            self.report_useless(written.span, header);
        }
        let kind = StatementKind::While { condition, entered_when: entered, body };
        (self.done(kind, header), true)
    }

    fn prepared_condition(&mut self, condition: &ast::Expression<'s>) -> Prepared {
        self.prepared(condition, &Need::new(ValueType::Bool, "`while`"))
    }

    fn counted(
        &mut self,
        counted: Counted<'s>,
        (first, last): (Expression, Expression),
        body: &ast::Block<'s>,
        header: Span,
    ) -> (Statement, bool) {
        let hoists = self.frame.take_hoists();
        let (computed, held) = (first.size().0 + last.size().0, first.size().1 + last.size().1);
        if computed > MAX_COMPUTED {
            self.report_too_large(header, computed, held);
        }
        let counter = CounterId(self.frame.counters);
        // More than there is room for are reported at the end of the function.
        self.frame.counters = self.frame.counters.saturating_add(1);
        self.frame.counter_peak = self.frame.counter_peak.max(self.frame.counters);
        self.frame.layout.counters = self.frame.layout.counters.max(self.frame.counters);
        let scope = self.names.open();
        let name = counted.map(|(name, meaning)| {
            let meaning = meaning(counter);
            let is_down = matches!(meaning, Meaning::CountDown(_));
            self.declare(name, meaning);
            self.names.mark_used(name.value);
            (name.value.to_owned(), is_down)
        });
        let (body, _) = self.body(body, header);
        self.names.close(&scope);
        self.frame.counters -= 1;
        let kind = StatementKind::For { counter, name, first, last, body };
        (Statement { hoists, kind, span: header }, true)
    }

    /// The body of a loop, and whether a `break` leaves it.
    fn body(&mut self, body: &ast::Block<'s>, header: Span) -> (Block, bool) {
        let moves = self.movers.may_move(body);
        if moves {
            self.lose_position("a loop comes round to here", header);
        }
        self.frame.around.push(Around::Loop { breaks: false });
        let block = self.block(body);
        let around = self.frame.around.pop();
        if moves {
            self.lose_position("a loop ends here", header);
        }
        (block, matches!(around, Some(Around::Loop { breaks: true })))
    }

    fn report_useless(&mut self, assertion: Span, header: Span) {
        let message = "there is nothing to assert: only one way comes here".to_owned();
        let diagnostic =
            Diagnostic::error(Code::UselessAssertion, assertion, message, "tells nothing apart")
                .with_label(header, "a block of this leaves for good")
                .with_help("leave the assertion out");
        self.reports.add(diagnostic);
    }
}

/// The number as far below -1 as this one is above, or the other way round. It turns the order of
/// all integers round, so that a loop that counts the complements up counts the numbers down.
pub(super) fn complement(number: Expression) -> Expression {
    let span = number.span;
    binary(Instr::IntSub {}, Expression::int(-1, span), number, ValueType::Int, span)
}
