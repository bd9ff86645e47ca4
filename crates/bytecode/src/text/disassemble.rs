//! The disassembler: a module as text. Knows nothing of how text is read.

use super::listing::{Section, SourceComments, name};
use super::mention;
use super::names::{Names, Scope};
use super::quote::{is_plain, quoted};
use super::words::{self, Word};
use crate::fault::{Bounds, Watched};
use crate::module::{
    ErrorDeclaration, Extent, Function, Item, Module, Otherwise, Perturbation, Recovery, Reversal,
    SourceFile, Variable,
};
use obverse_isa::OperandKind;
use std::fmt::Write;

/// A module as assembly text, which [`assemble`](super::assemble()) reads back as the same module.
#[must_use]
pub fn disassemble(module: &Module) -> String {
    let names = Names::new(module);
    let scope = Scope::new(&names, None);
    let source = SourceComments::new(module);
    let mut out = String::from("obvasm 1\n");
    tables(module, &scope, &mut out);
    code(module, &names, &source, &mut out);
    source.write(module.code.len(), &mut out);
    if !source.is_inline {
        out.push('\n');
        source.write_map(&mut out);
    }
    for file in &module.sources {
        source_file(file, &mut out);
    }
    if !module.mentions.is_empty() || !module.loops.is_empty() {
        out.push('\n');
    }
    mention::write(&module.mentions, &mut out);
    mention::write_loops(&module.loops, &mut out);
    out
}

/// One function as assembly text: its head and its code; `None` if there is no such function.
#[must_use]
pub fn disassemble_function(module: &Module, function: usize) -> Option<String> {
    let names = Names::new(module);
    let function = module.functions.get(function)?;
    let mut out = String::new();
    head(function, &mut out);
    let section = Section::of_function(&names, module, function);
    section.write(&SourceComments::new(module), &mut out);
    Some(out)
}

/// One instruction as assembly text, without a comment; `None` behind the end of the code.
#[must_use]
pub fn instruction(module: &Module, pc: u32) -> Option<String> {
    let instr = module.code.get(pc as usize)?;
    let names = Names::new(module);
    let section = match module.function_at(pc) {
        Some(function) => Section::of_function(&names, module, &module.functions[function]),
        None => Section::of_none(&names, 0..module.code.len()),
    };
    Some(section.instruction(instr))
}

fn tables(module: &Module, scope: &Scope, out: &mut String) {
    if let Some(cell) = &module.cell {
        let _ = writeln!(out, ".cell {}", quoted(cell));
    }
    for constant in &module.constants {
        let _ = writeln!(out, ".const {} {}", constant.of_type(), words::constant(*constant));
    }
    for (name, joints) in &module.joints {
        let _ = writeln!(out, ".joints {} {}", quoted(name), reals(joints));
    }
    named(".keyframe", &module.keyframes, out);
    for it in &module.items {
        item(it, scope, out);
    }
    named(".tool", &module.tools, out);
    for error in &module.errors {
        error_declaration(error, scope, out);
    }
    named(".checkpoint", &module.checkpoints, out);
    named(".reason", &module.reasons, out);
    for variable in &module.globals {
        let _ = writeln!(out, ".global {}", declared(variable));
    }
    if let Some(cleanup) = module.cleanup {
        let cleanup = name(scope, OperandKind::Function, usize::from(cleanup));
        let _ = writeln!(out, ".cleanup {cleanup}");
    }
}

fn named(directive: &str, names: &[String], out: &mut String) {
    for name in names {
        let _ = writeln!(out, "{directive} {}", quoted(name));
    }
}

fn reals(values: &[f64]) -> String {
    values.iter().map(|&value| words::real(value)).collect::<Vec<_>>().join(" ")
}

fn item(item: &Item, scope: &Scope, out: &mut String) {
    let _ = writeln!(out, ".item {}", quoted(&item.name));
    for keyframe in &item.keyframes {
        let of = name(scope, OperandKind::Keyframe, usize::from(keyframe.name));
        let position = reals(&keyframe.position_m);
        let _ = writeln!(out, "    .at {of} {position} {}", reals(&keyframe.rotation_rad));
    }
}

