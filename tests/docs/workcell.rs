//! What the reference of the workcell file owes that file: every key is there, and every example is
//! a workcell.

use crate::page::{Page, ROOT};
use obverse_sim::{Cell, Sim};
use std::collections::BTreeSet;
use std::path::Path;

/// What an example is added to that has no arm of its own.
const ARM: &str = "[arm]\nhome_rad = [0, -1.5, 1.5, -1.5, -1.5, 0]\n";

fn reference() -> Page {
    Page::read("docs/workcell.md")
}

/// The fields that serde reads, of every module of the workcell file.
fn keys() -> BTreeSet<String> {
    let folder = Path::new(ROOT).join("crates/sim/src/cell");
    let mut keys = BTreeSet::new();
    for entry in std::fs::read_dir(folder).expect("the modules of the workcell file") {
        let text = std::fs::read_to_string(entry.expect("an entry").path()).expect("a module");
        for structure in text.split("#[serde(deny_unknown_fields)]").skip(1) {
            let body = structure.split("\n}").next().unwrap_or_default();
            let fields = body.lines().filter_map(|line| line.trim().strip_prefix("pub(super) "));
            keys.extend(fields.filter_map(|field| Some(field.split_once(':')?.0.to_owned())));
        }
    }
    keys
}

#[test]
fn every_key_of_a_workcell_file_is_named() {
    let keys = keys();
    assert!(keys.len() > 70, "{keys:?}");
    let page = reference().text;
    let names: BTreeSet<&str> =
        page.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect();
    let missing: Vec<&String> = keys.iter().filter(|key| !names.contains(key.as_str())).collect();
    assert!(missing.is_empty(), "docs/workcell.md lacks {missing:?}");
}

#[test]
fn every_example_is_a_workcell_in_which_something_can_be_done() {
    let page = reference();
    let blocks = page.blocks();
    let examples: Vec<_> = blocks.iter().filter(|block| block.language() == "toml").collect();
    assert!(examples.len() > 8, "{} examples", examples.len());
    for block in examples {
        let text = block.text();
        let text = if text.contains("[arm]") { text } else { format!("{ARM}{text}") };
        match Cell::parse(&text) {
            Ok(cell) => assert!(Sim::new(&cell, 1).truth().len() < 9),
            Err(error) => panic!("{}:{}: {error}\n{text}", page.name, block.line),
        }
    }
}

/// A key that is in no example would be shown nowhere at work.
#[test]
fn every_key_is_in_an_example() {
    let page = reference();
    let blocks = page.blocks();
    let examples = blocks.iter().filter(|block| block.language() == "toml");
    let text: String = examples.map(crate::page::Block::text).collect();
    let words: BTreeSet<&str> =
        text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect();
    let missing: Vec<String> =
        keys().into_iter().filter(|key| !words.contains(key.as_str())).collect();
    assert!(missing.is_empty(), "no example has {missing:?}");
}
