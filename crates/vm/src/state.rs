//! The state of a machine: all that a program can observe or command, but for the workcell's part.

use crate::hot::Place;
use crate::task::Fork;
use crate::values::{CounterSlots, Settings, Words};
use obverse_bytecode::Function;
use obverse_geometry::JointConfiguration;
use obverse_isa::{CounterId, ErrorId};
use obverse_tape::record;

/// The most calls that may be under way.
pub const MAX_FRAMES: usize = 1024;

/// Which way a machine runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// As the program is written.
    Forward,
    /// Back over what was run.
    Reverse,
}

impl Direction {
    /// The other direction.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Forward => Self::Reverse,
            Self::Reverse => Self::Forward,
        }
    }
}

/// A call under way.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The function, as an index into the module's.
    pub function: u16,
    /// Where the caller goes on.
    pub return_pc: u32,
    pub(crate) words: Box<Words>,
    pub(crate) positions: Vec<JointConfiguration>,
}

/// An act that was begun and not finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Pending {
    /// Which way it was done. Its record is on the tape either way: it is written before the act,
    /// and dropped after its reversal.
    pub direction: Direction,
    /// The level that a toggled output had before the instruction: a toggle that may or may not
    /// have happened can only be repeated as an absolute level.
    pub level_before: Option<bool>,
}

/// A function that is run in place of the reversal of a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Compensation {
    /// How many frames there are while it runs.
    pub(crate) frames: usize,
    /// Where the machine was: behind the `block.replace`.
    pub(crate) place: Place,
}

/// The machine's part of the state.
#[derive(Clone, Debug)]
pub struct State {
    pub(crate) place: Place,
    pub(crate) depth: u8,
    pub(crate) frames: Vec<Frame>,
    pub(crate) globals: Vec<u64>,
    pub(crate) settings: Settings,
    pub(crate) raised: Vec<ErrorId>,
    pub(crate) draws: u64,
    pub(crate) pending: Option<Pending>,
    /// How many blocks with a reverse of their own are open: their starts must stay on the tape.
    pub(crate) open_blocks: u32,
    pub(crate) compensations: Vec<Compensation>,
    /// The forks that are open, outermost first.
    pub(crate) forks: Vec<Fork>,
}

impl Frame {
    pub(crate) fn new(index: u16, function: &Function, return_pc: u32) -> Self {
        Self {
            function: index,
            return_pc,
            words: Box::default(),
            positions: vec![JointConfiguration::ZERO; function.slots.len()],
        }
    }

    /// Begin with what the frame around has: the locals that are this one's parameters, the
    /// counters that both have, and the positions.
    pub(crate) fn begin_with(&mut self, around: &Self, functions: &[Function]) {
        let function = |frame: &Self| &functions[usize::from(frame.function)];
        let locals = usize::from(function(self).parameters);
        let shared = function(self).counters.min(function(around).counters);
        let counters = 256 - 3 * usize::from(shared)..256;
        let ((own, _), (others, _)) = (self.words.parts_mut(), around.words.parts());
        own[..locals].copy_from_slice(&others[..locals]);
        own[counters.clone()].copy_from_slice(&others[counters]);
        for (own, remembered) in self.positions.iter_mut().zip(&around.positions) {
            *own = *remembered;
        }
    }

    /// What a loop counter is, which means something within its loop alone.
    #[must_use]
    pub fn counter(&self, counter: CounterId) -> i64 {
        self.words.slot(CounterSlots::of(counter).present).cast_signed()
    }

    /// The words that a function uses: locals, then counters from the top.
    fn used(function: &Function) -> impl Iterator<Item = u8> + use<> {
        let counters = 3 * usize::from(function.counters);
        (0..function.locals.len()).chain((0..counters).map(|at| 255 - at)).map(|at| at as u8)
    }

    /// What must be saved when the frame dies.
    pub(crate) fn save(&self, function: &Function) -> record::Frame {
        record::Frame {
            words: Self::used(function).map(|slot| self.words.slot(slot)).collect(),
            joints: self.positions.clone(),
        }
    }

