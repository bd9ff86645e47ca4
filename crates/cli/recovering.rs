//! Recoveries at the edge: the strategy that was asked for, the memory on disk, a person at the
//! terminal, and the story of a recovery for people and for machines.

use crate::load::Program;
use crate::problem::{Message, Problem};
use crate::report::{self, Report};
use crate::story::Story;
use crate::{files, show, write};
use obverse_bytecode::Module;
use obverse_recovery::{
    Incident, Memory, MemoryCode, Operator, Outcome, Step, Strategy, Subject, Teller,
};
use obverse_workcell::{Fault, Workcell};
use serde_json::{Value, json};
use std::io::{self, BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// How many of the things that a memory knows and the program has not are said one by one.
const LACKING_SHOWN: usize = 3;

/// What a command that runs a program is told of recoveries, a person being there.
#[derive(clap::Args)]
pub(crate) struct PolicyArguments {
    /// How errors are recovered from whose recovery is reversal: declared, stop, retry, back-up,
    /// restart, explicit, fixed:N, escalating, learned.
    #[arg(long, default_value = "declared", value_name = "STRATEGY", value_parser = strategy)]
    pub(crate) strategy: Strategy,
    /// What is learned of how far to go back, kept from run to run in a file that can be read.
    #[arg(long, value_name = "FILE")]
    pub(crate) memory: Option<PathBuf>,
}

/// The same, where nobody need be.
#[derive(clap::Args)]
pub(crate) struct RecoveryArguments {
    #[command(flatten)]
    pub(crate) policy: PolicyArguments,
    /// How often a stopped arm is released without asking: the fresh command that it waits for.
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub(crate) release: u32,
}

/// The strategy of a name.
///
/// # Errors
/// There is none of this name that can be chosen; which there are.
pub(crate) fn strategy(text: &str) -> Result<Strategy, String> {
    match Strategy::from_name(text) {
        Some(Strategy::Oracle) => {
            Err("only `obverse trials` knows what will come of going back".to_owned())
        }
        Some(strategy) => Ok(strategy),
        None => Err(format!(
            "say declared, stop, retry, back-up, restart, explicit, fixed:N with N from 1 to {}, \
             escalating or learned",
            Strategy::FIXED_MAX
        )),
    }
}

/// What was learned before a run, and the file that it is kept in.
pub(crate) struct Kept {
    path: Option<PathBuf>,
    subject: Subject,
    before: Memory,
}

impl Kept {
    /// That of a file, of a program in a workcell: empty where there is no file yet, or none was
    /// named.
    ///
    /// # Errors
    /// The file cannot be read, or is no memory of these.
    pub(crate) fn read(
        path: Option<&Path>,
        program: &Program,
        cell: &str,
    ) -> Result<Self, Problem> {
        let subject = subject(program, cell);
        let before =
            path.map_or(Ok(Memory::default()), |path| remembered_of(path, program, &subject))?;
        Ok(Self { path: path.map(Path::to_owned), subject, before })
    }

    /// What was learned before the run.
    pub(crate) fn memory(&self) -> Memory {
        self.before.clone()
    }

    /// Keep what the run has learned beside what others have meanwhile.
    ///
    /// # Errors
    /// The file cannot be written, or is none any more; what was there is there still.
    pub(crate) fn keep(&self, memory: &Memory) -> Result<(), Problem> {
        let Some(path) = &self.path else { return Ok(()) };
        let _lock = write::lock(path)?;
        let mut all = remembered(path, &self.subject)?;
        all.merge(&memory.since(&self.before));
        write::file(path, all.to_text(&self.subject).as_bytes())
    }
}

/// Of what a memory is: by the names of files, without their folders; of a module, by that of its
/// source.
pub(crate) fn subject(program: &Program, cell: &str) -> Subject {
    let name = |path: &Path| match path.file_name() {
        Some(name) => name.to_string_lossy().into_owned(),
        None => path.display().to_string(),
    };
    let source = program.verified.module().sources.first();
    let program = source.map_or(program.path.as_path(), |source| Path::new(&source.name));
    Subject { program: name(program), cell: name(Path::new(cell)) }
}

/// The memory of a file; what it knows and the program has not is warned of.
///
/// # Errors
/// The file cannot be read, or is no memory of this.
pub(crate) fn remembered_of(
    path: &Path,
    program: &Program,
    of: &Subject,
) -> Result<Memory, Problem> {
    let memory = remembered(path, of)?;
    let lacking = lacking(&memory, program.verified.module());
    for text in lacking.iter().take(LACKING_SHOWN) {
        show::note(&format!("warning: {}: {text}", path.display()));
    }
    if let more @ 1.. = lacking.len().saturating_sub(LACKING_SHOWN) {
        show::note(&format!("warning: {}: and {more} more of that kind", path.display()));
    }
    Ok(memory)
}

/// What a memory knows something of and a program has not, in words.
fn lacking(memory: &Memory, module: &Module) -> Vec<String> {
    let lacks = |(error, place): (&str, &str)| {
        if !module.errors.iter().any(|declared| declared.name == error) {
            return Some(format!(
                "the program has no error `{error}`, of which this remembers something; if it is \
                 the memory of another program, name another file"
            ));
        }
        (!obverse_recovery::has_place(module, place)).then(|| {
            format!(
                "the program has no place `{place}`, where this remembers error `{error}`; take \
                 the [[place]] out if it is gone for good"
            )
        })
    };
    memory.places().filter_map(lacks).collect()
}

/// The memory of a file; an empty one where there is no file yet.
///
/// # Errors
/// The file cannot be read, or is no memory of this.
pub(crate) fn remembered(path: &Path, of: &Subject) -> Result<Memory, Problem> {
    if !path.exists() {
        return Ok(Memory::default());
    }
    let bytes = files::read(path).map_err(|why| Problem::of_file(path, why))?;
    let wrong = |text: String, code: MemoryCode| {
        Problem::several(vec![Message::of_file(path, text).coded(code.as_str())])
    };
    let text = String::from_utf8(bytes)
        .map_err(|error| wrong(format!("not text: {error}"), MemoryCode::Malformed))?;
    Memory::from_text(&text, of).map_err(|error| wrong(error.to_string(), error.code()))
}

/// The person at the terminal, if there is one, or so many releases given beforehand.
pub(crate) struct Terminal {
    releases_left: u32,
    asks: bool,
}

impl Terminal {
    pub(crate) fn new(releases: u32, is_json: bool) -> Self {
        let asks = !is_json && io::stdin().is_terminal() && io::stdout().is_terminal();
        Self { releases_left: releases, asks }
    }
}

impl Operator for Terminal {
    fn release(&mut self, fault: &Fault) -> bool {
        if self.releases_left > 0 {
            self.releases_left -= 1;
            return true;
        }
        if !self.asks {
            return false;
        }
        write::line(&format!("the arm is held: {fault}"));
        write::out("release it? Write `release` to let it move again: ");
        let _ = io::stdout().flush();
        let mut answer = String::new();
        let is_read = io::stdin().lock().read_line(&mut answer).is_ok();
        is_read && answer.trim() == "release"
    }
}

impl Teller for Story<'_> {
    fn on_step(&mut self, step: &Step<'_>, cell: &dyn Workcell) {
        self.tell_headings();
        let text = obverse_recovery::words(self.module(), step);
        write::line(&format!("{:>7.2} s ! {text}", cell.now_s()));
    }
}

