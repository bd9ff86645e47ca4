//! Parameter files that a command line names: read, and held against the actions of the program
//! before they take the place of defaults.

use crate::load;
use crate::problem::Problem;
use obverse_bytecode::Module;
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

/// What tells one program from another: all of it that runs, and nothing of its files and texts.
pub(crate) fn digest(path: &Path, module: &Module) -> Result<String, Problem> {
    let (sources, source_map, mentions) = Default::default();
    let bare = Module { sources, source_map, mentions, ..module.clone() };
    let bytes = obverse_bytecode::encode(&bare).map_err(|error| Problem::of_file(path, error))?;
    Ok(format!("{:016x}", obverse_bytecode::fingerprint(&bytes)))
}

/// The values of all files, for the program of a file with these actions, compiled with its own
/// defaults.
pub(crate) fn defaults(
    files: &[PathBuf],
    (program, module): (&Path, &Module),
    actions: &[Action],
) -> Result<Defaults, Problem> {
    let digest = digest(program, module)?;
    let program = program.file_name().unwrap_or_default().to_string_lossy();
    let mut defaults = Defaults::new();
    for path in files {
        let file = read(path)?;
        let wrong = |why: String| Err(Problem::of_file(path, why));
        if let Some(why) = foreign(&file, &program, &digest) {
            return wrong(why);
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

/// Why a file is not of this program.
fn foreign(file: &ParameterFile, program: &str, digest: &str) -> Option<String> {
    let learned = &file.program;
    match &file.program_digest {
        Some(known) if known == digest => None,
        None if learned == program => None,
        Some(_) if learned == program => Some(format!(
            "learned for another program of the name `{program}`, or for this before it was \
             changed: learn it again, or take out its `program_digest` to use the values all the \
             same"
        )),
        _ => Some(format!("learned for `{learned}`, and this is `{program}`")),
    }
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
