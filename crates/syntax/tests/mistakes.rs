//! What is said of mistakes: the code, the place, and that one mistake is reported once.

use obverse_syntax::ast::{ExpressionKind, Item, StatementKind};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::{MAX_SOURCE_BYTES, parse};

fn text<'s>(source: &'s str, diagnostic: &Diagnostic) -> &'s str {
    let span = diagnostic.primary.span;
    &source[span.start as usize..span.end as usize]
}

/// The codes of all diagnostics and the text that each marks.
fn mistakes(source: &str) -> Vec<(&'static str, &str)> {
    let diagnostics = parse(source).diagnostics;
    diagnostics.iter().map(|one| (one.code.as_str(), text(source, one))).collect()
}

/// The only diagnostic.
fn mistake(source: &str) -> Diagnostic {
    let mut diagnostics = parse(source).diagnostics;
    assert_eq!(diagnostics.len(), 1, "{source}: {diagnostics:#?}");
    diagnostics.remove(0)
}

/// The only diagnostic of a text in a sequence, and the text that it marks.
fn in_sequence(body: &str) -> (Diagnostic, String) {
    let source = format!("sequence main {{\n{body}\n}}");
    let diagnostic = mistake(&source);
    let text = text(&source, &diagnostic).to_owned();
    (diagnostic, text)
}

fn message(body: &str) -> String {
    in_sequence(body).0.message
}

#[test]
fn the_examples_of_the_pages_are_what_they_say() {
    let is_of_syntax = |code: &&Code| code.as_str().starts_with("E00");
    for code in Code::ALL.iter().filter(is_of_syntax) {
        let codes =
            |source| parse(source).diagnostics.iter().map(|one| one.code).collect::<Vec<_>>();
        assert_eq!(codes(code.page().right), [], "{code}: right");
        if !code.page().wrong.is_empty() {
            assert_eq!(codes(code.page().wrong), [*code], "{code}: wrong");
        }
    }
}

#[test]
fn codes_are_unique_and_sorted_and_found_by_name() {
    let codes: Vec<&str> = Code::ALL.iter().map(|code| code.as_str()).collect();
    assert!(codes.is_sorted_by(|a, b| a < b), "{codes:?}");
    for code in Code::ALL {
        assert_eq!(code.as_str().to_lowercase().parse(), Ok(*code));
        assert!(code.page().explanation().starts_with(code.as_str()));
    }
    assert!("E9999".parse::<Code>().is_err());
}

#[test]
fn at_most_three_things_are_expected_and_none_is_a_token_of_the_parser() {
    let cases = [
        ("move start to", "expected a direction or an operator, found `to`"),
        ("ready", "expected a statement or `}`, found `ready`"),
        ("a = 3 4", "expected a statement, `}` or an operator, found `4`"),
        ("a = = 3", "expected a value, found `=`"),
        ("set \"x\" high", "expected a name or a whole number, found a text in quotes"),
        ("set x hihg", "expected `high` or `low`, found `hihg`"),
        ("set 0 3", "expected `high` or `low`, found `3`"),
        ("speed quick", "expected a speed, found `quick`"),
        ("move 1 mm sideways", "expected a direction or an operator, found `sideways`"),
        ("move 1 mm up in world", "expected `base`, `tcp` or `toolmount`, found `world`"),
        ("call pick(3 4)", "expected `)`, `,` or an operator, found `4`"),
        ("barrier here", "expected a text in quotes, found `here`"),
        ("io \"open\"", "expected a name, found a text in quotes"),
        ("skip { break }", "expected `in`, found `{`"),
    ];
    for (source, expected) in cases {
        assert_eq!(message(source), expected, "{source}");
    }
    let message = mistake("frobnicate").message;
    assert_eq!(message, "expected a declaration, found `frobnicate`");
    let message = mistake("error e { colour }").message;
    assert_eq!(message, "expected a clause or `}`, found `colour`");
    let message = mistake("output lamp = x").message;
    assert_eq!(message, "expected a whole number, found `x`");
    let message = mistake("joints a = 3").message;
    assert_eq!(message, "expected `[`, found `3`");
}

