//! What is wrong with a text, and how it is said.

use super::nearest::nearest;
use super::quote::excerpt;
use crate::code::ModuleCode;
use std::fmt;

/// The most errors that are reported of one text.
pub const MAX_ERRORS: usize = 32;

/// Why a text is no module.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct AsmError {
    /// The line, from 1.
    pub line: usize,
    /// The character in the line, from 1.
    pub column: usize,
    /// What is wrong, and what to do.
    pub message: String,
    /// Its kind.
    pub code: ModuleCode,
}

/// What is wrong, before it has a place.
#[derive(Clone, Debug)]
pub(super) struct Wrong {
    pub(super) code: ModuleCode,
    pub(super) message: String,
}

impl Wrong {
    pub(super) fn new(code: ModuleCode, message: impl Into<String>) -> Self {
        Self { code, message: message.into() }
    }

    /// With more to say.
    pub(super) fn and(mut self, more: &str) -> Self {
        self.message += more;
        self
    }
}

impl From<String> for Wrong {
    fn from(message: String) -> Self {
        Self::new(ModuleCode::Form, message)
    }
}

impl From<&str> for Wrong {
    fn from(message: &str) -> Self {
        Self::new(ModuleCode::Form, message)
    }
}

impl fmt::Display for AsmError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.message)
    }
}

impl std::error::Error for AsmError {}

/// The errors found so far, no more than [`MAX_ERRORS`].
#[derive(Debug, Default)]
pub(super) struct Errors(Vec<AsmError>);

impl Errors {
    pub(super) fn add(&mut self, error: AsmError) {
        if !self.is_full() {
            self.0.push(error);
        }
    }

    /// Note what is wrong and go on with the rest.
    pub(super) fn keep<T>(&mut self, result: Result<T, AsmError>) -> Option<T> {
        result.map_err(|error| self.add(error)).ok()
    }

    pub(super) fn is_full(&self) -> bool {
        self.0.len() >= MAX_ERRORS
    }

    /// All of them in the order of the text, if there are any.
    pub(super) fn finish(mut self) -> Result<(), Vec<AsmError>> {
        self.0.sort();
        if self.0.is_empty() { Ok(()) } else { Err(self.0) }
    }
}

/// A word of the text, as it is named in a message.
pub(super) fn shown(word: &str) -> String {
    format!("`{}`", excerpt(word))
}

/// That nothing of a kind has this name, and which one was probably meant.
pub(super) fn unknown<'c>(
    what: &str,
    word: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Wrong {
    let nearest = nearest(word, candidates)
        .map(|name| format!("; the nearest is {}", shown(name)))
        .unwrap_or_default();
    let message = format!("there is no {what} {}{nearest}", shown(word));
    Wrong::new(ModuleCode::UnknownWord, message)
}

/// That a word is none of a few, and which these are.
pub(super) fn none_of<'c>(
    what: &str,
    word: &str,
    choices: impl IntoIterator<Item = &'c str>,
) -> Wrong {
    let choices = choices.into_iter().collect::<Vec<_>>().join(", ");
    let message = format!("{} is no {what}; there are {choices}", shown(word));
    Wrong::new(ModuleCode::UnknownWord, message)
}
