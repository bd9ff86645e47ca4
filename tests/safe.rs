//! Whatever is stopped wherever, and by whatever strategy it is met: a run ends in success or in a
//! give-up that has a name; the cleanup has been gone through, unless the arm is held; nothing goes
//! back over what cannot be taken back; and where it ended it can be gone back from, to the state
//! that the program began in.
//!
//! Every program is run with faults of every kind that there is at drawn acts, in either direction,
//! also while a recovery is under way. `SAFE_RUNS` sets how many runs there are of each program,
//! over all strategies.

use obverse_bytecode::{ErrorDeclaration, FaultName, Severity, Verified, Watched, verify};
use obverse_compiler::compile_files;
use obverse_isa::{Class, Family, Instr};
use obverse_recovery::{
    Bounds, Clairvoyant, Ending, Memory, Operator, Recovery, Step, Strategy, Teller, drive, recover,
};
use obverse_sim::random::{Stream, bits};
use obverse_sim::{Cell, FaultPlan, Sim};
use obverse_testkit::faulty::Faulty;
use obverse_testkit::files::Folder;
use obverse_testkit::recovery_laws::{STRATEGIES, acts_in_place};
use obverse_vm::{Direction, Event, Limits, Machine, Observer};
use obverse_workcell::{Fault, FaultKind, Safety, Workcell};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// How many runs of each program there are, unless said otherwise.
const RUNS: u64 = 120;

/// How many faults are planned in a run at the most.
const FAULTS_MAX: u64 = 4;

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
    // Where a program has an error and names no fault, its first one is raised by all of them; but
    // no warning is, which would let it go on as if nothing had happened, and wait for ever for
    // what did not.
    let names_faults = module.errors.iter().any(|error| !error.faults.is_empty());
    let is_more = |error: &&mut ErrorDeclaration| error.severity != Severity::Warning;
    if let (false, Some(error)) = (names_faults, module.errors.iter_mut().find(is_more)) {
        error.faults = FaultName::ALL.to_vec();
        // A cell says of what is watched whose it is; here always that of the first error.
        error.watches = vec![Watched::Force { above_n: 1e6 }];
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

/// A kind of fault, what the act was that met it, and which way.
type Met = (FaultKind, Family, bool);

/// Watches that nothing goes back over what cannot be taken back, that the cleanup is gone through,
/// and which faults are met where.
struct Guard<'p> {
    program: &'p Program,
    /// Whether the start went on behind the cleanup.
    is_cleaned_up: bool,
    /// What the start has called last.
    called: Option<u16>,
    /// How many instructions lay before what was passed last that cannot be taken back.
    floor_steps: u64,
    crossed: Option<u32>,
    met: BTreeSet<Met>,
}

impl Guard<'_> {
    fn meet(&mut self, fault: &Fault, pc: u32, direction: Direction) {
        let instr = self.program.verified.module().code[pc as usize];
        self.met.insert((fault.kind(), instr.info().family, direction == Direction::Reverse));
    }
}

