//! The laws of recovery over generated programs: going back along the trail leads to where an
//! action began, exactly; and whatever goes wrong wherever, and whatever is done about it, a run
//! ends, within bounds, where it can be taken back from.

use crate::logged::Logged;
use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{FaultName, Module, Respond, Verified, Watched, verify};
use obverse_compiler::compile;
use obverse_recovery::{
    Bounds, Ending, Memory, Operator, Recovery, Strategy, Trail, drive, recover,
};
use obverse_vm::{Direction, Event, Limits, Machine, Mark, Observer, Stop};
use obverse_workcell::{Fault, Safety, Workcell};
use std::collections::BTreeMap;

/// Every strategy, with the numbers that are usual.
pub const STRATEGIES: [Strategy; 10] = [
    Strategy::Declared,
    Strategy::Stop,
    Strategy::Retry { times: 3 },
    Strategy::BackUp { distance_m: 0.30, times: 6 },
    Strategy::Restart { times: 3 },
    Strategy::Explicit,
    Strategy::Fixed { actions: 3 },
    Strategy::Escalating,
    Strategy::Learned,
    // Where nobody knows what will come, it has nothing to try.
    Strategy::Oracle,
];

/// Whether a strategy leaves the arm where the program does not know it to be.
#[must_use]
pub fn acts_in_place(strategy: Strategy) -> bool {
    matches!(strategy, Strategy::Retry { .. } | Strategy::BackUp { .. } | Strategy::Restart { .. })
}

/// The longest run, in instructions.
const MAX_INSTRUCTIONS: u64 = 3_000;

/// Taken back to where an action began, the machine and what it commands are as they were then, and
/// the trail is as long as it was.
///
/// # Errors
/// Those of the randomness.
pub fn goes_back_along_the_trail(u: &mut Unstructured<'_>) -> Result<bool> {
    let source = programs::generate(u, Options { allow_overrides: false, ..Options::default() })?;
    let program = program(&source, |_| {});
    let mut cell = Logged::new(u.arbitrary()?).steady();
    let Ok(mut machine) = Machine::new(&program, &cell) else { return Ok(false) };
    let mut watch = Watch(Trail::new(program.module(), obverse_workcell::Arm::joints(&cell)));
    let mut digests = BTreeMap::new();
    while machine.executed() < MAX_INSTRUCTIONS {
        digests.insert(machine.state().steps(), machine.digest(&cell));
        match machine.step(Direction::Forward, &mut cell, &mut watch) {
            Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }) => {}
            Err(_) => break,
        }
    }
    let mut trail = watch.0;
    let mut is_compared = false;
    while !trail.actions().is_empty() {
        let index = u.choose_index(trail.actions().len())?;
        let steps = trail.actions()[index].steps;
        let stop = machine.reverse_to(Mark::at(steps), &mut cell, &mut ());
        assert_eq!(stop, Stop::AtMark, "to action {index}, {steps} steps\n{source}");
        let digest = machine.digest(&cell);
        assert_eq!(Some(&digest), digests.get(&steps), "at action {index}\n{source}");
        trail.cut(machine.state().steps());
        assert_eq!(trail.actions().len(), index, "the trail behind action {index}\n{source}");
        is_compared = true;
    }
    Ok(is_compared)
}

/// A way back that is blocked in an act, and gone forward from there: the trail is what it was, no
/// action longer and none shorter. Branches of a fork may take their turns otherwise then, since
/// the clock has gone on, so that programs without forks are looked at.
///
/// # Errors
/// Those of the randomness.
pub fn keeps_the_trail_over_a_blocked_return(u: &mut Unstructured<'_>) -> Result<bool> {
    let options = Options { allow_overrides: false, allow_forks: false, ..Options::default() };
    let source = programs::generate(u, options)?;
    let program = program(&source, |_| {});
    let mut cell = Logged::new(u.arbitrary()?).steady();
    let Ok(mut machine) = Machine::new(&program, &cell) else { return Ok(false) };
    let mut watch = Watch(Trail::new(program.module(), obverse_workcell::Arm::joints(&cell)));
    go_on(&mut machine, &mut cell, &mut watch, u64::MAX);
    if watch.0.actions().is_empty() {
        return Ok(false);
    }
    let before = actions(&watch.0);
    let steps = machine.state().steps();
    let first = watch.0.actions()[0].steps;
    let acts = cell.ledger.acts;
    cell.ledger.stop_at = Some((acts + u.int_in_range(0..=8)?, 0.5));
    let stop = machine.reverse_to(Mark::at(first), &mut cell, &mut watch);
    let Stop::Fault { pc, .. } = stop else { return Ok(false) };
    let prefix = u64::from(program.module().code[pc as usize].prefix());
    watch.0.cut_into(machine.state().steps() - 1 - prefix, pc);
    cell.release();
    // What is half undone is done again even where no step is left to be made.
    let _again = machine.step(Direction::Forward, &mut cell, &mut watch);
    go_on(&mut machine, &mut cell, &mut watch, steps);
    if machine.state().steps() == steps {
        assert_eq!(actions(&watch.0), before, "blocked at {pc}\n{source}");
        return Ok(true);
    }
    Ok(false)
}

