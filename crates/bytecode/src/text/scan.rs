//! One line of assembly text, token by token, with the place of what is wrong. Knows nothing of
//! what lines mean.

use super::error::{AsmError, Wrong, none_of, shown};
use super::quote::{is_bare, unquote};
use super::words::{Word, parse_real};
use crate::code::ModuleCode;
use std::str::FromStr;

/// A piece of a line.
#[derive(Debug, PartialEq)]
pub(super) enum Token<'t> {
    /// A run of characters that are no space and mean nothing by themselves.
    Word(&'t str),
    /// What stands between quotes, without escapes.
    Text(String),
    Comma,
    Colon,
}

/// A token and the byte of its line where it begins.
#[derive(Debug)]
pub(super) struct Placed<T> {
    pub(super) at: usize,
    pub(super) value: T,
}

/// How far a line has been read.
#[derive(Clone, Debug)]
pub(super) struct Scanner<'t> {
    /// The number of the line, from 1.
    number: usize,
    line: &'t str,
    at: usize,
}

impl<'t> Scanner<'t> {
    pub(super) fn new(number: usize, line: &'t str) -> Self {
        Self { number, line, at: 0 }
    }

    /// The whole line behind a `|`, if it begins with one.
    pub(super) fn after_bar(&self) -> Option<&'t str> {
        self.line.trim_start().strip_prefix('|')
    }

    /// An error at a byte of this line.
    pub(super) fn error(&self, at: usize, wrong: impl Into<Wrong>) -> AsmError {
        let column = self.line.get(..at).map_or(0, |before| before.chars().count()) + 1;
        let Wrong { code, message } = wrong.into();
        AsmError { line: self.number, column, message, code }
    }

    /// An error where the scanner is.
    pub(super) fn error_here(&mut self, wrong: impl Into<Wrong>) -> AsmError {
        self.skip_spaces();
        self.error(self.at, wrong)
    }

    fn skip_spaces(&mut self) {
        let rest = &self.line[self.at..];
        self.at += rest.len() - rest.trim_start().len();
    }

    /// The next token; `None` at the end of the line or at a comment.
    pub(super) fn token(&mut self) -> Result<Option<Placed<Token<'t>>>, AsmError> {
        self.skip_spaces();
        let (at, rest) = (self.at, &self.line[self.at..]);
        let (value, width) = match rest.bytes().next() {
            None | Some(b';') => return Ok(None),
            Some(b',') => (Token::Comma, 1),
            Some(b':') => (Token::Colon, 1),
            Some(b'"') => match unquote(rest) {
                Ok((text, width)) => (Token::Text(text), width),
                Err(error) => return Err(self.error(at + error.at, error.why)),
            },
            Some(_) => {
                let ends = |c: char| c.is_whitespace() || matches!(c, ',' | ':' | ';' | '"');
                let width = rest.find(ends).unwrap_or(rest.len());
                (Token::Word(&rest[..width]), width)
            }
        };
        self.at += width;
        Ok(Some(Placed { at, value }))
    }

    /// Whether a colon comes next, which is then taken.
    pub(super) fn takes_colon(&mut self) -> bool {
        let is_colon = self.line[self.at..].starts_with(':');
        self.at += usize::from(is_colon);
        is_colon
    }

    /// That nothing follows.
    pub(super) fn end(&mut self) -> Result<(), AsmError> {
        match self.token()? {
            None => Ok(()),
            Some(token) => Err(self.error(token.at, format!("the line should end before {token}"))),
        }
    }

    /// The next word, if there is one.
    pub(super) fn optional_word(
        &mut self,
        what: &str,
    ) -> Result<Option<Placed<&'t str>>, AsmError> {
        match self.token()? {
            None => Ok(None),
            Some(Placed { at, value: Token::Word(value) }) => Ok(Some(Placed { at, value })),
            Some(token) => Err(self.error(token.at, format!("{token} is no {what}"))),
        }
    }

    /// The next word.
    pub(super) fn word(&mut self, what: &str) -> Result<Placed<&'t str>, AsmError> {
        let word = self.optional_word(what)?;
        word.ok_or_else(|| self.error_here(format!("the {what} is missing")))
    }

    /// A name that is declared: a word or quoted text.
    pub(super) fn name(&mut self, what: &str) -> Result<String, AsmError> {
        match self.token()? {
            Some(Placed { value: Token::Text(text), .. }) => Ok(text),
            Some(Placed { value: Token::Word(word), .. }) if is_bare(word) => Ok(word.to_owned()),
            Some(token) => {
                let message = format!("{token} is no {what}; a name that is no word needs quotes");
                Err(self.error(token.at, message))
            }
            None => Err(self.error_here(format!("the {what} is missing"))),
        }
    }

    /// One of a few words.
    pub(super) fn one_of<T: Word>(&mut self) -> Result<T, AsmError> {
        let word = self.word(T::WHAT)?;
        let choices = || T::ALL.iter().map(|choice| choice.word());
        T::from_word(word.value)
            .ok_or_else(|| self.error(word.at, none_of(T::WHAT, word.value, choices())))
    }

    /// A number of a type.
    pub(super) fn number<T: FromStr + Limits>(&mut self, what: &str) -> Result<T, AsmError> {
        let word = self.word(what)?;
        word.value.parse().map_err(|_| {
            let (value, least, most) = (shown(word.value), T::LEAST, T::MOST);
            let message = format!("{value} is no {what}: a number from {least} to {most}");
            self.error(word.at, Wrong::new(ModuleCode::Number, message))
        })
    }

    /// A real.
    pub(super) fn real(&mut self, what: &str) -> Result<f64, AsmError> {
        let word = self.word(what)?;
        parse_real(word.value).ok_or_else(|| {
            let message = format!(
                "{} is no {what}: a decimal number, or 0x and the bits of one",
                shown(word.value)
            );
            self.error(word.at, Wrong::new(ModuleCode::Number, message))
        })
    }

    /// So many reals.
    pub(super) fn reals<const N: usize>(&mut self, what: &str) -> Result<[f64; N], AsmError> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.real(what)?;
        }
        Ok(values)
    }
}

