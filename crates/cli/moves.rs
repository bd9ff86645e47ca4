//! What a check of moves found: a table for people, an object a move for machines.
//!
//! Knows the words; what was found it is given.

use crate::report::{Lines, columns_of};
use crate::{story, write};
use obverse_bytecode::{Module, Places};
use obverse_preflight::{Grade, Graded, MoveReport, Reason, Report};
use serde_json::{Map, Value, json};
use std::path::Path;

/// How wide the column of what the program says is.
const TEXT_COLUMNS: usize = 52;

/// The table of all moves, and how many there are of each grade.
///
/// It may be of a program that begins where another has ended.
pub(crate) fn tell(module: &Module, report: &Report, after: Option<&Path>) {
    if report.moves.is_empty() {
        return;
    }
    let lines = Lines::new(module);
    let shown: Vec<String> = report.moves.iter().map(|found| lines.shown(found.pc)).collect();
    let width = columns_of(shown.iter().map(String::as_str));
    write::line(&format!("\n{:>width$}  {:<TEXT_COLUMNS$}  grade", "line", "move"));
    for (found, line) in report.moves.iter().zip(&shown) {
        row(&lines, found, &format!("{line:>width$}"));
    }
    write::line("");
    write::line(&counts(report));
    if !report.is_complete {
        write::line(GIVEN_UP);
    } else {
        let after = after.map(|first| format!(" after {}", first.display())).unwrap_or_default();
        write::line(&format!("everything taken to be where the workcell has it{after}"));
        let is_elsewhere = |graded: &Graded| graded.elsewhere.is_some();
        let both = |found: &MoveReport| [found.forward.clone(), found.reverse.clone()];
        if report.moves.iter().flat_map(both).flatten().any(|graded| is_elsewhere(&graded)) {
            write::line(OTHERWISE);
        }
    }
}

const OTHERWISE: &str = "\
otherwise: where a guarded move is stopped elsewhere, or the gripper or an input is not as planned";

const GIVEN_UP: &str = "\
the check was given up: there are too many ways through the program, rounds of a loop, or motions,
to look at all of them; that a move looks fine says nothing";

/// The row of a move, whose line is given at the width of its column.
fn row(lines: &Lines<'_>, found: &MoveReport, line: &str) {
    let (module, width) = (lines.module, line.chars().count());
    let text = story::text_of(module, found.pc, module.code[found.pc as usize]);
    let (forward, reverse) = (found.forward.as_ref(), found.reverse.as_ref());
    let Some(first) = forward.or(reverse) else {
        let never = found.unseen;
        let grade = format!("{} ({})", never.grade().words(), never.code());
        write::line(&format!("{line}  {text:<TEXT_COLUMNS$}  {grade}"));
        return write::line(&format!("{:>width$}    {}", "", never.title()));
    };
    let alone = if forward.is_none() { ", in reverse alone" } else { "" };
    write::line(&format!("{line}  {text:<TEXT_COLUMNS$}  {}{alone}", grade(first)));
    more(lines, first, width);
    if let (Some(there), Some(back)) = (forward, reverse)
        && differs(there.verdict.grade(), back.verdict.grade())
    {
        let label = format!("{:<TEXT_COLUMNS$}", "  in reverse");
        write::line(&format!("{:>width$}  {label}  {}", "", grade(back)));
        more(lines, back, width);
    }
}

/// Whether what was found in reverse is worth a row of its own. Over a move that cannot be made
/// there is nothing to go back.
fn differs(there: Grade, back: Grade) -> bool {
    there != back && !(there.is_wrong() && back == Grade::NotKnown)
}

/// `in collision (P0502)`; nothing needs explaining of what is fine.
fn grade(graded: &Graded) -> String {
    let verdict = &graded.verdict;
    match (verdict.grade(), graded.elsewhere) {
        (Grade::Reachable, None) => verdict.grade().words().to_owned(),
        (Grade::Reachable, Some(reason)) => {
            format!("reachable; otherwise not known ({})", reason.code())
        }
        (other, _) => format!("{} ({})", other.words(), verdict.reason.code()),
    }
}

/// The line below a row: what was found, and by which calls.
fn more(lines: &Lines<'_>, graded: &Graded, width: usize) {
    let verdict = &graded.verdict;
    if verdict.grade() == Grade::Reachable {
        return;
    }
    let said = match verdict.detail.as_str() {
        "" => verdict.reason.title(),
        detail => detail,
    };
    // The main sequence is called by nobody's line.
    let calls = graded.calls.iter().skip(1).map(|&pc| lines.shown(pc));
    let calls: Vec<String> = calls.filter(|line| !line.is_empty()).collect();
    let called = match calls.is_empty() {
        true => String::new(),
        false => format!("; called from line {}", calls.join(", ")),
    };
    write::line(&format!("{:>width$}    {said}{called}", ""));
}

fn counts(report: &Report) -> String {
    let total = report.moves.len();
    let counted = Grade::ALL.into_iter().filter_map(|grade| match report.count(grade) {
        0 => None,
        count if count == total => Some(format!("all {}", grade.words())),
        count => Some(format!("{count} {}", grade.words())),
    });
    let counted: Vec<String> = counted.collect();
    match total {
        1 => format!("1 move: {}", counted.join(", ").trim_start_matches("all ")),
        _ => format!("{total} moves: {}", counted.join(", ")),
    }
}

/// An object a move.
pub(crate) fn tell_machines(module: &Module, report: &Report) {
    let places = Places::new(module);
    for found in &report.moves {
        let verdict = found.verdict();
        let mut object = json!({
            "type": "move",
            "instruction": found.pc,
            "text": story::text_of(module, found.pc, module.code[found.pc as usize]),
            "grade": verdict.grade().word(),
            "code": verdict.reason.code(),
            "message": verdict.reason.title(),
            "forward": found.forward.as_ref().map(|graded| direction(&places, graded)),
            "reverse": found.reverse.as_ref().map(|graded| direction(&places, graded)),
        });
        if let Some((file, line, column)) = places.of(found.pc) {
            object["file"] = json!(file);
            object["line"] = json!(line);
            object["column"] = json!(column);
        }
        write::line(&object.to_string());
    }
}

fn direction(places: &Places<'_>, graded: &Graded) -> Value {
    let verdict = &graded.verdict;
    let line = |pc: &u32| places.of(*pc).map(|(_, line, _)| line);
    json!({
        "grade": verdict.grade().word(),
        "code": verdict.reason.code(),
        "detail": verdict.detail,
        "fraction": verdict.fraction,
        "body": verdict.contact.as_ref().map(|contact| &contact.body),
        "with": verdict.contact.as_ref().map(|contact| &contact.with),
        "force_n": verdict.contact.as_ref().map(|contact| contact.force_n),
        "called_from_lines": graded.calls.iter().map(line).collect::<Vec<_>>(),
        "ways": graded.visits,
        "always_fails": graded.always_fails,
        "elsewhere": graded.elsewhere.map(Reason::code),
    })
}

/// How many moves there are of each grade, for the summary.
pub(crate) fn counts_for_machines(report: &Report) -> Value {
    let counts = Grade::ALL.map(|grade| (grade.word().to_owned(), json!(report.count(grade))));
    Value::Object(Map::from_iter(counts))
}
