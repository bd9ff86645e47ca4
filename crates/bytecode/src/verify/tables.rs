//! Rules 1, 2 and 9: tables, functions, source map. Knows nothing of what instructions mean.

use super::{Findings, Rule};
use crate::fault::{Bounds, Watched};
use crate::module::{FunctionKind, Mention, Mentioned, Module, Otherwise, Recovery, Variable};
use crate::{Extent, Function};
use obverse_isa::{Instr, Type};
use std::collections::HashSet;

/// The most that may be watched for one error.
const MAX_WATCHES: usize = 64;

pub(super) fn check(module: &Module, findings: &mut Findings) {
    lengths(module, findings);
    numbers(module, findings);
    errors(module, findings);
    faults(module, findings);
    cleanup(module, findings);
    functions(module, findings);
    source_map(module, findings);
    mentions(module, findings);
    loops(module, findings);
}

fn lengths(module: &Module, findings: &mut Findings) {
    let tables = [
        ("constants", module.constants.len()),
        ("joint configurations", module.joints.len()),
        ("items", module.items.len()),
        ("keyframes", module.keyframes.len()),
        ("tools", module.tools.len()),
        ("errors", module.errors.len()),
        ("checkpoints", module.checkpoints.len()),
        ("reasons", module.reasons.len()),
        ("variables", module.globals.len()),
        ("functions", module.functions.len()),
        ("source files", module.sources.len()),
    ];
    for (name, length) in tables {
        if length > usize::from(u16::MAX) {
            let why = format!("there are {length} {name}, and no more than {} can be", u16::MAX);
            findings.of_module(Rule::Tables, why);
        }
    }
    if u32::try_from(module.code.len()).is_err() {
        findings.of_module(Rule::Tables, "the code is longer than an index can say");
    }
}

fn numbers(module: &Module, findings: &mut Findings) {
    for (name, joints) in &module.joints {
        if !joints.iter().all(|joint| joint.is_finite()) {
            findings.of_module(Rule::Tables, format!("joint configuration `{name}` is not finite"));
        }
    }
    for item in &module.items {
        let names: HashSet<u16> = item.keyframes.iter().map(|keyframe| keyframe.name).collect();
        if names.len() != item.keyframes.len() {
            let why = format!("item `{}` has two keyframes of one name", item.name);
            findings.of_module(Rule::Tables, why);
        }
        for keyframe in &item.keyframes {
            let numbers = keyframe.position_m.iter().chain(&keyframe.rotation_rad);
            if !numbers.copied().all(f64::is_finite) {
                let why = format!("a keyframe of item `{}` is not finite", item.name);
                findings.of_module(Rule::Tables, why);
            }
            if usize::from(keyframe.name) >= module.keyframes.len() {
                let why = format!("item `{}` has a keyframe without a name", item.name);
                findings.of_module(Rule::Tables, why);
            }
        }
    }
    for variable in &module.globals {
        variable_type(module, variable, findings);
    }
}

/// Every variable begins as zero bits, which must be a value of its type.
fn variable_type(module: &Module, variable: &Variable, findings: &mut Findings) {
    let is_empty = match variable.of_type {
        Type::Joints => module.joints.is_empty(),
        Type::Item => module.items.is_empty(),
        Type::Int | Type::Real | Type::Bool | Type::Speed | Type::Tool => false,
    };
    if is_empty {
        let why = format!(
            "variable `{}` is of type {}, and the module has none",
            variable.name, variable.of_type
        );
        findings.of_module(Rule::Tables, why);
    }
}

fn errors(module: &Module, findings: &mut Findings) {
    for error in &module.errors {
        let using = match error.recovery {
            Recovery::Using(function) => Some(function),
            Recovery::None | Recovery::Reversing(_) => None,
        };
        let otherwise = match error.otherwise {
            Otherwise::Using(function) => Some(function),
            Otherwise::Operator | Otherwise::Stop => None,
        };
        for function in using.into_iter().chain(otherwise) {
            if usize::from(function) >= module.functions.len() {
                let why = format!("error `{}` names a function that is not there", error.name);
                findings.of_module(Rule::Tables, why);
            }
        }
        if let Recovery::Reversing(reversal) = &error.recovery {
            let is_missing = matches!(reversal.extent, Extent::Checkpoint(checkpoint)
                if usize::from(checkpoint) >= module.checkpoints.len());
            let limit_m = reversal.perturbation.map(|perturbation| perturbation.limit_m);
            let is_bad = limit_m.is_some_and(|limit| !(limit >= 0.0 && limit.is_finite()));
            if is_missing || is_bad {
                let why = format!("the reversal of error `{}` makes no sense", error.name);
                findings.of_module(Rule::Tables, why);
            }
        }
    }
}

/// A fault raises one error at the most, and what bounds an incident bounds it.
fn faults(module: &Module, findings: &mut Findings) {
    let mut taken = HashSet::new();
    for error in &module.errors {
        if !error.faults.is_sorted() || !error.faults.iter().all(|fault| taken.insert(*fault)) {
            let why = format!("error `{}` has a fault twice, or another error has it", error.name);
            findings.of_module(Rule::Tables, why);
        }
        let is_force = |watched: &Watched| match watched {
            Watched::Force { above_n } => *above_n > 0.0 && above_n.is_finite(),
            Watched::Input { .. } => true,
        };
        if !error.watches.iter().all(is_force) || error.watches.len() > MAX_WATCHES {
            let why = format!("what is watched for error `{}` makes no sense", error.name);
            findings.of_module(Rule::Tables, why);
        }
        let Bounds { attempts, time_s, distance_m } = error.bounds;
        let is_none = |bound: Option<f64>| bound.is_some_and(|b| !(b > 0.0 && b.is_finite()));
        if attempts == Some(0) || is_none(time_s) || is_none(distance_m) {
            let why = format!("the bounds of error `{}` make no sense", error.name);
            findings.of_module(Rule::Tables, why);
        }
    }
}

