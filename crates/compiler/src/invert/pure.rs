//! Expressions that say the same whenever they are evaluated in the same state, and the opposite of
//! a condition.

use super::walk;
use obverse_syntax::ast::{BinaryOperator, Expression, ExpressionKind, UnaryOperator};
use obverse_syntax::span::Span;

/// Where an expression reads the outside or draws at random, if it does.
pub(super) fn reading(expression: &Expression<'_>) -> Option<Span> {
    let mut found = None;
    walk::each_expression(expression, &mut |part| {
        let is_reading = match &part.kind {
            ExpressionKind::Input(_)
            | ExpressionKind::Force
            | ExpressionKind::Distance
            | ExpressionKind::Holding => true,
            ExpressionKind::Function { name, .. } => name.value == "random",
            _ => false,
        };
        if is_reading && found.is_none() {
            found = Some(part.span);
        }
    });
    found
}

/// What holds where this does not. The opposite of the opposite is the same again.
pub(super) fn opposite<'s>(condition: &Expression<'s>) -> Expression<'s> {
    let span = condition.span;
    let kind = match &condition.kind {
        ExpressionKind::Unary { operator: UnaryOperator::Not, operand }
            if opposite_of_equality(operand).is_none() =>
        {
            return (**operand).clone();
        }
        _ => opposite_of_equality(condition).unwrap_or_else(|| {
            let operand = Box::new(condition.clone());
            ExpressionKind::Unary { operator: UnaryOperator::Not, operand }
        }),
    };
    Expression { kind, span }
}

/// `a != b` of `a == b`, and the other way round.
fn opposite_of_equality<'s>(condition: &Expression<'s>) -> Option<ExpressionKind<'s>> {
    let ExpressionKind::Binary { operator, left, right } = &condition.kind else { return None };
    let operator = match operator {
        BinaryOperator::Equal => BinaryOperator::NotEqual,
        BinaryOperator::NotEqual => BinaryOperator::Equal,
        _ => return None,
    };
    Some(ExpressionKind::Binary { operator, left: left.clone(), right: right.clone() })
}