#[test]
fn a_slip_of_the_pen_is_corrected() {
    let cases = [
        ("wile true { }", "while"),
        ("if true { } esle { }", "else"),
        ("set 0 hgih", "high"),
        ("repeat 3 tiems { }", "times"),
        ("wait 3 mni", "min"),
        ("move to a revresible always", "reversible"),
        ("speed slwo", "slow"),
    ];
    for (source, meant) in cases {
        let help = in_sequence(source).0.help;
        assert_eq!(help.as_deref(), Some(format!("did you mean `{meant}`?").as_str()), "{source}");
    }
    let help = mistake("sequnce main { break }").help;
    assert_eq!(help.as_deref(), Some("did you mean `sequence`?"));
}

#[test]
fn habits_from_other_languages_are_named() {
    let cases = [
        ("if a = 3 { break }", "E0015", "=", "to compare two values write `==`"),
        ("while a and b = 3 { break }", "E0015", "=", "to compare two values write `==`"),
        ("while a entered when b = 3 { break }", "E0015", "=", "to compare two values write `==`"),
        ("a = b = 3", "E0015", "=", "to compare two values write `==`"),
        ("if a && b { break }", "E0016", "&&", "write `and`"),
        ("if a || b { break }", "E0016", "||", "write `or`"),
        ("if !a { break }", "E0016", "!", "write `not`"),
        ("a := 3", "E0016", ":=", "write `=`"),
        ("i++", "E0016", "++", "write `i += 1`"),
        ("i--;", "E0016", "--", "write `i -= 1`"),
        ("i *= 2", "E0016", "*=", "write `i = i * ..`"),
        ("if a break", "E0017", "break", "put the statements into braces: `{ .. }`"),
        ("while a b = 3", "E0017", "b", "put the statements into braces: `{ .. }`"),
        ("pick(peg)", "E0010", "pick", "to call an action write `call pick(..)`"),
        ("move start", "E0010", "start", "to go to a position write `move to start`"),
        ("move 1 mm + b up", "E0010", "+", "put a sum in parentheses: `move (a + b) up`"),
    ];
    for (source, code, marked, help) in cases {
        let (diagnostic, text) = in_sequence(source);
        assert_eq!((diagnostic.code.as_str(), text.as_str()), (code, marked), "{source}");
        assert_eq!(diagnostic.help.as_deref(), Some(help), "{source}");
    }
}

#[test]
fn what_is_nearly_right_is_put_right() {
    let declarations = "io grip { set 0 high }\nadvanced move press { distance 1 mm up }\n\
                        action place(what: item) { break }\nitem vial { }\n";
    let cases = [
        ("move press", "advance press", "write `advance press`"),
        ("wait for 3 s", "wait 3 s", "write `wait 3 s`"),
        ("io grip()", "io grip", "nothing is given to it: write `io grip`"),
        (
            "call place vial",
            "call place(vial)",
            "what is given stands in parentheses: `call place(vial)`",
        ),
        ("call place(what = vial)", "call place(what: vial)", "write `what: ..`"),
        ("if force => 3 N { break }", "if force >= 3 N { break }", "write `>=`"),
        ("if force =< 3 N { break }", "if force <= 3 N { break }", "write `<=`"),
        ("if NOT input 2 { break }", "if not input 2 { break }", "write `not`"),
        (
            "wait until input 2 for up to 2 s",
            "wait until input 2 high for up to 2 s",
            "say which level: `wait until input 3 high for up to 2 s`",
        ),
    ];
    for (written, meant, help) in cases {
        let source = format!("{declarations}sequence main {{\n{written}\nbreak\n}}");
        let found = mistake(&source);
        assert_eq!(found.help.as_deref(), Some(help), "{written}");
        let change = found.suggestion.expect("a change of the text");
        let (start, end) = (change.span.start as usize, change.span.end as usize);
        let mended = [&source[..start], &change.text, &source[end..]].concat();
        assert!(mended.contains(&format!("\n{meant}\n")), "{written} becomes {mended}");
    }
}

