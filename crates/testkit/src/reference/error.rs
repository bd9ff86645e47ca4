//! Errors: which are due after an action, and what the program does about each.
//!
//! An error that is responded to after the sequence is due where the sequence was called, any
//! other one where it was raised. Reversal is not among the responses: whoever drives a machine
//! reverses, and what follows here is what follows once that has been given up.

use super::control::Flow;
use super::value::Value;
use super::{Interpreter, Run};
use obverse_syntax::ast::{
    Behaviour, Bound, Continuation, ErrorClause, ErrorDeclaration, Item, MoveClause, Otherwise,
    Recovery, Respond, Sequence, Severity,
};
use std::collections::BTreeSet;

/// How often something is done again before that is given up.
const MAX_ROUNDS: u64 = 3;

/// An action while its errors are responded to.
#[derive(Default)]
pub(super) struct Site {
    /// How often it has been done again.
    rounds: u64,
}

/// What is done about an error.
pub(super) enum Response<'p> {
    Ignore,
    Stop,
    Recover { using: Option<&'p str>, then: Continuation },
}

impl<'p> Interpreter<'p, '_> {
    /// The program from its main sequence on, as often as its errors want it again.
    pub(super) fn begin(&mut self, main: &'p Sequence<'p>) -> Run<()> {
        let mut rounds = 0;
        loop {
            let mut site = Site::default();
            while self.call_and_respond(main.name.value, &[], &mut site)?.is_none() {
                self.step()?;
            }
            if !std::mem::take(&mut self.restarts) || rounds >= self.most_restarts() {
                return Ok(());
            }
            rounds += 1;
            self.step()?;
            self.clear_restarting();
            self.first_values()?;
        }
    }

    /// How often the program begins again: as often as one of its errors says.
    fn most_restarts(&self) -> u64 {
        let errors = self.in_order(|error| {
            matches!(response(error), Response::Recover { then: Continuation::Program, .. })
        });
        errors.into_iter().map(most_rounds).max().unwrap_or(0)
    }

    /// The program begins again: the errors that want that are dealt with.
    fn clear_restarting(&mut self) {
        for item in &self.program.items {
            if let Item::Error(error) = item
                && let Response::Recover { then: Continuation::Program, .. } = response(error)
            {
                self.clear(error.name.value);
            }
        }
    }

    /// Call a sequence, and respond to what it leaves; where to go on, or none for once more.
    pub(super) fn call_and_respond(
        &mut self,
        name: &'p str,
        arguments: &[Value],
        site: &mut Site,
    ) -> Run<Option<Flow>> {
        let Some(&sequence) = self.names.sequences.get(name) else { return Ok(Some(Flow::Next)) };
        if self.call(sequence, arguments)? == Flow::Leave {
            return Ok(Some(Flow::Leave));
        }
        let due = self.left_to_caller(sequence);
        self.respond_to_all(due, site)
    }

    /// Respond to what an advanced move has thrown.
    pub(super) fn respond_after_move(
        &mut self,
        name: &'p str,
        site: &mut Site,
    ) -> Run<Option<Flow>> {
        let thrown = self.thrown_by_move(name);
        let due =
            self.in_order(|error| thrown.contains(&error.name.value) && !is_for_caller(error));
        self.respond_to_all(due, site)
    }

    /// Respond to an error that has just been thrown.
    pub(super) fn respond_to_throw(&mut self, name: &'p str, site: &mut Site) -> Run<Option<Flow>> {
        match self.names.errors.get(name) {
            Some(error) if !is_for_caller(error) => self.respond(error, site),
            _ => Ok(Some(Flow::Next)),
        }
    }

    /// Respond to those that are pending, until one of them leads elsewhere.
    fn respond_to_all(
        &mut self,
        due: Vec<&'p ErrorDeclaration<'p>>,
        site: &mut Site,
    ) -> Run<Option<Flow>> {
        for error in due {
            if self.raised.contains(&error.name.value) {
                let flow = self.respond(error, site)?;
                if flow != Some(Flow::Next) {
                    return Ok(flow);
                }
            }
        }
        Ok(Some(Flow::Next))
    }

    /// Respond to an error; where to go on, or none for the action once more.
    fn respond(&mut self, error: &'p ErrorDeclaration<'p>, site: &mut Site) -> Run<Option<Flow>> {
        let (using, then) = match response(error) {
            Response::Ignore => {
                self.clear(error.name.value);
                return Ok(Some(Flow::Next));
            }
            Response::Stop => return Ok(Some(Flow::Leave)),
            Response::Recover { using, then } => (using, then),
        };
        // The program calls one sequence: that again is the call again.
        let then = match then {
            Continuation::Sequence if self.frames.len() == 1 => Continuation::Action,
            then => then,
        };
        let rounds = match then {
            Continuation::Action => site.rounds,
            Continuation::Sequence => self.frame().rounds,
            _ => 0,
        };
        if self.is_recovering || rounds >= most_rounds(error) {
            return Ok(Some(Flow::Leave));
        }
        let is_set_aside =
            using.is_some() && self.raised_in_recoveries().contains(error.name.value);
        if is_set_aside {
            self.clear(error.name.value);
        }
        let has_recovered = self.recover(using)?;
        let stays = !has_recovered || matches!(then, Continuation::Program | Continuation::Stop);
        if is_set_aside && stays {
            self.clear(error.name.value);
            self.raised.push(error.name.value);
        }
        if !has_recovered {
            return Ok(Some(Flow::Leave));
        }
        Ok(self.go_on(error, then, !is_set_aside, site))
    }

    /// How the program goes on after a recovery.
    fn go_on(
        &mut self,
        error: &'p ErrorDeclaration<'p>,
        then: Continuation,
        is_pending: bool,
        site: &mut Site,
    ) -> Option<Flow> {
        match then {
            Continuation::Stop => return Some(Flow::Leave),
            Continuation::Program => {
                self.restarts = true;
                return Some(Flow::Leave);
            }
            _ if is_pending => self.clear(error.name.value),
            _ => {}
        }
        match then {
            Continuation::Action => {
                site.rounds += 1;
                None
            }
            Continuation::Sequence => {
                self.frame_mut().rounds += 1;
                Some(Flow::Again)
            }
            _ => Some(Flow::Next),
        }
    }

    /// Run the sequence of a recovery; whether it could.
    fn recover(&mut self, using: Option<&'p str>) -> Run<bool> {
        let Some(&sequence) = using.and_then(|name| self.names.sequences.get(name)) else {
            return Ok(true);
        };
        self.is_recovering = true;
        let flow = self.call(sequence, &[])?;
        self.is_recovering = false;
        if flow == Flow::Leave {
            return Ok(false);
        }
        for error in self.left_to_caller(sequence) {
            match response(error) {
                Response::Ignore => self.clear(error.name.value),
                _ if self.raised.contains(&error.name.value) => return Ok(false),
                _ => {}
            }
        }
        Ok(true)
    }

    /// An error is pending; one that is so until the sequence ends is pending once.
    pub(super) fn raise(&mut self, name: &'p str) {
        let is_later = self.names.errors.get(name).is_some_and(|error| is_for_caller(error));
        if !is_later || !self.raised.contains(&name) {
            self.raised.push(name);
        }
    }

    /// An error is dealt with: its oldest entry goes.
    pub(super) fn clear(&mut self, name: &str) {
        if let Some(place) = self.raised.iter().position(|raised| *raised == name) {
            self.raised.remove(place);
        }
    }

    /// The errors that a sequence leaves to be responded to where it was called.
    fn left_to_caller(&self, sequence: &'p Sequence<'p>) -> Vec<&'p ErrorDeclaration<'p>> {
        let mut raised = BTreeSet::new();
        self.raised_by(&sequence.body, &mut raised, &mut Vec::new());
        self.in_order(|error| raised.contains(error.name.value) && is_for_caller(error))
    }

    /// Errors in the order in which they are responded to: the worst first, and of those alike the
    /// one that is declared first.
    fn in_order(
        &self,
        is_wanted: impl Fn(&ErrorDeclaration<'p>) -> bool,
    ) -> Vec<&'p ErrorDeclaration<'p>> {
        let errors = self.program.items.iter().filter_map(|item| match item {
            Item::Error(error) => Some(error),
            _ => None,
        });
        let mut wanted: Vec<_> = errors.filter(|error| is_wanted(error)).collect();
        wanted.sort_by_key(|error| rank(error));
        wanted
    }

    /// The errors that an advanced move throws.
    pub(super) fn thrown_by_move(&self, name: &str) -> Vec<&'p str> {
        let clauses = self.names.moves.get(name).map_or(&[][..], |guarded| &guarded.clauses);
        let behaviours = clauses.iter().flat_map(|clause| match &clause.value {
            MoveClause::OnSuccess(behaviours) | MoveClause::OnFailure(behaviours) => {
                behaviours.as_slice()
            }
            _ => &[],
        });
        let thrown = behaviours.filter_map(|behaviour| match &behaviour.value {
            Behaviour::Throw(name) => Some(name.value),
            _ => None,
        });
        let unmet = clauses.iter().filter_map(|clause| Self::thrown_if_unmet(&clause.value));
        thrown.chain(unmet).collect()
    }
}

