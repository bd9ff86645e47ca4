//! The ways forward through a program, all that there may be, and what each move does on them.
//!
//! A way parts where a decision is not known, and where a guarded move may end otherwise than it
//! does if all is where it should be. Knows how control flows; what an effect does to the robot is
//! in `act`.

use crate::notes::Notes;
use crate::reason::Reason;
use crate::seen::Seen;
use crate::state::{Frame, State, Word};
use crate::trace::{Deed, Node, NodeId, Trace};
use crate::value::{Trapped, Values};
use crate::verdict::Verdict;
use crate::worlds::{WorldId, Worlds};
use obverse_bytecode::Module;
use obverse_isa::{CounterId, Family, FunctionId, Instr, Label};
use obverse_vm::{Branches, Direction, branches};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::ops::Range;
use std::rc::Rc;

/// The most work that is done in one check: a statement is one, and so is every [`WORDS`] of a
/// state that is copied, which bounds the memory too.
const MAX_WORK: usize = 400_000;
/// How many words of a state cost as much as a statement.
const WORDS: usize = 16;
/// The most calls under way.
const MAX_CALLS: usize = 256;
/// How often a function may be under way at once, where ways part by what is only known when the
/// program runs.
const MAX_UNCERTAIN_RECURSION: usize = 2;

/// Which way the machine runs when a way is followed: what replaces a block is run forward while
/// the machine goes back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Course {
    Forward,
    /// In place of going back; it is not gone back over itself.
    InReverse,
}

/// What is known while ways are followed.
pub(crate) struct Explorer<'m> {
    pub(crate) values: Values<'m>,
    pub(crate) worlds: Worlds,
    pub(crate) trace: Trace,
    pub(crate) notes: Notes,
    pub(crate) course: Course,
    /// The branches of each fork.
    pub(crate) branches: BTreeMap<u32, Branches>,
    seen: Seen,
    /// States that are still to be followed.
    pub(crate) open: Vec<State>,
    /// The workcells in which the outermost call that is followed ended.
    ended: Vec<WorldId>,
    work: usize,
    /// The code that is not followed, by its first instruction and whether as planned; whether
    /// going back over it leads to where it began.
    unfollowed: HashMap<(u32, bool), bool>,
}

impl<'m> Explorer<'m> {
    pub(crate) fn new(values: Values<'m>, worlds: Worlds) -> (Self, NodeId) {
        let (trace, begin) = Trace::new(worlds.start());
        let explorer = Self {
            branches: branches(values.module),
            values,
            worlds,
            trace,
            notes: Notes::default(),
            course: Course::Forward,
            seen: Seen::default(),
            open: Vec::new(),
            ended: Vec::new(),
            work: 0,
            unfollowed: HashMap::new(),
        };
        (explorer, begin)
    }

    /// Follow all ways from a state to where its outermost call ends; the workcells there.
    pub(crate) fn follow(&mut self, state: State, course: Course) -> Vec<WorldId> {
        self.course = course;
        self.seen = Seen::default();
        self.open = vec![state];
        while let Some(state) = self.open.pop() {
            self.run(state);
        }
        std::mem::take(&mut self.ended)
    }

    /// Whether ways were left that nobody followed.
    pub(crate) fn is_given_up(&self) -> bool {
        self.work > MAX_WORK || self.worlds.is_given_up()
    }

    /// Follow one way until it ends or parts.
    fn run(&mut self, mut state: State) {
        loop {
            self.work += 1;
            if self.work > MAX_WORK {
                return;
            }
            let code = &self.values.module.code;
            while code[state.pc].info().family.is_pure() {
                state.pc += 1;
            }
            let Ok(operands) = self.values.operands(&state, state.pc) else { return };
            let Some(next) = self.effect(state, &operands) else { return };
            state = next;
        }
    }

