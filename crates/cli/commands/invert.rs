//! `obverse invert`: print the inverse of a sequence as a program of its own.

use super::Result;
use crate::files::ProgramFolder;
use crate::problem::{Diagnosed, Problem};
use crate::{Outcome, load, report, show, write};
use obverse_compiler::{Inverse, NoInverse};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::sources::Sources;
use serde_json::{Map, json};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program, as source text.
    file: PathBuf,
    /// The sequence or action.
    sequence: String,
    /// For machines: an object with the text, and a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let path = &arguments.file;
    load::require_source(path, "inverted")?;
    let raw = load::bytes(path)?;
    let folder = path.with_file_name("");
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let wrong = |sources, diagnostics| Diagnosed { folder: folder.clone(), sources, diagnostics };
    let text = obverse_syntax::text_of(&raw).map_err(|diagnostic| {
        Problem::in_source(wrong(Sources::one(&name, ""), vec![*diagnostic]))
    })?;
    let mut files = ProgramFolder::of(path);
    let (sources, inverse) =
        obverse_compiler::invert_files(&name, text, &arguments.sequence, &mut files);
    match inverse {
        Ok(inverse) => Ok(told(arguments, &name, &inverse)),
        Err(NoInverse::UnknownSequence(meant)) => {
            let hint = meant.map_or_else(String::new, |meant| format!("; did you mean `{meant}`?"));
            let why = format!("there is no sequence or action `{}`{hint}", arguments.sequence);
            Err(Problem::of_file(path, why))
        }
        Err(NoInverse::OtherKind(other)) => {
            let why = format!(
                "`{}` is {}, and sequences and actions are inverted; put `{}` into an action, and \
                 invert that",
                arguments.sequence, other.kind, other.statement
            );
            Err(Problem::of_file(path, why))
        }
        Err(NoInverse::Diagnosed(diagnostics)) if is_refusal(&diagnostics) => {
            Ok(refused(arguments, &wrong(sources, diagnostics)))
        }
        Err(NoInverse::Diagnosed(diagnostics)) => {
            Err(Problem::in_source(wrong(sources, diagnostics)))
        }
    }
}

/// Whether the program is correct, and what has no inverse was said.
fn is_refusal(diagnostics: &[Diagnostic]) -> bool {
    diagnostics.iter().all(|diagnostic| diagnostic.code == Code::NotInvertible)
}

fn told(arguments: &Arguments, file: &str, inverse: &Inverse) -> Outcome {
    let plain = |text: &str| text.chars().filter(|c| !c.is_control()).collect::<String>();
    let (sequence, file) = (&arguments.sequence, plain(file));
    let mut text = format!("// The inverse of `{sequence}` in {file}.\n");
    // Of another sequence than the whole, nobody can say what else is to be done first.
    if sequence == "main" && inverse.is_begun_with {
        text += &format!(
            "// It begins where that has ended: check and run it with `--after {file}`.\n"
        );
    }
    if !inverse.is_begun_with {
        text += "//\n// `main` is empty: who calls the inverse knows its arguments, and has the \
                 variables of the\n// program as the sequence leaves them.\n";
    }
    text += &format!("\n{}", inverse.text);
    if !arguments.json {
        write::exactly(&text);
        return Outcome::Done;
    }
    let object = json!({
        "type": "inverse",
        "sequence": sequence,
        "name": inverse.name,
        "is_begun_with": inverse.is_begun_with,
        "text": text,
    });
    write::line(&object.to_string());
    report::summary("inverted", Map::new(), Map::new());
    Outcome::Done
}

fn refused(arguments: &Arguments, diagnosed: &Diagnosed) -> Outcome {
    if !arguments.json {
        show::diagnostics(diagnosed);
        return Outcome::EndedOtherwise;
    }
    show::diagnostics_json(diagnosed).iter().for_each(|one| write::line(&one.to_string()));
    let errors = Map::from_iter([("errors".to_owned(), json!(diagnosed.diagnostics.len()))]);
    report::summary("no inverse", errors, Map::new());
    Outcome::EndedOtherwise
}
