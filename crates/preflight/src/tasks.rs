//! Forks: whose turn it is, as the machine has it.
//!
//! Turns end with acts, whatever the acts lead to, and tasks that wait are passed over until their
//! time has come. As long as that is known, branches are followed in the one order in which the
//! machine runs them; where it is not, in every order that there may be. What is done is noted in
//! that order too, and the machine takes turns back as they were: going back knows nothing of
//! forks.

use crate::explore::Explorer;
use crate::state::{Frame, State, Word};
use obverse_isa::Instr;
use obverse_vm::{Branches, MAX_FORKS, convert, is_turn_of_motion};

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
    /// How much time has passed in it, in nanoseconds.
    passed_ns: Word,
    /// One a branch. That whose turn it is has nothing of its own here.
    pub(crate) tasks: Vec<Task>,
}

/// A task that waits for its turn.
#[derive(Clone, Debug)]
pub(crate) struct Task {
    pc: usize,
    is_done: bool,
    /// How long it still waits, in nanoseconds.
    rest_ns: Word,
    /// Its calls, outermost first.
    pub(crate) frames: Vec<Frame>,
}

impl Fork {
    /// The tasks that have not come to their end, from the one after that whose turn it is on, and
    /// that last.
    fn undone(&self) -> impl Iterator<Item = usize> {
        let count = self.tasks.len();
        let all = (1..=count).map(move |step| (self.current + step) % count);
        all.filter(|&task| !self.tasks[task].is_done)
    }

    /// Whether other tasks go on while that waits whose turn it is.
    fn has_others(&self) -> bool {
        self.undone().any(|task| task != self.current)
    }

    /// The times that it keeps.
    pub(crate) fn times(&self) -> impl Iterator<Item = &Word> {
        self.tasks.iter().map(|task| &task.rest_ns).chain([&self.passed_ns])
    }

    /// The same, to change them.
    pub(crate) fn times_mut(&mut self) -> impl Iterator<Item = &mut Word> {
        self.tasks.iter_mut().map(|task| &mut task.rest_ns).chain([&mut self.passed_ns])
    }

    /// So much time passes, if it is known how much.
    fn pass(&mut self, took_ns: Word) {
        let passed = self.passed_ns.zip(took_ns);
        self.passed_ns = passed.map(|(passed, took)| passed.saturating_add(took));
        for task in &mut self.tasks {
            task.rest_ns = match (task.rest_ns, took_ns) {
                (Some(0), _) => Some(0),
                (rest, took) => rest.zip(took).map(|(rest, took)| rest.saturating_sub(took)),
            };
        }
    }

    /// Let time pass until a task is ready, and say whose turn may be next: none if no task goes
    /// on, and several if it is not known who is ready.
    fn wait(&mut self, branches: &Branches) -> Vec<usize> {
        let undone: Vec<usize> = self.undone().collect();
        let is_ready = |fork: &Self, task: usize| fork.tasks[task].rest_ns == Some(0);
        if !undone.iter().any(|&task| is_ready(self, task)) {
            let rests: Option<Vec<u64>> =
                undone.iter().map(|&task| self.tasks[task].rest_ns).collect();
            let soonest = rests.map(|rests| rests.into_iter().min().unwrap_or(0));
            self.pass(soonest);
            if soonest.is_none() {
                return undone;
            }
        }
        let ready = undone.iter().filter(|&&task| is_ready(self, task));
        let places = ready.map(|&task| (task, self.tasks[task].pc as u32));
        let first = branches.first_of(places);
        let before = undone.iter().copied().take_while(|&task| !is_ready(self, task));
        before.filter(|&task| self.tasks[task].rest_ns.is_none()).chain(first).collect()
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
                let fork = close_fork(&mut state)?;
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
        let started = |&(first, _): &(u32, u32)| Task {
            pc: first as usize,
            is_done: false,
            rest_ns: Some(0),
            frames: Vec::new(),
        };
        let mut tasks: Vec<Task> = branches.ends.iter().map(started).collect();
        let current = branches.first();
        state.pc = std::mem::take(&mut tasks[current].pc);
        let (base, blocks) = (state.frames.len(), state.blocks.len());
        state.forks.push(Fork { at, base, blocks, current, passed_ns: Some(0), tasks });
        Some(state)
    }

