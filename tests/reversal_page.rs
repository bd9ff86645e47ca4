//! `docs/reversal.md` says which law, contract or test holds each word to what it promises: here,
//! that each is there, that no word of the language is missing from the page, and that what it says
//! has no inverse has none.

use obverse_compiler::{NoInverse, invert};
use obverse_syntax::codes::Code;
use std::path::Path;

const PAGE: &str = include_str!("../docs/reversal.md");
const LAWS: &str = include_str!("laws.rs");
const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The last columns of the tables that say what holds each row.
fn rows() -> Vec<&'static str> {
    tables("held by").filter_map(|line| line.trim_end_matches(" |").rsplit(" | ").next()).collect()
}

/// The rows of all tables whose last column has this head.
fn tables(head: &str) -> impl Iterator<Item = &'static str> {
    let mut is_in = false;
    PAGE.lines().filter(move |line| {
        let is_head = line.ends_with(&format!("| {head} |"));
        is_in = is_head || is_in && line.starts_with("| ");
        is_in && !is_head && !line.starts_with("| --- ")
    })
}

/// What is not part of a name.
fn is_between(of: char) -> bool {
    !of.is_alphanumeric() && of != '_'
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
    assert!(rows.len() >= 29, "{rows:?}");
    for row in rows {
        for held_by in row.split(", ") {
            let (kind, name) = held_by.split_once(' ').expect("a kind and a name");
            let name = name.trim_matches('`');
            let is_there = match kind {
                "law" => {
                    let folder = "crates/testkit/src";
                    let files = ["laws", "machine_laws", "word_laws", "invert_laws"];
                    let files = files.map(|file| format!("{folder}/{file}.rs"));
                    let is_run = LAWS.split(is_between).any(|word| word == name);
                    is_run && is_in(&files.each_ref().map(String::as_str), name)
                }
                "contract" => !text(&format!("tests/ops/{name}.obvasm")).is_empty(),
                "test" => {
                    let files = ["reversal_mistakes", "invert"];
                    let files = files.map(|file| format!("crates/compiler/tests/suite/{file}.rs"));
                    is_in(&files.each_ref().map(String::as_str), name)
                }
                _ => false,
            };
            assert!(is_there, "there is no {held_by}");
        }
    }
}

/// What the rows below take for granted.
const DECLARATIONS: &str = "\
joints a = [0, 0, 0, 0, 0, 0] deg
joints b = [1, 0, 0, 0, 0, 0] deg
error jam {}
advanced move feel { distance 20 mm down in base }
var n = 0
var m = 1
var gap = 1 mm
";

#[test]
fn what_has_no_inverse_is_refused() {
    let inverted = |body: &str| {
        let source = format!(
            "{DECLARATIONS}sequence work {{ move to a {body} }}\nsequence main {{ call work }}\n"
        );
        invert("work.obv", &source, "work")
    };
    assert!(inverted("toggle 2").is_ok(), "what is around the rows has an inverse");
    let rows: Vec<&str> = tables("since").filter_map(|row| row.split('`').nth(1)).collect();
    assert!(rows.len() >= 21, "{rows:?}");
    for row in rows {
        let Err(NoInverse::Diagnosed(found)) = inverted(row) else {
            panic!("{row} has an inverse")
        };
        let codes: Vec<Code> = found.iter().map(|found| found.code).collect();
        assert!(codes.iter().all(|code| *code == Code::NotInvertible), "{row}: {found:#?}");
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
