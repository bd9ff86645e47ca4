//! What each reversal word promises: what the workcell is commanded going back over its block; and
//! for all of them that the program's own state is what it was before the block, bit for bit.
//!
//! Held over pairs of programs that are the same but for the word. A law panics where it does not
//! hold, and else says whether there was anything to compare; its errors are those of the
//! randomness. `docs/reversal.md` says which law is of which word.

use crate::laws;
use crate::logged::{Command, Logged};
use crate::programs::{self, BLOCK, Pair, Word, pair};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{Module, Verified, verify};
use obverse_compiler::compile;
use obverse_geometry::JointConfiguration;
use obverse_isa::{FunctionId, Instr, Opcode};
use obverse_vm::{Direction, Limits, Machine, Mark, Stop};
use obverse_workcell::{Goal, Motion, Path, Speed};

/// The longest run to the block, in steps.
const MAX_STEPS: usize = 20_000;
/// How often a motion that is held back is tried again.
const MAX_TRIES: usize = 1_000;

/// Over a block that is skipped, the workcell is commanded nothing.
pub fn skipped_blocks_command_nothing(u: &mut Unstructured<'_>) -> Result<bool> {
    let pair = pair(u, Word::Skip)?;
    let program = program(&pair.with_word);
    let Some(over) = Over::run(&program, Logged::new(u.arbitrary()?)) else { return Ok(false) };
    over.restores(&pair);
    assert_eq!(over.back, [], "{}", pair.with_word);
    Ok(!over.there.is_empty())
}

/// In place of a block that is replaced, the workcell is commanded what the other block commands
/// when it is run behind the first.
pub fn replacements_command_what_they_say(u: &mut Unstructured<'_>) -> Result<bool> {
    commands_what_comes_after(u, Word::Replace)
}

/// In place of an I/O operation with a counterpart, the counterpart is run.
pub fn io_counterparts_command_what_they_say(u: &mut Unstructured<'_>) -> Result<bool> {
    commands_what_comes_after(u, Word::Io)
}

/// In place of an advanced move with a counterpart, the counterpart is run.
pub fn move_counterparts_command_what_they_say(u: &mut Unstructured<'_>) -> Result<bool> {
    commands_what_comes_after(u, Word::Advance)
}

fn commands_what_comes_after(u: &mut Unstructured<'_>, word: Word) -> Result<bool> {
    let pair = pair(u, word)?;
    let (program, behind) = (program(&pair.with_word), program(&pair.without));
    let seed = u.arbitrary()?;
    let Some(over) = Over::run(&program, Logged::new(seed)) else { return Ok(false) };
    over.restores(&pair);
    let Some(one_after_the_other) = forward(&behind, Logged::new(seed)) else { return Ok(false) };
    let (first, second) = one_after_the_other.split_at(over.before + over.there.len());
    assert_eq!(first[over.before..], over.there, "{}", pair.with_word);
    assert_eq!(second, over.back, "{}", pair.with_word);
    Ok(!over.back.is_empty())
}

/// A block that keeps its order commands in reverse what it commanded forward, in the same order:
/// where nothing is drawn anew or found elsewhere, the same commands.
pub fn kept_blocks_command_the_same_again(u: &mut Unstructured<'_>) -> Result<bool> {
    let pair = pair(u, Word::Keep)?;
    let program = program(&pair.with_word);
    let cell = Logged::new(u.arbitrary()?).steady();
    let Some(over) = Over::run(&program, cell) else { return Ok(false) };
    over.restores(&pair);
    if depends_on_the_place(program.module()) {
        return Ok(false);
    }
    let (there, back) = (without_starts(&over.there), without_starts(&over.back));
    assert_eq!(there, back, "{}", pair.with_word);
    Ok(!back.is_empty())
}

