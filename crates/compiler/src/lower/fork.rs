//! Forks as tasks: the branches one behind the other, and how an error leaves all of them.
//!
//! What leaves a branch sets `$leaving`, says where to in a local, goes to the end of the branch,
//! leaves the fork there, and goes on behind its join, where nothing of the fork is under way any
//! more. What the other branches were in the middle of is put right there: settings are what they
//! were before the fork, and what cannot be taken back is not. A branch that nothing leaves has
//! none of this. That the fork is left is said by the flag and not by the local, since that is what
//! is followed where it is found out how far back a point can go.

use super::Lower;
use super::frame::Scope;
use super::leave::Way;
use super::statement::PREFIX;
use crate::effects::Carried;
use crate::tree::Block;
use obverse_bytecode::Mark;
use obverse_isa::{Instr, LocalId, ReasonId, Setting};

impl Lower<'_> {
    /// Branches that take turns.
    pub(super) fn fork(&mut self, branches: &[Block]) {
        let is_left = branches.iter().any(|branch| self.may_be_left(branch));
        let way = is_left.then(|| self.way_local());
        let held = self.held(branches);
        let kept = self.keep_settings(held);
        let fork = self.code.jump(|join| Instr::Fork { join });
        let mut leaving = Vec::new();
        let mut ways = Vec::new();
        for (index, branch) in branches.iter().enumerate() {
            if index > 0 {
                self.push(Instr::ForkNext {});
            }
            let found = self.fork_branch(branch, way);
            if !found.is_empty() {
                leaving.extend(self.leave_fork());
            }
            ways.extend(found);
        }
        let join = self.code.join(fork, |from| Instr::ForkJoin { from });
        leaving.into_iter().for_each(|mark| self.code.lead(mark, join));
        if !ways.is_empty() {
            self.go_on_if_left(&ways, &kept, held.irreversible);
        }
    }

    /// What branches may be in the middle of when another one leaves the fork.
    fn held(&self, branches: &[Block]) -> Carried {
        let leavers = branches.iter().filter(|branch| self.may_be_left(branch)).count();
        let is_held = |branch: &&Block| leavers > usize::from(self.may_be_left(branch));
        let held = branches.iter().filter(is_held);
        held.fold(Carried::default(), |all, branch| all.and(self.effects.of_statements(branch)))
    }

    /// Keep the settings that would not be what they were.
    fn keep_settings(&mut self, held: Carried) -> Vec<(Setting, LocalId)> {
        let needed = Setting::ALL.iter().copied().filter(|setting| held.sets[*setting as usize]);
        needed
            .map(|setting| {
                let name = setting.name().replace('.', "_");
                let local = self.hidden(&format!("{name}_before"), setting.of_type());
                self.keep(setting, local);
                (setting, local)
            })
            .collect()
    }

    /// Behind the join, if the fork was left: put right what would not be so, and go on where the
    /// ways lead.
    fn go_on_if_left(
        &mut self,
        ways: &[Way],
        kept: &[(Setting, LocalId)],
        irreversible: Option<ReasonId>,
    ) {
        let Some(stay) = self.unless_leaving() else { return };
        if let Some(leaving) = self.globals.leaving {
            self.set_flag(leaving, false);
        }
        for &(setting, local) in kept {
            self.restore(setting, local);
        }
        if let Some(reason) = irreversible {
            self.push(Instr::Irreversible { reason });
        }
        self.go_on_one_of(ways);
        self.join_one(stay);
    }

    /// A jump that is taken if nothing is being left.
    fn unless_leaving(&mut self) -> Option<Mark> {
        let leaving = self.globals.leaving?;
        self.push(Instr::PushGlobal { global: leaving });
        Some(self.code.jump(|target| Instr::JumpUnless { prefix: PREFIX, target }))
    }

    /// A branch up to its end; the ways that lead there from within it.
    fn fork_branch(&mut self, branch: &Block, way: Option<LocalId>) -> Vec<Way> {
        // Another task may come between: each branch has a local of its own for what is left in it.
        let frame = &mut self.frame;
        let around = (frame.way.take(), frame.again.take(), std::mem::take(&mut frame.aside));
        let scope = self.scoped(Scope::Branch(way, Vec::new()), branch);
        (self.frame.way, self.frame.again, self.frame.aside) = around;
        let Some(Scope::Branch(_, ways)) = scope else { return Vec::new() };
        let (marks, ways): (Vec<Mark>, Vec<Way>) = ways.into_iter().unzip();
        self.at(branch.end, None);
        self.join_all(marks);
        ways
    }

    /// At the end of a branch: leave the fork if a way leads out of it.
    fn leave_fork(&mut self) -> Option<Mark> {
        let stay = self.unless_leaving()?;
        let leave = self.code.jump(|join| Instr::ForkLeave { join });
        self.frame.is_reached = false;
        self.join_one(stay);
        Some(leave)
    }
}
