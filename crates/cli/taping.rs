//! Runs that are recorded to a tape file, and tape files as they are opened again.

use crate::after;
use crate::commands::run::Arguments;
use crate::files;
use crate::load::{self, Program, Workcell};
use crate::problem::{Message, Problem, plain};
use crate::show;
use obverse_bytecode::{encode, fingerprint, verify};
use obverse_debugger::{Before, CellFile, Run, TapeFile, Taped, Writer, taped};
use obverse_geometry::Pose;
use obverse_recovery::{Direct, Driven};
use obverse_sim::Sim;
use obverse_vm::Machine;
use std::fs::File;
use std::path::{Path, PathBuf};

/// The file that a run is recorded to, if it is. What was in it is gone from here on: a run that
/// is killed leaves what it has come to under this name.
pub(crate) fn create(path: Option<&Path>) -> Result<Option<File>, Problem> {
    let cannot = |path: &Path, error: std::io::Error| {
        Problem::of_file(path, format!("cannot be written: {}", plain(&error)))
    };
    path.map(|path| File::create(path).map_err(|error| cannot(path, error))).transpose()
}

/// A machine and its workcell, recorded or not.
pub(crate) enum Rig<'r, 'p> {
    Plain(Direct<'r, 'p, Sim>),
    Taped(Box<Taped<'r, 'r, 'p, Sim>>, &'r Path),
}

impl<'r, 'p> Rig<'r, 'p> {
    /// Of a run that is about to begin, recorded to a file if there is one, with what was run in
    /// the workcell before.
    pub(crate) fn of(
        arguments: &'r Arguments,
        program: &Program,
        (machine, cell): (&'r mut Machine<'p>, &'r mut Sim),
        file: Option<&'r mut File>,
        (workcell, before): (&Workcell, Option<Before>),
    ) -> Result<Self, Problem> {
        let (Some(path), Some(file)) = (&arguments.tape, file) else {
            return Ok(Self::Plain(Direct { machine, cell }));
        };
        let text = workcell.text.clone();
        let cell_file = text.map(|text| CellFile { name: workcell.name.clone(), text });
        let names = (program.path.display().to_string(), cell_file);
        let mut head = taped::head(program.verified.module(), cell, names, arguments.seed)
            .map_err(|error| Problem::of_file(path, error))?;
        head.after = before;
        let taped = Taped::new(machine, cell, Writer::begin(file, head));
        Ok(Self::Taped(Box::new(taped), path))
    }

    /// What is driven.
    pub(crate) fn driven(&mut self) -> &mut dyn Driven<'p, Sim> {
        match self {
            Self::Plain(direct) => direct,
            Self::Taped(taped, _) => &mut **taped,
        }
    }

    /// The run is over: say so in its file.
    pub(crate) fn end(self, ending: &str) -> Result<(), Problem> {
        let Self::Taped(taped, path) = self else { return Ok(()) };
        taped.end(ending).map_err(|error| {
            Problem::of_file(path, format!("cannot be written: {}", plain(&error)))
        })
    }
}

/// A tape file with its program.
pub(crate) struct Opened {
    /// What is in the file.
    pub(crate) file: TapeFile,
    /// Its program.
    pub(crate) program: Program,
    path: PathBuf,
}

/// Open a tape file.
///
/// # Errors
/// It cannot be read, is none, is damaged elsewhere than at its end, or its module does not verify.
pub(crate) fn open(path: &Path) -> Result<Opened, Problem> {
    let bytes = files::read(path).map_err(|why| Problem::of_file(path, why))?;
    let file = TapeFile::from_bytes(&bytes).map_err(|error| Problem::of_file(path, error))?;
    let verified = verify(file.module.clone()).map_err(|errors| {
        Problem::several(errors.iter().map(|error| Message::of_file(path, error)).collect())
    })?;
    let program = Program { path: PathBuf::from(&file.head.program), verified, source: None };
    Ok(Opened { file, program, path: path.to_owned() })
}

/// What tells a program from others, whatever its files are called.
fn identity(program: &Program) -> Result<u64, Problem> {
    let mut module = program.verified.module().clone();
    module.sources.iter_mut().for_each(|source| source.name.clear());
    let bytes = encode(&module).map_err(|error| Problem::of_file(&program.path, error))?;
    Ok(fingerprint(&bytes))
}

