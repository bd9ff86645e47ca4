//! Which key of a workcell file a place belongs to, for messages of the reader that do not say it.

/// The key whose value a byte of a text is in: the word before the last `=` outside of brackets
/// that are closed before that byte. None where there is no such word.
pub(super) fn key_of(text: &str, byte: usize) -> Option<&str> {
    let bytes = text.as_bytes().get(..byte)?;
    let (mut closed, mut at) = (0_usize, bytes.len());
    while let Some(before) = at.checked_sub(1) {
        at = before;
        match bytes[at] {
            b'"' => at = bytes[..at].iter().rposition(|other| *other == b'"')?,
            b']' | b'}' => closed += 1,
            b'[' | b'{' => closed = closed.saturating_sub(1),
            b'=' if closed == 0 => return word_before(text.get(..at)?),
            _ => {}
        }
    }
    None
}

/// The word that a text ends with, which is no part of a longer name with dots or quotes.
fn word_before(text: &str) -> Option<&str> {
    let text = text.trim_end_matches([' ', '\t']);
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    let begin = text.rfind(|c| !is_part(c)).map_or(0, |at| at + 1);
    let word = text.get(begin..)?;
    (!word.is_empty()).then_some(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_belongs_to_the_key_before_it() {
        let key = |text: &'static str| key_of(text, text.find('!').expect("a mark"));
        assert_eq!(key("count = !1"), Some("count"));
        assert_eq!(key("a = [1, 2]\nsize_mm = [\n  1,\n  !2]"), Some("size_mm"));
        assert_eq!(key("p = { at = { xyz_mm = [0, 0, 1] }, turn = [!1] }"), Some("turn"));
        assert_eq!(key("name = \"a = [\"\nplace = !1"), Some("place"));
        assert_eq!(key("arm.home_rad = ![1]"), Some("arm.home_rad"));
        for text in ["!", "[arm]\n!x = 1", "= !1", "é = !1", "\" = !1"] {
            assert_eq!(key(text), None, "{text}");
        }
        assert_eq!(key_of("a = 1", 99), None);
    }
}
