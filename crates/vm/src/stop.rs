//! Why a machine stopped.

use obverse_isa::{ErrorId, ReasonId};
use obverse_workcell::Fault;

use crate::state::Direction;

/// Why a run stopped.
#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    /// Going forward, the program ended.
    Finished,
    /// Going in reverse, it is back where it began.
    AtStart,
    /// Going in reverse, it is where it was asked to go back to.
    AtMark,
    /// Going in reverse, it is before the mark, or behind it from the start: the mark lies in a
    /// block that was passed over, within a statement, or in another history.
    OffMark,
    /// So many steps as it was given have been made.
    Budget,
    /// The program raised an error, which is now pending; going on goes on behind it.
    Raised {
        /// The error.
        error: ErrorId,
        /// The instruction that raised it.
        pc: u32,
    },
    /// An error that is pending is responded to here; going on means that going back was given up.
    Due {
        /// The error.
        error: ErrorId,
        /// The instruction that says so.
        pc: u32,
    },
    /// The workcell did not do as commanded: the act is pending, and may be done again in either
    /// direction.
    Fault {
        /// What happened.
        fault: Fault,
        /// The instruction.
        pc: u32,
        /// Which way it was going.
        direction: Direction,
    },
    /// Going in reverse, it met an instruction that cannot be taken back, and changed nothing.
    Refused(Refusal),
    /// The machine refuses to go on.
    Trap(Trap),
}

/// Why the machine will not go back over an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The instruction.
    pub pc: u32,
    /// Why such an instruction cannot be taken back.
    pub why: &'static str,
    /// The program's own reason.
    pub reason: Option<ReasonId>,
}

/// The machine refuses to go on; the statement that it stands before has not begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trap {
    /// The instruction.
    pub pc: u32,
    /// Why.
    pub kind: TrapKind,
}

/// What makes a machine refuse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrapKind {
    /// A division by zero, or a remainder by zero.
    DivisionByZero,
    /// A real that is no integer of 64 bits.
    NotAnInteger,
    /// An assertion of a join contradicts the way that led to it.
    Assertion {
        /// Whether the join was reached by its jump.
        by_jump: bool,
    },
    /// A condition that must hold does not.
    Required(ReasonId),
    /// Too many calls are under way.
    CallDepth,
    /// An item has no such keyframe.
    NoKeyframe,
    /// A time to wait that is negative, or no number.
    NotADuration,
    /// A limit of a force that is not above zero, or no number.
    NotAForceLimit,
    /// The tape holds as much as it may.
    TapeFull,
    /// A record that must be on the tape is not: the tape belongs to another run.
    TapeEmpty,
    /// A variable holds what no run of the program can have put there.
    Foreign,
    /// The machine was made without a tape and cannot go back.
    NoTape,
}

impl std::fmt::Display for TrapKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::DivisionByZero => write!(f, "division by zero"),
            Self::NotAnInteger => {
                write!(f, "the number is outside the integers, or is not a number")
            }
            Self::Assertion { by_jump: true } => {
                write!(
                    f,
                    "the assertion of this join is false, and the way that led here says true"
                )
            }
            Self::Assertion { by_jump: false } => {
                write!(
                    f,
                    "the assertion of this join is true, and the way that led here says false"
                )
            }
            Self::Required(_) => write!(f, "a condition that must hold does not"),
            Self::CallDepth => {
                write!(f, "more than {} calls are under way", crate::state::MAX_FRAMES)
            }
            Self::NotADuration => write!(f, "the time to wait is negative, or no number"),
            Self::NotAForceLimit => {
                write!(f, "the limit of a force is not above zero, or no number")
            }
            Self::NoKeyframe => write!(f, "the item has no such keyframe"),
            Self::TapeFull => {
                write!(f, "the tape holds as much as it may; a barrier would empty it")
            }
            Self::TapeEmpty => write!(f, "a record is missing: the tape belongs to another run"),
            Self::Foreign => {
                write!(f, "a variable holds no value of its type: the tape was changed")
            }
            Self::NoTape => write!(f, "this run keeps no tape, so there is no way back"),
        }
    }
}
