//! What the documents show is true: every example in them is compiled and run, every command prints
//! what is shown, and what the reader is told to write works when it is written.
//!
//! `UPDATE=1 cargo test --test docs` writes what commands print now into the pages, wherever a
//! picture has no line of three dots. How a block is meant, the words behind its fence say: see
//! `example`, `reader` and `console`.

mod assembly;
mod console;
mod example;
mod grammar;
mod library;
mod page;
mod reader;
mod words;
mod workcell;

use page::{Block, Page};
use reader::Reader;

/// Blocks that show something else than the language and its commands.
const OTHER_LANGUAGES: [&str; 5] = ["toml", "text", "sh", "ebnf", "layers"];

/// Read a page as its reader does, from the beginning to the end; what is wrong with it.
fn follow(page: &Page) -> Vec<String> {
    let mut reader = Reader::of(page);
    let mut prelude = String::new();
    let mut findings = Vec::new();
    for block in &page.blocks() {
        let mut note =
            |what: String| findings.push(format!("{}:{}: {what}", page.name, block.line));
        if let Err(why) = reader.write(block) {
            note(why);
        }
        match block.language() {
            "console" => shown(block, &reader).into_iter().for_each(&mut note),
            "obv" if block.says("prelude") => prelude = block.text(),
            "obv" if is_of_reader(block) => {}
            "obv" => {
                if let Err(why) = example::check(block, &prelude, &reader) {
                    note(why);
                }
            }
            "obvasm" => {
                if let Err(why) = assembly::check(&block.text()) {
                    note(why);
                }
            }
            other if OTHER_LANGUAGES.contains(&other) => {}
            other => note(format!("`{other}` is no language of a block")),
        }
    }
    findings
}

/// Whether a block is part of a file, which the commands after it speak of.
fn is_of_reader(block: &Block<'_>) -> bool {
    ["file", "change", "add"].iter().any(|word| block.says(word))
}

/// What commands print that their pictures do not show.
fn shown(block: &Block<'_>, reader: &Reader) -> Vec<String> {
    let examples = console::examples(block).into_iter();
    let wrong = examples.filter_map(|example| {
        let printed = console::printed(example.command, reader.place());
        let lines: Vec<&str> = printed.lines().collect();
        let is_shown = console::matches(&example.output, &lines);
        (!is_shown).then(|| format!("`obverse {}` prints\n{printed}", example.command))
    });
    wrong.collect()
}

/// The page with what its commands print now.
fn updated(page: &Page) -> String {
    let mut reader = Reader::of(page);
    let mut pictures = Vec::new();
    for block in &page.blocks() {
        if reader.write(block).is_ok() && block.language() == "console" {
            let range = block.line..block.line + block.lines.len();
            pictures.push((range, picture(block, &reader)));
        }
    }
    let mut lines: Vec<String> = page.text.lines().map(str::to_owned).collect();
    for (range, picture) in pictures.into_iter().rev() {
        lines.splice(range, picture);
    }
    lines.iter().flat_map(|line| [line, "\n"]).collect()
}

/// The lines of a block with what its commands print now, but for what is shown in part.
fn picture(block: &Block<'_>, reader: &Reader) -> Vec<String> {
    let mut lines = Vec::new();
    for example in console::examples(block) {
        lines.push(format!("$ obverse {}", example.command));
        let printed = console::printed(example.command, reader.place());
        match example.output.iter().any(|line| line.trim() == "...") {
            true => lines.extend(example.output.iter().map(|line| (*line).to_owned())),
            false => lines.extend(printed.lines().map(|line| line.trim_end().to_owned())),
        }
    }
    lines
}

#[test]
fn every_page_is_true() {
    if std::env::var_os("UPDATE").is_some() {
        for page in Page::all() {
            let text = updated(&page);
            if text != page.text {
                std::fs::write(page.path(), text).expect("the page can be written");
            }
        }
    }
    let findings: Vec<String> = Page::all().iter().flat_map(follow).collect();
    assert!(findings.is_empty(), "{} findings:\n{}", findings.len(), findings.join("\n"));
}

#[test]
fn the_readme_shows_the_program_at_work() {
    let page = Page::read("README.md");
    let commands = page.blocks().iter().filter(|block| block.language() == "console").count();
    assert!(commands >= 3, "{commands} commands");
}
