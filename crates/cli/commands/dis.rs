//! `obverse dis`: show the instructions of a program, with the class of each.

use super::Result;
use crate::{Outcome, load, write};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    file: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let module = load::module(&arguments.file)?;
    write::out(&obverse_bytecode::disassemble(&module));
    Ok(Outcome::Done)
}
