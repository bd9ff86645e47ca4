//! `--after PROGRAM`: what begins where another program has ended, as an inverse does.
//!
//! The other program runs in the same workcell first, untold and without a tape. Knows nothing of
//! what begins then.

use crate::load::{self, Program, Workcell};
use crate::problem::Problem;
use crate::report;
use obverse_bytecode::{decode, encode};
use obverse_debugger::Before;
use obverse_recovery::{Ending, drive};
use obverse_sim::Sim;
use obverse_vm::{Direction, Limits};
use std::path::{Path, PathBuf};

/// What goes before takes no more instructions.
const INSTRUCTIONS_MAX: u64 = 1_000_000_000;

#[derive(clap::Args)]
pub(crate) struct AfterArguments {
    /// Begin where this program has ended, run in the same workcell: so begins what `obverse
    /// invert` prints.
    #[arg(long, value_name = "PROGRAM")]
    pub(crate) after: Option<PathBuf>,
}

impl AfterArguments {
    /// Run what goes before, if anything does. What that was.
    ///
    /// # Errors
    /// It does not fit into the workcell, or does not come to its end there.
    pub(crate) fn lead(&self, cell: &mut Sim, file: &Workcell) -> Result<Option<Before>, Problem> {
        lead(self.after.as_deref(), cell, file)
    }
}

/// `, after first.obv`, behind what says where a program runs.
pub(crate) fn words(first: Option<&Path>) -> String {
    first.map(|first| format!(", after {}", first.display())).unwrap_or_default()
}

/// Run a program that goes before, if there is one. What that was.
///
/// # Errors
/// It does not fit into the workcell, or does not come to its end there.
pub(crate) fn lead(
    first: Option<&Path>,
    cell: &mut Sim,
    file: &Workcell,
) -> Result<Option<Before>, Problem> {
    let Some(first) = first else { return Ok(None) };
    let program = load::quietly(first)?;
    run_through(&program, cell, file)?;
    Ok(Some(before(&program)?))
}

/// Run again what a recorded run began after, which the tape holds.
///
/// # Errors
/// It does not verify, does not fit into the workcell, or does not come to its end there.
pub(crate) fn lead_again(
    recorded: &Before,
    cell: &mut Sim,
    file: &Workcell,
) -> Result<(), Problem> {
    let path = Path::new(&recorded.program);
    let module = decode(&recorded.module).map_err(|error| Problem::of_file(path, error))?;
    run_through(&load::verified(path, module, None)?, cell, file)
}

fn before(program: &Program) -> Result<Before, Problem> {
    let module = encode(program.verified.module());
    let module = module.map_err(|error| Problem::of_file(&program.path, error))?;
    let name = program.path.display().to_string();
    Ok(Before { program: name, module })
}

fn run_through(program: &Program, cell: &mut Sim, file: &Workcell) -> Result<(), Problem> {
    let mut machine = load::machine(program, cell, file)?.without_tape();
    let limits = Limits::instructions(INSTRUCTIONS_MAX);
    let ending = drive(&mut machine, Direction::Forward, limits, cell, &mut ());
    if ending == Ending::Finished {
        return Ok(());
    }
    let words = report::ending_words(program.verified.module(), &ending);
    Err(Problem::of_file(
        &program.path,
        format!("nothing can begin after it, since it does not end: {words}"),
    ))
}
