//! The case that is a program in its workcell: each assembly is a run of a machine from the start,
//! in a workcell that its seed has made.

use crate::case::{Case, Stand};
use crate::outcome::{Ending, Incident, Outcome};
use crate::strategy::Strategy;
use obverse_bytecode::{Module, Verified};
use obverse_sim::{Cell, Sim};
use obverse_vm::{Direction, Limits, LinkError, Machine, Stop};
use obverse_workcell::{Clock, Safety};
use std::collections::BTreeMap;

/// What a machine goes by that learns: nothing, as long as none does.
#[derive(Clone, Debug, Default)]
pub struct Memory(());

/// A program in its workcell.
pub struct MachineCase<'p> {
    /// A machine at the start of the program, which is copied for each assembly.
    machine: Machine<'p>,
    cell: &'p Cell,
    terms: Terms,
}

/// What an assembly may take.
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    /// How long a person takes, each time that one has to come, in seconds.
    pub person_s: f64,
    /// How often a person releases a stopped arm in one assembly.
    pub releases: u32,
    /// How many instructions it may have.
    pub instructions: u64,
}

impl<'p> MachineCase<'p> {
    /// A program in a workcell, assembled on these terms.
    ///
    /// # Errors
    /// What the program needs and the workcell lacks.
    pub fn new(
        program: &'p Verified,
        cell: &'p Cell,
        terms: Terms,
    ) -> Result<Self, Vec<LinkError>> {
        let machine = Machine::new(program, &Sim::new(cell, 0))?;
        Ok(Self { machine, cell, terms })
    }

    /// What was learned, of the text that keeps it.
    ///
    /// # Errors
    /// Why the text is none.
    pub fn memory_of(&self, _text: &str) -> Result<Memory, String> {
        Err("no strategy that learns is known".to_owned())
    }

    /// The text that keeps what was learned.
    #[must_use]
    pub fn text_of(&self, _: &Memory) -> String {
        String::new()
    }

    /// Whether assemblies can be made by a strategy.
    #[must_use]
    pub fn knows(&self, strategy: Strategy) -> bool {
        matches!(strategy, Strategy::Stop | Strategy::Explicit | Strategy::Declared)
    }
}

impl Case for MachineCase<'_> {
    type Memory = Memory;
    type Stand<'c>
        = MachineStand<'c>
    where
        Self: 'c;

    fn stand<'c>(&'c self, _: &'c Memory) -> MachineStand<'c> {
        MachineStand { case: self, places: BTreeMap::new() }
    }

    fn learn(&self, _: &mut Memory, _: &Outcome) {}
}

/// Where one thread runs machines.
pub struct MachineStand<'c> {
    case: &'c MachineCase<'c>,
    /// Where instructions were written, once asked for.
    places: BTreeMap<u32, String>,
}

impl Stand for MachineStand<'_> {
    fn assemble(&mut self, seed: u64, strategy: Strategy) -> Outcome {
        let mut cell = Sim::new(self.case.cell, seed);
        let mut machine = self.case.machine.clone();
        let (mut incidents, mut releases) = (Vec::new(), 0);
        let (ending, why) = loop {
            let limits = Limits::instructions(
                self.case.terms.instructions.saturating_sub(machine.executed()),
            );
            match machine.run(Direction::Forward, limits, &mut cell, &mut ()) {
                Stop::Raised { error, pc } => {
                    let module = machine.program().module();
                    incidents.push(self.incident(module, &module.errors[error.index()].name, pc));
                    if strategy == Strategy::Stop {
                        break (Ending::GivenUp, Some("nothing is tried".to_owned()));
                    }
                }
                Stop::Finished if machine.state().raised().is_empty() => {
                    incidents.iter_mut().for_each(|incident| incident.recovered = true);
                    break (Ending::Succeeded, None);
                }
                Stop::Finished => break (Ending::GivenUp, Some("an error is pending".to_owned())),
                Stop::Fault { .. } if cell.is_stopped() && releases < self.case.terms.releases => {
                    releases += 1;
                    cell.release();
                }
                Stop::Fault { fault, .. } => break (Ending::Fault, Some(fault.to_string())),
                Stop::Trap(trap) => break (Ending::Trap, Some(trap.kind.to_string())),
                Stop::Budget => break (Ending::Limit, Some("too many instructions".to_owned())),
                Stop::AtStart | Stop::AtMark | Stop::OffMark | Stop::Refused(_) => {
                    break (Ending::GivenUp, Some("it cannot be taken back".to_owned()));
                }
            }
        };
        let is_left = ending != Ending::Succeeded;
        let calls = releases + u32::from(is_left);
        Outcome {
            ending,
            why,
            attempts: 0,
            makespan_s: cell.now_s(),
            releases,
            person_s: self.case.terms.person_s * f64::from(calls),
            instructions: machine.executed(),
            incidents,
        }
    }
}

impl MachineStand<'_> {
    fn incident(&mut self, module: &Module, error: &str, pc: u32) -> Incident {
        let place = self.places.entry(pc).or_insert_with(|| match module.place_of(pc) {
            Some((file, line, _)) => format!("{file}:{line}"),
            None => format!("instruction {pc}"),
        });
        Incident {
            error: error.to_owned(),
            place: place.clone(),
            depths: Vec::new(),
            recovered: false,
            cause: None,
        }
    }
}
