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
    chunk: Box<[T; CHUNK]>,
    /// How many elements of it are in use.
    top: usize,
    /// Full chunks, oldest first. Nothing is written to one while a copy has it too.
    #[expect(clippy::redundant_allocation, reason = "a chunk is filled in a box and never moved")]
    full: Vec<Arc<Box<[T; CHUNK]>>>,
    /// Chunks for later use: never more than one, unless a barrier freed them.
    spare: Vec<Box<[T; CHUNK]>>,
}

impl<T: Copy + Default> Default for Stream<T> {
    fn default() -> Self {
        Self { chunk: fresh(), top: 0, full: Vec::new(), spare: Vec::new() }
    }
}

impl<T: Copy + Default> Clone for Stream<T> {
    fn clone(&self) -> Self {
        let mut chunk = fresh();
        chunk[..self.top].copy_from_slice(&self.chunk[..self.top]);
        Self { chunk, top: self.top, full: self.full.clone(), spare: Vec::new() }
    }
}

fn fresh<T: Copy + Default>() -> Box<[T; CHUNK]> {
    let elements = vec![T::default(); CHUNK].into_boxed_slice();
    match elements.try_into() {
        Ok(chunk) => chunk,
        Err(_) => unreachable!("the slice has CHUNK elements"),
    }
}

impl<T: Copy + Default> Stream<T> {
    /// How many elements there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.full.len() * CHUNK + self.top
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Push an element.
    #[inline(always)]
    pub fn push(&mut self, element: T) {
        // One check serves as bound and as the end of the chunk.
        if let Some(place) = self.chunk.get_mut(self.top) {
            *place = element;
            self.top += 1;
        } else {
            self.push_in_next_chunk(element);
        }
    }

    /// Pop the newest element.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        if self.top == 0 && !self.previous_chunk() {
            return None;
        }
        self.top -= 1;
        self.chunk.get(self.top).copied()
    }

    /// The newest element.
    #[must_use]
    pub fn last(&self) -> Option<T> {
        match self.top {
            0 => self.full.last().map(|chunk| chunk[CHUNK - 1]),
            top => Some(self.chunk[top - 1]),
        }
    }

    /// Drop all but the oldest `length` elements.
    pub fn truncate(&mut self, length: usize) {
        while self.len() > length {
            let above = self.len() - length;
            if above <= self.top {
                self.top -= above;
            } else {
                self.top = 0;
                self.previous_chunk();
            }
        }
    }

    /// The elements, oldest first.
    pub fn iter(&self) -> impl Iterator<Item = T> + '_ {
        self.full
            .iter()
            .flat_map(|chunk| chunk.as_slice())
            .chain(self.chunk[..self.top].iter())
            .copied()
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
        (self.full.len() + self.spare.len() + 1) * CHUNK * size_of::<T>()
    }

    #[cold]
    #[inline(never)]
    fn push_in_next_chunk(&mut self, element: T) {
        let next = self.spare.pop().unwrap_or_else(fresh);
        self.full.push(Arc::new(std::mem::replace(&mut self.chunk, next)));
        self.chunk[0] = element;
        self.top = 1;
    }

    #[cold]
    #[inline(never)]
    fn previous_chunk(&mut self) -> bool {
        let Some(previous) = self.full.pop() else { return false };
        let previous = Arc::try_unwrap(previous).unwrap_or_else(|shared| (*shared).clone());
        let emptied = std::mem::replace(&mut self.chunk, previous);
        if self.spare.is_empty() {
            self.spare.push(emptied);
        }
        self.top = CHUNK;
        true
    }
}

impl<T: Copy + Default> FromIterator<T> for Stream<T> {
    fn from_iter<I: IntoIterator<Item = T>>(elements: I) -> Self {
        let mut stream = Self::default();
        for element in elements {
            stream.push(element);
        }
        stream
    }
}

/// A stack of bits, 64 to a word.
#[derive(Clone, Debug)]
pub struct BitStream {
    /// The newest bits below a sentinel: the newest is the lowest, and 1 means none.
    word: u64,
    /// Full words.
    words: Stream<u64>,
}

impl Default for BitStream {
    fn default() -> Self {
        Self { word: 1, words: Stream::default() }
    }
}

impl BitStream {
    fn filled(&self) -> u32 {
        63 - self.word.leading_zeros()
    }

    /// How many bits there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.words.len() * 64 + self.filled() as usize
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Push a bit.
    #[inline(always)]
    pub fn push(&mut self, bit: bool) {
        let is_last = self.word >> 63 == 1;
        self.word = self.word << 1 | u64::from(bit);
        if is_last {
            self.words.push(self.word);
            self.word = 1;
        }
    }

    /// Pop the newest bit.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<bool> {
        if self.word == 1 {
            let word = self.words.pop()?;
            self.word = word >> 1 | 1 << 63;
            return Some(word & 1 == 1);
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
            let filled = self.filled() as usize;
            if filled == 0 {
                self.words.truncate(self.words.len().min(length / 64 + 1));
                self.pop();
            } else {
                self.word >>= filled.min(above);
            }
        }
    }

    /// The bits, oldest first.
    pub fn iter(&self) -> impl Iterator<Item = bool> + '_ {
        let full =
            self.words.iter().flat_map(|word| (0..64).rev().map(move |at| word >> at & 1 == 1));
        let newest = (0..self.filled()).rev().map(|at| self.word >> at & 1 == 1);
        full.chain(newest)
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
        for length in [0, 1, 63, 64, 65, 127, 128, 129, 999, 1000] {
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
