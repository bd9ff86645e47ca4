//! Blocks of the language `console`: commands, and what they print.
//!
//! A line that begins with `$ obverse` is a command, and what follows is its output up to the next
//! command. A line of three dots stands for any number of lines.

use crate::page::Block;
use std::io::Read;
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

/// What a command prints, on standard output and standard error, in the order of a terminal.
pub(crate) fn printed(command: &str, folder: &Path) -> String {
    let (mut reader, writer) = std::io::pipe().expect("a pipe");
    let mut child = Command::new(env!("CARGO_BIN_EXE_obverse"))
        .args(command.split_whitespace())
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(writer.try_clone().expect("a second end"))
        .stderr(writer)
        .spawn()
        .expect("the binary runs");
    let mut bytes = Vec::new();
    reader.read_to_end(&mut bytes).expect("what it prints");
    child.wait().expect("its end");
    String::from_utf8_lossy(&bytes).into_owned()
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
