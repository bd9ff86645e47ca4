//! `obverse learn`: try the parameters of an action in simulation until it is known which succeed.

use super::Result;
use super::trials::progress::Progress;
use crate::load::{self, Program};
use crate::parameters::said;
use crate::problem::Problem;
use crate::{Outcome, lacking, parameters, report, write};
use obverse_compiler::{Action, Defaults, Parameter};
use obverse_learn::search::Confirmed;
use obverse_learn::{Axis, Budget, Evidence, Learned, ParameterFile, Standing, Value, space};
use obverse_recovery::Memory;
use obverse_sim::Cell;
use obverse_trials::machine::Terms;
use obverse_trials::outcome::Ending;
use obverse_trials::table::grouped;
use obverse_trials::{Case, MachineCase, Stand, Strategy};
use serde_json::{Map, json};
use std::collections::BTreeMap;
use std::num::NonZero;
use std::path::{Path, PathBuf};

/// How many candidates the table shows.
const SHOWN: usize = 6;
/// The most runs that can be asked for.
const MAX_RUNS: u64 = 10_000_000;
/// The most candidates that can be asked for: each is a program of its own.
const MAX_CANDIDATES: usize = 1024;

#[derive(clap::Args)]
#[command(after_help = "\
A run succeeds when the program ends with no error pending, and no error is answered: the strategy
is `stop`. Parameters are learned that have a range and that some call leaves to their default.")]
pub(crate) struct Arguments {
    /// The program: source text.
    program: PathBuf,
    /// The action whose parameters are learned.
    action: String,
    /// How many runs are made in all; a quarter of them confirms the choice.
    #[arg(long, default_value_t = 4000, value_name = "N")]
    runs: u64,
    /// How many values of the parameters are tried.
    #[arg(long, default_value_t = 64, value_name = "N")]
    candidates: usize,
    /// What the seeds of the runs follow from.
    #[arg(long, default_value_t = 0, value_name = "N")]
    seed: u64,
    /// The workcell file, in place of the one that the program names.
    #[arg(long, value_name = "FILE")]
    cell: Option<PathBuf>,
    /// On how many threads; as many as there are cores, if it is not said. It changes no result.
    #[arg(long, value_name = "J")]
    jobs: Option<NonZero<usize>>,
    /// Give a run up after about so many instructions.
    #[arg(long, default_value_t = 1_000_000, value_name = "N")]
    limit: u64,
    /// Where the parameters are kept; ACTION.toml, if it is not said.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// For machines: JSON Lines, a line for each candidate, and a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    check(arguments)?;
    let (program, actions) = load::source(&arguments.program, &Defaults::new())?;
    let digest = parameters::digest(&arguments.program, program.verified.module())?;
    let action = action_of(&actions, &arguments.action)?;
    let axes = axes(action)?;
    let (cell, file) = load::cell(&program, arguments.cell.as_deref())?;
    let values = space::candidates(&axes, arguments.candidates);
    let least = obverse_learn::least_runs(values.len());
    if arguments.runs < least {
        return Err(Problem::new(format!(
            "--runs is {}, which is too few to try {} candidates and to confirm the choice: at \
             least {least}, or fewer --candidates",
            arguments.runs,
            values.len()
        )));
    }
    let programs = values
        .iter()
        .map(|values| candidate(arguments, &axes, values))
        .collect::<std::result::Result<Vec<_>, Problem>>()?;
    let cases = programs
        .iter()
        .map(|program| case(arguments, program, &cell, &file))
        .collect::<std::result::Result<Vec<_>, Problem>>()?;
    let learned = search(arguments, &axes, &values, &cases);
    let found = Found { axes, values, learned };
    let kept = found.file(arguments, digest);
    let out = out(arguments);
    let has_learned = found.learned.confirmed.successes > 0;
    if has_learned {
        write::file(&out, kept.to_text().as_bytes())?;
    }
    match arguments.json {
        true => found.report(&kept, has_learned.then_some(&out)),
        false => {
            let told = match has_learned {
                true => format!("{}: written\n", out.display()),
                false => nothing(arguments, &out),
            };
            write::out(&(found.story(&kept) + &told));
        }
    }
    Ok(if has_learned { Outcome::Done } else { Outcome::EndedOtherwise })
}

