//! Stacks in chunks of a fixed size that are kept and used again.
//!
//! Growing never moves what is there, and memory that has been touched once is used again after a
//! reversal or a barrier: fresh pages cost more than the records in them. Copies of a stream have
//! their full chunks in common, so that one may be kept at every place of a long run.

use std::sync::Arc;

/// Elements of a chunk.
pub const CHUNK: usize = 4096;

/// A stack of elements.
#[derive(Debug)]
pub struct Stream<T> {
    /// The chunk that is being filled.
    chunk: Vec<T>,
    /// Chunks that cannot hold more, oldest first. None is empty, and nothing is written to one
    /// while a copy has it too.
    full: Vec<Arc<Vec<T>>>,
    /// How many elements are in those.
    in_full: usize,
    /// An empty chunk for later use.
    spare: Option<Vec<T>>,
}

impl<T> Default for Stream<T> {
    fn default() -> Self {
        Self { chunk: Vec::new(), full: Vec::new(), in_full: 0, spare: None }
    }
}

impl<T: Clone> Clone for Stream<T> {
    fn clone(&self) -> Self {
        let Self { chunk, full, in_full, spare: _ } = self;
        Self { chunk: chunk.clone(), full: full.clone(), in_full: *in_full, spare: None }
    }
}

impl<T: Copy> Stream<T> {
    /// How many elements there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.in_full + self.chunk.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether an element can be pushed where memory is held already.
    #[inline(always)]
    #[must_use]
    pub fn has_room(&self) -> bool {
        self.chunk.len() < self.chunk.capacity()
    }

    /// Make room where there is none.
    #[cold]
    #[inline(never)]
    pub fn make_room(&mut self) {
        let next = self.spare.take().unwrap_or_else(|| Vec::with_capacity(CHUNK));
        let filled = std::mem::replace(&mut self.chunk, next);
        if !filled.is_empty() {
            self.in_full += filled.len();
            self.full.push(Arc::new(filled));
        }
    }

    /// Push an element.
    #[inline(always)]
    pub fn push(&mut self, element: T) {
        // So that the vector never grows.
        if !self.has_room() {
            self.make_room();
        }
        self.chunk.push(element);
    }

    /// Pop the newest element.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        match self.chunk.pop() {
            None => self.pop_from_previous_chunk(),
            element => element,
        }
    }

    /// The newest element.
    #[must_use]
    pub fn last(&self) -> Option<T> {
        self.chunk.last().or_else(|| self.full.last()?.last()).copied()
    }

    /// Drop all but the oldest `length` elements.
    pub fn truncate(&mut self, length: usize) {
        while self.len() > length {
            self.chunk.truncate(length.saturating_sub(self.in_full));
            if self.chunk.is_empty() {
                self.previous_chunk();
            }
        }
    }

    /// The elements, oldest first.
    pub fn iter(&self) -> impl Iterator<Item = T> + '_ {
        self.full.iter().flat_map(|chunk| chunk.iter()).chain(&self.chunk).copied()
    }

    /// How many chunks are full.
    #[inline(always)]
    #[must_use]
    pub fn full_chunks(&self) -> usize {
        self.full.len()
    }

    /// The memory that is held, in bytes, in use or spare.
    #[must_use]
    pub fn held_bytes(&self) -> usize {
        let full = self.full.iter().map(|chunk| &**chunk);
        let chunks = full.chain(&self.spare).chain([&self.chunk]);
        chunks.map(|chunk| chunk.capacity() * size_of::<T>()).sum()
    }

    #[cold]
    #[inline(never)]
    fn pop_from_previous_chunk(&mut self) -> Option<T> {
        self.previous_chunk();
        self.chunk.pop()
    }

    /// Go on in the newest full chunk, if there is one, in place of the empty one.
    fn previous_chunk(&mut self) {
        let Some(previous) = self.full.pop() else { return };
        self.in_full -= previous.len();
        let previous = Arc::try_unwrap(previous).unwrap_or_else(|shared| (*shared).clone());
        let emptied = std::mem::replace(&mut self.chunk, previous);
        // That of a copy may be smaller.
        if emptied.capacity() >= CHUNK {
            self.spare = Some(emptied);
        }
    }
}

impl<T: Copy> FromIterator<T> for Stream<T> {
    fn from_iter<I: IntoIterator<Item = T>>(elements: I) -> Self {
        let mut stream = Self::default();
        for element in elements {
            stream.push(element);
        }
        stream
    }
}

/// Bits of a word, beside the sentinel.
pub(crate) const WORD_BITS: usize = 63;

/// A stack of bits.
#[derive(Clone, Debug)]
pub struct BitStream {
    /// The newest bits below a sentinel: the newest is the lowest, and 1 means none.
    word: u64,
    /// Words before it, each with its sentinel at the top.
    words: Stream<u64>,
}

impl Default for BitStream {
    fn default() -> Self {
        Self { word: 1, words: Stream::default() }
    }
}

impl BitStream {
    fn filled(&self) -> usize {
        filled(self.word)
    }

    /// How many bits there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.words.len() * WORD_BITS + self.filled()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether a bit can be pushed where memory is held already.
    #[inline(always)]
    #[must_use]
    pub fn has_room(&self) -> bool {
        self.word >> WORD_BITS == 0
    }

    /// Make room where there is none.
    #[cold]
    #[inline(never)]
    pub fn make_room(&mut self) {
        self.words.push(self.word);
        self.word = 1;
    }

    /// Push a bit.
    #[inline(always)]
    pub fn push(&mut self, bit: bool) {
        if !self.has_room() {
            self.make_room();
        }
        self.word = self.word << 1 | u64::from(bit);
    }

