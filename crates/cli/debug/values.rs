//! What there is at the moment that is shown: variables, the workcell, calls, history, the tape,
//! and what stops going back.

use super::{Answer, Done, Front, frames};
use crate::commands::reach::margin;
use crate::{report, story};
use obverse_debugger::session::{Action, Variable};
use obverse_debugger::{Hit, Subject, Unit, Value};
use obverse_geometry::{JointConfiguration, Pose};
use obverse_sim::kinematics;
use obverse_vm::Direction;
use serde_json::{Map, Value as Json, json};
use std::collections::BTreeMap;

/// How much of the history is shown unless told otherwise, and at the most.
const HISTORY: usize = 20;
const MAX_HISTORY: usize = 10_000;
/// How many marks a gauge has.
const GAUGE: usize = 24;

fn json_of(value: &Value) -> Json {
    match value {
        Value::Int(value) => json!(value),
        Value::Real(value) | Value::Quantity(value, _) => json!(value),
        Value::Bool(value) => json!(value),
        Value::Joints(joints) => json!(joints),
        Value::Name(name) => json!(name),
        Value::Unlimited | Value::Absent | Value::Wrong(_) => Json::Null,
    }
}

fn unit_of(value: &Value) -> Option<String> {
    match value {
        Value::Quantity(_, unit) => Some(unit.to_string()),
        Value::Joints(_) => Some(Unit::ANGLE.to_string()),
        _ => None,
    }
}

/// Values of one thing by name, for machines: numbers in SI units, and the unit of them.
pub(super) fn data<'v>(
    values: impl IntoIterator<Item = (&'static str, &'v Value)>,
) -> Map<String, Json> {
    let (mut data, mut unit) = (Map::new(), None);
    for (name, value) in values {
        data.insert(name.to_owned(), json_of(value));
        unit = unit.or_else(|| unit_of(value));
    }
    data.insert("unit".to_owned(), json!(unit));
    data
}

/// What was come to, for machines; of a watch with what has changed.
pub(super) fn hits(hits: &[Hit], names: &BTreeMap<u32, String>) -> Vec<Json> {
    let one = |hit: &Hit| {
        let change = hit.change.as_ref().map(|(was, is)| [("before", was), ("after", is)]);
        let mut it = data(change.into_iter().flatten());
        it.insert("number".to_owned(), json!(hit.id));
        it.insert("what".to_owned(), json!(names.get(&hit.id)));
        Json::Object(it)
    };
    hits.iter().map(one).collect()
}

/// Variables by their names, and the units of those that have one, for machines.
fn variables(variables: &[Variable]) -> [Map<String, Json>; 2] {
    let values = variables.iter().map(|it| (it.name.clone(), json_of(&it.value)));
    let unit = |it: &Variable| unit_of(&it.value).map(|unit| (it.name.clone(), json!(unit)));
    [values.collect(), variables.iter().filter_map(unit).collect()]
}

fn listed(all: &[Variable], none: &str) -> Answer {
    let mut lines: Vec<String> =
        all.iter().map(|variable| format!("{} = {}", variable.name, variable.value)).collect();
    if lines.is_empty() {
        lines.push(none.to_owned());
    }
    let [values, units] = variables(all);
    Answer::lines(lines).with("values", values).with("units", units)
}

pub(super) fn print(front: &mut Front<'_>, rest: &str) -> Done {
    if rest.is_empty() {
        let mut all = front.call().map_or(Vec::new(), |call| front.session.locals(call.index));
        all.extend(front.session.globals());
        return Ok(listed(&all, "there are no variables here"));
    }
    let expression = front.expression(rest)?;
    let value = front.session.look(|look| expression.value(look));
    if let Value::Wrong(why) = value {
        return Err(format!("`{rest}` cannot be worked out: {why}"));
    }
    Ok(Answer::line(format!("{rest} = {value}")).with_all(data([("value", &value)])))
}

