//! What functions do to those who call them: which errors they leave to be responded to, whether
//! they make their callers leave, whether they pass a barrier.
//!
//! Linear in the program: an error that is for the caller goes up one call, and that the program
//! is being left goes up as one truth.

use crate::faults::{Act, Faults, act_of};
use crate::response::{Response, is_for_caller, response, urgency};
use crate::tree::{Block, Body, Function, Program, Statement, StatementKind};
use obverse_bytecode::{ErrorDeclaration, FunctionKind};
use obverse_isa::{ErrorId, FunctionId, ReasonId, Setting};
use obverse_syntax::span::Span;
use std::collections::HashSet;

/// What is known of all functions. The start, function 0, has no effects.
#[derive(Debug)]
pub(crate) struct Effects {
    /// By error: what is done about it.
    responses: Vec<Response>,
    /// The errors that the workcell raises.
    faults: Faults,
    /// By function.
    functions: Vec<Effect>,
    /// By function: whether it may be run while an error is being recovered from.
    in_recovery: Vec<bool>,
    /// By error: whether it may be raised while one is being recovered from.
    raised_in_recovery: Vec<bool>,
}

/// What is known of a function.
#[derive(Clone, Debug, Default)]
struct Effect {
    /// The errors that its caller responds to.
    for_caller: Vec<ErrorId>,
    /// The errors that it responds to itself.
    own: Vec<ErrorId>,
    /// Those of both that are thrown, by it or by an advanced move of it, not by the workcell.
    thrown: Vec<ErrorId>,
    /// What it calls, and where.
    calls: Vec<(FunctionId, Span)>,
    /// What it does to its callers, itself or by a call.
    carried: Carried,
}

/// What goes up from callees to their callers, and from statements to what they are in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Carried {
    /// Whether it may make the caller leave.
    leaves: bool,
    /// Whether it may do so even if the workcell does as commanded.
    fails: bool,
    /// Where a barrier is passed.
    barrier: Option<Span>,
    /// Why a block of it cannot be taken back.
    pub(crate) irreversible: Option<ReasonId>,
    /// By setting: whether it is another one meanwhile.
    pub(crate) sets: [bool; Setting::ALL.len()],
}

impl Carried {
    /// This and the other.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            leaves: self.leaves || other.leaves,
            fails: self.fails || other.fails,
            barrier: self.barrier.or(other.barrier),
            irreversible: self.irreversible.or(other.irreversible),
            sets: std::array::from_fn(|at| self.sets[at] || other.sets[at]),
        }
    }

    fn of_setting(setting: Setting) -> Self {
        let mut carried = Self::default();
        carried.sets[setting as usize] = true;
        carried
    }
}

impl Effects {
    /// Those of a program.
    pub(crate) fn of(program: &Program) -> Self {
        let errors = &program.module.errors;
        let mut effects = Self {
            responses: errors.iter().map(response).collect(),
            faults: Faults::of(errors),
            functions: vec![Effect::default(); program.functions.len() + 1],
            in_recovery: Vec::new(),
            raised_in_recovery: vec![false; errors.len()],
        };
        let for_caller: Vec<bool> = errors.iter().map(is_for_caller).collect();
        let is_part = |function: &Function| {
            function.kind == FunctionKind::Io || matches!(function.body, Body::Guarded(_))
        };
        for (id, function) in program.numbered().filter(|(_, function)| is_part(function)) {
            effects.functions[id.index()] = effects.of_part(function);
        }
        for (id, function) in program.numbered().filter(|(_, function)| !is_part(function)) {
            if let Body::Block(block) = &function.body {
                effects.functions[id.index()] = effects.of_block(program, block, &for_caller);
            }
        }
        effects.spread();
        effects.in_recovery = effects.reached_from_recoveries();
        for (effect, _) in effects.functions.iter().zip(&effects.in_recovery).filter(|(_, is)| **is)
        {
            for error in effect.own.iter().chain(&effect.for_caller) {
                effects.raised_in_recovery[error.index()] = true;
            }
        }
        effects
    }

    /// What an advanced move or an I/O operation does: it leaves all errors to be responded to.
    fn of_part(&self, function: &Function) -> Effect {
        let mut effect = Effect::default();
        match &function.body {
            Body::Guarded(guarded) => {
                effect.thrown = distinct(guarded.throws().map(|(error, _)| error).collect());
                effect.for_caller.extend(&effect.thrown);
                effect.for_caller.extend(self.faults.raised_by(Act::Motion));
                if guarded.speed.is_some() {
                    effect.carried = Carried::of_setting(Setting::Speed);
                }
            }
            Body::Block(block) => block.each_statement(&mut |statement| {
                effect.for_caller.extend(self.raised_by_act(&statement.kind));
            }),
        }
        effect.for_caller = distinct(effect.for_caller);
        effect
    }

