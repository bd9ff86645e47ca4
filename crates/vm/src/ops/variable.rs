//! The family `variable`: stores, which save the former value, and updates of integers, which have
//! an exact inverse.

use crate::class::{AfterForward, Always, Failure};
use crate::values::Variables;
use obverse_isa::op;
use obverse_tape::record::Word;

impl AfterForward<Variables<'_, '_>> for op::StoreLocal {
    type Saved = Word;

    #[inline(always)]
    fn save(&self, variables: &Variables<'_, '_>) -> Word {
        Word(variables.values().local(self.local))
    }

    #[inline(always)]
    fn forward(self, variables: &mut Variables<'_, '_>, _: &Word) -> Result<(), Failure> {
        *variables.local(self.local) = variables.top();
        Ok(())
    }

    #[inline(always)]
    fn reverse(self, variables: &mut Variables<'_, '_>, saved: &Word) -> Result<(), Failure> {
        *variables.local(self.local) = saved.0;
        Ok(())
    }
}

impl AfterForward<Variables<'_, '_>> for op::StoreGlobal {
    type Saved = Word;

    #[inline(always)]
    fn save(&self, variables: &Variables<'_, '_>) -> Word {
        Word(variables.values().global(self.global))
    }

    #[inline(always)]
    fn forward(self, variables: &mut Variables<'_, '_>, _: &Word) -> Result<(), Failure> {
        *variables.global(self.global) = variables.top();
        Ok(())
    }

    #[inline(always)]
    fn reverse(self, variables: &mut Variables<'_, '_>, saved: &Word) -> Result<(), Failure> {
        *variables.global(self.global) = saved.0;
        Ok(())
    }
}

/// Updates with an exact inverse: a place, the operand, what adds and what takes away again.
macro_rules! updates {
    ($($op:ident($op_value:ident, $variables:ident)
        $place:expr, $operand:expr, $forward:ident / $reverse:ident;)*) => {$(
        impl Always<Variables<'_, '_>> for op::$op {
            #[inline(always)]
            fn forward(self, $variables: &mut Variables<'_, '_>) -> Result<(), Failure> {
                let $op_value = self;
                let operand = $operand;
                let place = $place;
                *place = place.$forward(operand);
                Ok(())
            }

            #[inline(always)]
            fn reverse(self, $variables: &mut Variables<'_, '_>) -> Result<(), Failure> {
                let $op_value = self;
                let operand = $operand;
                let place = $place;
                *place = place.$reverse(operand);
                Ok(())
            }
        }
    )*};
}

updates! {
    AddLocal(op, variables)
        variables.local(op.local), variables.top(), wrapping_add / wrapping_sub;
    SubLocal(op, variables)
        variables.local(op.local), variables.top(), wrapping_sub / wrapping_add;
    AddGlobal(op, variables)
        variables.global(op.global), variables.top(), wrapping_add / wrapping_sub;
    SubGlobal(op, variables)
        variables.global(op.global), variables.top(), wrapping_sub / wrapping_add;
    AddLocalImmediate(op, variables)
        variables.local(op.local), i64::from(op.value).cast_unsigned(), wrapping_add / wrapping_sub;
    AddLocalLocal(op, variables)
        variables.local(op.local), variables.values().local(op.value), wrapping_add / wrapping_sub;
    AddLocalCounter(op, variables)
        variables.local(op.local), variables.values().counter(op.counter).cast_unsigned(),
        wrapping_add / wrapping_sub;
    SubLocalLocal(op, variables)
        variables.local(op.local), variables.values().local(op.value), wrapping_sub / wrapping_add;
    SubLocalCounter(op, variables)
        variables.local(op.local), variables.values().counter(op.counter).cast_unsigned(),
        wrapping_sub / wrapping_add;
}