pub(super) fn locals(front: &mut Front<'_>, rest: &str) -> Done {
    let number = frames::numbered(front, rest)?;
    let call = front.calls().into_iter().nth(number);
    let locals = call.map_or(Vec::new(), |call| front.session.locals(call.index));
    Ok(listed(&locals, "this call has no variables"))
}

pub(super) fn globals(front: &mut Front<'_>, _: &str) -> Done {
    Ok(listed(&front.session.globals(), "the program has no variables"))
}

/// A gauge of a number between two others.
fn gauge(value: f64, [least, most]: [f64; 2]) -> String {
    let part = ((value - least) / (most - least)).clamp(0.0, 1.0);
    // Neither more nor less than one of the marks.
    let at = (part * (GAUGE - 1) as f64).round() as usize;
    (0..GAUGE).map(|mark| if mark == at { '#' } else { '.' }).collect()
}

pub(super) fn state(front: &mut Front<'_>, _: &str) -> Done {
    let all = front.session.workcell();
    let is_output = |it: &&Variable| matches!(it.subject, Some(Subject::Output(_)));
    let (outputs, others): (Vec<&Variable>, Vec<&Variable>) = all.iter().partition(is_output);
    let mut lines: Vec<String> = others.into_iter().flat_map(shown).collect();
    let joints = all.iter().find_map(|it| match it.value {
        Value::Joints(joints) => Some(JointConfiguration(joints)),
        _ => None,
    });
    let (name, pose) = tool_pose(front, &joints.unwrap_or(JointConfiguration::ZERO));
    let place_mm = pose.translation_m.iter().map(|part| tenths(part * 1e3));
    let turned_deg = pose.rotation_vector_rad().map(|part| tenths(part.to_degrees()));
    let place = format!(
        "{name:<8} ({}) mm, turned ({}) deg",
        place_mm.collect::<Vec<String>>().join(", "),
        turned_deg.join(", ")
    );
    lines.insert(joints.map_or(0, |_| 6).min(lines.len()), place);
    let level = |it: &&Variable| {
        let level = if it.value == Value::Bool(true) { "high" } else { "low" };
        format!("{} {level}", it.name)
    };
    let outputs: Vec<String> = outputs.iter().map(level).collect();
    lines.extend(outputs.chunks(4).map(|some| some.join(", ")));
    let [values, units] = variables(&all);
    let pose = json!({
        "of": name,
        "translation_m": <[f64; 3]>::from(pose.translation_m),
        "rotation_vector_rad": pose.rotation_vector_rad(),
    });
    Ok(Answer::lines(lines).with("values", values).with("units", units).with("pose", pose))
}

/// A number to a tenth; nothing is no less than nothing.
fn tenths(value: f64) -> String {
    format!("{:.1}", (value * 10.0).round() / 10.0 + 0.0)
}

/// Where the tool centre point is in the base frame; of a tape whose workcell file cannot be read,
/// where the tool mount is.
fn tool_pose(front: &Front<'_>, joints: &JointConfiguration) -> (&'static str, Pose) {
    let mount = kinematics::forward(joints);
    let tool = usize::from(front.session.machine().tool().0);
    let tcp = match front.session.run().cell() {
        Some(sim) => sim.cell().tools.get(tool).map(|tool| tool.tcp),
        None => front.tcps.get(tool).copied(),
    };
    match tcp {
        Some(tcp) => ("tcp", mount.compose(&tcp)),
        None => ("mount", mount),
    }
}

/// What is seen of the workcell but its outputs, in columns.
fn shown(variable: &Variable) -> Vec<String> {
    let name = &variable.name;
    vec![match (&variable.subject, &variable.value) {
        (_, Value::Joints(joints)) => {
            let joint = |(joint, at): (&f64, u8)| {
                let degrees = joint.to_degrees();
                let gauge = gauge(degrees, [-180.0, 180.0]);
                format!("joint {at}  {degrees:>8.2} deg  [{gauge}]")
            };
            return joints.iter().zip(1..).map(joint).collect();
        }
        (Some(Subject::Force), Value::Quantity(force_n, _)) => {
            format!("{name:<8} {force_n:>8.2} N    [{}]", gauge(*force_n, [0.0, 50.0]))
        }
        (Some(Subject::Time), Value::Quantity(time_s, _)) => format!("{name:<8} {time_s:>8.2} s"),
        (_, value) => format!("{name:<8} {value}"),
    }]
}

