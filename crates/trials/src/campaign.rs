//! Running a campaign, or the rest of one, on all cores.

use crate::case::{Case, Stand};
use crate::outcome::Record;
use crate::plan::{Plan, Purpose, seed_of};
use crate::pool;
use std::ops::Range;

/// Make the assemblies of some runs of a campaign by each of its strategies, and hand on the
/// records of one run after another, in order.
///
/// # Errors
/// The first error of who they are handed to, after which no more runs are begun.
pub fn run<C: Case, E>(
    case: &C,
    memory: &C::Memory,
    plan: &Plan,
    runs: Range<u64>,
    jobs: usize,
    mut hand_on: impl FnMut(Vec<Record>) -> Result<(), E>,
) -> Result<(), E> {
    let worker = || {
        let mut stand = case.stand(memory);
        move |run| {
            let seed = seed_of(plan.seed, Purpose::Trial, run);
            let assemble = |strategy| {
                let outcome = stand.assemble(seed, strategy);
                Record { run, seed, strategy, outcome }
            };
            plan.strategies.iter().copied().map(assemble).collect()
        }
    };
    pool::ordered(jobs, runs, worker, &mut hand_on)
}
