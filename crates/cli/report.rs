//! A run for machines, as JSON Lines on standard output: an object an event, and a summary last.

use crate::problem::Problem;
use crate::{show, story, write};
pub(crate) use obverse_bytecode::text::line_of;
use obverse_bytecode::{Module, Places};
use obverse_recovery::Ending;
use obverse_vm::{Direction, Event, Machine, Observer, Trap, TrapKind};
use obverse_workcell::{MotionEnd, Workcell};
use serde_json::{Map, Value, json};

/// Tells a run to machines as it happens.
pub(crate) struct Report<'m> {
    module: &'m Module,
    places: Places<'m>,
}

impl<'m> Report<'m> {
    pub(crate) fn new(module: &'m Module) -> Self {
        Self { module, places: Places::new(module) }
    }

    pub(crate) fn module(&self) -> &'m Module {
        self.module
    }
}

impl Observer for Report<'_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        let mut object = json!({
            "type": "event",
            "direction": direction(event.direction),
            "instruction": event.pc,
            "opcode": event.instr.info().mnemonic,
            "text": story::said(self.module, event.pc),
            "class": event.instr.info().class.name(),
            "calls": event.frames,
            "time_s": cell.now_s(),
        });
        if let Some((file, line, column)) = self.places.of(event.pc) {
            object["file"] = json!(file);
            object["line"] = json!(line);
            object["column"] = json!(column);
        }
        if !event.branches.is_empty() {
            // From 1, as people count them.
            let branch: Vec<usize> = event.branches.iter().map(|branch| branch + 1).collect();
            object["branch"] = json!(branch);
        }
        if let Some(report) = event.report {
            object["distance_m"] = json!(report.distance_m);
            object["peak_force_n"] = json!(report.peak_force_n);
            object["duration_s"] = json!(report.duration_s);
            object["stopped_by_force"] = json!(report.end == MotionEnd::StoppedByForce);
        }
        if let Some(outcome) = story::outcome_of(self.module, event, cell) {
            object["outcome"] = json!(outcome);
        }
        write::line(&object.to_string());
    }
}

fn direction(direction: Direction) -> &'static str {
    match direction {
        Direction::Forward => "forward",
        Direction::Reverse => "reverse",
    }
}

/// The figures of a run.
pub(crate) fn figures(machine: &Machine<'_>, cell: &dyn Workcell) -> Map<String, Value> {
    let tape = machine.tape();
    let mut object = Map::new();
    object.insert("instructions".to_owned(), json!(machine.executed()));
    object.insert("commands".to_owned(), json!(machine.commands()));
    object.insert("tape_bits".to_owned(), json!(tape.map_or(0, obverse_tape::Tape::recorded_bits)));
    object.insert("time_s".to_owned(), json!(cell.now_s()));
    object.insert("digest".to_owned(), json!(format!("{:016x}", machine.digest(cell))));
    object
}

/// The last line of a run.
pub(crate) fn summary(outcome: &str, figures: Map<String, Value>, more: Map<String, Value>) {
    let mut object = Map::new();
    object.insert("type".to_owned(), json!("summary"));
    object.insert("outcome".to_owned(), json!(outcome));
    object.extend(figures);
    object.extend(more);
    write::line(&Value::Object(object).to_string());
}

/// The only line of a command that could not be carried out.
pub(crate) fn refused(problem: &Problem) {
    summary("refused", Map::new(), Map::from_iter([messages(problem)]));
}

/// What is wrong, as a field of a summary.
pub(crate) fn messages(problem: &Problem) -> (String, Value) {
    ("messages".to_owned(), show::problem_json(problem).into())
}

/// Where an ending happened, for machines; null if nowhere.
pub(crate) fn place(module: &Module, pc: Option<u32>) -> Value {
    let Some(pc) = pc else { return Value::Null };
    let instr = module.code.get(pc as usize).map(|instr| instr.info().mnemonic);
    let mut object = json!({ "instruction": pc, "opcode": instr });
    if let Some((file, line, column)) = module.place_of(pc) {
        object["file"] = json!(file);
        object["line"] = json!(line);
        object["column"] = json!(column);
    }
    object
}

/// How wide a column of lines of one file is.
const LINE_COLUMNS: usize = 6;

