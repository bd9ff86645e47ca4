//! A run that goes on from every error as the code says, and never goes back by itself.

use crate::driven::{Direct, Driven};
use crate::ending::Ending;
use obverse_vm::{Direction, Limits, Machine, Observer, Stop};
use obverse_workcell::Workcell;

/// Run a program in a direction until it ends.
pub fn drive<C: Workcell>(
    machine: &mut Machine<'_>,
    direction: Direction,
    limits: Limits,
    cell: &mut C,
    observer: &mut dyn Observer,
) -> Ending {
    drive_in(&mut Direct { machine, cell }, direction, limits, observer)
}

/// The same, of a machine and a workcell that are driven in a way of their own.
pub fn drive_in<C: Workcell>(
    driven: &mut dyn Driven<'_, C>,
    direction: Direction,
    limits: Limits,
    observer: &mut dyn Observer,
) -> Ending {
    let begin = driven.machine().executed();
    loop {
        let left = limits.instructions.saturating_sub(driven.machine().executed() - begin);
        let stop = driven.run(direction, left, observer);
        if let Some(ending) = ending(stop, driven.machine()) {
            return ending;
        }
    }
}

/// How a run ended that stopped; none if it goes on from there.
#[must_use]
pub fn ending(stop: Stop, machine: &Machine<'_>) -> Option<Ending> {
    Some(match stop {
        Stop::Raised { .. } | Stop::Due { .. } => return None,
        Stop::Finished if machine.state().raised().is_empty() => Ending::Finished,
        Stop::Finished => Ending::Unhandled(machine.state().raised().to_vec()),
        Stop::AtStart | Stop::AtMark | Stop::OffMark => Ending::AtStart,
        Stop::Budget => Ending::Budget,
        Stop::Fault { fault, pc, direction } => Ending::Fault { fault, pc, direction },
        Stop::Refused(refusal) => Ending::Refused(refusal),
        Stop::Trap(trap) => Ending::Trap(trap),
    })
}
