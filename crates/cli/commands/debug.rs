//! `obverse debug`: walk through a run in both directions.

use super::Result;
use crate::after::{self, AfterArguments};
use crate::debug::{Face, Front, Lines};
use crate::load;
use crate::parameters::ParameterArguments;
use crate::problem::{Problem, plain};
use crate::recovering::{Kept, PolicyArguments};
use crate::report::Report;
use crate::story::Story;
use crate::{Outcome, lacking, taping, write};
use obverse_debugger::{Policy, Run, Session};
use obverse_geometry::Pose;
use obverse_sim::Sim;
use serde_json::json;
use signal_hook::consts::SIGINT;
use signal_hook::flag::{register, register_conditional_default};
use std::path::{Path, PathBuf};

/// What a person may forget to stop: the most instructions that one command runs.
const LIMIT: u64 = 100_000_000;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module. A tape has its own.
    file: Option<PathBuf>,
    /// Open the tape file of a run at its end, in place of a run that begins.
    #[arg(long, value_name = "FILE")]
    tape: Option<PathBuf>,
    /// What all chance in the workcell follows from.
    #[arg(long, default_value_t = 0, value_name = "N", conflicts_with = "tape")]
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
    /// How often a stopped arm is released without a `release`, as it is in `run`.
    #[arg(long, default_value_t = 0, value_name = "N", conflicts_with = "tape")]
    release: u32,
    #[command(flatten)]
    after: AfterArguments,
    #[command(flatten)]
    parameters: ParameterArguments,
    #[command(flatten)]
    policy: PolicyArguments,
    /// For machines: JSON Lines, an object an event and an answer a command, a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    match (&arguments.tape, &arguments.file) {
        (Some(tape), file) => post_mortem(arguments, tape, file.as_deref()),
        (None, Some(file)) => live(arguments, file),
        (None, None) => Err(Problem::new("name a program, or a tape with `--tape`")),
    }
}

fn live(arguments: &Arguments, file: &Path) -> Result {
    let program = load::program_with(file, &arguments.parameters.parameters)?;
    let named = arguments.cell.as_deref();
    if let Some(memory) = &arguments.policy.memory {
        let cell = load::workcell_path(&program, named);
        let inputs: Vec<PathBuf> = program.files().into_iter().chain(cell).collect();
        write::check_text(memory, "memory", &inputs)?;
    }
    let (mut cell, cell_file) = load::workcell(&program, named, arguments.seed)?;
    arguments.after.lead(&mut cell, &cell_file)?;
    let kept = Kept::read(arguments.policy.memory.as_deref(), &program, &cell_file.name)?;
    let lines = Lines::of(arguments.commands.as_deref(), arguments.json)?;
    let run = Run::new(&program.verified, cell)
        .map_err(|errors| Problem::several(lacking::messages(&program, &cell_file, &errors)))?;
    if !arguments.json {
        let (name, after) = (file.display(), after::words(arguments.after.after.as_deref()));
        write::line(&format!("{name} in {}, seed {}{after}", cell_file.name, arguments.seed));
    }
    let run = run.simulated(None);
    converse(arguments, (run, Vec::new()), (arguments.seed, Some(&kept)), lines)
}

/// A run as its tape tells it. What would have been can be tried where its workcell is to be had.
fn post_mortem(arguments: &Arguments, tape: &Path, file: Option<&Path>) -> Result {
    if arguments.policy.memory.is_some() {
        return Err(Problem::new("a tape is only looked at, and teaches nothing: no `--memory`"));
    }
    if arguments.after.after.is_some() {
        return Err(Problem::new("a tape has what its run began after: no `--after`"));
    }
    let opened = taping::open(tape)?;
    if let Some(file) = file {
        let program = load::program_with(file, &arguments.parameters.parameters)?;
        opened.check_is_of(&program)?;
    }
    let lines = Lines::of(arguments.commands.as_deref(), arguments.json)?;
    let run = opened.run()?;
    let named = arguments.cell.as_deref();
    let (start, lacks) = match opened.start(named) {
        Ok(start) => (Some(start), None),
        Err(problem) if named.is_some() => return Err(problem),
        Err(problem) => (None, Some(problem)),
    };
    let head = &opened.file.head;
    if arguments.json {
        let told = json!({
            "type": "tape",
            "program": head.program,
            "cell": head.cell.as_ref().map(|cell| &cell.name),
            "seed": head.seed,
            "after": head.after.as_ref().map(|before| &before.program),
            "ending": opened.file.ending,
            "torn_bytes": opened.file.torn_bytes,
            "can_try": start.is_some(),
        });
        write::line(&told.to_string());
    } else {
        write::line(&opened.title());
        write::line(&opened.ending());
        opened.lacks(lacks.as_ref()).iter().for_each(|text| write::line(text));
    }
    let run = run.simulated(start);
    converse(arguments, (run, opened.tcps()), (head.seed, None), lines)
}

/// The first Ctrl-C halts the command under way, between instructions; where it has found nothing
/// to halt, the next one ends the process as it always does.
fn interrupt(session: &Session<'_, Sim>) -> std::result::Result<(), Problem> {
    let is_asked = session.interrupter();
    register_conditional_default(SIGINT, is_asked.clone())
        .and_then(|_| register(SIGINT, is_asked))
        .map(|_| ())
        .map_err(|error| Problem::new(format!("Ctrl-C cannot be heard: {}", plain(&error))))
}

fn converse(
    arguments: &Arguments,
    (run, tcps): (Run<'_, Sim>, Vec<Pose>),
    (seed, kept): (u64, Option<&Kept>),
    mut lines: Lines,
) -> Result {
    let mut session = Session::over(run);
    let module = session.module();
    session.limit(arguments.limit);
    interrupt(&session)?;
    session.tell_to(match arguments.json {
        true => Box::new(Report::new(module)),
        false => Box::new(Story::new(module)),
    });
    let policy = Policy { strategy: arguments.policy.strategy, ..Policy::declared(seed) };
    session.recover_by(policy, kept.map(Kept::memory).unwrap_or_default());
    let face = Face::of(arguments.json);
    let mut front = Front::over(session, tcps, (face, arguments.release));
    let failed = front.converse(&mut lines)?;
    kept.map_or(Ok(()), |kept| kept.keep(front.memory()))?;
    Ok(if failed == 0 || lines.is_terminal() { Outcome::Done } else { Outcome::EndedOtherwise })
}
