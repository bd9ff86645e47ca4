//! The case that is a program in its workcell: each assembly is a run of a machine from the start,
//! in a workcell that its seed has made.

use crate::case::{Case, Stand};
use crate::outcome::{Ending, Incident, Outcome, Stop};
use crate::stops::Stops;
use crate::strategy::Strategy;
use obverse_bytecode::{Module, Verified};
use obverse_isa::ErrorId;
use obverse_recovery::{
    Bounds, Clairvoyant, Foresight, Memory, Operator, Recovery, Site, place, recover,
};
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

/// A person who releases a stopped arm as often as is left.
struct Releases<'r>(&'r std::cell::Cell<u32>);

impl Operator for Releases<'_> {
    fn release(&mut self, _: &Fault) -> bool {
        let left = self.0.get();
        self.0.set(left.saturating_sub(1));
        left > 0
    }
}

impl Stand for MachineStand<'_> {
    fn assemble(&mut self, seed: u64, strategy: Strategy) -> Outcome {
        let terms = &self.case.terms;
        let mut cell = Sim::new(self.case.cell, seed);
        let mut machine = self.case.machine.clone();
        let releases = std::cell::Cell::new(terms.releases);
        let mut operator = Releases(&releases);
        let mut seer = Seer { releases: &releases, causes: Vec::new() };
        let answer = strategy.answer();
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
        let mut stops = Stops::default();
        let ended = recover(&mut machine, limits, &mut cell, &mut recovery, &mut stops);
        let found = recovery.incidents;
        let module = machine.program().module();
        // What reversal gives up the code behind it may still put right.
        let put_right =
            answer.goes_on_when_given_up() && ended == obverse_recovery::Ending::Finished;
        let released = stops.released(&found);
        let mut incidents: Vec<Incident> = found
            .iter()
            .zip(released)
            .map(|(found, is_released)| Incident {
                stop: is_released.then_some(Stop::Released),
                ..incident(module, found, put_right, seer.cause_of(found))
            })
            .collect();
        if let Some(held) = stops.held(&ended) {
            hold(&mut incidents, module, held, &cell);
        }
        let (ending, why) = match ending(module, &ended) {
            (Ending::Succeeded, _) => judged(&cell),
            other => other,
        };
        let given = terms.releases - releases.get();
        let calls = given + u32::from(ending != Ending::Succeeded);
        Outcome {
            ending,
            why,
            attempts: incidents.iter().map(|incident| incident.depths.len() as u32).sum(),
            makespan_s: cell.now_s(),
            releases: given,
            person_s: terms.person_s * f64::from(calls),
            instructions: machine.executed(),
            incidents,
        }
    }
}

/// Sees what is truly wrong when an error is due.
struct Seer<'r> {
    /// How often a person will still release a stopped arm.
    releases: &'r std::cell::Cell<u32>,
    /// The error, when it was due, and the cause.
    causes: Vec<(u16, f64, Option<String>)>,
}

impl Foresight<Sim> for Seer<'_> {
    fn depth(&mut self, site: &Site<'_, '_, Sim>) -> Option<usize> {
        Clairvoyant { releases: self.releases.get() }.depth(site)
    }

    fn on_error(&mut self, incident: &obverse_recovery::Incident, cell: &Sim) {
        self.causes.push((incident.error.0, incident.began_s, cause(cell)));
    }
}

/// What is truly wrong in a workcell.
fn cause(cell: &Sim) -> Option<String> {
    let mut codes: Vec<&str> = cell.truth().iter().map(|cause| cause.kind.code()).collect();
    codes.sort_unstable();
    codes.dedup();
    (!codes.is_empty()).then(|| codes.join("+"))
}

impl Seer<'_> {
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
        stop: None,
        lesson: found.lesson(),
        cause,
    }
}

/// An error at an act whose fault a stop held, so that it was never due: an incident of its own,
/// unless it was the same again.
fn hold(incidents: &mut Vec<Incident>, module: &Module, (error, pc): (ErrorId, u32), cell: &Sim) {
    let (error, place) = (module.errors[error.index()].name.clone(), place(module, pc));
    let is_again =
        |open: &&mut Incident| !open.recovered && open.error == error && open.place == place;
    if let Some(again) = incidents.iter_mut().find(is_again) {
        again.stop = Some(Stop::Held);
        return;
    }
    incidents.push(Incident {
        error,
        place,
        depths: Vec::new(),
        recovered: false,
        otherwise: false,
        stop: Some(Stop::Held),
        lesson: None,
        cause: cause(cell),
    });
}