/// Whether what the last block of a program commands may follow from where the workcell is when it
/// begins: that is where it was at the end of the block, going back.
fn depends_on_the_place(module: &Module) -> bool {
    let of_the_place = [
        Opcode::OutputToggle,
        Opcode::Remember,
        Opcode::SenseDistance,
        Opcode::SenseHolding,
        Opcode::SensePeakForce,
    ];
    let main = module.functions.iter().find(|function| function.name == "main");
    let code = main.map_or(&[][..], |main| &module.code[main.first as usize..main.end as usize]);
    let last = code.iter().rev().find_map(|instr| match instr {
        Instr::BlockReplace { function, .. } => Some(*function),
        _ => None,
    });
    let mut to_visit: Vec<FunctionId> = last.into_iter().collect();
    let mut seen = to_visit.clone();
    while let Some(function) = to_visit.pop() {
        let function = &module.functions[function.index()];
        for instr in &module.code[function.first as usize..function.end as usize] {
            if of_the_place.contains(&instr.opcode()) {
                return true;
            }
            if let Instr::Call { function, .. } = instr
                && !seen.contains(function)
            {
                seen.push(*function);
                to_visit.push(*function);
            }
        }
    }
    false
}

/// The commands but for where their motions begin.
fn without_starts(commands: &[Command]) -> Vec<Command> {
    let nowhere = JointConfiguration::ZERO;
    let without = |command: &Command| match *command {
        Command::Execute(motion) => {
            let goal = match motion.goal {
                Goal::Displaced { distance_m, axis, frame, .. } => {
                    Goal::Displaced { from: nowhere, distance_m, axis, frame }
                }
                Goal::Offset { by_m, frame, .. } => Goal::Offset { from: nowhere, by_m, frame },
                Goal::Turned { angle_rad, advance_m, axis, frame, .. } => {
                    Goal::Turned { from: nowhere, angle_rad, advance_m, axis, frame }
                }
                goal => goal,
            };
            Command::Execute(Motion { goal, ..motion })
        }
        command => command,
    };
    commands.iter().map(without).collect()
}

/// With parameters for the way back, what is commanded forward is the same, and every motion that
/// goes back has them.
pub fn parameters_hold_going_back(u: &mut Unstructured<'_>) -> Result<bool> {
    let pair = pair(u, Word::With)?;
    let (program, plain) = (program(&pair.with_word), program(&pair.without));
    let sets = |instr: &Instr| match instr {
        Instr::SettingSet { setting, .. } => setting.name().starts_with("reverse"),
        _ => false,
    };
    let is_plain = |instr: &Instr| !sets(instr) && instr.opcode() != Opcode::MoveGuardedOpposite;
    if !plain.module().code.iter().all(is_plain) {
        return Ok(false);
    }
    let cell = Logged::new(u.arbitrary()?).steady();
    let (over, without) = (Over::run(&program, cell.clone()), Over::run(&plain, cell));
    let (Some(over), Some(without)) = (over, without) else { return Ok(false) };
    over.restores(&pair);
    assert_eq!(over.there, without.there, "{}", pair.with_word);
    let with_parameters = |command: &Command| match *command {
        Command::Execute(motion) => Command::Execute(Motion {
            path: Path::Linear,
            speed: Speed::VerySlow,
            force_limit_n: Some(7.5),
            ..motion
        }),
        command => command,
    };
    let expected: Vec<Command> = without.back.iter().map(with_parameters).collect();
    assert_eq!(over.back, expected, "{}", pair.with_word);
    Ok(over.back.iter().any(|command| matches!(command, Command::Execute(_))))
}

/// With every word, from anywhere in a run, going back restores all of the program's own state and
/// empties the tape. A motion that is held back on the way may be tried again.
pub fn words_restore_the_program(u: &mut Unstructured<'_>) -> Result<bool> {
    let options =
        programs::Options { allow_never: false, allow_traps: false, ..Default::default() };
    let source = programs::generate(u, options)?;
    let program = program(&source);
    let uncommanded = Logged::new(u.arbitrary()?);
    let mut cell = uncommanded.clone();
    let mut machine = machine(&program, &cell);
    let start = machine.digest(&uncommanded);
    for _ in 0..u.int_in_range(0..=2_000)? {
        match machine.step(Direction::Forward, &mut cell, &mut ()) {
            Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }) => {}
            Err(Stop::Finished) => break,
            Err(_) => return Ok(false),
        }
    }
    let mut tries = 0;
    let stop = loop {
        let stop = machine.run(Direction::Reverse, Limits::NONE, &mut cell, &mut ());
        tries += 1;
        if !laws::is_held_back(&stop) || tries > MAX_TRIES {
            break stop;
        }
    };
    assert_eq!(stop, Stop::AtStart, "{source}");
    assert_eq!(machine.digest(&uncommanded), start, "{source}");
    assert_eq!(machine.streams(), Default::default(), "{source}");
    Ok(!cell.log.is_empty())
}