/// How bad an error is, the worst first.
fn rank(error: &ErrorDeclaration<'_>) -> u8 {
    let severity = error.clauses.iter().find_map(|clause| match &clause.value {
        ErrorClause::Severity(severity) => Some(*severity),
        _ => None,
    });
    match severity {
        Some(Severity::Fatal) => 0,
        Some(Severity::Recoverable) | None => 1,
        Some(Severity::Warning) => 2,
    }
}

/// How often an error has something done again.
fn most_rounds(error: &ErrorDeclaration<'_>) -> u64 {
    let mut most = None;
    for clause in &error.clauses {
        match &clause.value {
            ErrorClause::Recover(Recovery::Reversing { .. }) => return MAX_ROUNDS,
            ErrorClause::GiveUp(bounds) => {
                most = bounds.iter().find_map(|bound| match bound {
                    Bound::Attempts(times) => Some(times.value),
                    Bound::Cost(_) => None,
                });
            }
            _ => {}
        }
    }
    most.unwrap_or(MAX_ROUNDS)
}

/// Whether an error is responded to where the sequence that raised it was called.
pub(super) fn is_for_caller(error: &ErrorDeclaration<'_>) -> bool {
    let is_after_sequence =
        |clause: &ErrorClause<'_>| matches!(clause, ErrorClause::Respond(Respond::AfterSequence));
    error.clauses.iter().any(|clause| is_after_sequence(&clause.value))
}

