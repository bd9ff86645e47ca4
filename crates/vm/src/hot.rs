//! The loops over what needs no workcell: values, variables, flow.
//!
//! Program counter, operand depth and tape top live in registers here; whatever else an instruction
//! needs makes the loop return [`Exit::Slow`]. Runs are bounded at back edges, since a count at
//! every instruction would cost half as much again; how many steps a run has made follows from the
//! program counter and what the jumps have added to `offset`.

use crate::class::{AfterForward, Always, Failure, Pure};
use crate::ops::flow::{Course, Way};
use crate::stop::TrapKind;
use crate::values::{Values, Variables};
use obverse_isa::{CounterId, Instr, Label, for_each_op, op};
use obverse_tape::{Record, Recorder, Tape, record};

/// Why a loop returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// The instruction at hand needs more than this loop has.
    Slow,
    /// The bound of the run was met.
    Bound,
    /// One step was asked for, and made.
    One,
    /// The statement that holds this instruction was not done.
    Trap(usize, TrapKind),
}

/// Where a run is: the next instruction, and `steps - pc`, wrapping.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) pc: usize,
    pub(crate) offset: u64,
}

impl Place {
    /// How many instructions have been run to come here, less those that were reversed.
    #[inline(always)]
    pub(crate) fn steps(self) -> u64 {
        (self.pc as u64).wrapping_add(self.offset)
    }

    /// Whether no more than `floor` steps are left. A count that went below nothing, as one from a
    /// tape that was tampered with can, is below every floor.
    #[inline(always)]
    pub(crate) fn is_at_or_below(self, floor: u64) -> bool {
        self.steps().cast_signed() <= floor.cast_signed()
    }

    /// Go on behind the instruction at `to`, as one step from the instruction at hand.
    #[inline(always)]
    pub(crate) fn jump_forward(&mut self, to: usize) {
        self.offset = self.offset.wrapping_add(self.pc as u64).wrapping_sub(to as u64);
        self.pc = to + 1;
    }

    /// Undo a jump: from behind the instruction at `landed` to behind the one at `from`.
    #[inline(always)]
    pub(crate) fn jump_reverse(&mut self, landed: usize, from: usize) {
        self.offset = self.offset.wrapping_add(landed as u64).wrapping_sub(from as u64);
        self.pc = from + 1;
    }
}

/// The failure of an opcode that commands no workcell.
#[inline(always)]
fn trap(at: usize, failure: Failure) -> Exit {
    match failure {
        Failure::Trap(kind) => Exit::Trap(at, kind),
        Failure::Fault(_) => Exit::Slow,
    }
}

macro_rules! borrow {
    ($values:ident) => {
        Values {
            words: &mut *$values.words,
            top: $values.top,
            depth: $values.depth,
            globals: &mut *$values.globals,
            fixed: $values.fixed,
        }
    };
}

/// Forward: one opcode, by family and class.
macro_rules! forward_arm {
    ($op:expr, $run:ident, value always) => {{
        if let Err(kind) = $op.run(&mut $run.values) {
            break Exit::Trap($run.place.pc, kind);
        }
        $run.place.pc += 1;
    }};
    ($op:expr, $run:ident, variable always) => {{
        if let Err(failure) = $op.forward(&mut Variables(&mut $run.values)) {
            break trap($run.place.pc, failure);
        }
        $run.values.depth = 0;
        $run.place.pc += 1;
    }};
    ($op:expr, $run:ident, variable after_forward $record:ident) => {{
        let op = $op;
        let mut variables = Variables(&mut $run.values);
        let saved: record::$record = op.save(&variables);
        saved.push($run.recorder);
        if let Err(failure) = op.forward(&mut variables, &saved) {
            break trap($run.place.pc, failure);
        }
        $run.values.depth = 0;
        $run.place.pc += 1;
    }};
    ($op:expr, $run:ident, flow always) => {{
        let mut variables = Variables(&mut $run.values);
        let mut course = Course { variables: &mut variables, way: Way::Beside };
        if let Err(failure) = $op.forward(&mut course) {
            break trap($run.place.pc, failure);
        }
        let way = course.way;
        follow!($run, way);
    }};
    ($op:expr, $run:ident, flow after_forward $record:ident) => {{
        let op = $op;
        let mut variables = Variables(&mut $run.values);
        let mut course = Course { variables: &mut variables, way: Way::Beside };
        let saved: record::$record = op.save(&course);
        saved.push($run.recorder);
        if let Err(failure) = op.forward(&mut course, &saved) {
            break trap($run.place.pc, failure);
        }
        let way = course.way;
        follow!($run, way);
    }};
    ($op:expr, $run:ident, $($other:tt)*) => {{
        let _ = $op;
        break Exit::Slow;
    }};
}

