//! The pieces that a text is made of, for showing it in colours: words, names, numbers, units,
//! texts, comments. It knows tokens and no grammar: a word that can be a name is told from one by
//! whoever knows where names stand.

use crate::ahead::{is_before_assignment, unit_length};
use crate::span::Span;
use crate::token::Token;
use logos::Logos;

/// What a piece of a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PieceKind {
    /// A word that cannot be a name.
    Reserved,
    /// Another word of the language, which may stand here as a name.
    Free,
    /// A name.
    Name,
    /// A number, without its unit.
    Number,
    /// The unit of a number or a vector.
    Unit,
    /// A text with its quotes.
    Text,
    /// A comment, without the end of its line.
    Comment,
    /// A sign of an operation or an assignment.
    Operator,
    /// A bracket, or a sign between parts.
    Punctuation,
}

/// A piece of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// What it is.
    pub kind: PieceKind,
    /// Where it stands.
    pub span: Span,
}

/// The pieces of a text, in their order; what is no token is left out.
#[must_use]
pub fn pieces(source: &str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut tokens = Token::lexer(source);
    let mut end = 0;
    let mut may_have_unit = false;
    while let Some(token) = tokens.next() {
        let mut range = tokens.span();
        let gap = source.get(end..range.start).unwrap_or("");
        comments(gap, end, &mut pieces);
        let is_same_line = !gap.contains(['\n', '\r']);
        let mut kind = token.ok().and_then(kind_of);
        if may_have_unit && is_same_line && kind.is_some_and(is_word) {
            let rest = &source[range.start..];
            let length = unit_length(rest).filter(|length| !is_before_assignment(&rest[*length..]));
            if let Some(length) = length {
                tokens.bump(length - range.len());
                range = range.start..range.start + length;
                kind = Some(PieceKind::Unit);
            }
        }
        may_have_unit = matches!(token, Ok(Token::Integer | Token::Real | Token::CloseBracket));
        end = range.end;
        if let Some(kind) = kind {
            pieces.push(Piece { kind, span: Span::new(range.start as u32, range.end as u32) });
        }
    }
    comments(source.get(end..).unwrap_or(""), end, &mut pieces);
    pieces
}

fn is_word(kind: PieceKind) -> bool {
    matches!(kind, PieceKind::Name | PieceKind::Free | PieceKind::Reserved)
}

/// The comments of what stands between two tokens.
fn comments(gap: &str, start: usize, pieces: &mut Vec<Piece>) {
    let mut from = 0;
    while let Some(at) = gap[from..].find("//").map(|at| from + at) {
        let rest = &gap[at..];
        let length = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let span = Span::new((start + at) as u32, (start + at + length) as u32);
        pieces.push(Piece { kind: PieceKind::Comment, span });
        from = at + length;
    }
}

fn kind_of(token: Token) -> Option<PieceKind> {
    let kind = match token {
        Token::Name => PieceKind::Name,
        Token::Integer | Token::Real => PieceKind::Number,
        Token::Text => PieceKind::Text,
        Token::OpenBrace
        | Token::CloseBrace
        | Token::OpenParenthesis
        | Token::CloseParenthesis
        | Token::OpenBracket
        | Token::CloseBracket
        | Token::Semicolon
        | Token::Comma
        | Token::Colon
        | Token::Dot => PieceKind::Punctuation,
        _ if token.is_reserved() => PieceKind::Reserved,
        _ if token.is_free() => PieceKind::Free,
        _ if token.text().is_some() => PieceKind::Operator,
        _ => return None,
    };
    Some(kind)
}

#[cfg(test)]
mod tests {
    use super::*;
    use PieceKind::*;

    fn read(source: &str) -> Vec<(PieceKind, &str)> {
        let text = |span: Span| &source[span.start as usize..span.end as usize];
        pieces(source).iter().map(|piece| (piece.kind, text(piece.span))).collect()
    }

    #[test]
    fn every_piece_is_told() {
        let found = read("move to a // one // two\n3 mm/s [1, 2]deg \"x\" += up // end");
        let expected = [
            (Reserved, "move"),
            (Reserved, "to"),
            (Name, "a"),
            (Comment, "// one // two"),
            (Number, "3"),
            (Unit, "mm/s"),
            (Punctuation, "["),
            (Number, "1"),
            (Punctuation, ","),
            (Number, "2"),
            (Punctuation, "]"),
            (Unit, "deg"),
            (Text, "\"x\""),
            (Operator, "+="),
            (Free, "up"),
            (Comment, "// end"),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_unit_stands_on_the_line_of_its_number() {
        assert_eq!(read("3\nm")[1], (Name, "m"));
        assert_eq!(read("toggle 3 m = 4")[2], (Name, "m"));
        assert_eq!(read("3 // x\n s")[2], (Name, "s"));
        assert_eq!(read("3s"), [(Number, "3"), (Unit, "s")]);
    }

    #[test]
    fn what_is_no_token_is_left_out() {
        assert_eq!(read("a § \"b"), [(Name, "a")]);
    }
}
