//! One program as it stands: its files, what the compiler says of it, where its names are. It knows
//! what an offset of the compiler is in an editor.

use crate::headers::mended;
use crate::position::Lines;
use crate::steps::Steps;
use crate::uri::{join, split};
use lsp_types::{Position, Range};
use obverse_compiler::symbols::Symbols;
use obverse_compiler::{Compiled, Loader, analyse, library};
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use std::cell::OnceCell;
use std::rc::Rc;

/// A program, compiled.
pub(crate) struct Program {
    /// The folder that it is in.
    folder: String,
    /// What the compiler says.
    pub(crate) compiled: Compiled,
    /// Where its names are.
    pub(crate) symbols: Symbols,
    /// By file.
    lines: Vec<Lines>,
    /// What is known of going back, once it has been asked for.
    steps: OnceCell<Option<Steps>>,
    /// The newest that compiled, if this does not.
    before: Option<Rc<Self>>,
}

/// A place of a program: the key of its file, and where in it.
pub(crate) type Place = (String, Range);

impl Program {
    /// The program that begins in a file, by its key.
    pub(crate) fn new(key: &str, text: &str, loader: &mut dyn Loader) -> Self {
        let (folder, name) = split(key);
        let (compiled, symbols) = analyse(name, text, loader);
        let whole = mended(text).filter(|_| compiled.module.is_none());
        let symbols = match whole.map(|whole| analyse(name, &whole, loader).1) {
            Some(more) if more.symbols.len() > symbols.symbols.len() => more,
            _ => symbols,
        };
        let sources = &compiled.sources;
        let lines = (0..sources.len()).map(|file| Lines::new(sources.text(file))).collect();
        Self {
            folder: folder.to_owned(),
            compiled,
            symbols,
            lines,
            steps: OnceCell::new(),
            before: None,
        }
    }

    /// The same after another one, of which what is known of going back is kept as far as the text
    /// is the same.
    pub(crate) fn after(self, before: Option<Rc<Self>>) -> Self {
        Self { before: before.filter(|_| self.compiled.module.is_none()), ..self }
    }

    /// What is known of going back, from the newest text that compiled; none if none did yet.
    pub(crate) fn steps(&self) -> Option<&Steps> {
        let steps = || match (&self.compiled.module, &self.before) {
            (Some(module), _) => Some(Steps::of(module)),
            (None, Some(before)) => Some(before.steps()?.carried_to(self.sources())),
            (None, None) => None,
        };
        self.steps.get_or_init(steps).as_ref()
    }

    /// All files.
    pub(crate) fn sources(&self) -> &Sources {
        &self.compiled.sources
    }

    /// Which of its files a key is of.
    pub(crate) fn file_of(&self, key: &str) -> Option<usize> {
        (0..self.lines.len()).find(|file| self.key(*file) == key)
    }

    /// The key of a file.
    pub(crate) fn key(&self, file: usize) -> String {
        let name = self.sources().name(file);
        match is_of_library(name) {
            true => name.to_owned(),
            false => join(&self.folder, name),
        }
    }

    /// The text of a file.
    pub(crate) fn text(&self, file: usize) -> &str {
        self.sources().text(file)
    }

    /// The lines of a file.
    pub(crate) fn lines(&self, file: usize) -> Option<&Lines> {
        self.lines.get(file)
    }

    /// The offset in all files of a place in one of them.
    pub(crate) fn offset(&self, file: usize, position: Position) -> u32 {
        let within =
            self.lines.get(file).map_or(0, |lines| lines.offset(self.text(file), position));
        self.start(file) + within
    }

    /// Where a file begins among all of them.
    pub(crate) fn start(&self, file: usize) -> u32 {
        u32::try_from(self.sources().range(file).start).unwrap_or(u32::MAX)
    }

    /// The file and the place of a span.
    pub(crate) fn place(&self, span: Span) -> Option<Place> {
        let place = self.sources().locate(span);
        Some((self.key(place.file), self.range_in(place.file, place.span)?))
    }

    /// The place of a span of one file; none if it is in another.
    pub(crate) fn range(&self, file: usize, span: Span) -> Option<Range> {
        let place = self.sources().locate(span);
        if place.file != file {
            return None;
        }
        self.range_in(file, place.span)
    }

    fn range_in(&self, file: usize, span: Span) -> Option<Range> {
        self.lines.get(file).map(|lines| lines.range(self.text(file), span))
    }

    /// The file that an import in a file leads to.
    pub(crate) fn imported(&self, file: usize, is_library: bool, path: &str) -> Option<usize> {
        let sources = self.sources();
        let name = match is_library {
            true => format!("{}{path}.obv", library::PREFIX),
            false => {
                let mut parts: Vec<&str> = sources.name(file).split('/').collect();
                parts.pop();
                for part in path.split('/') {
                    match part {
                        "" | "." => {}
                        ".." => _ = parts.pop(),
                        _ => parts.push(part),
                    }
                }
                parts.join("/")
            }
        };
        (0..sources.len()).find(|file| sources.name(*file) == name)
    }

    /// What is written at a span.
    pub(crate) fn written(&self, span: Span) -> &str {
        self.sources().whole().get(span.start as usize..span.end as usize).unwrap_or("")
    }
}

/// Whether a file comes with the language.
pub(crate) fn is_of_library(name: &str) -> bool {
    name.starts_with(library::PREFIX)
}
