//! Linking: a module's names to a workcell's numbers, once, before anything moves.

use crate::values::Settings;
use obverse_bytecode::Module;
use obverse_isa::{Instr, Setting};
use obverse_workcell::{ItemId, Workcell};
use std::fmt;

/// What a module's items and tools are in a workcell.
#[derive(Clone, Debug, Default)]
pub struct Links {
    /// By the module's items.
    pub(crate) items: Vec<ItemId>,
    /// By the module's tools.
    pub(crate) tools: Vec<u64>,
    /// The settings that hold when the program starts.
    pub(crate) settings: Settings,
}

/// What a module needs and a workcell has not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LinkError {
    /// An item.
    Item(String),
    /// A tool.
    Tool(String),
    /// A digital output: the one asked for at an instruction, and how many there are.
    Output {
        /// Which.
        bit: u16,
        /// How many there are.
        count: u16,
        /// The instruction.
        pc: u32,
    },
    /// A digital input.
    Input {
        /// Which.
        bit: u16,
        /// How many there are.
        count: u16,
        /// The instruction.
        pc: u32,
    },
}

impl fmt::Display for LinkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Item(name) => write!(f, "the workcell has no item `{name}`; name it in its file"),
            Self::Tool(name) => write!(f, "the workcell has no tool `{name}`; name it in its file"),
            Self::Output { bit, count, .. } => {
                write!(f, "there is no output {bit}: the workcell has {count}, numbered from 0")
            }
            Self::Input { bit, count, .. } => {
                write!(f, "there is no input {bit}: the workcell has {count}, numbered from 0")
            }
        }
    }
}

impl std::error::Error for LinkError {}

impl Links {
    /// Link a module to a workcell.
    ///
    /// # Errors
    /// All that the workcell lacks.
    pub fn new(module: &Module, cell: &dyn Workcell) -> Result<Self, Vec<LinkError>> {
        let mut errors = Vec::new();
        let mut links = Self::default();
        for item in &module.items {
            match cell.item(&item.name) {
                Some(found) => links.items.push(found),
                None => errors.push(LinkError::Item(item.name.clone())),
            }
        }
        for tool in &module.tools {
            match cell.tool(tool) {
                Some(found) => links.tools.push(u64::from(found.0)),
                None => errors.push(LinkError::Tool(tool.clone())),
            }
        }
        for (pc, instr) in module.code.iter().enumerate() {
            errors.extend(missing_line(pc as u32, instr, cell));
        }
        for setting in Setting::ALL {
            links.settings[*setting as usize] = setting.initial();
        }
        links.settings[Setting::Tool as usize] = u64::from(cell.initial_tool().0);
        if errors.is_empty() { Ok(links) } else { Err(errors) }
    }
}

fn missing_line(pc: u32, instr: &Instr, cell: &dyn Workcell) -> Option<LinkError> {
    match *instr {
        Instr::OutputSet { bit, .. } | Instr::OutputToggle { bit, .. } => {
            let count = cell.output_count();
            (bit.0 >= count).then_some(LinkError::Output { bit: bit.0, count, pc })
        }
        Instr::SenseInput { bit, .. } | Instr::WaitInput { bit, .. } => {
            let count = cell.input_count();
            (bit.0 >= count).then_some(LinkError::Input { bit: bit.0, count, pc })
        }
        _ => None,
    }
}
