//! The machine: a verified program, its state, and its tape, run in either direction.

use crate::alter::Alteration;
use crate::branches::{self, Branches};
use crate::hot::{self, Exit, MAX_STEP_WORDS};
use crate::link::{LinkError, Links};
use crate::observe::Observer;
use crate::reversed::{Reversed, reversed};
use crate::state::{Direction, Frame, State};
use crate::step::{Host, Outcome};
use crate::stop::Stop;

use obverse_bytecode::Verified;
use obverse_isa::{Class, Instr, Setting};
use obverse_tape::{NoTape, Note, Recorder, Tape};
use obverse_workcell::{ToolId, Watch, Workcell};
use std::collections::BTreeMap;
use xxhash_rust::xxh3::Xxh3;

/// A reversible machine. The workcell is lent to it for each run, so that whoever drives the
/// machine can look at the workcell in between.
#[derive(Clone, Debug)]
pub struct Machine<'p> {
    pub(crate) program: &'p Verified,
    pub(crate) constants: Vec<u64>,
    reversed: Vec<Reversed>,
    /// The branches of each fork.
    pub(crate) branches: BTreeMap<u32, Branches>,
    pub(crate) links: Links,
    pub(crate) state: State,
    pub(crate) tape: Option<Tape>,
    pub(crate) commands: u64,
    pub(crate) executed: u64,
    /// What is done otherwise than the program says.
    pub(crate) alteration: Option<Alteration>,
    /// Whether what is reversed restores the program's state alone and commands nothing.
    pub(crate) is_muted: bool,
    /// How many steps back over a block with a reverse of its own are believed: a machine knows its
    /// own past, and a recording may be anybody's.
    pub(crate) believed_steps: u64,
}

/// When a run ends at the latest.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// After about so many instructions: met at the next back edge, call or act.
    pub instructions: u64,
}

impl Limits {
    /// No limit.
    pub const NONE: Self = Self { instructions: u64::MAX };

    /// About so many instructions.
    #[must_use]
    pub fn instructions(instructions: u64) -> Self {
        Self { instructions }
    }
}

/// A place in the history of a run, to go back to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Mark {
    steps: u64,
}

impl Mark {
    /// Where the machine was so many steps from the start of the program.
    #[must_use]
    pub fn at(steps: u64) -> Self {
        Self { steps }
    }

    /// How many steps that is from the start of the program.
    #[must_use]
    pub fn steps(self) -> u64 {
        self.steps
    }
}

macro_rules! values {
    ($machine:ident) => {{
        let state = &mut $machine.state;
        let frame = match state.frames.last_mut() {
            Some(frame) => frame,
            None => unreachable!("a machine always has the frame of its start"),
        };
        $crate::values::Values {
            top: frame.words.operand(state.depth.wrapping_sub(1)),
            words: &mut frame.words,
            depth: state.depth,
            globals: &mut state.globals,
            fixed: &$crate::values::Fixed {
                constants: &$machine.constants,
                tools: &$machine.links.tools,
                settings: state.settings,
                raised: &state.raised,
            },
        }
    }};
}
pub(crate) use values;

impl<'p> Machine<'p> {
    /// A machine at the start of a program, with an empty tape.
    ///
    /// # Errors
    /// All that the program needs and the workcell lacks.
    pub fn new(program: &'p Verified, cell: &dyn Workcell) -> Result<Self, Vec<LinkError>> {
        let module = program.module();
        let links = Links::new(module, cell)?;
        let settings = links.settings;
        let state = State {
            place: hot::Place { pc: 1, offset: 0 },
            depth: 0,
            frames: vec![Frame::new(0, &module.functions[0], 0)],
            globals: vec![0; module.globals.len()],
            settings,
            raised: Vec::new(),
            draws: 0,
            pending: None,
            open_blocks: 0,
            compensations: Vec::new(),
            forks: Vec::new(),
        };
        Ok(Self {
            program,
            constants: module.constants.iter().map(|constant| constant.bits()).collect(),
            reversed: reversed(&module.code),
            branches: branches::branches(module),
            links,
            state,
            tape: Some(Tape::default()),
            commands: 0,
            executed: 0,
            alteration: None,
            is_muted: false,
            believed_steps: u64::MAX,
        })
    }

    /// The same machine without a tape: it runs forward only.
    #[must_use]
    pub fn without_tape(mut self) -> Self {
        self.tape = None;
        self
    }

