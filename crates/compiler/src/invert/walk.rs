//! Walks over the syntax tree: statements with all that is in them, and the names that expressions
//! have in them. What they mean is not known here.

use obverse_syntax::ast::{
    Block, Expression, ExpressionKind, Primitive, ReverseParameter, Statement, StatementKind,
    Target,
};
use std::collections::BTreeSet;

/// A statement and every statement in it.
pub(super) fn each_statement<'a, 's>(
    statement: &'a Statement<'s>,
    visit: &mut impl FnMut(&'a Statement<'s>),
) {
    visit(statement);
    for block in statement.blocks() {
        each_in(block, visit);
    }
}

/// Every statement in a block, those in blocks of it included.
pub(super) fn each_in<'a, 's>(block: &'a Block<'s>, visit: &mut impl FnMut(&'a Statement<'s>)) {
    for statement in &block.statements {
        each_statement(statement, visit);
    }
}

/// The expressions of a statement itself, not of its blocks.
pub(super) fn expressions<'a, 's>(statement: &'a Statement<'s>) -> Vec<&'a Expression<'s>> {
    match &statement.kind {
        StatementKind::Move { target: Target::Relative { distance, .. }, .. } => vec![distance],
        StatementKind::Move { target: Target::Turned(turn), .. } => turn.amounts().collect(),
        StatementKind::Call { arguments, .. } => {
            arguments.iter().map(|argument| &argument.value).collect()
        }
        StatementKind::Wait(value)
        | StatementKind::WaitUntil { timeout: value, .. }
        | StatementKind::Primitive(Primitive::Sleep { duration: value, .. })
        | StatementKind::Assign { value, .. }
        | StatementKind::Repeat { times: value, .. } => vec![value],
        StatementKind::Variable(variable) => vec![&variable.value],
        StatementKind::If { condition, ending_when: assertion, .. }
        | StatementKind::While { condition, entered_when: assertion, .. } => {
            std::iter::once(condition).chain(assertion).collect()
        }
        StatementKind::Requires { condition, .. } => vec![condition],
        StatementKind::For { first, last, .. } => vec![first, last],
        StatementKind::WithInReverse { parameters, .. } => {
            let limits = parameters.iter().filter_map(|parameter| match &parameter.value {
                ReverseParameter::ForceLimit(limit) => Some(limit),
                ReverseParameter::Speed(_) | ReverseParameter::StraightMoves => None,
            });
            limits.collect()
        }
        StatementKind::Move { .. }
        | StatementKind::Advance(_)
        | StatementKind::Io(_)
        | StatementKind::Primitive(Primitive::Set { .. } | Primitive::Toggle { .. })
        | StatementKind::Remember(_)
        | StatementKind::Loop(_)
        | StatementKind::Break
        | StatementKind::Return
        | StatementKind::Speed { .. }
        | StatementKind::Tool { .. }
        | StatementKind::Checkpoint(_)
        | StatementKind::Barrier(_)
        | StatementKind::Irreversible { .. }
        | StatementKind::SkipInReverse(_)
        | StatementKind::ReplaceInReverse { .. }
        | StatementKind::KeepInReverse(_)
        | StatementKind::Fork(_)
        | StatementKind::Throw(_)
        | StatementKind::Allow(_) => Vec::new(),
    }
}

/// An expression and every expression in it.
pub(super) fn each_expression<'a, 's>(
    expression: &'a Expression<'s>,
    visit: &mut impl FnMut(&'a Expression<'s>),
) {
    visit(expression);
    match &expression.kind {
        ExpressionKind::Unary { operand, .. } => each_expression(operand, visit),
        ExpressionKind::Binary { left, right, .. } => {
            each_expression(left, visit);
            each_expression(right, visit);
        }
        ExpressionKind::Function { arguments, .. } => {
            arguments.iter().for_each(|argument| each_expression(argument, visit));
        }
        ExpressionKind::Integer(_)
        | ExpressionKind::Real(_)
        | ExpressionKind::Quantity { .. }
        | ExpressionKind::Boolean(_)
        | ExpressionKind::Name(_)
        | ExpressionKind::Input(_)
        | ExpressionKind::Force
        | ExpressionKind::Distance
        | ExpressionKind::Holding
        | ExpressionKind::Missing => {}
    }
}

/// The names that stand in an expression.
pub(super) fn names_of<'s>(expression: &Expression<'s>) -> Vec<&'s str> {
    let mut names = Vec::new();
    each_expression(expression, &mut |part| {
        if let ExpressionKind::Name(name) = part.kind {
            names.push(name);
        }
    });
    names
}

/// The names that stand in a place that the arm may be moved to.
pub(super) fn names_of_target<'s>(target: &Target<'s>) -> Vec<&'s str> {
    match target {
        Target::Named(name) => vec![name.value],
        Target::Keyframe { item, .. } => vec![item.value],
        Target::Relative { distance, .. } => names_of(distance),
        Target::Turned(turn) => turn.amounts().flat_map(names_of).collect(),
    }
}

/// The variables that are declared in a block, and in blocks of it.
pub(super) fn declared_in<'s>(block: &Block<'s>) -> BTreeSet<&'s str> {
    let mut names = BTreeSet::new();
    each_in(block, &mut |statement| {
        if let StatementKind::Variable(variable) = &statement.kind {
            names.insert(variable.name.value);
        }
    });
    names
}

/// The names that stand anywhere in a statement as a value, a place or what is assigned.
pub(super) fn mentioned<'s>(statement: &Statement<'s>) -> Vec<&'s str> {
    let mut names = Vec::new();
    each_statement(statement, &mut |inner| {
        expressions(inner).into_iter().for_each(|one| names.extend(names_of(one)));
        match &inner.kind {
            StatementKind::Assign { name, .. } => names.push(name.value),
            StatementKind::Move { target, .. } => names.extend(names_of_target(target)),
            _ => {}
        }
    });
    names
}
