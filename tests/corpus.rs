//! Wrong programs as people write them, in `tests/corpus`, and what is said of them: exactly the
//! diagnostics that each file says, on exactly the lines that it says.
//!
//! `//~ E0201 E0101` at the end of a line names the diagnostics that begin on it, each as often as
//! it comes; `//~^ E0201` those of the line above, `//~^^` of the one above that. To add a program,
//! add a file; what it imports stands in a folder of its name. What is meant is never written by a
//! switch: goldens are for how it looks.
//!
//! A change that a diagnostic suggests is made: what it was suggested for is then gone.

use libtest_mimic::{Arguments, Failed, Trial};
use obverse_compiler::Compiled;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::source::LineIndex;
use obverse_syntax::sources::Place;
use obverse_testkit::files::Folder;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/corpus");

/// How many programs there are at the least, and how many of them mix mistakes in twenty lines and
/// more.
const LEAST: usize = 150;
const LEAST_MIXED: usize = 75;

/// Codes that no program of a sensible size causes, and the one of a program without mistakes: it
/// is inversion that fails.
const NOT_SHOWN: [Code; 3] = [Code::SourceTooLarge, Code::TooManyImports, Code::NotInvertible];

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let mut trials: Vec<Trial> = files()
        .into_iter()
        .map(|file| {
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            Trial::test(name, move || check(&file))
        })
        .collect();
    trials.push(Trial::test("every code occurs", every_code_occurs));
    trials.push(Trial::test("there are enough", there_are_enough));
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn files() -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(Path::new(FOLDER)) else { return Vec::new() };
    let files = entries.flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.is_file()).collect();
    files.sort();
    files
}

/// Files, lines and codes, in order.
type Placed = Vec<(String, usize, String)>;

/// What a file says of itself.
fn said_in(name: &str, text: &str) -> Placed {
    let index = LineIndex::new(text);
    let mut said = Placed::new();
    for number in 1..=index.line_count() {
        let line = index.line_text(number as u32);
        let Some((_, codes)) = line.split_once("//~") else { continue };
        let above = codes.len() - codes.trim_start_matches('^').len();
        let codes = codes[above..].split_whitespace();
        said.extend(codes.map(|code| (name.to_owned(), number - above, code.to_owned())));
    }
    said
}

/// What a program says of itself, with what its folder has for it to import.
fn said(file: &Path) -> std::io::Result<Placed> {
    let name = name_of(file);
    let mut said = said_in(&name, &String::from_utf8_lossy(&std::fs::read(file)?));
    let folder = format!("{}/", name.trim_end_matches(".obv"));
    for (path, text) in &Folder::read(Path::new(FOLDER)).0 {
        if path.starts_with(&folder) {
            said.extend(said_in(path, text));
        }
    }
    said.sort();
    Ok(said)
}

fn name_of(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What is said of a program whose files are these.
fn compile(folder: &mut Folder, name: &str) -> Compiled {
    let compiled = folder.compile(name);
    let is_wrong = compiled.diagnostics.iter().any(|one| one.code.as_str().starts_with('E'));
    assert_eq!(compiled.module.is_none(), is_wrong, "an error, or a module");
    compiled
}

fn check(file: &Path) -> Result<(), Failed> {
    let (name, said) = (name_of(file), said(file)?);
    if let Err(diagnostic) = obverse_syntax::text_of(&std::fs::read(file)?) {
        return compare(&said, &[(name, 1, diagnostic.code.to_string(), diagnostic.message)]);
    }
    let mut folder = Folder::read(Path::new(FOLDER));
    let compiled = compile(&mut folder, &name);
    let found = compiled.diagnostics.iter().map(|one| {
        let (name, position) = compiled.sources.position(one.primary.span);
        (name.to_owned(), position.line as usize, one.code.to_string(), one.message.clone())
    });
    compare(&said, &found.collect::<Vec<_>>())?;
    let mut suggested = compiled.diagnostics.iter();
    suggested.try_for_each(|one| check_suggestion(&folder, &compiled, &name, one))
}

fn compare(said: &Placed, found: &[(String, usize, String, String)]) -> Result<(), Failed> {
    let place = |(file, line, code, _): &(String, usize, String, String)| {
        (file.clone(), *line, code.clone())
    };
    let mut placed: Placed = found.iter().map(place).collect();
    placed.sort();
    if !said.is_empty() && placed == *said {
        return Ok(());
    }
    let told =
        found.iter().map(|(file, line, code, message)| format!("{file}:{line} {code} {message}"));
    let told = told.collect::<Vec<_>>().join("\n  ");
    Err(format!("it says\n  {said:?}\nand there are\n  {told}").into())
}

/// Make the change that a diagnostic suggests: it is then gone.
fn check_suggestion(
    folder: &Folder,
    compiled: &Compiled,
    name: &str,
    diagnostic: &Diagnostic,
) -> Result<(), Failed> {
    let Some(suggestion) = &diagnostic.suggestion else { return Ok(()) };
    let Place { file, span } = compiled.sources.locate(suggestion.span);
    let range = span.start as usize..span.end as usize;
    let mut mended = compiled.sources.text(file).to_owned();
    if mended.get(range.clone()).is_none() {
        return Err(format!("the suggestion of {} is not in the text", diagnostic.code).into());
    }
    mended.replace_range(range, &suggestion.text);
    let mut folder = folder.clone();
    folder.0.insert(compiled.sources.name(file).to_owned(), mended);
    let left = compile(&mut folder, name);
    let is_same = |one: &&Diagnostic| {
        one.code == diagnostic.code
            && one.primary.span.start == diagnostic.primary.span.start
            && one.message == diagnostic.message
    };
    match left.diagnostics.iter().find(is_same) {
        Some(same) => Err(format!("`{}` does not mend: {}", suggestion.text, same.message).into()),
        None => Ok(()),
    }
}

fn every_code_occurs() -> Result<(), Failed> {
    let mut shown = BTreeSet::new();
    for file in files() {
        shown.extend(said(&file)?.into_iter().map(|(.., code)| code));
    }
    let is_missing = |code: &&Code| !NOT_SHOWN.contains(code) && !shown.contains(code.as_str());
    let missing: Vec<_> = Code::ALL.iter().filter(is_missing).collect();
    match missing.is_empty() {
        true => Ok(()),
        false => Err(format!("no program in tests/corpus has {missing:?}").into()),
    }
}

fn there_are_enough() -> Result<(), Failed> {
    let (mut all, mut mixed) = (0, 0);
    for file in files() {
        let bytes = std::fs::read(&file)?;
        let lines = bytes.iter().filter(|byte| **byte == b'\n').count();
        all += 1;
        mixed += usize::from(lines >= 20 && said(&file)?.len() > 1);
    }
    match all >= LEAST && mixed >= LEAST_MIXED {
        true => Ok(()),
        false => Err(format!("{all} of {LEAST}, {mixed} of {LEAST_MIXED} mixed").into()),
    }
}
