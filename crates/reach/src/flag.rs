//! The flags that say that the sequences under way are being left.
//!
//! A program that gives up after an error sets a variable and returns, and every caller looks at it
//! and returns too; another one says that the program then begins again. Without them, what is
//! behind a call would seem to be reached also from the place of the error, and the beginning from
//! the end. So the analysis follows two truth values of the program that are only ever set to
//! constants: one that the compiler has made (the first), or else the one that is looked at most
//! often; and one that the start looks at, since it alone begins again. Any such choice is sound.

use obverse_bytecode::Module;
use obverse_isa::{GlobalId, Instr, Level, Type};

/// How many flags are followed.
const MAX_FLAGS: usize = 2;

/// How many values they have together: a bit a flag.
pub(crate) const VALUES: usize = 1 << MAX_FLAGS;

/// One of the flags that are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Flag(usize);

impl Flag {
    /// Whether it is set in a value of all flags.
    pub(crate) fn is_set(self, value: usize) -> bool {
        value & self.bit() != 0
    }

    /// The values of all flags that differ from this one in this flag alone.
    pub(crate) fn bit(self) -> usize {
        1 << self.0
    }
}

/// What an instruction does to the flags, or asks of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Touch {
    /// It does not.
    None,
    /// It sets one.
    Set(Flag, bool),
    /// It jumps if one has this value, and goes on beside otherwise.
    JumpsIf(Flag, bool),
}

/// The flags of a module.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flags([Option<GlobalId>; MAX_FLAGS]);

impl Flags {
    pub(crate) fn of(module: &Module) -> Self {
        let is_bool = |global: &obverse_bytecode::Variable| global.of_type == Type::Bool;
        let mut tests: Vec<Option<usize>> =
            module.globals.iter().map(|global| is_bool(global).then_some(0)).collect();
        let start = module.functions.first().map_or(0, |start| start.end as usize);
        let mut is_tested_by_start = vec![false; module.globals.len()];
        for (at, instr) in module.code.iter().enumerate() {
            match *instr {
                Instr::StoreGlobal { global, .. } if constant(module, at).is_none() => {
                    tests[global.index()] = None;
                }
                Instr::JumpIf { .. } | Instr::JumpUnless { .. } => {
                    let Some(global) = alone(module, at).and_then(read) else { continue };
                    is_tested_by_start[global.index()] |= at < start;
                    tests[global.index()].iter_mut().for_each(|count| *count += 1);
                }
                _ => {}
            }
        }
        let is_tested = |&global: &usize| tests[global].is_some_and(|count| count > 0);
        let mut tested: Vec<usize> = (0..tests.len()).filter(is_tested).collect();
        // No name that is written in a source begins so.
        let is_written = |global: usize| !module.globals[global].name.starts_with('$');
        tested.sort_by_key(|&global| match is_written(global) {
            false => (false, 0),
            true => (true, usize::MAX - tests[global].unwrap_or(0)),
        });
        let id = |global: usize| GlobalId(global as u16);
        let mut tested = tested.into_iter();
        let first = tested.next().map(id);
        Self([first, tested.find(|&global| is_tested_by_start[global]).map(id)])
    }

    /// How many values they can have.
    pub(crate) fn values(self) -> usize {
        1 << self.0.iter().flatten().count()
    }

    pub(crate) fn touch(self, module: &Module, at: usize) -> Touch {
        let flag = |global: Option<GlobalId>| {
            let known = self.0.iter().position(|flag| flag.is_some() && *flag == global);
            known.map(Flag)
        };
        let is_read = || flag(alone(module, at).and_then(read));
        let touch = match module.code[at] {
            Instr::StoreGlobal { global, .. } => flag(Some(global))
                .zip(constant(module, at))
                .map(|(flag, value)| Touch::Set(flag, value)),
            Instr::JumpIf { .. } => is_read().map(|flag| Touch::JumpsIf(flag, true)),
            Instr::JumpUnless { .. } => is_read().map(|flag| Touch::JumpsIf(flag, false)),
            _ => None,
        };
        touch.unwrap_or(Touch::None)
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