/// What was commanded over the last block of a program.
struct Over {
    /// How much was commanded before it.
    before: usize,
    /// Going forward.
    there: Vec<Command>,
    /// Going back.
    back: Vec<Command>,
    /// The program's own state before it, and when it had gone back.
    states: [u64; 2],
}

impl Over {
    /// Run a program to its end, and back over its last block; nothing if it does not come there.
    fn run(program: &Verified, mut cell: Logged) -> Option<Self> {
        let uncommanded = cell.clone();
        let module = program.module();
        let id = module.checkpoints.iter().position(|name| name == BLOCK)?;
        let is_block = |instr: &Instr| match instr {
            Instr::Checkpoint { checkpoint } => checkpoint.index() == id,
            _ => false,
        };
        let block = module.code.iter().position(is_block)? as u32;
        let mut machine = machine(program, &cell);
        for _ in 0..MAX_STEPS {
            if machine.state().pc() == block {
                break;
            }
            machine.step(Direction::Forward, &mut cell, &mut ()).ok()?;
        }
        if machine.state().pc() != block {
            return None;
        }
        let (mark, before) = (machine.mark(), cell.log.len());
        let state = machine.digest(&uncommanded);
        let stop = machine.run(Direction::Forward, Limits::NONE, &mut cell, &mut ());
        if stop != Stop::Finished {
            return None;
        }
        let end = cell.log.len();
        go_back(&mut machine, mark, &mut cell)?;
        let (there, back) = (cell.log[before..end].to_vec(), cell.log[end..].to_vec());
        let states = [state, machine.digest(&uncommanded)];
        Some(Self { before, there, back, states })
    }

    #[track_caller]
    fn restores(&self, pair: &Pair) {
        let [before, after] = self.states;
        assert_eq!(before, after, "the program's state\n{}", pair.with_word);
    }
}

/// Go back to a mark, trying again what is held back; nothing if the workcell cannot.
fn go_back(machine: &mut Machine<'_>, mark: Mark, cell: &mut Logged) -> Option<()> {
    for _ in 0..MAX_TRIES {
        match machine.reverse_to(mark, cell, &mut ()) {
            Stop::AtMark => return Some(()),
            stop if laws::is_held_back(&stop) => {}
            Stop::Fault { .. } => return None,
            stop => panic!("going back stopped: {stop:?}"),
        }
    }
    panic!("a motion is held back for ever");
}

/// What a whole run commands; nothing if it does not finish.
fn forward(program: &Verified, mut cell: Logged) -> Option<Vec<Command>> {
    let mut machine = machine(program, &cell);
    let stop = machine.run(Direction::Forward, Limits::NONE, &mut cell, &mut ());
    (stop == Stop::Finished).then_some(cell.log)
}

fn program(source: &str) -> Verified {
    let compiled = compile("program.obv", source);
    let Some(module) = compiled.module else {
        panic!("it does not compile: {:#?}\n{source}", compiled.diagnostics);
    };
    match verify(module) {
        Ok(program) => program,
        Err(errors) => panic!("it does not verify: {errors:?}\n{source}"),
    }
}

fn machine<'p>(program: &'p Verified, cell: &Logged) -> Machine<'p> {
    match Machine::new(program, cell) {
        Ok(machine) => machine,
        Err(errors) => panic!("it does not link: {errors:?}"),
    }
}
