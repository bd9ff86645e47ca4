//! What a text goes on with, seen from its bytes alone: a word, a unit, an assignment. It knows no
//! tokens around it.

use crate::token::UNITS;

/// The length of the word that a text begins with.
pub(crate) fn ascii_word_length(text: &str) -> usize {
    let is_word_byte = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    let begins = text.bytes().next().is_some_and(|byte| !byte.is_ascii_digit());
    if begins { text.bytes().take_while(is_word_byte).count() } else { 0 }
}

/// The length of a `°` that a text begins with, and of the blanks before it.
pub(crate) fn degree_sign(text: &str) -> Option<usize> {
    let sign = text.trim_start_matches([' ', '\t']);
    sign.starts_with('°').then_some(text.len() - sign.len() + '°'.len_utf8())
}

/// The length of the unit that a text begins with: `mm`, or `mm/s` written without blanks.
pub(crate) fn unit_length(text: &str) -> Option<usize> {
    let word = ascii_word_length(text);
    let after = &text[word..];
    if let Some(per) = after.strip_prefix('/') {
        let whole = word + 1 + ascii_word_length(per);
        if UNITS.contains(&&text[..whole]) {
            return Some(whole);
        }
    }
    UNITS.contains(&&text[..word]).then_some(word)
}

/// Whether a text goes on, after blanks and comments, with `=`, `+=`, `-=` or the foreign `:=`.
pub(crate) fn is_before_assignment(text: &str) -> bool {
    let mut rest = text.as_bytes();
    loop {
        rest = rest.trim_ascii_start();
        let Some(comment) = rest.strip_prefix(b"//") else { break };
        let line = comment.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        rest = &comment[line.unwrap_or(comment.len())..];
    }
    match rest {
        [b'=', b'=', ..] => false,
        [b'=', ..] | [b'+' | b'-' | b':', b'=', ..] => true,
        _ => false,
    }
}
