//! A machine's state as plain data, and back again from data that may be hostile.

use crate::hot::Place;
use crate::link::Links;
use crate::machine::Machine;
use crate::state::{Direction, Frame, MAX_FRAMES, Pending};
use crate::task::{Fork, Task, may_wait};
use obverse_bytecode::{Module, Verified};
use obverse_geometry::JointConfiguration;
use obverse_isa::{ErrorId, Instr};
use obverse_tape::{ForkSnapshot, FrameSnapshot, Snapshot, Streams, Tape, TaskSnapshot, record};
use obverse_workcell::{Shadow, Workcell};
use std::fmt;

/// How many steps back over a block with a reverse of its own are made at once in a recording.
const BELIEVED_STEPS: u64 = 1 << 24;

/// A snapshot that is of no run of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SnapshotError {
    /// What does not fit.
    pub what: &'static str,
}

impl fmt::Display for SnapshotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the recorded state is not one of this program: its {} does not fit", self.what)
    }
}

impl std::error::Error for SnapshotError {}

impl<'p> Machine<'p> {
    /// The state as plain data. Where a function runs in place of a reversal, it is the program's
    /// state from before it.
    #[must_use]
    pub fn snapshot(&self, cell: &dyn Workcell) -> Snapshot {
        self.without_compensations().state_as_data(cell)
    }

    /// The records of the tape that belong to [`snapshot`](Self::snapshot), as plain data; none
    /// without a tape.
    #[must_use]
    pub fn streams(&self) -> Streams {
        let machine = self.without_compensations();
        machine.tape.as_ref().map(Tape::streams).unwrap_or_default()
    }

    fn without_compensations(&self) -> Self {
        let mut machine = self.clone();
        machine.leave_compensations();
        machine
    }

    /// Take the program's own state back to where the outermost function that runs in place of a
    /// reversal was called; the workcell is commanded nothing.
    pub(crate) fn leave_compensations(&mut self) {
        let mut nothing = Shadow::new(JointConfiguration::ZERO, Vec::new());
        while !self.state.compensations.is_empty() {
            if self.state.pending.is_some_and(|pending| pending.direction == Direction::Reverse) {
                self.state.pending = None;
            }
            if self.unwind(&mut nothing).is_err() {
                // What a run recorded can be unwound; there is no more to know of another state.
                self.state.compensations.clear();
            }
        }
    }

    pub(crate) fn state_as_data(&self, cell: &dyn Workcell) -> Snapshot {
        let state = &self.state;
        let module = self.program.module();
        let frame = |frame: &Frame| frame_as_data(module, frame);
        let task = |task: &Task| TaskSnapshot {
            pc: task.pc,
            is_done: task.is_done,
            until_ns: task.until_ns,
            frames: task.frames.iter().map(frame).collect(),
        };
        let fork = |fork: &Fork| ForkSnapshot {
            at: fork.at,
            base: fork.base as u32,
            current: fork.current as u8,
            turn_steps: state.steps().wrapping_sub(fork.turn_began),
            now_ns: fork.now_ns,
            tasks: fork.tasks.iter().map(task).collect(),
        };
        let pending =
            |pending: Pending| (pending.direction == Direction::Reverse, pending.level_before);
        Snapshot {
            pc: state.pc(),
            steps: state.steps(),
            operands: state.operands().to_vec(),
            frames: state.frames.iter().map(frame).collect(),
            globals: state.globals.clone(),
            settings: state.settings,
            raised: state.raised.iter().map(|error| error.0).collect(),
            draws: state.draws,
            pending: state.pending.map(pending),
            forks: state.forks.iter().map(fork).collect(),
            joints: cell.joints().0,
            outputs: (0..cell.output_count()).map(|bit| cell.output(bit)).collect(),
        }
    }

    /// The machine of a recording. It is there to be looked at and walked back: names are not
    /// linked to a workcell.
    ///
    /// # Errors
    /// If the state is none of the program.
    pub fn from_recording(
        program: &'p Verified,
        snapshot: &Snapshot,
        streams: &Streams,
        cell: &dyn Workcell,
    ) -> Result<Self, SnapshotError> {
        let module = program.module();
        let mut machine =
            Self::new(program, cell).map_err(|_| SnapshotError { what: "workcell" })?;
        machine.believed_steps = BELIEVED_STEPS;
        machine.links = Links {
            items: vec![obverse_workcell::ItemId(0); module.items.len()],
            tools: vec![0; module.tools.len()],
            watches: Vec::new(),
            settings: snapshot.settings,
        };
        machine.tape = Some(Tape::from_streams(streams));
        machine.stand_as(snapshot)?;
        Ok(machine)
    }

