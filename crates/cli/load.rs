//! Programs and workcells from files, whatever they contain.

use crate::show::{self, Problem};
use obverse_bytecode::{Module, Verified, assemble, decode, verify};
use obverse_sim::{Cell, Sim};
use obverse_vm::Machine;
use std::fs;
use std::path::{Path, PathBuf};

/// The largest file that is read, in bytes.
const MAX_FILE_BYTES: u64 = 256 << 20;

/// A program that may be run, and where it came from.
pub(crate) struct Program {
    /// The file.
    pub(crate) path: PathBuf,
    /// What runs.
    pub(crate) verified: Verified,
}

/// Read a file, if it is one and not too large.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    let cannot = |why: String| Problem::new(format!("{}: {why}", path.display()));
    let about = fs::metadata(path).map_err(|error| cannot(format!("cannot be read: {error}")))?;
    if about.is_dir() {
        return Err(cannot("this is a folder; name a file in it".to_owned()));
    }
    if about.len() > MAX_FILE_BYTES {
        let megabytes = MAX_FILE_BYTES >> 20;
        return Err(cannot(format!("larger than the {megabytes} MiB that a program may have")));
    }
    fs::read(path).map_err(|error| cannot(format!("cannot be read: {error}")))
}

fn extension(path: &Path) -> &str {
    path.extension().and_then(|extension| extension.to_str()).unwrap_or("")
}

/// The module of a file: source (`.obv`), assembly text (`.obvasm`) or a module (`.obc`). Warnings
/// are shown, errors returned.
pub(crate) fn module(path: &Path) -> Result<Module, Problem> {
    match extension(path) {
        "obc" => decode(&bytes(path)?)
            .map_err(|error| Problem::new(format!("{}: {error}", path.display()))),
        "obvasm" => assembled(path),
        "tape" => Err(Problem::new(format!(
            "{}: this is a tape; `obverse tape {0}` shows it",
            path.display()
        ))),
        "toml" => Err(Problem::new(format!(
            "{}: this is a workcell; name the program that runs in it",
            path.display()
        ))),
        _ => compiled(path),
    }
}

fn compiled(path: &Path) -> Result<Module, Problem> {
    let raw = bytes(path)?;
    let name = path.display().to_string();
    let text = match obverse_syntax::text_of(&raw) {
        Ok(text) => text,
        Err(diagnostic) => {
            let lossy = String::from_utf8_lossy(&raw);
            return Err(Problem::in_source(&name, &lossy, vec![*diagnostic]));
        }
    };
    // The module carries the file's name alone: the same source gives the same bytes anywhere.
    let short = path.file_name().map_or_else(|| name.clone(), |n| n.to_string_lossy().into_owned());
    let compiled = obverse_compiler::compile(&short, text);
    match compiled.module {
        Some(module) => {
            show::diagnostics(&name, text, &compiled.diagnostics);
            Ok(module)
        }
        None => Err(Problem::in_source(&name, text, compiled.diagnostics)),
    }
}

fn assembled(path: &Path) -> Result<Module, Problem> {
    let raw = bytes(path)?;
    let text = std::str::from_utf8(&raw)
        .map_err(|error| Problem::new(format!("{}: no text: {error}", path.display())))?;
    assemble(text).map_err(|errors| {
        let place = |error: &obverse_bytecode::AsmError| {
            format!("{}:{}:{}: {}", path.display(), error.line, error.column, error.message)
        };
        Problem::several(errors.iter().map(place).collect())
    })
}

/// The program of a file, verified.
pub(crate) fn program(path: &Path) -> Result<Program, Problem> {
    let verified = verify(module(path)?).map_err(|errors| {
        let place = |error| format!("{}: {error}", path.display());
        Problem::several(errors.iter().map(place).collect())
    })?;
    Ok(Program { path: path.to_owned(), verified })
}

/// The workcell that a program runs in: the file that the command line names, else the one that the
/// program names beside itself, else a bare arm.
pub(crate) fn workcell(
    program: &Program,
    named: Option<&Path>,
    seed: u64,
) -> Result<(Sim, String), Problem> {
    let path = match (named, &program.verified.module().cell) {
        (Some(path), _) => path.to_owned(),
        (None, Some(name)) => program.path.with_file_name("").join(name),
        (None, None) => return Ok((Sim::new(&Cell::bare(), seed), "a bare arm".to_owned())),
    };
    let raw = bytes(&path)?;
    let text = String::from_utf8(raw)
        .map_err(|error| Problem::new(format!("{}: no text: {error}", path.display())))?;
    let cell =
        Cell::parse(&text).map_err(|error| Problem::new(format!("{}:{error}", path.display())))?;
    Ok((Sim::new(&cell, seed), path.display().to_string()))
}

/// A machine at the start of a program, in its workcell.
pub(crate) fn machine<'p>(
    program: &'p Program,
    cell: &Sim,
    cell_name: &str,
) -> Result<Machine<'p>, Problem> {
    Machine::new(&program.verified, cell).map_err(|errors| {
        let module = program.verified.module();
        let place = |error: &obverse_vm::LinkError| {
            let at = match error {
                obverse_vm::LinkError::Output { pc, .. }
                | obverse_vm::LinkError::Input { pc, .. } => module.place_of(*pc),
                _ => None,
            };
            let at = at.map_or_else(
                || program.path.display().to_string(),
                |(_, line, column)| format!("{}:{line}:{column}", program.path.display()),
            );
            format!("{at}: {error} (workcell: {cell_name})")
        };
        Problem::several(errors.iter().map(place).collect())
    })
}