/// Go where a flow opcode said.
macro_rules! follow {
    ($run:ident, $way:ident) => {
        match $way {
            Way::Beside => {
                $run.values.depth = 0;
                $run.place.pc += 1;
            }
            Way::Named(target) => {
                if let Some(exit) = $run.land(target) {
                    break exit;
                }
            }
        }
    };
}

struct Forward<'r, 'a, R> {
    code: &'r [Instr],
    values: Values<'a>,
    place: Place,
    limit: u64,
    recorder: &'r mut R,
}

impl<R: Recorder> Forward<'_, '_, R> {
    /// Land on the join of a jump, in the jump's step.
    #[inline(always)]
    fn land(&mut self, target: Label) -> Option<Exit> {
        let from = self.place.pc;
        let to = target.index();
        match self.code[to] {
            Instr::Join { .. } => self.recorder.bit(true),
            Instr::JoinAssert { .. } => {
                let values = &mut self.values;
                if let Some(exit) = check_assertion(self.code, borrow!(values), from, to) {
                    return Some(exit);
                }
            }
            _ => {}
        }
        self.values.depth = 0;
        self.place.jump_forward(to);
        if to <= from && (self.place.steps() >= self.limit || self.recorder.is_full()) {
            return Some(Exit::Bound);
        }
        None
    }
}

/// Run the prefix of an asserted join that a jump lands on, which must say so. Takes the values by
/// parts, so that those of the loop stay in registers.
#[inline(never)]
#[cold]
fn check_assertion(
    code: &[Instr],
    mut values: Values<'_>,
    jump: usize,
    join: usize,
) -> Option<Exit> {
    values.depth = 0;
    let start = join - usize::from(code[join].prefix());
    if let Err((at, kind)) = evaluate(code, start, join, &mut values) {
        return Some(Exit::Trap(at, kind));
    }
    (values.top() == 0).then_some(Exit::Trap(jump, TrapKind::Assertion { by_jump: true }))
}

