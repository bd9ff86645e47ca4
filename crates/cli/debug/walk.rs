//! Walking and jumping, and what is said of where that led.

use super::{Answer, Done, Front, errors, values};
use crate::report;
use obverse_bytecode::FunctionKind;
use obverse_debugger::recording::Moment;
use obverse_debugger::{Change, Grain, Halt, Mode, Walk};
use obverse_recovery::drive::ending;
use obverse_vm::{Direction, Stop};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// More steps than these are no count.
const MAX_COUNT: u32 = 1_000_000;

/// A count behind a command; 1 if there is none.
fn count(text: &str) -> Result<u32, String> {
    match text.parse() {
        _ if text.is_empty() => Ok(1),
        Ok(count @ 1..=MAX_COUNT) => Ok(count),
        _ => Err(format!("`{text}` is no count: say a number from 1 to {MAX_COUNT}, or nothing")),
    }
}

pub(super) fn go(front: &mut Front<'_>, rest: &str, direction: Direction, walk: Walk) -> Done {
    let count = count(rest)?;
    // Those that stop once are gone when they have.
    let names = front.breakpoint_names();
    let mut halt = Halt::Done;
    for made in 0..count {
        halt = match direction {
            Direction::Forward => front.go_on(walk),
            Direction::Reverse => front.drive(|session| session.go(direction, walk)),
        };
        let goes_on = match walk {
            Walk::Continue => matches!(halt, Halt::Hits(_) | Halt::Stopped(Stop::Due { .. })),
            _ => halt == Halt::Done,
        };
        if !goes_on || made + 1 == count {
            break;
        }
        if front.session.take_interrupt() {
            halt = Halt::Interrupted;
            break;
        }
    }
    Ok(walked(front, &halt, direction, &names))
}

/// Into the first sequence, where that is still to come.
pub(super) fn enter(front: &mut Front<'_>) -> Option<Done> {
    let step = Walk::Step(Grain::Statement);
    front.is_in_start().then(|| go(front, "", Direction::Forward, step))
}

/// Where a walk has led, and why it ended.
pub(super) fn walked(
    front: &mut Front<'_>,
    halt: &Halt,
    direction: Direction,
    names: &BTreeMap<u32, String>,
) -> Answer {
    front.moved();
    let mut lines = front.halt_words(halt, direction, names);
    lines.push(front.place_line());
    let is_recovering = front.session.is_recovering();
    let mut answer = Answer::lines(lines)
        .with("halt", halt_code(halt))
        .with("recovering", is_recovering)
        .with("next", errors::intent(front, halt));
    if let Halt::Hits(hits) = halt {
        let ids: Vec<u32> = hits.iter().map(|hit| hit.id).collect();
        answer = answer.with("breakpoints", ids).with("hits", values::hits(hits, names));
    }
    if let Some(refusal) = halt.refusal() {
        answer = answer.with("stopped_at", report::place(front.module, Some(refusal.pc)));
    }
    front.shown(answer)
}

/// Why a walk ended, for machines.
fn halt_code(halt: &Halt) -> &'static str {
    match halt {
        Halt::Done => "done",
        Halt::Hits(_) => "breakpoint",
        Halt::Stopped(Stop::Finished) => "finished",
        Halt::Stopped(Stop::Refused(_)) => "refused",
        Halt::Stopped(Stop::Fault { .. }) => "fault",
        Halt::Stopped(Stop::Trap(_)) => "trap",
        Halt::Stopped(Stop::Due { .. } | Stop::Raised { .. }) => "error",
        Halt::Stopped(Stop::AtStart | Stop::AtMark | Stop::OffMark) => "start",
        Halt::Stopped(Stop::Budget) | Halt::Limit => "limit",
        Halt::Ended(ending) => ending.code(),
        Halt::Held => "held",
        Halt::Changed => "changed",
        Halt::EndOfRecording => "end_of_recording",
        Halt::StartOfRecording => "start_of_recording",
        Halt::Interrupted => "interrupted",
        Halt::Lost => "lost",
    }
}