impl Opened {
    /// The run, at its end.
    ///
    /// # Errors
    /// If what was recorded is not what the program does.
    pub(crate) fn run(&self) -> Result<Run<'_, Sim>, Problem> {
        let run = Run::of_recording(&self.program.verified, self.file.recording.clone());
        run.map_err(|errors| {
            let errors = errors.unwrap_or_default();
            let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
            let why = if errors.is_empty() { "it does otherwise" } else { &errors.join("; ") };
            let text = format!("what it records is not what its program does: {why}");
            Problem::of_file(&self.path, text)
        })
    }

    /// Whether it is the recording of a program.
    ///
    /// # Errors
    /// If it is not, with both names.
    pub(crate) fn check_is_of(&self, program: &Program) -> Result<(), Problem> {
        let (recorded, named) = (&self.program, program);
        let (was, is) = (identity(recorded)?, identity(named)?);
        if was == is {
            return Ok(());
        }
        let (recorded, named) = (recorded.path.display(), named.path.display());
        let text = format!(
            "this is a run of {recorded} ({was:016x}), and not of {named} as it is now \
             ({is:016x}); leave the program out: the tape has its own, or record the run again"
        );
        Err(Problem::of_file(&self.path, text))
    }

    /// What it is a tape of.
    pub(crate) fn title(&self) -> String {
        let head = &self.file.head;
        let (tape, program, cell) = (self.path.display(), &head.program, self.cell());
        let after = head.after.as_ref().map(|before| Path::new(&before.program));
        let after = after::words(after);
        format!("{tape}: a run of {program} in {cell}, seed {}{after}", head.seed)
    }

    fn cell(&self) -> &str {
        self.file.head.cell.as_ref().map_or("a bare arm", |cell| &cell.name)
    }

    /// Why nothing can be tried otherwise, if nothing can.
    pub(crate) fn lacks(&self, problem: Option<&Problem>) -> Option<String> {
        let Problem { messages, source } = problem?;
        let of_source = source.iter().flat_map(show::diagnostic_lines);
        let why = messages.iter().map(ToString::to_string).chain(of_source).next();
        Some(format!("nothing can be tried otherwise: {}", why.unwrap_or_default()))
    }

    /// Where the tool centre points of the workcell that the run was in are on the tool mount; none
    /// where its file cannot be read.
    pub(crate) fn tcps(&self) -> Vec<Pose> {
        let cell = match &self.file.head.cell {
            Some(CellFile { name, text }) => load::cell_of(Path::new(name), text).ok(),
            None => Some(load::bare().0),
        };
        cell.map_or(Vec::new(), |cell| cell.tools.iter().map(|tool| tool.tcp).collect())
    }

    /// How the run ended, in words.
    pub(crate) fn ending(&self) -> String {
        let torn = match self.file.torn_bytes {
            0 => String::new(),
            1 => "; its last byte is not whole".to_owned(),
            torn => format!("; its last {torn} bytes are not whole"),
        };
        match &self.file.ending {
            Some(words) => words.clone(),
            None => format!("cut off before its end: killed, or still under way{torn}"),
        }
    }

    /// The workcell that the run began in, or the one of another file, which is then to begin and
    /// to act as that one did.
    ///
    /// # Errors
    /// It cannot be read, or what was run in it before does not come to its end in it.
    pub(crate) fn start(&self, named: Option<&Path>) -> Result<Sim, Problem> {
        let head = &self.file.head;
        let (cell, file) = match (named, &head.cell) {
            (Some(_), _) => load::cell(&self.program, named)?,
            (None, Some(CellFile { name, text })) => {
                let file = Workcell { name: name.clone(), text: Some(text.clone()) };
                (load::cell_of(Path::new(name), text)?, file)
            }
            (None, None) => load::bare(),
        };
        let mut cell = Sim::new(&cell, head.seed);
        if let Some(before) = &head.after {
            after::lead_again(before, &mut cell, &file)?;
        }
        Ok(cell)
    }
}
