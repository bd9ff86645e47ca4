//! Valid modules and recordings, altered: what they say is mostly right, and somewhere wrong in a
//! way that no writer would write. Knows nothing of what is then done with them.

use crate::Ledger;
use crate::code::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{
    Constant, Continuation, Function, Item, Mention, Mentioned, Module, Otherwise, Recovery,
    Respond, SourceEntry, Verified, verify,
};
use obverse_isa::{Instr, Type};
use obverse_tape::{ForkSnapshot, FrameSnapshot, Snapshot, Streams};
use obverse_vm::{Direction, Machine};

/// The most alterations of one thing.
const ALTERATIONS: u8 = 3;

/// A generated module with alterations.
///
/// # Errors
/// Those of the randomness.
pub fn module(u: &mut Unstructured<'_>) -> Result<Module> {
    let alterations = u.int_in_range(1..=ALTERATIONS)?;
    let choices: Vec<(u8, [u8; 8])> =
        (0..alterations).map(|_| u.arbitrary()).collect::<Result<_>>()?;
    let mut module = code::module(u, Options { never: true, blocks: true })?;
    for (choice, random) in choices {
        let u = &mut Unstructured::new(&random);
        match choice % 16 {
            0..=9 => alter_code(u, &mut module.code)?,
            10 | 11 => alter_function(u, &mut module)?,
            12 => alter_tables(u, &mut module)?,
            13 => alter_names(u, &mut module)?,
            14 => alter_error(u, &mut module)?,
            _ => alter_map(u, &mut module)?,
        }
    }
    Ok(module)
}

fn alter_code(u: &mut Unstructured<'_>, code: &mut Vec<Instr>) -> Result<()> {
    let (at, other) = (u.choose_index(code.len())?, u.choose_index(code.len())?);
    match u.int_in_range(0..=9_u8)? {
        0 => code[at] = code[other],
        1 => code.swap(at, other),
        2 => drop(code.remove(at)),
        3 => code.insert(at, code[other]),
        // A field, a number in it, or the instruction itself.
        _ => {
            let mut bytes = code[at].encode();
            let byte = u.choose_index(bytes.len())?;
            bytes[byte] ^=
                if u.ratio(1, 2)? { 1 << u.int_in_range(0..=7)? } else { u.arbitrary()? };
            if let Ok(instr) = Instr::decode(bytes) {
                code[at] = instr;
            }
        }
    }
    Ok(())
}

fn alter_function(u: &mut Unstructured<'_>, module: &mut Module) -> Result<()> {
    let types = [Type::Int, Type::Real, Type::Bool, Type::Joints, Type::Item, Type::Tool];
    let at = u.choose_index(module.functions.len())?;
    let function: &mut Function = &mut module.functions[at];
    match u.int_in_range(0..=8_u8)? {
        0 => function.parameters = u.arbitrary()?,
        1 => function.counters = u.arbitrary()?,
        2 => function.first = near(u, function.first)?,
        3 => function.end = near(u, function.end)?,
        4 => drop(function.locals.pop()),
        5 => drop(function.slots.pop()),
        6 => {
            let local = u.choose_index(function.locals.len().max(1))?;
            if let Some(local) = function.locals.get_mut(local) {
                local.of_type = *u.choose(&types)?;
            }
        }
        7 => {
            let local = function.locals[0].clone();
            function.locals.resize(u.int_in_range(0..=600)?, local);
        }
        _ => drop(module.functions.remove(at)),
    }
    Ok(())
}

/// A number beside another, or anywhere.
fn near(u: &mut Unstructured<'_>, number: u32) -> Result<u32> {
    let by: i8 = u.arbitrary()?;
    Ok(if u.ratio(3, 4)? { number.wrapping_add_signed(i32::from(by)) } else { u.arbitrary()? })
}

fn alter_tables(u: &mut Unstructured<'_>, module: &mut Module) -> Result<()> {
    match u.int_in_range(0..=9_u8)? {
        0 => drop(module.constants.pop()),
        1 => drop(module.joints.pop()),
        2 => drop(module.items.pop()),
        3 => drop(module.keyframes.pop()),
        4 => drop(module.tools.pop()),
        5 => drop(module.errors.pop()),
        6 => drop(module.reasons.pop()),
        7 => drop(module.globals.pop()),
        8 => {
            let reals = [f64::NAN, f64::INFINITY, -0.0, f64::MAX, 1e19, -1.0];
            module.constants[2] = Constant::Real(*u.choose(&reals)?);
        }
        _ => module.constants.swap(0, 2),
    }
    Ok(())
}

