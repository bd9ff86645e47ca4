//! The loops over what needs no workcell: values, variables, flow.
//!
//! Program counter, operand depth and tape top live in registers here; whatever else an instruction
//! needs makes the loop return [`Exit::Slow`]. Runs are bounded at back edges, since a count at
//! every instruction would cost half as much again; how many steps a run has made follows from the
//! program counter and what the jumps have added to `offset`.

use crate::class::{AfterForward, Always, Failure, Pure};
use crate::ops::flow::{Course, Way};
use crate::reversed::{Reversed, nearest};
use crate::stop::TrapKind;
use crate::update::Undo;
use crate::values::{Values, Variables};
use obverse_isa::{CounterId, Instr, Label, for_each_op, op};
use obverse_tape::{Record, Recorder, Tape, record};

/// The most words that a step of the loops records: a counter has three, and a landing a bit.
pub(crate) const MAX_STEP_WORDS: u64 = 4;

/// Why a loop returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// The instruction at hand needs more than this loop has.
    Slow,
    /// The bound of the run was met.
    Bound,
    /// One step was asked for, and made.
    One,
    /// The recorder has no room for what the instruction at hand records, and is to get memory: a
    /// call that came back into the loop would cost it registers.
    Full,
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

    /// Go on behind the instruction at `to`, as one step from the instruction at hand.
    #[inline(always)]
    pub(crate) fn jump_forward(&mut self, to: usize) {
        self.offset = self.offset.wrapping_add(self.pc as u64).wrapping_sub(to as u64);
        self.pc = to + 1;
    }

    /// Stand before an instruction after so many steps.
    pub(crate) fn stand_at(&mut self, pc: usize, steps: u64) {
        *self = Self { pc, offset: steps.wrapping_sub(pc as u64) };
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
    ($values:expr) => {
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
        if !record::$record::has_room($run.recorder) {
            break Exit::Full;
        }
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
        if !record::$record::has_room($run.recorder) {
            break Exit::Full;
        }
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
            Instr::Join { .. } => {
                // What leads to such a join has changed nothing so far, and can be run once more.
                if !self.recorder.has_room_for_bit() {
                    return Some(Exit::Full);
                }
                self.recorder.bit(true);
            }
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
        if to <= from && self.place.steps() >= self.limit {
            return Some(Exit::Bound);
        }
        None
    }
}

/// Run the prefix of an asserted join that a jump lands on, which must say so.
#[inline(never)]
#[cold]
fn check_assertion(code: &[Instr], values: Values<'_>, jump: usize, join: usize) -> Option<Exit> {
    match operands(code, values, join) {
        Ok((0, _)) => Some(Exit::Trap(jump, TrapKind::Assertion { by_jump: true })),
        Ok(_) => None,
        Err(exit) => Some(exit),
    }
}

/// Run the prefix of an effect: the newest operand, and how many there are. Takes the values by
/// parts, so that those of the loops stay in registers.
#[inline(never)]
fn operands(code: &[Instr], mut values: Values<'_>, effect: usize) -> Result<(u64, u8), Exit> {
    values.depth = 0;
    let start = effect - usize::from(code[effect].prefix());
    match evaluate(code, start, effect, &mut values) {
        Ok(()) => Ok((values.top, values.depth)),
        Err((at, kind)) => Err(Exit::Trap(at, kind)),
    }
}

