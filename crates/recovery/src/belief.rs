//! What is believed of how far back is enough, and what is best to try by it.
//!
//! An incident has a least depth that is enough. An attempt that goes so far helps with a chance
//! that depends on which attempt it is: a search that has come round without finding anything finds
//! less and less, and what was done anew three times in vain is seldom put right by the fourth.
//! What the counts leave open of the depths is shared out by expectation maximisation (Turnbull
//! 1976) over a prior that holds near depths likelier. Knows nothing of errors and places.

use crate::memory::{ATTEMPTS_MAX, Costs, DEPTH_MAX, Kind};
use std::collections::BTreeMap;

/// How many attempts that helped, and how many that did not, are believed of each depth that is
/// enough before anything is known.
const PRIOR_HELPED: f64 = 1.0;
const PRIOR_FAILED: f64 = 1.0;
/// How many attempts the chance of one by its number is believed to be like all the others of its
/// depth.
const LIKE_ALL: f64 = 4.0;
/// The weight in incidents of what is believed of the first depth before anything is known; of a
/// further one that divided by the depth.
const PRIOR_FIRST: f64 = 1.0;
/// What is believed of going back never helping, before anything is known.
const PRIOR_NEVER: f64 = 0.1;
/// Rounds of expectation maximisation: the shares settle to a percent in fewer.
const ROUNDS: usize = 24;

/// A number for each depth, from 1, and in the last place one for what no depth is enough for.
type Numbers = [f64; DEPTH_MAX + 1];

/// How attempts have gone, by their number in an incident.
#[derive(Clone, Copy, Debug, Default)]
struct Tries {
    helped: [f64; ATTEMPTS_MAX],
    failed: [f64; ATTEMPTS_MAX],
    all_helped: f64,
    all_failed: f64,
}

impl Tries {
    fn add(&mut self, number: usize, helped: bool, incidents: f64) {
        let (one, all) = match helped {
            true => (&mut self.helped, &mut self.all_helped),
            false => (&mut self.failed, &mut self.all_failed),
        };
        one[number.min(ATTEMPTS_MAX - 1)] += incidents;
        *all += incidents;
    }

    /// The chance of the attempt of a number, counted from 0: of its own tries, as far as there are
    /// any, and else of all, those among them that have just failed.
    fn chance(&self, number: usize) -> f64 {
        let helped = PRIOR_HELPED + self.all_helped;
        let all = helped / (helped + PRIOR_FAILED + self.all_failed + number as f64);
        let at = number.min(ATTEMPTS_MAX - 1);
        let own = self.helped[at] + self.failed[at];
        (self.helped[at] + LIKE_ALL * all) / (own + LIKE_ALL)
    }
}

/// What is believed of incidents of an error at a place.
#[derive(Clone, Debug)]
pub(crate) struct Belief {
    /// How likely each depth is the least that is enough; all of them add up to 1.
    shares: Numbers,
    /// By least depth.
    tries: Vec<Tries>,
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

/// Whether an attempt of a depth goes far enough, if this is the least that is enough.
fn goes_so_far(depth: usize, index: usize) -> bool {
    index < DEPTH_MAX && depth > index
}

/// The attempts of an incident that go so far, each with its number and whether it helped.
fn attempts(kind: &Kind, index: usize) -> impl Iterator<Item = (usize, bool)> + '_ {
    let last = kind.depths.len().saturating_sub(1);
    let so_far = kind.depths.iter().enumerate();
    let so_far = so_far.filter(move |(_, depth)| goes_so_far(**depth, index));
    so_far.enumerate().map(move |(number, (at, _))| (number, kind.is_enough && at == last))
}

