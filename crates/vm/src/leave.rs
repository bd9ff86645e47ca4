//! Leaving all that is under way for the cleanup, where the code has no way there of its own.
//!
//! The tape keeps the whole state that was left, so that going back leads into it again, an act
//! that was half done included. When a run is left is not known here.

use crate::machine::Machine;
use crate::stop::{Stop, Trap, TrapKind};
use obverse_bytecode::Module;
use obverse_isa::Instr;
use obverse_tape::Tape;
use obverse_workcell::Workcell;

impl Machine<'_> {
    /// Leave all calls, forks and blocks under way, and go on where the cleanup begins, with the
    /// settings that the program began with. Errors that are pending stay so. Whether it could be:
    /// nothing is done where the program has no cleanup, or is in it.
    pub fn leave(&mut self, cell: &dyn Workcell) -> bool {
        let begins = begins(self.program.module());
        let Some(begins) = begins.filter(|_| !self.is_cleaning_up()) else { return false };
        self.leave_compensations();
        let left = self.state_as_data(cell);
        if let Some(tape) = &mut self.tape {
            tape.leave(left);
        }
        let steps = self.state.steps();
        let state = &mut self.state;
        state.frames.truncate(1);
        state.forks.clear();
        state.pending = None;
        state.depth = 0;
        state.open_blocks = 0;
        state.settings = self.links.settings;
        state.place.stand_at(begins, steps + 1);
        self.executed = self.executed.saturating_add(1);
        true
    }

    /// Whether the cleanup is under way.
    #[must_use]
    pub fn is_cleaning_up(&self) -> bool {
        let cleanup = self.program.module().cleanup;
        let called = self.state.frames.get(1).map(|frame| frame.function);
        called.is_some() && called == cleanup
    }

    /// How many steps there were when all was left for the cleanup, if it was.
    pub(crate) fn came_from_leaving(&self) -> Option<u64> {
        self.tape.as_ref()?.left_steps().map(|steps| steps.wrapping_add(1))
    }

    /// Going back to where all was left: it is under way again. Whether that was the step.
    pub(crate) fn come_back(&mut self) -> Result<bool, Stop> {
        if self.came_from_leaving() != Some(self.state.steps()) {
            return Ok(false);
        }
        let Some(left) = self.tape.as_mut().and_then(Tape::take_left) else {
            return Ok(false);
        };
        let trap = Trap { pc: self.state.pc(), kind: TrapKind::Foreign };
        self.stand_as(&left).map(|()| true).map_err(|_| Stop::Trap(trap))
    }
}

/// Where the start begins the cleanup: with what it does about errors before the call, which lies
/// under the same words of the source.
fn begins(module: &Module) -> Option<usize> {
    let cleanup = module.cleanup?;
    let start = module.functions.first()?;
    let is_call = |at: &u32| {
        let instr = module.code.get(*at as usize);
        matches!(instr, Some(Instr::Call { function, .. }) if function.0 == cleanup)
    };
    let call = (start.first..start.end).find(is_call)?;
    let prefix = u32::from(module.code[call as usize].prefix());
    let entry = module.source_at(call).map_or(call - prefix, |entry| entry.first);
    Some(entry.max(start.first + 1) as usize)
}
