//! The laws of compiler and machine together, held against the reference interpreter. Each is a
//! function of randomness: the same function is a property test and a fuzz target.
//!
//! A law panics where it does not hold, with the program and what is different, and else says
//! whether there was anything to compare.
//!
//! The interpreter runs the branches of a fork one after the other, the machine in turns. Of
//! programs with a fork, therefore, the end is compared and what each device was told, and going
//! back is compared with the machine's own way forward; and the machine takes no longer.

use crate::logged::{Command, Logged};
use crate::programs::{self, Options};
use crate::reference::{self, Ending, Outcome, StateCopy};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{Verified, verify};
use obverse_compiler::compile;
use obverse_isa::Instr;
use obverse_syntax::diagnostic::Severity;
use obverse_vm::{Direction, Limits, Machine, Mark, Stop, Trap, TrapKind};
use obverse_workcell::{Arm, Clock, DigitalIo, Fault, Gripper, Workcell};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fmt::Debug;

/// The longest run that is compared, in statements of the reference interpreter.
const MAX_STEPS: u64 = 6_000;

/// The deepest run that is compared, in calls: the reference interpreter recurses.
const MAX_CALLS: usize = 128;

/// Every generated program compiles without an error, and what comes of it verifies.
///
/// # Errors
/// Those of the randomness.
pub fn compiles(u: &mut Unstructured<'_>) -> Result<bool> {
    let source = programs::generate(u, Options::default())?;
    Case::new(&source);
    Ok(true)
}

/// A run comes to the same in the machine and in the reference interpreter: the same commands in
/// the same order, the same state at the end, the same reason for ending.
///
/// # Errors
/// Those of the randomness.
pub fn agrees_forward(u: &mut Unstructured<'_>) -> Result<bool> {
    let source = programs::generate(u, Options::default())?;
    Ok(agrees_forward_on(&source, u.arbitrary()?))
}

/// The same for a given program, in a workcell that follows from a seed.
pub fn agrees_forward_on(source: &str, seed: u64) -> bool {
    let case = Case::new(source);
    let Some((expected, expected_cell)) = case.reference(seed) else { return false };
    let mut cell = Logged::new(seed);
    let mut machine = case.machine(&cell);
    let stop = loop {
        match machine.run(Direction::Forward, Limits::NONE, &mut cell, &mut ()) {
            Stop::Raised { .. } | Stop::Due { .. } => {}
            stop => break stop,
        }
    };
    let same_end = is_same_end(&expected.ending, &stop);
    case.require(same_end, || format!("it ended otherwise: {:?}, {stop:?}", expected.ending));
    if case.has_fork() {
        case.same("a device", "", &by_device(&cell.log), &by_device(&expected_cell.log));
        case.took_no_longer(&cell, &expected_cell);
    } else {
        case.same("the command", "", &cell.log, &expected_cell.log);
    }
    case.compare("at the end", &expected.last, &machine, &cell);
    true
}

/// Step by step, forward and in reverse, the machine is at the beginning of every statement in the
/// state in which the reference interpreter was there, down to the start or to what cannot be
/// taken back. Run at once and gone back over from mark to mark, it is the same.
///
/// # Errors
/// Those of the randomness.
pub fn agrees_backward(u: &mut Unstructured<'_>) -> Result<bool> {
    let source = programs::generate(u, Options { allow_overrides: false, ..Options::default() })?;
    Ok(agrees_backward_on(&source, u.arbitrary()?))
}

/// The same for a given program without blocks that are skipped or replaced in reverse, in a
/// workcell that follows from a seed.
pub fn agrees_backward_on(source: &str, seed: u64) -> bool {
    let case = Case::new(source);
    let Some((expected, _)) = case.reference(seed) else { return false };
    if case.has_fork() {
        return case.retraces(seed);
    }
    let starts = case.starts(&expected.history);
    let history: Vec<&StateCopy> =
        expected.history.iter().filter(|copy| starts.contains_key(&copy.span.start)).collect();
    let pcs: HashSet<u32> = starts.values().copied().collect();
    let mut cell = Logged::new(seed);
    let mut machine = case.machine(&cell);
    let mut walk = Walk { case: &case, history, pcs, place: 0, marks: Vec::new() };
    walk.forward(&mut machine, &mut cell);
    let (end, end_cell) = (machine.mark(), cell.clone());
    walk.reverse(&mut machine, &mut cell);
    let mut cell = Logged::new(seed);
    let mut machine = case.machine(&cell);
    walk.run_to_end(&mut machine, &mut cell);
    case.same("the end", "of a run", &machine.mark(), &end);
    case.same("the commands", "of a run", &cell.log, &end_cell.log);
    walk.reverse_to_marks(&mut machine, &mut cell);
    !walk.history.is_empty()
}