#[test]
fn places_in_brackets_are_declared() {
    let help = "declare the position, `joints NAME = [..] deg`, and write `move to NAME`";
    for source in ["move to {0,0,0,0}", "move to [0, -90, 0] deg", "move to (0, 0)"] {
        assert_eq!(in_sequence(source).0.help.as_deref(), Some(help), "{source}");
    }
}

#[test]
fn what_is_done_again_is_said_by_its_words() {
    for word in ["retry", "again"] {
        let help = mistake(&format!("advanced move a {{ on failure {{ {word} 3 times }} }}")).help;
        assert!(help.is_some_and(|help| help.contains("repeat with perturbation")), "{word}");
    }
}

#[test]
fn a_path_stands_in_quotes() {
    let diagnostic = mistake("import poses.obv\nsequence main { break }");
    assert_eq!(diagnostic.help.as_deref(), Some("a path stands in quotes: `import \"poses.obv\"`"));
    assert_eq!(diagnostic.suggestion.map(|change| change.text).as_deref(), Some("\"poses.obv\""));
}

#[test]
fn each_line_of_other_languages_is_told() {
    let source = "sequence main {\n  PULSE($OUT[1],TRUE,0.5)\n  SWITCH n\n  ENDSWITCH\n\
                  $VEL.CP=0.05\n  FOR n=1 TO 5\n    PTP P1\n  ENDFOR\n\
                  frob($IN[2], 3)\n  LIN P2\n  wait for 3 s\n  LIN P3\n}";
    let words: Vec<&str> = mistakes(source).into_iter().map(|(_, text)| text).collect();
    let expected = [
        "PULSE($OUT[1],TRUE,0.5)",
        "SWITCH n",
        "$VEL.CP=0.05",
        "FOR n=1 TO 5",
        "PTP P1",
        "frob",
        "LIN P2",
        "for",
        "LIN P3",
    ];
    assert_eq!(words, expected);
}

#[test]
fn a_word_that_declares_is_no_declaration_within_a_clause() {
    let source = "error jam {\n severity error\n recover by reversing 2 steps\n then retry\n}\n\
                  sequence main { break }";
    let words: Vec<&str> = mistakes(source).into_iter().map(|(_, text)| text).collect();
    assert_eq!(words, ["error", "steps", "retry"]);
}

#[test]
fn what_a_program_declares_is_no_word_of_another_language() {
    let source = "sequence load { break }\nsequence main {\n  load\n  break\n}";
    assert_eq!(mistake(source).help.as_deref(), Some("write `call load`"));
}

#[test]
fn loops_of_other_languages_are_one_mistake() {
    let loops = [
        "for (i = 0; i < 10; i++) { sleep 1 s }",
        "for (int i = 0; i < 10; i++)\n{ sleep 1 s }",
        "for (var i = f(0); i < 10; i += 1) { sleep 1 s }",
        "for i in list { sleep 1 s }",
        "for i = 0 to 9 { sleep 1 s }",
    ];
    for source in loops {
        assert_eq!(in_sequence(source).0.code, Code::ForeignLoop, "{source}");
    }
}

#[test]
fn a_reserved_word_is_not_a_name() {
    let names = ["var wait = 3", "position force", "call move()", "for input from 0 to 9 { }"];
    for source in names {
        assert_eq!(in_sequence(source).0.code, Code::ReservedWord, "{source}");
    }
    // On the next line it is a statement, and the name is missing.
    assert_eq!(message("position\nbreak"), "expected a name, found `break`");
}

