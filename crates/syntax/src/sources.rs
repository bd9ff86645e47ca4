//! The source files of one program in one space of positions: each file begins where the one
//! before it ends, so that a [`Span`] says which file it is in. It knows neither how files are
//! found nor what is in them.

use crate::MAX_SOURCE_BYTES;
use crate::source::{LineIndex, Position};
use crate::span::Span;

/// The texts of a program, one after another. The first file is the one that was asked for.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// All texts, a line end behind each, so that none can run on into the next.
    whole: String,
    files: Vec<File>,
}

#[derive(Clone, Debug)]
struct File {
    name: String,
    start: u32,
    end: u32,
}

/// A place within one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Which file.
    pub file: usize,
    /// Byte offsets from the beginning of that file.
    pub span: Span,
}

impl Sources {
    /// One file, which begins at position 0.
    #[must_use]
    pub fn one(name: &str, text: &str) -> Self {
        let mut sources = Self::default();
        sources.push(name, text);
        sources
    }

    /// A further file, and its index; none if the texts would have more than
    /// [`MAX_SOURCE_BYTES`] together.
    pub fn add(&mut self, name: &str, text: &str) -> Option<usize> {
        let has_room = self.whole.len().saturating_add(text.len()) < MAX_SOURCE_BYTES;
        has_room.then(|| self.push(name, text))
    }

    fn push(&mut self, name: &str, text: &str) -> usize {
        // A text beyond the positions is refused before anything is read of it.
        let position = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        let start = position(self.whole.len());
        self.whole.push_str(text);
        let end = position(self.whole.len());
        self.whole.push('\n');
        self.files.push(File { name: name.to_owned(), start, end });
        self.files.len() - 1
    }

    /// How many files there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// The name of a file; empty if there is no such file.
    #[must_use]
    pub fn name(&self, file: usize) -> &str {
        self.files.get(file).map_or("", |file| &file.name)
    }

    /// The text of a file; empty if there is no such file.
    #[must_use]
    pub fn text(&self, file: usize) -> &str {
        self.whole.get(self.range(file)).unwrap_or("")
    }

    /// The positions of a file.
    #[must_use]
    pub fn range(&self, file: usize) -> std::ops::Range<usize> {
        self.files.get(file).map_or(0..0, |file| file.start as usize..file.end as usize)
    }

    /// All texts, so that a span is a range of them.
    #[must_use]
    pub fn whole(&self) -> &str {
        &self.whole
    }

    /// Which file a span is in, and where there. Beyond the end is the end of the last file.
    #[must_use]
    pub fn locate(&self, span: Span) -> Place {
        let after = self.files.partition_point(|file| file.start <= span.start);
        let index = after.saturating_sub(1);
        let Some(file) = self.files.get(index) else { return Place { file: 0, span } };
        let within = |offset: u32| offset.clamp(file.start, file.end) - file.start;
        Place { file: index, span: Span::new(within(span.start), within(span.end)) }
    }

    /// The name of the file that a span begins in, and its line and column there. In O(length of
    /// the file): where many are wanted, make a [`LineIndex`] of the file.
    #[must_use]
    pub fn position(&self, span: Span) -> (&str, Position) {
        let place = self.locate(span);
        (self.name(place.file), LineIndex::new(self.text(place.file)).position(place.span.start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(file: usize, start: u32, end: u32) -> Place {
        Place { file, span: Span::new(start, end) }
    }

    #[test]
    fn every_position_is_in_one_file() {
        let mut sources = Sources::one("a", "one");
        assert_eq!((sources.add("b", ""), sources.add("c", "x\ny")), (Some(1), Some(2)));
        assert_eq!(sources.len(), 3);
        assert_eq!(sources.locate(Span::new(0, 3)), place(0, 0, 3));
        // The end of a file is not the beginning of the next.
        assert_eq!(sources.locate(Span::new(3, 3)), place(0, 3, 3));
        assert_eq!(sources.locate(Span::new(4, 4)), place(1, 0, 0));
        assert_eq!(sources.locate(Span::new(7, 8)), place(2, 2, 3));
        assert_eq!(sources.locate(Span::new(90, 99)), place(2, 3, 3));
        assert_eq!(sources.position(Span::new(7, 8)), ("c", Position { line: 2, column: 1 }));
        let texts = [0, 1, 2, 3].map(|file| (sources.name(file), sources.text(file)));
        assert_eq!(texts, [("a", "one"), ("b", ""), ("c", "x\ny"), ("", "")]);
        assert_eq!(&sources.whole()[sources.range(2)], "x\ny");
    }

    #[test]
    fn without_a_file_there_is_no_text() {
        let sources = Sources::default();
        assert!(sources.is_empty());
        assert_eq!(sources.locate(Span::new(3, 4)), place(0, 3, 4));
        assert_eq!(sources.position(Span::default()), ("", Position { line: 1, column: 1 }));
    }
}
