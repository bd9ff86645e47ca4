//! The story of a run, in lines that a person follows: where the program is, what the robot did,
//! what came of it, and when.
//!
//! Knows the words; what happened it is told by the machine, event by event.

use crate::write;
use obverse_bytecode::text::SAID_COLUMNS;
pub(crate) use obverse_bytecode::text::said;
use obverse_bytecode::{Continuation, FunctionKind, Module, Severity};
use obverse_isa::{ErrorId, FunctionId, Instr, Level, Setting};
use obverse_vm::{Direction, Event, Observer};
use obverse_workcell::{MotionEnd, MotionReport, Workcell};

/// Deeper calls than these are not set in further.
const DEPTH_MAX: usize = 10;

/// Tells a run as it happens.
pub(crate) struct Story<'m> {
    module: &'m Module,
    /// The headings under which nothing has been told yet, outermost first.
    headings: Vec<Told>,
}

/// A line of the story.
struct Told {
    time_s: f64,
    direction: Direction,
    /// Which branch it belongs to of each fork that is open, outermost first.
    branches: Vec<usize>,
    /// How many calls are under way around it.
    depth: usize,
    text: String,
    outcome: String,
}

impl<'m> Story<'m> {
    pub(crate) fn new(module: &'m Module) -> Self {
        Self { module, headings: Vec::new() }
    }

    pub(crate) fn module(&self) -> &'m Module {
        self.module
    }

    /// Say where the program is, whatever comes next.
    pub(crate) fn tell_headings(&mut self) {
        self.headings.drain(..).for_each(|heading| heading.write());
    }
}

impl Observer for Story<'_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        let is_left = match event.direction {
            Direction::Forward => matches!(event.instr, Instr::Return { .. }),
            Direction::Reverse => matches!(event.instr, Instr::Call { .. }),
        };
        if is_left {
            // Nothing happened under a heading that is still here: it is not told.
            self.headings.retain(|heading| heading.depth < event.frames);
        } else if let Some(heading) = heading(self.module, event, cell) {
            self.headings.push(heading);
        } else if let Some(told) = act(self.module, event, cell) {
            self.tell_headings();
            told.write();
        }
    }
}

impl Told {
    fn write(&self) {
        let arrow = match self.direction {
            Direction::Forward => ' ',
            Direction::Reverse => '<',
        };
        let indent = "  ".repeat(self.depth.saturating_sub(2).min(DEPTH_MAX));
        let text = format!("{}{indent}{}", mark(&self.branches), self.text);
        let time = format!("{:.2} s", self.time_s);
        let line = format!("{time:>9} {arrow} {text:<SAID_COLUMNS$} {}", self.outcome);
        write::line(line.trim_end());
    }
}

/// Which branch of a fork a line belongs to: `|2 `, or `|2|1 ` in a fork within it; else empty.
fn mark(branches: &[usize]) -> String {
    let mark: String = branches.iter().map(|branch| format!("|{}", branch + 1)).collect();
    if mark.is_empty() { mark } else { mark + " " }
}

/// The line over what a sequence does: where it is called, or, going back, where its end is passed.
fn heading(module: &Module, event: &Event, cell: &dyn Workcell) -> Option<Told> {
    let depth = event.frames.saturating_sub(1);
    let (text, outcome) = match (event.instr, event.direction) {
        (Instr::Call { function, .. }, Direction::Forward) => {
            (called(module, event.pc, function), "")
        }
        (Instr::Return { .. }, Direction::Reverse) => {
            let function = module.functions.get(module.function_at(event.pc)?)?;
            (format!("{} {}", kind_word(function.kind), function.name), "")
        }
        (Instr::BlockReplace { function, .. }, Direction::Reverse) => {
            (replacement(module, function), "in place of going back")
        }
        _ => return None,
    };
    Some(Told {
        time_s: cell.now_s(),
        direction: event.direction,
        branches: event.branches.clone(),
        depth,
        text,
        outcome: outcome.to_owned(),
    })
}

