//! What functions and blocks use themselves: devices, variables, and whom they call.
//!
//! Each use and each call is kept once, where it comes first. A recovery that an error of a
//! statement is responded to with, and what is run in reverse in the place of something, count as
//! called there.

use crate::effects::Effects;
use crate::response::Response;
use crate::tree::{
    Block, Body, Expression, ExpressionKind, GuardedMove, Hoist, Motion, Place, Prepared, Program,
    Statement, StatementKind,
};
use obverse_isa::{FunctionId, GlobalId, Instr, LocalId};
use obverse_syntax::span::Span;
use std::collections::{BTreeMap, HashSet};

/// Something that a program uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Resource {
    /// The arm with its settings and readings.
    Arm,
    /// The random numbers.
    Dice,
    /// An output.
    Output(u16),
    /// A variable of the program.
    Global(GlobalId),
    /// A variable of the function.
    Local(LocalId),
}

impl Resource {
    /// Whether it is of one call of one function.
    pub(crate) fn is_local(self) -> bool {
        matches!(self, Self::Local(_))
    }
}

/// In which way it is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum How {
    /// A device is commanded, or a reading of it taken that its commands change.
    Commands,
    /// A variable is assigned.
    Writes,
    /// A variable is read.
    Reads,
}

impl How {
    /// As a verb.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Commands => "uses",
            Self::Writes => "assigns",
            Self::Reads => "reads",
        }
    }
}

/// A call, and what it is in words.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    /// What is called.
    pub(crate) callee: FunctionId,
    /// Where.
    pub(crate) span: Span,
    /// `calls`, and the like.
    pub(crate) word: &'static str,
}

/// What is said of a call that is made going back.
const TAKES_BACK: &str = "takes this back by";

/// What a function or block uses itself.
#[derive(Debug, Default)]
pub(crate) struct Uses {
    /// What is used, and where first.
    pub(crate) uses: BTreeMap<(Resource, How), Span>,
    /// What is called, in the order of the first calls.
    pub(crate) calls: Vec<Edge>,
    called: HashSet<FunctionId>,
}

/// What each function of a program uses itself, the start left out: function n is at n - 1.
pub(crate) fn of_functions(program: &Program, effects: &Effects) -> Vec<Uses> {
    let functions = program.numbered().map(|(_, function)| match &function.body {
        Body::Block(block) => Uses::of_block(block, program, effects),
        Body::Guarded(guarded) => Uses::of_guarded(guarded),
    });
    functions.collect()
}

impl Uses {
    /// Those of a block.
    pub(crate) fn of_block(block: &Block, program: &Program, effects: &Effects) -> Self {
        let mut uses = Self::default();
        uses.block(block, program, effects);
        uses
    }

    fn block(&mut self, block: &Block, program: &Program, effects: &Effects) {
        block.each_statement(&mut |statement| {
            self.statement(statement);
            // What keeps its order stands here too, in this frame.
            if let StatementKind::Kept(function) = &statement.kind
                && let Body::Block(kept) = &program.function(*function).body
            {
                self.block(kept, program, effects);
            }
            for error in effects.due(&statement.kind, &program.module.errors) {
                if let Response::Recover { using: Some(callee), .. } = effects.response(error) {
                    self.call(callee, "recovers using", statement.span);
                }
            }
        });
    }

    fn of_guarded(guarded: &GuardedMove) -> Self {
        let mut uses = Self::default();
        uses.add(Resource::Arm, How::Commands, guarded.spans.motion);
        let GuardedMove { requires, distance, limit, succeeds, repeat, .. } = guarded;
        requires.iter().for_each(|(condition, _)| uses.prepared(condition));
        uses.prepared(distance);
        limit.iter().for_each(|limit| uses.prepared(limit));
        uses.prepared(succeeds);
        if let Some(retry) = repeat {
            uses.add(Resource::Dice, How::Commands, retry.span);
            uses.prepared(&retry.within);
        }
        uses
    }

    fn add(&mut self, resource: Resource, how: How, span: Span) {
        self.uses.entry((resource, how)).or_insert(span);
    }

