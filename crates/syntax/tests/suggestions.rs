//! What is suggested mends: made in the text, each suggestion lessens what is wrong with it. Tried
//! with statements that are cut off after each of their words, before what may follow them.

use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::parse;

/// Statements in which every word of the language that begins or joins one occurs.
const STATEMENTS: &[&str] = &[
    "move to start linearly",
    "move to vial . above",
    "move 20 mm up in base",
    "move linearly to start",
    "call pick ( 3 , vial )",
    "io open",
    "throw jammed",
    "advance insert",
    "tool gripper",
    "checkpoint here",
    "position seen",
    "var n : int = 3",
    "x = y + 3",
    "x += 1",
    "x ++",
    "set lamp = high",
    "set 1 on",
    "toggle 2",
    "sleep 0.5 s",
    "wait 2 s",
    "wait until input 3 high for up to 2 s else { return }",
    "wait for input 3",
    "wait until x > 3",
    "speed very slow",
    "if x > 3 { return } else { break }",
    "while x < 3 entered when x == 0 { x += 1 }",
    "repeat 3 times { return }",
    "repeat until x > 3 { return }",
    "for i from 1 to 3 { return }",
    "for i from 3 down to 1 { return }",
    "loop { break }",
    "fork { return } and { return }",
    "fork { return } { return }",
    "skip in reverse { return }",
    "keep in reverse { return }",
    "do { return } in reverse { return }",
    "do { return } undo { return }",
    "with speed slow , force limit 5 N in reverse { return }",
    "irreversible \"glue\" { return }",
    "barrier \"glue\"",
    "requires x > 3 else throw jammed",
];

/// What may come behind, on a line of its own or not.
const FOLLOWING: &[&str] = &[
    "\ntoggle 1",
    " toggle 1",
    "\nmove to start",
    "\nx = 3",
    "\nwait 1 s",
    "",
    " { toggle 1 }",
    " = 3",
];

fn suggested(source: &str, diagnostic: &Diagnostic) -> Option<String> {
    let suggestion = diagnostic.suggestion.as_ref()?;
    let mut mended = source.to_owned();
    mended.replace_range(
        suggestion.span.start as usize..suggestion.span.end as usize,
        &suggestion.text,
    );
    Some(mended)
}

/// Where what is wrong begins, from the end of the text, so that a change before it moves nothing.
fn first_mistake(source: &str) -> Option<(usize, usize)> {
    let diagnostics = parse(source).diagnostics;
    let first = diagnostics.first()?;
    Some((source.len() - first.primary.span.start as usize, diagnostics.len()))
}

#[test]
fn a_suggestion_lessens_what_is_wrong() {
    let (mut tried, mut wrong) = (0, Vec::new());
    for statement in STATEMENTS {
        let words: Vec<&str> = statement.split(' ').collect();
        for count in 1..=words.len() {
            for following in FOLLOWING {
                let written = words[..count].join(" ");
                let source = format!("sequence main {{\nwait 1 s\n{written}{following}\n}}\n");
                let is_open = written.matches('{').count() > written.matches('}').count();
                if is_open || written.contains('(') && following.contains('=') {
                    // That a block lacks its end is the greater mistake; and whether a bracket
                    // does, or `=` is meant as `==`, cannot be told.
                    continue;
                }
                for one in &parse(&source).diagnostics {
                    let Some(mended) = suggested(&source, one) else { continue };
                    tried += 1;
                    if !is_less(first_mistake(&source), first_mistake(&mended)) {
                        let help = one.help.as_deref().unwrap_or_default();
                        wrong.push(format!("{help}, and {source} becomes {mended}"));
                    }
                }
            }
        }
    }
    assert!(tried > 100, "{tried} suggestions");
    assert!(wrong.is_empty(), "{} of {tried}:\n{}", wrong.len(), wrong.join("\n"));
}

/// Whether there are fewer mistakes, or the first comes later.
fn is_less(before: Option<(usize, usize)>, after: Option<(usize, usize)>) -> bool {
    match (before, after) {
        (_, None) => true,
        (Some((rest, count)), Some((left, others))) => others < count || left < rest,
        (None, Some(_)) => false,
    }
}

#[test]
fn nothing_is_said_of_a_declaration_where_a_name_or_a_value_is_missing() {
    let unfinished = [
        "move to",
        "call",
        "io",
        "throw",
        "advance",
        "tool",
        "checkpoint",
        "position",
        "x =",
        "wait",
        "set",
        "toggle",
        "if x >",
        "while",
        "x +=",
    ];
    for statement in unfinished {
        for next in
            ["toggle 1", "wait 1 s", "move to start", "{ toggle 1 }", "for i from 1 to 2 {}"]
        {
            let source = format!("sequence main {{\n  {statement}\n  {next}\n}}\n");
            for one in parse(&source).diagnostics {
                let help = one.help.unwrap_or_default();
                let foreign = ["keyframe", "times", "stop if", "actions", "severity"];
                assert!(!foreign.iter().any(|word| help.contains(word)), "{source}{help}");
            }
        }
    }
}
