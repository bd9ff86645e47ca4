//! `obverse dis`: show the instructions of a program, with the class of each.

use super::Result;
use crate::report::Lines;
use crate::{Outcome, load, show, write};
use obverse_bytecode::Module;
use serde_json::{Map, json};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    file: PathBuf,
    /// For machines: JSON Lines, an object an instruction and a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    // What cannot run can be looked at all the same.
    let (module, source) = load::module(&arguments.file)?;
    source.iter().for_each(show::diagnostics);
    if arguments.json {
        as_json(&module);
    } else {
        write::out(&obverse_bytecode::disassemble(&module));
    }
    Ok(Outcome::Done)
}

fn as_json(module: &Module) {
    let lines = Lines::new(module);
    for (pc, instr) in (0_u32..).zip(&module.code) {
        let info = instr.info();
        let mut operands = Map::new();
        let mut names = info.operands.iter();
        instr.each_operand(&mut |_, _, value| {
            operands.extend(names.next().map(|(name, _)| ((*name).to_owned(), json!(value))));
        });
        let function = module.function_at(pc).and_then(|index| module.functions.get(index));
        let object = json!({
            "type": "instruction",
            "instruction": pc,
            "opcode": info.mnemonic,
            "operands": operands,
            "class": info.class.name(),
            "function": function.map(|function| &function.name),
            "file": lines.of(pc).map(|(file, _)| file),
            "line": lines.of(pc).map(|(_, line)| line),
        });
        write::line(&object.to_string());
    }
    let summary = json!({
        "type": "summary",
        "outcome": "shown",
        "functions": module.functions.len(),
        "instructions": module.code.len(),
    });
    write::line(&summary.to_string());
}
