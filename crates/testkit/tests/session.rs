//! The debugger is a run: gone through in a session by `continue` alone, every program comes to the
//! end that it comes to by itself, with the same story and the same tape, and learns the same.

use obverse_bytecode::{Verified, verify};
use obverse_compiler::{compile, compile_files};
use obverse_debugger::{Halt, Policy, Run, Session, Walk};
use obverse_recovery::{
    Bounds, Incident, Memory, Operator, Outcome, PERSON_S, Recovery, Step, Strategy, Subject,
    Teller, recover,
};
use obverse_sim::{Cell, FaultPlan, Sim};
use obverse_testkit::Ledger;
use obverse_testkit::faulty::Faulty;
use obverse_testkit::files::Folder;
use obverse_vm::{Direction, Event, Limits, Machine, Observer};
use obverse_workcell::{Fault, FaultKind, Workcell};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

const PROGRAMS_FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../programs");

/// The programs whose parts lie so that going back is what helps, and others that go back.
const PROGRAMS: [&str; 7] = [
    "cases/bearing/bearing.obv",
    "cases/cover/cover.obv",
    "cases/peg/peg.obv",
    "cases/plug/plug.obv",
    "reversal_policy.obv",
    "sheets.obv",
    "tower.obv",
];

/// How many assemblies of each there are.
const SEEDS: u64 = 90;

/// Lets a held arm go, whenever it is asked.
struct Releases;

impl Operator for Releases {
    fn release(&mut self, _: &Fault) -> bool {
        true
    }
}

/// What is told of a run, in words.
#[derive(Clone, Default)]
struct Told(Arc<Mutex<Vec<String>>>);

impl Told {
    fn tell(&self, words: String) {
        self.0.lock().unwrap().push(words);
    }
}

impl Observer for Told {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        self.tell(format!("{} {event:?}", cell.now_s()));
    }
}

impl Teller for Told {
    fn on_step(&mut self, step: &Step<'_>, cell: &dyn Workcell) {
        self.tell(format!("{} {step:?}", cell.now_s()));
    }
}

fn load(program: &str) -> (Verified, Cell) {
    let path = Path::new(PROGRAMS_FOLDER).join(program);
    let (folder, name) = (path.parent().unwrap(), path.file_name().unwrap().to_string_lossy());
    let text = std::fs::read_to_string(&path).unwrap();
    let module = compile_files(&name, &text, &mut Folder::read(folder)).module.unwrap();
    let cell = std::fs::read_to_string(folder.join(module.cell.as_ref().unwrap())).unwrap();
    (verify(module).unwrap(), Cell::parse(&cell).unwrap())
}

/// The workcell of a seed; every third has a fault in store, which may stop the arm.
fn workcell(cell: &Cell, seed: u64) -> Faulty {
    let mut faulty = Faulty::new(Sim::new(cell, seed));
    if seed.is_multiple_of(3) {
        let kind = FaultKind::ALL[(seed / 3) as usize % FaultKind::ALL.len()];
        faulty.plan(kind, FaultPlan { act: seed % 17, fraction: 0.4 });
    }
    faulty
}

/// What there is to compare of a run.
#[derive(Debug, PartialEq)]
struct Came {
    told: Vec<String>,
    incidents: Vec<Incident>,
    digest: u64,
    streams: obverse_tape::Streams,
    learned: String,
}

fn learned(memory: &Memory) -> String {
    memory.to_text(&Subject { program: "p.obv".to_owned(), cell: "c.toml".to_owned() })
}

fn by_itself(program: &Verified, mut cell: Faulty, memory: &mut Memory, seed: u64) -> Came {
    let mut machine = Machine::new(program, &cell).unwrap();
    let mut told = Told::default();
    let mut recovery = Recovery {
        strategy: Strategy::Declared,
        bounds: Bounds::default(),
        memory,
        remembers: true,
        person_s: PERSON_S,
        seed,
        operator: &mut Releases,
        foresight: None,
        incidents: Vec::new(),
    };
    recover(&mut machine, Limits::NONE, &mut cell, &mut recovery, &mut told);
    let incidents = recovery.incidents;
    let told = told.0.lock().unwrap().clone();
    let (digest, learned) = (machine.digest(&cell), learned(memory));
    Came { told, incidents, digest, streams: machine.streams(), learned }
}

fn in_a_session(program: &Verified, cell: Faulty, memory: &mut Memory, seed: u64) -> Came {
    let mut session = Session::over(Run::new(program, cell).unwrap());
    let told = Told::default();
    session.tell_to(Box::new(told.clone()));
    session.recover_by(Policy::declared(seed), memory.clone());
    while !session.is_over() {
        if session.go(Direction::Forward, Walk::Continue) == Halt::Held {
            session.release().unwrap();
        }
    }
    *memory = session.memory().clone();
    let told = told.0.lock().unwrap().clone();
    let (digest, streams) = (session.digest(), session.machine().streams());
    Came {
        told,
        incidents: session.incidents().to_vec(),
        digest,
        streams,
        learned: learned(memory),
    }
}

#[test]
fn continue_alone_is_the_run() {
    let (mut recovered, mut given_up) = (0, 0);
    for name in PROGRAMS {
        let (program, cell) = load(name);
        let (mut one, mut other) = (Memory::default(), Memory::default());
        for seed in 1..=SEEDS {
            let alone = by_itself(&program, workcell(&cell, seed), &mut one, seed);
            let walked = in_a_session(&program, workcell(&cell, seed), &mut other, seed);
            let differs =
                alone.told.iter().zip(&walked.told).find(|(alone, walked)| alone != walked);
            assert_eq!(differs, None, "{name}, seed {seed}");
            assert_eq!(walked, alone, "{name}, seed {seed}");
            let outcomes = alone.incidents.iter().filter_map(|incident| incident.outcome);
            for (outcome, _) in outcomes {
                recovered += u32::from(outcome == Outcome::Recovered);
                given_up += u32::from(matches!(outcome, Outcome::GivenUp(_)));
            }
        }
    }
    assert!(recovered > 60 && given_up > 8, "{recovered} recovered, {given_up} given up");
}

/// Interrupts as soon as it is told something.
struct Impatient(Arc<AtomicBool>);

impl Observer for Impatient {
    fn on_event(&mut self, _: &Event, _: &dyn Workcell) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Teller for Impatient {
    fn on_step(&mut self, _: &Step<'_>, _: &dyn Workcell) {}
}

#[test]
fn a_run_that_tells_much_is_interrupted_before_it_has_told_much_more() {
    let source = "var n = 0\nsequence add { n += 1 }\nsequence main {\n  \
                  for turn from 1 to 5000 { call add }\n  if n > 0 { set 1 high }\n}\n";
    let compiled = compile("p.obv", source);
    let program = verify(compiled.module.expect("it compiles")).expect("it verifies");
    let mut session = Session::over(Run::new(&program, Ledger::new(1)).expect("it links"));
    session.tell_to(Box::new(Impatient(session.interrupter())));
    for _ in 0..3 {
        let before = session.moment();
        assert_eq!(session.go(Direction::Forward, Walk::Continue), Halt::Interrupted);
        let made = session.moment().0 - before.0;
        assert!(made <= 1_000, "{made} instructions, of which the first ones were told");
    }
}
