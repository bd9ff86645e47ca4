//! What a campaign computes.

use crate::toy::{PERSON_S, Toy, plan, records};
use obverse_trials::statistics::Interval;
use obverse_trials::{
    Ending, Part, Plan, Record, Shard, Stop, Strategy, merge, plots, summary, table,
};

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

/// An assembly that only seems to be right is worse than an error that was given up.
#[test]
fn what_ends_falsely_counts_for_nothing_and_is_said() {
    let plan = plan("escalating,oracle", 300);
    let mut records = records(&plan, Shard::WHOLE, 2);
    let before = summary(&plan, &records);
    let is_false = |record: &Record| {
        record.strategy == Strategy::Escalating && !record.outcome.incidents.is_empty()
    };
    let changed = records.iter_mut().filter(|record| is_false(record)).map(|record| {
        record.outcome.ending = Ending::FalseSuccess;
        record.outcome.why = Some("`peg` in the hole of `block`: depth".to_owned());
    });
    let count = changed.count() as u64;
    let after = summary(&plan, &records);
    let ([escalating, oracle], before) = (&after.strategies[..], &before.strategies[0]) else {
        panic!("{after:?}")
    };
    assert_eq!(before.all.recovered, count, "each of them went on past its error");
    assert_eq!((escalating.all.recovered, escalating.all.count), (0, count));
    assert_eq!((before.to_a_person, escalating.to_a_person), (0, count));
    assert_eq!((escalating.false_successes, oracle.false_successes), (count, 0));
    let table = table::draw(&after);
    let row = format!("escalating  `peg` in the hole of `block`: depth  {count:>10}");
    assert!(table.contains(&row), "{table}");
    let endings = plots::plots(&plan, &after).remove(0);
    assert!(endings.name == "endings.svg" && endings.svg.contains("seemingly"), "{endings:?}");
    let unjudged = Plan { goals: 0, ..plan };
    let table = table::draw(&summary(&unjudged, &records));
    let cell = |row: &str, column| row.split_whitespace().nth(column).map(str::to_owned);
    let falsely = table.lines().nth(1).and_then(|row| cell(row, 11));
    assert_eq!(falsely.as_deref(), Some("-"), "nothing was judged: {table}");
}

/// An error that was put right stays so when another one brings a person later; not if a person had
/// to release the arm for it.
#[test]
fn an_error_is_put_right_by_itself_or_not() {
    let plan = plan("oracle,stop", 300);
    let mut records = records(&plan, Shard::WHOLE, 2);
    let before = summary(&plan, &records).strategies[0].all.recovered;
    assert!(before > 50, "{before}");
    let is_put_right = |record: &&mut Record| {
        record.strategy == Strategy::Oracle && !record.outcome.incidents.is_empty()
    };
    for record in records.iter_mut().filter(is_put_right) {
        let mut other = record.outcome.incidents[0].clone();
        (other.error, other.recovered) = ("lost".to_owned(), false);
        record.outcome.incidents.push(other);
        record.outcome.ending = Ending::GivenUp;
        record.outcome.why = Some("lost: attempts".to_owned());
    }
    let after = summary(&plan, &records);
    let oracle = &after.strategies[0];
    assert_eq!((oracle.all.recovered, oracle.all.count), (before, 2 * before));
    assert_eq!(
        (oracle.to_a_person, oracle.brought_by["given up: lost: attempts"]),
        (before, before)
    );
    let row = format!("oracle    given up: lost: attempts  {before:>10}");
    assert!(table::draw(&after).contains(&row), "{}", table::draw(&after));
    for record in records.iter_mut().filter(is_put_right) {
        record.outcome.incidents[0].stop = Some(Stop::Released);
    }
    assert_eq!(summary(&plan, &records).strategies[0].all.recovered, 0, "a person released it");
}

/// All strategies make the same assemblies: their difference is of pairs, from which what the
/// assemblies differ in by themselves has gone.
#[test]
fn makespans_are_compared_assembly_by_assembly() {
    let plan = plan("stop,retry,learned", 500);
    let records = records(&plan, Shard::WHOLE, 2);
    let summary = summary(&plan, &records);
    let [stop, retry, learned] = &summary.strategies[..] else { panic!("{summary:?}") };
    assert_eq!(summary.compared_with, Some(Strategy::Learned));
    assert_eq!((learned.longer_mean_s(), learned.longer_interval_s()), (None, None));
    for tally in [stop, retry] {
        let difference = tally.longer_mean_s().expect("runs");
        let of_means = tally.makespan_mean_s().zip(learned.makespan_mean_s()).map(|(a, b)| a - b);
        assert!((difference - of_means.expect("runs")).abs() < 1e-9, "{difference}");
        let interval = tally.longer_interval_s().expect("runs");
        assert!(interval.low < difference && difference < interval.high, "{interval:?}");
    }
    let table = table::draw(&summary);
    assert!(table.contains("mean s more than learned"), "{table}");
    // Three tries in vain cost 9 s where something jams, and nothing else differs.
    let plan = self::plan("stop,retry", 500);
    let alone = obverse_trials::summary(&plan, &records);
    assert_eq!(alone.compared_with, Some(Strategy::Stop));
    let (jammed, retry) = (alone.strategies[0].in_error as f64, &alone.strategies[1]);
    let difference = retry.longer_mean_s().expect("runs");
    assert!((difference - 9.0 * jammed / 500.0).abs() < 1e-9, "{difference}");
    let width = |interval: Interval| interval.high - interval.low;
    let paired = width(retry.longer_interval_s().expect("runs"));
    let by_itself = width(retry.makespan_interval_s().expect("runs"));
    assert!(20.0 * paired < by_itself, "{paired} and {by_itself}");
    let one = obverse_trials::summary(&self::plan("stop", 500), &records);
    assert_eq!(one.compared_with, None);
    assert!(!table::draw(&one).contains("more than"));
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
