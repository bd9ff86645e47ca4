//! Heads of actions and sequences that are being written: what is not there yet is filled in byte
//! for byte, so that all that is below keeps its names and its places. What is wrong with them is
//! still said of the text itself. It knows how a head begins, and nothing else of the language.

/// What begins what has a head.
const KINDS: [&str; 3] = ["action ", "sequence ", "advanced move "];

/// The text with its heads made whole, of the same length; none if none has to be.
pub(crate) fn mended(text: &str) -> Option<String> {
    let mut mended = text.as_bytes().to_vec();
    let mut begin = 0;
    for line in text.split_inclusive('\n') {
        if KINDS.iter().any(|kind| line.starts_with(kind)) {
            mend(line, &mut mended[begin..begin + line.len()]);
        }
        begin += line.len();
    }
    // Bytes of ASCII alone were put in the place of others, and of whole characters.
    String::from_utf8(mended).ok().filter(|mended| mended != text)
}

/// Mend the head on a line.
fn mend(line: &str, bytes: &mut [u8]) {
    let written = line.trim_end();
    let head_end = line.find('{').unwrap_or(written.len());
    let head = &line[..head_end];
    if let Some(open) = head.find('(') {
        let close = head.rfind(')').filter(|close| *close > open);
        parameters(head, open + 1, close.unwrap_or(head.trim_end().len()), bytes);
        let room = head.trim_end().len();
        if close.is_none() && line[room..].starts_with(char::is_whitespace) {
            bytes[room] = b')';
        }
    }
    // The end of the line stands for the brace that is missing there.
    if !line.contains('{')
        && let Some(free) = (written.len()..line.len()).rfind(|at| bytes[*at] != b')')
    {
        bytes[free] = b'{';
    }
}

/// Blank out each parameter that is not one yet, with the comma before it.
fn parameters(head: &str, first: usize, end: usize, bytes: &mut [u8]) {
    let mut begin = first;
    for parameter in head[first..end].split(',') {
        let is_whole = parameter.split_once(':').is_some_and(|(name, of_type)| {
            !name.trim().is_empty() && !of_type.trim().is_empty() && !of_type.trim().ends_with('=')
        });
        let stop = begin + parameter.len();
        if !is_whole {
            bytes[begin.saturating_sub(usize::from(begin > first))..stop].fill(b' ');
        }
        begin = stop + 1;
    }
    // Where the first is none, so is the comma behind it.
    let rest = &mut bytes[first..end];
    if let Some(comma) = rest.iter().position(|byte| !byte.is_ascii_whitespace())
        && rest[comma] == b','
    {
        rest[comma] = b' ';
    }
}

#[cfg(test)]
mod tests {
    use super::mended;

    #[test]
    fn a_head_is_made_whole_byte_for_byte() {
        for (text, expected) in [
            ("action two(x: int, y: ) {\n}\n", "action two(x: int     ) {\n}\n"),
            ("action two(x: int, y) {\n}\n", "action two(x: int   ) {\n}\n"),
            ("action two(, x: int) {\n}\n", "action two(  x: int) {\n}\n"),
            ("action two(x, y: int) {\n}\n", "action two(   y: int) {\n}\n"),
            ("action two() {\n}\n", "action two() {\n}\n"),
            ("action f(p: int {\n}\n", "action f(p: int){\n}\n"),
            ("action f(p: int{\n}\n", "action f(p: int{\n}\n"),
            ("action f(p: int\n}\n", "action f(p: int)}\n"),
            ("sequence f\n  wait 1 s\n}\n", "sequence f{  wait 1 s\n}\n"),
            ("sequence f \r\n}\r\n", "sequence f \r{}\r\n"),
            ("sequence f", "sequence f"),
            ("  action f(x: ) {\n", "  action f(x: ) {\n"),
            ("action \u{fc}(x: , \u{e4}: int) {\n", "action \u{fc}(     \u{e4}: int) {\n"),
        ] {
            let found = mended(text);
            assert_eq!(found.as_deref().unwrap_or(text), expected, "{text:?}");
            assert_eq!(expected.len(), text.len(), "{text:?}");
        }
    }
}
