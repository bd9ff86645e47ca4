//! `obverse check`: say what is wrong with a program, and whether its workcell has what it needs.

use super::Result;
use crate::load::{self, Program};
use crate::problem::Problem;
use crate::{Outcome, show, write};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{Diagnostic, Severity};
use serde_json::json;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    file: PathBuf,
    /// The workcell file, in place of the one that the program names.
    #[arg(long, value_name = "FILE")]
    cell: Option<PathBuf>,
    /// Warnings that are not let pass: `warnings` for all of them, or the code of one.
    #[arg(long, value_name = "WHAT", value_parser = denied)]
    deny: Vec<Denied>,
    /// For machines: JSON Lines, an object a diagnostic and a summary last.
    #[arg(long)]
    json: bool,
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
    let program = load::program(&arguments.file)?;
    let cell = in_its_cell(arguments, &program)?;
    let module = program.verified.module();
    let denied = arguments.denied(warnings_of(&program));
    if denied > 0 {
        let words = if denied == 1 { "warning that is" } else { "warnings that are" };
        write::line(&format!("{}: {denied} {words} not let pass", arguments.file.display()));
        return Ok(Outcome::EndedOtherwise);
    }
    let warnings = show::counted(warnings_of(&program));
    let warnings = if warnings.is_empty() { "no warnings" } else { &warnings };
    write::line(&format!(
        "{}: correct, {warnings}; {} functions, {} instructions; workcell: {cell}",
        arguments.file.display(),
        module.functions.len(),
        module.code.len(),
    ));
    Ok(Outcome::Done)
}

/// Whether the program can run in its workcell; what that is called.
fn in_its_cell(arguments: &Arguments, program: &Program) -> std::result::Result<String, Problem> {
    let (cell, name) = load::workcell(program, arguments.cell.as_deref(), 0)?;
    load::machine(program, &cell, &name)?;
    Ok(name)
}

fn warnings_of(program: &Program) -> &[Diagnostic] {
    program.source.as_ref().map_or(&[], |diagnosed| &diagnosed.diagnostics)
}

fn as_json(arguments: &Arguments) -> Result {
    let (mut errors, mut warnings, mut denied) = (0, 0, 0);
    let mut summary = json!({ "type": "summary", "file": arguments.file.display().to_string() });
    let checked = load::quietly(&arguments.file).and_then(|program| {
        if let Some(diagnosed) = &program.source {
            show::diagnostics_json(diagnosed).iter().for_each(|one| write::line(&one.to_string()));
        }
        let module = program.verified.module();
        summary["functions"] = json!(module.functions.len());
        summary["instructions"] = json!(module.code.len());
        warnings = warnings_of(&program).len();
        denied = arguments.denied(warnings_of(&program));
        in_its_cell(arguments, &program)
    });
    match &checked {
        Ok(cell) => summary["workcell"] = json!(cell),
        Err(problem) => {
            let all = show::problem_json(problem);
            all.iter().for_each(|one| write::line(&one.to_string()));
            if let Some(diagnosed) = &problem.source {
                errors += show::count(&diagnosed.diagnostics, Severity::Error);
                warnings += show::count(&diagnosed.diagnostics, Severity::Warning);
            }
            errors += problem.messages.len();
        }
    }
    let (outcome, words) = match &checked {
        Err(_) => (Outcome::Wrong, "wrong"),
        Ok(_) if denied > 0 => (Outcome::EndedOtherwise, "denied"),
        Ok(_) => (Outcome::Done, "correct"),
    };
    summary["outcome"] = json!(words);
    summary["errors"] = json!(errors);
    summary["warnings"] = json!(warnings);
    summary["denied"] = json!(denied);
    write::line(&summary.to_string());
    Ok(outcome)
}
