//! How strings stand in assembly text: bare, quoted, cut short. Knows nothing of what they name.

use std::fmt::Write;

/// The most of a name that is repeated where it is used, in bytes.
const MAX_SHOWN: usize = 80;

/// Whether a name can be repeated where it is used. If long ones were, a text would not be linear
/// in its module.
pub(super) fn is_short(name: &str) -> bool {
    name.len() <= MAX_SHOWN
}

/// Whether a name can stand without quotes.
pub(super) fn is_bare(name: &str) -> bool {
    let is_inner = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'$' | b'.');
    is_short(name)
        && name.bytes().next().is_some_and(|first| is_inner(first) && first != b'.')
        && !name.as_bytes()[0].is_ascii_digit()
        && name.bytes().all(is_inner)
}

/// A string with quotes and escapes: nothing in it moves a cursor or ends a line.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            _ if is_plain(c) => out.push(c),
            _ => {
                let _ = write!(out, "\\u{{{:x}}}", u32::from(c));
            }
        }
    }
    out.push('"');
    out
}

/// The beginning of a string, on one line, without quotes: for comments and messages. Takes no
/// longer for a longer string.
pub(super) fn excerpt(text: &str) -> String {
    let mut chars = text.chars().take(4 * MAX_SHOWN).skip_while(|c| c.is_whitespace());
    let out: String = chars
        .by_ref()
        .take(MAX_SHOWN)
        .map(|c| match c {
            _ if c.is_whitespace() => ' ',
            _ if is_plain(c) => c,
            _ => char::REPLACEMENT_CHARACTER,
        })
        .collect();
    let is_cut = chars.any(|c| !c.is_whitespace());
    format!("{}{}", out.trim_end(), if is_cut { "…" } else { "" })
}

/// Whether a character shows as itself and leaves the rest of its line alone.
pub(super) fn is_plain(c: char) -> bool {
    matches!(c, '"' | '\'' | '\\') || c.escape_debug().len() == 1
}

/// Why a quoted string cannot be read.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct QuoteError {
    /// Where, in bytes from the opening quote.
    pub(super) at: usize,
    /// What is wrong.
    pub(super) why: &'static str,
}

/// The string that `text` begins with, which begins with a quote, and how many bytes it takes.
pub(super) fn unquote(text: &str) -> Result<(String, usize), QuoteError> {
    let mut out = String::new();
    let mut chars = text.char_indices().skip(1);
    while let Some((at, c)) = chars.next() {
        match c {
            '"' => return Ok((out, at + 1)),
            '\\' => {
                let escaped = chars.next().map(|(_, c)| c);
                let meant = match escaped {
                    Some('"' | '\\') => escaped,
                    Some('n') => Some('\n'),
                    Some('r') => Some('\r'),
                    Some('t') => Some('\t'),
                    Some('u') => code_point(&mut chars),
                    _ => None,
                };
                out.push(meant.ok_or(QuoteError {
                    at,
                    why: r#"this is no escape; there are \" \\ \n \r \t and \u{..}"#,
                })?);
            }
            _ => out.push(c),
        }
    }
    Err(QuoteError { at: 0, why: "the quote is not closed on this line" })
}

/// The `{hex}` of an escape.
fn code_point(chars: &mut impl Iterator<Item = (usize, char)>) -> Option<char> {
    if chars.next()?.1 != '{' {
        return None;
    }
    let mut value = 0;
    for digits in 0..=6 {
        let c = chars.next()?.1;
        if c == '}' {
            return if digits == 0 { None } else { char::from_u32(value) };
        }
        value = value * 16 + c.to_digit(16)?;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoting_and_unquoting_are_inverse() {
        let all: String = (0..0x500).filter_map(char::from_u32).collect();
        for text in ["", "plain", "\"\\\n\r\t\0\u{7f}", "ü\u{202e}\u{10ffff}", all.as_str()] {
            let written = quoted(text);
            assert_eq!(unquote(&written), Ok((text.to_owned(), written.len())));
            assert!(!written.contains(['\n', '\r', '\0', '\u{202e}', '\u{1b}']), "{written}");
        }
    }

    #[test]
    fn what_follows_the_quote_is_left() {
        assert_eq!(unquote("\"ab\" c"), Ok(("ab".to_owned(), 4)));
    }

    #[test]
    fn wrong_escapes_are_refused_where_they_stand() {
        let wrong = [r#""a\q""#, r#""a\u""#, r#""a\u{}""#, r#""a\u{d800}""#, r#""a\u{1234567}""#];
        for text in wrong {
            assert_eq!(unquote(text).map_err(|error| error.at), Err(2), "{text}");
        }
        for text in ["\"", "\"ab", "\"a\\\""] {
            assert_eq!(unquote(text).map_err(|error| error.at), Err(0), "{text}");
        }
    }

    #[test]
    fn bare_names_are_words() {
        let longest = "a".repeat(80);
        for name in ["a", "$hidden", "insert_peg", "L12", "a.b", &longest] {
            assert!(is_bare(name), "{name}");
        }
        let long = "a".repeat(81);
        for name in ["", "1a", ".a", "a b", "a#1", "a:", "a,", "\u{fc}", "+x", &long] {
            assert!(!is_bare(name), "{name}");
        }
    }

    #[test]
    fn excerpts_are_one_short_line() {
        assert_eq!(excerpt("  move to start\n"), "move to start");
        assert_eq!(excerpt("a\tb\u{1b}"), "a b\u{fffd}");
        assert_eq!(excerpt(&"x".repeat(100)), format!("{}…", "x".repeat(80)));
        assert_eq!(excerpt(&format!("{} \n", "x".repeat(80))), "x".repeat(80));
        assert_eq!(excerpt(&" ".repeat(1000)), "");
    }
}
