//! Errors and faults in a session of the debugger: it is told and done as in `run`.

use crate::debug::piped_to;
use crate::support::{Bench, Ran};
use serde_json::{Value, json};
use std::path::Path;

const PROGRAM: &str = "reversal_policy.obv";

/// It drives into the tray, as often as it may.
const BUMPS: &str = "\
cell \"bench_cell.toml\"
error bumped {
  on collision
  recover by reversing 1 action
  give up after 2 times
  otherwise operator
}
cleanup { set 3 high }
sequence main {
  set 2 high
  move 600 mm down in base
  set 2 low
}
";

fn session(bench: &Bench, arguments: &[&str], commands: &[&str]) -> Ran {
    piped_to(bench, &[&["debug", "--json"], arguments].concat(), commands)
}

fn answers(ran: &Ran) -> Vec<Value> {
    ran.json().into_iter().filter(|line| line["type"] == "answer").collect()
}

fn halts(ran: &Ran) -> Vec<Value> {
    answers(ran).into_iter().map(|answer| answer["halt"].clone()).collect()
}

/// What happened, told to machines.
fn story(ran: &Ran) -> Vec<Value> {
    let is_told = |line: &Value| line["type"] == "event" || line["type"] == "recovery";
    ran.json().into_iter().filter(is_told).collect()
}

#[test]
fn continue_tells_the_story_of_the_run_and_learns_what_it_learns() {
    let bench = Bench::new("debug_story");
    for (name, seed) in [(PROGRAM, "0"), ("cases/plug/plug.obv", "2")] {
        let (one, other) = (format!("{seed}_run.toml"), format!("{seed}_debug.toml"));
        let ran = bench.run(&["run", name, "--seed", seed, "--json", "--memory", &one]);
        let arguments = [name, "--seed", seed, "--memory", &other];
        let walked = session(&bench, &arguments, &["continue 1000", "continue"]);
        assert_eq!(walked.code, 0, "{}\n{}", walked.stdout, walked.stderr);
        assert_eq!(story(&walked), story(&ran), "{name}");
        assert!(story(&ran).iter().any(|line| line["step"] == "back"), "{name} recovers");
        assert_eq!(walked.summary()["incidents"], ran.summary()["incidents"], "{name}");
        assert_eq!(bench.read(&one), bench.read(&other), "{name}");
    }
}

#[test]
fn a_stop_at_an_error_says_what_comes_next_and_recover_does_it_to_the_end() {
    let bench = Bench::new("debug_recover");
    let commands = ["recover", "c", "break 44", "recover", "reverse-stepi", "c", "recover"];
    let ran = session(&bench, &[PROGRAM], &commands);
    let all = answers(&ran);
    assert_eq!((ran.code, &all[0]["why"]), (1, &json!("no error is due in the run")));
    let next = &all[1]["next"];
    assert_eq!((&all[1]["halt"], &all[1]["recovering"]), (&json!("error"), &json!(true)));
    assert_eq!(
        (&next["does"], &next["actions"], &next["attempts"]),
        (&json!("back"), &json!(1), &json!(0))
    );
    assert_eq!(
        (&next["to"]["line"], &next["change"]),
        (&json!(45), &json!("0.18 mm aside, slower"))
    );
    // On its way back by two actions it stops where it was told to.
    assert_eq!((&all[3]["halt"], &all[3]["position"]["line"]), (&json!("breakpoint"), &json!(44)));
    assert_eq!((&all[3]["recovering"], &all[3]["next"]), (&json!(true), &Value::Null));
    // Gone back by hand, it begins anew.
    assert_eq!(all[4]["recovering"], false);
    assert_eq!((&all[5]["halt"], &all[6]["halt"]), (&json!("breakpoint"), &Value::Null));
    let incidents = &ran.summary()["incidents"];
    assert_eq!(
        (&incidents[0]["outcome"], &incidents[0]["depths"]),
        (&json!("lost"), &json!([1, 2]))
    );
}

