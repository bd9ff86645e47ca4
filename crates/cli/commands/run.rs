//! `obverse run`: run a program on the simulated workcell and tell what happens.

use super::{Result, dry};
use crate::after::{self, AfterArguments};
use crate::load::{self, Program, Workcell};
use crate::parameters::ParameterArguments;
use crate::problem::Problem;
use crate::recovering::{self, Kept, Terminal};
use crate::report::{self, Report};
use crate::story::Story;
use crate::taping::{self, Rig};
use crate::{Outcome, show, write};
use obverse_debugger::Before;
use obverse_recovery::{
    Bounds, Driven, Ending, Incident, Memory, PERSON_S, Recovery, drive_in, recover_in,
};
use obverse_sim::{Missed, Sim};
use obverse_vm::{Direction, Limits, Machine};
use obverse_workcell::{Clock, Safety};
use serde_json::{Map, json};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    pub(crate) file: PathBuf,
    /// What all chance in the workcell follows from.
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub(crate) seed: u64,
    /// The workcell file, in place of the one that the program names.
    #[arg(long, value_name = "FILE")]
    pub(crate) cell: Option<PathBuf>,
    /// Record the run to a tape file.
    #[arg(long, value_name = "FILE")]
    pub(crate) tape: Option<PathBuf>,
    /// Stop after about so many instructions.
    #[arg(long, default_value_t = 1_000_000_000, value_name = "N")]
    pub(crate) limit: u64,
    #[command(flatten)]
    pub(crate) after: AfterArguments,
    #[command(flatten)]
    pub(crate) parameters: ParameterArguments,
    #[command(flatten)]
    pub(crate) recovering: recovering::RecoveryArguments,
    /// Tell the run to machines: JSON Lines, a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

/// What `run` alone understands.
#[derive(clap::Args)]
pub(crate) struct RunArguments {
    #[command(flatten)]
    pub(crate) common: Arguments,
    /// Tell how long it takes, by sequence and by action, and not what happens: everything is at
    /// the place that the workcell file gives it, and nothing is noisy.
    #[arg(long, conflicts_with = "tape")]
    dry: bool,
}

pub(crate) fn run(arguments: &RunArguments) -> Result {
    if arguments.dry {
        return dry::run(&arguments.common);
    }
    let arguments = &arguments.common;
    let program = load::program_with(&arguments.file, &arguments.parameters.parameters)?;
    let (mut cell, file, before) = workcell(arguments, &program)?;
    let mut machine = load::machine(&program, &cell, &file)?;
    let kept = Kept::read(arguments.recovering.policy.memory.as_deref(), &program, &file.name)?;
    let mut memory = kept.memory();
    let mut tape = taping::create(arguments.tape.as_deref())?;
    let mut rig =
        Rig::of(arguments, &program, (&mut machine, &mut cell), tape.as_mut(), (&file, before))?;
    head(arguments, &file.name);
    let (ending, incidents) = there(arguments, rig.driven(), &mut memory);
    let recorded = rig
        .end(&report::ending_words(program.verified.module(), &ending))
        .and_then(|()| kept.keep(&memory));
    let missed = missed(arguments, &ending, &cell);
    let told = Told { ending: &ending, incidents: &incidents, missed: &missed };
    finish(arguments, &machine, &cell, &told, recorded.as_ref().err());
    Ok(outcome(ending == Ending::Finished && missed.is_empty(), recorded))
}

/// The outcome of a run that has been told. That its tape was not written is said last: the run
/// itself is no less true.
pub(crate) fn outcome(is_done: bool, recorded: std::result::Result<(), Problem>) -> Outcome {
    match (is_done, recorded) {
        (_, Err(problem)) => {
            show::problem(&problem);
            Outcome::Wrong
        }
        (true, Ok(())) => Outcome::Done,
        (false, Ok(())) => Outcome::EndedOtherwise,
    }
}

/// The workcell of a run and what was run in it before, once it is sure that its tape and its
/// memory have a place to go.
pub(crate) fn workcell(
    arguments: &Arguments,
    program: &Program,
) -> std::result::Result<(Sim, Workcell, Option<Before>), Problem> {
    let named = arguments.cell.as_deref();
    let cell = load::workcell_path(program, named);
    let mut inputs: Vec<PathBuf> = program.files().into_iter().chain(cell).collect();
    if let Some(tape) = &arguments.tape {
        write::check(tape, "tape", &inputs)?;
        inputs.push(tape.clone());
    }
    if let Some(memory) = &arguments.recovering.policy.memory {
        write::check_text(memory, "memory", &inputs)?;
    }
    let (mut sim, file) = load::workcell(program, named, arguments.seed)?;
    let before = arguments.after.lead(&mut sim, &file)?;
    Ok((sim, file, before))
}