/// What an error's declaration says is done about it.
pub(super) fn response<'p>(error: &'p ErrorDeclaration<'p>) -> Response<'p> {
    let mut severity = Severity::Recoverable;
    let mut reverses = false;
    let mut using = None;
    let mut then = None;
    for clause in &error.clauses {
        match &clause.value {
            ErrorClause::Severity(value) => severity = *value,
            ErrorClause::Recover(Recovery::Reversing { .. }) => reverses = true,
            ErrorClause::Recover(Recovery::Using(name))
            | ErrorClause::Otherwise(Otherwise::Using(name)) => using = Some(name.value),
            ErrorClause::Then(value) => then = Some(*value),
            ErrorClause::Otherwise(_)
            | ErrorClause::Respond(_)
            | ErrorClause::On(_)
            | ErrorClause::GiveUp(_) => {}
        }
    }
    let has_recovery = reverses || using.is_some();
    let default = if has_recovery { Continuation::Sequence } else { Continuation::Stop };
    match (severity, using, then.unwrap_or(default)) {
        (Severity::Warning, ..) => Response::Ignore,
        (Severity::Fatal, ..) => Response::Stop,
        // Going back is all it asks for, and that has been given up.
        (_, None, _) if reverses => Response::Stop,
        (_, None, Continuation::Stop) => Response::Stop,
        (_, None, Continuation::NextAction) => Response::Ignore,
        (_, using, then) => Response::Recover { using, then },
    }
}
