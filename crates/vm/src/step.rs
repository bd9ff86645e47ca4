//! Steps that the hot loops leave: acts of the workcell, calls, and the reversal words.
//!
//! The order of things is the law of this file. Forward: save, append to the tape, act. Reverse:
//! read the record, act, and only then drop it. An act that fails is `pending`, with its record
//! still on the tape, and can be done again in either direction.

use crate::class::{AfterForward, Always, Failure, Never};
use crate::hot;
use crate::machine::{Machine, values};
use crate::observe::{Event, Observer};
use crate::ops::acts::{Acts, Done};
use crate::state::{Direction, Frame, MAX_FRAMES, Pending};
use crate::stop::{Refusal, Stop, Trap, TrapKind};
use obverse_geometry::JointConfiguration;
use obverse_isa::{Class, FunctionId, Instr, ReasonId, for_each_op, op};
use obverse_tape::{NoTape, Record, record};
use obverse_workcell::{Fault, MotionReport, Workcell};

/// What a step ended in, if the run does not go on.
pub(crate) type Outcome = Result<(), Stop>;

/// What an act is done with.
pub(crate) struct Host<'h> {
    pub(crate) cell: &'h mut dyn Workcell,
    pub(crate) observer: &'h mut dyn Observer,
}

macro_rules! acts {
    ($machine:ident, $host:ident) => {{
        let state = &mut $machine.state;
        let frame = match state.frames.last_mut() {
            Some(frame) => frame,
            None => unreachable!("a machine always has the frame of its start"),
        };
        let (slots, operands) = frame.words.parts_mut();
        Acts {
            operands,
            slots,
            positions: &mut frame.positions,
            settings: &mut state.settings,
            raised: &mut state.raised,
            draws: &mut state.draws,
            module: $machine.program.module(),
            links: &$machine.links,
            cell: &mut *$host.cell,
            level_before: state.pending.and_then(|pending| pending.level_before),
            pc: state.place.pc as u32,
            alteration: $machine.alteration.as_ref(),
            aside: None,
            may_rest: false,
            done: Done::default(),
        }
    }};
}

/// Call the method of an opcode's class, for the families that command, read, set or raise:
/// `$always` or `$recorded`.
macro_rules! act_arm {
    ($m:ident, $host:ident, $op:expr, $always:ident, $recorded:ident, setting $($c:tt)*) => {
        act_arm!(@ $m, $host, $op, $always, $recorded, $($c)*)
    };
    ($m:ident, $host:ident, $op:expr, $always:ident, $recorded:ident, kinematic $($c:tt)*) => {
        act_arm!(@ $m, $host, $op, $always, $recorded, $($c)*)
    };
    ($m:ident, $host:ident, $op:expr, $always:ident, $recorded:ident, sense $($c:tt)*) => {
        act_arm!(@ $m, $host, $op, $always, $recorded, $($c)*)
    };
    ($m:ident, $host:ident, $op:expr, $always:ident, $recorded:ident, io $($c:tt)*) => {
        act_arm!(@ $m, $host, $op, $always, $recorded, $($c)*)
    };
    ($m:ident, $host:ident, $op:expr, $always:ident, $recorded:ident, error $($c:tt)*) => {
        act_arm!(@ $m, $host, $op, $always, $recorded, $($c)*)
    };
    ($m:ident, $host:ident, $op:expr, always_forward, $recorded:ident, reversal never $w:tt) => {
        $m.never_forward($op, $host)
    };
    (@ $m:ident, $host:ident, $op:expr, $always:ident, $recorded:ident, always) => {
        $m.$always($op, $host)
    };
    (@ $m:ident, $host:ident, $op:expr, $always:ident, $recorded:ident,
        after_forward $record:ident) => {
        $m.$recorded::<_, record::$record>($op, $host)
    };
    ($m:ident, $host:ident, $op:expr, $always:ident, $recorded:ident, $($other:tt)*) => {{
        let _ = $op;
        Err(Failure::Trap(TrapKind::TapeEmpty))
    }};
}

/// What was noticed while an act was done is told behind it, once its output has settled.
fn settle_noticed(done: &Done, host: &mut Host<'_>) -> Result<(), Failure> {
    let Some((watch, fraction)) = done.noticed else { return Ok(()) };
    host.cell.watch(&[]);
    if done.rest_s > 0.0 {
        host.cell.wait(done.rest_s)?;
    }
    Err(Fault::Watched { watch, fraction }.into())
}

