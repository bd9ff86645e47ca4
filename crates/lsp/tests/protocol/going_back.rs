//! What the editor shows of going back: hover, hints, lenses.

use crate::support::{Editor, hover, marked, opened, uri};
use serde_json::{Value, json};

const GLUE: &str = "\
io grip { set 0 high; sleep 0.3 s } reverse release
io release { set 0 low; sleep 0.3 s }
joints home = [0, -90, 90, -90, -90, 0] deg
sequence fetch {
  move to home
  io grip
}
sequence main {
  call fetch
  barrier \"the glue has set\"
  move to home
  wait 1 s
}
";

#[test]
fn a_name_tells_what_it_is() {
    let text = hover("var gap: length = 3 mm\nsequence main { move «gap» up }");
    assert!(text.contains("```obverse\nvar gap: length = 3 mm\n```"), "{text}");
    assert!(text.contains("A variable of the program: a length (um, mm, cm or m)"), "{text}");
    let text =
        hover("item peg { keyframe top = [0, 0, 0] mm } sequence main { move to peg.«top» }");
    assert!(text.contains("A keyframe of the item `peg`"), "{text}");
    let text = hover("sequence main { for «i» from 1 to 3 { wait 1 s } }");
    assert!(text.contains("A counter of a loop: an integer"), "{text}");
}

#[test]
fn an_operation_tells_its_class_and_its_counterpart() {
    let text = hover(&GLUE.replacen("io grip\n", "io «grip»\n", 1));
    assert!(text.contains("An I/O operation"), "{text}");
    assert!(text.contains("Class *after-forward*: it can be taken back to its start"), "{text}");
    assert!(text.contains("In reverse: `io release`"), "{text}");
    assert!(text.contains("From before this statement a run goes back to the start"), "{text}");
    let text = hover("io «on» { set 3 high } sequence main { io on }");
    assert!(text.contains("In reverse: its outputs take their former levels"), "{text}");
}

#[test]
fn a_statement_tells_how_far_back_it_goes() {
    let text = hover(&GLUE.replacen("\n  wait", "\n  «wait»", 1));
    assert!(text.contains("In reverse: not waited for again"), "{text}");
    let text = hover(&GLUE.replacen("  move to home\n  wait", "  «move» to home\n  wait", 1));
    assert!(text.contains("Class *after-forward*"), "{text}");
    assert!(text.contains("In reverse: back to where it began, as recorded"), "{text}");
    let stop = "goes back to just after line 10: the glue has set";
    assert!(text.contains(stop), "{text}");
    let text = hover(&GLUE.replacen("barrier", "«barrier»", 1));
    assert!(text.contains("Class *never*"), "{text}");
}

#[test]
fn what_cannot_be_taken_back_within_a_statement_is_not_promised() {
    let source = "\
sequence draw {
  irreversible \"the glue is on\" { set 3 high }
  move 3 mm up
}
sequence main {
  call draw
}
";
    let text = hover(&source.replacen("  call", "  «call»", 1));
    assert!(text.contains("Class *never*"), "{text}");
    let taken = "In reverse: what it did is taken back, the last first; but going back stops \
                 within it, at line 2: the glue is on";
    assert!(text.contains(taken), "{text}");
    let text = hover(&source.replacen("irreversible", "«irreversible»", 1));
    assert!(text.contains("In reverse: going back ends here"), "{text}");
}

#[test]
fn every_word_of_an_advanced_move_tells_what_it_is() {
    let source = "\
error jams { severity recoverable }
advanced move press {
  requires not holding else throw jams
  distance 60 mm forward in tcp
  speed very slow
  stop if force > 15 N
  succeeds if distance > 200 mm and force < 3 N
  on failure { repeat with perturbation 1 mm 3 times return to initial position throw jams }
  on success { return to initial position }
  opposite force in reverse
} reverse back
advanced move back { turn 90 deg advancing 2 mm forward in base }
sequence main { advance press }
";
    for (marked, says) in [
        ("«advanced» move press", "A motion that feels"),
        ("«requires» not", "must hold before the motion"),
        ("requires not «holding»", "Whether an item is held"),
        ("«distance» 60", "a length above zero, in um, mm, cm or m"),
        ("60 mm «forward»", "the way in which it looks"),
        ("forward in «tcp»", "the tool centre point"),
        ("«speed» very slow", "in mm/s"),
        ("speed very «slow»", "in mm/s"),
        ("«stop» if", "The motion stops at the instant"),
        ("stop if «force»", "a force, in N"),
        ("«succeeds» if", "What success is"),
        ("succeeds if «distance»", "has come along its way: a length"),
        ("200 mm and «force»", "The largest force that was felt on the way, in N"),
        ("on «failure»", "has not succeeded"),
        ("repeat with «perturbation»", "1 mm where none is given"),
        ("3 times «return»", "Straight back to where the move began"),
        ("position «throw»", "Raises an error"),
        ("on «success»", "where it has succeeded"),
        ("«opposite» force", "as much force as the way there, in N"),
        ("} «reverse»", "takes its place going back"),
        ("«turn» 90", "an angle, in deg or rad"),
        ("«advancing»", "while it is turned: a length"),
        ("forward in «base»", "the base of the arm"),
    ] {
        let plain = marked.replace(['«', '»'], "");
        assert!(source.contains(&plain), "{marked}");
        let text = hover(&source.replacen(&plain, marked, 1));
        assert!(text.contains(says), "{marked}: {text}");
    }
}

