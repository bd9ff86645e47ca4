//! Disassembly in the simulated workcell: a program is run, then its inverse, forward; every item
//! is then where it was. No tape is used.

use obverse_bytecode::verify;
use obverse_geometry::Pose;
use obverse_recovery::{Ending, drive};
use obverse_sim::{Cell, Sim};
use obverse_testkit::invert_laws::together;
use obverse_vm::{Direction, Limits, Machine};
use obverse_workcell::Items;
use std::fs;
use std::path::Path;

/// How far from its place an item may be put back, in metres.
const TOLERANCE_M: f64 = 2e-6;

fn read(file: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{file}: {error}"))
}

fn poses(cell: &Cell, sim: &Sim) -> Vec<Pose> {
    let pose = |name: &str| sim.true_pose(sim.item(name).expect("an item")).expect("it has a pose");
    cell.items.iter().map(|item| pose(&item.name)).collect()
}

/// How far the item that has been moved farthest is from where it was, in metres, when these calls
/// have been made. What was the main sequence of the program is `work`.
fn moved_m(file: &str, cell: &str, calls: &str) -> f64 {
    let source = read(file).replace("sequence main {", "sequence work {");
    let alone = format!("{source}\nsequence main {{}}\n");
    let inverse = obverse_compiler::invert("work.obv", &alone, "work")
        .unwrap_or_else(|why| panic!("{file}: {why:#?}"));
    let text = format!("{}\nsequence main {{ {calls} }}\n", together(&source, &inverse.text));
    let compiled = obverse_compiler::compile("both.obv", &text);
    let module = compiled.module.unwrap_or_else(|| panic!("{:?}\n{text}", compiled.diagnostics));
    let program = verify(module).expect("it verifies");
    let cell = Cell::parse(&read(cell)).expect("a workcell");
    let mut sim = Sim::new(&cell, 1);
    let mut machine = Machine::new(&program, &sim).expect("it links");
    let before = poses(&cell, &sim);
    let end = drive(&mut machine, Direction::Forward, Limits::NONE, &mut sim, &mut ());
    assert_eq!(end, Ending::Finished, "{file}: {calls}");
    let apart = |(a, b): (&Pose, &Pose)| (a.translation_m - b.translation_m).norm();
    before.iter().zip(&poses(&cell, &sim)).map(apart).fold(0.0, f64::max)
}

#[test]
fn what_has_been_assembled_is_taken_apart() {
    let programs = [
        ("programs/sheets.obv", "programs/vacuum_cell.toml"),
        ("tests/golden/invert/tower.obv", "programs/bench_cell.toml"),
    ];
    for (file, cell) in programs {
        let there_m = moved_m(file, cell, "call work");
        assert!(there_m > 0.05, "{file} moves something: {there_m} m");
        let back_m = moved_m(file, cell, "call work call work_inverse");
        assert!(back_m < TOLERANCE_M, "{file} leaves something {back_m} m from its place");
    }
}
