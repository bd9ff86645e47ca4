//! Why a command was not carried out: messages with their places, or the diagnostics of a source.
//!
//! Data alone; how it is shown is in `show`.

use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::sources::Sources;
use std::path::{Path, PathBuf};

/// Why a command was not carried out.
#[derive(Debug)]
pub(crate) struct Problem {
    /// What is wrong.
    pub(crate) messages: Vec<Message>,
    /// Diagnostics of a source text.
    pub(crate) source: Option<Diagnosed>,
}

/// A sentence about a file, or about the command line.
#[derive(Clone, Debug)]
pub(crate) struct Message {
    /// The file as the command line named it, or as the one that did names it.
    pub(crate) file: Option<String>,
    /// Line and column, from 1.
    pub(crate) place: Option<(usize, usize)>,
    /// What is wrong there.
    pub(crate) text: String,
    /// The code that `obverse explain` knows, of what is wrong with a workcell or with assembly;
    /// none of what is wrong with the command line or with reading a file.
    pub(crate) code: Option<&'static str>,
    /// Further places that belong to it.
    pub(crate) also: Vec<Message>,
}

/// The files of a program and what is wrong with them.
#[derive(Clone, Debug)]
pub(crate) struct Diagnosed {
    /// The folder that they are in, as the command line names it.
    pub(crate) folder: PathBuf,
    /// The files as they were read; the first is the one that the command line names.
    pub(crate) sources: Sources,
    /// Errors and warnings, by place.
    pub(crate) diagnostics: Vec<Diagnostic>,
}

impl Problem {
    /// Something wrong with the command line.
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self::several(vec![Message::new(text)])
    }

    /// Something wrong with a file.
    pub(crate) fn of_file(path: &Path, text: impl ToString) -> Self {
        Self::several(vec![Message::of_file(path, text)])
    }

    /// Several messages.
    pub(crate) fn several(messages: Vec<Message>) -> Self {
        Self { messages, source: None }
    }

    /// What is wrong with a program's files.
    pub(crate) fn in_source(diagnosed: Diagnosed) -> Self {
        Self { messages: Vec::new(), source: Some(diagnosed) }
    }
}

impl Diagnosed {
    /// A file as people find it.
    pub(crate) fn name(&self, file: usize) -> String {
        self.path_of(self.sources.name(file)).display().to_string()
    }

    /// The same by its name; a file of the library is in no folder.
    pub(crate) fn path_of(&self, file: &str) -> PathBuf {
        match file.starts_with(obverse_compiler::library::PREFIX) {
            true => PathBuf::from(file),
            false => self.folder.join(file),
        }
    }
}

impl Message {
    /// A sentence about no file.
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self { file: None, place: None, text: text.into(), code: None, also: Vec::new() }
    }

    /// A sentence about a file.
    pub(crate) fn of_file(path: &Path, text: impl ToString) -> Self {
        Self { file: Some(path.display().to_string()), ..Self::new(text.to_string()) }
    }

    /// The same at a line and column, if they are known.
    pub(crate) fn at(self, place: Option<(usize, usize)>) -> Self {
        Self { place, ..self }
    }

    /// The same with its code.
    pub(crate) fn coded(self, code: &'static str) -> Self {
        Self { code: Some(code), ..self }
    }

    /// The same with a further place, if there is one.
    pub(crate) fn with(mut self, also: Option<Self>) -> Self {
        self.also.extend(also);
        self
    }
}

impl std::fmt::Display for Message {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{file}:")?;
            if let Some((line, column)) = self.place {
                write!(f, "{line}:{column}:")?;
            }
            write!(f, " ")?;
        }
        f.write_str(&self.text)?;
        self.also.iter().try_for_each(|also| write!(f, "\n  {also}"))
    }
}

/// An error of the system in plain words, without its number.
pub(crate) fn plain(error: &std::io::Error) -> String {
    let text = error.to_string();
    match text.split_once(" (os error") {
        Some((words, _)) => words.to_lowercase(),
        None => text,
    }
}
