//! Forks: branches of a program that run as tasks, in turns.
//!
//! A task is a place in the code and the calls under way there; the frame of the function that
//! forks is everybody's. A turn ends when something was commanded of the workcell and what came of
//! it has been read, or its branch has ended; then the next branch goes on that has not. The tape
//! keeps one switch a turn: whose it was, and how many steps it took. So the turns are taken back
//! in their order, whatever rule they were taken by. While an error is pending, and in a block with
//! a reverse of its own, the turn does not end: the other tasks are held where they are, between
//! statements.
//!
//! Knows nothing of what the statements of a turn do.

use crate::machine::Machine;
use crate::state::{Frame, MAX_FRAMES};
use crate::step::Outcome;
use crate::stop::{Stop, Trap, TrapKind};
use obverse_bytecode::{Function, Module};
use obverse_isa::Instr;
use obverse_tape::Tape;
use obverse_tape::record::{self, HeldTask, Switch};
use std::collections::BTreeMap;

/// The most forks that may be open in one another.
pub const MAX_FORKS: usize = 64;

/// A fork that is open.
#[derive(Clone, Debug)]
pub(crate) struct Fork {
    /// The `fork`.
    pub(crate) at: u32,
    /// How many calls are around it.
    pub(crate) base: usize,
    /// Whose turn it is.
    pub(crate) current: usize,
    /// How many steps the program had made when the turn began.
    pub(crate) turn_began: u64,
    /// How many blocks with a reverse of their own are around it.
    pub(crate) open_blocks: u32,
    /// How many functions that run in place of a reversal are around it.
    pub(crate) compensations: usize,
    /// One a branch. That whose turn it is has nothing of its own here.
    pub(crate) tasks: Vec<Task>,
}

/// A task that waits for its turn.
#[derive(Clone, Debug, Default)]
pub(crate) struct Task {
    /// The next instruction.
    pub(crate) pc: u32,
    /// Whether it has come to its end.
    pub(crate) is_done: bool,
    /// Its calls, outermost first.
    pub(crate) frames: Vec<Frame>,
}

/// The branches of a fork: the first instruction of each, and its last.
#[derive(Clone, Debug)]
pub struct Branches {
    /// Where the branches come together.
    pub join: u32,
    /// One a branch: its first instruction, and that at which it ends.
    pub ends: Vec<(u32, u32)>,
}

/// The forks of a program by their first instruction.
#[must_use]
pub fn branches(code: &[Instr]) -> BTreeMap<u32, Branches> {
    let mut forks = BTreeMap::new();
    // Of each fork that is open: where it is, the branches so far, where the next begins.
    let mut open: Vec<(u32, Branches, u32)> = Vec::new();
    for (at, instr) in (0..).zip(code) {
        match instr {
            Instr::Fork { join } => {
                open.push((at, Branches { join: join.0, ends: Vec::new() }, at + 1));
            }
            Instr::ForkNext {} => {
                if let Some((_, branches, start)) = open.last_mut() {
                    branches.ends.push((*start, at));
                    *start = at + 1;
                }
            }
            Instr::ForkJoin { .. } => {
                if let Some((fork, mut branches, start)) = open.pop() {
                    branches.ends.push((start, at));
                    forks.insert(fork, branches);
                }
            }
            _ => {}
        }
    }
    forks
}

impl Fork {
    /// The next task that has not come to its end, other than the one whose turn it is.
    fn next(&self) -> Option<usize> {
        let count = self.tasks.len();
        let others = (1..count).map(|step| (self.current + step) % count);
        others.into_iter().find(|&task| !self.tasks[task].is_done)
    }

    /// Every word of its state: where the tasks are that wait, and what they hold.
    pub(crate) fn each_word(&self, steps: u64, functions: &[Function], sink: &mut dyn FnMut(u64)) {
        sink(u64::from(self.at) << 32 | self.base as u64);
        sink(self.current as u64);
        sink(steps.wrapping_sub(self.turn_began));
        for task in &self.tasks {
            sink(u64::from(task.is_done) << 32 | u64::from(task.pc));
            task.frames.iter().for_each(|frame| frame.each_word(functions, sink));
        }
    }
}