    fn call(&mut self, callee: FunctionId, word: &'static str, span: Span) {
        if self.called.insert(callee) {
            self.calls.push(Edge { callee, span, word });
        }
    }

    /// A statement without those in its blocks.
    fn statement(&mut self, statement: &Statement) {
        self.hoists(&statement.hoists, statement.span);
        let span = statement.span;
        match &statement.kind {
            StatementKind::Move(motion) => {
                self.add(Resource::Arm, How::Commands, span);
                self.motion(motion);
            }
            StatementKind::Remember(_) | StatementKind::Set(_) | StatementKind::SetFor { .. } => {
                self.add(Resource::Arm, How::Commands, span);
            }
            StatementKind::Output { bit, settle, .. } => {
                self.add(Resource::Output(bit.0), How::Commands, span);
                self.expression(settle);
            }
            StatementKind::Store(place, value) | StatementKind::Update { place, value, .. } => {
                self.add(resource(*place), How::Writes, span);
                self.expression(value);
            }
            StatementKind::Advance(callee, counterpart) => {
                self.call(*callee, "advances", span);
                counterpart.iter().for_each(|callee| self.call(*callee, TAKES_BACK, span));
            }
            StatementKind::Io(callee, counterpart) => {
                self.call(*callee, "does", span);
                counterpart.iter().for_each(|callee| self.call(*callee, TAKES_BACK, span));
            }
            StatementKind::Reversed(_, Some(callee)) => self.call(*callee, TAKES_BACK, span),
            StatementKind::Call(callee, arguments) => {
                self.call(*callee, "calls", span);
                arguments.iter().for_each(|argument| self.expression(argument));
            }
            _ => self.control(&statement.kind),
        }
    }

    /// What branches, loops and waits read.
    fn control(&mut self, kind: &StatementKind) {
        match kind {
            StatementKind::Wait(time) => self.expression(time),
            StatementKind::Requires(condition, _) | StatementKind::Demand(condition, _) => {
                self.expression(condition);
            }
            StatementKind::WaitInput { timeout, .. } => self.expression(timeout),
            StatementKind::If { condition, ending_when, .. } => {
                self.expression(condition);
                ending_when.iter().for_each(|assertion| self.expression(assertion));
            }
            StatementKind::While { condition, entered_when, .. } => {
                self.prepared(condition);
                entered_when.iter().for_each(|assertion| self.expression(assertion));
            }
            StatementKind::For { first, last, .. } => {
                self.expression(first);
                self.expression(last);
            }
            _ => {}
        }
    }

    fn motion(&mut self, motion: &Motion) {
        match motion {
            Motion::Joints(value, _)
            | Motion::Keyframe(value, ..)
            | Motion::Relative(value, ..) => self.expression(value),
            Motion::Always(..) | Motion::Position(..) => {}
        }
    }

    fn prepared(&mut self, prepared: &Prepared) {
        self.hoists(&prepared.hoists, prepared.value.span);
        self.expression(&prepared.value);
    }

    fn hoists(&mut self, hoists: &[Hoist], span: Span) {
        for hoist in hoists {
            match hoist {
                Hoist::Store { value, .. } => self.expression(value),
                Hoist::Read(Instr::Draw { .. }) => self.add(Resource::Dice, How::Commands, span),
                Hoist::Read(Instr::SenseInput { .. }) => {}
                Hoist::Read(_) => self.add(Resource::Arm, How::Commands, span),
            }
        }
    }

    fn expression(&mut self, expression: &Expression) {
        let span = expression.span;
        match &expression.kind {
            ExpressionKind::Local(local) => self.add(Resource::Local(*local), How::Reads, span),
            ExpressionKind::Global(global) => self.add(Resource::Global(*global), How::Reads, span),
            ExpressionKind::Unary(_, operand) => self.expression(operand),
            ExpressionKind::Binary(_, operands) => {
                self.expression(&operands.0);
                self.expression(&operands.1);
            }
            _ => {}
        }
    }
}

fn resource(place: Place) -> Resource {
    match place {
        Place::Local(local) => Resource::Local(local),
        Place::Global(global) => Resource::Global(global),
    }
}
