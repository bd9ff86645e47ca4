//! The kinds of record, one type each, named as the instruction table names them.
//!
//! What an opcode saves is a type here, so that an implementation that saves something else does
//! not compile. A record knows which streams it goes to, and how to come back from them.

use crate::tape::{Recorder, Tape};
use obverse_geometry::JointConfiguration;

/// A record: pushed before its instruction acts, popped after it has been reversed.
pub trait Record: Sized {
    /// Whether the recorder has room for what of it comes first.
    fn has_room(recorder: &impl Recorder) -> bool;

    /// Push it.
    fn push(&self, recorder: &mut impl Recorder);

    /// Pop it, the newest of its kind; `None` if there is none.
    fn pop(tape: &mut Tape) -> Option<Self>;

    /// Read it without popping.
    fn peek(tape: &Tape) -> Option<Self>;
}

/// One bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bit(pub bool);

impl Record for Bit {
    #[inline(always)]
    fn has_room(recorder: &impl Recorder) -> bool {
        recorder.has_room_for_bit()
    }

    #[inline(always)]
    fn push(&self, recorder: &mut impl Recorder) {
        recorder.bit(self.0);
    }

    #[inline(always)]
    fn pop(tape: &mut Tape) -> Option<Self> {
        tape.bits.pop().map(Self)
    }

    fn peek(tape: &Tape) -> Option<Self> {
        tape.bits.last().map(Self)
    }
}

/// One word: the bits of a variable, the identity of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word(pub u64);

impl Record for Word {
    #[inline(always)]
    fn has_room(recorder: &impl Recorder) -> bool {
        recorder.has_room_for_word()
    }

    #[inline(always)]
    fn push(&self, recorder: &mut impl Recorder) {
        recorder.word(self.0);
    }

    #[inline(always)]
    fn pop(tape: &mut Tape) -> Option<Self> {
        tape.words.pop().map(Self)
    }

    fn peek(tape: &Tape) -> Option<Self> {
        tape.words.last().map(Self)
    }
}

/// A loop counter: its first, last and present value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counter(pub [u64; 3]);

impl Record for Counter {
    #[inline(always)]
    fn has_room(recorder: &impl Recorder) -> bool {
        recorder.has_room_for_word()
    }

    #[inline(always)]
    fn push(&self, recorder: &mut impl Recorder) {
        for word in self.0 {
            recorder.word(word);
        }
    }

    #[inline(always)]
    fn pop(tape: &mut Tape) -> Option<Self> {
        let present = tape.words.pop()?;
        let last = tape.words.pop()?;
        Some(Self([tape.words.pop()?, last, present]))
    }

    fn peek(tape: &Tape) -> Option<Self> {
        Self::pop(&mut tape.clone())
    }
}

/// Where the arm was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joints(pub JointConfiguration);

impl Record for Joints {
    fn has_room(_: &impl Recorder) -> bool {
        // Only motions record them, and those may as well wait for memory.
        true
    }

    fn push(&self, recorder: &mut impl Recorder) {
        recorder.joints(self.0);
    }

    fn pop(tape: &mut Tape) -> Option<Self> {
        tape.joints.pop().map(|joints| Self(JointConfiguration(joints)))
    }

    fn peek(tape: &Tape) -> Option<Self> {
        tape.joints.last().map(|joints| Self(JointConfiguration(joints)))
    }
}

/// What a frame held when its function returned. Its function says how many of each there are.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Locals, then counters.
    pub words: Vec<u64>,
    /// Remembered positions.
    pub joints: Vec<JointConfiguration>,
}

impl Frame {
    /// Push it.
    pub fn push(&self, recorder: &mut impl Recorder) {
        for word in &self.words {
            recorder.word(*word);
        }
        for joints in &self.joints {
            recorder.joints(*joints);
        }
    }

    /// Pop the newest frame of a function with so many words and joint configurations.
    pub fn pop(tape: &mut Tape, words: usize, joints: usize) -> Option<Self> {
        let joints = pop_many(joints, || tape.joints.pop().map(JointConfiguration))?;
        let words = pop_many(words, || tape.words.pop())?;
        Some(Self { words, joints })
    }
}

/// Whose turn ended, after how many steps, and the times that this changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switch {
    /// The task, by its branch.
    pub task: u8,
    /// The steps of the turn.
    pub steps: u64,
    /// Whether it left the fork and the other tasks where they were.
    pub leaves: bool,
    /// The time of the fork before, in nanoseconds.
    pub now_ns: u64,
    /// Until when the task waited that is next, in nanoseconds.
    pub until_ns: u64,
}

impl Switch {
    /// What the newest of its words says; the times are in those before.
    #[must_use]
    pub fn from_word(word: u64) -> Self {
        let (task, steps, leaves) = (word as u8, word >> 9, word & 0x100 != 0);
        Self { task, steps, leaves, now_ns: 0, until_ns: 0 }
    }

