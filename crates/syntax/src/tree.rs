//! What the grammar's actions call to build the tree: texts and numbers from their spans, and the
//! mistakes that the grammar accepts in order to say clearly what is wrong with them.

use crate::ast::{
    BinaryOperator, Block, Expression, ExpressionKind, Item, Name, SignalKind, Statement,
    StatementKind, UnaryOperator,
};
use crate::codes::Code;
use crate::diagnostic::Diagnostic;
use crate::nearest::nearest;
use crate::sink::Sink;
use crate::span::{Span, Spanned};
use crate::token::UNITS;

/// The source between two offsets.
pub(crate) fn text(source: &str, start: u32, end: u32) -> &str {
    source.get(start as usize..end as usize).unwrap_or("")
}

/// The source from an offset on.
pub(crate) fn rest(source: &str, start: u32) -> &str {
    source.get(start as usize..).unwrap_or("")
}

/// A name at a place.
pub(crate) fn name(source: &str, start: u32, end: u32) -> Name<'_> {
    Spanned::new(text(source, start, end), Span::new(start, end))
}

/// A text without its quotes; the span has them.
pub(crate) fn quoted(source: &str, start: u32, end: u32) -> Spanned<&str> {
    let is_quote = |c: char| c == '"' || c == '\'' || crate::foreign::is_typographic_quote(c);
    let text = text(source, start, end);
    let inner = text.strip_prefix(is_quote).unwrap_or(text);
    Spanned::new(inner.strip_suffix(is_quote).unwrap_or(inner), Span::new(start, end))
}

/// An integer, or nothing and a diagnostic if it is too large.
pub(crate) fn integer<'s>(
    source: &'s str,
    sink: &Sink<'s>,
    start: u32,
    end: u32,
) -> ExpressionKind<'s> {
    match text(source, start, end).parse() {
        Ok(value) => ExpressionKind::Integer(value),
        Err(_) => out_of_range(sink, start, end, "the largest integer is 9223372036854775807"),
    }
}

/// A whole number that is not negative: the number of a signal, or how often.
pub(crate) fn index<'s>(source: &'s str, sink: &Sink<'s>, start: u32, end: u32) -> Spanned<u64> {
    let value = text(source, start, end).parse().unwrap_or_else(|_| {
        out_of_range(sink, start, end, "the largest whole number here is 18446744073709551615");
        0
    });
    Spanned::new(value, Span::new(start, end))
}

/// A real, or nothing and a diagnostic if it is too large.
pub(crate) fn real<'s>(
    source: &'s str,
    sink: &Sink<'s>,
    start: u32,
    end: u32,
) -> ExpressionKind<'s> {
    match finite(text(source, start, end), sink, start, end) {
        Some(value) => ExpressionKind::Real(value),
        None => ExpressionKind::Missing,
    }
}

/// A number and its unit, which may have blanks between them.
pub(crate) fn quantity<'s>(
    source: &'s str,
    sink: &Sink<'s>,
    start: u32,
    end: u32,
) -> ExpressionKind<'s> {
    let (number, unit) = split_quantity(text(source, start, end));
    let unit = name(source, end - unit.len() as u32, end);
    match finite(number, sink, start, end) {
        Some(value) => ExpressionKind::Quantity { value, unit },
        None => ExpressionKind::Missing,
    }
}

/// A number and a word that is no unit.
pub(crate) fn bad_quantity<'s>(
    source: &'s str,
    sink: &Sink<'s>,
    start: u32,
    end: u32,
) -> ExpressionKind<'s> {
    let (number, word) = split_quantity(text(source, start, end));
    let span = Span::new(end - word.len() as u32, end);
    let is_of_number = number.len() + word.len() == (end - start) as usize;
    let is_base = number == "0" && word.starts_with(['x', 'X', 'b', 'B', 'o', 'O']);
    sink.report(if word == "step" {
        step(span)
    } else if is_of_number && (word.starts_with('_') || is_base) {
        let message = "numbers are written in decimal digits, without groups";
        Diagnostic::error(Code::MalformedNumber, span, message, "not a part of a number")
    } else {
        unknown_unit(word, span, &["times"])
    });
    ExpressionKind::Missing
}

/// A loop that counts is given a step.
pub(crate) fn step(span: Span) -> Diagnostic {
    let message = "a loop that counts goes by one";
    Diagnostic::error(Code::ForeignLoop, span, message, "no step can be given")
        .with_help("compute in the loop: `var n = i * 2`; it counts down by `from 9 down to 0`")
}

