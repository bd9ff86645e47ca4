//! The colours of Visual Studio Code, made from the words of the lexer. They know no grammar: which
//! word is a name where it stands, the server's semantic tokens say.

use crate::check_made;
use obverse_compiler::symbols::{functions, types};
use obverse_syntax::{FREE_WORDS, RESERVED_WORDS, UNITS};
use serde_json::{Value, json};

const FILE: &str = "editors/vscode/syntaxes/obverse.tmLanguage.json";

/// Reserved words that are no orders.
const CONSTANTS: [&str; 2] = ["false", "true"];
const OPERATORS: [&str; 4] = ["and", "mod", "not", "or"];
const READINGS: [&str; 3] = ["distance", "force", "holding"];

/// The words that a name follows which is declared, and the colour of the name.
const DECLARING: [(&str, &str); 4] = [
    ("sequence|action|io|advanced[ \\t]+move", "entity.name.function.obverse"),
    ("var|joints|output|position|checkpoint", "variable.other.obverse"),
    ("item", "entity.name.type.item.obverse"),
    ("error", "entity.name.type.error.obverse"),
];

/// One of some words, the longest first.
fn one_of<'w>(words: impl IntoIterator<Item = &'w str>) -> String {
    let mut words: Vec<&str> = words.into_iter().collect();
    words.sort_by_key(|word| (std::cmp::Reverse(word.len()), *word));
    words.join("|")
}

fn colour(pattern: String, name: &str) -> Value {
    json!({ "match": pattern, "name": name })
}

fn grammar() -> Value {
    let orders = RESERVED_WORDS
        .iter()
        .copied()
        .filter(|word| ![&CONSTANTS[..], &OPERATORS, &READINGS].concat().contains(word));
    let number = r"\b[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?";
    let units = one_of(UNITS.iter().copied());
    let declaring = DECLARING.iter().map(|(words, name)| {
        json!({
            "match": format!(r"\b({words})[ \t]+([A-Za-z_][A-Za-z0-9_]*)(?=[ \t]*[={{(:\r\n])"),
            "captures": { "1": { "name": "keyword.control.obverse" }, "2": { "name": name } },
        })
    });
    let mut patterns = vec![
        colour(r"//.*$".to_owned(), "comment.line.double-slash.obverse"),
        colour(r#""[^"\r\n]*""#.to_owned(), "string.quoted.double.obverse"),
        json!({
            "match": format!(r"({number})[ \t]*({units})(?![A-Za-z0-9_])"),
            "captures": {
                "1": { "name": "constant.numeric.obverse" },
                "2": { "name": "keyword.other.unit.obverse" },
            },
        }),
        json!({
            "match": format!(r"(?<=\])[ \t]*({units})(?![A-Za-z0-9_])"),
            "captures": { "1": { "name": "keyword.other.unit.obverse" } },
        }),
        colour(number.to_owned(), "constant.numeric.obverse"),
    ];
    patterns.extend(declaring);
    let types = one_of(types());
    let functions = one_of(functions().into_iter().map(|(name, _)| name));
    let whole = |words: String| format!(r"\b(?:{words})\b");
    patterns.extend([
        json!({
            "match": format!(r":[ \t]*({types})\b"),
            "captures": { "1": { "name": "support.type.obverse" } },
        }),
        colour(format!(r"\b(?:{functions})(?=[ \t]*\()"), "support.function.obverse"),
        colour(whole(one_of(CONSTANTS)), "constant.language.obverse"),
        colour(whole(one_of(OPERATORS)), "keyword.operator.word.obverse"),
        colour(whole(one_of(READINGS)), "variable.language.obverse"),
        colour(whole(one_of(orders)), "keyword.control.obverse"),
        // What is assigned is a name, whatever else it may be.
        colour(
            format!(r"\b(?:{})\b(?![ \t]*(?:=(?!=)|\+=|-=))", one_of(FREE_WORDS.iter().copied())),
            "keyword.other.obverse",
        ),
        colour(r"==|!=|<=|>=|\+=|-=|[-+*/<>=]".to_owned(), "keyword.operator.obverse"),
    ]);
    json!({
        "name": "Obverse",
        "scopeName": "source.obverse",
        "fileTypes": ["obv"],
        "patterns": patterns,
    })
}

#[test]
fn the_colours_are_those_of_the_words_of_the_lexer() {
    let text = serde_json::to_string_pretty(&grammar()).expect("it is JSON");
    check_made(FILE, &format!("{text}\n"));
}

#[test]
fn what_is_no_order_is_a_reserved_word() {
    for word in [&CONSTANTS[..], &OPERATORS, &READINGS].concat() {
        assert!(RESERVED_WORDS.contains(&word), "{word}");
    }
}