    /// The same machine with an empty tape that holds at most so many bytes.
    #[must_use]
    pub fn with_tape_limit(mut self, limit_bytes: usize) -> Self {
        self.tape = Some(Tape::with_limit(limit_bytes));
        self
    }

    /// Run until something stops it. A limit is met at the next back edge, call or act.
    pub fn run(
        &mut self,
        direction: Direction,
        limits: Limits,
        cell: &mut dyn Workcell,
        observer: &mut dyn Observer,
    ) -> Stop {
        let allowed = self.executed.saturating_add(limits.instructions);
        let mut host = Host { cell, observer };
        loop {
            if self.executed >= allowed {
                return Stop::Budget;
            }
            let left = allowed - self.executed;
            if let Err(stop) = self.burst(direction, left, 0, &mut host) {
                return stop;
            }
        }
    }

    /// Run in reverse until the machine is where the mark was taken, between statements.
    pub fn reverse_to(
        &mut self,
        mark: Mark,
        cell: &mut dyn Workcell,
        observer: &mut dyn Observer,
    ) -> Stop {
        let mut host = Host { cell, observer };
        while self.state.steps() > mark.steps || !self.state.compensations.is_empty() {
            if let Err(stop) = self.burst(Direction::Reverse, u64::MAX, mark.steps, &mut host) {
                return stop;
            }
        }
        if self.state.steps() == mark.steps { Stop::AtMark } else { Stop::OffMark }
    }

    /// One step: forward, an instruction; in reverse, an instruction, with the operands that it
    /// found. A jump and its landing are one.
    ///
    /// # Errors
    /// Why no step was made, or what the step led to.
    pub fn step(
        &mut self,
        direction: Direction,
        cell: &mut dyn Workcell,
        observer: &mut dyn Observer,
    ) -> Outcome {
        let mut host = Host { cell, observer };
        match self.direction_of(direction) {
            Direction::Forward => self.step_forward(&mut host),
            Direction::Reverse => self.step_reverse(&mut host),
        }
    }

    /// One step back of the program's own state, commanding nothing, whatever the program says of
    /// its reverse: for looking at what is on the tape.
    ///
    /// # Errors
    /// Why there is no such step: the start, or an instruction before which the tape was dropped.
    pub fn unwind(&mut self, cell: &mut dyn Workcell) -> Outcome {
        let never = self.state.place.pc.checked_sub(1).map(|at| self.program.module().code[at]);
        let is_never = never.is_some_and(|instr| matches!(instr.info().class, Class::Never(_)));
        let passes_over = !is_never || self.state.open_blocks > 0;
        let mut host = Host { cell, observer: &mut () };
        self.is_muted = passes_over;
        let outcome = self.step_reverse(&mut host);
        self.is_muted = false;
        outcome
    }

    /// Take the program's own state back to a mark, commanding nothing: the world stays as it is.
    ///
    /// # Errors
    /// Why it cannot be taken back as far.
    pub fn unwind_to(&mut self, mark: Mark, cell: &mut dyn Workcell) -> Outcome {
        while self.state.steps() > mark.steps {
            self.unwind(cell)?;
        }
        Ok(())
    }

    fn step_forward(&mut self, host: &mut Host<'_>) -> Outcome {
        if self.state.pending.is_some() {
            return self.count_step(|machine| machine.slow_forward(host));
        }
        let code = &self.program.module().code;
        self.count_step(|machine| match machine.hot_forward::<true>(code, u64::MAX) {
            Exit::Slow => machine.slow_forward(host),
            Exit::Trap(at, kind) => Err(machine.trapped(at, kind)),
            Exit::One | Exit::Bound | Exit::Full => Ok(()),
        })
    }

    fn step_reverse(&mut self, host: &mut Host<'_>) -> Outcome {
        if self.state.depth > 0 && self.state.pending.is_none() {
            return self.count_step(Self::operand_back);
        }
        let compensations = self.state.compensations.len();
        // What was left for the cleanup stands where it was left.
        let comes_back = self.came_from_leaving() == Some(self.state.steps());
        self.count_step(|machine| {
            machine.statement_back(host)?;
            // Into what replaces a reversal it goes forward, and out of it the machine stands where
            // it entered, behind its block.
            let is_same = machine.state.compensations.len() == compensations;
            if is_same && !comes_back { machine.show_operands() } else { Ok(()) }
        })
    }

