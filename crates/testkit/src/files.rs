//! The law of several files: a program that is cut into files, each imported where it was cut out,
//! is the same program. Knows how a program is cut, and nothing of what it says.

use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{Module, verify};
use obverse_compiler::{Compiled, Loader, compile, compile_files};
use std::collections::BTreeMap;
use std::path::Path;

/// How deep files import one another at the most.
const MAX_DEPTH: usize = 4;

/// Files that are kept in memory, by path.
#[derive(Clone, Debug, Default)]
pub struct Folder(pub BTreeMap<String, String>);

impl Loader for Folder {
    fn name(&mut self, path: &str) -> std::result::Result<String, String> {
        let is_there = self.0.contains_key(path);
        is_there.then(|| path.to_owned()).ok_or_else(|| "no such file".to_owned())
    }

    fn read(&mut self, name: &str) -> std::result::Result<String, String> {
        self.0.get(name).cloned().ok_or_else(|| "no such file".to_owned())
    }

    fn files(&mut self, folder: &str) -> Vec<String> {
        let inside = self.0.keys().filter_map(|path| match folder {
            "" => Some(path.as_str()),
            folder => path.strip_prefix(folder)?.strip_prefix('/'),
        });
        inside.filter(|name| !name.contains('/')).map(str::to_owned).collect()
    }
}

impl Folder {
    /// The sources that a folder and those in it have, by their paths from there.
    #[must_use]
    pub fn read(path: &Path) -> Self {
        let mut folder = Self::default();
        folder.add(path, "");
        folder
    }

    fn add(&mut self, path: &Path, prefix: &str) {
        for entry in std::fs::read_dir(path).into_iter().flatten().flatten() {
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                self.add(&entry.path(), &format!("{name}/"));
            } else if name.ends_with(".obv") {
                let text = std::fs::read(entry.path()).unwrap_or_default();
                self.0.insert(name, String::from_utf8_lossy(&text).into_owned());
            }
        }
    }

    /// The program that begins in a file; an empty one if there is no such file.
    #[must_use]
    pub fn compile(&mut self, file: &str) -> Compiled {
        let text = self.0.get(file).cloned().unwrap_or_default();
        compile_files(file, &text, self)
    }
}

/// A program in several files has the same bytecode as in one, and every instruction comes from
/// the same words.
///
/// # Errors
/// Those of the randomness.
///
/// # Panics
/// If the law does not hold.
pub fn files_are_one_program(u: &mut Unstructured<'_>) -> Result<bool> {
    let declarations = programs::declarations(u, Options::default())?;
    let mut cut = Cut { u, folder: Folder::default() };
    cut.file("main.obv", &declarations, 0)?;
    let mut folder = cut.folder;
    let files = folder.0.len();
    let Some(one) = compile("main.obv", &declarations.concat()).module else { return Ok(false) };
    let compiled = folder.compile("main.obv");
    let Some(several) = compiled.module else {
        panic!("it does not compile: {:#?}\n{folder:#?}", compiled.diagnostics)
    };
    assert_eq!(said(&several), said(&one), "{folder:#?}");
    assert_eq!(mentioned(&several), mentioned(&one), "{folder:#?}");
    assert_eq!(several.sources.len(), files, "each file is read once: {folder:#?}");
    assert_eq!(bare(several.clone()), bare(one), "{folder:#?}");
    assert!(verify(several).is_ok(), "it does not verify: {folder:#?}");
    Ok(files > 1)
}

/// What each stretch of code was written as.
fn said(module: &Module) -> Vec<(u32, &str)> {
    let entries = module.source_map.iter();
    entries.map(|entry| (entry.first, text(module, entry.file, entry.start, entry.end))).collect()
}

/// What the program says of its workcell, in its own words.
fn mentioned(module: &Module) -> Vec<&str> {
    let mentions = module.mentions.iter();
    mentions.map(|one| text(module, one.file, one.start, one.end)).collect()
}

fn text(module: &Module, file: u16, start: u32, end: u32) -> &str {
    &module.sources[usize::from(file)].text[start as usize..end as usize]
}

/// A module without its places.
fn bare(mut module: Module) -> Module {
    module.sources.clear();
    module.source_map.clear();
    module.mentions.clear();
    module
}

struct Cut<'g, 'u> {
    u: &'g mut Unstructured<'u>,
    folder: Folder,
}

impl Cut<'_, '_> {
    /// Put declarations into a file, some of them by way of files that it imports.
    fn file(&mut self, name: &str, declarations: &[String], depth: usize) -> Result<()> {
        let mut text = String::new();
        let mut rest = declarations;
        while let [first, others @ ..] = rest {
            if depth < MAX_DEPTH && self.u.ratio(1, 4)? {
                let (inner, after) = rest.split_at(self.u.int_in_range(1..=rest.len())?);
                let inner_name = self.new_name()?;
                // Its place is taken while it is being cut.
                self.folder.0.insert(inner_name.clone(), String::new());
                self.file(&inner_name, inner, depth + 1)?;
                text += &import(name, &inner_name);
                if self.u.ratio(1, 4)? {
                    text += &import(name, &inner_name);
                }
                rest = after;
            } else {
                text += first;
                rest = others;
            }
        }
        self.folder.0.insert(name.to_owned(), text);
        Ok(())
    }

    fn new_name(&mut self) -> Result<String> {
        let folder = *self.u.choose(&["", "", "a/", "b/"])?;
        Ok(format!("{folder}part_{}.obv", self.folder.0.len()))
    }
}

/// An import in one file of another, both being at most one folder deep.
fn import(importer: &str, path: &str) -> String {
    let up = if importer.contains('/') { "../" } else { "" };
    format!("import \"{up}{path}\"\n")
}