/// Where instructions were written, for people.
pub(crate) struct Lines<'m> {
    pub(crate) module: &'m Module,
    places: Places<'m>,
}

impl<'m> Lines<'m> {
    pub(crate) fn new(module: &'m Module) -> Self {
        Self { module, places: Places::new(module) }
    }

    /// The file and the line, from 1, of an instruction, if they are known.
    pub(crate) fn of(&self, pc: u32) -> Option<(&'m str, usize)> {
        self.places.of(pc).map(|(file, line, _)| (file, line))
    }

    /// The line of an instruction for people, with its file where there are several; empty if it is
    /// not known.
    pub(crate) fn shown(&self, pc: u32) -> String {
        let is_one = self.module.sources.len() <= 1;
        self.of(pc).map_or_else(String::new, |(file, line)| match is_one {
            true => line.to_string(),
            false => format!("{file}:{line}"),
        })
    }

    /// How wide a column of them is, at the most of what is reasonable.
    pub(crate) fn width(&self) -> usize {
        let names = self.module.sources.iter().map(|source| source.name.chars().count());
        match names.len() {
            0 | 1 => 5,
            _ => (names.max().unwrap_or(0) + 5).min(40),
        }
    }
}

/// How wide a column is that holds these lines of a program: that of a table of one file, or more.
pub(crate) fn columns_of<'l>(lines: impl Iterator<Item = &'l str>) -> usize {
    lines.map(|line| line.chars().count()).max().unwrap_or(0).max(LINE_COLUMNS)
}

/// The errors that are pending, by name.
pub(crate) fn pending(machine: &Machine<'_>) -> Value {
    let errors = &machine.program().module().errors;
    let names = machine.state().raised().iter().map(|error| errors[error.index()].name.as_str());
    names.collect()
}

/// The instruction that an ending is about.
pub(crate) fn ending_pc(ending: &Ending) -> Option<u32> {
    match ending {
        Ending::Refused(refusal) => Some(refusal.pc),
        Ending::Fault { pc, .. } | Ending::GivenUp { pc, .. } => Some(*pc),
        Ending::Trap(trap) => Some(trap.pc),
        Ending::Finished | Ending::Unhandled(_) | Ending::AtStart | Ending::Budget => None,
    }
}

/// An ending in words, with its place and what to do.
pub(crate) fn ending_words(module: &Module, ending: &Ending) -> String {
    match ending {
        Ending::Finished => "finished".to_owned(),
        Ending::Unhandled(errors) => {
            let names: Vec<&str> =
                errors.iter().map(|error| module.errors[error.index()].name.as_str()).collect();
            format!("stopped by error {}", names.join(", "))
        }
        Ending::GivenUp { error, pc, why } => {
            let error = &module.errors[error.index()].name;
            format!("stopped by error {error}, due at {}: {why}", line_of(module, *pc))
        }
        Ending::AtStart => "back at the start".to_owned(),
        Ending::Budget => "stopped at the limit of instructions; `--limit` sets another".to_owned(),
        Ending::Refused(refusal) => {
            let reason = refusal.reason.and_then(|reason| module.reasons.get(reason.index()));
            let why = reason.map_or(refusal.why, String::as_str);
            format!("cannot go back past {}: {why}", line_of(module, refusal.pc))
        }
        Ending::Fault { fault, direction: Direction::Forward, pc } => {
            format!("fault: {}: {fault}", statement(module, *pc))
        }
        Ending::Fault { fault, direction: Direction::Reverse, pc } => {
            format!("fault: going back over {}: {fault}", statement(module, *pc))
        }
        Ending::Trap(trap) => {
            format!("trap: {}: {}", statement(module, trap.pc), why(module, trap))
        }
    }
}

/// Where an instruction was written, and what stands there.
fn statement(module: &Module, pc: u32) -> String {
    format!("{} `{}`", line_of(module, pc), story::said(module, pc))
}

fn why(module: &Module, trap: &Trap) -> String {
    let reason = match trap.kind {
        // Which of its truth values the code asks for is of no interest to who wrote it.
        TrapKind::Assertion { .. } => {
            return "this assertion contradicts the way that led here".to_owned();
        }
        TrapKind::Required(reason) => module.reasons.get(reason.index()).cloned(),
        _ => None,
    };
    reason.unwrap_or_else(|| trap.kind.to_string())
}
