//! What was learned of how far to go back: a posterior by error and place, kept as counts that a
//! person can read.
//!
//! An incident has a depth that is enough, which nobody sees, and an attempt that goes back as far
//! helps with a chance that belongs to that depth: a spiral search near the error may need several,
//! where a part gripped anew nearly always helps. The counts say how far each attempt of an
//! incident went back and whether the last was enough; `belief` says what follows, `text` what it
//! looks like when it is kept. Knows nothing of what an action is, nor of files on a disk.

mod text;

pub use text::{MemoryError, Subject};

use crate::belief::Belief;
use std::collections::BTreeMap;

/// The greatest depth that is told apart; what is deeper counts as this.
pub const DEPTH_MAX: usize = 16;
/// The most attempts of an incident that are remembered, the first ones.
pub const ATTEMPTS_MAX: usize = 16;
/// How much longer a nearer depth may be expected to take than the best, as a share, where it was
/// never tried, and how many attempts at it halve that: where far ones have helped nobody knows
/// whether near ones would, until they have been tried. As the first attempt and as a later one are
/// two things: a search that goes on may come upon what its first point has missed.
const CURIOSITY: f64 = 0.3;
const FEW: f64 = 5.0;
/// How often a depth is tried in one incident before it is no longer tried for that.
const CURIOUS_TIMES: usize = 2;
/// How many incidents must be known in which going back as far as can be was in vain, before it is
/// believed that going back may not help.
const IN_VAIN_MIN: u64 = 5;

/// What became of incidents of a kind.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Kind {
    /// How far each attempt went back.
    pub(crate) depths: Vec<usize>,
    /// Whether the last was enough.
    pub(crate) is_enough: bool,
}

/// What is known of an error at a place.
#[derive(Clone, Debug, Default)]
struct Known {
    times: BTreeMap<Kind, u64>,
    /// What follows from it, once somebody has asked.
    belief: Option<Belief>,
}

impl PartialEq for Known {
    fn eq(&self, other: &Self) -> bool {
        self.times == other.times
    }
}

/// What was learned of how far to go back.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    places: BTreeMap<(String, String), Known>,
}

/// What to do next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// How many actions to go back; none to give up, which is expected to cost less.
    pub actions: Option<usize>,
    /// The chance that it is enough.
    pub chance: f64,
    /// The expected time until the run is past the error, in seconds.
    pub expected_s: f64,
    /// How many incidents are known.
    pub known: u64,
}

/// The costs of a choice, in seconds.
#[derive(Clone, Copy, Debug)]
pub struct Costs<'a> {
    /// Of going back and coming again, by depth from 1.
    pub by_depth_s: &'a [f64],
    /// Of giving up: what a person takes.
    pub give_up_s: f64,
    /// How many attempts there may still be.
    pub attempts_left: u32,
}

impl Memory {
    /// How many incidents of an error at a place are known.
    #[must_use]
    pub fn known(&self, error: &str, place: &str) -> u64 {
        let known = self.places.get(&(error.to_owned(), place.to_owned()));
        known.map_or(0, |known| known.times.values().sum())
    }

    /// How many attempts are known that say something of a depth, from one of their number on:
    /// those of it, and those that went further in vain, as it would have been.
    fn tried(&self, error: &str, place: &str, depth: usize, from: usize) -> f64 {
        let Some(known) = self.places.get(&(error.to_owned(), place.to_owned())) else {
            return 0.0;
        };
        let in_kind = |kind: &Kind| {
            let failed = kind.depths.len() - usize::from(kind.is_enough);
            let says = |(number, tried): (usize, &usize)| match number < failed {
                true => *tried >= depth,
                false => *tried == depth,
            };
            kind.depths.iter().enumerate().skip(from).filter(|it| says(*it)).count()
        };
        known.times.iter().map(|(kind, times)| in_kind(kind) as f64 * *times as f64).sum()
    }

    /// How many of them were not recovered from, although an attempt went back so far: who gives up
    /// before has not learned that going on would have been in vain.
    fn in_vain(&self, error: &str, place: &str, furthest: usize) -> u64 {
        let Some(known) = self.places.get(&(error.to_owned(), place.to_owned())) else { return 0 };
        let went_so_far = |kind: &Kind| kind.depths.iter().any(|depth| *depth >= furthest);
        let is_it = |kind: &Kind| !kind.is_enough && went_so_far(kind);
        known.times.iter().filter(|(kind, _)| is_it(kind)).map(|(_, times)| times).sum()
    }

