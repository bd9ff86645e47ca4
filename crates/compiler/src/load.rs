//! The files of a program: from one file to all that it imports, each read once.
//!
//! It knows which paths may be imported, cycles and limits. How a file is read a [`Loader`] knows,
//! and what an import means `merge`.

use crate::library;
use crate::path;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::sources::Sources;
use obverse_syntax::span::{Span, Spanned};
use obverse_syntax::{MAX_SOURCE_BYTES, imports, nearest};
use std::collections::HashMap;

/// How many files a program may import, those that cannot be read among them.
pub const MAX_IMPORTED: usize = 1_000;

/// How many files may import one another in a row.
pub const MAX_IMPORT_DEPTH: usize = 64;

/// Where the files of a program come from. Paths are relative to the folder of the program, with
/// `/` between folders, and lead to nothing outside of it.
///
/// Errors say why not, in words that follow "cannot be imported: ".
pub trait Loader {
    /// The one name of the file that a path leads to, also a path: the same for every path to the
    /// same file.
    ///
    /// # Errors
    /// Why there is no such file.
    fn name(&mut self, path: &str) -> Result<String, String>;

    /// The text of the file of this name. Asked for once.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn read(&mut self, name: &str) -> Result<String, String>;

    /// The names of the files of a folder that can be imported, as far as they can be told; the
    /// folder of the program is empty. Asked for where there is no file that a path leads to.
    fn files(&mut self, _folder: &str) -> Vec<String> {
        Vec::new()
    }
}

/// A program of one file.
pub(crate) struct OneFile;

impl Loader for OneFile {
    fn name(&mut self, _path: &str) -> Result<String, String> {
        Err("this text stands alone, without a folder".to_owned())
    }

    fn read(&mut self, _name: &str) -> Result<String, String> {
        Err("this text stands alone, without a folder".to_owned())
    }
}

/// All files of a program, and what is wrong with its imports.
#[derive(Debug, Default)]
pub(crate) struct Loaded {
    /// The files; the first is the one that was asked for.
    pub(crate) sources: Sources,
    /// Which file each import is of, by the position that its path begins at.
    pub(crate) imported: HashMap<u32, usize>,
    /// What is wrong, in the order of reading.
    pub(crate) diagnostics: Vec<Diagnostic>,
}

/// Read all that a text imports. `name` is that of its file in its folder.
pub(crate) fn load(name: &str, text: &str, loader: &mut dyn Loader) -> Loaded {
    let loaded = Loaded { sources: Sources::one(name, text), ..Loaded::default() };
    if imports(&loaded.sources, 0).is_empty() {
        return loaded;
    }
    // A file that cannot be named again is not imported by what it imports.
    let root = loader.name(name).unwrap_or_else(|_| name.to_owned());
    let files = HashMap::from([(root, Some(0))]);
    let mut loading = Loading { loader, loaded, files, asked: HashMap::new(), chain: Vec::new() };
    loading.imports_of(0);
    loading.loaded
}

/// What a file is by its name, if it is no source text, and how it is named instead.
fn other_kind(written: &str) -> Option<(&'static str, String)> {
    let (_, extension) = written.rsplit_once('.')?;
    Some(match extension {
        "toml" => ("a workcell", format!("a program names its workcell by `cell \"{written}\"`")),
        "obvasm" => ("assembly text", "what is imported is source text, `.obv`".to_owned()),
        "obc" => ("a module", "what is imported is source text, `.obv`".to_owned()),
        "tape" => ("a tape", "what is imported is source text, `.obv`".to_owned()),
        _ => return None,
    })
}

/// An import that is being followed.
struct Link {
    /// The file that is imported.
    file: usize,
    /// Where.
    at: Span,
}

struct Loading<'l> {
    loader: &'l mut dyn Loader,
    loaded: Loaded,
    /// By name; none for what could not be read.
    files: HashMap<String, Option<usize>>,
    /// By path as it is asked for; none for what has been reported.
    asked: HashMap<String, Option<usize>>,
    /// From the first file to the one in hand.
    chain: Vec<Link>,
}

