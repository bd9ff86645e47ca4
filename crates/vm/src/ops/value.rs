//! The family `value`: pure instructions, which touch the operand stack alone.

use crate::class::Pure;
use crate::stop::TrapKind;
use crate::values::Values;
use obverse_isa::op;

/// Implement [`Pure`] for opcodes that cannot trap: `Op { operands } with values => body`.
macro_rules! pure {
    ($($op:ident { $($field:ident),* }, $values:ident => $body:expr;)*) => {$(
        impl Pure for op::$op {
            #[inline(always)]
            fn run(self, $values: &mut Values<'_>) -> Result<(), TrapKind> {
                let op::$op { $($field),* } = self;
                $body;
                Ok(())
            }
        }
    )*};
}

/// Opcodes that take two values of a type and leave one: `Op(a, b) => value`.
macro_rules! binary {
    ($pop:ident, $push:ident: $($op:ident($a:ident, $b:ident) => $value:expr;)*) => {$(
        impl Pure for op::$op {
            #[inline(always)]
            fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
                let $b = values.$pop();
                let $a = values.$pop();
                values.$push($value);
                Ok(())
            }
        }
    )*};
}

/// Opcodes that take one value and leave one: `Op(a) => value`.
macro_rules! unary {
    ($($op:ident, $pop:ident($a:ident) => $push:ident($value:expr);)*) => {$(
        impl Pure for op::$op {
            #[inline(always)]
            fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
                let $a = values.$pop();
                values.$push($value);
                Ok(())
            }
        }
    )*};
}

pure! {
    PushInt { value }, values => values.push_int(i64::from(value));
    PushConstant { constant }, values => values.push(values.fixed.constants[constant.index()]);
    PushBool { value }, values => values.push_bool(value.is_high());
    PushLocal { local }, values => values.push(values.local(local));
    PushGlobal { global }, values => values.push(values.global(global));
    PushCounter { counter }, values => values.push_int(values.counter(counter));
    PushJoints { joints }, values => values.push(u64::from(joints.0));
    PushItem { item }, values => values.push(u64::from(item.0));
    PushSpeed { speed }, values => values.push(speed as u64);
    PushTool { tool }, values => values.push(values.fixed.tools[tool.index()]);
    PushSetting { setting }, values => values.push(values.setting(setting));
    PushRaised { error }, values => values.push_bool(values.is_raised(error));
    IntAddLocals { left, right }, values => {
        values.push(values.local(left).wrapping_add(values.local(right)))
    };
    IntAddLocal { local }, values => {
        let sum = values.pop().wrapping_add(values.local(local));
        values.push(sum);
    };
    IntAddImmediate { value }, values => {
        let sum = values.pop_int().wrapping_add(i64::from(value));
        values.push_int(sum);
    };
    IntMulImmediate { value }, values => {
        let product = values.pop_int().wrapping_mul(i64::from(value));
        values.push_int(product);
    };
    IntMulLocalImmediate { local, value }, values => {
        values.push_int(values.local(local).cast_signed().wrapping_mul(i64::from(value)))
    };
}

binary! { pop_int, push_int:
    IntAdd(a, b) => a.wrapping_add(b);
    IntSub(a, b) => a.wrapping_sub(b);
    IntMul(a, b) => a.wrapping_mul(b);
    IntMin(a, b) => a.min(b);
    IntMax(a, b) => a.max(b);
}

binary! { pop_int, push_bool:
    IntLt(a, b) => a < b;
    IntLe(a, b) => a <= b;
    IntEq(a, b) => a == b;
    IntNe(a, b) => a != b;
}

binary! { pop_real, push_real:
    RealAdd(a, b) => a + b;
    RealSub(a, b) => a - b;
    RealMul(a, b) => a * b;
    RealDiv(a, b) => a / b;
    // Written out since the standard library leaves the sign of a zero open.
    RealMin(a, b) => if a < b || b.is_nan() { a } else { b };
    RealMax(a, b) => if a > b || b.is_nan() { a } else { b };
}

binary! { pop_real, push_bool:
    RealLt(a, b) => a < b;
    RealLe(a, b) => a <= b;
    RealEq(a, b) => a == b;
    RealNe(a, b) => a != b;
}

binary! { pop_bool, push_bool:
    BoolAnd(a, b) => a & b;
    BoolOr(a, b) => a | b;
    BoolEq(a, b) => a == b;
}

unary! {
    IntNeg, pop_int(a) => push_int(a.wrapping_neg());
    IntAbs, pop_int(a) => push_int(a.wrapping_abs());
    RealNeg, pop_real(a) => push_real(-a);
    RealAbs, pop_real(a) => push_real(a.abs());
    RealSqrt, pop_real(a) => push_real(a.sqrt());
    IntToReal, pop_int(a) => push_real(a as f64);
    BoolNot, pop_bool(a) => push_bool(!a);
}

impl Pure for op::IntDiv {
    #[inline(always)]
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
        let divisor = values.pop_int();
        let dividend = values.pop_int();
        if divisor == 0 {
            return Err(TrapKind::DivisionByZero);
        }
        values.push_int(dividend.wrapping_div(divisor));
        Ok(())
    }
}

#[inline(always)]
fn push_remainder(values: &mut Values<'_>, dividend: i64, divisor: i64) -> Result<(), TrapKind> {
    if divisor == 0 {
        return Err(TrapKind::DivisionByZero);
    }
    // Half the cost where both fit 32 bits, which is nearly always.
    let remainder = match (u32::try_from(dividend), u32::try_from(divisor)) {
        (Ok(dividend), Ok(divisor)) => i64::from(dividend % divisor),
        _ => dividend.wrapping_rem(divisor),
    };
    values.push_int(remainder);
    Ok(())
}

impl Pure for op::IntRem {
    #[inline(always)]
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
        let divisor = values.pop_int();
        let dividend = values.pop_int();
        push_remainder(values, dividend, divisor)
    }
}

impl Pure for op::IntRemImmediate {
    #[inline(always)]
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
        let dividend = values.pop_int();
        push_remainder(values, dividend, i64::from(self.value))
    }
}

impl Pure for op::IntRemLocalImmediate {
    #[inline(always)]
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
        let dividend = values.local(self.local).cast_signed();
        push_remainder(values, dividend, i64::from(self.value))
    }
}

impl Pure for op::IntRemCounterImmediate {
    #[inline(always)]
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
        let dividend = values.counter(self.counter);
        push_remainder(values, dividend, i64::from(self.value))
    }
}

impl Pure for op::RealToInt {
    #[inline(always)]
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
        const LIMIT: f64 = 9_223_372_036_854_775_808.0;
        let value = values.pop_real().trunc();
        if !(-LIMIT..LIMIT).contains(&value) {
            return Err(TrapKind::NotAnInteger);
        }
        values.push_int(value as i64);
        Ok(())
    }
}
