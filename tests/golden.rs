//! Renderings, compared with files that people have read: one walk over `tests/golden`, and one
//! switch, `UPDATE=1 cargo test --test golden`, that writes what is rendered now.
//!
//! ```text
//! diag/NAME.obv      what `obverse check` says of a program that is wrong: NAME.txt; what it
//!                    imports is in a folder. `//~ E0201`
//!                    at the end of a line says which diagnostics begin there, `//~^ E0201` alone
//!                    on a line those of the line above; asserted, never written
//! compile/NAME.obv   its disassembly but for the source text: NAME.obvasm
//! run/NAME.obv       what `obverse run` tells: NAME.txt, and what `obverse back`: back/NAME.txt
//! reach/NAME.obv     what `obverse reach` draws of it: NAME.txt; likewise of NAME.obvasm
//! moves/NAME.obv     what `obverse check` says of its moves, in the workcell NAME.toml: NAME.txt
//! dry/NAME.obv       what `obverse run --dry` tells: NAME.txt
//! invert/NAME.obv    the inverse of its `main`, or why there is none, at the lines that say so:
//!                    NAME.txt
//! asm/NAME.obvasm    what is wrong with assembly text, or with the module that it says: NAME.txt
//! ```
//!
//! What is rendered is for eyes. What is *meant* is asserted elsewhere, and is never written by a
//! switch.

use libtest_mimic::{Arguments, Failed, Trial};
use obverse_bytecode::{Module, assemble, disassemble, verify};
use obverse_compiler::{MAX_IMPORT_DEPTH, NoInverse, compile_files, invert_files};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::sources::Sources;
use obverse_testkit::files::Folder;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden");

/// A golden: what it is rendered from, how, and where it is kept, both within the folder.
struct Golden {
    source: String,
    render: fn(&str) -> Result<String, Failed>,
    kept: String,
}

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let (goldens, strays) = walk();
    let mut trials: Vec<Trial> = goldens
        .into_iter()
        .map(|golden| Trial::test(golden.kept.clone(), move || golden.compare()))
        .collect();
    trials.extend(strays.into_iter().map(|stray| {
        let why = "nothing is rendered to it: remove it, or bring its source back";
        Trial::test(stray, move || Err(why.into()))
    }));
    trials.push(Trial::test("every diagnostic is shown", every_diagnostic_is_shown));
    libtest_mimic::run(&arguments, trials).exit_code()
}

/// Every golden that should be, and every file that belongs to none.
fn walk() -> (Vec<Golden>, BTreeSet<String>) {
    let mut goldens = Vec::new();
    let mut add = |source: &str, render, kept: String| {
        goldens.push(Golden { source: source.to_owned(), render, kept });
    };
    let mut strays = BTreeSet::new();
    for folder in ["diag", "compile", "run", "back", "reach", "moves", "dry", "invert", "asm"] {
        for name in names_in(folder) {
            let file = format!("{folder}/{name}");
            match (folder, name.rsplit_once('.')) {
                ("diag", Some((stem, "obv"))) => add(&file, diagnosed, format!("diag/{stem}.txt")),
                ("compile", Some((stem, "obv"))) => {
                    add(&file, compiled, format!("compile/{stem}.obvasm"));
                }
                ("run", Some((stem, "obv"))) => {
                    add(&file, run, format!("run/{stem}.txt"));
                    add(&file, back, format!("back/{stem}.txt"));
                }
                ("reach", Some((stem, "obv" | "obvasm"))) => {
                    add(&file, reach, format!("reach/{stem}.txt"));
                }
                ("moves", Some((stem, "obv"))) => add(&file, moves, format!("moves/{stem}.txt")),
                ("dry", Some((stem, "obv"))) => add(&file, dry, format!("dry/{stem}.txt")),
                ("invert", Some((stem, "obv"))) => {
                    add(&file, inverted, format!("invert/{stem}.txt"));
                }
                ("asm", Some((stem, "obvasm"))) => add(&file, refused, format!("asm/{stem}.txt")),
                // Workcells.
                (_, Some((_, "toml"))) => {}
                _ => _ = strays.insert(file),
            }
        }
    }
    goldens.iter().for_each(|golden| _ = strays.remove(&golden.kept));
    (goldens, strays)
}

