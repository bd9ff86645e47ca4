//! The law of a live session over generated programs with faults, errors and what is watched: it is
//! a run, however it is walked through.

use crate::logged::Logged;
use crate::programs::{self, Options};
use crate::recovery_laws::{self, Releases, STRATEGIES, all_reversing};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{FaultName, Respond, Watched};
use obverse_debugger::{Breakpoint, Grain, Halt, Moment, Places, Policy, Run, Session, Walk};
use obverse_recovery::{
    Bounds, Ending, Memory, Recovery, Step, Strategy, Subject, Teller, recover,
};
use obverse_vm::{Direction, Event, Limits, Machine, Observer, Stop};
use obverse_workcell::{Arm, Workcell};
use std::sync::{Arc, Mutex};

/// How far the arm may be off a place that it was taken back to, in radians.
const NEAR_RAD: f64 = 1e-4;

/// Tells what happens in words, into a list that others hold too.
#[derive(Clone, Default)]
struct Story(Arc<Mutex<Vec<String>>>);

impl Story {
    fn tell(&self, words: String) {
        if let Ok(mut told) = self.0.lock() {
            told.push(words);
        }
    }

    fn told(&self) -> Vec<String> {
        self.0.lock().map(|told| told.clone()).unwrap_or_default()
    }
}

impl Observer for Story {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        // How often a statement was begun that traps is told of no step.
        let event = Event { executed: 0, ..event.clone() };
        self.tell(format!("{:?} {event:?}", cell.now_s().to_bits()));
    }
}

impl Teller for Story {
    fn on_step(&mut self, step: &Step<'_>, cell: &dyn Workcell) {
        self.tell(format!("{:?} {step:?}", cell.now_s().to_bits()));
    }
}

/// Whoever walks forward through a run in a session, by whatever steps, over whatever breakpoints
/// and looks at what was, comes to the end that the run comes to by itself, recoveries included:
/// the same state and tape, the same story, the same learned.
///
/// # Errors
/// Those of the randomness.
///
/// # Panics
/// If it is not so.
pub fn is_a_run(u: &mut Unstructured<'_>) -> Result<bool> {
    let strategy = *u.choose(&STRATEGIES)?;
    let fraction = f64::from(u.int_in_range(0_u8..=10)?) / 10.0;
    let mut cell = Logged::new(u.arbitrary()?);
    cell.ledger.stop_at = Some((u.int_in_range(0..=40)?, fraction));
    if matches!(strategy, Strategy::BackUp { .. }) {
        // What commands beside the program asks for a person at once, whom a session has not.
        cell.ledger.stop_at = None;
    }
    cell.ledger.comes_at = Some((u.int_in_range(0..=40)?, fraction));
    let walks: [u8; 16] = u.arbitrary()?;
    let breaks: [u8; 2] = u.arbitrary()?;
    let (names_faults, is_at_once): (bool, bool) = (u.arbitrary()?, u.arbitrary()?);
    let options = Options { allow_overrides: u.arbitrary()?, ..Options::default() };
    let source = all_reversing(&programs::generate(u, options)?);
    let program = recovery_laws::program(&source, |module| {
        if let (true, Some(error)) = (names_faults, module.errors.first_mut()) {
            error.faults = vec![FaultName::ProtectiveStop];
            error.watches = vec![Watched::Force { above_n: 50.0 }];
            error.respond = [Respond::AtOnce, Respond::AfterAction][usize::from(!is_at_once)];
        }
    });
    let (mut alone, mut memory, mut story) = (cell.clone(), Memory::default(), Story::default());
    let Ok(mut machine) = Machine::new(&program, &alone) else { return Ok(false) };
    let policy = Policy { strategy, bounds: Bounds::default(), person_s: 300.0, seed: 7 };
    let mut recovery = Recovery {
        strategy,
        bounds: policy.bounds,
        memory: &mut memory,
        remembers: true,
        person_s: policy.person_s,
        seed: policy.seed,
        operator: &mut Releases(u32::MAX),
        foresight: None,
        incidents: Vec::new(),
    };
    let limits = Limits::instructions(20_000);
    let ending = recover(&mut machine, limits, &mut alone, &mut recovery, &mut story);
    let incidents = recovery.incidents;
    if ending == Ending::Budget {
        return Ok(false);
    }
    let Ok(run) = Run::new(&program, cell) else { return Ok(false) };
    let mut session = Session::over(run);
    let told = Story::default();
    session.tell_to(Box::new(told.clone()));
    session.recover_by(policy, Memory::default());
    for at in breaks {
        let pc = u32::from(at) % program.module().code.len().max(1) as u32;
        if let Ok(places) = Places::of_instruction(program.module(), pc) {
            session.add_breakpoint(Breakpoint::at(places));
        }
    }
    let halts = walk_to_end(&mut session, &walks);
    let what = || format!("{policy:?}, {ending:?}, {halts:?}\n{source}");
    assert_eq!(told.told(), story.told(), "{}", what());
    assert_eq!(session.incidents(), incidents, "{}", what());
    let subject = Subject { program: String::new(), cell: String::new() };
    let (learned, here) = (memory.to_text(&subject), session.memory().to_text(&subject));
    assert_eq!(here, learned, "{}", what());
    assert_eq!(session.digest(), machine.digest(&alone), "{}", what());
    assert_eq!(session.machine().streams(), machine.streams(), "{}", what());
    if let Ending::GivenUp { .. } = ending {
        // Where a person is called, nothing goes on.
        for walk in [Walk::Continue, Walk::Step(Grain::Instruction), Walk::Finish] {
            let halt = session.go(Direction::Forward, walk);
            let ended = Halt::Ended(ending.clone());
            let expected = if session.is_held() { Halt::Held } else { ended };
            assert_eq!(halt, expected, "{walk:?}: {}", what());
            assert_eq!(session.digest(), machine.digest(&alone), "{walk:?}: {}", what());
        }
    }
    // What was recorded shows it again.
    session.go_to(session.recording().end).map_err(|_| arbitrary::Error::IncorrectFormat)?;
    assert_eq!(session.digest(), machine.digest(&alone), "shown again: {}", what());
    Ok(!incidents.is_empty())
}

