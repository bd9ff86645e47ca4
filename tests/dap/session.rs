//! A session in both directions, across what cannot be taken back, and what is looked at in it.

use crate::client::{Client, PROGRAMS, line_of};
use serde_json::{Value, json};

fn glue() -> String {
    format!("{PROGRAMS}/glue.obv")
}

fn lines(lines: &[u64]) -> Value {
    let points: Vec<Value> = lines.iter().map(|line| json!({ "line": line })).collect();
    json!({ "source": { "path": glue() }, "breakpoints": points })
}

#[test]
fn capabilities_are_answered_to() {
    let mut client = Client::new();
    let body = client.ok("initialize", json!({ "adapterID": "obverse" }));
    for promised in ["supportsStepBack", "supportsGotoTargetsRequest", "supportsDataBreakpoints"] {
        assert_eq!(body[promised], true, "{promised}");
    }
    assert_eq!(client.bye("capabilities"), Some(0));
}

#[test]
fn a_step_back_at_a_never_stays_and_says_why() {
    let mut client = Client::at_entry("glue.obv");
    let never = line_of(&glue(), "irreversible");
    let body = client.ok("setBreakpoints", lines(&[never + 8]));
    assert_eq!(body["breakpoints"][0]["verified"], true);
    assert_eq!(client.go("continue", json!({}))["reason"], "breakpoint");
    assert_eq!(client.line(), never + 8);
    let why = client.refused("stepBack", json!({ "threadId": 1 }));
    assert!(why.contains("the glue is on the block"), "{why}");
    assert_eq!(client.event("output")["output"], json!(format!("{why}\n")));
    assert_eq!(client.line(), never + 8);
    // Rewound, it is passed.
    assert!(client.typed("bookmark here").starts_with("here is moment"));
    client.typed("goto here");
    assert!(
        client.event("stopped")["description"].as_str().is_some_and(|it| it.contains("rewound"))
    );
    client.go("stepBack", json!({}));
    client.go("stepBack", json!({}));
    assert!(client.line() < never + 8);
    assert_eq!(client.bye("never"), Some(0));
}

#[test]
fn what_was_done_is_taken_back_step_by_step() {
    let mut client = Client::at_entry("glue.obv");
    let mut there = vec![client.line()];
    for _ in 0..3 {
        assert_eq!(client.go("stepIn", json!({}))["reason"], "step");
        there.push(client.line());
    }
    let joints = |client: &mut Client| client.typed("joints");
    let end = joints(&mut client);
    while there.len() > 1 {
        there.pop();
        client.go("stepBack", json!({ "granularity": "instruction" }));
        let mut steps = 0;
        while client.line() != there[there.len() - 1] && steps < 20 {
            client.go("stepBack", json!({ "granularity": "instruction" }));
            steps += 1;
        }
        assert!(steps < 20, "{there:?}");
    }
    for _ in 0..3 {
        client.go("stepIn", json!({}));
    }
    assert_eq!(joints(&mut client), end);
    assert_eq!(client.bye("back"), Some(0));
}

/// At the start there is no call but that of the program itself: it is shown as any other.
#[test]
fn the_start_is_shown_as_any_place_when_the_run_is_back_there() {
    let mut client = Client::at_entry("bad_pin.obv");
    let stack = |client: &mut Client| client.ok("stackTrace", json!({ "threadId": 1 }));
    let outer = stack(&mut client)["stackFrames"][1].clone();
    assert_eq!(
        (&outer["name"], &outer["presentationHint"]),
        (&json!("the start"), &json!("subtle"))
    );
    client.go("reverseContinue", json!({}));
    let shown = stack(&mut client);
    assert_eq!(shown["totalFrames"], 1);
    let start = &shown["stackFrames"][0];
    assert_eq!((&start["name"], &start["presentationHint"]), (&json!("the start"), &json!(null)));
    assert_eq!(client.bye("start"), Some(0));
}

