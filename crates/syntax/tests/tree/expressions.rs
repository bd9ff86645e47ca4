//! Expressions: how operators bind, what is made of what, and what spans cover.

use super::*;

#[test]
fn operators_bind_as_usual() {
    let cases = [
        ("1 + 2 * 3 - 4", "((1 Add (2 Multiply 3)) Subtract 4)"),
        ("a / b mod c", "((a Divide b) Remainder c)"),
        ("not a == b and c or d", "(((Not (a Equal b)) And c) Or d)"),
        ("a or b and c", "(a Or (b And c))"),
        ("- -1 * 2", "((Negate (Negate 1)) Multiply 2)"),
        ("a - -b", "(a Subtract (Negate b))"),
        ("(1 + 2) * 3", "((1 Add 2) Multiply 3)"),
        ("a < b", "(a Less b)"),
        ("a <= 1", "(a LessOrEqual 1)"),
        ("a > 1", "(a Greater 1)"),
        ("a >= 1", "(a GreaterOrEqual 1)"),
        ("a != 1", "(a NotEqual 1)"),
        ("(a < b) == true", "((a Less b) Equal true)"),
    ];
    for (source, tree) in cases {
        assert_eq!(expression(source), tree, "{source}");
    }
}

#[test]
fn what_an_expression_is_made_of() {
    let cases = [
        ("9223372036854775807", "9223372036854775807"),
        ("0.5", "0.5"),
        ("1e-3", "0.001"),
        ("0.5 s", "0.5s"),
        ("20mm/s", "20.0mm/s"),
        ("3 mm / s", "(3.0mm Divide s)"),
        ("false", "false"),
        ("input 3 and force > 5 N", "(input 3 And (force Greater 5.0N))"),
        ("distance", "distance"),
        ("holding", "holding"),
        ("random(-1 mm, 1 mm,)", "random((Negate 1.0mm), 1.0mm)"),
        ("abs()", "abs()"),
        ("min(m, s)", "min(m, s)"),
    ];
    for (source, tree) in cases {
        assert_eq!(expression(source), tree, "{source}");
    }
}

#[test]
fn spans_cover_what_was_written() {
    let source = "var gap = (1 + 2) * 3 // that is it";
    let Item::Variable(variable) = item(source) else { panic!() };
    let text = |span: obverse_syntax::span::Span| &source[span.start as usize..span.end as usize];
    assert_eq!(text(variable.span), "var gap = (1 + 2) * 3");
    assert_eq!(text(variable.value.span), "(1 + 2) * 3");
    let ExpressionKind::Binary { left, .. } = &variable.value.kind else { panic!() };
    assert_eq!(text(left.span), "(1 + 2)");
    let source = "sequence s { wait 20 mm / s }";
    let Item::Sequence(sequence) = item(source) else { panic!() };
    let statement = &sequence.body.statements[0];
    let text = |span: obverse_syntax::span::Span| &source[span.start as usize..span.end as usize];
    assert_eq!(text(statement.span), "wait 20 mm / s");
    assert_eq!(text(sequence.body.span), "{ wait 20 mm / s }");
    let StatementKind::Wait(Expression { kind: ExpressionKind::Binary { left, .. }, .. }) =
        &statement.kind
    else {
        panic!()
    };
    let ExpressionKind::Quantity { unit, .. } = left.kind else { panic!() };
    assert_eq!((text(left.span), text(unit.span)), ("20 mm", "mm"));
}
