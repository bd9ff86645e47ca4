//! What a campaign computes.

use crate::toy::{PERSON_S, Toy, plan, records};
use obverse_trials::{Part, Shard, merge, plots, summary, table};

#[test]
fn a_campaign_does_not_depend_on_threads_or_shards() {
    let plan = plan("all", 101);
    let whole =
        Part { plan: plan.clone(), shard: Shard::WHOLE, records: records(&plan, Shard::WHOLE, 1) };
    for jobs in [2, 3, 16] {
        assert!(records(&plan, Shard::WHOLE, jobs) == whole.records, "{jobs} jobs");
    }
    for count in [2, 3, 101, 200] {
        let part = |index| {
            let shard = Shard { index, count };
            let jobs = 1 + index as usize % 3;
            let part = Part { plan: plan.clone(), shard, records: records(&plan, shard, jobs) };
            let read = Part::parse(part.to_text().as_bytes()).expect("it was written so");
            (format!("shard {index}"), read)
        };
        // In another order than theirs.
        let merged = merge((1..=count).rev().map(part).collect()).expect("all are there");
        assert!(merged.to_text() == whole.to_text(), "{count} shards");
    }
}

#[test]
fn what_is_learned_does_not_depend_on_threads_and_is_the_truth() {
    let learn = |jobs| obverse_trials::learn(&Toy, Vec::new(), 9, 1000, jobs, &mut |_| {});
    let memory = learn(1);
    assert_eq!(learn(2), memory);
    assert_eq!(learn(16), memory);
    let errors: u64 = memory.iter().sum();
    // Three in ten of a thousand: six standard deviations on either side are 87.
    assert!((213..=387).contains(&errors), "{memory:?}");
    assert_eq!(memory[0], 0);
    assert!(memory[1..].iter().all(|count| *count > 20), "{memory:?}");
}

#[test]
fn progress_of_learning_ends_with_all_of_it() {
    let mut seen = Vec::new();
    obverse_trials::learn(&Toy, Vec::new(), 9, 50, 2, &mut |done| seen.push(done));
    assert_eq!(seen, (1..=50).collect::<Vec<_>>());
}

#[test]
fn the_figures_are_those_of_the_case() {
    let plan = plan("stop,retry,fixed:2,escalating,oracle", 2000);
    let records = records(&plan, Shard::WHOLE, 2);
    let summary = summary(&plan, &records);
    let [stop, retry, fixed, escalating, oracle] = &summary.strategies[..] else {
        panic!("{summary:?}")
    };
    for tally in &summary.strategies {
        assert_eq!((tally.runs, tally.in_error), (2000, stop.in_error), "the same seeds");
        assert_eq!(tally.to_a_person, tally.in_error - tally.all.recovered);
        let (mean, interval) = (tally.makespan_mean_s(), tally.makespan_interval_s());
        let (mean, interval) = (mean.expect("runs"), interval.expect("runs"));
        assert!(interval.low < mean && mean < interval.high);
    }
    assert_eq!((stop.all.recovered, retry.all.recovered), (0, 0));
    assert_eq!(stop.all.mean_depth(), None);
    assert_eq!(escalating.all.share(), Some(1.0));
    assert_eq!(oracle.all.share(), Some(1.0));
    let half = fixed.all.interval().expect("errors");
    assert!(half.low < 0.5 && 0.5 < half.high, "two of four causes: {half:?}");
    assert!(stop.makespan_quantile_s(0.95) > Some(PERSON_S));
    assert!(retry.makespan_mean_s() > stop.makespan_mean_s(), "it tries in vain");
    // By cause: each is recovered wholly or not at all.
    for kind in fixed.kinds.iter().filter(|kind| kind.cause.is_some()) {
        let helps = matches!(kind.cause.as_deref(), Some("cause 1" | "cause 2"));
        assert_eq!(kind.errors.recovered, if helps { kind.errors.count } else { 0 });
    }
}

#[test]
fn tables_and_plots_name_each_strategy_and_nothing_is_no_number() {
    for runs in [0, 1, 300] {
        let plan = plan("all", runs);
        let summary = summary(&plan, &records(&plan, Shard::WHOLE, 2));
        let texts = plots::plots(&plan, &summary).into_iter().map(|plot| plot.svg);
        for text in texts.chain([table::draw(&summary)]) {
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
            for strategy in &plan.strategies {
                assert!(text.contains(&strategy.to_string()), "{strategy} in {text}");
            }
        }
    }
}
