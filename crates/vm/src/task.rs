//! Forks: branches of a program that run as tasks, in turns.
//!
//! A task is a place in the code and the calls under way there; the frame of the function that
//! forks is everybody's. A turn ends when something was commanded of the workcell and what came of
//! it has been read, or its branch has ended; then the next branch goes on that has not and that is
//! ready. The tape keeps one switch a turn: whose it was, and how many steps it took. So the turns
//! are taken back in their order, whatever rule they were taken by. While an error is pending, and
//! in a block with a reverse of its own, the turn does not end: the other tasks are held where they
//! are, between statements.
//!
//! A task that waits, or whose output settles, is ready again at a time of its fork. That time is
//! the sum of what the acts took, as the workcell reported it, so never more than has really passed
//! since, and it goes back with the turns. The workcell is commanded to wait only where no task is
//! ready: in the act that ended the turn, or before a branch ends or a fork is left, which then has
//! not begun if there is a fault.
//!
//! Knows nothing of what the statements of a turn do.

use crate::branches::{Branches, is_turn_of_motion};
use crate::class::Failure;
use crate::convert;
use crate::machine::Machine;
use crate::ops::acts::Done;
use crate::state::{Direction, Frame, MAX_FRAMES};
use crate::step::{Host, Outcome};
use crate::stop::{Stop, Trap, TrapKind};
use obverse_bytecode::{Function, Module};
use obverse_isa::Instr;
use obverse_tape::Tape;
use obverse_tape::record::{self, HeldTask, Switch};
use obverse_workcell::{Fault, Workcell};

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
    /// How much time has passed in it, in nanoseconds.
    pub(crate) now_ns: u64,
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
    /// Until when it waits, in nanoseconds of the fork's time.
    pub(crate) until_ns: u64,
    /// Its calls, outermost first.
    pub(crate) frames: Vec<Frame>,
}

/// How a turn ends that another one follows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TurnEnd {
    /// Whose turn is next.
    next: usize,
    /// When it begins, in nanoseconds of the fork's time.
    now_ns: u64,
    /// Until when the task waits whose turn ends.
    until_ns: u64,
}

impl Fork {
    /// The tasks that have not come to their end, other than the one whose turn it is, from the
    /// one after it on.
    fn others(&self) -> impl Iterator<Item = usize> {
        let count = self.tasks.len();
        let others = (1..count).map(move |step| (self.current + step) % count);
        others.filter(|&task| !self.tasks[task].is_done)
    }

    /// How the turn ends at a time, if any task goes on: when the first of them is ready, and which
    /// of those that are ready then. The task whose turn it is waits until a time too, at a place,
    /// unless it has come to its end.
    fn turn_end(
        &self,
        branches: &Branches,
        now_ns: u64,
        own: Option<(u64, u32)>,
    ) -> Option<TurnEnd> {
        let other = |task: usize| (task, self.tasks[task].until_ns, self.tasks[task].pc);
        let own_task = own.map(|(until_ns, pc)| (self.current, until_ns, pc));
        let all = || self.others().map(other).chain(own_task);
        let now_ns = all().map(|(_, until_ns, _)| until_ns).min()?.max(now_ns);
        let ready = all().filter(|(_, until_ns, _)| *until_ns <= now_ns);
        let next = branches.first_of(ready.map(|(task, _, pc)| (task, pc)))?;
        Some(TurnEnd { next, now_ns, until_ns: own.map_or(0, |(until_ns, _)| until_ns) })
    }

    /// How long the last of the tasks that have not come to their end still waits, in nanoseconds.
    fn longest_rest_ns(&self) -> u64 {
        let rest = |task: usize| self.tasks[task].until_ns.saturating_sub(self.now_ns);
        self.others().map(rest).max().unwrap_or(0)
    }

