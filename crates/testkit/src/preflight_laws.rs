//! The law of the check before anything moves: what it says of a move is what a run meets there.
//!
//! Programs are generated, and so are workcells around them, with fixtures in the way. The run is
//! one without chance: everything is where the workcell file says.

use crate::code;
use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{Constant, Module, Verified, disassemble, verify};
use obverse_compiler::compile;
use obverse_geometry::Pose;
use obverse_isa::{Axis, Frame, Instr};
use obverse_preflight::{Grade, Graded, Report, check};
use obverse_sim::cell::{FixtureSpec, InputRule, ItemSpec, OffsetSpec, Part, Shape, ToolSpec};
use obverse_sim::{Cell, Plan, Sim};
use obverse_vm::{Direction, Event, Limits, Machine, Observer, Stop};
use obverse_workcell::{Fault, MotionEnd, Workcell};
use std::f64::consts::PI;

/// The longest run that is compared, in instructions.
const MAX_INSTRUCTIONS: u64 = 20_000;

/// A run meets a fault only at a move that the check found wrong or did not know; a move that the
/// check says always fails does, with the fault that was foretold; and no move is done to which the
/// check found no way. The same going back.
///
/// # Errors
/// Those of the randomness.
pub fn foretells(u: &mut Unstructured<'_>) -> Result<bool> {
    // The program takes all that is left, so the cell has randomness of its own.
    let seed = u.arbitrary()?;
    let source = programs::generate(u, Options { max_statements: 40, ..Options::default() })?;
    let Some(module) = compile("program.obv", &source).module else {
        panic!("it does not compile\n{source}")
    };
    Ok(compared(module, &source, seed)?.moves > 0)
}

/// The same of modules, in which several branches of a fork command the arm. Only runs in which
/// the arm moves while a fork is open count.
///
/// # Errors
/// Those of the randomness.
pub fn foretells_of_modules(u: &mut Unstructured<'_>) -> Result<bool> {
    let seed = u.arbitrary()?;
    let mut module = code::module(u, code::Options { never: true, blocks: true })?;
    for instr in &mut module.code {
        if let Instr::OutputToggle { prefix, .. } = *instr {
            let (axis, frame) = (Axis::PlusZ, Frame::Base);
            *instr = Instr::MoveRelative { prefix, axis, frame };
        }
    }
    // As a length, one that the arm can go.
    module.constants[2] = Constant::Real(0.01);
    let text = disassemble(&module);
    Ok(compared(module, &text, seed)?.in_forks > 0)
}

/// What was compared of a program, in a workcell that follows from a number.
fn compared(mut module: Module, source: &str, seed: u64) -> Result<Compared> {
    // What is watched ends acts at any time, which nobody foretells.
    module.errors.iter_mut().for_each(|error| error.watches.clear());
    let cell = cell(&mut Unstructured::new(&noise(seed)), &module)?;
    let program = match verify(module) {
        Ok(program) => program,
        Err(errors) => panic!("{errors:?}\n{source}"),
    };
    let report = match check(&program, Plan::new(&cell)) {
        Ok(report) => report,
        Err(errors) => panic!("it does not link: {errors:?}\n{source}"),
    };
    if !report.is_complete {
        return Ok(Compared::default());
    }
    Ok(Case { source, report: &report }.run(&program, &cell, seed))
}

/// How much was compared.
#[derive(Clone, Copy, Default)]
struct Compared {
    /// How many moves, those that failed included.
    moves: usize,
    /// How many of those that were done belonged to a branch of a fork.
    in_forks: usize,
    /// How many contact stopped: where exactly depends on when the force is read, and so does which
    /// fault a move meets that counts from there.
    stopped: usize,
}

/// A program and what the check says of it.
struct Case<'c> {
    source: &'c str,
    report: &'c Report,
}

impl Case<'_> {
    fn run(&self, program: &Verified, cell: &Cell, seed: u64) -> Compared {
        let mut sim = Sim::new(&cell.nominal(), seed);
        let mut machine = match Machine::new(program, &sim) {
            Ok(machine) => machine,
            Err(errors) => panic!("{errors:?}"),
        };
        let mut compared = Compared::default();
        for asked in [Direction::Forward, Direction::Reverse] {
            let mut watch = Watch { case: self, asked, compared };
            let stop = loop {
                let limits = Limits::instructions(MAX_INSTRUCTIONS);
                match machine.run(asked, limits, &mut sim, &mut watch) {
                    Stop::Raised { .. } | Stop::Due { .. } => {}
                    stop => break stop,
                }
            };
            compared = watch.compared;
            match stop {
                Stop::Fault { fault, pc, .. } => {
                    self.faulted(pc, asked, &fault, compared.stopped == 0);
                    compared.moves += 1;
                    break;
                }
                Stop::Finished => {}
                _ => break,
            }
        }
        compared
    }

    fn graded(&self, pc: u32, asked: Direction) -> Option<&Graded> {
        let found = self.report.moves.iter().find(|found| found.pc == pc);
        let Some(found) = found else { panic!("{pc} is not in the report\n{}", self.source) };
        match asked {
            Direction::Forward => found.forward.as_ref(),
            Direction::Reverse => found.reverse.as_ref(),
        }
    }

    fn faulted(&self, pc: u32, asked: Direction, fault: &Fault, is_exact: bool) {
        let Some(graded) = self.graded(pc, asked) else {
            panic!("{pc}, {asked:?}: {fault}, and the check knows no way there\n{}", self.source)
        };
        let verdict = &graded.verdict;
        assert!(
            verdict.grade() != Grade::Reachable,
            "{pc}, {asked:?}: {fault}, and the check says that it is fine\n{}",
            self.source
        );
        let is_only_way = is_exact && graded.visits == 1 && verdict.grade().is_wrong();
        assert!(
            !is_only_way || verdict.fault.is_none_or(|kind| kind == fault.kind()),
            "{pc}, {asked:?}: {fault}, and the check says {verdict:?}\n{}",
            self.source
        );
    }
}

