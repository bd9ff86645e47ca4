//! Recovery by reversal: how far each policy and each strategy goes back, what it changes, when it
//! gives up, and what it never does.
//!
//! The cell is a bare arm with an input that comes high at a time, or never: until then the error
//! of the programs here is raised, so that what is tried against it can be read off.

mod again;
mod bounds;
mod cleanup;
mod pairs;
mod sites;
mod watched;

use obverse_bytecode::{FaultName, Module, verify};
use obverse_compiler::compile;
use obverse_recovery::{
    Bounds, Clairvoyant, Ending, GiveUp, Incident, Memory, Operator, Outcome, Recovery, Step,
    Strategy, Teller, Unattended, drive, recover,
};
use obverse_sim::cell::InputRule;
use obverse_sim::{Cell, FaultPlan, Sim, StopKind};
use obverse_tape::Note;
use obverse_vm::{Direction, Event, Limits, Machine, Observer};
use obverse_workcell::{Arm, Clock, DigitalIo, Fault, Safety, Workcell};

/// Five actions, the last of which asks for the input and throws where it is low.
const BODY: &str = "
sequence main {
  set 1 high
  checkpoint ready
  move 10 mm up
  call ask_later
}
sequence ask_later {
  move 10 mm up
  set 2 high
  call asks()
}
action asks() {
  wait 1 s
  if not input 0 { throw late }
}
";

fn program(policy: &str) -> String {
    format!("error late {{ {policy} respond after current action then return to action }}\n{BODY}")
}

fn module(source: &str) -> Module {
    let compiled = compile("program.obv", source);
    let Some(module) = compiled.module else { panic!("{:#?}\n{source}", compiled.diagnostics) };
    module
}

/// A bare arm whose input 0 comes high at a time, in seconds.
fn cell(high_at_s: f64) -> Cell {
    let mut cell = Cell::bare();
    cell.inputs[0] = InputRule::At(vec![(high_at_s, true)]);
    cell
}

const NEVER_S: f64 = 1e9;
/// More motions than any run here makes.
const MOTIONS_MAX: u64 = 300;

/// A run and what became of it.
struct Run {
    ending: Ending,
    incidents: Vec<Incident>,
    sim: Sim,
    steps: Steps,
    /// What the tape says of recoveries, after going back.
    notes: Vec<Note>,
    /// Whether going back from the end leads to the start, bit for bit.
    is_identical: bool,
}

impl Run {
    fn depths(&self) -> Vec<usize> {
        self.incidents[0].depths()
    }

    fn outcome(&self) -> Outcome {
        self.incidents[0].outcome.unwrap().0
    }
}

/// The steps of a recovery by name, and how often the program's own acts were done.
#[derive(Default)]
struct Steps {
    told: Vec<String>,
    /// How far the tool was backed up, each time.
    backed_up_m: Vec<Option<f64>>,
    /// Whether a motion was to be made aside, at each attempt.
    changes: Vec<bool>,
    forward: u64,
    reverse: u64,
}

impl Observer for Steps {
    fn on_event(&mut self, event: &Event, _: &dyn Workcell) {
        if event.instr.info().family.commands_workcell() {
            match event.direction {
                Direction::Forward => self.forward += 1,
                Direction::Reverse => self.reverse += 1,
            }
        }
    }
}

impl Teller for Steps {
    fn on_step(&mut self, step: &Step<'_>, _: &dyn Workcell) {
        let text = format!("{step:?}");
        let word = text.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
        self.told.push(word.to_owned());
        match step {
            Step::InPlace { backed_up_m, .. } => self.backed_up_m.push(*backed_up_m),
            Step::Again { change, .. } => {
                self.changes.push(change.is_some_and(|change| change.aside.is_some()));
            }
            _ => {}
        }
    }
}

/// How a run is made.
struct Case {
    module: Module,
    sim: Sim,
    strategy: Strategy,
    memory: Memory,
    releases: u32,
}

struct Releases(u32);

impl Operator for Releases {
    fn release(&mut self, _: &Fault) -> bool {
        let is_left = self.0 > 0;
        self.0 = self.0.saturating_sub(1);
        is_left
    }
}

impl Case {
    fn new(source: &str, high_at_s: f64) -> Self {
        Self {
            module: module(source),
            sim: Sim::new(&cell(high_at_s), 0),
            strategy: Strategy::Declared,
            memory: Memory::default(),
            releases: 0,
        }
    }

    fn with(mut self, strategy: Strategy) -> Self {
        self.strategy = strategy;
        self
    }

