//! Where and when a run is to stop: at places of the code, or when something changes.
//!
//! Places are found by line, by name, by kind of action or by opcode. A line without code gives way
//! to the next that has some, and it is told. Knows a module and a moment, not how it came about.

use crate::condition::Expression;
use crate::place::prepared;
use crate::subject::{Look, Value};
use crate::writers::writers;
use obverse_bytecode::text::nearest;
use obverse_bytecode::{ActionKind, FunctionKind, Module};
use obverse_isa::Instr;
use obverse_vm::{Direction, Stops, can_stop_at};
use std::collections::BTreeSet;

/// A breakpoint.
#[derive(Clone, Debug)]
pub struct Breakpoint {
    /// The number that it is called by.
    pub id: u32,
    /// What it stops at.
    pub what: What,
    /// Only if this is true there.
    pub condition: Option<Expression>,
    /// How often it is passed before it stops.
    pub ignored: u64,
    /// Of the times that it is come to and not passed, those at which it stops.
    pub counts: Counts,
    /// How often it has been come to.
    pub hits: u64,
    /// Whether it stops at all.
    pub is_enabled: bool,
    /// Whether it is gone once it has stopped something.
    pub is_temporary: bool,
    /// Only when the run goes this way.
    pub direction: Option<Direction>,
    /// Told, with what is between braces worked out, in place of a stop.
    pub log: Option<Vec<Piece>>,
}

/// At which of the times that it is come to a breakpoint stops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Counts {
    /// At all of them.
    #[default]
    All,
    /// At this one, counted from 1.
    Only(u64),
    /// At those whose number can be divided by this.
    Every(u64),
}

impl Counts {
    fn holds(self, hits: u64) -> bool {
        match self {
            Self::All => true,
            Self::Only(number) => hits == number,
            Self::Every(number) => hits.is_multiple_of(number),
        }
    }
}

/// A piece of what a breakpoint tells.
#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    /// Text.
    Text(String),
    /// Something worked out.
    Value(Expression),
}

/// What a breakpoint stops at.
#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// Places of the code.
    Places {
        /// What a person calls them.
        name: String,
        /// The instructions.
        pcs: BTreeSet<u32>,
        /// Behind them, not before.
        is_after: bool,
    },
    /// A change of what this is.
    Change(Expression),
}

/// A breakpoint was come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Hit {
    /// Which.
    pub id: u32,
    /// What was before and is now, if it stops at changes.
    pub change: Option<(Value, Value)>,
    /// What it tells, if it tells something in place of a stop.
    pub log: Option<String>,
}

/// Why there is no such place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlaceError {
    /// No file of the program has this name.
    NoFile {
        /// What was asked for.
        name: String,
        /// The files that there are.
        known: Vec<String>,
    },
    /// No line from this on has code.
    NoCode {
        /// What was asked for.
        line: usize,
    },
    /// Nothing has this name.
    NoName {
        /// What was asked for.
        name: String,
        /// What was probably meant.
        meant: Option<String>,
    },
    /// There is no such instruction.
    NoInstruction {
        /// What was asked for.
        pc: u32,
        /// How many there are.
        count: usize,
    },
}

impl std::fmt::Display for PlaceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoFile { name, known } => {
                write!(f, "the program has no file `{name}`; it is made of {}", known.join(", "))
            }
            Self::NoCode { line } => write!(f, "there is no code at line {line} or behind it"),
            Self::NoName { name, meant: None } => {
                write!(f, "nothing of the program is called `{name}`")
            }
            Self::NoName { name, meant: Some(meant) } => {
                write!(f, "nothing of the program is called `{name}`; `{meant}`?")
            }
            Self::NoInstruction { pc, count } => {
                write!(f, "there is no instruction {pc}: they are numbered from 0 to {}", count - 1)
            }
        }
    }
}

impl std::error::Error for PlaceError {}

/// Places of the code, and the line that they are on if it is another than was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Places {
    /// What a person calls them.
    pub name: String,
    /// The instructions.
    pub pcs: BTreeSet<u32>,
    /// The line, if they were asked for by one.
    pub line: Option<usize>,
}

