//! Learning before a campaign: a phase of its own, on seeds of its own, after which the memory
//! stays as it is.
//!
//! A memory that went on growing through the campaign would make each assembly depend on all
//! before it, and so a shard on all other shards. So the phase comes first and is the same in
//! every shard. It goes in epochs that grow by a quarter of all before: the runs of an epoch go by
//! what was learned from all epochs before, and what they teach is added in the order of the runs,
//! so that all cores can work and the memory does not depend on how many there are. Every assembly
//! that counts is then judged by a memory that knows nothing of it.

use crate::case::{Case, Stand};
use crate::plan::{Purpose, seed_of};
use crate::pool;
use crate::strategy::Strategy;
use std::convert::Infallible;
use std::ops::Range;

/// How many runs an epoch has at the least.
const FEWEST: u64 = 32;

/// The epochs of so many runs: a quarter of the runs that there were before each. What is tried to
/// learn from is soon gone by, and not tried by half of all runs in vain.
fn epochs(runs: u64) -> impl Iterator<Item = Range<u64>> {
    let mut end = 0;
    std::iter::from_fn(move || {
        let begin = end;
        end = runs.min(begin + (begin / 4).max(FEWEST));
        (begin < end).then_some(begin..end)
    })
}

/// What is learned from so many runs, beginning with a memory.
pub fn learn<C: Case>(
    case: &C,
    mut memory: C::Memory,
    seed: u64,
    runs: u64,
    jobs: usize,
    progress: &mut dyn FnMut(u64),
) -> C::Memory {
    for epoch in epochs(runs) {
        let before = memory.clone();
        let worker = || {
            let mut stand = case.stand(&before);
            move |run| {
                let seed = seed_of(seed, Purpose::Learning, run);
                stand.assemble(seed, Strategy::Learned)
            }
        };
        let mut done = epoch.start;
        let Ok(()) = pool::ordered(jobs, epoch, worker, |outcome| {
            case.learn(&mut memory, &outcome);
            done += 1;
            progress(done);
            Ok::<(), Infallible>(())
        });
    }
    memory
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn epochs_grow_and_cover_each_run_once() {
        let lengths = |runs| epochs(runs).map(|epoch| epoch.end - epoch.start).collect::<Vec<_>>();
        assert_eq!(lengths(0), Vec::<u64>::new());
        assert_eq!(lengths(5), [5]);
        assert_eq!(lengths(100), [32, 32, 32, 4]);
        assert_eq!(lengths(256), [32, 32, 32, 32, 32, 40, 50, 6]);
    }
}
