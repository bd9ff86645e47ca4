//! Expressions and vectors as pieces.

use super::piece::Glue;
use super::writer::Writer;
use crate::ast::{BinaryOperator, Expression, ExpressionKind, UnaryOperator, Vector};

/// How tightly operators bind, as the grammar has it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Or,
    And,
    Not,
    Comparison,
    Sum,
    Product,
    Sign,
    Primary,
}

impl Level {
    /// The next tighter one.
    fn above(self) -> Self {
        match self {
            Self::Or => Self::And,
            Self::And => Self::Not,
            Self::Not => Self::Comparison,
            Self::Comparison => Self::Sum,
            Self::Sum => Self::Product,
            Self::Product => Self::Sign,
            Self::Sign | Self::Primary => Self::Primary,
        }
    }

    fn of(operator: BinaryOperator) -> Self {
        use BinaryOperator::*;
        match operator {
            Or => Self::Or,
            And => Self::And,
            Less | LessOrEqual | Greater | GreaterOrEqual | Equal | NotEqual => Self::Comparison,
            Add | Subtract => Self::Sum,
            Multiply | Divide | Remainder => Self::Product,
        }
    }

    fn of_expression(kind: &ExpressionKind<'_>) -> Self {
        match kind {
            ExpressionKind::Binary { operator, .. } => Self::of(*operator),
            ExpressionKind::Unary { operator: UnaryOperator::Not, .. } => Self::Not,
            ExpressionKind::Unary { operator: UnaryOperator::Negate, .. } => Self::Sign,
            ExpressionKind::Integer(_)
            | ExpressionKind::Real(_)
            | ExpressionKind::Quantity { .. }
            | ExpressionKind::Boolean(_)
            | ExpressionKind::Name(_)
            | ExpressionKind::Function { .. }
            | ExpressionKind::Input(_)
            | ExpressionKind::Force
            | ExpressionKind::Distance
            | ExpressionKind::Holding
            | ExpressionKind::Missing => Self::Primary,
        }
    }
}

fn sign(operator: BinaryOperator) -> &'static str {
    match operator {
        BinaryOperator::Add => "+",
        BinaryOperator::Subtract => "-",
        BinaryOperator::Multiply => "*",
        BinaryOperator::Divide => "/",
        BinaryOperator::Remainder => "mod",
        BinaryOperator::Less => "<",
        BinaryOperator::LessOrEqual => "<=",
        BinaryOperator::Greater => ">",
        BinaryOperator::GreaterOrEqual => ">=",
        BinaryOperator::Equal => "==",
        BinaryOperator::NotEqual => "!=",
        BinaryOperator::And => "and",
        BinaryOperator::Or => "or",
    }
}

impl<'s> Writer<'s> {
    /// An expression where any may stand.
    pub(super) fn expression(&mut self, expression: &Expression<'s>) {
        self.nested(|writer| writer.operand(expression, Level::Or));
    }

    /// One where no sum may stand: a distance before a direction.
    pub(super) fn product(&mut self, expression: &Expression<'s>) {
        self.nested(|writer| writer.operand(expression, Level::Product));
    }

    /// Elements in brackets, with their unit.
    pub(super) fn vector(&mut self, vector: &Vector<'s>) {
        self.list(["[", "]"], &vector.elements, Self::expression);
        if let Some(unit) = vector.unit {
            self.text(unit.value);
        }
    }

    /// Arguments in parentheses.
    /// An expression where only what is no comparison stands.
    pub(super) fn sum(&mut self, expression: &Expression<'s>) {
        self.operand(expression, Level::Sum);
    }

    pub(super) fn arguments(&mut self, arguments: &[Expression<'s>]) {
        self.glue(Glue::Tight);
        self.list(["(", ")"], arguments, Self::expression);
    }

    /// An expression where those that bind less stand in parentheses.
    fn operand(&mut self, expression: &Expression<'s>, least: Level) {
        let parentheses = self.parentheses(expression, least);
        for _ in 0..parentheses {
            self.word("(");
            self.glue(Glue::Tight);
        }
        self.bare(expression);
        for _ in 0..parentheses {
            self.tight(")");
        }
    }

    /// How many pairs of parentheses there are around an expression: those that were written, or
    /// those that are needed.
    fn parentheses(&self, expression: &Expression<'s>, least: Level) -> usize {
        let is_needed = Level::of_expression(&expression.kind) < least;
        let end = match &expression.kind {
            // What the left operand begins with is its own.
            ExpressionKind::Binary { left, .. } => left.span.start,
            _ => expression.span.end,
        };
        self.count_next("(", end).unwrap_or(usize::from(is_needed))
    }

    /// A part of [`Writer::operand`] without its parentheses.
    fn bare(&mut self, expression: &Expression<'s>) {
        match &expression.kind {
            ExpressionKind::Integer(value) => self.text(value.to_string()),
            ExpressionKind::Real(value) => self.text(format!("{value:?}")),
            ExpressionKind::Quantity { value, unit } => {
                self.text(format!("{value} {}", unit.value));
            }
            ExpressionKind::Boolean(value) => self.word(if *value { "true" } else { "false" }),
            ExpressionKind::Name(name) => self.text(*name),
            ExpressionKind::Unary { operator: UnaryOperator::Negate, operand } => {
                self.word("-");
                self.glue(Glue::Tight);
                self.operand(operand, Level::Sign);
            }
            ExpressionKind::Unary { operator: UnaryOperator::Not, operand } => {
                self.word("not");
                self.operand(operand, Level::Not);
            }
            ExpressionKind::Binary { operator, left, right } => {
                self.binary(*operator, left, right);
            }
            ExpressionKind::Function { name, arguments } => {
                self.text(name.value);
                self.arguments(arguments);
            }
            ExpressionKind::Input(index) => {
                self.word("input");
                self.signal(index.value);
            }
            ExpressionKind::Force => self.word("force"),
            ExpressionKind::Distance => self.word("distance"),
            ExpressionKind::Holding => self.word("holding"),
            // Only in the tree of a text that is wrong.
            ExpressionKind::Missing => {}
        }
    }

    /// `a + b`, of which `a` may be `c + d`: a row of operators is as deep as its last.
    fn binary(&mut self, operator: BinaryOperator, left: &Expression<'s>, right: &Expression<'s>) {
        let level = Level::of(operator);
        // Comparisons do not chain.
        let least = if level == Level::Comparison { level.above() } else { level };
        let is_row =
            Level::of_expression(&left.kind) == level && self.parentheses(left, least) == 0;
        match is_row {
            true => self.operand(left, least),
            false => self.nested(|writer| writer.operand(left, least)),
        }
        self.glue(Glue::Break(self.nesting));
        self.word(sign(operator));
        self.nested(|writer| writer.operand(right, level.above()));
    }
}