/// Sees to it that each move that is done may have been.
struct Watch<'c> {
    case: &'c Case<'c>,
    /// The way the run was asked to go: what replaces a block runs the other way round.
    asked: Direction,
    compared: Compared,
}

impl Observer for Watch<'_> {
    fn on_event(&mut self, event: &Event, _: &dyn Workcell) {
        let Some(report) = event.report else { return };
        self.compared.stopped += usize::from(report.end == MotionEnd::StoppedByForce);
        self.compared.moves += 1;
        self.compared.in_forks += usize::from(!event.branches.is_empty());
        let (pc, asked, source) = (event.pc, self.asked, self.case.source);
        match self.case.graded(pc, asked) {
            None => panic!("{pc}, {asked:?}: it is done, and the check knows no way\n{source}"),
            Some(graded) => assert!(
                !graded.always_fails,
                "{pc}, {asked:?}: it is done, and the check says {:?}\n{source}",
                graded.verdict
            ),
        }
    }
}

/// A cell with all that a program names, and things in its way.
fn cell(u: &mut Unstructured<'_>, module: &Module) -> Result<Cell> {
    let mut cell = Cell::bare();
    let offset = OffsetSpec { uniform: [0.01; 6], ..OffsetSpec::default() };
    cell.items.clear();
    for item in &module.items {
        let parts = vec![cuboid(u, 0.1)?];
        let (name, grasp) = (item.name.clone(), Pose::identity());
        cell.items.push(ItemSpec {
            name,
            pose: pose(u)?,
            on: None,
            offset,
            grasp,
            parts,
            peg: None,
        });
    }
    for name in &module.tools {
        let tcp = Pose::from_rotation_vector([0.0, 0.0, 0.1 * share(u)?], [0.0; 3]);
        let parts = vec![cuboid(u, 0.08)?];
        cell.tools.push(ToolSpec { name: name.clone(), tcp, parts });
    }
    for number in 0..u.int_in_range(0..=3)? {
        let (name, parts) = (format!("fixture{number}"), vec![cuboid(u, 0.4)?]);
        cell.fixtures.push(FixtureSpec {
            name,
            pose: pose(u)?,
            on: None,
            offset,
            parts,
            holes: Vec::new(),
        });
    }
    if u.ratio(1, 3)? {
        cell.arm.limits_rad = [(-PI, PI); 6];
    }
    if let Some(gripper) = &mut cell.gripper {
        // So wide that something is taken now and then.
        (gripper.near_m, gripper.near_rad) = (0.3, PI);
        gripper.output = u.int_in_range(0..=7)?;
    }
    cell.inputs[1] = InputRule::Holding;
    cell.inputs[2] = InputRule::Constant(true);
    cell.inputs[3] = InputRule::FollowsOutput { output: 3, delay_s: 0.1 };
    cell.inputs[4] = InputRule::At(vec![(1.0, true), (3.0, false)]);
    Ok(cell)
}

/// Bytes that follow from a number.
fn noise(seed: u64) -> Vec<u8> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ x >> 31
    };
    (0..512).flat_map(|_| next().to_le_bytes()).collect()
}

/// From 0 to 1.
fn share(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(f64::from(u.int_in_range(0..=1_000)?) / 1_000.0)
}

fn cuboid(u: &mut Unstructured<'_>, largest_m: f64) -> Result<Part> {
    let mut size_m = [0.0; 3];
    for edge in &mut size_m {
        *edge = 0.01 + largest_m * share(u)?;
    }
    Ok(Part { pose: Pose::identity(), shape: Shape::Cuboid { size_m } })
}

/// Somewhere around the arm, and mostly in its reach.
fn pose(u: &mut Unstructured<'_>) -> Result<Pose> {
    let mut numbers = [0.0; 6];
    for number in &mut numbers {
        *number = 2.0 * share(u)? - 1.0;
    }
    let [x, y, z, a, b, c] = numbers;
    Ok(Pose::from_rotation_vector([0.8 * x, 0.8 * y, 0.3 + 0.6 * z], [3.0 * a, 3.0 * b, 3.0 * c]))
}
