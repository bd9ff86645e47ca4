//! The calls under way, and which of them is looked at: the innermost, unless another is selected.

use super::{Answer, Done, Front};
use crate::report;
use obverse_debugger::session::FrameView;
use obverse_debugger::{ConditionError, Expression, Subject};
use serde_json::{Value, json};

impl Front<'_> {
    /// The calls under way, innermost first: as they are numbered.
    pub(super) fn calls(&self) -> Vec<FrameView> {
        let mut frames = self.session.frames();
        frames.reverse();
        frames
    }

    /// The call that is looked at.
    pub(super) fn call(&self) -> Option<FrameView> {
        self.calls().into_iter().nth(self.selected)
    }

    /// The function whose names hold where one looks.
    pub(super) fn function(&self) -> usize {
        self.call().map_or(0, |call| usize::from(call.function))
    }

    /// An expression whose names are those of the call that is looked at.
    pub(super) fn expression(&self, text: &str) -> Result<Expression, String> {
        let function = self.function();
        let found = self.checked(Expression::parse(self.module, function, text))?;
        let calls = self.calls();
        let is_hidden = calls.iter().take(self.selected).any(|it| it.function as usize == function);
        let is_local =
            |subject: &&Subject| matches!(subject, Subject::Local(..) | Subject::Counter(..));
        match found.subjects().into_iter().find(is_local).filter(|_| is_hidden) {
            Some(subject) => Err(format!(
                "`{}` would be that of a call further in of the same sequence; `info locals` shows \
                 those of this one",
                subject.name(self.module)
            )),
            None => Ok(found),
        }
    }

    /// An expression that asks about no line that the workcell has not.
    pub(super) fn checked(
        &self,
        found: Result<Expression, ConditionError>,
    ) -> Result<Expression, String> {
        let facts = &self.session.recording().facts;
        let found = found.and_then(|found| found.check_lines(facts).map(|()| found));
        found.map_err(|why| why.to_string())
    }

    /// Look at a call of this number.
    fn select(&mut self, number: usize) -> Done {
        self.selected = number;
        self.listed = None;
        let Some(call) = self.call() else { return Err("no call is under way".to_owned()) };
        let line = self.line_of(number, &call);
        let lines = vec![words(self, number, &call), line];
        Ok(Answer::lines(lines).with("frame", data(number, &call)))
    }
}

fn words(front: &Front<'_>, number: usize, call: &FrameView) -> String {
    let place = report::line_of(front.module, call.pc);
    let place = call.place.as_ref().map_or(place, |at| format!("{}:{}", at.file, at.line));
    match call.index {
        0 => format!("#{number} the start"),
        _ => format!("#{number} {} at {place}", call.name),
    }
}

fn data(number: usize, call: &FrameView) -> Value {
    json!({
        "number": number,
        "function": call.name,
        "instruction": call.pc,
        "file": call.place.as_ref().map(|place| &place.file),
        "line": call.place.as_ref().map(|place| place.line),
    })
}

pub(super) fn backtrace(front: &mut Front<'_>, _: &str) -> Done {
    let calls = front.calls();
    let all = || (0..).zip(&calls);
    let lines = all().map(|(number, call)| words(front, number, call)).collect();
    let data: Vec<Value> = all().map(|(number, call)| data(number, call)).collect();
    Ok(Answer::lines(lines).with("frames", data))
}

/// The number of a call that is under way; that of the one looked at, if none is named.
pub(super) fn numbered(front: &Front<'_>, text: &str) -> Result<usize, String> {
    let last = front.calls().len().saturating_sub(1);
    match text.parse() {
        _ if text.is_empty() => Ok(front.selected),
        Ok(number) if number <= last => Ok(number),
        _ => Err(format!("`{text}` is no call: they are numbered from 0 to {last}")),
    }
}

pub(super) fn frame(front: &mut Front<'_>, rest: &str) -> Done {
    let number = numbered(front, rest)?;
    front.select(number)
}

/// How many calls to go.
fn count(text: &str) -> Result<usize, String> {
    match text.parse() {
        _ if text.is_empty() => Ok(1),
        Ok(count @ 1..) => Ok(count),
        _ => Err(format!("`{text}` is no count of calls")),
    }
}

pub(super) fn up(front: &mut Front<'_>, rest: &str) -> Done {
    let (count, last) = (count(rest)?, front.calls().len().saturating_sub(1));
    if front.selected == last {
        return Err("this is the outermost call".to_owned());
    }
    // Further than there are calls is to the last, as people expect who say `up 99`.
    front.select(front.selected.saturating_add(count).min(last))
}

pub(super) fn down(front: &mut Front<'_>, rest: &str) -> Done {
    let count = count(rest)?;
    if front.selected == 0 {
        return Err("this is the innermost call".to_owned());
    }
    front.select(front.selected.saturating_sub(count))
}

/// Where the call that is looked at stands, and who called it.
pub(super) fn info(front: &mut Front<'_>) -> Done {
    let number = front.selected;
    let calls = front.calls();
    let Some(call) = calls.get(number) else { return Err("no call is under way".to_owned()) };
    let mut lines = vec![words(front, number, call)];
    lines.push(format!("instruction {}, moment {}", call.pc, front.session.moment()));
    if let Some(caller) = calls.get(number + 1) {
        lines.push(format!("called from {}", words(front, number + 1, caller)));
    }
    lines.push(match front.session.locals(call.index).len() {
        0 => "no variables of its own".to_owned(),
        1 => "1 variable of its own; `info locals` shows it".to_owned(),
        count => format!("{count} variables of its own; `info locals` shows them"),
    });
    Ok(Answer::lines(lines).with("frame", data(number, call)))
}
