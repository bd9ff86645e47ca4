//! The law of the tape file: what is recorded of a run, with its recoveries, shows the run again;
//! recording it changes nothing, and a file that is cut off anywhere shows it up to there.

use crate::logged::Logged;
use crate::programs::{self, Options};
use crate::recovery_laws::{Releases, STRATEGIES, all_reversing, program};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{FaultName, Verified};
use obverse_debugger::{Run, TapeFile, Taped, Writer, taped};
use obverse_recovery::{
    Bounds, Direct, Driven, Ending, Memory, Recovery, Strategy, drive_in, recover_in,
};
use obverse_vm::{Direction, Limits, Machine};

/// The longest run, in instructions.
const MAX_INSTRUCTIONS: u64 = 20_000;

/// How a run is driven.
#[derive(Clone, Copy, Debug)]
struct Way {
    seed: u64,
    stop_at: (u64, f64),
    strategy: Strategy,
    releases: u32,
    /// Whether back, too, as far as can be.
    and_back: bool,
}

/// Drive a machine so: how it ended.
fn driven(driven: &mut dyn Driven<'_, Logged>, way: Way) -> Ending {
    let mut recovery = Recovery {
        strategy: way.strategy,
        bounds: Bounds { attempts: 4, ..Bounds::default() },
        memory: &mut Memory::default(),
        remembers: true,
        person_s: 300.0,
        seed: 0,
        operator: &mut Releases(way.releases),
        foresight: None,
        incidents: Vec::new(),
    };
    let limits = Limits::instructions(MAX_INSTRUCTIONS);
    let there = recover_in(driven, limits, &mut recovery, &mut ());
    if there == Ending::Budget || !way.and_back {
        return there;
    }
    driven.release();
    drive_in(driven, Direction::Reverse, Limits::NONE, &mut ())
}

fn cell(way: Way) -> Logged {
    let mut cell = Logged::new(way.seed);
    cell.ledger.stop_at = Some(way.stop_at);
    cell
}

/// Recorded or not, a run is the same; the file of the one that was leads to its end, bit for bit,
/// its tape and its notes included; and cut off anywhere, it leads to a moment of it.
///
/// # Errors
/// Those of the randomness.
///
/// # Panics
/// If it is not so.
pub fn shows_the_run_again(u: &mut Unstructured<'_>) -> Result<bool> {
    let way = Way {
        seed: u.arbitrary()?,
        stop_at: (u.int_in_range(0..=40)?, f64::from(u.int_in_range(0_u8..=10)?) / 10.0),
        strategy: *u.choose(&STRATEGIES)?,
        releases: u.int_in_range(0..=2)?,
        and_back: u.ratio(1, 4)?,
    };
    let cut_at: u16 = u.arbitrary()?;
    let options = Options { allow_overrides: u.arbitrary()?, ..Options::default() };
    let source = all_reversing(&programs::generate(u, options)?);
    let names_faults: bool = u.arbitrary()?;
    let program = program(&source, |module| {
        if let (true, Some(error)) = (names_faults, module.errors.first_mut()) {
            error.faults = vec![FaultName::ProtectiveStop];
        }
    });
    let mut plain = cell(way);
    let Ok(mut machine) = Machine::new(&program, &plain) else { return Ok(false) };
    let ended = driven(&mut Direct { machine: &mut machine, cell: &mut plain }, way);
    if ended == Ending::Budget {
        // Where a run is cut off is not said to the instruction.
        return Ok(false);
    }
    let (bytes, recorded, digest) = recorded(&program, way);
    let told = || format!("{way:?}, {ended:?}\n{source}");
    assert_eq!(recorded, ended, "{}", told());
    assert_eq!(digest, machine.digest(&plain), "{}", told());
    let whole = match TapeFile::from_bytes(&bytes) {
        Ok(file) => file,
        Err(error) => panic!("{error}: {}", told()),
    };
    assert_eq!((whole.ending.as_deref(), whole.torn_bytes), (Some("over"), 0));
    let Ok(run) = Run::<Logged>::of_recording(&program, whole.recording) else {
        panic!("it does not fit: {}", told())
    };
    let (_, streams) = run.as_data();
    assert_eq!(run.rewound().digest(run.recording()), digest, "{}", told());
    assert_eq!(streams, machine.streams(), "{}", told());
    let cut = bytes.len() * usize::from(cut_at) / usize::from(u16::MAX);
    let Ok(part) = TapeFile::from_bytes(&bytes[..cut]) else {
        // In its head.
        return Ok(true);
    };
    let Ok(part) = Run::<Logged>::of_recording(&program, part.recording) else {
        panic!("cut off after {cut} bytes it does not fit: {}", told())
    };
    let mut shown = run.rewound();
    shown.go_to(run.recording(), run.timeline(), part.recording().end);
    let is_there = shown.moment() == part.recording().end;
    assert!(is_there, "cut off after {cut} bytes: {}", told());
    let (state, shown) = (part.machine().state(), shown.machine().state());
    assert_eq!((state.pc(), state.steps()), (shown.pc(), shown.steps()), "{cut}: {}", told());
    Ok(!run.recording().log.notes.is_empty())
}

/// The file of a run, how it ended, and the digest of its end.
fn recorded(program: &Verified, way: Way) -> (Vec<u8>, Ending, u64) {
    let mut cell = cell(way);
    let Ok(mut machine) = Machine::new(program, &cell) else { panic!("it linked before") };
    let names = ("program.obv".to_owned(), None);
    let Ok(head) = taped::head(program.module(), &cell, names, way.seed) else {
        panic!("the module is too large")
    };
    let mut bytes = Vec::new();
    let mut taped = Taped::new(&mut machine, &mut cell, Writer::begin(&mut bytes, head));
    let ended = driven(&mut taped, way);
    let Ok(()) = taped.end("over") else { panic!("memory can be written") };
    let digest = machine.digest(&cell);
    (bytes, ended, digest)
}
