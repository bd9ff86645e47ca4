//! The tape: its streams, positions on it, the barrier, and how much it has recorded.

use crate::note::{Note, Notes};
use crate::snapshot::Snapshot;
use crate::stream::{BitStream, CHUNK, Stream};
use obverse_geometry::JointConfiguration;

/// What records are written to: a tape, or nothing at all.
///
/// Whoever asks for room before a word or a bit is written, and has it made, keeps what gets memory
/// out of a loop.
pub trait Recorder {
    /// Whether the next bit can be written where memory is held already.
    fn has_room_for_bit(&self) -> bool;
    /// Whether the next word can be written where memory is held already.
    fn has_room_for_word(&self) -> bool;
    /// See to it that there is room for a bit and for a word.
    fn make_room(&mut self);
    /// Write a bit.
    fn bit(&mut self, bit: bool);
    /// Write a word.
    fn word(&mut self, word: u64);
    /// Write a joint configuration.
    fn joints(&mut self, joints: JointConfiguration);
    /// Write a word on whose turn it was.
    fn control(&mut self, word: u64);
    /// Write a word on a fault that became an error.
    fn fault(&mut self, word: u64);
    /// Write where a motion began that was made aside.
    fn aside(&mut self, words: [u64; 7]);
}

/// The recorder of a run that will not go back.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoTape;

impl Recorder for NoTape {
    #[inline(always)]
    fn has_room_for_bit(&self) -> bool {
        true
    }
    #[inline(always)]
    fn has_room_for_word(&self) -> bool {
        true
    }
    fn make_room(&mut self) {}
    #[inline(always)]
    fn bit(&mut self, _: bool) {}
    #[inline(always)]
    fn word(&mut self, _: u64) {}
    #[inline(always)]
    fn joints(&mut self, _: JointConfiguration) {}
    #[inline(always)]
    fn control(&mut self, _: u64) {}
    #[inline(always)]
    fn fault(&mut self, _: u64) {}
    fn aside(&mut self, _: [u64; 7]) {}
}

/// A place on the tape: the length of each stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Place {
    /// Recorded joins and output levels.
    pub bits: u64,
    /// Values of variables, settings, counters.
    pub words: u64,
    /// Joint configurations.
    pub joints: u64,
    /// Words on the turns of tasks.
    pub control: u64,
    /// Faults that became errors.
    pub faults: u64,
    /// Motions that were made aside.
    pub asides: u64,
}

impl Place {
    /// The size of the tape up to here, in bits.
    #[must_use]
    pub fn size_bits(&self) -> u64 {
        let words = self.words + self.control + self.faults + 7 * self.asides;
        self.bits + 64 * words + 384 * self.joints
    }
}

/// The trace tape.
#[derive(Clone, Debug)]
pub struct Tape {
    pub(crate) bits: BitStream,
    pub(crate) words: Stream<u64>,
    pub(crate) joints: Stream<[f64; 6]>,
    pub(crate) control: Stream<u64>,
    pub(crate) faults: Stream<u64>,
    pub(crate) asides: Stream<[u64; 7]>,
    /// The state in which all that was under way was left for the cleanup, if it was.
    left: Option<Box<Snapshot>>,
    /// What happened in recoveries; going back takes nothing from it.
    notes: Notes,
    /// What has been recorded and dropped, in bits.
    dropped_bits: u64,
    /// The most full chunks that may be held, each as large as one of words.
    limit_chunks: usize,
}

/// The most that a tape holds unless told otherwise, in bytes.
pub const DEFAULT_LIMIT_BYTES: usize = 4 << 30;

impl Default for Tape {
    fn default() -> Self {
        Self::with_limit(DEFAULT_LIMIT_BYTES)
    }
}

impl Recorder for Tape {
    #[inline(always)]
    fn has_room_for_bit(&self) -> bool {
        self.bits.has_room()
    }

    #[inline(always)]
    fn has_room_for_word(&self) -> bool {
        self.words.has_room()
    }

