//! The laws of inversion over generated programs: twice is identity, and what a sequence has done
//! its inverse takes back as going back does.

use crate::format_laws::meaning;
use crate::invertible::{self, Invertible};
use crate::logged::Logged;
use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{Verified, verify};
use obverse_compiler::{NoInverse, compile, invert};
use obverse_syntax::ast::{Item, Program};
use obverse_syntax::format::{format, print};
use obverse_syntax::parse;
use obverse_vm::{Direction, Limits, Machine, Stop};
use obverse_workcell::{Arm, DigitalIo, Gripper};
use std::collections::BTreeSet;

/// How far two angles of a joint may be apart that are the same but for rounding: a way there and
/// back is computed in each direction.
const TOLERANCE_RAD: f64 = 1e-9;

/// The longest run that is compared, in instructions.
const MAX_STEPS: u64 = 200_000;

/// The inverse of an inverse compiles to the code and tables of the sequence with what it needs,
/// and what is printed is formatted.
///
/// # Errors
/// Those of the randomness.
pub fn inverts_twice(u: &mut Unstructured<'_>) -> Result<bool> {
    let source = format!("{}sequence main {{}}\n", invertible::generate(u)?.source);
    Ok(inverts_twice_on(&source, "work"))
}

/// The same for every sequence of a program that may contain anything.
///
/// # Errors
/// Those of the randomness.
pub fn inverts_anything_twice(u: &mut Unstructured<'_>) -> Result<bool> {
    let options = Options { allow_errors: false, max_statements: 25, ..Options::default() };
    let source = programs::generate(u, options)?;
    let program = parse(&source).program;
    let sequences = program.items.iter().filter_map(|item| match item {
        Item::Sequence(sequence) => Some(sequence.name.value),
        _ => None,
    });
    Ok(sequences.filter(|name| inverts_twice_on(&source, name)).count() > 0)
}

/// The same for a sequence of a program; whether that has an inverse.
pub fn inverts_twice_on(source: &str, sequence: &str) -> bool {
    let once = match invert("program.obv", source, sequence) {
        Ok(once) => once.text,
        Err(NoInverse::Diagnosed(found)) => {
            assert!(!found.is_empty(), "refused without a reason\n{source}");
            return false;
        }
        Err(unknown) => panic!("{unknown:?}\n{source}"),
    };
    assert_eq!(format(&once).as_ref(), Ok(&once), "the inverse is formatted");
    let inverse = format!("{sequence}_inverse");
    let twice = invert("program.obv", &once, &inverse)
        .unwrap_or_else(|why| panic!("the inverse has none: {why:#?}\n{source}\n{once}"))
        .text;
    let kept = restricted(source, &twice, sequence);
    assert!(meaning(&twice) == meaning(&kept), "twice is not once:\n{kept}\n{once}\n{twice}");
    true
}

/// The declarations of a program that another has by name, with the main sequence of that unless
/// it is the main sequence that is inverted.
fn restricted(source: &str, other: &str, sequence: &str) -> String {
    let (program, other) = (parse(source).program, parse(other).program);
    let named: BTreeSet<&str> = other.items.iter().filter_map(name_of).collect();
    let is_main = |item: &&Item<'_>| name_of(item) == Some("main");
    let is_kept = |item: &&Item<'_>| {
        let has_name = name_of(item).is_none_or(|name| named.contains(name));
        has_name && (sequence == "main" || !is_main(item))
    };
    let mut items: Vec<Item<'_>> = program.items.iter().filter(is_kept).cloned().collect();
    if sequence != "main" {
        items.extend(other.items.iter().find(is_main).cloned());
    }
    print(&Program { items })
}

fn name_of<'s>(item: &Item<'s>) -> Option<&'s str> {
    match item {
        Item::Cleanup(_) => Some("cleanup"),
        item => item.name().map(|name| name.value),
    }
}

/// A sequence and then its inverse end in the state that the sequence and going back over it end
/// in, begun where the head of the sequence says.
///
/// # Errors
/// Those of the randomness.
pub fn inverse_goes_back(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = invertible::generate(u)?;
    Ok(inverse_goes_back_on(&program, u.arbitrary()?))
}

