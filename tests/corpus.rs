//! Wrong programs as people write them, in `tests/corpus`, and what is said of them: exactly the
//! diagnostics that each file says, on exactly the lines that it says.
//!
//! `//~ E0201 E0101` at the end of a line names the diagnostics that begin on it, each as often as
//! it comes; `//~^ E0201` those of the line above, `//~^^` of the one above that. To add a program,
//! add a file; what it imports stands in a folder of its name. A file `inverse_…` says also what of
//! its `main` has no inverse. What is meant is never written by a switch: goldens are for how it
//! looks.
//!
//! A change that a diagnostic suggests is made: what it was suggested for is then gone, and as far
//! as its place there are fewer errors.

use libtest_mimic::{Arguments, Failed, Trial};
use obverse_compiler::{
    Compiled, MAX_IMPORT_DEPTH, MAX_IMPORTED, NoInverse, compile_files, invert_files,
};
use obverse_syntax::MAX_SOURCE_BYTES;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{Diagnostic, Severity, Suggestion};
use obverse_syntax::source::LineIndex;
use obverse_syntax::sources::{Place, Sources};
use obverse_testkit::files::Folder;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/corpus");

/// What the names of files begin with whose `main` is inverted as well.
const INVERTED: &str = "inverse_";

/// How many programs there are at the least, and how many of them mix mistakes in twenty lines and
/// more.
const LEAST: usize = 150;
const LEAST_MIXED: usize = 75;

/// Codes that no file shows, since it would be too large or one of too many. The programs that
/// have them are made by a test of their own, `too_large_to_be_kept`.
const NOT_KEPT: [Code; 2] = [Code::SourceTooLarge, Code::TooManyImports];

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let mut trials: Vec<Trial> = files()
        .into_iter()
        .map(|file| {
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            Trial::test(name, move || check(&file))
        })
        .collect();
    trials.push(Trial::test("too large to be kept", too_large_to_be_kept));
    trials.push(Trial::test("a word left out leaves no name unknown", no_name_is_lost));
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
    let mut found = found_in(&compiled.sources, &compiled.diagnostics);
    if name.starts_with(INVERTED) {
        found.extend(not_inverted(&mut folder, &name));
    }
    compare(&said, &found)?;
    let mut suggested = compiled.diagnostics.iter();
    suggested.try_for_each(|one| check_suggestion(&folder, &compiled, &name, one))
}

/// What is said of the inverse of a program's `main`.
fn not_inverted(folder: &mut Folder, name: &str) -> Vec<Found> {
    let text = folder.0.get(name).cloned().unwrap_or_default();
    match invert_files(name, &text, "main", folder) {
        (sources, Err(NoInverse::Diagnosed(diagnostics))) => found_in(&sources, &diagnostics),
        (_, Ok(_) | Err(NoInverse::UnknownSequence(_) | NoInverse::OtherKind(_))) => Vec::new(),
    }
}

/// File, line, code and message of a diagnostic.
type Found = (String, usize, String, String);

fn found_in(sources: &Sources, diagnostics: &[Diagnostic]) -> Vec<Found> {
    let found = diagnostics.iter().map(|one| {
        let (name, position) = sources.position(one.primary.span);
        (name.to_owned(), position.line as usize, one.code.to_string(), one.message.clone())
    });
    found.collect()
}

fn compare(said: &Placed, found: &[Found]) -> Result<(), Failed> {
    let place = |(file, line, code, _): &Found| (file.clone(), *line, code.clone());
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

/// Make the change that a diagnostic suggests: it is then gone, and as far as its place there are
/// fewer errors of its family. What follows, and what its names and types come to, is seen only
/// now.
fn check_suggestion(
    folder: &Folder,
    compiled: &Compiled,
    name: &str,
    diagnostic: &Diagnostic,
) -> Result<(), Failed> {
    diagnostic
        .suggestion
        .iter()
        .chain(&diagnostic.choices)
        .try_for_each(|change| check_change(folder, compiled, name, diagnostic, change))
}

fn check_change(
    folder: &Folder,
    compiled: &Compiled,
    name: &str,
    diagnostic: &Diagnostic,
    suggestion: &Suggestion,
) -> Result<(), Failed> {
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
    if let Some(same) = left.diagnostics.iter().find(is_same) {
        return Err(format!("`{}` does not mend: {}", suggestion.text, same.message).into());
    }
    if !diagnostic.choices.is_empty() {
        // What is chosen may be seen to be of no use where it stands.
        return Ok(());
    }
    // Measured from the end, which the change does not move.
    let from_end = |compiled: &Compiled| {
        let length = compiled.sources.whole().len();
        move |one: &Diagnostic| length - one.primary.span.start as usize
    };
    let rest = from_end(compiled)(diagnostic);
    let before = errors_to(rest, diagnostic, &compiled.diagnostics, from_end(compiled));
    let after = errors_to(rest, diagnostic, &left.diagnostics, from_end(&left));
    if diagnostic.severity == Severity::Error && after.len() >= before.len() {
        let why = format!("`{}` for {} leaves", suggestion.text, diagnostic.message);
        return Err(format!("{why}\n  {}", after.join("\n  ")).into());
    }
    Ok(())
}

/// The errors of the family of a diagnostic, such as `E00`, that begin so far from the end or
/// further. That a statement then stands outside of a sequence is another's fault.
fn errors_to<'d>(
    rest: usize,
    of: &Diagnostic,
    diagnostics: &'d [Diagnostic],
    from_end: impl Fn(&Diagnostic) -> usize,
) -> Vec<&'d str> {
    let family = |one: &Diagnostic| one.code.as_str()[..3].to_owned();
    let is_counted = |one: &&Diagnostic| {
        family(one) == family(of) && one.code != Code::StatementOutside && from_end(one) >= rest
    };
    diagnostics.iter().filter(is_counted).map(|one| one.message.as_str()).collect()
}

