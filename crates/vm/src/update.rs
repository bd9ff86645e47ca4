//! Updates of a local integer that a run in reverse undoes in one operation, in place of running
//! the prefix once more and then the inverse.
//!
//! A statement that only adds, subtracts and multiplies by numbers of the code takes from its
//! variable a linear form of other slots. Which form that is, the machine itself is asked: its own
//! code undoes the statement where all slots are zero, and where one of them is one.

use crate::hot::{self, Exit, Place};
use crate::reversed::Reversed;
use crate::values::{CounterSlots, Fixed, Settings, Values, Words};
use obverse_isa::{Class, CounterId, Family, Instr, OperandKind};
use obverse_tape::Tape;

/// The undoing of an update: a slot gets `scales[0] * slots[0] + scales[1] * slots[1] + constant`
/// added, wrapping. What is not read has the scale 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Update {
    changed: u8,
    slots: [u8; 2],
    scales: [i16; 2],
    constant: i32,
}

impl Update {
    #[inline(always)]
    pub(crate) fn undo(self, values: &mut Values<'_>) {
        let words = &mut *values.words;
        let term = |at: usize| {
            let scale = i64::from(self.scales[at]).cast_unsigned();
            words.slot(self.slots[at]).wrapping_mul(scale)
        };
        let constant = i64::from(self.constant).cast_unsigned();
        let sum = term(0).wrapping_add(term(1)).wrapping_add(constant);
        let changed = words.slot_mut(self.changed);
        *changed = changed.wrapping_add(sum);
    }
}

/// What undoes an effect.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Undo {
    /// The reverse of this instruction.
    Instr(Instr),
    /// One operation for the whole statement.
    Update(Update),
}

const _: () = assert!(size_of::<Undo>() == 16, "half of a row");

/// Finds updates.
#[derive(Default)]
pub(crate) struct Updates {
    words: Box<Words>,
}

impl Updates {
    /// What undoes the statement of this effect.
    pub(crate) fn undo(&mut self, code: &[Instr], effect: usize) -> Undo {
        self.update(code, effect).map_or(Undo::Instr(code[effect]), Undo::Update)
    }

    fn update(&mut self, code: &[Instr], effect: usize) -> Option<Update> {
        let start = effect.checked_sub(usize::from(code[effect].prefix()))?;
        let statement = &code[start..=effect];
        let (last, prefix) = statement.split_last()?;
        if !is_update_of_local(*last) || !prefix.iter().all(|instr| is_linear(*instr)) {
            return None;
        }
        let (changed, read) = slots(statement)?;
        let constant = self.undone(statement, changed, None);
        let mut scale = |slot| {
            let scaled = self.undone(statement, changed, Some(slot)).wrapping_sub(constant);
            i16::try_from(scaled.cast_signed()).ok()
        };
        Some(Update {
            changed,
            slots: read.map(|slot| slot.unwrap_or(changed)),
            scales: [read[0].map_or(Some(0), &mut scale)?, read[1].map_or(Some(0), scale)?],
            constant: i32::try_from(constant.cast_signed()).ok()?,
        })
    }

    /// What a slot holds when a statement has been undone where all slots were zero, except one
    /// that was one.
    fn undone(&mut self, statement: &[Instr], changed: u8, one: Option<u8>) -> u64 {
        self.words.parts_mut().0.fill(0);
        if let Some(slot) = one {
            *self.words.slot_mut(slot) = 1;
        }
        undo(statement, &mut self.words);
        self.words.slot(changed)
    }
}

/// Undo an update as the machine does that has no operation for it: by running its prefix and then
/// the inverse.
fn undo(statement: &[Instr], words: &mut Words) {
    let fixed = Fixed { constants: &[], tools: &[], settings: Settings::default(), raised: &[] };
    let mut values = Values { words, top: 0, depth: 0, globals: &mut Vec::new(), fixed: &fixed };
    let rows: Vec<_> = statement.iter().map(|instr| Reversed::by_instr(*instr)).collect();
    let mut place = Place { pc: statement.len(), offset: 0 };
    let mut tape = Tape::default();
    let exit = hot::reverse::<true>(statement, &rows, &mut values, &mut place, 0, &mut tape);
    debug_assert_eq!(exit, Exit::One, "an update of linear forms does not trap");
}

/// Whether an instruction makes a linear form of linear forms.
fn is_linear(instr: Instr) -> bool {
    matches!(
        instr,
        Instr::PushInt { .. }
            | Instr::PushLocal { .. }
            | Instr::PushCounter { .. }
            | Instr::IntAdd {}
            | Instr::IntSub {}
            | Instr::IntNeg {}
            | Instr::IntAddImmediate { .. }
            | Instr::IntMulImmediate { .. }
            | Instr::IntAddLocals { .. }
            | Instr::IntAddLocal { .. }
            | Instr::IntMulLocalImmediate { .. }
            | Instr::IntMulCounterImmediate { .. }
    )
}

