//! The flag that says that the sequences under way are being left.
//!
//! A program that gives up after an error sets a variable and returns, and every caller looks at it
//! and returns too. Without it, what is behind a call would seem to be reached also from the place
//! of the error. So the analysis follows one truth value of the program: the one that is looked at
//! most often among those that are only ever set to a constant. Any such choice is sound.

use obverse_bytecode::Module;
use obverse_isa::{GlobalId, Instr, Level, Type};

/// What an instruction does to the flag, or asks of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Touch {
    /// It does not.
    None,
    /// It sets it.
    Set(bool),
    /// It jumps if it has this value, and goes on beside otherwise.
    JumpsIf(bool),
}

/// The flag of a module, if it has one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flag(Option<GlobalId>);

impl Flag {
    pub(crate) fn of(module: &Module) -> Self {
        let is_bool = |global: &obverse_bytecode::Variable| global.of_type == Type::Bool;
        let mut tests: Vec<Option<u32>> =
            module.globals.iter().map(|global| is_bool(global).then_some(0)).collect();
        for (at, instr) in module.code.iter().enumerate() {
            match *instr {
                Instr::StoreGlobal { global, .. } if constant(module, at).is_none() => {
                    tests[global.index()] = None;
                }
                Instr::JumpIf { .. } | Instr::JumpUnless { .. } => {
                    let global = alone(module, at).and_then(read);
                    let count = global.and_then(|global| tests[global.index()].as_mut());
                    count.into_iter().for_each(|count| *count += 1);
                }
                _ => {}
            }
        }
        let counted = tests.iter().enumerate().filter_map(|(at, count)| Some(((*count)?, at)));
        let most = counted.max_by_key(|&(count, at)| (count, std::cmp::Reverse(at)));
        Self(most.filter(|(count, _)| *count > 0).map(|(_, at)| GlobalId(at as u16)))
    }

    pub(crate) fn is_some(self) -> bool {
        self.0.is_some()
    }

    pub(crate) fn touch(self, module: &Module, at: usize) -> Touch {
        let is_read = || alone(module, at).and_then(read) == self.0;
        match module.code[at] {
            _ if self.0.is_none() => Touch::None,
            Instr::StoreGlobal { global, .. } if Some(global) == self.0 => {
                constant(module, at).map_or(Touch::None, Touch::Set)
            }
            Instr::JumpIf { .. } if is_read() => Touch::JumpsIf(true),
            Instr::JumpUnless { .. } if is_read() => Touch::JumpsIf(false),
            _ => Touch::None,
        }
    }
}

/// The prefix of an effect, if it is one instruction.
fn alone(module: &Module, effect: usize) -> Option<Instr> {
    let has_one = module.code[effect].prefix() == 1;
    effect.checked_sub(1).filter(|_| has_one).map(|at| module.code[at])
}

fn read(instr: Instr) -> Option<GlobalId> {
    match instr {
        Instr::PushGlobal { global } => Some(global),
        _ => None,
    }
}

/// What a store stores, if it is a truth value written there.
fn constant(module: &Module, store: usize) -> Option<bool> {
    match alone(module, store) {
        Some(Instr::PushBool { value }) => Some(value == Level::High),
        _ => None,
    }
}