    /// What a block does that its own calls do not: those are followed later.
    fn of_block(&self, program: &Program, block: &Block, for_caller: &[bool]) -> Effect {
        let mut effect = Effect::default();
        let mut raised = Vec::new();
        self.raised_in(program, block, &mut raised);
        block.each_statement(&mut |statement| {
            effect.carried = effect.carried.and(self.carried_by(statement));
            match &statement.kind {
                StatementKind::Throw(error) | StatementKind::Requires(_, error) => {
                    effect.thrown.push(*error);
                }
                StatementKind::Advance(guarded, _) => {
                    effect.thrown.extend(&self.functions[guarded.index()].thrown);
                }
                StatementKind::Call(callee, _) | StatementKind::Kept(callee) => {
                    effect.calls.push((*callee, statement.span));
                }
                _ => {}
            }
        });
        effect.thrown = distinct(effect.thrown);
        let is_for_caller = |error: &ErrorId| for_caller[error.index()];
        (effect.for_caller, effect.own) = distinct(raised).into_iter().partition(is_for_caller);
        effect
    }

    /// The errors that the statements of a block raise but for its calls. What keeps its order in
    /// reverse stands here as well; the grammar bounds how deep.
    fn raised_in(&self, program: &Program, block: &Block, raised: &mut Vec<ErrorId>) {
        block.each_statement(&mut |statement| match &statement.kind {
            StatementKind::Throw(error) | StatementKind::Requires(_, error) => raised.push(*error),
            StatementKind::Advance(part, _) | StatementKind::Io(part, _) => {
                raised.extend(&self.functions[part.index()].for_caller);
            }
            StatementKind::Kept(function) => {
                if let Body::Block(kept) = &program.function(*function).body {
                    self.raised_in(program, kept, raised);
                }
            }
            kind => raised.extend(self.raised_by_act(kind)),
        });
    }

    /// The errors that a statement's own act may raise.
    pub(crate) fn raised_by_act(&self, kind: &StatementKind) -> &[ErrorId] {
        act_of(kind).map_or(&[], |act| self.faults.raised_by(act))
    }

    /// The errors that a motion may raise.
    pub(crate) fn raised_by_motion(&self) -> &[ErrorId] {
        self.faults.raised_by(Act::Motion)
    }

    /// What a statement does without those in its blocks, and without calls of sequences.
    fn carried_by(&self, statement: &Statement) -> Carried {
        match &statement.kind {
            StatementKind::Advance(guarded, _) => self.functions[guarded.index()].carried,
            StatementKind::Barrier(_) => {
                Carried { barrier: Some(statement.span), ..Carried::default() }
            }
            StatementKind::Irreversible(reason, _) => Carried {
                barrier: Some(statement.span),
                irreversible: Some(*reason),
                ..Carried::default()
            },
            StatementKind::Set(value) | StatementKind::SetFor { value, .. } => {
                Carried::of_setting(value.setting())
            }
            _ => Carried::default(),
        }
    }

    /// What a block does, itself or by a call.
    pub(crate) fn of_statements(&self, block: &Block) -> Carried {
        let mut carried = Carried::default();
        block.each_statement(&mut |statement| {
            carried = carried.and(match &statement.kind {
                StatementKind::Call(callee, _) | StatementKind::Kept(callee) => {
                    self.functions[callee.index()].carried
                }
                _ => self.carried_by(statement),
            });
        });
        carried
    }

    /// Carry what goes up from callees to their callers.
    fn spread(&mut self) {
        let mut callers = vec![Vec::new(); self.functions.len()];
        for (index, effect) in self.functions.iter().enumerate() {
            for (callee, _) in &effect.calls {
                callers[callee.index()].push(index);
            }
        }
        let mut changed = Vec::new();
        for index in 0..self.functions.len() {
            let effect = &self.functions[index];
            let callees = effect.calls.iter().map(|(callee, _)| &self.functions[callee.index()]);
            let from_callees = callees.flat_map(|callee| &callee.for_caller);
            let may_leave =
                effect.own.iter().chain(from_callees).any(|error| self.may_leave(*error));
            let fails = may_leave && self.fails_by_itself(effect);
            let carried = &mut self.functions[index].carried;
            (carried.leaves, carried.fails) = (may_leave, fails);
            if *carried != Carried::default() {
                changed.push(index);
            }
        }
        while let Some(callee) = changed.pop() {
            let carried = self.functions[callee].carried;
            for &caller in &callers[callee] {
                let known = &mut self.functions[caller].carried;
                let both = known.and(carried);
                if std::mem::replace(known, both) != both {
                    changed.push(caller);
                }
            }
        }
    }

    /// Whether an error that is thrown may make a function leave.
    fn fails_by_itself(&self, effect: &Effect) -> bool {
        let leaves_for = |error: &&ErrorId| self.may_leave(**error);
        let mut own = effect.own.iter().filter(leaves_for);
        let callees = effect.calls.iter().map(|(callee, _)| &self.functions[callee.index()]);
        let mut from_callees = callees.flat_map(|callee| {
            let is_thrown = |error: &&ErrorId| callee.thrown.binary_search(error).is_ok();
            callee.for_caller.iter().filter(leaves_for).filter(is_thrown)
        });
        own.any(|error| effect.thrown.binary_search(error).is_ok()) || from_callees.next().is_some()
    }

