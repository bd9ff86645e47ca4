//! What was learned of how far to go back: a posterior by error and place, kept as counts that a
//! person can read.
//!
//! Each incident says something of the depth that is enough there: more than the furthest attempt
//! that failed, and no more than the one that did not. What the counts leave open is shared out by
//! expectation maximisation (Turnbull 1976) over a prior that holds near depths likelier. Knows
//! nothing of what an action is, nor of files on a disk.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The greatest depth that is told apart; what is deeper counts as this.
pub const DEPTH_MAX: usize = 16;
/// The chance that going back far enough helps, at each attempt: what is random may fail again.
const HELPS: f64 = 0.9;
/// How many attempts are thought ahead.
const AHEAD: usize = 3;
/// The weight in incidents of what is believed before anything is known, by depth: each depth half
/// of the one before, and as much as the first that going back does not help at all.
const PRIOR_FIRST: f64 = 1.0;
/// What is believed of going back never helping, before anything is known.
const PRIOR_NEVER: f64 = 0.2;
/// Rounds of expectation maximisation: the shares settle to a percent in fewer.
const ROUNDS: usize = 12;
/// The version of the text.
const VERSION: u32 = 1;
/// The most kinds of incident that a text may hold.
const KINDS_MAX: usize = 100_000;

/// What became of incidents of a kind: failed at this depth, and enough at that.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
struct Kind {
    /// The furthest attempt that failed; 0 if none did.
    failed: usize,
    /// The attempt that did not fail; none if it was given up.
    enough: Option<usize>,
}

/// What is known of an error at a place.
#[derive(Clone, Debug, Default, PartialEq)]
struct Known(BTreeMap<Kind, u64>);

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
}

impl Memory {
    /// How many incidents of an error at a place are known.
    #[must_use]
    pub fn known(&self, error: &str, place: &str) -> u64 {
        self.of(error, place).map_or(0, |known| known.0.values().sum())
    }

    fn of(&self, error: &str, place: &str) -> Option<&Known> {
        self.places.get(&(error.to_owned(), place.to_owned()))
    }

    /// Remember what became of an incident: how far each attempt went back, and whether the last
    /// was enough.
    pub fn learn(&mut self, error: &str, place: &str, depths: &[usize], was_enough: bool) {
        let (failed, enough) = match (depths, was_enough) {
            ([before @ .., last], true) => (before, Some(*last)),
            (all, _) => (all, None),
        };
        let failed = failed.iter().copied().max().unwrap_or(0).min(DEPTH_MAX);
        let enough = enough.map(|depth| depth.clamp(1, DEPTH_MAX));
        if failed == 0 && enough.is_none() {
            return;
        }
        let known = self.places.entry((error.to_owned(), place.to_owned())).or_default();
        *known.0.entry(Kind { failed, enough }).or_default() += 1;
    }

    /// How far to go back next from an error at a place, after attempts of these depths have
    /// failed. There is a cost for each depth that is possible.
    #[must_use]
    pub fn choose(&self, error: &str, place: &str, tried: &[usize], costs: Costs<'_>) -> Choice {
        let known = self.of(error, place);
        let mut belief = Belief::of(known);
        for &depth in tried {
            belief = belief.after_failure(depth);
        }
        let from = tried.iter().copied().max().unwrap_or(1).clamp(1, DEPTH_MAX);
        let (expected_s, actions) = belief.best(from, costs, AHEAD);
        Choice {
            actions,
            chance: actions.map_or(0.0, |depth| belief.chance(depth)),
            expected_s,
            known: self.known(error, place),
        }
    }
}

/// How likely each depth is the least that is enough, from 1; the last place: none is.
#[derive(Clone, Debug)]
struct Belief([f64; DEPTH_MAX + 1]);

impl Belief {
    fn prior() -> Self {
        let mut weights = [PRIOR_FIRST; DEPTH_MAX + 1];
        for depth in 1..DEPTH_MAX {
            weights[depth] = 0.5 * weights[depth - 1];
        }
        weights[DEPTH_MAX] = PRIOR_NEVER;
        Self(weights)
    }

    fn of(known: Option<&Known>) -> Self {
        let prior = Self::prior();
        let Some(known) = known else { return prior.normal() };
        let mut belief = prior.clone();
        for _ in 0..ROUNDS {
            let mut weights = prior.0;
            for (kind, times) in &known.0 {
                let share = belief.within(*kind);
                let whole: f64 = share.iter().sum();
                for (weight, part) in weights.iter_mut().zip(share) {
                    *weight += *times as f64 * part / whole;
                }
            }
            belief = Self(weights);
        }
        belief.normal()
    }

