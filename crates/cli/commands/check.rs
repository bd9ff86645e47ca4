//! `obverse check`: say what is wrong with a program, and whether its workcell has what it needs.

use super::Result;
use crate::Outcome;
use crate::load;
use crate::write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    file: PathBuf,
    /// The workcell file, in place of the one that the program names.
    #[arg(long)]
    cell: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let program = load::program(&arguments.file)?;
    let (cell, name) = load::workcell(&program, arguments.cell.as_deref(), 0)?;
    load::machine(&program, &cell, &name)?;
    let module = program.verified.module();
    write::line(&format!(
        "{}: correct; {} functions, {} instructions; workcell: {name}",
        arguments.file.display(),
        module.functions.len(),
        module.code.len(),
    ));
    Ok(Outcome::Done)
}
