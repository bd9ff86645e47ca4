//! The laws of the machine, each a function of randomness: the same function is a property test and
//! a fuzz target.
//!
//! A law panics where it does not hold, with what is needed to see why, and else says whether there
//! was anything to compare. In a deterministic workcell all of them compare bit for bit. Its errors
//! are those of the randomness.

use crate::Ledger;
use crate::code::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{Module, Verified, decode, encode, verify};
use obverse_isa::{Class, Family, Instr, RecordKind};
use obverse_tape::{ForkSnapshot, FrameSnapshot, Place};
use obverse_vm::{Direction, Limits, Machine, Stop};
use obverse_workcell::Safety;

/// The longest run that a law steps through, in instructions.
const MAX_STEPS: usize = 3_000;
/// How often a law turns round within what replaces a block.
const MAX_TURNS: u32 = 5;

/// What the end of a turn leaves on the tape.
const SWITCH_BITS: u64 = 192;

fn program(u: &mut Unstructured<'_>, options: Options) -> Result<Verified> {
    let module = code::module(u, options)?;
    match verify(module) {
        Ok(verified) => Ok(verified),
        Err(errors) => panic!("the generator made a module that does not verify: {errors:?}"),
    }
}

fn machine<'p>(program: &'p Verified, cell: &Ledger) -> Machine<'p> {
    match Machine::new(program, cell) {
        Ok(machine) => machine,
        Err(errors) => panic!("the module does not link: {errors:?}"),
    }
}

/// The whole state, and how much tape there is.
fn picture(machine: &Machine<'_>, cell: &Ledger) -> (u64, Place) {
    (machine.digest(cell), machine.tape().map(obverse_tape::Tape::place).unwrap_or_default())
}

/// Run until something stops it that is no raised error.
fn run(machine: &mut Machine<'_>, direction: Direction, cell: &mut Ledger) -> Stop {
    loop {
        match machine.run(direction, Limits::NONE, cell, &mut ()) {
            Stop::Raised { .. } | Stop::Due { .. } => {}
            stop => return stop,
        }
    }
}

/// One step; whether the run goes on.
fn step(machine: &mut Machine<'_>, direction: Direction, cell: &mut Ledger) -> bool {
    match machine.step(direction, cell, &mut ()) {
        Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }) => true,
        Err(Stop::Finished | Stop::AtStart) => false,
        Err(stop) => panic!("a verified module stopped: {stop:?}"),
    }
}

/// Each step in reverse undoes one step forward, and forward again leads the same way.
pub fn there_and_back(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = program(u, Options::default())?;
    let mut cell = Ledger::new(u.arbitrary()?);
    let mut machine = machine(&program, &cell);
    let mut history = vec![picture(&machine, &cell)];
    while history.len() < MAX_STEPS && step(&mut machine, Direction::Forward, &mut cell) {
        history.push(picture(&machine, &cell));
    }
    for (step_number, before) in history.iter().enumerate().rev().skip(1) {
        assert!(step(&mut machine, Direction::Reverse, &mut cell), "step {step_number}");
        assert_eq!(picture(&machine, &cell), *before, "back over step {step_number}");
    }
    assert!(!step(&mut machine, Direction::Reverse, &mut cell), "the start is the end");
    for after in &history[1..] {
        assert!(step(&mut machine, Direction::Forward, &mut cell));
        assert_eq!(picture(&machine, &cell), *after, "forward again");
    }
    Ok(true)
}

