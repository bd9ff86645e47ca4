//! Branches and loops as jumps and joins.

use super::Lower;
use super::frame::Loop;
use super::statement::PREFIX;
use super::test::is_alone;
use crate::tree::{Block, Expression, ExpressionKind, Prepared, Statement, StatementKind};
use obverse_bytecode::{LoopName, Mark};
use obverse_isa::{CounterId, Instr};

impl Lower<'_> {
    /// A branch or a loop.
    pub(super) fn control(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::If { condition, then, otherwise, ending_when } => {
                self.branch(condition, then, otherwise.as_ref(), ending_when.as_ref());
            }
            StatementKind::While { condition, entered_when, body } => {
                self.open_loop();
                let skip = self.while_loop(condition, entered_when.as_ref(), body);
                self.at(body.end, None);
                self.join_one(skip);
                self.close_loop();
            }
            StatementKind::For { counter, name, first, last, body } => {
                self.open_loop();
                self.counted((*counter, name.as_ref()), (first, last), body);
                self.close_loop();
            }
            StatementKind::Loop(body) => {
                self.open_loop();
                self.endless(body);
                self.at(body.end, None);
                self.close_loop();
            }
            _ => {}
        }
    }

    fn branch(
        &mut self,
        condition: &Expression,
        then: &Block,
        otherwise: Option<&Block>,
        ending_when: Option<&Expression>,
    ) {
        if otherwise.is_none() && self.is_plain_break(then) {
            let test = self.test(condition, true);
            let mark = self.code.jump(|target| test.to(target));
            return self.add_break(mark);
        }
        let test = self.test(condition, false);
        if otherwise.is_none() {
            self.at_asserted(ending_when);
        }
        let skip = self.code.jump(|target| test.to(target));
        self.block(then);
        let Some(otherwise) = otherwise else {
            self.at(then.end, None);
            return match ending_when {
                // Reached by the jump where the condition does not hold.
                Some(predicate) => self.join_asserted(skip, predicate, false),
                None => self.join_one(skip),
            };
        };
        self.at(then.end, None);
        self.at_asserted(ending_when);
        let over = self.frame.is_reached.then(|| self.jump());
        self.join_one(skip);
        self.block(otherwise);
        self.at(otherwise.end, None);
        match (over, ending_when) {
            (Some(over), Some(predicate)) => self.join_asserted(over, predicate, true),
            (Some(over), None) => self.join_one(over),
            (None, _) => {}
        }
    }

    /// Whether a block only leaves the innermost loop, with nothing to put right on the way: its
    /// jump is then that of the condition.
    fn is_plain_break(&self, block: &Block) -> bool {
        let is_break =
            matches!(block.statements.as_slice(), [Statement { kind: StatementKind::Break, .. }]);
        let depth = self.frame.loops.last().map(|around| around.depth);
        is_break && depth == Some(self.frame.scopes.len())
    }

    /// A join that a predicate tells apart: it is `when` if the jump has come.
    fn join_asserted(&mut self, mark: Mark, predicate: &Expression, when: bool) {
        self.assertion(predicate, when);
        self.code.join(mark, |from| Instr::JoinAssert { prefix: PREFIX, from });
    }

    /// A jump to an asserted join comes next: where the assertion fails, it is here that the
    /// machine stops, and it is the predicate that is to be shown.
    fn at_asserted(&mut self, predicate: Option<&Expression>) {
        if let Some(predicate) = predicate {
            self.at(predicate.span, None);
        }
    }

    /// Push whether a predicate is `when`.
    fn assertion(&mut self, predicate: &Expression, when: bool) {
        self.at(predicate.span, None);
        match (&predicate.kind, when) {
            (ExpressionKind::Unary(Instr::BoolNot {}, operand), false) => self.expression(operand),
            (_, true) => self.expression(predicate),
            (_, false) => {
                self.expression(predicate);
                self.push(Instr::BoolNot {});
            }
        }
    }

    /// A loop with a condition; the jump that leaves it where it does not hold.
    fn while_loop(
        &mut self,
        condition: &Prepared,
        entered_when: Option<&Expression>,
        body: &Block,
    ) -> Mark {
        let top = match entered_when {
            Some(predicate) => {
                self.assertion(predicate, false);
                let top = self.code.join_ahead(|from| Instr::JoinAssert { prefix: PREFIX, from });
                self.at(condition.value.span, None);
                Some(top)
            }
            None if !body.falls_through => None,
            None if is_alone(&condition.value, false) => Some(self.join_ahead()),
            None => return self.turned(condition, body),
        };
        let skip = self.leave_unless(condition);
        self.block(body);
        if let Some(top) = top {
            self.at(body.end, None);
            self.at_asserted(entered_when);
            self.jump_back(top);
        }
        skip
    }

    /// The loop turned round, with its test at the end: one jump less each time round.
    fn turned(&mut self, condition: &Prepared, body: &Block) -> Mark {
        let skip = self.leave_unless(condition);
        let top = self.join_ahead();
        self.block(body);
        self.at(condition.value.span, None);
        self.hoists(&condition.hoists);
        let test = self.test(&condition.value, true);
        self.code.jump_back(top, |target| test.to(target));
        skip
    }

    fn leave_unless(&mut self, condition: &Prepared) -> Mark {
        self.hoists(&condition.hoists);
        let test = self.test(&condition.value, false);
        self.code.jump(|target| test.to(target))
    }

    fn counted(
        &mut self,
        (counter, name): (CounterId, Option<&(String, bool)>),
        (first, last): (&Expression, &Expression),
        body: &Block,
    ) {
        self.expression(first);
        self.expression(last);
        let enter = self.code.here();
        let named = |(name, is_down): &(String, bool)| LoopName {
            enter,
            name: name.clone(),
            is_down: *is_down,
        };
        self.loops.extend(name.map(named));
        let exit = self.code.jump(|exit| Instr::ForEnter { prefix: PREFIX, counter, exit });
        let top = self.code.join_ahead(|from| Instr::ForTop { counter, from });
        // The end of the body must be reached by something, and if only by a jump never taken.
        let never = (!body.falls_through).then(|| {
            self.push_bool(false);
            self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target })
        });
        self.block(body);
        self.at(body.end, None);
        never.into_iter().for_each(|never| self.join_one(never));
        self.code.jump_back(top, |target| Instr::ForNext { counter, target });
        self.code.join(exit, |from| Instr::ForExit { counter, from });
        self.frame.is_reached = true;
    }

    fn endless(&mut self, body: &Block) {
        if !body.falls_through {
            return self.block(body);
        }
        let top = self.join_ahead();
        self.block(body);
        self.at(body.end, None);
        let breaks = self.frame.loops.last().is_some_and(|around| !around.breaks.is_empty());
        if breaks || self.has_way_out() {
            return self.jump_back(top);
        }
        // Nothing leaves this loop, and yet something must reach what is behind it.
        self.push_bool(true);
        self.code.jump_back(top, |target| Instr::JumpIf { prefix: PREFIX, target });
    }

    fn open_loop(&mut self) {
        let depth = self.frame.scopes.len();
        self.frame.loops.push(Loop { breaks: Vec::new(), depth });
    }

    fn close_loop(&mut self) {
        if let Some(around) = self.frame.loops.pop() {
            self.join_all(around.breaks);
        }
    }
}
