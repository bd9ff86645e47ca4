//! Lines of the output: blank lines, comments behind lines, and the alignment of lines that follow
//! each other.

use super::MAX_COLUMNS;
use super::piece::Column;
use std::collections::BTreeSet;

/// A line of code or a comment.
pub(super) struct Line<'s> {
    indent: usize,
    /// Its parts, with a blank between, and where they are aligned.
    cells: Vec<(Column, String)>,
    key: Key,
    /// The comment behind it.
    comment: Option<&'s str>,
}

/// With which of its neighbours a line is aligned: those with an equal key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Key {
    /// With none.
    Alone,
    /// With lines that begin with the same word.
    Word(String),
    /// With the other lines of a table.
    Table(usize),
}

impl Key {
    pub(super) fn word(word: &str) -> Self {
        Self::Word(word.to_owned())
    }
}

impl<'s> Line<'s> {
    pub(super) fn new(indent: usize, cells: Vec<(Column, String)>, key: Key) -> Self {
        Self { indent, cells, key, comment: None }
    }

    fn is_blank(&self) -> bool {
        self.cells.is_empty()
    }

    fn width(&self) -> usize {
        let cells: usize = self.cells.iter().map(|(_, text)| text.chars().count() + 1).sum();
        self.indent + cells.saturating_sub(1)
    }

    /// How far to the right of its beginning a cell begins.
    fn offset(&self, column: Column) -> Option<usize> {
        let index = self.cells.iter().position(|cell| cell.0 == column)?;
        Some(self.cells[..index].iter().map(|(_, text)| text.chars().count() + 1).sum())
    }

    /// Has a cell begin further to the right.
    fn pad(&mut self, column: Column, offset: usize) {
        let Some(missing) = self.offset(column).and_then(|own| offset.checked_sub(own)) else {
            return;
        };
        let index = self.cells.iter().position(|cell| cell.0 == column);
        if let Some(before) = index.and_then(|index| self.cells.get_mut(index.checked_sub(1)?)) {
            before.1.extend(std::iter::repeat_n(' ', missing));
        }
    }

    fn write(&self, text: &mut String) {
        if !self.is_blank() {
            text.extend(std::iter::repeat_n(' ', self.indent));
        }
        for (index, (_, cell)) in self.cells.iter().enumerate() {
            if index > 0 {
                text.push(' ');
            }
            text.push_str(cell);
        }
    }
}

/// The lines of a file.
#[derive(Default)]
pub(super) struct Lines<'s> {
    lines: Vec<Line<'s>>,
    /// Whether the last line opened a block.
    is_at_start: bool,
}

impl<'s> Lines<'s> {
    pub(super) fn push(&mut self, line: Line<'s>) {
        self.lines.push(line);
        self.is_at_start = false;
    }

    /// A blank line, but not a second one, nor where a file or block begins.
    pub(super) fn blank(&mut self) {
        let is_useful = self.lines.last().is_some_and(|line| !line.is_blank());
        if is_useful && !self.is_at_start {
            self.push(Line::new(0, Vec::new(), Key::Alone));
        }
    }

    /// The last line opens a block.
    pub(super) fn begin_block(&mut self) {
        self.is_at_start = true;
    }

    /// A comment behind the last line, if that has none; whether it is there.
    pub(super) fn trail(&mut self, comment: &'s str) -> bool {
        let line = self.lines.last_mut().filter(|line| line.comment.is_none() && !line.is_blank());
        line.map(|line| line.comment = Some(comment)).is_some()
    }

    /// All of it.
    pub(super) fn into_text(mut self) -> String {
        for run in self
            .lines
            .chunk_by_mut(|a, b| a.key == b.key && a.key != Key::Alone && a.indent == b.indent)
        {
            align(run);
        }
        let mut text = String::new();
        for run in self
            .lines
            .chunk_by(|a, b| a.comment.is_some() && b.comment.is_some() && a.indent == b.indent)
        {
            let column = run.iter().map(Line::width).max().unwrap_or(0) + 1;
            for line in run {
                line.write(&mut text);
                if let Some(comment) = line.comment {
                    text.extend(std::iter::repeat_n(' ', column - line.width()));
                    text.push_str(comment);
                }
                text.push('\n');
            }
        }
        text
    }
}

/// Aligns lines column by column, if none becomes too long by it.
fn align(run: &mut [Line<'_>]) {
    let columns: BTreeSet<Column> =
        run.iter().flat_map(|line| line.cells.iter().skip(1).map(|cell| cell.0)).collect();
    let before: Vec<Vec<usize>> =
        run.iter().map(|line| line.cells.iter().map(|cell| cell.1.len()).collect()).collect();
    for column in columns {
        let offset = run.iter().filter_map(|line| line.offset(column)).max().unwrap_or(0);
        run.iter_mut().for_each(|line| line.pad(column, offset));
    }
    if run.iter().any(|line| line.width() > MAX_COLUMNS) {
        for (line, lengths) in run.iter_mut().zip(before) {
            for (cell, length) in line.cells.iter_mut().zip(lengths) {
                cell.1.truncate(length);
            }
        }
    }
}