/// A run all the way is the same as all its steps, in both directions, and a mark can be gone back
/// to.
pub fn runs_are_steps(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = program(u, Options::default())?;
    let seed = u.arbitrary()?;
    let (mut cell, mut stepped_cell) = (Ledger::new(seed), Ledger::new(seed));
    let mut stepped = machine(&program, &stepped_cell);
    let start = picture(&stepped, &stepped_cell);
    let mut marks = Vec::new();
    while marks.len() < MAX_STEPS && step(&mut stepped, Direction::Forward, &mut stepped_cell) {
        if stepped.state().operands().is_empty() {
            marks.push((stepped.mark(), picture(&stepped, &stepped_cell)));
        }
    }
    if marks.len() >= MAX_STEPS {
        return Ok(false);
    }
    let mut machine = machine(&program, &cell);
    assert_eq!(run(&mut machine, Direction::Forward, &mut cell), Stop::Finished);
    assert_eq!(picture(&machine, &cell), picture(&stepped, &stepped_cell), "all the way");
    if let Some((mark, at_mark)) = marks.get(u.choose_index(marks.len().max(1))?) {
        assert_eq!(machine.reverse_to(*mark, &mut cell, &mut ()), Stop::AtMark);
        assert_eq!(picture(&machine, &cell), *at_mark, "at the mark");
    }
    assert_eq!(run(&mut machine, Direction::Reverse, &mut cell), Stop::AtStart);
    assert_eq!(picture(&machine, &cell), start, "back at the start");
    Ok(true)
}

/// What a step leaves on the tape is what the class of its instruction says, and nothing else.
pub fn parsimony(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = program(u, Options::default())?;
    let module = program.module();
    let mut cell = Ledger::new(u.arbitrary()?);
    let mut machine = machine(&program, &cell);
    let mut forks = Vec::new();
    for _ in 0..MAX_STEPS {
        let before = picture(&machine, &cell).1;
        let pc = machine.state().pc() as usize;
        let (instr, commands) = (module.code[pc], machine.commands());
        if !step(&mut machine, Direction::Forward, &mut cell) {
            break;
        }
        let after = picture(&machine, &cell).1;
        let mut expected = expected_bits(module, machine.state(), &instr);
        let went_on_at = machine.state().pc() as usize;
        let landed = instr.jump_target().is_some() && went_on_at != pc + 1;
        if landed && matches!(module.code[went_on_at - 1], Instr::Join { .. }) {
            expected += 1;
        }
        // An act may end a turn, which leaves a switch.
        let held = std::mem::replace(&mut forks, machine.snapshot(&cell).forks);
        let began_turn = forks.last().is_some_and(|fork| fork.turn_steps == 0);
        let ended_turn = instr.info().family != Family::Task && began_turn;
        expected += SWITCH_BITS * u64::from(ended_turn) + held_bits(module, held.last(), &instr);
        let recorded = after.size_bits() - before.size_bits();
        assert_eq!(recorded, expected, "{} at {pc}", instr.info().mnemonic);
        let commanded = machine.commands() > commands;
        assert_eq!(commanded, instr.info().family.commands_workcell(), "{instr:?}");
    }
    Ok(true)
}

/// What the tasks hold that a `fork.leave` leaves where they are.
fn held_bits(module: &Module, fork: Option<&ForkSnapshot>, instr: &Instr) -> u64 {
    let (Some(fork), Instr::ForkLeave { .. }) = (fork, instr) else { return 0 };
    let frames = fork.tasks.iter().flat_map(|task| &task.frames);
    let of_frame = |frame: &FrameSnapshot| 64 + frame_bits(module, usize::from(frame.function));
    SWITCH_BITS + 128 * fork.tasks.len() as u64 + frames.map(of_frame).sum::<u64>()
}

fn frame_bits(module: &Module, function: usize) -> u64 {
    let function = &module.functions[function];
    let words = function.locals.len() + 3 * usize::from(function.counters);
    64 * words as u64 + 384 * function.slots.len() as u64
}

fn expected_bits(module: &Module, state: &obverse_vm::State, instr: &Instr) -> u64 {
    match instr.info().class {
        Class::Always | Class::Never(_) => 0,
        Class::AfterForward(RecordKind::Bit) => 1,
        Class::AfterForward(RecordKind::Word) => 64,
        Class::AfterForward(RecordKind::Counter) => 192,
        Class::AfterForward(RecordKind::Joints) => 384,
        Class::AfterForward(RecordKind::Frame) => {
            let call = state.pc() as usize - 1;
            let Instr::Call { function, .. } = module.code[call] else {
                panic!("a return goes on behind its call");
            };
            frame_bits(module, function.index())
        }
        Class::AfterForward(RecordKind::Switch) => SWITCH_BITS,
        Class::AfterForward(RecordKind::Tasks) => 0,
    }
}

