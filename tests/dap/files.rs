//! Which file is meant: the program's own, and no other of its name.

use crate::client::{Client, PROGRAMS};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;

fn scratch(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("dap_files").join(test);
    let _ = std::fs::remove_dir_all(&folder);
    for part in ["a", "b"] {
        std::fs::create_dir_all(folder.join(part)).expect("a folder");
    }
    folder
}

fn write(path: &Path, text: &str) {
    std::fs::write(path, text).expect("a file");
}

fn begun(arguments: Value, breakpoints: &[(&Path, u64)]) -> (Client, Vec<Value>) {
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("launch", arguments);
    client.event("initialized");
    let mut set = |(path, line): &(&Path, u64)| {
        let asked = json!({ "source": { "path": path }, "breakpoints": [{ "line": line }] });
        client.ok("setBreakpoints", asked)["breakpoints"][0].clone()
    };
    let answers = breakpoints.iter().map(&mut set).collect();
    client.ok("configurationDone", Value::Null);
    (client, answers)
}

const TWO_WAITS: &str = "sequence main {\n  wait 1 s\n  wait 2 s\n}\n";

#[test]
fn a_file_of_the_same_name_elsewhere_leaves_the_program_alone() {
    let folder = scratch("names");
    let (own, other) = (folder.join("a/main.obv"), folder.join("b/main.obv"));
    write(&own, TWO_WAITS);
    write(&other, TWO_WAITS);
    let (mut client, answers) = begun(json!({ "program": own }), &[(&own, 3), (&other, 2)]);
    assert_eq!(answers[0]["verified"], true);
    assert_eq!(answers[1]["verified"], false);
    let why = answers[1]["message"].as_str().expect("it says why");
    assert!(why.contains("no file of the program") && why.contains("a/main.obv"), "{why}");
    assert_eq!(client.event("stopped")["reason"], "breakpoint");
    assert_eq!(client.line(), 3);
    let none = json!({ "source": { "path": other }, "breakpoints": [] });
    assert_eq!(client.ok("setBreakpoints", none)["breakpoints"], json!([]));
    client.go("reverseContinue", json!({}));
    assert_eq!(client.go("continue", json!({}))["reason"], "breakpoint", "it is there yet");
    assert_eq!(client.bye("files_names"), Some(0));
}

#[cfg(unix)]
#[test]
fn a_link_to_the_program_is_the_program() {
    let folder = scratch("links");
    let own = folder.join("a/main.obv");
    write(&own, TWO_WAITS);
    std::os::unix::fs::symlink(folder.join("a"), folder.join("c")).expect("a link");
    let linked = folder.join("c/main.obv");
    let (mut client, answers) = begun(json!({ "program": own }), &[(&linked, 3)]);
    assert_eq!(answers[0]["verified"], true, "{answers:?}");
    assert_eq!(client.event("stopped")["reason"], "breakpoint");
    assert_eq!(client.bye("files_links"), Some(0));
}

#[test]
fn a_module_shows_the_file_beside_it_only_if_it_is_what_runs() {
    let folder = scratch("module");
    let (source, module) = (folder.join("a/main.obv"), folder.join("a/main.obc"));
    write(&source, TWO_WAITS);
    let built = Command::new(env!("CARGO_BIN_EXE_obverse"))
        .current_dir(PROGRAMS)
        .arg("build")
        .arg(&source)
        .arg("-o")
        .arg(&module)
        .status();
    assert!(built.expect("the binary runs").success());
    let launch = json!({ "program": module, "stopOnEntry": true });
    // The adapter was started elsewhere.
    let (mut client, answers) = begun(launch.clone(), &[(&source, 3)]);
    assert_eq!(answers[0]["verified"], true, "{answers:?}");
    client.event("stopped");
    let top = client.ok("stackTrace", json!({ "threadId": 1 }))["stackFrames"][0].clone();
    assert_eq!(top["source"]["path"], json!(source), "{top}");
    assert_eq!(client.bye("files_module"), Some(0));
    write(&source, &format!("// later\n{TWO_WAITS}"));
    let (mut client, answers) = begun(launch, &[(&source, 4)]);
    let why = answers[0]["message"].as_str().expect("it says why");
    assert!(answers[0]["verified"] == false && why.contains("has changed"), "{why}");
    client.event("stopped");
    let top = client.ok("stackTrace", json!({ "threadId": 1 }))["stackFrames"][0].clone();
    assert_eq!(top["source"]["path"], Value::Null, "{top}");
    let number = top["source"]["sourceReference"].clone();
    let shown = client.ok("source", json!({ "sourceReference": number }));
    assert_eq!(shown["content"], TWO_WAITS);
    let asked = json!({
        "source": { "sourceReference": number }, "breakpoints": [{ "line": 3 }],
    });
    assert_eq!(client.ok("setBreakpoints", asked)["breakpoints"][0]["verified"], true);
    client.go("continue", json!({}));
    assert_eq!(client.line(), 3);
    assert_eq!(client.bye("files_changed"), Some(0));
}

#[test]
fn relative_paths_are_from_the_folder_that_is_named() {
    let folder = scratch("cwd");
    write(&folder.join("b/main.obv"), TWO_WAITS);
    let launch = json!({ "program": "main.obv", "cwd": folder.join("b"), "stopOnEntry": true });
    let (mut client, _) = begun(launch, &[]);
    assert_eq!(client.event("stopped")["reason"], "entry");
    assert_eq!(client.bye("files_cwd"), Some(0));
}