fn names_in(folder: &str) -> BTreeSet<String> {
    let Ok(entries) = std::fs::read_dir(Path::new(FOLDER).join(folder)) else {
        return BTreeSet::new();
    };
    // Folders hold what is imported.
    let name = |entry: std::io::Result<std::fs::DirEntry>| {
        let entry = entry.ok().filter(|entry| !entry.path().is_dir())?;
        Some(entry.file_name().to_string_lossy().into_owned())
    };
    entries.filter_map(name).collect()
}

fn path(file: &str) -> PathBuf {
    Path::new(FOLDER).join(file)
}

fn bytes(file: &str) -> Result<Vec<u8>, Failed> {
    Ok(std::fs::read(path(file)).map_err(|error| format!("{file}: {error}"))?)
}

fn text(file: &str) -> Result<String, Failed> {
    Ok(String::from_utf8_lossy(&bytes(file)?).into_owned())
}

impl Golden {
    fn compare(&self) -> Result<(), Failed> {
        let rendered = (self.render)(&self.source)?;
        let kept = text(&self.kept).ok();
        if kept.as_deref() == Some(&rendered) {
            return Ok(());
        }
        if std::env::var_os("UPDATE").is_some() {
            return Ok(std::fs::write(path(&self.kept), rendered)?);
        }
        let Some(kept) = kept else {
            return Err(format!("it is not there; {REFRESH}\n{rendered}").into());
        };
        let same = kept.lines().zip(rendered.lines()).take_while(|(a, b)| a == b).count();
        let line = |text: &str| text.lines().nth(same).unwrap_or("the end").to_owned();
        Err(format!(
            "line {} is\n  {}\nand is kept as\n  {}\nin tests/golden/{}; {REFRESH}",
            same + 1,
            line(&rendered),
            line(&kept),
            self.kept
        )
        .into())
    }
}

const REFRESH: &str =
    "if what is rendered now is right, `UPDATE=1 cargo test --test golden` keeps it";

/// What the binary prints, after a line with its exit code. It runs in the folder, so that what it
/// prints does not depend on where that is.
fn printed(arguments: &[&str]) -> Result<String, Failed> {
    let output = Command::new(env!("CARGO_BIN_EXE_obverse"))
        .args(arguments)
        .current_dir(FOLDER)
        .env("NO_COLOR", "1")
        .output()?;
    let code = output.status.code().ok_or("it was ended by a signal")?;
    let (out, error) = (String::from_utf8(output.stdout)?, String::from_utf8(output.stderr)?);
    if out.contains('\u{1b}') || error.contains('\u{1b}') {
        return Err("it is coloured, and nobody looks at it".into());
    }
    Ok(format!("exit {code}\n{error}{out}"))
}

fn run(file: &str) -> Result<String, Failed> {
    printed(&["run", "--seed", "1", file])
}

fn back(file: &str) -> Result<String, Failed> {
    printed(&["back", "--seed", "1", file])
}

fn reach(file: &str) -> Result<String, Failed> {
    printed(&["reach", file])
}

fn moves(file: &str) -> Result<String, Failed> {
    printed(&["check", file])
}

fn dry(file: &str) -> Result<String, Failed> {
    printed(&["run", "--dry", "--seed", "1", file])
}

fn listed(errors: &[impl ToString]) -> String {
    errors.iter().map(|error| error.to_string() + "\n").collect()
}

/// The disassembly of a program, which assembles to the same module again.
fn compiled(file: &str) -> Result<String, Failed> {
    let source = text(file)?;
    let name = file.trim_start_matches("compile/");
    let compiled = obverse_compiler::compile(name, &source);
    let found: Vec<_> = placed(&compiled.sources, &compiled.diagnostics).into_iter().collect();
    let (Some(module), []) = (compiled.module, &found[..]) else {
        return Err(format!("it does not compile without a word: {found:?}").into());
    };
    let listing = disassemble(&module);
    let again: Module = assemble(&listing).map_err(|errors| listed(&errors))?;
    if again != module {
        return Err("its disassembly is of another module".into());
    }
    verify(module).map_err(|errors| listed(&errors))?;
    let (code, _source) = listing.split_once("\n.source").ok_or("it lacks its source")?;
    Ok(code.to_owned())
}

fn refused(file: &str) -> Result<String, Failed> {
    match assemble(&text(file)?) {
        Err(errors) => Ok(listed(&errors)),
        Ok(module) => match verify(module) {
            Err(errors) => Ok(listed(&errors)),
            Ok(_) => Err("nothing is wrong with it".into()),
        },
    }
}