/// With a stop in the midst of any act, going back leads to the start and going on to the same end.
/// The same for a stop in the midst of going back.
pub fn write_ahead(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = program(u, Options::default())?;
    let seed = u.arbitrary()?;
    let mut cell = Ledger::new(seed);
    let mut whole = machine(&program, &cell);
    let start = picture(&whole, &cell);
    assert_eq!(run(&mut whole, Direction::Forward, &mut cell), Stop::Finished);
    let end = picture(&whole, &cell);
    let acts = cell.acts;
    if acts == 0 {
        return Ok(false);
    }
    let at = u.int_in_range(0..=acts - 1)?;
    let fraction = f64::from(u.int_in_range(0..=10_u8)?) / 10.0;

    let mut cell = Ledger::new(seed).stopping_at(at, fraction);
    let mut forward = machine(&program, &cell);
    stop_in_the_midst(&mut forward, Direction::Forward, &mut cell);
    let (mut back_cell, stopped) = (cell.clone(), forward.snapshot(&cell));
    assert_eq!(run(&mut forward, Direction::Forward, &mut cell), Stop::Finished);
    assert_eq!(picture(&forward, &cell), end, "on from the stop in act {at}");

    let mut back = machine(&program, &Ledger::new(seed));
    let mut again = Ledger::new(seed).stopping_at(at, fraction);
    stop_in_the_midst(&mut back, Direction::Forward, &mut again);
    assert_eq!(back.snapshot(&again), stopped, "a run is deterministic");
    assert_eq!(run(&mut back, Direction::Reverse, &mut back_cell), Stop::AtStart);
    assert_eq!(picture(&back, &back_cell), start, "back from the stop in act {at}");

    stop_while_going_back(u, &program, seed, start, end)
}

fn stop_while_going_back(
    u: &mut Unstructured<'_>,
    program: &Verified,
    seed: u64,
    start: (u64, Place),
    end: (u64, Place),
) -> Result<bool> {
    for goes_on in [Direction::Reverse, Direction::Forward] {
        let mut cell = Ledger::new(seed);
        let mut machine = machine(program, &cell);
        assert_eq!(run(&mut machine, Direction::Forward, &mut cell), Stop::Finished);
        let (there, mut trial) = (cell.acts, cell.clone());
        let mut probe = self::machine(program, &Ledger::new(seed));
        assert_eq!(run(&mut probe, Direction::Forward, &mut Ledger::new(seed)), Stop::Finished);
        assert_eq!(run(&mut probe, Direction::Reverse, &mut trial), Stop::AtStart);
        let back_acts = trial.acts - there;
        if back_acts == 0 {
            return Ok(false);
        }
        let at = there + u.int_in_range(0..=back_acts - 1)?;
        cell.stop_at = Some((at, f64::from(u.int_in_range(0..=10_u8)?) / 10.0));
        stop_in_the_midst(&mut machine, Direction::Reverse, &mut cell);
        match goes_on {
            Direction::Reverse => {
                assert_eq!(run(&mut machine, Direction::Reverse, &mut cell), Stop::AtStart);
                assert_eq!(picture(&machine, &cell), start, "back again");
            }
            Direction::Forward => {
                assert_eq!(run(&mut machine, Direction::Forward, &mut cell), Stop::Finished);
                assert_eq!(picture(&machine, &cell), end, "forward from half-way back");
            }
        }
    }
    Ok(true)
}

fn stop_in_the_midst(machine: &mut Machine<'_>, direction: Direction, cell: &mut Ledger) {
    match run(machine, direction, cell) {
        Stop::Fault { direction: stopped, .. } => {
            // What replaces a block goes forward while the machine goes back.
            assert!(stopped == direction || machine.state().is_compensating());
        }
        stop => panic!("the fault plan did not stop the run: {stop:?}"),
    }
    cell.release();
}

