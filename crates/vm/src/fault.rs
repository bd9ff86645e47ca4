//! Faults that become errors of the program.
//!
//! The act that the fault stopped counts as done as far as it came: its record is on the tape, and
//! reversing it takes back what was done of it. Which fault becomes which error is not known here.

use crate::machine::Machine;
use crate::state::{Direction, Pending};
use obverse_isa::ErrorId;
use obverse_tape::record;

impl Machine<'_> {
    /// Let the fault that stopped the act at hand be an error of the program, which is now pending.
    /// Whether it could be: nothing is done unless an act of the program itself was stopped going
    /// forward, and the program declares the error.
    pub fn raise(&mut self, error: ErrorId) -> bool {
        let is_forward =
            matches!(self.state.pending, Some(Pending { direction: Direction::Forward, .. }));
        let is_declared = error.index() < self.program.module().errors.len();
        if !is_forward || !is_declared || self.state.is_compensating() {
            return false;
        }
        self.executed = self.executed.saturating_add(1);
        self.state.pending = None;
        self.state.depth = 0;
        self.state.place.pc += 1;
        self.state.raised.push(error);
        if let Some(tape) = &mut self.tape {
            record::Fault { error: error.0, steps: self.state.steps() }.push(tape);
        }
        true
    }

    /// Going back to where a fault became an error: it is pending no more.
    pub(crate) fn take_back_fault(&mut self) {
        let steps = self.state.steps();
        let Some(tape) = &mut self.tape else { return };
        let Some(fault) = record::Fault::peek(tape).filter(|fault| fault.steps == steps) else {
            return;
        };
        record::Fault::pop(tape);
        if self.state.raised.last() == Some(&ErrorId(fault.error)) {
            self.state.raised.pop();
        }
    }
}