impl Front<'_> {
    /// Why a walk ended, in words; none if it did what it was to do.
    fn halt_words(
        &mut self,
        halt: &Halt,
        direction: Direction,
        names: &BTreeMap<u32, String>,
    ) -> Vec<String> {
        let line = match halt {
            Halt::Done => return Vec::new(),
            Halt::Hits(hits) => {
                let words = |hit: &obverse_debugger::Hit| {
                    let name = names.get(&hit.id).map_or("", String::as_str);
                    match &hit.change {
                        Some((was, is)) => {
                            format!("watch {}: {name} was {was} and is {is}", hit.id)
                        }
                        None => format!("breakpoint {}: {name}", hit.id),
                    }
                };
                return hits.iter().map(words).collect();
            }
            Halt::Stopped(stop) => return self.stop_words(stop, direction),
            Halt::Ended(_) | Halt::Held => return errors::halted(self, halt),
            Halt::Changed => "a variable was changed by hand here, and no record leads back over \
                              it; `leave` goes back to the run as it was"
                .to_owned(),
            Halt::EndOfRecording => match self.session.run().cell() {
                Some(_) => "this is where the run has come to; `goto end` makes it live again",
                None => "this is where the recording ends",
            }
            .to_owned(),
            Halt::StartOfRecording => "this is the start".to_owned(),
            Halt::Limit => "it has run as many instructions as one command may; `--limit` sets \
                            another number, and the command again goes on"
                .to_owned(),
            Halt::Interrupted => "interrupted".to_owned(),
            Halt::Lost => "the recording does not fit the program".to_owned(),
        };
        vec![line]
    }

    fn stop_words(&mut self, stop: &Stop, direction: Direction) -> Vec<String> {
        match stop {
            Stop::Due { error, pc } | Stop::Raised { error, pc } => {
                return self.due_words(error.index(), *pc);
            }
            Stop::AtStart if direction == Direction::Forward => return Vec::new(),
            _ => {}
        }
        let ending = ending(stop.clone(), self.session.machine());
        let mut lines = ending.map(|ending| self.end_words(&ending)).unwrap_or_default();
        match stop {
            Stop::Fault { .. } | Stop::Trap(_) => lines.extend(self.fault_words(direction)),
            Stop::Refused(_) => {
                let hint = "`goto` and `last` show what was before, and command nothing";
                lines.push(hint.to_owned());
            }
            _ => {}
        }
        lines
    }

    /// On. What is before the first sequence is written nowhere: a walk does not end there, and
    /// goes into that sequence, since behind it is nothing.
    fn go_on(&mut self, walk: Walk) -> Halt {
        let (is_start, walk) = match walk {
            Walk::Step(Grain::Statement) | Walk::Next(Grain::Statement) if self.is_in_start() => {
                (true, Walk::Step(Grain::Statement))
            }
            _ => (false, walk),
        };
        loop {
            let halt = self.drive(|session| session.go(Direction::Forward, walk));
            if !is_start || halt != Halt::Done || !self.is_in_start() {
                return halt;
            }
            if self.session.take_interrupt() {
                return Halt::Interrupted;
            }
        }
    }

    fn is_in_start(&self) -> bool {
        let here = self.module.function_at(self.session.machine().state().pc());
        let function = here.and_then(|index| self.module.functions.get(index));
        function.is_some_and(|function| function.kind == FunctionKind::Start)
    }

    /// What a jump led to.
    pub(super) fn jumped(&mut self, mut lines: Vec<String>) -> Answer {
        self.moved();
        lines.push(self.place_line());
        self.shown(Answer::lines(lines))
    }
}

