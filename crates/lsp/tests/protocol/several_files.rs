//! Programs of several files: what is open counts, and else what lies on the disk.

use crate::support::{Editor, FOLDER, Texts, marked, uri};
use serde_json::{Value, json};
use std::sync::{Arc, Mutex};

const POSES: &str = "joints home = [0, 0, 0, 0, 0, 0] deg\n";
const MAIN: &str = "import \"cell/poses.obv\"\nsequence main {\n  move to «home»\n}\n";

fn disk(files: &[(&str, &str)]) -> Texts {
    let path = |name: &str| format!("{FOLDER}/{name}");
    let texts = files.iter().map(|(name, text)| (path(name), (*text).to_owned())).collect();
    Texts(Arc::new(Mutex::new(texts)))
}

#[test]
fn a_file_on_the_disk_is_imported() {
    let (text, places) = marked(MAIN);
    let mut editor = Editor::with_disk(disk(&[("cell/poses.obv", POSES)]));
    editor.open("main.obv", &text);
    assert_eq!(editor.diagnostics("main.obv"), Vec::<Value>::new());
    let found = editor.at("definition", "main.obv", places[0]["start"].clone()).expect("it leads");
    assert_eq!(found[0]["uri"], uri("cell/poses.obv"));
    assert_eq!(found[0]["range"]["start"], json!({ "line": 0, "character": 7 }));
    let import = json!({ "line": 0, "character": 12 });
    let found = editor.at("definition", "main.obv", import).expect("it leads");
    assert_eq!(found[0]["uri"], uri("cell/poses.obv"));
}

#[test]
fn what_is_open_counts_before_it_is_saved() {
    let (text, _) = marked(MAIN);
    let mut editor = Editor::with_disk(disk(&[("cell/poses.obv", POSES)]));
    editor.open("main.obv", &text);
    editor.open("cell/poses.obv", &POSES.replace("home", "rest"));
    let found = editor.diagnostics("main.obv");
    let found = if found.is_empty() { editor.diagnostics("main.obv") } else { found };
    assert_eq!(found[0]["code"], "E0101");
    let document = json!({ "uri": uri("cell/poses.obv") });
    editor.tell("textDocument/didClose", json!({ "textDocument": document }));
    assert_eq!(editor.diagnostics("main.obv"), Vec::<Value>::new());
}

#[test]
fn a_file_that_was_never_saved_is_imported() {
    let (text, _) = marked(MAIN);
    let mut editor = Editor::new();
    editor.open("cell/poses.obv", POSES);
    editor.open("main.obv", &text);
    assert_eq!(editor.diagnostics("main.obv"), Vec::<Value>::new());
}

/// A part of a program is no program; it is looked at with what imports it, open or not.
#[test]
fn a_part_is_looked_at_with_the_program_that_imports_it() {
    let (text, _) = marked(MAIN);
    let mut editor = Editor::with_disk(disk(&[("main.obv", &text), ("cell/poses.obv", POSES)]));
    editor.open("cell/poses.obv", POSES);
    assert_eq!(editor.diagnostics("cell/poses.obv"), Vec::<Value>::new());
    let params = json!({
        "textDocument": { "uri": uri("cell/poses.obv") },
        "position": { "line": 0, "character": 8 },
        "context": { "includeDeclaration": false },
    });
    let found = editor.ask("textDocument/references", params).expect("a list");
    assert_eq!(found[0]["uri"], uri("main.obv"));
}

#[test]
fn a_rename_reaches_every_program_that_shares_the_file() {
    let (text, places) = marked(MAIN);
    let other = text.replace("main", "other");
    let files = [("main.obv", &*text), ("other.obv", &*other), ("cell/poses.obv", POSES)];
    let mut editor = Editor::with_disk(disk(&files));
    editor.open("cell/poses.obv", POSES);
    let rename = |name: &str| {
        json!({
            "textDocument": { "uri": uri("cell/poses.obv") },
            "position": { "line": 0, "character": 8 },
            "newName": name,
        })
    };
    let edit = editor.ask("textDocument/rename", rename("rest")).expect("it is renamed");
    let changes = edit["changes"].as_object().expect("files");
    assert_eq!(changes.len(), 3, "{changes:?}");
    assert_eq!(changes[&uri("main.obv")][0]["range"], places[0]);
    assert_eq!(changes[&uri("other.obv")][0]["newText"], "rest");
    // `other` is a name of one of the programs alone.
    let refused = editor.ask("textDocument/rename", rename("other")).expect_err("refused").1;
    assert!(refused.contains("a sequence of the name `other`"), "{refused}");
}

#[test]
fn a_mistake_in_an_imported_file_is_told_there_and_taken_back() {
    let mut editor = Editor::with_disk(disk(&[("poses.obv", "joints home = [1] deg\n")]));
    editor.open("main.obv", "import \"poses.obv\"\nsequence main {\n  move to home\n}\n");
    assert_eq!(editor.diagnostics("poses.obv")[0]["code"], "E0205");
    editor.change("main.obv", json!([{ "text": "sequence main {\n  wait 1 s\n}\n" }]));
    assert_eq!(editor.diagnostics("poses.obv"), Vec::<Value>::new());
}

#[test]
fn a_file_that_appears_on_the_disk_is_noticed() {
    let disk = disk(&[]);
    let mut editor = Editor::with_disk(disk.clone());
    editor.open("main.obv", "import \"poses.obv\"\nsequence main {\n  move to home\n}\n");
    assert_eq!(editor.diagnostics("main.obv")[0]["code"], "E0501");
    disk.0.lock().expect("no panic").insert(format!("{FOLDER}/poses.obv"), POSES.to_owned());
    let change = json!({ "uri": uri("poses.obv"), "type": 1 });
    editor.tell("workspace/didChangeWatchedFiles", json!({ "changes": [change] }));
    assert_eq!(editor.diagnostics("main.obv"), Vec::<Value>::new());
}

#[test]
fn the_library_can_be_read() {
    let (text, places) = marked("import library \"«press»\"\nsequence main { call press() }\n");
    let mut editor = Editor::new();
    editor.open("main.obv", &text);
    let found = editor.at("definition", "main.obv", places[0]["start"].clone()).expect("it leads");
    let address = found[0]["uri"].clone();
    assert_eq!(address, "obverse-library:press.obv");
    let text = editor.ask("obverse/library", json!({ "uri": address })).expect("a text");
    assert!(text.as_str().is_some_and(|text| text.contains("action press")), "{text}");
    let unknown = editor.ask("obverse/library", json!({ "uri": "obverse-library:x" }));
    assert_eq!(unknown.map_err(|(code, _)| code), Err(-32602));
}