    /// Remember what became of an incident: how far each attempt went back, and whether the last
    /// was enough. Without an attempt there is nothing to remember.
    pub fn learn(&mut self, error: &str, place: &str, depths: &[usize], is_enough: bool) {
        if depths.is_empty() {
            return;
        }
        let left_out = depths.len() > ATTEMPTS_MAX;
        let kept = depths.iter().take(ATTEMPTS_MAX);
        let depths = kept.map(|&depth| depth.clamp(1, DEPTH_MAX)).collect();
        let kind = Kind { depths, is_enough: is_enough && !left_out };
        let known = self.places.entry((error.to_owned(), place.to_owned())).or_default();
        known.belief = None;
        let times = known.times.entry(kind).or_default();
        *times = times.saturating_add(1);
    }

    /// How far to go back next from an error at a place, after attempts of these depths have
    /// failed. There is a cost for each depth that is possible.
    #[must_use]
    pub fn choose(
        &mut self,
        error: &str,
        place: &str,
        tried: &[usize],
        costs: Costs<'_>,
    ) -> Choice {
        let known = self.known(error, place);
        let mut belief = match self.places.get_mut(&(error.to_owned(), place.to_owned())) {
            Some(known) => known.belief.get_or_insert_with(|| Belief::of(&known.times)).clone(),
            None => Belief::of(&BTreeMap::new()),
        };
        for &depth in tried {
            belief.fail(depth);
        }
        let slack = |depth: usize| {
            let is_enough = tried.iter().filter(|tried| **tried == depth).count() >= CURIOUS_TIMES;
            if !tried.is_empty() && (known == 0 || is_enough) {
                return 1.0;
            }
            let times = self.tried(error, place, depth, usize::from(!tried.is_empty()));
            1.0 + CURIOSITY * FEW / (FEW + times)
        };
        let best = belief.best(costs, slack);
        let furthest = costs.by_depth_s.len().min(DEPTH_MAX);
        let is_open = self.in_vain(error, place, furthest) < IN_VAIN_MIN;
        // That nothing helps is found out by going as far as can be, and nowhere nearer.
        let has_been_there = tried.iter().any(|depth| *depth >= furthest);
        let (expected_s, actions) = match best {
            Some((expected_s, depth))
                if expected_s < costs.give_up_s || is_open && has_been_there =>
            {
                (expected_s, Some(depth))
            }
            Some((expected_s, _)) if is_open => (expected_s, Some(furthest)),
            _ => (costs.give_up_s, None),
        };
        let chance = actions.map_or(0.0, |depth| belief.chance(depth));
        Choice { actions, chance, expected_s, known }
    }
}

impl Memory {
    /// What it knows something of: each error, by name, and its place.
    pub fn places(&self) -> impl Iterator<Item = (&str, &str)> {
        self.places.keys().map(|(error, place)| (error.as_str(), place.as_str()))
    }

    /// What it knows more than it did when it was as another one.
    #[must_use]
    pub fn since(&self, before: &Self) -> Self {
        let mut more = Self::default();
        for (place, known) in &self.places {
            let old = before.places.get(place);
            let old_times = |kind: &Kind| old.and_then(|old| old.times.get(kind)).copied();
            let new = known.times.iter().filter_map(|(kind, times)| {
                let more = times.saturating_sub(old_times(kind).unwrap_or(0));
                (more > 0).then(|| (kind.clone(), more))
            });
            let times: BTreeMap<Kind, u64> = new.collect();
            if !times.is_empty() {
                more.places.insert(place.clone(), Known { times, belief: None });
            }
        }
        more
    }

    /// Add what another one knows.
    pub fn merge(&mut self, other: &Self) {
        for (place, known) in &other.places {
            let own = self.places.entry(place.clone()).or_default();
            own.belief = None;
            for (kind, times) in &known.times {
                let sum = own.times.entry(kind.clone()).or_default();
                *sum = sum.saturating_add(*times);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COSTS_S: [f64; 6] = [2.0, 4.0, 8.0, 12.0, 20.0, 30.0];

    fn choose(memory: &mut Memory, tried: &[usize]) -> Choice {
        let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0, attempts_left: 8 };
        memory.choose("jam", "here", tried, costs)
    }

    #[test]
    fn who_knows_nothing_begins_near_goes_further_and_gives_up_only_at_the_end() {
        let mut memory = Memory::default();
        let mut tried = Vec::new();
        for attempts_left in (1..=12).rev() {
            let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0, attempts_left };
            tried.push(memory.choose("jam", "here", &tried, costs).actions.unwrap());
        }
        assert_eq!(tried[0], 1, "{tried:?}");
        assert_eq!(tried.iter().max(), Some(&COSTS_S.len()), "{tried:?}");
        let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0, attempts_left: 0 };
        assert_eq!(memory.choose("jam", "here", &tried, costs).actions, None);
    }

    #[test]
    fn who_has_given_up_early_has_not_learned_that_it_is_in_vain() {
        let mut memory = Memory::default();
        for _ in 0..100 {
            memory.learn("jam", "here", &[1, 3], false);
        }
        assert!(choose(&mut memory, &[1, 3]).actions.is_some());
    }