/// Say what is about to run.
pub(crate) fn head(arguments: &Arguments, cell_name: &str) {
    if !arguments.json {
        let file = arguments.file.display();
        let after = after::words(arguments.after.after.as_deref());
        write::line(&format!("{file} in {cell_name}, seed {}{after}", arguments.seed));
    }
}

/// Run forward, recovering from errors, telling it as asked.
pub(crate) fn there(
    arguments: &Arguments,
    driven: &mut dyn Driven<'_, Sim>,
    memory: &mut Memory,
) -> (Ending, Vec<Incident>) {
    let module = driven.machine().program().module();
    let limits = Limits::instructions(arguments.limit);
    let mut recovery = Recovery {
        strategy: arguments.recovering.policy.strategy,
        bounds: Bounds::default(),
        memory,
        remembers: true,
        person_s: PERSON_S,
        seed: arguments.seed,
        operator: &mut Terminal::new(arguments.recovering.release, arguments.json),
        foresight: None,
        incidents: Vec::new(),
    };
    let ending = if arguments.json {
        recover_in(driven, limits, &mut recovery, &mut Report::new(module))
    } else {
        let mut story = Story::new(module);
        let ending = recover_in(driven, limits, &mut recovery, &mut story);
        tell_fault(&mut story, &ending);
        ending
    };
    (ending, recovery.incidents)
}

/// Go back, telling it as asked.
pub(crate) fn back(arguments: &Arguments, driven: &mut dyn Driven<'_, Sim>) -> Ending {
    let module = driven.machine().program().module();
    let limits = Limits::instructions(arguments.limit);
    if arguments.json {
        return drive_in(driven, Direction::Reverse, limits, &mut Report::new(module));
    }
    let mut story = Story::new(module);
    let ending = drive_in(driven, Direction::Reverse, limits, &mut story);
    tell_fault(&mut story, &ending);
    ending
}

/// Where the program was that a fault stopped.
fn tell_fault(story: &mut Story<'_>, ending: &Ending) {
    if matches!(ending, Ending::Fault { .. }) {
        story.tell_headings();
    }
}

/// What is not as the workcell file says that it should be, of a run that believes all is well: of
/// one that begins with the bare cell, since what comes after an assembly may take it apart.
fn missed(arguments: &Arguments, ending: &Ending, cell: &Sim) -> Vec<Missed> {
    let assembles = arguments.after.after.is_none() && *ending == Ending::Finished;
    if assembles { cell.missed_goals() } else { Vec::new() }
}

/// What there is to say of a run in the end.
struct Told<'t> {
    ending: &'t Ending,
    incidents: &'t [Incident],
    missed: &'t [Missed],
}

fn finish(
    arguments: &Arguments,
    machine: &Machine<'_>,
    cell: &Sim,
    told: &Told<'_>,
    unrecorded: Option<&Problem>,
) {
    let Told { ending, incidents, missed } = *told;
    let module = machine.program().module();
    let words = report::ending_words(module, ending);
    if arguments.json {
        let mut more = Map::new();
        more.insert("held".to_owned(), json!(cell.is_stopped()));
        more.insert("message".to_owned(), json!(words));
        more.insert("errors".to_owned(), report::pending(machine));
        more.insert("incidents".to_owned(), recovering::incidents(module, incidents));
        more.insert("stopped_at".to_owned(), report::place(module, report::ending_pc(ending)));
        let goal = |missed: &Missed| {
            let (why, text) = (missed.why.code(), missed.to_string());
            json!({ "goal": missed.goal + 1, "why": why, "text": text })
        };
        more.insert("missed_goals".to_owned(), missed.iter().map(goal).collect());
        more.extend(unrecorded.map(report::messages));
        let code = if missed.is_empty() { ending.code() } else { "false_success" };
        report::summary(code, report::figures(machine, cell), more);
        return;
    }
    match missed.is_empty() {
        true => write::line(&words),
        false => write::line(&format!("{words}, and it is not as it should be")),
    }
    for missed in missed {
        write::line(&format!("  {missed}"));
    }
    if cell.is_stopped() {
        write::line("the arm is held: it needs a release (`--release N` gives so many beforehand)");
    }
    write::line(&figures_line(machine, cell));
}

/// The figures of a run on one line.
pub(crate) fn figures_line(machine: &Machine<'_>, cell: &Sim) -> String {
    let bits = machine.tape().map_or(0, obverse_tape::Tape::recorded_bits);
    format!(
        "{} instructions, {} commands, {bits} bits of tape, {:.2} s",
        machine.executed(),
        machine.commands(),
        cell.now_s()
    )
}
