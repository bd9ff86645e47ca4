//! The kinds of record, one type each, named as the instruction table names them.
//!
//! What an opcode saves is a type here, so that an implementation that saves something else does
//! not compile. A record knows which streams it goes to, and how to come back from them.

use crate::tape::{Recorder, Tape};
use obverse_geometry::JointConfiguration;

/// A record: pushed before its instruction acts, popped after it has been reversed.
pub trait Record: Sized {
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

fn pop_many<T>(count: usize, mut pop: impl FnMut() -> Option<T>) -> Option<Vec<T>> {
    let mut all = (0..count).map(|_| pop()).collect::<Option<Vec<_>>>()?;
    all.reverse();
    Some(all)
}
