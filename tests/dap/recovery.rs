//! Errors that are due, as a client meets them: gone on from as the program says, in one request or
//! in many.

use crate::client::{Client, PROGRAMS};
use serde_json::{Value, json};

const PROGRAM: &str = "reversal_policy.obv";

/// Stopped where the error of the program is due.
fn at_the_error() -> Client {
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("launch", json!({ "program": PROGRAM, "seed": 0 }));
    client.event("initialized");
    client.ok("configurationDone", Value::Null);
    is_due(&client.event("stopped"), "back 1 action");
    client
}

fn is_due(stopped: &Value, next: &str) {
    assert_eq!(stopped["reason"], "exception", "{stopped}");
    let text = stopped["text"].as_str().expect("it says what");
    assert!(text.starts_with("error peg_meets_rim is due at") && text.contains(next), "{text}");
}

/// What the console has told.
fn told(client: &Client, text: &str) -> usize {
    let is_it = |message: &&Value| {
        let output = message["body"]["output"].as_str();
        message["event"] == "output" && output.is_some_and(|output| output.contains(text))
    };
    client.came.iter().filter(is_it).count()
}

#[test]
fn continue_goes_on_from_an_error_as_the_program_says() {
    let mut client = at_the_error();
    assert_eq!(
        client.ok("exceptionInfo", json!({ "threadId": 1 }))["exceptionId"],
        "peg_meets_rim"
    );
    is_due(&client.go("continue", json!({})), "back 2 actions");
    assert_eq!(client.go("continue", json!({}))["reason"], "end");
    assert_eq!(told(&client, " s: forward again, attempt"), 2);
    assert_eq!(told(&client, "past peg_meets_rim after 2 attempts"), 1);
    assert!(client.typed("history").contains("<-"));
    assert_eq!(client.bye("recovery_continue"), Some(0));
}

#[test]
fn recover_is_typed_and_stopped_on_its_way_by_a_breakpoint() {
    let mut client = at_the_error();
    let source = json!({ "path": format!("{PROGRAMS}/{PROGRAM}") });
    let lines = json!({ "source": source, "breakpoints": [{ "line": 44 }] });
    client.ok("setBreakpoints", lines);
    assert_eq!(client.typed("recover"), "recovering");
    client.event("continued");
    assert_eq!(client.event("stopped")["reason"], "breakpoint");
    assert_eq!(client.line(), 44);
    assert_eq!(client.go("next", json!({}))["reason"], "step");
    assert_eq!(client.typed("recover"), "recovering");
    assert_eq!(client.event("stopped")["reason"], "step");
    assert_eq!(told(&client, "past peg_meets_rim"), 1);
    let nothing = json!({ "expression": "recover", "context": "repl" });
    assert!(client.refused("evaluate", nothing.clone()).contains("no error is due"));
    client.typed("goto 3");
    client.event("stopped");
    client.refused("evaluate", nothing);
    assert_eq!(client.bye("recovery_recover"), Some(0));
}

#[test]
fn errors_that_a_client_does_not_want_to_hear_of_are_recovered_from_all_the_same() {
    let mut client = at_the_error();
    client.ok("setExceptionBreakpoints", json!({ "filters": [] }));
    assert_eq!(client.go("continue", json!({}))["reason"], "end");
    assert_eq!(told(&client, "past peg_meets_rim"), 1);
    assert_eq!(client.bye("recovery_quiet"), Some(0));
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("launch", json!({ "program": PROGRAM, "seed": 0, "noDebug": true }));
    client.ok("configurationDone", Value::Null);
    assert_eq!(client.event("exited")["exitCode"], 0);
    assert_eq!(client.bye("recovery_no_debug"), Some(0));
}

#[test]
fn a_held_arm_waits_for_a_release() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("dap_bumps.obv");
    let text = "error bumped {\n  on collision\n  recover by reversing 1 action\n}\n\
                sequence main {\n  set 2 high\n  move 600 mm down in base\n}\n";
    std::fs::write(&path, text).expect("a file");
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    let cell = format!("{PROGRAMS}/bench_cell.toml");
    client.ok("launch", json!({ "program": path, "cell": cell }));
    client.ok("configurationDone", Value::Null);
    assert_eq!(client.event("stopped")["reason"], "exception");
    let why = client.refused("continue", json!({ "threadId": 1 }));
    assert!(why.contains("`release`"), "{why}");
    assert!(client.typed("release").contains("may move again"));
    let release = json!({ "expression": "release", "context": "repl" });
    assert!(client.refused("evaluate", release).contains("no stop"));
    let stopped = client.go("continue", json!({}));
    let text = stopped["text"].as_str().expect("it says what");
    assert!(text.contains("bumped is due") && text.contains("back 1 action"), "{text}");
    assert_eq!(client.bye("recovery_held"), Some(0));
}
