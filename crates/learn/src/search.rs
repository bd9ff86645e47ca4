//! Discrete elimination by bounds of Wilson over a kernel estimate (after arXiv 2509.09238): all
//! candidates are tried a few times, in rounds; those that are surely worse than the best are left
//! out; and the rest are tried again.
//!
//! What is seen of a candidate says something of its neighbours: successes and runs are summed with
//! the weights of a Gaussian kernel over the ranges, and count as the effective number of runs
//! (Kish 1965). Those left out go on counting for their neighbours. Who was best by luck would look
//! better than it is, so that what is reported of the best, and of the defaults beside it, comes
//! from seeds that nothing was chosen by.

use obverse_trials::plan::{Purpose, seed_of};
use obverse_trials::pool;
use obverse_trials::statistics::{Interval, wilson, wilson_weighted};
use std::convert::Infallible;

/// How often a candidate is tried in a round.
const BATCH: u64 = 8;
/// The share of all runs that is kept to confirm the choice.
const CONFIRMED: f64 = 0.25;
/// The best is known when its interval is narrower than this.
const NARROW: f64 = 0.04;
/// How far the kernel reaches for one candidate in one dimension, in parts of a range.
const REACH: f64 = 0.3;

/// What a search may take.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// How many runs in all, those that confirm among them.
    pub runs: u64,
    /// What all seeds follow from.
    pub seed: u64,
    /// On how many threads. It changes no result.
    pub jobs: usize,
}

/// How a candidate has stood.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Standing {
    /// How often it was tried.
    pub runs: u64,
    /// How often it succeeded.
    pub successes: u64,
    /// What its chance is held to be, by its neighbours too; none before anything was tried.
    pub estimate: Option<Estimate>,
    /// After which round it was left out; none for those that were left.
    pub left_out: Option<u32>,
}

/// What a chance is held to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The chance.
    pub chance: f64,
    /// Where it lies.
    pub interval: Interval,
}

/// Runs with seeds that nothing was chosen by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Confirmed {
    /// How many.
    pub runs: u64,
    /// How many succeeded.
    pub successes: u64,
}

impl Confirmed {
    /// Where the chance lies; none of no runs.
    #[must_use]
    pub fn interval(&self) -> Option<Interval> {
        wilson(self.successes, self.runs)
    }
}

/// What came of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Learned {
    /// The index of the best candidate.
    pub best: usize,
    /// By candidate.
    pub standings: Vec<Standing>,
    /// How many rounds there were.
    pub rounds: u32,
    /// How the best did on seeds of its own.
    pub confirmed: Confirmed,
    /// How the first candidate, the defaults, did on the same.
    pub defaults: Confirmed,
}

/// Search among candidates, given as shares of their ranges; the first are the defaults.
/// `attempt` says whether a candidate succeeds with a seed; `progress` hears of each run.
///
/// # Panics
/// Never; without candidates nothing is tried, and the best is the one that is not there.
pub fn search(
    points: &[Vec<f64>],
    budget: Budget,
    attempt: impl Fn(usize, u64) -> bool + Sync,
    mut progress: impl FnMut(),
) -> Learned {
    let weights = weights(points);
    let mut standings = vec![Standing::default(); points.len()];
    let reserved = reserved(budget.runs);
    let mut left = budget.runs.saturating_sub(reserved);
    let (mut rounds, mut drawn) = (0, 0);
    loop {
        let alive: Vec<usize> =
            (0..points.len()).filter(|&index| standings[index].left_out.is_none()).collect();
        let batch = BATCH.min(left / (alive.len() as u64).max(1));
        let is_known = rounds > 0 && (alive.len() <= 1 || is_narrow(&standings, &alive));
        if batch == 0 || is_known {
            break;
        }
        let seeds = Seeds { campaign: budget.seed, purpose: Purpose::Parameters, first: drawn };
        let counts = tried(&alive, batch, seeds, budget.jobs, &attempt, &mut progress);
        for (&index, successes) in alive.iter().zip(counts) {
            standings[index].runs += batch;
            standings[index].successes += successes;
        }
        drawn += batch;
        left -= batch * alive.len() as u64;
        rounds += 1;
        estimate(&weights, &mut standings);
        eliminate(&mut standings, &alive, rounds);
    }
    let best = best(&standings);
    let both = if best == 0 { vec![0] } else { vec![best, 0] };
    let runs = (reserved + left) / both.len() as u64;
    let seeds = Seeds { campaign: budget.seed, purpose: Purpose::Confirmation, first: 0 };
    let counts = match points.is_empty() {
        true => Vec::new(),
        false => tried(&both, runs, seeds, budget.jobs, &attempt, &mut progress),
    };
    let confirmed = |at: Option<&u64>| Confirmed { runs, successes: at.copied().unwrap_or(0) };
    let (confirmed, defaults) = (confirmed(counts.first()), confirmed(counts.last()));
    Learned { best, standings, rounds, confirmed, defaults }
}

