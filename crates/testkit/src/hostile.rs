//! What is done with bytes and text from outside: none of it may panic, nor take long, whatever
//! they are. Each is a function of bytes: the same function is a test and a fuzz target.
//!
//! Knows the doors that untrusted input comes in by, and what a user would do with what came in;
//! how valid things are altered is for [`crate::altered`] to know.

use crate::Ledger;
use crate::altered::{self, Recorded};
use arbitrary::Unstructured;
use obverse_bytecode::codec::{self, MODULE};
use obverse_bytecode::{Module, Verified, assemble, decode, disassemble, encode, verify};
use obverse_compiler::compile;
use obverse_debugger::file::{TAPE, TapeFile};
use obverse_debugger::{Grain, Moment, Run, Session, Walk};
use obverse_sim::Cell;
use obverse_tape::{Snapshot, Streams};
use obverse_vm::{Direction, Limits, Machine, Stop};
use serde::ser::{Serialize, SerializeTuple, Serializer};

/// How far a machine is run or stepped in each direction, in instructions.
const STEPS: u64 = 2_000;

/// Bytes as the payload of a file: sealed, their header and their checksum are right.
struct Payload<'b>(&'b [u8]);

impl Serialize for Payload<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(self.0.len())?;
        for byte in self.0 {
            tuple.serialize_element(byte)?;
        }
        tuple.end()
    }
}

/// A module's bytes, and bytes as the payload of a module: decoded, verified, run. Whether one of
/// them was run.
pub fn module_bytes(bytes: &[u8]) -> bool {
    let whole = decode(bytes).is_ok_and(there_and_back);
    let sealed = codec::seal(MODULE, &Payload(bytes));
    let payload = sealed.and_then(|bytes| decode(&bytes));
    payload.is_ok_and(there_and_back) || whole
}

/// A tape file's bytes, and bytes as the parts of a tape file, each behind its length in two bytes:
/// read, and opened in the debugger. Whether one of them was.
pub fn tape_bytes(bytes: &[u8]) -> bool {
    let whole = TapeFile::from_bytes(bytes).is_ok_and(opened);
    let mut parts = Vec::new();
    let mut rest = bytes;
    while let Some((length, after)) = rest.split_first_chunk::<2>() {
        let length = usize::from(u16::from_le_bytes(*length)).min(after.len());
        let (part, after) = after.split_at(length);
        parts.extend(codec::seal(TAPE, &Payload(part)).unwrap_or_default());
        rest = after;
    }
    TapeFile::from_bytes(&parts).is_ok_and(opened) || whole
}

/// Everything that a debugger does with a recording, for so long.
fn opened(file: TapeFile) -> bool {
    let Ok(program) = verify(file.module) else { return false };
    let mut recording = file.recording;
    recording.end = recording.end.min(Moment(STEPS));
    let Ok(run) = Run::of_recording(&program, recording) else { return false };
    let _data = run.as_data();
    let mut session = Session::over(run.simulated(Some(Ledger::new(1))));
    let half = Moment(session.moment().0 / 2);
    let _shown = (session.history(), session.why(), session.digest());
    session.go(Direction::Reverse, Walk::Next(Grain::Statement));
    if session.go_to(half).is_ok() && session.what_if().is_ok() {
        session.limit(STEPS);
        session.go(Direction::Forward, Walk::Continue);
        session.go(Direction::Reverse, Walk::Continue);
    }
    true
}

/// The text of a module, or whatever the bytes are of it. Whether it was run.
pub fn assembly(bytes: &[u8]) -> bool {
    assemble(&String::from_utf8_lossy(bytes)).is_ok_and(there_and_back)
}

/// The source of a program, or whatever the bytes are of it. What compiles verifies. Whether it
/// did.
///
/// # Panics
/// If the compiler makes a module that does not verify.
pub fn source(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let Some(module) = compile("program.obv", &text).module else { return false };
    match verify(module) {
        Ok(program) => run(&program),
        Err(errors) => panic!("it compiles and does not verify: {errors:?}\n{text}"),
    }
}

/// The text of a workcell file, or whatever the bytes are of it. Whether it is one.
pub fn workcell(bytes: &[u8]) -> bool {
    Cell::parse(&String::from_utf8_lossy(bytes)).is_ok()
}

/// A valid module, altered as the bytes say. Whether it still is one and was run.
pub fn altered_module(bytes: &[u8]) -> bool {
    let module = altered::module(&mut Unstructured::new(bytes));
    let bytes = module.ok().and_then(|module| encode(&module).ok());
    bytes.is_some_and(|bytes| module_bytes(&bytes))
}

/// A valid state with its tape, altered as the bytes say. Whether it still is one and was walked.
pub fn altered_recording(bytes: &[u8]) -> bool {
    altered::recording(&mut Unstructured::new(bytes)).is_ok_and(walked)
}

fn there_and_back(module: Module) -> bool {
    let _shown = disassemble(&module);
    verify(module).is_ok_and(|program| run(&program))
}

/// Run a program, in a workcell that does all it is told, so far, and take it back.
fn run(program: &Verified) -> bool {
    let mut cell = Ledger::new(1);
    let Ok(mut machine) = Machine::new(program, &cell) else { return false };
    let limits = Limits::instructions(STEPS);
    let mut raised = 0;
    while let Stop::Raised { .. } | Stop::Due { .. } =
        machine.run(Direction::Forward, limits, &mut cell, &mut ())
    {
        raised += 1;
        if raised == STEPS {
            break;
        }
    }
    walk(&mut machine, &mut cell);
    true
}

fn walked(file: Recorded) -> bool {
    let Ok(program) = verify(file.module) else { return false };
    let is_one = unwound(&program, &file.state, &file.streams);
    let mut cell = Ledger::new(1);
    if let Ok(mut machine) = Machine::from_recording(&program, &file.state, &file.streams, &cell) {
        walk(&mut machine, &mut cell);
    }
    is_one
}

/// What `obverse` does with a recording: look at it, step by step back.
fn unwound(program: &Verified, state: &Snapshot, streams: &Streams) -> bool {
    let mut cell = Ledger::new(1);
    let Ok(mut machine) = Machine::from_recording(program, state, streams, &cell) else {
        return false;
    };
    for _ in 0..STEPS {
        if machine.unwind(&mut cell).is_err() {
            break;
        }
    }
    look(&machine, &cell);
    true
}

/// Step by step back, and forward again, on whatever happens: going on after a stop is allowed.
fn walk(machine: &mut Machine<'_>, cell: &mut Ledger) {
    for direction in [Direction::Reverse, Direction::Forward, Direction::Reverse] {
        let mut stops = 0;
        for _ in 0..STEPS {
            stops += u32::from(machine.step(direction, cell, &mut ()).is_err());
            if stops > 3 {
                break;
            }
        }
        look(machine, cell);
    }
}

/// All that can be asked of a machine wherever it stands.
fn look(machine: &Machine<'_>, cell: &Ledger) {
    let (snapshot, streams) = (machine.snapshot(cell), machine.streams());
    let _again = Machine::from_recording(machine.program(), &snapshot, &streams, cell);
    let _digest = machine.digest(cell);
}
