//! What was learned of recoveries, kept in a file: beside what others learn meanwhile, of one
//! program alone, and never lost for what is wrong with it.

use super::support::Bench;
use obverse_recovery::MemoryCode;
use serde_json::Value;
use std::fs;
use std::thread;

const RUN: [&str; 3] = ["run", "reversal_policy.obv", "--memory"];

/// A run that has one incident, and how far it goes back does not depend on what is known.
fn run(bench: &Bench) {
    bench.run(&[&RUN[..], &["m.toml", "--strategy", "fixed:2"]].concat());
}

/// How many incidents a memory holds.
fn incidents(bench: &Bench) -> i64 {
    let text = fs::read_to_string(bench.path("m.toml")).expect("a memory");
    let times = text.lines().filter_map(|line| line.strip_prefix("times = "));
    times.map(|times| times.parse::<i64>().expect("a number")).sum()
}

#[test]
fn runs_at_the_same_time_lose_nothing_of_each_other() {
    let bench = Bench::new("memory_shared");
    run(&bench);
    assert_eq!(incidents(&bench), 1);
    thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| run(&bench));
        }
    });
    assert_eq!(incidents(&bench), 9);
}

#[test]
fn what_is_wrong_with_a_memory_is_said_with_its_code_and_it_stays_as_it_is() {
    let bench = Bench::new("memory_wrong");
    let codes = || -> Vec<String> {
        let messages = bench.refuses_as_json(&[&RUN[..], &["m.toml", "--json"]].concat());
        let code = |message: &Value| message["code"].as_str().unwrap_or_default().to_owned();
        messages.iter().map(code).collect()
    };
    for code in MemoryCode::ALL {
        let page = code.page();
        let own = |text: &str| {
            text.replace("\"p.obv\"", "\"reversal_policy.obv\"")
                .replace("\"c.toml\"", "\"peg_in_hole.toml\"")
        };
        let wrong = own(page.wrong);
        bench.write("m.toml", &wrong);
        assert_eq!(codes(), [code.as_str()]);
        assert_eq!(fs::read_to_string(bench.path("m.toml")).expect("a file"), wrong);
        bench.write("m.toml", own(page.right));
        assert!(bench.run(&[&RUN[..], &["m.toml"]].concat()).code < 2, "{}", code.as_str());
    }
    bench.write("m.toml", [0xff_u8, 0xfe]);
    assert_eq!(codes(), [MemoryCode::Malformed.as_str()]);
}

/// A program is worked on, and its memory is not refused for that; what it has no more is said.
#[test]
fn what_a_memory_knows_and_the_program_has_not_is_warned_of() {
    let bench = Bench::new("memory_lacking");
    run(&bench);
    let with = [&RUN[..], &["m.toml", "--strategy", "fixed:2"]].concat();
    let ran = bench.run(&with);
    assert!(!ran.stderr.contains("warning: m.toml"), "{}", ran.stderr);
    let text = String::from_utf8(bench.read("m.toml")).expect("text");
    assert!(text.ends_with("[end]\n"), "{text}");
    for (from, to, words) in [
        ("error = \"peg_meets_rim\"", "error = \"spilt\"", "no error `spilt`"),
        ("at = \"main: ", "at = \"elsewhere: ", "no place `elsewhere: "),
    ] {
        let other = text.replace(from, to);
        assert_ne!(other, text);
        bench.write("m.toml", &other);
        let ran = bench.run(&with);
        assert!(ran.code < 2 && ran.stderr.contains("warning: m.toml"), "{}", ran.stderr);
        assert!(ran.stderr.contains(words), "{words}: {}", ran.stderr);
        let trials = ["trials", "reversal_policy.obv", "--runs", "3", "--strategy", "learned"];
        let ran = bench.ends(0, &[&trials[..], &["--memory", "m.toml"]].concat());
        assert!(ran.stderr.contains(words), "{words}: {}", ran.stderr);
        let kept = String::from_utf8(bench.read("m.toml")).expect("text");
        assert!(kept.contains(to), "what it knew is kept: {kept}");
    }
}
