//! The names of statements and expressions, in the scopes of their blocks. What declarations give
//! is `walk`'s.

use super::walk::Walk;
use super::{Role, SymbolKind};
use crate::check::FUNCTIONS;
use obverse_syntax::ast::{
    Argument, Block, Expression, ExpressionKind, Name, Primitive, ReverseParameter, Signal,
    Statement, StatementKind, Target,
};
use obverse_syntax::span::{Span, Spanned};

impl<'s> Walk<'s> {
    /// The statements of a block, in a scope of their own.
    pub(super) fn block(&mut self, block: &Block<'s>) {
        let scope = self.scopes.open();
        block.statements.iter().for_each(|statement| self.statement(statement, block.span));
        self.scopes.close(&scope);
    }

    fn blocks<'b>(&mut self, blocks: impl IntoIterator<Item = &'b Block<'s>>)
    where
        's: 'b,
    {
        blocks.into_iter().for_each(|block| self.block(block));
    }

    /// A statement of a block; of control, see [`Walk::control`].
    fn statement(&mut self, statement: &Statement<'s>, block: Span) {
        let rest = Span::new(statement.span.end, block.end);
        match &statement.kind {
            StatementKind::Move { target, .. } => self.target(target),
            StatementKind::Advance(name) | StatementKind::Io(name) | StatementKind::Throw(name) => {
                self.uses([*name]);
            }
            StatementKind::Call { name, arguments } => self.call(*name, arguments),
            StatementKind::Wait(time) => self.expression(time),
            StatementKind::Primitive(primitive) => self.primitive(primitive),
            StatementKind::Variable(variable) => {
                self.first_value(variable);
                self.declare_within(variable.name, SymbolKind::Local, variable.span, rest);
            }
            StatementKind::Remember(name) => match self.scopes.find(name.value) {
                Some(known) if self.scopes.kind(known) == SymbolKind::Position => {
                    self.scopes.declare_again(known, name.span);
                }
                _ => self.declare_within(*name, SymbolKind::Position, statement.span, rest),
            },
            StatementKind::Assign { name, value, .. } => {
                self.expression(value);
                self.scopes.use_name(*name, Role::Assigns);
            }
            StatementKind::Tool { name, block } => {
                self.scopes.use_foreign(*name, SymbolKind::Tool);
                self.blocks(block);
            }
            StatementKind::Checkpoint(name) => {
                self.scopes.set_checkpoint(*name, statement.span, self.parent);
            }
            StatementKind::WithInReverse { parameters, block } => {
                for parameter in parameters {
                    if let ReverseParameter::ForceLimit(limit) = &parameter.value {
                        self.expression(limit);
                    }
                }
                self.block(block);
            }
            StatementKind::Requires { condition, error } => {
                self.expression(condition);
                self.uses([*error]);
            }
            _ => self.control(statement),
        }
    }

    /// Branches, loops, waits and blocks that are otherwise in reverse.
    fn control(&mut self, statement: &Statement<'s>) {
        match &statement.kind {
            StatementKind::WaitUntil { input, timeout, otherwise, .. } => {
                self.signal(*input);
                self.expression(timeout);
                self.blocks(otherwise);
            }
            StatementKind::If { condition, then, otherwise, ending_when } => {
                self.expression(condition);
                self.block(then);
                self.blocks(otherwise);
                ending_when.iter().for_each(|assertion| self.expression(assertion));
            }
            StatementKind::While { condition, entered_when, body } => {
                self.expression(condition);
                entered_when.iter().for_each(|assertion| self.expression(assertion));
                self.block(body);
            }
            StatementKind::Repeat { times, body } => {
                self.expression(times);
                self.block(body);
            }
            StatementKind::For { name, first, last, body, .. } => {
                self.expression(first);
                self.expression(last);
                let scope = self.scopes.open();
                let whole = Span::new(statement.span.start, last.span.end);
                self.declare_within(*name, SymbolKind::Counter, whole, body.span);
                self.block(body);
                self.scopes.close(&scope);
            }
            _ => self.blocks(statement.blocks()),
        }
    }

    fn target(&mut self, target: &Target<'s>) {
        match target {
            Target::Named(name) => self.uses([*name]),
            Target::Keyframe { item, keyframe } => {
                let item = self.scopes.use_name(*item, Role::Uses);
                self.scopes.use_keyframe(*keyframe, item);
            }
            Target::Relative { distance, .. } => self.expression(distance),
            Target::Turned(turn) => turn.amounts().for_each(|amount| self.expression(amount)),
        }
    }

    fn call(&mut self, name: Name<'s>, arguments: &[Argument<'s>]) {
        let callee = self.scopes.use_name(name, Role::Uses);
        for argument in arguments {
            if let Some(given) = argument.name {
                let parameters = callee.and_then(|callee| self.parameters.get(&callee));
                let known = parameters.into_iter().flatten().find(|(name, _)| *name == given.value);
                let symbol = known.map(|(_, symbol)| *symbol);
                self.scopes.note(given.span, symbol, Role::Uses);
            }
            self.expression(&argument.value);
        }
    }

    /// A primitive.
    pub(super) fn primitive(&mut self, primitive: &Primitive<'s>) {
        match primitive {
            Primitive::Set { bit, .. } | Primitive::Toggle { bit, .. } => self.signal(*bit),
            Primitive::Sleep { duration, .. } => self.expression(duration),
        }
    }

    pub(super) fn signal(&mut self, signal: Spanned<Signal<'s>>) {
        if let Signal::Name(name) = signal.value {
            self.uses([Spanned::new(name, signal.span)]);
        }
    }

    /// An expression. Recurses no deeper than one may be.
    pub(super) fn expression(&mut self, expression: &Expression<'s>) {
        match &expression.kind {
            ExpressionKind::Name(name) => {
                let name = self.placed(name, expression.span);
                self.uses([name]);
            }
            ExpressionKind::Unary { operand, .. } => self.expression(operand),
            ExpressionKind::Binary { left, right, .. } => {
                self.expression(left);
                self.expression(right);
            }
            ExpressionKind::Function { name, arguments } => {
                match FUNCTIONS.iter().any(|(known, _)| *known == name.value) {
                    true => self.scopes.use_foreign(*name, SymbolKind::Function),
                    false => self.scopes.note(name.span, None, Role::Uses),
                }
                arguments.iter().for_each(|argument| self.expression(argument));
            }
            ExpressionKind::Input(signal) => self.signal(*signal),
            ExpressionKind::Integer(_)
            | ExpressionKind::Real(_)
            | ExpressionKind::Quantity { .. }
            | ExpressionKind::Boolean(_)
            | ExpressionKind::Force
            | ExpressionKind::Distance
            | ExpressionKind::Holding
            | ExpressionKind::Missing => {}
        }
    }
}