impl Machine<'_> {
    /// How many steps the program had made when the turn at hand began, if there is one.
    pub(crate) fn turn_began(&self) -> Option<u64> {
        self.state.forks.last().map(|fork| fork.turn_began)
    }

    /// One step forward of the family of forks.
    pub(crate) fn task_forward(&mut self, at: usize) -> Outcome {
        match self.program.module().code[at] {
            Instr::Fork { .. } => self.fork(at),
            Instr::ForkLeave { .. } => self.leave_fork(at),
            _ => self.end_branch(),
        }
    }

    fn trap_at<T>(at: usize, kind: TrapKind) -> Result<T, Stop> {
        Err(Stop::Trap(Trap { pc: at as u32, kind }))
    }

    fn fork(&mut self, at: usize) -> Outcome {
        let Some(branches) = self.branches.get(&(at as u32)) else {
            return Self::trap_at(at, TrapKind::Foreign);
        };
        if self.state.forks.len() >= MAX_FORKS {
            return Err(self.trapped(at, TrapKind::CallDepth));
        }
        let started = |&(start, _): &(u32, u32)| Task { pc: start, ..Task::default() };
        let mut tasks: Vec<Task> = branches.ends.iter().map(started).collect();
        tasks[0] = Task::default();
        self.state.place.pc = at + 1;
        let turn_began = self.state.steps();
        self.open_fork(at as u32, 0, turn_began, tasks);
        Ok(())
    }

    fn open_fork(&mut self, at: u32, current: usize, turn_began: u64, tasks: Vec<Task>) {
        self.state.forks.push(Fork {
            at,
            base: self.state.frames.len(),
            current,
            turn_began,
            open_blocks: self.state.open_blocks,
            compensations: self.state.compensations.len(),
            tasks,
        });
    }

    /// The task at hand has come to the end of its branch.
    fn end_branch(&mut self) -> Outcome {
        self.state.place.pc += 1;
        if let Some(fork) = self.state.forks.last_mut() {
            fork.tasks[fork.current].is_done = true;
        }
        self.pass_turn();
        Ok(())
    }

    /// After an instruction: the turn ends if it ends one, and nothing holds the other tasks.
    pub(crate) fn end_turn(&mut self, instr: Instr) {
        let Some(fork) = self.state.forks.last() else { return };
        // What came of a motion is read before anybody else moves.
        let is_read = self.program.module().code[self.state.place.pc].reads_motion();
        let is_held = !self.state.raised.is_empty()
            || self.state.open_blocks != fork.open_blocks
            || self.state.compensations.len() != fork.compensations;
        if instr.ends_turn() && !is_read && !is_held && fork.next().is_some() {
            self.pass_turn();
        }
    }

    /// The turn has ended: record it, and let the next task go on, or all come together.
    fn pass_turn(&mut self) {
        let steps = self.state.steps();
        let Some(fork) = self.state.forks.last() else { return };
        let turn = steps.wrapping_sub(fork.turn_began);
        let switch = Switch { task: fork.current as u8, steps: turn, leaves: false };
        if let Some(tape) = &mut self.tape {
            switch.push(tape);
        }
        match fork.next() {
            Some(next) => self.give_turn_to(next, steps),
            None => {
                let join = self.branches.get(&fork.at).map_or(0, |branches| branches.join);
                self.state.forks.pop();
                self.state.place.stand_at(join as usize + 1, steps);
            }
        }
    }

    /// Let the task at hand wait, and another one stand where it waited.
    fn give_turn_to(&mut self, next: usize, turn_began: u64) {
        let steps = self.state.steps();
        let pc = self.state.pc();
        let Some(fork) = self.state.forks.last_mut() else { return };
        let own = self.state.frames.split_off(fork.base);
        let current = &mut fork.tasks[fork.current];
        current.pc = pc;
        current.frames = own;
        let next_task = &mut fork.tasks[next];
        self.state.frames.append(&mut next_task.frames);
        let stands = std::mem::take(&mut next_task.pc);
        fork.current = next;
        fork.turn_began = turn_began;
        self.state.place.stand_at(stands as usize, steps);
    }

    /// Leave a fork from within a branch.
    fn leave_fork(&mut self, at: usize) -> Outcome {
        let Some(fork) = self.state.forks.pop() else {
            return Self::trap_at(at, TrapKind::Foreign);
        };
        let functions = &self.program.module().functions;
        if let Some(tape) = &mut self.tape {
            for frame in fork.tasks.iter().flat_map(|task| &task.frames) {
                frame.save(&functions[usize::from(frame.function)]).push(tape);
            }
            // Where it was left from stands for the task whose turn it is.
            let pc = |index, task: &Task| if index == fork.current { at as u32 } else { task.pc };
            let held = |(index, task): (usize, &Task)| HeldTask {
                pc: pc(index, task),
                is_done: task.is_done,
                calls: task.frames.iter().map(|frame| (frame.function, frame.return_pc)).collect(),
            };
            record::Tasks(fork.tasks.iter().enumerate().map(held).collect()).push(tape);
        }
        let join = self.branches.get(&fork.at).map_or(at, |branches| branches.join as usize);
        self.state.place.jump_forward(join);
        let steps = self.state.steps().wrapping_sub(fork.turn_began);
        if let Some(tape) = &mut self.tape {
            Switch { task: fork.current as u8, steps, leaves: true }.push(tape);
        }
        Ok(())
    }

    /// At the beginning of a turn, going back: undo the fork, if no turn was before; otherwise it
    /// is the turn of the task before again. Whether that was all of the step.
    pub(crate) fn turn_back(&mut self) -> Result<bool, Stop> {
        let steps = self.state.steps();
        let at = self.state.place.pc.wrapping_sub(1);
        let Some(fork) = self.state.forks.last() else { return Ok(false) };
        if steps != fork.turn_began {
            return Ok(false);
        }
        if self.is_at_start(fork) {
            self.state.place.pc = fork.at as usize;
            self.state.forks.pop();
            return Ok(true);
        }
        let Some(tape) = &mut self.tape else { return Self::trap_at(at, TrapKind::NoTape) };
        let Some(switch) = Switch::pop(tape) else {
            return Self::trap_at(at, TrapKind::TapeEmpty);
        };
        let before = usize::from(switch.task);
        let is_other = before < fork.tasks.len() && before != fork.current;
        if !is_other || switch.steps > steps || switch.leaves {
            return Self::trap_at(at, TrapKind::Foreign);
        }
        self.give_turn_to(before, steps - switch.steps);
        let Some(fork) = self.state.forks.last_mut() else { return Ok(false) };
        let was_done = std::mem::take(&mut fork.tasks[before].is_done);
        self.state.place.pc -= usize::from(was_done);
        Ok(was_done)
    }

    /// Whether no task of a fork has made a step.
    fn is_at_start(&self, fork: &Fork) -> bool {
        let Some(branches) = self.branches.get(&fork.at) else { return false };
        let mut starts = branches.ends.iter().zip(&fork.tasks).enumerate();
        starts.all(|(index, ((start, _), task))| {
            let pc = if index == fork.current { self.state.pc() } else { task.pc };
            pc == *start && task.frames.is_empty() && !task.is_done
        })
    }

    /// Going back over a `fork.join` from behind it: the turns are taken back from the last.
    pub(crate) fn join_reverse(&mut self, join: usize, fork: u32) -> Outcome {
        let Some(branches) = self.branches.get(&fork).cloned() else {
            return Self::trap_at(join, TrapKind::Foreign);
        };
        let Some(tape) = &mut self.tape else { return Self::trap_at(join, TrapKind::NoTape) };
        let Some(switch) = Switch::pop(tape) else {
            return Self::trap_at(join, TrapKind::TapeEmpty);
        };
        let steps = self.state.steps();
        let current = usize::from(switch.task);
        if current >= branches.ends.len() || !(1..=steps).contains(&switch.steps) {
            return Self::trap_at(join, TrapKind::Foreign);
        }
        let mut tasks: Vec<Task> = if switch.leaves {
            self.take_held(join, &branches)?
        } else {
            let done = |&(_, end): &(u32, u32)| Task { pc: end + 1, is_done: true, frames: vec![] };
            branches.ends.iter().map(done).collect()
        };
        let was = std::mem::take(&mut tasks[current]);
        let at = if switch.leaves { was.pc } else { was.pc - 1 };
        self.state.frames.extend(was.frames);
        self.open_fork(fork, current, steps - switch.steps, tasks);
        self.state.place.jump_reverse(join, at as usize);
        self.state.place.pc = at as usize;
        Ok(())
    }

    /// The tasks that were held when a fork was left.
    fn take_held(&mut self, join: usize, branches: &Branches) -> Result<Vec<Task>, Stop> {
        let foreign = Stop::Trap(Trap { pc: join as u32, kind: TrapKind::Foreign });
        let functions = &self.program.module().functions;
        let Some(tape) = &mut self.tape else { return Err(foreign) };
        let held = record::Tasks::pop(tape, branches.ends.len()).ok_or(foreign.clone())?;
        let calls = held.0.iter().map(|task| task.calls.len()).sum::<usize>();
        if calls > MAX_FRAMES {
            return Err(foreign);
        }
        let mut tasks = Vec::new();
        for (task, ends) in held.0.iter().zip(&branches.ends).rev() {
            let frames = take_frames(tape, functions, &task.calls).ok_or(foreign.clone())?;
            let waits = Task { pc: task.pc, is_done: task.is_done, frames };
            let calls = task.calls.iter().copied();
            let home = self.state.frames.last().map_or(0, |frame| usize::from(frame.function));
            if !may_wait(self.program.module(), home, (task.pc, task.is_done), calls, *ends) {
                return Err(foreign);
            }
            tasks.push(waits);
        }
        tasks.reverse();
        Ok(tasks)
    }
}

