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

/// What a word on the stack is, by type.
fn int(word: u64) -> i64 {
    word.cast_signed()
}

fn real(word: u64) -> f64 {
    f64::from_bits(word)
}

fn bool(word: u64) -> bool {
    word != 0
}

fn of_int(value: i64) -> u64 {
    value.cast_unsigned()
}

/// What is no number has the same bits on every machine.
fn of_real(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() & !(1 << 63) } else { value.to_bits() }
}

fn of_bool(value: bool) -> u64 {
    u64::from(value)
}

/// Opcodes that take two values of a type and leave one: `Op(a, b) => value`.
macro_rules! binary {
    ($from:ident -> $to:ident: $($op:ident($a:ident, $b:ident) => $value:expr;)*) => {$(
        impl Pure for op::$op {
            #[inline(always)]
            fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
                values.binary(|a, b| {
                    let ($a, $b) = ($from(a), $from(b));
                    $to($value)
                });
                Ok(())
            }
        }
    )*};
}

/// Opcodes that take one value and leave one: `Op: from -> to, (a) => value`.
macro_rules! unary {
    ($($op:ident: $from:ident -> $to:ident, ($a:ident) => $value:expr;)*) => {$(
        impl Pure for op::$op {
            #[inline(always)]
            fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
                values.unary(|a| {
                    let $a = $from(a);
                    $to($value)
                });
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
        values.push(values.local(left).wrapping_add(values.local(right)));
    };
    IntAddLocal { local }, values => {
        let term = values.local(local);
        values.unary(|top| top.wrapping_add(term));
    };
    IntAddImmediate { value }, values => {
        values.unary(|top| of_int(int(top).wrapping_add(i64::from(value))));
    };
    IntMulImmediate { value }, values => {
        values.unary(|top| of_int(int(top).wrapping_mul(i64::from(value))));
    };
    IntMulLocalImmediate { local, value }, values => {
        values.push_int(values.local(local).cast_signed().wrapping_mul(i64::from(value)));
    };
    IntMulCounterImmediate { counter, value }, values => {
        values.push_int(values.counter(counter).wrapping_mul(i64::from(value)));
    };
}

binary! { int -> of_int:
    IntAdd(a, b) => a.wrapping_add(b);
    IntSub(a, b) => a.wrapping_sub(b);
    IntMul(a, b) => a.wrapping_mul(b);
    IntMin(a, b) => a.min(b);
    IntMax(a, b) => a.max(b);
}

binary! { int -> of_bool:
    IntLt(a, b) => a < b;
    IntLe(a, b) => a <= b;
    IntEq(a, b) => a == b;
    IntNe(a, b) => a != b;
}

binary! { real -> of_real:
    RealAdd(a, b) => a + b;
    RealSub(a, b) => a - b;
    RealMul(a, b) => a * b;
    RealDiv(a, b) => a / b;
    // Written out since the standard library leaves the sign of a zero open.
    RealMin(a, b) => if a < b || b.is_nan() { a } else { b };
    RealMax(a, b) => if a > b || b.is_nan() { a } else { b };
}

binary! { real -> of_bool:
    RealLt(a, b) => a < b;
    RealLe(a, b) => a <= b;
    RealEq(a, b) => a == b;
    RealNe(a, b) => a != b;
}

binary! { bool -> of_bool:
    BoolAnd(a, b) => a & b;
    BoolOr(a, b) => a | b;
    BoolEq(a, b) => a == b;
}

unary! {
    IntNeg: int -> of_int, (a) => a.wrapping_neg();
    IntAbs: int -> of_int, (a) => a.wrapping_abs();
    RealNeg: real -> of_real, (a) => -a;
    RealAbs: real -> of_real, (a) => a.abs();
    RealSqrt: real -> of_real, (a) => a.sqrt();
    IntToReal: int -> of_real, (a) => a as f64;
    BoolNot: bool -> of_bool, (a) => !a;
}

impl Pure for op::IntDiv {
    #[inline(always)]
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
        if values.top() == 0 {
            return Err(TrapKind::DivisionByZero);
        }
        values.binary(|dividend, divisor| of_int(int(dividend).wrapping_div(int(divisor))));
        Ok(())
    }
}

/// Half the cost where both fit 32 bits, which is nearly always; the divisor is not zero.
#[inline(always)]
fn remainder(dividend: i64, divisor: i64) -> u64 {
    of_int(match (u32::try_from(dividend), u32::try_from(divisor)) {
        (Ok(dividend), Ok(divisor)) if divisor != 0 => i64::from(dividend % divisor),
        _ => dividend.wrapping_rem(divisor),
    })
}

impl Pure for op::IntRem {
    #[inline(always)]
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
        if values.top() == 0 {
            return Err(TrapKind::DivisionByZero);
        }
        values.binary(|dividend, divisor| remainder(int(dividend), int(divisor)));
        Ok(())
    }
}

/// Remainders by a small integer: what is divided, and how it is put on the stack.
macro_rules! remainders {
    ($($op:ident($this:ident, $values:ident) $put:ident $dividend:expr;)*) => {$(
        impl Pure for op::$op {
            #[inline(always)]
            fn run(self, $values: &mut Values<'_>) -> Result<(), TrapKind> {
                let $this = self;
                let _ = $this;
                if self.value == 0 {
                    return Err(TrapKind::DivisionByZero);
                }
                let left = remainder($dividend, i64::from(self.value));
                remainders!(@ $put $values, left);
                Ok(())
            }
        }
    )*};
    (@ push $values:ident, $left:ident) => { $values.push($left) };
    (@ replace $values:ident, $left:ident) => { $values.unary(|_| $left) };
}

remainders! {
    IntRemImmediate(_op, values) replace int(values.top());
    IntRemLocalImmediate(op, values) push int(values.local(op.local));
    IntRemCounterImmediate(op, values) push values.counter(op.counter);
}

impl Pure for op::RealToInt {
    #[inline(always)]
    fn run(self, values: &mut Values<'_>) -> Result<(), TrapKind> {
        const LIMIT: f64 = 9_223_372_036_854_775_808.0;
        let value = real(values.top()).trunc();
        if !(-LIMIT..LIMIT).contains(&value) {
            return Err(TrapKind::NotAnInteger);
        }
        values.unary(|_| of_int(value as i64));
        Ok(())
    }
}
