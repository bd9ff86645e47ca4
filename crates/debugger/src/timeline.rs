//! Copies of a machine along a run, so that every moment of it is near one.
//!
//! There are never more than [`MAX_KEPT`]: when there would be, every other one is dropped and the
//! next are taken twice as far apart. The full part of the tape is shared between them.

use crate::recording::Moment;
use crate::replay::Cursor;
use obverse_vm::Kept;

/// The most copies that are kept.
pub const MAX_KEPT: usize = 96;

/// How far apart they are taken at first, in instructions: a few milliseconds of running.
pub const FIRST_INTERVAL: u64 = 1 << 20;

/// A machine in a recording at a moment.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    /// When.
    pub moment: Moment,
    /// Which stretch of the recording it was in.
    pub stretch: usize,
    /// The place in the recording.
    pub cursor: Cursor,
    /// The machine.
    pub kept: Kept,
}

/// The copies along a run, oldest first.
#[derive(Clone, Debug)]
pub struct Timeline {
    kept: Vec<Checkpoint>,
    interval: u64,
}

impl Timeline {
    /// Of a run that begins here.
    #[must_use]
    pub fn new(start: Checkpoint) -> Self {
        Self { kept: vec![start], interval: FIRST_INTERVAL }
    }

    /// How many instructions from a moment until the next copy is to be taken; none if it is due.
    #[must_use]
    pub fn until_due(&self, now: Moment) -> Option<u64> {
        let newest = self.kept.last().map_or(0, |newest| newest.moment.0);
        newest.saturating_add(self.interval).checked_sub(now.0).filter(|left| *left > 0)
    }

    /// Keep one, newer than all others.
    pub fn keep(&mut self, checkpoint: Checkpoint) {
        if self.kept.len() >= MAX_KEPT {
            let mut number = 0;
            self.kept.retain(|_| {
                number += 1;
                number % 2 == 1
            });
            self.interval *= 2;
        }
        self.kept.push(checkpoint);
    }

    /// The newest that is not after a moment.
    #[must_use]
    pub fn before(&self, moment: Moment) -> &Checkpoint {
        let after = self.kept.partition_point(|kept| kept.moment <= moment);
        &self.kept[after.saturating_sub(1)]
    }

    /// The newest that had answered fewer than so many commands.
    #[must_use]
    pub fn before_frame(&self, frame: usize) -> &Checkpoint {
        let after = self.kept.partition_point(|kept| kept.cursor.frame() < frame);
        &self.kept[after.saturating_sub(1)]
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.kept.len()
    }

    /// Whether there are none, which is never so.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }

    /// The start, and those before a moment.
    #[must_use]
    pub(crate) fn before_all_of(&self, moment: Moment) -> Self {
        let before = self.kept.partition_point(|kept| kept.moment < moment).max(1);
        Self { kept: self.kept[..before].to_vec(), interval: self.interval }
    }
}
