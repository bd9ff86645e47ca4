//! Programs and workcells from files, whatever they contain.

use crate::files::{self, ProgramFolder};
use crate::problem::{Diagnosed, Message, Problem};
use crate::{lacking, show};
use obverse_bytecode::codec::MODULE;
use obverse_bytecode::{Mentioned, Module, ModuleCode, Verified, assemble, decode, verify};
use obverse_compiler::{Action, Compiled, Defaults, compile_with, library};
use obverse_sim::{Cell, CellCode, Sim};
use obverse_syntax::sources::Sources;
use obverse_vm::Machine;
use std::path::{Path, PathBuf};

/// A program that may be run, and where it came from.
pub(crate) struct Program {
    /// The file.
    pub(crate) path: PathBuf,
    /// What runs.
    pub(crate) verified: Verified,
    /// The source text and its warnings, if it was compiled from one.
    pub(crate) source: Option<Diagnosed>,
}

impl Program {
    /// A source file of the program as people find it.
    pub(crate) fn path_of(&self, file: &str) -> PathBuf {
        match &self.source {
            Some(diagnosed) => diagnosed.path_of(file),
            None => PathBuf::from(file),
        }
    }

    /// Every file that was read for the program.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let sources = self.source.iter().flat_map(|diagnosed| {
            let names = (1..diagnosed.sources.len()).map(|file| diagnosed.sources.name(file));
            let on_disk = names.filter(|name| !name.starts_with(library::PREFIX));
            on_disk.map(|name| diagnosed.path_of(name))
        });
        std::iter::once(self.path.clone()).chain(sources).collect()
    }
}

/// A workcell file as it was read, for messages.
pub(crate) struct Workcell {
    /// What to call it.
    pub(crate) name: String,
    /// Its text; none for a bare arm.
    pub(crate) text: Option<String>,
}

/// Read a file, if it is one and not too large.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    files::read(path).map_err(|why| Problem::of_file(path, why))
}

/// Refuse a file whose name says that it is no source text, which alone can be treated so.
pub(crate) fn require_source(path: &Path, treated: &str) -> Result<(), Problem> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("");
    if matches!(extension, "obvasm" | "obc" | "tape" | "toml") {
        let why = format!("`.{extension}` is not for source text, which alone is {treated}");
        return Err(Problem::of_file(path, why));
    }
    Ok(())
}

/// The module of a file, not verified, with the source text and its warnings, if there is one. It
/// is a module by its first bytes, assembly text by its name (`.obvasm`), and source otherwise.
pub(crate) fn module(path: &Path) -> Result<(Module, Option<Diagnosed>), Problem> {
    module_with(path, &[])
}

/// The same with the values of parameter files in the place of defaults.
fn module_with(
    path: &Path,
    parameters: &[PathBuf],
) -> Result<(Module, Option<Diagnosed>), Problem> {
    if !parameters.is_empty() {
        require_source(path, "given parameters")?;
    }
    let raw = bytes(path)?;
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("");
    if extension == "tape" {
        let shown = path.display();
        let why = format!(
            "this is a tape; `obverse tape {shown}` shows it, and `obverse debug --tape \
             {shown}` walks through its run"
        );
        return Err(Problem::of_file(path, why));
    }
    if raw.starts_with(&MODULE.magic) || extension == "obc" {
        let module = decode(&raw).map_err(|error| {
            let message = Message::of_file(path, error).coded(ModuleCode::Bytes.as_str());
            Problem::several(vec![message])
        })?;
        return Ok((module, None));
    }
    match extension {
        "obvasm" => Ok((assembled(path, &raw)?, None)),
        "toml" => {
            Err(Problem::of_file(path, "this is a workcell; name the program that runs in it"))
        }
        _ => {
            let (mut module, mut diagnosed, actions) = compiled(path, &raw, &Defaults::new())?;
            if !parameters.is_empty() {
                let defaults = crate::parameters::defaults(parameters, (path, &module), &actions)?;
                (module, diagnosed, _) = compiled(path, &raw, &defaults)?;
            }
            Ok((module, Some(diagnosed)))
        }
    }
}

/// The program of a source text and its actions, with other values in the place of defaults.
pub(crate) fn source(path: &Path, defaults: &Defaults) -> Result<(Program, Vec<Action>), Problem> {
    let (module, diagnosed, actions) = compiled(path, &bytes(path)?, defaults)?;
    Ok((verified(path, module, Some(diagnosed))?, actions))
}

fn compiled(
    path: &Path,
    raw: &[u8],
    defaults: &Defaults,
) -> Result<(Module, Diagnosed, Vec<Action>), Problem> {
    // The module carries the file's name alone: the same source gives the same bytes anywhere.
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let folder = path.with_file_name("");
    let text = match obverse_syntax::text_of(raw) {
        Ok(text) => text,
        Err(diagnostic) => {
            let (sources, diagnostics) = (Sources::one(&name, ""), vec![*diagnostic]);
            return Err(Problem::in_source(Diagnosed { folder, sources, diagnostics }));
        }
    };
    let compiled = compile_with(&name, text, &mut ProgramFolder::of(path), defaults);
    let Compiled { module, diagnostics, actions, sources } = compiled;
    let diagnosed = Diagnosed { folder, sources, diagnostics };
    match module {
        Some(module) => Ok((module, diagnosed, actions)),
        None => Err(Problem::in_source(diagnosed)),
    }
}