/// A program and what became of it.
struct Case<'s> {
    source: &'s str,
    program: Verified,
}

impl<'s> Case<'s> {
    fn new(source: &'s str) -> Self {
        let compiled = compile("program.obv", source);
        let errors: Vec<String> = compiled
            .diagnostics
            .iter()
            .filter(|diagnostic| diagnostic.severity == Severity::Error)
            .map(|diagnostic| {
                let span = diagnostic.primary.span;
                let at = source.get(span.start as usize..span.end as usize).unwrap_or_default();
                format!("{} (`{at}`, {})", diagnostic.message, diagnostic.primary.text)
            })
            .collect();
        assert!(errors.is_empty(), "it does not compile: {errors:#?}\n{source}");
        let Some(module) = compiled.module else { panic!("no error and no module\n{source}") };
        match verify(module) {
            Ok(program) => Self { source, program },
            Err(errors) => panic!("it does not verify: {errors:?}\n{source}"),
        }
    }

    fn machine(&self, cell: &dyn Workcell) -> Machine<'_> {
        match Machine::new(&self.program, cell) {
            Ok(machine) => machine,
            Err(errors) => panic!("it does not link: {errors:?}\n{}", self.source),
        }
    }

    /// What the reference interpreter says, and the workcell it said it with; nothing where it is
    /// too long a run.
    fn reference(&self, seed: u64) -> Option<(Outcome, Logged)> {
        let parsed = obverse_syntax::parse(self.source);
        let mut cell = Logged::new(seed);
        let limits = reference::Limits { steps: MAX_STEPS, calls: MAX_CALLS };
        let outcome = reference::run(&parsed.program, &mut cell, limits);
        (outcome.ending != Ending::Limit).then_some((outcome, cell))
    }

    /// Where the code of each statement begins, by where the statement begins in the source. A
    /// statement may have no code of its own.
    fn starts(&self, history: &[StateCopy]) -> HashMap<u32, u32> {
        let wanted: HashSet<u32> = history.iter().map(|copy| copy.span.start).collect();
        let mut starts = HashMap::new();
        for entry in &self.program.module().source_map {
            if wanted.contains(&entry.start) {
                starts.entry(entry.start).or_insert(entry.first);
            }
        }
        starts
    }

    /// Whether some of it runs in turns.
    fn has_fork(&self) -> bool {
        let code = &self.program.module().code;
        code.iter().any(|instr| matches!(instr, Instr::Fork { .. }))
    }

    /// Step by step the machine goes back through the states that it went forward through, down to
    /// the start or to what cannot be taken back; a run at once comes to the same end.
    fn retraces(&self, seed: u64) -> bool {
        let mut cell = Logged::new(seed);
        let mut machine = self.machine(&cell);
        let mut way = Vec::new();
        loop {
            way.push(place(&machine, &cell));
            match machine.step(Direction::Forward, &mut cell, &mut ()) {
                Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }) => {}
                Err(_) => break,
            }
        }
        // A trap has led back to before its statement.
        let end = way.iter().rposition(|there| *there == place(&machine, &cell));
        self.require(end.is_some(), || "the end was not on the way".to_owned());
        way.truncate(end.map_or(0, |end| end + 1));
        let (steps, log) = (way.len(), cell.log.clone());
        while let Some(there) = way.pop() {
            self.same("the place", "in reverse", &place(&machine, &cell), &there);
            let mut stepped = machine.step(Direction::Reverse, &mut cell, &mut ());
            while stepped.as_ref().is_err_and(is_held_back) {
                stepped = machine.step(Direction::Reverse, &mut cell, &mut ());
            }
            match stepped {
                Ok(()) => {}
                Err(Stop::AtStart) if way.is_empty() => {}
                Err(Stop::Refused(_)) => break,
                Err(stop) => self.require(false, || format!("reverse stopped: {stop:?}")),
            }
        }
        let mut cell = Logged::new(seed);
        let mut machine = self.machine(&cell);
        while let Stop::Raised { .. } | Stop::Due { .. } =
            machine.run(Direction::Forward, Limits::NONE, &mut cell, &mut ())
        {}
        self.same("the commands", "of a run", &cell.log, &log);
        steps > 1
    }

    /// What tasks wait for together is waited for once.
    fn took_no_longer(&self, found: &Logged, expected: &Logged) {
        let (found_s, expected_s) = (found.now_s(), expected.now_s());
        // The machine counts in whole nanoseconds, one wait after the other.
        let tolerance_s = 1e-9 * expected.log.len() as f64 + 1e-9 * expected_s;
        self.require(found_s <= expected_s + tolerance_s, || {
            format!("it took {found_s} s, and one branch after the other {expected_s} s")
        });
    }

    /// What must hold.
    #[track_caller]
    fn require(&self, holds: bool, otherwise: impl FnOnce() -> String) {
        assert!(holds, "{}\n{}", otherwise(), self.source);
    }

    #[track_caller]
    fn same<T: PartialEq + Debug>(&self, what: &str, when: &str, found: &T, expected: &T) {
        assert!(
            found == expected,
            "{what} {when}\n   is {found:?}\ninstead of {expected:?}\n{}",
            self.source
        );
    }

    /// The state of machine and workcell is that of the copy.
    fn compare(&self, when: &str, expected: &StateCopy, machine: &Machine<'_>, cell: &Logged) {
        let at = expected.span.start as usize;
        let line = self.source.get(at..).and_then(|rest| rest.lines().next()).unwrap_or_default();
        let when = format!("{when}, byte {at} `{line}`");
        self.compare_program(&when, expected, machine);
        self.same("the arm", &when, &cell.joints().bits(), &expected.joints);
        let outputs: Vec<bool> = (0..cell.output_count()).map(|bit| cell.output(bit)).collect();
        self.same("the outputs", &when, &outputs, &expected.outputs);
        self.same("the item held", &when, &cell.held().map(|item| item.0), &expected.held);
        if expected.calls > 1 {
            self.compare_frame(&when, expected, machine);
        }
    }

    fn compare_program(&self, when: &str, expected: &StateCopy, machine: &Machine<'_>) {
        let (module, state) = (self.program.module(), machine.state());
        self.same("the calls", when, &state.frames().len(), &expected.calls);
        let names = module.globals.iter().map(|global| global.name.clone());
        let globals: Vec<(String, u64)> =
            names.zip(state.globals().iter().copied()).filter(|(name, _)| is_named(name)).collect();
        self.same("the program's variables", when, &globals, &expected.globals);
        self.same("the settings", when, &state.settings(), &expected.settings);
        let raised = state.raised().iter().map(|error| module.errors[error.index()].name.clone());
        self.same("the errors pending", when, &raised.collect(), &expected.raised);
        self.same("the draws", when, &state.draws(), &expected.draws);
    }

    fn compare_frame(&self, when: &str, expected: &StateCopy, machine: &Machine<'_>) {
        let Some(frame) = machine.state().frames().last() else { return };
        let function = &self.program.module().functions[usize::from(frame.function)];
        // A block that is run in reverse is a part of the sequence before the `$` of its name.
        let sequence = function.name.split('$').next().unwrap_or_default().to_owned();
        self.same("the sequence", when, &sequence, &expected.function);
        for (local, index) in function.locals.iter().zip(0..) {
            if is_named(&local.name) {
                let found = frame.local(index);
                let expected = expected.locals.get(&local.name).copied().unwrap_or(0);
                self.same(&format!("the variable {}", local.name), when, &found, &expected);
            }
        }
        for (name, position) in function.slots.iter().zip(frame.positions()) {
            if is_named(name) {
                let expected = expected.positions.get(name).copied().unwrap_or_default();
                let found = position.bits();
                self.same(&format!("the position {name}"), when, &found, &expected);
            }
        }
        for (expected, index) in expected.counters.iter().zip(0_u8..) {
            // A counter's present value is the third of its words, which lie down from the top.
            let found = frame.local(253 - 3 * index).cast_signed();
            self.same(&format!("the counter {index}"), when, &found, expected);
        }
    }
}

