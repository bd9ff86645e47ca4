//! The law of reach: what stops a machine that goes back is what was said of that point before
//! anything ran. Each law is a function of randomness, as those of
//! [`machine_laws`](crate::machine_laws) are, and panics where it does not hold.

use crate::code::{self, Options};
use crate::{Ledger, fork_code, programs, reach_programs};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{Verified, verify};
use obverse_reach::{Horizon, MAX_KEPT, Reach};
use obverse_vm::{Direction, Limits, Machine, Stop};
use std::collections::BTreeSet;

/// The longest run forward, in steps, and the longest part of the way back that is looked at.
const MAX_STEPS: u16 = 600;
const MAX_STEPS_BACK: u8 = 40;
/// How many instructions going back is given in all: a program may be long in passing its blocks.
const MAX_BACK: u64 = 1_000_000;

/// How many runs of a module of forks are gone back from, each at other steps.
const FORK_RUNS: u64 = 3;
/// How long each of them is at the most, in steps.
const FORK_STEPS: u64 = 120;

/// A point of a run, and where going back from it ended.
pub type Met = (u32, Horizon);

/// Random modules: of every shape that the verifier admits.
///
/// # Errors
/// Those of the randomness.
pub fn reach_of_modules(u: &mut Unstructured<'_>) -> Result<bool> {
    let (never, blocks) = (u.ratio(7_u8, 8)?, u.ratio(1_u8, 2)?);
    let module = code::module(u, Options { never, blocks })?;
    let program = verified(module);
    let reach = Reach::of(program.module());
    consistent(&reach, program.module().code.len());
    let met = meet(&program, &reach, u)?;
    Ok(met.is_some_and(|(_, horizon)| horizon != Horizon::Start))
}

/// Random programs of the language: calls, errors and what is done about them, blocks.
///
/// # Errors
/// Those of the randomness.
pub fn reach_of_programs(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = compiled(&programs::generate(u, programs::Options::default())?);
    let reach = Reach::of(program.module());
    Ok(meet(&program, &reach, u)?.is_some())
}

/// Random modules of forks: from many points of some runs going back ends where it was said to.
/// Whether something stopped it in a branch.
///
/// # Errors
/// Those of the randomness.
pub fn reach_of_forks(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = verified(fork_code::module(u)?);
    let reach = Reach::of(program.module());
    consistent(&reach, program.module().code.len());
    let mut is_stopped_in_branch = false;
    let mut known = BTreeSet::new();
    for run in 0..FORK_RUNS {
        let mut cell = Ledger::new(run);
        let mut machine = machine(&program, &cell);
        for at in 0..FORK_STEPS {
            if at % FORK_RUNS == run {
                let met = met_from(&machine, &cell);
                // Runs come by the same points again and again.
                if let Some((pc, horizon)) = met.filter(|met| known.insert(*met)) {
                    was_said(&reach, pc, horizon);
                }
                let is_stopped = met.is_some_and(|(_, horizon)| horizon != Horizon::Start);
                is_stopped_in_branch |= is_stopped && !machine.state().branches().is_empty();
            }
            if !step(&mut machine, Direction::Forward, &mut cell) {
                break;
            }
        }
    }
    Ok(is_stopped_in_branch)
}

/// What runs met, and what was said of the points that they met it at.
pub type MetAndSaid = (BTreeSet<Met>, BTreeSet<Met>);

/// All that some runs of a random module meet, and all that is said of the points they met it at.
///
/// # Errors
/// Those of the randomness.
pub fn met_and_said(u: &mut Unstructured<'_>) -> Result<MetAndSaid> {
    let module = code::module(u, Options { never: true, blocks: true })?;
    Ok(met_by_runs(&verified(module), 20))
}

/// The same of a random program in which errors lead on in every way, with forks or without.
///
/// # Errors
/// Those of the randomness.
pub fn met_and_said_of_programs(u: &mut Unstructured<'_>, with_forks: bool) -> Result<MetAndSaid> {
    Ok(met_and_said_of(&reach_programs::generate(u, with_forks)?, 100))
}

/// The same of this program, in so many runs.
#[must_use]
pub fn met_and_said_of(source: &str, runs: u64) -> MetAndSaid {
    met_by_runs(&compiled(source), runs)
}