fn assembled(path: &Path, raw: &[u8]) -> Result<Module, Problem> {
    let text = std::str::from_utf8(raw)
        .map_err(|error| not_text(path, &error, ModuleCode::Header.as_str()))?;
    assemble(text).map_err(|errors| {
        let message = |error: &obverse_bytecode::AsmError| {
            let place = (error.line, error.column);
            Message::of_file(path, &error.message).at(Some(place)).coded(error.code.as_str())
        };
        Problem::several(errors.iter().map(message).collect())
    })
}

/// The program of a file, verified. Its warnings are shown.
pub(crate) fn program(path: &Path) -> Result<Program, Problem> {
    program_with(path, &[])
}

/// The same with the values of parameter files in the place of defaults.
pub(crate) fn program_with(path: &Path, parameters: &[PathBuf]) -> Result<Program, Problem> {
    let (module, source) = module_with(path, parameters)?;
    let program = verified(path, module, source)?;
    if let Some(diagnosed) = &program.source {
        show::diagnostics(diagnosed);
    }
    Ok(program)
}

/// The program of a file, verified.
pub(crate) fn quietly(path: &Path) -> Result<Program, Problem> {
    quietly_with(path, &[])
}

/// The same with the values of parameter files in the place of defaults.
pub(crate) fn quietly_with(path: &Path, parameters: &[PathBuf]) -> Result<Program, Problem> {
    let (module, source) = module_with(path, parameters)?;
    verified(path, module, source)
}

/// The program of a module, verified.
pub(crate) fn verified(
    path: &Path,
    module: Module,
    source: Option<Diagnosed>,
) -> Result<Program, Problem> {
    let verified = verify(module).map_err(|errors| {
        let message = |error: &obverse_bytecode::VerifyError| {
            Message::of_file(path, error).coded(error.rule.code().as_str())
        };
        Problem::several(errors.iter().map(message).collect())
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

/// The workcell that a program runs in, and its file; a bare arm where none is named.
pub(crate) fn workcell(
    program: &Program,
    named: Option<&Path>,
    seed: u64,
) -> Result<(Sim, Workcell), Problem> {
    let (cell, file) = cell(program, named)?;
    Ok((Sim::new(&cell, seed), file))
}

/// The description of the workcell that a program runs in, and its file; a bare arm where none is
/// named.
pub(crate) fn cell(program: &Program, named: Option<&Path>) -> Result<(Cell, Workcell), Problem> {
    let Some(path) = workcell_path(program, named) else { return Ok(bare()) };
    let raw = bytes(&path).map_err(|problem| match named {
        Some(_) => problem,
        None => named_by(program, problem),
    })?;
    let text = String::from_utf8(raw)
        .map_err(|error| not_text(&path, &error.utf8_error(), CellCode::Toml.as_str()))?;
    Ok((cell_of(&path, &text)?, Workcell { name: path.display().to_string(), text: Some(text) }))
}

/// The workcell of a program that names none.
pub(crate) fn bare() -> (Cell, Workcell) {
    (Cell::bare(), Workcell { name: "a bare arm".to_owned(), text: None })
}

/// The workcell that the text of a file describes.
pub(crate) fn cell_of(path: &Path, text: &str) -> Result<Cell, Problem> {
    Cell::parse(text).map_err(|error| {
        let place = (error.line, error.column);
        let message = Message::of_file(path, error.message).at(Some(place));
        Problem::several(vec![message.coded(error.code.as_str())])
    })
}

fn not_text(path: &Path, error: &std::str::Utf8Error, code: &'static str) -> Problem {
    let message = Message::of_file(path, format!("not text: {error}"));
    Problem::several(vec![message.coded(code)])
}

/// What is wrong with a workcell file, and where the program names it.
fn named_by(program: &Program, mut problem: Problem) -> Problem {
    let module = program.verified.module();
    let mention = module.mentions.iter().find(|mention| mention.what == Mentioned::Cell);
    let place = mention.and_then(|mention| module.place_of_mention(mention));
    let text = "it is named as the workcell here; `--cell FILE` names another";
    let here = match place {
        Some((file, line, column)) => {
            Message::of_file(&program.path_of(file), text).at(Some((line, column)))
        }
        None => Message::of_file(&program.path, text),
    };
    problem.messages =
        problem.messages.into_iter().map(|one| one.with(Some(here.clone()))).collect();
    problem
}

/// A machine at the start of a program, in its workcell.
pub(crate) fn machine<'p>(
    program: &'p Program,
    cell: &Sim,
    workcell: &Workcell,
) -> Result<Machine<'p>, Problem> {
    Machine::new(&program.verified, cell)
        .map_err(|errors| Problem::several(lacking::messages(program, workcell, &errors)))
}