    /// Do the effect that a state is at; the state after it, unless the way ends or is continued
    /// from among those that are open.
    fn effect(&mut self, mut state: State, operands: &[Word]) -> Option<State> {
        let instr = self.values.module.code[state.pc];
        match instr {
            Instr::Land { .. } => self.pass(state),
            Instr::Join { .. } | Instr::ForTop { .. } | Instr::ForExit { .. } => {
                state.pc += 1;
                self.meet(state)
            }
            Instr::JoinAssert { .. } => {
                let is_wrong = operands.first().copied().flatten().is_some_and(|word| word != 0);
                state.pc += 1;
                if is_wrong { None } else { self.meet(state) }
            }
            Instr::ForEnter { counter, exit, .. } => {
                self.enter_loop(state, counter, exit, operands)
            }
            Instr::ForNext { counter, target } => self.next_round(state, counter, target),
            Instr::Call { function, .. } => self.call(state, function, operands),
            Instr::Fork { .. }
            | Instr::ForkNext {}
            | Instr::ForkJoin { .. }
            | Instr::ForkLeave { .. } => self.task(state, instr),
            Instr::Return {} => self.leave(state),
            Instr::Halt {} => {
                self.ended.push(state.world);
                None
            }
            _ => match instr.jump_target() {
                Some(target) => {
                    let is_taken = self.is_taken(&state, instr, operands);
                    self.part(state, is_taken, target)
                }
                None => self.act_in_turn(state, instr, operands),
            },
        }
    }

    /// Go on at the next instruction.
    pub(crate) fn pass(&mut self, mut state: State) -> Option<State> {
        state.pc += 1;
        Some(state)
    }

    /// A state for another way.
    pub(crate) fn copy(&mut self, state: &State) -> State {
        self.work += state.size() / WORDS;
        state.clone()
    }

    /// Come to a place where ways meet.
    pub(crate) fn meet(&mut self, state: State) -> Option<State> {
        self.work += state.size() / WORDS;
        self.seen.meet(state, self.worlds.nothing_known(), &mut self.trace)
    }

    /// Whether a jump is taken.
    fn is_taken(&mut self, state: &State, instr: Instr, operands: &[Word]) -> Word {
        let operand = |at: usize| operands.get(at).copied().flatten();
        let mut not =
            |instr, a, b| self.values.binary(instr, a, b).map(|word| u64::from(word == 0));
        let immediate = |value: i16| Some(i64::from(value).cast_unsigned());
        match instr {
            Instr::Jump { .. } => Some(1),
            Instr::JumpIf { .. } => operand(0),
            Instr::JumpUnless { .. } => operand(0).map(|word| u64::from(word == 0)),
            Instr::JumpUnlessLt { .. } => not(Instr::IntLt {}, operand(0), operand(1)),
            Instr::JumpUnlessLe { .. } => not(Instr::IntLe {}, operand(0), operand(1)),
            Instr::JumpUnlessEq { .. } => not(Instr::IntEq {}, operand(0), operand(1)),
            Instr::JumpUnlessNe { .. } => not(Instr::IntNe {}, operand(0), operand(1)),
            Instr::JumpUnlessEqImmediate { value, .. } => {
                not(Instr::IntEq {}, operand(0), immediate(value))
            }
            Instr::JumpUnlessLocalLtImmediate { local, value, .. } => {
                not(Instr::IntLt {}, state.frame().locals[local.index()], immediate(value))
            }
            Instr::JumpUnlessLocalLtLocal { left, right, .. } => {
                let locals = &state.frame().locals;
                not(Instr::IntLt {}, locals[left.index()], locals[right.index()])
            }
            // A jump that this check does not know may go either way.
            _ => None,
        }
    }

    /// Go on beside a jump, at its target, or at both.
    fn part(&mut self, mut state: State, is_taken: Word, target: Label) -> Option<State> {
        match is_taken {
            Some(0) => self.pass(state),
            Some(_) => self.land(state, target),
            None => {
                state.is_certain = false;
                let jumping = self.copy(&state);
                if let Some(landed) = self.land(jumping, target) {
                    self.open.push(landed);
                }
                self.pass(state)
            }
        }
    }

    /// Land on the join that a jump names.
    fn land(&mut self, mut state: State, target: Label) -> Option<State> {
        let join = self.values.module.code[target.index()];
        state.pc = target.index();
        if let Instr::JoinAssert { .. } = join {
            match self.values.operands(&state, target.index()) {
                Ok(operands) if operands.first() == Some(&Some(0)) => return None,
                Ok(_) => {}
                Err(Trapped) => return None,
            }
        }
        state.pc += 1;
        match join {
            Instr::Land { .. } => Some(state),
            _ => self.meet(state),
        }
    }

