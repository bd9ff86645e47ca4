//! Notes of recoveries: what went wrong where, what was tried against it, and what came of it.
//!
//! They say what happened, so that going back takes nothing from them, and no machine reads them:
//! what a file says here is shown and never acted on. Knows nothing of why it was tried.

use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The most notes that are kept, the newest ones.
pub const NOTES_MAX: usize = 4096;

/// Something that happened in a recovery.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// How many instructions lay between the start of the program and where the run was.
    pub steps: u64,
    /// When, in seconds of the workcell's clock.
    pub time_s: f64,
    /// The error, by its place in the module's table.
    pub error: u16,
    /// The instruction at which it was due, or at which a fault became the error.
    pub pc: u32,
    /// How many attempts there had been.
    pub attempts: u32,
    /// What happened.
    pub what: Noted,
}

/// What happened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Noted {
    /// A fault became the error.
    Fault,
    /// The run went back.
    Back {
        /// By so many actions.
        actions: u32,
        /// To this instruction.
        to: u32,
    },
    /// The program alone went back.
    InPlace {
        /// How far the tool was backed up before, in metres.
        backed_up_m: Option<f64>,
    },
    /// The way back was blocked at this instruction.
    Blocked {
        /// The instruction that was being reversed.
        at: u32,
    },
    /// The run went forward again.
    Again {
        /// How many names slower each motion was.
        slower: u8,
        /// By what each force limit was multiplied.
        force_factor: Option<f64>,
        /// How far aside the motion was made that had failed, in metres.
        aside_m: Option<[f64; 2]>,
    },
    /// The run got past the error.
    Recovered,
    /// The error was given up.
    GivenUp {
        /// The word for why.
        why: String,
    },
}

/// The newest notes of a run, oldest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Notes {
    kept: VecDeque<Note>,
    dropped: u64,
}

impl Notes {
    /// One more; the oldest goes where there are too many.
    pub fn push(&mut self, note: Note) {
        if self.kept.len() >= NOTES_MAX {
            self.kept.pop_front();
            self.dropped = self.dropped.saturating_add(1);
        }
        self.kept.push_back(note);
    }

    /// They, oldest first.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &Note> {
        self.kept.iter()
    }

    /// How many are no longer kept.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_notes_are_kept_and_the_others_counted() {
        let mut notes = Notes::default();
        for steps in 0..NOTES_MAX as u64 + 3 {
            let what = Noted::Recovered;
            notes.push(Note { steps, time_s: 0.0, error: 0, pc: 0, attempts: 0, what });
        }
        assert_eq!(notes.iter().count(), NOTES_MAX);
        assert_eq!(notes.iter().next().map(|note| note.steps), Some(3));
        assert_eq!(notes.dropped(), 3);
    }
}
