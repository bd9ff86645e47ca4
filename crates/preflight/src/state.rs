//! What is known of a run at a place of the program.
//!
//! A word is known or not; the workcell is one of those that [`Worlds`](crate::worlds) keeps. A
//! state stands for every run whose values are those that it knows.

use crate::reason::Reason;
use crate::tasks::Fork;
use crate::trace::NodeId;
use crate::worlds::WorldId;
use obverse_bytecode::Function;
use obverse_geometry::JointConfiguration;
use obverse_isa::{ErrorId, Setting};

/// How many pending errors keep states apart. With more, what is known of them may be forgotten.
const MAX_APART: usize = 2;

/// A value of 64 bits, if it is known.
pub(crate) type Word = Option<u64>;

/// A call under way.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) function: usize,
    /// Where the caller goes on.
    pub(crate) return_pc: usize,
    pub(crate) locals: Vec<Word>,
    /// First, last and present value of each loop counter.
    pub(crate) counters: Vec<[Word; 3]>,
    pub(crate) slots: Vec<Option<JointConfiguration>>,
}

/// What is known of a run.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) pc: usize,
    pub(crate) frames: Vec<Frame>,
    pub(crate) globals: Vec<Word>,
    pub(crate) settings: [Word; Setting::ALL.len()],
    /// The errors that are pending, oldest first.
    pub(crate) raised: Option<Vec<ErrorId>>,
    pub(crate) world: WorldId,
    /// What the last motion reported, in metres, in newtons and, in a fork, in seconds.
    pub(crate) distance: Word,
    pub(crate) peak_force: Word,
    pub(crate) duration: Word,
    /// Whether everything so far went as it does where all is at the place that the file gives.
    pub(crate) is_planned: bool,
    /// Whether every decision so far was known, so that this is the only way.
    pub(crate) is_certain: bool,
    /// Why this way is not followed as it would be run: only so many rounds of a loop are, and no
    /// run comes past a move that fails. What is not known from then on is so for this reason.
    pub(crate) since: Option<Reason>,
    /// The blocks with a reverse of their own that are open.
    pub(crate) blocks: Vec<NodeId>,
    /// The forks that are open, outermost first.
    pub(crate) forks: Vec<Fork>,
    /// The last thing done that a reversal comes by.
    pub(crate) last: NodeId,
}

impl Frame {
    pub(crate) fn new(index: usize, function: &Function, return_pc: usize) -> Self {
        Self {
            function: index,
            return_pc,
            locals: vec![Some(0); function.locals.len()],
            counters: vec![[Some(0); 3]; usize::from(function.counters)],
            slots: vec![Some(JointConfiguration::ZERO); function.slots.len()],
        }
    }

    /// Begin with what the frame around has: the locals that are this one's parameters, the
    /// counters that both have, and the positions.
    pub(crate) fn begin_with(&mut self, around: &Self, function: &Function) {
        let parameters = usize::from(function.parameters);
        for (own, outer) in self.locals.iter_mut().zip(&around.locals).take(parameters) {
            *own = *outer;
        }
        for (own, outer) in self.counters.iter_mut().zip(&around.counters) {
            *own = *outer;
        }
        for (own, outer) in self.slots.iter_mut().zip(&around.slots) {
            *own = *outer;
        }
    }

    /// Forget all that it holds.
    pub(crate) fn forget(&mut self) {
        self.words_mut().for_each(|word| *word = None);
        self.slots.fill(None);
    }

    fn words(&self) -> impl Iterator<Item = &Word> {
        self.locals.iter().chain(self.counters.iter().flatten())
    }

    fn words_mut(&mut self) -> impl Iterator<Item = &mut Word> {
        self.locals.iter_mut().chain(self.counters.iter_mut().flatten())
    }
}

fn covers_all<'w>(
    all: impl Iterator<Item = &'w Word>,
    others: impl Iterator<Item = &'w Word>,
) -> bool {
    all.zip(others).all(|(word, other)| word.is_none() || word == other)
}

fn same_position(a: &Option<JointConfiguration>, b: &Option<JointConfiguration>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => a.same_bits(b),
        (a, b) => a.is_none() && b.is_none(),
    }
}

impl State {
    /// How many words it has, more or less.
    pub(crate) fn size(&self) -> usize {
        let frame = |frame: &Frame| {
            frame.locals.len() + 3 * frame.counters.len() + 6 * frame.slots.len() + 8
        };
        let tasks = self.forks.iter().map(|fork| 4 * fork.tasks.len()).sum::<usize>();
        self.globals.len() + tasks + self.all_frames().map(frame).sum::<usize>()
    }

