//! `obverse build`: compile a program to a module file.

use super::Result;
use crate::problem::Problem;
use crate::{Outcome, load, write};
use serde_json::json;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source or assembly text.
    file: PathBuf,
    /// The module to write; beside the program, with the extension `.obc`, where none is named.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// For machines: a summary.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let program = load::program(&arguments.file)?;
    let output = arguments.output.clone().unwrap_or_else(|| arguments.file.with_extension("obc"));
    write::check(&output, "module", &program.files())?;
    let bytes = obverse_bytecode::encode(program.verified.module())
        .map_err(|error| Problem::of_file(&arguments.file, error))?;
    write::file(&output, &bytes)?;
    if arguments.json {
        let summary = json!({
            "type": "summary",
            "outcome": "built",
            "file": output.display().to_string(),
            "bytes": bytes.len(),
        });
        write::line(&summary.to_string());
    } else {
        write::line(&format!("{}: {} bytes", output.display(), bytes.len()));
    }
    Ok(Outcome::Done)
}
