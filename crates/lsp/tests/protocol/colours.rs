//! Semantic tokens.

use crate::support::opened;
use obverse_lsp::legend;

/// The pieces of a text with their kinds and modifiers.
fn coloured(source: &str) -> Vec<(String, String)> {
    let (mut editor, _) = opened(source);
    let answer = editor.of("semanticTokens/full", "main.obv");
    let data: Vec<usize> = answer["data"]
        .as_array()
        .expect("numbers")
        .iter()
        .map(|number| number.as_u64().expect("a number") as usize)
        .collect();
    let lines: Vec<Vec<u16>> = source.lines().map(|line| line.encode_utf16().collect()).collect();
    let legend = legend();
    let (mut line, mut character) = (0, 0);
    data.chunks(5)
        .map(|piece| {
            if piece[0] > 0 {
                (line, character) = (line + piece[0], 0);
            }
            character += piece[1];
            let text = String::from_utf16(&lines[line][character..character + piece[2]]);
            let mut kind = legend.token_types[piece[3]].clone();
            for (bit, modifier) in legend.token_modifiers.iter().enumerate() {
                if piece[4] & (1 << bit) != 0 {
                    kind += &format!(" {modifier}");
                }
            }
            (text.expect("letters"), kind)
        })
        .collect()
}

#[test]
fn a_word_that_is_a_name_is_coloured_as_a_name() {
    let found = coloured("var up = 3 mm // \u{1F916}\nsequence main {\n  move up up // ä\n}\n");
    let expected = [
        ("var", "keyword"),
        ("up", "variable declaration"),
        ("=", "operator"),
        ("3", "number"),
        ("mm", "enumMember"),
        ("// \u{1F916}", "comment"),
        ("sequence", "keyword"),
        ("main", "function declaration"),
        ("move", "keyword"),
        ("up", "variable"),
        ("up", "keyword"),
        ("// ä", "comment"),
    ];
    let expected: Vec<_> =
        expected.iter().map(|(text, kind)| ((*text).to_owned(), (*kind).to_owned())).collect();
    assert_eq!(found, expected);
}

#[test]
fn modifiers_tell_what_is_done_with_a_name() {
    let found = coloured("sequence main {\n  var x: int = 1\n  x += abs(x)\n}\n");
    let kind = |text: &str, nth: usize| {
        found.iter().filter(|(found, _)| found == text).nth(nth).map(|(_, kind)| kind.as_str())
    };
    assert_eq!(kind("x", 1), Some("variable modification"));
    assert_eq!(kind("int", 0), Some("type defaultLibrary"));
    assert_eq!(kind("abs", 0), Some("function defaultLibrary"));
}
