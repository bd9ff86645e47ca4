//! What belongs where one writes: parameters of calls, and forms of commands.

use crate::support::{Editor, Texts, marked, opened, uri};
use serde_json::{Value, json};

const HEAD: &str = "\
import library \"insert\"
item peg { keyframe grasp = [0, 0, 0] mm }
// Pushes as far as it goes.
// Twice, if asked to.
action push(depth: length in 1 mm to 30 mm = 20 mm, twice: bool = false,
    what: item) { move depth up if twice { move depth up } }
sequence main {
";

/// The answer at the mark of a text in a sequence: label, the parameter at hand, and all of it.
fn at(rest: &str) -> Option<(String, String, Value)> {
    within(&format!("{HEAD}  {rest}"))
}

fn within(source: &str) -> Option<(String, String, Value)> {
    let (mut editor, places) = opened(source);
    let place = places[0]["start"].clone();
    let answer = editor.at("signatureHelp", "main.obv", place).expect("an answer");
    let signature = answer["signatures"].get(0)?;
    let label = signature["label"].as_str().expect("a label").to_owned();
    let active = answer["activeParameter"].as_u64().expect("a number") as usize;
    let parameter = &signature["parameters"][active]["label"];
    let offset = |index: usize| parameter[index].as_u64().map_or(0, |offset| offset as usize);
    let (start, end) = (offset(0), offset(1));
    let at_hand: String = label.chars().skip(start).take(end - start).collect();
    Some((label, at_hand, answer))
}

/// The parameter at hand.
fn at_hand(rest: &str) -> String {
    at(rest).map_or_else(|| "nothing".to_owned(), |(_, at_hand, _)| at_hand)
}

#[test]
fn a_call_tells_parameters_with_units_ranges_and_defaults() {
    let (label, at_hand, answer) = at("call push(«»").expect("a signature");
    let expected = "push(depth: length in 1 mm to 30 mm = 20 mm, twice: bool = false, what: item)";
    assert_eq!(label, expected);
    assert_eq!(at_hand, "depth: length in 1 mm to 30 mm = 20 mm");
    let signature = &answer["signatures"][0];
    let said = |index: usize| signature["parameters"][index]["documentation"]["value"].clone();
    let depth = "length, in um, mm, cm or m; from 1 mm to 30 mm; 20 mm where it is left out";
    assert_eq!(said(0), depth);
    assert_eq!(said(2), "item; must be given");
    let comment = &signature["documentation"]["value"];
    assert_eq!(comment, "Pushes as far as it goes.\nTwice, if asked to.");
}

#[test]
fn the_parameter_at_hand_is_found_by_order_and_by_name() {
    let name = |rest: &str| at_hand(rest).split(':').next().unwrap_or_default().to_owned();
    assert_eq!(name("call push(3 mm«»"), "depth");
    assert_eq!(name("call push(3 mm, «»)"), "twice");
    assert_eq!(name("call push(3 mm, tw«»"), "twice");
    assert_eq!(name("call push(what: «»peg, depth: 3 mm)"), "what");
    assert_eq!(name("call push(what: peg, depth: «»"), "depth");
    assert_eq!(name("call push(3 mm, what: peg, «»"), "twice", "what is left");
    assert_eq!(name("call push(3 mm, true, peg, «»"), "", "none is left");
    assert_eq!(name("call push(what: peg, nobody: «»"), "", "there is none of this name");
    assert_eq!(name("call push((3 mm + [1, 2, «»"), "depth", "its commas are not the call's");
    assert_eq!(name("call push «»"), "depth", "before there is a bracket");
}

#[test]
fn an_action_of_the_library_is_told_of_as_its_file_does() {
    let rest = "call insert_with_spiral_search(depth: 20 mm, force_limit: «»";
    let (_, at_hand, answer) = at(rest).expect("a signature");
    assert_eq!(at_hand, "force_limit: force in 1 N to 60 N = 8 N");
    let comment = answer["signatures"][0]["documentation"]["value"].as_str().expect("a comment");
    assert!(comment.contains("feels for the hole") && comment.contains("Class: after forward"));
}

#[test]
fn a_function_within_an_argument_is_the_one_that_is_told_of() {
    assert_eq!(at("call push(min(3 mm, «»").expect("a signature").0, "min(value, other)");
    assert_eq!(at_hand("call push(min(3 mm, «»"), "other");
    assert_eq!(at_hand("call push(min(3 mm, 4 mm), «»").split(':').next(), Some("twice"));
}

#[test]
fn a_command_tells_its_form_and_where_in_it_one_is() {
    let moved = "move distance direction [in frame] [linearly] [reversible always]";
    assert_eq!(at("move «»").expect("a form").0, moved);
    for (rest, part) in [
        ("move «»", "distance"),
        ("move 20 «»", "distance"),
        ("move 20 mm«»", "distance"),
        ("move 20 mm «»", "direction"),
        ("move (20 mm + «»", "distance"),
        ("move 20 mm -«»", "distance"),
        ("move 20 mm up in «»", "frame"),
        ("move 20 mm\n    up in «»", "frame"),
        ("move to «»", "place"),
        ("move to peg.«»", "place"),
        ("move to peg.grasp «»", ""),
        ("turn 90 deg advancing «»", "distance"),
        ("wait «»", "time"),
        ("wait until «»", "input"),
        ("wait until input 3 «»", "level"),
        ("wait until input 3 high for up to «»", "time"),
        ("set 2 «»", "level"),
        ("set 2 high; sleep «»", "time"),
        ("repeat «»", "count"),
        ("repeat 3 times { move to peg.grasp }\n  speed «»", "speed"),
        ("speed very «»", "speed"),
        ("for index from 1 to «»", "number"),
        ("requires holding else throw «»", "error"),
        ("with force limit «»", "force"),
    ] {
        assert_eq!(at_hand(rest), part, "{rest}");
    }
    let clause = |rest: &str| within(rest).expect("a form").1;
    assert_eq!(clause("advanced move insert { distance 3 mm «»"), "direction");
    assert_eq!(clause("advanced move a { on failure { repeat with perturbation «»"), "distance");
    assert_eq!(clause("error jam { severity «»"), "severity");
    assert_eq!(clause("error jam { recover by reversing up to «»"), "count");
}

#[test]
fn nothing_is_told_where_nothing_is_written() {
    for rest in [
        "«»",
        "gap = «»",
        "move to peg.grasp\n  gap = «»",
        "// move «»",
        "barrier \"call push(«»",
        "call nobody(«»",
        "call push(3 mm)\n  «»",
        "if holding {«»",
    ] {
        assert_eq!(at_hand(rest), "nothing", "{rest}");
    }
    // What is begun and not closed does not reach into the next statement.
    assert_eq!(at_hand("call push(3 mm,\n  wait «»"), "time");
    assert_eq!(within("«»"), None);
}

#[test]
fn a_declaration_with_a_mistake_elsewhere_is_told_of_yet() {
    let source = "action go(far: length) { move move far up }\nsequence main { call go(«»";
    assert_eq!(within(source).expect("a signature").1, "far: length");
}

#[test]
fn it_is_promised_and_asked_for_by_brackets_and_blanks() {
    let mut editor = Editor::uninitialized(crate::support::Texts::default());
    let told = editor.ask("initialize", json!({ "capabilities": {} })).expect("an answer");
    let provider = &told["capabilities"]["signatureHelpProvider"];
    assert_eq!(provider["triggerCharacters"], json!(["(", ",", ":", " "]));
    let (text, places) = marked("sequence main { wait «»");
    editor.tell("initialized", json!({}));
    editor.open("main.obv", &text);
    let document = json!({ "uri": uri("main.obv") });
    let position = places[0]["start"].clone();
    let context = json!({ "triggerKind": 2, "triggerCharacter": "(", "isRetrigger": false });
    let params = json!({ "textDocument": document, "position": position, "context": context });
    let answer = editor.ask("textDocument/signatureHelp", params).expect("an answer");
    assert_eq!(answer["signatures"][0]["label"], "wait time");
}

#[test]
fn an_editor_that_knows_how_is_told_that_no_parameter_is_at_hand() {
    let can = json!({ "signatureHelp": { "noActiveParameterSupport": true } });
    for (can, expected) in [(can, json!(null)), (json!({}), json!(3))] {
        let (text, places) = marked(&format!("{HEAD}  call push(nothing: «»"));
        let mut editor = Editor::uninitialized(Texts::default());
        let params = json!({ "capabilities": { "textDocument": can } });
        editor.ask("initialize", params).expect("it is initialized");
        editor.tell("initialized", json!({}));
        editor.open("main.obv", &text);
        let place = places[0]["start"].clone();
        let answer = editor.at("signatureHelp", "main.obv", place).expect("an answer");
        assert!(answer.as_object().is_some_and(|it| it.contains_key("activeParameter")));
        assert_eq!(answer["activeParameter"], expected, "{answer}");
    }
}