/// The same for a given program, in a workcell that follows from a seed.
pub fn inverse_goes_back_on(program: &Invertible, seed: u64) -> bool {
    let Invertible { source, head } = program;
    let alone = format!("{source}sequence main {{\n{head}  call work\n}}\n");
    let Ok(inverse) = invert("program.obv", &alone, "work") else { return false };
    let both = format!(
        "{}sequence main {{\n{head}  call work\n  call work_inverse\n}}\n",
        together(source, &inverse.text)
    );
    let (there, back) = (verified(&alone), verified(&both));
    let Some(expected) = there_and_back(&there, seed) else { return false };
    let Some(found) = forward(&back, seed) else { return false };
    assert!(is_close(&found, &expected), "{found:?}\ninstead of {expected:?}\n{both}");
    true
}

/// A program with the declarations of another that it does not have, but for its main sequence.
pub fn together(source: &str, other: &str) -> String {
    let (program, other) = (parse(source).program, parse(other).program);
    let known: BTreeSet<&str> = program.items.iter().filter_map(name_of).collect();
    let is_new = |item: &&Item<'_>| {
        name_of(item).is_some_and(|name| name != "main" && !known.contains(name))
    };
    let mut items = program.items.clone();
    items.extend(other.items.iter().filter(is_new).cloned());
    print(&Program { items })
}

fn verified(source: &str) -> Verified {
    let compiled = compile("program.obv", source);
    let Some(module) = compiled.module else {
        panic!("it does not compile: {:#?}\n{source}", compiled.diagnostics)
    };
    match verify(module) {
        Ok(program) => program,
        Err(errors) => panic!("it does not verify: {errors:?}\n{source}"),
    }
}

/// What is compared: variables by name, outputs, held, bit for bit; and joints.
#[derive(Debug)]
struct End {
    globals: Vec<(String, u64)>,
    joints: [f64; 6],
    outputs: Vec<bool>,
    held: Option<u16>,
}

impl End {
    fn of(machine: &Machine<'_>, cell: &Logged) -> Self {
        let module = machine.program().module();
        let values = module.globals.iter().zip(machine.state().globals());
        let values = values.filter(|(global, _)| !global.name.starts_with('$'));
        Self {
            globals: values.map(|(global, value)| (global.name.clone(), *value)).collect(),
            joints: cell.joints().0,
            outputs: (0..cell.output_count()).map(|bit| cell.output(bit)).collect(),
            held: cell.held().map(|item| item.0),
        }
    }
}

fn is_close(a: &End, b: &End) -> bool {
    let near = |(a, b): (&f64, f64)| (a - b).abs() <= TOLERANCE_RAD * (1.0 + a.abs().max(b.abs()));
    a.joints.iter().zip(b.joints).all(near)
        && (&a.globals, &a.outputs, a.held) == (&b.globals, &b.outputs, b.held)
}

fn machine<'p>(program: &'p Verified, cell: &Logged) -> Machine<'p> {
    match Machine::new(program, cell) {
        Ok(machine) => machine,
        Err(errors) => panic!("it does not link: {errors:?}"),
    }
}

/// The end of a whole run, if it is not too long.
fn forward(program: &Verified, seed: u64) -> Option<End> {
    let mut cell = Logged::new(seed);
    let mut machine = machine(program, &cell);
    let limits = Limits::instructions(MAX_STEPS);
    match machine.run(Direction::Forward, limits, &mut cell, &mut ()) {
        Stop::Finished => Some(End::of(&machine, &cell)),
        Stop::Budget => None,
        stop => panic!("it stopped: {stop:?}"),
    }
}

/// The state before the call of `work`, come to by going back over it.
fn there_and_back(program: &Verified, seed: u64) -> Option<End> {
    let mut cell = Logged::new(seed);
    let mut machine = machine(program, &cell);
    let mut before = machine.mark();
    loop {
        let frame = machine.state().frames().last();
        let function = frame.map(|frame| usize::from(frame.function));
        let name = function.map(|index| program.module().functions[index].name.as_str());
        if name == Some("work") {
            break;
        }
        before = machine.mark();
        if let Err(stop) = machine.step(Direction::Forward, &mut cell, &mut ()) {
            panic!("it stopped before its work: {stop:?}");
        }
    }
    let limits = Limits::instructions(MAX_STEPS);
    match machine.run(Direction::Forward, limits, &mut cell, &mut ()) {
        Stop::Finished => {}
        Stop::Budget => return None,
        stop => panic!("it stopped: {stop:?}"),
    }
    let stop = machine.reverse_to(before, &mut cell, &mut ());
    assert_eq!(stop, Stop::AtMark);
    Some(End::of(&machine, &cell))
}
