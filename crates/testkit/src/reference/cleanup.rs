//! What runs at the end of a program, whatever came before. The errors that may be raised in it are
//! not pending meanwhile, and are so again behind it.

use super::error::{Response, is_for_caller, response};
use super::{Frame, Interpreter, Run};
use obverse_syntax::ast::{
    Block, Cause, ErrorClause, ErrorDeclaration, FaultWord, Item, MoveClause, StatementKind,
};
use std::collections::BTreeSet;

/// The names of errors.
type Names<'p> = BTreeSet<&'p str>;

impl<'p> Interpreter<'p, '_> {
    /// The cleanup, if the program has one.
    pub(super) fn clean_up(&mut self) -> Run<()> {
        let Some(cleanup) = self.names.cleanup else { return Ok(()) };
        let raised = self.raised_within(&cleanup.body);
        let before: Vec<&'p str> = self.errors(|error| {
            raised.contains(error.name.value) && self.raised.contains(&error.name.value)
        });
        before.iter().for_each(|error| self.clear(error));
        let frame = Frame { function: "cleanup", ..Frame::default() };
        self.within(frame, |interpreter| interpreter.body(&cleanup.body))?;
        let mut left = Names::new();
        self.raised_by(&cleanup.body, &mut left, &mut Vec::new());
        let noted = self.errors(|error| {
            let is_noted = matches!(response(error), Response::Ignore);
            left.contains(error.name.value) && is_for_caller(error) && is_noted
        });
        noted.iter().for_each(|error| self.clear(error));
        for error in before {
            self.clear(error);
            self.raised.push(error);
        }
        Ok(())
    }

    fn errors(&self, is_wanted: impl Fn(&ErrorDeclaration<'p>) -> bool) -> Vec<&'p str> {
        let errors = self.program.items.iter().filter_map(|item| match item {
            Item::Error(error) if is_wanted(error) => Some(error.name.value),
            _ => None,
        });
        errors.collect()
    }

    /// The errors that may be raised while a block is run, in what it calls and in the recoveries
    /// from them.
    fn raised_within(&self, block: &'p Block<'p>) -> Names<'p> {
        let mut raised = Names::new();
        let (mut called, mut seen) = (Vec::new(), Names::new());
        let mut to_visit = vec![block];
        while let Some(block) = to_visit.pop() {
            let known = raised.clone();
            self.raised_by(block, &mut raised, &mut called);
            for error in raised.difference(&known) {
                let error = self.names.errors.get(error).copied();
                if let Some(Response::Recover { using, .. }) = error.map(response) {
                    called.extend(using);
                }
            }
            for name in called.drain(..).filter(|name| seen.insert(name)) {
                to_visit.extend(self.names.sequences.get(name).map(|sequence| &sequence.body));
            }
        }
        raised
    }

    /// The errors that may be raised while one is being recovered from.
    pub(super) fn raised_in_recoveries(&self) -> Names<'p> {
        let mut raised = Names::new();
        let recoveries = self.names.errors.values().filter_map(|error| match response(error) {
            Response::Recover { using, .. } => using,
            Response::Ignore | Response::Stop => None,
        });
        let mut called: Vec<&'p str> = recoveries.collect();
        let mut seen = Names::new();
        while let Some(name) = called.pop() {
            if let Some(sequence) = self.names.sequences.get(name).filter(|_| seen.insert(name)) {
                self.raised_by(&sequence.body, &mut raised, &mut called);
            }
        }
        raised
    }

    /// The errors that the statements of a block raise but for its calls, and what it calls.
    pub(super) fn raised_by(
        &self,
        block: &'p Block<'p>,
        raised: &mut Names<'p>,
        called: &mut Vec<&'p str>,
    ) {
        for statement in &block.statements {
            match &statement.kind {
                StatementKind::Throw(error) | StatementKind::Requires { error, .. } => {
                    raised.insert(error.value);
                }
                StatementKind::Advance(name) => {
                    raised.extend(self.thrown_by_move(name.value));
                    raised.extend(self.faulty(|_| true));
                }
                StatementKind::Move { .. } => raised.extend(self.faulty(|_| true)),
                StatementKind::Wait(_)
                | StatementKind::WaitUntil { .. }
                | StatementKind::Primitive(_) => raised.extend(self.faulty(is_of_any_act)),
                StatementKind::Io(name) => {
                    let io = self.names.io.get(name.value);
                    if io.is_some_and(|io| !io.primitives.is_empty()) {
                        raised.extend(self.faulty(is_of_any_act));
                    }
                }
                StatementKind::Call { name, .. } => called.push(name.value),
                _ => {}
            }
            // In reverse nothing is raised.
            let blocks = match &statement.kind {
                StatementKind::ReplaceInReverse { block, .. } => vec![block],
                _ => statement.blocks(),
            };
            blocks.into_iter().for_each(|block| self.raised_by(block, raised, called));
        }
    }

    /// The errors that a fault of some kind raises.
    fn faulty(&self, is_kind: impl Fn(FaultWord) -> bool) -> Vec<&'p str> {
        self.errors(|error| {
            error.clauses.iter().any(|clause| match &clause.value {
                ErrorClause::On(causes) => causes.iter().any(|cause| match cause {
                    Cause::Fault(fault) => is_kind(fault.value),
                    Cause::Input { .. } | Cause::Force(_) => true,
                }),
                _ => false,
            })
        })
    }

    /// What an advanced move throws if what it requires does not hold.
    pub(super) fn thrown_if_unmet(clause: &MoveClause<'p>) -> Option<&'p str> {
        match clause {
            MoveClause::Requires { otherwise, .. } => otherwise.map(|error| error.value),
            _ => None,
        }
    }
}

/// Whether every act may meet a fault, not only a motion.
fn is_of_any_act(fault: FaultWord) -> bool {
    matches!(fault, FaultWord::ProtectiveStop | FaultWord::EmergencyStop | FaultWord::Missing)
}
