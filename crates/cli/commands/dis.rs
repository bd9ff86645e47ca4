//! `obverse dis`: show the instructions of a program, with the class of each.

use super::Result;
use crate::{Outcome, load, show, write};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    file: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    // What cannot run can be looked at all the same.
    let (module, source) = load::module(&arguments.file)?;
    source.iter().for_each(show::diagnostics);
    write::out(&obverse_bytecode::disassemble(&module));
    Ok(Outcome::Done)
}
