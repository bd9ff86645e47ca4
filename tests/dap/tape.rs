//! A tape that is attached to: opened at its end, and looked at from there.

use crate::client::{Client, PROGRAMS};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The tape of a run.
fn tape(test: &str, program: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("dap_tapes");
    std::fs::create_dir_all(&folder).expect("a folder");
    let tape = folder.join(format!("{test}.tape"));
    let ran = Command::new(env!("CARGO_BIN_EXE_obverse"))
        .current_dir(PROGRAMS)
        .args(["run", program, "--seed", "1", "--tape"])
        .arg(&tape)
        .output()
        .expect("the binary runs");
    assert_eq!(ran.status.code(), Some(0), "{}", String::from_utf8_lossy(&ran.stderr));
    tape
}

fn attached(arguments: Value) -> Client {
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("attach", arguments);
    client.event("initialized");
    client.ok("configurationDone", Value::Null);
    client
}

#[test]
fn a_tape_is_opened_at_its_end_and_goes_back() {
    let tape = tape("back", "glue.obv");
    let mut client = attached(json!({ "tape": tape, "program": "glue.obv" }));
    let stopped = client.event("stopped");
    let description = stopped["description"].as_str().expect("it says where");
    assert!(description.contains("recording") && description.contains("rewound"), "{stopped}");
    let why = client.refused("next", json!({ "threadId": 1 }));
    assert!(why.contains("recording"), "{why}");
    // Shown, what cannot be taken back is no end.
    assert_eq!(client.go("reverseContinue", json!({}))["reason"], "entry");
    let body = client.ok("evaluate", json!({ "expression": "steps", "context": "hover" }));
    assert_eq!(body["result"], "1");
    client.go("continue", json!({}));
    // What would have been can be tried: the workcell is there.
    client.go("stepBack", json!({}));
    assert!(client.typed("what-if").starts_with("what-if"));
    assert_eq!(client.bye("attach_back"), Some(0));
}

/// What is promised of a tape that lies elsewhere is so: whether its workcell is to be had there.
#[test]
fn what_cannot_be_tried_is_not_promised() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("dap_tapes");
    let tape = tape("moved", "glue.obv");
    let bytes = std::fs::read(&tape).expect("the tape");
    let mut client = Client::in_folder(&folder);
    std::fs::write(folder.join("elsewhere.tape"), bytes).expect("a file");
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("attach", json!({ "tape": "elsewhere.tape" }));
    let capabilities = client.event("capabilities");
    let is_promised = capabilities["capabilities"]["supportsSetVariable"].as_bool();
    client.ok("configurationDone", Value::Null);
    client.event("stopped");
    client.go("reverseContinue", json!({}));
    let what_if = client.send("evaluate", json!({ "expression": "what-if", "context": "repl" }));
    assert_eq!(client.response(what_if)["success"].as_bool(), is_promised);
    assert_eq!(client.bye("attach_moved"), Some(0));
}

#[test]
fn the_tape_of_another_program_is_refused_with_both_names() {
    let tape = tape("other", "glue.obv");
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    let why = client.refused("attach", json!({ "tape": tape, "program": "tower.obv" }));
    assert!(why.contains("glue.obv") && why.contains("tower.obv"), "{why}");
    client.ok("attach", json!({ "tape": tape }));
    assert_eq!(client.bye("attach_other"), Some(0));
}
