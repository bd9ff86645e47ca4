//! What a pure instruction makes of its operands, for whoever reasons about code and does not run
//! it. The same code as the machine's, so that there is one arithmetic. Knows no state.

use crate::hot;
use crate::stop::TrapKind;
use crate::values::{Fixed, Settings, Values, Words};
use obverse_isa::{Instr, OperandKind};

/// Does single pure instructions.
#[derive(Clone, Debug, Default)]
pub struct Calculator {
    words: Box<Words>,
}

impl Calculator {
    /// What an instruction leaves of its operands, the newest last; none if it looks at more than
    /// its operands, or takes another number of them.
    ///
    /// # Errors
    /// A trap: a division by zero, a real that is no integer.
    pub fn result(&mut self, instr: Instr, operands: &[u64]) -> Option<Result<u64, TrapKind>> {
        let info = instr.info();
        let looks_at_more = info.operands.iter().any(|(_, kind)| *kind != OperandKind::Integer);
        let is_fitting = info.family.is_pure() && info.pops.len() == operands.len();
        let (top, below) = operands.split_last()?;
        if looks_at_more || !is_fitting {
            return None;
        }
        self.words.parts_mut().1[..below.len()].copy_from_slice(below);
        let fixed =
            Fixed { constants: &[], tools: &[], settings: Settings::default(), raised: &[] };
        let mut values = Values {
            words: &mut self.words,
            top: *top,
            depth: operands.len() as u8,
            globals: &mut Vec::new(),
            fixed: &fixed,
        };
        let done = hot::evaluate(&[instr], 0, 1, &mut values);
        Some(done.map(|()| values.top).map_err(|(_, kind)| kind))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use obverse_isa::LocalId;

    #[test]
    fn it_calculates_as_the_machine_does() {
        let mut calculator = Calculator::default();
        let two = |calculator: &mut Calculator, instr, a: i64, b: i64| {
            calculator.result(instr, &[a.cast_unsigned(), b.cast_unsigned()])
        };
        let sub = two(&mut calculator, Instr::IntSub {}, 3, 5);
        assert_eq!(sub, Some(Ok((-2_i64).cast_unsigned())));
        let div = two(&mut calculator, Instr::IntDiv {}, 3, 0);
        assert_eq!(div, Some(Err(TrapKind::DivisionByZero)));
        let root = calculator.result(Instr::RealSqrt {}, &[2.25_f64.to_bits()]);
        assert_eq!(root, Some(Ok(1.5_f64.to_bits())));
        let immediate = calculator.result(Instr::IntMulImmediate { value: -4 }, &[6]);
        assert_eq!(immediate, Some(Ok((-24_i64).cast_unsigned())));
    }

    #[test]
    fn what_looks_at_more_than_its_operands_is_left_alone() {
        let mut calculator = Calculator::default();
        assert_eq!(calculator.result(Instr::IntAddLocal { local: LocalId(0) }, &[1]), None);
        assert_eq!(calculator.result(Instr::PushInt { value: 1 }, &[]), None);
        assert_eq!(calculator.result(Instr::IntAdd {}, &[1]), None);
        assert_eq!(calculator.result(Instr::Halt {}, &[1]), None);
    }
}
