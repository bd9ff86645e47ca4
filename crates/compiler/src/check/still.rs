//! What leaves the arm where it is, told from the syntax tree: what a loop or a call does to the
//! position named last must be known before its body has been checked. Knows nothing of where the
//! arm is.

use crate::response::{Response, response};
use obverse_bytecode::{ErrorDeclaration, Recovery};
use obverse_syntax::ast::{Block, Item, Program, Statement, StatementKind};
use std::collections::{HashMap, HashSet};

/// What may move the arm, by name.
#[derive(Debug, Default)]
pub(super) struct Movers<'s> {
    /// The sequences and actions.
    sequences: HashSet<&'s str>,
    /// The errors that are recovered from, each with the sequence that does so; none where the
    /// program goes back.
    recovered: HashMap<&'s str, Option<&'s str>>,
}

impl<'s> Movers<'s> {
    /// Those of a program; `errors` are what has become of its declarations, in their order.
    pub(super) fn of(program: &Program<'s>, errors: &[ErrorDeclaration]) -> Self {
        let recovered = recoveries(program, errors);
        let mut movers = Self { sequences: HashSet::new(), recovered };
        let mut callers: HashMap<&str, Vec<&'s str>> = HashMap::new();
        let mut to_visit: Vec<&'s str> = Vec::new();
        for item in &program.items {
            let Item::Sequence(sequence) = item else { continue };
            let caller = sequence.name.value;
            if movers.may_move(&sequence.body) {
                to_visit.push(caller);
            }
            movers.each_run(&sequence.body, &mut |name| {
                callers.entry(name).or_default().push(caller);
            });
        }
        while let Some(name) = to_visit.pop() {
            if movers.sequences.insert(name) {
                to_visit.extend(callers.get(name).into_iter().flatten());
            }
        }
        movers
    }

    /// Whether a call of this sequence may move the arm.
    pub(super) fn may_move_in(&self, sequence: &str) -> bool {
        self.sequences.contains(sequence)
    }

    /// Whether the arm may be moved while this error is recovered from.
    pub(super) fn may_move_after(&self, error: &str) -> bool {
        let recovered = self.recovered.get(error);
        recovered.is_some_and(|using| using.is_none_or(|using| self.may_move_in(using)))
    }

    /// Whether a block may move the arm.
    pub(super) fn may_move(&self, block: &Block<'_>) -> bool {
        block.statements.iter().any(|statement| self.is_mover(statement))
    }

    fn is_mover(&self, statement: &Statement<'_>) -> bool {
        match &statement.kind {
            StatementKind::Move { .. } | StatementKind::Advance(_) => true,
            StatementKind::Call { name, .. } => self.may_move_in(name.value),
            StatementKind::Throw(name) => self.may_move_after(name.value),
            _ => statement.blocks().into_iter().any(|block| self.may_move(block)),
        }
    }

    /// The name of each sequence that a block calls, or has run for an error.
    fn each_run(&self, block: &Block<'s>, visit: &mut impl FnMut(&'s str)) {
        for statement in &block.statements {
            match &statement.kind {
                StatementKind::Call { name, .. } => visit(name.value),
                StatementKind::Throw(name) => {
                    self.recovered.get(name.value).into_iter().flatten().for_each(|name| {
                        visit(name);
                    });
                }
                _ => statement.blocks().into_iter().for_each(|block| self.each_run(block, visit)),
            }
        }
    }
}

/// The errors that are recovered from, and how.
fn recoveries<'s>(
    program: &Program<'s>,
    errors: &[ErrorDeclaration],
) -> HashMap<&'s str, Option<&'s str>> {
    // The start of the program comes first among the functions.
    let (mut functions, mut names) = (vec![""], Vec::new());
    for item in &program.items {
        match item {
            Item::Io(io) => functions.push(io.name.value),
            Item::AdvancedMove(guarded) => functions.push(guarded.name.value),
            Item::Sequence(sequence) => functions.push(sequence.name.value),
            Item::Error(error) => names.push(error.name.value),
            _ => {}
        }
    }
    let recovery = |(name, error): (&'s str, &ErrorDeclaration)| match response(error) {
        Response::Ignore | Response::Stop => None,
        Response::Recover { using: None, .. } if error.recovery == Recovery::None => None,
        Response::Recover { using, .. } => {
            let goes_back = matches!(error.recovery, Recovery::Reversing(_));
            let using = using.filter(|_| !goes_back);
            Some((name, using.and_then(|using| functions.get(using.index()).copied())))
        }
    };
    names.into_iter().zip(errors).filter_map(recovery).collect()
}