pub(super) fn goto(front: &mut Front<'_>, rest: &str) -> Done {
    let session = &mut front.session;
    let said = |why: obverse_debugger::Declined| why.to_string();
    let before_error = |session: &mut obverse_debugger::Session<'_, _>| {
        let none = || "no error was raised before this moment".to_owned();
        session.go_to_last_error().map_err(|why| why.words_or(none))
    };
    match rest {
        "" => return Err("say where to: a moment, start, end, error, or a name".to_owned()),
        "end" => session.go_to_end(),
        "start" => session.go_to(Moment(0)).map_err(said)?,
        "error" => drop(before_error(session)?),
        _ if rest.starts_with(|c: char| c.is_ascii_digit()) => {
            let moment = rest.parse().map_err(|_| format!("`{rest}` is no moment"))?;
            session.go_to(Moment(moment)).map_err(said)?;
        }
        name if session.bookmarks().contains_key(name) => {
            session.go_to_bookmark(name).map_err(said)?;
        }
        name => return to_checkpoint(front, name),
    }
    Ok(front.jumped(Vec::new()))
}

fn to_checkpoint(front: &mut Front<'_>, name: &str) -> Done {
    let checkpoints = &front.module.checkpoints;
    let Some(index) = checkpoints.iter().position(|known| known == name) else {
        let marks = front.session.bookmarks().keys();
        let known = marks.chain(checkpoints).map(String::as_str).chain(["start", "end", "error"]);
        let meant = obverse_bytecode::text::nearest(name, known);
        let hint = meant.map(|meant| format!("; did you mean `{meant}`?")).unwrap_or_default();
        return Err(format!("`{name}` is no moment, bookmark or checkpoint{hint}"));
    };
    let checkpoint = obverse_isa::CheckpointId(index as u16);
    let moment = front.session.go_to_checkpoint(checkpoint);
    let none = || format!("checkpoint {name} was not passed before this moment");
    moment.map_err(|why| why.words_or(none))?;
    Ok(front.jumped(Vec::new()))
}

pub(super) fn last(front: &mut Front<'_>, rest: &str) -> Done {
    let expression = front.expression(rest)?;
    let change = front
        .session
        .go_to_last_change(&expression)
        .map_err(|why| why.words_or(|| format!("{rest} did not change before this moment")))?;
    let Change { moment, before, after } = change;
    let line = format!("{rest} was {before} until here, and became {after}");
    let mut data = values::data([("before", &before), ("after", &after)]);
    data.insert("moment".to_owned(), json!(moment.0));
    Ok(front.jumped(vec![line]).with("change", data))
}

pub(super) fn undo(front: &mut Front<'_>, _: &str) -> Done {
    front.session.undo_jump().map_err(|why| why.to_string())?;
    Ok(front.jumped(Vec::new()))
}

pub(super) fn bookmark(front: &mut Front<'_>, rest: &str) -> Done {
    if rest.is_empty() {
        return Ok(bookmarks(front));
    }
    let is_name = rest.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c));
    if !is_name || rest.starts_with(|c: char| c.is_ascii_digit()) {
        return Err(format!("`{rest}` is no name: letters, digits, `_`, `-`, a letter first"));
    }
    if ["start", "end", "error"].contains(&rest) {
        return Err(format!("`goto {rest}` means something else already"));
    }
    front.session.bookmark(rest);
    Ok(Answer::line(format!("{rest} is moment {}", front.session.moment())))
}

pub(super) fn bookmarks(front: &Front<'_>) -> Answer {
    let marks = front.session.bookmarks();
    let lines: Vec<String> = marks.iter().map(|(name, at)| format!("{at:>8} {name}")).collect();
    let data: Vec<Value> =
        marks.iter().map(|(name, at)| json!({ "name": name, "moment": at.0 })).collect();
    match lines.is_empty() {
        true => Answer::line("there are no bookmarks"),
        false => Answer::lines(lines),
    }
    .with("bookmarks", data)
}

impl Front<'_> {
    /// Whether something is tried, which alone can be changed by hand.
    pub(super) fn require_try(&self) -> Result<(), String> {
        match self.session.mode() {
            Mode::WhatIf => Ok(()),
            Mode::Live if self.session.tries() == 0 => Err("this is the run itself, which nobody \
                changes by hand; `what-if` first"
                .to_owned()),
            _ => Err("this shows what was; `what-if` first".to_owned()),
        }
    }
}