fn met_by_runs(program: &Verified, runs: u64) -> MetAndSaid {
    let reach = Reach::of(program.module());
    let (mut met, mut said) = (BTreeSet::new(), BTreeSet::new());
    for seed in 0..runs {
        let mut cell = Ledger::new(seed);
        let mut machine = machine(program, &cell);
        for _ in 0..MAX_STEPS {
            let pc = machine.state().pc();
            let (mut trial, mut trial_cell) = (machine.clone(), cell.clone());
            if let Some(horizon) = back(&mut trial, &mut trial_cell) {
                met.insert((pc, horizon));
                said.extend(reach.every(pc).into_iter().map(|horizon| (pc, horizon)));
            }
            if !step(&mut machine, Direction::Forward, &mut cell) {
                break;
            }
        }
    }
    (met, said)
}

fn compiled(source: &str) -> Verified {
    let compiled = obverse_compiler::compile("program.obv", source);
    let Some(module) = compiled.module else { panic!("{:?}\n{source}", compiled.diagnostics) };
    verified(module)
}

fn verified(module: obverse_bytecode::Module) -> Verified {
    match verify(module) {
        Ok(verified) => verified,
        Err(errors) => panic!("the generator made a module that does not verify: {errors:?}"),
    }
}

fn machine<'p>(program: &'p Verified, cell: &Ledger) -> Machine<'p> {
    match Machine::new(program, cell) {
        Ok(machine) => machine,
        Err(errors) => panic!("the module does not link: {errors:?}"),
    }
}

/// One step; whether the run goes on.
fn step(machine: &mut Machine<'_>, direction: Direction, cell: &mut Ledger) -> bool {
    matches!(
        machine.step(direction, cell, &mut ()),
        Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. })
    )
}

/// Go back as far as it goes; where that ended, unless it was for the values of a run.
fn back(machine: &mut Machine<'_>, cell: &mut Ledger) -> Option<Horizon> {
    let begin = machine.executed();
    loop {
        let left = Limits::instructions(MAX_BACK.saturating_sub(machine.executed() - begin));
        match machine.run(Direction::Reverse, left, cell, &mut ()) {
            Stop::Raised { .. } | Stop::Due { .. } => {}
            Stop::AtStart => return Some(Horizon::Start),
            Stop::Refused(refusal) => return Some(Horizon::Never(refusal.pc)),
            _ => return None,
        }
    }
}

/// From some point of a run, and from some point of the way back from there, which may lie within
/// what replaces a block, going back ends where it was said to.
fn meet(program: &Verified, reach: &Reach<'_>, u: &mut Unstructured<'_>) -> Result<Option<Met>> {
    let mut cell = Ledger::new(u.arbitrary()?);
    let mut machine = machine(program, &cell);
    for _ in 0..u.int_in_range(0..=MAX_STEPS)? {
        if !step(&mut machine, Direction::Forward, &mut cell) {
            break;
        }
    }
    let met = agree(reach, &machine, &cell);
    for _ in 0..u.int_in_range(0..=MAX_STEPS_BACK)? {
        if !step(&mut machine, Direction::Reverse, &mut cell) {
            break;
        }
    }
    agree(reach, &machine, &cell);
    Ok(met)
}

/// Where going back from here ends is what was said of this point.
fn agree(reach: &Reach<'_>, machine: &Machine<'_>, cell: &Ledger) -> Option<Met> {
    let (pc, horizon) = met_from(machine, cell)?;
    was_said(reach, pc, horizon);
    Some((pc, horizon))
}

/// This point, and where going back from it ends; machine and workcell stay as they are.
fn met_from(machine: &Machine<'_>, cell: &Ledger) -> Option<Met> {
    let horizon = back(&mut machine.clone(), &mut cell.clone())?;
    Some((machine.state().pc(), horizon))
}

/// What is kept of a point says so, or, where that is not all, a search from there.
fn was_said(reach: &Reach<'_>, pc: u32, horizon: Horizon) {
    let kept = reach.at(pc);
    let said = match kept.is_more {
        true => reach.every(pc).into_iter().collect(),
        false => kept.horizons,
    };
    assert!(said.contains(&horizon), "from {pc} it met {horizon:?}, and {said:?} was said");
    assert!(reach.way(pc, horizon).is_some(), "there is a way from {pc} to {horizon:?}");
}

/// The sets that are found for all points at once are those of a search from each of them.
fn consistent(reach: &Reach<'_>, instructions: usize) {
    for pc in (0..instructions as u32).step_by(7) {
        let (few, every) = (reach.at(pc), reach.every(pc));
        let first: Vec<Horizon> = every.iter().copied().take(MAX_KEPT).collect();
        assert_eq!((few.horizons, few.is_more), (first, every.len() > MAX_KEPT), "at {pc}");
    }
}