impl Loading<'_> {
    /// Follow the imports of a file.
    fn imports_of(&mut self, file: usize) {
        let found = imports(&self.loaded.sources, file);
        let found =
            found.iter().map(|one| (one.is_library, one.path.value.to_owned(), one.path.span));
        let found: Vec<(bool, String, Span)> = found.collect();
        for (is_library, written, at) in found {
            let target = match is_library {
                true => self.of_library(&written, at),
                false => self.target(file, &written, at),
            };
            if let Some(target) = target.filter(|target| !self.is_cycle(*target, at)) {
                self.loaded.imported.insert(at.start, target);
            }
        }
    }

    /// The file that an import leads to, with its own imports followed.
    fn target(&mut self, file: usize, written: &str, at: Span) -> Option<usize> {
        let path = match path::resolve(self.loaded.sources.name(file), written) {
            Ok(path) => path,
            Err(why) => {
                let message = format!("`{written}` is no path that can be imported");
                self.report(Code::ImportPath, at, message, why);
                return None;
            }
        };
        if let Some(known) = self.asked.get(&path) {
            return *known;
        }
        let target = self.open(&path, Spanned::new(written, at));
        self.asked.insert(path, target);
        target
    }

    /// A file of the library, which imports others of it alone.
    fn of_library(&mut self, written: &str, at: Span) -> Option<usize> {
        let Some((name, text)) = library::find(written) else {
            let message = format!("`{written}` cannot be imported: the library has no such file");
            let names = library::FILES.map(|(name, _)| name);
            let diagnostic = Diagnostic::error(Code::CannotImport, at, message, "imported here")
                .with_note(format!("it has {}", names.join(", ")));
            self.loaded.diagnostics.push(match nearest(written, names) {
                Some(meant) => diagnostic.did_you_mean(at, &format!("\"{meant}\"")),
                None => diagnostic,
            });
            return None;
        };
        // No path has a colon in it, so that no file of the program is called so.
        let name = format!("{}{name}.obv", library::PREFIX);
        match self.files.get(&name) {
            Some(known) => *known,
            None => self.follow(&name, text, at),
        }
    }

    /// Find a file that this path has not been asked for before.
    fn open(&mut self, path: &str, written: Spanned<&str>) -> Option<usize> {
        let at = written.span;
        if self.asked.len() >= MAX_IMPORTED {
            if self.asked.len() == MAX_IMPORTED {
                let message = format!("a program imports at most {MAX_IMPORTED} files");
                self.report(Code::TooManyImports, at, message, "this one is too many");
            }
            return None;
        }
        let refuse = |loading: &mut Self, why: &str| {
            let message = format!("`{}` cannot be imported: {why}", written.value);
            loading.report(Code::CannotImport, at, message, "imported here");
            None
        };
        if let Some((kind, help)) = other_kind(written.value) {
            let message = format!("`{}` cannot be imported: this is {kind}", written.value);
            let diagnostic = Diagnostic::error(Code::CannotImport, at, message, "imported here");
            self.loaded.diagnostics.push(diagnostic.with_help(help));
            return None;
        }
        let name = match self.loader.name(path) {
            Ok(name) => name,
            Err(why) => {
                refuse(self, &why);
                self.suggest(path, written);
                return None;
            }
        };
        if let Some(known) = self.files.get(&name) {
            return *known;
        }
        self.files.insert(name.clone(), None);
        if self.chain.len() >= MAX_IMPORT_DEPTH {
            let message = format!("at most {MAX_IMPORT_DEPTH} files import one another in a row");
            self.report(Code::TooManyImports, at, message, "this one is too many");
            return None;
        }
        let text = match self.loader.read(&name) {
            Ok(text) if text.contains('\0') => return refuse(self, "this is no text: a NUL byte"),
            Ok(text) => text,
            Err(why) => return refuse(self, &why),
        };
        self.follow(&name, &text, at)
    }

    /// Add to the diagnostic of a file that is not there the one that was probably meant.
    fn suggest(&mut self, path: &str, written: Spanned<&str>) {
        let (folder, name) = path.rsplit_once('/').unwrap_or(("", path));
        let mut files = self.loader.files(folder);
        // What is under way cannot be meant.
        let under_way = std::iter::once(0).chain(self.chain.iter().map(|link| link.file));
        for file in under_way {
            let own = self.loaded.sources.name(file);
            let (at, own) = own.rsplit_once('/').unwrap_or(("", own));
            files.retain(|name| at != folder || name != own);
        }
        let full = format!("{name}.obv");
        let same = files.iter().find(|file| **file == full).map(String::as_str);
        let Some(meant) = same.or(nearest(name, files.iter().map(String::as_str))) else { return };
        let Some(diagnostic) = self.loaded.diagnostics.pop() else { return };
        let folder =
            written.value.rsplit_once('/').map_or(String::new(), |(at, _)| format!("{at}/"));
        let meant = format!("\"{folder}{meant}\"");
        self.loaded.diagnostics.push(diagnostic.did_you_mean(written.span, &meant));
    }

    /// Add a file, and all that it imports.
    fn follow(&mut self, name: &str, text: &str, at: Span) -> Option<usize> {
        let Some(file) = self.loaded.sources.add(name, text) else {
            let megabytes = MAX_SOURCE_BYTES >> 20;
            let message = format!("the files of a program have at most {megabytes} MiB together");
            self.report(Code::TooManyImports, at, message, "with this one they have more");
            return None;
        };
        self.files.insert(name.to_owned(), Some(file));
        self.chain.push(Link { file, at });
        self.imports_of(file);
        self.chain.pop();
        Some(file)
    }

    /// Whether a file is imported by what it imports itself, which is reported.
    fn is_cycle(&mut self, target: usize, at: Span) -> bool {
        let begin = match target {
            0 => Some(0),
            _ => self.chain.iter().position(|link| link.file == target).map(|index| index + 1),
        };
        let Some(begin) = begin else { return false };
        let sources = &self.loaded.sources;
        let links = &self.chain[begin..];
        let row = std::iter::once(target).chain(links.iter().map(|link| link.file));
        let names: Vec<&str> = row.chain([target]).map(|file| sources.name(file)).collect();
        let message = format!("`{}` imports itself: {}", names[0], names.join(" -> "));
        let mut diagnostic =
            Diagnostic::error(Code::ImportCycle, at, message, "which closes the circle")
                .with_help("put what both need into a file of its own");
        for (link, importer) in links.iter().zip(&names) {
            let imported = sources.name(link.file);
            diagnostic = diagnostic.with_label(link.at, format!("{importer} imports {imported}"));
        }
        self.loaded.diagnostics.push(diagnostic);
        true
    }

    fn report(&mut self, code: Code, at: Span, message: String, why: &str) {
        self.loaded.diagnostics.push(Diagnostic::error(code, at, message, why));
    }
}