/// Run forward until something else is needed, a back edge passes `limit` steps, or, with `ONE`,
/// after one step.
#[inline(never)]
pub(crate) fn forward<R: Recorder, const ONE: bool>(
    code: &[Instr],
    values: &mut Values<'_>,
    place: &mut Place,
    limit: u64,
    recorder: &mut R,
) -> Exit {
    let mut run = Forward { code, values: borrow!(values), place: *place, limit, recorder };
    macro_rules! dispatch {
        ($(
            $(#[doc = $doc:literal])+
            $code:literal $ident:ident $mnemonic:literal ($($field:ident: $ty:ty),*)
            [$($picture:tt)*] $class:ident $(($payload:tt))? $family:ident;
        )*) => {
            loop {
                match run.code[run.place.pc] {
                    $(Instr::$ident { $($field,)* } => {
                        forward_arm!(op::$ident { $($field,)* }, run, $family $class $($payload)?);
                    })*
                }
                if ONE {
                    break Exit::One;
                }
                // Once more: two places to dispatch from are predicted better than one, and a run
                // depends less on where the compiler happens to lay them.
                match run.code[run.place.pc] {
                    $(Instr::$ident { $($field,)* } => {
                        forward_arm!(op::$ident { $($field,)* }, run, $family $class $($payload)?);
                    })*
                }
                if ONE {
                    break Exit::One;
                }
            }
        };
    }
    let exit = for_each_op!(dispatch);
    *place = run.place;
    run.values.spill();
    values.depth = run.values.depth;
    exit
}

/// Run pure instructions from `start` up to `end`.
///
/// # Errors
/// A trap, with the instruction that made it.
#[inline(always)]
pub(crate) fn evaluate(
    code: &[Instr],
    start: usize,
    end: usize,
    values: &mut Values<'_>,
) -> Result<(), (usize, TrapKind)> {
    macro_rules! pure_arm {
        ($op:expr, $at:ident, value) => {
            $op.run(values).map_err(|kind| ($at, kind))?
        };
        ($op:expr, $at:ident, $other:ident) => {{
            let _ = $op;
            return Ok(());
        }};
    }
    macro_rules! dispatch {
        ($(
            $(#[doc = $doc:literal])+
            $code:literal $ident:ident $mnemonic:literal ($($field:ident: $ty:ty),*)
            [$($picture:tt)*] $class:ident $(($payload:tt))? $family:ident;
        )*) => {
            for at in start..end {
                match code[at] {
                    $(Instr::$ident { $($field,)* } => {
                        pure_arm!(op::$ident { $($field,)* }, at, $family);
                    })*
                }
            }
        };
    }
    for_each_op!(dispatch);
    Ok(())
}

/// For each join, where the statement of its jump begins: one load in the chain from a statement to
/// the one before it, where the label of the join and the prefix of the jump would be two.
pub(crate) fn ways_back(code: &[Instr]) -> Vec<u32> {
    let start_of_jump = |instr: &Instr| {
        let from = instr.join_from()?;
        let jump = code.get(from.index())?;
        Some(from.0 - u32::from(jump.prefix()))
    };
    code.iter().map(|instr| start_of_jump(instr).unwrap_or(0)).collect()
}

struct Reverse<'r, 'a> {
    code: &'r [Instr],
    ways_back: &'r [u32],
    values: Values<'a>,
    place: Place,
    tape: &'r mut Tape,
}

impl Reverse<'_, '_> {
    /// Undo the jump at `from` that led to the join at `landed`, and stand before its statement.
    #[inline(always)]
    fn undo_jump(&mut self, join: Instr, landed: usize, from: Label) -> Result<(), Exit> {
        let from = from.index();
        match join {
            Instr::ForTop { counter, .. } => self.uncount(from, counter)?,
            Instr::ForExit { .. } => self.uncount_none(from)?,
            // Nothing is lost by any other jump.
            _ => {}
        }
        self.place.jump_reverse(landed, from);
        self.place.pc = self.ways_back[landed] as usize;
        Ok(())
    }

    /// Undo a `for.next` that went round.
    #[inline(always)]
    fn uncount(&mut self, from: usize, counter: CounterId) -> Result<(), Exit> {
        let mut variables = Variables(&mut self.values);
        let mut course = Course { variables: &mut variables, way: Way::Beside };
        let next = op::ForNext { counter, target: Label(0) };
        next.reverse(&mut course).map_err(|failure| trap(from, failure))
    }

    /// Undo a `for.enter` that had nothing to count.
    #[inline(never)]
    #[cold]
    fn uncount_none(&mut self, from: usize) -> Result<(), Exit> {
        let Instr::ForEnter { prefix, counter, exit } = self.code[from] else { return Ok(()) };
        let saved = record::Counter::pop(self.tape).ok_or(Exit::Trap(from, TrapKind::TapeEmpty))?;
        let mut variables = Variables(&mut self.values);
        let mut course = Course { variables: &mut variables, way: Way::Beside };
        let enter = op::ForEnter { prefix, counter, exit };
        enter.reverse(&mut course, &saved).map_err(|failure| trap(from, failure))
    }
}

/// Reverse: one opcode, by family and class. `$at` is the instruction, `$prefix` its prefix. What
/// needs its operands leaves by `$operands`, to come back with them.
macro_rules! reverse_arm {
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $operands:lifetime $out:lifetime
        variable always) => {{
        if $prefix > 0 {
            break $operands ($at, $prefix);
        }
        if let Err(failure) = $op.reverse(&mut Variables(&mut $run.values)) {
            break $out trap($at, failure);
        }
        $run.place.pc = $at;
    }};
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $operands:lifetime $out:lifetime
        variable after_forward $record:ident) => {{
        let Some(saved) = record::$record::pop($run.tape) else {
            break $out Exit::Trap($at, TrapKind::TapeEmpty);
        };
        if let Err(failure) = $op.reverse(&mut Variables(&mut $run.values), &saved) {
            break $out trap($at, failure);
        }
        $run.place.pc = $at - $prefix;
    }};
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $operands:lifetime $out:lifetime
        flow always) => {{
        if matches!($instr, Instr::JoinAssert { .. }) {
            break $operands ($at, $prefix);
        }
        let mut variables = Variables(&mut $run.values);
        let mut course = Course { variables: &mut variables, way: Way::Beside };
        if let Err(failure) = $op.reverse(&mut course) {
            break $out trap($at, failure);
        }
        let way = course.way;
        retrace!($run, $instr, $at, $prefix, way, $out);
    }};
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $operands:lifetime $out:lifetime
        flow after_forward $record:ident) => {{
        let Some(saved) = record::$record::pop($run.tape) else {
            break $out Exit::Trap($at, TrapKind::TapeEmpty);
        };
        let mut variables = Variables(&mut $run.values);
        let mut course = Course { variables: &mut variables, way: Way::Beside };
        if let Err(failure) = $op.reverse(&mut course, &saved) {
            break $out trap($at, failure);
        }
        let way = course.way;
        retrace!($run, $instr, $at, $prefix, way, $out);
    }};
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $operands:lifetime $out:lifetime
        $($other:tt)*) => {{
        let _ = $op;
        break $out Exit::Slow;
    }};
}