#[test]
fn nothing_moves_after_a_stop_before_a_release() {
    let bench = Bench::new("debug_held");
    bench.write("h.obv", BUMPS);
    let commands = ["release", "c", "c", "step", "recover", "release", "recover", "release", "c"];
    let ran = session(&bench, &["h.obv"], &commands);
    let all = answers(&ran);
    assert_eq!((&all[0]["done"], &all[0]["why"]), (&json!(false), &json!("no stop holds the arm")));
    let moment = |at: usize| all[at]["position"]["moment"].as_u64();
    assert_eq!(halts(&ran)[1..5], ["fault", "held", "held", "held"].map(|halt| json!(halt)));
    assert!((2..=5).all(|at| moment(at) == moment(1)), "{}", ran.stdout);
    // It goes back and comes again, and the tray is still there.
    assert_eq!(halts(&ran)[6], "fault");
    assert_eq!(halts(&ran)[8], "error");
    let steps: Vec<Value> = story(&ran).into_iter().map(|line| line["step"].clone()).collect();
    let steps: Vec<&Value> = steps.iter().filter(|step| !step.is_null()).collect();
    assert_eq!(steps, ["fault", "released", "back", "again", "fault", "released"]);
    assert_eq!(ran.summary()["held"], false);
    let told = piped_to(&bench, &["debug", "h.obv"], &["c", "c"]);
    assert!(told.stdout.contains("the arm is held: nothing moves before a `release`"));
}

#[test]
fn strategies_and_memories_are_those_of_run() {
    let bench = Bench::new("debug_strategy");
    let ran = session(&bench, &[PROGRAM, "--strategy", "stop"], &["c", "c", "c"]);
    assert_eq!(answers(&ran)[0]["next"]["does"], "given_up");
    assert_eq!(halts(&ran)[1], "given_up");
    let run = bench.run(&["run", PROGRAM, "--strategy", "stop", "--json"]);
    assert_eq!(ran.summary()["incidents"], run.summary()["incidents"]);
    bench.write("torn.toml", "version = 2\nprogram = ");
    bench.refuses(&["debug", PROGRAM, "--memory", "torn.toml"], &["torn.toml", "M0101"]);
    bench.refuses(&["debug", PROGRAM, "--strategy", "hope"], &["say declared"]);
    bench.refuses(&["debug", PROGRAM, "--memory", PROGRAM], &["reversal_policy.obv"]);
}

/// A run that a person was called to is recorded; what going back would have made of it is tried
/// from its tape.
#[test]
fn what_ended_a_run_is_recovered_from_in_a_what_if_from_its_tape() {
    let bench = Bench::new("debug_tape_try");
    bench.ends(1, &["run", PROGRAM, "--strategy", "stop", "--tape", "t.tape"]);
    let commands = ["recover", "what-if", "recover", "c", "leave"];
    let ran = session(&bench, &["--tape", "t.tape"], &commands);
    let all = answers(&ran);
    assert!(all[0]["why"].as_str().is_some_and(|why| why.contains("try what would have been")));
    assert_eq!(halts(&ran)[2..4], ["done", "finished"].map(|halt| json!(halt)));
    assert!(story(&ran).iter().any(|line| line["step"] == "recovered"), "{}", ran.stdout);
    assert_eq!(all[4]["position"], all[0]["position"], "the recording is as it was");
    bench.refuses(&["debug", "--tape", "t.tape", "--memory", "m.toml"], &["no `--memory`"]);
}