impl Teller for Report<'_> {
    fn on_step(&mut self, step: &Step<'_>, cell: &dyn Workcell) {
        let mut object = json!({
            "type": "recovery",
            "step": code(step),
            "text": obverse_recovery::words(self.module(), step),
            "time_s": cell.now_s(),
        });
        for (key, value) in details(self.module(), step) {
            object[key] = value;
        }
        write::line(&object.to_string());
    }
}

fn code(step: &Step<'_>) -> &'static str {
    match step {
        Step::Fault { .. } => "fault",
        Step::PassedOver { .. } => "passed_over",
        Step::Released => "released",
        Step::Back { .. } => "back",
        Step::RoundTrip { .. } => "round_trip",
        Step::InPlace { .. } => "in_place",
        Step::Blocked { .. } => "blocked",
        Step::Again { .. } => "again",
        Step::Recovered { .. } => "recovered",
        Step::GivenUp { .. } => "given_up",
        Step::Operator { .. } => "operator",
    }
}

fn details(module: &Module, step: &Step<'_>) -> Vec<(&'static str, Value)> {
    let mut details = match step {
        Step::Fault { fault, pc, error } => vec![
            ("fault", json!(fault.kind().code())),
            ("error", json!(module.errors[error.index()].name)),
            ("at", report::place(module, Some(*pc))),
        ],
        Step::Back { actions, to, .. } => {
            vec![("actions", json!(actions)), ("to", report::place(module, Some(*to)))]
        }
        Step::RoundTrip { pc, .. } => vec![("at", report::place(module, Some(*pc)))],
        Step::InPlace { backed_up_m, .. } => vec![("backed_up_m", json!(backed_up_m))],
        Step::Blocked { fault, pc, .. } | Step::PassedOver { fault, pc } => {
            vec![("fault", json!(fault.kind().code())), ("at", report::place(module, Some(*pc)))]
        }
        Step::GivenUp { why, .. } => vec![("why", json!(why.code()))],
        Step::Again { change: Some(change), .. } => {
            vec![("change", json!(obverse_recovery::changed(*change)))]
        }
        Step::Again { .. } | Step::Released | Step::Recovered { .. } | Step::Operator { .. } => {
            Vec::new()
        }
    };
    let incident = match step {
        Step::Back { incident, .. }
        | Step::RoundTrip { incident, .. }
        | Step::InPlace { incident, .. }
        | Step::Blocked { incident, .. }
        | Step::Again { incident, .. }
        | Step::Recovered { incident }
        | Step::GivenUp { incident, .. }
        | Step::Operator { incident } => incident,
        Step::Fault { .. } | Step::PassedOver { .. } | Step::Released => return details,
    };
    details.push(("error", json!(obverse_recovery::name(module, incident))));
    details.push(("place", json!(incident.place)));
    details.push(("attempts", json!(incident.attempts.len())));
    details.push(("due", report::place(module, Some(incident.pc))));
    details
}

/// The incidents of a run for machines.
pub(crate) fn incidents(module: &Module, incidents: &[Incident]) -> Value {
    let incident = |incident: &Incident| {
        let outcome = match incident.outcome {
            Some((Outcome::Recovered, _)) => "recovered",
            Some((Outcome::GivenUp(why), _)) => why.code(),
            Some((Outcome::Lost, _)) => "lost",
            None => "open",
        };
        json!({
            "error": obverse_recovery::name(module, incident),
            "place": incident.place,
            "outcome": outcome,
            "depths": incident.depths(),
            "began_s": incident.began_s,
            "duration_s": incident.duration_s(),
        })
    };
    incidents.iter().map(incident).collect()
}
