//! Blocks of the language `obv`: each is compiled, and run and taken back in the workcell of its
//! page.
//!
//! ```text
//! obv                    a whole program
//! obv declarations       stands beside the prelude of its page, with a `main` or without
//! obv statements         stands in a sequence, after the prelude
//! obv prelude            what the others of the page take for granted, from here on
//! obv .. wrong E0203     what gives these codes and no others
//! obv from FILE          is that file of the project, to the letter
//! ```
//!
//! Of a part of a program it is not asked that what it declares is used.

use crate::page::{Block, ROOT};
use crate::reader::Reader;
use obverse_bytecode::verify;
use obverse_compiler::compile;
use obverse_recovery::{Ending, drive};
use obverse_sim::{Cell, Sim};
use obverse_syntax::codes::Code;
use obverse_vm::{Direction, Limits, Machine};
use std::collections::BTreeSet;
use std::path::Path;

/// An example that runs longer than this does not end.
const INSTRUCTIONS: u64 = 100_000;

/// Try one; `prelude` is what the page takes for granted.
///
/// # Errors
/// What it does that it should not.
pub(crate) fn check(block: &Block<'_>, prelude: &str, reader: &Reader) -> Result<(), String> {
    if let Some(file) = block.after("from") {
        let text = std::fs::read_to_string(Path::new(ROOT).join(file)).unwrap_or_default();
        let is_same = text == block.text();
        return is_same.then_some(()).ok_or_else(|| format!("{file} has another text"));
    }
    let wrong: BTreeSet<Code> = match block.after("wrong") {
        Some(codes) => codes.split(',').map(|code| code.parse().expect("a code")).collect(),
        None => BTreeSet::new(),
    };
    let is_whole = !block.says("statements") && !block.says("declarations");
    let text = whole(block, prelude);
    let compiled = compile("main.obv", &text);
    let found = compiled.diagnostics.iter().map(|found| found.code);
    let is_allowed = |code: &Code| !is_whole && *code == Code::Unused && !wrong.contains(code);
    let found: BTreeSet<Code> = found.filter(|code| !is_allowed(code)).collect();
    if found != wrong {
        return Err(format!("gives {found:?}:\n{:#?}", compiled.diagnostics));
    }
    match compiled.module {
        Some(module) => {
            let named = module.cell.as_deref();
            let Some(cell) = named.map_or(Some(Cell::bare()), |name| cell(name, reader)) else {
                return Err("names a workcell that is not there".to_owned());
            };
            let verified = verify(module).map_err(|errors| format!("{errors:?}"))?;
            there_and_back(&verified, &cell)
        }
        _ => Ok(()),
    }
}

/// The program that a block is, or is part of.
fn whole(block: &Block<'_>, prelude: &str) -> String {
    let text = block.text();
    if block.says("statements") {
        format!("{prelude}\nsequence main {{\n{text}}}\n")
    } else if block.says("declarations") {
        let main = if text.contains("sequence main {") { "" } else { "sequence main { }\n" };
        format!("{prelude}\n{text}\n{main}")
    } else {
        text
    }
}

/// A workcell that the reader has written, or else one of those for people.
fn cell(name: &str, reader: &Reader) -> Option<Cell> {
    let of_project = || std::fs::read_to_string(Path::new(ROOT).join("programs").join(name)).ok();
    let text = reader.file(name).or_else(of_project)?;
    Some(Cell::parse(&text).unwrap_or_else(|error| panic!("{name}: {error:?}")))
}

/// It runs to an end of its own, and goes back to the start or to what cannot be taken back.
fn there_and_back(program: &obverse_bytecode::Verified, cell: &Cell) -> Result<(), String> {
    let mut sim = Sim::new(cell, 0);
    let mut machine = Machine::new(program, &sim).map_err(|errors| format!("{errors:?}"))?;
    let begin = machine.digest(&sim);
    let limits = Limits::instructions(INSTRUCTIONS);
    let mut run =
        |machine: &mut Machine<'_>, direction| drive(machine, direction, limits, &mut sim, &mut ());
    let there = run(&mut machine, Direction::Forward);
    if !matches!(there, Ending::Finished | Ending::Unhandled(_)) {
        return Err(format!("ends with {there:?}"));
    }
    let back = run(&mut machine, Direction::Reverse);
    let is_identical = machine.digest(&sim) == begin;
    match back {
        Ending::AtStart if is_identical => Ok(()),
        Ending::Refused(_) => Ok(()),
        other => Err(format!("goes back to {other:?}, identical: {is_identical}")),
    }
}
