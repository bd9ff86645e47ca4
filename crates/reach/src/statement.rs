//! Which instructions of a statement are asked of, by whoever shows a program with what can be
//! taken back. Knows no source text.

use obverse_bytecode::Module;
use obverse_isa::{Family, Instr};

/// The first instruction from which the statement of instructions `first` to `end` is gone back
/// from as a whole: behind its joins, where the ways to it have met.
#[must_use]
pub fn point(module: &Module, first: u32, end: u32) -> u32 {
    let mut point = first;
    for pc in first..end {
        let instr = &module.code[pc as usize];
        if instr.join_from().is_some() {
            point = pc + 1;
        } else if !instr.info().family.is_pure() {
            break;
        }
    }
    point.min(end - 1)
}

/// Whether an instruction is worth a class to people.
#[must_use]
pub fn does_something(instr: &Instr) -> bool {
    match instr.info().family {
        Family::Value | Family::Flow => false,
        Family::Frame => matches!(instr, Instr::Call { .. }),
        _ => true,
    }
}