    /// Pop the newest bit.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<bool> {
        if self.word == 1 {
            self.word = self.words.pop()?;
        }
        let bit = self.word & 1 == 1;
        self.word >>= 1;
        Some(bit)
    }

    /// The newest bit.
    #[must_use]
    pub fn last(&self) -> Option<bool> {
        let word = if self.word == 1 { self.words.last()? } else { self.word };
        Some(word & 1 == 1)
    }

    /// Drop all but the oldest `length` bits.
    pub fn truncate(&mut self, length: usize) {
        while self.len() > length {
            let above = self.len() - length;
            let filled = self.filled();
            if filled == 0 {
                self.words.truncate(self.words.len().min(length / WORD_BITS + 1));
                self.pop();
            } else {
                self.word >>= filled.min(above);
            }
        }
    }

    /// The bits, oldest first.
    pub fn iter(&self) -> impl Iterator<Item = bool> + '_ {
        let words = self.words.iter().chain([self.word]);
        words.flat_map(|word| (0..filled(word)).rev().map(move |at| word >> at & 1 == 1))
    }

    /// The memory that is held, in bytes.
    #[must_use]
    pub fn held_bytes(&self) -> usize {
        self.words.held_bytes() + 8
    }

    /// How many chunks are full.
    #[inline(always)]
    #[must_use]
    pub fn full_chunks(&self) -> usize {
        self.words.full_chunks()
    }
}

/// How many bits are below the sentinel.
fn filled(word: u64) -> usize {
    WORD_BITS - word.leading_zeros() as usize
}

impl FromIterator<bool> for BitStream {
    fn from_iter<I: IntoIterator<Item = bool>>(bits: I) -> Self {
        let mut stream = Self::default();
        for bit in bits {
            stream.push(bit);
        }
        stream
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_pops_what_was_pushed_over_chunks_and_back() {
        let mut stream = Stream::default();
        for number in 0..3 * CHUNK as u64 {
            stream.push(number);
        }
        assert_eq!(stream.len(), 3 * CHUNK);
        for number in (0..3 * CHUNK as u64).rev() {
            assert_eq!(stream.last(), Some(number));
            assert_eq!(stream.pop(), Some(number));
        }
        assert_eq!(stream.pop(), None);
        assert_eq!(stream.last(), None);
    }

    #[test]
    fn truncating_leaves_the_oldest() {
        for length in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 3 * CHUNK - 1, 3 * CHUNK] {
            let mut stream: Stream<u64> = (0..3 * CHUNK as u64).collect();
            stream.truncate(length);
            assert!(stream.iter().eq(0..length as u64), "length {length}");
            stream.push(7);
            assert_eq!(stream.pop(), Some(7));
        }
    }

    #[test]
    fn what_was_copied_goes_on_like_what_it_was_copied_from() {
        for length in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1] {
            let mut stream = (0..length as u64).collect::<Stream<u64>>().clone();
            (length..3 * CHUNK).for_each(|number| stream.push(number as u64));
            assert_eq!(stream.len(), 3 * CHUNK);
            assert!(stream.iter().eq(0..3 * CHUNK as u64), "length {length}");
            stream.truncate(length / 2);
            assert!(stream.iter().eq(0..length as u64 / 2), "length {length}");
        }
    }

    #[test]
    fn pushing_where_there_is_room_holds_no_more_memory() {
        let (mut words, mut bits) = (Stream::default(), BitStream::default());
        for number in 0..3 * CHUNK as u64 {
            let (words_held, bits_held) = (words.held_bytes(), bits.held_bytes());
            let (words_had_room, bits_had_room) = (words.has_room(), bits.has_room());
            words.push(number);
            bits.push(number & 1 == 1);
            assert!(!words_had_room || words.held_bytes() == words_held, "word {number}");
            assert!(!bits_had_room || bits.held_bytes() == bits_held, "bit {number}");
        }
    }

    #[test]
    fn a_copy_stays_as_it_was() {
        let numbers = 0..3 * CHUNK as u64 + 7;
        let mut stream: Stream<u64> = numbers.clone().collect();
        let copy = stream.clone();
        stream.truncate(CHUNK / 2);
        (0..3 * CHUNK).for_each(|_| stream.push(u64::MAX));
        assert!(copy.iter().eq(numbers));
        assert_eq!(stream.iter().filter(|number| *number == u64::MAX).count(), 3 * CHUNK);
    }

    #[test]
    fn bits_keep_their_order_and_their_length() {
        let bits: Vec<bool> =
            (0_u64..1000).map(|n| n.wrapping_mul(0x9e37_79b9) >> 7 & 1 == 1).collect();
        for length in [0, 1, 62, 63, 64, 125, 126, 127, 999, 1000] {
            let mut stream: BitStream = bits.iter().copied().collect();
            stream.truncate(length);
            assert_eq!(stream.len(), length);
            assert!(stream.iter().eq(bits[..length].iter().copied()), "length {length}");
            assert_eq!(stream.last(), bits[..length].last().copied());
            for bit in bits[..length].iter().rev() {
                assert_eq!(stream.pop(), Some(*bit));
            }
            assert_eq!(stream.pop(), None);
        }
    }

    #[test]
    fn going_back_and_forth_over_a_chunk_boundary_allocates_once() {
        let mut stream: Stream<u64> = (0..CHUNK as u64).collect();
        stream.push(1);
        let held = stream.held_bytes();
        for _ in 0..10 {
            stream.pop();
            stream.pop();
            stream.push(1);
            stream.push(2);
        }
        assert_eq!(stream.held_bytes(), held);
    }
}
