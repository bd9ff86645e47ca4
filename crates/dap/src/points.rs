//! The breakpoints that a client has set, group by group: those of a file, of names, of
//! instructions, of data, of errors.
//!
//! A client always sends a whole group. What it sends again as it was stays, with how often it has
//! been come to.

use crate::arguments::given;
use crate::filters::{self, Filter};
use crate::message::{Asked, Client, FilterOption};
use crate::places;
use crate::server::Loaded;
use obverse_bytecode::Module;
use obverse_debugger::recording::Facts;
use obverse_debugger::{
    Breakpoint, ConditionError, Counts, Expression, Halt, Piece, Places, Session,
};
use obverse_sim::Sim;
use obverse_vm::Stop;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// The most breakpoints of a group.
const MAX_POINTS: usize = 1000;

/// What a client sets at once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Group {
    /// Lines of a file.
    Lines(String),
    Functions,
    Instructions,
    Data,
    Errors,
}

impl Group {
    /// Why a run stops at one.
    fn reason(&self) -> &'static str {
        match self {
            Self::Lines(_) => "breakpoint",
            Self::Functions => "function breakpoint",
            Self::Instructions => "instruction breakpoint",
            Self::Data => "data breakpoint",
            Self::Errors => "exception",
        }
    }
}

struct Point {
    group: Group,
    asked: Value,
    /// None of one that could not be set.
    id: Option<u32>,
    answer: Value,
}

/// The breakpoints that a client has set.
pub(crate) struct Points {
    points: Vec<Point>,
    filters: Vec<Filter>,
}

/// What is known of a program before it runs, by which a breakpoint can be seen to be none.
#[derive(Clone, Copy)]
struct Known<'k> {
    module: &'k Module,
    facts: &'k Facts,
}

impl Known<'_> {
    /// An expression, if the workcell has what it asks for.
    fn checked(
        self,
        parsed: Result<Expression, ConditionError>,
    ) -> Result<Expression, ConditionError> {
        parsed.and_then(|it| it.check_lines(self.facts).map(|()| it))
    }
}

/// A breakpoint, and what a client is told of it.
type Made = (Breakpoint, Value);

impl Points {
    /// None yet; of errors, those that are due.
    pub(crate) fn new() -> Self {
        Self { points: Vec::new(), filters: vec![Filter::due()] }
    }

    /// Set a group; what is in its place is told of each.
    pub(crate) fn set(
        &mut self,
        session: &mut Session<'_, Sim>,
        (loaded, client): (&Loaded, &Client),
        group: &Group,
        asked: Vec<Value>,
    ) -> Result<Value, String> {
        if asked.len() > MAX_POINTS {
            return Err(format!("no more than {MAX_POINTS} breakpoints are set at once"));
        }
        let is_other = |point: &mut Point| point.group == *group;
        let mut before: Vec<Point> = self.points.extract_if(.., is_other).collect();
        let mut answers = Vec::new();
        for asked in asked {
            let kept = before.iter().position(|point| point.asked == asked);
            let point = match kept {
                Some(kept) => before.swap_remove(kept),
                None => make(session, (loaded, client), group, asked),
            };
            answers.push(point.answer.clone());
            self.points.push(point);
        }
        drop_all(session, &before);
        Ok(json!({ "breakpoints": answers }))
    }

    /// Set which errors stop a run.
    pub(crate) fn set_errors(
        &mut self,
        session: &mut Session<'_, Sim>,
        asked: Vec<FilterOption>,
    ) -> Value {
        let is_error = |point: &mut Point| point.group == Group::Errors;
        let before: Vec<Point> = self.points.extract_if(.., is_error).collect();
        drop_all(session, &before);
        let module = session.module();
        let found: Vec<_> = asked.iter().map(|asked| Filter::of(module, asked)).collect();
        let answer = |found: &Result<Filter, String>| match found {
            Ok(_) => json!({ "verified": true }),
            Err(why) => json!({ "verified": false, "message": why }),
        };
        let answers: Vec<Value> = found.iter().map(answer).collect();
        self.filters = found.into_iter().flatten().collect();
        let raised = self.filters.iter().flat_map(|filter| filter.raised(module));
        let raised: BTreeSet<usize> = raised.collect();
        for index in raised {
            let id = Some(session.add_breakpoint(filters::where_raised(module, index)));
            let (group, asked) = (Group::Errors, json!(module.errors[index].name));
            self.points.push(Point { group, asked, id, answer: Value::Null });
        }
        json!({ "breakpoints": answers })
    }

    /// Whether a run is to go on from a halt as if nothing had been: an error that is due, where
    /// the client wants to hear of none.
    pub(crate) fn passes(&self, halt: &Halt) -> bool {
        let Halt::Stopped(Stop::Due { error, .. }) = halt else { return false };
        !self.filters.iter().any(|filter| filter.is_of(error.index()))
    }