impl Places {
    /// Of a line, from 1, of a file; the first file if none is named.
    ///
    /// # Errors
    /// If there is no such file, or no code from there on.
    pub fn of_line(module: &Module, file: Option<&str>, line: usize) -> Result<Self, PlaceError> {
        let known = || module.sources.iter().map(|source| source.name.clone()).collect();
        let index = match file {
            None => 0,
            Some(name) => module
                .sources
                .iter()
                .position(|source| source.name == name)
                .ok_or_else(|| PlaceError::NoFile { name: name.to_owned(), known: known() })?,
        };
        let lines = module.sources.get(index).map(|source| line_starts(&source.text));
        let lines = lines.unwrap_or_default();
        let line_of = |start: u32| lines.partition_point(|begin| *begin <= start as usize);
        let starts = module.source_map.iter().filter(|entry| usize::from(entry.file) == index);
        let found = starts.clone().map(|entry| line_of(entry.start)).filter(|of| *of >= line).min();
        let found = found.ok_or(PlaceError::NoCode { line })?;
        let on_it = starts.filter(|entry| line_of(entry.start) == found);
        let firsts: Vec<(u32, u32)> = on_it.map(|entry| (entry.start, entry.first)).collect();
        // Of a statement that is in the code in several pieces, each is where it may begin; of
        // several statements on a line, the first.
        let first = firsts.iter().map(|(start, _)| *start).min().unwrap_or(0);
        let entries = firsts.into_iter().filter(|(start, _)| *start == first);
        let pcs = entries.filter_map(|(_, pc)| stop_from(module, pc));
        let pcs = pcs.filter(|pc| prepared(module, *pc).is_none()).collect();
        let name = format!("{}:{found}", module.sources[index].name);
        Ok(Self { name, pcs, line: Some(found) })
    }

    /// Of a sequence, an action, an I/O operation or an advanced move; of a checkpoint; of an
    /// opcode; or of a kind of action (`move`, `advance`, `call`, `io`, `wait`, `primitive`).
    ///
    /// # Errors
    /// If nothing has this name.
    pub fn of_name(module: &Module, name: &str) -> Result<Self, PlaceError> {
        let at = |pcs: BTreeSet<u32>| Self { name: name.to_owned(), pcs, line: None };
        let is_hidden = |kind| matches!(kind, FunctionKind::Start | FunctionKind::Replacement);
        let functions = module.functions.iter().filter(|function| !is_hidden(function.kind));
        let mut named = functions.clone().filter(|function| function.name == name);
        if let Some(function) = named.next() {
            return Ok(at(stop_from(module, function.first).into_iter().collect()));
        }
        if let Some(checkpoint) = module.checkpoints.iter().position(|known| known == name) {
            let is_it = |instr: &Instr| match instr {
                Instr::Checkpoint { checkpoint: at } => at.index() == checkpoint,
                _ => false,
            };
            return Ok(at(instructions(module, is_it)));
        }
        if let Some(kind) = action_kind(name) {
            let entries = module.source_map.iter().filter(|entry| entry.action == Some(kind));
            return Ok(at(entries.filter_map(|entry| stop_from(module, entry.first)).collect()));
        }
        let with_mnemonic = instructions(module, |instr: &Instr| instr.info().mnemonic == name);
        if !with_mnemonic.is_empty() {
            return Ok(at(with_mnemonic));
        }
        let names = functions.map(|function| function.name.as_str());
        let names = names.chain(module.checkpoints.iter().map(String::as_str));
        let meant = nearest(name, names.chain(ACTIONS.iter().map(|(name, _)| *name)));
        Err(PlaceError::NoName { name: name.to_owned(), meant: meant.map(str::to_owned) })
    }

    /// Of an error of the program: where the code raises it.
    ///
    /// # Errors
    /// If there is no such error.
    pub fn of_error(module: &Module, name: &str) -> Result<Self, PlaceError> {
        let mut errors = module.errors.iter();
        let Some(index) = errors.position(|error| error.name == name) else {
            let meant = nearest(name, module.errors.iter().map(|error| error.name.as_str()));
            let (name, meant) = (name.to_owned(), meant.map(str::to_owned));
            return Err(PlaceError::NoName { name, meant });
        };
        let raises =
            |instr: &Instr| matches!(instr, Instr::ErrorRaise { error } if error.index() == index);
        let pcs = instructions(module, raises);
        Ok(Self { name: format!("error {name}"), pcs, line: None })
    }

    /// Of an instruction, or the first after it before which a run can stop.
    ///
    /// # Errors
    /// If there is none.
    pub fn of_instruction(module: &Module, pc: u32) -> Result<Self, PlaceError> {
        let missing = PlaceError::NoInstruction { pc, count: module.code.len() };
        let found = stop_from(module, pc).ok_or(missing)?;
        Ok(Self { name: format!("instruction {found}"), pcs: [found].into(), line: None })
    }
}

const ACTIONS: [(&str, ActionKind); 6] = [
    ("move", ActionKind::Move),
    ("advance", ActionKind::Advance),
    ("call", ActionKind::Call),
    ("io", ActionKind::Io),
    ("wait", ActionKind::Wait),
    ("primitive", ActionKind::Primitive),
];

fn action_kind(name: &str) -> Option<ActionKind> {
    ACTIONS.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind)
}

/// The word for a kind of action.
#[must_use]
pub fn action_name(kind: ActionKind) -> &'static str {
    ACTIONS.iter().find(|(_, known)| *known == kind).map_or("", |(name, _)| name)
}