    fn make_room(&mut self) {
        if !self.has_room_for_bit() {
            self.bits.make_room();
        }
        if !self.has_room_for_word() {
            self.words.make_room();
        }
    }

    #[inline(always)]
    fn bit(&mut self, bit: bool) {
        self.bits.push(bit);
    }

    #[inline(always)]
    fn word(&mut self, word: u64) {
        self.words.push(word);
    }

    #[inline(always)]
    fn joints(&mut self, joints: JointConfiguration) {
        self.joints.push(joints.0);
    }

    fn control(&mut self, word: u64) {
        self.control.push(word);
    }

    fn fault(&mut self, word: u64) {
        self.faults.push(word);
    }

    fn aside(&mut self, words: [u64; 7]) {
        self.asides.push(words);
    }
}

impl Tape {
    /// An empty tape that holds at most so many bytes.
    #[must_use]
    pub fn with_limit(limit_bytes: usize) -> Self {
        Self {
            bits: BitStream::default(),
            words: Stream::default(),
            joints: Stream::default(),
            control: Stream::default(),
            faults: Stream::default(),
            asides: Stream::default(),
            left: None,
            notes: Notes::default(),
            dropped_bits: 0,
            limit_chunks: limit_bytes / (CHUNK * 8),
        }
    }

    /// How far it has come.
    #[must_use]
    pub fn place(&self) -> Place {
        Place {
            bits: self.bits.len() as u64,
            words: self.words.len() as u64,
            joints: self.joints.len() as u64,
            control: self.control.len() as u64,
            faults: self.faults.len() as u64,
            asides: self.asides.len() as u64,
        }
    }

    /// How many chunks are full, each as large as one of words.
    fn held_chunks(&self) -> usize {
        let joints = self.joints.full_chunks() * size_of::<[f64; 6]>() / size_of::<u64>();
        let words = self.words.full_chunks() + self.control.full_chunks();
        let asides = self.asides.full_chunks() * size_of::<[u64; 7]>() / size_of::<u64>();
        let words = words + self.faults.full_chunks() + asides;
        words + self.bits.full_chunks() + joints
    }

