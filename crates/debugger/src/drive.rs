//! The machine driven by one order, with the clock of a recording kept.
//!
//! The run that is recorded and the one that shows it again go through here, so that a moment is
//! the same in both: the clock counts instructions, and an act that failed or had failed before as
//! at least one.

use crate::recording::Order;
use obverse_vm::{Direction, Limits, Machine, Observer, Stop, Stops};
use obverse_workcell::Workcell;

/// How far to go before looking again.
#[derive(Clone, Copy, Debug)]
pub enum Pace<'s> {
    /// One step.
    Step,
    /// About so many instructions.
    Run(u64),
    /// About so many instructions, and forward no further than to a stop.
    To(&'s Stops, u64),
    /// About so many instructions forward, telling at each stop, and no further than to one where
    /// the workcell is asked or commanded.
    Past(&'s Stops, u64),
}

/// What came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Driven {
    /// By how much the clock went on.
    pub ticks: u64,
    /// Why it is not to go on, if it is not.
    pub stop: Option<Stop>,
}

/// Drive a machine by an order.
pub fn drive(
    machine: &mut Machine<'_>,
    order: Order,
    pace: Pace<'_>,
    cell: &mut dyn Workcell,
    observer: &mut dyn Observer,
) -> Driven {
    let before = machine.executed();
    let was_pending = machine.state().pending().is_some();
    // What was begun and not finished is a moment of its own, however far is gone after it; and a
    // statement that traps leads back to its beginning, which may lie before this.
    let is_within = order == Order::Forward && !machine.state().operands().is_empty();
    let pace = if was_pending || is_within { Pace::Step } else { pace };
    let stop = match order {
        Order::Forward => go(machine, Direction::Forward, pace, cell, observer),
        Order::Reverse => go(machine, Direction::Reverse, pace, cell, observer),
        Order::Unwind => machine.unwind(cell).err(),
        Order::Raise(error) => {
            machine.raise(error, cell);
            None
        }
        Order::PassOver => {
            machine.pass_over_fault(cell);
            None
        }
        Order::Leave => {
            machine.leave(cell);
            None
        }
        // Notes are the recording's to give.
        Order::Note(_) => None,
        Order::Alter(alteration) => {
            machine.alter(alteration);
            None
        }
        Order::Change => return Driven { ticks: 1, stop: None },
        Order::SetGlobal(global, value) => {
            machine.set_global(global, value);
            return Driven { ticks: 1, stop: None };
        }
        Order::SetLocal(frame, local, value) => {
            machine.set_local(frame as usize, local, value);
            return Driven { ticks: 1, stop: None };
        }
    };
    let ticks = machine.executed() - before;
    let is_act = matches!(order, Order::Forward | Order::Reverse | Order::Unwind);
    let is_fault = matches!(stop, Some(Stop::Fault { .. }));
    let ticks = match (was_pending && is_act, is_fault) {
        (true, _) => ticks.max(1),
        (false, true) => ticks + 1,
        (false, false) => ticks,
    };
    Driven { ticks, stop }
}

fn go(
    machine: &mut Machine<'_>,
    direction: Direction,
    pace: Pace<'_>,
    cell: &mut dyn Workcell,
    observer: &mut dyn Observer,
) -> Option<Stop> {
    match pace {
        Pace::To(stops, instructions) if direction == Direction::Forward => {
            machine.run_to(stops, Limits::instructions(instructions), cell, observer)
        }
        Pace::Past(stops, instructions) if direction == Direction::Forward => {
            machine.run_past(stops, Limits::instructions(instructions), cell, observer)
        }
        Pace::Run(instructions) => {
            Some(machine.run(direction, Limits::instructions(instructions), cell, observer))
        }
        Pace::Step | Pace::To(..) | Pace::Past(..) => machine.step(direction, cell, observer).err(),
    }
    .filter(|stop| *stop != Stop::Budget)
}
