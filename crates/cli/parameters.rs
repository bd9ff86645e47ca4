//! Parameter files that a command line names: read, and held against the actions of the program
//! before they take the place of defaults.

use crate::load;
use crate::problem::Problem;
use obverse_compiler::{Action, Defaults, Parameter};
use obverse_learn::{ParameterFile, Value};
use std::path::{Path, PathBuf};

/// What every command understands that runs a program.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct ParameterArguments {
    /// Values for the parameters of an action in place of their defaults, as `obverse learn` writes
    /// them; once for each action.
    #[arg(long, value_name = "FILE")]
    pub(crate) parameters: Vec<PathBuf>,
}

/// The values of all files, for a program of this file name with these actions.
pub(crate) fn defaults(
    files: &[PathBuf],
    program: &str,
    actions: &[Action],
) -> Result<Defaults, Problem> {
    let mut defaults = Defaults::new();
    for path in files {
        let file = read(path)?;
        let wrong = |why: String| Err(Problem::of_file(path, why));
        if file.program != program {
            let learned = &file.program;
            return wrong(format!("learned for `{learned}`, and this is `{program}`"));
        }
        let Some(action) = actions.iter().find(|action| action.name == file.action) else {
            return wrong(format!("`{program}` has no action `{}`", file.action));
        };
        if defaults.keys().any(|(known, _)| *known == file.action) {
            return wrong(format!("a second file for the action `{}`", file.action));
        }
        for (name, value) in &file.parameters {
            let known = action.parameters.iter().find(|known| known.name == *name);
            let Some(known) = known else {
                return wrong(format!("the action `{}` has no parameter `{name}`", file.action));
            };
            if let Some(why) = misfit(known, value) {
                return wrong(why);
            }
            defaults.insert((file.action.clone(), name.clone()), value.value);
        }
    }
    Ok(defaults)
}

fn read(path: &Path) -> Result<ParameterFile, Problem> {
    let text = String::from_utf8(load::bytes(path)?)
        .map_err(|error| Problem::of_file(path, format!("not text: {error}")))?;
    ParameterFile::from_text(&text).map_err(|error| Problem::of_file(path, error))
}

/// Why a value cannot be that of a parameter.
fn misfit(parameter: &Parameter, Value { value, unit }: &Value) -> Option<String> {
    let name = &parameter.name;
    if parameter.default.is_none() {
        return Some(format!("`{name}` has no default that a number could take the place of"));
    }
    if *unit != parameter.unit {
        let asked = if parameter.unit.is_empty() { "without a unit" } else { parameter.unit };
        return Some(format!("`{name}` is in `{unit}`, and the program needs it {asked}"));
    }
    if parameter.is_integer && value.fract() != 0.0 {
        return Some(format!("`{name}` is {value}, and must be a whole number"));
    }
    let [least, most] = parameter.range?;
    let is_within = (least..=most).contains(value);
    let range = format!("{} to {}", said(least, unit), said(most, unit));
    (!is_within).then(|| format!("`{name}` is {}, and its range is {range}", said(*value, unit)))
}

/// A value with its unit.
pub(crate) fn said(value: f64, unit: &str) -> String {
    if unit.is_empty() { value.to_string() } else { format!("{value} {unit}") }
}