impl std::fmt::Display for Placed<Token<'_>> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&match &self.value {
            Token::Word(word) => shown(word),
            Token::Text(text) => shown(&format!("\"{text}\"")),
            Token::Comma => shown(","),
            Token::Colon => shown(":"),
        })
    }
}

/// The range of a number, for messages.
pub(super) trait Limits {
    const LEAST: i64;
    const MOST: i64;
}

macro_rules! limits {
    ($($type:ident)*) => {$(
        impl Limits for $type {
            const LEAST: i64 = $type::MIN as i64;
            const MOST: i64 = $type::MAX as i64;
        }
    )*};
}

limits! { i8 u8 u16 u32 i64 }

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(line: &str) -> Vec<(usize, Token<'_>)> {
        let mut scanner = Scanner::new(1, line);
        let mut found = Vec::new();
        while let Some(Placed { at, value }) = scanner.token().unwrap() {
            found.push((at, value));
        }
        found
    }

    #[test]
    fn a_line_is_words_texts_and_marks() {
        let expected = vec![
            (0, Token::Word("top")),
            (3, Token::Colon),
            (5, Token::Word("move.item")),
            (15, Token::Text("a;b".to_owned())),
            (20, Token::Comma),
            (22, Token::Word("#7")),
        ];
        assert_eq!(tokens("top: move.item \"a;b\", #7 ; comment, \""), expected);
        assert_eq!(tokens("   "), vec![]);
        assert_eq!(tokens("a;b"), vec![(0, Token::Word("a"))]);
    }

    #[test]
    fn columns_are_characters() {
        let mut scanner = Scanner::new(7, "\"\u{fc}\u{fc}\" x");
        scanner.token().unwrap();
        let error = scanner.end().unwrap_err();
        assert_eq!((error.line, error.column), (7, 6));
    }

    #[test]
    fn numbers_say_their_range() {
        let error = Scanner::new(1, " 256").number::<u8>("count").unwrap_err();
        assert_eq!(error.column, 2);
        assert_eq!(error.message, "`256` is no count: a number from 0 to 255");
    }
}