/// Whether an effect adds something to a local integer, and keeps no record of it.
fn is_update_of_local(instr: Instr) -> bool {
    let info = instr.info();
    let changes_local = info.operands.iter().any(|(_, kind)| *kind == OperandKind::Local);
    info.family == Family::Variable && info.class == Class::Always && changes_local
}

/// The slot that the last instruction of a statement names first, which is the one that it changes,
/// and those that the statement reads, if they are no more than two.
fn slots(statement: &[Instr]) -> Option<(u8, [Option<u8>; 2])> {
    let (effect, prefix) = statement.split_last()?;
    let mut named = Vec::new();
    for instr in std::iter::once(effect).chain(prefix) {
        instr.each_operand(&mut |kind, _, number| {
            let index = number as u8;
            match kind {
                OperandKind::Local => named.push(index),
                OperandKind::Counter => named.push(CounterSlots::of(CounterId(index)).present),
                _ => {}
            }
        });
    }
    let (changed, read) = named.split_first_mut()?;
    read.sort_unstable();
    let mut read = read.chunk_by(|a, b| a == b).map(|same| same[0]);
    let two = [read.next(), read.next()];
    read.next().is_none().then_some((*changed, two))
}

#[cfg(test)]
mod tests {
    use super::*;
    use obverse_isa::{LocalId, OPS, Opcode, OperandError};

    /// Words that are spread over all values.
    fn spread(seed: u64) -> u64 {
        let word = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (word ^ word >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9)
    }

    /// An instruction whose locals and counters are small numbers that follow from a seed.
    fn instruction(opcode: Opcode, seed: u64) -> Instr {
        let mut count = seed;
        let made = Instr::from_operands::<OperandError>(opcode, &mut |kind, _| {
            count += 1;
            Ok(match kind {
                OperandKind::Integer => i64::from(spread(count) as i8),
                OperandKind::Counter => (spread(count) % 2).cast_signed(),
                OperandKind::Local => 1 + (spread(count) % 2).cast_signed(),
                _ => 0,
            })
        });
        made.unwrap_or(Instr::Halt {})
    }

    fn is_same(statement: &[Instr], update: Update, seed: u64) -> bool {
        let mut one = Box::<Words>::default();
        for (at, slot) in one.parts_mut().0.iter_mut().enumerate() {
            *slot = spread(seed + at as u64);
        }
        let mut other = one.clone();
        undo(statement, &mut one);
        let fixed =
            Fixed { constants: &[], tools: &[], settings: Settings::default(), raised: &[] };
        let mut values =
            Values { words: &mut other, top: 0, depth: 0, globals: &mut Vec::new(), fixed: &fixed };
        update.undo(&mut values);
        one.parts().0 == other.parts().0
    }

    #[test]
    fn one_operation_does_what_the_prefix_and_the_inverse_do() {
        let mut found = 0;
        for row in OPS.iter().filter(|row| is_linear(instruction(row.opcode, 0))) {
            for seed in 0..100 {
                let mut code = vec![Instr::PushCounter { counter: CounterId(0) }; row.pops.len()];
                code.push(instruction(row.opcode, seed));
                code.push(Instr::IntMulImmediate { value: -7 });
                let effect = code.len();
                let prefix = obverse_isa::Prefix(effect as u8);
                code.push(Instr::SubLocal { prefix, local: LocalId(0) });
                let Undo::Update(update) = Updates::default().undo(&code, effect) else {
                    panic!("{code:?}")
                };
                assert!(is_same(&code, update, seed), "{code:?}\n{update:?}");
                found += 1;
            }
        }
        assert_eq!(found, 1200);
    }

    #[test]
    fn every_update_of_a_local_without_a_prefix_is_one_operation() {
        let updates = OPS.iter().map(|row| instruction(row.opcode, 3));
        let updates: Vec<_> = updates
            .filter(|instr| is_update_of_local(*instr) && instr.info().pops.is_empty())
            .collect();
        assert_eq!(updates.len(), 5);
        for effect in updates {
            let code = [effect];
            let Undo::Update(update) = Updates::default().undo(&code, 0) else {
                panic!("{effect:?}")
            };
            assert!((0..20).all(|seed| is_same(&code, update, seed)), "{effect:?}");
        }
    }

    #[test]
    fn what_is_not_linear_or_reads_too_much_is_left_to_the_instruction() {
        let local = |index| Instr::PushLocal { local: LocalId(index) };
        let add =
            |prefix| Instr::AddLocal { prefix: obverse_isa::Prefix(prefix), local: LocalId(0) };
        let left = |code: &[Instr]| {
            matches!(Updates::default().undo(code, code.len() - 1), Undo::Instr(instr)
                if instr == code[code.len() - 1])
        };
        assert!(left(&[local(1), local(2), Instr::IntMul {}, add(3)]));
        assert!(left(&[
            local(1),
            Instr::IntAddLocals { left: LocalId(2), right: LocalId(3) },
            Instr::IntAdd {},
            add(3)
        ]));
        let large = Instr::IntMulImmediate { value: 1 << 10 };
        assert!(left(&[local(1), large, large, add(3)]));
        assert!(!left(&[local(1), large, add(2)]));
    }
}