#[test]
fn breakpoints_of_all_kinds_stop_a_run() {
    let mut client = Client::at_entry("glue.obv");
    let body = client.ok("setBreakpoints", lines(&[1, 9000]));
    let (moved, none) = (&body["breakpoints"][0], &body["breakpoints"][1]);
    assert!(moved["message"].as_str().is_some_and(|why| why.contains("no code at line 1")));
    assert_eq!(none["verified"], false);
    client.ok("setBreakpoints", lines(&[]));
    let named = json!({ "breakpoints": [{ "name": "look" }, { "name": "lok" }] });
    let body = client.ok("setFunctionBreakpoints", named);
    assert_eq!(body["breakpoints"][0]["verified"], true);
    assert!(body["breakpoints"][1]["message"].as_str().is_some_and(|why| why.contains("`look`")));
    let info =
        client.ok("dataBreakpointInfo", json!({ "variablesReference": 2, "name": "output 3" }));
    let data = json!({ "breakpoints": [{ "dataId": info["dataId"], "hitCondition": "2" }] });
    client.ok("setDataBreakpoints", data);
    let stop = client.go("continue", json!({}));
    assert_eq!(
        (&stop["reason"], &stop["text"]),
        (&json!("data breakpoint"), &json!("it was true and is false"))
    );
    assert_eq!(client.go("continue", json!({}))["reason"], "function breakpoint");
    let stack = client.ok("stackTrace", json!({ "threadId": 1 }));
    let pc = stack["stackFrames"][1]["instructionPointerReference"].clone();
    let at =
        json!({ "breakpoints": [{ "instructionReference": pc }, { "instructionReference": "x" }] });
    let body = client.ok("setInstructionBreakpoints", at);
    assert_eq!(body["breakpoints"][1]["verified"], false);
    assert_eq!(client.go("continue", json!({}))["reason"], "instruction breakpoint");
    let line = line_of(&glue(), "set 2 high");
    let log = json!({
        "source": { "path": glue() },
        "breakpoints": [{ "line": line, "logMessage": "light {output 2}" }],
    });
    client.ok("setBreakpoints", log);
    assert_eq!(client.go("continue", json!({}))["reason"], "end");
    assert_eq!(client.bye("breakpoints"), Some(0));
}

#[test]
fn an_error_of_the_program_is_an_exception() {
    let mut client = Client::at_entry("bad_pin.obv");
    let filters = json!({ "filters": ["error pin_jams"] });
    assert_eq!(client.ok("setExceptionBreakpoints", filters)["breakpoints"][0]["verified"], true);
    let stop = client.go("continue", json!({}));
    assert_eq!(stop["reason"], "exception", "{stop}");
    assert_eq!(client.ok("exceptionInfo", json!({ "threadId": 1 }))["exceptionId"], "pin_jams");
    client.typed("goto error");
    assert_eq!(client.event("stopped")["reason"], "goto");
    assert_eq!(client.bye("exception"), Some(0));
}

#[test]
fn a_variable_is_changed_in_a_what_if_that_leaves_the_run_as_it_was() {
    let mut client = Client::at_entry("bad_pin.obv");
    let stop = json!({ "breakpoints": [{ "name": "fetch_pin" }] });
    client.ok("setFunctionBreakpoints", stop);
    client.go("continue", json!({}));
    assert_eq!(client.typed("next_pin"), "1");
    let set = json!({ "variablesReference": 1, "name": "next_pin", "value": "1 + 1" });
    assert_eq!(client.ok("setVariable", set)["value"], "2");
    assert_eq!(client.typed("next_pin"), "2");
    client.typed("leave");
    client.event("stopped");
    assert_eq!(client.typed("next_pin"), "1");
    let wrong = json!({ "variablesReference": 1, "name": "next_pin", "value": "true" });
    client.refused("setVariable", wrong);
    assert_eq!(client.typed("next_pin"), "1");
    assert_eq!(client.bye("what_if"), Some(0));
}

