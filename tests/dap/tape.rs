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

#[test]
fn a_tape_has_its_workcell_wherever_it_is() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("dap_tapes");
    let tape = tape("moved", "glue.obv");
    let bytes = std::fs::read(&tape).expect("the tape");
    // Neither program nor workcell file are there.
    let mut client = Client::in_folder(&folder);
    std::fs::write(folder.join("elsewhere.tape"), bytes).expect("a file");
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("attach", json!({ "tape": "elsewhere.tape" }));
    client.ok("configurationDone", Value::Null);
    client.event("stopped");
    client.go("reverseContinue", json!({}));
    assert!(client.typed("what-if").starts_with("what-if"));
    client.go("continue", json!({}));
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
