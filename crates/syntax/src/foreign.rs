//! Characters that mean nothing in the language: what was probably meant by them, and how that is
//! said. It knows characters; tokens only where one clearly stands for another.

use crate::codes::Code;
use crate::diagnostic::Diagnostic;
use crate::span::Span;
use crate::token::Token;

/// A piece of text that is no token.
pub(crate) struct Foreign {
    /// How many bytes more belong to it.
    pub(crate) length: usize,
    /// The token that takes its place, if any does.
    pub(crate) meant: Option<Token>,
}

/// Quotes as word processors write them.
pub(crate) fn is_typographic_quote(c: char) -> bool {
    matches!(c, '\u{201C}'..='\u{201F}' | '\u{2018}'..='\u{201B}' | '«' | '»' | '‹' | '›')
}

/// How many bytes of the text go on with a word, letters of any alphabet allowed.
pub(crate) fn word_length(text: &str) -> usize {
    text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len())
}

/// How far a foreign piece goes on after its beginning, and what it stands for.
pub(crate) fn read(beginning: &str, rest: &str) -> Foreign {
    let line = &rest[..rest.find(['\r', '\n']).unwrap_or(rest.len())];
    match beginning.chars().next() {
        Some(c) if is_typographic_quote(c) => {
            let after_quote =
                |index: usize| index + line[index..].chars().next().map_or(0, char::len_utf8);
            let closing = line.find(|c| is_typographic_quote(c) || c == '"').map(after_quote);
            Foreign { length: closing.unwrap_or(line.len()), meant: Some(Token::Text) }
        }
        Some('#' | '$') => Foreign { length: line.len(), meant: None },
        Some(c) if c.is_alphanumeric() => {
            Foreign { length: word_length(line), meant: Some(Token::Name) }
        }
        Some(c) => {
            let meant = instead_of(c).and_then(|(_, token)| token);
            // A row of strange characters is one mistake.
            let is_strange = |c: char| !c.is_ascii() && !c.is_alphanumeric();
            let length = if meant.is_some() {
                0
            } else {
                line.find(|c| !is_strange(c)).unwrap_or(line.len())
            };
            Foreign { length, meant }
        }
        None => Foreign { length: 0, meant: None },
    }
}

/// What is written in place of a character, with its token if that is one.
fn instead_of(c: char) -> Option<(&'static str, Option<Token>)> {
    Some(match c {
        '≤' | '⩽' => ("<=", Some(Token::LessOrEqual)),
        '≥' | '⩾' => (">=", Some(Token::GreaterOrEqual)),
        '≠' => ("!=", Some(Token::NotEqual)),
        '×' | '·' | '∙' | '⋅' => ("*", Some(Token::Star)),
        '÷' | '∕' => ("/", Some(Token::Slash)),
        '−' | '–' | '—' | '‐' | '‑' => ("-", Some(Token::Minus)),
        '&' => ("and", Some(Token::And)),
        '|' => ("or", Some(Token::Or)),
        '°' => ("deg", None),
        '#' => ("//", None),
        _ => return None,
    })
}

/// A word with letters outside of ASCII.
pub(crate) fn foreign_word(word: &str, span: Span) -> Diagnostic {
    let letter = word.chars().find(|c| !c.is_ascii()).unwrap_or_default();
    let message = format!("{} cannot be in a name", named(letter));
    let diagnostic =
        Diagnostic::error(Code::UnexpectedCharacter, span, message, "not a name of the language")
            .with_note("names are made of the letters a to z and A to Z, digits and `_`");
    let spelled: Option<String> = word.chars().map(spelling).collect();
    match spelled {
        Some(spelled) => diagnostic.write_instead(span, &spelled),
        None => diagnostic,
    }
}