#[test]
fn a_moment_of_a_line_is_gone_to_and_a_call_restarted() {
    let mut client = Client::at_entry("glue.obv");
    assert_eq!(client.go("continue", json!({}))["reason"], "end");
    let line = line_of(&glue(), "set 2 high");
    let targets = client.ok("gotoTargets", json!({ "source": { "path": glue() }, "line": line }));
    let target = targets["targets"][0]["id"].clone();
    assert_eq!(client.go("goto", json!({ "targetId": target }))["reason"], "goto");
    assert_eq!(client.line(), line);
    let stack = client.ok("stackTrace", json!({ "threadId": 1, "startFrame": 0, "levels": 1 }));
    assert_eq!(stack["stackFrames"].as_array().map(Vec::len), Some(1));
    client.go("next", json!({}));
    client.go("next", json!({}));
    let frame = stack["stackFrames"][0]["id"].clone();
    assert_eq!(client.go("restartFrame", json!({ "frameId": frame }))["reason"], "restart");
    assert_eq!(client.line(), line);
    assert_eq!(client.bye("goto"), Some(0));
}

#[test]
fn everything_is_shown() {
    let mut client = Client::at_entry("bad_pin.obv");
    client.go("stepIn", json!({}));
    let scopes = client.ok("scopes", json!({ "frameId": 1 }));
    let scopes = scopes["scopes"].as_array().expect("scopes").clone();
    assert_eq!(scopes.len(), 5);
    let mut named = Vec::new();
    for scope in &scopes {
        let reference = json!({ "variablesReference": scope["variablesReference"] });
        let variables = client.ok("variables", reference)["variables"].clone();
        for variable in variables.as_array().expect("variables") {
            let Some(name) = variable["evaluateName"].as_str() else { continue };
            let asked = json!({ "expression": name, "frameId": 1, "context": "watch" });
            let result = client.ok("evaluate", asked)["result"].clone();
            assert_eq!(result, variable["value"], "{name}");
            named.push(name.to_owned());
        }
    }
    assert!(named.iter().any(|name| name == "reverse.force_limit"), "{named:?}");
    let arm = client.ok("variables", json!({ "variablesReference": 5 }));
    assert_eq!(arm["variables"].as_array().map(Vec::len), Some(6));
    let asked = json!({ "memoryReference": "0", "instructionOffset": -3, "instructionCount": 9 });
    let shown = client.ok("disassemble", asked);
    assert_eq!(shown["instructions"].as_array().map(Vec::len), Some(9));
    assert_eq!(client.ok("loadedSources", json!({}))["sources"][0]["name"], "bad_pin.obv");
    assert!(client.ok("source", json!({ "sourceReference": 1 }))["content"].is_string());
    assert_eq!(
        client.ok("evaluate", json!({ "expression": "1 + 2", "context": "hover" }))["result"],
        "3"
    );
    assert_eq!(client.bye("shown"), Some(0));
}

#[test]
fn a_run_that_does_not_end_is_paused() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("for_ever.obv");
    let text = "var n = 0\nsequence main { while n >= 0 { n += 1 } }\n";
    std::fs::write(&path, text).expect("a file");
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("launch", json!({ "program": path }));
    client.ok("configurationDone", Value::Null);
    assert!(client.ok("threads", json!({}))["threads"][0]["name"].is_string());
    client.refused("stackTrace", json!({ "threadId": 1 }));
    client.ok("setFunctionBreakpoints", json!({ "breakpoints": [] }));
    assert_eq!(client.go("pause", json!({}))["reason"], "pause");
    assert_ne!(client.typed("n"), "0");
    client.go("stepBack", json!({}));
    client.ok("continue", json!({ "threadId": 1 }));
    client.ok("terminate", json!({}));
    assert_eq!(client.bye("paused"), Some(0));
}
