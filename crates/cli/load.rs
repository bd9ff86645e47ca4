//! Programs and workcells from files, whatever they contain.

use crate::problem::{Diagnosed, Message, Problem, plain};
use crate::show;
use obverse_bytecode::codec::MODULE;
use obverse_bytecode::{Module, Verified, assemble, decode, verify};
use obverse_sim::{Cell, Sim};
use obverse_vm::{LinkError, Machine};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The largest file that is read, in bytes.
const MAX_FILE_BYTES: u64 = 256 << 20;

/// A program that may be run, and where it came from.
pub(crate) struct Program {
    /// The file.
    pub(crate) path: PathBuf,
    /// What runs.
    pub(crate) verified: Verified,
    /// The source text and its warnings, if it was compiled from one.
    pub(crate) source: Option<Diagnosed>,
}

/// Read a file, if it is one and not too large.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    let cannot = |error: std::io::Error| {
        Problem::of_file(path, format!("cannot be read: {}", plain(&error)))
    };
    if fs::metadata(path).map_err(cannot)?.is_dir() {
        return Err(Problem::of_file(path, "this is a folder; name a file in it"));
    }
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(cannot)?;
    // What a device or a pipe will give cannot be asked beforehand.
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let megabytes = MAX_FILE_BYTES >> 20;
        return Err(Problem::of_file(
            path,
            format!("larger than {megabytes} MiB, the most allowed"),
        ));
    }
    Ok(bytes)
}

/// The module of a file, not verified, with the source text and its warnings, if there is one. It
/// is a module by its first bytes, assembly text by its name (`.obvasm`), and source otherwise.
pub(crate) fn module(path: &Path) -> Result<(Module, Option<Diagnosed>), Problem> {
    let raw = bytes(path)?;
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("");
    if extension == "tape" {
        let why = format!("this is a tape; `obverse tape {}` shows it", path.display());
        return Err(Problem::of_file(path, why));
    }
    if raw.starts_with(&MODULE.magic) || extension == "obc" {
        let module = decode(&raw).map_err(|error| Problem::of_file(path, error))?;
        return Ok((module, None));
    }
    match extension {
        "obvasm" => Ok((assembled(path, &raw)?, None)),
        "toml" => {
            Err(Problem::of_file(path, "this is a workcell; name the program that runs in it"))
        }
        _ => compiled(path, &raw).map(|(module, diagnosed)| (module, Some(diagnosed))),
    }
}

fn compiled(path: &Path, raw: &[u8]) -> Result<(Module, Diagnosed), Problem> {
    let name = path.display().to_string();
    let text = match obverse_syntax::text_of(raw) {
        Ok(text) => text,
        Err(diagnostic) => {
            let (text, diagnostics) = (String::new(), vec![*diagnostic]);
            return Err(Problem::in_source(Diagnosed { name, text, diagnostics }));
        }
    };
    // The module carries the file's name alone: the same source gives the same bytes anywhere.
    let short = path.file_name().map_or_else(|| name.clone(), |n| n.to_string_lossy().into_owned());
    let compiled = obverse_compiler::compile(&short, text);
    let diagnosed = Diagnosed { name, text: text.to_owned(), diagnostics: compiled.diagnostics };
    match compiled.module {
        Some(module) => Ok((module, diagnosed)),
        None => Err(Problem::in_source(diagnosed)),
    }
}

fn assembled(path: &Path, raw: &[u8]) -> Result<Module, Problem> {
    let text = std::str::from_utf8(raw)
        .map_err(|error| Problem::of_file(path, format!("not text: {error}")))?;
    assemble(text).map_err(|errors| {
        let message = |error: &obverse_bytecode::AsmError| {
            let place = (error.line, error.column);
            Message::of_file(path, &error.message).at(Some(place))
        };
        Problem::several(errors.iter().map(message).collect())
    })
}

/// The program of a file, verified. Its warnings are shown.
pub(crate) fn program(path: &Path) -> Result<Program, Problem> {
    let program = quietly(path)?;
    if let Some(diagnosed) = &program.source {
        show::diagnostics(diagnosed);
    }
    Ok(program)
}

/// The program of a file, verified.
pub(crate) fn quietly(path: &Path) -> Result<Program, Problem> {
    let (module, source) = module(path)?;
    let verified = verify(module).map_err(|errors| {
        Problem::several(errors.iter().map(|error| Message::of_file(path, error)).collect())
    })?;
    Ok(Program { path: path.to_owned(), verified, source })
}

/// The file of the workcell that a program runs in: the one that the command line names, else the
/// one that the program names beside itself.
pub(crate) fn workcell_path(program: &Program, named: Option<&Path>) -> Option<PathBuf> {
    let beside = || {
        let name = program.verified.module().cell.as_ref()?;
        Some(program.path.with_file_name("").join(name))
    };
    named.map(Path::to_owned).or_else(beside)
}

/// The workcell that a program runs in, and what to call it; a bare arm where none is named.
pub(crate) fn workcell(
    program: &Program,
    named: Option<&Path>,
    seed: u64,
) -> Result<(Sim, String), Problem> {
    let Some(path) = workcell_path(program, named) else {
        return Ok((Sim::new(&Cell::bare(), seed), "a bare arm".to_owned()));
    };
    let raw = bytes(&path).map_err(|mut problem| {
        if named.is_none() {
            let file = program.path.display();
            let hint = format!("; {file} names it as its workcell, `--cell FILE` names another");
            problem.messages.iter_mut().for_each(|message| message.text.push_str(&hint));
        }
        problem
    })?;
    let text = String::from_utf8(raw)
        .map_err(|error| Problem::of_file(&path, format!("not text: {error}")))?;
    let cell = Cell::parse(&text).map_err(|error| {
        let place = (error.line, error.column);
        Problem::several(vec![Message::of_file(&path, error.message).at(Some(place))])
    })?;
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
        let message = |error: &LinkError| {
            let place = match error {
                LinkError::Output { pc, .. } | LinkError::Input { pc, .. } => module.place_of(*pc),
                LinkError::Item(_) | LinkError::Tool(_) => None,
            };
            Message::of_file(&program.path, format!("{error} (workcell: {cell_name})"))
                .at(place.map(|(_, line, column)| (line, column)))
        };
        Problem::several(errors.iter().map(message).collect())
    })
}
