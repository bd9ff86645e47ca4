//! The tokens of a text that has a mistake, read again: what stands around a place, and which
//! bracket is open there. It knows no grammar.

use crate::codes::Code;
use crate::diagnostic::Diagnostic;
use crate::span::Span;
use crate::token::Token;
use logos::Logos;

/// A token and its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    /// The token as it stands alone: numbers are not joined with units.
    pub(crate) token: Token,
    /// Where.
    pub(crate) span: Span,
}

/// All tokens of a text.
pub(crate) struct Surroundings<'s> {
    source: &'s str,
    tokens: Vec<Placed>,
}

impl<'s> Surroundings<'s> {
    /// Reads the text that begins at an offset.
    pub(crate) fn new(source: &'s str, start: usize) -> Self {
        let mut lexer = Token::lexer(source);
        lexer.bump(start);
        let tokens = lexer.spanned().filter_map(|(token, range)| {
            let span = Span::new(range.start as u32, range.end as u32);
            token.ok().map(|token| Placed { token, span })
        });
        Self { source, tokens: tokens.collect() }
    }

    /// The text of a span.
    pub(crate) fn text(&self, span: Span) -> &'s str {
        self.source.get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// The last token that begins before an offset.
    pub(crate) fn before(&self, offset: u32) -> Option<Placed> {
        self.until(offset).last().copied()
    }

    /// The first token that begins at an offset or after it.
    pub(crate) fn after(&self, offset: u32) -> Option<Placed> {
        self.tokens.get(self.until(offset).len()).copied()
    }

    /// The first two such tokens.
    pub(crate) fn two_after(&self, offset: u32) -> Option<[Placed; 2]> {
        let first = self.until(offset).len();
        self.tokens.get(first..first + 2)?.try_into().ok()
    }

    /// The tokens of the line of an offset that begin before it.
    pub(crate) fn line_before(&self, offset: u32) -> &[Placed] {
        let start = self.until(self.line_start(offset)).len();
        &self.until(offset)[start..]
    }

    /// What stands from an offset to the end of its line, without a comment.
    pub(crate) fn line_behind(&self, offset: u32) -> &'s str {
        let rest = self.source.get(offset as usize..).unwrap_or("");
        let line = rest.lines().next().unwrap_or("");
        line.split("//").next().unwrap_or("")
    }

    /// The word of the declaration that gives a name, if one at the top of the text does.
    pub(crate) fn declared_by(&self, name: &str) -> Option<Token> {
        let mut open = Vec::new();
        let mut before = None;
        for token in &self.tokens {
            let is_named = token.token.is_word() && self.text(token.span) == name;
            if open.is_empty() && is_named && before.is_some_and(declares) {
                return before;
            }
            follow(&mut open, *token);
            before = Some(token.token);
        }
        None
    }

    /// The name of the argument of a `call` that stands before an offset, behind its bracket or a
    /// comma.
    pub(crate) fn named_argument(&self, offset: u32) -> Option<Span> {
        let name = self.before(offset)?;
        let sign = self.before(name.span.start)?;
        let opening = self.innermost_open(offset)?;
        let called = self.before(opening.span.start)?;
        let verb = self.before(called.span.start)?;
        let is_first = matches!(sign.token, Token::OpenParenthesis | Token::Comma);
        let is_call = opening.token == Token::OpenParenthesis && verb.token == Token::Call;
        (is_first && is_call && name.token.is_word()).then_some(name.span)
    }

    /// Whether nothing but blanks stands before an offset on its line.
    pub(crate) fn begins_line(&self, offset: u32) -> bool {
        self.indentation(offset).len() as u32 == offset - self.line_start(offset)
    }

    /// The innermost bracket that is open at an offset.
    pub(crate) fn innermost_open(&self, offset: u32) -> Option<Placed> {
        let mut open = Vec::new();
        for token in self.until(offset) {
            follow(&mut open, *token);
        }
        open.last().copied()
    }

    /// The bracket that the one at this place closes.
    pub(crate) fn opening_of(&self, closing: Span) -> Option<Placed> {
        let mut open = Vec::new();
        let mut closed = None;
        for token in self.until(closing.start + 1) {
            closed = follow(&mut open, *token).filter(|_| token.span == closing);
        }
        closed
    }

    /// The bracket that probably lacks its closing one, if the text ends with brackets open. It is
    /// the one whose closing bracket begins a line that is indented otherwise than its own, since
    /// that one was meant for another; or else the innermost.
    pub(crate) fn likely_unclosed(&self) -> Option<Span> {
        let mut open = Vec::new();
        let mut suspect = None;
        for token in &self.tokens {
            let closed = follow(&mut open, *token);
            let Some(opening) = closed else { continue };
            let (opened, closed) = (opening.span.start, token.span.start);
            let is_other_line = self.line_start(opened) != self.line_start(closed);
            if suspect.is_none()
                && is_other_line
                && self.begins_line(closed)
                && self.indentation(opened) != self.indentation(closed)
            {
                suspect = Some(opening.span);
            }
        }
        let innermost = open.last()?.span;
        Some(suspect.unwrap_or(innermost))
    }

    /// The closing brace before an offset that is probably one too many: it begins a line that is
    /// indented otherwise than that of the one it closes.
    pub(crate) fn likely_too_many(&self, offset: u32) -> Option<Span> {
        let mut open = Vec::new();
        for token in self.until(offset) {
            let Some(opening) = follow(&mut open, *token) else { continue };
            let (opened, closed) = (opening.span.start, token.span.start);
            let is_other_line = self.line_start(opened) != self.line_start(closed);
            let is_odd = self.indentation(opened) != self.indentation(closed);
            if is_other_line && self.begins_line(closed) && is_odd {
                return Some(token.span);
            }
        }
        None
    }

    /// What is said of the bracket that probably lacks its closing one, at the end of the text.
    pub(crate) fn unclosed_at(&self, end: u32) -> Option<Diagnostic> {
        let opening = self.likely_unclosed()?;
        let message = format!("this `{}` is not closed", self.text(opening));
        let diagnostic = Diagnostic::error(Code::UnclosedBracket, opening, message, "opened here");
        Some(diagnostic.with_label(Span::new(end, end), "the file ends here"))
    }

    fn until(&self, offset: u32) -> &[Placed] {
        &self.tokens[..self.tokens.partition_point(|token| token.span.start < offset)]
    }

    fn line_start(&self, offset: u32) -> u32 {
        let before = self.source.as_bytes().get(..offset as usize).unwrap_or_default();
        before.iter().rposition(|byte| matches!(byte, b'\n' | b'\r')).map_or(0, |at| at as u32 + 1)
    }

    /// The blanks that the line of an offset begins with, as far as the offset.
    fn indentation(&self, offset: u32) -> &'s str {
        let line = self.text(Span::new(self.line_start(offset), offset));
        &line[..line.len() - line.trim_start_matches([' ', '\t']).len()]
    }
}