pub(super) fn history(front: &mut Front<'_>, rest: &str) -> Done {
    let count = match rest.parse() {
        _ if rest.is_empty() => HISTORY,
        Ok(count @ 1..=MAX_HISTORY) => count,
        _ => return Err(format!("say how many, from 1 to {MAX_HISTORY}")),
    };
    let around = front.session.history_around(count);
    let shown = &around.actions;
    let mut lines: Vec<String> = shown.iter().map(|action| words(front, action)).collect();
    if let Some(here) = around.here {
        lines.insert(here, format!("{:>7} > here", front.session.moment()));
    }
    if lines.is_empty() {
        lines.push("nothing was done".to_owned());
    }
    let data: Vec<Json> = shown
        .iter()
        .map(|action| {
            json!({
                "moment": action.moment.0,
                "instruction": action.pc,
                "line": action.place.as_ref().map(|place| place.line),
                "forward": action.direction == Direction::Forward,
                "text": action.text,
                "end_s": action.end_s,
            })
        })
        .collect();
    Ok(Answer::lines(lines).with("history", data))
}

fn words(front: &Front<'_>, action: &Action) -> String {
    let arrow = match action.direction {
        Direction::Forward => ' ',
        Direction::Reverse => '<',
    };
    let place = report::line_of(front.module, action.pc);
    let text = story::said(front.module, action.pc);
    format!("{:>7} {arrow} {:>7.2} s  {place}  {text}", action.moment, action.end_s)
}

pub(super) fn tape(front: &mut Front<'_>, _: &str) -> Done {
    let Some(tape) = front.session.machine().tape() else {
        return Ok(Answer::line("nothing is recorded: the run cannot go back"));
    };
    let place = tape.place();
    let line = format!(
        "{} bits from here back to {}: {} single bits, {} words, {} positions of the arm, {} words \
         on turns of branches, {} faults",
        place.size_bits(),
        if place.size_bits() == tape.recorded_bits() {
            "the start"
        } else {
            "what is never undone"
        },
        place.bits,
        place.words,
        place.joints,
        place.control,
        place.faults
    );
    let data = json!({
        "bits": place.bits,
        "words": place.words,
        "joints": place.joints,
        "control": place.control,
        "faults": place.faults,
        "recorded_bits": tape.recorded_bits(),
    });
    Ok(Answer::line(line).with("tape", data))
}

pub(super) fn why(front: &mut Front<'_>, _: &str) -> Done {
    let why = front.session.why();
    let actions = match why.actions {
        0 => "no action".to_owned(),
        1 => "1 action".to_owned(),
        count => format!("{count} actions"),
    };
    let mut lines = Vec::new();
    match &why.never {
        Some(stopper) => {
            let place = report::line_of(front.module, stopper.pc);
            let text = story::said(front.module, stopper.pc);
            lines.push(format!("going back ends at {place} `{text}`: {}", stopper.reason));
            lines.push(match why.is_refused_here {
                true => "that is the very next step back".to_owned(),
                false => format!("{actions} back, at moment {}", stopper.moment),
            });
        }
        None => lines.push(format!("nothing stops going back to the start: {actions}")),
    }
    let ends = margin::ends(front.module, front.session.machine().state().pc());
    if !ends.is_empty() {
        lines.push(format!("whatever way led here, it goes back to {}", ends.join(", or to ")));
    }
    let never = why.never.as_ref().map(|stopper| {
        json!({
            "at": report::place(front.module, Some(stopper.pc)),
            "moment": stopper.moment.0,
            "reason": stopper.reason,
        })
    });
    Ok(Answer::lines(lines).with("never", never).with("ends", ends).with("actions", why.actions))
}