/// Reverse, with the operands there: one opcode, by family and class.
macro_rules! with_operands_arm {
    ($op:expr, $values:ident, variable always) => {
        $op.reverse(&mut Variables(&mut $values)).map(|()| Way::Beside)
    };
    ($op:expr, $values:ident, flow always) => {{
        let mut variables = Variables(&mut $values);
        let mut course = Course { variables: &mut variables, way: Way::Beside };
        $op.reverse(&mut course).map(|()| course.way)
    }};
    ($op:expr, $values:ident, $($other:tt)*) => {{
        let _ = $op;
        Ok(Way::Beside)
    }};
}

/// Reverse an effect whose inverse needs its operands: run its prefix forward once more, then undo
/// it. Of its own, so that the loop's values stay in registers.
#[inline(never)]
fn reverse_with_operands(
    code: &[Instr],
    mut values: Values<'_>,
    effect: usize,
    prefix: usize,
) -> Result<Way, Exit> {
    values.depth = 0;
    let ran = evaluate(code, effect - prefix, effect, &mut values);
    ran.map_err(|(at, kind)| Exit::Trap(at, kind))?;
    macro_rules! dispatch {
        ($(
            $(#[doc = $doc:literal])+
            $code:literal $ident:ident $mnemonic:literal ($($field:ident: $ty:ty),*)
            [$($picture:tt)*] $class:ident $(($payload:tt))? $family:ident;
        )*) => {
            match code[effect] {
                $(Instr::$ident { $($field,)* } => with_operands_arm!(
                    op::$ident { $($field,)* }, values, $family $class $($payload)?
                ),)*
            }
        };
    }
    for_each_op!(dispatch).map_err(|failure| trap(effect, failure))
}

/// Go back where a flow opcode said. A jump is undone in the same step as its landing.
macro_rules! retrace {
    ($run:ident, $instr:ident, $at:ident, $prefix:expr, $way:ident, $out:lifetime) => {
        match $way {
            Way::Beside => $run.place.pc = $at - $prefix,
            Way::Named(from) => {
                if let Err(exit) = $run.undo_jump($instr, $at, from) {
                    break $out exit;
                }
            }
        }
    };
}

/// Run in reverse, a statement at a time, until something else is needed, no more than `floor`
/// steps are left, or, with `ONE`, after one statement. Begins between statements.
#[inline(never)]
pub(crate) fn reverse<const ONE: bool>(
    code: &[Instr],
    ways_back: &[u32],
    values: &mut Values<'_>,
    place: &mut Place,
    floor: u64,
    tape: &mut Tape,
) -> Exit {
    let mut run = Reverse { code, ways_back, values: borrow!(values), place: *place, tape };
    macro_rules! dispatch {
        ($(
            $(#[doc = $doc:literal])+
            $code:literal $ident:ident $mnemonic:literal ($($field:ident: $ty:ty),*)
            [$($picture:tt)*] $class:ident $(($payload:tt))? $family:ident;
        )*) => {
            'out: loop {
                let effect = 'operands: loop {
                    // Before the first instruction the index wraps, and is none of the code's.
                    let at = run.place.pc.wrapping_sub(1);
                    let Some(&instr) = run.code.get(at) else { break 'out Exit::Slow };
                    match instr {
                        $(Instr::$ident { $($field,)* } => {
                            reverse_arm!(
                                op::$ident { $($field,)* },
                                run,
                                instr,
                                at,
                                usize::from(0 $(+ obverse_isa::Operand::as_prefix($field))*),
                                'operands 'out $family $class $($payload)?
                            );
                        })*
                    }
                    if ONE {
                        break 'out Exit::One;
                    }
                    if run.place.is_at_or_below(floor) {
                        break 'out Exit::Bound;
                    }
                };
                let (effect, prefix) = effect;
                let values = &mut run.values;
                match reverse_with_operands(run.code, borrow!(values), effect, prefix) {
                    Ok(Way::Beside) => run.place.pc = effect - prefix,
                    Ok(Way::Named(from)) => {
                        let join = run.code[effect];
                        if let Err(exit) = run.undo_jump(join, effect, from) {
                            break exit;
                        }
                    }
                    Err(exit) => break exit,
                }
                if ONE {
                    break Exit::One;
                }
                if run.place.is_at_or_below(floor) {
                    break Exit::Bound;
                }
            }
        };
    }
    let exit = for_each_op!(dispatch);
    *place = run.place;
    values.depth = 0;
    exit
}
