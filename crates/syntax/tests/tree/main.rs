//! The tree that each construct becomes. Here is what all of it needs.

mod declarations;
mod expressions;
mod statements;

use obverse_syntax::ast::*;
use obverse_syntax::parse;

/// The declarations of a text without mistakes.
fn items(source: &str) -> Vec<Item<'_>> {
    let parsed = parse(source);
    assert_eq!(parsed.diagnostics, [], "{source}");
    parsed.program.items
}

fn item(source: &str) -> Item<'_> {
    let mut items = items(source);
    assert_eq!(items.len(), 1, "{source}");
    items.remove(0)
}

/// Calls `check` with the statements of a sequence with this body.
fn with_statements(body: &str, check: impl FnOnce(Vec<StatementKind<'_>>)) {
    let source = format!("sequence main {{\n{body}\n}}");
    let Item::Sequence(sequence) = item(&source) else { panic!("{source}") };
    check(sequence.body.statements.into_iter().map(|statement| statement.kind).collect());
}

fn with_statement(body: &str, check: impl FnOnce(StatementKind<'_>)) {
    with_statements(body, |mut statements| {
        assert_eq!(statements.len(), 1, "{body}");
        check(statements.remove(0));
    });
}

fn signal(signal: Signal<'_>) -> String {
    match signal {
        Signal::Number(number) => number.to_string(),
        Signal::Name(name) => name.to_owned(),
    }
}

/// An expression with brackets around every operation, numbers as they are.
fn show(expression: &Expression<'_>) -> String {
    let list =
        |arguments: &[Expression<'_>]| arguments.iter().map(show).collect::<Vec<_>>().join(", ");
    match &expression.kind {
        ExpressionKind::Integer(value) => format!("{value}"),
        ExpressionKind::Real(value) => format!("{value:?}"),
        ExpressionKind::Quantity { value, unit } => format!("{value:?}{}", unit.value),
        ExpressionKind::Boolean(value) => format!("{value}"),
        ExpressionKind::Name(name) => (*name).to_owned(),
        ExpressionKind::Unary { operator, operand } => format!("({operator:?} {})", show(operand)),
        ExpressionKind::Binary { operator, left, right } => {
            format!("({} {operator:?} {})", show(left), show(right))
        }
        ExpressionKind::Function { name, arguments } => {
            format!("{}({})", name.value, list(arguments))
        }
        ExpressionKind::Input(line) => format!("input {}", signal(line.value)),
        ExpressionKind::Force => "force".to_owned(),
        ExpressionKind::Distance => "distance".to_owned(),
        ExpressionKind::Holding => "holding".to_owned(),
        ExpressionKind::Missing => "missing".to_owned(),
    }
}

fn expression(source: &str) -> String {
    let text = format!("var v = {source}");
    let Item::Variable(variable) = item(&text) else { panic!("{source}") };
    show(&variable.value)
}

#[test]
fn the_example_is_read_whole() {
    let names = items(include_str!("../example.obv")).len();
    assert_eq!(names, 11);
}
