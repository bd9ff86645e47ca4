//! Forks: whose turn it is, as the machine has it.
//!
//! Turns end with acts, whatever the acts lead to, so that branches are followed in the one order
//! in which the machine runs them. What is done is noted in that order too, and the machine takes
//! turns back as they were: going back knows nothing of forks.

use crate::explore::Explorer;
use crate::state::{Frame, State, Word};
use obverse_isa::Instr;
use obverse_vm::MAX_FORKS;

/// A fork that is open.
#[derive(Clone, Debug)]
pub(crate) struct Fork {
    at: u32,
    /// How many calls are around it.
    base: usize,
    /// How many blocks with a reverse of their own are around it.
    blocks: usize,
    /// Whose turn it is.
    current: usize,
    /// One a branch. That whose turn it is has nothing of its own here.
    pub(crate) tasks: Vec<Task>,
}

/// A task that waits for its turn.
#[derive(Clone, Debug, Default)]
pub(crate) struct Task {
    pc: usize,
    is_done: bool,
    /// Its calls, outermost first.
    pub(crate) frames: Vec<Frame>,
}

impl Fork {
    /// The next task that has not come to its end, other than the one whose turn it is.
    fn next(&self) -> Option<usize> {
        let count = self.tasks.len();
        let mut others = (1..count).map(|step| (self.current + step) % count);
        others.find(|&task| !self.tasks[task].is_done)
    }

    /// Where it is and where its tasks wait, through which calls.
    pub(crate) fn add_place(&self, place: &mut Vec<usize>) {
        place.extend([usize::MAX, self.at as usize, self.base, self.current]);
        for task in &self.tasks {
            place.extend([task.pc, usize::from(task.is_done), task.frames.len()]);
            place.extend(task.frames.iter().map(|frame| frame.return_pc));
        }
    }
}

impl Explorer<'_> {
    /// Do an instruction of the family of forks.
    pub(crate) fn task(&mut self, mut state: State, instr: Instr) -> Option<State> {
        match instr {
            Instr::Fork { .. } => self.fork(state),
            Instr::ForkLeave { join } => {
                let fork = state.forks.pop()?;
                state.frames.truncate(fork.base);
                state.pc = join.index() + 1;
                self.meet(state)
            }
            _ => {
                state.pc += 1;
                let fork = state.forks.last_mut()?;
                fork.tasks[fork.current].is_done = true;
                self.pass_turn(state)
            }
        }
    }

    fn fork(&mut self, mut state: State) -> Option<State> {
        let at = state.pc as u32;
        let branches = self.branches.get(&at)?;
        if state.forks.len() >= MAX_FORKS {
            return None;
        }
        let started = |&(first, _): &(u32, u32)| Task { pc: first as usize, ..Task::default() };
        let mut tasks: Vec<Task> = branches.ends.iter().map(started).collect();
        tasks[0] = Task::default();
        let (base, blocks) = (state.frames.len(), state.blocks.len());
        state.forks.push(Fork { at, base, blocks, current: 0, tasks });
        self.pass(state)
    }

    /// Do an effect other than flow; the turn ends with it if it was an act.
    pub(crate) fn act_in_turn(
        &mut self,
        state: State,
        instr: Instr,
        operands: &[Word],
    ) -> Option<State> {
        let is_turn = !state.forks.is_empty() && instr.ends_turn();
        let open = self.open.len();
        let state = self.act(state, instr, operands);
        if !is_turn {
            return state;
        }
        for other in self.open.split_off(open) {
            let other = self.end_turn(other);
            self.open.extend(other);
        }
        self.end_turn(state?)
    }

    /// The turn ends unless something holds the other tasks.
    fn end_turn(&mut self, mut state: State) -> Option<State> {
        let fork = state.forks.last()?;
        let is_read = self.values.module.code[state.pc].reads_motion();
        if is_read || fork.next().is_none() || state.blocks.len() != fork.blocks {
            return Some(state);
        }
        match state.raised.as_ref().map(Vec::is_empty) {
            Some(true) => self.pass_turn(state),
            Some(false) => Some(state),
            None => {
                state.is_certain = false;
                let held = self.copy(&state);
                self.open.push(held);
                self.pass_turn(state)
            }
        }
    }

    /// Let the next task go on, or all come together.
    fn pass_turn(&mut self, mut state: State) -> Option<State> {
        let fork = state.forks.last_mut()?;
        let Some(next) = fork.next() else {
            let join = self.branches.get(&fork.at)?.join;
            state.forks.pop();
            state.pc = join as usize + 1;
            return self.meet(state);
        };
        let own = state.frames.split_off(fork.base);
        let current = &mut fork.tasks[fork.current];
        (current.pc, current.frames) = (state.pc, own);
        let waiting = &mut fork.tasks[next];
        state.frames.append(&mut waiting.frames);
        state.pc = std::mem::take(&mut waiting.pc);
        fork.current = next;
        Some(state)
    }

    /// It is not known any more whose turn it is: all that the branches may do is not followed,
    /// until they come together.
    pub(crate) fn lose_turns(&mut self, mut state: State) -> Option<State> {
        let fork = state.forks.drain(..).next()?;
        let join = self.branches.get(&fork.at)?.join;
        state.frames.truncate(fork.base);
        state.blocks.truncate(fork.blocks);
        state.frame_mut().forget();
        let mut state = self.leave_unfollowed(state, fork.at..join);
        state.pc = join as usize + 1;
        self.meet(state)
    }
}