fn alter_names(u: &mut Unstructured<'_>, module: &mut Module) -> Result<()> {
    let keyframes = module.items.iter_mut().flat_map(|item: &mut Item| &mut item.keyframes);
    match u.int_in_range(0..=3_u8)? {
        0 => {
            for keyframe in keyframes {
                keyframe.name = u.arbitrary()?;
            }
        }
        1 => {
            for keyframe in keyframes {
                keyframe.position_m[0] = f64::NAN;
                keyframe.rotation_rad = [1e308; 3];
            }
        }
        2 => module.joints[0].1[3] = f64::NAN,
        _ => module.globals[0].name = "\0\n\u{202e}".repeat(9),
    }
    Ok(())
}

fn alter_error(u: &mut Unstructured<'_>, module: &mut Module) -> Result<()> {
    let error = &mut module.errors[0];
    match u.int_in_range(0..=3_u8)? {
        0 => error.recovery = Recovery::Using(u.arbitrary()?),
        1 => error.otherwise = Otherwise::Using(u.arbitrary()?),
        2 => error.respond = Respond::AtOnce,
        _ => error.continuation = Continuation::Sequence,
    }
    Ok(())
}

fn alter_map(u: &mut Unstructured<'_>, module: &mut Module) -> Result<()> {
    for _ in 0..2 {
        let (first, start) = (near(u, 0)?, u.arbitrary()?);
        let (file, end) = (u.arbitrary()?, u.arbitrary()?);
        module.source_map.push(SourceEntry { first, file, start, end, action: None });
        let what = Mentioned::Item(u.arbitrary()?);
        module.mentions.push(Mention { what, file, start, end });
    }
    Ok(())
}

/// A program, a state of it as plain data, and a tape.
#[derive(Debug)]
pub struct Recorded {
    /// The program.
    pub module: Module,
    /// The state.
    pub state: Snapshot,
    /// The tape.
    pub streams: Streams,
}

/// The state and the tape of a generated program, which stopped anywhere, with alterations.
///
/// # Errors
/// Those of the randomness.
///
/// # Panics
/// If the generator makes a module that does not verify or link.
pub fn recording(u: &mut Unstructured<'_>) -> Result<Recorded> {
    let alterations = u.int_in_range(1..=ALTERATIONS)?;
    let choices: Vec<(u8, [u8; 12])> =
        (0..alterations).map(|_| u.arbitrary()).collect::<Result<_>>()?;
    let steps = u.int_in_range(0..=300_u32)?;
    let never = u.arbitrary()?;
    let Ok(program) = verify(code::module(u, Options { never, blocks: true })?) else {
        panic!("the generator made a module that does not verify");
    };
    let (mut state, mut streams) = recorded(&program, steps);
    for (choice, random) in choices {
        let u = &mut Unstructured::new(&random);
        match choice % 5 {
            4 => alter_fork(u, &mut state.forks)?,
            0 => alter_state(u, &mut state)?,
            1 => alter_frame(u, &mut state.frames)?,
            2 => alter_place(u, program.module(), &mut state)?,
            _ => alter_streams(u, &mut streams)?,
        }
    }
    Ok(Recorded { module: program.module().clone(), state, streams })
}

/// The state and the tape after so many steps.
fn recorded(program: &Verified, steps: u32) -> (Snapshot, Streams) {
    let mut cell = Ledger::new(1);
    let Ok(mut machine) = Machine::new(program, &cell) else { panic!("the module does not link") };
    for _ in 0..steps {
        let _stop = machine.step(Direction::Forward, &mut cell, &mut ());
    }
    (machine.snapshot(&cell), machine.streams())
}

fn alter_state(u: &mut Unstructured<'_>, state: &mut Snapshot) -> Result<()> {
    match u.int_in_range(0..=9_u8)? {
        0 => state.operands.push(u.arbitrary()?),
        1 => state.operands.resize(u.int_in_range(0..=300)?, 7),
        2 => state.globals.push(u.arbitrary()?),
        3 => alter_word(u, &mut state.globals)?,
        4 => state.settings[u.choose_index(5)?] = u.arbitrary()?,
        5 => state.raised.push(u.arbitrary()?),
        6 => state.raised = vec![0; u.int_in_range(0..=5000)?],
        7 => state.draws = extreme(u)?,
        8 => state.joints[u.choose_index(6)?] = f64::from_bits(extreme(u)?),
        _ => state.outputs = vec![true; u.int_in_range(0..=20)?],
    }
    Ok(())
}

