//! Rules 6, 8 and 10: counted loops, blocks and forks nest, and nothing jumps into them. Knows that
//! operands are in range and that jumps and joins name each other.

use super::{Findings, MAX_BRANCHES, Rule};
use crate::module::{Function, Module};
use obverse_isa::{CounterId, Instr, Label, Opcode};

/// The deepest that counted loops, blocks and forks nest.
const MAX_NESTING: usize = 256;

/// What a stretch of code with one way in is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A counted loop.
    Loop(CounterId),
    /// A block with a reverse of its own.
    Block,
    /// A branch of the fork at an instruction.
    Branch { fork: usize },
}

impl Kind {
    fn rule(self) -> Rule {
        match self {
            Self::Loop(_) => Rule::Loops,
            Self::Block => Rule::Blocks,
            Self::Branch { .. } => Rule::Tasks,
        }
    }
}

/// A stretch of code with one way in.
#[derive(Clone, Copy)]
struct Region {
    /// Its first instruction.
    begin: usize,
    /// Its last.
    end: usize,
    kind: Kind,
}

/// A region whose end has not come yet.
struct Open {
    begin: usize,
    kind: Kind,
    /// The counters of the loops in it, a bit each.
    counters: u128,
    /// The branches before it of the same fork: how many, and the counters of their loops.
    branches: usize,
    others: u128,
}

/// What takes a block's place begins with locals of the function around the block.
fn replacement(module: &Module, function: &Function, at: usize, findings: &mut Findings) {
    let around = module.function_at(at as u32).map(|index| &module.functions[index]);
    let taken = &function.locals[..usize::from(function.parameters)];
    let given = around.and_then(|around| around.locals.get(..taken.len()));
    let is_given = given.is_some_and(|given| {
        given.iter().zip(taken).all(|(given, taken)| given.of_type == taken.of_type)
    });
    if !is_given {
        let why = "a function that takes a block's place has for parameters the first locals of \
                   the function around the block";
        findings.at(at, Rule::Blocks, why);
    }
}

/// The counter of an instruction at an end of a counted loop.
fn counter_of(instr: Option<&Instr>) -> Option<(Opcode, CounterId)> {
    match *instr? {
        Instr::ForEnter { counter, .. } => Some((Opcode::ForEnter, counter)),
        Instr::ForTop { counter, .. } => Some((Opcode::ForTop, counter)),
        Instr::ForExit { counter, .. } => Some((Opcode::ForExit, counter)),
        _ => None,
    }
}

#[derive(Default)]
pub(super) struct Nesting {
    open: Vec<Open>,
    done: Vec<Region>,
    /// For each instruction in order, the innermost region that holds it.
    innermost: Vec<(usize, Option<usize>)>,
    parents: Vec<Option<usize>>,
}

impl Nesting {
    pub(super) fn step(&mut self, module: &Module, at: usize, findings: &mut Findings) {
        let code = &module.code;
        if self.open.len() > MAX_NESTING {
            let why = format!("loops, blocks and forks nest deeper than {MAX_NESTING}");
            findings.at(at, Rule::Blocks, why);
            self.open.clear();
        }
        match code[at] {
            Instr::ForEnter { counter, .. } => {
                if self.open.iter().any(|open| open.kind == Kind::Loop(counter)) {
                    findings.at(at, Rule::Loops, "the counter is that of a loop around this one");
                }
                self.begin(at, Kind::Loop(counter));
                if counter_of(code.get(at + 1)) != Some((Opcode::ForTop, counter)) {
                    findings.at(at, Rule::Loops, "for.top does not follow for.enter");
                }
            }
            Instr::ForTop { counter, .. } => {
                let before = at.checked_sub(1).map(|before| &code[before]);
                if counter_of(before) != Some((Opcode::ForEnter, counter)) {
                    findings.at(at, Rule::Loops, "for.top does not follow for.enter");
                }
            }
            Instr::ForNext { counter, target } => {
                let follows = counter_of(code.get(at + 1)) == Some((Opcode::ForExit, counter));
                let begins = self.open.last().is_some_and(|open| open.begin + 1 == target.index());
                if !follows || !begins {
                    findings.at(at, Rule::Loops, "for.next does not end the innermost loop");
                }
            }
            Instr::ForExit { from, .. } => {
                let is_loop =
                    |open: &Open| matches!(open.kind, Kind::Loop(_)) && open.begin == from.index();
                self.end(at, Rule::Loops, is_loop, findings);
            }
            Instr::BlockBegin {} => self.begin(at, Kind::Block),
            Instr::BlockSkip { from } => self.end_block(at, from.index(), findings),
            Instr::BlockReplace { function, from } => {
                replacement(module, &module.functions[function.index()], at, findings);
                self.end_block(at, from.index(), findings);
            }
            Instr::Fork { .. } => self.begin(at + 1, Kind::Branch { fork: at }),
            Instr::ForkNext {} => self.next_branch(at, findings),
            Instr::ForkJoin { from } => {
                let fork = from.index();
                let is_branch = |open: &Open| open.kind == Kind::Branch { fork };
                self.end(at, Rule::Tasks, is_branch, findings);
            }
            _ => {}
        }
    }

