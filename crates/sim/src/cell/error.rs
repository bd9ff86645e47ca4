//! What is wrong with a workcell file, and where.

use super::CellCode;
use std::fmt;

/// Why a workcell file was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellError {
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
    /// What is wrong there.
    pub message: String,
    /// Its kind.
    pub code: CellCode,
}

impl CellError {
    /// An error at a byte of the text: a contradiction, unless it is said to be of another kind.
    pub(super) fn at(text: &str, byte: usize, message: impl Into<String>) -> Self {
        let before = text.get(..byte).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Self {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            message: message.into(),
            code: CellCode::Contradiction,
        }
    }

    /// The same, of this kind.
    pub(super) fn of(self, code: CellCode) -> Self {
        Self { code, ..self }
    }
}

impl fmt::Display for CellError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.message)
    }
}

impl std::error::Error for CellError {}