    /// Within a prefix, one instruction back.
    fn operand_back(&mut self) -> Outcome {
        let before = self.state.place.pc - 1;
        self.state.place.pc = before;
        self.load_operands_up_to(before)
    }

    fn statement_back(&mut self, host: &mut Host<'_>) -> Outcome {
        let exit = match self.state.pending {
            Some(_) => Exit::Slow,
            None => self.hot_reverse::<true>(0),
        };
        match exit {
            Exit::Slow => self.slow_reverse(host),
            Exit::Trap(at, kind) => Err(self.trapped(at, kind)),
            Exit::One | Exit::Bound | Exit::Full => Ok(()),
        }
    }

    /// Between statements, going back by instructions: run the prefix, to stand before the effect.
    fn show_operands(&mut self) -> Outcome {
        let code = &self.program.module().code;
        let start = self.state.place.pc;
        let effect = (start..code.len()).find(|&at| !code[at].info().family.is_pure());
        let Some(effect) = effect else { return Ok(()) };
        self.load_operands(effect)?;
        self.state.place.pc = effect;
        Ok(())
    }

    /// Within a prefix: run it again up to an instruction.
    fn load_operands_up_to(&mut self, at: usize) -> Outcome {
        let code = &self.program.module().code;
        let start = self.statement_start(at);
        self.state.depth = 0;
        let mut values = values!(self);
        let ran = hot::evaluate(code, start, at, &mut values);
        values.spill();
        let depth = values.depth;
        self.state.depth = depth;
        ran.map_err(|(at, kind)| self.trapped(at, kind))
    }

    /// As far as the hot loop goes, and one step more: at most about so many instructions, and in
    /// reverse not below `floor` steps.
    fn burst(
        &mut self,
        direction: Direction,
        left: u64,
        floor: u64,
        host: &mut Host<'_>,
    ) -> Outcome {
        let now = self.direction_of(direction);
        let floor = if self.state.compensations.is_empty() { floor } else { 0 };
        self.net_of_traps(|machine| machine.loop_and_step((now, left, floor), host))
    }

    /// Count nothing twice of a statement that trapped and was gone back over: what is counted is
    /// how far it led.
    pub(crate) fn net_of_traps(&mut self, run: impl FnOnce(&mut Self) -> Outcome) -> Outcome {
        let (executed, steps) = (self.executed, self.state.steps());
        let outcome = run(self);
        if let Err(Stop::Trap(_)) = outcome {
            self.executed = executed.saturating_add(self.state.steps().abs_diff(steps));
        }
        outcome
    }

    fn loop_and_step(
        &mut self,
        (now, left, floor): (Direction, u64, u64),
        host: &mut Host<'_>,
    ) -> Outcome {
        let steps = self.state.steps();
        let code = &self.program.module().code;
        // What the loop ran and the step behind it are counted one by one: they may lead opposite
        // ways.
        let exit = self.count(|machine| match (machine.state.pending, now) {
            (Some(_), _) => Exit::Slow,
            (None, Direction::Forward) => {
                machine.hot_forward::<false>(code, steps.saturating_add(left))
            }
            (None, Direction::Reverse) => {
                machine.hot_reverse::<false>(floor.max(steps.saturating_sub(left)))
            }
        });
        match (exit, now) {
            (Exit::Trap(at, kind), _) => Err(self.trapped(at, kind)),
            (Exit::Bound | Exit::One | Exit::Full, Direction::Forward) => self.check_tape(),
            (Exit::Bound | Exit::One | Exit::Full, Direction::Reverse) => Ok(()),
            (Exit::Slow, Direction::Forward) => {
                self.count_step(|machine| machine.slow_forward(host))
            }
            (Exit::Slow, Direction::Reverse) => {
                self.count_step(|machine| machine.slow_reverse(host))
            }
        }
    }

    pub(crate) fn check_tape(&self) -> Outcome {
        use crate::stop::{Trap, TrapKind};
        match &self.tape {
            Some(tape) if tape.is_full() => {
                Err(Stop::Trap(Trap { pc: self.state.pc(), kind: TrapKind::TapeFull }))
            }
            _ => Ok(()),
        }
    }

