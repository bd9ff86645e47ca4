//! How a session begins: with a run of its own, or with one that a tape holds.

use crate::message::Wanted;
use crate::server::{Begin, Loaded};
use obverse_debugger::{Recording, Run};
use obverse_sim::Sim;
use obverse_vm::LinkError;

/// The run of a session that begins.
pub(crate) fn run(loaded: &Loaded) -> Result<Run<'_, Sim>, String> {
    let told = |errors: Vec<LinkError>| {
        let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
        errors.join("; ")
    };
    match &loaded.begin {
        Begin::Live(cell) => {
            let run = Run::new(&loaded.program, Sim::clone(cell)).map_err(told)?;
            Ok(run.simulated(None))
        }
        Begin::Recorded(recording, start) => {
            let run = Run::of_recording(&loaded.program, Recording::clone(recording));
            let misfit = "what the tape records is not what its program does";
            let run = run.map_err(|errors| errors.map_or_else(|| misfit.to_owned(), told))?;
            Ok(run.simulated(start.as_deref().cloned()))
        }
    }
}

/// Where a session stops that nobody has asked to.
pub(crate) struct Stops {
    /// Before the first action.
    pub(crate) stop_on_entry: bool,
    /// At the end of the program.
    pub(crate) stop_at_end: bool,
    /// Nowhere at all.
    pub(crate) no_debug: bool,
    /// After about so many instructions of a request.
    pub(crate) limit: u64,
}

impl Stops {
    pub(crate) fn of(wanted: &Wanted) -> Self {
        match wanted {
            Wanted::Launch(launch) => Self {
                stop_on_entry: launch.stop_on_entry,
                stop_at_end: launch.stop_at_end,
                no_debug: launch.no_debug,
                limit: launch.limit.map_or(u64::MAX, |limit| limit.max(1)),
            },
            Wanted::Attach(attach) => Self {
                stop_on_entry: true,
                stop_at_end: true,
                no_debug: false,
                limit: attach.limit.map_or(u64::MAX, |limit| limit.max(1)),
            },
        }
    }
}
