//! Responding to errors: at the action that raised them, as each error says.
//!
//! A sequence that gives up sets `$leaving` and goes to its end, and so do its callers: the error
//! stays pending, and the program stops. What is done again is done again a few times at the most:
//! an action in a row, a sequence in one call of it, the program in one run.

use super::Lower;
use super::leave::Way;
use super::statement::PREFIX;
use super::test::Test;
use crate::response::Response;
use crate::tree::StatementKind;
use obverse_bytecode::{Continuation, Mark, Recovery, Severity};
use obverse_isa::{ErrorId, FunctionId, GlobalId, Instr, LocalId, Type};

/// How often something is done again before it is given up.
pub(super) const MAX_ROUNDS: i16 = 3;

/// An action that may leave errors to be responded to.
pub(super) struct Site {
    /// The joins before it, for those that let it be done again.
    again: Vec<Mark>,
    /// How often it has been done again in a row.
    rounds: Option<LocalId>,
}

impl Lower<'_> {
    /// The errors that are responded to after a statement.
    pub(super) fn due(&self, kind: &StatementKind) -> Vec<ErrorId> {
        self.effects.due(kind, &self.program.module.errors)
    }

    /// Before an action that may leave these errors.
    pub(super) fn begin_site(&mut self, due: &[ErrorId]) -> Site {
        let repeats = due
            .iter()
            .filter(|error| self.continuation(**error) == Some(Continuation::Action))
            .count();
        if repeats == 0 {
            return Site { again: Vec::new(), rounds: None };
        }
        let local = self.hidden("rounds", Type::Int);
        self.push(Instr::PushInt { value: 0 });
        self.push(Instr::StoreLocal { prefix: PREFIX, local });
        let again = (0..repeats).map(|_| self.join_ahead()).collect();
        Site { again, rounds: Some(local) }
    }

    /// After it.
    pub(super) fn end_site(&mut self, due: &[ErrorId], mut site: Site, is_thrown: bool) {
        for error in due {
            self.respond(*error, &mut site, is_thrown);
        }
    }

    /// How the program goes on after an error is recovered from, if it is.
    pub(super) fn continuation(&self, error: ErrorId) -> Option<Continuation> {
        match self.effects.response(error) {
            // The start calls one sequence: that again is the action again.
            Response::Recover { then: Continuation::Sequence, .. } if self.frame.is_start => {
                Some(Continuation::Action)
            }
            Response::Recover { then, .. } => Some(then),
            Response::Ignore | Response::Stop => None,
        }
    }

    fn respond(&mut self, error: ErrorId, site: &mut Site, is_thrown: bool) {
        let response = self.effects.response(error);
        if response == Response::Ignore {
            return self.push(Instr::ErrorClear { error });
        }
        let next = (!is_thrown).then(|| {
            self.push(Instr::PushRaised { error });
            self.code.jump(|target| Instr::JumpUnless { prefix: PREFIX, target })
        });
        if self.is_reversed(error) {
            self.push(Instr::ErrorDue { error });
        }
        match (response, self.continuation(error)) {
            (Response::Recover { using, .. }, Some(then)) => {
                self.recover(error, using, then, site);
            }
            _ => self.give_up(Way::Out),
        }
        next.into_iter().for_each(|next| self.join_one(next));
    }

    /// Whether whoever drives the machine may go back for an error before the code responds.
    fn is_reversed(&self, error: ErrorId) -> bool {
        let declared = &self.program.module.errors[error.index()];
        declared.severity == Severity::Recoverable
            && matches!(declared.recovery, Recovery::Reversing(_))
    }

    fn recover(
        &mut self,
        error: ErrorId,
        using: Option<FunctionId>,
        then: Continuation,
        site: &mut Site,
    ) {
        let mut given_up = self.limits(then, site);
        if let Some(function) = using {
            self.recover_using(function, &mut given_up);
        }
        match then {
            Continuation::NextAction => self.push(Instr::ErrorClear { error }),
            Continuation::Action => {
                self.push(Instr::ErrorClear { error });
                if let Some(local) = site.rounds {
                    self.push(Instr::AddLocalImmediate { local, value: 1 });
                }
                if let Some(top) = site.again.pop() {
                    self.jump_back(top);
                }
            }
            Continuation::Sequence => {
                self.push(Instr::ErrorClear { error });
                self.leave(Way::Again);
            }
            Continuation::Program => {
                // The error stays pending until the start has seen that there is a round left.
                self.give_up(Way::Restart);
            }
            Continuation::Stop => {
                self.join_all(given_up);
                return self.give_up(Way::Out);
            }
        }
        if given_up.is_empty() {
            return;
        }
        let over = self.frame.is_reached.then(|| self.jump());
        self.join_all(given_up);
        self.give_up(Way::Out);
        over.into_iter().for_each(|over| self.join_one(over));
    }

    /// Where recovering is not begun: while another recovery is under way, or too often.
    fn limits(&mut self, then: Continuation, site: &Site) -> Vec<Mark> {
        let mut given_up = Vec::new();
        if let (true, Some(recovering)) = (self.frame.may_nest_recovery, self.globals.recovering) {
            self.push(Instr::PushGlobal { global: recovering });
            given_up.push(self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target }));
        }
        let rounds = match then {
            Continuation::Action => site.rounds,
            Continuation::Sequence => self.frame.rounds,
            _ => None,
        };
        if let Some(rounds) = rounds {
            let test = Test::UnlessLocalLtImmediate(rounds, MAX_ROUNDS);
            given_up.push(self.code.jump(|target| test.to(target)));
        }
        given_up
    }

    /// Run the sequence of a recovery; an error in it gives the recovery up.
    fn recover_using(&mut self, function: FunctionId, given_up: &mut Vec<Mark>) {
        if let Some(recovering) = self.globals.recovering {
            self.set_flag(recovering, true);
        }
        self.push(Instr::Call { prefix: PREFIX, function });
        if let Some(recovering) = self.globals.recovering {
            self.set_flag(recovering, false);
        }
        if let (true, Some(leaving)) = (self.effects.leaves(function), self.globals.leaving) {
            self.push(Instr::PushGlobal { global: leaving });
            given_up.push(self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target }));
        }
        for &error in self.effects.left_by(function) {
            if self.effects.response(error) == Response::Ignore {
                self.push(Instr::ErrorClear { error });
            } else {
                self.push(Instr::PushRaised { error });
                given_up.push(self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target }));
            }
        }
    }

    /// Set one of the hidden variables of the program.
    pub(super) fn set_flag(&mut self, global: GlobalId, value: bool) {
        self.push_bool(value);
        self.push(Instr::StoreGlobal { prefix: PREFIX, global });
    }

    /// After a call of a function that may make its caller leave.
    pub(super) fn leave_if_left(&mut self, function: FunctionId) {
        if self.effects.leaves(function) {
            self.leave_if_leaving();
        }
    }
}