impl Observer for Guard<'_> {
    fn on_event(&mut self, event: &Event, _: &dyn Workcell) {
        let is_never = matches!(event.instr.info().class, Class::Never(_));
        match event.instr {
            // Back in the start.
            Instr::Return {} if event.frames == 1 => {
                self.is_cleaned_up = self.called == self.program.verified.module().cleanup;
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

impl Teller for Guard<'_> {
    fn on_step(&mut self, step: &Step<'_>, _: &dyn Workcell) {
        match step {
            Step::Fault { fault, pc, .. } => self.meet(fault, *pc, Direction::Forward),
            Step::Blocked { fault, pc, .. } => self.meet(fault, *pc, Direction::Reverse),
            _ => {}
        }
    }
}

/// One run, with faults at drawn acts; which of them were met where.
fn run(program: &Program, number: u64, memory: &mut Memory) -> BTreeSet<Met> {
    let draw = |what: u64| bits(number, Stream::Dice, what);
    let strategy = STRATEGIES[(number % STRATEGIES.len() as u64) as usize];
    let mut cell = Faulty::new(Sim::new(&program.cell, draw(0)));
    let mut faults = Vec::new();
    for fault in 0..1 + draw(1) % FAULTS_MAX {
        let kind = FaultKind::ALL[(draw(10 + fault) % FaultKind::ALL.len() as u64) as usize];
        let fraction = (draw(20 + fault) % 11) as f64 / 10.0;
        let plan = FaultPlan { act: draw(30 + fault) % 60, fraction };
        cell.plan(kind, plan);
        faults.push((kind, plan));
    }
    let releases = draw(2) % 4;
    let case =
        || format!("{} {number}: {strategy:?}, {faults:?}, {releases} releases", program.name);
    let mut machine = Machine::new(&program.verified, &cell).unwrap();
    let mut guard = Guard {
        program,
        is_cleaned_up: false,
        called: None,
        floor_steps: 0,
        crossed: None,
        met: BTreeSet::new(),
    };
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
        foresight: Some(&mut Clairvoyant::default()),
        incidents: Vec::new(),
    };
    let limits = Limits::instructions(2_000_000);
    let ending = recover(&mut machine, limits, &mut cell, &mut recovery, &mut guard);
    let incidents = recovery.incidents;
    let is_named = matches!(
        ending,
        Ending::Finished | Ending::Unhandled(_) | Ending::GivenUp { .. } | Ending::Fault { .. }
    );
    assert!(is_named, "{}: {ending:?}", case());
    assert_eq!(guard.crossed, None, "{}: gone back over a never", case());
    let module = program.verified.module();
    let is_safe = module.cleanup.is_none() || guard.is_cleaned_up || cell.is_stopped();
    assert!(is_safe, "{}: {ending:?} without the cleanup", case());
    let errors = &module.errors;
    for incident in incidents {
        let most = errors[incident.error.index()].bounds.attempts;
        let most = most.unwrap_or(Bounds::default().attempts) as usize;
        assert!(incident.attempts.len() <= most, "{}: {incident:?}", case());
    }
    if let Ending::Fault { fault, pc, direction } = &ending {
        guard.meet(fault, *pc, *direction);
    }
    if go_back(&mut machine, &mut cell, strategy, &mut guard, &case) {
        assert_eq!(machine.digest(&unmoved), start, "{}: the program's state", case());
    }
    guard.met
}

/// Whether something in the world is in the way, where the arm was moved in place or by hand.
fn is_in_the_way(fault: &Fault, strategy: Strategy) -> bool {
    match fault.kind() {
        FaultKind::Collision | FaultKind::ForceLimit => true,
        // A bad command, too, since a straight line from elsewhere may end with other joints.
        FaultKind::JointLimit
        | FaultKind::OutOfReach
        | FaultKind::Singular
        | FaultKind::BadCommand => acts_in_place(strategy),
        _ => false,
    }
}

/// From wherever a run ended there is a way back: released whenever it is stopped. Whether it led
/// to the start.
fn go_back(
    machine: &mut Machine<'_>,
    cell: &mut Faulty,
    strategy: Strategy,
    guard: &mut Guard<'_>,
    case: &dyn Fn() -> String,
) -> bool {
    let mut faults = Vec::new();
    // Most of so many are none of the planned ones.
    for _ in 0..2 * FAULTS_MAX + 2 {
        cell.release();
        match drive(machine, Direction::Reverse, Limits::NONE, cell, &mut ()) {
            Ending::AtStart => return true,
            Ending::Refused(_) => return false,
            Ending::Fault { fault, pc, direction } => {
                guard.meet(&fault, pc, direction);
                faults.push(fault);
            }
            other => panic!("{}: back: {other:?}", case()),
        }
    }
    let in_the_way = faults.iter().filter(|fault| is_in_the_way(fault, strategy)).count();
    assert!(in_the_way > FAULTS_MAX as usize, "{}: back: {faults:?}", case());
    false
}

/// So many runs of each program; which faults were met where.
fn run_all(paths: &[PathBuf], runs: u64) -> BTreeSet<Met> {
    let mut met = BTreeSet::new();
    for path in paths {
        let program = load(path);
        let mut memory = Memory::default();
        (0..runs).for_each(|number| met.extend(run(&program, number, &mut memory)));
    }
    met
}

#[test]
fn every_run_ends_well_or_in_a_named_give_up() {
    let runs = std::env::var("SAFE_RUNS").ok().and_then(|text| text.parse().ok()).unwrap_or(RUNS);
    let mut found = Vec::new();
    programs(Path::new("programs"), &mut found);
    assert!(found.len() >= 10, "{found:?}");
    let half = found.len() / 2;
    let mut met = BTreeSet::new();
    std::thread::scope(|scope| {
        let parts = [&found[..half], &found[half..]];
        let parts = parts.map(|part| scope.spawn(move || run_all(part, runs)));
        parts.into_iter().for_each(|part| met.extend(part.join().expect("its runs end well")));
    });
    if runs >= RUNS {
        for kind in FaultKind::ALL {
            for family in [Family::Kinematic, Family::Io] {
                for is_reverse in [false, true] {
                    let place = (*kind, family, is_reverse);
                    assert!(met.contains(&place), "nowhere met: {place:?}");
                }
            }
        }
    }
}
