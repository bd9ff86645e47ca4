//! What the debugger is asked by name, and what its answers hold for machines.

use crate::debug::piped_to;
use crate::debug_commands::{answers, bench, done, line, text};
use crate::support::Bench;
use serde_json::{Value, json};

/// What goes back with care, and a move.
const CAREFUL: &str = "\
cell \"bench_cell.toml\"
var total = 3
sequence main {
  set 1 high
  with speed slow, force limit 20 N, straight moves in reverse {
    total += 1
  }
  set 2 high
}
";

fn careful(name: &str) -> Bench {
    let bench = bench(name);
    bench.write("p.obv", CAREFUL);
    bench
}

/// Why each of some commands is not done.
fn reasons(bench: &Bench, commands: &[&str]) -> Vec<String> {
    let why = |answer: Value| {
        assert_eq!(answer["done"], false, "{answer}");
        answer["why"].as_str().unwrap_or_default().to_owned()
    };
    answers(bench, commands).into_iter().map(why).collect()
}

#[test]
fn settings_are_asked_for_by_the_names_that_state_shows() {
    let bench = careful("settings");
    let all = done(
        &bench,
        &[
            "p reverse.speed",
            "p reverse.force_limit",
            "p reverse.straight",
            "p tool",
            "p reverse.force_limit > 5 N and tool == none",
            "state",
            "watch reverse.straight",
            "c",
            "p reverse.speed == slow and reverse.force_limit == 20 N",
            "last reverse.force_limit",
        ],
    );
    let said: Vec<String> = all[..5].iter().map(text).collect();
    let expected = [
        "reverse.speed = unnamed",
        "reverse.force_limit = none",
        "reverse.straight = false",
        "tool = none",
        "reverse.force_limit > 5 N and tool == none = true",
    ];
    assert_eq!(said, expected);
    assert_eq!((&all[1]["value"], &all[4]["value"]), (&Value::Null, &json!(true)));
    assert!(text(&all[5]).contains("tool     none\n"), "{}", text(&all[5]));
    assert!(text(&all[5]).contains("reverse.force_limit none\n"), "{}", text(&all[5]));
    assert_eq!((&all[7]["halt"], &all[8]["value"]), (&json!("breakpoint"), &json!(true)));
    let change = &all[9]["change"];
    assert_eq!((&change["before"], &change["after"]), (&Value::Null, &json!(20.0)));
    assert_eq!(change["unit"], "N");
    // In a frame that keeps what the settings were, under names of the compiler's own.
    let why = answers(&bench, &["b 6", "c", "p reverse.sped", "p reverse_speed", "p reverse_st"]);
    for answer in &why[2..] {
        assert_eq!(answer["done"], false);
        assert!(!answer["why"].as_str().unwrap_or("$").contains('$'), "{answer}");
    }
    let help = text(&done(&bench, &["help print"])[0]);
    assert!(help.contains("reverse.speed"), "{help}");
}

#[test]
fn values_are_numbers_with_their_unit_in_every_answer() {
    let bench = bench("data");
    let moves = "cell \"bench_cell.toml\"\nvar n = 0\nsequence main {\n  n += 1\n  \
                 move 50 mm up in base\n  set 1 high\n}\n";
    bench.write("p.obv", moves);
    let all = done(
        &bench,
        &[
            "watch n",
            "watch joint 2",
            "b 6",
            "c",
            "c",
            "p joint 2",
            "display joint 2",
            "state",
            "last joint 2",
        ],
    );
    let variable = json!([{ "number": 1, "what": "n", "before": 0, "after": 1, "unit": null }]);
    assert_eq!(all[3]["hits"], variable);
    assert!(all[1]["value"].is_number() && all[1]["unit"] == "rad", "{}", all[1]);
    let now = &all[5]["value"];
    assert!(now.is_number() && all[5]["unit"] == "rad", "{}", all[5]);
    let hits = all[4]["hits"].as_array().expect("hits");
    assert_eq!(hits.len(), 2, "{}", all[4]);
    let (watch, place) = (&hits[0], &hits[1]);
    assert_eq!((&watch["number"], &watch["what"]), (&json!(2), &json!("joint 2")));
    assert_eq!((&watch["after"], &watch["unit"]), (now, &json!("rad")));
    assert_eq!(place, &json!({ "number": 3, "what": "p.obv:6", "unit": null }));
    assert_eq!((&all[6]["value"], &all[6]["unit"]), (now, &json!("rad")));
    let values = &all[7];
    assert_eq!((&values["units"]["force"], &values["units"]["time"]), (&json!("N"), &json!("s")));
    let change = &all[8]["change"];
    assert_eq!((&change["before"], &change["after"]), (&watch["before"], now));
    assert_eq!(change["unit"], "rad");
}

