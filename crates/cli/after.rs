//! `--after PROGRAM`: what begins where another program has ended, as an inverse does.
//!
//! The other program runs in the same workcell first, untold and without a tape. Knows nothing of
//! what begins then.

use crate::load::{self, Workcell};
use crate::problem::Problem;
use crate::report;
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
    /// Run what goes before, if anything does.
    ///
    /// # Errors
    /// It does not fit into the workcell, or does not come to its end there.
    pub(crate) fn lead(&self, cell: &mut Sim, file: &Workcell) -> Result<(), Problem> {
        self.after.as_deref().map_or(Ok(()), |first| lead(first, cell, file))
    }
}

fn lead(first: &Path, cell: &mut Sim, file: &Workcell) -> Result<(), Problem> {
    let program = load::quietly(first)?;
    let mut machine = load::machine(&program, cell, file)?.without_tape();
    let limits = Limits::instructions(INSTRUCTIONS_MAX);
    let ending = drive(&mut machine, Direction::Forward, limits, cell, &mut ());
    if ending == Ending::Finished {
        return Ok(());
    }
    let words = report::ending_words(program.verified.module(), &ending);
    Err(Problem::of_file(
        first,
        format!("nothing can begin after it, since it does not end: {words}"),
    ))
}
