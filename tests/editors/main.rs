//! What editors are given is what the language has: the colours of Visual Studio Code are made from
//! the words of the lexer, its extension names what the command line has, and docs/editor.md shows
//! what the server says. `UPDATE=1 cargo test --test editors` writes the colours and the page.

mod colours;
mod page;

use serde_json::Value;
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
    let attributes = |request: &str| -> Vec<String> {
        let properties = &debugger["configurationAttributes"][request]["properties"];
        properties.as_object().expect("properties").keys().cloned().collect()
    };
    assert_eq!(debugger["type"], "obverse");
    assert_eq!(attributes("launch"), ["after", "program", "seed", "stopOnEntry", "workcell"]);
    assert_eq!(attributes("attach"), ["after", "program", "tape", "workcell"]);
}

/// Lock files name no place that packages come from: that is the business of who installs.
#[test]
fn the_lock_file_names_no_registry() {
    let lock = read("editors/vscode/package-lock.json");
    let named = lock.lines().find(|line| line.contains("\"resolved\""));
    assert_eq!(named, None);
    assert!(lock.contains("\"integrity\""), "what is installed is what was locked");
}
