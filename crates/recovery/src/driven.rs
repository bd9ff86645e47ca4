//! What a recovery drives: a machine and its workcell, or a run that records how they are driven.
//!
//! Knows what can be asked of them, and nothing of when it is.

use obverse_isa::ErrorId;
use obverse_tape::Note;
use obverse_vm::{Alteration, Direction, Limits, Machine, Mark, Observer, Stop};
use obverse_workcell::{Fault, Motion, Workcell};

/// A machine and its workcell, as a recovery drives them.
pub trait Driven<'p, C> {
    /// The machine.
    fn machine(&self) -> &Machine<'p>;

    /// The workcell.
    fn cell(&self) -> &C;

    /// In a direction until something stops it, for about so many instructions.
    fn run(&mut self, direction: Direction, instructions: u64, observer: &mut dyn Observer)
    -> Stop;

    /// One step forward.
    ///
    /// # Errors
    /// Why no step was made, or what the step led to.
    fn step(&mut self, observer: &mut dyn Observer) -> Result<(), Stop>;

    /// In reverse to a mark.
    fn reverse_to(&mut self, mark: Mark, observer: &mut dyn Observer) -> Stop;

    /// Back to a mark in the program alone.
    ///
    /// # Errors
    /// Why it cannot be taken back as far.
    fn unwind_to(&mut self, mark: Mark) -> Result<(), Stop>;

    /// From here on otherwise than the program says, or no longer.
    fn alter(&mut self, alteration: Option<Alteration>);

    /// Let the fault that stopped the act at hand be an error of the program. Whether it could be.
    fn raise(&mut self, error: ErrorId) -> bool;

    /// Go on behind the act at hand, which a fault has stopped. Whether it could be.
    fn pass_over_fault(&mut self) -> bool;

    /// Leave all that is under way for the cleanup. Whether it could be.
    fn leave(&mut self) -> bool;

    /// Note on the tape what happened.
    fn note(&mut self, note: Note);

    /// Command a motion beside the program, for which nothing is watched.
    ///
    /// # Errors
    /// What the workcell did otherwise.
    fn execute(&mut self, motion: &Motion) -> Result<(), Fault>;

    /// What was noticed of an error's conditions was taken back: what of them holds still is to be
    /// noticed again.
    fn watch_again(&mut self, number: u16);

    /// Give the fresh command without which nothing moves after a stop.
    fn release(&mut self);
}

/// A machine and its workcell themselves.
pub struct Direct<'d, 'p, C> {
    /// The machine.
    pub machine: &'d mut Machine<'p>,
    /// The workcell.
    pub cell: &'d mut C,
}

impl<'p, C: Workcell> Driven<'p, C> for Direct<'_, 'p, C> {
    fn machine(&self) -> &Machine<'p> {
        self.machine
    }

    fn cell(&self) -> &C {
        self.cell
    }

    fn run(
        &mut self,
        direction: Direction,
        instructions: u64,
        observer: &mut dyn Observer,
    ) -> Stop {
        self.machine.run(direction, Limits::instructions(instructions), self.cell, observer)
    }

    fn step(&mut self, observer: &mut dyn Observer) -> Result<(), Stop> {
        self.machine.step(Direction::Forward, self.cell, observer)
    }

    fn reverse_to(&mut self, mark: Mark, observer: &mut dyn Observer) -> Stop {
        self.machine.reverse_to(mark, self.cell, observer)
    }

    fn unwind_to(&mut self, mark: Mark) -> Result<(), Stop> {
        self.machine.unwind_to(mark, self.cell)
    }

    fn alter(&mut self, alteration: Option<Alteration>) {
        self.machine.alter(alteration);
    }

    fn raise(&mut self, error: ErrorId) -> bool {
        self.machine.raise(error, self.cell)
    }

    fn pass_over_fault(&mut self) -> bool {
        self.machine.pass_over_fault(self.cell)
    }

    fn leave(&mut self) -> bool {
        self.machine.leave(self.cell)
    }

    fn note(&mut self, note: Note) {
        self.machine.note(note);
    }

    fn execute(&mut self, motion: &Motion) -> Result<(), Fault> {
        self.cell.watch(&[]);
        self.cell.execute(motion).map(|_| ())
    }

    fn watch_again(&mut self, number: u16) {
        self.cell.watch_again(number);
    }

    fn release(&mut self) {
        self.cell.release();
    }
}
