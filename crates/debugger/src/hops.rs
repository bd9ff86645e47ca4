//! A live run as a recovery drives it: recorded, and hop by hop, so that between any two of them it
//! can be looked at and halted. What is decided in a recovery is not known here.

use crate::drive::{Driven, Pace};
use crate::recording::Order;
use crate::run::{Live, Run};
use obverse_isa::ErrorId;
use obverse_recovery as recovery;
use obverse_tape::Note;
use obverse_vm::{Alteration, Direction, Event, Machine, Mark, Observer, Stop, Stops};
use obverse_workcell::{Arm, Fault, Motion, Watching, Workcell};
use std::sync::atomic::{AtomicBool, Ordering};

/// How many instructions a live run makes at once, at the most: as often it can be interrupted.
const BURST: u64 = 1 << 18;
/// The same where it has something to tell, as every command is told: that takes longer.
const SLOW_BURST: u64 = 256;

/// A live run, driven hop by hop: a run forward comes back at a stop, a run in reverse behind
/// every step, as if as many instructions had been made as were allowed.
pub(crate) struct Hops<'r, 'p, C> {
    live: Live<'r, 'p, C>,
    /// Where a hop forward ends; none if everywhere.
    stops: Option<&'r Stops>,
    /// Raised, it ends a hop.
    interrupt: &'r AtomicBool,
}

impl<'r, 'p, C: Workcell> Hops<'r, 'p, C> {
    /// Of a run; none of a recording.
    pub(crate) fn of(
        run: &'r mut Run<'p, C>,
        stops: Option<&'r Stops>,
        interrupt: &'r AtomicBool,
    ) -> Option<Self> {
        run.live().map(|live| Self { live, stops, interrupt })
    }

    fn drive(&mut self, order: Order, pace: Pace<'_>, observer: &mut dyn Observer) -> Driven {
        self.live.drive(order, pace, observer)
    }

    /// Whether something was done by an order that takes one step.
    fn does(&mut self, order: Order) -> bool {
        self.drive(order, Pace::Step, &mut ()).ticks > 0
    }

    fn is_at_stop(&self) -> bool {
        let pc = self.live.past.machine.state().pc();
        self.stops.is_some_and(|stops| stops.has(pc))
    }

    fn forward(&mut self, instructions: u64, observer: &mut dyn Observer) -> Stop {
        let until = self.live.past.recording.end.after(instructions);
        let mut most = SLOW_BURST;
        loop {
            let is_close = self.is_at_stop() || self.live.past.machine.state().is_compensating();
            let pace = match self.stops {
                Some(stops) if !is_close => Pace::To(stops, most.min(instructions)),
                _ => Pace::Step,
            };
            let is_step = matches!(pace, Pace::Step);
            let mut heard = Heard { observer, is_told: false };
            let driven = self.drive(Order::Forward, pace, &mut heard);
            most = if heard.is_told { SLOW_BURST } else { BURST.min(most * 2) };
            if let Some(stop) = driven.stop {
                return stop;
            }
            let is_over = is_step || self.live.past.recording.end >= until;
            if is_over || self.interrupt.load(Ordering::Relaxed) || self.is_at_stop() {
                return Stop::Budget;
            }
        }
    }

    /// Where a machine is that goes back to a mark, if it is there, or past it.
    fn at(&self, mark: Mark) -> Option<Stop> {
        let state = self.live.past.machine.state();
        match state.steps() == mark.steps() {
            _ if state.steps() > mark.steps() || state.is_compensating() => None,
            true => Some(Stop::AtMark),
            false => Some(Stop::OffMark),
        }
    }
}

/// Who is told of a run, and whether anything was.
struct Heard<'o> {
    observer: &'o mut dyn Observer,
    is_told: bool,
}

impl Observer for Heard<'_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        self.is_told = true;
        self.observer.on_event(event, cell);
    }
}

impl<'p, C: Workcell> recovery::Driven<'p, C> for Hops<'_, 'p, C> {
    fn machine(&self) -> &Machine<'p> {
        &self.live.past.machine
    }

    fn cell(&self) -> &C {
        self.live.cell
    }

    fn run(
        &mut self,
        direction: Direction,
        instructions: u64,
        observer: &mut dyn Observer,
    ) -> Stop {
        match direction {
            Direction::Forward => self.forward(instructions, observer),
            Direction::Reverse => {
                self.drive(Order::Reverse, Pace::Step, observer).stop.unwrap_or(Stop::Budget)
            }
        }
    }

    fn step(&mut self, observer: &mut dyn Observer) -> Result<(), Stop> {
        self.drive(Order::Forward, Pace::Step, observer).stop.map_or(Ok(()), Err)
    }

    fn reverse_to(&mut self, mark: Mark, observer: &mut dyn Observer) -> Stop {
        if let Some(there) = self.at(mark) {
            return there;
        }
        let stop = self.drive(Order::Reverse, Pace::Step, observer).stop;
        stop.or_else(|| self.at(mark)).unwrap_or(Stop::Budget)
    }

    fn unwind_to(&mut self, mark: Mark) -> Result<(), Stop> {
        while self.live.past.machine.state().steps() > mark.steps() {
            let stop = self.drive(Order::Unwind, Pace::Step, &mut ()).stop;
            stop.map_or(Ok(()), Err)?;
        }
        Ok(())
    }

    fn alter(&mut self, alteration: Option<Alteration>) {
        self.drive(Order::Alter(alteration), Pace::Step, &mut ());
    }

    fn raise(&mut self, error: ErrorId) -> bool {
        self.does(Order::Raise(error))
    }

    fn pass_over_fault(&mut self) -> bool {
        self.does(Order::PassOver)
    }

    fn leave(&mut self) -> bool {
        self.does(Order::Leave)
    }

    fn note(&mut self, note: Note) {
        self.live.note(note);
    }

    fn execute(&mut self, motion: &Motion) -> Result<(), Fault> {
        self.live.beside(|recorder| {
            recorder.watch(&[]);
            recorder.execute(motion).map(|_| ())
        })
    }

    fn watch_again(&mut self, number: u16) {
        self.live.beside(|recorder| recorder.watch_again(number));
    }

    fn release(&mut self) {
        self.live.release();
    }
}
