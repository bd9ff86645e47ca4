//! What the reference of the language owes the grammar: every rule with all its alternatives, word,
//! unit and key is there.

use crate::grammar::Grammar;
use crate::page::{Page, ROOT};
use obverse_syntax::{FREE_WORDS, RESERVED_WORDS, UNITS};
use std::collections::BTreeSet;
use std::path::Path;

fn reference() -> Page {
    Page::read("docs/language.md")
}

fn source(file: &str) -> String {
    std::fs::read_to_string(Path::new(ROOT).join(file)).expect("a file of the project")
}

fn fails(missing: &[&str], of: &str) {
    assert!(missing.is_empty(), "docs/language.md lacks {of}: {missing:?}");
}

/// The words of all examples, without comments and texts in quotes.
fn words() -> BTreeSet<String> {
    let page = reference();
    let blocks = page.blocks();
    let examples = blocks.iter().filter(|block| block.language() == "obv");
    let lines = examples.flat_map(|block| block.lines.iter());
    let mut words = BTreeSet::new();
    for line in lines {
        let code = line.split("//").next().unwrap_or_default();
        for part in code.split('"').step_by(2) {
            let parts = part.split(|c: char| !c.is_ascii_alphanumeric() && c != '_' && c != '/');
            words.extend(parts.map(str::to_owned));
        }
    }
    words
}

#[test]
fn every_rule_of_the_grammar_is_named() {
    let grammar = source("crates/syntax/GRAMMAR.md");
    let rules = grammar.split("```ebnf").nth(1).and_then(|rest| rest.split("```").next());
    let heads = rules.expect("the page has rules").lines().filter_map(|line| {
        let (name, _) = line.split_once('=')?;
        let name = name.trim();
        (!line.starts_with(' ') && name.bytes().all(|b| b.is_ascii_lowercase() || b == b'_'))
            .then_some(name)
    });
    let heads: Vec<&str> = heads.collect();
    assert!(heads.len() > 20, "{heads:?}");
    let page = reference().text;
    let missing: Vec<&str> =
        heads.into_iter().filter(|rule| !page.contains(&format!("`{rule}`"))).collect();
    fails(&missing, "rules");
}

#[test]
fn every_alternative_of_every_rule_is_in_an_example() {
    let grammar = Grammar::of_page(&source("crates/syntax/GRAMMAR.md"));
    let page = reference();
    let mut used = BTreeSet::new();
    for block in page.blocks().iter().filter(|block| block.language() == "obv") {
        if block.says("wrong") {
            continue;
        }
        let rule = if block.says("statements") { "statement" } else { "program" };
        match grammar.used(rule, &block.text()) {
            Ok(parts) => used.extend(parts),
            Err(rest) => panic!("{}:{}: no {rule}: {rest}", page.name, block.line),
        }
    }
    let missing: Vec<&str> = (0..grammar.parts.len())
        .filter(|part| !used.contains(part))
        .map(|part| grammar.parts[part].as_str())
        .collect();
    fails(&missing, "alternatives");
}

#[test]
fn every_word_of_the_language_is_in_an_example() {
    let words = words();
    let known = RESERVED_WORDS.iter().chain(FREE_WORDS);
    let missing: Vec<&str> = known.copied().filter(|word| !words.contains(*word)).collect();
    fails(&missing, "words");
}

#[test]
fn every_unit_is_in_an_example() {
    // Numbers may stand close to their units.
    let words: BTreeSet<String> = words()
        .iter()
        .map(|word| word.trim_start_matches(|c: char| c.is_numeric()).to_owned())
        .collect();
    let missing: Vec<&str> = UNITS.iter().copied().filter(|unit| !words.contains(*unit)).collect();
    fails(&missing, "units");
}