#[test]
fn units_types_and_codes_are_told() {
    assert!(hover("sequence main { wait 3 «ms» }").contains("The unit of a time"));
    assert!(hover("sequence main(x: «force») { }").contains("have a unit: N"));
    let code = hover("allow «W0001» \"meant\"\nvar x = 1\nsequence main { }");
    assert!(code.contains("**W0001**"), "{code}");
    assert_eq!(hover("sequence main { wait 3 s } // «wait»"), "");
}

fn hints(editor: &mut Editor) -> Vec<(u64, String)> {
    let all = json!({ "start": { "line": 0, "character": 0 },
                      "end": { "line": 1000, "character": 0 } });
    let params = json!({ "textDocument": { "uri": uri("main.obv") }, "range": all });
    let hints = editor.ask("textDocument/inlayHint", params).expect("a list");
    let hint = |one: &Value| {
        let line = one["position"]["line"].as_u64().expect("a line") + 1;
        (line, one["label"].as_str().expect("a label").to_owned())
    };
    hints.as_array().expect("a list").iter().map(hint).collect()
}

fn expected_hints() -> Vec<(u64, String)> {
    let hint = |line, label: &str| (line, label.to_owned());
    vec![
        hint(5, "after"),
        hint(6, "after"),
        hint(9, "after"),
        hint(10, "never"),
        hint(11, "after"),
        hint(12, "always"),
    ]
}

#[test]
fn each_action_shows_its_class_at_the_end_of_its_line() {
    let (mut editor, _) = opened(GLUE);
    assert_eq!(hints(&mut editor), expected_hints());
}

#[test]
fn only_the_lines_that_are_asked_for_are_told() {
    let (mut editor, _) = opened(GLUE);
    let range = json!({ "start": { "line": 9, "character": 0 },
                        "end": { "line": 9, "character": 5 } });
    let params = json!({ "textDocument": { "uri": uri("main.obv") }, "range": range });
    let hints = editor.ask("textDocument/inlayHint", params).expect("a list");
    assert_eq!(hints.as_array().map(Vec::len), Some(1));
    assert_eq!(hints[0]["position"], json!({ "line": 9, "character": 28 }));
    let tooltip = hints[0]["tooltip"].as_str().expect("a text");
    assert!(tooltip.starts_with("cannot be taken back"), "{tooltip}");
}

#[test]
fn a_sequence_shows_how_far_it_goes_back() {
    let (mut editor, _) = opened(GLUE);
    let lenses = editor.of("codeLens", "main.obv");
    let told: Vec<(u64, &str)> = lenses
        .as_array()
        .expect("a list")
        .iter()
        .map(|lens| {
            let line = lens["range"]["start"]["line"].as_u64().expect("a line") + 1;
            (line, lens["command"]["title"].as_str().expect("a title"))
        })
        .collect();
    let stop = "stops at line 10: the glue has set";
    assert_eq!(told, [(4, "goes back to its start"), (8, stop)]);
}

/// While a line is being written, what was known of the others stays.
#[test]
fn half_a_line_takes_no_hint_of_the_others_away() {
    let (text, places) = marked(&GLUE.replacen("  io grip\n", "  io grip\n«»", 1));
    let mut editor = Editor::new();
    editor.open("main.obv", &text);
    assert_eq!(hints(&mut editor).len(), expected_hints().len());
    editor.change("main.obv", json!([{ "range": places[0], "text": "  move to \n" }]));
    let moved = |(line, label): (u64, String)| (if line > 6 { line + 1 } else { line }, label);
    let expected: Vec<_> = expected_hints().into_iter().map(moved).collect();
    assert_eq!(hints(&mut editor), expected);
    let lenses = editor.of("codeLens", "main.obv");
    assert_eq!(lenses[1]["command"]["title"], "stops at line 11: the glue has set");
}
