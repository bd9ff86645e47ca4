//! `obverse build`: compile a program to a module file.

use super::Result;
use crate::Outcome;
use crate::load;
use crate::show::Problem;
use crate::write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source or assembly text.
    file: PathBuf,
    /// The module to write; beside the program, with the extension `.obc`, where none is named.
    #[arg(short, long)]
    output: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let program = load::program(&arguments.file)?;
    let output = arguments.output.clone().unwrap_or_else(|| arguments.file.with_extension("obc"));
    if output == arguments.file {
        let why = format!("{}: this would overwrite the program itself", output.display());
        return Err(Problem::new(why));
    }
    let bytes = obverse_bytecode::encode(program.verified.module())
        .map_err(|error| Problem::new(format!("{}: {error}", arguments.file.display())))?;
    write::file(&output, &bytes)?;
    write::line(&format!("{}: {} bytes", output.display(), bytes.len()));
    Ok(Outcome::Done)
}
