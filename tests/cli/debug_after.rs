//! The debugger on runs that begin where another program has ended.

use crate::support::{Bench, Ran};
use serde_json::{Value, json};

/// A folder with `sheets.obv`, which builds a stack, and `apart.obv`, which takes it apart again.
fn bench(name: &str) -> Bench {
    let bench = Bench::new(&format!("debug_after_{name}"));
    let inverse = bench.ends(0, &["invert", "sheets.obv", "main"]).stdout;
    bench.write("apart.obv", inverse);
    bench.write("commands", "goto start\nwhat-if\ncontinue\n");
    bench
}

/// The same with a tape of the run that takes it apart.
fn taped(name: &str) -> (Bench, Value) {
    let bench = bench(name);
    let run = ["run", "--json", "apart.obv", "--after", "sheets.obv", "--tape", "t.tape"];
    let ran = bench.ends(0, &run).summary();
    (bench, ran)
}

fn debug(bench: &Bench, code: i32, more: &[&str]) -> Ran {
    bench.ends(code, &[&["debug", "--json", "--commands", "commands"], more].concat())
}

fn last_answer(ran: &Ran) -> Value {
    let mut lines = ran.json().into_iter();
    lines.rfind(|line| line["type"] == "answer").expect("an answer")
}

#[test]
fn a_live_session_begins_where_another_program_has_ended() {
    let bench = bench("live");
    let ran = debug(&bench, 0, &["apart.obv", "--after", "sheets.obv"]);
    assert_eq!(last_answer(&ran)["halt"], "finished");
    let text = bench.ends(0, &["debug", "apart.obv", "--after", "sheets.obv"]).stdout;
    assert!(
        text.starts_with("apart.obv in vacuum_cell.toml, seed 0, after sheets.obv\n"),
        "{text}"
    );
    // Where nothing has been built, there is nothing to take apart.
    let bare = last_answer(&debug(&bench, 0, &["apart.obv"]));
    assert_ne!(bare["halt"], "finished");
}

#[test]
fn a_tape_knows_what_its_run_began_after() {
    let (bench, ran) = taped("tape");
    let told = debug(&bench, 0, &["--tape", "t.tape"]);
    let tape = &told.json()[0];
    assert_eq!((&tape["after"], &tape["can_try"]), (&json!("sheets.obv"), &json!(true)));
    let answer = last_answer(&told);
    let position = &answer["position"];
    assert_eq!((&answer["halt"], &position["mode"]), (&json!("finished"), &json!("what-if")));
    assert_eq!(position["moment"], ran["instructions"], "the same again");
    let title = bench.ends(0, &["debug", "--tape", "t.tape"]).stdout;
    assert!(title.contains("seed 0, after sheets.obv\n"), "{title}");
}

#[test]
fn a_tape_has_all_that_its_run_began_in() {
    let (bench, ran) = taped("whole");
    for file in ["sheets.obv", "apart.obv", "vacuum_cell.toml"] {
        bench.write(file, "nothing of the kind\n");
    }
    let told = debug(&bench, 0, &["--tape", "t.tape"]);
    let answer = last_answer(&told);
    assert_eq!((&answer["halt"], &told.json()[0]["can_try"]), (&json!("finished"), &json!(true)));
    assert_eq!(answer["position"]["moment"], ran["instructions"], "the same again");
    let named = ["debug", "--tape", "t.tape", "--after", "sheets.obv"];
    bench.refuses(&named, &["a tape has what its run began after: no `--after`"]);
}

#[test]
fn another_workcell_is_tried_in_only_as_far_as_the_run_was_the_same_in_it() {
    let bench = bench("other");
    bench.ends(0, &["run", "sheets.obv", "--tape", "s.tape"]);
    let cell = String::from_utf8(bench.read("vacuum_cell.toml")).expect("text");
    let (home, speed) = ("home_rad = [3.1416,", "normal = { tool_mm_per_s = 100,");
    let with = |old: &str, new: &str| {
        assert!(cell.contains(old), "{old} is there");
        cell.replace(old, new)
    };
    bench.write("elsewhere.toml", with(home, "home_rad = [3.1,"));
    bench.write("faster.toml", with(speed, "normal = { tool_mm_per_s = 110,"));
    let try_in = |cell: &str, commands: &str| {
        bench.write("commands", commands);
        let code = i32::from(!cell.starts_with("faster") || commands.starts_with("what-if"));
        let told = debug(&bench, code, &["--tape", "s.tape", "--cell", cell]);
        let mut answers = told.json().into_iter().filter(|line| line["command"] == "what-if");
        answers.next().expect("an answer")
    };
    let at_start = "goto start\nwhat-if\n";
    let refused = try_in("elsewhere.toml", at_start);
    assert!(refused["why"].to_string().contains("does not begin as it did"), "{refused}");
    let refused = try_in("faster.toml", "what-if\n");
    assert!(refused["why"].to_string().contains("does not do again what it did"), "{refused}");
    assert_eq!(try_in("faster.toml", at_start)["done"], true);
}

#[test]
fn a_copy_of_the_program_is_the_program_of_the_tape() {
    let bench = bench("copy");
    bench.ends(0, &["run", "sheets.obv", "--tape", "s.tape"]);
    let source = String::from_utf8(bench.read("sheets.obv")).expect("text");
    bench.write("copy.obv", &source);
    bench.write("other.obv", source.replace("sequence main {", "sequence main {\n  wait 1 s"));
    debug(&bench, 0, &["copy.obv", "--tape", "s.tape"]);
    let other = ["debug", "other.obv", "--tape", "s.tape"];
    bench.refuses(&other, &["s.tape: this is a run of sheets.obv", "not of other.obv"]);
}

#[test]
fn a_run_that_began_after_nothing_says_so() {
    let bench = bench("nothing");
    bench.ends(0, &["run", "sheets.obv", "--tape", "s.tape"]);
    let tape = &bench.ends(0, &["debug", "--json", "--tape", "s.tape"]).json()[0];
    assert_eq!((&tape["after"], &tape["can_try"]), (&json!(null), &json!(true)));
}
