//! Wrong programs as people write them, in `tests/corpus`, and what is said of them: exactly the
//! diagnostics that each file says, on exactly the lines that it says.
//!
//! `//~ E0201 E0101` at the end of a line names the diagnostics that begin on it, each as often as
//! it comes; `//~^ E0201` those of the line above, `//~^^` of the one above that. To add a program,
//! add a file. What is meant is never written by a switch: goldens are for how it looks.
//!
//! A change that a diagnostic suggests is made: what it was suggested for is then gone.

use libtest_mimic::{Arguments, Failed, Trial};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::source::LineIndex;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/corpus");

/// How many programs there are at the least, and how many of them mix mistakes in twenty lines and
/// more.
const LEAST: usize = 150;
const LEAST_MIXED: usize = 75;

/// Codes that no source text of a sensible size causes.
const NOT_SHOWN: [Code; 1] = [Code::SourceTooLarge];

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
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.sort();
    files
}

/// Lines and codes, in order.
type Placed = Vec<(usize, String)>;

/// What a file says of itself.
fn said(bytes: &[u8]) -> Placed {
    let text = String::from_utf8_lossy(bytes);
    let index = LineIndex::new(&text);
    let mut said = Placed::new();
    for number in 1..=index.line_count() {
        let line = index.line_text(number as u32);
        let Some((_, codes)) = line.split_once("//~") else { continue };
        let above = codes.len() - codes.trim_start_matches('^').len();
        let codes = codes[above..].split_whitespace();
        said.extend(codes.map(|code| (number - above, code.to_owned())));
    }
    said.sort();
    said
}

fn diagnostics(bytes: &[u8]) -> (String, Vec<Diagnostic>) {
    match obverse_syntax::text_of(bytes) {
        Ok(text) => {
            let compiled = obverse_compiler::compile("program.obv", text);
            let is_wrong =
                compiled.diagnostics.iter().any(|one| one.code.as_str().starts_with('E'));
            assert_eq!(compiled.module.is_none(), is_wrong, "an error, or a module");
            (text.to_owned(), compiled.diagnostics)
        }
        Err(diagnostic) => (String::new(), vec![*diagnostic]),
    }
}

fn check(file: &Path) -> Result<(), Failed> {
    let bytes = std::fs::read(file)?;
    let said = said(&bytes);
    let (text, found) = diagnostics(&bytes);
    let index = LineIndex::new(&text);
    let line = |one: &Diagnostic| index.position(one.primary.span.start).line as usize;
    let mut placed: Placed = found.iter().map(|one| (line(one), one.code.to_string())).collect();
    placed.sort();
    if said.is_empty() || placed != said {
        let told: Vec<String> =
            found.iter().map(|one| format!("{} {} {}", line(one), one.code, one.message)).collect();
        return Err(format!("it says\n  {said:?}\nand there are\n  {}", told.join("\n  ")).into());
    }
    found.iter().try_for_each(|one| check_suggestion(&text, one))
}

/// Make the change that a diagnostic suggests: it is then gone.
fn check_suggestion(text: &str, diagnostic: &Diagnostic) -> Result<(), Failed> {
    let Some(suggestion) = &diagnostic.suggestion else { return Ok(()) };
    let range = suggestion.span.start as usize..suggestion.span.end as usize;
    if text.get(range.clone()).is_none() {
        return Err(format!("the suggestion of {} is not in the text", diagnostic.code).into());
    }
    let mut mended = text.to_owned();
    mended.replace_range(range, &suggestion.text);
    let (_, left) = diagnostics(mended.as_bytes());
    let is_same = |one: &&Diagnostic| {
        one.code == diagnostic.code
            && one.primary.span.start == diagnostic.primary.span.start
            && one.message == diagnostic.message
    };
    match left.iter().find(is_same) {
        Some(same) => Err(format!("`{}` does not mend: {}", suggestion.text, same.message).into()),
        None => Ok(()),
    }
}

fn every_code_occurs() -> Result<(), Failed> {
    let mut shown = BTreeSet::new();
    for file in files() {
        shown.extend(said(&std::fs::read(file)?).into_iter().map(|(_, code)| code));
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
        mixed += usize::from(lines >= 20 && said(&bytes).len() > 1);
    }
    match all >= LEAST && mixed >= LEAST_MIXED {
        true => Ok(()),
        false => Err(format!("{all} of {LEAST}, {mixed} of {LEAST_MIXED} mixed").into()),
    }
}
