//! Values of the reference interpreter, and what operators and functions make of them.
//!
//! Types are found while running: an integer beside a real is one that was written out where a
//! real is needed, since the compiler accepts no other. Knows nothing of names and readings.

use super::Trap;
use obverse_syntax::ast::{BinaryOperator, UnaryOperator};
use std::f64::consts::PI;

/// A value. Joint configurations and items are named by their place among the declarations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Int(i64),
    /// In metres, radians, seconds, newtons.
    Real(f64),
    Bool(bool),
    Joints(u16),
    Item(u16),
}

impl Value {
    /// The value as the 64 bits that a machine would keep.
    pub(super) fn bits(self) -> u64 {
        match self {
            Self::Int(value) => value.cast_unsigned(),
            Self::Real(value) => value.to_bits(),
            Self::Bool(value) => u64::from(value),
            Self::Joints(index) | Self::Item(index) => u64::from(index),
        }
    }

    /// As a real; what is no number, which no checked program has here, as no number.
    pub(super) fn real(self) -> f64 {
        match self {
            Self::Int(value) => value as f64,
            Self::Real(value) => value,
            Self::Bool(_) | Self::Joints(_) | Self::Item(_) => f64::NAN,
        }
    }

    /// As an integer.
    pub(super) fn int(self) -> i64 {
        match self {
            Self::Int(value) => value,
            _ => 0,
        }
    }

    /// As a truth value.
    pub(super) fn holds(self) -> bool {
        self == Self::Bool(true)
    }

    /// The value as one of the type of another: an integer that was written for a real is one.
    pub(super) fn like(self, other: Self) -> Self {
        match other {
            Self::Real(_) => Self::Real(self.real()),
            _ => self,
        }
    }

    /// The value as one of a declared type.
    pub(super) fn declared(self, type_name: &str) -> Self {
        match (type_name, self) {
            ("number", Self::Int(_)) => Self::Real(self.real()),
            _ => self,
        }
    }
}

/// The value of one of a unit in metres, radians, seconds and newtons.
pub(super) fn si(value: f64, unit: &str) -> f64 {
    match unit {
        "um" => value / 1e6,
        "mm" | "mm/s" | "ms" => value / 1e3,
        "cm" => value / 1e2,
        "deg" | "deg/s" => value * PI / 180.0,
        "min" => value * 60.0,
        _ => value,
    }
}

/// `-a`, `not a`
pub(super) fn unary(operator: UnaryOperator, a: Value) -> Value {
    match (operator, a) {
        (UnaryOperator::Negate, Value::Int(a)) => Value::Int(a.wrapping_neg()),
        (UnaryOperator::Negate, a) => Value::Real(-a.real()),
        (UnaryOperator::Not, a) => Value::Bool(!a.holds()),
    }
}

/// `a + b`
pub(super) fn binary(operator: BinaryOperator, a: Value, b: Value) -> Result<Value, Trap> {
    match (a, b) {
        (Value::Int(a), Value::Int(b)) => of_ints(operator, a, b),
        (Value::Bool(a), Value::Bool(b)) => Ok(Value::Bool(match operator {
            BinaryOperator::And => a && b,
            BinaryOperator::Or => a || b,
            BinaryOperator::NotEqual => a != b,
            _ => a == b,
        })),
        _ => Ok(of_reals(operator, a.real(), b.real())),
    }
}

fn of_ints(operator: BinaryOperator, a: i64, b: i64) -> Result<Value, Trap> {
    use BinaryOperator as Op;
    Ok(match operator {
        Op::Add => Value::Int(a.wrapping_add(b)),
        Op::Subtract => Value::Int(a.wrapping_sub(b)),
        Op::Multiply => Value::Int(a.wrapping_mul(b)),
        Op::Divide | Op::Remainder if b == 0 => return Err(Trap::Arithmetic),
        Op::Divide => Value::Int(a.wrapping_div(b)),
        Op::Remainder => Value::Int(a.wrapping_rem(b)),
        Op::Less => Value::Bool(a < b),
        Op::LessOrEqual => Value::Bool(a <= b),
        Op::Greater => Value::Bool(a > b),
        Op::GreaterOrEqual => Value::Bool(a >= b),
        Op::NotEqual => Value::Bool(a != b),
        Op::Equal | Op::And | Op::Or => Value::Bool(a == b),
    })
}

