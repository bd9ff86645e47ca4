//! How far to go back next.
//!
//! Knows the policy of an error, what has been tried, and how far the trail leads; not how going
//! back is done.

use crate::ending::GiveUp;
use crate::memory::{Costs, DEPTH_MAX, Memory};
use crate::tell::Why;
use crate::trail::Trail;
use obverse_bytecode::{Depth, Extent, Reversal};
use obverse_isa::CheckpointId;

/// What the next depth depends on.
pub(crate) struct Question<'q> {
    pub(crate) trail: &'q Trail<'q>,
    /// The name of the error, and the place in words.
    pub(crate) error: &'q str,
    pub(crate) place: &'q str,
    /// How far each attempt has gone back.
    pub(crate) tried: &'q [usize],
    /// What going back so many actions and coming again is expected to take, in seconds.
    pub(crate) costs_s: &'q dyn Fn(usize) -> f64,
    /// What a person takes, in seconds.
    pub(crate) give_up_s: f64,
    /// How many attempts there may still be.
    pub(crate) attempts_left: u32,
}

/// What is asked for, before it is known whether the trail leads there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Policy {
    pub(crate) depth: Depth,
    /// The furthest, in actions, or a place.
    pub(crate) extent: Extent,
}

impl Policy {
    pub(crate) fn of(reversal: &Reversal) -> Self {
        Self { depth: reversal.depth, extent: reversal.extent }
    }

    /// One that is bounded by the trail alone.
    pub(crate) fn unbounded(depth: Depth) -> Self {
        Self { depth, extent: Extent::Actions(u32::MAX) }
    }
}

impl Question<'_> {
    /// How many actions to go back, and why so many.
    ///
    /// # Errors
    /// Why there is no way back, or none that would help.
    pub(crate) fn answer(
        &self,
        policy: Policy,
        memory: &mut Memory,
    ) -> Result<(usize, Why), GiveUp> {
        let available = self.trail.actions().len();
        if available == 0 {
            return Err(GiveUp::NoWayBack { never: self.trail.never() });
        }
        let asked = self.furthest(policy.extent);
        let furthest = asked.map_or(available, |asked| asked.min(available)).max(1);
        let is_whole = asked.is_some_and(|asked| asked <= available);
        let tries = self.tried.len();
        let (wanted, why) = match policy.depth {
            Depth::Fixed => (asked.unwrap_or(usize::MAX), self.why(policy.extent)),
            Depth::Escalating { doubling } => {
                let wanted = if doubling {
                    1_usize.checked_shl(tries as u32).unwrap_or(usize::MAX)
                } else {
                    tries + 1
                };
                let why = if tries == 0 { Why::Said } else { Why::Further };
                (wanted.min(asked.unwrap_or(usize::MAX)), why)
            }
            Depth::Learned => return self.learned(furthest, memory),
        };
        if wanted > furthest || !is_whole && wanted == usize::MAX {
            return Ok((furthest, Why::AsFarAsPossible));
        }
        Ok((wanted, why))
    }

    fn why(&self, extent: Extent) -> Why {
        match extent {
            Extent::Actions(_) => Why::Said,
            Extent::Checkpoint(_) | Extent::Sequence => Why::Place,
        }
    }

    /// The furthest that may be gone back, in actions; none where that lies before the trail.
    fn furthest(&self, extent: Extent) -> Option<usize> {
        match extent {
            Extent::Actions(count) => Some(count as usize),
            Extent::Checkpoint(checkpoint) => {
                self.trail.back_to_checkpoint(CheckpointId(checkpoint))
            }
            Extent::Sequence => self.trail.back_to_sequence(),
        }
    }

    fn learned(&self, furthest: usize, memory: &mut Memory) -> Result<(usize, Why), GiveUp> {
        let costs_s: Vec<f64> = (1..=furthest.min(DEPTH_MAX)).map(self.costs_s).collect();
        let (give_up_s, attempts_left) = (self.give_up_s, self.attempts_left);
        let costs = Costs { by_depth_s: &costs_s, give_up_s, attempts_left };
        let choice = memory.choose(self.error, self.place, self.tried, costs);
        let actions = choice.actions.ok_or(GiveUp::WouldNotHelp)?;
        let (chance, expected_s, known) = (choice.chance, choice.expected_s, choice.known);
        Ok((actions, Why::Learned { chance, expected_s, known }))
    }
}