#[test]
fn an_unclosed_brace_is_shown_where_it_was_opened() {
    let source = "sequence a {\n  loop {\n    break\n}\nsequence b { break }\n";
    assert_eq!(mistakes(source), [("E0011", "{")]);
    let diagnostic = mistake(source);
    assert_eq!(diagnostic.primary.span.start as usize, source.find("loop {").unwrap() + 5);
    assert_eq!(diagnostic.labels[0].text, "this declaration stands in it");
    let diagnostic = mistake("sequence a { break");
    assert_eq!((diagnostic.primary.span.start, diagnostic.labels[0].span.start), (11, 18));
    assert_eq!(mistakes("error e {\n severity fatal\n"), [("E0011", "{")]);
}

#[test]
fn an_unclosed_parenthesis_is_shown_where_it_was_opened() {
    let (diagnostic, text) = in_sequence("a = (3 + 2\nbreak");
    assert_eq!((diagnostic.code, text.as_str()), (Code::UnclosedBracket, "("));
    assert_eq!(diagnostic.labels[0].text, "`)` was expected before this");
    assert_eq!(in_sequence("while (a { break }").0.code, Code::UnclosedBracket);
}

#[test]
fn a_bracket_that_closes_nothing_is_left_out() {
    assert_eq!(in_sequence("call pick(peg)) break").0.code, Code::UnmatchedBracket);
    let source = "sequence a { break } }\nmove to b\nmove to c";
    assert_eq!(mistakes(source), [("E0012", "}")]);
    let last = source.rfind('}');
    assert_eq!(Some(mistake(source).primary.span.start as usize), last);
}

#[test]
fn misplaced_statements_are_one_mistake_and_misplaced_declarations_are_kept() {
    assert_eq!(mistakes("move to a\nmove to b\nsequence main { break }"), [("E0020", "move to a")]);
    let parsed = parse("sequence main { error lost { } break }");
    assert_eq!(parsed.diagnostics[0].code, Code::DeclarationInside);
    let [Item::Sequence(main), Item::Error(lost)] = &parsed.program.items[..] else { panic!() };
    assert_eq!((main.body.statements.len(), lost.name.value), (1, "lost"));
}

#[test]
fn independent_mistakes_are_all_reported() {
    let source = "
        joints start [1, 2] rad
        item peg { keyframe grasp [0, 0, 2] mm
                   keyframe up = [0, 0, 2] mmm }
        error lost { sevrity fatal
                     respond at onze
                     recover by reversing 4 actons }
        advanced move insert { distance 3 mm sideways
                               on failure { retrun to initial position
                                            throw } }
        var gap 3
        sequence main {
          speed quick
          tool 3
          wait until input 3 high
          move to
          if x == { break } else { break }
          wait 5 kg
        }
        action pick(part item) { }
        sequence other { move a to }";
    let marked: Vec<&str> = mistakes(source).into_iter().map(|(_, text)| text).collect();
    let expected = [
        "[", "[", "mmm", "sevrity", "onze", "actons", "sideways", "retrun", "}", "3", "quick", "3",
        "high", "to", "{", "kg", "item", "to",
    ];
    assert_eq!(marked, expected);
}

#[test]
fn one_mistake_is_reported_once() {
    let cases = [
        "if x == { break } else { break }",
        "if a { break } esle { break } checkpoint b",
        "advnace to = insert 3 [ ( )",
        "irreversible \"why { move 1 mm up }\nbreak",
        "barrier “why” move to b",
        "a = 0..9",
        "a = 1_000",
        "a = 0x1F",
        "a = größe + 1",
        "foo bar { a = 3 }",
        "if a then { break }",
        "var wait = 3 s",
        "/* a comment */ break",
        "# a comment",
    ];
    for source in cases {
        let source = format!("sequence main {{ {source}\n}}\nsequence other {{ break }}");
        assert_eq!(mistakes(&source).len(), 1, "{source}: {:#?}", parse(&source).diagnostics);
    }
    let whole = "advnced move m {\n requires holding\n stop if force > 5 N\n speed slow\n }";
    assert_eq!(mistakes(whole), [("E0010", "advnced")]);
}

