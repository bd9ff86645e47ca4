//! `obverse check`: say what is wrong with a program, whether its workcell has what it needs, and
//! what can be said of each move before anything moves.

use super::Result;
use crate::after::AfterArguments;
use crate::load::{self, Program};
use crate::parameters::ParameterArguments;
use crate::problem::Problem;
use crate::{Outcome, moves, show, write};
use obverse_preflight::Report;
use obverse_sim::Plan;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{Diagnostic, Severity};
use serde_json::json;
use std::path::PathBuf;

#[derive(clap::Args)]
#[command(after_help = GRADES)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    file: PathBuf,
    /// The workcell file, in place of the one that the program names.
    #[arg(long, value_name = "FILE")]
    cell: Option<PathBuf>,
    #[command(flatten)]
    after: AfterArguments,
    #[command(flatten)]
    parameters: ParameterArguments,
    /// Let a move that is not known before running fail the check, too.
    #[arg(long)]
    strict: bool,
    /// Warnings that are not let pass: `warnings` for all of them, or the code of one.
    #[arg(long, value_name = "WHAT", value_parser = denied)]
    deny: Vec<Denied>,
    /// For machines: JSON Lines, an object a diagnostic and one a move, a summary last.
    #[arg(long)]
    json: bool,
}

const GRADES: &str = "\
Each move is graded, forward and in reverse, with everything at the place that the workcell file
gives it, and the arm, the tool and the held item followed all along the path:
  reachable                                fine
  not known before running                 it depends on a reading, a draw, or a contact; exit code
                                           1 with `--strict` alone
  reachable only in another configuration  exit code 1, as for all that follow: a run would end
  out of limits                            there with a fault
  out of reach
  in collision
A guarded move is meant to touch: its contact is no collision. Where ways through the program are
left unlooked at, since there are too many, the exit code is 1 whatever was found. `obverse explain
P0501` explains the code of a reason.";

/// A program that can run in its workcell, and what was found of its moves.
struct Checked {
    program: Program,
    cell_name: String,
    report: Report,
    /// How many of the warnings are not let pass.
    denied: usize,
}

/// Warnings that are not let pass.
#[derive(Clone, Copy, Debug)]
enum Denied {
    /// All.
    All,
    /// Those of a code.
    Of(Code),
}

fn denied(word: &str) -> std::result::Result<Denied, String> {
    if word == "warnings" {
        return Ok(Denied::All);
    }
    let warnings = Code::ALL.iter().filter(|code| code.as_str().starts_with('W'));
    match word.parse::<Code>() {
        Ok(code) if code.as_str().starts_with('W') => Ok(Denied::Of(code)),
        Ok(_) => Err("this is an error, which is never let pass".to_owned()),
        Err(_) => {
            let words = warnings.map(|code| code.as_str()).chain(["warnings"]);
            Err(obverse_syntax::nearest(word, words).map_or_else(
                || "write `warnings`, or the code of one, such as W0001".to_owned(),
                |near| format!("did you mean `{near}`?"),
            ))
        }
    }
}

impl Arguments {
    /// How many of the warnings are not let pass.
    fn denied(&self, warnings: &[Diagnostic]) -> usize {
        let is_denied = |warning: &&Diagnostic| {
            self.deny.iter().any(|denied| match denied {
                Denied::All => true,
                Denied::Of(code) => *code == warning.code,
            })
        };
        warnings.iter().filter(is_denied).count()
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    if arguments.json {
        return as_json(arguments);
    }
    let program = load::program_with(&arguments.file, &arguments.parameters.parameters)?;
    let checked = in_its_cell(arguments, program)?;
    let module = checked.program.verified.module();
    let warnings = show::counted(warnings_of(&checked.program));
    let warnings = if warnings.is_empty() { "no warnings" } else { &warnings };
    write::line(&format!(
        "{}: correct, {warnings}; {} functions, {} instructions; workcell: {}",
        arguments.file.display(),
        module.functions.len(),
        module.code.len(),
        checked.cell_name,
    ));
    moves::tell(module, &checked.report, arguments.after.after.as_deref());
    if checked.denied > 0 {
        let words = if checked.denied == 1 { "warning that is" } else { "warnings that are" };
        let (file, count) = (arguments.file.display(), checked.denied);
        write::line(&format!("{file}: {count} {words} not let pass"));
    }
    Ok(outcome(arguments, &checked).1)
}

/// What it comes to, in a word for machines, and as an exit code.
fn outcome(arguments: &Arguments, checked: &Checked) -> (&'static str, Outcome) {
    if !checked.report.is_fine(arguments.strict) {
        ("moves_fail", Outcome::EndedOtherwise)
    } else if checked.denied > 0 {
        ("denied", Outcome::EndedOtherwise)
    } else {
        ("correct", Outcome::Done)
    }
}

/// Whether the program can run in its workcell, and what its moves come to there.
fn in_its_cell(arguments: &Arguments, program: Program) -> std::result::Result<Checked, Problem> {
    let (cell, file) = load::workcell(&program, arguments.cell.as_deref(), 0)?;
    // Says what is missing, with its place.
    load::machine(&program, &cell, &file)?;
    let plan = Plan::new(cell.cell()).led(|sim| arguments.after.lead(sim, &file).map(drop))?;
    let report = obverse_preflight::check(&program.verified, plan).map_err(|errors| {
        Problem::new(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    })?;
    let denied = arguments.denied(warnings_of(&program));
    Ok(Checked { program, cell_name: file.name, report, denied })
}

fn warnings_of(program: &Program) -> &[Diagnostic] {
    program.source.as_ref().map_or(&[], |diagnosed| &diagnosed.diagnostics)
}

fn as_json(arguments: &Arguments) -> Result {
    let (mut errors, mut warnings) = (0, 0);
    let mut summary = json!({ "type": "summary", "file": arguments.file.display().to_string() });
    let checked = load::quietly(&arguments.file).and_then(|program| {
        if let Some(diagnosed) = &program.source {
            show::diagnostics_json(diagnosed).iter().for_each(|one| write::line(&one.to_string()));
        }
        let module = program.verified.module();
        summary["functions"] = json!(module.functions.len());
        summary["instructions"] = json!(module.code.len());
        warnings = warnings_of(&program).len();
        in_its_cell(arguments, program)
    });
    let (words, outcome) = match &checked {
        Ok(checked) => {
            moves::tell_machines(checked.program.verified.module(), &checked.report);
            summary["workcell"] = json!(checked.cell_name);
            summary["moves"] = moves::counts_for_machines(&checked.report);
            summary["complete"] = json!(checked.report.is_complete);
            outcome(arguments, checked)
        }
        Err(problem) => {
            let all = show::problem_json(problem);
            all.iter().for_each(|one| write::line(&one.to_string()));
            if let Some(diagnosed) = &problem.source {
                errors += show::count(&diagnosed.diagnostics, Severity::Error);
                warnings += show::count(&diagnosed.diagnostics, Severity::Warning);
            }
            errors += problem.messages.len();
            ("wrong", Outcome::Wrong)
        }
    };
    summary["outcome"] = json!(words);
    summary["errors"] = json!(errors);
    summary["warnings"] = json!(warnings);
    summary["denied"] = json!(checked.as_ref().map_or(0, |checked| checked.denied));
    write::line(&summary.to_string());
    Ok(outcome)
}
