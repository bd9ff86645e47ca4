//! What can be seen from a place in a program: variables with their types.

use super::Generator;
use super::fork::Claim;

/// The types of variables and parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    Int,
    Number,
    Length,
    Angle,
    Time,
    Force,
    Bool,
    Joints,
    /// Of parameters alone.
    Item,
}

impl Type {
    /// Those of reals.
    pub(super) const REALS: [Self; 5] =
        [Self::Number, Self::Length, Self::Time, Self::Force, Self::Angle];
    /// Those of variables.
    pub(super) const OF_VARIABLES: [Self; 9] = [
        Self::Int,
        Self::Int,
        Self::Bool,
        Self::Number,
        Self::Length,
        Self::Time,
        Self::Force,
        Self::Angle,
        Self::Joints,
    ];

    /// As declared.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Int => "int",
            Self::Number => "number",
            Self::Length => "length",
            Self::Angle => "angle",
            Self::Time => "time",
            Self::Force => "force",
            Self::Bool => "bool",
            Self::Joints => "joints",
            Self::Item => "item",
        }
    }
}

/// A variable, a parameter or a loop counter.
#[derive(Clone, Debug)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) of_type: Type,
    /// Whether it may be assigned: what bounds a loop or is asserted may not.
    pub(super) is_free: bool,
}

/// What is known of the sequence in hand.
#[derive(Clone, Debug, Default)]
pub(super) struct Frame {
    pub(super) variables: Vec<Variable>,
    /// Remembered positions.
    pub(super) positions: Vec<String>,
    /// How many statements the sequence comes to so far.
    pub(super) cost: u64,
    /// How often the statement in hand is done in one call at the most.
    pub(super) times: u64,
    /// How many blocks there are around.
    pub(super) nesting: usize,
    /// Whether there is a loop around that `break` may leave.
    pub(super) in_loop: bool,
    /// Whether there is a block with a reverse of its own around, or a branch.
    pub(super) in_reversed: bool,
    /// What the branch of a fork around has for itself.
    pub(super) claim: Option<Claim>,
    /// Whether this is a block that is run in reverse.
    pub(super) is_replacement: bool,
    /// Whether it is known which position the program named last.
    pub(super) knows_position: bool,
    /// How many of the positions may not be remembered anew.
    pub(super) kept_positions: usize,
    /// Whether it passes a barrier.
    pub(super) has_barrier: bool,
    /// Whether readings of the outside may stand in expressions.
    pub(super) may_read: bool,
}

impl Frame {
    /// At the beginning of a sequence.
    pub(super) fn new() -> Self {
        Self { times: 1, may_read: true, ..Self::default() }
    }

    /// Of a block that replaces another in reverse: it reads what is around it.
    pub(super) fn in_reverse(&self) -> Self {
        let read = |variable: &Variable| Variable { is_free: false, ..variable.clone() };
        Self {
            variables: self.variables.iter().map(read).collect(),
            positions: self.positions.clone(),
            kept_positions: self.positions.len(),
            in_reversed: true,
            is_replacement: true,
            nesting: self.nesting,
            claim: self.claim.clone(),
            ..Self::new()
        }
    }
}

/// How much could be seen when a block began.
#[derive(Clone, Copy)]
pub(super) struct Mark {
    variables: usize,
    positions: usize,
}

impl Generator<'_, '_> {
    /// The variables of a type that can be read here.
    pub(super) fn readable(&self, of_type: Type) -> Vec<String> {
        self.seen(of_type).map(|variable| variable.name.clone()).collect()
    }

    /// The variables of a type that can be assigned here.
    pub(super) fn assignable(&self, of_type: Type) -> Vec<String> {
        let free = self.seen(of_type).filter(|variable| variable.is_free);
        free.map(|variable| variable.name.clone()).collect()
    }

    fn seen(&self, of_type: Type) -> impl Iterator<Item = &Variable> {
        let all = self.globals.iter().chain(&self.frame.variables);
        all.filter(move |variable| variable.of_type == of_type)
    }

    /// Declare a variable of the sequence in hand.
    pub(super) fn declare(&mut self, name: &str, of_type: Type, is_free: bool) {
        self.frame.variables.push(Variable { name: name.to_owned(), of_type, is_free });
    }

    /// What can be seen now.
    pub(super) fn mark(&self) -> Mark {
        Mark { variables: self.frame.variables.len(), positions: self.frame.positions.len() }
    }

    /// See no more than then.
    pub(super) fn forget(&mut self, mark: Mark) {
        self.frame.variables.truncate(mark.variables);
        self.frame.positions.truncate(mark.positions);
    }
}
