//! Places as editors count them: lines from 0, and in a line UTF-16 code units. It knows one text.

use lsp_types::{Position, Range};
use obverse_syntax::span::Span;

/// Where the lines of a text begin. A line ends with LF, CR LF or CR.
#[derive(Clone, Debug)]
pub(crate) struct Lines {
    /// The offset of the first byte of each line; the first is 0.
    starts: Vec<u32>,
}

impl Lines {
    /// Those of a text.
    pub(crate) fn new(text: &str) -> Self {
        let bytes = text.as_bytes();
        let ends_line = |at: &usize| match bytes[*at] {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        let starts = (0..bytes.len()).filter(ends_line).map(|at| offset(at + 1));
        Self { starts: std::iter::once(0).chain(starts).collect() }
    }

    /// The place of an offset; beyond the end it is the end, within a letter the letter's.
    pub(crate) fn position(&self, text: &str, offset: u32) -> Position {
        let end = boundary(text, offset as usize);
        let line = self.line_of(offset);
        let begin = (self.starts[line] as usize).min(end);
        let units = text[begin..end].encode_utf16().count();
        Position::new(line as u32, units as u32)
    }

    /// The line of an offset, from 0.
    pub(crate) fn line_of(&self, offset: u32) -> usize {
        self.starts.partition_point(|&start| start <= offset).saturating_sub(1)
    }

    /// The place of a span.
    pub(crate) fn range(&self, text: &str, span: Span) -> Range {
        Range::new(self.position(text, span.start), self.position(text, span.end))
    }

    /// The offset of a place. Beyond the end of a line it is the end of the line, and beyond the
    /// last line the end of the text.
    pub(crate) fn offset(&self, text: &str, position: Position) -> u32 {
        let Some(&start) = self.starts.get(position.line as usize) else {
            return offset(text.len());
        };
        let line = self.line(text, position.line as usize);
        let mut units = position.character as usize;
        for (at, c) in line.char_indices() {
            let width = c.len_utf16();
            if units < width {
                return start + offset(at);
            }
            units -= width;
        }
        start + offset(line.len())
    }

    /// A line, without its end.
    pub(crate) fn line<'t>(&self, text: &'t str, line: usize) -> &'t str {
        let Some(&start) = self.starts.get(line) else { return "" };
        let end = self.starts.get(line + 1).map_or(text.len(), |next| *next as usize);
        text.get(start as usize..end).unwrap_or("").trim_end_matches(['\r', '\n'])
    }

    /// The offset at which a line ends, before what ends it.
    pub(crate) fn end_of(&self, text: &str, line: usize) -> u32 {
        self.starts
            .get(line)
            .map_or(offset(text.len()), |start| start + offset(self.line(text, line).len()))
    }
}

/// Texts are at most as long as offsets go.
fn offset(bytes: usize) -> u32 {
    u32::try_from(bytes).unwrap_or(u32::MAX)
}

/// The last beginning of a letter that is not behind an offset, or the end.
pub(crate) fn boundary(text: &str, offset: usize) -> usize {
    let offset = offset.min(text.len());
    (0..=offset).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

/// Put a text in the place of a range of another.
pub(crate) fn replace(text: &mut String, range: Range, new: &str) {
    let lines = Lines::new(text);
    let (start, end) = (lines.offset(text, range.start), lines.offset(text, range.end));
    text.replace_range(start as usize..end.max(start) as usize, new);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_letter_beyond_the_first_plane_counts_as_two() {
        let text = "a\u{1F916}b\r\nä";
        let lines = Lines::new(text);
        assert_eq!(lines.position(text, 5), Position::new(0, 3));
        assert_eq!(lines.offset(text, Position::new(0, 3)), 5);
        // Within the pair: the letter.
        assert_eq!(lines.offset(text, Position::new(0, 2)), 1);
        assert_eq!(lines.position(text, 8), Position::new(1, 0));
        assert_eq!(lines.position(text, 10), Position::new(1, 1));
    }

    #[test]
    fn what_is_beyond_an_end_is_the_end() {
        let text = "one\rtwo\n";
        let lines = Lines::new(text);
        assert_eq!(lines.offset(text, Position::new(0, 99)), 3);
        assert_eq!(lines.offset(text, Position::new(1, 99)), 7);
        assert_eq!(lines.offset(text, Position::new(2, 5)), 8);
        assert_eq!(lines.offset(text, Position::new(u32::MAX, u32::MAX)), 8);
        assert_eq!(lines.position(text, u32::MAX), Position::new(2, 0));
        assert_eq!((lines.line(text, 1), lines.line(text, 7)), ("two", ""));
        assert_eq!((lines.end_of(text, 1), lines.end_of(text, 7)), (7, 8));
    }

    #[test]
    fn a_range_is_replaced_whichever_way_round_it_is() {
        let mut text = "move to a\n".to_owned();
        replace(&mut text, Range::new(Position::new(0, 8), Position::new(0, 9)), "home");
        assert_eq!(text, "move to home\n");
        replace(&mut text, Range::new(Position::new(0, 4), Position::new(0, 0)), "!");
        assert_eq!(text, "move! to home\n");
    }
}