/// Run forward until something else is needed, a back edge passes `limit` steps, or, with `ONE`,
/// after one step.
#[inline(never)]
pub(crate) fn forward<R: Recorder, const ONE: bool>(
    code: &[Instr],
    values: &mut Values<'_>,
    place: &mut Place,
    recorder: &mut R,
    limit: u64,
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
    (values.top, values.depth) = (run.values.top, run.values.depth);
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

struct Reverse<'r, 'a> {
    code: &'r [Instr],
    values: Values<'a>,
    tape: &'r mut Tape,
}

impl Reverse<'_, '_> {
    /// Undo what a jump did besides leading to a join.
    #[inline(always)]
    fn undo_jump(&mut self, join: Instr, from: Label) -> Result<(), Exit> {
        match join {
            Instr::ForTop { counter, .. } => self.uncount(from.index(), counter),
            Instr::ForExit { .. } => {
                let values = &mut self.values;
                uncount_none(self.code, borrow!(values), self.tape, from.index())
            }
            // Nothing is lost by any other jump.
            _ => Ok(()),
        }
    }

    /// Undo a `for.next` that went round.
    #[inline(always)]
    fn uncount(&mut self, from: usize, counter: CounterId) -> Result<(), Exit> {
        let mut variables = Variables(&mut self.values);
        let mut course = Course { variables: &mut variables, way: Way::Beside };
        let next = op::ForNext { counter, target: Label(0) };
        next.reverse(&mut course).map_err(|failure| trap(from, failure))
    }
}

/// Undo a `for.enter` that had nothing to count. Takes the values by parts, so that those of the
/// loop stay in registers.
#[inline(never)]
#[cold]
fn uncount_none(
    code: &[Instr],
    mut values: Values<'_>,
    tape: &mut Tape,
    from: usize,
) -> Result<(), Exit> {
    let Instr::ForEnter { prefix, counter, exit } = code[from] else { return Ok(()) };
    let saved = record::Counter::pop(tape).ok_or(Exit::Trap(from, TrapKind::TapeEmpty))?;
    let mut variables = Variables(&mut values);
    let mut course = Course { variables: &mut variables, way: Way::Beside };
    let enter = op::ForEnter { prefix, counter, exit };
    enter.reverse(&mut course, &saved).map_err(|failure| trap(from, failure))
}

/// Reverse: one opcode, by family and class, as whether a jump was undone. `$at` is the
/// instruction, `$prefix` its prefix.
macro_rules! reverse_arm {
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $out:lifetime
        variable always) => {{
        load_operands!($run, $at, $prefix, $out);
        if let Err(failure) = $op.reverse(&mut Variables(&mut $run.values)) {
            break $out trap($at, failure);
        }
        false
    }};
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $out:lifetime
        variable after_forward $record:ident) => {{
        let Some(saved) = record::$record::pop($run.tape) else {
            break $out Exit::Trap($at, TrapKind::TapeEmpty);
        };
        if let Err(failure) = $op.reverse(&mut Variables(&mut $run.values), &saved) {
            break $out trap($at, failure);
        }
        false
    }};
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $out:lifetime
        flow always) => {{
        if matches!($instr, Instr::JoinAssert { .. }) {
            load_operands!($run, $at, $prefix, $out);
        }
        let mut variables = Variables(&mut $run.values);
        let mut course = Course { variables: &mut variables, way: Way::Beside };
        if let Err(failure) = $op.reverse(&mut course) {
            break $out trap($at, failure);
        }
        let way = course.way;
        retrace!($run, $instr, way, $out)
    }};
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $out:lifetime
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
        retrace!($run, $instr, way, $out)
    }};
    ($op:expr, $run:ident, $instr:ident, $at:ident, $prefix:expr, $out:lifetime
        $($other:tt)*) => {{
        let _ = $op;
        break $out Exit::Slow;
    }};
}

/// Have the operands of an effect there.
macro_rules! load_operands {
    ($run:ident, $at:ident, $prefix:expr, $out:lifetime) => {
        if $prefix > 0 {
            let values = &mut $run.values;
            match operands($run.code, borrow!(values), $at) {
                Ok((top, depth)) => ($run.values.top, $run.values.depth) = (top, depth),
                Err(exit) => break $out exit,
            }
        }
    };
}

/// Whether a flow opcode said to go back by its jump, which is then undone.
macro_rules! retrace {
    ($run:ident, $instr:ident, $way:ident, $out:lifetime) => {
        match $way {
            Way::Beside => false,
            Way::Named(from) => match $run.undo_jump($instr, from) {
                Ok(()) => true,
                Err(exit) => break $out exit,
            },
        }
    };
}

/// Run in reverse, a statement at a time, until something else is needed, no more than `floor`
/// steps are left, or, with `ONE`, after one statement. Begins between statements. A jump is undone
/// in the same step as its landing.
#[inline(never)]
pub(crate) fn reverse<const ONE: bool>(
    code: &[Instr],
    reversed: &[Reversed],
    values: &mut Values<'_>,
    place: &mut Place,
    floor: u64,
    tape: &mut Tape,
) -> Exit {
    let mut run = Reverse { code, values: borrow!(values), tape };
    // Before the first instruction the index wraps, and is none of the code's.
    let mut next = (place.pc as u32).wrapping_sub(1);
    // A count that went below nothing, as one from a tape that was tampered with can, is below
    // every floor.
    let mut left = place.steps().wrapping_sub(floor).cast_signed();
    macro_rules! dispatch {
        ($(
            $(#[doc = $doc:literal])+
            $code:literal $ident:ident $mnemonic:literal ($($field:ident: $ty:ty),*)
            [$($picture:tt)*] $class:ident $(($payload:tt))? $family:ident;
        )*) => {
            'out: loop {
                let at = next as usize;
                let Some(row) = reversed.get(at) else { break Exit::Slow };
                let by_jump = match row.undo {
                    Undo::Update(update) => {
                        update.undo(&mut run.values);
                        false
                    }
                    Undo::Instr(instr) => match instr {
                        $(Instr::$ident { $($field,)* } => {
                            reverse_arm!(
                                op::$ident { $($field,)* },
                                run,
                                instr,
                                at,
                                0 $(+ obverse_isa::Operand::as_prefix($field))*,
                                'out $family $class $($payload)?
                            )
                        })*
                    }
                };
                let way = if by_jump { row.jump } else { row.beside };
                if ONE || way.steps() >= left {
                    let way = nearest(code, at, by_jump, if ONE { 0 } else { left });
                    next = way.next();
                    left = left.wrapping_sub(way.steps());
                    break if ONE { Exit::One } else { Exit::Bound };
                }
                next = way.next();
                left -= way.steps();
            }
        };
    }
    let exit = for_each_op!(dispatch);
    let steps = floor.wrapping_add(left.cast_unsigned());
    place.stand_at(next.wrapping_add(1) as usize, steps);
    values.depth = 0;
    exit
}