/// How many of so many runs are kept to confirm the choice.
fn reserved(runs: u64) -> u64 {
    ((runs as f64 * CONFIRMED) as u64).max(2)
}

/// The fewest runs of which enough choose that each of so many candidates is tried once.
#[must_use]
pub fn least_runs(candidates: usize) -> u64 {
    let candidates = candidates as u64;
    // Half as many again are more than enough.
    let enough = |runs: &u64| runs - reserved(*runs) >= candidates;
    (candidates + 2..candidates.saturating_mul(2) + 2).find(enough).unwrap_or(candidates + 2)
}

/// A row of seeds.
#[derive(Clone, Copy)]
struct Seeds {
    campaign: u64,
    purpose: Purpose,
    first: u64,
}

/// How often each of some candidates succeeds with the same seeds.
fn tried(
    candidates: &[usize],
    each: u64,
    seeds: Seeds,
    jobs: usize,
    attempt: &(impl Fn(usize, u64) -> bool + Sync),
    progress: &mut impl FnMut(),
) -> Vec<u64> {
    let mut successes = vec![0; candidates.len()];
    let all = each * candidates.len() as u64;
    let place = |number: u64| (number / each.max(1)) as usize;
    let worker = || {
        |number: u64| {
            let seed = seed_of(seeds.campaign, seeds.purpose, seeds.first + number % each);
            (place(number), attempt(candidates[place(number)], seed))
        }
    };
    let Ok(()) = pool::ordered(jobs, 0..all, worker, |(place, is_success)| {
        successes[place] += u64::from(is_success);
        progress();
        Ok::<(), Infallible>(())
    });
    successes
}

/// How much what is seen of one candidate counts for another.
fn weights(points: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let dimensions = points.first().map_or(1, Vec::len) as f64;
    // Scott's rule: the more candidates, the nearer those that count.
    let reach = REACH * libm::pow(points.len().max(1) as f64, -1.0 / (dimensions + 4.0));
    let weight = |a: &Vec<f64>, b: &Vec<f64>| {
        let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
        libm::exp(-square / (2.0 * reach * reach))
    };
    points.iter().map(|a| points.iter().map(|b| weight(a, b)).collect()).collect()
}

/// What each candidate's chance is held to be.
fn estimate(weights: &[Vec<f64>], standings: &mut [Standing]) {
    let tallies: Vec<(f64, f64)> =
        standings.iter().map(|one| (one.runs as f64, one.successes as f64)).collect();
    for (row, standing) in weights.iter().zip(standings) {
        let sums =
            row.iter().zip(&tallies).fold([0.0; 3], |[all, won, squares], (weight, tally)| {
                let (runs, successes) = tally;
                [all + weight * runs, won + weight * successes, squares + weight * weight * runs]
            });
        let [all, won, squares] = sums;
        if squares > 0.0 {
            let (chance, effective) = (won / all, all * all / squares);
            standing.estimate = wilson_weighted(chance * effective, effective)
                .map(|interval| Estimate { chance, interval });
        }
    }
}

/// Leave out those whose chance is surely below that of the best.
fn eliminate(standings: &mut [Standing], alive: &[usize], round: u32) {
    let interval = |standing: &Standing| standing.estimate.map(|estimate| estimate.interval);
    let lows = alive.iter().filter_map(|&index| interval(&standings[index]));
    let bar = lows.map(|interval| interval.low).fold(0.0, f64::max);
    for &index in alive {
        if interval(&standings[index]).is_some_and(|interval| interval.high < bar) {
            standings[index].left_out = Some(round);
        }
    }
}

