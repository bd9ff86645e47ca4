//! The story of a run, in lines that a person follows: where the program is, what the robot did,
//! what came of it, and when.

use crate::write;
use obverse_bytecode::{FunctionKind, Module};
use obverse_isa::{Instr, Level};
use obverse_vm::{Direction, Event, Observer};
use obverse_workcell::{MotionEnd, MotionReport, Workcell};

/// How wide the column of what the program says is.
const TEXT_COLUMNS: usize = 52;

/// Tells a run as it happens.
pub(crate) struct Story<'m> {
    module: &'m Module,
    /// Whether anything has been told: the heads of sequences come with what happens in them.
    began: bool,
}

impl<'m> Story<'m> {
    pub(crate) fn new(module: &'m Module) -> Self {
        Self { module, began: false }
    }

    fn tell(&mut self, event: &Event, cell: &dyn Workcell, text: &str, outcome: &str) {
        if !self.began {
            write::line(&format!("{:>9}", "time"));
            self.began = true;
        }
        let arrow = match event.direction {
            Direction::Forward => ' ',
            Direction::Reverse => '<',
        };
        let depth = event.frames.saturating_sub(2);
        let text = format!("{}{text}", "  ".repeat(depth));
        let time = format!("{:.2} s", cell.now_s());
        let line = format!("{time:>9} {arrow} {text:<TEXT_COLUMNS$} {outcome}");
        write::line(line.trim_end());
    }
}

impl Observer for Story<'_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        if let Instr::Call { function, .. } | Instr::BlockReplace { function, .. } = event.instr {
            let called = &self.module.functions[function.index()];
            let text = format!("{} {}", kind_word(called.kind), called.name);
            // Going in, the call's own depth; a reverse entry is told at the return.
            let mut at_call = *event;
            at_call.frames = event.frames - usize::from(event.direction == Direction::Forward);
            let outcome = match event.instr {
                Instr::BlockReplace { .. } => "in place of going back",
                _ => "",
            };
            if event.direction == Direction::Forward || !outcome.is_empty() {
                self.tell(&at_call, cell, &text, outcome);
            }
            return;
        }
        let Some(outcome) = outcome_of(self.module, event, cell) else { return };
        let text = said(self.module, event.pc);
        self.tell(event, cell, &text, &outcome);
    }
}

pub(crate) fn kind_word(kind: FunctionKind) -> &'static str {
    match kind {
        FunctionKind::Start => "start",
        FunctionKind::Sequence => "sequence",
        FunctionKind::Action => "action",
        FunctionKind::Io => "io",
        FunctionKind::AdvancedMove => "advance",
        FunctionKind::Replacement => "block",
    }
}

/// What the program says at an instruction, on one line.
pub(crate) fn said(module: &Module, pc: u32) -> String {
    let entry = module.source_at(pc);
    let text = entry.and_then(|entry| {
        let file = module.sources.get(usize::from(entry.file))?;
        file.text.get(entry.start as usize..entry.end as usize)
    });
    let Some(text) = text else {
        return obverse_bytecode::text::instruction(module, pc).unwrap_or_default();
    };
    let line = text.lines().next().unwrap_or("").trim();
    let short: String = line.chars().take(TEXT_COLUMNS).collect();
    short.trim_end_matches(['{', ' ']).to_owned()
}

/// What an instruction did, if it is worth telling.
pub(crate) fn outcome_of(module: &Module, event: &Event, cell: &dyn Workcell) -> Option<String> {
    let is_reverse = event.direction == Direction::Reverse;
    Some(match event.instr {
        Instr::OutputSet { bit, level, .. } => {
            let level = if is_reverse { level_word(cell.output(bit.0)) } else { word(level) };
            format!("output {} {level}", bit.0)
        }
        Instr::OutputToggle { bit, .. } => {
            format!("output {} {}", bit.0, level_word(cell.output(bit.0)))
        }
        Instr::Wait { .. } if is_reverse => return None,
        Instr::Wait { .. } => "waited".to_owned(),
        Instr::WaitInput { bit, level, .. } if !is_reverse => {
            let is_there = cell.input(bit.0) == Ok(level.is_high());
            let found = if is_there { "came" } else { "did not come in time" };
            format!("input {} {} {found}", bit.0, word(level))
        }
        Instr::ErrorRaise { error } if is_reverse => {
            format!("error {} taken back", module.errors[error.index()].name)
        }
        Instr::ErrorRaise { error } => format!("error {}", module.errors[error.index()].name),
        Instr::ErrorClear { error } if !is_reverse => {
            format!("error {} dealt with", module.errors[error.index()].name)
        }
        Instr::Barrier { reason } | Instr::Irreversible { reason } => {
            format!("no way back from here: {}", module.reasons[reason.index()])
        }
        _ => return event.report.map(|report| motion(event, &report)),
    })
}

fn motion(event: &Event, report: &MotionReport) -> String {
    let is_guarded = matches!(event.instr, Instr::MoveGuarded { .. });
    if event.direction == Direction::Reverse {
        return format!("back in {:.2} s", report.duration_s);
    }
    if is_guarded {
        let end = match report.end {
            MotionEnd::Reached => "reached its end",
            MotionEnd::StoppedByForce => "stopped by force",
        };
        return format!("{:.1} mm, {:.1} N, {end}", report.distance_m * 1e3, report.peak_force_n);
    }
    format!("{:.1} mm in {:.2} s", report.distance_m * 1e3, report.duration_s)
}

fn word(level: Level) -> &'static str {
    level_word(level.is_high())
}

fn level_word(is_high: bool) -> &'static str {
    if is_high { "high" } else { "low" }
}