/// What the arm was told, and what each output was told.
type ByDevice = (Vec<Command>, BTreeMap<u16, Vec<bool>>);

fn by_device(log: &[Command]) -> ByDevice {
    let (mut arm, mut outputs) = ByDevice::default();
    for command in log {
        match command {
            Command::Execute(_) => arm.push(*command),
            Command::Output(bit, level) => outputs.entry(*bit).or_default().push(*level),
            Command::Wait(_) => {}
        }
    }
    (arm, outputs)
}

/// How far a run is, and the state there.
fn place(machine: &Machine<'_>, cell: &Logged) -> (Mark, u64) {
    (machine.mark(), machine.digest(cell))
}

/// The program gave it its name.
fn is_named(name: &str) -> bool {
    !name.starts_with('$')
}

/// Something was in the way of a motion that goes back with a force limit: it may be tried again.
pub(crate) fn is_held_back(stop: &Stop) -> bool {
    matches!(stop, Stop::Fault { fault: Fault::ForceLimit { .. }, .. })
}

fn is_same_end(expected: &Ending, found: &Stop) -> bool {
    use reference::Trap as Expected;
    match (expected, found) {
        (Ending::Finished, Stop::Finished) => true,
        (Ending::Fault(expected), Stop::Fault { fault, .. }) => expected == fault,
        (Ending::Trap(expected), Stop::Trap(Trap { kind, .. })) => match kind {
            // Which of two comes first in one statement is open.
            TrapKind::DivisionByZero | TrapKind::NotAnInteger => *expected == Expected::Arithmetic,
            TrapKind::Assertion { .. } => *expected == Expected::Assertion,
            TrapKind::Required(_) => *expected == Expected::Required,
            TrapKind::CallDepth => *expected == Expected::CallDepth,
            _ => false,
        },
        _ => false,
    }
}

