//! Going in reverse over blocks with a reverse of their own: those that are passed over, and those
//! that a function takes the place of.
//!
//! The program's state goes back as through any other code, and the workcell is commanded nothing
//! meanwhile. Knows nothing of how an instruction is undone.

use crate::hot::Exit;
use crate::machine::Machine;
use crate::state::{Compensation, Direction, Frame, MAX_FRAMES, State};
use crate::step::{Host, Outcome};
use crate::stop::{Stop, Trap, TrapKind};
use obverse_isa::{FunctionId, Instr};

impl Machine<'_> {
    /// The function that ran in place of a block's reversal is done: what it did to the program's
    /// state goes, and then what the block did.
    pub(crate) fn end_compensation(
        &mut self,
        running: Compensation,
        host: &mut Host<'_>,
    ) -> Outcome {
        let innermost = self.state.frames.last().map_or(0, |frame| usize::from(frame.function));
        let first = self.program.module().functions[innermost].first as usize;
        self.reverse_muted(first, host)?;
        self.state.frames.pop();
        self.state.compensations.pop();
        self.state.place = running.place;
        let end = running.place.pc - 1;
        match self.program.module().code[end] {
            Instr::BlockReplace { from, .. } => self.pass_over(end, from.index(), host),
            _ => Ok(()),
        }
    }

    /// Going in reverse over a block with a reverse of its own: the program's state goes back step
    /// by step, and the workcell is commanded nothing. Nothing of a run's own can stop that, so it
    /// is one step.
    pub(crate) fn pass_over(&mut self, end: usize, begin: usize, host: &mut Host<'_>) -> Outcome {
        self.state.open_blocks += 1;
        self.state.place.pc = end;
        if self.is_muted {
            return Ok(());
        }
        self.reverse_muted(begin, host)?;
        self.slow_reverse(host)
    }

    /// Reverse, commanding nothing, until the instruction before this place in this frame is met.
    fn reverse_muted(&mut self, until: usize, host: &mut Host<'_>) -> Outcome {
        let depth = |state: &State| (state.frames.len(), state.forks.len());
        let outer = depth(&self.state);
        let is_there = |state: &State| state.place.pc == until + 1 && depth(state) == outer;
        let floor = self.state.steps().saturating_sub(self.believed_steps);
        self.is_muted = true;
        let mut outcome = Ok(());
        while outcome.is_ok() && !is_there(&self.state) {
            outcome = match self.hot_reverse::<false>(floor) {
                Exit::Trap(at, kind) => Err(self.trapped(at, kind)),
                // A count that went below nothing, as one that was tampered with can, is below it.
                Exit::Bound if self.state.steps().cast_signed() <= floor.cast_signed() => {
                    Err(self.trapped(until, TrapKind::Foreign))
                }
                Exit::Slow if !is_there(&self.state) => self.slow_reverse(host),
                _ => Ok(()),
            };
        }
        self.is_muted = false;
        outcome
    }

    /// Going in reverse into a block that another one takes the place of: call that one.
    pub(crate) fn compensate(
        &mut self,
        at: usize,
        function: FunctionId,
        host: &mut Host<'_>,
    ) -> Outcome {
        if self.state.call_count() >= MAX_FRAMES {
            return Err(Stop::Trap(Trap { pc: at as u32, kind: TrapKind::CallDepth }));
        }
        if self.tape.is_none() {
            return Err(Stop::Trap(Trap { pc: at as u32, kind: TrapKind::NoTape }));
        }
        let declared = &self.program.module().functions[function.index()];
        self.state
            .compensations
            .push(Compensation { frames: self.state.frames.len() + 1, place: self.state.place });
        let mut frame = Frame::new(function.0, declared, at as u32 + 1);
        if let Some(around) = self.state.frames.last() {
            frame.begin_with(around, &self.program.module().functions);
        }
        self.state.frames.push(frame);
        self.state.place.pc = at;
        self.state.place.jump_forward(declared.first as usize);
        self.tell(Direction::Reverse, at, None, host);
        Ok(())
    }
}