/// How a letter can be written in ASCII.
fn spelling(c: char) -> Option<&'static str> {
    const ASCII: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
    if let Some(index) = ASCII.find(c) {
        return ASCII.get(index..=index);
    }
    Some(match c {
        'ä' | 'æ' => "ae",
        'ö' | 'ø' | 'œ' => "oe",
        'ü' => "ue",
        'Ä' | 'Æ' => "Ae",
        'Ö' | 'Ø' | 'Œ' => "Oe",
        'Ü' => "Ue",
        'ß' => "ss",
        'å' => "aa",
        'Å' => "Aa",
        'à' | 'á' | 'â' | 'ã' => "a",
        'ç' => "c",
        'è' | 'é' | 'ê' | 'ë' => "e",
        'ì' | 'í' | 'î' | 'ï' => "i",
        'ñ' => "n",
        'ò' | 'ó' | 'ô' | 'õ' => "o",
        'ù' | 'ú' | 'û' => "u",
        'µ' | 'μ' => "u",
        _ => return None,
    })
}

/// What is said of a piece of text that is no token.
pub(crate) fn diagnostic(text: &str, span: Span) -> Diagnostic {
    let c = text.chars().next().unwrap_or_default();
    let error =
        |message: String, at: &str| Diagnostic::error(Code::UnexpectedCharacter, span, message, at);
    if is_typographic_quote(c) {
        let inner = text.trim_matches(|c| is_typographic_quote(c) || c == '"');
        return error(format!("{} is a typographic quote", named(c)), "not a text")
            .with_help(format!("write \"{inner}\" with straight quotes"))
            .replacing(span, format!("\"{inner}\""));
    }
    if c.is_alphanumeric() {
        return foreign_word(text, span);
    }
    if c.is_whitespace() || matches!(c, '\u{200B}'..='\u{200F}' | '\u{2060}' | '\u{FEFF}') {
        return error(format!("{} is an invisible character", named(c)), "invisible")
            .with_help("write a plain blank, or nothing")
            .replacing(span, " ");
    }
    let diagnostic = error(format!("{} means nothing here", named(c)), "no part of the language");
    match instead_of(c) {
        Some(("//", _)) => diagnostic
            .with_help("a comment begins with `//`")
            .replacing(Span::new(span.start, span.start + 1), "//"),
        Some((instead, _)) => diagnostic.write_instead(span, instead),
        None if c == '$' => {
            diagnostic.with_help("write `set 1 high` for an output, and `input 1` for an input")
        }
        None => diagnostic,
    }
}

/// A character as it is named in a message; one that cannot be seen by its number alone.
fn named(c: char) -> String {
    let number = u32::from(c);
    if c.is_ascii_graphic() {
        format!("`{c}`")
    } else if c.is_alphanumeric() || is_typographic_quote(c) || instead_of(c).is_some() {
        format!("`{c}` (U+{number:04X})")
    } else {
        format!("U+{number:04X}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn help(text: &str) -> Option<String> {
        diagnostic(text, Span::default()).help
    }

    #[test]
    fn what_was_meant_is_said() {
        assert_eq!(help("≤").as_deref(), Some("write `<=`"));
        assert_eq!(help("# note").as_deref(), Some("a comment begins with `//`"));
        assert_eq!(help("größe").as_deref(), Some("write `groesse`"));
        assert_eq!(help("µm").as_deref(), Some("write `um`"));
        assert_eq!(help("“peg.toml”").as_deref(), Some("write \"peg.toml\" with straight quotes"));
        assert_eq!(help("点"), None);
    }

    #[test]
    fn what_cannot_be_seen_is_named_by_number() {
        let message = diagnostic("\u{A0}", Span::default()).message;
        assert_eq!(message, "U+00A0 is an invisible character");
    }

    #[test]
    fn a_piece_ends_with_its_kind() {
        assert_eq!(read("“", "peg” {").length, "peg”".len());
        assert_eq!(read("“", "peg\nmove").length, "peg".len());
        assert_eq!(read("#", " a note\nmove").length, " a note".len());
        assert_eq!(read("ö", "ße = 3").length, "ße".len());
        assert_eq!(read("☃", "☃☃ move").length, "☃☃".len());
    }
}
