//! What was learned of how far to go back: a posterior by error and place, kept as counts that a
//! person can read.
//!
//! An incident has a depth that is enough, which nobody sees, and an attempt that goes back as far
//! helps with a chance that belongs to that depth: a spiral search near the error may need
//! several, where a part gripped anew nearly always helps. The counts say how far each attempt of
//! an incident went back and whether the last was enough; what they leave open of the depths is
//! shared out by expectation maximisation (Turnbull 1976) over a prior that holds near depths
//! likelier. Knows nothing of what an action is, nor of files on a disk.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The greatest depth that is told apart; what is deeper counts as this.
pub const DEPTH_MAX: usize = 16;
/// The most attempts of an incident that are remembered, the first ones.
pub const ATTEMPTS_MAX: usize = 16;
/// How many attempts that helped, and how many that did not, are believed of each depth that is
/// enough before anything is known.
const PRIOR_HELPED: f64 = 1.0;
const PRIOR_FAILED: f64 = 1.0;
/// The weight in incidents of what is believed of the first depth before anything is known; of a
/// further one that divided by the depth.
const PRIOR_FIRST: f64 = 1.0;
/// What is believed of going back never helping, before anything is known.
const PRIOR_NEVER: f64 = 0.1;
/// How much longer a nearer depth may be expected to take than the best, as a share, where it was
/// never tried, and how many attempts at it halve that: where far ones have helped nobody knows
/// whether near ones would, until they have been tried.
const CURIOSITY: f64 = 0.3;
const FEW: f64 = 5.0;
/// How many incidents must be known in which going back as far as can be was in vain, before it is
/// believed that going back may not help.
const IN_VAIN_MIN: u64 = 5;
/// Rounds of expectation maximisation: the shares settle to a percent in fewer.
const ROUNDS: usize = 24;
/// The version of the text.
const VERSION: u32 = 1;
/// The most kinds of incident that a text may hold.
const KINDS_MAX: usize = 100_000;

/// What became of incidents of a kind.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    /// How far each attempt went back.
    depths: Vec<usize>,
    /// Whether the last was enough.
    is_enough: bool,
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

    /// How many attempts are known that say something of a depth: those of it, and those that went
    /// further in vain, as it would have been.
    fn tried(&self, error: &str, place: &str, depth: usize) -> f64 {
        let Some(known) = self.places.get(&(error.to_owned(), place.to_owned())) else {
            return 0.0;
        };
        let in_kind = |kind: &Kind| {
            let failed = kind.depths.len() - usize::from(kind.is_enough);
            let (failed, helped) = kind.depths.split_at(failed);
            let in_vain = failed.iter().filter(|tried| **tried >= depth).count();
            in_vain + helped.iter().filter(|tried| **tried == depth).count()
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
        let slack = |depth: usize| match tried {
            [] => 1.0 + CURIOSITY * FEW / (FEW + self.tried(error, place, depth)),
            _ => 1.0,
        };
        let best = belief.best(costs, slack);
        let is_worth_it = best.is_some_and(|(expected_s, _)| expected_s < costs.give_up_s);
        let furthest = costs.by_depth_s.len().min(DEPTH_MAX);
        let goes_on = is_worth_it || self.in_vain(error, place, furthest) < IN_VAIN_MIN;
        let best = best.filter(|_| goes_on);
        let (expected_s, actions) = match best {
            Some((expected_s, depth)) => (expected_s, Some(depth)),
            None => (costs.give_up_s, None),
        };
        let chance = actions.map_or(0.0, |depth| belief.chance(depth));
        Choice { actions, chance, expected_s, known }
    }
}

/// A number for each depth, from 1, and in the last place one for what no depth is enough for.
type Numbers = [f64; DEPTH_MAX + 1];

/// What is believed of an incident.
#[derive(Clone, Debug)]
struct Belief {
    /// How likely each depth is the least that is enough; all of them add up to 1.
    shares: Numbers,
    /// Of the attempts that went back far enough, how many are believed to have helped, and how
    /// many not: the chance that one helps is Beta distributed, so that the first that fails says
    /// little where nothing is known, and much where they nearly always help.
    helped: Numbers,
    failed: Numbers,
}