/// The calls of a task with what they held, the newest on the tape.
fn take_frames(
    tape: &mut Tape,
    functions: &[Function],
    calls: &[(u16, u32)],
) -> Option<Vec<Frame>> {
    let mut frames = Vec::new();
    for &(function, return_pc) in calls.iter().rev() {
        let declared = functions.get(usize::from(function))?;
        let (words, joints) = Frame::saved_size(declared);
        let saved = record::Frame::pop(tape, words, joints)?;
        frames.push(Frame::restore(function, declared, return_pc, saved));
    }
    frames.reverse();
    Some(frames)
}

/// Whether a task of a branch can wait at a place, in the calls that it has made from the function
/// that forks, `home`. What a tape says is not believed.
pub(crate) fn may_wait(
    module: &Module,
    home: usize,
    (pc, is_done): (u32, bool),
    calls: impl Iterator<Item = (u16, u32)>,
    (start, end): (u32, u32),
) -> bool {
    let mut function = home;
    let mut is_in_branch = None;
    for (callee, return_pc) in calls {
        let Some(at) = return_pc.checked_sub(1) else { return false };
        let is_call = matches!(
            module.code.get(at as usize),
            Some(Instr::Call { function, .. }) if function.0 == callee
        );
        if !is_call || module.function_at(at) != Some(function) {
            return false;
        }
        is_in_branch.get_or_insert((start..end).contains(&at));
        function = usize::from(callee);
    }
    let is_inside = module.function_at(pc) == Some(function)
        && module.functions[function].first < pc
        && is_in_branch.unwrap_or((start..=end + 1).contains(&pc));
    is_inside && is_done == (is_in_branch.is_none() && pc == end + 1)
}