    fn run(mut self) -> Run {
        let program = verify(self.module).unwrap();
        let mut machine = Machine::new(&program, &self.sim).unwrap();
        let start = machine.digest(&self.sim);
        let mut steps = Steps::default();
        let mut recovery = Recovery {
            strategy: self.strategy,
            bounds: Bounds::default(),
            memory: &mut self.memory,
            remembers: true,
            person_s: 300.0,
            seed: 0,
            operator: &mut Releases(self.releases),
            foresight: Some(&mut Clairvoyant::default()),
            incidents: Vec::new(),
        };
        let limits = Limits::instructions(1_000_000);
        let ending = recover(&mut machine, limits, &mut self.sim, &mut recovery, &mut steps);
        let incidents = recovery.incidents;
        let after = self.sim.clone();
        let mut back = ending.clone();
        for _ in 0..MOTIONS_MAX {
            self.sim.release();
            back = drive(&mut machine, Direction::Reverse, limits, &mut self.sim, &mut ());
            if !matches!(back, Ending::Fault { .. }) {
                break;
            }
        }
        let is_identical = back == Ending::AtStart && machine.digest(&self.sim) == start;
        let notes = machine.tape().map(|tape| tape.notes().iter().cloned().collect());
        let notes = notes.unwrap_or_default();
        Run { ending, incidents, sim: after, steps, notes, is_identical }
    }
}

fn run(policy: &str, high_at_s: f64) -> Run {
    Case::new(&program(policy), high_at_s).run()
}

#[test]
fn fixed_goes_back_as_far_each_time_and_gives_up_in_the_end() {
    let run = run("recover by reversing 2 actions", NEVER_S);
    assert_eq!(run.depths(), [2; 8]);
    assert_eq!(run.outcome(), Outcome::GivenUp(GiveUp::Attempts(8)));
    assert!(matches!(run.ending, Ending::Unhandled(_)), "{:?}", run.ending);
    assert!(run.is_identical);
}

#[test]
fn escalating_goes_one_further_each_time_up_to_its_bound() {
    let run = run("recover by reversing escalating up to 3 actions", NEVER_S);
    assert_eq!(run.depths(), [1, 2, 3, 3, 3, 3, 3, 3]);
}

#[test]
fn doubling_goes_twice_as_far_each_time() {
    let mut case = Case::new(&program("recover by reversing escalating up to 4 actions"), NEVER_S);
    let obverse_bytecode::Recovery::Reversing(policy) = &mut case.module.errors[0].recovery else {
        panic!("it is recovered from by reversing");
    };
    policy.depth = obverse_bytecode::Depth::Escalating { doubling: true };
    assert_eq!(case.run().depths(), [1, 2, 4, 4, 4, 4, 4, 4]);
}

#[test]
fn a_checkpoint_and_the_start_of_a_sequence_are_as_far_as_they_are() {
    let to_checkpoint = run("recover by reversing to checkpoint ready", NEVER_S);
    assert_eq!(to_checkpoint.depths(), [4; 8]);
    let to_start = run("recover by reversing to start of sequence", NEVER_S);
    assert_eq!(to_start.depths(), [3; 8]);
}

#[test]
fn it_goes_on_once_going_back_has_helped() {
    let run = run("recover by reversing escalating up to 4 actions", 3.5);
    assert_eq!(run.ending, Ending::Finished);
    assert_eq!(run.outcome(), Outcome::Recovered);
    assert_eq!(run.incidents.len(), 1);
    assert!(run.incidents[0].depths().len() >= 2, "{:?}", run.incidents);
    assert!(run.sim.output(1) && run.sim.output(2));
    assert!(run.is_identical);
    assert_eq!(run.steps.told.last().map(String::as_str), Some("Recovered"));
}

#[test]
fn what_cannot_be_taken_back_is_never_gone_over() {
    let source = program("recover by reversing 4 actions")
        .replace("set 2 high", "barrier \"the part is glued\"\n  set 2 high");
    let run = Case::new(&source, NEVER_S).run();
    // Behind the barrier: `set 2 high` and the action that fails.
    assert_eq!(run.depths(), [2; 8]);
    let source = program("recover by reversing 4 actions")
        .replace("if not", "barrier \"it is pressed in\"\n  if not");
    let run = Case::new(&source, NEVER_S).run();
    assert!(run.depths().is_empty());
    assert!(
        matches!(run.outcome(), Outcome::GivenUp(GiveUp::NoWayBack { never: Some(_) })),
        "{:?}",
        run.outcome()
    );
    assert_eq!(run.steps.reverse, 0, "nothing moved back");
}

