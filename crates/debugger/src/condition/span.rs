//! What an expression is while the count of steps runs over a span and nothing else changes: found
//! without looking at every step, by halving what may hold a change.

use super::{Expression, Node, Operator};
use crate::subject::{Look, Subject, Value};

/// Reals below it hold every integer.
const EXACT: f64 = (1_u64 << 53) as f64;

/// What an expression can be over a span.
enum Span {
    /// This all along.
    Is(Value),
    /// Integers from the one to the other, both included.
    Within(i64, i64),
    /// Nothing is known.
    Any,
}

impl Expression {
    /// The last step of a span, ends included, after which this is another than at it, what it is
    /// there and what behind it; none if it is the same all along.
    pub(crate) fn last_change_over(
        &self,
        look: &Look<'_>,
        (first, last): (i64, i64),
    ) -> Option<(i64, Value, Value)> {
        if let Span::Is(_) = self.root.over(look, (first, last)) {
            return None;
        }
        if last - first <= 1 {
            let [before, after] = [first, last].map(|step| self.root.over(look, (step, step)));
            return match (before, after) {
                (Span::Is(before), Span::Is(after)) if before != after => {
                    Some((first, before, after))
                }
                _ => None,
            };
        }
        let middle = first + (last - first) / 2;
        self.last_change_over(look, (middle, last))
            .or_else(|| self.last_change_over(look, (first, middle)))
    }
}

impl Node {
    /// What it can be. With one step there is always one value.
    fn over(&self, look: &Look<'_>, steps: (i64, i64)) -> Span {
        match self {
            Self::Value(value) => Span::Is(value.clone()),
            Self::Subject(Subject::Steps) if steps.0 < steps.1 => Span::Within(steps.0, steps.1),
            Self::Subject(Subject::Steps) => Span::Is(Value::Int(steps.0)),
            Self::Subject(subject) => Span::Is(subject.read(look)),
            Self::Not(inner) | Self::Minus(inner) => match inner.over(look, steps) {
                Span::Is(value) => Span::Is(self.of_one(value)),
                Span::Within(..) | Span::Any => Span::Any,
            },
            Self::Two(operator, left, right) => {
                let left = left.over(look, steps);
                match (operator, &left) {
                    (Operator::Or, Span::Is(Value::Bool(true)))
                    | (Operator::And, Span::Is(Value::Bool(false))) => left,
                    _ => operator.over(left, right.over(look, steps)),
                }
            }
        }
    }
}

impl Operator {
    fn over(self, left: Span, right: Span) -> Span {
        let (left, right) = match (left, right) {
            (Span::Is(left), Span::Is(right)) => return Span::Is(self.of(&left, &right)),
            (left, right) => (left.integers(), right.integers()),
        };
        let (Some(left), Some(right)) = (left, right) else { return Span::Any };
        match self {
            Self::Plus => ends(left, right, i64::checked_add),
            Self::Minus => ends(left, right, i64::checked_sub),
            Self::Times => ends(left, right, i64::checked_mul),
            Self::Over | Self::Or | Self::And => Span::Any,
            Self::Less | Self::AtMost => decided(left.1 < right.0, left.0 > right.1),
            Self::More | Self::AtLeast => decided(left.0 > right.1, left.1 < right.0),
            Self::Equal => decided(false, left.1 < right.0 || left.0 > right.1),
            Self::Unequal => decided(left.1 < right.0 || left.0 > right.1, false),
        }
    }
}

impl Span {
    /// The integers that it lies between; of a real those beside it, where they are exact.
    fn integers(&self) -> Option<(i64, i64)> {
        match *self {
            Self::Is(Value::Int(value)) => Some((value, value)),
            Self::Is(Value::Real(value) | Value::Quantity(value, _)) if value.abs() < EXACT => {
                Some((value.floor() as i64, value.ceil() as i64))
            }
            Self::Within(low, high) => Some((low, high)),
            Self::Is(_) | Self::Any => None,
        }
    }
}

/// What grows or falls with both of its operands is within what it is at their ends.
fn ends(left: (i64, i64), right: (i64, i64), of: fn(i64, i64) -> Option<i64>) -> Span {
    let at = |left, right| of(left, right);
    let all = [at(left.0, right.0), at(left.0, right.1), at(left.1, right.0), at(left.1, right.1)];
    let known: Vec<i64> = all.into_iter().flatten().collect();
    match (known.iter().min(), known.iter().max()) {
        (Some(low), Some(high)) if known.len() == all.len() => Span::Within(*low, *high),
        _ => Span::Any,
    }
}

fn decided(is_true: bool, is_false: bool) -> Span {
    match (is_true, is_false) {
        (true, _) => Span::Is(Value::Bool(true)),
        (_, true) => Span::Is(Value::Bool(false)),
        _ => Span::Any,
    }
}