/// What is said where no run of the best succeeded.
fn nothing(arguments: &Arguments, out: &Path) -> String {
    format!(
        "{}: not written: none of these runs succeeded, and so nothing is known of which values \
         are good; `obverse run {} --seed 1 --strategy stop` shows what goes wrong\n",
        out.display(),
        arguments.program.display()
    )
}

/// What can be told to be wrong before anything is read.
fn check(arguments: &Arguments) -> std::result::Result<(), Problem> {
    let rows = [
        ("--runs", arguments.runs, 2, MAX_RUNS),
        ("--candidates", arguments.candidates as u64, 1, MAX_CANDIDATES as u64),
    ];
    for (name, value, least, most) in rows {
        if !(least..=most).contains(&value) {
            let why = format!("{name} is {value}, and must be from {least} to {most}");
            return Err(Problem::new(why));
        }
    }
    load::require_source(&arguments.program, "learned for")?;
    let inputs: Vec<PathBuf> =
        std::iter::once(arguments.program.clone()).chain(arguments.cell.clone()).collect();
    let out = out(arguments);
    write::check_text(&out, "parameter file", &inputs)?;
    let (program, action) = (name_of(arguments), &arguments.action);
    let what = format!("a parameter file of `{action}` in `{program}`");
    write::check_own(&out, &what, |text| ParameterFile::is_of(text, &program, action))
}

fn name_of(arguments: &Arguments) -> String {
    arguments.program.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn out(arguments: &Arguments) -> PathBuf {
    arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.toml", arguments.action)))
}

fn action_of<'a>(actions: &'a [Action], name: &str) -> std::result::Result<&'a Action, Problem> {
    actions.iter().find(|action| action.name == name).ok_or_else(|| {
        let names: Vec<&str> = actions.iter().map(|action| action.name.as_str()).collect();
        let has = match (obverse_syntax::nearest(name, names.iter().copied()), names.is_empty()) {
            (Some(meant), _) => format!("did you mean `{meant}`?"),
            (None, true) => "it declares none".to_owned(),
            (None, false) => format!("it has {}", names.join(", ")),
        };
        Problem::new(format!("the program has no action `{name}`; {has}"))
    })
}

/// The parameters that can be learned.
fn axes(action: &Action) -> std::result::Result<Vec<Axis>, Problem> {
    let axis = |parameter: &Parameter| {
        let ([low, high], default) = parameter.range.zip(parameter.default)?;
        let Parameter { name, unit, is_integer, .. } = parameter;
        let (name, unit, is_integer) = (name.clone(), (*unit).to_owned(), *is_integer);
        parameter.is_left_to_default.then_some(Axis { name, unit, low, high, is_integer, default })
    };
    let axes: Vec<Axis> = action.parameters.iter().filter_map(axis).collect();
    let name = &action.name;
    match axes.len() {
        0 => Err(Problem::new(format!(
            "nothing can be learned of `{name}`: no parameter has a range and a default and is \
             left out by a call"
        ))),
        many if many > space::MAX_AXES => Err(Problem::new(format!(
            "`{name}` leaves {many} parameters open, and at most {} are learned at a time; give \
             some of them in the call",
            space::MAX_AXES
        ))),
        _ => Ok(axes),
    }
}

/// The program with the values of a candidate.
fn candidate(
    arguments: &Arguments,
    axes: &[Axis],
    values: &[f64],
) -> std::result::Result<Program, Problem> {
    let key = |axis: &Axis| (arguments.action.clone(), axis.name.clone());
    let defaults = axes.iter().map(key).zip(values.iter().copied()).collect();
    load::source(&arguments.program, &defaults).map(|(program, _)| program)
}