#[test]
fn a_tape_shows_where_the_tool_is_as_a_live_run_does() {
    let bench = Bench::new("debug_data_tcp");
    let run = ["run", "bad_pin.obv", "--seed", "1", "--tape", "t.tape"];
    let _ = bench.run(&run);
    let pose = |arguments: &[&str], commands: &[&str]| {
        let ran = piped_to(&bench, &[&["debug", "--json"], arguments].concat(), commands);
        let states = ran.json().into_iter().filter(|line| line["command"] == "state");
        states.map(|state| state["pose"].clone()).collect::<Vec<Value>>()
    };
    let tape = ["--tape", "t.tape"];
    let shown = pose(&tape, &["goto 20", "state", "what-if", "state"]);
    let live = pose(&["bad_pin.obv", "--seed", "1"], &["stepi 30", "goto 20", "state"]);
    assert_eq!(live[0]["of"], "tcp");
    assert_eq!(shown, [live[0].clone(), live[0].clone()]);
    // A workcell that is named to try in has no say in what was.
    let cell = String::from_utf8(bench.read("pin_cell.toml")).expect("text");
    bench.write(
        "other.toml",
        cell.replacen("tcp = { xyz_mm = [0, 0,", "tcp = { xyz_mm = [1, 0,", 1),
    );
    let other = [&tape[..], &["--cell", "other.toml"]].concat();
    assert_eq!(pose(&other, &["goto 20", "state"]), live);
}

#[test]
fn what_info_knows_of_may_be_shortened() {
    let bench = bench("info");
    let asked = ["b 4", "info bre", "info br", "info breakpoint", "info b", "info g", "info loc"];
    let all = done(&bench, &asked);
    for answer in &all[1..5] {
        assert_eq!(answer["breakpoints"].as_array().map(Vec::len), Some(1), "{answer}");
    }
    assert_eq!(all[5]["values"], json!({ "total": 0 }));
    let why = reasons(&bench, &["info st", "info", "info nothing"]);
    assert_eq!(why[0], "`st` may be stack or state");
    assert!(why[1..].iter().all(|why| why.starts_with("say of what: ")), "{why:?}");
}

#[test]
fn until_goes_into_the_first_sequence() {
    let bench = bench("until_start");
    let all = done(&bench, &["until", "goto start", "what-if", "until"]);
    assert_eq!((line(&all[0]), &all[0]["halt"]), (&json!(16), &json!("done")));
    assert_eq!(line(&all[3]), &json!(16));
}

#[test]
fn nothing_is_come_to_at_the_end_of_what_is_shown() {
    let bench = bench("end");
    let commands = ["b 17", "c", "goto start", "c", "c", "c", "info breakpoints"];
    let all = done(&bench, &commands);
    assert_eq!(all[3]["halt"], "breakpoint");
    assert_eq!((&all[4]["halt"], &all[5]["halt"]), (&"end_of_recording".into(), &all[4]["halt"]));
    assert_eq!(all[6]["breakpoints"][0]["hits"], 2);
}

#[test]
fn what_cannot_be_meant_is_refused_in_its_own_words() {
    let bench = bench("meant");
    let why = reasons(
        &bench,
        &[
            "list 500",
            "list ,500",
            "list 500,",
            "b 4 if",
            "b if",
            "watch 3",
            "watch true if output 1",
        ],
    );
    for why in &why[..3] {
        assert_eq!(why, "there is no line 500: the last is 18");
    }
    for why in &why[3..5] {
        assert_eq!(why, "a condition is missing behind `if`");
    }
    assert_eq!(why[5], "`3` never changes: watch what may");
    assert_eq!(why[6], "`true` never changes: watch what may");
    let all = done(&bench, &["b 4", "c", "b if amount == 2", "delete 1", "c", "p amount"]);
    assert_eq!(all[5]["value"], 2);
}

#[test]
fn a_byte_order_mark_is_no_part_of_a_command() {
    let bench = bench("mark");
    bench.write("p.commands", "\u{feff}step\nprint total\n");
    for ran in [
        bench.run(&["debug", "p.obv", "--json", "--commands", "p.commands"]),
        piped_to(&bench, &["debug", "p.obv", "--json"], &["\u{feff}step", "print total"]),
    ] {
        assert_eq!(ran.code, 0, "{}\n{}", ran.stdout, ran.stderr);
        assert_eq!(ran.summary()["carried_out"], 2);
    }
}

#[test]
fn what_the_program_is_yet_to_begin_with_is_said_where_it_is_set() {
    let bench = careful("begin");
    let commands = [
        "goto start",
        "what-if",
        "set total = 7",
        "step",
        "p total",
        "set total = 8",
        "c",
        "p total",
    ];
    let all = done(&bench, &[&["step"], &commands[..]].concat());
    assert!(text(&all[3]).contains("has yet to give `total` its first value"), "{}", text(&all[3]));
    assert_eq!((&all[5]["value"], text(&all[6])), (&json!(3), "total is 8".to_owned()));
    assert_eq!(all[6]["value"], 8);
    assert_eq!(all[8]["value"], 9);
}