/// A machine beside the history of the reference interpreter.
struct Walk<'c> {
    case: &'c Case<'c>,
    /// Of the statements that have code of their own.
    history: Vec<&'c StateCopy>,
    /// Where these begin.
    pcs: HashSet<u32>,
    /// How many of the history the machine has begun.
    place: usize,
    /// Where it was at the beginning of each.
    marks: Vec<Mark>,
}

impl Walk<'_> {
    fn is_at_start(&self, machine: &Machine<'_>) -> bool {
        let state = machine.state();
        state.pending().is_none() && state.operands().is_empty() && self.pcs.contains(&state.pc())
    }

    /// Step by step to the end.
    fn forward(&mut self, machine: &mut Machine<'_>, cell: &mut Logged) {
        loop {
            if self.is_at_start(machine) {
                let is_more = self.place < self.history.len();
                self.case.require(is_more, || "the machine does more statements".to_owned());
                self.case.compare("going forward", self.history[self.place], machine, cell);
                self.marks.push(machine.mark());
                self.place += 1;
            }
            match machine.step(Direction::Forward, cell, &mut ()) {
                Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }) => {}
                Err(_) => break,
            }
        }
        let is_all = self.place == self.history.len();
        self.case.require(is_all, || "the machine does fewer statements".to_owned());
    }

    /// Step by step to the start, or to what cannot be taken back.
    fn reverse(&mut self, machine: &mut Machine<'_>, cell: &mut Logged) {
        let stop = loop {
            if self.is_at_start(machine) {
                let is_more = self.place > 0;
                self.case.require(is_more, || "reverse meets more statements".to_owned());
                self.place -= 1;
                self.case.compare("in reverse", self.history[self.place], machine, cell);
            }
            match machine.step(Direction::Reverse, cell, &mut ()) {
                Ok(()) => {}
                Err(stop) if is_held_back(&stop) => {}
                Err(stop) => break stop,
            }
        };
        match stop {
            Stop::AtStart => {
                let is_all = self.place == 0;
                self.case.require(is_all, || "reverse meets fewer statements".to_owned());
            }
            Stop::Refused(_) => {}
            stop => self.case.require(false, || format!("reverse stopped: {stop:?}")),
        }
    }

    /// At a run to the end.
    fn run_to_end(&self, machine: &mut Machine<'_>, cell: &mut Logged) {
        while let Stop::Raised { .. } | Stop::Due { .. } =
            machine.run(Direction::Forward, Limits::NONE, cell, &mut ())
        {}
    }

    /// From statement to statement, at a run, as far as it went by steps.
    fn reverse_to_marks(&self, machine: &mut Machine<'_>, cell: &mut Logged) {
        for at in (self.place..self.history.len()).rev() {
            let stop = loop {
                let stop = machine.reverse_to(self.marks[at], cell, &mut ());
                if !is_held_back(&stop) {
                    break stop;
                }
            };
            self.case.require(stop == Stop::AtMark, || format!("no mark was met: {stop:?}"));
            self.case.compare("back at the mark", self.history[at], machine, cell);
        }
    }
}
