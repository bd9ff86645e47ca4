//! Faults that become errors of the program.
//!
//! The act that the fault stopped counts as done as far as it came: its record is on the tape, and
//! reversing it takes back what was done of it. The toggle of an output has no record, and is
//! finished first. Which fault becomes which error is not known here.

use crate::machine::Machine;
use crate::state::{Direction, Pending};
use obverse_isa::{ErrorId, Instr};
use obverse_tape::record;
use obverse_workcell::Workcell;

impl Machine<'_> {
    /// Let the fault that stopped the act at hand be an error of the program, which is now pending,
    /// once however often it is raised. Whether it could be: nothing is done unless the program
    /// declares the error and the act can be [passed over](Self::pass_over_fault).
    pub fn raise(&mut self, error: ErrorId, cell: &mut dyn Workcell) -> bool {
        let is_declared = error.index() < self.program.module().errors.len();
        if !is_declared || !self.pass_over_fault(cell) {
            return false;
        }
        let was_pending = self.state.raised.contains(&error);
        if !was_pending {
            self.state.raised.push(error);
        }
        if let Some(tape) = &mut self.tape {
            let steps = self.state.steps();
            record::Fault { error: error.0, was_pending, steps }.push(tape);
        }
        true
    }

    /// Go on behind the act at hand, which a fault has stopped: it counts as done as far as it
    /// came. Whether it could be: nothing is done unless an act of the program itself was stopped
    /// going forward, and the workcell lets a toggle be finished.
    pub fn pass_over_fault(&mut self, cell: &mut dyn Workcell) -> bool {
        let Some(Pending { direction: Direction::Forward, level_before }) = self.state.pending
        else {
            return false;
        };
        if self.state.is_compensating() || !self.toggle(level_before, cell) {
            return false;
        }
        self.executed = self.executed.saturating_add(1);
        self.state.pending = None;
        self.state.depth = 0;
        self.state.place.pc += 1;
        true
    }

    /// Finish the toggle at hand of an output that had this level, if it is one. Whether it is
    /// done.
    fn toggle(&self, level_before: Option<bool>, cell: &mut dyn Workcell) -> bool {
        match (level_before, self.program.module().code[self.state.place.pc]) {
            (Some(level), Instr::OutputToggle { bit, .. }) => {
                self.watch(false, cell);
                cell.output(bit.0) != level || cell.set_output(bit.0, !level).is_ok()
            }
            _ => true,
        }
    }

    /// Going back to where a fault became an error: it is pending no more.
    pub(crate) fn take_back_fault(&mut self) {
        let steps = self.state.steps();
        let Some(tape) = &mut self.tape else { return };
        let Some(fault) = record::Fault::peek(tape).filter(|fault| fault.steps == steps) else {
            return;
        };
        record::Fault::pop(tape);
        if !fault.was_pending && self.state.raised.last() == Some(&ErrorId(fault.error)) {
            self.state.raised.pop();
        }
    }
}