impl Belief {
    /// That which follows from what became of incidents.
    pub(crate) fn of(times: &BTreeMap<Kind, u64>) -> Self {
        let tries = vec![Tries::default(); DEPTH_MAX + 1];
        let mut belief = Self { shares: normal(prior()), tries: tries.clone() };
        for _ in 0..ROUNDS {
            let mut next = Self { shares: prior(), tries: tries.clone() };
            for (kind, times) in times {
                let likely: Numbers = std::array::from_fn(|index| belief.explain(kind, index));
                let whole: f64 = likely.iter().sum();
                for (index, likely) in likely.iter().enumerate().filter(|(_, it)| **it > 0.0) {
                    next.count(kind, index, *times as f64 * likely / whole);
                }
            }
            next.shares = normal(next.shares);
            belief = next;
        }
        belief
    }

    /// How likely a depth is the least that is enough and an incident has come to this.
    fn explain(&self, kind: &Kind, index: usize) -> f64 {
        let helped_by = kind.depths.last().filter(|_| kind.is_enough);
        if helped_by.is_some_and(|depth| !goes_so_far(*depth, index)) {
            return 0.0;
        }
        let each = attempts(kind, index).map(|(number, helped)| {
            let chance = self.tries[index].chance(number);
            if helped { chance } else { 1.0 - chance }
        });
        self.shares[index] * each.product::<f64>()
    }

    /// Count incidents of a kind for which a depth is the least that is enough.
    fn count(&mut self, kind: &Kind, index: usize, incidents: f64) {
        self.shares[index] += incidents;
        for (number, helped) in attempts(kind, index) {
            self.tries[index].add(number, helped, incidents);
        }
    }

    /// An incident of which nothing is known but that attempts of these depths have failed.
    pub(crate) fn after(&self, tried: &[usize]) -> Course<'_> {
        let numbers = [0; DEPTH_MAX + 1];
        let mut course = Course { belief: self, shares: self.shares, numbers, spent_s: 0.0 };
        for &depth in tried {
            course.fail(depth);
            course.shares = normal(course.shares);
        }
        course
    }
}

/// An incident and a plan that is followed in thought; the shares are what is left of them.
#[derive(Clone)]
pub(crate) struct Course<'b> {
    belief: &'b Belief,
    shares: Numbers,
    /// By least depth, how many attempts have gone so far.
    numbers: [usize; DEPTH_MAX + 1],
    spent_s: f64,
}

impl Course<'_> {
    /// The chance that an attempt of a depth gets past the error.
    pub(crate) fn chance(&self, depth: usize) -> f64 {
        let one = |index: usize| self.shares[index] * self.helps(index);
        (0..depth.min(DEPTH_MAX)).map(one).sum()
    }

    /// The chance that the next attempt helps that goes far enough.
    fn helps(&self, index: usize) -> f64 {
        self.belief.tries[index].chance(self.numbers[index])
    }

    /// Take from the shares what an attempt of a depth gets past.
    fn fail(&mut self, depth: usize) {
        for index in 0..depth.min(DEPTH_MAX) {
            self.shares[index] *= 1.0 - self.helps(index);
            self.numbers[index] += 1;
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
        let mut course = self.clone();
        let mut least_s = f64::INFINITY;
        for left in (0..costs.attempts_left).rev() {
            least_s = least_s.min(course.attempt(first, costs));
            for then in (1..=costs.by_depth_s.len().min(DEPTH_MAX)).filter(|then| *then != first) {
                least_s = least_s.min(course.clone().go_on(then, left, costs));
            }
        }
        least_s
    }

    /// One attempt more. The expected time if it is given up after that, in seconds.
    fn attempt(&mut self, depth: usize, costs: Costs<'_>) -> f64 {
        let open: f64 = self.shares.iter().sum();
        self.spent_s += open * costs.by_depth_s[depth - 1];
        self.fail(depth);
        self.spent_s + self.shares.iter().sum::<f64>() * costs.give_up_s
    }

    /// The same depth up to so often. The expected time if it is given up where that is best.
    fn go_on(mut self, depth: usize, times: u32, costs: Costs<'_>) -> f64 {
        (0..times).map(|_| self.attempt(depth, costs)).fold(f64::INFINITY, f64::min)
    }
}
