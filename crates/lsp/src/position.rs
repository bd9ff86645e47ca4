//! Places as editors count them: lines from 0, and in a line UTF-16 code units. It knows one text.

use lsp_types::{Position, Range};
use obverse_syntax::span::Span;

/// Where the lines of a text begin, and its letters that have more bytes than code units. A line
/// ends with LF, CR LF or CR.
#[derive(Clone, Debug)]
pub(crate) struct Lines {
    /// The offset of the first byte of each line; the first is 0.
    starts: Vec<u32>,
    /// Behind each letter that has more than one byte: the offset, and how many bytes there are up
    /// to there more than code units.
    wide: Vec<(u32, u32)>,
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
        let starts = std::iter::once(0).chain(starts).collect();
        let mut surplus = 0;
        let is_wide = |(_, c): &(usize, char)| c.len_utf8() > 1;
        let wide = text.char_indices().filter(is_wide).map(|(at, c)| {
            surplus += offset(c.len_utf8() - c.len_utf16());
            (offset(at + c.len_utf8()), surplus)
        });
        Self { starts, wide: wide.collect() }
    }

    /// How many code units there are up to an offset.
    fn units(&self, offset: u32) -> u32 {
        let before = self.wide.partition_point(|(behind, _)| *behind <= offset);
        let surplus = before.checked_sub(1).map_or(0, |last| self.wide[last].1);
        offset - surplus
    }

    /// The place of an offset; beyond the end it is the end, within a letter the letter's.
    pub(crate) fn position(&self, text: &str, at: u32) -> Position {
        let end = offset(boundary(text, at as usize));
        let line = self.line_of(end);
        let start = self.starts[line].min(end);
        Position::new(line as u32, self.units(end) - self.units(start))
    }

    /// The line of an offset, from 0.
    pub(crate) fn line_of(&self, offset: u32) -> usize {
        self.starts.partition_point(|&start| start <= offset).saturating_sub(1)
    }

    /// The offset of a letter of a line, both from 1; beyond the end it is the end.
    pub(crate) fn offset_of(&self, text: &str, line: usize, column: usize) -> u32 {
        let start = line.checked_sub(1).and_then(|line| self.starts.get(line)).copied();
        let start = start.unwrap_or(offset(text.len()));
        let rest = &text[start as usize..];
        let before = rest.chars().take(column.saturating_sub(1)).map(char::len_utf8).sum();
        start + offset(before)
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
        let end = start + offset(self.line(text, position.line as usize).len());
        let wanted = self.units(start).saturating_add(position.character);
        let (mut least, mut most) = (start, end);
        while least < most {
            let middle = least + (most - least).div_ceil(2);
            // Within a letter as many as before it.
            let whole = offset(boundary(text, middle as usize));
            match self.units(whole) <= wanted {
                true => least = middle,
                false => most = middle - 1,
            }
        }
        offset(boundary(text, least as usize))
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

    /// Letter by letter, against what the standard library counts.
    #[test]
    fn offsets_and_positions_are_each_others_inverse() {
        let text = "aä\u{1F916}b\n\u{1F916}\u{1F916}ö\r\nend€";
        let lines = Lines::new(text);
        for (at, _) in text.char_indices().chain([(text.len(), ' ')]) {
            let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
            let line = text[..at].matches('\n').count() as u32;
            let units = text[start..at].encode_utf16().count() as u32;
            let position = lines.position(text, at as u32);
            assert_eq!(position, Position::new(line, units), "at {at}");
            let is_line_end = text[..at].ends_with('\r');
            assert!(is_line_end || lines.offset(text, position) == at as u32, "at {at}");
        }
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