    #[test]
    fn where_four_was_always_enough_and_three_never_it_goes_back_four_at_once() {
        let mut memory = Memory::default();
        for _ in 0..30 {
            memory.learn("jam", "here", &[1, 3, 4], true);
        }
        assert_eq!(choose(&mut memory, &[]).actions, Some(4));
        // Elsewhere, and for another error, nothing is known.
        let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0, attempts_left: 8 };
        assert!(memory.choose("jam", "there", &[], costs).actions.unwrap() <= 2);
    }

    #[test]
    fn where_going_back_never_helped_it_gives_up_at_once() {
        let mut memory = Memory::default();
        for _ in 0..50 {
            memory.learn("jam", "here", &[1, 2, 4, 6], false);
        }
        let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 60.0, attempts_left: 8 };
        assert_eq!(memory.choose("jam", "here", &[], costs).actions, None);
    }

    #[test]
    fn half_near_and_half_far_goes_near_first_if_that_is_cheap() {
        let mut memory = Memory::default();
        for _ in 0..40 {
            memory.learn("jam", "here", &[1], true);
            memory.learn("jam", "here", &[1, 2, 4, 5], true);
        }
        let first = choose(&mut memory, &[]);
        assert_eq!(first.actions, Some(1));
        assert!((0.3..0.6).contains(&first.chance), "{}", first.chance);
        assert_eq!(choose(&mut memory, &[1]).actions, Some(5));
    }

    #[test]
    fn a_search_near_goes_on_as_long_as_it_is_worth_it_and_then_what_is_far_is_done_anew() {
        // Half need the third point of a search, half what only four actions back does anew, which
        // two and three are known not to. A near attempt gains 0.083 * 0.67^n a second and a far
        // one 0.042, so that it is two or three near ones and then a far one.
        let mut memory = Memory::default();
        for _ in 0..40 {
            memory.learn("jam", "here", &[1, 1, 1], true);
            memory.learn("jam", "here", &[1, 1, 1, 1, 2, 3, 4], true);
        }
        let mut tried = Vec::new();
        for _ in 0..6 {
            tried.push(choose(&mut memory, &tried).actions.unwrap());
        }
        assert_eq!(tried[..2], [1, 1], "{tried:?}");
        assert!(tried.contains(&4), "{tried:?}");
    }

    #[test]
    fn where_each_attempt_helps_seldom_but_near_ones_as_much_as_far_it_stays_near() {
        // A search that takes its time: one attempt in three helps, however far back.
        let mut memory = Memory::default();
        for round in 0..60 {
            let depths: Vec<usize> = (0..1 + round % 5).map(|index| 1 + index % 3).collect();
            memory.learn("jam", "here", &depths, true);
        }
        let mut tried = Vec::new();
        for _ in 0..6 {
            let choice = choose(&mut memory, &tried);
            tried.push(choice.actions.unwrap());
        }
        assert!(tried.iter().all(|&depth| depth <= 3), "{tried:?}");
    }

    #[test]
    fn whether_a_search_near_helps_in_the_end_is_tried_before_it_is_believed_that_it_does_not() {
        // Going far has helped wherever near had failed once; nobody has tried near twice.
        let mut memory = Memory::default();
        for _ in 0..20 {
            memory.learn("jam", "here", &[1], true);
            memory.learn("jam", "here", &[1, 4], true);
        }
        let near = choose(&mut memory, &[1]).actions.unwrap();
        assert!(near < 4, "{near}");
        for _ in 0..20 {
            for near in 1..4 {
                memory.learn("jam", "here", &[1, near, 4], true);
            }
        }
        assert_eq!(choose(&mut memory, &[1]).actions, Some(4), "it has been tried often enough");
    }

    #[test]
    fn what_two_learned_beside_each_other_is_kept_of_both() {
        let mut common = Memory::default();
        common.learn("jam", "here", &[1], true);
        let (mut one, mut other) = (common.clone(), common.clone());
        one.learn("jam", "here", &[1], true);
        one.learn("jam", "here", &[2], false);
        other.learn("jam", "there", &[3], true);
        let mut kept = one.clone();
        kept.merge(&other.since(&common));
        assert_eq!((kept.known("jam", "here"), kept.known("jam", "there")), (3, 1));
        assert_eq!(one.since(&one), Memory::default());
    }

    #[test]
    fn memories_add_up() {
        let (mut one, mut both) = (Memory::default(), Memory::default());
        let mut other = Memory::default();
        one.learn("jam", "here", &[1], true);
        other.learn("jam", "here", &[1], true);
        other.learn("jam", "there", &[2], false);
        for memory in [&one.clone(), &other] {
            both.merge(memory);
        }
        one.merge(&other);
        assert_eq!(one, both);
        assert_eq!(one.known("jam", "here"), 2);
    }
}
