//! `obverse trials`: try a program over many seeded assemblies, by one strategy or several.

mod journal;
pub(super) mod progress;

use super::Result;
use crate::load::{self, Program};
use crate::parameters::ParameterArguments;
use crate::problem::Problem;
use crate::{Outcome, files, lacking, recovering, show, write};
use journal::Journal;
use obverse_recovery::{Memory, Subject};
use obverse_sim::Cell;
use obverse_trials::machine::Terms;
use obverse_trials::{MachineCase, Part, Plan, Shard, Strategy, Summary};
use obverse_trials::{plots, shard, statistics, table};
use progress::Progress;
use serde_json::{Value, json};
use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf};

/// The largest file of a shard that is read, in bytes.
const MAX_SHARD_BYTES: u64 = 4 << 30;
/// The most threads that can be asked for.
const MAX_JOBS: usize = 1024;
/// The highest price of a person, in seconds: a week.
const MAX_PERSON_S: f64 = 7.0 * 86_400.0;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    #[arg(required_unless_present = "merge")]
    program: Option<PathBuf>,
    /// How many assemblies are made by each strategy.
    #[arg(long, default_value_t = 1000, value_name = "N")]
    runs: u64,
    /// How errors are answered: declared (as the program says), stop, retry, back-up, restart,
    /// explicit, fixed:D, escalating, learned or oracle; several with commas, or `all` to compare.
    #[arg(long, default_value = "declared", value_name = "LIST")]
    strategy: String,
    /// What the seeds of the assemblies follow from.
    #[arg(long, default_value_t = 0, value_name = "N")]
    seed: u64,
    /// The workcell file, in place of the one that the program names.
    #[arg(long, value_name = "FILE")]
    cell: Option<PathBuf>,
    /// On how many threads; as many as there are cores, if it is not said. It changes no result.
    #[arg(long, value_name = "J")]
    jobs: Option<usize>,
    /// Only one part of the campaign, of so many: 2/4 is the second quarter.
    #[arg(long, default_value_t = Shard::WHOLE, value_name = "I/N", requires = "out")]
    shard: Shard,
    /// Keep what comes of it in a file, whole or not at all.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Go on with what was stopped: what was done is in FILE.part.
    #[arg(long, requires = "out")]
    resume: bool,
    /// Put the files of all shards together, and report on the whole; what was made is said by
    /// them.
    #[arg(long, value_name = "FILES", num_args = 1.., conflicts_with_all = [
        "program", "runs", "strategy", "seed", "cell", "jobs", "shard", "resume", "memory",
        "learn", "parameters", "person", "release", "limit",
    ])]
    merge: Vec<PathBuf>,
    /// Write plots to a folder, as SVG.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// What the strategy `learned` goes by: read, if the file is there; else learned beforehand,
    /// and written.
    #[arg(long, value_name = "FILE")]
    memory: Option<PathBuf>,
    /// From how many assemblies, of seeds of their own, the strategy `learned` learns beforehand.
    #[arg(long, default_value_t = 8192, value_name = "N")]
    learn: u64,
    #[command(flatten)]
    parameters: ParameterArguments,
    /// How long a person takes, each time that one has to come, in seconds.
    #[arg(long, default_value_t = 300.0, value_name = "S")]
    person: f64,
    /// How often a person releases a stopped arm in one assembly: the fresh command it waits for.
    #[arg(long, default_value_t = 0, value_name = "N")]
    release: u32,
    /// Give an assembly up after about so many instructions.
    #[arg(long, default_value_t = 1_000_000, value_name = "N")]
    limit: u64,
    /// For machines: JSON Lines, a line for each run and strategy, and a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let part = match &arguments.program {
        Some(program) => campaign(arguments, program)?,
        None => merged(arguments)?,
    };
    let summary = obverse_trials::summary(&part.plan, &part.records);
    let unwritten = draw(arguments, &part, &summary).err();
    match arguments.json {
        true => report(&part, &summary, unwritten.as_ref()),
        false => write::out(&(head(&part) + "\n" + &table::draw(&summary))),
    }
    let Some(problem) = unwritten else { return Ok(Outcome::Done) };
    show::problem(&problem);
    Ok(Outcome::Wrong)
}

