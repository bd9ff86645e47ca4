//! What the records of a tape cost, by opcode, by instruction and by robot command.

use super::walk::Walk;
use obverse_bytecode::Module;
use std::collections::BTreeMap;

/// What some records cost.
#[derive(Clone, Copy, Default)]
pub(super) struct Cost {
    /// How many there are.
    pub(super) records: u64,
    /// Their size in bits.
    pub(super) bits: u64,
}

/// What the records of a tape cost.
#[derive(Default)]
pub(super) struct Costs {
    /// By mnemonic, and whether it is that of a robot command.
    pub(super) by_opcode: BTreeMap<(&'static str, bool), Cost>,
    /// By instruction, the most expensive first.
    pub(super) by_instruction: Vec<(u32, Cost)>,
    /// Of the robot commands alone.
    pub(super) of_commands: Cost,
    /// Of all.
    pub(super) total: Cost,
}

impl Cost {
    fn add(&mut self, bits: u64) {
        self.records += 1;
        self.bits += bits;
    }

    /// Bits a record.
    pub(super) fn each(&self) -> f64 {
        per(self.bits, self.records)
    }
}

/// So many bits, shared among so many; none among none.
pub(super) fn per(bits: u64, count: u64) -> f64 {
    if count == 0 { 0.0 } else { bits as f64 / count as f64 }
}

impl Costs {
    pub(super) fn of(module: &Module, walk: &Walk) -> Self {
        let mut costs = Self::default();
        let mut by_instruction: BTreeMap<u32, Cost> = BTreeMap::new();
        for entry in &walk.entries {
            let info = module.code[entry.pc as usize].info();
            let is_command = info.family.commands_workcell();
            costs.by_opcode.entry((info.mnemonic, is_command)).or_default().add(entry.bits);
            by_instruction.entry(entry.pc).or_default().add(entry.bits);
            costs.total.add(entry.bits);
            if is_command {
                costs.of_commands.add(entry.bits);
            }
        }
        costs.by_instruction = by_instruction.into_iter().collect();
        costs.by_instruction.sort_by_key(|(pc, cost)| (std::cmp::Reverse(cost.bits), *pc));
        costs
    }
}
