//! The commands that people bring along from other debuggers, and lines that are none.

use crate::debug::piped_to;
use crate::support::{Bench, Ran};
use serde_json::{Value, json};
use std::io::Write;
use std::process::Stdio;

/// A call within a call, a loop, and a variable of each.
const PROGRAM: &str = "\
cell \"bench_cell.toml\"
var total = 0
sequence add(amount: int) {
  total += amount
  set 2 high
}
sequence thrice {
  var turn = 1
  while turn <= 3 {
    call add(turn)
    turn += 1
  }
  set 3 high
}
sequence main {
  call thrice
  set 1 high
}
";

pub(crate) fn bench(name: &str) -> Bench {
    let bench = Bench::new(&format!("debug_commands_{name}"));
    bench.write("p.obv", PROGRAM);
    bench
}

fn fed(bench: &Bench, arguments: &[&str], input: &[u8]) -> Ran {
    let mut command = bench.command(arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the binary runs");
    let mut stdin = child.stdin.take().expect("a pipe");
    let _ = stdin.write_all(input);
    drop(stdin);
    Ran::from(child.wait_with_output().expect("its end"))
}

/// The answers to commands, as many as there are of them.
pub(crate) fn answers(bench: &Bench, commands: &[&str]) -> Vec<Value> {
    let ran = piped_to(bench, &["debug", "p.obv", "--json"], commands);
    let answers: Vec<Value> =
        ran.json().into_iter().filter(|line| line["type"] == "answer").collect();
    assert_eq!(answers.len(), commands.len(), "{}\n{}", ran.stdout, ran.stderr);
    answers
}

/// Answers to commands that are all carried out.
pub(crate) fn done(bench: &Bench, commands: &[&str]) -> Vec<Value> {
    let answers = answers(bench, commands);
    for answer in &answers {
        assert_eq!(answer["done"], true, "{answer}");
    }
    answers
}

pub(crate) fn text(answer: &Value) -> String {
    let lines = answer["text"].as_array().expect("text");
    lines.iter().filter_map(Value::as_str).collect::<Vec<_>>().join("\n")
}

pub(crate) fn line(answer: &Value) -> &Value {
    &answer["position"]["line"]
}

#[test]
fn a_bad_line_is_not_done_and_the_next_one_is() {
    let bench = bench("bad_lines");
    let long = [b"print ".to_vec(), vec![b'1'; 1_000_000], b"\n".to_vec()].concat();
    let input = [b"step\n\xff\xfe\n".to_vec(), long, b"print total\n".to_vec()].concat();
    bench.write("p.commands", &input);
    let by_file = bench.run(&["debug", "p.obv", "--json", "--commands", "p.commands"]);
    for (ran, from) in [
        (fed(&bench, &["debug", "p.obv", "--json"], &input), "standard input"),
        (by_file, "p.commands"),
    ] {
        assert_eq!(ran.code, 1, "{}\n{}", ran.stdout, ran.stderr);
        let lines = ran.json();
        let answers: Vec<&Value> = lines.iter().filter(|line| line["type"] == "answer").collect();
        assert_eq!(answers.len(), 4, "{}", ran.stdout);
        let why = |at: usize| answers[at]["why"].as_str().unwrap_or_default();
        assert_eq!(why(1), format!("line 2 of {from} is no text: its bytes are not UTF-8"));
        assert!(why(2).starts_with(&format!("line 3 of {from} is longer than")), "{}", why(2));
        assert_eq!(answers[3]["value"], 0);
        assert_eq!(
            (&ran.summary()["carried_out"], &ran.summary()["failed"]),
            (&json!(2), &json!(2))
        );
    }
    let ran = fed(&bench, &["debug", "p.obv"], &input);
    assert_eq!(ran.code, 1);
    assert!(ran.stdout.contains("not done: line 2 of standard input is no text"), "{}", ran.stdout);
    assert!(ran.stdout.ends_with("total = 0\n"), "{}", ran.stdout);
}

#[test]
fn calls_are_looked_at_until_the_run_moves() {
    let bench = bench("frames");
    let all = done(
        &bench,
        &[
            "b 4",
            "c",
            "up",
            "print turn",
            "info locals",
            "info frame",
            "down",
            "print amount",
            "frame 2",
            "list",
            "frame 1",
            "watch turn > 1",
            "step",
            "info frame",
            "frames",
            "f 1",
            "c",
        ],
    );
    assert_eq!(text(&all[2]).lines().next(), Some("#1 thrice at p.obv:10"));
    assert_eq!(all[2]["frame"]["number"], 1);
    assert_eq!((&all[3]["value"], &all[4]["values"]["turn"]), (&json!(1), &json!(1)));
    assert!(text(&all[5]).contains("called from #2 main at p.obv:16"), "{}", text(&all[5]));
    assert_eq!((&all[6]["frame"]["number"], &all[7]["value"]), (&json!(0), &json!(1)));
    assert!(text(&all[9]).contains(">  16 "), "{}", text(&all[9]));
    // The run has moved: the innermost call is looked at again.
    assert_eq!(all[13]["frame"]["function"], "add");
    assert_eq!(all[14]["frames"].as_array().map(Vec::len), Some(4));
    assert_eq!(all[15]["frame"]["function"], "thrice");
    // The watch is of the call that was looked at.
    assert!(text(&all[16]).starts_with("watch 2: turn > 1 was false and is true"), "{}", all[16]);
}

#[test]
fn names_of_another_call_are_refused_and_the_ends_of_the_calls_are_said() {
    let bench = bench("frame_ends");
    let all = answers(&bench, &["b 4", "c", "p turn", "down", "up 99", "up", "frame 9", "up x"]);
    let why = |at: usize| all[at]["why"].as_str().unwrap_or_default();
    assert!(why(2).contains("nothing is called `turn` here"), "{}", why(2));
    assert_eq!((why(3), why(5)), ("this is the innermost call", "this is the outermost call"));
    assert_eq!(why(6), "`9` is no call: they are numbered from 0 to 3");
    assert_eq!(why(7), "`x` is no count of calls");
}

#[test]
fn breakpoints_are_switched_conditioned_and_cleared() {
    let bench = bench("breakpoints");
    let all = done(
        &bench,
        &[
            "b 4",
            "condition 1 amount == 2",
            "c",
            "p amount",
            "info breakpoints",
            "condition 1",
            "disable 1",
            "info breakpoints",
            "c",
        ],
    );
    assert_eq!((&all[2]["halt"], &all[3]["value"]), (&json!("breakpoint"), &json!(2)));
    assert_eq!(all[4]["breakpoints"][0]["condition"], "amount == 2");
    assert_eq!(text(&all[5]), "breakpoint 1 stops always");
    assert_eq!(
        (&all[7]["breakpoints"][0]["enabled"], &all[8]["halt"]),
        (&json!(false), &json!("finished"))
    );
    assert!(text(&all[7]).contains("disabled"), "{}", text(&all[7]));
    let all = done(
        &bench,
        &["b 4", "b 5", "b add", "b 13", "dis 1 2", "enable", "c", "clear 4", "c", "clear", "c"],
    );
    assert_eq!((line(&all[6]), line(&all[8])), (&json!(4), &json!(5)));
    assert_eq!(all[7]["breakpoints"], json!([1, 3]));
    assert_eq!((&all[9]["breakpoints"], line(&all[10])), (&json!([2]), &json!(13)));
    let all = answers(
        &bench,
        &[
            "enable",
            "b 4",
            "enable 1 9",
            "condition",
            "condition 9 true",
            "condition 1 total",
            "condition 1 amount >",
            "clear 13",
            "disable x",
            "info nothing",
        ],
    );
    for (at, answer) in all.iter().enumerate().filter(|(at, _)| *at != 1) {
        assert_eq!(answer["done"], false, "{at}: {answer}");
    }
    assert_eq!(all[7]["why"], "there is no breakpoint at p.obv:13");
}

#[test]
fn a_run_goes_on_to_places_that_are_named_once() {
    let bench = bench("until");
    let all = done(
        &bench,
        &[
            "start",
            "advance thrice",
            "until 12",
            "until",
            "p turn",
            "info breakpoints",
            "b 17",
            "until",
        ],
    );
    assert_eq!(all[..3].iter().map(line).collect::<Vec<_>>(), [&json!(16), &json!(8), &json!(12)]);
    // Behind the last line of a loop, the loop is over.
    assert_eq!((line(&all[3]), &all[4]["value"]), (&json!(13), &json!(4)));
    assert_eq!((&all[5]["breakpoints"], &all[6]["breakpoint"]), (&json!([]), &json!(1)));
    // A call that is over ends it, as a breakpoint does.
    let all = done(&bench, &["b 10", "c", "b 5", "until 17", "until 17", "delete all", "until 17"]);
    assert_eq!((&all[3]["halt"], line(&all[3])), (&json!("breakpoint"), &json!(5)));
    assert_eq!((&all[6]["halt"], line(&all[6])), (&json!("done"), &json!(17)));
    let all = done(&bench, &["advance 13", "goto start", "advance add", "run"][..3]);
    assert_eq!((&all[2]["position"]["mode"], line(&all[2])), (&json!("rewound"), &json!(4)));
}

#[test]
fn a_run_is_begun_once() {
    let bench = bench("run");
    let all =
        answers(&bench, &["run", "run", "start", "goto start", "r", "what-if", "start", "leave"]);
    assert_eq!(all[0]["halt"], "finished");
    for at in [1, 2, 4] {
        let why = all[at]["why"].as_str().unwrap_or_default();
        assert!(why.starts_with("there is one run") && why.contains("`goto start`"), "{why}");
    }
    assert_eq!((&all[6]["done"], line(&all[6])), (&json!(true), &json!(16)));
}

#[test]
fn what_is_displayed_is_told_wherever_a_command_leads() {
    let bench = bench("display");
    let all = done(
        &bench,
        &[
            "display total",
            "b 4",
            "c",
            "display amount",
            "c",
            "goto start",
            "info display",
            "undisplay 1",
            "display",
            "undisplay",
            "goto end",
            "display",
        ],
    );
    assert_eq!(text(&all[0]), "1: total = 0");
    assert!(text(&all[2]).ends_with("1: total = 0"), "{}", text(&all[2]));
    assert_eq!(all[4]["display"][0]["value"], 1);
    assert!(text(&all[4]).ends_with("1: total = 1\n2: amount = 2"), "{}", text(&all[4]));
    // What belongs to a call that is not under way is not shown.
    assert_eq!(all[5]["display"].as_array().map(Vec::len), Some(1));
    assert_eq!(all[6]["displays"].as_array().map(Vec::len), Some(2));
    assert_eq!(all[8]["display"], json!([]));
    assert_eq!(all[10]["display"], Value::Null);
    let all = answers(&bench, &["display nonsense", "undisplay 7"]);
    assert!(all.iter().all(|answer| answer["done"] == false));
}

#[test]
fn lists_and_instructions_are_those_asked_for() {
    let bench = bench("list");
    let numbers = |answer: &Value| -> Vec<usize> {
        let text = text(answer);
        let number = |line: &str| line[1..5].trim().parse().expect("a number");
        text.lines().map(number).collect()
    };
    let all = done(
        &bench,
        &[
            "list 1,5",
            "list",
            "list -",
            "list 3,3",
            "list thrice",
            "list ,2",
            "list p.obv:17,",
            "x/5i",
            "x/2i thrice",
            "x/3 13",
        ],
    );
    assert_eq!(numbers(&all[0]), (1..=5).collect::<Vec<_>>());
    assert_eq!(numbers(&all[1]), (6..=16).collect::<Vec<_>>());
    assert_eq!(numbers(&all[2]), (1..=5).collect::<Vec<_>>());
    assert_eq!(numbers(&all[3]), [3]);
    assert!(numbers(&all[4]).contains(&8), "{}", text(&all[4]));
    assert_eq!((numbers(&all[5]), numbers(&all[6])), (vec![1, 2], vec![17, 18]));
    assert_eq!((numbers(&all[7]), numbers(&all[8]).len()), (vec![1, 2, 3, 4, 5], 2));
    assert!(numbers(&all[8])[0] < numbers(&all[9])[0]);
    let all = answers(
        &bench,
        &[
            "list 5,1",
            "list 99",
            "list 1",
            "list -",
            "list x:1",
            "list 0",
            "x/0i",
            "x/zi",
            "x nothing",
        ],
    );
    for (at, answer) in all.iter().enumerate().filter(|(at, _)| *at != 2) {
        assert_eq!(answer["done"], false, "{at}: {answer}");
    }
}

#[test]
fn short_names_are_those_that_people_know_and_help_knows_all() {
    let bench = bench("names");
    let short = ["s", "n", "si", "ni", "u", "f", "i locals", "bt", "en", "dis", "x", "l"];
    let all = done(&bench, &[&["b 17"], &short[..]].concat());
    assert!(all.len() == short.len() + 1);
    let all = answers(&bench, &["un", "fr", "disa", "cond"]);
    assert_eq!(all[0]["why"], "`un` may be `until` or `undo` or `undisplay`");
    assert_eq!((&all[1]["done"], &all[2]["done"]), (&json!(true), &json!(false)));
    let commands = [
        "until",
        "advance",
        "start",
        "run",
        "condition",
        "enable",
        "disable",
        "clear",
        "display",
        "undisplay",
        "frame",
        "up",
        "down",
        "frames",
        "x",
    ];
    let asked: Vec<String> = commands.iter().map(|name| format!("help {name}")).collect();
    done(&bench, &asked.iter().map(String::as_str).collect::<Vec<_>>());
    let help = text(&done(&bench, &["help"])[0]);
    for name in commands.iter().filter(|name| !["frames", "x"].contains(name)) {
        assert!(help.contains(name), "{name}: {help}");
    }
}

#[test]
fn the_prompt_says_what_is_tried_and_bookmarks_go_with_it() {
    let bench = bench("prompt");
    let commands = [
        "c",
        "bookmark over",
        "goto start",
        "step",
        "bookmark begun",
        "what-if",
        "c",
        "bookmark tried",
        "goto tried",
        "goto over",
        "goto start",
        "what-if",
        "bookmark within",
        "goto start",
        "leave",
        "bookmark",
        "leave",
        "bookmark",
        "goto over",
    ];
    let ran = piped_to(&bench, &["debug", "p.obv"], &commands);
    let prompts: Vec<&str> = ran
        .stdout
        .lines()
        .filter_map(|line| line.strip_prefix('(')?.split_once(") "))
        .map(|(prompt, _)| prompt.split_once(' ').expect("a moment and a mode").1)
        .collect();
    let expected = [
        "live",
        "live",
        "live",
        "rewound",
        "rewound",
        "rewound",
        "what-if",
        "what-if",
        "what-if",
        "what-if rewound",
        "what-if rewound",
        "what-if rewound",
        "what-if 2",
        "what-if 2",
        "what-if 2 rewound",
        "what-if rewound",
        "what-if rewound",
        "rewound",
        "rewound",
    ];
    assert_eq!(prompts, expected, "{}", ran.stdout);
    let all = answers(&bench, &commands);
    let tries: Vec<u64> =
        all.iter().filter_map(|answer| answer["position"]["tries"].as_u64()).collect();
    assert_eq!(tries, [0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 2, 1, 1, 0, 0, 0]);
    let names = |at: usize| -> Vec<&str> {
        let all = all[at]["bookmarks"].as_array().expect("bookmarks");
        all.iter().filter_map(|mark| mark["name"].as_str()).collect()
    };
    // What lies behind the moment that was left comes no more in what is tried.
    assert_eq!(all[9]["done"], false);
    assert_eq!((names(15), names(17)), (vec!["begun", "tried"], vec!["begun", "over"]));
    assert_eq!(all[18]["done"], true);
}

#[test]
fn values_have_units_and_lines_that_are_not_there_are_refused() {
    let bench = bench("units");
    let all = done(
        &bench,
        &["p joint 1 - joint 1", "p 2 * 3 N", "p 3 mm + 2 cm", "p force > 1000", "display time"],
    );
    assert_eq!(text(&all[0]), "joint 1 - joint 1 = 0 deg");
    assert_eq!((&all[0]["value"], &all[0]["unit"]), (&json!(0.0), &json!("rad")));
    assert_eq!(
        (text(&all[1]), text(&all[2])),
        ("2 * 3 N = 6 N".into(), "3 mm + 2 cm = 23 mm".into())
    );
    assert_eq!((&all[3]["unit"], &all[4]["unit"]), (&Value::Null, &json!("s")));
    for (command, why) in [
        ("p 3 mm + 2", "a length and a number without a unit cannot be added"),
        ("p 9223372036854775807 + total + 1", "an overflow"),
        ("p total / 0", "a division by zero"),
        ("watch output 99", "there is no output 99: they are numbered from 0 to 7, at column 8"),
        ("p input 99", "there is no input 99"),
        ("b 4 if output 99", "there is no output 99"),
        ("p joint 9", "the joints are numbered from 1 to 6"),
    ] {
        let answer = answers(&bench, &[command]).remove(0);
        assert!(answer["why"].as_str().is_some_and(|it| it.contains(why)), "{command}: {answer}");
    }
}
