//! `obverse run --dry`: how long a program takes, by sequence and by action, without a picture of
//! what happens.

use super::{Result, run};
use crate::cycle::{Cycle, Reading, Times};
use crate::report::{Lines, columns_of};
use crate::{Outcome, load, report, story, write};
use obverse_bytecode::{Module, Places};
use obverse_isa::Family;
use obverse_recovery::{Ending, drive};
use obverse_sim::Sim;
use obverse_vm::{Direction, Limits};
use obverse_workcell::Clock;
use serde_json::{Map, Value, json};

/// How wide the column of what the program says is.
const TEXT_COLUMNS: usize = 38;
/// How wide the longest bar is.
const BAR_COLUMNS: usize = 12;
/// Of more actions than these, those that take longest are told.
const ACTIONS_MAX: usize = 40;

/// What a dry run does not show.
const NOT_SHOWN: [&str; 3] = [
    "everything is at the place that the workcell file gives it, and the force sensor is not noisy",
    "inputs follow the rules of the workcell, random numbers the seed: others may lead elsewhere",
    "a guarded move stops where it touches now; in another contact it takes another time, or fails",
];

/// What it does not show either, of a program with forks.
const NOT_SHOWN_OF_FORKS: &str =
    "in a fork, what branches wait for overlaps; what a cell is commanded at once takes less time";

/// What is told of the time in which no branch of a fork can go on.
const COMMON_WAIT: &str = "all branches of the fork wait";

