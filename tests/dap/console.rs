//! What is typed into the debug console: the words of the debugger at a terminal.

use crate::client::{Client, PROGRAMS};
use obverse_dap::console::WORDS;
use serde_json::{Value, json};
use std::io::Write;
use std::process::{Command, Stdio};

/// What the debugger at a terminal answers to lines.
fn terminal(lines: &str) -> String {
    let mut debugger = Command::new(env!("CARGO_BIN_EXE_obverse"))
        .current_dir(PROGRAMS)
        .args(["debug", "glue.obv"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the debugger starts");
    let mut input = debugger.stdin.take().expect("it has one");
    input.write_all(lines.as_bytes()).expect("it reads");
    drop(input);
    let output = debugger.wait_with_output().expect("it ends");
    String::from_utf8(output.stdout).expect("text")
}

/// One name for one thing: of each word the terminal has help under its full name.
#[test]
fn every_word_is_a_command_of_the_terminal() {
    for word in WORDS.iter().filter(|word| word.is_carried_out()) {
        let full = word.names[0];
        let lines: String = word.names.iter().map(|name| format!("help {name}\n")).collect();
        let told = terminal(&lines);
        let heads = told.lines().filter(|line| {
            // The answer begins with the name in full, and says no more of it than what follows.
            let rest = line.strip_prefix(full);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', ',']))
        });
        assert_eq!(heads.count(), word.names.len(), "{full}:\n{told}");
    }
    let carried_out = WORDS.iter().filter(|word| word.is_carried_out());
    assert!(carried_out.count() > 20);
    assert!(terminal("help such_a_word\n").contains("not done"), "what is none is told from one");
}

#[test]
fn moments_are_jumped_to_and_bookmarked() {
    let mut client = Client::at_entry("glue.obv");
    let moved = |client: &mut Client, text: &str| {
        let told = client.typed(text);
        assert_eq!(client.event("stopped")["reason"], "goto", "{text}");
        told
    };
    client.go("continue", json!({}));
    assert!(client.typed("bookmark the.end").starts_with("the.end is moment"));
    assert!(moved(&mut client, "goto start").starts_with("rewound to 0 of"));
    assert!(moved(&mut client, "goto the.end").starts_with("rewound to"));
    let told = moved(&mut client, "last output 3");
    assert!(told.ends_with("output 3 was true until here, and became false"), "{told}");
    let told = moved(&mut client, "last output 3");
    assert!(told.ends_with("output 3 was false until here, and became true"), "{told}");
    assert_eq!(client.typed("output 3"), "false");
    assert!(moved(&mut client, "undo").starts_with("rewound"));
    assert_eq!(client.typed("output 3"), "true");
    assert!(moved(&mut client, "goto end").starts_with("live"));
    assert!(client.typed("mark").contains("the.end"));
    assert_eq!(client.bye("console_jumps"), Some(0));
}

#[test]
fn the_last_error_is_gone_to() {
    for typed in ["goto error", "last error"] {
        let mut client = Client::at_entry("bad_pin.obv");
        assert_eq!(client.go("continue", json!({}))["reason"], "exception");
        let told = client.typed(typed);
        assert!(told.starts_with("rewound"), "{typed}: {told}");
        assert_eq!(client.event("stopped")["reason"], "goto");
        assert_eq!(client.typed("error pin_jams"), "false");
        client.go("stepIn", json!({ "granularity": "instruction" }));
        assert_eq!(client.typed("error pin_jams"), "true");
        assert_eq!(client.bye("console_error"), Some(0));
    }
}

#[test]
fn the_moment_is_looked_at() {
    let mut client = Client::at_entry("bad_pin.obv");
    client.ok("setFunctionBreakpoints", json!({ "breakpoints": [{ "name": "grip" }] }));
    client.go("continue", json!({}));
    for (typed, expected) in [
        ("state", "held = nothing"),
        ("backtrace", "#1 pick at bad_pin.obv:55"),
        ("list", ">  10"),
        ("list 80", "advance insert"),
        ("print next_pin", "1"),
        ("p", "next_pin = 1"),
        ("globals", "next_pin = 1"),
        ("locals 1", "pin"),
        ("x", ">"),
        ("tape", "bits"),
        ("why", "nothing stops going back"),
        ("history 3", "move to pin.grasp linearly"),
        ("help", "reverse-step"),
        ("help goto", "MOMENT|start|end|error|NAME"),
    ] {
        let told = client.typed(typed);
        assert!(told.contains(expected), "{typed}: {told}");
    }
    for (typed, place) in [("next", "Step Over"), ("b", "beside a line"), ("rn", "Step Back")] {
        let asked = json!({ "expression": typed, "context": "repl" });
        let why = client.refused("evaluate", asked);
        assert!(why.contains(place), "{typed}: {why}");
    }
    assert_eq!(client.bye("console_looks"), Some(0));
}

#[test]
fn what_is_half_typed_is_completed() {
    let mut client = Client::at_entry("bad_pin.obv");
    client.typed("bookmark here");
    let offered = |client: &mut Client, text: &str, column: u64| {
        let asked = json!({ "text": text, "column": column, "frameId": 2 });
        let found = client.ok("completions", asked)["targets"].clone();
        let found = found.as_array().expect("targets").clone();
        let label = |it: &serde_json::Value| it["label"].as_str().unwrap_or("").to_owned();
        let begin = found.first().map(|it| (it["start"].as_u64(), it["length"].as_u64()));
        (found.iter().map(label).collect::<Vec<_>>(), begin.unwrap_or_default())
    };
    let (labels, begin) = offered(&mut client, "rev", 4);
    assert_eq!(labels[0], "reverse-step");
    assert_eq!(begin, (Some(1), Some(3)));
    // What stands behind the cursor does not count.
    let (labels, begin) = offered(&mut client, "goto he and more", 8);
    assert_eq!((labels, begin), (vec!["here".to_owned()], (Some(6), Some(2))));
    let (labels, _) = offered(&mut client, "last next", 10);
    assert_eq!(labels, ["next_pin"]);
    let (labels, _) = offered(&mut client, "held == out", 12);
    assert_eq!(labels[0], "output 0");
    let (labels, _) = offered(&mut client, "", 1);
    assert!(["goto", "held", "next_pin"].iter().all(|it| labels.contains(&(*it).to_owned())));
    for wrong in [json!({}), json!({ "text": "x" }), json!({ "text": 3, "column": 1 })] {
        client.refused("completions", wrong);
    }
    let far = json!({ "text": "x", "column": u64::MAX, "line": u64::MAX });
    client.ok("completions", far);
    assert_eq!(client.bye("console_completes"), Some(0));
}

#[test]
fn what_is_other_is_tried_in_a_what_if() {
    let mut client = Client::at_entry("bad_pin.obv");
    client.ok("setFunctionBreakpoints", json!({ "breakpoints": [{ "name": "fetch_pin" }] }));
    client.go("continue", json!({}));
    assert_eq!(client.typed("set next_pin = 2"), "next_pin is 2");
    client.event("stopped");
    assert!(client.typed("input 0 high").contains("reads high"));
    assert!(client.typed("seed 3").contains("seed 3"));
    assert_eq!(client.go("continue", json!({}))["reason"], "end");
    assert!(client.typed("leave").starts_with("live"));
    client.event("stopped");
    assert_eq!(client.typed("next_pin"), "1");
    // What cannot be given begins none.
    let wrong = json!({ "expression": "set next_pin = true", "context": "repl" });
    client.refused("evaluate", wrong);
    let leave = json!({ "expression": "leave", "context": "repl" });
    client.refused("evaluate", leave);
    assert_eq!(client.bye("console_tries"), Some(0));
}

#[test]
fn the_thread_says_how_many_what_ifs_are_within_each_other() {
    let mut client = Client::at_entry("bad_pin.obv");
    let name = |client: &mut Client| {
        client.ok("threads", Value::Null)["threads"][0]["name"].as_str().map(str::to_owned)
    };
    for (typed, expected) in [
        ("what-if", "robot (what-if)"),
        ("what-if", "robot (what-if 2)"),
        ("leave", "robot (what-if)"),
        ("leave", "robot (live)"),
    ] {
        client.typed(typed);
        assert_eq!(name(&mut client).as_deref(), Some(expected), "{typed}");
    }
    client.typed("what-if");
    client.go("next", json!({}));
    client.typed("goto start");
    let rewound = name(&mut client).expect("a name");
    assert!(rewound.starts_with("robot (what-if rewound to"), "{rewound}");
    assert_eq!(client.bye("nested"), Some(0));
}