/// What comes of a campaign, or of a shard of it.
fn campaign(arguments: &Arguments, path: &Path) -> std::result::Result<Part, Problem> {
    let strategies =
        Strategy::list(&arguments.strategy).map_err(|error| Problem::new(error.to_string()))?;
    let jobs = check(arguments)?;
    let program = load::program_with(path, &arguments.parameters.parameters)?;
    let (cell, file) = load::cell(&program, arguments.cell.as_deref())?;
    let terms = Terms {
        person_s: arguments.person,
        releases: arguments.release,
        instructions: arguments.limit,
    };
    let case = MachineCase::new(&program.verified, &cell, terms)
        .map_err(|errors| Problem::several(lacking::messages(&program, &file, &errors)))?;
    let cell_path = load::workcell_path(&program, arguments.cell.as_deref());
    let parameters = arguments.parameters.parameters.iter().cloned();
    check_outputs(arguments, program.files().into_iter().chain(cell_path).chain(parameters))?;
    let mut plan = plan(arguments, &program, (&cell, file.text.as_deref()), strategies)?;
    let memory = match plan.strategies.contains(&Strategy::Learned) {
        true => {
            let of = recovering::subject(&program, &file.name);
            let memory = learned(arguments, &program, &case, &of, jobs)?;
            plan.memory_digest = Some(digest(memory.to_text(&of).as_bytes()));
            memory
        }
        false => Memory::default(),
    };
    carry_out(arguments, &case, &memory, plan, jobs)
}

/// Run what is not done yet, and keep it as asked.
fn carry_out(
    arguments: &Arguments,
    case: &MachineCase<'_>,
    memory: &Memory,
    plan: Plan,
    jobs: usize,
) -> std::result::Result<Part, Problem> {
    let shard = arguments.shard;
    let (mut journal, mut records) = match &arguments.out {
        Some(out) => Journal::open(out, &plan, shard, arguments.resume)?,
        None => (Journal::none(), Vec::new()),
    };
    let mut runs = shard.runs(plan.runs);
    let all = runs.end - runs.start;
    runs.start += (records.len() / plan.strategies.len()) as u64;
    let mut progress = Progress::new("assemblies", runs.start - shard.runs(plan.runs).start, all);
    obverse_trials::run(case, memory, &plan, runs, jobs, |of_run| {
        journal.add(&of_run)?;
        records.extend(of_run);
        progress.one_more();
        Ok(())
    })?;
    drop(progress);
    journal.finish()?;
    Ok(Part { plan, shard, records })
}

/// What can be told to be wrong before anything is read; and how many threads work.
fn check(arguments: &Arguments) -> std::result::Result<usize, Problem> {
    let wrong = |text: String| Err(Problem::new(text));
    let (runs, most) = (arguments.runs, obverse_trials::plan::MAX_RUNS);
    if !(1..=most).contains(&runs) {
        return wrong(format!("--runs is {runs}, and must be from 1 to {most}"));
    }
    if arguments.learn > most {
        return wrong(format!("--learn is {}, and must be at most {most}", arguments.learn));
    }
    if !(0.0..=MAX_PERSON_S).contains(&arguments.person) {
        let person = arguments.person;
        return wrong(format!("--person is {person} s, and must be from 0 to {MAX_PERSON_S} s"));
    }
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    let jobs = arguments.jobs.unwrap_or(cores.min(MAX_JOBS));
    if !(1..=MAX_JOBS).contains(&jobs) {
        return wrong(format!("--jobs is {jobs}, and must be from 1 to {MAX_JOBS}"));
    }
    Ok(jobs)
}

fn plan(
    arguments: &Arguments,
    program: &Program,
    (cell, cell_text): (&Cell, Option<&str>),
    strategies: Vec<Strategy>,
) -> std::result::Result<Plan, Problem> {
    let module = obverse_bytecode::encode(program.verified.module())
        .map_err(|error| Problem::of_file(&program.path, error))?;
    let name = program.path.file_name().unwrap_or(program.path.as_os_str());
    Ok(Plan {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        program: name.to_string_lossy().into_owned(),
        program_digest: digest(&module),
        cell_digest: digest(cell_text.unwrap_or_default().as_bytes()),
        goals: u32::try_from(cell.goals.len()).unwrap_or(u32::MAX),
        sequences: sequences(program),
        memory_digest: None,
        strategies,
        seed: arguments.seed,
        runs: arguments.runs,
        person_s: arguments.person,
        releases: arguments.release,
        instructions: arguments.limit,
    })
}

/// How many errors of a program have a sequence written against them.
fn sequences(program: &Program) -> u32 {
    let errors = program.verified.module().errors.iter();
    errors.map(|error| u32::from(obverse_recovery::sequence(error).is_some())).sum()
}

fn digest(bytes: &[u8]) -> String {
    format!("{:016x}", obverse_bytecode::fingerprint(bytes))
}