    /// Push it.
    pub fn push(&self, recorder: &mut impl Recorder) {
        recorder.control(self.now_ns);
        recorder.control(self.until_ns);
        recorder.control(self.steps << 9 | u64::from(self.leaves) << 8 | u64::from(self.task));
    }

    /// Pop the newest.
    pub fn pop(tape: &mut Tape) -> Option<Self> {
        let switch = tape.control.pop().map(Self::from_word)?;
        let until_ns = tape.control.pop()?;
        let now_ns = tape.control.pop()?;
        Some(Self { now_ns, until_ns, ..switch })
    }
}

/// A fault of the workcell that became an error of the program: the act that it stopped counts as
/// done as far as it came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The error, by its place in the module's table.
    pub error: u16,
    /// Whether it was pending before.
    pub was_pending: bool,
    /// How many instructions lay between the start of the program and where it became one.
    pub steps: u64,
}

impl Fault {
    /// What a word says.
    #[must_use]
    pub fn from_word(word: u64) -> Self {
        Self { error: word as u16, was_pending: word & 0x1_0000 != 0, steps: word >> 17 }
    }

    /// Push it.
    pub fn push(&self, recorder: &mut impl Recorder) {
        let was_pending = u64::from(self.was_pending);
        recorder.fault(self.steps << 17 | was_pending << 16 | u64::from(self.error));
    }

    /// Pop the newest.
    pub fn pop(tape: &mut Tape) -> Option<Self> {
        tape.faults.pop().map(Self::from_word)
    }

    /// Read the newest without popping.
    #[must_use]
    pub fn peek(tape: &Tape) -> Option<Self> {
        tape.faults.last().map(Self::from_word)
    }
}

/// Where a motion began that was made aside of where the program says. It goes back to there
/// first, so that its way back is the way that it came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aside {
    /// How many instructions lay between the start of the program and the motion.
    pub steps: u64,
    /// Where the joints were.
    pub joints: JointConfiguration,
}

impl Aside {
    fn from_words(words: [u64; 7]) -> Self {
        let [steps, joints @ ..] = words;
        Self { steps, joints: JointConfiguration(joints.map(f64::from_bits)) }
    }

    /// Push it.
    pub fn push(&self, recorder: &mut impl Recorder) {
        let [a, b, c, d, e, f] = self.joints.bits();
        recorder.aside([self.steps, a, b, c, d, e, f]);
    }

    /// Pop the newest, if it is that of the motion before which so many instructions lay.
    pub fn pop(tape: &mut Tape, steps: u64) -> Option<Self> {
        let aside = Self::peek(tape, steps)?;
        tape.asides.pop();
        Some(aside)
    }

    /// Read it without popping.
    #[must_use]
    pub fn peek(tape: &Tape, steps: u64) -> Option<Self> {
        tape.asides.last().map(Self::from_words).filter(|aside| aside.steps == steps)
    }
}

/// Where a task was held when a fork was left. What its calls held is a [`Frame`] each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeldTask {
    /// The next instruction.
    pub pc: u32,
    /// Whether it had come to its end.
    pub is_done: bool,
    /// Until when it waited, in nanoseconds of the fork's time.
    pub until_ns: u64,
    /// Its calls, outermost first: the function, and where the caller goes on.
    pub calls: Vec<(u16, u32)>,
}

/// The tasks that were held when a fork was left, by branch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tasks(pub Vec<HeldTask>);

impl Tasks {
    /// Push it.
    pub fn push(&self, recorder: &mut impl Recorder) {
        for task in &self.0 {
            for (function, return_pc) in &task.calls {
                recorder.control(u64::from(*function) << 32 | u64::from(*return_pc));
            }
            recorder.control(task.until_ns);
            let calls = task.calls.len() as u64;
            recorder.control(calls << 33 | u64::from(task.is_done) << 32 | u64::from(task.pc));
        }
    }

    /// Pop those of a fork with so many branches.
    pub fn pop(tape: &mut Tape, branches: usize) -> Option<Self> {
        pop_many(branches, || {
            let word = tape.control.pop()?;
            let until_ns = tape.control.pop()?;
            let count = usize::try_from(word >> 33).ok().filter(|&n| n <= tape.control.len())?;
            let call = |word: u64| ((word >> 32) as u16, word as u32);
            let calls = pop_many(count, || tape.control.pop().map(call))?;
            let (pc, is_done) = (word as u32, word & 1 << 32 != 0);
            Some(HeldTask { pc, is_done, until_ns, calls })
        })
        .map(Self)
    }
}

fn pop_many<T>(count: usize, mut pop: impl FnMut() -> Option<T>) -> Option<Vec<T>> {
    let mut all = (0..count).map(|_| pop()).collect::<Option<Vec<_>>>()?;
    all.reverse();
    Some(all)
}
