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
fn what_a_run_began_after_is_found_elsewhere_if_it_is_named() {
    let (bench, _) = taped("moved");
    let sheets = bench.read("sheets.obv");
    bench.write("old/sheets.obv", &sheets);
    bench.write("old/vacuum_cell.toml", bench.read("vacuum_cell.toml"));
    bench.write("sheets.obv", "cell \"vacuum_cell.toml\"\nsequence main { wait 1 s }\n");
    // What cannot be tried is told, with the true reason; the rest of the session is as ever.
    let told = bench.ends(0, &["debug", "--tape", "t.tape"]).stdout;
    let lines = told.lines().collect::<Vec<_>>();
    assert!(lines[2].starts_with("nothing can be tried otherwise: sheets.obv: "), "{told}");
    assert!(lines[2].contains("the run began after sheets.obv as it was then"), "{told}");
    assert!(!lines[2].contains("vacuum_cell.toml"), "the workcell is as it was: {told}");
    let there = debug(&bench, 0, &["--tape", "t.tape", "--after", "old/sheets.obv"]);
    assert_eq!(last_answer(&there)["halt"], "finished");
    let wrong = ["debug", "--tape", "t.tape", "--after", "tower.obv"];
    bench.refuses(&wrong, &["tower.obv: the run began after sheets.obv", "`--after PROGRAM`"]);
    let none = ["debug", "--tape", "t.tape", "--after", "none.obv"];
    bench.refuses(&none, &["none.obv: cannot be read", "the run began after it"]);
}

#[test]
fn a_run_that_began_after_nothing_is_not_begun_after_something() {
    let bench = bench("nothing");
    bench.ends(0, &["run", "sheets.obv", "--tape", "s.tape"]);
    let tape = &bench.ends(0, &["debug", "--json", "--tape", "s.tape"]).json()[0];
    assert_eq!((&tape["after"], &tape["can_try"]), (&json!(null), &json!(true)));
    let named = ["debug", "--tape", "s.tape", "--after", "sheets.obv"];
    bench.refuses(&named, &["s.tape: its run began after nothing else"]);
}