/// What `obverse check` says, if the diagnostics are those that the source says that it has.
fn diagnosed(file: &str) -> Result<String, Failed> {
    let bytes = bytes(file)?;
    let name = file.trim_start_matches("diag/");
    let (found, said) = match obverse_syntax::text_of(&bytes) {
        Ok(source) => {
            let compiled = compile_files(name, source, &mut Folder::read(&path("diag")));
            let sources = &compiled.sources;
            let said = (0..sources.len())
                .flat_map(|file| said(sources.name(file), sources.text(file)))
                .collect();
            (placed(&compiled.sources, &compiled.diagnostics), said)
        }
        Err(diagnostic) => {
            let found = Placed::from([(name.to_owned(), 1, diagnostic.code.to_string())]);
            (found, said(name, &text(file)?))
        }
    };
    if found != said {
        return Err(format!("it says that it has {said:?}, and it has {found:?}").into());
    }
    let code = file.trim_start_matches("diag/").split(['.', '_']).next().unwrap_or_default();
    if !said.iter().any(|(_, _, said)| said == code) {
        return Err(format!("its name says that it shows {code}, and it does not").into());
    }
    printed(&["check", file])
}

/// What `obverse invert` says, if it refuses what the source says that it does.
fn inverted(file: &str) -> Result<String, Failed> {
    let source = text(file)?;
    let said = said(file, &source);
    let (sources, inverse) = invert_files(file, &source, "main", &mut Folder::default());
    let found = match inverse {
        Ok(_) => Placed::new(),
        Err(NoInverse::Diagnosed(diagnostics)) => placed(&sources, &diagnostics),
        Err(NoInverse::UnknownSequence(_) | NoInverse::OtherKind(_)) => {
            return Err("it has no `main`".into());
        }
    };
    if found != said {
        return Err(format!("it says that it has {said:?}, and it has {found:?}").into());
    }
    printed(&["invert", file, "main"])
}

/// Files, lines and codes of diagnostics.
type Placed = BTreeSet<(String, usize, String)>;

fn placed(sources: &Sources, diagnostics: &[Diagnostic]) -> Placed {
    let place = |one: &Diagnostic| {
        let (name, position) = sources.position(one.primary.span);
        (name.to_owned(), position.line as usize, one.code.to_string())
    };
    diagnostics.iter().map(place).collect()
}

/// What a file says of its own diagnostics.
fn said(name: &str, text: &str) -> Placed {
    let mut said = Placed::new();
    for (number, line) in (1..).zip(text.lines()) {
        let Some((_, codes)) = line.split_once("//~") else { continue };
        let (number, codes) = match codes.strip_prefix('^') {
            Some(codes) => (number - 1, codes),
            None => (number, codes),
        };
        let one = |code: &str| (name.to_owned(), number, code.to_owned());
        said.extend(codes.split_whitespace().map(one));
    }
    said
}

/// What takes too much room to be kept among the goldens: a text that is too large, and more files
/// in a row than may import one another.
fn too_large() -> Vec<Code> {
    let source = " ".repeat(obverse_syntax::MAX_SOURCE_BYTES + 1);
    let mut row = Folder::default();
    for index in 0..=MAX_IMPORT_DEPTH + 1 {
        row.0.insert(format!("{index}.obv"), format!("import \"{}.obv\"", index + 1));
    }
    let found = [obverse_syntax::parse(&source).diagnostics, row.compile("0.obv").diagnostics];
    found.iter().flatten().map(|one| one.code).collect()
}

fn every_diagnostic_is_shown() -> Result<(), Failed> {
    let mut shown: BTreeSet<String> = too_large().iter().map(ToString::to_string).collect();
    for name in names_in("diag").iter().filter(|name| name.ends_with(".obv")) {
        let said = said(name, &text(&format!("diag/{name}"))?);
        if said.is_empty() {
            return Err(format!("no `//~ CODE` in {name}").into());
        }
        shown.extend(said.into_iter().map(|(_, _, code)| code));
    }
    let refused = said("refused.obv", &text("invert/refused.obv")?);
    shown.extend(refused.into_iter().map(|(_, _, code)| code));
    let codes: BTreeSet<String> = Code::ALL.iter().map(ToString::to_string).collect();
    let missing: Vec<_> = codes.difference(&shown).collect();
    let unknown: Vec<_> = shown.difference(&codes).collect();
    if missing.is_empty() && unknown.is_empty() {
        return Ok(());
    }
    Err(format!("write tests/golden/diag/CODE.obv for {missing:?}; unknown: {unknown:?}").into())
}