/// Walk by these ways, as often as it takes, until the run is over.
fn walk_to_end(session: &mut Session<'_, Logged>, walks: &[u8]) -> Vec<String> {
    use Direction::Forward;
    let mut halts = Vec::new();
    for walk in walks.iter().cycle().take(30_000) {
        let halt = match walk % 8 {
            0 => session.go(Forward, Walk::Step(Grain::Instruction)),
            1 => session.go(Forward, Walk::Step(Grain::Statement)),
            2 => session.go(Forward, Walk::Next(Grain::Statement)),
            3 => session.go(Forward, Walk::Finish),
            4 => session.recover().unwrap_or(Halt::Done),
            5 => {
                let _looked = session.go_to(Moment(session.recording().end.0 / 2));
                session.go(Forward, Walk::Step(Grain::Instruction));
                session.go_to_end();
                Halt::Done
            }
            _ => session.go(Forward, Walk::Continue),
        };
        if halt == Halt::Held {
            let _ = session.release();
        }
        halts.push(format!("{halt:?}"));
        if session.is_over() {
            break;
        }
    }
    halts
}

/// Whoever goes back by hand in between, wherever a recovery stands, comes to an end all the same
/// by going on; and from there back to the start, or to what cannot be taken back. The program's
/// state is then what it was, bit for bit, and the outputs; the arm is there but for what motions
/// came to that ended where they began, near enough.
///
/// # Errors
/// Those of the randomness.
///
/// # Panics
/// If it is not so.
pub fn takes_a_hand(u: &mut Unstructured<'_>) -> Result<bool> {
    let fraction = f64::from(u.int_in_range(0_u8..=10)?) / 10.0;
    let mut cell = Logged::new(u.arbitrary()?);
    cell.ledger.stop_at = Some((u.int_in_range(0..=40)?, fraction));
    let walks: [u8; 24] = u.arbitrary()?;
    let options = Options { allow_overrides: false, ..Options::default() };
    let source = all_reversing(&programs::generate(u, options)?);
    let program = recovery_laws::program(&source, |module| {
        if let Some(error) = module.errors.first_mut() {
            error.faults = vec![FaultName::ProtectiveStop];
        }
    });
    let unmoved = cell.clone();
    let Ok(run) = Run::new(&program, cell) else { return Ok(false) };
    let mut session = Session::over(run);
    session.limit(20_000);
    let start = session.digest();
    let mut was_recovering = false;
    for walk in walks {
        let (way, walk) = match walk % 8 {
            0 => (Direction::Reverse, Walk::Step(Grain::Instruction)),
            1 => (Direction::Reverse, Walk::Next(Grain::Statement)),
            2 => (Direction::Reverse, Walk::Finish),
            3 => (Direction::Forward, Walk::Step(Grain::Instruction)),
            4 => (Direction::Forward, Walk::Next(Grain::Statement)),
            _ => (Direction::Forward, Walk::Continue),
        };
        was_recovering |= way == Direction::Reverse && session.is_recovering();
        if session.go(way, walk) == Halt::Held {
            let _ = session.release();
        }
        let _told = session.intent();
    }
    let mut halt = Halt::Done;
    for _ in 0..1_000 {
        halt = session.go(Direction::Forward, Walk::Continue);
        if halt == Halt::Held {
            let _ = session.release();
        }
        if session.is_over() || halt == Halt::Limit {
            break;
        }
    }
    assert!(session.is_over() || halt == Halt::Limit, "{walks:?}, {halt:?}\n{source}");
    let _ = session.release();
    session.limit(u64::MAX);
    let back = session.go(Direction::Reverse, Walk::Continue);
    match &back {
        Halt::Stopped(Stop::AtStart) => {
            let what = format!("{walks:?}, {halt:?}\n{source}");
            assert_eq!(session.machine().digest(&unmoved), start, "{what}");
            let Some(cell) = session.run().cell() else { panic!("it is live: {what}") };
            assert_eq!(cell.ledger.outputs, unmoved.ledger.outputs, "{what}");
            let off_rad = cell.joints().largest_difference_rad(&unmoved.joints());
            assert!(off_rad < NEAR_RAD, "{off_rad} rad off: {what}");
        }
        Halt::Stopped(Stop::Refused(_) | Stop::Fault { .. }) => {}
        _ => panic!("{walks:?}, {halt:?}, back: {back:?}\n{source}"),
    }
    Ok(was_recovering)
}
