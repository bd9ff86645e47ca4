//! Offsets to lines and columns, for one source text. It does not know what the text means.

use crate::span::Span;

/// Where the lines of a source text begin. A line ends with LF, CR LF or CR.
#[derive(Clone, Debug)]
pub struct LineIndex<'s> {
    source: &'s str,
    /// The offset of the first byte of each line; the first is 0.
    starts: Vec<u32>,
}

/// A place for people: both numbers begin at 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Position {
    /// The line.
    pub line: u32,
    /// The column, in characters.
    pub column: u32,
}

impl std::fmt::Display for Position {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{}:{}", self.line, self.column)
    }
}

impl<'s> LineIndex<'s> {
    /// Reads the text once. Offsets beyond `u32` are not indexed: such texts are refused anyway.
    #[must_use]
    pub fn new(source: &'s str) -> Self {
        let bytes = source.as_bytes();
        let mut starts = vec![0];
        for (offset, &byte) in bytes.iter().enumerate().take(u32::MAX as usize) {
            let ends = byte == b'\n' || byte == b'\r' && bytes.get(offset + 1) != Some(&b'\n');
            if ends {
                starts.push(offset as u32 + 1);
            }
        }
        Self { source, starts }
    }

    /// How many lines there are; an empty text has one.
    #[must_use]
    pub fn line_count(&self) -> usize {
        self.starts.len()
    }

    /// The line and column of an offset, in O(log lines + length of the line). An offset beyond the
    /// end is that of the end.
    #[must_use]
    pub fn position(&self, offset: u32) -> Position {
        let line = self.starts.partition_point(|&start| start <= offset);
        let start = self.starts[line - 1] as usize;
        let end = (offset as usize).min(self.source.len());
        let before = self.source.as_bytes().get(start..end).unwrap_or_default();
        // A character is counted at its first byte: bytes that go on are 0b10xx_xxxx.
        let characters = before.iter().filter(|&&byte| byte & 0xC0 != 0x80).count();
        Position { line: line as u32, column: characters as u32 + 1 }
    }

    /// The text of a line, counted from 1, without its end. Empty for a line that does not exist.
    #[must_use]
    pub fn line_text(&self, line: u32) -> &'s str {
        let Some(index) = (line as usize).checked_sub(1) else { return "" };
        let Some(&start) = self.starts.get(index) else { return "" };
        let end = self.starts.get(index + 1).map_or(self.source.len(), |&next| next as usize);
        self.source.get(start as usize..end).unwrap_or("").trim_end_matches(['\n', '\r'])
    }

    /// The text of a span; empty if it is not one of this source.
    #[must_use]
    pub fn text(&self, span: Span) -> &'s str {
        self.source.get(span.start as usize..span.end as usize).unwrap_or("")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_end_counts_once() {
        let index = LineIndex::new("ab\ncd\r\nef\rgh\n");
        let lines: Vec<&str> = (1..=5).map(|line| index.line_text(line)).collect();
        assert_eq!(lines, ["ab", "cd", "ef", "gh", ""]);
        assert_eq!(index.line_count(), 5);
        assert_eq!(index.line_text(0), "");
        assert_eq!(index.line_text(6), "");
    }

    #[test]
    fn columns_are_characters_from_one() {
        let index = LineIndex::new("äb\nc");
        assert_eq!(index.position(0), Position { line: 1, column: 1 });
        assert_eq!(index.position(2), Position { line: 1, column: 2 });
        assert_eq!(index.position(4), Position { line: 2, column: 1 });
        assert_eq!(index.position(5), Position { line: 2, column: 2 });
    }

    #[test]
    fn an_offset_beyond_the_end_is_the_end() {
        assert_eq!(LineIndex::new("ab").position(99), Position { line: 1, column: 3 });
        assert_eq!(LineIndex::new("").position(0), Position { line: 1, column: 1 });
    }
}