/// Where the strategy calls a person, a session ends where the run does, however one goes on.
#[test]
fn a_strategy_that_gives_up_ends_a_session_where_it_ends_the_run() {
    let bench = Bench::new("debug_given_up");
    let arguments = [PROGRAM, "--strategy", "stop"];
    let ran = bench.run(&[&["run", "--json"], &arguments[..]].concat());
    let commands = ["c", "c", "c", "step", "finish", "until", "c", "reverse-next"];
    let walked = session(&bench, &arguments, &commands);
    let all = answers(&walked);
    let told = story(&ran);
    assert_eq!(story(&walked)[..told.len()], told);
    let next = all[0]["next"]["text"].as_str().unwrap_or_default();
    assert!(next.ends_with("then an operator is called"), "{next}");
    for answer in &all[1..7] {
        assert_eq!(answer["halt"], "given_up", "{answer}");
        assert_eq!(answer["position"], all[1]["position"], "{answer}");
    }
    assert_eq!(all[7]["halt"], "done", "by hand it goes back");
}

/// `--release` gives as many releases beforehand as it does in `run`.
#[test]
fn releases_that_are_given_beforehand_are_those_of_run() {
    let bench = Bench::new("debug_release");
    bench.write("b.obv", BUMPS);
    for count in ["0", "1", "2", "9"] {
        let ran = bench.run(&["run", "b.obv", "--json", "--release", count]);
        let commands = ["c"; 12];
        let walked = session(&bench, &["b.obv", "--release", count], &commands);
        assert_eq!(story(&walked), story(&ran), "{count}\n{}", walked.stdout);
        assert_eq!(walked.summary()["held"], ran.summary()["held"], "{count}");
    }
}

/// What is tried recovers by itself, from the past too, and the run knows nothing of it.
/// A case of the programs in a bench.
fn case(name: &str) -> Bench {
    let bench = Bench::new(&format!("debug_case_{name}"));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("programs/cases").join(name);
    for kind in ["obv", "toml"] {
        let file = format!("{name}.{kind}");
        bench.write(&file, std::fs::read(folder.join(&file)).expect("the case"));
    }
    bench
}

#[test]
fn what_the_run_learned_later_is_not_known_to_a_what_if_from_before() {
    let bench = case("cover");
    let there = ["c"; 7];
    let commands = [&there[..], &["goto 1", "what-if"], &there[..]].concat();
    let all = answers(&session(&bench, &["cover.obv", "--seed", "2"], &commands));
    let end = |at: usize| (&all[at]["halt"], &all[at]["position"]["moment"]);
    assert_eq!(end(6).0, "finished", "{all:?}");
    assert_eq!(end(15), end(6), "nothing was changed");
}

#[test]
fn a_workcell_that_is_changed_by_hand_is_another_moment() {
    let bench = case("plug");
    let commands =
        ["step", "step", "what-if", "print force", "seed 5", "print force", "last force"];
    let told = ["print force", "goto end", "print force"];
    let commands = [&commands[..], &told].concat();
    let all = answers(&session(&bench, &["plug.obv", "--seed", "4"], &commands));
    let value = |at: usize| &all[at]["value"];
    assert_ne!(value(3), value(5), "another seed, another reading: {all:?}");
    assert_eq!(all[6]["done"], true, "the change is found: {all:?}");
    assert_eq!((value(7), value(9)), (value(3), value(5)), "before it, and behind it");
}

#[test]
fn a_what_if_recovers_and_teaches_nothing() {
    let bench = Bench::new("debug_try");
    let commands = ["c", "what-if", "seed 3", "recover", "leave", "goto 30", "what-if", "c", "c"];
    let ran = session(&bench, &[PROGRAM, "--memory", "m.toml"], &commands);
    assert_eq!(ran.code, 0, "{}\n{}", ran.stdout, ran.stderr);
    let all = answers(&ran);
    assert_eq!((&all[4]["position"], &all[3]["recovering"]), (&all[0]["position"], &json!(false)));
    assert_eq!((&all[7]["halt"], &all[7]["next"]["does"]), (&json!("error"), &json!("back")));
    assert!(!String::from_utf8_lossy(&bench.read("m.toml")).contains("times = "));
}