    /// Do an effect other than flow; the turn ends with it if it was an act.
    pub(crate) fn act_in_turn(
        &mut self,
        state: State,
        instr: Instr,
        operands: &[Word],
    ) -> Option<State> {
        let code = &self.values.module.code;
        let is_turn = !state.forks.is_empty() && instr.ends_turn_before(&code[state.pc + 1]);
        let is_motion = is_turn && is_turn_of_motion(code, state.pc);
        let open = self.open.len();
        let state = self.act(state, instr, operands);
        if !is_turn {
            return state;
        }
        let rest_ns = rest_ns(instr, operands);
        let took_ns = |state: &State| match instr {
            Instr::WaitInput { .. } => None,
            _ if is_motion => state.duration.map(f64::from_bits).map(convert::nanoseconds),
            _ => Some(0),
        };
        for other in self.open.split_off(open) {
            let took_ns = took_ns(&other);
            let other = self.end_turn(other, took_ns, rest_ns);
            self.open.extend(other);
        }
        let state = state?;
        let took_ns = took_ns(&state);
        self.end_turn(state, took_ns, rest_ns)
    }

    /// The turn ends unless something holds the other tasks.
    fn end_turn(&mut self, mut state: State, took_ns: Word, rest_ns: Word) -> Option<State> {
        let blocks = state.blocks.len();
        let Some(fork) = state.forks.last_mut() else { return Some(state) };
        if !fork.has_others() || blocks != fork.blocks {
            return Some(state);
        }
        if state.raised.as_ref().is_some_and(|raised| !raised.is_empty()) {
            return Some(state);
        }
        if state.raised.is_none() {
            state.is_certain = false;
            let held = self.copy(&state);
            self.open.push(held);
        }
        let fork = state.forks.last_mut()?;
        fork.pass(took_ns);
        fork.tasks[fork.current].rest_ns = rest_ns;
        self.pass_turn(state)
    }

    /// Let the next task go on, or all come together.
    fn pass_turn(&mut self, mut state: State) -> Option<State> {
        let fork = state.forks.last_mut()?;
        let own = state.frames.split_off(fork.base);
        let current = &mut fork.tasks[fork.current];
        (current.pc, current.frames) = (state.pc, own);
        let branches = self.branches.get(&fork.at)?;
        let next = fork.wait(branches);
        match next[..] {
            [] => {
                state.pc = branches.join as usize + 1;
                close_fork(&mut state)?;
                self.meet(state)
            }
            [next] => give_turn_to(next, state),
            _ => {
                state.is_certain = false;
                for next in next {
                    let other = give_turn_to(next, self.copy(&state));
                    let other = other.and_then(|other| self.meet(other));
                    self.open.extend(other);
                }
                None
            }
        }
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

/// Let a task go on where it waited.
fn give_turn_to(next: usize, mut state: State) -> Option<State> {
    let fork = state.forks.last_mut()?;
    let waiting = &mut fork.tasks[next];
    state.frames.append(&mut waiting.frames);
    state.pc = std::mem::take(&mut waiting.pc);
    waiting.rest_ns = Some(0);
    fork.current = next;
    Some(state)
}

/// The fork is over: its time is time of the one around it.
fn close_fork(state: &mut State) -> Option<Fork> {
    let fork = state.forks.pop()?;
    if let Some(around) = state.forks.last_mut() {
        around.pass(fork.passed_ns);
    }
    Some(fork)
}

/// How long a task waits after an act, while others go on.
fn rest_ns(instr: Instr, operands: &[Word]) -> Word {
    match instr {
        Instr::Wait { .. } | Instr::OutputSet { .. } | Instr::OutputToggle { .. } => {
            let duration = operands.first().copied().flatten();
            duration.map(f64::from_bits).map(convert::nanoseconds)
        }
        _ => Some(0),
    }
}
