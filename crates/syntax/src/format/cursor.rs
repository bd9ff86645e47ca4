//! The tokens of a source text in order, with the comments and line ends between them. It knows no
//! grammar.

use super::piece::{Comment, Gap};
use crate::lexer::Lexer;
use crate::sink::Sink;
use crate::token::Token;
use crate::tree;
use std::borrow::Cow;

/// A place in a row of tokens.
pub(super) struct Cursor<'s> {
    source: &'s str,
    tokens: Vec<(u32, Token, u32)>,
    next: usize,
    /// The end of the token before.
    end: u32,
    /// What stood before tokens that were left out.
    before: Gap<'s>,
}

impl<'s> Cursor<'s> {
    /// At the beginning of a text without mistakes.
    pub(super) fn new(source: &'s str) -> Self {
        let sink = Sink::default();
        // That a token has been read is all that is built here.
        let tokens = Lexer::new(source, 0, &sink).inspect(|_| sink.built());
        let tokens = tokens.map_while(Result::ok).collect();
        let end = if source.starts_with('\u{FEFF}') { '\u{FEFF}'.len_utf8() as u32 } else { 0 };
        Self { source, tokens, next: 0, end, before: Gap::default() }
    }

    /// How many tokens in a row, from the next on and before a place, are this one.
    pub(super) fn count(&self, text: &str, before: u32) -> usize {
        let is_it = |&&(start, _, end): &&(u32, Token, u32)| {
            start < before && tree::text(self.source, start, end) == text
        };
        self.tokens[self.next..].iter().take_while(is_it).count()
    }

    /// Where the next token begins.
    fn offset(&self) -> u32 {
        self.tokens.get(self.next).map_or(self.source.len() as u32, |&(start, ..)| start)
    }

    /// The next token as written; empty at the end.
    pub(super) fn peek(&self) -> &'s str {
        self.tokens
            .get(self.next)
            .map_or("", |&(start, _, end)| tree::text(self.source, start, end))
    }

    /// The next token, a blank between a number and its unit; and what stands before it. Nothing
    /// but that at the end.
    pub(super) fn take(&mut self) -> (Cow<'s, str>, Gap<'s>) {
        let gap = self.gap();
        let Some(&(start, token, end)) = self.tokens.get(self.next) else {
            return (Cow::Borrowed(""), gap);
        };
        self.next += 1;
        self.end = end;
        let text = tree::text(self.source, start, end);
        let text = match token {
            Token::Quantity => {
                let (number, unit) = tree::split_quantity(text);
                Cow::Owned(format!("{number} {unit}"))
            }
            _ => Cow::Borrowed(text),
        };
        (text, gap)
    }

    /// Leaves out the next token if it is this one, but not what stands before it; whether it was.
    pub(super) fn skip(&mut self, text: &str) -> bool {
        let is_it = self.peek() == text;
        if is_it {
            let gap = self.gap();
            self.take();
            self.before = gap;
        }
        is_it
    }

    /// What stands before the next token, what was left out included.
    fn gap(&mut self) -> Gap<'s> {
        let gap = read_gap(tree::text(self.source, self.end, self.offset()));
        self.end = self.offset();
        join(std::mem::take(&mut self.before), gap)
    }
}

/// The gap of two with a token between that is left out.
fn join<'s>(mut first: Gap<'s>, mut second: Gap<'s>) -> Gap<'s> {
    if let Some(comment) = second.comments.first_mut() {
        comment.is_trailing &= first.comments.is_empty() && !first.has_newline;
        comment.is_apart |= first.has_blank_line;
    } else {
        second.has_blank_line |= first.has_blank_line;
    }
    second.has_newline |= first.has_newline;
    first.comments.append(&mut second.comments);
    Gap { comments: first.comments, ..second }
}

/// Reads blanks, line ends and comments.
fn read_gap(text: &str) -> Gap<'_> {
    let mut gap = Gap::default();
    let mut rest = text;
    loop {
        let word = rest.trim_ascii_start();
        let lines = line_ends(&rest[..rest.len() - word.len()]);
        gap.has_newline |= lines > 0;
        gap.has_blank_line = lines > 1;
        if !word.starts_with("//") {
            return gap;
        }
        let (comment, after) = word.split_at(word.find(['\r', '\n']).unwrap_or(word.len()));
        gap.comments.push(Comment {
            text: comment.trim_end_matches([' ', '\t']),
            is_trailing: lines == 0 && gap.comments.is_empty(),
            is_apart: lines > 1,
        });
        rest = after;
    }
}

/// How many lines end in a text: with LF, CR LF or CR.
fn line_ends(text: &str) -> usize {
    let bytes = text.as_bytes();
    let follows = |index: usize| index > 0 && bytes[index - 1] == b'\r';
    let ends = |(index, byte): (usize, &u8)| *byte == b'\r' || *byte == b'\n' && !follows(index);
    bytes.iter().enumerate().filter(|&one| ends(one)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_ends_of_every_kind_count_once() {
        assert_eq!(line_ends("\n \r\n\t\r \r\r"), 5);
    }

    #[test]
    fn comments_keep_their_places() {
        let gap = read_gap(" // a \n\n  // b\r\n // c\r\r");
        let comments: Vec<_> =
            gap.comments.iter().map(|c| (c.text, c.is_trailing, c.is_apart)).collect();
        assert_eq!(
            comments,
            [("// a", true, false), ("// b", false, true), ("// c", false, false)]
        );
        assert!(gap.has_newline && gap.has_blank_line);
    }
}