    /// The calls under way, and then those of the tasks that wait.
    pub(crate) fn all_frames(&self) -> impl Iterator<Item = &Frame> {
        let waiting = self.forks.iter().flat_map(|fork| &fork.tasks);
        self.frames.iter().chain(waiting.flat_map(|task| &task.frames))
    }

    fn all_frames_mut(&mut self) -> impl Iterator<Item = &mut Frame> {
        let waiting = self.forks.iter_mut().flat_map(|fork| &mut fork.tasks);
        self.frames.iter_mut().chain(waiting.flat_map(|task| &mut task.frames))
    }

    /// Where it is, through which calls, in which blocks, with which errors pending, whether all
    /// went as planned, and where the tasks wait: only states at one place are compared, so that
    /// what an error leaves aside is never mixed with what goes well.
    pub(crate) fn place(&self) -> Vec<usize> {
        let calls = self.frames.iter().map(|frame| frame.return_pc);
        let blocks = self.blocks.iter().map(|block| block.index());
        let mut place: Vec<usize> =
            calls.chain([usize::MAX, self.pc, self.blocks.len()]).chain(blocks).collect();
        self.forks.iter().for_each(|fork| fork.add_place(&mut place));
        place.push(usize::from(self.is_planned));
        let pending = self.raised.iter().flatten().take(MAX_APART);
        place.extend(pending.map(|error| error.index()));
        place
    }

    /// Whether every run that `other` stands for is one that this stands for; both at one place.
    pub(crate) fn covers(&self, other: &Self, nothing_known: WorldId) -> bool {
        let is_same_world = self.world == other.world || self.world == nothing_known;
        let frames = || self.all_frames().zip(other.all_frames());
        is_same_world
            && covers_all(self.globals.iter(), other.globals.iter())
            && covers_all(self.settings.iter(), other.settings.iter())
            && (self.raised.is_none() || self.raised == other.raised)
            && covers_all(self.reported().iter(), other.reported().iter())
            && covers_all(self.times(), other.times())
            && frames().all(|(frame, other)| covers_all(frame.words(), other.words()))
            && frames().all(|(frame, other)| {
                let mut slots = frame.slots.iter().zip(&other.slots);
                slots.all(|(slot, other)| slot.is_none() || same_position(slot, other))
            })
    }

    fn reported(&self) -> [Word; 3] {
        [self.distance, self.peak_force, self.duration]
    }

    /// The times of the forks.
    fn times(&self) -> impl Iterator<Item = &Word> {
        self.forks.iter().flat_map(Fork::times)
    }

    /// Forget all in which `other` differs, but for the workcell.
    pub(crate) fn forget_differences(&mut self, other: &Self) {
        fn meet(word: &mut Word, other: &Word) {
            if word != other {
                *word = None;
            }
        }
        self.globals.iter_mut().zip(&other.globals).for_each(|(word, other)| meet(word, other));
        self.settings.iter_mut().zip(&other.settings).for_each(|(word, other)| meet(word, other));
        meet(&mut self.distance, &other.distance);
        meet(&mut self.peak_force, &other.peak_force);
        meet(&mut self.duration, &other.duration);
        let times = self.forks.iter_mut().flat_map(Fork::times_mut);
        times.zip(other.times()).for_each(|(time, other)| meet(time, other));
        if self.raised != other.raised {
            self.raised = None;
        }
        for (frame, other) in self.all_frames_mut().zip(other.all_frames()) {
            frame.words_mut().zip(other.words()).for_each(|(word, other)| meet(word, other));
            for (slot, other) in frame.slots.iter_mut().zip(&other.slots) {
                if !same_position(slot, other) {
                    *slot = None;
                }
            }
        }
        self.is_certain = false;
    }

    /// Forget everything that a call may change.
    pub(crate) fn forget_effects(&mut self, nothing_known: WorldId) {
        self.globals.fill(None);
        self.settings = [None; Setting::ALL.len()];
        self.raised = None;
        self.world = nothing_known;
        (self.distance, self.peak_force, self.duration) = (None, None, None);
        self.is_certain = false;
    }

    /// The innermost call.
    pub(crate) fn frame(&self) -> &Frame {
        match self.frames.last() {
            Some(frame) => frame,
            None => unreachable!("a state always has the frame that it began with"),
        }
    }

    /// The same, to change it.
    pub(crate) fn frame_mut(&mut self) -> &mut Frame {
        match self.frames.last_mut() {
            Some(frame) => frame,
            None => unreachable!("a state always has the frame that it began with"),
        }
    }

    /// The calls that led here, outermost first, as the instructions that make them.
    pub(crate) fn calls(&self) -> Vec<u32> {
        self.frames.iter().skip(1).map(|frame| frame.return_pc as u32 - 1).collect()
    }
}
