//! Whatever is stopped wherever, and by whatever strategy it is met: a run ends in success or in a
//! give-up that has a name; the cleanup has been gone through, unless the arm is held; nothing goes
//! back over what cannot be taken back; and where it ended it can be gone back from, to the state
//! that the program began in.
//!
//! Every program is run with a stop of every kind at drawn acts, in either direction. `SAFE_RUNS`
//! sets how many runs there are of each program, over all strategies.

use obverse_bytecode::{ErrorDeclaration, FaultName, Severity, Verified, verify};
use obverse_compiler::compile_files;
use obverse_isa::{Class, Instr};
use obverse_recovery::{
    Bounds, Clairvoyant, Ending, Memory, Operator, Recovery, Step, Strategy, Teller, drive, recover,
};
use obverse_sim::random::{Stream, bits};
use obverse_sim::{Cell, FaultPlan, Sim, StopKind};
use obverse_testkit::files::Folder;
use obverse_vm::{Direction, Event, Limits, Machine, Observer};
use obverse_workcell::{Fault, Safety, Workcell};
use std::path::{Path, PathBuf};

/// How many runs of each program there are, unless said otherwise.
const RUNS: u64 = 120;

const STRATEGIES: [Strategy; 10] = [
    Strategy::Declared,
    Strategy::Stop,
    Strategy::Retry { times: 3 },
    Strategy::BackUp { distance_m: 0.30, times: 6 },
    Strategy::Restart { times: 3 },
    Strategy::Explicit,
    Strategy::Fixed { actions: 3 },
    Strategy::Escalating,
    Strategy::Learned,
    Strategy::Oracle,
];

/// Every program for people, at whatever depth, with its workcell.
fn programs(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            programs(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "obv") {
            let text = std::fs::read_to_string(&path).unwrap();
            // What is imported has no workcell of its own.
            if text.lines().any(|line| line.starts_with("cell ")) {
                found.push(path);
            }
        }
    }
}

struct Program {
    name: String,
    verified: Verified,
    cell: Cell,
}

fn load(path: &Path) -> Program {
    let folder = path.parent().unwrap();
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let text = std::fs::read_to_string(path).unwrap();
    let mut files = Folder::read(folder);
    let compiled = compile_files(&name, &text, &mut files);
    let mut module =
        compiled.module.unwrap_or_else(|| panic!("{name}: {:#?}", compiled.diagnostics));
    // Where a program has an error and names no fault, its first one is raised by some; but no
    // warning is, which would let it go on as if nothing had happened, and wait for ever for what
    // did not.
    let names_faults = module.errors.iter().any(|error| !error.faults.is_empty());
    let is_more = |error: &&mut ErrorDeclaration| error.severity != Severity::Warning;
    if let (false, Some(error)) = (names_faults, module.errors.iter_mut().find(is_more)) {
        error.faults = vec![FaultName::ProtectiveStop, FaultName::StoppedShort];
    }
    let cell = folder.join(module.cell.as_ref().unwrap());
    let cell = Cell::parse(&std::fs::read_to_string(cell).unwrap()).unwrap();
    let verified = verify(module).unwrap_or_else(|errors| panic!("{name}: {errors:?}"));
    Program { name, verified, cell }
}

/// A person who releases a stopped arm so often.
struct Releases(u64);

impl Operator for Releases {
    fn release(&mut self, _: &Fault) -> bool {
        let is_left = self.0 > 0;
        self.0 = self.0.saturating_sub(1);
        is_left
    }
}

/// Watches that nothing goes back over what cannot be taken back, and that the cleanup is gone
/// through.
#[derive(Default)]
struct Guard {
    /// The function of the cleanup, if there is one.
    cleanup: Option<u16>,
    /// Whether the start went on behind it.
    is_cleaned_up: bool,
    /// What the start has called last.
    called: Option<u16>,
    /// How many instructions lay before what was passed last that cannot be taken back.
    floor_steps: u64,
    crossed: Option<u32>,
}

impl Observer for Guard {
    fn on_event(&mut self, event: &Event, _: &dyn Workcell) {
        let is_never = matches!(event.instr.info().class, Class::Never(_));
        match event.instr {
            // Back in the start.
            Instr::Return {} if event.frames == 1 => {
                self.is_cleaned_up = self.called == self.cleanup;
            }
            Instr::Call { function, .. } if event.frames == 2 => self.called = Some(function.0),
            _ => {}
        }
        match event.direction {
            Direction::Forward if is_never && event.open_blocks == 0 => {
                self.floor_steps = event.steps;
            }
            Direction::Reverse if event.steps < self.floor_steps => self.crossed = Some(event.pc),
            _ => {}
        }
    }
}