/// What an instruction did, if it is worth telling.
fn act(module: &Module, event: &Event, cell: &dyn Workcell) -> Option<Told> {
    let outcome = outcome_of(module, event, cell)?;
    let text = text_of(module, event.pc, event.instr);
    Some(Told {
        time_s: cell.now_s(),
        direction: event.direction,
        branches: event.branches.clone(),
        depth: event.frames,
        text,
        outcome,
    })
}

/// A call in the program's words: `action pick(block_a)`.
fn called(module: &Module, pc: u32, function: FunctionId) -> String {
    let function = &module.functions[function.index()];
    let said = said(module, pc);
    // A recovery is called by no statement of its own.
    let with_arguments = said.strip_prefix("call ").map(str::trim_start);
    let name = with_arguments.filter(|text| text.starts_with(&function.name));
    format!("{} {}", kind_word(function.kind), name.unwrap_or(&function.name))
}

fn replacement(module: &Module, function: FunctionId) -> String {
    let function = &module.functions[function.index()];
    match function.kind {
        FunctionKind::Replacement => "in reverse".to_owned(),
        kind => format!("{} {}", kind_word(kind), function.name),
    }
}

fn kind_word(kind: FunctionKind) -> &'static str {
    match kind {
        FunctionKind::Start => "start",
        FunctionKind::Sequence => "sequence",
        FunctionKind::Action => "action",
        FunctionKind::Io => "io",
        FunctionKind::AdvancedMove => "advance",
        FunctionKind::Replacement => "block",
        FunctionKind::Cleanup => "cleanup",
    }
}

/// What the program says at an event, or what it means there: the moves around an advanced move
/// are all written in one clause.
pub(crate) fn text_of(module: &Module, pc: u32, instr: Instr) -> String {
    let kind = module.function_at(pc).map(|index| module.functions[index].kind);
    match instr {
        Instr::MoveSlot { .. } if kind == Some(FunctionKind::AdvancedMove) => {
            "return to initial position".to_owned()
        }
        Instr::MoveOffset { .. } if kind == Some(FunctionKind::AdvancedMove) => {
            "perturbation".to_owned()
        }
        Instr::ErrorClear { error } => {
            format!("error {}", module.errors[error.index()].name)
        }
        Instr::Irreversible { .. } if is_end(module, pc) => {
            "end of what is irreversible".to_owned()
        }
        _ => said(module, pc),
    }
}

/// Whether this is the later of the two instructions around what is irreversible: both are written
/// in its header.
fn is_end(module: &Module, pc: u32) -> bool {
    let function = module.function_at(pc).and_then(|index| module.functions.get(index));
    let first = function.map_or(pc, |function| function.first);
    let span = |pc| module.source_at(pc).map(|entry| (entry.file, entry.start, entry.end));
    let is_begin = |at: u32| {
        let instr = module.code.get(at as usize);
        matches!(instr, Some(Instr::Irreversible { .. })) && span(at) == span(pc)
    };
    span(pc).is_some() && (first..pc).any(is_begin)
}

/// What an instruction did, if it is worth telling.
pub(crate) fn outcome_of(module: &Module, event: &Event, cell: &dyn Workcell) -> Option<String> {
    match event.direction {
        Direction::Forward => forward_outcome(module, event, cell),
        Direction::Reverse => reverse_outcome(module, event, cell),
    }
}