/// Left for the cleanup at any instant, an act that was stopped half way included, a run goes on
/// there, and going back leads into what was left, bit for bit, and from there to the start.
///
/// # Errors
/// Those of the randomness.
pub fn comes_back_to_what_was_left(u: &mut Unstructured<'_>) -> Result<bool> {
    let source = programs::generate(u, Options { allow_overrides: false, ..Options::default() })?;
    let program = program(&source, |_| {});
    let mut cell = Logged::new(u.arbitrary()?).steady();
    cell.ledger.stop_at = Some((u.int_in_range(0..=40)?, 0.5));
    let Ok(mut machine) = Machine::new(&program, &cell) else { return Ok(false) };
    let start = machine.digest(&cell);
    let mut watch = Watch(Trail::new(program.module(), obverse_workcell::Arm::joints(&cell)));
    go_on(&mut machine, &mut cell, &mut watch, u.int_in_range(0..=600)?);
    let (steps, was_cleaning_up) = (machine.state().steps(), machine.is_cleaning_up());
    let left = machine.digest(&cell);
    if !machine.leave(&cell) {
        let may_leave = program.module().cleanup.is_some() && !was_cleaning_up;
        assert!(!may_leave, "after {steps} steps\n{source}");
        assert_eq!(machine.digest(&cell), left, "it changed nothing");
        return Ok(false);
    }
    cell.release();
    cell.ledger.stop_at = None;
    go_on(&mut machine, &mut cell, &mut watch, u64::MAX);
    let stop = machine.reverse_to(Mark::at(steps), &mut cell, &mut ());
    if matches!(stop, Stop::Refused(_)) {
        return Ok(false);
    }
    assert_eq!(stop, Stop::AtMark, "to what was left after {steps} steps\n{source}");
    assert_eq!(machine.digest(&cell), left, "what was left after {steps} steps\n{source}");
    let back = drive(&mut machine, Direction::Reverse, Limits::NONE, &mut cell, &mut ());
    if back == Ending::AtStart {
        assert_eq!(machine.digest(&cell), start, "left after {steps} steps\n{source}");
    }
    Ok(true)
}

/// Forward until so many steps have been made, or the run ends.
fn go_on(machine: &mut Machine<'_>, cell: &mut Logged, watch: &mut Watch<'_>, steps: u64) {
    let allowed = machine.executed() + MAX_INSTRUCTIONS;
    while machine.executed() < allowed && machine.state().steps() < steps {
        match machine.step(Direction::Forward, cell, watch) {
            Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }) => {}
            Err(_) => return,
        }
    }
}

/// What makes the actions of a trail the same: where they began, and their numbers.
fn actions(trail: &Trail<'_>) -> Vec<(u64, u64, u32)> {
    trail.actions().iter().map(|action| (action.steps, action.number, action.entry)).collect()
}