    fn enter_loop(
        &mut self,
        mut state: State,
        counter: CounterId,
        exit: Label,
        operands: &[Word],
    ) -> Option<State> {
        let operand = |at: usize| operands.get(at).copied().flatten();
        let (first, last) = (operand(0), operand(1));
        state.frame_mut().counters[counter.index()] = [first, last, first];
        let is_empty = self.values.binary(Instr::IntLt {}, last, first);
        self.part(state, is_empty, exit)
    }

    fn next_round(&mut self, mut state: State, counter: CounterId, target: Label) -> Option<State> {
        let [_, last, present] = state.frame().counters[counter.index()];
        let goes_round = self.values.binary(Instr::IntNe {}, present, last);
        let next = self.values.binary(Instr::IntAdd {}, present, Some(1));
        state.frame_mut().counters[counter.index()][2] = next;
        self.part(state, goes_round, target)
    }

    fn call(&mut self, mut state: State, function: FunctionId, operands: &[Word]) -> Option<State> {
        let is_it = |frame: &&Frame| frame.function == function.index();
        let under_way = state.frames.iter().filter(is_it).count();
        let is_too_deep = state.all_frames().count() >= MAX_CALLS
            || !state.is_certain && under_way >= MAX_UNCERTAIN_RECURSION;
        if is_too_deep {
            if !state.forks.is_empty() {
                return self.lose_turns(state);
            }
            let function = &self.values.module.functions[function.index()];
            let state = self.leave_unfollowed(state, function.first..function.end);
            return self.pass(state);
        }
        let declared = &self.values.module.functions[function.index()];
        let mut frame = Frame::new(function.index(), declared, state.pc + 1);
        for (local, operand) in frame.locals.iter_mut().zip(operands) {
            *local = *operand;
        }
        state.frames.push(frame);
        state.pc = declared.first as usize + 1;
        self.meet(state)
    }

    /// Some code, and all that it calls, is run from where nobody knows, and leads nobody knows
    /// where.
    pub(crate) fn leave_unfollowed(&mut self, mut state: State, code: Range<u32>) -> State {
        let restores = self.note_unfollowed(code, state.is_planned);
        let before = state.world;
        state.forget_effects(self.worlds.nothing_known());
        let (deed, after) = (Deed::Unfollowed { restores }, state.world);
        let from = vec![state.last];
        state.last = self.trace.add(Node { deed, before, after, from });
        state
    }

    /// Note it of every move there, once; whether going back over it leads to where it began.
    fn note_unfollowed(&mut self, code: Range<u32>, is_planned: bool) -> bool {
        let key = (code.start, is_planned);
        if let Some(&restores) = self.unfollowed.get(&key) {
            return restores;
        }
        let unknown = Rc::new(Verdict::new(Reason::DeepCalls));
        let calls: Rc<[u32]> = Rc::new([]);
        let mut restores = true;
        for (pc, instr) in with_calls(self.values.module, code) {
            restores &= !matches!(
                instr,
                Instr::BlockSkip { .. } | Instr::BlockReplace { .. } | Instr::MoveAlways { .. }
            );
            if instr.info().family == Family::Kinematic {
                for direction in [Direction::Forward, Direction::Reverse] {
                    self.notes.add(pc, direction, &unknown, &calls, is_planned);
                }
            }
        }
        self.unfollowed.insert(key, restores);
        restores
    }

    fn leave(&mut self, mut state: State) -> Option<State> {
        let left = state.frames.pop()?;
        if state.frames.is_empty() {
            self.ended.push(state.world);
            return None;
        }
        state.pc = left.return_pc;
        self.meet(state)
    }
}

/// Some code and that of all functions that it may call, or run in reverse.
fn with_calls(module: &Module, code: Range<u32>) -> Vec<(u32, Instr)> {
    let mut called: HashSet<FunctionId> = HashSet::new();
    let (mut open, mut all) = (vec![code], Vec::new());
    while let Some(code) = open.pop() {
        for pc in code {
            let instr = module.code[pc as usize];
            all.push((pc, instr));
            if let Instr::Call { function, .. } | Instr::BlockReplace { function, .. } = instr
                && called.insert(function)
            {
                let function = &module.functions[function.index()];
                open.push(function.first..function.end);
            }
        }
    }
    all
}
