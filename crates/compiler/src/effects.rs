//! What functions do to those who call them: which errors they leave to be responded to, whether
//! they make their callers leave, whether they pass a barrier.
//!
//! Linear in the program: an error that is for the caller goes up one call, and that the program
//! is being left goes up as one truth.

use crate::response::{Response, is_for_caller, response};
use crate::tree::{Block, Body, Program, Statement, StatementKind};
use obverse_bytecode::ErrorDeclaration;
use obverse_isa::{ErrorId, FunctionId, ReasonId, Setting};
use obverse_syntax::span::Span;

/// What is known of all functions. The start, function 0, has no effects.
#[derive(Debug)]
pub(crate) struct Effects {
    /// By error: what is done about it.
    responses: Vec<Response>,
    /// By function.
    functions: Vec<Effect>,
    /// By function: whether it may be run while an error is being recovered from.
    in_recovery: Vec<bool>,
}

/// What is known of a function.
#[derive(Clone, Debug, Default)]
struct Effect {
    /// The errors that its caller responds to.
    for_caller: Vec<ErrorId>,
    /// The errors that it responds to itself.
    own: Vec<ErrorId>,
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
            functions: vec![Effect::default(); program.functions.len() + 1],
            in_recovery: Vec::new(),
        };
        let for_caller: Vec<bool> = errors.iter().map(is_for_caller).collect();
        for (id, function) in program.numbered() {
            if let Body::Guarded(guarded) = &function.body {
                let thrown = [guarded.on_success.throws, guarded.on_failure.throws];
                let thrown = thrown.into_iter().flatten().map(|(error, _)| error);
                let effect = &mut effects.functions[id.index()];
                effect.for_caller = distinct(thrown.collect());
                if guarded.speed.is_some() {
                    effect.carried = Carried::of_setting(Setting::Speed);
                }
            }
        }
        for (id, function) in program.numbered() {
            if let Body::Block(block) = &function.body {
                effects.functions[id.index()] = effects.of_block(block, &for_caller);
            }
        }
        effects.spread();
        effects.in_recovery = effects.reached_from_recoveries();
        effects
    }

    /// What a block does that its own calls do not: those are followed later.
    fn of_block(&self, block: &Block, for_caller: &[bool]) -> Effect {
        let mut effect = Effect::default();
        block.each_statement(&mut |statement| {
            effect.carried = effect.carried.and(self.carried_by(statement));
            match &statement.kind {
                StatementKind::Throw(error) => effect.raise(*error, for_caller),
                StatementKind::Kept(block) => effect.calls.push((*block, statement.span)),
                StatementKind::Advance(guarded, _) => {
                    for error in &self.functions[guarded.index()].for_caller {
                        effect.raise(*error, for_caller);
                    }
                }
                StatementKind::Call(callee, _) => effect.calls.push((*callee, statement.span)),
                _ => {}
            }
        });
        effect.own = distinct(std::mem::take(&mut effect.own));
        effect.for_caller = distinct(std::mem::take(&mut effect.for_caller));
        effect
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
            let carried = &mut self.functions[index].carried;
            carried.leaves = may_leave;
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

    /// The errors that a call of a function leaves to be responded to.
    pub(crate) fn left_by(&self, function: FunctionId) -> &[ErrorId] {
        &self.functions[function.index()].for_caller
    }

    /// The errors that are responded to after a statement; `declared` are those of the program.
    pub(crate) fn due(&self, kind: &StatementKind, declared: &[ErrorDeclaration]) -> Vec<ErrorId> {
        let is_own = |error: &ErrorId| !is_for_caller(&declared[error.index()]);
        match kind {
            StatementKind::Throw(error) => Some(*error).filter(is_own).into_iter().collect(),
            StatementKind::Advance(guarded, _) => {
                self.left_by(*guarded).iter().copied().filter(is_own).collect()
            }
            StatementKind::Call(callee, _) => self.left_by(*callee).to_vec(),
            _ => Vec::new(),
        }
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

    /// Whether a function, or what it calls, may raise an error that is not just noted there.
    pub(crate) fn may_fail(&self, function: FunctionId) -> bool {
        let effect = &self.functions[function.index()];
        effect.carried.leaves || !effect.own.is_empty() || !effect.for_caller.is_empty()
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

impl Effect {
    fn raise(&mut self, error: ErrorId, for_caller: &[bool]) {
        match for_caller[error.index()] {
            true => self.for_caller.push(error),
            false => self.own.push(error),
        }
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
