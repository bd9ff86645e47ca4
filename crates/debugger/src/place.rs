//! Where a session stands, in words that fronts show.

use crate::recording::Moment;
use obverse_bytecode::{ActionKind, Module, SourceEntry};
use obverse_isa::Instr;
use obverse_vm::{Direction, State, can_stop_at};

/// What holds of what is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The run itself: going on commands the workcell, in either direction.
    Live,
    /// An earlier moment of it, or a recording: nothing is commanded.
    Rewound,
    /// A run that left a recorded one to try something: it commands a copy of the workcell.
    WhatIf,
}

impl Mode {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Live => "live",
            Self::Rewound => "rewound",
            Self::WhatIf => "what-if",
        }
    }
}

/// A place in the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourcePlace {
    /// The file, as the program calls it.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1.
    pub column: usize,
}

/// Where a session stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Position {
    /// What holds of it.
    pub mode: Mode,
    /// When.
    pub moment: Moment,
    /// The last moment that there is.
    pub end: Moment,
    /// How many instructions lie between the start of the program and here.
    pub steps: u64,
    /// The next instruction.
    pub pc: u32,
    /// Its source.
    pub place: Option<SourcePlace>,
    /// The function that it is in.
    pub function: String,
    /// What begins or goes on here, if it is an action.
    pub action: Option<ActionKind>,
    /// How many calls are under way.
    pub depth: usize,
    /// Whose turn it is of the forks that are open, outermost first.
    pub branches: Vec<usize>,
    /// Which way the run goes from here; live, which way it came.
    pub direction: Direction,
    /// The workcell's clock, in seconds.
    pub now_s: f64,
    /// Whether an act was begun here and not finished, and which way.
    pub pending: Option<Direction>,
}

/// The source of an instruction.
#[must_use]
pub fn source_place(module: &Module, pc: u32) -> Option<SourcePlace> {
    let (file, line, column) = module.place_of(pc)?;
    Some(SourcePlace { file: file.to_owned(), line, column })
}

/// Whether a machine stands at the beginning of a statement of the source: before its first
/// instruction that is no join.
pub(crate) fn is_at_statement(module: &Module, state: &State) -> bool {
    let pc = state.pc();
    if !state.operands().is_empty() || state.pending().is_some() {
        return false;
    }
    let Some(entry) = module.source_at(pc) else { return false };
    prepared(module, pc).is_none()
        && can_stop_at(module, pc)
        && (entry.first..pc).all(|before| !can_stop_at(module, before))
}

/// The statement that an instruction only prepares, as file, first byte and end: it begins behind
/// that. Attempts are counted from there, and no person wrote it.
#[must_use]
pub fn prepared(module: &Module, pc: u32) -> Option<(u16, u32, u32)> {
    let span = |entry: &SourceEntry| (entry.file, entry.start, entry.end);
    let after = module.source_map.partition_point(|entry| entry.first <= pc);
    let here = module.source_map.get(after.checked_sub(1)?)?;
    let next = module.source_map.get(after)?;
    let locals = &module.functions.get(module.function_at(pc)?)?.locals;
    let is_hidden = |instr: &Instr| match instr {
        Instr::StoreLocal { local, .. } => {
            locals.get(local.index()).is_some_and(|local| local.name.starts_with('$'))
        }
        Instr::Join { .. } | Instr::Land { .. } => true,
        instr => instr.info().family.is_pure(),
    };
    let code = module.code.get(here.first as usize..next.first as usize)?;
    (span(here) == span(next) && code.iter().all(is_hidden)).then(|| span(here))
}
