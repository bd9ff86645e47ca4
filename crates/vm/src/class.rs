//! The class of an instruction as a trait, so that a wrong one does not compile.
//!
//! The step loop calls an opcode by the trait that the table's class column names: an opcode whose
//! row says `always` and whose code saves something is a type error, and so is a never-op with a
//! reverse to call, or a record of another kind than the row's. No implementation sees the tape:
//! the step loop saves, appends, acts; in reverse it reads, acts, and only then drops.
//!
//! `C` is what an opcode of a family may touch. Operands lie in the order of the stack picture.
//!
//! # What compiles, and what does not
//!
//! An opcode with one variable to touch:
//!
//! ```
//! use obverse_isa::{LocalId, Prefix, op};
//! use obverse_tape::record::Word;
//! use obverse_vm::class::{AfterForward, Failure};
//!
//! struct Cell(u64);
//!
//! impl AfterForward<Cell> for op::StoreLocal {
//!     type Saved = Word;
//!
//!     fn save(&self, cell: &Cell) -> Word {
//!         Word(cell.0)
//!     }
//!
//!     fn forward(self, cell: &mut Cell, _: &Word) -> Result<(), Failure> {
//!         cell.0 = 7;
//!         Ok(())
//!     }
//!
//!     fn reverse(self, cell: &mut Cell, saved: &Word) -> Result<(), Failure> {
//!         cell.0 = saved.0;
//!         Ok(())
//!     }
//! }
//!
//! let op = op::StoreLocal { prefix: Prefix(1), local: LocalId(0) };
//! let mut cell = Cell(3);
//! // As the step loop does where the row says `after_forward(Word)`.
//! let saved: Word = op.save(&cell);
//! op.forward(&mut cell, &saved)?;
//! op.reverse(&mut cell, &saved)?;
//! assert_eq!(cell.0, 3);
//! # Ok::<(), Failure>(())
//! ```
//!
//! The same where the row says `always`, a class that saves nothing:
//!
//! ```compile_fail,E0277
//! # use obverse_isa::{LocalId, Prefix, op};
//! # use obverse_tape::record::Word;
//! # use obverse_vm::class::{AfterForward, Always, Failure};
//! #
//! # struct Cell(u64);
//! #
//! # impl AfterForward<Cell> for op::StoreLocal {
//! #     type Saved = Word;
//! #
//! #     fn save(&self, cell: &Cell) -> Word {
//! #         Word(cell.0)
//! #     }
//! #
//! #     fn forward(self, cell: &mut Cell, _: &Word) -> Result<(), Failure> {
//! #         cell.0 = 7;
//! #         Ok(())
//! #     }
//! #
//! #     fn reverse(self, cell: &mut Cell, saved: &Word) -> Result<(), Failure> {
//! #         cell.0 = saved.0;
//! #         Ok(())
//! #     }
//! # }
//! #
//! # let op = op::StoreLocal { prefix: Prefix(1), local: LocalId(0) };
//! fn where_the_row_says_always(op: impl Always<Cell>) {}
//! where_the_row_says_always(op);
//! ```
//!
//! Without its reverse:
//!
//! ```compile_fail,E0046
//! # use obverse_isa::{LocalId, Prefix, op};
//! # use obverse_tape::record::Word;
//! # use obverse_vm::class::{AfterForward, Failure};
//! #
//! # struct Cell(u64);
//! impl AfterForward<Cell> for op::StoreLocal {
//!     type Saved = Word;
//!
//!     fn save(&self, cell: &Cell) -> Word {
//!         Word(cell.0)
//!     }
//!
//!     fn forward(self, cell: &mut Cell, _: &Word) -> Result<(), Failure> {
//!         cell.0 = 7;
//!         Ok(())
//!     }
//! }
//! ```
//!
//! With a record of another kind than the row's:
//!
//! ```compile_fail,E0308
//! # use obverse_isa::{LocalId, Prefix, op};
//! # use obverse_tape::record::{Bit, Word};
//! # use obverse_vm::class::{AfterForward, Failure};
//! #
//! # struct Cell(u64);
//! #
//! # impl AfterForward<Cell> for op::StoreLocal {
//! #     type Saved = Word;
//! #
//! #     fn save(&self, cell: &Cell) -> Word {
//! #         Word(cell.0)
//! #     }
//! #
//! #     fn forward(self, cell: &mut Cell, _: &Word) -> Result<(), Failure> {
//! #         cell.0 = 7;
//! #         Ok(())
//! #     }
//! #
//! #     fn reverse(self, cell: &mut Cell, saved: &Word) -> Result<(), Failure> {
//! #         cell.0 = saved.0;
//! #         Ok(())
//! #     }
//! # }
//! #
//! # let op = op::StoreLocal { prefix: Prefix(1), local: LocalId(0) };
//! let cell = Cell(3);
//! // Where the row says `after_forward(Bit)`.
//! let saved: Bit = op.save(&cell);
//! ```
//!
//! A reverse of what has none:
//!
//! ```compile_fail,E0599
//! # use obverse_isa::{ReasonId, op};
//! # use obverse_vm::class::{Failure, Never};
//! #
//! # struct Cell(u64);
//! impl Never<Cell> for op::Barrier {
//!     fn forward(self, cell: &mut Cell) -> Result<(), Failure> {
//!         cell.0 = 7;
//!         Ok(())
//!     }
//! }
//!
//! op::Barrier { reason: ReasonId(0) }.reverse(&mut Cell(3));
//! ```

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