    /// The frame that was saved.
    pub(crate) fn restore(
        index: u16,
        function: &Function,
        return_pc: u32,
        saved: record::Frame,
    ) -> Self {
        let mut frame = Self::new(index, function, return_pc);
        for (slot, word) in Self::used(function).zip(saved.words) {
            *frame.words.slot_mut(slot) = word;
        }
        frame.positions = saved.joints;
        frame
    }

    /// How many words and joint configurations are saved when a frame of a function dies.
    pub(crate) fn saved_size(function: &Function) -> (usize, usize) {
        (Self::used(function).count(), function.slots.len())
    }

    /// Every word of what it is and holds.
    pub(crate) fn each_word(&self, functions: &[Function], sink: &mut dyn FnMut(u64)) {
        sink(u64::from(self.function) << 32 | u64::from(self.return_pc));
        let function = &functions[usize::from(self.function)];
        Self::used(function).map(|slot| self.words.slot(slot)).for_each(&mut *sink);
        self.positions.iter().flat_map(JointConfiguration::bits).for_each(&mut *sink);
    }

    /// A local variable.
    #[must_use]
    pub fn local(&self, index: u8) -> u64 {
        self.words.slot(index)
    }

    /// The positions that it remembers.
    #[must_use]
    pub fn positions(&self) -> &[JointConfiguration] {
        &self.positions
    }
}

impl State {
    /// The next instruction.
    #[must_use]
    pub fn pc(&self) -> u32 {
        self.place.pc as u32
    }

    /// How many instructions lie between the start of the program and here.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.place.steps()
    }

    /// The operand stack, bottom first; empty between statements.
    #[must_use]
    pub fn operands(&self) -> &[u64] {
        let frame = self.frames.last();
        frame.map_or(&[], |frame| &frame.words.parts().1[..usize::from(self.depth)])
    }

    /// The calls under way, outermost first.
    #[must_use]
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// The variables of the program.
    #[must_use]
    pub fn globals(&self) -> &[u64] {
        &self.globals
    }

    /// The settings by identity.
    #[must_use]
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The errors that are pending, oldest first.
    #[must_use]
    pub fn raised(&self) -> &[ErrorId] {
        &self.raised
    }

    /// How many random numbers have been drawn.
    #[must_use]
    pub fn draws(&self) -> u64 {
        self.draws
    }

    /// The act that was begun and not finished.
    #[must_use]
    pub fn pending(&self) -> Option<Pending> {
        self.pending
    }

    /// How many blocks with a reverse of their own the machine is in.
    #[must_use]
    pub fn open_blocks(&self) -> u32 {
        self.open_blocks
    }

    /// Whether a function is being run in place of the reversal of a block.
    #[must_use]
    pub fn is_compensating(&self) -> bool {
        !self.compensations.is_empty()
    }

    /// The branches whose turns it is, by fork, outermost first.
    #[must_use]
    pub fn branches(&self) -> Vec<usize> {
        self.forks.iter().map(|fork| fork.current).collect()
    }

    /// How many calls are under way, those of tasks that wait included.
    pub(crate) fn call_count(&self) -> usize {
        let waiting = self.forks.iter().flat_map(|fork| &fork.tasks);
        self.frames.len() + waiting.map(|task| task.frames.len()).sum::<usize>()
    }

    /// Every word of the state, in an order that depends on the state alone.
    pub(crate) fn each_word(&self, functions: &[Function], sink: &mut dyn FnMut(u64)) {
        sink(self.place.pc as u64);
        sink(u64::from(self.depth));
        self.operands().iter().copied().for_each(&mut *sink);
        self.frames.iter().for_each(|frame| frame.each_word(functions, sink));
        sink(self.forks.len() as u64);
        self.forks.iter().for_each(|fork| fork.each_word(self.steps(), functions, sink));
        self.globals.iter().copied().for_each(&mut *sink);
        self.settings.into_iter().for_each(&mut *sink);
        sink(self.raised.len() as u64);
        self.raised.iter().map(|error| u64::from(error.0)).for_each(&mut *sink);
        sink(self.draws);
        sink(self.pending.map_or(0, |pending| match pending.direction {
            Direction::Forward => 1,
            Direction::Reverse => 2,
        }));
        sink(u64::from(self.open_blocks));
        sink(self.compensations.len() as u64);
    }
}