    fn reached_from_recoveries(&self) -> Vec<bool> {
        let mut reached = vec![false; self.functions.len()];
        let mut to_visit: Vec<FunctionId> = self.responses.iter().filter_map(using).collect();
        while let Some(function) = to_visit.pop() {
            if !std::mem::replace(&mut reached[function.index()], true) {
                let calls = &self.functions[function.index()].calls;
                to_visit.extend(calls.iter().map(|(callee, _)| *callee));
            }
        }
        reached
    }

    fn may_leave(&self, error: ErrorId) -> bool {
        self.responses[error.index()] != Response::Ignore
    }

    /// What is done about an error.
    pub(crate) fn response(&self, error: ErrorId) -> Response {
        self.responses[error.index()]
    }

    /// Whether an error may be raised while one is being recovered from.
    pub(crate) fn is_raised_in_recovery(&self, error: ErrorId) -> bool {
        self.raised_in_recovery[error.index()]
    }

    /// The errors that a call of a function leaves to be responded to.
    pub(crate) fn left_by(&self, function: FunctionId) -> &[ErrorId] {
        &self.functions[function.index()].for_caller
    }

    /// The errors that are responded to after a statement; `declared` are those of the program.
    pub(crate) fn due(&self, kind: &StatementKind, declared: &[ErrorDeclaration]) -> Vec<ErrorId> {
        let is_own = |error: &ErrorId| !is_for_caller(&declared[error.index()]);
        let mut due: Vec<ErrorId> = match kind {
            StatementKind::Throw(error) | StatementKind::Requires(_, error) => {
                Some(*error).filter(is_own).into_iter().collect()
            }
            StatementKind::Advance(part, _) | StatementKind::Io(part, _) => {
                self.left_by(*part).iter().copied().filter(is_own).collect()
            }
            StatementKind::Call(callee, _) => self.left_by(*callee).to_vec(),
            kind => self.raised_by_act(kind).iter().copied().filter(is_own).collect(),
        };
        due.sort_by_key(|error| urgency(&declared[error.index()]));
        due
    }

    /// Whether a function may make its caller leave.
    pub(crate) fn leaves(&self, function: FunctionId) -> bool {
        self.functions[function.index()].carried.leaves
    }

    /// Where a function passes a barrier.
    pub(crate) fn barrier(&self, function: FunctionId) -> Option<Span> {
        self.functions[function.index()].carried.barrier
    }

    /// What a function calls, and where.
    pub(crate) fn calls(&self, function: FunctionId) -> &[(FunctionId, Span)] {
        &self.functions[function.index()].calls
    }

    /// Whether a function, or what it calls, may raise an error that is not just noted there, even
    /// if the workcell does as commanded.
    pub(crate) fn may_fail(&self, function: FunctionId) -> bool {
        let effect = &self.functions[function.index()];
        effect.carried.fails || !effect.thrown.is_empty()
    }

    /// The errors that may be raised while a function is run, in what it calls and in the
    /// recoveries from them.
    pub(crate) fn raised_within(&self, function: FunctionId) -> Vec<ErrorId> {
        let mut seen = HashSet::from([function]);
        let mut to_visit = vec![function];
        let mut raised = Vec::new();
        while let Some(function) = to_visit.pop() {
            let effect = &self.functions[function.index()];
            raised.extend(effect.own.iter().chain(&effect.for_caller));
            let here = effect.own.iter().chain(&effect.for_caller);
            let recoveries = here.filter_map(|error| using(&self.responses[error.index()]));
            let callees = effect.calls.iter().map(|(callee, _)| *callee).chain(recoveries);
            to_visit.extend(callees.filter(|callee| seen.insert(*callee)));
        }
        distinct(raised)
    }

    /// Whether any function may make its caller leave.
    pub(crate) fn any_leaves(&self) -> bool {
        self.functions.iter().any(|effect| effect.carried.leaves)
            || self.functions.iter().any(|effect| !effect.for_caller.is_empty())
    }

    /// Whether a function may be run during a recovery and would begin another one.
    pub(crate) fn recovers_in_recovery(&self, function: FunctionId) -> bool {
        let effect = &self.functions[function.index()];
        let callees = effect.calls.iter().flat_map(|(callee, _)| self.left_by(*callee));
        self.in_recovery[function.index()]
            && effect
                .own
                .iter()
                .chain(callees)
                .any(|error| matches!(self.responses[error.index()], Response::Recover { .. }))
    }
}

fn using(response: &Response) -> Option<FunctionId> {
    match response {
        Response::Recover { using, .. } => *using,
        Response::Ignore | Response::Stop => None,
    }
}

/// Each once, in the order of their declaration.
fn distinct(mut errors: Vec<ErrorId>) -> Vec<ErrorId> {
    errors.sort_unstable();
    errors.dedup();
    errors
}
