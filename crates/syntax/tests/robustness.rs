//! Whatever is given, the parser answers: no panic, no overflow of the stack, a bounded number of
//! diagnostics, all within the text. What has none is formatted, and a second time stays as it is.

use obverse_syntax::codes::Code;
use obverse_syntax::format::format;
use obverse_syntax::{MAX_NESTING, MAX_OPERATORS, parse, text_of};

const EXAMPLE: &str = include_str!("example.obv");

/// Parses, and checks what holds for every text.
fn codes(source: &str) -> Vec<Code> {
    let diagnostics = parse(source).diagnostics;
    assert!(diagnostics.len() <= 20);
    for diagnostic in &diagnostics {
        let spans = diagnostic.labels.iter().map(|label| label.span);
        for span in spans.chain([diagnostic.primary.span]) {
            let range = span.start as usize..span.end as usize;
            assert!(source.get(range).is_some(), "{diagnostic:?} in {source:?}");
        }
        assert!(!diagnostic.message.is_empty() && !diagnostic.message.ends_with('.'));
    }
    if diagnostics.is_empty() {
        let formatted = format(source).unwrap_or_else(|found| panic!("{found:?} in {source:?}"));
        assert_eq!(format(&formatted).as_ref(), Ok(&formatted), "a second time, of {source:?}");
    }
    diagnostics.iter().map(|diagnostic| diagnostic.code).collect()
}

/// The same numbers for the same seed.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % bound
    }
}

#[test]
fn a_text_cut_off_anywhere_is_read_and_found_wanting() {
    let mut depth = 0;
    for (end, byte) in EXAMPLE.bytes().enumerate() {
        let codes = codes(&EXAMPLE[..end]);
        assert!(depth == 0 || !codes.is_empty(), "nothing is missed of the first {end} bytes");
        depth += i32::from(byte == b'{') - i32::from(byte == b'}');
    }
    assert_eq!(codes(EXAMPLE), []);
}

#[test]
fn a_text_without_one_of_its_tokens_is_read() {
    let words: Vec<&str> = EXAMPLE.split_inclusive(' ').collect();
    for left_out in 0..words.len() {
        let mut rest = words.clone();
        rest.remove(left_out);
        codes(&rest.concat());
    }
}

#[test]
fn changed_bytes_are_read() {
    let mut random = Random(1);
    for _ in 0..800 {
        let mut bytes = EXAMPLE.as_bytes().to_vec();
        for _ in 0..=random.below(8) {
            let at = random.below(bytes.len());
            match random.below(3) {
                0 => bytes[at] = random.below(256) as u8,
                1 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
                _ => bytes.insert(at, b"{}()[];=\"'.,-0e\n"[random.below(16)]),
            }
        }
        codes(&String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn rows_of_random_words_are_read() {
    let words: Vec<&str> =
        EXAMPLE.split_whitespace().chain(["°", "ö", "“", "\0", "\u{FEFF}"]).collect();
    let mut random = Random(2);
    for _ in 0..1000 {
        let count = random.below(40);
        let text: Vec<&str> = (0..count).map(|_| words[random.below(words.len())]).collect();
        codes(&text.join(" "));
    }
}

#[test]
fn random_bytes_are_read() {
    let mut random = Random(3);
    for _ in 0..1000 {
        let length = random.below(200);
        let bytes: Vec<u8> = (0..length).map(|_| random.below(256) as u8).collect();
        codes(&String::from_utf8_lossy(&bytes));
        let ascii: Vec<u8> = bytes.iter().map(|byte| byte % 127 + 1).collect();
        codes(&String::from_utf8_lossy(&ascii));
    }
}

#[test]
fn what_is_too_deep_is_refused_at_once() {
    let deep = 100_000;
    let openings = [
        "sequence main { loop {",
        "sequence main { if a {} else if",
        "var a = (",
        "var a = f(",
        "joints a = [",
        "item a {",
        "{",
        "(",
        "[",
    ];
    for opening in openings {
        let (head, repeated) = opening.split_at(opening.rfind(['{', '(', '[']).unwrap_or(0));
        let repeated = if opening.contains("else") { " {} else if a" } else { repeated };
        let text = format!("{head}{}", repeated.repeat(deep));
        let codes = codes(&text);
        assert!(codes.contains(&Code::NestingTooDeep), "{opening}: {codes:?}");
    }
    let blocks = format!("sequence main {{{}", "if a {} else { loop { ".repeat(deep));
    assert!(codes(&blocks).contains(&Code::NestingTooDeep));
    for operator in ["-", "not ", "a + ", "a and ", "a * "] {
        let text = format!("var a = {}a", operator.repeat(deep));
        assert_eq!(codes(&text), [Code::ExpressionTooLong], "{operator}");
    }
}

#[test]
fn what_is_as_deep_as_allowed_is_read() {
    let nested = |depth: usize| {
        format!("sequence main {{{}{}}}", "loop {".repeat(depth - 1), "}".repeat(depth - 1))
    };
    assert_eq!(codes(&nested(MAX_NESTING)), []);
    assert_eq!(codes(&nested(MAX_NESTING + 1)), [Code::NestingTooDeep]);
    let sum = |operators: usize| format!("var a = a{}", " + a".repeat(operators));
    assert_eq!(codes(&sum(MAX_OPERATORS)), []);
    assert_eq!(codes(&sum(MAX_OPERATORS + 1)), [Code::ExpressionTooLong]);
    let links =
        |links: usize| format!("sequence main {{ if a {{}} {} }}", "else if a {}".repeat(links));
    assert_eq!(codes(&links(MAX_NESTING - 2)), []);
    assert_eq!(codes(&links(MAX_NESTING - 1)), [Code::NestingTooDeep]);
}

#[test]
fn long_texts_without_sense_are_read_in_time() {
    for piece in [
        "1 ",
        "a ",
        "} ",
        ") ",
        "else ",
        "= ",
        "\" ",
        "[ ] ",
        "if ",
        "x = ",
        "x = 1; ",
        "if x { } ",
        "; x ",
        "// \n",
    ] {
        codes(&piece.repeat(30_000));
        codes(&format!("sequence main {{{}", piece.repeat(30_000)));
    }
}

#[test]
fn long_lists_and_rows_are_read() {
    let list = "1, ".repeat(5000);
    assert_eq!(codes(&format!("joints a = [{list}]")), []);
    assert_eq!(codes(&format!("sequence main {{ call a({list}) {} }}", ";".repeat(5000))), []);
    assert_eq!(codes(&format!("action a({}) {{ }}", "b: int, ".repeat(5000))), []);
    let changes = ", slower".repeat(5000);
    assert_eq!(codes(&format!("error e {{ recover by reversing 1 action{changes} }}")), []);
    let operators = "-".repeat(MAX_OPERATORS);
    let (opening, closing) = ("(".repeat(MAX_NESTING), ")".repeat(MAX_NESTING));
    assert_eq!(codes(&format!("var a = {operators}{opening}1{closing}")), []);
}

#[test]
fn bytes_that_are_not_text_are_refused() {
    assert_eq!(text_of(b"ab\xFFc").map_err(|diagnostic| diagnostic.code), Err(Code::NotText));
    assert_eq!(text_of("größe".as_bytes()), Ok("größe"));
    assert_eq!(codes("sequence main {\0}"), [Code::NotText]);
}