    /// Be in the state of a snapshot.
    ///
    /// # Errors
    /// If it is none of the program.
    pub(crate) fn stand_as(&mut self, snapshot: &Snapshot) -> Result<(), SnapshotError> {
        let module = self.program.module();
        check(module, snapshot)?;
        let forks: Option<Vec<Fork>> =
            snapshot.forks.iter().map(|fork| restore_fork(self, snapshot, fork)).collect();
        let forks = forks.ok_or(SnapshotError { what: "fork" })?;
        let state = &mut self.state;
        state.place = Place {
            pc: snapshot.pc as usize,
            offset: snapshot.steps.wrapping_sub(u64::from(snapshot.pc)),
        };
        state.depth = snapshot.operands.len() as u8;
        state.frames = snapshot.frames.iter().map(|frame| restore_frame(module, frame)).collect();
        if let Some(innermost) = state.frames.last_mut() {
            let (_, operands) = innermost.words.parts_mut();
            operands[..snapshot.operands.len()].copy_from_slice(&snapshot.operands);
        }
        state.globals.clone_from(&snapshot.globals);
        state.settings = snapshot.settings;
        state.raised = snapshot.raised.iter().map(|&error| ErrorId(error)).collect();
        state.draws = snapshot.draws;
        state.open_blocks = open_blocks(module, &snapshot.frames, snapshot.pc);
        state.pending = snapshot.pending.map(|(is_reverse, level_before)| Pending {
            direction: if is_reverse { Direction::Reverse } else { Direction::Forward },
            level_before,
        });
        state.forks = forks;
        Ok(())
    }
}

fn frame_as_data(module: &Module, frame: &Frame) -> FrameSnapshot {
    let saved = frame.save(&module.functions[usize::from(frame.function)]);
    FrameSnapshot {
        function: frame.function,
        return_pc: frame.return_pc,
        words: saved.words,
        positions: saved.joints.iter().map(|joints| joints.0).collect(),
    }
}

/// A fork of a snapshot, if it can be open where the snapshot is.
fn restore_fork(machine: &Machine<'_>, snapshot: &Snapshot, fork: &ForkSnapshot) -> Option<Fork> {
    let module = machine.program.module();
    let branches = machine.branches.get(&fork.at)?;
    let base = usize::try_from(fork.base).ok()?;
    let (around, inner) = snapshot.frames.split_at_checked(base)?;
    let home = usize::from(around.last()?.function);
    let current = usize::from(fork.current);
    let is_whole = module.function_at(fork.at) == Some(home)
        && fork.tasks.len() == branches.ends.len()
        && snapshot.steps >= fork.turn_steps;
    let here = inner.first().map_or(snapshot.pc, |frame| frame.return_pc.saturating_sub(1));
    let (start, end) = *branches.ends.get(current)?;
    if !is_whole || !(start..=end).contains(&here) {
        return None;
    }
    let tasks = fork.tasks.iter().zip(&branches.ends).enumerate();
    let tasks: Option<Vec<Task>> = tasks
        .map(|(index, (task, ends))| match index == current {
            true => (*task == TaskSnapshot::default()).then(Task::default),
            false => restore_task(module, home, task, *ends),
        })
        .collect();
    Some(Fork {
        at: fork.at,
        base,
        current,
        turn_began: snapshot.steps - fork.turn_steps,
        now_ns: fork.now_ns,
        open_blocks: open_blocks(module, around, fork.at),
        compensations: 0,
        tasks: tasks?,
    })
}

