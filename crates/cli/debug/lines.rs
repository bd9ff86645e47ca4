//! Where commands come from: a line editor at a terminal; else a file or a pipe, whose lines are
//! shown behind the prompt as if they had been typed.

use super::complete::{Completer, Names};
use crate::problem::{Message, Problem, plain};
use crate::write;
use rustyline::error::ReadlineError;
use rustyline::history::MemHistory;
use rustyline::{Config, Editor};
use std::fs::File;
use std::io::{BufRead, BufReader, IsTerminal, Read};
use std::path::Path;

/// The longest line, in bytes.
const MAX_LINE: u64 = 4096;

/// What tells that a file is text in UTF-8, if it does.
const MARK: &str = "\u{feff}";

/// What is read.
pub(super) enum Line {
    /// A command without the blanks around it. From a terminal, it may be empty.
    Text(String),
    /// A line that is no command, and why.
    Bad(String),
    /// There is no more.
    End,
}

/// Where commands come from.
pub(crate) enum Lines {
    Terminal(Box<Editor<Completer, MemHistory>>),
    Text { from: Box<dyn BufRead>, number: usize, name: String, is_shown: bool },
}

impl Lines {
    /// A file, or standard input.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(crate) fn of(file: Option<&Path>, is_json: bool) -> Result<Self, Problem> {
        let text = |from: Box<dyn BufRead>, name: String| Self::Text {
            from,
            number: 0,
            name,
            is_shown: !is_json,
        };
        if let Some(path) = file {
            let cannot = |why: std::io::Error| Problem::of_file(path, plain(&why));
            if path.is_dir() {
                return Err(Problem::of_file(path, "this is a folder; name a file of commands"));
            }
            let file = File::open(path).map_err(cannot)?;
            return Ok(text(Box::new(BufReader::new(file)), path.display().to_string()));
        }
        let is_terminal = std::io::stdin().is_terminal() && std::io::stdout().is_terminal();
        if is_json || !is_terminal {
            let stdin = BufReader::new(std::io::stdin());
            return Ok(text(Box::new(stdin), "standard input".to_owned()));
        }
        let cannot =
            |why: ReadlineError| Problem::new(format!("this terminal cannot be used: {why}"));
        let mut editor =
            Editor::with_history(Config::default(), MemHistory::new()).map_err(cannot)?;
        editor.set_helper(Some(Completer::default()));
        Ok(Self::Terminal(Box::new(editor)))
    }

    pub(crate) fn is_terminal(&self) -> bool {
        matches!(self, Self::Terminal(_))
    }

    /// Let the editor offer names, where there is one.
    pub(super) fn offer(&mut self, names: impl FnOnce() -> Names) {
        if let Self::Terminal(editor) = self
            && let Some(helper) = editor.helper_mut()
        {
            helper.offer(names());
        }
    }

    /// The next line.
    pub(super) fn next(&mut self, prompt: &str) -> Result<Line, Problem> {
        match self {
            Self::Terminal(editor) => Ok(typed(editor, prompt)),
            Self::Text { from, number, name, is_shown } => loop {
                *number += 1;
                let line = read(from).map_err(|error| unreadable(name, *number, &error))?;
                let text = match line {
                    Raw::End => return Ok(Line::End),
                    Raw::Bad(why) => {
                        if *is_shown {
                            write::line(prompt.trim_end());
                        }
                        return Ok(Line::Bad(format!("line {number} of {name} is {why}")));
                    }
                    // Editors mark the beginning of a text file.
                    Raw::Text(text) if *number == 1 => text.trim_start_matches(MARK).to_owned(),
                    Raw::Text(text) => text,
                };
                // A remark is shown, too: it is for who reads what was said.
                if *is_shown && !text.is_empty() {
                    write::line(&format!("{prompt}{text}"));
                }
                if !text.is_empty() && !text.starts_with('#') {
                    return Ok(Line::Text(text));
                }
            },
        }
    }
}

fn typed(editor: &mut Editor<Completer, MemHistory>, prompt: &str) -> Line {
    loop {
        match editor.readline(prompt) {
            Ok(text) => {
                let text = text.trim().to_owned();
                if !text.is_empty() {
                    // A line that is not remembered can be typed again.
                    let _ = editor.add_history_entry(&text);
                }
                return Line::Text(text);
            }
            // The line is dropped, and the session is not.
            Err(ReadlineError::Interrupted) => {}
            Err(_) => return Line::End,
        }
    }
}

fn unreadable(name: &str, number: usize, error: &std::io::Error) -> Problem {
    let message = Message::new(plain(error)).at(Some((number, 1)));
    Problem::several(vec![Message { file: Some(name.to_owned()), ..message }])
}

/// A line of a text.
#[derive(Debug, PartialEq)]
enum Raw {
    Text(String),
    /// What is there in place of a command.
    Bad(String),
    End,
}

/// The next line. One that is too long is gone over to its end, and not kept.
fn read(from: &mut impl BufRead) -> std::io::Result<Raw> {
    let mut bytes = Vec::new();
    if from.take(MAX_LINE).read_until(b'\n', &mut bytes)? == 0 {
        return Ok(Raw::End);
    }
    let is_whole = bytes.ends_with(b"\n");
    // What is missing of a line of just this length is its end.
    if !is_whole && from.skip_until(b'\n')? > 1 {
        return Ok(Raw::Bad(format!("longer than the {MAX_LINE} bytes of a command")));
    }
    Ok(match String::from_utf8(bytes) {
        Ok(text) => Raw::Text(text.trim().to_owned()),
        Err(_) => Raw::Bad("no text: its bytes are not UTF-8".to_owned()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(mut bytes: &[u8]) -> Vec<Raw> {
        std::iter::from_fn(|| read(&mut bytes).ok().filter(|line| *line != Raw::End)).collect()
    }

    #[test]
    fn a_bad_line_is_one_line_and_the_next_is_read() {
        let text = |text: &str| Raw::Text(text.to_owned());
        let most = "x".repeat(MAX_LINE as usize);
        assert_eq!(all(format!("{most}\nstep\n").as_bytes()), [text(&most), text("step")]);
        assert_eq!(all(most.as_bytes()), [text(&most)]);
        for more in [1, 4096, 100_000] {
            let long = "x".repeat(MAX_LINE as usize + more);
            let read = all(format!("{long}\nstep").as_bytes());
            assert!(matches!(&read[0], Raw::Bad(why) if why.contains("longer")), "{more}");
            assert_eq!(read[1..], [text("step")]);
        }
        let read = all(b"\xff\n\nstep\n");
        assert!(matches!(&read[0], Raw::Bad(why) if why.contains("UTF-8")));
        assert_eq!(read[1..], [text(""), text("step")]);
    }
}