    /// Every word of its state: where the tasks are that wait, and what they hold.
    pub(crate) fn each_word(&self, steps: u64, functions: &[Function], sink: &mut dyn FnMut(u64)) {
        sink(u64::from(self.at) << 32 | self.base as u64);
        sink(self.current as u64);
        sink(steps.wrapping_sub(self.turn_began));
        sink(self.now_ns);
        for task in &self.tasks {
            sink(u64::from(task.is_done) << 32 | u64::from(task.pc));
            sink(task.until_ns);
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
    pub(crate) fn task_forward(&mut self, at: usize, host: &mut Host<'_>) -> Outcome {
        match self.program.module().code[at] {
            Instr::Fork { .. } => self.fork(at),
            Instr::ForkLeave { .. } => self.leave_fork(at, host),
            _ => self.end_branch(at, host),
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
        let first = branches.first();
        let start = std::mem::take(&mut tasks[first]).pc;
        let turn_began = self.state.steps() + 1;
        self.state.place.stand_at(start as usize, turn_began);
        self.open_fork(at as u32, first, turn_began, tasks);
        Ok(())
    }

    fn open_fork(&mut self, at: u32, current: usize, turn_began: u64, tasks: Vec<Task>) {
        self.state.forks.push(Fork {
            at,
            base: self.state.frames.len(),
            current,
            turn_began,
            now_ns: 0,
            open_blocks: self.state.open_blocks,
            compensations: self.state.compensations.len(),
            tasks,
        });
    }

    /// The fork is over: its time is time of the one around it.
    fn close_fork(&mut self) -> Option<Fork> {
        let fork = self.state.forks.pop()?;
        if let Some(around) = self.state.forks.last_mut() {
            around.now_ns = around.now_ns.wrapping_add(fork.now_ns);
        }
        Some(fork)
    }

    /// The fork is open again at a time of its own.
    fn reopen_fork(
        &mut self,
        at: u32,
        (current, turn_began): (usize, u64),
        now_ns: u64,
        tasks: Vec<Task>,
    ) {
        if let Some(around) = self.state.forks.last_mut() {
            around.now_ns = around.now_ns.wrapping_sub(now_ns);
        }
        self.open_fork(at, current, turn_began, tasks);
        if let Some(fork) = self.state.forks.last_mut() {
            fork.now_ns = now_ns;
        }
    }

    /// Have the workcell wait before an instruction that is no act: it has not begun if there is a
    /// fault.
    fn wait_before(at: usize, rest_ns: u64, host: &mut Host<'_>) -> Outcome {
        let (pc, direction) = (at as u32, Direction::Forward);
        wait(rest_ns, host.cell).map_err(|fault| Stop::Fault { fault, pc, direction })
    }

    /// The task at hand has come to the end of its branch.
    fn end_branch(&mut self, at: usize, host: &mut Host<'_>) -> Outcome {
        let Some(fork) = self.state.forks.last() else {
            return Self::trap_at(at, TrapKind::Foreign);
        };
        let branches = self.branches.get(&fork.at);
        let end = branches.and_then(|branches| fork.turn_end(branches, fork.now_ns, None));
        if let Some(end) = end.filter(|end| end.now_ns > fork.now_ns) {
            self.watch(false, host.cell);
            Self::wait_before(at, end.now_ns - fork.now_ns, host)?;
            self.tell(Direction::Forward, at, None, host);
        }
        self.state.place.pc += 1;
        if let Some(fork) = self.state.forks.last_mut() {
            fork.tasks[fork.current].is_done = true;
        }
        match end {
            Some(end) => self.pass_turn(end),
            None => self.join(),
        }
        Ok(())
    }

    /// Whether other tasks of a fork go on while the one whose turn it is waits.
    pub(crate) fn others_go_on(&self) -> bool {
        let Some(fork) = self.state.forks.last() else { return false };
        let is_held = !self.state.raised.is_empty()
            || self.state.open_blocks != fork.open_blocks
            || self.state.compensations.len() != fork.compensations;
        !is_held && fork.others().next().is_some()
    }

    /// After an act: how the turn ends, if it does. The workcell waits until a task is ready.
    ///
    /// # Errors
    /// A fault of the workcell.
    pub(crate) fn end_of_turn(
        &mut self,
        effect: usize,
        done: &Done,
        host: &mut Host<'_>,
    ) -> Result<Option<TurnEnd>, Failure> {
        let Some(fork) = self.state.forks.last() else { return Ok(None) };
        let code = &self.program.module().code;
        if !code[effect].ends_turn_before(&code[effect + 1]) || !self.others_go_on() {
            return Ok(None);
        }
        let Some(branches) = self.branches.get(&fork.at) else { return Ok(None) };
        let passed_ns = fork.now_ns.saturating_add(took_ns(code, effect, done, host.cell));
        let until_ns = passed_ns.saturating_add(convert::nanoseconds(done.rest_s));
        let end = fork.turn_end(branches, passed_ns, Some((until_ns, effect as u32 + 1)));
        if let Some(end) = end {
            wait(end.now_ns - passed_ns, host.cell)?;
        }
        Ok(end)
    }

    /// Record the turn that has ended, before the next one begins at a time.
    fn record_turn(&mut self, until_ns: u64, leaves: bool) {
        let steps = self.state.steps();
        let Some(fork) = self.state.forks.last() else { return };
        let steps = steps.wrapping_sub(fork.turn_began);
        let (task, now_ns) = (fork.current as u8, fork.now_ns);
        if let Some(tape) = &mut self.tape {
            Switch { task, steps, leaves, now_ns, until_ns }.push(tape);
        }
    }

    /// The turn has ended: record it, and let the next task go on.
    pub(crate) fn pass_turn(&mut self, end: TurnEnd) {
        let waited = self.state.forks.last().map(|fork| fork.tasks[end.next].until_ns);
        self.record_turn(waited.unwrap_or(0), false);
        if let Some(fork) = self.state.forks.last_mut() {
            fork.now_ns = end.now_ns;
            fork.tasks[fork.current].until_ns = end.until_ns;
        }
        self.give_turn_to(end.next, self.state.steps());
    }

    /// The last turn has ended: record it, and go on behind the fork.
    fn join(&mut self) {
        self.record_turn(0, false);
        let steps = self.state.steps();
        let Some(fork) = self.close_fork() else { return };
        let join = self.branches.get(&fork.at).map_or(0, |branches| branches.join);
        self.state.place.stand_at(join as usize + 1, steps);
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
        next_task.until_ns = 0;
        fork.current = next;
        fork.turn_began = turn_began;
        self.state.place.stand_at(stands as usize, steps);
    }

    /// Leave a fork from within a branch, when what the others command has settled.
    fn leave_fork(&mut self, at: usize, host: &mut Host<'_>) -> Outcome {
        let Some(fork) = self.state.forks.last() else {
            return Self::trap_at(at, TrapKind::Foreign);
        };
        self.watch(false, host.cell);
        Self::wait_before(at, fork.longest_rest_ns(), host)?;
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
                until_ns: task.until_ns,
                calls: task.frames.iter().map(|frame| (frame.function, frame.return_pc)).collect(),
            };
            record::Tasks(fork.tasks.iter().enumerate().map(held).collect()).push(tape);
        }
        let join = self.branches.get(&fork.at).map_or(at, |branches| branches.join as usize);
        self.state.place.jump_forward(join);
        self.record_turn(0, true);
        self.close_fork();
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
            self.state.place.stand_at(fork.at as usize, steps.wrapping_sub(1));
            self.state.forks.pop();
            return Ok(true);
        }
        let Some(tape) = &mut self.tape else { return Self::trap_at(at, TrapKind::NoTape) };
        let Some(switch) = Switch::pop(tape) else {
            return Self::trap_at(at, TrapKind::TapeEmpty);
        };
        let before = usize::from(switch.task);
        let is_one = before < fork.tasks.len() && (1..=steps).contains(&switch.steps);
        if !is_one || switch.leaves {
            return Self::trap_at(at, TrapKind::Foreign);
        }
        if let Some(fork) = self.state.forks.last_mut() {
            fork.now_ns = switch.now_ns;
            fork.tasks[fork.current].until_ns = switch.until_ns;
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
            let done =
                |&(_, end): &(u32, u32)| Task { pc: end + 1, is_done: true, ..Task::default() };
            branches.ends.iter().map(done).collect()
        };
        let was = std::mem::take(&mut tasks[current]);
        let at = if switch.leaves { was.pc } else { was.pc - 1 };
        self.state.frames.extend(was.frames);
        let began = steps - switch.steps;
        self.reopen_fork(fork, (current, began), switch.now_ns, tasks);
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
            let (pc, is_done, until_ns) = (task.pc, task.is_done, task.until_ns);
            let waits = Task { pc, is_done, until_ns, frames };
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

/// How long the turn took that ends with an act, in nanoseconds: as the workcell reported, or as
/// it was commanded to wait.
fn took_ns(code: &[Instr], effect: usize, done: &Done, cell: &dyn Workcell) -> u64 {
    let motion = is_turn_of_motion(code, effect).then(|| cell.last_motion());
    convert::nanoseconds(motion.map_or(0.0, |report| report.duration_s) + done.waited_s)
}

fn wait(rest_ns: u64, cell: &mut dyn Workcell) -> Result<(), Fault> {
    if rest_ns == 0 { Ok(()) } else { cell.wait(convert::seconds(rest_ns)) }
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
