//! `obverse check`: say what is wrong with a program, and whether its workcell has what it needs.

use super::Result;
use crate::load::{self, Program};
use crate::problem::Problem;
use crate::{Outcome, show, write};
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
    /// For machines: JSON Lines, an object a diagnostic and a summary last.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    if arguments.json {
        return as_json(arguments);
    }
    let program = load::program(&arguments.file)?;
    let cell = in_its_cell(arguments, &program)?;
    let module = program.verified.module();
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
    let (cell, file) = load::workcell(program, arguments.cell.as_deref(), 0)?;
    load::machine(program, &cell, &file)?;
    Ok(file.name)
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
    summary["outcome"] = json!(if checked.is_ok() { "correct" } else { "wrong" });
    summary["errors"] = json!(errors);
    summary["warnings"] = json!(warnings);
    write::line(&summary.to_string());
    Ok(if checked.is_ok() { Outcome::Done } else { Outcome::Wrong })
}