#[test]
fn each_bound_ends_it_and_is_named() {
    let bounded = |bounds| {
        let mut case = Case::new(&program("recover by reversing 4 actions"), NEVER_S);
        case.module.errors[0].bounds = bounds;
        case.run()
    };
    let none = obverse_bytecode::Bounds::default();
    let run = bounded(obverse_bytecode::Bounds { attempts: Some(3), ..none });
    assert_eq!(run.outcome(), Outcome::GivenUp(GiveUp::Attempts(3)));
    assert_eq!(run.depths().len(), 3);
    let run = bounded(obverse_bytecode::Bounds { time_s: Some(5.0), ..none });
    assert_eq!(run.outcome(), Outcome::GivenUp(GiveUp::Time(5.0)));
    // Each attempt goes 20 mm back and 20 mm forward again: a third would end at 120 mm.
    let run = bounded(obverse_bytecode::Bounds { distance_m: Some(0.1), ..none });
    assert_eq!(run.outcome(), Outcome::GivenUp(GiveUp::Distance(0.1)));
    assert_eq!(run.depths().len(), 2);
    assert!(run.sim.way_m() <= 0.02 + 0.1, "{} m", run.sim.way_m());
    let run = bounded(obverse_bytecode::Bounds { distance_m: Some(0.03), ..none });
    assert_eq!(run.outcome(), Outcome::GivenUp(GiveUp::Distance(0.03)));
    assert_eq!(run.steps.reverse, 0, "what cannot fit is not begun");
    let run = bounded(obverse_bytecode::Bounds { time_s: Some(0.5), ..none });
    assert_eq!(run.outcome(), Outcome::GivenUp(GiveUp::Time(0.5)));
    assert_eq!(run.steps.reverse, 0, "what cannot fit is not begun");
}

#[test]
fn what_the_program_counts_does_not_bound_what_going_back_restores() {
    // The explicit sequence is run at most three times in a row, as counted in a variable that
    // going back restores.
    let source = program("recover by reversing 4 actions otherwise using help")
        + "sequence help { toggle 5 }\n";
    let run = Case::new(&source, NEVER_S).run();
    assert!(matches!(run.ending, Ending::Unhandled(_)), "{:?}", run.ending);
    let outcomes: Vec<Outcome> =
        run.incidents.iter().map(|incident| incident.outcome.unwrap().0).collect();
    assert_eq!(outcomes[0], Outcome::GivenUp(GiveUp::Attempts(8)));
    assert!(outcomes[1..].iter().all(|it| *it == Outcome::GivenUp(GiveUp::Before)), "{outcomes:?}");
    assert_eq!(outcomes.len(), 4);
}

#[test]
fn an_action_that_ended_where_it_began_is_not_made_again_backwards() {
    // The return of an advanced move is exact.
    let source = "
        error late { recover by reversing 2 actions then return to action }
        advanced move feel {
          distance 20 mm up in tcp
          stop if force > 5 N
          on success { return to initial position }
          on failure { return to initial position }
        }
        action looks() { advance feel  if not input 0 { throw late } }
        sequence main { wait 1 s  call looks() }
    ";
    let run = Case::new(source, 2.5).run();
    assert_eq!(run.ending, Ending::Finished);
    assert!(run.steps.told.contains(&"RoundTrip".to_owned()), "{:?}", run.steps.told);
    // What is reversed in the world is the wait alone, once an attempt.
    assert_eq!(run.steps.reverse, run.incidents[0].attempts.len() as u64);
}

#[test]
fn each_strategy_does_what_it_is_called_for() {
    let source = program("recover by reversing 4 actions otherwise using help")
        + "sequence help { set 5 high }\n";
    let with = |strategy| Case::new(&source, NEVER_S).with(strategy).run();

    let stop = with(Strategy::Stop);
    assert!(
        matches!(stop.ending, Ending::GivenUp { why: GiveUp::Strategy, .. }),
        "{:?}",
        stop.ending
    );
    assert_eq!(stop.steps.reverse, 0);

    let retry = with(Strategy::Retry { times: 3 });
    assert!(matches!(retry.ending, Ending::GivenUp { why: GiveUp::Attempts(3), .. }));
    assert_eq!((retry.depths(), retry.steps.reverse), (vec![0; 3], 0));

    let explicit = with(Strategy::Explicit);
    assert!(matches!(explicit.ending, Ending::Unhandled(_)));
    assert!(explicit.sim.output(5) && explicit.steps.reverse == 0);

    let fixed = with(Strategy::Fixed { actions: 2 });
    assert_eq!(fixed.depths(), [2; 8]);
    assert!(fixed.sim.output(5), "it replaces the depth, and not what follows");

    let escalating = with(Strategy::Escalating);
    assert_eq!(escalating.depths(), [1, 2, 3, 4, 5, 5, 5, 5]);
    assert!(escalating.sim.output(5));
    assert!(!retry.sim.output(5) && !stop.sim.output(5), "nothing but what the strategy does");

    let restart = with(Strategy::Restart { times: 2 });
    assert!(matches!(restart.ending, Ending::GivenUp { why: GiveUp::Attempts(2), .. }));
    assert_eq!(restart.steps.reverse, 0);
    assert!(restart.steps.forward > 2 * stop.steps.forward);
}

