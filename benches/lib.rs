//! What the benchmarks share: programs, compiled from their sources, and machines to run them.

use obverse_bytecode::{Verified, verify};
use obverse_testkit::Ledger;
use obverse_vm::{Direction, Limits, Machine, Stop};
use std::time::{Duration, Instant};

/// The sources of the programs that the machine is measured on, by name.
pub const SOURCES: [(&str, &str); 2] = [
    ("branches", include_str!("programs/branches.obv")),
    ("stores", include_str!("programs/stores.obv")),
];

/// A program of a source text.
///
/// # Panics
/// If the source does not compile.
#[must_use]
pub fn program(name: &str, source: &str) -> Verified {
    let compiled = obverse_compiler::compile(name, source);
    let Some(module) = compiled.module else { panic!("{name}: {:?}", compiled.diagnostics) };
    match verify(module) {
        Ok(verified) => verified,
        Err(errors) => panic!("{name}: {errors:?}"),
    }
}

/// A machine at the start of a program.
///
/// # Panics
/// If the program does not link to a bookkeeping workcell.
#[must_use]
pub fn machine<'p>(program: &'p Verified, cell: &Ledger) -> Machine<'p> {
    match Machine::new(program, cell) {
        Ok(machine) => machine,
        Err(errors) => panic!("{errors:?}"),
    }
}

/// Run to the end in a direction; how long it took.
///
/// # Panics
/// If the run ends otherwise.
pub fn timed(machine: &mut Machine<'_>, direction: Direction, cell: &mut Ledger) -> Duration {
    let begin = Instant::now();
    let stop = machine.run(direction, Limits::NONE, cell, &mut ());
    let took = begin.elapsed();
    assert!(matches!(stop, Stop::Finished | Stop::AtStart), "{stop:?}");
    took
}
