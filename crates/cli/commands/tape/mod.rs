//! `obverse tape`: show what is on a recorded tape, newest first, and what it costs by opcode, by
//! instruction and by robot command.
//!
//! [`walk`] finds the records, [`cost`] adds them up, [`text`] and [`machine`] show them to people
//! and machines, [`value`] says what a record holds, [`notes`] what happened in recoveries.

mod cost;
mod machine;
mod notes;
mod text;
mod value;
mod walk;

use super::Result;
use crate::problem::Problem;
use crate::{Outcome, taping};
use cost::Costs;
use obverse_bytecode::{Module, fingerprint};
use obverse_tape::{Snapshot, Streams};
use std::path::PathBuf;
use walk::Walk;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The tape file.
    file: PathBuf,
    /// Show at most so many records: 40 where no number is given, with `--json` all.
    #[arg(long, value_name = "N")]
    records: Option<usize>,
    /// For machines: JSON Lines, a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

/// What there is to show.
struct Shown<'a> {
    module: &'a Module,
    file: &'a Recorded,
    walk: &'a Walk,
    costs: &'a Costs,
}

/// What a tape file leads to: the end of its run.
struct Recorded {
    fingerprint: u64,
    seed: u64,
    ending: String,
    state: Snapshot,
    streams: Streams,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let path = &arguments.file;
    let opened = taping::open(path)?;
    let (state, streams) = opened.run()?.as_data();
    let head = &opened.file.head;
    let (fingerprint, seed, ending) = (fingerprint(&head.module), head.seed, opened.ending());
    let file = Recorded { fingerprint, seed, ending, state, streams };
    let program = &opened.program.verified;
    let walk = walk::back(program, &file).map_err(|error| Problem::of_file(path, error))?;
    let module = program.module();
    let costs = Costs::of(module, &walk);
    let shown = Shown { module, file: &file, walk: &walk, costs: &costs };
    if arguments.json {
        machine::show(&shown, arguments.records);
    } else {
        text::show(&shown, arguments.records.unwrap_or(text::RECORDS));
    }
    Ok(Outcome::Done)
}
