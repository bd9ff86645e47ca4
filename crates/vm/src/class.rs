//! The class of an instruction as a trait, so that a wrong one does not compile.
//!
//! The step loop calls an opcode by the trait that the table's class column names: an opcode whose
//! row says `always` and whose code saves something is a type error, and so is a never-op with a
//! reverse to call, or a record of another kind than the row's. No implementation sees the tape:
//! the step loop saves, appends, acts; in reverse it reads, acts, and only then drops.
//!
//! `C` is what an opcode of a family may touch. Operands lie in the order of the stack picture.

use crate::stop::TrapKind;
use crate::values::Values;
use obverse_tape::Record;

/// Why an effect was not done.
#[derive(Debug)]
pub enum Failure {
    /// The machine refuses.
    Trap(TrapKind),
    /// The workcell did not do as commanded.
    Fault(obverse_workcell::Fault),
}

impl From<TrapKind> for Failure {
    fn from(trap: TrapKind) -> Self {
        Self::Trap(trap)
    }
}

impl From<obverse_workcell::Fault> for Failure {
    fn from(fault: obverse_workcell::Fault) -> Self {
        Self::Fault(fault)
    }
}

/// A pure instruction: of class always, and reversed by running its prefix again up to the one
/// before.
pub trait Pure {
    /// Run it.
    ///
    /// # Errors
    /// A trap leaves the statement as if it had not begun.
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind>;
}

/// An effect that is undone in any state, without a record.
pub trait Always<C> {
    /// Do it.
    ///
    /// # Errors
    /// An act that was not finished may be done again or undone.
    fn forward(self, context: &mut C) -> Result<(), Failure>;

    /// Undo it, with the operands it was done with.
    ///
    /// # Errors
    /// As for [`forward`](Self::forward).
    fn reverse(self, context: &mut C) -> Result<(), Failure>;
}

/// An effect that is undone from what it saved.
pub trait AfterForward<C> {
    /// What it saves: the record that the table names.
    type Saved: Record;

    /// What undoing it will need.
    fn save(&self, context: &C) -> Self::Saved;

    /// Do it.
    ///
    /// # Errors
    /// An act that was not finished may be done again or undone, from the same record.
    fn forward(self, context: &mut C, saved: &Self::Saved) -> Result<(), Failure>;

    /// Undo it from its record. An act of the workcell has its operands too; what the hot loops
    /// run has not.
    ///
    /// # Errors
    /// As for [`forward`](Self::forward).
    fn reverse(self, context: &mut C, saved: &Self::Saved) -> Result<(), Failure>;
}

/// An effect that cannot be undone: there is no reverse to call.
pub trait Never<C> {
    /// Do it.
    ///
    /// # Errors
    /// If it was not done.
    fn forward(self, context: &mut C) -> Result<(), Failure>;
}
