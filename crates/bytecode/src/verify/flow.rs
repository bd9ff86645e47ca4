//! Rule 5: joins. Knows that operands are in range.

use super::nesting::Nesting;
use super::{Findings, Rule};
use crate::module::{Function, Module};
use obverse_isa::{Instr, Label};

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
        (Instr::Fork { .. }, Instr::ForkJoin { .. }) => true,
        (Instr::ForNext { .. } | Instr::ForEnter { .. } | Instr::Fork { .. }, _)
        | (_, Instr::ForTop { .. } | Instr::ForExit { .. } | Instr::ForkJoin { .. }) => false,
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