/// A word stands where a unit should; `others` are words that could have been meant as well.
pub(crate) fn unknown_unit(word: &str, span: Span, others: &[&str]) -> Diagnostic {
    let message = format!("`{word}` is not a unit");
    let diagnostic = Diagnostic::error(Code::UnknownUnit, span, message, "not a unit")
        .with_note(format!("the units are {}", UNITS.join(", ")));
    let small = word.to_lowercase();
    let row = UNIT_WORDS.iter().find(|(words, _)| words.contains(&small.as_str()));
    match (row, nearest(word, UNITS.iter().chain(others).copied())) {
        (Some((_, unit)), _) => diagnostic.write_instead(span, unit),
        // `Nm`, of which none is near by its letters alone.
        (None, _) if word.starts_with('N') => diagnostic.did_you_mean(span, "N"),
        (None, Some(meant)) => diagnostic.did_you_mean(span, meant),
        (None, None) => diagnostic,
    }
}

/// Other words for the units, and one that elsewhere follows the first number of a loop.
const UNIT_WORDS: [(&[&str], &str); 11] = [
    (&["millimeter", "millimeters", "millimetre", "millimetres"], "mm"),
    (&["centimeter", "centimeters", "centimetre", "centimetres"], "cm"),
    (&["meter", "meters", "metre", "metres"], "m"),
    (&["micrometer", "micrometers", "micron", "microns"], "um"),
    (&["degree", "degrees", "°"], "deg"),
    (&["radian", "radians"], "rad"),
    (&["msec", "millis", "millisecond", "milliseconds"], "ms"),
    (&["sec", "secs", "second", "seconds"], "s"),
    (&["mins", "minute", "minutes"], "min"),
    (&["newton", "newtons"], "N"),
    (&["downto"], "down to"),
];

/// The number and the word of `20 mm`.
pub(crate) fn split_quantity(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    // `e` is of the number where digits or a sign and digits follow: `1e5 mm`, not `3 eel`.
    let is_number = |index: usize| match bytes[index] {
        b'0'..=b'9' | b'.' | b',' => true,
        b'+' | b'-' => true,
        b'e' | b'E' => {
            let next = bytes.get(index + 1);
            next.is_some_and(|&byte| byte.is_ascii_digit() || byte == b'+' || byte == b'-')
        }
        _ => false,
    };
    let end = (0..bytes.len()).find(|&index| !is_number(index)).unwrap_or(bytes.len());
    let (number, rest) = text.split_at_checked(end).unwrap_or((text, ""));
    (number, rest.trim_start_matches([' ', '\t']))
}

/// The number, if it is one and finite. What is not written as a number the lexer has reported.
fn finite(number: &str, sink: &Sink<'_>, start: u32, end: u32) -> Option<f64> {
    let value: f64 = number.parse().ok()?;
    if value.is_infinite() {
        out_of_range(sink, start, end, "the largest number is about 1.8e308");
        return None;
    }
    Some(value)
}

fn out_of_range<'s>(sink: &Sink<'s>, start: u32, end: u32, limit: &str) -> ExpressionKind<'s> {
    let span = Span::new(start, end);
    sink.report(
        Diagnostic::error(Code::NumberOutOfRange, span, "this number is too large", "too large")
            .with_note(limit),
    );
    ExpressionKind::Missing
}

/// `left operator right`.
pub(crate) fn binary<'s>(
    operator: BinaryOperator,
    left: Expression<'s>,
    right: Expression<'s>,
) -> Expression<'s> {
    let span = left.span.to(right.span);
    let (left, right) = (Box::new(left), Box::new(right));
    Expression { kind: ExpressionKind::Binary { operator, left, right }, span }
}

/// `operator operand`, the operator beginning at `start`.
pub(crate) fn unary<'s>(
    operator: UnaryOperator,
    operand: Expression<'s>,
    start: u32,
) -> Expression<'s> {
    let span = Span::new(start, operand.span.end);
    Expression { kind: ExpressionKind::Unary { operator, operand: Box::new(operand) }, span }
}

/// What stands for an expression that is wrong.
pub(crate) fn missing<'s>(start: u32, end: u32) -> Expression<'s> {
    Expression { kind: ExpressionKind::Missing, span: Span::new(start, end.max(start)) }
}

/// `a < b < c`, the second comparison being at `again`.
pub(crate) fn chained_comparison<'s>(sink: &Sink<'s>, first: Span, again: Span) -> Expression<'s> {
    let message = "comparisons cannot be chained";
    sink.report(
        Diagnostic::error(Code::ChainedComparison, again, message, "compared again here")
            .with_label(first, "the first comparison begins here")
            .with_help("compare twice: `a < b and b < c`"),
    );
    missing(first.start, again.end)
}

