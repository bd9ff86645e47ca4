//! Rules 5, 6 and 8: joins, counted loops, blocks. Knows that operands are in range.

use super::{Findings, Rule};
use crate::module::{Function, Module};
use obverse_isa::{CounterId, Instr, Label, Opcode};

pub(super) fn check(module: &Module, function: &Function, findings: &mut Findings) {
    let code = &module.code;
    let range = function.first as usize..function.end as usize;
    let mut nesting = Nesting::default();
    for at in range.clone() {
        pairing(code, &range, at, findings);
        fall_through(code, at, function, findings);
        nesting.step(module, at, findings);
    }
    nesting.finish(findings);
    for at in range {
        nesting.jumps(code, at, findings);
    }
}

/// A jump and its join name each other, and are of kinds that go together.
fn pairing(code: &[Instr], range: &std::ops::Range<usize>, at: usize, findings: &mut Findings) {
    let instr = code[at];
    let other = instr.jump_target().or(instr.join_from());
    let Some(other) = other.map(Label::index) else { return };
    if !range.contains(&other) {
        findings.at(at, Rule::Joins, "it names an instruction of another function");
        return;
    }
    let back = code[other].jump_target().or(code[other].join_from());
    if back.map(Label::index) != Some(at) || other == at {
        let why = format!("it names instruction {other}, which does not name it");
        findings.at(at, Rule::Joins, why);
        return;
    }
    let (jump, join) =
        if instr.jump_target().is_some() { (instr, code[other]) } else { (code[other], instr) };
    if !go_together(jump, join) {
        let why =
            format!("{} and {} do not go together", jump.info().mnemonic, join.info().mnemonic);
        findings.at(at, Rule::Joins, why);
    }
}

fn go_together(jump: Instr, join: Instr) -> bool {
    match (jump, join) {
        (Instr::ForNext { counter: a, .. }, Instr::ForTop { counter: b, .. })
        | (Instr::ForEnter { counter: a, .. }, Instr::ForExit { counter: b, .. }) => a == b,
        (Instr::ForNext { .. } | Instr::ForEnter { .. }, _)
        | (_, Instr::ForTop { .. } | Instr::ForExit { .. }) => false,
        (jump, join) => jump.jump_target().is_some() && join.join_from().is_some(),
    }
}

fn fall_through(code: &[Instr], at: usize, function: &Function, findings: &mut Findings) {
    let is_last = at + 1 == function.end as usize;
    if is_last {
        return;
    }
    let next_is_land = matches!(code[at + 1], Instr::Land { .. });
    if code[at].never_falls_through() != next_is_land {
        let why = if next_is_land {
            "land can only follow what never falls through"
        } else {
            "only land can follow what never falls through"
        };
        findings.at(at + 1, Rule::Joins, why);
    }
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

/// The deepest that counted loops and blocks nest.
const MAX_NESTING: usize = 256;

/// A stretch of code with one way in.
#[derive(Clone, Copy)]
struct Region {
    /// Its first instruction.
    begin: usize,
    /// Its last.
    end: usize,
    /// Whether control may leave it other than by its end.
    may_leave: bool,
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
struct Nesting {
    open: Vec<(usize, Option<CounterId>)>,
    done: Vec<Region>,
    /// For each instruction in order, the innermost region that holds it.
    innermost: Vec<(usize, Option<usize>)>,
    parents: Vec<Option<usize>>,
}

impl Nesting {
    fn step(&mut self, module: &Module, at: usize, findings: &mut Findings) {
        let code = &module.code;
        if self.open.len() > MAX_NESTING {
            let why = format!("loops and blocks nest deeper than {MAX_NESTING}");
            findings.at(at, Rule::Blocks, why);
            self.open.clear();
        }
        match code[at] {
            Instr::ForEnter { counter, .. } => {
                if self.open.iter().any(|(_, open)| *open == Some(counter)) {
                    findings.at(at, Rule::Loops, "the counter is that of a loop around this one");
                }
                self.open.push((at, Some(counter)));
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
                let begins = self.open.last().is_some_and(|(begin, _)| begin + 1 == target.index());
                if !follows || !begins {
                    findings.at(at, Rule::Loops, "for.next does not end the innermost loop");
                }
            }
            Instr::ForExit { from, .. } => {
                self.close(at, from.index(), true, Rule::Loops, findings);
            }
            Instr::BlockBegin {} => self.open.push((at, None)),
            Instr::BlockSkip { from } => {
                self.close(at, from.index(), false, Rule::Blocks, findings);
            }
            Instr::BlockReplace { function, from } => {
                replacement(module, &module.functions[function.index()], at, findings);
                self.close(at, from.index(), false, Rule::Blocks, findings);
            }
            _ => {}
        }
    }

    fn close(
        &mut self,
        at: usize,
        begin: usize,
        may_leave: bool,
        rule: Rule,
        findings: &mut Findings,
    ) {
        match self.open.pop() {
            Some((open, counter))
                if open == begin && counter.is_some() == (rule == Rule::Loops) =>
            {
                self.done.push(Region { begin, end: at, may_leave });
            }
            _ => findings.at(at, rule, "it does not end the innermost loop or block"),
        }
    }

    /// Every region is closed; find for each the one around it, by a sweep over their begins.
    fn finish(&mut self, findings: &mut Findings) {
        if let Some((begin, counter)) = self.open.first() {
            let rule = if counter.is_some() { Rule::Loops } else { Rule::Blocks };
            findings.at(*begin, rule, "the loop or block has no end");
        }
        self.done.sort_unstable_by_key(|region| region.begin);
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

    /// A jump may leave counted loops and enter nothing.
    fn jumps(&self, code: &[Instr], at: usize, findings: &mut Findings) {
        let Some(target) = code[at].jump_target() else { return };
        if matches!(code[at], Instr::ForEnter { .. } | Instr::ForNext { .. }) {
            return;
        }
        let goal = self.region_of(target.index());
        let mut region = self.region_of(at);
        while region != goal {
            let Some(index) = region else {
                let is_loop = goal.is_some_and(|goal| self.done[goal].may_leave);
                let rule = if is_loop { Rule::Loops } else { Rule::Blocks };
                findings.at(at, rule, "it jumps into a loop or block from outside");
                return;
            };
            if !self.done[index].may_leave {
                findings.at(at, Rule::Blocks, "it jumps out of a block with a reverse of its own");
                return;
            }
            region = self.parents[index];
        }
    }
}
