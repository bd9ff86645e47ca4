//! What editors are given is what the language has: the colours of Visual Studio Code are made from
//! the words of the lexer, its extension names what the command line has, and docs/editor.md shows
//! what the server says. `UPDATE=1 cargo test --test editors` writes the colours and the page.

mod colours;
mod debugging;
mod page;

use obverse_dap::arguments::{ATTACH, Argument, LAUNCH};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn path(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file)
}

fn read(file: &str) -> String {
    std::fs::read_to_string(path(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

fn json(file: &str) -> Value {
    serde_json::from_str(&read(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// Whether files are to be written anew.
fn updates() -> bool {
    std::env::var_os("UPDATE").is_some()
}

/// That a file is as it would be made now; made anew if that is asked for.
fn check_made(file: &str, made: &str) {
    if updates() {
        std::fs::write(path(file), made).expect("the file can be written");
    }
    let is = read(file);
    let first = is.lines().zip(made.lines()).find(|(a, b)| a != b);
    assert!(is == made, "{file} is not what is made now: {first:?}; UPDATE=1 makes it anew");
}

#[test]
fn the_extension_speaks_of_what_there_is() {
    let manifest = json("editors/vscode/package.json");
    let language = &manifest["contributes"]["languages"][0];
    assert_eq!(language["extensions"][0], ".obv");
    for file in [&language["configuration"], &manifest["contributes"]["grammars"][0]["path"]] {
        let file = file.as_str().expect("a path").trim_start_matches("./");
        json(&format!("editors/vscode/{file}"));
    }
    assert_eq!(manifest["version"], env!("CARGO_PKG_VERSION"));
    let debugger = &manifest["contributes"]["debuggers"][0];
    assert_eq!(debugger["type"], "obverse");
    check_attributes(&debugger["configurationAttributes"]["launch"], LAUNCH);
    check_attributes(&debugger["configurationAttributes"]["attach"], ATTACH);
}

/// That an editor offers what the adapter understands, by the same names and in the same words.
fn check_attributes(offered: &Value, known: &[Argument]) {
    let properties = offered["properties"].as_object().expect("properties");
    let mut names: Vec<&str> = known.iter().map(|argument| argument.name).collect();
    let required = known.iter().filter(|argument| argument.is_required);
    let required: Vec<&str> = required.map(|argument| argument.name).collect();
    assert_eq!(offered["required"], json!(required));
    names.sort_unstable();
    assert_eq!(properties.keys().map(String::as_str).collect::<Vec<_>>(), names);
    for Argument { name, kind, about, .. } in known {
        let mut described = about.to_string();
        described[..1].make_ascii_uppercase();
        assert_eq!(properties[*name]["type"], kind.schema(), "{name}");
        assert_eq!(properties[*name]["description"], format!("{described}."), "{name}");
    }
}

/// Lock files name no place that packages come from: that is the business of who installs.
#[test]
fn the_lock_file_names_no_registry() {
    let lock = read("editors/vscode/package-lock.json");
    let named = lock.lines().find(|line| line.contains("\"resolved\""));
    assert_eq!(named, None);
    assert!(lock.contains("\"integrity\""), "what is installed is what was locked");
}
