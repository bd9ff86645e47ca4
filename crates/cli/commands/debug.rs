//! `obverse debug`: walk through a run in both directions.

use super::Result;
use crate::debug::{Face, Front, Lines};
use crate::load;
use crate::parameters::ParameterArguments;
use crate::problem::Problem;
use crate::report::Report;
use crate::story::Story;
use crate::{Outcome, lacking, write};
use obverse_debugger::{Run, Session};
use std::path::PathBuf;

/// What a person may forget to stop: the most instructions that one command runs.
const LIMIT: u64 = 100_000_000;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    file: PathBuf,
    /// What all chance in the workcell follows from.
    #[arg(long, default_value_t = 0, value_name = "N")]
    seed: u64,
    /// The workcell file, in place of the one that the program names.
    #[arg(long, value_name = "FILE")]
    cell: Option<PathBuf>,
    /// Read commands from a file, a line each, not from standard input.
    #[arg(long, value_name = "FILE")]
    commands: Option<PathBuf>,
    /// Stop a command after about so many instructions.
    #[arg(long, default_value_t = LIMIT, value_name = "N")]
    limit: u64,
    #[command(flatten)]
    parameters: ParameterArguments,
    /// For machines: JSON Lines, an object an event and an answer a command, a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let program = load::program_with(&arguments.file, &arguments.parameters.parameters)?;
    let (cell, file) = load::workcell(&program, arguments.cell.as_deref(), arguments.seed)?;
    let mut lines = Lines::of(arguments.commands.as_deref(), arguments.json)?;
    let run = Run::new(&program.verified, cell)
        .map_err(|errors| Problem::several(lacking::messages(&program, &file, &errors)))?;
    let mut session = Session::over(run.simulated(None));
    let module = program.verified.module();
    session.limit(arguments.limit);
    session.tell_to(match arguments.json {
        true => Box::new(Report::new(module)),
        false => Box::new(Story::new(module)),
    });
    if !arguments.json {
        let name = arguments.file.display();
        write::line(&format!("{name} in {}, seed {}", file.name, arguments.seed));
    }
    let mut front = Front::over(session, Face::of(arguments.json));
    let failed = front.converse(&mut lines)?;
    Ok(if failed == 0 || lines.is_terminal() { Outcome::Done } else { Outcome::EndedOtherwise })
}
