//! Blocks of the language `console`: commands, and what they print.
//!
//! A line that begins with `$ obverse` is a command, and what follows is its output up to the next
//! command. A line of three dots stands for any number of lines.

use crate::page::Block;
use std::path::Path;
use std::process::{Command, Stdio};

/// A command and its picture.
pub(crate) struct Example<'p> {
    /// What follows `obverse`.
    pub(crate) command: &'p str,
    pub(crate) output: Vec<&'p str>,
}

pub(crate) fn examples<'p>(block: &Block<'p>) -> Vec<Example<'p>> {
    let mut examples: Vec<Example<'p>> = Vec::new();
    for line in &block.lines {
        match (line.strip_prefix("$ obverse "), examples.last_mut()) {
            (Some(command), _) => examples.push(Example { command, output: Vec::new() }),
            (None, Some(example)) => example.output.push(line),
            (None, None) => panic!("line {}: a block begins with `$ obverse`", block.line),
        }
    }
    examples
}

/// What a command prints: first on standard output, then on standard error.
pub(crate) fn printed(command: &str, folder: &Path) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_obverse"))
        .args(command.split_whitespace())
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .expect("the binary runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}

/// Whether lines are those of a picture.
pub(crate) fn matches(picture: &[&str], lines: &[&str]) -> bool {
    match picture.split_first() {
        None => lines.is_empty(),
        Some((first, rest)) if first.trim() == "..." => {
            (0..=lines.len()).any(|skipped| matches(rest, &lines[skipped..]))
        }
        Some((first, rest)) => match lines.split_first() {
            Some((line, more)) => line.trim_end() == first.trim_end() && matches(rest, more),
            None => false,
        },
    }
}

#[test]
fn dots_stand_for_any_number_of_lines() {
    assert!(matches(&["a", "...", "d"], &["a", "b", "c", "d"]));
    assert!(matches(&["a", "...", "d"], &["a", "d"]));
    assert!(!matches(&["a", "...", "d"], &["a", "b", "c"]));
    assert!(!matches(&["a"], &["a", "b"]));
}