fn forward_outcome(module: &Module, event: &Event, cell: &dyn Workcell) -> Option<String> {
    Some(match event.instr {
        Instr::OutputSet { bit, .. } | Instr::OutputToggle { bit, .. } => output(bit.0, cell),
        // In a fork the others go on meanwhile.
        Instr::Wait { .. } if !event.branches.is_empty() => "waits".to_owned(),
        Instr::Wait { .. } => "waited".to_owned(),
        Instr::WaitInput { bit, level, .. } => waited_for(bit.0, level, cell),
        Instr::SettingSet { setting: Setting::Tool, .. } => {
            let is_asked_for = said(module, event.pc).starts_with("tool ");
            is_asked_for.then(|| "mounted".to_owned())?
        }
        Instr::Checkpoint { .. } => "may be gone back to".to_owned(),
        Instr::Barrier { .. } | Instr::Irreversible { .. } => "no way back from here".to_owned(),
        // It was set aside, or is raised anew: who raised it has been told.
        Instr::ErrorClear { .. } if is_set_aside(module, event.pc) => return None,
        Instr::ErrorRaise { error } if is_raised_anew(module, event.pc, error) => return None,
        Instr::ErrorRaise { error } => {
            let error = &module.errors[error.index()];
            let severity = match error.severity {
                Severity::Warning => "a warning",
                Severity::Recoverable => "recoverable",
                Severity::Fatal => "fatal",
            };
            format!("error {}, {severity}", error.name)
        }
        // Raised again at once, it is still there.
        Instr::ErrorClear { error } if is_followed_by_raise(module, event.pc, error) => {
            return None;
        }
        Instr::ErrorClear { error } => dealt_with(module, error),
        _ => return event.report.map(|report| motion(event, &report)),
    })
}

fn reverse_outcome(module: &Module, event: &Event, cell: &dyn Workcell) -> Option<String> {
    Some(match event.instr {
        Instr::OutputSet { bit, .. } | Instr::OutputToggle { bit, .. } => output(bit.0, cell),
        Instr::ErrorRaise { error } => {
            format!("error {} taken back", module.errors[error.index()].name)
        }
        _ => match event.report? {
            report if report.duration_s == 0.0 => "there already".to_owned(),
            report => format!("back in {:.2} s", report.duration_s),
        },
    })
}

fn output(bit: u16, cell: &dyn Workcell) -> String {
    format!("output {bit} {}", level_word(cell.output(bit)))
}

fn waited_for(bit: u16, level: Level, cell: &dyn Workcell) -> String {
    if cell.input(bit) == Ok(level.is_high()) {
        format!("input {bit} {}", level_word(level.is_high()))
    } else {
        format!("input {bit} still {}: time is up", level_word(!level.is_high()))
    }
}

/// Whether an error is pending no more only while something else is done, as a local remembers.
fn is_set_aside(module: &Module, pc: u32) -> bool {
    let before = |by: u32| module.code.get(pc.checked_sub(by)? as usize);
    matches!(
        (before(2), before(1)),
        (Some(Instr::PushLocal { .. }), Some(Instr::JumpUnless { .. }))
    )
}

fn is_raised_anew(module: &Module, pc: u32, error: ErrorId) -> bool {
    let before = pc.checked_sub(1).and_then(|before| module.code.get(before as usize));
    before == Some(&Instr::ErrorClear { error })
}

fn is_followed_by_raise(module: &Module, pc: u32, error: ErrorId) -> bool {
    module.code.get(pc as usize + 1) == Some(&Instr::ErrorRaise { error })
}

fn dealt_with(module: &Module, error: ErrorId) -> String {
    let error = &module.errors[error.index()];
    let then = match error.continuation {
        _ if error.severity == Severity::Warning => return "noted".to_owned(),
        Continuation::Action => "the action again",
        Continuation::NextAction => "on with the next action",
        Continuation::Sequence => "the sequence again",
        Continuation::Program => "the program again",
        Continuation::Stop => "stop",
    };
    format!("dealt with; {then}")
}

fn motion(event: &Event, report: &MotionReport) -> String {
    let distance_mm = report.distance_m * 1e3;
    if event.instr.is_guarded() {
        let end = match report.end {
            MotionEnd::Reached => "reached its end",
            MotionEnd::StoppedByForce => "stopped by force",
        };
        return format!("{distance_mm:.1} mm, {:.1} N, {end}", report.peak_force_n);
    }
    if report.duration_s == 0.0 {
        return "there already".to_owned();
    }
    format!("{distance_mm:.1} mm in {:.2} s", report.duration_s)
}

fn level_word(is_high: bool) -> &'static str {
    if is_high { "high" } else { "low" }
}
