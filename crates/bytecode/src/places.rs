//! Where instructions were written: file, line and column, for whoever asks of many.
//!
//! Knows how lines end, and nothing of languages.

use crate::module::{Mention, Module};

/// The beginnings of all lines of a module's sources, so that a place is found without a search.
#[derive(Clone, Debug)]
pub struct Places<'m> {
    module: &'m Module,
    /// A source each: the offset of each line, in bytes.
    lines: Vec<Vec<usize>>,
}

impl<'m> Places<'m> {
    /// Reads the sources of a module once.
    #[must_use]
    pub fn new(module: &'m Module) -> Self {
        let lines = module.sources.iter().map(|source| line_starts(&source.text)).collect();
        Self { module, lines }
    }

    /// The line and column, from 1, of an instruction's source, with the file's name.
    #[must_use]
    pub fn of(&self, pc: u32) -> Option<(&'m str, usize, usize)> {
        let entry = self.module.source_at(pc)?;
        self.position(entry.file, entry.start)
    }

    /// The line and column, from 1, of where the program speaks of something, with the file's name.
    #[must_use]
    pub fn of_mention(&self, mention: &Mention) -> Option<(&'m str, usize, usize)> {
        self.position(mention.file, mention.start)
    }

    fn position(&self, file: u16, start: u32) -> Option<(&'m str, usize, usize)> {
        let source = self.module.sources.get(usize::from(file))?;
        let starts = self.lines.get(usize::from(file))?;
        let before = source.text.get(..start as usize)?;
        let line = starts.partition_point(|&begin| begin <= before.len());
        let begin = starts[line - 1];
        Some((&source.name, line, before[begin..].chars().count() + 1))
    }
}

/// The offset of each line of a text: a line ends with LF, CR LF or CR, as in the sources that
/// diagnostics are of.
fn line_starts(text: &str) -> Vec<usize> {
    let text = text.as_bytes();
    let ends_line = |at: &usize| match text[*at] {
        b'\n' => true,
        b'\r' => text.get(at + 1) != Some(&b'\n'),
        _ => false,
    };
    let ends = (0..text.len()).filter(ends_line);
    std::iter::once(0).chain(ends.map(|at| at + 1)).collect()
}
