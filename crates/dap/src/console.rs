//! What can be typed: what something is, and the few commands that the protocol has no word for.
//!
//! A text that is the name or the value of something is that; else it is a command.

use crate::debuggee::{Debuggee, Next, THREAD};
use crate::message::{Evaluate, Request};
use crate::motion::Going;
use crate::{shown, words};
use obverse_debugger::{Declined, Expression, Mode, Moment, Value as Known, Walk};
use obverse_vm::Direction;
use serde_json::json;

/// How many actions of the history are shown unless another number is asked for.
const SHOWN: usize = 20;

const HELP: &str = "\
help               this
why                what stops going back from here
history [N]        what the robot did last
rewind [MOMENT]    show what was: from here back, or at a moment; nothing is commanded
live               to where the run has come to, and go on from there
change WHAT        to before the last change of something: `change output 3`
error              to before the last error was raised
undo               undo the last jump
bookmark NAME      remember this moment
to NAME            to a bookmark
what-if            go on otherwise from here, in a copy of the workcell
set WHAT = VALUE   in a what-if, which begins here: give a variable or an input a value
leave              out of the what-if, back to the run
recover            at an error that is due: on until the run is past it, or it is given up
release            give the command without which nothing moves after a stop
Anything else is worked out: `x + 1`, `force > 5 N`, `output 3`, `held`, `time`, `steps`.";

/// What a command comes to.
enum Done {
    /// A value.
    Is(Known),
    Told(String),
    /// Another moment is shown.
    Moved(String),
    /// The run goes on.
    Goes(String),
}