fn alter_place(u: &mut Unstructured<'_>, module: &Module, state: &mut Snapshot) -> Result<()> {
    match u.int_in_range(0..=4_u8)? {
        0 => state.steps += u.int_in_range(0..=10_000)?,
        1 => state.pc = near(u, state.pc)?,
        2 => {
            state.pc = u.choose_index(module.code.len())? as u32;
            state.operands.clear();
            if let (Some(frame), Some(function)) =
                (state.frames.last_mut(), module.function_at(state.pc))
            {
                frame.function = function as u16;
            }
        }
        _ => state.pending = u.arbitrary()?,
    }
    Ok(())
}

fn alter_frame(u: &mut Unstructured<'_>, frames: &mut Vec<FrameSnapshot>) -> Result<()> {
    if frames.is_empty() {
        return Ok(());
    }
    let at = u.choose_index(frames.len())?;
    let frame = &mut frames[at];
    match u.int_in_range(0..=7_u8)? {
        0 => frame.function = u.int_in_range(0..=5)?,
        1 => frame.return_pc = near(u, frame.return_pc)?,
        2 => frame.words.resize(u.int_in_range(0..=300)?, 1),
        3 => drop(frame.positions.pop()),
        4 => drop(frames.pop()),
        5 => {
            let again = frames[at].clone();
            frames.resize(u.int_in_range(0..=1100)?, again);
        }
        _ => alter_word(u, &mut frame.words)?,
    }
    Ok(())
}

fn alter_fork(u: &mut Unstructured<'_>, forks: &mut Vec<ForkSnapshot>) -> Result<()> {
    if forks.is_empty() {
        return Ok(());
    }
    let at = u.choose_index(forks.len())?;
    let fork = &mut forks[at];
    let task = u.choose_index(fork.tasks.len().max(1))?;
    match u.int_in_range(0..=9_u8)? {
        0 => fork.at = near(u, fork.at)?,
        1 => fork.base = near(u, fork.base)?,
        2 => fork.current = u.int_in_range(0..=4)?,
        3 => fork.turn_steps = extreme(u)?,
        4 => drop(fork.tasks.pop()),
        8 => fork.now_ns = extreme(u)?,
        5 => {
            let again = forks[at].clone();
            forks.resize(u.int_in_range(0..=100)?, again);
        }
        choice => {
            let Some(task) = fork.tasks.get_mut(task) else { return Ok(()) };
            match choice {
                6 => task.pc = near(u, task.pc)?,
                7 => task.until_ns = extreme(u)?,
                _ => task.is_done = !task.is_done,
            }
        }
    }
    Ok(())
}

fn alter_streams(u: &mut Unstructured<'_>, streams: &mut Streams) -> Result<()> {
    match u.int_in_range(0..=9_u8)? {
        0 => drop(streams.bits.pop()),
        1 => drop(streams.words.pop()),
        2 => drop(streams.joints.pop()),
        3 => streams.bits.push(u.arbitrary()?),
        4 => streams.dropped_bits = extreme(u)?,
        5 => {
            let at = u.choose_index(streams.bits.len().max(1))?;
            if let Some(bit) = streams.bits.get_mut(at) {
                *bit = !*bit;
            }
        }
        6 => streams.joints.push([f64::from_bits(extreme(u)?); 6]),
        7 => drop(streams.control.pop()),
        8 => alter_word(u, &mut streams.control)?,
        _ => alter_word(u, &mut streams.words)?,
    }
    Ok(())
}

fn alter_word(u: &mut Unstructured<'_>, words: &mut [u64]) -> Result<()> {
    let at = u.choose_index(words.len().max(1))?;
    if let Some(word) = words.get_mut(at) {
        *word = extreme(u)?;
    }
    Ok(())
}

fn extreme(u: &mut Unstructured<'_>) -> Result<u64> {
    let words = [0, 1, 2, 255, u64::MAX, 1 << 63, (1 << 63) - 1, u64::MAX - 1];
    Ok(if u.arbitrary()? { *u.choose(&words)? } else { u.arbitrary()? })
}
