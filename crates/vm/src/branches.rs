//! The branches of forks as they lie in the code, and which of them has its turn before others.
//!
//! Knows nothing of machines, so that whoever follows a program without one takes the same turns.

use obverse_bytecode::Module;
use obverse_isa::{Family, Instr};
use std::collections::BTreeMap;

/// How far into a branch is looked for what it commands first, in instructions.
const MAX_LOOKS: usize = 64;

/// The branches of a fork.
#[derive(Clone, Debug)]
pub struct Branches {
    /// Where the branches come together.
    pub join: u32,
    /// One a branch: its first instruction, and that at which it ends.
    pub ends: Vec<(u32, u32)>,
    /// One a branch: whether it begins with a motion.
    begins_with_motion: Vec<bool>,
}

impl Branches {
    /// Whose turn is next of the tasks that are ready, in the order in which they come, each with
    /// its place: the first. But one that begins with a motion lets those begin before it that do
    /// not, since what they command can settle meanwhile.
    pub fn first_of(&self, ready: impl Iterator<Item = (usize, u32)>) -> Option<usize> {
        let mut ready = ready;
        let has_begun = |task: usize, pc: u32| pc != self.ends[task].0;
        let (first, pc) = ready.next()?;
        if has_begun(first, pc) || !self.begins_with_motion[first] {
            return Some(first);
        }
        let goes_before =
            |&(task, pc): &(usize, u32)| !has_begun(task, pc) && !self.begins_with_motion[task];
        Some(ready.find(goes_before).map_or(first, |(task, _)| task))
    }

    /// The branch that begins.
    #[must_use]
    pub fn first(&self) -> usize {
        let starts = self.ends.iter().map(|(start, _)| *start);
        self.first_of(starts.enumerate()).unwrap_or(0)
    }
}

/// The forks of a program by their first instruction.
#[must_use]
pub fn branches(module: &Module) -> BTreeMap<u32, Branches> {
    let mut forks = BTreeMap::new();
    // Of each fork that is open: where it is, the branches so far, where the next begins.
    let mut open: Vec<(u32, Branches, u32)> = Vec::new();
    let end_branch = |(_, branches, start): &mut (u32, Branches, u32), at: u32| {
        branches.ends.push((*start, at));
        branches.begins_with_motion.push(begins_with_motion(module, *start));
        *start = at + 1;
    };
    for (at, instr) in (0..).zip(&module.code) {
        match instr {
            Instr::Fork { join } => {
                let branches =
                    Branches { join: join.0, ends: Vec::new(), begins_with_motion: Vec::new() };
                open.push((at, branches, at + 1));
            }
            Instr::ForkNext {} => open.last_mut().into_iter().for_each(|fork| end_branch(fork, at)),
            Instr::ForkJoin { .. } => {
                if let Some(mut fork) = open.pop() {
                    end_branch(&mut fork, at);
                    forks.insert(fork.0, fork.1);
                }
            }
            _ => {}
        }
    }
    forks
}

/// Whether the turn that ends with an act began with a motion: that act, or what was read of it.
#[must_use]
pub fn is_turn_of_motion(code: &[Instr], act: usize) -> bool {
    let last = code[..=act].iter().rev().find(|instr| !instr.reads_motion());
    last.is_some_and(|instr| instr.info().family == Family::Kinematic)
}

/// Whether what comes first of that which takes a turn moves the arm, in the order in which it is
/// written and as far as it is looked at.
fn begins_with_motion(module: &Module, start: u32) -> bool {
    let mut at = start as usize;
    for _ in 0..MAX_LOOKS {
        at = match module.code.get(at) {
            Some(Instr::Call { function, .. }) => module.functions[function.index()].first as usize,
            Some(instr) if instr.ends_turn() => return instr.info().family == Family::Kinematic,
            Some(Instr::ForkNext {} | Instr::ForkJoin { .. } | Instr::Return {}) | None => {
                return false;
            }
            Some(_) => at + 1,
        };
    }
    false
}