impl Machine<'_> {
    /// One step forward of what the hot loop left.
    pub(crate) fn slow_forward(&mut self, host: &mut Host<'_>) -> Outcome {
        let at = self.state.place.pc;
        if let Some(Pending { direction: Direction::Reverse, .. }) = self.state.pending {
            // Half undone: do it again, from the record that is still there.
            let effect = at - 1;
            self.load_operands(effect)?;
            return self.finish_forward(effect, host, at);
        }
        match self.program.module().code[at] {
            Instr::Halt {} => Err(Stop::Finished),
            Instr::Call { function, .. } => self.call(at, function, host),
            Instr::Return {} => self.return_forward(at, host),
            Instr::Checkpoint { .. } => {
                self.tell(Direction::Forward, at, None, host);
                self.advance()
            }
            Instr::BlockBegin {} => {
                self.state.open_blocks += 1;
                self.advance()
            }
            Instr::BlockSkip { .. } | Instr::BlockReplace { .. } => {
                self.state.open_blocks = self.state.open_blocks.saturating_sub(1);
                self.advance()
            }
            Instr::Fork { .. } | Instr::ForkNext {} | Instr::ForkJoin { .. } => {
                self.task_forward(at, host)
            }
            Instr::ForkLeave { .. } => {
                self.task_forward(at, host)?;
                self.tell(Direction::Forward, at, None, host);
                Ok(())
            }
            _ => self.finish_forward(at, host, at + 1),
        }
    }

    /// Do the act at `effect`, whose operands are there, and go on at `next`.
    fn finish_forward(&mut self, effect: usize, host: &mut Host<'_>, next: usize) -> Outcome {
        let instr = self.program.module().code[effect];
        self.watch(true, host.cell);
        let acted = self.act_forward(instr, host).and_then(|done| {
            settle_noticed(&done, host)?;
            // What all tasks wait for is waited for in this act.
            Ok((done.report, self.end_of_turn(effect, &done, host)?))
        });
        let (report, turn) =
            acted.map_err(|failure| self.failed(failure, effect, Direction::Forward))?;
        self.state.pending = None;
        self.state.depth = 0;
        self.state.place.pc = next;
        self.tell(Direction::Forward, effect, report, host);
        if let Some(turn) = turn {
            self.pass_turn(turn);
        }
        match instr {
            Instr::ErrorRaise { error } => Err(Stop::Raised { error, pc: effect as u32 }),
            Instr::ErrorDue { error } => Err(Stop::Due { error, pc: effect as u32 }),
            _ => Ok(()),
        }
    }

    /// One step in reverse of what the hot loop left: a whole statement.
    pub(crate) fn slow_reverse(&mut self, host: &mut Host<'_>) -> Outcome {
        if let Some(Pending { direction: Direction::Forward, .. }) = self.state.pending {
            // Half done: undo it first; the machine stands before it.
            return self.finish_reverse(self.state.place.pc, host);
        }
        if self.state.depth > 0 {
            self.state.place.pc = self.statement_start(self.state.place.pc);
            self.state.depth = 0;
            return Ok(());
        }
        if self.come_back()? {
            return Ok(());
        }
        self.take_back_fault();
        if self.turn_back()? {
            return Ok(());
        }
        let Some(at) = self.state.place.pc.checked_sub(1) else { return Err(Stop::AtStart) };
        match self.program.module().code[at] {
            Instr::Enter {} => self.enter_reverse(at, host),
            Instr::Call { function, .. } => self.return_reverse(at, function, host),
            Instr::Checkpoint { .. } => {
                self.state.place.pc = at;
                self.tell(Direction::Reverse, at, None, host);
                Ok(())
            }
            Instr::Barrier { .. } | Instr::Irreversible { .. } if self.is_muted => {
                self.state.place.pc = at;
                Ok(())
            }
            Instr::Barrier { reason } | Instr::Irreversible { reason } => {
                Err(self.refusal(at, Some(reason)))
            }
            Instr::BlockBegin {} => {
                self.state.open_blocks = self.state.open_blocks.saturating_sub(1);
                self.state.place.pc = at;
                Ok(())
            }
            Instr::ForkJoin { from } => self.join_reverse(at, from.0),
            Instr::BlockReplace { function, .. } if !self.is_muted => {
                self.compensate(at, function, host)
            }
            Instr::BlockSkip { from } | Instr::BlockReplace { from, .. } => {
                self.pass_over(at, from.index(), host)
            }
            _ => {
                self.load_operands(at)?;
                self.finish_reverse(at, host)
            }
        }
    }

    /// Undo the act at `effect`, whose operands are there, and stand before its statement.
    fn finish_reverse(&mut self, effect: usize, host: &mut Host<'_>) -> Outcome {
        let instr = self.program.module().code[effect];
        self.watch(false, host.cell);
        let done = self
            .act_reverse(instr, host)
            .map_err(|failure| self.failed(failure, effect, Direction::Reverse))?;
        self.state.pending = None;
        self.state.depth = 0;
        self.state.place.pc = effect - usize::from(instr.prefix());
        self.tell(Direction::Reverse, effect, done.report, host);
        Ok(())
    }

    /// Have the workcell watch what the program says, if what comes is an act of the program, and
    /// nothing where no error is raised.
    pub(crate) fn watch(&self, is_of_program: bool, cell: &mut dyn Workcell) {
        if self.links.watches.is_empty() {
            return;
        }
        let raises = is_of_program && !self.state.is_compensating() && !self.is_cleaning_up();
        cell.watch(if raises { &self.links.watches } else { &[] });
    }

    fn act_forward(&mut self, instr: Instr, host: &mut Host<'_>) -> Result<Done, Failure> {
        macro_rules! dispatch {
            ($(
                $(#[doc = $doc:literal])+
                $code:literal $ident:ident $mnemonic:literal ($($field:ident: $ty:ty),*)
                [$($picture:tt)*] $class:ident $(($payload:tt))? $family:ident;
            )*) => {
                match instr {
                    $(Instr::$ident { $($field,)* } => act_arm!(
                        self, host, op::$ident { $($field,)* },
                        always_forward, recorded_forward, $family $class $($payload)?
                    ),)*
                }
            };
        }
        for_each_op!(dispatch)
    }

    fn act_reverse(&mut self, instr: Instr, host: &mut Host<'_>) -> Result<Done, Failure> {
        macro_rules! dispatch {
            ($(
                $(#[doc = $doc:literal])+
                $code:literal $ident:ident $mnemonic:literal ($($field:ident: $ty:ty),*)
                [$($picture:tt)*] $class:ident $(($payload:tt))? $family:ident;
            )*) => {
                match instr {
                    $(Instr::$ident { $($field,)* } => act_arm!(
                        self, host, op::$ident { $($field,)* },
                        always_reverse, recorded_reverse, $family $class $($payload)?
                    ),)*
                }
            };
        }
        for_each_op!(dispatch)
    }

    fn always_forward<O>(&mut self, op: O, host: &mut Host<'_>) -> Result<Done, Failure>
    where
        O: for<'a> Always<Acts<'a>> + Into<Instr> + Copy,
    {
        self.count_command(op);
        let may_rest = self.others_go_on();
        let mut acts = Acts { may_rest, ..acts!(self, host) };
        let acted = op.forward(&mut acts);
        let (done, level_before) = (acts.done, acts.level_before);
        self.remember_level(Direction::Forward, level_before);
        acted.map(|()| done)
    }

    /// Nothing before this can be reversed: what is on the tape is dropped, unless a block with a
    /// reverse of its own is open, which passes over this too.
    fn never_forward<O>(&mut self, op: O, host: &mut Host<'_>) -> Result<Done, Failure>
    where
        O: for<'a> Never<Acts<'a>>,
    {
        op.forward(&mut acts!(self, host))?;
        let may_drop = self.state.compensations.is_empty() && self.state.open_blocks == 0;
        if let (Some(tape), true) = (&mut self.tape, may_drop) {
            tape.barrier();
        }
        Ok(Done::default())
    }

    fn always_reverse<O>(&mut self, op: O, host: &mut Host<'_>) -> Result<Done, Failure>
    where
        O: for<'a> Always<Acts<'a>> + Into<Instr> + Copy,
    {
        if !self.count_command(op) {
            return Ok(Done::default());
        }
        let mut acts = acts!(self, host);
        let acted = op.reverse(&mut acts);
        let (done, level_before) = (acts.done, acts.level_before);
        self.remember_level(Direction::Reverse, level_before);
        acted.map(|()| done)
    }

    fn recorded_forward<O, R>(&mut self, op: O, host: &mut Host<'_>) -> Result<Done, Failure>
    where
        O: for<'a> AfterForward<Acts<'a>, Saved = R> + Into<Instr> + Copy,
        R: Record,
    {
        self.count_command(op);
        let is_again = self.state.pending.is_some();
        let may_rest = self.others_go_on();
        let mut acts = Acts { may_rest, ..acts!(self, host) };
        let saved = match &self.tape {
            Some(tape) if is_again => R::peek(tape).ok_or(TrapKind::TapeEmpty)?,
            None if is_again => return Err(TrapKind::NoTape.into()),
            _ => op.save(&acts),
        };
        if !is_again {
            match &mut self.tape {
                Some(tape) => saved.push(tape),
                None => saved.push(&mut NoTape),
            }
        }
        let acted = op.forward(&mut acts, &saved);
        let done = acts.done;
        self.record_aside(done.aside);
        if let (Err(Failure::Trap(_)), false, Some(tape)) = (&acted, is_again, &mut self.tape) {
            // The statement has not begun, so nothing of it is recorded.
            R::pop(tape);
        }
        acted.map(|()| done)
    }

    fn recorded_reverse<O, R>(&mut self, op: O, host: &mut Host<'_>) -> Result<Done, Failure>
    where
        O: for<'a> AfterForward<Acts<'a>, Saved = R> + Into<Instr> + Copy,
        R: Record,
    {
        if !self.count_command(op) {
            let steps = self.steps_before_act();
            let tape = self.tape.as_mut().ok_or(TrapKind::NoTape)?;
            record::Aside::pop(tape, steps);
            return R::pop(tape).map(|_| Done::default()).ok_or(TrapKind::TapeEmpty.into());
        }
        let tape = self.tape.as_ref().ok_or(TrapKind::NoTape)?;
        let saved = R::peek(tape).ok_or(TrapKind::TapeEmpty)?;
        let steps = self.steps_before_act();
        let aside = record::Aside::peek(tape, steps).map(|aside| aside.joints);
        let mut acts = Acts { aside, ..acts!(self, host) };
        op.reverse(&mut acts, &saved)?;
        let done = acts.done;
        if let Some(tape) = &mut self.tape {
            record::Aside::pop(tape, steps);
            R::pop(tape);
        }
        Ok(done)
    }

    /// Keep where a motion began that was made aside, in place of where it did when it was begun
    /// before.
    fn record_aside(&mut self, aside: Option<JointConfiguration>) {
        let steps = self.state.steps();
        if let (Some(joints), Some(tape)) = (aside, &mut self.tape) {
            record::Aside::pop(tape, steps);
            record::Aside { steps, joints }.push(tape);
        }
    }

    /// How many instructions lie before the act that is being reversed: the machine stands behind
    /// it, or before one that was begun going forward.
    fn steps_before_act(&self) -> u64 {
        let steps = self.state.steps();
        match self.state.pending {
            Some(Pending { direction: Direction::Forward, .. }) => steps,
            _ => steps.saturating_sub(1),
        }
    }

    /// Count what commands the workcell; whether it is done at all, or passed over.
    fn count_command(&mut self, op: impl Into<Instr>) -> bool {
        let instr: Instr = op.into();
        let commands = instr.info().family.commands_workcell();
        self.commands += u64::from(commands && !self.is_muted);
        !(commands && self.is_muted)
    }

    fn remember_level(&mut self, direction: Direction, level_before: Option<bool>) {
        if level_before.is_some() {
            self.state.pending = Some(Pending { direction, level_before });
        }
    }

    /// What a failure means: a fault leaves the act pending, a trap leaves the statement undone.
    fn failed(&mut self, failure: Failure, effect: usize, direction: Direction) -> Stop {
        let pc = effect as u32;
        match failure {
            Failure::Fault(fault) => {
                let level_before = self.state.pending.and_then(|pending| pending.level_before);
                self.state.pending = Some(Pending { direction, level_before });
                self.state.place.pc = match direction {
                    Direction::Forward => effect,
                    Direction::Reverse => effect + 1,
                };
                if direction == Direction::Reverse {
                    self.state.depth = 0;
                }
                Stop::Fault { fault, pc, direction }
            }
            Failure::Trap(kind) => self.trapped(effect, kind),
        }
    }

    /// Stand before the statement that trapped, as if it had not begun.
    pub(crate) fn trapped(&mut self, at: usize, kind: TrapKind) -> Stop {
        self.state.place.pc = self.statement_start(self.state.place.pc);
        self.state.depth = 0;
        Stop::Trap(Trap { pc: at as u32, kind })
    }

    fn refusal(&self, at: usize, reason: Option<ReasonId>) -> Stop {
        let why = match self.program.module().code[at].info().class {
            Class::Never(why) => why,
            Class::Always | Class::AfterForward(_) => "it cannot be reversed",
        };
        Stop::Refused(Refusal { pc: at as u32, why, reason })
    }

    fn advance(&mut self) -> Outcome {
        self.state.place.pc += 1;
        Ok(())
    }

    /// The first instruction of the statement that holds, or begins at, an instruction.
    pub(crate) fn statement_start(&self, at: usize) -> usize {
        let code = &self.program.module().code;
        let effect = (at..code.len()).find(|&at| !code[at].info().family.is_pure());
        effect.map_or(at, |effect| effect - usize::from(code[effect].prefix()))
    }

    /// Run the prefix of an effect so that its operands are there.
    pub(crate) fn load_operands(&mut self, effect: usize) -> Outcome {
        let code = &self.program.module().code;
        let start = effect - usize::from(code[effect].prefix());
        self.state.depth = 0;
        let mut values = values!(self);
        let ran = hot::evaluate(code, start, effect, &mut values);
        values.spill();
        let depth = values.depth;
        self.state.depth = depth;
        ran.map_err(|(at, kind)| Stop::Trap(Trap { pc: at as u32, kind }))
    }

    fn call(&mut self, at: usize, function: FunctionId, host: &mut Host<'_>) -> Outcome {
        if self.state.call_count() >= MAX_FRAMES {
            return Err(self.trapped(at, TrapKind::CallDepth));
        }
        let declared = &self.program.module().functions[function.index()];
        let mut frame = Frame::new(function.0, declared, at as u32 + 1);
        let parameters = usize::from(declared.parameters);
        let (slots, _) = frame.words.parts_mut();
        slots[..parameters].copy_from_slice(&self.state.operands()[..parameters]);
        self.state.frames.push(frame);
        self.state.depth = 0;
        self.state.place.jump_forward(declared.first as usize);
        self.tell(Direction::Forward, at, None, host);
        Ok(())
    }

    fn enter_reverse(&mut self, at: usize, host: &mut Host<'_>) -> Outcome {
        let frames = self.state.frames.len();
        if frames == 1 {
            return Err(Stop::AtStart);
        }
        let compensation = self.state.compensations.last().copied();
        let Some(frame) = self.state.frames.pop() else { return Err(Stop::AtStart) };
        if let Some(compensation) = compensation.filter(|running| running.frames == frames) {
            self.state.compensations.pop();
            self.state.place = compensation.place;
            return Ok(());
        }
        let call = frame.return_pc as usize - 1;
        self.state.place.jump_reverse(at, call);
        self.state.place.pc = call - usize::from(self.program.module().code[call].prefix());
        self.tell(Direction::Reverse, call, None, host);
        Ok(())
    }

    fn return_forward(&mut self, at: usize, host: &mut Host<'_>) -> Outcome {
        let frames = self.state.frames.len();
        let compensation = self.state.compensations.last().copied();
        if let Some(compensation) = compensation.filter(|running| running.frames == frames) {
            return self.end_compensation(compensation, host);
        }
        let Some(frame) = self.state.frames.pop() else { return Err(Stop::Finished) };
        let declared = &self.program.module().functions[usize::from(frame.function)];
        if let Some(tape) = &mut self.tape {
            frame.save(declared).push(tape);
        }
        self.state.place.jump_forward(frame.return_pc as usize - 1);
        self.tell(Direction::Forward, at, None, host);
        Ok(())
    }

    fn return_reverse(&mut self, at: usize, function: FunctionId, host: &mut Host<'_>) -> Outcome {
        if self.state.call_count() >= MAX_FRAMES {
            return Err(Stop::Trap(Trap { pc: at as u32, kind: TrapKind::Foreign }));
        }
        let declared = &self.program.module().functions[function.index()];
        let (words, joints) = Frame::saved_size(declared);
        let missing = |kind| Stop::Trap(Trap { pc: at as u32, kind });
        let tape = self.tape.as_mut().ok_or(missing(TrapKind::NoTape))?;
        let saved = record::Frame::pop(tape, words, joints).ok_or(missing(TrapKind::TapeEmpty))?;
        let frame = Frame::restore(function.0, declared, at as u32 + 1, saved);
        self.state.frames.push(frame);
        let last = declared.end as usize - 1;
        self.state.place.jump_reverse(at, last);
        self.state.place.pc = last;
        self.tell(Direction::Reverse, last, None, host);
        Ok(())
    }

    pub(crate) fn tell(
        &self,
        direction: Direction,
        at: usize,
        report: Option<MotionReport>,
        host: &mut Host<'_>,
    ) {
        if self.is_muted {
            return;
        }
        let instr = self.program.module().code[at];
        let (steps, frames) = (self.state.steps(), self.state.frames.len());
        let (open_blocks, branches) = (self.state.open_blocks, self.state.branches());
        let (pc, executed) = (at as u32, self.executed);
        let event =
            Event { direction, pc, instr, report, steps, executed, open_blocks, frames, branches };
        host.observer.on_event(&event, host.cell);
    }
}