fn restore_task(
    module: &Module,
    home: usize,
    task: &TaskSnapshot,
    ends: (u32, u32),
) -> Option<Task> {
    let calls = task.frames.iter().map(|frame| (frame.function, frame.return_pc));
    let place = (task.pc, task.is_done);
    let is_whole = |frame: &FrameSnapshot| {
        let declared = &module.functions[usize::from(frame.function)];
        (frame.words.len(), frame.positions.len()) == Frame::saved_size(declared)
    };
    let fits = task.frames.len() <= MAX_FRAMES
        && may_wait(module, home, place, calls, ends)
        && task.frames.iter().all(is_whole);
    fits.then(|| Task {
        pc: task.pc,
        is_done: task.is_done,
        until_ns: task.until_ns,
        frames: task.frames.iter().map(|frame| restore_frame(module, frame)).collect(),
    })
}

/// How many blocks with a reverse of their own are open around these calls and an instruction.
fn open_blocks(module: &Module, frames: &[FrameSnapshot], pc: u32) -> u32 {
    let calls = frames.iter().skip(1).map(|frame| frame.return_pc - 1);
    calls.chain([pc]).map(|pc| blocks_around(module, pc)).sum()
}

/// How many blocks with a reverse of their own are open before an instruction.
fn blocks_around(module: &Module, pc: u32) -> u32 {
    let first = module.function_at(pc).map_or(pc, |index| module.functions[index].first);
    let mut open: u32 = 0;
    for instr in &module.code[first as usize..pc as usize] {
        match instr {
            Instr::BlockBegin {} => open += 1,
            Instr::BlockSkip { .. } | Instr::BlockReplace { .. } => open = open.saturating_sub(1),
            _ => {}
        }
    }
    open
}

fn restore_frame(module: &Module, frame: &FrameSnapshot) -> Frame {
    let saved = record::Frame {
        words: frame.words.clone(),
        joints: frame.positions.iter().map(|&joints| JointConfiguration(joints)).collect(),
    };
    let declared = &module.functions[usize::from(frame.function)];
    Frame::restore(frame.function, declared, frame.return_pc, saved)
}

fn check(module: &Module, snapshot: &Snapshot) -> Result<(), SnapshotError> {
    let fits = |fits: bool, what: &'static str| {
        if fits { Ok(()) } else { Err(SnapshotError { what }) }
    };
    let innermost = snapshot.frames.last().map(|frame| usize::from(frame.function));
    fits(snapshot.steps < 1 << 62, "number of steps")?;
    fits((1..=MAX_FRAMES).contains(&snapshot.frames.len()), "number of calls")?;
    fits(module.function_at(snapshot.pc).is_some_and(|at| Some(at) == innermost), "position")?;
    fits(module.functions[innermost.unwrap_or(0)].first < snapshot.pc, "position")?;
    fits(snapshot.globals.len() == module.globals.len(), "number of variables")?;
    fits(snapshot.raised.iter().all(|&error| usize::from(error) < module.errors.len()), "errors")?;
    fits(operands_fit(module, snapshot), "operand stack")?;
    let mut caller: Option<usize> = None;
    for frame in &snapshot.frames {
        let index = usize::from(frame.function);
        let declared = module.functions.get(index).ok_or(SnapshotError { what: "call" })?;
        let saved = (frame.words.len(), frame.positions.len());
        fits(saved == Frame::saved_size(declared), "call")?;
        fits(calls(module, caller, frame), "call")?;
        caller = Some(index);
    }
    Ok(())
}

/// Whether a frame was made by a call in its caller; the first is the start, which nobody calls.
fn calls(module: &Module, caller: Option<usize>, frame: &FrameSnapshot) -> bool {
    let Some(caller) = caller else { return frame.function == 0 };
    let Some(at) = frame.return_pc.checked_sub(1) else { return false };
    let is_call = matches!(
        module.code.get(at as usize),
        Some(Instr::Call { function, .. }) if function.0 == frame.function
    );
    is_call && module.function_at(at) == Some(caller)
}

/// Within a prefix there are as many operands as the instructions before have left; an act that was
/// not finished going forward has all of its own.
fn operands_fit(module: &Module, snapshot: &Snapshot) -> bool {
    let at = snapshot.pc as usize;
    let effect = (at..module.code.len()).find(|&at| !module.code[at].info().family.is_pure());
    let Some(effect) = effect else { return false };
    let start = effect - usize::from(module.code[effect].prefix());
    let mut height = 0;
    for instr in &module.code[start..at.max(start)] {
        let info = instr.info();
        height += info.pushes.len();
        height = height.saturating_sub(info.pops.len());
    }
    height == snapshot.operands.len()
}
