//! Computing at compile time what the machine would compute, to the same bits.
//!
//! What the machine would trap on, and what is not the same bits everywhere (a value that is no
//! number, the smaller of two zeros), is left to it.

use crate::tree::ExpressionKind::{self, Bool, Int, Real};
use obverse_isa::Instr;

/// The value of an instruction of one operand, if it is known.
pub(crate) fn unary(instr: Instr, operand: &ExpressionKind) -> Option<ExpressionKind> {
    match (instr, operand) {
        (Instr::IntNeg {}, Int(value)) => Some(Int(value.wrapping_neg())),
        (Instr::IntAbs {}, Int(value)) => Some(Int(value.wrapping_abs())),
        (Instr::RealNeg {}, Real(value)) => Some(Real(-value)),
        (Instr::RealAbs {}, Real(value)) => Some(Real(value.abs())),
        (Instr::RealSqrt {}, Real(value)) if *value >= 0.0 => Some(Real(value.sqrt())),
        (Instr::BoolNot {}, Bool(value)) => Some(Bool(!value)),
        (Instr::IntToReal {}, Int(value)) => Some(Real(*value as f64)),
        (Instr::RealToInt {}, Real(value)) => to_int(*value).map(Int),
        _ => None,
    }
}

/// The value of an instruction of two operands, if it is known.
pub(crate) fn binary(
    instr: Instr,
    left: &ExpressionKind,
    right: &ExpressionKind,
) -> Option<ExpressionKind> {
    match (left, right) {
        (Int(left), Int(right)) => int(instr, *left, *right),
        (Real(left), Real(right)) => real(instr, *left, *right),
        (Bool(left), Bool(right)) => match instr {
            Instr::BoolAnd {} => Some(Bool(*left && *right)),
            Instr::BoolOr {} => Some(Bool(*left || *right)),
            Instr::BoolEq {} => Some(Bool(left == right)),
            _ => None,
        },
        _ => None,
    }
}

fn int(instr: Instr, left: i64, right: i64) -> Option<ExpressionKind> {
    Some(match instr {
        Instr::IntAdd {} => Int(left.wrapping_add(right)),
        Instr::IntSub {} => Int(left.wrapping_sub(right)),
        Instr::IntMul {} => Int(left.wrapping_mul(right)),
        Instr::IntDiv {} if right != 0 => Int(left.wrapping_div(right)),
        Instr::IntRem {} if right != 0 => Int(left.wrapping_rem(right)),
        Instr::IntMin {} => Int(left.min(right)),
        Instr::IntMax {} => Int(left.max(right)),
        Instr::IntLt {} => Bool(left < right),
        Instr::IntLe {} => Bool(left <= right),
        Instr::IntEq {} => Bool(left == right),
        Instr::IntNe {} => Bool(left != right),
        _ => return None,
    })
}

fn real(instr: Instr, left: f64, right: f64) -> Option<ExpressionKind> {
    let value = match instr {
        Instr::RealAdd {} => left + right,
        Instr::RealSub {} => left - right,
        Instr::RealMul {} => left * right,
        Instr::RealDiv {} => left / right,
        Instr::RealMin {} if left != right => left.min(right),
        Instr::RealMax {} if left != right => left.max(right),
        Instr::RealLt {} => return Some(Bool(left < right)),
        Instr::RealLe {} => return Some(Bool(left <= right)),
        Instr::RealEq {} => return Some(Bool(left == right)),
        Instr::RealNe {} => return Some(Bool(left != right)),
        _ => return None,
    };
    value.is_finite().then_some(Real(value))
}

/// Towards zero, if it is in range.
fn to_int(value: f64) -> Option<i64> {
    // Both bounds are exact as doubles; the upper one is the first that is out of range.
    let is_in_range = (-9_223_372_036_854_775_808.0..9_223_372_036_854_775_808.0).contains(&value);
    is_in_range.then_some(value as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_wrap_as_in_the_machine() {
        assert_eq!(binary(Instr::IntAdd {}, &Int(i64::MAX), &Int(1)), Some(Int(i64::MIN)));
        assert_eq!(binary(Instr::IntDiv {}, &Int(i64::MIN), &Int(-1)), Some(Int(i64::MIN)));
        assert_eq!(unary(Instr::IntNeg {}, &Int(i64::MIN)), Some(Int(i64::MIN)));
        assert_eq!(binary(Instr::IntRem {}, &Int(-7), &Int(3)), Some(Int(-1)));
    }

    #[test]
    fn what_would_trap_or_is_no_number_is_left_to_the_machine() {
        assert_eq!(binary(Instr::IntDiv {}, &Int(1), &Int(0)), None);
        assert_eq!(binary(Instr::IntRem {}, &Int(1), &Int(0)), None);
        assert_eq!(binary(Instr::RealDiv {}, &Real(0.0), &Real(0.0)), None);
        assert_eq!(binary(Instr::RealMin {}, &Real(0.0), &Real(-0.0)), None);
        assert_eq!(unary(Instr::RealToInt {}, &Real(1e19)), None);
        assert_eq!(unary(Instr::RealToInt {}, &Real(-1.9)), Some(Int(-1)));
        assert_eq!(unary(Instr::RealSqrt {}, &Real(-1.0)), None);
    }
}