fn prior() -> Numbers {
    std::array::from_fn(|index| match index {
        DEPTH_MAX => PRIOR_NEVER,
        _ => PRIOR_FIRST / (index + 1) as f64,
    })
}

fn normal(mut shares: Numbers) -> Numbers {
    let whole: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= whole);
    shares
}

/// What incidents of a kind say of each depth: see [`attempts`].
type AllAttempts = [Option<(f64, f64)>; DEPTH_MAX + 1];

/// What incidents of a kind say of a depth, if that is the least that is enough: how many attempts
/// that went so far have failed, and whether one has helped; none if one has helped that did not.
fn attempts(kind: &Kind, index: usize) -> Option<(f64, f64)> {
    let goes_so_far = |depth: &&usize| index < DEPTH_MAX && **depth > index;
    let (last, before) = kind.depths.split_last()?;
    let failed = if kind.is_enough { before } else { &kind.depths[..] };
    let helped = match kind.is_enough {
        true if goes_so_far(&last) => 1.0,
        true => return None,
        false => 0.0,
    };
    Some((failed.iter().filter(goes_so_far).count() as f64, helped))
}

impl Belief {
    fn of(times: &BTreeMap<Kind, u64>) -> Self {
        let mut belief = Self {
            shares: normal(prior()),
            helped: [PRIOR_HELPED; DEPTH_MAX + 1],
            failed: [PRIOR_FAILED; DEPTH_MAX + 1],
        };
        let kinds: Vec<(AllAttempts, f64)> = times
            .iter()
            .map(|(kind, times)| {
                (std::array::from_fn(|index| attempts(kind, index)), *times as f64)
            })
            .collect();
        for _ in 0..ROUNDS {
            let (mut weights, mut helped) = (prior(), [PRIOR_HELPED; DEPTH_MAX + 1]);
            let mut failed = [PRIOR_FAILED; DEPTH_MAX + 1];
            for (attempts, times) in &kinds {
                let likely = belief.explain(attempts);
                let whole: f64 = likely.iter().sum();
                for (index, attempts) in attempts.iter().enumerate() {
                    let incidents = times * likely[index] / whole;
                    let (in_vain, enough) = attempts.unwrap_or_default();
                    weights[index] += incidents;
                    helped[index] += incidents * enough;
                    failed[index] += incidents * in_vain;
                }
            }
            belief = Self { shares: normal(weights), helped, failed };
        }
        belief
    }

    /// How likely each depth is the least that is enough and an incident has come to this.
    fn explain(&self, attempts: &AllAttempts) -> Numbers {
        std::array::from_fn(|index| {
            let Some((failed, helped)) = attempts[index] else { return 0.0 };
            let helps = self.helps(index);
            let likely = if helped > 0.0 { helps } else { 1.0 };
            self.shares[index] * likely * libm::pow(1.0 - helps, failed)
        })
    }

    /// The chance that an attempt helps that goes back far enough.
    fn helps(&self, index: usize) -> f64 {
        self.helped[index] / (self.helped[index] + self.failed[index])
    }

    /// The chance that an attempt of a depth gets past the error.
    fn chance(&self, depth: usize) -> f64 {
        (0..depth.min(DEPTH_MAX)).map(|index| self.shares[index] * self.helps(index)).sum()
    }

    /// An attempt of a depth has failed.
    fn fail(&mut self, depth: usize) {
        self.weaken(depth);
        self.shares = normal(self.shares);
    }

    /// Take from the shares what an attempt of a depth gets past.
    fn weaken(&mut self, depth: usize) {
        for index in 0..depth.min(DEPTH_MAX) {
            self.shares[index] *= 1.0 - self.helps(index);
            self.failed[index] += 1.0;
        }
    }