fn case<'p>(
    arguments: &Arguments,
    program: &'p Program,
    cell: &'p Cell,
    file: &load::Workcell,
) -> std::result::Result<MachineCase<'p>, Problem> {
    let terms = Terms { person_s: 0.0, releases: 0, instructions: arguments.limit };
    MachineCase::new(&program.verified, cell, terms)
        .map_err(|errors| Problem::several(lacking::messages(program, file, &errors)))
}

fn search(
    arguments: &Arguments,
    axes: &[Axis],
    values: &[Vec<f64>],
    cases: &[MachineCase<'_>],
) -> Learned {
    let share = |values: &Vec<f64>| {
        axes.iter().zip(values).map(|(axis, value)| axis.share(*value)).collect()
    };
    let points: Vec<Vec<f64>> = values.iter().map(share).collect();
    let cores = || std::thread::available_parallelism().map_or(1, NonZero::get);
    let jobs = arguments.jobs.map_or_else(cores, NonZero::get).min(MAX_CANDIDATES);
    let memory = Memory::default();
    let attempt = |index: usize, seed: u64| {
        let outcome = cases[index].stand(&memory).assemble(seed, Strategy::Stop);
        outcome.ending == Ending::Succeeded
    };
    let budget = Budget { runs: arguments.runs, seed: arguments.seed, jobs };
    let mut progress = Progress::new("runs", 0, arguments.runs);
    obverse_learn::search(&points, budget, attempt, || progress.one_more())
}

/// What was tried, and what came of it.
struct Found {
    axes: Vec<Axis>,
    /// By candidate and parameter.
    values: Vec<Vec<f64>>,
    learned: Learned,
}

impl Found {
    fn search_runs(&self) -> u64 {
        self.learned.standings.iter().map(|standing| standing.runs).sum()
    }

    fn file(&self, arguments: &Arguments, digest: String) -> ParameterFile {
        let Learned { best, confirmed, defaults, .. } = &self.learned;
        let value = |(axis, value): (&Axis, &f64)| {
            (axis.name.clone(), Value { value: *value, unit: axis.unit.clone() })
        };
        let parameters: BTreeMap<String, Value> =
            self.axes.iter().zip(&self.values[*best]).map(value).collect();
        let interval = confirmed.interval();
        let evidence = Evidence {
            runs: confirmed.runs,
            successes: confirmed.successes,
            low: interval.map_or(0.0, |interval| interval.low),
            high: interval.map_or(1.0, |interval| interval.high),
            successes_of_defaults: defaults.successes,
            candidates: self.values.len() as u64,
            search_runs: self.search_runs(),
            seed: arguments.seed,
            version: env!("CARGO_PKG_VERSION").to_owned(),
        };
        let (program, action) = (name_of(arguments), &arguments.action);
        ParameterFile::new((&program, digest), action, parameters, evidence)
    }

    /// The candidates, the best first; then those that stood longest.
    fn order(&self) -> Vec<usize> {
        let standings = &self.learned.standings;
        let chance = |index: usize| standings[index].estimate.map_or(0.0, |found| found.chance);
        let is_best = |index: usize| index == self.learned.best;
        let is_left = |index: usize| standings[index].left_out.is_none();
        let mut order: Vec<usize> = (0..standings.len()).collect();
        order.sort_by(|&a, &b| {
            let word = |index| (is_best(index), is_left(index));
            word(b).cmp(&word(a)).then(chance(b).total_cmp(&chance(a)))
        });
        order
    }

    fn story(&self, kept: &ParameterFile) -> String {
        let Learned { standings, rounds, confirmed, defaults, best } = &self.learned;
        let left = standings.iter().filter(|standing| standing.left_out.is_none()).count();
        let mut text = format!(
            "{}: {}, {} candidates, seed {}; {} runs in {rounds} rounds left {left}\n\n",
            kept.program,
            kept.action,
            self.values.len(),
            kept.evidence.seed,
            grouped(self.search_runs()),
        );
        let heads = self.axes.iter().map(|axis| axis.name.clone());
        // Of the best of many, and smoothed: bounds to choose by, and no interval of confidence.
        let heads = heads.chain(["runs", "held for", "bounds", ""].map(str::to_owned));
        let mut rows: Vec<Vec<String>> = vec![heads.collect()];
        let order = self.order();
        let is_shown = |(place, index): &(usize, &usize)| *place < SHOWN || **index == 0;
        for (_, &index) in order.iter().enumerate().filter(is_shown) {
            rows.push(self.row(index, &standings[index]));
        }
        text.push_str(&drawn(&rows));
        let line = |what: &str, confirmed: &Confirmed| {
            let share = 100.0 * confirmed.successes as f64 / confirmed.runs.max(1) as f64;
            let interval = confirmed.interval().map_or_else(String::new, |interval| {
                format!(
                    ", {:.1} to {:.1} % (95 % interval)",
                    100.0 * interval.low,
                    100.0 * interval.high
                )
            });
            let (won, runs) = (grouped(confirmed.successes), grouped(confirmed.runs));
            format!("{what}: {won} of {runs} runs succeed, {share:.1} %{interval}\n")
        };
        text.push_str("\nOn seeds that nothing was chosen by:\n");
        text.push_str(&line("  best", confirmed));
        if *best != 0 {
            text.push_str(&line("  defaults", defaults));
        }
        text
    }

    fn row(&self, index: usize, standing: &Standing) -> Vec<String> {
        let values = self.axes.iter().zip(&self.values[index]);
        let mut row: Vec<String> = values.map(|(axis, value)| said(*value, &axis.unit)).collect();
        row.push(grouped(standing.runs));
        let (chance, interval) = match standing.estimate {
            Some(found) => (
                format!("{:.1} %", 100.0 * found.chance),
                format!(
                    "{:.1} to {:.1} %",
                    100.0 * found.interval.low,
                    100.0 * found.interval.high
                ),
            ),
            None => ("-".to_owned(), "-".to_owned()),
        };
        row.extend([chance, interval]);
        let is_best = index == self.learned.best;
        row.push(match (is_best, index, standing.left_out) {
            (true, 0, _) => "best: the defaults".to_owned(),
            (true, ..) => "best".to_owned(),
            (_, 0, None) => "the defaults".to_owned(),
            (_, 0, Some(round)) => format!("the defaults, left out after round {round}"),
            (.., Some(round)) => format!("left out after round {round}"),
            (.., None) => String::new(),
        });
        row
    }

    /// The same for machines, with the file that was written, if one was.
    fn report(&self, kept: &ParameterFile, out: Option<&PathBuf>) {
        for (index, standing) in self.learned.standings.iter().enumerate() {
            let values: Map<String, serde_json::Value> = self
                .axes
                .iter()
                .zip(&self.values[index])
                .map(|(axis, value)| {
                    (axis.name.clone(), json!({ "value": value, "unit": axis.unit }))
                })
                .collect();
            let estimate = standing.estimate;
            let object = json!({
                "type": "candidate",
                "index": index,
                "parameters": values,
                "runs": standing.runs,
                "successes": standing.successes,
                "chance": estimate.map(|found| found.chance),
                "low": estimate.map(|found| found.interval.low),
                "high": estimate.map(|found| found.interval.high),
                "left_out_after_round": standing.left_out,
            });
            write::line(&object.to_string());
        }
        let fields = [
            ("program", json!(kept.program)),
            ("action", json!(kept.action)),
            ("best", json!(self.learned.best)),
            ("rounds", json!(self.learned.rounds)),
            ("parameters", json!(kept.parameters)),
            ("evidence", json!(kept.evidence)),
            ("out", json!(out.map(|out| out.display().to_string()))),
        ];
        let more = fields.map(|(name, value)| (name.to_owned(), value)).into_iter().collect();
        report::summary(if out.is_some() { "done" } else { "nothing learned" }, more, Map::new());
    }
}

/// A table whose columns are right-aligned, but for the last.
fn drawn(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width =
        |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            if column + 1 == columns { cell.clone() } else { format!("{cell:>width$}") }
        });
        format!("{}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}
