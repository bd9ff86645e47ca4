//! What the lexer makes of a text: tokens, the text of each, and what is reported.

use super::*;
use Token::*;

fn lex(source: &str) -> (Vec<(Token, &str)>, Vec<Code>) {
    let sink = Sink::default();
    let tokens = Lexer::new(source, 0, &sink)
        .map_while(Result::ok)
        .map(|(start, token, end)| (token, &source[start as usize..end as usize]))
        // One that is not written helps the parser to go on.
        .filter(|(token, text)| *token != Semicolon || *text == ";")
        .collect();
    let found = sink.into_findings().diagnostics;
    let codes = found.into_iter().map(|diagnostic| diagnostic.code).collect();
    (tokens, codes)
}

fn tokens(source: &str) -> Vec<Token> {
    let (tokens, codes) = lex(source);
    assert_eq!(codes, [], "{source}");
    tokens.into_iter().map(|(token, _)| token).collect()
}

#[test]
fn a_number_and_its_unit_are_one_token() {
    let cases = ["20 mm", "0.5s", "3\tdeg", "1e5 N", "3 mm/s", "2rad/s"];
    for source in cases {
        assert_eq!(lex(source), (vec![(Quantity, source)], vec![]));
    }
}

#[test]
fn a_unit_on_the_next_line_is_a_name() {
    assert_eq!(tokens("3\nm"), [Integer, Name]);
    assert_eq!(tokens("[3]\nm"), [OpenBracket, Integer, CloseBracket, Name]);
}

#[test]
fn a_unit_that_is_assigned_is_a_name() {
    assert_eq!(tokens("toggle 3 m = 4"), [Toggle, Integer, Assigned, Assign, Integer]);
}

#[test]
fn a_quotient_with_blanks_is_not_a_unit() {
    assert_eq!(tokens("3 mm / s"), [Quantity, Slash, Name]);
    assert_eq!(tokens("3 mm/speed"), [Quantity, Slash, Speed]);
}

#[test]
fn a_unit_after_a_bracket_is_a_token() {
    assert_eq!(tokens("[1] mm"), [OpenBracket, Integer, CloseBracket, Unit]);
    assert_eq!(lex("[1] mm/s").0.last(), Some(&(Unit, "mm/s")));
    assert_eq!(tokens("[1] when"), [OpenBracket, Integer, CloseBracket, When]);
    assert_eq!(tokens("m"), [Name]);
}

#[test]
fn a_word_after_a_number_that_is_no_unit_is_marked() {
    assert_eq!(lex("5 kg"), (vec![(BadQuantity, "5 kg")], vec![]));
    assert_eq!(tokens("3 times"), [Integer, Times]);
    assert_eq!(tokens("3 and"), [Integer, And]);
}

#[test]
fn an_assigned_word_is_marked_outside_of_brackets() {
    assert_eq!(tokens("speed = 3"), [Assigned, Assign, Integer]);
    assert_eq!(tokens("a // why\n += 1"), [Assigned, AddAssign, Integer]);
    assert_eq!(tokens("a == 1"), [Name, Equal, Integer]);
    assert_eq!(tokens("(a = 1)"), [OpenParenthesis, Name, Assign, Integer, CloseParenthesis]);
    assert_eq!(tokens("{ a = 1 }"), [OpenBrace, Assigned, Assign, Integer, CloseBrace]);
    assert_eq!(tokens("wait = 1"), [Wait, Assign, Integer]);
    assert_eq!(tokens("if a = 1"), [If, Name, Assign, Integer]);
    assert_eq!(tokens("b +\na = 1"), [Name, Plus, Assigned, Assign, Integer]);
}

#[test]
fn blanks_comments_and_line_ends_are_passed_over() {
    assert_eq!(tokens("\u{FEFF}a\r\nb\rc\t\x0Cd // e\n// f"), [Name; 4]);
}

#[test]
fn foreign_signs_are_reported_and_replaced() {
    let cases = [("&&", And), ("||", Or), ("!", Not), ("%", Mod), (":=", Assign), ("<>", NotEqual)];
    for (sign, meant) in cases {
        let source = format!("if {sign}");
        let tokens = vec![(If, "if"), (meant, sign)];
        assert_eq!(lex(&source), (tokens, vec![Code::ForeignOperator]));
    }
    assert_eq!(tokens("!="), [NotEqual]);
}

#[test]
fn foreign_characters_are_reported_and_replaced() {
    let code = Code::UnexpectedCharacter;
    assert_eq!(lex("a ≤ b").0[1], (LessOrEqual, "≤"));
    assert_eq!(lex("größe"), (vec![(Name, "größe")], vec![code]));
    assert_eq!(lex("ö1 b"), (vec![(Name, "ö1"), (Name, "b")], vec![code]));
    assert_eq!(lex("“a b” c"), (vec![(Text, "“a b”"), (Name, "c")], vec![code]));
    assert_eq!(lex("'a b' c"), (vec![(Text, "'a b'"), (Name, "c")], vec![code]));
    assert_eq!(lex("! a b\nc"), (vec![(Name, "c")], vec![code]));
    assert_eq!(lex("c ! a b"), (vec![(Name, "c")], vec![code]));
    assert_eq!(lex("; a b\nc"), (vec![(Name, "c")], vec![code]));
    assert_eq!(lex("c; a = 3").1, []);
    assert_eq!(lex("c\n; a // b\n= 3").1, []);
    assert_eq!(lex("# a b\nc"), (vec![(Name, "c")], vec![code]));
    assert_eq!(lex("/* a\nb */ c"), (vec![(Name, "c")], vec![code]));
    assert_eq!(lex("/* a\nb"), (vec![(Name, "b")], vec![code]));
    assert_eq!(lex("a\u{A0}b"), (vec![(Name, "a"), (Name, "b")], vec![code]));
    assert_eq!(lex("@ ~ a"), (vec![(Name, "a")], vec![code, code]));
}

#[test]
fn a_text_that_is_not_closed_ends_with_the_line_or_before_a_brace() {
    let code = Code::UnterminatedString;
    assert_eq!(lex("\"a b\nc"), (vec![(Text, "\"a b"), (Name, "c")], vec![code]));
    assert_eq!(
        lex("\"a {}"),
        (vec![(Text, "\"a "), (OpenBrace, "{"), (CloseBrace, "}")], vec![code])
    );
    assert_eq!(tokens("\"a { b\""), [Text]);
}

#[test]
fn a_number_with_a_digit_missing_is_reported_and_read() {
    for source in [".5", "5.", ".5 mm"] {
        let (tokens, codes) = lex(source);
        assert_eq!(codes, [Code::MalformedNumber], "{source}");
        assert_eq!(tokens.len(), 1, "{source}");
    }
}

#[test]
fn a_closing_bracket_too_many_is_reported_and_left_out() {
    assert_eq!(lex("a } b"), (vec![(Name, "a"), (Name, "b")], vec![Code::UnmatchedBracket]));
}

#[test]
fn reading_ends_after_so_many_mistakes() {
    let source = "@ a ".repeat(100);
    let (tokens, codes) = lex(&source);
    assert_eq!(codes.len(), crate::sink::MAX_MISTAKES);
    assert!(tokens.len() < codes.len() + 1);
}