    /// What of it agrees with what became of an incident; some of it always does.
    fn within(&self, kind: Kind) -> [f64; DEPTH_MAX + 1] {
        // Enough at a depth that had failed before: chance had a part in it.
        let low = kind.enough.map_or(kind.failed, |enough| kind.failed.min(enough - 1));
        let high = kind.enough.unwrap_or(DEPTH_MAX + 1);
        let mut share = self.0;
        for (index, weight) in share.iter_mut().enumerate() {
            let depth = index + 1;
            if depth <= low || depth > high {
                *weight = 0.0;
            }
        }
        share
    }

    fn normal(mut self) -> Self {
        let whole: f64 = self.0.iter().sum();
        self.0.iter_mut().for_each(|weight| *weight /= whole);
        self
    }

    /// The chance that an attempt of a depth gets past the error.
    fn chance(&self, depth: usize) -> f64 {
        HELPS * self.0[..depth.min(DEPTH_MAX)].iter().sum::<f64>()
    }

    /// What is believed after an attempt of a depth has failed.
    fn after_failure(&self, depth: usize) -> Self {
        let mut weights = self.0;
        for weight in &mut weights[..depth.min(DEPTH_MAX)] {
            *weight *= 1.0 - HELPS;
        }
        Self(weights).normal()
    }

    /// The least expected time to be past the error, and the depth to try first for it; none where
    /// giving up costs less. No depth below `from` is tried.
    fn best(&self, from: usize, costs: Costs<'_>, ahead: usize) -> (f64, Option<usize>) {
        let mut best = (costs.give_up_s, None);
        if ahead == 0 {
            return best;
        }
        let depths = costs.by_depth_s.len().min(DEPTH_MAX);
        // Where no depth is left to go further, the furthest may be tried again.
        for depth in from.min(depths.max(1))..=depths {
            let cost_s = costs.by_depth_s[depth - 1];
            let fails = 1.0 - self.chance(depth);
            if cost_s >= best.0 {
                continue;
            }
            let (then_s, _) = self.after_failure(depth).best(depth, costs, ahead - 1);
            let expected_s = cost_s + fails * then_s;
            if expected_s < best.0 {
                best = (expected_s, Some(depth));
            }
        }
        best
    }
}

/// The text of a memory.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Text {
    version: u32,
    #[serde(default)]
    place: Vec<PlaceText>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlaceText {
    error: String,
    at: String,
    #[serde(default)]
    incident: Vec<KindText>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KindText {
    failed_at: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    enough_at: Option<usize>,
    times: u64,
}

/// A text that is no memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MemoryError {
    /// It is no text of this kind, or was torn.
    Malformed {
        /// What is wrong, with its line where that is known.
        why: String,
    },
    /// It is of another version.
    Version {
        /// That which it says.
        found: u32,
    },
    /// It says what no run can have come to.
    Impossible {
        /// The error.
        error: String,
        /// The place.
        place: String,
        /// What.
        what: &'static str,
    },
}

impl fmt::Display for MemoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Malformed { why } => write!(f, "this is no memory of recoveries: {why}"),
            Self::Version { found } => write!(
                f,
                "this memory is of version {found}, and this is for version {VERSION}; move it \
                 away to begin anew"
            ),
            Self::Impossible { error, place, what } => {
                write!(f, "what it says of error {error} at `{place}` cannot be: {what}")
            }
        }
    }
}

impl std::error::Error for MemoryError {}

const HEAD: &str = "\
# What was learned of how far to go back, by error and place. `failed_at` is the furthest that was
# tried in vain, in actions (0: nothing was), `enough_at` how far was enough (absent: it was given
# up). Take out a [[place]], or the whole file, to forget it.
";

impl Memory {
    /// It as text, to be kept.
    #[must_use]
    pub fn to_text(&self) -> String {
        let kind = |(kind, times): (&Kind, &u64)| KindText {
            failed_at: kind.failed,
            enough_at: kind.enough,
            times: *times,
        };
        let place = |((error, at), known): (&(String, String), &Known)| PlaceText {
            error: error.clone(),
            at: at.clone(),
            incident: known.0.iter().map(kind).collect(),
        };
        let text = Text { version: VERSION, place: self.places.iter().map(place).collect() };
        format!("{HEAD}{}", toml::to_string(&text).unwrap_or_default())
    }

    /// The memory of a text.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn from_text(text: &str) -> Result<Self, MemoryError> {
        let malformed = |why: &dyn fmt::Display| MemoryError::Malformed { why: why.to_string() };
        let text: Text = toml::from_str(text).map_err(|error| malformed(&error))?;
        if text.version != VERSION {
            return Err(MemoryError::Version { found: text.version });
        }
        if text.place.iter().map(|place| place.incident.len()).sum::<usize>() > KINDS_MAX {
            return Err(malformed(&"it is too long"));
        }
        let mut memory = Self::default();
        for PlaceText { error, at, incident } in text.place {
            let mut known = Known::default();
            for kind in incident {
                check(&kind).map_err(|what| MemoryError::Impossible {
                    error: error.clone(),
                    place: at.clone(),
                    what,
                })?;
                let key = Kind { failed: kind.failed_at, enough: kind.enough_at };
                let times = known.0.entry(key).or_default();
                *times = times.saturating_add(kind.times);
            }
            memory.places.insert((error, at), known);
        }
        Ok(memory)
    }

    /// Add what another one knows.
    pub fn merge(&mut self, other: &Self) {
        for (place, known) in &other.places {
            let own = self.places.entry(place.clone()).or_default();
            for (kind, times) in &known.0 {
                let sum = own.0.entry(*kind).or_default();
                *sum = sum.saturating_add(*times);
            }
        }
    }
}

