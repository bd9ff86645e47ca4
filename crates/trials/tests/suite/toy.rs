//! A case of which everything is known: in three assemblies of ten something jams, and going back
//! by one to four actions, as the seed says, helps.

use obverse_trials::{Case, Ending, Incident, Outcome, Plan, Record, Shard, Stand, Strategy};
use std::convert::Infallible;

pub(crate) const PERSON_S: f64 = 300.0;

/// How often each depth was what helped.
pub(crate) type Memory = Vec<u64>;

pub(crate) struct Toy;

impl Case for Toy {
    type Memory = Memory;
    type Stand<'c> = ToyStand<'c>;

    fn stand<'c>(&'c self, memory: &'c Memory) -> ToyStand<'c> {
        ToyStand(memory)
    }

    fn learn(&self, memory: &mut Memory, outcome: &Outcome) {
        memory.resize(5, 0);
        for incident in &outcome.incidents {
            let cause = incident.cause.as_deref().and_then(|cause| cause.strip_prefix("cause "));
            memory[cause.expect("it is known").parse::<usize>().expect("a number")] += 1;
        }
    }
}

pub(crate) struct ToyStand<'c>(&'c Memory);

impl Stand for ToyStand<'_> {
    fn assemble(&mut self, seed: u64, strategy: Strategy) -> Outcome {
        let needed = seed % 4 + 1;
        let is_jammed = seed / 8 % 10 < 3;
        let tried: Vec<u32> = match (is_jammed, strategy) {
            (false, _) | (_, Strategy::Stop) => Vec::new(),
            (true, Strategy::Retry) => vec![0; 3],
            (true, Strategy::Escalating) => (1..=needed as u32).collect(),
            (true, Strategy::Fixed(depth)) => vec![depth],
            (true, Strategy::Learned) => {
                let most = (0..self.0.len()).max_by_key(|depth| (self.0[*depth], *depth));
                vec![most.unwrap_or(1) as u32]
            }
            (true, _) => vec![needed as u32],
        };
        let recovered = tried.last().is_some_and(|depth| u64::from(*depth) >= needed);
        let is_left = is_jammed && !recovered;
        let incident = Incident {
            error: "jammed".to_owned(),
            place: "toy.obv:7".to_owned(),
            depths: tried.clone(),
            recovered,
            otherwise: false,
            stop: None,
            lesson: None,
            cause: Some(format!("cause {needed}")),
        };
        Outcome {
            ending: if is_left { Ending::GivenUp } else { Ending::Succeeded },
            why: is_left.then(|| "attempts".to_owned()),
            attempts: tried.len() as u32,
            makespan_s: 20.0 + (seed % 1000) as f64 / 300.0 + 3.0 * tried.len() as f64,
            releases: 0,
            person_s: if is_left { PERSON_S } else { 0.0 },
            instructions: seed % 97,
            incidents: if is_jammed { vec![incident] } else { Vec::new() },
        }
    }
}

pub(crate) fn plan(strategies: &str, runs: u64) -> Plan {
    Plan {
        version: "0".to_owned(),
        program: "toy.obv".to_owned(),
        program_digest: "1".to_owned(),
        cell_digest: "2".to_owned(),
        goals: 1,
        sequences: 1,
        memory_digest: None,
        strategies: Strategy::list(strategies).expect("a list"),
        seed: 5,
        runs,
        person_s: PERSON_S,
        releases: 0,
        instructions: 1000,
    }
}

/// What comes of a shard on so many threads, with what is learned on them before.
pub(crate) fn records(plan: &Plan, shard: Shard, jobs: usize) -> Vec<Record> {
    let memory = obverse_trials::learn(&Toy, Vec::new(), plan.seed, 200, jobs, &mut |_| {});
    let mut records = Vec::new();
    let hand_on = |of_run| {
        records.extend::<Vec<Record>>(of_run);
        Ok::<(), Infallible>(())
    };
    let Ok(()) = obverse_trials::run(&Toy, &memory, plan, shard.runs(plan.runs), jobs, hand_on);
    records
}
