//! Files of shards: whole or refused, gone on with or foreign.

use crate::toy::{plan, records};
use obverse_trials::shard::{Begun, MergeError, end_line, head_line};
use obverse_trials::{Part, Shard, ShardError, merge};

fn part(index: u32, count: u32) -> Part {
    let plan = plan("stop,learned", 9);
    let shard = Shard { index, count };
    let records = records(&plan, shard, 1);
    Part { plan, shard, records }
}

fn named(part: Part) -> (String, Part) {
    (format!("file {}", part.shard), part)
}

#[test]
fn a_file_says_all_of_its_part() {
    let part = part(2, 3);
    assert_eq!(Part::parse(part.to_text().as_bytes()), Ok(part));
}

#[test]
fn a_file_that_is_cut_anywhere_is_refused() {
    let text = part(1, 2).to_text();
    for end in 0..text.len() {
        let error = Part::parse(&text.as_bytes()[..end]).expect_err("a part of it is missing");
        assert!(matches!(error, ShardError::Torn(_) | ShardError::NotAShard), "{end}: {error}");
    }
}

#[test]
fn a_file_with_a_changed_byte_is_refused() {
    let text = part(1, 2).to_text().into_bytes();
    for at in 0..text.len() {
        let mut changed = text.clone();
        changed[at] ^= 0x04;
        assert!(Part::parse(&changed).is_err(), "byte {at}");
    }
}

#[test]
fn what_its_maker_could_not_have_written_is_refused() {
    let text = part(1, 1).to_text();
    let body = &text[..text.trim_end().rfind('\n').expect("lines") + 1];
    let sealed = |body: &str| body.to_owned() + &end_line(body.as_bytes());
    assert!(Part::parse(sealed(body).as_bytes()).is_ok());
    let lines: Vec<&str> = body.lines().collect();
    let swapped = [lines[0], lines[2], lines[1]].join("\n") + "\n";
    let wrong = [
        (swapped, "line 2: run 0 by stop"),
        (body.replacen("\"format\":4", "\"format\":1", 1), "format 1"),
        (body.replacen("\"runs\":9", "\"runs\":10", 1), "not whole"),
        (body.replacen("\"runs\":9", "\"runs\":99999999999", 1), "too many runs"),
        (body.replacen("\"index\":1", "\"index\":2", 1), "no such shard"),
        (body.replacen("[\"stop\",\"learned\"]", "[]", 1), "strategies"),
        (body.replacen("\"makespan_s\":", "\"makespan_s\":-", 1), "negative"),
        (body.replacen("\"makespan_s\":", "\"makespan_s\":1e999,\"x\":", 1), "line 2"),
        (body.replacen("{\"type\":\"run\"", "{\"type\":\"end\"", 1), "line 2"),
        ("[[[[".repeat(10_000) + "\n", "no file of a campaign"),
    ];
    for (body, words) in wrong {
        let error = Part::parse(sealed(&body).as_bytes()).expect_err(words).to_string();
        assert!(error.contains(words), "{words}: {error}");
    }
}

#[test]
fn what_was_begun_is_gone_on_with_from_its_last_whole_run() {
    let part = part(2, 2);
    let (plan, text) = (&part.plan, part.to_text());
    let head = head_line(plan, part.shard).len();
    for end in head..=text.len() {
        let begun = Begun::parse(&text.as_bytes()[..end], plan, part.shard).expect("it is ours");
        assert!(begun.records.len().is_multiple_of(2) && begun.bytes <= end);
        assert_eq!(begun.records, part.records[..begun.records.len()]);
        let rest = records(plan, part.shard, 1).split_off(begun.records.len());
        let mut whole = text[..begun.bytes].to_owned();
        whole.extend(rest.iter().map(obverse_trials::shard::record_line));
        assert_eq!(whole.clone() + &end_line(whole.as_bytes()), text, "stopped after {end} bytes");
    }
}

#[test]
fn what_another_campaign_began_is_refused() {
    let part = part(1, 2);
    let text = part.to_text();
    let begun =
        |plan: &obverse_trials::Plan, shard: Shard| Begun::parse(text.as_bytes(), plan, shard);
    let foreign = |result: Result<Begun, ShardError>, words: &str| {
        let error = result.expect_err(words).to_string();
        assert!(error.contains("another campaign") && error.contains(words), "{error}");
    };
    let change = |change: fn(&mut obverse_trials::Plan)| {
        let mut plan = part.plan.clone();
        change(&mut plan);
        plan
    };
    let shard = part.shard;
    foreign(begun(&part.plan, Shard { index: 2, count: 2 }), "shard 1/2, and not 2/2");
    foreign(begun(&change(|plan| plan.seed = 6), shard), "seed is 5, and not 6");
    foreign(begun(&change(|plan| plan.runs = 10), shard), "number of runs is 9, and not 10");
    foreign(begun(&change(|plan| plan.cell_digest = "3".to_owned()), shard), "workcell");
    foreign(begun(&change(|plan| plan.program_digest = "3".to_owned()), shard), "program");
    foreign(begun(&change(|plan| plan.version = "9".to_owned()), shard), "version of Obverse");
    foreign(begun(&change(|plan| _ = plan.strategies.pop()), shard), "stop,learned, and not stop");
    assert_eq!(Begun::parse(b"hello\n", &part.plan, shard), Err(ShardError::NotAShard));
    assert_eq!(Begun::parse(&[0; 4096], &part.plan, shard), Err(ShardError::NotAShard));
}

#[test]
fn shards_that_are_missing_twice_there_or_foreign_are_refused() {
    let all = || (1..=3).map(|index| named(part(index, 3)));
    assert!(merge(all().collect()).is_ok());
    assert_eq!(merge(Vec::new()), Err(MergeError::Nothing));
    let shard = Shard { index: 2, count: 3 };
    let missing = merge(all().filter(|(_, part)| part.shard != shard).collect());
    assert_eq!(missing, Err(MergeError::Missing { shard, others: 0 }));
    let one = merge(all().skip(2).collect());
    assert_eq!(one, Err(MergeError::Missing { shard: Shard { index: 1, count: 3 }, others: 1 }));

    let refused = |parts: Vec<(String, Part)>, words: &str| {
        let error = merge(parts).expect_err(words).to_string();
        assert!(error.contains(words), "{error}");
    };
    let twice = ("again".to_owned(), part(2, 3));
    refused(all().chain([twice]).collect(), "again: this is shard 2/3, and so is file 2/3");
    refused(all().take(2).chain([named(part(3, 4))]).collect(), "one of 4 shards, and not of 3");
    let mut foreign = part(3, 3);
    foreign.plan.seed = 6;
    refused(all().take(2).chain([named(foreign)]).collect(), "its seed is 6, and not 5");
}
