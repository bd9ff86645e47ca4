//! The case that is a program in its workcell: each assembly is a run of a machine from the start,
//! in a workcell that its seed has made.

use crate::case::{Case, Stand};
use crate::outcome::{Ending, Incident, Outcome};
use crate::strategy::Strategy;
use obverse_bytecode::{Module, Verified};
use obverse_recovery::{Bounds, Clairvoyant, Foresight, Memory, Operator, Recovery, Site, recover};
use obverse_sim::{Cell, Missed, Sim};
use obverse_vm::{Limits, LinkError, Machine};
use obverse_workcell::{Clock, Fault};

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
}

impl Case for MachineCase<'_> {
    type Memory = Memory;
    type Stand<'c>
        = MachineStand<'c>
    where
        Self: 'c;

    fn stand<'c>(&'c self, memory: &'c Memory) -> MachineStand<'c> {
        MachineStand { case: self, memory: memory.clone() }
    }

    fn learn(&self, memory: &mut Memory, outcome: &Outcome) {
        for incident in &outcome.incidents {
            if let Some((depths, was_enough)) = &incident.lesson {
                memory.learn(&incident.error, &incident.place, depths, *was_enough);
            }
        }
    }
}

/// Where one thread runs machines.
pub struct MachineStand<'c> {
    case: &'c MachineCase<'c>,
    memory: Memory,
}

/// A person who releases a stopped arm so often.
struct Releases {
    left: u32,
    given: u32,
}

impl Operator for Releases {
    fn release(&mut self, _: &Fault) -> bool {
        let is_given = self.left > 0;
        self.left -= u32::from(is_given);
        self.given += u32::from(is_given);
        is_given
    }
}

impl Stand for MachineStand<'_> {
    fn assemble(&mut self, seed: u64, strategy: Strategy) -> Outcome {
        let terms = &self.case.terms;
        let mut cell = Sim::new(self.case.cell, seed);
        let mut machine = self.case.machine.clone();
        let mut operator = Releases { left: terms.releases, given: 0 };
        let (mut seer, answer) = (Seer::default(), strategy.answer());
        let mut recovery = Recovery {
            strategy: answer,
            bounds: Bounds::default(),
            memory: &mut self.memory,
            // What this stand goes by stays as it was; lessons are drawn from the outcomes.
            remembers: false,
            person_s: terms.person_s,
            seed,
            operator: &mut operator,
            foresight: Some(&mut seer),
            incidents: Vec::new(),
        };
        let limits = Limits::instructions(terms.instructions);
        let ended = recover(&mut machine, limits, &mut cell, &mut recovery, &mut ());
        let incidents = recovery.incidents;
        let module = machine.program().module();
        let (ending, why) = match ending(module, &ended) {
            (Ending::Succeeded, _) => judged(&cell),
            other => other,
        };
        let goes_on = answer.goes_on_when_given_up();
        let calls = operator.given + u32::from(ending != Ending::Succeeded);
        Outcome {
            ending,
            why,
            attempts: incidents.iter().map(|incident| incident.attempts.len() as u32).sum(),
            makespan_s: cell.now_s(),
            releases: operator.given,
            person_s: terms.person_s * f64::from(calls),
            instructions: machine.executed(),
            // What reversal gives up the code behind it may still put right.
            incidents: incidents
                .iter()
                .map(|found| {
                    let put_right = goes_on && ended == obverse_recovery::Ending::Finished;
                    incident(module, found, put_right, seer.cause_of(found))
                })
                .collect(),
        }
    }
}

/// Sees what is truly wrong when an error is due.
#[derive(Default)]
struct Seer {
    /// The error, when it was due, and the cause.
    causes: Vec<(u16, f64, Option<String>)>,
}

impl Foresight<Sim> for Seer {
    fn depth(&mut self, site: &Site<'_, '_, Sim>) -> Option<usize> {
        Clairvoyant.depth(site)
    }

    fn on_error(&mut self, incident: &obverse_recovery::Incident, cell: &Sim) {
        let mut codes: Vec<&str> = cell.truth().iter().map(|cause| cause.kind.code()).collect();
        codes.sort_unstable();
        codes.dedup();
        let cause = (!codes.is_empty()).then(|| codes.join("+"));
        self.causes.push((incident.error.0, incident.began_s, cause));
    }
}

impl Seer {
    fn cause_of(&self, found: &obverse_recovery::Incident) -> Option<String> {
        let is_it = |(error, began_s, _): &&(u16, f64, Option<String>)| {
            *error == found.error.0 && *began_s == found.began_s
        };
        self.causes.iter().find(is_it).and_then(|(.., cause)| cause.clone())
    }
}

/// How an assembly ended, and why if not by success.
fn ending(module: &Module, ended: &obverse_recovery::Ending) -> (Ending, Option<String>) {
    use obverse_recovery::Ending as Ended;
    let name = |error: obverse_isa::ErrorId| module.errors[error.index()].name.as_str();
    match ended {
        Ended::Finished => (Ending::Succeeded, None),
        Ended::Unhandled(errors) => {
            let names: Vec<&str> = errors.iter().map(|error| name(*error)).collect();
            (Ending::GivenUp, Some(format!("pending: {}", names.join(", "))))
        }
        Ended::GivenUp { error, why, .. } => {
            (Ending::GivenUp, Some(format!("{}: {}", name(*error), why.code())))
        }
        Ended::AtStart | Ended::Refused(_) => (Ending::GivenUp, Some(ended.code().to_owned())),
        Ended::Fault { fault, .. } => (Ending::Fault, Some(fault.kind().code().to_owned())),
        Ended::Trap(trap) => (Ending::Trap, Some(trap.kind.to_string())),
        Ended::Budget => (Ending::Limit, Some("instructions".to_owned())),
    }
}

/// How a run ended that believes that it has succeeded: by what is truly so.
fn judged(cell: &Sim) -> (Ending, Option<String>) {
    let missed = cell.missed_goals();
    let word = |missed: &Missed| format!("{}: {}", missed.what, missed.why.code());
    let words: Vec<String> = missed.iter().map(word).collect();
    match words.is_empty() {
        true => (Ending::Succeeded, None),
        false => (Ending::FalseSuccess, Some(words.join("; "))),
    }
}

fn incident(
    module: &Module,
    found: &obverse_recovery::Incident,
    put_right: bool,
    cause: Option<String>,
) -> Incident {
    let is_recovered = matches!(found.outcome, Some((obverse_recovery::Outcome::Recovered, _)));
    Incident {
        error: module.errors[found.error.index()].name.clone(),
        place: found.place.clone(),
        depths: found.attempts.iter().map(|attempt| attempt.actions as u32).collect(),
        recovered: is_recovered || put_right,
        otherwise: !is_recovered && put_right,
        lesson: found.lesson(),
        cause,
    }
}
