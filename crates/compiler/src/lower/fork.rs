//! Forks as tasks: the branches one behind the other, and how an error leaves all of them.
//!
//! What leaves a branch says where to in a local, goes to the end of the branch, leaves the fork
//! there, and goes on behind its join, where nothing of the fork is under way any more. A branch
//! that nothing leaves has none of this.

use super::Lower;
use super::frame::Scope;
use super::leave::Way;
use super::statement::PREFIX;
use crate::tree::Block;
use obverse_bytecode::Mark;
use obverse_isa::{Instr, LocalId};

impl Lower<'_> {
    /// Branches that take turns.
    pub(super) fn fork(&mut self, branches: &[Block]) {
        let way = self.begin_ways(branches);
        let fork = self.code.jump(|join| Instr::Fork { join });
        let mut leaving = Vec::new();
        let mut ways = Vec::new();
        for (index, branch) in branches.iter().enumerate() {
            if index > 0 {
                self.push(Instr::ForkNext {});
            }
            let found = self.fork_branch(branch, way);
            if let (Some(local), false) = (way, found.is_empty()) {
                leaving.push(self.leave_fork(local));
            }
            ways.extend(found);
        }
        let join = self.code.join(fork, |from| Instr::ForkJoin { from });
        leaving.into_iter().for_each(|mark| self.code.lead(mark, join));
        self.go_on(&ways);
    }

    /// A branch up to its end; the ways that lead there from within it.
    fn fork_branch(&mut self, branch: &Block, way: Option<LocalId>) -> Vec<Way> {
        // Another task may come between: each branch has a local of its own for what is left in it.
        let around = self.frame.way.take();
        let scope = self.scoped(Scope::Branch(way, Vec::new()), branch);
        self.frame.way = around;
        let Some(Scope::Branch(_, ways)) = scope else { return Vec::new() };
        let (marks, ways): (Vec<Mark>, Vec<Way>) = ways.into_iter().unzip();
        self.at(branch.end, None);
        self.join_all(marks);
        ways
    }

    /// At the end of a branch: leave the fork if a way leads out of it.
    fn leave_fork(&mut self, way: LocalId) -> Mark {
        self.push(Instr::PushLocal { local: way });
        self.push(Instr::PushInt { value: 0 });
        let stay = self.code.jump(|target| Instr::JumpUnlessNe { prefix: PREFIX, target });
        let leave = self.code.jump(|join| Instr::ForkLeave { join });
        self.frame.is_reached = false;
        self.join_one(stay);
        leave
    }
}
