//! Breakpoints and watches.

use super::{Answer, Done, Front, values, walk};
use obverse_debugger::{Breakpoint, Expression, Places, What};
use obverse_vm::Direction;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Something and the condition behind it.
fn split_if(text: &str) -> (&str, Option<&str>) {
    match text.split_once(" if ") {
        Some((what, condition)) => (what.trim(), Some(condition.trim())),
        None => (text, None),
    }
}

/// The places of a name; and, of a line without code, what is to be said.
fn places(front: &Front<'_>, text: &str) -> Result<(Places, Option<String>), String> {
    let module = front.module;
    let said = |why: obverse_debugger::PlaceError| why.to_string();
    if let Some(name) = text.strip_prefix("error ") {
        return Ok((Places::of_error(module, name.trim()).map_err(said)?, None));
    }
    if let Some(number) = text.strip_prefix('*') {
        let pc = number.trim().parse().map_err(|_| format!("`{number}` is no instruction"))?;
        return Ok((Places::of_instruction(module, pc).map_err(said)?, None));
    }
    let (file, line) = match text.rsplit_once(':') {
        Some((file, line)) => (Some(file), line),
        None => (None, text),
    };
    if !line.starts_with(|c: char| c.is_ascii_digit()) {
        return Ok((Places::of_name(module, text).map_err(said)?, None));
    }
    let asked = line.parse().map_err(|_| format!("`{line}` is no line"))?;
    let found = match (file, asked) {
        (_, 0) => return Err("lines are numbered from 1".to_owned()),
        // Without a file, that of where the session stands.
        (None, asked) => Places::of_line(module, front.file_name().as_deref(), asked),
        (file, asked) => Places::of_line(module, file, asked),
    };
    let found = found.map_err(said)?;
    let moved = found.line.filter(|line| *line != asked);
    let told = moved.map(|line| format!("line {asked} has no code; the next that has is {line}"));
    Ok((found, told))
}

pub(super) fn add(front: &mut Front<'_>, rest: &str, is_temporary: bool) -> Done {
    let (what, condition) = split_if(rest);
    let (what, is_after) = match what.strip_prefix("after ") {
        Some(what) => (what.trim(), true),
        None => (what, false),
    };
    let (mut places, told) = match what {
        "" => (
            Places::of_instruction(front.module, front.session.machine().state().pc())
                .map_err(|why| why.to_string())?,
            None,
        ),
        _ => places(front, what)?,
    };
    let function = places.pcs.first().and_then(|pc| front.module.function_at(*pc)).unwrap_or(0);
    let condition = condition_of(front, function, condition)?;
    if is_after {
        places.name = format!("after {}", places.name);
    }
    let name = places.name.clone();
    let mut breakpoint = Breakpoint { condition, is_temporary, ..Breakpoint::at(places) };
    if let What::Places { is_after: behind, .. } = &mut breakpoint.what {
        *behind = is_after;
    }
    let id = front.session.add_breakpoint(breakpoint);
    let mut lines: Vec<String> = told.into_iter().collect();
    lines.push(format!("breakpoint {id}: {name}"));
    Ok(Answer::lines(lines).with("breakpoint", id))
}

fn condition_of(
    front: &Front<'_>,
    function: usize,
    text: Option<&str>,
) -> Result<Option<Expression>, String> {
    let condition = text.map(|text| Expression::condition(front.module, function, text));
    condition.transpose().map_err(|why| why.to_string())
}

pub(super) fn watch(front: &mut Front<'_>, rest: &str) -> Done {
    let (what, condition) = split_if(rest);
    let (what, direction) = match what.rsplit_once(' ') {
        Some((what, "forward")) => (what, Some(Direction::Forward)),
        Some((what, "reverse")) => (what, Some(Direction::Reverse)),
        _ => (what, None),
    };
    let expression = front.expression(what)?;
    let now = front.session.look(|look| expression.value(look));
    let condition = condition_of(front, front.function(), condition)?;
    let breakpoint = Breakpoint { condition, direction, ..Breakpoint::on_change(expression) };
    let id = front.session.add_breakpoint(breakpoint);
    Ok(Answer::line(format!("watch {id}: {what}, which is {now}")).with("breakpoint", id))
}