#[test]
fn what_is_wrong_leaves_a_gap_in_the_tree() {
    let source = "sequence main { a = 3 +; if == { break } frob nicate; break }";
    let parsed = parse(source);
    let [Item::Sequence(main)] = &parsed.program.items[..] else { panic!() };
    let [assign, condition, last] = &main.body.statements[..] else {
        panic!("{:?}", main.body.statements)
    };
    let StatementKind::Assign { value, .. } = &assign.kind else { panic!() };
    assert_eq!(value.kind, ExpressionKind::Missing);
    let StatementKind::If { condition, then, .. } = &condition.kind else { panic!() };
    assert_eq!((&condition.kind, then.statements.len()), (&ExpressionKind::Missing, 1));
    assert_eq!(last.kind, StatementKind::Break);
}

#[test]
fn numbers_out_of_range_are_refused() {
    for number in ["9223372036854775808", "1e999", "1e999 mm", "99999999999999999999"] {
        let source = format!("var a = {number}");
        assert_eq!(mistakes(&source), [("E0003", number)]);
    }
    assert_eq!(
        mistakes("io a { set 18446744073709551616 low }"),
        [("E0003", "18446744073709551616")]
    );
    assert_eq!(mistakes("io a { set 18446744073709551615 low }"), []);
}

#[test]
fn units_that_are_none_are_named_with_those_that_are() {
    let (diagnostic, text) = in_sequence("wait 5 kg");
    assert_eq!((diagnostic.code, text.as_str()), (Code::UnknownUnit, "kg"));
    assert!(diagnostic.notes[0].starts_with("the units are um, mm, cm, m, deg"));
    assert_eq!(mistakes("joints a = [1] rads"), [("E0005", "rads")]);
}

#[test]
fn the_twentieth_mistake_is_the_last() {
    let source = format!("sequence main {{\n{}}}", "a = ;\n".repeat(100));
    let diagnostics = parse(&source).diagnostics;
    assert_eq!(diagnostics.len(), 20);
    let notes = &diagnostics[19].notes;
    assert_eq!(notes.last().map(String::as_str), Some("no more than 20 mistakes are shown"));
}

#[test]
fn a_text_that_is_too_large_is_refused_unread() {
    let source = " ".repeat(MAX_SOURCE_BYTES + 1);
    assert_eq!(mistake(&source).code, Code::SourceTooLarge);
}

#[test]
fn what_a_bare_name_is_used_by_is_said() {
    let declarations = "io grip { set 0 high }\nadvanced move probe { distance 1 mm up }\n\
                        error jam { }\nsequence part { break }\naction pick { break }\n\
                        joints home = [1] deg\n";
    let cases = [
        ("grip", "io grip"),
        ("part", "call part"),
        ("pick", "call pick"),
        ("probe", "advance probe"),
        ("jam", "throw jam"),
        ("home", "move to home"),
    ];
    for (name, statement) in cases {
        let found = mistake(&format!("{declarations}sequence main {{\n  {name}\n  break\n}}"));
        assert_eq!(found.help, Some(format!("write `{statement}`")), "{name}");
    }
}

#[test]
fn a_move_with_its_words_in_another_order_is_put_right() {
    let cases = [
        ("move up 20 mm", "the distance comes first: `move 20 mm up`"),
        ("move up", "say how far before the direction: `move 20 mm up`"),
        ("move home", "to go to a position write `move to home`"),
    ];
    for (source, help) in cases {
        assert_eq!(in_sequence(source).0.help.as_deref(), Some(help), "{source}");
    }
}

#[test]
fn what_was_read_in_a_block_that_is_not_closed_is_kept() {
    let source = "sequence main {\n  wait 1 s\n  if true {\n    break\n    move to";
    let parsed = parse(source);
    let codes: Vec<Code> = parsed.diagnostics.iter().map(|one| one.code).collect();
    assert_eq!(codes, [Code::UnclosedBracket], "{:#?}", parsed.diagnostics);
    let [Item::Sequence(main)] = &parsed.program.items[..] else { panic!("one sequence") };
    assert_eq!(main.body.statements.len(), 2, "{main:#?}");
}