fn not_shown(cycle: &Cycle<'_>) -> impl Iterator<Item = &'static str> {
    NOT_SHOWN.into_iter().chain(cycle.has_branches.then_some(NOT_SHOWN_OF_FORKS))
}

/// A line of a table: its name, the instruction that it is about, and its times.
struct Row {
    name: String,
    pc: u32,
    times: Times,
}

pub(super) fn run(arguments: &run::Arguments) -> Result {
    let program = load::program_with(&arguments.file, &arguments.parameters.parameters)?;
    let (cell, file) = load::cell(&program, arguments.cell.as_deref())?;
    let mut cell = Sim::new(&cell.nominal(), arguments.seed);
    arguments.after.lead(&mut cell, &file)?;
    let begin_s = cell.now_s();
    let mut machine = load::machine(&program, &cell, &file)?.without_tape();
    run::head(arguments, &file.name);
    let module = program.verified.module();
    let mut cycle = Cycle::new(module, begin_s);
    let limits = Limits::instructions(arguments.limit);
    let ending = drive(&mut machine, Direction::Forward, limits, &mut cell, &mut cycle);
    cycle.end(cell.now_s());
    let total_s = cell.now_s() - begin_s;
    match arguments.json {
        true => tell_machines(module, &cycle, &ending, total_s),
        false => tell(module, &cycle, &ending, total_s),
    }
    Ok(if ending == Ending::Finished { Outcome::Done } else { Outcome::EndedOtherwise })
}

/// The longest first.
fn sorted(mut rows: Vec<Row>) -> Vec<Row> {
    rows.sort_by(|a, b| b.times.total_s.total_cmp(&a.times.total_s));
    rows
}

fn sequences(module: &Module, cycle: &Cycle<'_>) -> Vec<Row> {
    let row = |(&index, times): (&usize, &Times)| {
        let function = &module.functions[index];
        Row { name: function.name.clone(), pc: function.first, times: *times }
    };
    sorted(cycle.sequences.iter().map(row).collect())
}

fn actions(module: &Module, cycle: &Cycle<'_>) -> Vec<Row> {
    let row = |(&pc, times): (&u32, &Times)| {
        let name = match module.code[pc as usize].info().family {
            Family::Task => COMMON_WAIT.to_owned(),
            _ => story::said(module, pc),
        };
        Row { name, pc, times: *times }
    };
    sorted(cycle.actions.iter().map(row).collect())
}

fn tell(module: &Module, cycle: &Cycle<'_>, ending: &Ending, total_s: f64) {
    write::line(&format!("{}; a cycle takes {total_s:.2} s", report::ending_words(module, ending)));
    table(module, "sequence", &sequences(module, cycle), total_s);
    let mut actions = actions(module, cycle);
    let left_out = actions.split_off(actions.len().min(ACTIONS_MAX));
    table(module, "action", &actions, total_s);
    if !left_out.is_empty() {
        let rest_s: f64 = left_out.iter().map(|row| row.times.total_s).sum();
        write::line(&format!("        and {} more, {rest_s:.2} s together", left_out.len()));
    }
    let readings = readings(cycle);
    if !readings.is_empty() {
        let (lines, width) = lines(module, readings.iter().map(|(pc, _)| *pc));
        write::line(&format!("\n{:>width$}  what was read on the way", "line"));
        for (line, (_, what)) in lines.iter().zip(&readings) {
            write::line(&format!("{line:>width$}  {what}"));
        }
    }
    let (guarded, stopped) = cycle.guarded;
    if guarded > 0 {
        write::line(&format!("\n{guarded} guarded moves, {stopped} of them stopped by contact"));
    }
    write::line("\nwhat a dry run does not show:");
    not_shown(cycle).for_each(|what| write::line(&format!("- {what}")));
}

/// The lines of instructions, and how wide a column of them is.
fn lines(module: &Module, pcs: impl Iterator<Item = u32>) -> (Vec<String>, usize) {
    let lines = Lines::new(module);
    let shown: Vec<String> = pcs.map(|pc| lines.shown(pc)).collect();
    let width = columns_of(shown.iter().map(String::as_str));
    (shown, width)
}

fn table(module: &Module, what: &str, rows: &[Row], total_s: f64) {
    if rows.is_empty() {
        return;
    }
    let (lines, width) = lines(module, rows.iter().map(|row| row.pc));
    write::line(&format!(
        "\n{:>width$}  {what:<TEXT_COLUMNS$} times total s  share least s  mean s  most s",
        "line"
    ));
    for (row, line) in rows.iter().zip(&lines) {
        let times = &row.times;
        let share = share(times, total_s);
        let name: String = row.name.chars().take(TEXT_COLUMNS).collect();
        let (least, mean, most) = (times.least_s, times.mean_s(), times.most_s);
        let bar = "#".repeat((share * BAR_COLUMNS as f64).round().clamp(0.0, 99.0) as usize);
        let text = format!(
            "{line:>width$}  {name:<TEXT_COLUMNS$} {:>5} {:>7.2} {:>4.0} % {least:>7.2} \
             {mean:>7.2} {most:>7.2}  {bar}",
            times.count,
            times.total_s,
            share * 1e2,
        );
        write::line(text.trim_end());
    }
}

/// The part of the whole cycle; of a sequence that calls itself, more than that.
fn share(times: &Times, total_s: f64) -> f64 {
    if total_s > 0.0 { times.total_s / total_s } else { 0.0 }
}

/// What was read, by instruction, in words.
fn readings(cycle: &Cycle<'_>) -> Vec<(u32, String)> {
    cycle.readings.iter().map(|(&pc, readings)| (pc, in_words(readings))).collect()
}

fn in_words(readings: &[Reading]) -> String {
    let times =
        |count: usize| if count == 1 { "once".to_owned() } else { format!("{count} times") };
    let yes = |is_it: fn(&Reading) -> bool| readings.iter().filter(|one| is_it(one)).count();
    let both = |name: String, yes: usize, words: [&str; 2]| {
        let counts = [(yes, words[0]), (readings.len() - yes, words[1])];
        let told = counts.iter().filter(|(count, _)| *count > 0);
        let told: Vec<String> =
            told.map(|(count, word)| format!("{word} {}", times(*count))).collect();
        format!("{name}{}", told.join(", "))
    };
    let range = |name: &str, unit: &str, numbers: Vec<f64>| {
        let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let count = times(numbers.len());
        format!("{name} {count}, {least:.1} to {most:.1} {unit}")
    };
    let numbers = || {
        let number = |reading: &Reading| match reading {
            Reading::Distance(distance_m) => Some(distance_m * 1e3),
            Reading::Force(force_n) => Some(*force_n),
            Reading::Input { .. } | Reading::Holding(_) | Reading::Drawn => None,
        };
        readings.iter().filter_map(number).collect()
    };
    match readings.first() {
        Some(Reading::Input { bit, .. }) => {
            let high = yes(|reading| matches!(reading, Reading::Input { is_high: true, .. }));
            both(format!("input {bit}: "), high, ["high", "low"])
        }
        Some(Reading::Holding(_)) => {
            let held = yes(|reading| matches!(reading, Reading::Holding(true)));
            both("the gripper: ".to_owned(), held, ["holds something", "holds nothing"])
        }
        Some(Reading::Distance(_)) => range("distance:", "mm", numbers()),
        Some(Reading::Force(_)) => range("force:", "N", numbers()),
        Some(Reading::Drawn) => format!("a random number: {}", times(readings.len())),
        None => String::new(),
    }
}

fn tell_machines(module: &Module, cycle: &Cycle<'_>, ending: &Ending, total_s: f64) {
    let places = Places::new(module);
    let placed = |mut object: Value, pc: u32| {
        let place = places.of(pc);
        object["file"] = json!(place.map(|(file, _, _)| file));
        object["line"] = json!(place.map(|(_, line, _)| line));
        object
    };
    let objects = |kind: &str, rows: Vec<Row>| -> Vec<Value> {
        let object = |row: &Row| {
            let object = json!({
                "type": kind,
                "text": row.name,
                "count": row.times.count,
                "total_s": row.times.total_s,
                "share": share(&row.times, total_s),
                "least_s": row.times.least_s,
                "mean_s": row.times.mean_s(),
                "most_s": row.times.most_s,
            });
            placed(object, row.pc)
        };
        rows.iter().map(object).collect()
    };
    let reading =
        |(pc, what): (u32, String)| placed(json!({ "type": "reading", "text": what }), pc);
    let sequences = objects("sequence", sequences(module, cycle));
    let actions = objects("action", actions(module, cycle));
    let readings = readings(cycle).into_iter().map(reading);
    let all = sequences.into_iter().chain(actions).chain(readings);
    all.for_each(|object| write::line(&object.to_string()));
    let mut more = Map::new();
    more.insert("message".to_owned(), json!(report::ending_words(module, ending)));
    more.insert("stopped_at".to_owned(), report::place(module, report::ending_pc(ending)));
    more.insert("time_s".to_owned(), json!(total_s));
    more.insert("guarded_moves".to_owned(), json!(cycle.guarded.0));
    more.insert("stopped_by_contact".to_owned(), json!(cycle.guarded.1));
    more.insert("not_shown".to_owned(), not_shown(cycle).collect());
    report::summary(ending.code(), Map::new(), more);
}