/// Going back stops at the newest never-instruction, names it, and has changed nothing; what was
/// before it is off the tape.
pub fn barrier(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = program(u, Options { never: true, blocks: false })?;
    let module = program.module();
    let mut cell = Ledger::new(u.arbitrary()?);
    let mut machine = machine(&program, &cell);
    let mut behind_never = None;
    for _ in 0..MAX_STEPS {
        let pc = machine.state().pc();
        let is_never = matches!(module.code[pc as usize].info().class, Class::Never(_));
        if !step(&mut machine, Direction::Forward, &mut cell) {
            break;
        }
        if is_never {
            behind_never = Some((pc, picture(&machine, &cell)));
            assert_eq!(picture(&machine, &cell).1, Place::default(), "the past is dropped");
        }
    }
    let stop = run(&mut machine, Direction::Reverse, &mut cell);
    let Some((pc, then)) = behind_never else {
        assert_eq!(stop, Stop::AtStart);
        return Ok(false);
    };
    for _ in 0..2 {
        let stop = run(&mut machine, Direction::Reverse, &mut cell);
        assert!(matches!(stop, Stop::Refused(refusal) if refusal.pc == pc), "{stop:?}");
        assert_eq!(picture(&machine, &cell), then, "nothing changed");
    }
    Ok(true)
}

/// With blocks that are skipped or replaced in reverse, going back from anywhere still restores all
/// of the program's own state, bit for bit, and empties the tape: what is left as it is are the
/// joints and the outputs.
pub fn blocks(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = program(u, Options { never: false, blocks: true })?;
    let mut cell = Ledger::new(u.arbitrary()?);
    let mut machine = machine(&program, &cell);
    let (uncommanded, start) = (cell.clone(), picture(&machine, &cell));
    for _ in 0..u.int_in_range(0..=400)? {
        if !step(&mut machine, Direction::Forward, &mut cell) {
            break;
        }
    }
    assert_eq!(run(&mut machine, Direction::Reverse, &mut cell), Stop::AtStart);
    assert_eq!(picture(&machine, &uncommanded), start);
    Ok(true)
}

/// The same with a stop in the midst of any act, going forward or back, also within what replaces a
/// block; and going on forward from a stop on the way back, and only then back.
pub fn write_ahead_with_blocks(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = program(u, Options { never: false, blocks: true })?;
    let seed = u.arbitrary()?;
    let uncommanded = Ledger::new(seed);
    let mut cell = uncommanded.clone();
    let mut whole = machine(&program, &cell);
    let start = picture(&whole, &uncommanded);
    assert_eq!(run(&mut whole, Direction::Forward, &mut cell), Stop::Finished);
    let there = cell.acts;
    assert_eq!(run(&mut whole, Direction::Reverse, &mut cell), Stop::AtStart);
    assert_eq!(picture(&whole, &uncommanded), start, "without a stop");
    if cell.acts == 0 {
        return Ok(false);
    }
    let at = u.int_in_range(0..=cell.acts - 1)?;
    let fraction = f64::from(u.int_in_range(0..=10_u8)?) / 10.0;
    for goes_on in [Direction::Forward, Direction::Reverse] {
        let mut cell = uncommanded.clone().stopping_at(at, fraction);
        let mut machine = machine(&program, &cell);
        if at >= there {
            assert_eq!(run(&mut machine, Direction::Forward, &mut cell), Stop::Finished);
            stop_in_the_midst(&mut machine, Direction::Reverse, &mut cell);
        } else {
            stop_in_the_midst(&mut machine, Direction::Forward, &mut cell);
        }
        if goes_on == Direction::Forward {
            assert_eq!(run(&mut machine, Direction::Forward, &mut cell), Stop::Finished);
        }
        assert_eq!(run(&mut machine, Direction::Reverse, &mut cell), Stop::AtStart);
        let back = picture(&machine, &uncommanded);
        assert_eq!(back, start, "stopped in act {at} of {there}, on {goes_on:?}");
    }
    Ok(true)
}

