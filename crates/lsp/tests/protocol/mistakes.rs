//! Diagnostics as one types, and what mends them.

use crate::support::{Editor, edited, marked, opened, uri};
use serde_json::{Value, json};

const WRONG: &str = "\
joints home = [0, 0, 0, 0, 0, 0] deg
sequence main {
  move to «hmoe»
}
";

#[test]
fn a_mistake_is_told_where_it_is() {
    let (mut editor, places) = opened(WRONG);
    let found = editor.diagnostics("main.obv");
    let [one] = found.as_slice() else { panic!("{found:?}") };
    assert_eq!(one["range"], places[0]);
    assert_eq!((&one["code"], &one["severity"]), (&json!("E0101"), &json!(1)));
    assert_eq!(one["source"], "obverse");
    let message = one["message"].as_str().expect("a message");
    assert!(message.contains("there is no `hmoe`"), "{message}");
    assert!(message.contains("help: did you mean `home`?"), "{message}");
}

#[test]
fn further_places_are_told_as_related() {
    let (mut editor, places) =
        opened("var «x» = 1\nvar x = 2\nsequence main {\n  wait real(x) * 1 s\n}\n");
    let found = editor.diagnostics("main.obv");
    let related = &found[0]["relatedInformation"][0];
    assert_eq!(related["location"], json!({ "uri": uri("main.obv"), "range": places[0] }));
}

#[test]
fn a_key_stroke_mends_and_unmends() {
    let (text, places) = marked(WRONG);
    let mut editor = Editor::new();
    editor.open("main.obv", &text);
    assert_eq!(editor.diagnostics("main.obv").len(), 1);
    editor.change("main.obv", json!([{ "range": places[0], "text": "home" }]));
    assert_eq!(editor.diagnostics("main.obv"), Vec::<Value>::new());
    editor.change("main.obv", json!([{ "text": text }]));
    assert_eq!(editor.diagnostics("main.obv").len(), 1);
}

#[test]
fn several_changes_are_done_in_their_order_and_counted_in_utf_16() {
    let mut editor = Editor::new();
    editor.open("main.obv", "// \u{1F916}ä\nsequence main { wait 1 mm }\n");
    assert_eq!(editor.diagnostics("main.obv").len(), 1);
    let at = |line: u32, start: u32, end: u32| {
        json!({ "start": { "line": line, "character": start },
                "end": { "line": line, "character": end } })
    };
    let changes = json!([
        { "range": at(0, 5, 6), "text": "\nsequence other { }" },
        { "range": at(2, 23, 25), "text": "s" },
        { "range": at(1, 9, 14), "text": "_spare" },
    ]);
    editor.change("main.obv", changes);
    assert_eq!(editor.diagnostics("main.obv"), Vec::<Value>::new());
}

#[test]
fn of_many_changes_in_a_row_the_last_counts() {
    let mut editor = Editor::new();
    editor.open("main.obv", "");
    let whole = include_str!("../../../../programs/press_fit.obv");
    for end in (0..whole.len()).step_by(16).chain([whole.len()]) {
        editor.change("main.obv", json!([{ "text": &whole[..end] }]));
    }
    // What was asked last is answered last, and then nothing is left to be said.
    editor.of("documentSymbol", "main.obv");
    while !editor.diagnostics("main.obv").is_empty() {}
    let count = editor.publications[&uri("main.obv")];
    assert!(count < whole.len() / 16, "published {count} times");
}

#[test]
fn what_a_diagnostic_offers_is_a_quick_fix() {
    let (text, places) = marked(WRONG);
    let mut editor = Editor::new();
    editor.open("main.obv", &text);
    let params = json!({
        "textDocument": { "uri": uri("main.obv") },
        "range": places[0],
        "context": { "diagnostics": [] },
    });
    let actions = editor.ask("textDocument/codeAction", params).expect("a list");
    let action = &actions[0];
    assert_eq!(
        (&action["title"], &action["kind"]),
        (&json!("did you mean `home`?"), &json!("quickfix"))
    );
    let mended = edited(&text, &action["edit"]["changes"][uri("main.obv")]);
    assert_eq!(mended, text.replace("hmoe", "home"));
    assert_eq!(actions.as_array().map(Vec::len), Some(1));
}

#[test]
fn nothing_is_offered_where_nothing_is_wrong() {
    let (mut editor, places) = opened(&format!("«»{WRONG}"));
    let params = json!({
        "textDocument": { "uri": uri("main.obv") },
        "range": places[0],
        "context": { "diagnostics": [] },
    });
    assert_eq!(editor.ask("textDocument/codeAction", params), Ok(json!([])));
}

#[test]
fn a_text_is_formatted_by_the_least_change() {
    let text = "sequence main {\n  wait 1 s\n    wait   2 s\n  wait 3 s\n}\n";
    let mut editor = Editor::new();
    editor.open("main.obv", text);
    let params = json!({
        "textDocument": { "uri": uri("main.obv") },
        "options": { "tabSize": 4, "insertSpaces": true },
    });
    let edits = editor.ask("textDocument/formatting", params.clone()).expect("edits");
    let expected = "sequence main {\n  wait 1 s\n  wait 2 s\n  wait 3 s\n}\n";
    assert_eq!(edited(text, &edits), expected);
    assert_eq!(edits[0]["range"]["start"]["line"], 2);
    editor.change("main.obv", json!([{ "text": "sequence main {" }]));
    assert_eq!(editor.ask("textDocument/formatting", params), Ok(Value::Null));
}

#[test]
fn where_a_unit_is_to_be_chosen_each_is_a_quick_fix() {
    let (text, places) = marked("sequence main {\n  wait «5»\n  move «80» up in base\n}\n");
    let mut editor = Editor::new();
    editor.open("main.obv", &text);
    for (place, expected) in
        [(0, ["wait 5 s\n", "wait 5 ms\n"]), (1, ["move 80 mm up", "move 80 m up"])]
    {
        let params = json!({
            "textDocument": { "uri": uri("main.obv") },
            "range": places[place],
            "context": { "diagnostics": [] },
        });
        let actions = editor.ask("textDocument/codeAction", params).expect("a list");
        assert_eq!(actions.as_array().map(Vec::len), Some(2), "{actions}");
        for (action, expected) in actions.as_array().into_iter().flatten().zip(expected) {
            let mended = edited(&text, &action["edit"]["changes"][uri("main.obv")]);
            assert!(mended.contains(expected), "{mended}");
            assert_eq!(action["isPreferred"], json!(null), "a person chooses");
        }
    }
}