/// Under any strategy, with a fault anywhere, also on the way back, and with what is watched coming
/// to hold in some act, a run ends; no error is
/// tried more often than may be; nothing moves after a stop unless it was released; and from where
/// it ended the program's state goes back to the start, or to what cannot be taken back.
///
/// # Errors
/// Those of the randomness.
pub fn recovers_within_bounds(u: &mut Unstructured<'_>) -> Result<bool> {
    let source = programs::generate(u, Options { allow_overrides: false, ..Options::default() })?;
    let source = all_reversing(&source);
    let names_faults: bool = u.arbitrary()?;
    let is_at_once: bool = u.arbitrary()?;
    let program = program(&source, |module| {
        if let (true, Some(error)) = (names_faults, module.errors.first_mut()) {
            error.faults = vec![FaultName::ProtectiveStop];
            error.watches = vec![Watched::Force { above_n: 50.0 }];
            error.respond = [Respond::AtOnce, Respond::AfterAction][usize::from(!is_at_once)];
        }
    });
    let mut cell = Logged::new(u.arbitrary()?);
    let fraction = f64::from(u.int_in_range(0_u8..=10)?) / 10.0;
    cell.ledger.stop_at = Some((u.int_in_range(0..=40)?, fraction));
    cell.ledger.comes_at = Some((u.int_in_range(0..=40)?, fraction));
    let strategy = *u.choose(&STRATEGIES)?;
    let mut operator = Releases(u.int_in_range(0..=2)?);
    let Ok(mut machine) = Machine::new(&program, &cell) else { return Ok(false) };
    let start = machine.digest(&cell);
    let mut recovery = Recovery {
        strategy,
        bounds: Bounds { attempts: 4, ..Bounds::default() },
        memory: &mut Memory::default(),
        remembers: true,
        person_s: 300.0,
        seed: 0,
        operator: &mut operator,
        foresight: None,
        incidents: Vec::new(),
    };
    let limits = Limits::instructions(20 * MAX_INSTRUCTIONS);
    let ending = recover(&mut machine, limits, &mut cell, &mut recovery, &mut ());
    let incidents = recovery.incidents;
    let is_bounded = incidents.iter().all(|incident| incident.attempts.len() <= 4);
    assert!(is_bounded, "{incidents:?}\n{source}");
    let is_closed = incidents.iter().all(|incident| incident.outcome.is_some());
    assert!(is_closed, "{incidents:?}\n{source}");
    // What was done in place, or commanded beside the program, the world keeps.
    let is_exact = !acts_in_place(strategy);
    if ending == Ending::Budget {
        return Ok(false);
    }
    cell.release();
    cell.ledger.stop_at = None;
    let back = drive(&mut machine, Direction::Reverse, Limits::NONE, &mut cell, &mut ());
    if let Ending::Fault { fault: Fault::ForceLimit { .. }, .. } = back {
        // Something is in the way of a motion that a force may stop going back.
        return Ok(!incidents.is_empty());
    }
    let way = || format!("{strategy:?}, {ending:?}, back: {back:?}\n{source}");
    assert!(matches!(back, Ending::AtStart | Ending::Refused(_)), "{}", way());
    if back == Ending::AtStart && is_exact {
        assert_eq!(machine.digest(&cell), start, "{}", way());
    }
    Ok(!incidents.is_empty())
}

/// The same program with every error recovered from by reversing.
pub(crate) fn all_reversing(source: &str) -> String {
    const CLAUSES: &str = "  recover by reversing escalating up to 3 actions, slower\n";
    let mut lines = Vec::new();
    let mut is_error = false;
    for line in source.lines() {
        is_error |= line.starts_with("error ");
        if !is_error || line.starts_with("error ") {
            lines.push(line.to_owned());
        } else if line.starts_with('}') {
            lines.push(format!("{CLAUSES}  then return to action\n}}"));
        }
        is_error &= !line.starts_with('}');
    }
    lines.join("\n")
}

pub(crate) fn program(source: &str, change: impl FnOnce(&mut Module)) -> Verified {
    let compiled = compile("program.obv", source);
    let Some(mut module) = compiled.module else {
        panic!("it does not compile: {:#?}\n{source}", compiled.diagnostics)
    };
    change(&mut module);
    match verify(module) {
        Ok(program) => program,
        Err(errors) => panic!("it does not verify: {errors:?}\n{source}"),
    }
}

pub(crate) struct Releases(pub(crate) u32);

impl Operator for Releases {
    fn release(&mut self, _: &Fault) -> bool {
        let is_left = self.0 > 0;
        self.0 = self.0.saturating_sub(1);
        is_left
    }
}

struct Watch<'m>(Trail<'m>);

impl Observer for Watch<'_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        self.0.note(event, cell);
    }
}