/// A piece of source for a message: its first line, and not too much of it.
pub(crate) fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    let line = text.lines().next().unwrap_or("");
    match line.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}..", &line[..end]),
        None => line.to_owned(),
    }
}

/// Whether the name of what is declared follows a word; of `advanced move NAME` it is `move`.
fn declares(word: Token) -> bool {
    use Token::{Action, Error, Input, Io, Item, Joints, Move, Output, Sequence, Var};
    matches!(word, Action | Error | Input | Io | Item | Joints | Move | Output | Sequence | Var)
}

/// Keeps account of the open brackets; gives the one that the token closes. A bracket of another
/// kind in between is given up, but no block for a `)` or `]`.
fn follow(open: &mut Vec<Placed>, token: Placed) -> Option<Placed> {
    let opening = match token.token {
        Token::OpenBrace | Token::OpenParenthesis | Token::OpenBracket => {
            open.push(token);
            return None;
        }
        Token::CloseBrace => Token::OpenBrace,
        Token::CloseParenthesis => Token::OpenParenthesis,
        Token::CloseBracket => Token::OpenBracket,
        _ => return None,
    };
    let nearest =
        open.iter().rposition(|one| one.token == opening || one.token == Token::OpenBrace)?;
    let closed = open.get(nearest).copied().filter(|one| one.token == opening)?;
    open.truncate(nearest);
    Some(closed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_innermost_open_bracket_is_found() {
        let surroundings = Surroundings::new("a { ( b ) [ c } d", 0);
        let at = |offset| surroundings.innermost_open(offset).map(|token| token.span.start);
        assert_eq!(at(0), None);
        assert_eq!(at(7), Some(4));
        assert_eq!(at(9), Some(2));
        assert_eq!(at(13), Some(10));
        assert_eq!(at(16), None);
    }

    #[test]
    fn indentation_tells_the_bracket_that_is_not_closed() {
        let unclosed =
            |source| Surroundings::new(source, 0).likely_unclosed().map(|span| span.start);
        assert_eq!(unclosed("a {\n  b {\n    c\n  d {\n  }\n}\n"), Some(8));
        assert_eq!(unclosed("a {\n  b {\n  }\n"), Some(2));
        assert_eq!(unclosed("a { b }"), None);
    }
}
