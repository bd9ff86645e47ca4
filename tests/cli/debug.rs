//! The debugger through the binary, with commands from a file or a pipe.

use crate::support::{Bench, Ran};
use serde_json::{Value, json};
use std::io::Write;
use std::process::Stdio;

/// What cannot be taken back, a variable, an input, a checkpoint, an error and a branch.
const PROGRAM: &str = "\
cell \"bench_cell.toml\"
error odd { severity warning }
var count = 0
sequence work {
  set 2 high
  count += 1
  if input 1 { set 3 high }
  set 2 low
}
sequence main {
  call work
  checkpoint half
  irreversible \"the glue is on\" {
    set 1 high
  }
  call work
  throw odd
  if count > 5 { wait 0.1 s }
}
";

fn bench(name: &str) -> Bench {
    let bench = Bench::new(&format!("debug_{name}"));
    bench.write("p.obv", PROGRAM);
    bench
}

/// Feed commands through a pipe.
fn piped(bench: &Bench, more: &[&str], commands: &[&str]) -> Ran {
    piped_to(bench, &[&["debug", "p.obv"], more].concat(), commands)
}

pub(crate) fn piped_to(bench: &Bench, arguments: &[&str], commands: &[&str]) -> Ran {
    let mut command = bench.command(arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the binary runs");
    let text = commands.iter().flat_map(|line| [line, "\n"]).collect::<String>();
    let mut stdin = child.stdin.take().expect("a pipe");
    // It may have ended before it has read everything.
    let _ = stdin.write_all(text.as_bytes());
    drop(stdin);
    Ran::from(child.wait_with_output().expect("its end"))
}

/// The answers to commands, each of which must be carried out.
fn answers(bench: &Bench, commands: &[&str]) -> Vec<Value> {
    let ran = piped(bench, &["--json"], commands);
    assert_eq!(ran.code, 0, "{}\n{}", ran.stdout, ran.stderr);
    let answers: Vec<Value> =
        ran.json().into_iter().filter(|line| line["type"] == "answer").collect();
    assert_eq!(answers.len(), commands.len(), "{}", ran.stdout);
    answers
}

fn last(bench: &Bench, commands: &[&str]) -> Value {
    answers(bench, commands).pop().expect("an answer")
}

fn line(answer: &Value) -> &Value {
    &answer["position"]["line"]
}

#[test]
fn steps_go_into_calls_and_next_goes_over_them() {
    let bench = bench("walk");
    let all = answers(&bench, &["step", "s", "finish", "reverse-next", "next", "n", "rs", "rf"]);
    let lines: Vec<&Value> = all.iter().map(line).collect();
    let expected = [11, 5, 12, 11, 12, 13, 12].map(|line| json!(line));
    assert_eq!(lines[..7], expected.iter().collect::<Vec<_>>()[..]);
    // Also what is taken back takes its moments.
    let moment = |at: usize| all[at]["position"]["moment"].as_u64();
    assert!(moment(7) > moment(6) && moment(6) > moment(5));
}

#[test]
fn what_counts_the_attempts_of_a_move_is_no_statement_of_its_own() {
    let bench = bench("attempts");
    let there = ["break 45", "continue", "step", "reverse-step"];
    let ran = piped_to(&bench, &["debug", "--json", "peg_in_hole.obv"], &there);
    let answers: Vec<Value> =
        ran.json().into_iter().filter(|line| line["type"] == "answer").collect();
    let lines: Vec<&Value> = answers[1..].iter().map(line).collect();
    assert_eq!(lines, [&json!(45), &json!(30), &json!(45)]);
}

#[test]
fn a_never_is_refused_live_and_crossed_rewound() {
    let bench = bench("never");
    let all = answers(
        &bench,
        &["b 16", "c", "why", "rc", "goto half", "p output 1", "goto end", "p output 1"],
    );
    assert_eq!(all[2]["never"]["reason"], "the glue is on");
    assert_eq!(all[3]["halt"], "refused");
    assert_eq!(all[3]["position"]["mode"], "live");
    let text = all[3]["text"][0].as_str().expect("why");
    assert!(text.contains("cannot go back past p.obv:13: the glue is on"), "{text}");
    assert_eq!((&all[4]["position"]["mode"], line(&all[4])), (&json!("rewound"), &json!(12)));
    assert_eq!((&all[5]["value"], &all[7]["value"]), (&json!(false), &json!(true)));
    assert_eq!(all[7]["position"]["mode"], "live");
}

#[test]
fn what_is_tried_leaves_the_recording_as_it_was() {
    let bench = bench("what_if");
    let all = answers(
        &bench,
        &[
            "c",
            "p count",
            "goto half",
            "what-if",
            "set count = 41",
            "input 1 high",
            "c",
            "p count",
            "p output 3",
            "rc",
            "leave",
            "p count",
            "goto end",
            "p count",
            "p output 3",
        ],
    );
    assert_eq!(all[6]["halt"], "finished");
    assert_eq!((&all[7]["value"], &all[8]["value"]), (&json!(42), &json!(true)));
    assert_eq!(all[9]["position"]["mode"], "what-if");
    assert_eq!((&all[10]["position"]["mode"], &all[11]["value"]), (&json!("rewound"), &json!(1)));
    assert_eq!((&all[13]["value"], &all[14]["value"]), (&json!(2), &json!(false)));
    assert_eq!(all[12]["position"]["end"], all[0]["position"]["end"]);
}

#[test]
fn the_last_change_is_found_again_and_again_and_a_jump_is_undone() {
    let bench = bench("last");
    let all = answers(&bench, &["c", "last output 2", "last output 2", "last output 2", "undo"]);
    assert_eq!(all[1..4].iter().map(line).collect::<Vec<_>>(), [&json!(8), &json!(5), &json!(8)]);
    assert_eq!(all[1]["change"]["before"], true);
    assert_eq!(all[4]["position"], all[2]["position"]);
    // Before what is shown no error was raised; from the end it is found.
    let ran = piped(&bench, &[], &["c", "goto start", "goto error"]);
    assert!(ran.stdout.contains("no error was raised before this moment"), "{}", ran.stdout);
    assert_eq!(line(&last(&bench, &["c", "goto error"])), 17);
}

#[test]
fn breakpoints_stop_at_places_and_watches_at_changes() {
    let bench = bench("stops");
    let moved = last(&bench, &["break 1"]);
    let text = moved["text"][0].as_str().expect("text");
    assert!(text.starts_with("line 1 has no code; the next that has is"), "{text}");
    let all = answers(
        &bench,
        &["b work if count == 1", "tbreak 12", "b error odd", "c", "c", "c", "info breakpoints"],
    );
    assert_eq!(all[3..6].iter().map(line).collect::<Vec<_>>(), [&json!(12), &json!(5), &json!(17)]);
    let kept = all[6]["breakpoints"].as_array().expect("breakpoints");
    assert_eq!(kept.len(), 2, "{kept:?}");
    let all = answers(&bench, &["watch count", "c", "p count", "c", "p count", "rc", "delete all"]);
    assert_eq!((&all[2]["value"], &all[4]["value"]), (&json!(1), &json!(2)));
    assert_eq!(all[5]["halt"], "breakpoint");
    let all =
        answers(&bench, &["b work", "ignore 1 1", "c", "p count", "watch count reverse", "c"]);
    assert_eq!(all[3]["value"], 1);
    assert_eq!(all[5]["halt"], "finished");
}

#[test]
fn what_there_is_can_be_looked_at() {
    let bench = bench("look");
    let all = answers(
        &bench,
        &["b 6", "c", "bt", "locals", "globals", "state", "history", "tape", "list", "x", "help"],
    );
    assert_eq!(all[2]["frames"][0]["function"], "work");
    assert_eq!(all[4]["values"]["count"], 0);
    assert_eq!(all[5]["values"]["output 2"], true);
    assert_eq!(all[6]["history"][0]["text"], "set 2 high");
    assert_eq!(all[7]["tape"]["bits"], 1);
    let listed = all[8]["text"].as_array().expect("lines");
    assert!(listed.iter().any(|line| line == ">   6 │⇄   count += 1"), "{listed:?}");
    for answer in &all {
        assert!(answer["text"].is_array(), "{answer}");
    }
}

/// A bracket is along lines that can go back equally far: it ends where something stops that.
#[test]
fn a_listing_shows_by_brackets_how_far_back_lines_go() {
    let bench = bench("brackets");
    let listed = piped(&bench, &[], &["list 16"]).stdout;
    let lines = listed.lines().skip(3);
    let margins: Vec<String> = lines.map(|line| line.chars().skip(6).take(2).collect()).collect();
    assert_eq!(margins, ["╭←", "│⇄", "╰✗", "╶←", "  ", "╭←", "│←", "╰⇄", "  "], "{listed}");
    // Instructions have them where there is no source.
    let assembly = bench.ends(0, &["dis", "p.obv"]).stdout;
    let bare: Vec<&str> = assembly.lines().filter(|it| !it.trim().starts_with('@')).collect();
    bench.write("bare.obvasm", bare.join("\n"));
    let listed = piped_to(&bench, &["debug", "bare.obvasm"], &["list"]).stdout;
    assert!(listed.contains("\n    2 ╭← store.global count\n"), "{listed}");
}

#[test]
fn wrong_commands_are_answered_and_the_session_goes_on() {
    let bench = bench("wrong");
    for (command, why) in [
        ("stp", "did you mean `step`?"),
        ("re", "`re` may be `reverse-step` or"),
        ("step zero", "no count"),
        ("goto 1000000", "there is no moment 1000000"),
        ("goto halv", "did you mean `half`?"),
        ("b 999", "no code at line 999"),
        ("b nobody.obv:3", "no file `nobody.obv`"),
        ("b worrk", "`work`?"),
        ("b error oddd", "`odd`?"),
        ("b work if countt > 1", "`count`?"),
        ("b work if count", "neither true nor false"),
        ("p (1", "a `)` is missing, at column 3"),
        ("set count = 3", "`what-if` first"),
        ("leave", "nothing is being tried"),
        ("undo", "no jump to undo"),
        ("delete 7", "no breakpoint 7"),
        ("last count", "did not change before"),
        ("locals 9", "is no call"),
        ("info nothing", "say of what: bookmarks, breakpoints"),
    ] {
        let ran = piped(&bench, &[], &[command, "p count"]);
        assert_eq!(ran.code, 1, "{command}\n{}", ran.stdout);
        let told = ran.stdout.lines().find(|line| line.starts_with("not done: "));
        assert!(told.is_some_and(|told| told.contains(why)), "{command}\n{}", ran.stdout);
        assert!(ran.stdout.ends_with("count = 0\n"), "{command}\n{}", ran.stdout);
    }
}

#[test]
fn commands_come_from_a_file_too() {
    let bench = bench("file");
    bench.write("commands", "# a remark\n\nstep\nquit\nnonsense\n");
    let ran = bench.ends(0, &["debug", "p.obv", "--commands", "commands"]);
    assert!(ran.stdout.contains("(0 live) step\n"), "{}", ran.stdout);
    assert!(!ran.stdout.contains('\u{1b}') && !ran.stdout.contains("nonsense"), "{}", ran.stdout);
    bench.ends(2, &["debug", "p.obv", "--commands", "none"]);
    bench.write("long", "p ".repeat(5000));
    let ran = bench.ends(1, &["debug", "p.obv", "--commands", "long", "--json"]);
    assert_eq!(ran.summary()["failed"], 1);
    bench.write("binary", [0xff, 0xfe, b'\n']);
    bench.ends(1, &["debug", "p.obv", "--commands", "binary"]);
    bench.ends(2, &["debug", "none.obv"]);
}

#[test]
fn who_follows_a_run_changes_nothing_of_what_is_recorded() {
    // What is told of a wait asks for the level of the input, too.
    let bench = Bench::new("debug_follow");
    bench.write("commands", "c\ngoto start\nc\n");
    let ran = bench.ends(0, &["debug", "feeder.obv", "--commands", "commands", "--json"]);
    let answers: Vec<Value> =
        ran.json().into_iter().filter(|line| line["type"] == "answer").collect();
    assert_eq!(answers[2]["halt"], "end_of_recording");
    let commanded = |line: &Value| line["type"] == "event";
    let first = ran.json().iter().filter(|line| commanded(line)).count();
    let alone = bench.ends(0, &["run", "feeder.obv", "--json"]).json();
    assert_eq!(first, alone.iter().filter(|line| commanded(line)).count(), "once and not twice");
}

/// The tape of a run leads to its end; back from there, and to what would have been.
#[test]
fn a_tape_is_opened_at_its_end() {
    let bench = bench("tape");
    let ran = bench.ends(0, &["run", "--json", "p.obv", "--tape", "t.tape"]).summary();
    let commands = ["print count", "goto start", "what-if", "continue"];
    let told = piped_to(&bench, &["debug", "--json", "--tape", "t.tape"], &commands);
    assert_eq!(told.code, 0, "{}\n{}", told.stdout, told.stderr);
    let lines = told.json();
    assert_eq!((&lines[0]["type"], &lines[0]["program"]), (&json!("tape"), &json!("p.obv")));
    assert_eq!((&lines[0]["ending"], &lines[0]["can_try"]), (&ran["message"], &json!(true)));
    let answers: Vec<&Value> = lines.iter().filter(|line| line["type"] == "answer").collect();
    assert_eq!(answers[0]["position"]["moment"], ran["instructions"]);
    assert_eq!(answers[0]["position"]["mode"], "rewound");
    assert_eq!(answers[3]["position"]["moment"], ran["instructions"], "the same again");
    bench.write("other.obv", "sequence main { wait 1 s }");
    let refused = ["debug", "other.obv", "--tape", "t.tape"];
    bench.refuses(&refused, &["t.tape: this is a run of p.obv (", "and not of other.obv"]);
    bench.ends(0, &["debug", "p.obv", "--tape", "t.tape"]);
    bench.refuses(&["debug", "--tape", "t.tape", "--seed", "3"], &["cannot be used with"]);
    bench.refuses(&["debug"], &["--tape"]);
}

/// Killed in the middle, a run leaves what it has come to, while the next one has not begun.
#[cfg(unix)]
#[test]
fn the_tape_of_a_run_that_is_killed_is_opened_where_it_was() {
    let bench = bench("killed");
    let program = "cell \"bench_cell.toml\"\nvar count = 0\nsequence main {\n  \
                   repeat 1000000000 times { count += 1 set 2 high set 2 low }\n}\n";
    bench.write("k.obv", program);
    let run = ["run", "k.obv", "--json", "--tape", "k.tape"];
    let mut child = bench.command(&run).stdout(Stdio::null()).spawn().expect("it runs");
    let long = || std::fs::metadata(bench.path("k.tape")).map_or(0, |file| file.len()) > 200_000;
    let begun = std::time::Instant::now();
    while !long() {
        assert!(begun.elapsed().as_secs() < 60, "nothing is written");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    child.kill().expect("it is there");
    child.wait().expect("it is gone");
    let shown = bench.ends(0, &["debug", "--json", "--tape", "k.tape"]);
    assert_eq!(shown.json()[0]["ending"], json!(null));
    assert!(shown.summary()["position"]["moment"].as_u64() > Some(1000), "{}", shown.stdout);
    let told = piped_to(
        &bench,
        &["debug", "--json", "--tape", "k.tape"],
        &["print count", "last output 2", "reverse-step", "print count"],
    );
    assert_eq!(told.code, 0, "{}\n{}", told.stdout, told.stderr);
}

/// Ctrl-C halts what is under way, and the session goes on.
#[cfg(unix)]
#[test]
fn an_interrupt_halts_the_command_and_keeps_the_session() {
    let bench = bench("interrupt");
    let program = "var count = 0\nsequence main {\n  repeat 1000000000 times { count += 1 }\n  \
                   if count > 3 { wait 1 s }\n}\n";
    bench.write("i.obv", program);
    for command in ["continue", "step 1000000", "until"] {
        interrupted(&bench, command);
    }
}

/// A command that takes longer than anybody waits is interrupted, and the next one is carried out.
#[cfg(unix)]
fn interrupted(bench: &Bench, asked: &str) {
    use std::io::{BufRead, BufReader};
    let mut command = bench.command(&["debug", "i.obv", "--limit", "100000000000"]);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it runs");
    let mut stdin = child.stdin.take().expect("a pipe");
    let commands = format!("step\nstep\n{asked}\nprint count > 10\n");
    stdin.write_all(commands.as_bytes()).expect("it reads");
    let mut lines = BufReader::new(child.stdout.take().expect("a pipe")).lines();
    let is_begun = lines.by_ref().any(|line| line.is_ok_and(|line| line.ends_with(asked)));
    assert!(is_begun, "it begins");
    std::thread::sleep(std::time::Duration::from_millis(200));
    let id = child.id().to_string();
    let sent = std::process::Command::new("kill").args(["-INT", &id]).status();
    assert!(sent.expect("kill is there").success());
    drop(stdin);
    let rest: Vec<String> = lines.map_while(Result::ok).collect();
    assert_eq!(rest.first().map(String::as_str), Some("interrupted"), "{asked}: {rest:?}");
    assert!(rest.iter().any(|line| line.ends_with("= true")), "{asked}: {rest:?}");
    assert_eq!(child.wait().expect("its end").code(), Some(0));
}