/// What the strategy that learns goes by.
fn learned(
    arguments: &Arguments,
    program: &Program,
    case: &MachineCase<'_>,
    of: &Subject,
    jobs: usize,
) -> std::result::Result<Memory, Problem> {
    if let Some(path) = arguments.memory.as_deref().filter(|path| path.exists()) {
        return recovering::remembered_of(path, program, of);
    }
    let mut progress = Progress::new("learning", 0, arguments.learn);
    let mut more = |_| progress.one_more();
    let blank = Memory::default();
    let memory =
        obverse_trials::learn(case, blank, arguments.seed, arguments.learn, jobs, &mut more);
    if let Some(path) = &arguments.memory {
        write::file(path, memory.to_text(of).as_bytes())?;
    }
    Ok(memory)
}

/// The whole campaign of the files of its shards.
fn merged(arguments: &Arguments) -> std::result::Result<Part, Problem> {
    check_outputs(arguments, arguments.merge.iter().cloned())?;
    let read = |path: &PathBuf| {
        let bytes = files::read_at_most(path, MAX_SHARD_BYTES)
            .map_err(|why| Problem::of_file(path, why))?;
        let part = Part::parse(&bytes).map_err(|error| Problem::of_file(path, error))?;
        Ok((path.display().to_string(), part))
    };
    let parts = arguments.merge.iter().map(read).collect::<std::result::Result<_, Problem>>()?;
    let part = obverse_trials::merge(parts).map_err(|error| Problem::new(error.to_string()))?;
    if let Some(out) = &arguments.out {
        let (mut journal, _) = Journal::open(out, &part.plan, part.shard, false)?;
        journal.add(&part.records)?;
        journal.finish()?;
    }
    Ok(part)
}

/// Check that all that will be written can be, before anything is made; and make the folder for
/// plots.
fn check_outputs(
    arguments: &Arguments,
    inputs: impl Iterator<Item = PathBuf>,
) -> std::result::Result<(), Problem> {
    let mut inputs: Vec<PathBuf> = inputs.collect();
    if let Some(out) = &arguments.out {
        journal::check(out, &inputs, arguments.resume)?;
        inputs.push(out.clone());
    }
    if let Some(memory) = &arguments.memory {
        write::check_text(memory, "memory", &inputs)?;
        inputs.push(memory.clone());
    }
    let Some(folder) = &arguments.plots else { return Ok(()) };
    make_folder(folder)?;
    for name in plots::NAMES {
        let path = folder.join(name);
        write::check_text(&path, "plot", &inputs)?;
        write::check_own(&path, "a plot of a campaign", plots::is_plot)?;
    }
    Ok(())
}

fn make_folder(folder: &Path) -> std::result::Result<(), Problem> {
    if folder.is_dir() {
        return Ok(());
    }
    fs::create_dir(folder).map_err(|error| {
        let why = crate::problem::plain(&error);
        Problem::of_file(folder, format!("this folder cannot be made: {why}"))
    })
}

fn draw(arguments: &Arguments, part: &Part, summary: &Summary) -> std::result::Result<(), Problem> {
    let Some(folder) = &arguments.plots else { return Ok(()) };
    for plot in plots::plots(&part.plan, summary) {
        write::file(&folder.join(plot.name), plot.svg.as_bytes())?;
    }
    Ok(())
}

/// What was tried, in a line.
fn head(part: &Part) -> String {
    let Part { plan, shard, .. } = part;
    let person = format!("a person takes {} s", plan.person_s);
    let each = if plan.strategies.len() > 1 { " by each strategy" } else { "" };
    let runs = shard.runs(plan.runs);
    let of_shard = match *shard {
        Shard::WHOLE => String::new(),
        shard => format!(
            " (shard {shard}: {} from number {})",
            table::grouped(runs.end - runs.start),
            table::grouped(runs.start)
        ),
    };
    let (program, all, seed) = (&plan.program, table::grouped(plan.runs), plan.seed);
    format!("{program}: {all} assemblies{each}, seed {seed}{of_shard}; {person}\n")
}

fn report(part: &Part, summary: &Summary, unwritten: Option<&Problem>) {
    write::out(&shard::head_line(&part.plan, part.shard));
    for record in &part.records {
        write::out(&shard::record_line(record));
    }
    let runs = part.shard.runs(part.plan.runs);
    let mut more = serde_json::Map::new();
    more.insert("runs".to_owned(), json!(runs.end - runs.start));
    more.insert("strategies".to_owned(), summary.to_json());
    more.insert("confidence".to_owned(), Value::from(statistics::CONFIDENCE));
    more.extend(unwritten.map(crate::report::messages));
    crate::report::summary("done", more, serde_json::Map::new());
}
