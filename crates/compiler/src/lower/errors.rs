//! Responding to errors: at the action that raised them, as each error says.
//!
//! A sequence that gives up sets `$leaving` and goes to its end, and so do its callers: the error
//! stays pending, and the program stops. What is done again is done again a few times at the most:
//! an action in a row, a sequence in one call of it, the program in one run.

use super::Lower;
use super::frame::Role;
use super::leave::Way;
use super::statement::PREFIX;
use super::test::Test;
use crate::response::{Response, is_for_caller};
use crate::tree::StatementKind;
use obverse_bytecode::{Continuation, ErrorDeclaration, Mark, Recovery};
use obverse_isa::{ErrorId, FunctionId, GlobalId, Instr, LocalId, Type};

/// How often something is done again before it is given up.
const MAX_ROUNDS: i16 = 3;

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
        match self.frame.role {
            Role::Responds => self.effects.due(kind, &self.program.module.errors),
            Role::Ends | Role::InReverse => Vec::new(),
        }
    }

    /// An error is pending no more, if it was: what was not is not told to have been.
    pub(super) fn clear_if_raised(&mut self, error: ErrorId) {
        let next = self.unless_raised(error);
        self.push(Instr::ErrorClear { error });
        self.join_one(next);
    }

    /// In an advanced move or an I/O operation: it ends here if its act has been ended by an error
    /// that its caller responds to now, and does more than note it.
    pub(super) fn end_if_raised(&mut self, raised: &[ErrorId]) {
        if self.frame.role != Role::Ends {
            return;
        }
        for &error in raised {
            let is_noted = self.effects.response(error) == Response::Ignore;
            let declared = self.declared(error);
            if !is_noted && declared.ends_acts() && !is_for_caller(declared) {
                self.push(Instr::PushRaised { error });
                let mark = self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target });
                self.frame.exits.push(mark);
            }
        }
    }

    fn declared(&self, error: ErrorId) -> &ErrorDeclaration {
        &self.program.module.errors[error.index()]
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
        let local = match self.frame.again {
            Some(local) => local,
            None => self.hidden("rounds", Type::Int),
        };
        self.frame.again = Some(local);
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
        let next = (!is_thrown).then(|| self.unless_raised(error));
        if response == Response::Ignore {
            self.push(Instr::ErrorClear { error });
            return next.into_iter().for_each(|next| self.join_one(next));
        }
        self.push(Instr::ErrorDue { error });
        match (response, self.continuation(error)) {
            (Response::Recover { using, .. }, Some(then)) => {
                self.recover(error, using, then, site);
            }
            _ => self.give_up(Way::Out),
        }
        next.into_iter().for_each(|next| self.join_one(next));
    }

    /// A jump that is taken unless an error is pending.
    pub(super) fn unless_raised(&mut self, error: ErrorId) -> Mark {
        self.push(Instr::PushRaised { error });
        self.code.jump(|target| Instr::JumpUnless { prefix: PREFIX, target })
    }

    fn recover(
        &mut self,
        error: ErrorId,
        using: Option<FunctionId>,
        then: Continuation,
        site: &mut Site,
    ) {
        let limits = self.limits(error, then, site);
        // If it may be raised anew by its recovery, it is not pending meanwhile, so that this is
        // known.
        let is_set_aside = using.is_some() && self.effects.is_raised_in_recovery(error);
        if is_set_aside {
            self.push(Instr::ErrorClear { error });
        }
        let failed = using.map_or(Vec::new(), |function| self.recover_using(error, function));
        if !is_set_aside && !matches!(then, Continuation::Program | Continuation::Stop) {
            self.push(Instr::ErrorClear { error });
        }
        match then {
            Continuation::NextAction => {}
            Continuation::Action => {
                if let Some(local) = site.rounds {
                    self.push(Instr::AddLocalImmediate { local, value: 1 });
                }
                if let Some(top) = site.again.pop() {
                    self.jump_back(top);
                }
            }
            Continuation::Sequence => {
                self.leave(Way::Again);
            }
            Continuation::Program => {
                // The error is pending until the start has seen that there is a round left.
                self.raise_again(error, is_set_aside);
                self.give_up(Way::Restart);
            }
            Continuation::Stop => {
                self.join_all(failed);
                self.raise_again(error, is_set_aside);
                self.join_all(limits);
                return self.give_up(Way::Out);
            }
        }
        if limits.is_empty() && failed.is_empty() {
            return;
        }
        let over = self.frame.is_reached.then(|| self.jump());
        if !failed.is_empty() {
            self.join_all(failed);
            self.raise_again(error, is_set_aside);
        }
        self.join_all(limits);
        self.give_up(Way::Out);
        over.into_iter().for_each(|over| self.join_one(over));
    }

    /// Where recovering is not begun: while another recovery is under way, or too often.
    fn limits(&mut self, error: ErrorId, then: Continuation, site: &Site) -> Vec<Mark> {
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
            let test = Test::UnlessLocalLtImmediate(rounds, most_rounds(self.declared(error)));
            given_up.push(self.code.jump(|target| test.to(target)));
        }
        given_up
    }

    /// The local of this frame that says whether an error that was set aside was pending.
    fn pending(&mut self, error: ErrorId) -> LocalId {
        let known = self.frame.aside.iter().find(|(known, _)| *known == error);
        if let Some((_, local)) = known {
            return *local;
        }
        let local = self.hidden("pending", Type::Bool);
        self.frame.aside.push((error, local));
        local
    }

    /// From here on, errors that are pending are not so: the locals that say which were.
    pub(super) fn set_aside(&mut self, errors: &[ErrorId]) -> Vec<(ErrorId, LocalId)> {
        let mut aside = Vec::new();
        for &error in errors {
            let local = self.pending(error);
            self.push(Instr::PushRaised { error });
            self.push(Instr::StoreLocal { prefix: PREFIX, local });
            self.push(Instr::PushLocal { local });
            let was_not = self.code.jump(|target| Instr::JumpUnless { prefix: PREFIX, target });
            self.push(Instr::ErrorClear { error });
            self.join_one(was_not);
            aside.push((error, local));
        }
        aside
    }

    /// What was set aside is pending again.
    pub(super) fn take_up(&mut self, aside: &[(ErrorId, LocalId)]) {
        for &(error, local) in aside {
            self.push(Instr::PushLocal { local });
            let was_not = self.code.jump(|target| Instr::JumpUnless { prefix: PREFIX, target });
            self.pend(error);
            self.join_one(was_not);
        }
    }

    /// What may have been noticed before an error is recovered from, and is none of its sequence.
    fn noticed_before(&self, error: ErrorId, function: FunctionId) -> Vec<ErrorId> {
        let mut raised = self.effects.raised_within(function);
        let is_noted = |other: ErrorId| self.effects.response(other) == Response::Ignore;
        raised.retain(|&other| {
            other != error && !self.declared(other).watches.is_empty() && !is_noted(other)
        });
        raised
    }

    /// Run the sequence of a recovery; the jumps where an error in it gives the recovery up.
    fn recover_using(&mut self, error: ErrorId, function: FunctionId) -> Vec<Mark> {
        let mut failed = Vec::new();
        let aside = self.set_aside(&self.noticed_before(error, function));
        if let Some(recovering) = self.globals.recovering {
            self.set_flag(recovering, true);
        }
        self.push(Instr::Call { prefix: PREFIX, function });
        if let Some(recovering) = self.globals.recovering {
            self.set_flag(recovering, false);
        }
        self.take_up(&aside);
        if let (true, Some(leaving)) = (self.effects.leaves(function), self.globals.leaving) {
            self.push(Instr::PushGlobal { global: leaving });
            failed.push(self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target }));
        }
        for &error in self.effects.left_by(function) {
            if self.effects.response(error) == Response::Ignore {
                self.clear_if_raised(error);
            } else {
                let was = aside.iter().find(|(other, _)| *other == error).map(|(_, local)| *local);
                let next = was.map(|local| {
                    self.push(Instr::PushLocal { local });
                    self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target })
                });
                self.push(Instr::PushRaised { error });
                failed.push(self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target }));
                next.into_iter().for_each(|next| self.join_one(next));
            }
        }
        failed
    }

    /// After a recovery: what it was from is pending again, and once.
    fn raise_again(&mut self, error: ErrorId, is_set_aside: bool) {
        if is_set_aside {
            self.pend(error);
        }
    }

    /// Raise an error; one that is responded to later may be pending already, and is so once.
    pub(super) fn raise(&mut self, error: ErrorId) {
        let pending = is_for_caller(self.declared(error)).then(|| {
            self.push(Instr::PushRaised { error });
            self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target })
        });
        self.push(Instr::ErrorRaise { error });
        pending.into_iter().for_each(|pending| self.join_one(pending));
    }

    /// An error is pending again that was so before: who raised it has been told.
    pub(super) fn pend(&mut self, error: ErrorId) {
        self.push(Instr::ErrorClear { error });
        self.push(Instr::ErrorRaise { error });
    }

    /// Set one of the hidden variables of the program.
    pub(super) fn set_flag(&mut self, global: GlobalId, value: bool) {
        self.push_bool(value);
        self.push(Instr::StoreGlobal { prefix: PREFIX, global });
    }

    /// After a call of a function that may make its caller leave.
    pub(super) fn leave_if_left(&mut self, function: FunctionId) {
        if self.may_be_left_by(function) {
            self.leave_if_leaving();
        }
    }

    /// Whether a function that is called here may make this one leave.
    pub(super) fn may_be_left_by(&self, function: FunctionId) -> bool {
        self.frame.role != Role::InReverse && self.effects.leaves(function)
    }
}

/// How often something is done again for an error before it is given up.
pub(super) fn most_rounds(error: &ErrorDeclaration) -> i16 {
    let attempts = match error.recovery {
        // Those are bounds of going back.
        Recovery::Reversing(_) => None,
        Recovery::None | Recovery::Using(_) => error.bounds.attempts,
    };
    attempts.map_or(MAX_ROUNDS, |attempts| i16::try_from(attempts).unwrap_or(i16::MAX))
}