    /// Why a run stops at these, and the error if it is for one.
    pub(crate) fn reason(&self, ids: &[u32]) -> (&'static str, Option<String>) {
        let of = |point: &&Point| point.id.is_some_and(|id| ids.contains(&id));
        let mut found: Vec<&Point> = self.points.iter().filter(of).collect();
        found.sort_by_key(|point| point.group != Group::Errors);
        let first = found.first();
        let error = first.filter(|point| point.group == Group::Errors);
        let error = error.and_then(|point| point.asked.as_str()).map(str::to_owned);
        (first.map_or("breakpoint", |point| point.group.reason()), error)
    }

    /// Those of some that a client has numbers of.
    pub(crate) fn told(&self, ids: &[u32]) -> Vec<u32> {
        let is_told = |id: &&u32| {
            let mut points = self.points.iter();
            points.any(|point| point.id == Some(**id) && point.group != Group::Errors)
        };
        ids.iter().filter(is_told).copied().collect()
    }
}

/// What is told of so many that cannot be set for one reason.
pub(crate) fn none_set(count: usize, why: &str) -> Value {
    json!({ "breakpoints": vec![refused(why); count] })
}

fn refused(why: &str) -> Value {
    json!({ "verified": false, "message": why, "reason": "failed" })
}

fn drop_all(session: &mut Session<'_, Sim>, points: &[Point]) {
    for id in points.iter().filter_map(|point| point.id) {
        // It is there, and were it not, nothing would be left to drop.
        let _ = session.drop_breakpoint(id);
    }
}

fn make(
    session: &mut Session<'_, Sim>,
    (loaded, client): (&Loaded, &Client),
    group: &Group,
    asked: Value,
) -> Point {
    let known = Known { module: session.module(), facts: &session.recording().facts };
    let made = given::<Asked>("a breakpoint", &asked).and_then(|given| match group {
        Group::Lines(file) => of_line(known, (loaded, client), file, &given),
        Group::Functions => of_function(known, &given),
        Group::Instructions => of_instruction(known, &given),
        Group::Data | Group::Errors => of_data(known, &given),
    });
    let group = group.clone();
    match made {
        Ok((breakpoint, mut answer)) => {
            let id = session.add_breakpoint(breakpoint);
            answer["id"] = json!(id);
            answer["verified"] = json!(true);
            Point { group, asked, id: Some(id), answer }
        }
        Err(why) => Point { group, asked, id: None, answer: refused(&why) },
    }
}

fn of_line(
    known: Known<'_>,
    (loaded, client): (&Loaded, &Client),
    file: &str,
    given: &Asked,
) -> Result<Made, String> {
    let asked = given.line.ok_or("it must say its line")?;
    let line = client.line_of(asked);
    let places =
        Places::of_line(known.module, Some(file), line).map_err(|error| error.to_string())?;
    let found = places.line.unwrap_or(line);
    let mut answer = json!({ "line": client.line(found), "source": places::source(loaded, file) });
    if found != line {
        answer["message"] = json!(format!("there is no code at line {line}; the next is {found}"));
    }
    Ok((at(known, places, given)?, answer))
}

fn of_function(known: Known<'_>, given: &Asked) -> Result<Made, String> {
    let name = given.name.as_deref().ok_or("it must say a name")?;
    let places = Places::of_name(known.module, name.trim()).map_err(|error| error.to_string())?;
    Ok((at(known, places, given)?, json!({})))
}

fn of_instruction(known: Known<'_>, given: &Asked) -> Result<Made, String> {
    let reference = given.instruction_reference.as_deref().ok_or("it must say an instruction")?;
    let asked = places::address(reference, given.offset)?;
    let pc = u32::try_from(asked).map_err(|_| format!("there is no instruction {asked}"))?;
    let places = Places::of_instruction(known.module, pc).map_err(|error| error.to_string())?;
    let found = places.pcs.first().copied().unwrap_or(pc);
    let mut answer = json!({ "instructionReference": found.to_string() });
    if found != pc {
        let why = format!("no run can stop before instruction {pc}; the next is {found}");
        answer["message"] = json!(why);
    }
    Ok((at(known, places, given)?, answer))
}

fn at(known: Known<'_>, places: Places, given: &Asked) -> Result<Breakpoint, String> {
    let first = places.pcs.first().and_then(|pc| known.module.function_at(*pc));
    qualified(known, first.unwrap_or(0), Breakpoint::at(places), given)
}

fn of_data(known: Known<'_>, given: &Asked) -> Result<Made, String> {
    let id = given.data_id.as_deref().ok_or("it must say what is watched")?;
    if let Some(access) = given.access_type.as_deref().filter(|access| *access != "write") {
        return Err(format!("a run stops where it is changed, and not for `{access}`"));
    }
    let (function, text) = id.split_once(':').unwrap_or(("0", id));
    let function = function.parse().map_err(|_| format!("`{id}` is nothing that is watched"))?;
    let parsed = Expression::parse(known.module, function, text);
    let expression = known.checked(parsed).map_err(|error| error.to_string())?;
    let breakpoint = Breakpoint::on_change(expression);
    Ok((qualified(known, function, breakpoint, given)?, json!({})))
}

