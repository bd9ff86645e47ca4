//! Texts that are no programs, or hardly: a message with a place, no panic, and time in proportion
//! to the length.

use obverse_compiler::{Compiled, compile};
use obverse_syntax::codes::Code;
use obverse_syntax::source::LineIndex;
use std::path::Path;
use std::time::{Duration, Instant};

const PROGRAM: &str = "joints home = [0, -90, 90, -90, -90, 0] deg
sequence main {
  move to home
  wait 1 s
}
";

/// Compiles, and checks what holds of every text.
fn check(text: &str) -> Compiled {
    let compiled = compile("text.obv", text);
    for diagnostic in &compiled.diagnostics {
        let span = diagnostic.primary.span;
        let range = span.start as usize..span.end as usize;
        // What is wrong with a library's file lies behind the text.
        let is_in_text = text.get(range).is_some() || text.contains("import library");
        assert!(is_in_text, "{diagnostic:?}");
        assert!(!diagnostic.message.is_empty() && diagnostic.message.len() < 1000);
    }
    assert!(compiled.diagnostics.len() <= 420, "{}", compiled.diagnostics.len());
    compiled
}

fn codes(text: &str) -> Vec<Code> {
    check(text).diagnostics.iter().map(|one| one.code).collect()
}

/// That four times the text takes no more than so many times the time, of a text that is long
/// enough to be measured.
fn is_proportional(what: &str, write: impl Fn(usize) -> String) {
    let time = |times: usize| {
        let text = write(times);
        let take = || {
            let begin = Instant::now();
            check(&text);
            begin.elapsed()
        };
        take().min(take())
    };
    let (short, long) = (time(20_000), time(80_000));
    // Others may be using the machine: what is looked for is the square, sixteen times as long.
    let bound = short * 10 + Duration::from_millis(300);
    assert!(long <= bound, "{what}: {short:?}, and four times as much takes {long:?}");
}

#[test]
fn a_million_brackets_are_refused() {
    for bracket in ["{", "(", "[", "if true {", "loop {", "- ", "not ", "else if a {", "f("] {
        for head in ["", "sequence main {", "var a = ", "sequence main { wait "] {
            let text = format!("{head}{}", bracket.repeat(1_000_000));
            let found = codes(&text);
            assert!(found[0].as_str().starts_with('E'), "{head}{bracket}");
        }
    }
    let closed = format!("var a = {}1{}", "(".repeat(1_000_000), ")".repeat(1_000_000));
    assert!(codes(&closed).contains(&Code::NestingTooDeep));
}

#[test]
fn texts_without_sense_take_time_in_proportion() {
    let pieces = [
        "} ",
        ") ",
        "a ",
        "a\n",
        "1 ",
        "= ",
        "° ",
        "\" ",
        "$ ",
        "MoveJ p10;\n",
        "IF a THEN\n",
        "x++\n",
        "a = b\n",
        "move to\n",
        "0,5 ",
        "step 2 ",
        "ENDIF\n",
        "é ",
        "allow W0001 \"x\" ",
        "}\n",
        "error a { then }\n",
        "// x\n",
        "{ } ",
        "} else { ",
        "foo bar\n",
    ];
    for piece in pieces {
        is_proportional(piece, |times| piece.repeat(times));
        is_proportional(piece, |times| format!("sequence main {{{}}}", piece.repeat(times)));
    }
}

#[test]
fn programs_with_many_mistakes_take_time_in_proportion() {
    let each = |times: usize, write: &dyn Fn(usize) -> String| -> String {
        (0..times / 10).map(write).collect()
    };
    is_proportional("unknown names", |times| {
        let known = each(times, &|n| format!("joints start_{n} = [0, 0, 0, 0, 0, 0] deg\n"));
        let wrong = each(times, &|n| format!("move to strat_{n}\n"));
        format!("{known}sequence main {{\n{wrong}}}\n")
    });
    is_proportional("unused names", |times| each(times, &|n| format!("var v{n} = 1\n")) + PROGRAM);
    is_proportional("names given twice", |times| "var a = 1\n".repeat(times / 10) + PROGRAM);
    is_proportional("warnings that are meant", |times| {
        each(times, &|n| format!("allow W0001 \"it is so\" var v{n} = 1\n")) + PROGRAM
    });
    is_proportional("warnings that are meant in vain", |times| {
        let body = "allow W0002 \"it is so\" wait 1 s\n".repeat(times / 10);
        format!("sequence main {{\n{body}}}\n")
    });
    is_proportional("what is never reached", |times| {
        let unused = each(times, &|n| format!("sequence _s{n} {{ call _s{} }}\n", n.max(1) - 1));
        unused + PROGRAM
    });
    is_proportional("a long line", |times| PROGRAM.replace('\n', " ") + &"; ".repeat(times));
    is_proportional("a long sum", |times| format!("var a = {}1", "1 + ".repeat(times)));
}