/// What runs at the end is the one function of its kind, and is given nothing.
fn cleanup(module: &Module, findings: &mut Findings) {
    for (index, function) in module.functions.iter().enumerate() {
        let is_cleanup = function.kind == FunctionKind::Cleanup;
        let is_named = module.cleanup.is_some_and(|cleanup| usize::from(cleanup) == index);
        if is_cleanup != is_named || (is_cleanup && function.parameters != 0) {
            let why = format!(
                "function `{}`: what runs at the end is one function of that kind, without \
                 parameters",
                function.name
            );
            findings.of_module(Rule::Functions, why);
        }
    }
    if module.cleanup.is_some_and(|cleanup| usize::from(cleanup) >= module.functions.len()) {
        findings.of_module(Rule::Functions, "what runs at the end is a function that is not there");
    }
}

fn functions(module: &Module, findings: &mut Findings) {
    let mut next = 0;
    for (index, function) in module.functions.iter().enumerate() {
        let is_start = function.kind == FunctionKind::Start;
        if is_start != (index == 0) || (is_start && function.parameters != 0) {
            let why = format!(
                "function `{}`: the start is the first function, without parameters",
                function.name
            );
            findings.of_module(Rule::Functions, why);
        }
        if function.first != next || function.end <= function.first {
            let why =
                format!("function `{}` does not begin where the one before it ends", function.name);
            findings.of_module(Rule::Functions, why);
            return;
        }
        next = function.end;
        if next as usize > module.code.len() {
            let why = format!("function `{}` ends behind the code", function.name);
            findings.of_module(Rule::Functions, why);
            return;
        }
        frame(module, function, findings);
        ends(module, function, is_start, findings);
    }
    if module.functions.is_empty() || next as usize != module.code.len() {
        findings.of_module(Rule::Functions, "there is code that belongs to no function");
    }
}

fn frame(module: &Module, function: &Function, findings: &mut Findings) {
    let words = function.locals.len() + 3 * usize::from(function.counters);
    if words > 256 {
        let why = format!("function `{}` needs {words} slots, and a frame has 256", function.name);
        findings.of_module(Rule::Functions, why);
    }
    if usize::from(function.parameters) > function.locals.len() || function.slots.len() > 256 {
        let why = format!("function `{}` has too few locals or too many positions", function.name);
        findings.of_module(Rule::Functions, why);
    }
    for local in &function.locals {
        variable_type(module, local, findings);
    }
}

fn ends(module: &Module, function: &Function, is_start: bool, findings: &mut Findings) {
    let (first, last) = (function.first as usize, function.end as usize - 1);
    let last_is_right = match module.code[last] {
        Instr::Halt {} => is_start,
        Instr::Return {} => !is_start,
        _ => false,
    };
    if !matches!(module.code[first], Instr::Enter {}) || !last_is_right || first == last {
        let why = format!(
            "function `{}` does not begin with enter and end with return, or halt for the start",
            function.name
        );
        findings.of_module(Rule::Functions, why);
    }
    for at in first..last {
        let instr = module.code[at];
        let is_inner_enter = at != first && matches!(instr, Instr::Enter {});
        if is_inner_enter || matches!(instr, Instr::Return {} | Instr::Halt {}) {
            findings.at(
                at,
                Rule::Functions,
                "enter, return and halt stand at the ends of functions",
            );
        }
    }
}

/// Of messages alone, but those must not lead astray either.
fn mentions(module: &Module, findings: &mut Findings) {
    let is_wrong = |mention: &&Mention| {
        let text = module.sources.get(usize::from(mention.file)).map(|file| file.text.as_str());
        let span = mention.start as usize..mention.end as usize;
        let is_there = match mention.what {
            Mentioned::Item(item) => usize::from(item) < module.items.len(),
            Mentioned::Tool(tool) => usize::from(tool) < module.tools.len(),
            Mentioned::Cell => module.cell.is_some(),
            Mentioned::Output { .. } | Mentioned::Input { .. } => true,
        };
        !is_there || text.is_none_or(|text| text.get(span).is_none())
    };
    if let Some(index) = module.mentions.iter().position(|mention| is_wrong(&mention)) {
        findings.of_module(Rule::SourceMap, format!("mention {index} makes no sense"));
    }
}

/// The names of loops: of loops, in their order.
fn loops(module: &Module, findings: &mut Findings) {
    let mut before = None;
    for (index, named) in module.loops.iter().enumerate() {
        let entered = module.code.get(named.enter as usize);
        let is_loop = matches!(entered, Some(Instr::ForEnter { .. }));
        if !is_loop || before >= Some(named.enter) {
            findings.of_module(Rule::SourceMap, format!("name {index} of loops makes no sense"));
            return;
        }
        before = Some(named.enter);
    }
}

fn source_map(module: &Module, findings: &mut Findings) {
    let mut before = None;
    for entry in &module.source_map {
        let text = module.sources.get(usize::from(entry.file)).map(|file| file.text.as_str());
        let span = entry.start as usize..entry.end as usize;
        let is_in_text = text.is_some_and(|text| text.get(span).is_some());
        let is_ascending = before.is_none_or(|before| before < entry.first);
        if !is_in_text || !is_ascending || entry.first as usize >= module.code.len() {
            let why =
                format!("the source map's entry for instruction {} makes no sense", entry.first);
            findings.of_module(Rule::SourceMap, why);
            return;
        }
        before = Some(entry.first);
    }
}
