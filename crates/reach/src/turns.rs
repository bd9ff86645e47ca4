//! Where the branches of forks take turns: in which code, and what is known of the
//! [`flags`](crate::flag) there.
//!
//! Knows what lies between a fork and its join and what is called from there, and no ways.

use obverse_bytecode::Module;
use obverse_isa::Instr;

/// The code that is run in turns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Turns {
    /// By instruction; empty if there is no fork.
    in_fork: Vec<bool>,
    are_flags_altered: bool,
}

impl Turns {
    /// Those of a module, where no flag is set when a turn ends.
    pub(crate) fn of(module: &Module) -> Self {
        if !module.code.iter().any(|instr| matches!(instr, Instr::Fork { .. })) {
            return Self::default();
        }
        let mut turns = Self { in_fork: vec![false; module.code.len()], are_flags_altered: false };
        let mut called = Vec::new();
        let mut open = 0_u32;
        for (at, instr) in module.code.iter().enumerate() {
            turns.in_fork[at] = open > 0;
            match instr {
                Instr::Fork { .. } => open += 1,
                Instr::ForkJoin { .. } => open = open.saturating_sub(1),
                Instr::Call { function, .. } if open > 0 => called.push(function.index()),
                _ => {}
            }
        }
        turns.add_called(module, called);
        turns
    }

    /// The same where the flags may be anything when a turn begins.
    pub(crate) fn with_altered_flags(self) -> Self {
        Self { are_flags_altered: true, ..self }
    }

    fn add_called(&mut self, module: &Module, mut called: Vec<usize>) {
        let mut is_known = vec![false; module.functions.len()];
        while let Some(function) = called.pop() {
            if std::mem::replace(&mut is_known[function], true) {
                continue;
            }
            let code =
                module.functions[function].first as usize..module.functions[function].end as usize;
            self.in_fork[code.clone()].fill(true);
            called.extend(module.code[code].iter().filter_map(|instr| match instr {
                Instr::Call { function, .. } => Some(function.index()),
                _ => None,
            }));
        }
    }

    pub(crate) fn has_forks(&self) -> bool {
        !self.in_fork.is_empty()
    }

    /// Whether an instruction may be run by a branch.
    pub(crate) fn is_in_fork(&self, pc: u32) -> bool {
        self.in_fork.get(pc as usize).copied().unwrap_or(false)
    }

    /// Whether the flags may be anything when a turn begins.
    pub(crate) fn are_flags_altered(&self) -> bool {
        self.are_flags_altered
    }
}
