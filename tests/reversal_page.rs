//! `docs/reversal.md` says which law, contract or test holds each word to what it promises: here,
//! that each is there, and that no word of the language is missing from the page.

use obverse_syntax::codes::Code;
use std::path::Path;

const PAGE: &str = include_str!("../docs/reversal.md");
const LAWS: &str = include_str!("laws.rs");
const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The last columns of the table.
fn rows() -> Vec<&'static str> {
    let lines = PAGE.lines().filter(|line| line.starts_with("| ")).skip(2);
    lines.filter_map(|line| line.trim_end_matches(" |").rsplit(" | ").next()).collect()
}

fn text(file: &str) -> String {
    std::fs::read_to_string(Path::new(ROOT).join(file)).unwrap_or_default()
}

/// Whether a function of this name is in one of these files.
fn is_in(files: &[&str], name: &str) -> bool {
    files.iter().any(|file| text(file).contains(&format!("fn {name}(")))
}

#[test]
fn every_row_is_held_by_something_that_exists() {
    let rows = rows();
    assert!(rows.len() >= 11, "{rows:?}");
    for row in rows {
        for held_by in row.split(", ") {
            let (kind, name) = held_by.split_once(' ').expect("a kind and a name");
            let name = name.trim_matches('`');
            let is_there = match kind {
                "law" => {
                    let folder = "crates/testkit/src";
                    let files = ["laws", "machine_laws", "word_laws"];
                    let files = files.map(|file| format!("{folder}/{file}.rs"));
                    let is_run = LAWS.split_whitespace().any(|word| word == name);
                    is_run && is_in(&files.each_ref().map(String::as_str), name)
                }
                "contract" => !text(&format!("tests/ops/{name}.obvasm")).is_empty(),
                "test" => is_in(&["crates/compiler/tests/suite/reversal_mistakes.rs"], name),
                _ => false,
            };
            assert!(is_there, "there is no {held_by}");
        }
    }
}

#[test]
fn every_word_of_reversal_has_a_row() {
    let words = [
        "reversible always",
        "} reverse ",
        "skip in reverse",
        "do {",
        "keep in reverse",
        "with speed",
        "force limit",
        "straight moves",
        "opposite force in reverse",
        "barrier",
        "irreversible",
    ];
    for word in words {
        assert!(PAGE.contains(word), "`{word}` is missing");
    }
}

#[test]
fn its_codes_are_codes() {
    let words = PAGE.split(|c: char| !c.is_ascii_alphanumeric());
    let is_code = |word: &&str| word.len() == 5 && word.starts_with("E0");
    for code in words.filter(is_code) {
        assert!(code.parse::<Code>().is_ok(), "{code}");
    }
}