fn check(kind: &KindText) -> Result<(), &'static str> {
    match kind {
        KindText { failed_at: 0, enough_at: None, .. } => Err("nothing was tried"),
        KindText { enough_at: Some(0), .. } => Err("going back by 0 actions was enough"),
        KindText { failed_at, enough_at, .. }
            if (*failed_at).max(enough_at.unwrap_or(0)) > DEPTH_MAX =>
        {
            Err("that is further than is told apart")
        }
        KindText { times, .. } if *times > 1 << 40 => Err("that is more often than can be"),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COSTS_S: [f64; 6] = [2.0, 4.0, 8.0, 12.0, 20.0, 30.0];

    fn choose(memory: &Memory, tried: &[usize]) -> Choice {
        let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0 };
        memory.choose("jam", "here", tried, costs)
    }

    #[test]
    fn who_knows_nothing_begins_near_goes_further_and_gives_up_only_at_the_end() {
        let memory = Memory::default();
        let mut tried = Vec::new();
        while let Some(actions) = choose(&memory, &tried).actions {
            tried.push(actions);
            assert!(tried.len() < 20, "{tried:?}");
        }
        assert!(tried[0] <= 2, "{tried:?}");
        assert!(tried.is_sorted(), "{tried:?}");
        assert_eq!(tried.last(), Some(&COSTS_S.len()), "{tried:?}");
    }

    #[test]
    fn where_four_was_always_enough_and_three_never_it_goes_back_four_at_once() {
        let mut memory = Memory::default();
        for _ in 0..30 {
            memory.learn("jam", "here", &[1, 3, 4], true);
        }
        assert_eq!(choose(&memory, &[]).actions, Some(4));
        // Elsewhere, and for another error, nothing is known.
        let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0 };
        assert!(memory.choose("jam", "there", &[], costs).actions.unwrap() <= 2);
    }

    #[test]
    fn where_going_back_never_helped_it_gives_up_at_once() {
        let mut memory = Memory::default();
        for _ in 0..50 {
            memory.learn("jam", "here", &[1, 2, 4, 6], false);
        }
        let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 60.0 };
        assert_eq!(memory.choose("jam", "here", &[], costs).actions, None);
    }

    #[test]
    fn half_near_and_half_far_goes_near_first_if_that_is_cheap() {
        let mut memory = Memory::default();
        for _ in 0..40 {
            memory.learn("jam", "here", &[1], true);
            memory.learn("jam", "here", &[1, 2, 4, 5], true);
        }
        let first = choose(&memory, &[]);
        assert_eq!(first.actions, Some(1));
        assert!((0.3..0.6).contains(&first.chance), "{}", first.chance);
        let second = choose(&memory, &[1]);
        assert_eq!(second.actions, Some(5), "{second:?}");
    }

    #[test]
    fn a_memory_is_the_same_after_its_text() {
        let mut memory = Memory::default();
        memory.learn("jam", "sequence \"main\": advance insert", &[1, 2], true);
        memory.learn("jam", "sequence \"main\": advance insert", &[1, 2], false);
        memory.learn("empty", "elsewhere", &[40], true);
        assert_eq!(Memory::from_text(&memory.to_text()), Ok(memory));
    }

    #[test]
    fn what_no_run_can_have_learned_is_refused() {
        let text = |incident: &str| {
            format!(
                "version = 1\n[[place]]\nerror = \"jam\"\nat = \"here\"\nincident = [{incident}]\n"
            )
        };
        let what = |incident: &str| Memory::from_text(&text(incident)).unwrap_err().to_string();
        assert!(what("{ failed_at = 0, times = 1 }").contains("nothing was tried"));
        assert!(what("{ failed_at = 1, enough_at = 0, times = 1 }").contains("0 actions"));
        assert!(what("{ failed_at = 99, times = 1 }").contains("further"));
        assert!(what("{ failed_at = -1, times = 1 }").contains("no memory"));
        let other = Memory::from_text("version = 7\n").unwrap_err();
        assert_eq!(other, MemoryError::Version { found: 7 });
        let torn = &Memory::from_text(&text("{ failed_at = 1,")[..60]);
        assert!(matches!(torn, Err(MemoryError::Malformed { .. })));
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