    fn begin(&mut self, begin: usize, kind: Kind) {
        let counters = match kind {
            Kind::Loop(counter) => 1_u128.checked_shl(u32::from(counter.0)).unwrap_or(0),
            _ => 0,
        };
        self.open.push(Open { begin, kind, counters, branches: 0, others: 0 });
    }

    fn end_block(&mut self, at: usize, begin: usize, findings: &mut Findings) {
        let is_block = |open: &Open| open.kind == Kind::Block && open.begin == begin;
        self.end(at, Rule::Blocks, is_block, findings);
    }

    /// End the innermost region, if it is the right one.
    fn end(
        &mut self,
        at: usize,
        rule: Rule,
        is_right: impl Fn(&Open) -> bool,
        findings: &mut Findings,
    ) -> Option<Open> {
        let Some(open) = self.open.pop().filter(is_right) else {
            findings.at(at, rule, "it does not end the innermost loop, block or branch");
            return None;
        };
        if open.counters & open.others != 0 {
            let why = "a loop of this branch has the counter of one of a branch before";
            findings.at(at, Rule::Tasks, why);
        }
        self.done.push(Region { begin: open.begin, end: at, kind: open.kind });
        if let Some(around) = self.open.last_mut() {
            around.counters |= open.counters | open.others;
        }
        Some(open)
    }

    /// End a branch, and begin the next one of the same fork.
    fn next_branch(&mut self, at: usize, findings: &mut Findings) {
        let is_branch = |open: &Open| matches!(open.kind, Kind::Branch { .. });
        let Some(before) = self.end(at, Rule::Tasks, is_branch, findings) else { return };
        let branches = before.branches + 1;
        if branches >= MAX_BRANCHES {
            let why = format!("a fork has more than {MAX_BRANCHES} branches");
            findings.at(at, Rule::Tasks, why);
        }
        let others = before.others | before.counters;
        self.open.push(Open { begin: at + 1, kind: before.kind, counters: 0, branches, others });
    }

    /// Every region is closed; find for each the one around it, by a sweep over their begins.
    pub(super) fn finish(&mut self, findings: &mut Findings) {
        if let Some(open) = self.open.first() {
            findings.at(open.begin, open.kind.rule(), "the loop, block or fork has no end");
        }
        // Of two that begin together the outer one ends later.
        self.done.sort_unstable_by_key(|region| (region.begin, std::cmp::Reverse(region.end)));
        let mut around: Vec<usize> = Vec::new();
        for (index, region) in self.done.iter().enumerate() {
            while around.last().is_some_and(|&outer| self.done[outer].end < region.begin) {
                around.pop();
            }
            self.parents.push(around.last().copied());
            self.innermost.push((region.begin, Some(index)));
            self.innermost.push((region.end + 1, around.last().copied()));
            around.push(index);
        }
        // An end comes before a begin at the same place, which is the same innermost region.
        self.innermost.sort_by_key(|(at, _)| *at);
    }

    fn region_of(&self, at: usize) -> Option<usize> {
        let after = self.innermost.partition_point(|(begin, _)| *begin <= at);
        self.innermost[..after].last().and_then(|(_, region)| *region)
    }

    /// A jump may leave counted loops and enter nothing; `fork.leave` leaves the innermost fork.
    pub(super) fn jumps(&self, code: &[Instr], at: usize, findings: &mut Findings) {
        if let Instr::ForkLeave { join } = code[at] {
            return self.leave(code, at, join.index(), findings);
        }
        let Some(target) = code[at].jump_target() else { return };
        if matches!(code[at], Instr::ForEnter { .. } | Instr::ForNext { .. } | Instr::Fork { .. }) {
            return;
        }
        let goal = self.region_of(target.index());
        let mut region = self.region_of(at);
        while region != goal {
            let Some(index) = region else {
                let rule = goal.map_or(Rule::Blocks, |goal| self.done[goal].kind.rule());
                findings.at(at, rule, "it jumps into a loop, block or branch from outside");
                return;
            };
            match self.done[index].kind {
                Kind::Loop(_) => region = self.parents[index],
                Kind::Block => {
                    let why = "it jumps out of a block with a reverse of its own";
                    return findings.at(at, Rule::Blocks, why);
                }
                Kind::Branch { .. } => {
                    return findings.at(at, Rule::Tasks, "it jumps out of a branch");
                }
            }
        }
    }

    fn leave(&self, code: &[Instr], at: usize, join: usize, findings: &mut Findings) {
        let mut region = self.region_of(at);
        while let Some(index) = region {
            match self.done[index].kind {
                Kind::Loop(_) => region = self.parents[index],
                Kind::Branch { fork }
                    if code[fork].jump_target().map(Label::index) == Some(join) =>
                {
                    return;
                }
                _ => break,
            }
        }
        findings.at(at, Rule::Tasks, "it does not name the join of the innermost fork around it");
    }
}
