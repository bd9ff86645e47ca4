//! The debugger at a terminal: commands in words, answers in words or as JSON Lines.
//!
//! Reading order: [`table`], the commands; [`lines`], where they come from; `walk`, `until`,
//! `errors`, `stops`, `values`, `frames`, `displays`, `code` and `tries`, what each does with the
//! session; `complete`, what the line editor offers. It knows words and columns, and nothing of how
//! a moment is reached.

mod code;
mod complete;
mod displays;
mod errors;
mod frames;
mod lines;
mod stops;
mod table;
mod tries;
mod until;
mod values;
mod walk;

pub(crate) use lines::Lines;

use crate::commands::reach::margin::Margin;
use crate::problem::Problem;
use crate::{recovering, show, write};
use code::Listed;
use displays::Displays;
use lines::Line;
use obverse_bytecode::Module;
use obverse_debugger::{Mode, Session};
use obverse_geometry::Pose;
use obverse_recovery::Memory;
use obverse_sim::Sim;
use serde_json::{Map, Value, json};

/// What answers look like.
#[derive(Clone, Copy)]
pub(crate) struct Face {
    is_json: bool,
    is_coloured: bool,
}

impl Face {
    /// For machines, or for people, in colours where they can be seen.
    pub(crate) fn of(is_json: bool) -> Self {
        Self { is_json, is_coloured: !is_json && show::is_coloured(&std::io::stdout()) }
    }
}

/// What came of a command.
#[derive(Default)]
struct Answer {
    /// For people; coloured, if the face is.
    lines: Vec<String>,
    /// For machines, beside the same lines and the position.
    data: Map<String, Value>,
}

impl Answer {
    fn line(text: impl Into<String>) -> Self {
        Self::lines(vec![text.into()])
    }

    fn lines(lines: Vec<String>) -> Self {
        Self { lines, data: Map::new() }
    }

    /// The same with something for machines.
    fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.data.insert(name.to_owned(), value.into());
        self
    }

    /// The same with several things for machines.
    fn with_all(mut self, data: Map<String, Value>) -> Self {
        self.data.extend(data);
        self
    }
}

/// An answer, or why the command was not carried out.
type Done = Result<Answer, String>;

/// A session, and what its commands need beside it.
pub(crate) struct Front<'p> {
    session: Session<'p, Sim>,
    module: &'p Module,
    margin: Margin,
    /// Of a recording, where its tools' centre points are on the tool mount, if that is known.
    tcps: Vec<Pose>,
    face: Face,
    listed: Option<Listed>,
    /// How far out the call is that is looked at, from the innermost.
    selected: usize,
    displays: Displays,
    /// How often an arm that is held is still released without a command.
    releases_left: u32,
    /// Whether it was told once how one goes on from an error.
    is_told_how: bool,
    is_over: bool,
}

impl<'p> Front<'p> {
    pub(crate) fn over(
        session: Session<'p, Sim>,
        tcps: Vec<Pose>,
        (face, releases): (Face, u32),
    ) -> Self {
        let module = session.module();
        let margin = Margin::of(module);
        Self {
            session,
            module,
            margin,
            tcps,
            face,
            listed: None,
            selected: 0,
            displays: Displays::default(),
            releases_left: releases,
            is_told_how: false,
            is_over: false,
        }
    }

    /// What was learned of errors.
    pub(crate) fn memory(&self) -> &Memory {
        self.session.memory()
    }

    /// Carry out commands until there are no more. How many were not.
    ///
    /// # Errors
    /// What of the input cannot be read.
    pub(crate) fn converse(&mut self, lines: &mut Lines) -> Result<usize, Problem> {
        let (mut carried_out, mut failed) = (0_usize, 0);
        if !self.face.is_json {
            self.say(&[self.place_line()]);
        }
        let mut last = String::new();
        while !self.is_over {
            lines.offer(|| complete::names(self));
            let line = match lines.next(&self.prompt())? {
                Line::End => break,
                // As people know it: nothing is the last command again.
                Line::Text(text) if text.is_empty() => last.clone(),
                Line::Bad(why) => {
                    failed += 1;
                    self.tell("", Err(why));
                    continue;
                }
                Line::Text(text) => text,
            };
            if line.is_empty() {
                continue;
            }
            let done = self.obey(&line);
            carried_out += usize::from(done.is_ok());
            failed += usize::from(done.is_err());
            self.tell(&line, done);
            last = line;
        }
        if self.face.is_json {
            let summary = json!({
                "type": "summary",
                "outcome": "left",
                "carried_out": carried_out,
                "failed": failed,
                "held": self.session.is_held(),
                "incidents": recovering::incidents(self.module, self.session.incidents()),
                "position": self.position(),
            });
            write::line(&summary.to_string());
        }
        Ok(failed)
    }

    fn obey(&mut self, line: &str) -> Done {
        // What follows a stroke follows the name: `x/5i`.
        let is_end = |c: char| c.is_whitespace() || c == '/';
        let (word, rest) = line.split_at(line.find(is_end).unwrap_or(line.len()));
        let command = table::find(word)?;
        self.session.begin_command();
        (command.run)(self, rest.trim())
    }

    fn tell(&mut self, line: &str, done: Done) {
        let told = self.session.take_told();
        if !self.face.is_json {
            told.iter().for_each(|(id, text)| self.say(&[format!("{id}: {text}")]));
            match done {
                Ok(answer) => self.say(&answer.lines),
                Err(why) => self.say(&[format!("not done: {why}")]),
            }
            return;
        }
        let told: Vec<Value> =
            told.iter().map(|(id, text)| json!({ "breakpoint": id, "text": text })).collect();
        let mut object = json!({
            "type": "answer",
            "command": line,
            "done": done.is_ok(),
            "told": told,
            "position": self.position(),
        });
        match done {
            Ok(answer) => {
                object["text"] = json!(answer.lines);
                answer.data.into_iter().for_each(|(name, value)| object[name] = value);
            }
            Err(why) => object["why"] = json!(why),
        }
        write::line(&object.to_string());
    }

    fn say(&self, lines: &[String]) {
        for line in lines {
            match self.face.is_coloured {
                true => write::coloured(&format!("{line}\n")),
                false => write::line(line),
            }
        }
    }

    /// `(17 rewound) `, `(17 what-if rewound) `, and of one within another `(17 what-if 2) `.
    fn prompt(&self) -> String {
        let mode = self.session.mode();
        let mut words = match self.session.tries() {
            0 => mode.name().to_owned(),
            1 => Mode::WhatIf.name().to_owned(),
            tries => format!("{} {tries}", Mode::WhatIf.name()),
        };
        if self.session.tries() > 0 && mode == Mode::Rewound {
            words = format!("{words} {}", mode.name());
        }
        format!("({} {words}) ", self.session.moment())
    }

    /// Another moment is shown: nothing of it was looked at yet.
    fn moved(&mut self) {
        (self.listed, self.selected) = (None, 0);
    }

    /// Where the session stands, for machines.
    fn position(&self) -> Value {
        let position = self.session.position();
        let place = position.place.as_ref();
        json!({
            "mode": position.mode.name(),
            "tries": self.session.tries(),
            "moment": position.moment.0,
            "end": position.end.0,
            "steps": position.steps,
            "instruction": position.pc,
            "file": place.map(|place| &place.file),
            "line": place.map(|place| place.line),
            "column": place.map(|place| place.column),
            "function": position.function,
            "calls": position.depth,
            "time_s": position.now_s,
        })
    }
}
