//! How a run ended.

use obverse_isa::ErrorId;
use obverse_vm::{Direction, Refusal, Trap};
use obverse_workcell::Fault;
use std::fmt;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The program ended.
    Finished,
    /// The program ended with these errors pending: nothing dealt with them.
    Unhandled(Vec<ErrorId>),
    /// An error was given up, and the strategy has nothing else to try: the arm holds.
    GivenUp {
        /// The error.
        error: ErrorId,
        /// Where it was due.
        pc: u32,
        /// Why.
        why: GiveUp,
    },
    /// The run is back where it began.
    AtStart,
    /// Going back stopped at what cannot be taken back.
    Refused(Refusal),
    /// The workcell did not do as commanded.
    Fault {
        /// What happened.
        fault: Fault,
        /// The instruction.
        pc: u32,
        /// Which way the machine was going.
        direction: Direction,
    },
    /// The machine refuses to go on.
    Trap(Trap),
    /// As many instructions as were allowed have been run.
    Budget,
}

/// Why recovering from an error was given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GiveUp {
    /// It has been tried as often as may be.
    Attempts(u32),
    /// It has taken as long as it may, in seconds of the workcell's clock.
    Time(f64),
    /// The arm has gone as far as it may, in metres.
    Distance(f64),
    /// Nothing before the error can be taken back.
    NoWayBack {
        /// What stands in the way, if anything was done before.
        never: Option<u32>,
    },
    /// Going back has been seen not to help.
    WouldNotHelp,
    /// It was given up here before, and the run has not got past it since.
    Before,
    /// Nothing that was tried has got the run any further for so many attempts.
    Stuck(u32),
    /// The way back was blocked, in both directions.
    Blocked,
    /// The program's own sequence follows, and going back was not asked for.
    Explicit,
    /// The program declares nothing that is to be done about it.
    NoRecovery,
    /// The strategy does not recover.
    Strategy,
}

impl GiveUp {
    /// The word for it that machines read.
    #[must_use]
    pub fn code(self) -> &'static str {
        match self {
            Self::Attempts(_) => "attempts",
            Self::Time(_) => "time",
            Self::Distance(_) => "distance",
            Self::NoWayBack { .. } => "no_way_back",
            Self::WouldNotHelp => "would_not_help",
            Self::Before => "given_up_before",
            Self::Stuck(_) => "stuck",
            Self::Blocked => "blocked",
            Self::Explicit => "explicit",
            Self::NoRecovery => "no_recovery",
            Self::Strategy => "strategy",
        }
    }
}

impl fmt::Display for GiveUp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Attempts(1) => write!(f, "it was tried once, and may be no more often"),
            Self::Attempts(times) => {
                write!(f, "it was tried {times} times, and may be no more often")
            }
            Self::Time(limit_s) => write!(f, "it may take no longer than {limit_s} s"),
            Self::Distance(limit_m) => {
                write!(f, "the arm may go no further for it than {limit_m} m")
            }
            Self::NoWayBack { .. } => write!(f, "nothing before it can be taken back"),
            Self::WouldNotHelp => write!(f, "going back has been seen not to help"),
            Self::Before => write!(f, "it was given up here before"),
            Self::Stuck(attempts) => {
                write!(f, "{attempts} attempts in a row have got the run no further")
            }
            Self::Blocked => write!(f, "the way back was blocked"),
            Self::Explicit => write!(f, "what the program itself does about it follows"),
            Self::NoRecovery => write!(f, "the program does nothing about it"),
            Self::Strategy => write!(f, "there is nothing else to try"),
        }
    }
}

impl Ending {
    /// The word for it that machines read.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Unhandled(_) => "unhandled_error",
            Self::GivenUp { .. } => "given_up",
            Self::AtStart => "at_start",
            Self::Refused(_) => "refused",
            Self::Fault { .. } => "fault",
            Self::Trap(_) => "trap",
            Self::Budget => "budget",
        }
    }
}
