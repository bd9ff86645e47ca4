//! Conditions as jumps: which instruction tests them with the fewest before it.

use super::Lower;
use crate::tree::{Expression, ExpressionKind};
use obverse_isa::{Instr, Label, LocalId, Prefix};

/// A jump that depends on what the prefix has computed; it only lacks its target.
#[derive(Clone, Copy)]
pub(super) enum Test {
    /// Jump if true.
    If,
    /// Jump unless true.
    Unless,
    /// Jump unless less.
    UnlessLt,
    /// Jump unless less or equal.
    UnlessLe,
    /// Jump unless equal.
    UnlessEq,
    /// Jump unless different.
    UnlessNe,
    /// Jump unless equal to this.
    UnlessEqImmediate(i16),
    /// Jump unless the local is less than this.
    UnlessLocalLtImmediate(LocalId, i16),
    /// Jump unless the first local is less than the second.
    UnlessLocalLtLocal(LocalId, LocalId),
}

impl Test {
    /// The instruction.
    pub(super) fn to(self, target: Label) -> Instr {
        // The builder counts the prefix.
        let prefix = Prefix(0);
        match self {
            Self::If => Instr::JumpIf { prefix, target },
            Self::Unless => Instr::JumpUnless { prefix, target },
            Self::UnlessLt => Instr::JumpUnlessLt { prefix, target },
            Self::UnlessLe => Instr::JumpUnlessLe { prefix, target },
            Self::UnlessEq => Instr::JumpUnlessEq { prefix, target },
            Self::UnlessNe => Instr::JumpUnlessNe { prefix, target },
            Self::UnlessEqImmediate(value) => {
                Instr::JumpUnlessEqImmediate { prefix, value, target }
            }
            Self::UnlessLocalLtImmediate(local, value) => {
                Instr::JumpUnlessLocalLtImmediate { local, value, target }
            }
            Self::UnlessLocalLtLocal(left, right) => {
                Instr::JumpUnlessLocalLtLocal { left, right, target }
            }
        }
    }

    /// Whether it needs nothing before it.
    pub(super) fn is_alone(self) -> bool {
        matches!(self, Self::UnlessLocalLtImmediate(..) | Self::UnlessLocalLtLocal(..))
    }
}

/// A comparison of integers that a jump is made unless it holds, and what it compares.
type Comparison<'e> = (Instr, &'e Expression, &'e Expression);

impl Lower<'_> {
    /// Compute what a jump needs that is taken if the condition is `when`.
    pub(super) fn test(&mut self, condition: &Expression, when: bool) -> Test {
        let (test, operands) = plan(condition, when);
        for operand in operands.into_iter().flatten() {
            self.expression(operand);
        }
        test
    }
}

/// Whether a jump on a condition is one instruction.
pub(super) fn is_alone(condition: &Expression, when: bool) -> bool {
    plan(condition, when).0.is_alone()
}

/// The jump, and what is computed before it.
fn plan(condition: &Expression, when: bool) -> (Test, [Option<&Expression>; 2]) {
    if let ExpressionKind::Unary(Instr::BoolNot {}, operand) = &condition.kind {
        return plan(operand, !when);
    }
    match comparison(condition, when) {
        Some(comparison) => fuse(comparison),
        None if when => (Test::If, [Some(condition), None]),
        None => (Test::Unless, [Some(condition), None]),
    }
}

/// The comparison that holds where the jump is not taken.
fn comparison(condition: &Expression, when: bool) -> Option<Comparison<'_>> {
    let ExpressionKind::Binary(instr, operands) = &condition.kind else { return None };
    let (left, right) = (&operands.0, &operands.1);
    Some(match (instr, when) {
        (Instr::IntLt {} | Instr::IntLe {} | Instr::IntEq {} | Instr::IntNe {}, false) => {
            (*instr, left, right)
        }
        (Instr::IntLt {}, true) => (Instr::IntLe {}, right, left),
        (Instr::IntLe {}, true) => (Instr::IntLt {}, right, left),
        (Instr::IntEq {}, true) => (Instr::IntNe {}, left, right),
        (Instr::IntNe {}, true) => (Instr::IntEq {}, left, right),
        _ => return None,
    })
}

fn fuse((instr, left, right): Comparison<'_>) -> (Test, [Option<&Expression>; 2]) {
    use ExpressionKind::{Int, Local};
    let both = [Some(left), Some(right)];
    let alone = [None, None];
    match (instr, &left.kind, &right.kind) {
        (Instr::IntLt {}, Local(local), Int(value)) if fits(*value) => {
            (Test::UnlessLocalLtImmediate(*local, *value as i16), alone)
        }
        (Instr::IntLe {}, Local(local), Int(value)) if fits(value.saturating_add(1)) => {
            (Test::UnlessLocalLtImmediate(*local, (*value + 1) as i16), alone)
        }
        (Instr::IntLt {}, Local(left), Local(right)) => {
            (Test::UnlessLocalLtLocal(*left, *right), alone)
        }
        (Instr::IntEq {}, _, Int(value)) if fits(*value) => {
            (Test::UnlessEqImmediate(*value as i16), [Some(left), None])
        }
        (Instr::IntEq {}, Int(value), _) if fits(*value) => {
            (Test::UnlessEqImmediate(*value as i16), [Some(right), None])
        }
        (Instr::IntLt {}, ..) => (Test::UnlessLt, both),
        (Instr::IntLe {}, ..) => (Test::UnlessLe, both),
        (Instr::IntEq {}, ..) => (Test::UnlessEq, both),
        _ => (Test::UnlessNe, both),
    }
}

fn fits(value: i64) -> bool {
    i16::try_from(value).is_ok()
}