fn instructions(module: &Module, is_it: impl Fn(&Instr) -> bool) -> BTreeSet<u32> {
    let found = (0..).zip(&module.code).filter(|(_, instr)| is_it(instr));
    found.map(|(pc, _)| pc).filter(|pc| can_stop_at(module, *pc)).collect()
}

/// The first instruction from one on, in its function, before which a run can stop.
fn stop_from(module: &Module, pc: u32) -> Option<u32> {
    let end = module.functions.get(module.function_at(pc)?)?.end;
    (pc..end).find(|pc| can_stop_at(module, *pc))
}

/// The first byte of each line of a text.
pub(crate) fn line_starts(text: &str) -> Vec<usize> {
    let bytes = text.as_bytes();
    let ends = (0..bytes.len()).filter(|&at| match bytes[at] {
        b'\n' => true,
        b'\r' => bytes.get(at + 1) != Some(&b'\n'),
        _ => false,
    });
    std::iter::once(0).chain(ends.map(|at| at + 1)).collect()
}

/// What is looked at before a run goes on, to see what has changed behind it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Before {
    pc: Option<u32>,
    values: Vec<(u32, Value)>,
}

impl Before {
    pub(crate) fn of(breakpoints: &[Breakpoint], look: &Look<'_>) -> Self {
        let value = |it: &Breakpoint| match &it.what {
            What::Change(expression) if it.is_enabled => Some((it.id, expression.value(look))),
            _ => None,
        };
        Self { pc: Some(look.state.pc()), values: breakpoints.iter().filter_map(value).collect() }
    }

    fn value(&self, id: u32) -> Option<&Value> {
        self.values.iter().find(|(of, _)| *of == id).map(|(_, value)| value)
    }
}

impl Breakpoint {
    /// Before these places.
    #[must_use]
    pub fn at(places: Places) -> Self {
        let Places { name, pcs, .. } = places;
        Self::on(What::Places { name, pcs, is_after: false })
    }

    /// When this changes, going either way.
    #[must_use]
    pub fn on_change(expression: Expression) -> Self {
        Self::on(What::Change(expression))
    }

    fn on(what: What) -> Self {
        Self {
            id: 0,
            what,
            condition: None,
            ignored: 0,
            counts: Counts::All,
            hits: 0,
            is_enabled: true,
            is_temporary: false,
            direction: None,
            log: None,
        }
    }

    /// Whether it stops at the hit that was counted last.
    pub(crate) fn stops_now(&self) -> bool {
        self.hits > self.ignored && self.counts.holds(self.hits)
    }

    /// Whether it is come to here, going some way from what was before.
    pub(crate) fn hit(
        &self,
        before: &Before,
        look: &Look<'_>,
        direction: Direction,
    ) -> Option<Hit> {
        let is_way = self.direction.is_none_or(|only| only == direction);
        if !self.is_enabled || !is_way {
            return None;
        }
        let change = match &self.what {
            What::Places { pcs, is_after, .. } => {
                let at = if *is_after { before.pc } else { Some(look.state.pc()) };
                if !at.is_some_and(|at| pcs.contains(&at)) || look.state.pending().is_some() {
                    return None;
                }
                None
            }
            What::Change(expression) => {
                let (was, is) = (before.value(self.id)?, expression.value(look));
                if *was == is {
                    return None;
                }
                Some((was.clone(), is))
            }
        };
        if self.condition.as_ref().is_some_and(|condition| !condition.holds(look)) {
            return None;
        }
        let log = self.log.as_ref().map(|pieces| told(pieces, look));
        Some(Hit { id: self.id, change, log })
    }

    /// The instructions before which a run must stop for it; none if that is every one.
    fn stops(&self, module: &Module) -> Option<Vec<u32>> {
        match &self.what {
            What::Places { pcs, .. } => Some(pcs.iter().copied().collect()),
            What::Change(expression) => writers(module, expression),
        }
    }
}

fn told(pieces: &[Piece], look: &Look<'_>) -> String {
    let piece = |piece: &Piece| match piece {
        Piece::Text(text) => text.clone(),
        Piece::Value(expression) => expression.value(look).to_string(),
    };
    pieces.iter().map(piece).collect()
}

/// The instructions before which a run must stop for any of these; none if that is every one.
pub(crate) fn stops(module: &Module, breakpoints: &[Breakpoint]) -> Option<Stops> {
    let enabled = breakpoints.iter().filter(|breakpoint| breakpoint.is_enabled);
    let all: Option<Vec<Vec<u32>>> = enabled.map(|breakpoint| breakpoint.stops(module)).collect();
    Some(Stops::new(module, all?.into_iter().flatten()))
}