/// What is watched, by which a breakpoint can be set on it, and what a person calls it.
pub(crate) fn data(module: &Module, facts: &Facts, function: usize, text: &str) -> Value {
    let parsed = Expression::parse(module, function, text);
    match (Known { module, facts }).checked(parsed) {
        Ok(expression) if !expression.subjects().is_empty() => json!({
            "dataId": format!("{function}:{text}"),
            "description": text,
            "accessTypes": ["write"],
            "canPersist": true,
        }),
        Ok(_) => json!({ "dataId": null, "description": format!("`{text}` never changes") }),
        Err(error) => json!({ "dataId": null, "description": error.to_string() }),
    }
}

/// A breakpoint with when it stops, and what it tells in place of a stop.
fn qualified(
    known: Known<'_>,
    function: usize,
    breakpoint: Breakpoint,
    given: &Asked,
) -> Result<Breakpoint, String> {
    let text = |text: &Option<String>| text.clone().filter(|text| !text.trim().is_empty());
    let condition = text(&given.condition).map(|text| {
        let condition = Expression::condition(known.module, function, &text);
        known.checked(condition).map_err(|error| format!("condition: {error}"))
    });
    let hits = text(&given.hit_condition).map(|text| hits(&text)).transpose()?;
    let (ignored, counts) = hits.unwrap_or_default();
    let log = text(&given.log_message).map(|text| pieces(known, function, &text));
    Ok(Breakpoint {
        condition: condition.transpose()?,
        ignored,
        counts,
        log: log.transpose()?,
        ..breakpoint
    })
}

/// How often a breakpoint is passed, and where it stops then: `3` and `>= 3` stop from the third
/// time on, `> 3` behind it, `== 3` at it, `% 3` at every third.
fn hits(text: &str) -> Result<(u64, Counts), String> {
    let text = text.trim();
    let digits = text.find(|c: char| c.is_ascii_digit()).unwrap_or(text.len());
    let (operator, number) = text.split_at(digits);
    let number = number.parse::<u64>().ok();
    let passed = number.and_then(|number| number.checked_sub(1));
    let found = match operator.trim() {
        "" | ">=" => passed.map(|passed| (passed, Counts::All)),
        ">" => number.map(|number| (number, Counts::All)),
        "==" | "=" => passed.and(number).map(|number| (0, Counts::Only(number))),
        "%" => passed.and(number).map(|number| (0, Counts::Every(number))),
        _ => None,
    };
    let forms = "`3`, `>= 3`, `> 3`, `== 3` or `% 3`";
    found.ok_or_else(|| format!("`{text}` is no hit count: write {forms}"))
}

/// What a log point tells: text, and between braces what is worked out.
fn pieces(known: Known<'_>, function: usize, text: &str) -> Result<Vec<Piece>, String> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('{') {
        let (inner, after) = behind.split_once('}').ok_or("log message: a `}` is missing")?;
        let value = Expression::parse(known.module, function, inner);
        let value =
            known.checked(value).map_err(|error| format!("log message: `{inner}`: {error}"))?;
        pieces.extend((!before.is_empty()).then(|| Piece::Text(before.to_owned())));
        pieces.push(Piece::Value(value));
        rest = after;
    }
    pieces.extend((!rest.is_empty()).then(|| Piece::Text(rest.to_owned())));
    Ok(pieces)
}

#[cfg(test)]
mod tests {
    //! What is written in the fields of a breakpoint.

    use super::*;

    #[test]
    fn hit_counts_say_at_which_hits_it_stops() {
        for (text, ignored) in [("1", 0), (" 3 ", 2), (">= 3", 2), (">3", 3), ("> 0", 0)] {
            assert_eq!(hits(text), Ok((ignored, Counts::All)), "{text}");
        }
        assert_eq!(hits("==3"), Ok((0, Counts::Only(3))));
        assert_eq!(hits("% 2"), Ok((0, Counts::Every(2))));
        for text in ["0", "-1", "x", "< 3", "", "== 0", "%0", "%", "3 3", "99999999999999999999"] {
            assert!(hits(text).is_err(), "{text}");
        }
    }

    #[test]
    fn log_messages_are_text_and_values() {
        let (module, facts) = (Module::default(), Facts { outputs: 8, ..Facts::default() });
        let known = Known { module: &module, facts: &facts };
        let pieces = pieces(known, 0, "force {force} N").expect("it is well formed");
        assert!(matches!(
            &pieces[..],
            [Piece::Text(before), Piece::Value(_), Piece::Text(behind)]
                if before == "force " && behind == " N"
        ));
        for wrong in ["force {force", "{no_such_thing}", "{output 8}"] {
            assert!(super::pieces(known, 0, wrong).is_err(), "{wrong}");
        }
        assert!(super::pieces(known, 0, "{output 7}").is_ok());
    }
}
