//! Breakpoints and watches.

use super::{Answer, Done, Front, displays, frames, values, walk};
use obverse_debugger::{Breakpoint, Declined, Expression, Places, What};
use obverse_vm::Direction;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Something and the condition behind it.
fn split_if(text: &str) -> (&str, Option<&str>) {
    if let Some(condition) =
        text.strip_prefix("if").filter(|it| it.is_empty() || it.starts_with(' '))
    {
        return ("", Some(condition.trim()));
    }
    if let Some(what) = text.strip_suffix(" if") {
        return (what.trim(), Some(""));
    }
    match text.split_once(" if ") {
        Some((what, condition)) => (what.trim(), Some(condition.trim())),
        None => (text, None),
    }
}

/// The places of a name; and, of a line without code, what is to be said.
pub(super) fn places(front: &Front<'_>, text: &str) -> Result<(Places, Option<String>), String> {
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

/// The same, with where the session stands if none is named, and whether it is the place behind.
fn placed(front: &Front<'_>, text: &str) -> Result<(Places, Option<String>, bool), String> {
    let (what, is_after) = match text.strip_prefix("after ") {
        Some(what) => (what.trim(), true),
        None => (text, false),
    };
    if !what.is_empty() {
        let (found, told) = places(front, what)?;
        return Ok((found, told, is_after));
    }
    let here = front.session.machine().state().pc();
    let here = Places::of_instruction(front.module, here).map_err(|why| why.to_string())?;
    Ok((here, None, is_after))
}

pub(super) fn add(front: &mut Front<'_>, rest: &str, is_temporary: bool) -> Done {
    let (what, condition) = split_if(rest);
    let (mut places, told, is_after) = placed(front, what)?;
    let condition = condition_of(front, function_of(front, &places.pcs), condition)?;
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

/// The function whose names hold at places.
fn function_of(front: &Front<'_>, pcs: &BTreeSet<u32>) -> usize {
    pcs.first().and_then(|pc| front.module.function_at(*pc)).unwrap_or(0)
}

fn condition_of(
    front: &Front<'_>,
    function: usize,
    text: Option<&str>,
) -> Result<Option<Expression>, String> {
    if text == Some("") {
        return Err("a condition is missing behind `if`".to_owned());
    }
    let condition = text.map(|text| Expression::condition(front.module, function, text));
    condition.map(|condition| front.checked(condition)).transpose()
}

pub(super) fn watch(front: &mut Front<'_>, rest: &str) -> Done {
    let (what, condition) = split_if(rest);
    let (what, direction) = match what.rsplit_once(' ') {
        Some((what, "forward")) => (what, Some(Direction::Forward)),
        Some((what, "reverse")) => (what, Some(Direction::Reverse)),
        _ => (what, None),
    };
    let expression = front.expression(what)?;
    if expression.subjects().is_empty() {
        return Err(format!("`{what}` never changes: watch what may"));
    }
    let now = front.session.look(|look| expression.value(look));
    let condition = condition_of(front, front.function(), condition)?;
    let breakpoint = Breakpoint { condition, direction, ..Breakpoint::on_change(expression) };
    let id = front.session.add_breakpoint(breakpoint);
    let answer = Answer::line(format!("watch {id}: {what}, which is {now}"));
    Ok(answer.with("breakpoint", id).with_all(values::data([("value", &now)])))
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

/// Breakpoints of these numbers, each of which there is, or all.
fn numbers(front: &Front<'_>, text: &str) -> Result<Vec<u32>, String> {
    let known = || front.session.breakpoints().iter().map(|it| it.id);
    if matches!(text, "" | "all") {
        return Ok(known().collect());
    }
    let numbers = text.split_whitespace().map(|text| {
        let id = number(text)?;
        match known().any(|known| known == id) {
            true => Ok(id),
            false => Err(Declined::NoBreakpoint(id).to_string()),
        }
    });
    numbers.collect()
}

fn drop_all(front: &mut Front<'_>, ids: &[u32]) -> Result<(), String> {
    ids.iter().try_for_each(|id| front.session.drop_breakpoint(*id).map_err(|why| why.to_string()))
}

pub(super) fn delete(front: &mut Front<'_>, rest: &str) -> Done {
    if rest.is_empty() {
        return Err("say which breakpoint, or `all`".to_owned());
    }
    let ids = numbers(front, rest)?;
    drop_all(front, &ids)?;
    Ok(Answer::default())
}

/// Drop the breakpoints at a place.
pub(super) fn clear(front: &mut Front<'_>, rest: &str) -> Done {
    let (place, _, behind) = placed(front, rest)?;
    let is_there = |it: &&Breakpoint| match &it.what {
        What::Places { pcs, is_after, .. } => *is_after == behind && pcs.is_subset(&place.pcs),
        What::Change(_) => false,
    };
    let all = front.session.breakpoints().iter();
    let ids: Vec<u32> = all.filter(is_there).map(|it| it.id).collect();
    if ids.is_empty() {
        return Err(format!("there is no breakpoint at {}", place.name));
    }
    drop_all(front, &ids)?;
    let lines = ids.iter().map(|id| format!("breakpoint {id} is gone")).collect();
    Ok(Answer::lines(lines).with("breakpoints", ids))
}

/// Let breakpoints stop a run, or not for now; all of them, if none is named.
pub(super) fn switch(front: &mut Front<'_>, rest: &str, is_enabled: bool) -> Done {
    let ids = numbers(front, rest)?;
    if ids.is_empty() {
        return Err("there are no breakpoints".to_owned());
    }
    for id in &ids {
        let switch = |it: &mut Breakpoint| it.is_enabled = is_enabled;
        front.session.change_breakpoint(*id, switch).map_err(|why| why.to_string())?;
    }
    let state = if is_enabled { "stops runs again" } else { "stops nothing for now" };
    let lines = ids.iter().map(|id| format!("breakpoint {id} {state}")).collect();
    Ok(Answer::lines(lines).with("breakpoints", ids))
}

/// Give a breakpoint a condition, or take it away.
pub(super) fn condition(front: &mut Front<'_>, rest: &str) -> Done {
    let (id, text) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
    if id.is_empty() {
        return Err("say which breakpoint, and the condition; none takes it away".to_owned());
    }
    let id = number(id)?;
    let found = front.session.breakpoints().iter().find(|it| it.id == id);
    let function = match found.map(|it| &it.what) {
        None => return Err(Declined::NoBreakpoint(id).to_string()),
        Some(What::Places { pcs, .. }) => function_of(front, pcs),
        Some(What::Change(_)) => front.function(),
    };
    let text = text.trim();
    let text = text.strip_prefix("if ").unwrap_or(text).trim();
    let condition = condition_of(front, function, Some(text).filter(|text| !text.is_empty()))?;
    let change = |it: &mut Breakpoint| it.condition = condition;
    front.session.change_breakpoint(id, change).map_err(|why| why.to_string())?;
    Ok(Answer::line(match text {
        "" => format!("breakpoint {id} stops always"),
        text => format!("breakpoint {id} stops only if {text}"),
    }))
}

/// What `info` knows of.
pub(super) const INFO: [&str; 9] = [
    "bookmarks",
    "breakpoints",
    "display",
    "frame",
    "globals",
    "history",
    "locals",
    "stack",
    "state",
];

pub(super) fn info(front: &mut Front<'_>, rest: &str) -> Done {
    match subject_of(rest)? {
        "breakpoints" => Ok(breakpoints(front)),
        "bookmarks" => Ok(walk::bookmarks(front)),
        "display" => Ok(displays::info(front)),
        "frame" => frames::info(front),
        "locals" => values::locals(front, ""),
        "globals" => values::globals(front, ""),
        "stack" => frames::backtrace(front, ""),
        "state" => values::state(front, ""),
        _ => values::history(front, ""),
    }
}

/// What is asked for: by its name, by what it is called elsewhere, or by the beginning of its name
/// that is no other's.
fn subject_of(text: &str) -> Result<&'static str, String> {
    let begun = |name: &&str| !text.is_empty() && name.starts_with(text);
    let begun: Vec<&'static str> = INFO.into_iter().filter(begun).collect();
    match (text, &begun[..]) {
        ("b" | "watchpoints", _) => Ok("breakpoints"),
        ("s", _) => Ok("stack"),
        ("variables", _) => Ok("globals"),
        ("registers", _) => Ok("state"),
        (_, [one]) => Ok(one),
        (_, []) => Err(format!("say of what: {}", INFO.join(", "))),
        (_, several) => Err(format!("`{text}` may be {}", several.join(" or "))),
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
                "enabled": it.is_enabled,
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
    if !it.is_enabled {
        words += ", disabled";
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