    /// The least expected time to be past the error, and the depth to try first for it; none where
    /// there is none. Of those that take hardly longer (by a factor) it is the nearest, from which
    /// most is learned.
    fn best(&self, costs: Costs<'_>, slack: impl Fn(usize) -> f64) -> Option<(f64, usize)> {
        let depths = 1..=costs.by_depth_s.len().min(DEPTH_MAX);
        let times_s: Vec<f64> = depths.map(|first| self.expected_s(first, costs)).collect();
        let least_s = times_s.iter().copied().fold(f64::INFINITY, f64::min);
        let is_it = |(index, time_s): (usize, &f64)| {
            time_s.is_finite() && *time_s <= least_s * slack(index + 1)
        };
        let index = times_s.iter().enumerate().position(is_it)?;
        Some((times_s[index], index + 1))
    }

    /// The least expected time to be past the error, if a depth is tried first. All that is learned
    /// on the way is that attempts have failed, so that what to do can be planned at once: a depth
    /// some times, and then another as often as may be.
    fn expected_s(&self, first: usize, costs: Costs<'_>) -> f64 {
        let mut course = Course { belief: self.clone(), spent_s: 0.0 };
        let mut least_s = f64::INFINITY;
        for left in (0..costs.attempts_left).rev() {
            least_s = least_s.min(course.attempt(first, costs));
            for then in (1..=costs.by_depth_s.len().min(DEPTH_MAX)).filter(|then| *then != first) {
                least_s = least_s.min(course.clone().go_on(then, left, costs));
            }
        }
        least_s
    }
}

/// A plan that is being followed in thought; the shares are what is left of them.
#[derive(Clone)]
struct Course {
    belief: Belief,
    spent_s: f64,
}

impl Course {
    /// One attempt more. The expected time if it is given up after that, in seconds.
    fn attempt(&mut self, depth: usize, costs: Costs<'_>) -> f64 {
        let open: f64 = self.belief.shares.iter().sum();
        self.spent_s += open * costs.by_depth_s[depth - 1];
        self.belief.weaken(depth);
        self.spent_s + self.belief.shares.iter().sum::<f64>() * costs.give_up_s
    }

    /// The same depth up to so often. The expected time if it is given up where that is best.
    fn go_on(mut self, depth: usize, times: u32, costs: Costs<'_>) -> f64 {
        (0..times).map(|_| self.attempt(depth, costs)).fold(f64::INFINITY, f64::min)
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
    depths: Vec<usize>,
    enough: bool,
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
# What was learned of how far to go back, by error and place: how far each attempt of an incident
# went back, in actions, whether the last was enough, and how often that was so. Take out a
# [[place]], or the whole file, to forget it.
";

impl Memory {
    /// It as text, to be kept.
    #[must_use]
    pub fn to_text(&self) -> String {
        let kind = |(kind, times): (&Kind, &u64)| KindText {
            depths: kind.depths.clone(),
            enough: kind.is_enough,
            times: *times,
        };
        let place = |((error, at), known): (&(String, String), &Known)| PlaceText {
            error: error.clone(),
            at: at.clone(),
            incident: known.times.iter().map(kind).collect(),
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
                let key = Kind { depths: kind.depths, is_enough: kind.enough };
                let times = known.times.entry(key).or_default();
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
            own.belief = None;
            for (kind, times) in &known.times {
                let sum = own.times.entry(kind.clone()).or_default();
                *sum = sum.saturating_add(*times);
            }
        }
    }
}

fn check(kind: &KindText) -> Result<(), &'static str> {
    if kind.depths.is_empty() {
        Err("nothing was tried")
    } else if kind.depths.len() > ATTEMPTS_MAX {
        Err("that is more attempts than are remembered")
    } else if kind.depths.contains(&0) {
        Err("it went back by 0 actions")
    } else if kind.depths.iter().any(|&depth| depth > DEPTH_MAX) {
        Err("that is further than is told apart")
    } else if kind.times > 1 << 40 {
        Err("that is more often than can be")
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests;