    /// Whether more has been recorded than may be.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.held_chunks() > self.limit_chunks
    }

    /// How many words, or bits in their place, can be recorded for certain before it is full:
    /// whoever records no more need not ask in between.
    #[must_use]
    pub fn room_words(&self) -> u64 {
        // The chunks that are being filled, of words and of bits, may be about to be full.
        let chunks = self.limit_chunks.saturating_sub(self.held_chunks() + 1);
        (chunks as u64).saturating_mul(CHUNK as u64)
    }

    /// Whether nothing is on it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.place() == Place::default()
    }

    /// Drop what has been recorded since a position.
    pub fn cut(&mut self, to: Place) {
        let before_bits = self.place().size_bits();
        self.bits.truncate(to.bits as usize);
        self.words.truncate(to.words as usize);
        self.joints.truncate(to.joints as usize);
        self.control.truncate(to.control as usize);
        self.faults.truncate(to.faults as usize);
        self.asides.truncate(to.asides as usize);
        // What a file says was dropped is not believed.
        let dropped_bits = before_bits - self.place().size_bits();
        self.dropped_bits = self.dropped_bits.saturating_add(dropped_bits);
    }

    /// Nothing before this can be reversed: drop it.
    pub fn barrier(&mut self) {
        self.cut(Place::default());
        self.left = None;
    }

    /// All that was under way is left for the cleanup, in this state.
    pub fn leave(&mut self, state: Snapshot) {
        self.left = Some(Box::new(state));
    }

    /// How many instructions lay between the start and where all was left, if it was.
    #[inline]
    #[must_use]
    pub fn left_steps(&self) -> Option<u64> {
        self.left.as_ref().map(|state| state.steps)
    }

    /// The state in which all was left; the tape keeps it no more.
    pub fn take_left(&mut self) -> Option<Snapshot> {
        self.left.take().map(|state| *state)
    }

    /// Note what happened in a recovery.
    pub fn note(&mut self, note: Note) {
        self.notes.push(note);
    }

    /// What happened in recoveries.
    #[must_use]
    pub fn notes(&self) -> &Notes {
        &self.notes
    }

    /// All that was recorded, whether it has been dropped or not, in bits; what has been reversed
    /// does not count.
    #[must_use]
    pub fn recorded_bits(&self) -> u64 {
        self.dropped_bits.saturating_add(self.place().size_bits())
    }

    /// The memory that is held, in bytes.
    #[must_use]
    pub fn held_bytes(&self) -> usize {
        let words = self.words.held_bytes() + self.control.held_bytes();
        let words = words + self.faults.held_bytes() + self.asides.held_bytes();
        self.bits.held_bytes() + words + self.joints.held_bytes()
    }

    /// The newest bit.
    #[must_use]
    pub fn newest_bit(&self) -> Option<bool> {
        self.bits.last()
    }

    /// The newest word.
    #[must_use]
    pub fn newest_word(&self) -> Option<u64> {
        self.words.last()
    }

    /// The newest joint configuration, in radians.
    #[must_use]
    pub fn newest_joints(&self) -> Option<[f64; 6]> {
        self.joints.last()
    }

    /// The newest word on the turns of tasks.
    #[must_use]
    pub fn newest_control(&self) -> Option<u64> {
        self.control.last()
    }

    /// Every record as plain data, oldest first.
    #[must_use]
    pub fn streams(&self) -> Streams {
        Streams {
            bits: self.bits.iter().collect(),
            words: self.words.iter().collect(),
            joints: self.joints.iter().collect(),
            control: self.control.iter().collect(),
            faults: self.faults.iter().collect(),
            asides: self.asides.iter().collect(),
            left: self.left.clone(),
            notes: self.notes.clone(),
            dropped_bits: self.dropped_bits,
        }
    }

    /// The tape of these records.
    #[must_use]
    pub fn from_streams(streams: &Streams) -> Self {
        Self {
            bits: streams.bits.iter().copied().collect(),
            words: streams.words.iter().copied().collect(),
            joints: streams.joints.iter().copied().collect(),
            control: streams.control.iter().copied().collect(),
            faults: streams.faults.iter().copied().collect(),
            asides: streams.asides.iter().copied().collect(),
            left: streams.left.clone(),
            notes: streams.notes.clone(),
            dropped_bits: streams.dropped_bits,
            limit_chunks: DEFAULT_LIMIT_BYTES / (CHUNK * 8),
        }
    }
}

/// The records of a tape as plain data, oldest first.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Streams {
    /// Recorded joins and output levels.
    pub bits: Vec<bool>,
    /// Values of variables, settings, counters.
    pub words: Vec<u64>,
    /// Joint configurations in radians.
    pub joints: Vec<[f64; 6]>,
    /// Words on the turns of tasks.
    pub control: Vec<u64>,
    /// Words on the faults that became errors.
    pub faults: Vec<u64>,
    /// Where motions began that were made aside: how many instructions lay before, and the joints.
    pub asides: Vec<[u64; 7]>,
    /// The state in which all that was under way was left for the cleanup, if it was.
    pub left: Option<Box<Snapshot>>,
    /// What happened in recoveries.
    pub notes: Notes,
    /// What was recorded before and dropped, in bits.
    pub dropped_bits: u64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::WORD_BITS;

    #[test]
    fn a_tape_is_not_full_before_its_room_is_used_up() {
        let mut tape = Tape::with_limit(5 * CHUNK * 8);
        // The next bit needs another chunk, and the next word but one.
        (0..WORD_BITS * (CHUNK + 1)).for_each(|_| tape.bit(true));
        (1..CHUNK).for_each(|_| tape.word(7));
        let mut asked = 0;
        while !tape.is_full() {
            asked += 1;
            for _ in 0..tape.room_words() {
                tape.word(7);
                assert!(!tape.is_full(), "after {} words", tape.place().words);
            }
            tape.bit(true);
            tape.word(7);
        }
        assert_eq!(tape.place().words, 5 * CHUNK as u64 + 1);
        assert_eq!(asked, 2);
    }
}