/// A text of more than there may be, files that import one another in too long a row, and too many
/// files.
fn too_large_to_be_kept() -> Result<(), Failed> {
    let source = " ".repeat(MAX_SOURCE_BYTES + 1);
    let codes = |diagnostics: &[Diagnostic]| -> Vec<Code> {
        diagnostics.iter().map(|one| one.code).collect()
    };
    let found = codes(&obverse_syntax::parse(&source).diagnostics);
    if found != [Code::SourceTooLarge] {
        return Err(format!("of a text that is too large: {found:?}").into());
    }
    let mut row = Folder::default();
    let last = MAX_IMPORT_DEPTH + 1;
    for index in 0..last {
        row.0.insert(format!("{index}.obv"), format!("import \"{}.obv\"\n", index + 1));
    }
    row.0.insert(format!("{last}.obv"), "sequence main { wait 1 s }\n".to_owned());
    refused_once(&mut row, "0.obv", (&format!("{}.obv", last - 1), 1))?;
    let mut wide = Folder::default();
    let imports = (0..=MAX_IMPORTED).map(|index| format!("import \"poses/{index}.obv\"\n"));
    let imports: String = imports.collect();
    wide.0.insert("wide.obv".to_owned(), imports + "sequence main { wait 1 s }\n");
    for index in 0..=MAX_IMPORTED {
        let text = format!("joints _p{index} = [0, 0, 0, 0, 0, 0] deg\n");
        wide.0.insert(format!("poses/{index}.obv"), text);
    }
    refused_once(&mut wide, "wide.obv", ("wide.obv", MAX_IMPORTED + 1))
}

/// One file too many is said once, where it is imported.
fn refused_once(folder: &mut Folder, name: &str, at: (&str, usize)) -> Result<(), Failed> {
    let compiled = compile(folder, name);
    let said = vec![(at.0.to_owned(), at.1, Code::TooManyImports.to_string())];
    compare(&said, &found_in(&compiled.sources, &compiled.diagnostics))
}

/// Of the programs for people a word is left out, each in turn. Where that is a mistake of grammar,
/// no name is said to be unknown: all of them are declared.
fn no_name_is_lost() -> Result<(), Failed> {
    let programs = concat!(env!("CARGO_MANIFEST_DIR"), "/programs");
    let folder = Folder::read(Path::new(programs));
    let (mut mistakes, mut lost) = (0, Vec::new());
    for (name, text) in folder.0.iter().filter(|(name, _)| name.ends_with(".obv")) {
        let words: Vec<&str> = text.split_inclusive([' ', '\n']).collect();
        for (index, word) in words.iter().enumerate().filter(|(_, word)| !word.trim().is_empty()) {
            let end = if word.ends_with('\n') { "\n" } else { " " };
            let cut = [&words[..index], &[end], &words[index + 1..]].concat().concat();
            let found = compile_files(name, &cut, &mut folder.clone()).diagnostics;
            if !found.iter().any(|one| one.code.as_str().starts_with("E00")) {
                continue;
            }
            mistakes += 1;
            let unknown = found.iter().filter(|one| one.code == Code::UnknownName);
            lost.extend(unknown.map(|one| {
                let line = words[..index].concat().lines().count();
                format!("{name}:{line} without `{}`: {}", word.trim(), one.message)
            }));
        }
    }
    if mistakes < 100 || !lost.is_empty() {
        return Err(format!("{} of {mistakes}\n  {}", lost.len(), lost.join("\n  ")).into());
    }
    Ok(())
}

fn every_code_occurs() -> Result<(), Failed> {
    let mut shown = BTreeSet::new();
    for file in files() {
        shown.extend(said(&file)?.into_iter().map(|(.., code)| code));
    }
    let is_missing = |code: &&Code| !NOT_KEPT.contains(code) && !shown.contains(code.as_str());
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