#[test]
fn names_in_every_script_have_a_place() {
    let words = [
        "größe",
        "naïve",
        "Ångström",
        "позиция",
        "θέση",
        "位置",
        "ロボット",
        "로봇",
        "ตำแหน่ง",
        "מיקום",
        "موضع",
        "स्थान",
        "இடம்",
        "పని",
        "ადგილი",
        "տեղ",
        "ቦታ",
        "ទីតាំង",
        "ᎣᏍᏓ",
        "𝕩",
        "ⅷ",
        "ﬁx",
        "e\u{301}",
        "🤖",
        "a\u{200D}b",
        "\u{202E}evil",
        "ß",
        "ǅ",
        "İ",
        "ſ",
        "\u{212A}",
        "Ａ",
    ];
    for word in words {
        for text in [
            format!("{PROGRAM}joints {word} = [0, 0, 0, 0, 0, 0] deg\n"),
            format!("{PROGRAM}sequence other {{ move to {word} }}\n"),
            format!("{PROGRAM}{word}\n"),
            format!("{PROGRAM}var {word}_1 = 3 {word}\n"),
        ] {
            let compiled = check(&text);
            let lines = LineIndex::new(&text);
            let found = compiled.diagnostics.first().expect("a message");
            assert_eq!(lines.position(found.primary.span.start).line, 6, "{text}: {found:?}");
            assert!(compiled.module.is_none(), "{text}");
        }
        // In comments and texts every script is welcome.
        let text = PROGRAM.replace("wait 1 s", &format!("barrier \"{word}\" // {word}"));
        assert_eq!(codes(&text), [], "{word}");
    }
}

#[test]
fn lines_end_in_any_way() {
    for end in ["\n", "\r\n", "\r", "\n\n", "\n\r", "\x0C\n"] {
        assert_eq!(codes(&PROGRAM.replace('\n', end)), [], "{end:?}");
    }
    // These end no line of a program.
    for end in ["\u{B}", "\u{85}", "\u{2028}", "\u{2029}", "\u{1C}"] {
        let found = codes(&PROGRAM.replace('\n', end));
        assert_eq!(found.first(), Some(&Code::UnexpectedCharacter), "{end:?}: {found:?}");
    }
    assert_eq!(codes(&format!("\u{FEFF}{PROGRAM}")), []);
    assert_eq!(codes(&format!("{PROGRAM}\u{FEFF}")), [Code::UnexpectedCharacter]);
}

#[test]
fn what_is_no_text_is_said_to_be_none() {
    let help = |bytes: &[u8]| {
        let found = obverse_syntax::text_of(bytes).expect_err("no text");
        assert_eq!(found.code, Code::NotText);
        found.help.unwrap_or_default()
    };
    let wide: Vec<u8> =
        [0xFEFF].into_iter().chain(PROGRAM.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    assert!(help(&wide).contains("UTF-16"));
    assert!(help("größ".as_bytes().split_at(6).0.split_at(3).0).contains("cut off"));
    assert!(help(b"\x7FELF\xFF\x01").contains("UTF-8"));
    assert_eq!(codes("sequence main { wait 1 s }\0"), [Code::NotText]);
}

/// Every program that is shown or wrong, cut off at every byte.
#[test]
fn files_cut_off_at_any_byte_give_messages() {
    for (folder, step) in [("programs", 1), ("tests/corpus", 7)] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let entries = std::fs::read_dir(folder).expect("a folder of the project");
        for path in entries.map(|entry| entry.expect("an entry").path()) {
            if path.extension().is_none_or(|extension| extension != "obv") {
                continue;
            }
            let bytes = std::fs::read(&path).expect("a file");
            for end in (0..bytes.len()).step_by(step) {
                if let Ok(text) = obverse_syntax::text_of(&bytes[..end]) {
                    let compiled = check(text);
                    let is_told = compiled.module.is_some() || !compiled.diagnostics.is_empty();
                    assert!(is_told, "{} to {end}", path.display());
                }
            }
        }
    }
}