    /// Count the instructions that something runs, in either direction.
    pub(crate) fn count<T>(&mut self, run: impl FnOnce(&mut Self) -> T) -> T {
        let steps = self.state.steps();
        let outcome = run(self);
        self.executed = self.executed.saturating_add(self.state.steps().abs_diff(steps));
        outcome
    }

    /// Count a step: one that leads nowhere else, as into what replaces a reversal, is one too.
    pub(crate) fn count_step(&mut self, run: impl FnOnce(&mut Self) -> Outcome) -> Outcome {
        let executed = self.executed;
        let outcome = self.count(run);
        let is_made = matches!(outcome, Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }));
        if is_made && self.executed == executed {
            self.executed = self.executed.saturating_add(1);
        }
        outcome
    }

    pub(crate) fn hot_forward<const ONE: bool>(&mut self, code: &[Instr], limit: u64) -> Exit {
        let mut place = self.state.place;
        let mut values = values!(self);
        let exit = match &mut self.tape {
            Some(tape) => {
                // Until then it cannot become full, so that the loop need not ask.
                let room = place.steps().saturating_add(tape.room_words() / MAX_STEP_WORDS);
                let limit = limit.min(room);
                loop {
                    let exit = hot::forward::<_, ONE>(code, &mut values, &mut place, tape, limit);
                    if exit != Exit::Full {
                        break exit;
                    }
                    tape.make_room();
                }
            }
            None => hot::forward::<_, ONE>(code, &mut values, &mut place, &mut NoTape, limit),
        };
        let depth = values.depth;
        self.state.depth = depth;
        self.state.place = place;
        exit
    }

    pub(crate) fn hot_reverse<const ONE: bool>(&mut self, floor: u64) -> Exit {
        if self.state.depth > 0 {
            return Exit::Slow;
        }
        // What was before this turn was another task's, and what was left for the cleanup has no
        // code that leads there.
        let bound = self.turn_began().max(self.came_from_leaving());
        if bound.is_some_and(|bound| self.state.steps() <= bound) {
            return Exit::Slow;
        }
        let floor = floor.max(bound.unwrap_or(0));
        let code = &self.program.module().code;
        let mut place = self.state.place;
        let mut values = values!(self);
        let Some(tape) = &mut self.tape else {
            return Exit::Trap(place.pc, crate::stop::TrapKind::NoTape);
        };
        let exit = hot::reverse::<ONE>(code, &self.reversed, &mut values, &mut place, floor, tape);
        self.state.place = place;
        exit
    }

    /// While a function is run in place of a reversal, the directions change places.
    fn direction_of(&self, asked: Direction) -> Direction {
        if self.state.compensations.len() % 2 == 1 { asked.opposite() } else { asked }
    }

    /// From here on, do otherwise than the program says, or no longer.
    pub fn alter(&mut self, alteration: Option<Alteration>) {
        self.alteration = alteration;
    }

    /// What the program has the workcell watch while it acts.
    #[must_use]
    pub fn watches(&self) -> &[Watch] {
        &self.links.watches
    }

    /// A mark of where the machine is.
    #[must_use]
    pub fn mark(&self) -> Mark {
        Mark { steps: self.state.steps() }
    }

    /// The program.
    #[must_use]
    pub fn program(&self) -> &'p Verified {
        self.program
    }

    /// The tool in force.
    #[must_use]
    pub fn tool(&self) -> ToolId {
        ToolId(self.state.settings[Setting::Tool as usize] as u16)
    }

    /// Note on the tape what happened in a recovery.
    pub fn note(&mut self, note: Note) {
        if let Some(tape) = &mut self.tape {
            tape.note(note);
        }
    }

    /// The machine's part of the state.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The tape, if there is one.
    #[must_use]
    pub fn tape(&self) -> Option<&Tape> {
        self.tape.as_ref()
    }

    /// How many commands the workcell was given, in either direction.
    #[must_use]
    pub fn commands(&self) -> u64 {
        self.commands
    }

    /// How many instructions were run or reversed.
    #[must_use]
    pub fn executed(&self) -> u64 {
        self.executed
    }

    /// A digest of the whole state: the machine's part, and what it commands of the workcell.
    #[must_use]
    pub fn digest(&self, cell: &dyn Workcell) -> u64 {
        let mut hash = Xxh3::new();
        let mut sink = |word: u64| hash.update(&word.to_le_bytes());
        self.state.each_word(&self.program.module().functions, &mut sink);
        cell.commanded_state(&mut sink);
        hash.digest()
    }
}