#[test]
fn backing_up_moves_the_tool_straight_back() {
    let strategy = Strategy::BackUp { distance_m: 0.05, times: 1 };
    let source = program("recover by reversing 4 actions");
    let stop = Case::new(&source, NEVER_S).with(Strategy::Stop).run();
    let run = Case::new(&source, NEVER_S).with(strategy).run();
    assert_eq!(run.depths(), [0]);
    assert!(!stop.sim.joints().same_bits(&run.sim.joints()));
    // Of the program itself only the wait is done again.
    assert_eq!(run.steps.forward, stop.steps.forward + 1);
}

#[test]
fn who_knows_what_will_come_goes_back_just_as_far() {
    // The input comes high in a second and a half: waiting again is enough, and less is not.
    let source = program("recover by reversing 4 actions");
    let first_s = Case::new(&source, NEVER_S).with(Strategy::Stop).run().sim.now_s();
    let run = Case::new(&source, first_s + 0.5).with(Strategy::Oracle).run();
    assert_eq!((run.ending, run.incidents[0].depths()), (Ending::Finished, vec![1]));
    let never = Case::new(&source, NEVER_S).with(Strategy::Oracle).run();
    assert_eq!(never.outcome(), Outcome::GivenUp(GiveUp::WouldNotHelp));
    assert!(matches!(never.ending, Ending::Unhandled(_)), "{:?}", never.ending);
    assert_eq!(never.steps.reverse, 0);
}

#[test]
fn what_was_learned_is_used_and_kept() {
    let source = program("recover by reversing learned up to 5 actions");
    let run = Case::new(&source, 3.0).run();
    assert_eq!(run.ending, Ending::Finished);
    assert!(run.incidents[0].place.contains("call asks()"), "{}", run.incidents[0].place);
    // Where going back four was always enough and less never, it goes back as far at once.
    let mut case = Case::new(&source, NEVER_S);
    for _ in 0..40 {
        case.memory.learn("late", &run.incidents[0].place, &[1, 2, 3, 4], true);
    }
    assert!(case.run().depths()[0] >= 4);
}

#[test]
fn a_way_back_that_is_blocked_is_tried_again_after_a_release() {
    let source = program("recover by reversing 4 actions");
    let acts = Case::new(&source, NEVER_S).with(Strategy::Stop).run().sim.acts_begun();
    let blocked = |releases| {
        let mut case = Case::new(&source, 9.0);
        // The first act of the way back after the wait: output 2 goes low.
        case.sim.inject(FaultPlan { act: acts + 1, fraction: 0.3 });
        case.releases = releases;
        case.run()
    };
    let held = blocked(0);
    assert!(
        matches!(held.ending, Ending::GivenUp { why: GiveUp::Blocked, .. }),
        "{:?}",
        held.ending
    );
    assert!(held.sim.is_stopped(), "nothing moves without a fresh command");
    let released = blocked(1);
    assert_eq!(released.ending, Ending::Finished);
    assert!(released.steps.told.contains(&"Blocked".to_owned()));
    assert!(released.steps.told.contains(&"Released".to_owned()));
    assert!(released.is_identical);
}

#[test]
fn a_fault_that_nobody_named_holds_the_arm() {
    let source = program("recover by reversing 4 actions");
    let mut case = Case::new(&source, 0.0);
    case.sim.inject(FaultPlan { act: 1, fraction: 0.5 });
    let run = case.run();
    assert!(matches!(run.ending, Ending::Fault { .. }), "{:?}", run.ending);
    assert!(run.sim.is_stopped());
}

#[test]
fn a_fault_that_is_an_error_needs_a_release_and_is_taken_back_with_its_act() {
    let source = program("recover by reversing 4 actions");
    let stopped = |releases| {
        let mut case = Case::new(&source, 0.0);
        case.module.errors[0].faults = vec![FaultName::ProtectiveStop];
        case.sim.inject(FaultPlan { act: 1, fraction: 0.5 });
        case.releases = releases;
        case.run()
    };
    let held = stopped(0);
    assert!(matches!(held.ending, Ending::Fault { .. }), "{:?}", held.ending);
    let raised = stopped(1);
    assert_eq!(raised.steps.told[..2], ["Fault", "Released"]);
    assert!(raised.is_identical, "the half of the motion that was done is taken back");
}

#[test]
fn nobody_releases_what_nobody_watches() {
    assert!(!Unattended.release(&Fault::Stopped));
}