fn number(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| format!("`{text}` is no number of a breakpoint"))
}

pub(super) fn ignore(front: &mut Front<'_>, rest: &str) -> Done {
    let Some((id, count)) = rest.split_once(' ') else {
        return Err("say which breakpoint, and how often it is let pass".to_owned());
    };
    let count: u32 = count.trim().parse().map_err(|_| format!("`{count}` is no count"))?;
    let pass = |it: &mut Breakpoint| it.ignored = it.hits.saturating_add(u64::from(count));
    let id = number(id)?;
    front.session.change_breakpoint(id, pass).map_err(|why| why.to_string())?;
    Ok(Answer::line(format!("breakpoint {id} is let pass {count} times")))
}

pub(super) fn delete(front: &mut Front<'_>, rest: &str) -> Done {
    let ids: Vec<u32> = match rest {
        "all" => front.session.breakpoints().iter().map(|it| it.id).collect(),
        "" => return Err("say which breakpoint, or `all`".to_owned()),
        _ => vec![number(rest)?],
    };
    for id in ids {
        front.session.drop_breakpoint(id).map_err(|why| why.to_string())?;
    }
    Ok(Answer::default())
}

pub(super) fn info(front: &mut Front<'_>, rest: &str) -> Done {
    match rest {
        "breakpoints" | "break" | "b" | "watchpoints" => Ok(breakpoints(front)),
        "bookmarks" => Ok(walk::bookmarks(front)),
        "locals" => values::locals(front, ""),
        "globals" | "variables" => values::globals(front, ""),
        "frame" | "stack" => values::backtrace(front, ""),
        "state" | "registers" => values::state(front, ""),
        "history" => values::history(front, ""),
        _ => Err("say breakpoints, bookmarks, frame, locals, globals, state or history".to_owned()),
    }
}

fn breakpoints(front: &Front<'_>) -> Answer {
    let all = front.session.breakpoints();
    if all.is_empty() {
        return Answer::line("there are no breakpoints").with("breakpoints", Vec::<Value>::new());
    }
    let data: Vec<Value> = all
        .iter()
        .map(|it| {
            json!({
                "breakpoint": it.id,
                "name": name(&it.what),
                "condition": it.condition.as_ref().map(Expression::text),
                "hits": it.hits,
                "temporary": it.is_temporary,
            })
        })
        .collect();
    Answer::lines(all.iter().map(words).collect()).with("breakpoints", data)
}

fn name(what: &What) -> &str {
    match what {
        What::Places { name, .. } => name,
        What::Change(expression) => expression.text(),
    }
}

fn words(it: &Breakpoint) -> String {
    let kind = match it.what {
        What::Places { .. } => "break",
        What::Change(_) => "watch",
    };
    let mut words = format!("{:>3} {kind} {}", it.id, name(&it.what));
    match it.direction {
        Some(Direction::Forward) => words += " forward",
        Some(Direction::Reverse) => words += " reverse",
        None => {}
    }
    if let Some(condition) = &it.condition {
        words += &format!(" if {}", condition.text());
    }
    if it.is_temporary {
        words += ", once";
    }
    if it.hits > 0 {
        words += &format!(", come to {}", counted(it.hits));
    }
    if it.ignored > it.hits {
        words += &format!(", let pass {}", counted(it.ignored - it.hits));
    }
    words
}

fn counted(count: u64) -> String {
    if count == 1 { "once".to_owned() } else { format!("{count} times") }
}

impl Front<'_> {
    /// What breakpoints are called, by their numbers.
    pub(super) fn breakpoint_names(&self) -> BTreeMap<u32, String> {
        let all = self.session.breakpoints().iter();
        all.map(|it| (it.id, name(&it.what).to_owned())).collect()
    }
}