/// Going back by steps is going back by a run, with blocks too; and turning round within what
/// replaces a block leads out of it to where it was entered, as if it had not been.
pub fn turns(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = program(u, Options { never: false, blocks: true })?;
    let uncommanded = Ledger::new(u.arbitrary()?);
    let (mut cell, mut run_cell) = (uncommanded.clone(), uncommanded.clone());
    let (mut machine, mut at_a_run) = (machine(&program, &cell), machine(&program, &cell));
    let start = picture(&machine, &uncommanded);
    for _ in 0..u.int_in_range(0..=400)? {
        if !step(&mut machine, Direction::Forward, &mut cell) {
            break;
        }
        step(&mut at_a_run, Direction::Forward, &mut run_cell);
    }
    assert_eq!(run(&mut at_a_run, Direction::Reverse, &mut run_cell), Stop::AtStart);
    let mut turned = 0;
    let mut before = picture(&machine, &uncommanded);
    while step(&mut machine, Direction::Reverse, &mut cell) {
        if machine.state().is_compensating() && turned < MAX_TURNS {
            turned += 1;
            let mut trial = cell.clone();
            let steps = u.int_in_range(0..=30_u32)?;
            if turn(&mut machine, steps, &mut trial) {
                assert_eq!(picture(&machine, &uncommanded), before, "turned after {steps} steps");
            }
        }
        before = picture(&machine, &uncommanded);
    }
    assert_eq!(picture(&machine, &uncommanded), start, "by steps");
    if turned == 0 {
        assert_eq!(picture(&machine, &cell), picture(&at_a_run, &run_cell), "as at a run");
    }
    Ok(turned > 0)
}

/// So many steps further within what replaces a block, and forward out of it again; whether it did
/// not come to its end.
fn turn(machine: &mut Machine<'_>, steps: u32, cell: &mut Ledger) -> bool {
    for _ in 0..steps {
        let goes_on = step(machine, Direction::Reverse, cell);
        if !goes_on || !machine.state().is_compensating() {
            return false;
        }
    }
    while machine.state().is_compensating() {
        assert!(step(machine, Direction::Forward, cell), "there is a way out");
    }
    true
}

/// A module and its bytes say the same, and so do a recording and its bytes.
pub fn round_trips(u: &mut Unstructured<'_>) -> Result<bool> {
    let program = program(u, Options { never: true, blocks: true })?;
    let module = program.module();
    let bytes = match encode(module) {
        Ok(bytes) => bytes,
        Err(error) => panic!("{error}"),
    };
    assert_eq!(decode(&bytes).as_ref(), Ok(module));
    for (index, instr) in module.code.iter().enumerate() {
        assert_eq!(Instr::decode(instr.encode()), Ok(*instr), "instruction {index}");
    }
    let mut cell = Ledger::new(u.arbitrary()?);
    let mut machine = machine(&program, &cell);
    for _ in 0..u.int_in_range(0..=200)? {
        if !step(&mut machine, Direction::Forward, &mut cell) {
            break;
        }
    }
    let (snapshot, streams) = (machine.snapshot(&cell), machine.streams());
    let again = Machine::from_recording(&program, &snapshot, &streams, &cell);
    let again = match again {
        Ok(again) => again,
        Err(error) => panic!("{error}"),
    };
    assert_eq!(again.digest(&cell), machine.digest(&cell));
    assert_eq!(again.streams(), streams);
    Ok(true)
}

/// A count of the opcodes of a random module, to see that all of them occur.
pub fn opcodes(u: &mut Unstructured<'_>, seen: &mut dyn FnMut(obverse_isa::Opcode)) -> Result<()> {
    let program = program(u, Options { never: true, blocks: true })?;
    for instr in &program.module().code {
        seen(instr.opcode());
        assert!(instr.info().family != Family::Value || instr.prefix() == 0);
    }
    Ok(())
}
