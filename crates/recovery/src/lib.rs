//! Driving a machine through a program: what happens when an error is raised or something fails.
//!
//! Recovery owns the loop and asks the machine to step; the machine never calls up. It alone
//! decides how a run goes on after an error; it knows nothing of how motions, tapes or source texts
//! work. At present the recovery sequences that a program names run as part of its code, so that a
//! raised error is noted and gone on from; policies of reversal are carried in the module.

use obverse_isa::ErrorId;
use obverse_vm::{Direction, Limits, Machine, Observer, Refusal, Stop, Trap};
use obverse_workcell::{Fault, Workcell};

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The program ended.
    Finished,
    /// The program ended with these errors pending: nothing dealt with them.
    Unhandled(Vec<ErrorId>),
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

impl Ending {
    /// The word for it that machines read.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Unhandled(_) => "unhandled_error",
            Self::AtStart => "at_start",
            Self::Refused(_) => "refused",
            Self::Fault { .. } => "fault",
            Self::Trap(_) => "trap",
            Self::Budget => "budget",
        }
    }
}

/// Run a program in a direction until it ends.
pub fn drive(
    machine: &mut Machine<'_>,
    direction: Direction,
    limits: Limits,
    cell: &mut dyn Workcell,
    observer: &mut dyn Observer,
) -> Ending {
    let begin = machine.executed();
    loop {
        let left = limits.instructions.saturating_sub(machine.executed() - begin);
        return match machine.run(direction, Limits::instructions(left), cell, observer) {
            // What follows the raise in the code is what happens once reversal has been given up.
            Stop::Raised { .. } => continue,
            Stop::Finished if machine.state().raised().is_empty() => Ending::Finished,
            Stop::Finished => Ending::Unhandled(machine.state().raised().to_vec()),
            Stop::AtStart | Stop::AtMark | Stop::OffMark => Ending::AtStart,
            Stop::Budget => Ending::Budget,
            Stop::Fault { fault, pc, direction } => Ending::Fault { fault, pc, direction },
            Stop::Refused(refusal) => Ending::Refused(refusal),
            Stop::Trap(trap) => Ending::Trap(trap),
        };
    }
}
