//! Where commands come from: a line editor at a terminal; else a file or a pipe, whose lines are
//! shown behind the prompt as if they had been typed.

use super::complete::{Completer, Names};
use crate::problem::{Problem, plain};
use crate::write;
use rustyline::error::ReadlineError;
use rustyline::history::MemHistory;
use rustyline::{Config, Editor};
use std::fs::File;
use std::io::{BufRead, BufReader, IsTerminal, Read};
use std::path::Path;

/// The longest line, in bytes.
const MAX_LINE: u64 = 4096;

/// What is read.
pub(super) enum Line {
    /// A command without the blanks around it. From a terminal, it may be empty.
    Text(String),
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
                let Some(text) = read(from, number, name)? else { return Ok(Line::End) };
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

/// A line of a text, none behind its end.
fn read(
    from: &mut Box<dyn BufRead>,
    number: &mut usize,
    name: &str,
) -> Result<Option<String>, Problem> {
    *number += 1;
    let wrong = |why: String| {
        let message = crate::problem::Message::new(why).at(Some((*number, 1)));
        Problem::several(vec![crate::problem::Message { file: Some(name.to_owned()), ..message }])
    };
    let mut bytes = Vec::new();
    let read = from.take(MAX_LINE + 1).read_until(b'\n', &mut bytes);
    read.map_err(|error| wrong(plain(&error)))?;
    if bytes.len() as u64 > MAX_LINE {
        return Err(wrong(format!("a command is no longer than {MAX_LINE} bytes")));
    }
    if bytes.is_empty() {
        return Ok(None);
    }
    let text = String::from_utf8(bytes).map_err(|_| wrong("this is no text".to_owned()))?;
    Ok(Some(text.trim().to_owned()))
}