fn error_declaration(error: &ErrorDeclaration, scope: &Scope, out: &mut String) {
    let ErrorDeclaration { name: called, severity, .. } = error;
    let ErrorDeclaration {
        faults,
        watches,
        bounds,
        recovery,
        otherwise,
        respond,
        continuation,
        ..
    } = error;
    let function = |index: u16| name(scope, OperandKind::Function, usize::from(index));
    let recovery = match recovery {
        Recovery::None => "none".to_owned(),
        Recovery::Using(index) => format!("using {}", function(*index)),
        Recovery::Reversing(policy) => format!("reversing {}", reversal(policy, scope)),
    };
    let otherwise = match otherwise {
        Otherwise::Using(index) => format!("using {}", function(*index)),
        Otherwise::Operator => "operator".to_owned(),
        Otherwise::Stop => "stop".to_owned(),
    };
    let _ = writeln!(out, ".error {} {}", quoted(called), severity.word());
    if !faults.is_empty() {
        let faults = faults.iter().map(|fault| fault.word()).collect::<Vec<_>>().join(" ");
        let _ = writeln!(out, "    .on {faults}");
    }
    for watched in watches {
        let _ = writeln!(out, "    .watch {}", watched_text(*watched));
    }
    if *bounds != Bounds::default() {
        let _ = writeln!(out, "    .bounds{}", bounds_text(bounds));
    }
    let _ = writeln!(out, "    .recover {recovery}");
    let _ = writeln!(out, "    .otherwise {otherwise}");
    let _ = writeln!(out, "    .respond {}", respond.word());
    let _ = writeln!(out, "    .then {}", continuation.word());
}

fn watched_text(watched: Watched) -> String {
    match watched {
        Watched::Input { bit, level } => {
            format!("input {bit} {}", if level { "high" } else { "low" })
        }
        Watched::Force { above_n } => format!("force {}", words::real(above_n)),
    }
}

fn bounds_text(bounds: &Bounds) -> String {
    let Bounds { attempts, time_s, distance_m } = *bounds;
    let counted = attempts.map(|attempts| format!(" attempts {attempts}"));
    let timed = time_s.map(|time_s| format!(" time {}", words::real(time_s)));
    let measured = distance_m.map(|distance_m| format!(" distance {}", words::real(distance_m)));
    [counted, timed, measured].into_iter().flatten().collect()
}

fn reversal(policy: &Reversal, scope: &Scope) -> String {
    let Reversal { depth, extent, perturbation, slower, lighter } = *policy;
    let mut text = depth.word().to_owned();
    let _ = match extent {
        Extent::Actions(count) => write!(text, " actions {count}"),
        Extent::Checkpoint(at) => {
            let checkpoint = name(scope, OperandKind::Checkpoint, usize::from(at));
            write!(text, " checkpoint {checkpoint}")
        }
        Extent::Sequence => write!(text, " sequence"),
    };
    if let Some(Perturbation { limit_m, pattern }) = perturbation {
        let _ = write!(text, " perturbed {} {}", pattern.word(), words::real(limit_m));
    }
    for (is_said, word) in [(slower, " slower"), (lighter, " lighter")] {
        if is_said {
            text.push_str(word);
        }
    }
    text
}

fn code(module: &Module, names: &Names, source: &SourceComments, out: &mut String) {
    let covered = covered(module);
    for function in &module.functions {
        out.push('\n');
        head(function, out);
        match covered {
            Some(_) => Section::of_function(names, module, function).write(source, out),
            None => {
                let _ = writeln!(out, "    .range {} {}", function.first, function.end);
            }
        }
    }
    let rest = covered.unwrap_or(0)..module.code.len();
    if !rest.is_empty() {
        out.push_str("\n.code\n");
        Section::of_none(names, rest).write(source, out);
    }
}

/// How much code the functions cover, if each begins where the one before it ends.
fn covered(module: &Module) -> Option<usize> {
    let mut next = 0;
    for function in &module.functions {
        if function.first != next || function.end < function.first {
            return None;
        }
        next = function.end;
    }
    (next as usize <= module.code.len()).then_some(next as usize)
}

/// `"x" real of 1 0 0 0`
fn declared(variable: &Variable) -> String {
    let Variable { name, of_type, measures } = variable;
    let of =
        |[length, angle, time, force]: &[i8; 4]| format!(" of {length} {angle} {time} {force}");
    format!("{} {of_type}{}", quoted(name), measures.as_ref().map(of).unwrap_or_default())
}

fn head(function: &Function, out: &mut String) {
    let Function { name, kind, parameters, locals, counters, slots, first: _, end: _ } = function;
    let _ = writeln!(out, ".function {} {}", quoted(name), kind.word());
    for (at, local) in locals.iter().enumerate() {
        let word = if at < usize::from(*parameters) { ".parameter" } else { ".local" };
        let _ = writeln!(out, "    {word} {}", declared(local));
    }
    if usize::from(*parameters) > locals.len() {
        let _ = writeln!(out, "    .parameters {parameters}");
    }
    if *counters > 0 {
        let _ = writeln!(out, "    .counters {counters}");
    }
    for slot in slots {
        let _ = writeln!(out, "    .slot {}", quoted(slot));
    }
}

fn source_file(file: &SourceFile, out: &mut String) {
    let _ = writeln!(out, "\n.source {}", quoted(&file.name));
    for line in file.text.split('\n') {
        let is_verbatim = line.chars().all(|c| is_plain(c) || c == '\t');
        let _ = match line {
            "" => writeln!(out, "|"),
            _ if is_verbatim => writeln!(out, "| {line}"),
            _ => writeln!(out, "|{}", quoted(line)),
        };
    }
}