impl Teller for Guard {
    fn on_step(&mut self, _: &Step<'_>, _: &dyn Workcell) {}
}

/// One run, with stops at drawn acts.
fn run(program: &Program, number: u64, memory: &mut Memory) {
    let draw = |what: u64| bits(number, Stream::Dice, what);
    let strategy = STRATEGIES[(number % STRATEGIES.len() as u64) as usize];
    let mut sim = Sim::new(&program.cell, draw(0));
    let mut stops = Vec::new();
    for stop in 0..1 + draw(1) % 3 {
        let kinds = [StopKind::Protective, StopKind::Emergency, StopKind::Short];
        let kind = kinds[(draw(10 + stop) % 3) as usize];
        let fraction = (draw(20 + stop) % 11) as f64 / 10.0;
        let plan = FaultPlan { act: draw(30 + stop) % 60, fraction };
        sim.inject_as(plan, kind);
        stops.push((kind, plan));
    }
    let releases = draw(2) % 4;
    let case =
        || format!("{} {number}: {strategy:?}, {stops:?}, {releases} releases", program.name);
    let mut machine = Machine::new(&program.verified, &sim).unwrap();
    let module = program.verified.module();
    let mut guard = Guard { cleanup: module.cleanup, ..Guard::default() };
    let unmoved = Sim::new(&program.cell, 0);
    let start = machine.digest(&unmoved);
    let mut recovery = Recovery {
        strategy,
        bounds: Bounds::default(),
        memory,
        remembers: true,
        person_s: 300.0,
        seed: number,
        operator: &mut Releases(releases),
        foresight: Some(&mut Clairvoyant),
        incidents: Vec::new(),
    };
    let limits = Limits::instructions(2_000_000);
    let ending = recover(&mut machine, limits, &mut sim, &mut recovery, &mut guard);
    let incidents = recovery.incidents;
    let is_named = matches!(
        ending,
        Ending::Finished | Ending::Unhandled(_) | Ending::GivenUp { .. } | Ending::Fault { .. }
    );
    assert!(is_named, "{}: {ending:?}", case());
    assert_eq!(guard.crossed, None, "{}: gone back over a never", case());
    let is_safe = module.cleanup.is_none() || guard.is_cleaned_up || sim.is_stopped();
    assert!(is_safe, "{}: {ending:?} without the cleanup", case());
    let errors = &module.errors;
    for incident in incidents {
        let most = errors[incident.error.index()].bounds.attempts;
        let most = most.unwrap_or(Bounds::default().attempts) as usize;
        assert!(incident.attempts.len() <= most, "{}: {incident:?}", case());
    }
    if go_back(&mut machine, &mut sim, &case) {
        assert_eq!(machine.digest(&unmoved), start, "{}: the program's state", case());
    }
}

/// From wherever a run ended there is a way back: released whenever it is stopped. Whether it led
/// to the start.
fn go_back(machine: &mut Machine<'_>, sim: &mut Sim, case: &dyn Fn() -> String) -> bool {
    let mut blocked = 0;
    loop {
        sim.release();
        match drive(machine, Direction::Reverse, Limits::NONE, sim, &mut ()) {
            Ending::AtStart => return true,
            Ending::Refused(_) => return false,
            // What stands in the way in the world, where the arm was moved in place or by hand.
            Ending::Fault { fault: Fault::Collision { .. } | Fault::ForceLimit { .. }, .. } => {
                return false;
            }
            Ending::Fault { .. } if blocked < 8 => blocked += 1,
            other => panic!("{}: back: {other:?}", case()),
        }
    }
}

#[test]
fn every_run_ends_well_or_in_a_named_give_up() {
    let runs = std::env::var("SAFE_RUNS").ok().and_then(|text| text.parse().ok()).unwrap_or(RUNS);
    let mut found = Vec::new();
    programs(Path::new("programs"), &mut found);
    assert!(found.len() >= 10, "{found:?}");
    std::thread::scope(|scope| {
        let half = found.len() / 2;
        for part in [&found[..half], &found[half..]] {
            scope.spawn(move || {
                for path in part {
                    let program = load(path);
                    let mut memory = Memory::default();
                    (0..runs).for_each(|number| run(&program, number, &mut memory));
                }
            });
        }
    });
}
