//! `obverse fmt`: bring source files into their canonical layout. One with a mistake is left alone,
//! be it of grammar or of meaning: what was meant by it is not known.

use super::Result;
use crate::files::ProgramFolder;
use crate::problem::{Diagnosed, Problem};
use crate::{Outcome, load, report, show, write};
use obverse_compiler::mistakes_in;
use obverse_syntax::format::format;
use obverse_syntax::sources::Sources;
use serde_json::json;
use std::io::Read;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The programs, which are written again where something changes; `-` is standard input, of
    /// which the result is printed.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Write nothing; name the files that would change, with exit code 1 if there are any.
    #[arg(long, conflicts_with = "stdout")]
    check: bool,
    /// Write nothing; print what the file would become. Of one file at a time.
    #[arg(long, conflicts_with = "json")]
    stdout: bool,
    /// For machines: an object a file and a summary last. Not with `-`, unless with `--check`.
    #[arg(long)]
    pub(crate) json: bool,
}

/// What became of a file.
struct Formatted {
    /// What was read.
    raw: Vec<u8>,
    /// What it is in its layout.
    text: String,
}

impl Formatted {
    fn is_changed(&self) -> bool {
        self.raw != self.text.as_bytes()
    }
}

/// How many files there were of each sort.
#[derive(Default)]
struct Counts {
    changed: usize,
    wrong: usize,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let is_printed = |path: &Path| arguments.stdout || is_standard_input(path) && !arguments.check;
    if arguments.files.len() > 1 && arguments.files.iter().any(|path| is_printed(path)) {
        let why = "only one text can be printed at a time; name one file";
        return Err(Problem::new(why));
    }
    if arguments.json && arguments.files.iter().any(|path| is_printed(path)) {
        return Err(Problem::new("`-` prints a text, and `--json` objects; give one of them"));
    }
    let mut counts = Counts::default();
    for path in &arguments.files {
        let formatted = formatted(path).and_then(|formatted| {
            if is_printed(path) {
                write::exactly(&formatted.text);
            } else if formatted.is_changed() && !arguments.check {
                rewrite(path, &formatted)?;
            }
            Ok(formatted.is_changed())
        });
        match &formatted {
            Ok(is_changed) => counts.changed += usize::from(*is_changed),
            Err(_) => counts.wrong += 1,
        }
        match arguments.json {
            true => tell_machines(arguments, path, &formatted),
            false => tell_people(arguments, path, &formatted),
        }
    }
    Ok(ended(arguments, &counts))
}

fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

fn formatted(path: &Path) -> std::result::Result<Formatted, Problem> {
    load::require_source(path, "formatted")?;
    let raw = match is_standard_input(path) {
        true => standard_input()?,
        false => load::bytes(path)?,
    };
    let folder = path.with_file_name("");
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let wrong = |text: &str, diagnostics| {
        let (folder, sources) = (folder.clone(), Sources::one(&name, text));
        Problem::in_source(Diagnosed { folder, sources, diagnostics })
    };
    let source =
        obverse_syntax::text_of(&raw).map_err(|diagnostic| wrong("", vec![*diagnostic]))?;
    let text = format(source).map_err(|diagnostics| wrong(source, diagnostics))?;
    let (sources, diagnostics) = mistakes_in(&name, source, &mut ProgramFolder::of(path));
    if !diagnostics.is_empty() {
        let folder = folder.clone();
        return Err(Problem::in_source(Diagnosed { folder, sources, diagnostics }));
    }
    Ok(Formatted { raw, text })
}

/// Writes a file again, unless somebody else has in the meantime.
fn rewrite(path: &Path, formatted: &Formatted) -> std::result::Result<(), Problem> {
    if load::bytes(path)? != formatted.raw {
        let why = "it has changed while it was being formatted, and is left alone; try again";
        return Err(Problem::of_file(path, why));
    }
    write::file(path, formatted.text.as_bytes())
}

fn standard_input() -> std::result::Result<Vec<u8>, Problem> {
    let mut raw = Vec::new();
    // One byte more than is read as source, so that too much is found out.
    let most = obverse_syntax::MAX_SOURCE_BYTES as u64 + 1;
    let read = std::io::stdin().lock().take(most).read_to_end(&mut raw);
    read.map_err(|error| {
        let why = crate::problem::plain(&error);
        Problem::new(format!("standard input cannot be read: {why}"))
    })?;
    Ok(raw)
}

fn tell_people(arguments: &Arguments, path: &Path, formatted: &std::result::Result<bool, Problem>) {
    match formatted {
        Err(problem) => show::problem(problem),
        Ok(true) if arguments.check => {
            write::line(&format!("{}: would be formatted otherwise", path.display()));
        }
        Ok(true) if !arguments.stdout && !is_standard_input(path) => {
            write::line(&format!("{}: formatted", path.display()));
        }
        Ok(_) => {}
    }
}

fn tell_machines(
    arguments: &Arguments,
    path: &Path,
    formatted: &std::result::Result<bool, Problem>,
) {
    let outcome = match formatted {
        Err(problem) => {
            show::problem_json(problem).iter().for_each(|one| write::line(&one.to_string()));
            "wrong"
        }
        Ok(true) if arguments.check => "differs",
        Ok(true) => "formatted",
        Ok(false) => "unchanged",
    };
    let file = path.display().to_string();
    write::line(&json!({ "type": "file", "file": file, "outcome": outcome }).to_string());
}

fn ended(arguments: &Arguments, counts: &Counts) -> Outcome {
    let (outcome, word) = match (counts.wrong, arguments.check && counts.changed > 0) {
        (0, false) => (Outcome::Done, "formatted"),
        (0, true) => (Outcome::EndedOtherwise, "differs"),
        _ => (Outcome::Wrong, "wrong"),
    };
    if arguments.json {
        let figures = [
            ("files".to_owned(), json!(arguments.files.len())),
            ("changed".to_owned(), json!(counts.changed)),
            ("wrong".to_owned(), json!(counts.wrong)),
        ];
        report::summary(word, figures.into_iter().collect(), serde_json::Map::new());
    }
    outcome
}
