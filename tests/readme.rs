//! What the documents show is what the program prints: every `console` block of README.md is run.
//!
//! In a block a line that begins with `$ obverse` is a command, and what follows is its output up
//! to the next command. A line of three dots stands for any number of lines.

use std::path::Path;
use std::process::Command;

struct Example {
    line: usize,
    command: String,
    output: Vec<String>,
}

fn examples(text: &str) -> Vec<Example> {
    let mut examples: Vec<Example> = Vec::new();
    let mut is_console = false;
    for (index, line) in text.lines().enumerate() {
        if let Some(fence) = line.strip_prefix("```") {
            is_console = !is_console && fence == "console";
        } else if let Some(command) = line.strip_prefix("$ obverse ").filter(|_| is_console) {
            let command = command.to_owned();
            examples.push(Example { line: index + 1, command, output: Vec::new() });
        } else if let Some(example) = examples.last_mut().filter(|_| is_console) {
            example.output.push(line.to_owned());
        }
    }
    examples
}

/// Whether lines are those of a picture in which `...` stands for any number of them.
fn matches(picture: &[String], lines: &[&str]) -> bool {
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
fn the_examples_of_the_readme_are_what_is_printed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("README.md")).unwrap_or_default();
    let examples = examples(&text);
    assert!(examples.len() >= 3, "the readme shows the program at work");
    for example in examples {
        let output = Command::new(env!("CARGO_BIN_EXE_obverse"))
            .args(example.command.split_whitespace())
            .current_dir(root)
            .output();
        let output = match output {
            Ok(output) => output,
            Err(error) => panic!("{error}"),
        };
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        let printed = printed + &String::from_utf8_lossy(&output.stderr);
        let lines: Vec<&str> = printed.lines().collect();
        assert!(
            matches(&example.output, &lines),
            "README.md:{}: `obverse {}` prints\n{printed}",
            example.line,
            example.command
        );
    }
}
