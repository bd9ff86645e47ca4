//! The ways out of what is under way: loops, functions, closed blocks.
//!
//! A closed block, one with a reverse of its own or a branch of a fork, has one end. What leaves it
//! says so in a local, goes to that end, and goes on behind it (behind the fork); what the outside
//! is told, it is told there, so that the block skipped in reverse leaves no trace of it.

use super::Lower;
use super::frame::Scope;
use super::statement::PREFIX;
use crate::response::Response;
use crate::tree::{Block, Statement, StatementKind};
use obverse_bytecode::Mark;
use obverse_isa::{Instr, LocalId, ReasonId, Setting, Type};

/// Where a way out leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// To the end of the function.
    Out = 1,
    /// To its beginning.
    Again = 2,
    /// To the end of the function, so that the program begins again.
    Restart = 3,
}

impl Way {
    const ALL: [Self; 3] = [Self::Out, Self::Again, Self::Restart];
}

/// What one step out of a scope is.
enum Step {
    Restore(Setting, LocalId),
    Irreversible(ReasonId),
}

impl Lower<'_> {
    /// `break`
    pub(super) fn leave_loop(&mut self) {
        let Some(depth) = self.frame.loops.last().map(|around| around.depth) else { return };
        // No block with a reverse of its own is among them: checked.
        self.step_out(depth);
        let mark = self.jump();
        self.add_break(mark);
    }

    /// A jump out of the innermost loop.
    pub(super) fn add_break(&mut self, mark: Mark) {
        if let Some(around) = self.frame.loops.last_mut() {
            around.breaks.push(mark);
        }
    }

    /// Go where a way leads: as far as the innermost closed block, which goes on behind its end.
    pub(super) fn leave(&mut self, way: Way) {
        let block = self.block_around();
        self.step_out(block.map_or(0, |index| index + 1));
        if let Some(scope) = block.and_then(|index| self.frame.scopes.get(index)) {
            let (is_branch, of_branch) = match scope {
                Scope::Branch(local, _) => (true, *local),
                _ => (false, None),
            };
            let local = of_branch.unwrap_or_else(|| self.way_local());
            self.push(Instr::PushInt { value: way as i32 });
            self.push(Instr::StoreLocal { prefix: PREFIX, local });
            if let (true, Some(leaving)) = (is_branch, self.globals.leaving) {
                self.set_flag(leaving, true);
            }
        }
        let mark = self.jump();
        match block.and_then(|index| self.frame.scopes.get_mut(index)) {
            Some(Scope::Reversed(ways) | Scope::Branch(_, ways)) => ways.push((mark, way)),
            _ if way == Way::Again => self.frame.restarts.push(mark),
            _ => self.frame.exits.push(mark),
        }
    }

    /// Leave all sequences under way with an error pending, and begin the program again if that is
    /// the way.
    pub(super) fn give_up(&mut self, way: Way) {
        if let Some(block) = self.block_around() {
            let is_branch = matches!(self.frame.scopes.get(block), Some(Scope::Branch(..)));
            // A recovery that has given up may have set it; a branch that is left sets it anyway.
            if let (false, Some(leaving)) = (is_branch, self.globals.leaving) {
                self.set_flag(leaving, false);
            }
            return self.leave(way);
        }
        if let (Way::Restart, Some(restart)) = (way, self.globals.restart) {
            self.set_flag(restart, true);
        }
        // The start looks at what is asked for only if something is being left.
        let is_looked_at = !self.frame.is_start || way == Way::Restart;
        if let (true, Some(leaving)) = (is_looked_at, self.globals.leaving) {
            self.set_flag(leaving, true);
        }
        self.leave(Way::Out);
    }

    /// Leave if what was called has said so.
    pub(super) fn leave_if_leaving(&mut self) {
        let Some(leaving) = self.globals.leaving else { return };
        self.push(Instr::PushGlobal { global: leaving });
        if self.frame.scopes.is_empty() {
            let mark = self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target });
            return self.frame.exits.push(mark);
        }
        let stay = self.code.jump(|target| Instr::JumpUnless { prefix: PREFIX, target });
        if self.block_around().is_some() {
            self.take_back_restart();
            self.give_up(Way::Out);
        } else {
            self.leave(Way::Out);
        }
        self.join_one(stay);
    }

    /// In a closed block: if the program begins again, that is said behind it.
    fn take_back_restart(&mut self) {
        let Some(restart) = self.globals.restart else { return };
        self.push(Instr::PushGlobal { global: restart });
        let plain = self.code.jump(|target| Instr::JumpUnless { prefix: PREFIX, target });
        self.set_flag(restart, false);
        self.give_up(Way::Restart);
        self.join_one(plain);
    }

    /// The beginning of closed blocks: nothing leads out of them yet. The local that says what
    /// does, if something may.
    pub(super) fn begin_ways(&mut self, blocks: &[Block]) -> Option<LocalId> {
        blocks.iter().any(|block| self.may_be_left(block)).then(|| {
            let local = self.way_local();
            self.push(Instr::PushInt { value: 0 });
            self.push(Instr::StoreLocal { prefix: PREFIX, local });
            local
        })
    }

    /// Whether something may lead out of a closed block.
    pub(super) fn may_be_left(&self, block: &Block) -> bool {
        let mut may_leave = false;
        block.each_statement(&mut |statement| may_leave |= self.may_leave(statement));
        may_leave
    }

    fn may_leave(&self, statement: &Statement) -> bool {
        let due = self.due(&statement.kind);
        let is_left = match &statement.kind {
            StatementKind::Call(callee, _) => self.may_be_left_by(*callee),
            kind => self.kept_block(kind).is_some_and(|kept| self.may_be_left(kept)),
        };
        is_left || due.iter().any(|error| self.effects.response(*error) != Response::Ignore)
    }

    /// Behind the end of such a block: go on with what has led there, if anything has.
    pub(super) fn go_on(&mut self, ways: &[Way]) {
        for way in Way::ALL.into_iter().filter(|way| ways.contains(way)) {
            let local = self.way_local();
            self.push(Instr::PushLocal { local });
            let value = way as i16;
            let stay = self.code.jump(|target| Instr::JumpUnlessEqImmediate {
                prefix: PREFIX,
                value,
                target,
            });
            self.go(way);
            self.join_one(stay);
        }
    }

    /// The same where one of the ways has led there.
    pub(super) fn go_on_one_of(&mut self, ways: &[Way]) {
        let Some(last) = Way::ALL.into_iter().rfind(|way| ways.contains(way)) else { return };
        let others: Vec<Way> = ways.iter().copied().filter(|way| *way != last).collect();
        self.go_on(&others);
        self.go(last);
    }

    fn go(&mut self, way: Way) {
        match way {
            Way::Again => self.leave(way),
            Way::Out | Way::Restart => self.give_up(way),
        }
    }

    /// Whether some jump so far leads to the end of the innermost closed block, or of the function.
    pub(super) fn has_way_out(&self) -> bool {
        match self.block_around().and_then(|index| self.frame.scopes.get(index)) {
            Some(Scope::Reversed(ways) | Scope::Branch(_, ways)) => !ways.is_empty(),
            _ => !self.frame.exits.is_empty(),
        }
    }

    /// The innermost closed block.
    fn block_around(&self) -> Option<usize> {
        let is_closed = |scope: &Scope| matches!(scope, Scope::Reversed(_) | Scope::Branch(..));
        self.frame.scopes.iter().rposition(is_closed)
    }

    /// Put right what the scopes from this one inwards have changed, the innermost first.
    fn step_out(&mut self, outermost: usize) {
        let inner = self.frame.scopes.get(outermost..).unwrap_or_default();
        let steps: Vec<Step> = inner.iter().rev().filter_map(step).collect();
        for step in steps {
            match step {
                Step::Restore(setting, local) => self.restore(setting, local),
                Step::Irreversible(reason) => self.push(Instr::Irreversible { reason }),
            }
        }
    }

    /// The local that says which way leads out of a block.
    pub(super) fn way_local(&mut self) -> LocalId {
        if let Some(known) = self.frame.way {
            return known;
        }
        let way = self.hidden("way", Type::Int);
        self.frame.way = Some(way);
        way
    }
}

fn step(scope: &Scope) -> Option<Step> {
    match scope {
        Scope::Setting(setting, former) => Some(Step::Restore(*setting, *former)),
        Scope::Irreversible(reason) => Some(Step::Irreversible(*reason)),
        Scope::Reversed(_) | Scope::Branch(..) => None,
    }
}