fn of_reals(operator: BinaryOperator, a: f64, b: f64) -> Value {
    use BinaryOperator as Op;
    match operator {
        Op::Add => Value::Real(a + b),
        Op::Subtract => Value::Real(a - b),
        Op::Multiply => Value::Real(a * b),
        Op::Divide | Op::Remainder => Value::Real(a / b),
        Op::Less => Value::Bool(a < b),
        Op::LessOrEqual => Value::Bool(a <= b),
        Op::Greater => Value::Bool(a > b),
        Op::GreaterOrEqual => Value::Bool(a >= b),
        Op::NotEqual => Value::Bool(a != b),
        Op::Equal | Op::And | Op::Or => Value::Bool(a == b),
    }
}

/// `abs(a)`, `min(a, b)`; `random` is a reading.
pub(super) fn function(name: &str, arguments: &[Value]) -> Result<Value, Trap> {
    let first = arguments.first().copied().unwrap_or(Value::Int(0));
    let second = arguments.get(1).copied().unwrap_or(first);
    Ok(match (name, first, second) {
        ("abs", Value::Int(a), _) => Value::Int(a.wrapping_abs()),
        ("abs", a, _) => Value::Real(a.real().abs()),
        ("sqrt", a, _) => Value::Real(a.real().sqrt()),
        ("real", a, _) => Value::Real(a.real()),
        ("int", a, _) => Value::Int(truncated(a.real())?),
        ("min", Value::Int(a), Value::Int(b)) => Value::Int(a.min(b)),
        ("max", Value::Int(a), Value::Int(b)) => Value::Int(a.max(b)),
        ("min", a, b) => Value::Real(smaller(a.real(), b.real())),
        (_, a, b) => Value::Real(larger(a.real(), b.real())),
    })
}

/// The smaller one; the second of two that are equal; the one that is a number.
fn smaller(a: f64, b: f64) -> f64 {
    if a < b || b.is_nan() { a } else { b }
}

/// The larger one; the second of two that are equal; the one that is a number.
fn larger(a: f64, b: f64) -> f64 {
    if a > b || b.is_nan() { a } else { b }
}

/// Towards zero, if that is an integer of 64 bits.
fn truncated(value: f64) -> Result<i64, Trap> {
    let limit = 2.0_f64.powi(63);
    let is_in_range = value.trunc() >= -limit && value.trunc() < limit;
    if is_in_range { Ok(value.trunc() as i64) } else { Err(Trap::Arithmetic) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_wrap_and_divide_towards_zero() {
        let int = |operator, a, b| binary(operator, Value::Int(a), Value::Int(b));
        assert_eq!(int(BinaryOperator::Add, i64::MAX, 1), Ok(Value::Int(i64::MIN)));
        assert_eq!(int(BinaryOperator::Divide, -7, 2), Ok(Value::Int(-3)));
        assert_eq!(int(BinaryOperator::Remainder, -7, 2), Ok(Value::Int(-1)));
        assert_eq!(int(BinaryOperator::Divide, i64::MIN, -1), Ok(Value::Int(i64::MIN)));
        assert_eq!(int(BinaryOperator::Remainder, 1, 0), Err(Trap::Arithmetic));
    }

    #[test]
    fn an_integer_beside_a_real_is_one() {
        let product = binary(BinaryOperator::Multiply, Value::Int(2), Value::Real(0.5));
        assert_eq!(product, Ok(Value::Real(1.0)));
        assert_eq!(Value::Int(2).declared("number"), Value::Real(2.0));
        assert_eq!(Value::Int(2).declared("int"), Value::Int(2));
    }

    #[test]
    fn the_largest_reals_are_no_integers() {
        assert_eq!(function("int", &[Value::Real(-1.9)]), Ok(Value::Int(-1)));
        assert_eq!(function("int", &[Value::Real(9.3e18)]), Err(Trap::Arithmetic));
        assert_eq!(function("int", &[Value::Real(f64::NAN)]), Err(Trap::Arithmetic));
        let most = -(2.0_f64.powi(63));
        assert_eq!(function("int", &[Value::Real(most)]), Ok(Value::Int(i64::MIN)));
    }

    #[test]
    fn units_are_in_si() {
        assert_eq!(si(0.1, "mm"), 0.0001);
        assert_eq!(si(180.0, "deg"), PI);
        assert_eq!(si(2.0, "min"), 120.0);
        assert_eq!(si(3.0, "N"), 3.0);
    }
}