/// Whether the best of those that are left is known well enough.
fn is_narrow(standings: &[Standing], alive: &[usize]) -> bool {
    let best = best(standings);
    alive.contains(&best)
        && standings[best]
            .estimate
            .is_some_and(|estimate| estimate.interval.high - estimate.interval.low < NARROW)
}

/// The candidate that is surely as good as any: the highest lower bound, the first of those alike.
fn best(standings: &[Standing]) -> usize {
    let low = |standing: &Standing| match (standing.left_out, standing.estimate) {
        (None, Some(estimate)) => estimate.interval.low,
        _ => -1.0,
    };
    let mut best = 0;
    for (index, standing) in standings.iter().enumerate() {
        if low(standing) > low(&standings[best]) {
            best = index;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Succeeds with a chance, by the seed.
    fn chance(seed: u64, chance: f64) -> bool {
        (seed as f64 / (1_u64 << 53) as f64) < chance
    }

    fn line(count: usize) -> Vec<Vec<f64>> {
        (0..count).map(|index| vec![index as f64 / (count - 1) as f64]).collect()
    }

    fn peak(share: f64) -> f64 {
        0.95 - 2.0 * (share - 0.7) * (share - 0.7)
    }

    fn learned(runs: u64, seed: u64, jobs: usize) -> Learned {
        let points = line(21);
        let attempt = |index: usize, seed| chance(seed, peak(points[index][0]));
        search(&points, Budget { runs, seed, jobs }, attempt, || {})
    }

    #[test]
    fn the_best_is_found_and_its_chance_is_known() {
        for seed in 0..20 {
            let learned = learned(4000, seed, 2);
            let share = learned.best as f64 / 20.0;
            assert!(peak(share) > 0.9, "seed {seed}: {share}");
            let interval = learned.confirmed.interval().expect("there are runs");
            assert!(interval.low - 0.03 < peak(share) && peak(share) < interval.high + 0.03);
            assert!(learned.confirmed.successes > learned.defaults.successes, "seed {seed}");
            assert!(learned.standings[0].left_out.is_some(), "seed {seed}: the worst is left out");
        }
    }

    #[test]
    fn a_result_depends_on_the_seed_alone() {
        assert_eq!(learned(2000, 3, 1), learned(2000, 3, 5));
        assert_ne!(learned(2000, 3, 1), learned(2000, 4, 1));
    }

    #[test]
    fn no_more_runs_are_made_than_allowed() {
        for runs in [0, 1, 2, 10, 100, 999] {
            let mut made = 0;
            let budget = Budget { runs, seed: 0, jobs: 2 };
            search(&line(21), budget, |_, seed| chance(seed, 0.5), || made += 1);
            assert!(made <= runs.max(2), "{made} of {runs}");
        }
        let budget = Budget { runs: 10, seed: 0, jobs: 1 };
        assert_eq!(search(&[], budget, |_, _| true, || {}).standings, []);
    }

    /// With the fewest runs each candidate is tried, and with one run less none is.
    #[test]
    fn who_has_the_fewest_runs_tries_each_candidate() {
        for count in [2, 3, 7, 24, 64, 1024] {
            let runs = least_runs(count);
            let tried = |runs| {
                let budget = Budget { runs, seed: 0, jobs: 2 };
                search(&line(count), budget, |_, seed| chance(seed, 0.5), || {}).standings
            };
            assert!(tried(runs).iter().all(|standing| standing.runs > 0), "{count}: {runs}");
            assert!(tried(runs - 1).iter().all(|standing| standing.runs == 0), "{count}: {runs}");
        }
    }

    #[test]
    fn neighbours_count_and_strangers_do_not() {
        let weights = weights(&line(21));
        assert_eq!(weights[3][3], 1.0);
        assert!(weights[3][4] > 0.5 && weights[3][20] < 1e-5, "{:?}", weights[3]);
    }
}
