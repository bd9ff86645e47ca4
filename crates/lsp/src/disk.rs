//! The files behind what is open: what a program imports is what is open in the editor, and else
//! what lies on the disk. How files are read is known elsewhere.

use crate::uri::join;
use crate::workspace::Document;
use obverse_bytecode::Module;
use obverse_compiler::Loader;
use std::collections::BTreeMap;

/// How files are read.
pub trait Disk {
    /// The files of the folder that a file is in, for its compiler.
    fn folder_of(&self, path: &str) -> Box<dyn Loader>;

    /// The names and texts of the source files in a folder; no more of them than are read without
    /// being noticed.
    fn sources(&self, folder: &str) -> Vec<(String, String)>;

    /// What a program asks of its workcell that this has not, by the path of the file that it
    /// begins in; nothing where workcells are not known.
    fn lacking(&self, _path: &str, _module: &Module) -> Vec<Lacking> {
        Vec::new()
    }
}

/// What a program asks of its workcell and this has not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lacking {
    /// The file of the program that asks for it, by its name in the module.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// The letter of the line, from 1.
    pub column: usize,
    /// The code that explains it, if one does.
    pub code: Option<&'static str>,
    /// What is lacking, and what there is.
    pub message: String,
}

/// No files at all: what is open is all there is.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoDisk;

impl Disk for NoDisk {
    fn folder_of(&self, _path: &str) -> Box<dyn Loader> {
        Box::new(Self)
    }

    fn sources(&self, _folder: &str) -> Vec<(String, String)> {
        Vec::new()
    }
}

impl Loader for NoDisk {
    fn name(&mut self, _path: &str) -> Result<String, String> {
        Err("there is no such file".to_owned())
    }

    fn read(&mut self, _name: &str) -> Result<String, String> {
        Err("there is no such file".to_owned())
    }
}

/// The folder of a program, with what is open in place of what lies there.
pub(crate) struct OpenFirst<'t> {
    /// The folder.
    pub(crate) folder: String,
    /// What is open, by path.
    pub(crate) open: &'t BTreeMap<String, Document>,
    /// What lies there.
    pub(crate) disk: Box<dyn Loader>,
}

impl Loader for OpenFirst<'_> {
    fn name(&mut self, path: &str) -> Result<String, String> {
        self.disk.name(path).or_else(|why| {
            // It is being written and was never saved.
            let is_open = self.open.contains_key(&join(&self.folder, path));
            if is_open { Ok(path.to_owned()) } else { Err(why) }
        })
    }

    fn read(&mut self, name: &str) -> Result<String, String> {
        match self.open.get(&join(&self.folder, name)) {
            Some(document) => Ok(document.text.clone()),
            None => self.disk.read(name),
        }
    }
}