/// `left = right` where a value is asked for.
pub(crate) fn assignment_as_comparison<'s>(
    sink: &Sink<'s>,
    whole: Span,
    sign: Span,
) -> Expression<'s> {
    sink.report(assigns(sign));
    missing(whole.start, whole.end)
}

/// What is said of an `=` that should compare.
pub(crate) fn assigns(sign: Span) -> Diagnostic {
    let message = "`=` assigns and has no value";
    Diagnostic::error(Code::AssignmentAsComparison, sign, message, "assigns")
        .with_help("to compare two values write `==`")
        .replacing(sign, "==")
}

/// An `if` without its `ending when`.
pub(crate) fn if_else<'s>(
    condition: Expression<'s>,
    then: Block<'s>,
    otherwise: Option<Block<'s>>,
) -> StatementKind<'s> {
    StatementKind::If { condition, then, otherwise, ending_when: None }
}

/// The same with it.
pub(crate) fn if_ending<'s>(
    mut kind: StatementKind<'s>,
    assertion: Option<Expression<'s>>,
) -> StatementKind<'s> {
    if let StatementKind::If { ending_when, .. } = &mut kind {
        *ending_when = assertion;
    }
    kind
}

/// Branches in their order.
pub(crate) fn fork<'s>(first: Block<'s>, others: Vec<Block<'s>>) -> StatementKind<'s> {
    StatementKind::Fork(first_and(first, others))
}

/// A list that has one element at the least.
pub(crate) fn first_and<T>(first: T, mut others: Vec<T>) -> Vec<T> {
    others.insert(0, first);
    others
}

/// A block of one statement, for `else if`.
pub(crate) fn block_of(kind: StatementKind<'_>, start: u32, end: u32) -> Block<'_> {
    let span = Span::new(start, end);
    Block { statements: vec![Statement { kind, span }], span }
}

/// A statement at the top of a file.
pub(crate) fn statement_outside(source: &str, sink: &Sink<'_>, span: Span) {
    sink.outside(span, rest(source, span.end), || {
        let message = "a statement stands outside of a sequence";
        Diagnostic::error(Code::StatementOutside, span, message, "in no sequence")
            .with_note("at the top of a file stand declarations")
            .with_help("put it into `sequence main { .. }`")
    });
}

/// A declaration in a block: reported, and kept as if it stood at the top.
pub(crate) fn declaration_inside<'s>(sink: &Sink<'s>, item: Item<'s>, start: u32) {
    let (word, end) = match &item {
        Item::Cell(path) => ("cell", path.span.end),
        Item::Import(import) => ("import", import.path.span.end),
        Item::Signal(signal) => match signal.kind {
            SignalKind::Output => ("output", signal.name.span.end),
            SignalKind::Input => ("input", signal.name.span.end),
        },
        Item::Io(io) => ("io operation", io.name.span.end),
        Item::Joints(joints) => ("joint configuration", joints.name.span.end),
        Item::ItemDeclaration(item) => ("item", item.name.span.end),
        Item::Error(error) => ("error", error.name.span.end),
        Item::AdvancedMove(advanced) => ("advanced move", advanced.name.span.end),
        Item::Variable(variable) => ("variable", variable.name.span.end),
        Item::Allow(allow) => ("allow", allow.span.end),
        Item::Cleanup(cleanup) => ("cleanup", cleanup.word.end),
        Item::Sequence(sequence) if sequence.is_action => ("action", sequence.name.span.end),
        Item::Sequence(sequence) => ("sequence", sequence.name.span.end),
    };
    let message = format!("this {word} is declared inside of a block");
    let span = Span::new(start, end);
    let diagnostic = Diagnostic::error(Code::DeclarationInside, span, message, "not in a block")
        .with_help("declare it at the top of the file; or a `}` is missing before it");
    sink.misplaced(item, diagnostic);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_is_split_where_its_number_ends() {
        let cases = [
            ("20 mm", ("20", "mm")),
            ("0.5s", ("0.5", "s")),
            ("1e5mm/s", ("1e5", "mm/s")),
            ("1.5e-3\t rad", ("1.5e-3", "rad")),
            ("3 eel", ("3", "eel")),
            ("3", ("3", "")),
        ];
        for (text, parts) in cases {
            assert_eq!(split_quantity(text), parts, "{text}");
        }
    }
}
