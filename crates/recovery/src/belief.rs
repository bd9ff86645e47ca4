//! What is believed of how far back is enough, and what is best to try by it.
//!
//! What the counts leave open of the depths is shared out by expectation maximisation (Turnbull
//! 1976) over a prior that holds near depths likelier. Knows nothing of errors and places.

use crate::memory::{Costs, DEPTH_MAX, Kind};
use std::collections::BTreeMap;

/// How many attempts that helped, and how many that did not, are believed of each depth that is
/// enough before anything is known.
const PRIOR_HELPED: f64 = 1.0;
const PRIOR_FAILED: f64 = 1.0;
/// The weight in incidents of what is believed of the first depth before anything is known; of a
/// further one that divided by the depth.
const PRIOR_FIRST: f64 = 1.0;
/// What is believed of going back never helping, before anything is known.
const PRIOR_NEVER: f64 = 0.1;
/// How many of the errors that going back has helped in no incident yet are held to be such that it
/// helps in none. By Laplace's rule so many in vain (n) leave of the others one in n + 1.
const HELPED_BY_NOTHING: f64 = 0.2;
/// Rounds of expectation maximisation: the shares settle to a percent in fewer.
const ROUNDS: usize = 24;

/// A number for each depth, from 1, and in the last place one for what no depth is enough for.
type Numbers = [f64; DEPTH_MAX + 1];

/// What incidents of a kind say of each depth: see [`attempts`].
type Attempts = [Option<(f64, f64)>; DEPTH_MAX + 1];

/// What is believed of an incident.
#[derive(Clone, Debug)]
pub(crate) struct Belief {
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
    pub(crate) fn of(times: &BTreeMap<Kind, u64>) -> Self {
        let mut belief = Self {
            shares: normal(prior()),
            helped: [PRIOR_HELPED; DEPTH_MAX + 1],
            failed: [PRIOR_FAILED; DEPTH_MAX + 1],
        };
        let kinds: Vec<(Attempts, f64)> = times
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
        if times.keys().all(|kind| !kind.is_enough) {
            belief.doubt(times);
        }
        belief
    }

    /// No incident was ever put right: each depth is the less likely to be enough, the more often
    /// it was in vain to go so far, and what it loses is with going back not helping at all.
    fn doubt(&mut self, times: &BTreeMap<Kind, u64>) {
        for index in 0..DEPTH_MAX {
            let went_so_far = |kind: &Kind| kind.depths.iter().any(|depth| *depth > index);
            let in_vain = times.iter().filter(|(kind, _)| went_so_far(kind));
            let in_vain: f64 = in_vain.map(|(_, times)| *times as f64).sum();
            let left = self.shares[index] / (1.0 + HELPED_BY_NOTHING * in_vain);
            self.shares[DEPTH_MAX] += self.shares[index] - left;
            self.shares[index] = left;
        }
    }

    /// How likely each depth is the least that is enough and an incident has come to this.
    fn explain(&self, attempts: &Attempts) -> Numbers {
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
    pub(crate) fn chance(&self, depth: usize) -> f64 {
        (0..depth.min(DEPTH_MAX)).map(|index| self.shares[index] * self.helps(index)).sum()
    }

    /// An attempt of a depth has failed.
    pub(crate) fn fail(&mut self, depth: usize) {
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
    pub(crate) fn best(
        &self,
        costs: Costs<'_>,
        slack: impl Fn(usize) -> f64,
    ) -> Option<(f64, usize)> {
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