impl Debuggee<'_, '_, '_> {
    pub(crate) fn evaluate(&mut self, request: &Request) -> Next {
        match request.given::<Evaluate>().and_then(|asked| self.evaluated(&asked)) {
            Ok(done) => {
                let (text, kind) = match &done {
                    Done::Is(value) => (&value.to_string(), shown::type_name(value)),
                    Done::Told(text) | Done::Moved(text) | Done::Goes(text) => (text, ""),
                };
                let body = json!({ "result": text, "type": kind, "variablesReference": 0 });
                self.server.out.answer(request, body);
                match done {
                    Done::Moved(_) => self.jumped(),
                    Done::Goes(_) => return self.goes_on(),
                    Done::Is(_) | Done::Told(_) => {}
                }
            }
            Err(why) => self.server.out.refuse(request, &why),
        }
        Next::Stay
    }

    /// The run goes on, for what is due, and a client that has not asked for it is told.
    fn goes_on(&mut self) -> Next {
        let body = json!({ "threadId": THREAD, "allThreadsContinued": true });
        self.server.out.event("continued", body);
        Next::Go(Going::new(&self.session, Direction::Forward, Walk::Recover))
    }

    /// What it comes to.
    fn evaluated(&mut self, asked: &Evaluate) -> Result<Done, String> {
        let module = self.session.module();
        let text = asked.expression.trim();
        let function = self.function_of(asked.frame_id);
        let error = match Expression::parse(module, function, text) {
            Ok(expression) => {
                let value = self.session.look(|look| expression.value(look));
                return Ok(Done::Is(value));
            }
            Err(error) => error,
        };
        if asked.context.as_deref() != Some("repl") {
            return Err(error.to_string());
        }
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let done = self.command(word, rest.trim(), function);
        done.unwrap_or_else(|| Err(format!("{error}; `help` tells what can be typed")))
    }

    /// What a command comes to; none if there is none of this name.
    fn command(&mut self, word: &str, rest: &str, function: usize) -> Option<Result<Done, String>> {
        Some(match word {
            "help" => Ok(Done::Told(HELP.to_owned())),
            "why" => Ok(Done::Told(self.why())),
            "history" => self.history(rest),
            "rewind" => self.rewind(rest),
            "live" => {
                self.session.go_to_end();
                Ok(self.here())
            }
            "change" => self.last_change(rest, function),
            "error" => self.session.go_to_last_error().map_err(text).map(|_| self.here()),
            "undo" => self.session.undo_jump().map_err(text).map(|()| self.here()),
            "bookmark" if rest.is_empty() => Err("a bookmark needs a name".to_owned()),
            "bookmark" => {
                self.session.bookmark(rest);
                Ok(Done::Told(format!("{rest} is moment {}", self.session.moment())))
            }
            "to" => self.session.go_to_bookmark(rest).map_err(text).map(|()| self.here()),
            "what-if" => self.session.what_if().map_err(text).map(|()| self.here()),
            "set" => self.set_by_hand(rest, function),
            "leave" => self.session.leave_what_if().map_err(text).map(|()| self.here()),
            "recover" => self.recovering(),
            "release" if !self.session.is_held() => Err("no stop holds the arm".to_owned()),
            "release" => {
                let released = self.session.release().map_err(text);
                released.map(|()| Done::Told("released".to_owned()))
            }
            _ => return None,
        })
    }

    fn here(&self) -> Done {
        let pc = self.session.machine().state().pc();
        let line = words::line(self.session.module(), pc);
        Done::Moved(format!("{}: {line}", words::mode(&self.session)))
    }

    fn recovering(&self) -> Result<Done, String> {
        self.refuse_moving()?;
        match self.session.mode() {
            Mode::Rewound => Err(Declined::NotLive.to_string()),
            _ if self.session.is_held() => Err(words::HELD.to_owned()),
            _ if self.session.is_recovering() => Ok(Done::Goes("recovering".to_owned())),
            _ => Err(Declined::NothingDue.to_string()),
        }
    }

    fn why(&self) -> String {
        let why = self.session.why();
        let Some(never) = why.never else {
            return format!("nothing stops going back; {} actions lie behind", why.actions);
        };
        let place = words::line(self.session.module(), never.pc);
        format!(
            "{} actions can be taken back; {place} cannot, at moment {}: {}",
            why.actions, never.moment, never.reason
        )
    }

    fn history(&self, rest: &str) -> Result<Done, String> {
        let count = match rest {
            "" => SHOWN,
            number => number.parse().map_err(|_| format!("`{number}` is no number of actions"))?,
        };
        let history = self.session.history();
        let begin = history.len().saturating_sub(count);
        let module = self.session.module();
        let line = |action: &obverse_debugger::session::Action| {
            let way = if action.direction == Direction::Reverse { "<-" } else { "->" };
            let place = words::line(module, action.pc);
            format!("{:>8} {way} {place}: {}", action.moment.to_string(), action.text)
        };
        let lines: Vec<String> = history[begin..].iter().map(line).collect();
        Ok(Done::Told(if lines.is_empty() { "nothing yet".to_owned() } else { lines.join("\n") }))
    }

    fn rewind(&mut self, rest: &str) -> Result<Done, String> {
        let moment = match rest {
            "" => self.session.moment(),
            number => Moment(number.parse().map_err(|_| format!("`{number}` is no moment"))?),
        };
        self.session.go_to(moment).map_err(text)?;
        Ok(self.here())
    }

    fn last_change(&mut self, rest: &str, function: usize) -> Result<Done, String> {
        let expression = Expression::parse(self.session.module(), function, rest).map_err(text)?;
        let change = self.session.go_to_last_change(&expression).map_err(text)?;
        let here = match self.here() {
            Done::Moved(here) | Done::Told(here) | Done::Goes(here) => here,
            Done::Is(value) => value.to_string(),
        };
        let (before, after) = (change.before, change.after);
        Ok(Done::Moved(format!("{here}: `{rest}` is {before}, and becomes {after}")))
    }

    fn set_by_hand(&mut self, rest: &str, function: usize) -> Result<Done, String> {
        let (name, value) =
            rest.split_once('=').ok_or("write `set WHAT = VALUE`, as in `set x = 3`")?;
        let name = name.trim();
        let named = Expression::parse(self.session.module(), function, name).map_err(text)?;
        let subjects = named.subjects();
        let subject = match subjects[..] {
            [subject] if subject.name(self.session.module()) == name => subject.clone(),
            _ => return Err(format!("`{name}` is nothing that can be given a value")),
        };
        let was_live = self.session.mode() != Mode::WhatIf;
        let value = self.assign(&subject, function, value)?;
        let told = format!("{name} is {value}");
        Ok(if was_live { Done::Moved(told) } else { Done::Told(told) })
    }
}

fn text(why: impl ToString) -> String {
    why.to_string()
}
