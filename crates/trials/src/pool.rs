//! Work on all cores whose results come in order, whoever was faster.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc;

/// How many numbers a thread takes at a time.
const BATCH: u64 = 8;

/// Do the work of each number of a range on so many threads, and deliver the results in order.
/// Each thread works with a worker of its own.
///
/// # Errors
/// The first error of the delivery, after which no more work is begun.
pub fn ordered<T: Send, E, W: FnMut(u64) -> T>(
    jobs: usize,
    numbers: Range<u64>,
    worker: impl Fn() -> W + Sync,
    mut deliver: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let (next, is_over) = (AtomicU64::new(numbers.start), AtomicBool::new(false));
    let batches = numbers.end.saturating_sub(numbers.start).div_ceil(BATCH);
    let threads = (jobs.max(1) as u64).min(batches);
    std::thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..threads {
            let (sender, worker, next, is_over) = (sender.clone(), &worker, &next, &is_over);
            let end = numbers.end;
            scope.spawn(move || {
                let mut work = worker();
                while !is_over.load(Ordering::Relaxed) {
                    let first = next.fetch_add(BATCH, Ordering::Relaxed);
                    if first >= end {
                        return;
                    }
                    let results: Vec<T> = (first..end.min(first + BATCH)).map(&mut work).collect();
                    if sender.send((first, results)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let (mut due, mut early) = (numbers.start, BTreeMap::new());
        for (first, results) in receiver {
            early.insert(first, results);
            while let Some(results) = early.remove(&due) {
                due += BATCH;
                for result in results {
                    if let Err(error) = deliver(result) {
                        is_over.store(true, Ordering::Relaxed);
                        return Err(error);
                    }
                }
            }
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;
    use std::time::Duration;

    #[test]
    fn results_come_in_order_from_any_number_of_threads() {
        for jobs in [0, 1, 2, 7, 64] {
            for range in [0..0, 0..1, 3..8, 0..8, 5..1000] {
                let mut found = Vec::new();
                let slow_at_first = || {
                    |number: u64| {
                        if number.is_multiple_of(97) {
                            std::thread::sleep(Duration::from_millis(1));
                        }
                        number * number
                    }
                };
                let Ok(()) = ordered(jobs, range.clone(), slow_at_first, |square| {
                    found.push(square);
                    Ok::<(), Infallible>(())
                });
                assert_eq!(found, range.map(|number| number * number).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn an_error_of_the_delivery_ends_the_work() {
        let worked = AtomicU64::new(0);
        let worker = || |number: u64| (worked.fetch_add(1, Ordering::Relaxed), number).1;
        let refuse_ten = |number| if number == 10 { Err(number) } else { Ok(()) };
        assert_eq!(ordered(2, 0..u64::MAX - 64, worker, refuse_ten), Err(10));
        assert!(worked.load(Ordering::Relaxed) < 1_000_000);
    }
}
