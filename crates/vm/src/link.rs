//! Linking: a module's names to a workcell's numbers, once, before anything moves.

use crate::values::Settings;
use obverse_bytecode::{Mentioned, Module, Watched};
use obverse_isa::{Instr, Setting};
use obverse_workcell::{Condition, ItemId, Watch, Workcell};
use std::collections::BTreeMap;
use std::fmt;

/// What a module's items and tools are in a workcell.
#[derive(Clone, Debug, Default)]
pub struct Links {
    /// By the module's items.
    pub(crate) items: Vec<ItemId>,
    /// By the module's tools.
    pub(crate) tools: Vec<u64>,
    /// What is watched while the program acts, by the errors that it raises.
    pub(crate) watches: Vec<Watch>,
    /// The settings that hold when the program starts.
    pub(crate) settings: Settings,
}

/// What a module needs and a workcell has not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LinkError {
    /// An item.
    Item {
        /// Its name.
        name: String,
        /// Which of the module's items.
        index: u16,
    },
    /// A tool.
    Tool {
        /// Its name.
        name: String,
        /// Which of the module's tools.
        index: u16,
    },
    /// A digital output: which, and how many there are.
    Output {
        /// Which.
        bit: u16,
        /// How many there are.
        count: u16,
        /// The first instruction that needs it; none where it is only named.
        pc: Option<u32>,
    },
    /// A digital input.
    Input {
        /// Which.
        bit: u16,
        /// How many there are.
        count: u16,
        /// The first instruction that needs it; none where it is only named.
        pc: Option<u32>,
    },
}

impl fmt::Display for LinkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Item { name, .. } => write!(f, "the workcell has no item `{name}`"),
            Self::Tool { name, .. } => write!(f, "the workcell has no tool `{name}`"),
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
        for (item, index) in module.items.iter().zip(0..) {
            match cell.item(&item.name) {
                Some(found) => links.items.push(found),
                None => errors.push(LinkError::Item { name: item.name.clone(), index }),
            }
        }
        for (tool, index) in module.tools.iter().zip(0..) {
            match cell.tool(tool) {
                Some(found) => links.tools.push(u64::from(found.0)),
                None => errors.push(LinkError::Tool { name: tool.clone(), index }),
            }
        }
        errors.extend(missing_lines(module, cell));
        links.watches = watches(module);
        for setting in Setting::ALL {
            links.settings[*setting as usize] = setting.initial();
        }
        links.settings[Setting::Tool as usize] = u64::from(cell.initial_tool().0);
        if errors.is_empty() { Ok(links) } else { Err(errors) }
    }
}

/// What a module's errors have watched, in the order of their declaration.
fn watches(module: &Module) -> Vec<Watch> {
    let mut watches = Vec::new();
    for (number, error) in (0..).zip(&module.errors) {
        let stops = error.interrupts();
        watches.extend(error.watches.iter().map(|watched| {
            let condition = match *watched {
                Watched::Input { bit, level } => Condition::Input { bit, level },
                Watched::Force { above_n } => Condition::Force { above_n },
            };
            Watch { number, condition, stops }
        }));
    }
    watches
}

/// The outputs and inputs that are not there, each once: those that the code needs, those that are
/// watched, and those that the program's I/O map names.
fn missing_lines(module: &Module, cell: &dyn Workcell) -> Vec<LinkError> {
    let outputs = |bit: u16| bit >= cell.output_count();
    let inputs = |bit: u16| bit >= cell.input_count();
    let (mut no_outputs, mut no_inputs) = (BTreeMap::new(), BTreeMap::new());
    for (pc, instr) in (0..).zip(&module.code) {
        match *instr {
            Instr::OutputSet { bit, .. } | Instr::OutputToggle { bit, .. } if outputs(bit.0) => {
                no_outputs.entry(bit.0).or_insert(Some(pc));
            }
            Instr::SenseInput { bit, .. } | Instr::WaitInput { bit, .. } if inputs(bit.0) => {
                no_inputs.entry(bit.0).or_insert(Some(pc));
            }
            _ => {}
        }
    }
    for watched in module.errors.iter().flat_map(|error| &error.watches) {
        if let Watched::Input { bit, .. } = *watched
            && inputs(bit)
        {
            no_inputs.entry(bit).or_insert(None);
        }
    }
    for mention in &module.mentions {
        match mention.what {
            Mentioned::Output { bit, .. } if outputs(bit) => {
                no_outputs.entry(bit).or_insert(None);
            }
            Mentioned::Input { bit, .. } if inputs(bit) => {
                no_inputs.entry(bit).or_insert(None);
            }
            _ => {}
        }
    }
    let output = |(bit, pc)| LinkError::Output { bit, count: cell.output_count(), pc };
    let input = |(bit, pc)| LinkError::Input { bit, count: cell.input_count(), pc };
    no_outputs.into_iter().map(output).chain(no_inputs.into_iter().map(input)).collect()
}
