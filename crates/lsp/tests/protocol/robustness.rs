//! Half-written sources, places out of range, files that are not open: there is an answer to every
//! question, and the server goes on.

use crate::support::{Editor, uri};
use obverse_lsp::Ended;
use serde_json::{Value, json};

/// Every question about a place, and about a text.
fn ask_everything(editor: &mut Editor, name: &str, line: u64, character: u64) {
    let at = json!({ "line": line, "character": character });
    for method in ["hover", "definition", "documentHighlight", "completion", "signatureHelp"] {
        let answer = editor.at(method, name, at.clone());
        assert!(answer.is_ok(), "{method} at {line}:{character}: {answer:?}");
    }
    // These may be refused, with a reason.
    for (method, params) in [
        ("prepareRename", json!({})),
        ("rename", json!({ "newName": "another" })),
        ("references", json!({ "context": { "includeDeclaration": true } })),
    ] {
        let mut params = params;
        params["textDocument"] = json!({ "uri": uri(name) });
        params["position"] = at.clone();
        if let Err((code, why)) = editor.ask(&format!("textDocument/{method}"), params) {
            assert!(code == -32803 && !why.is_empty(), "{method}: {code} {why}");
        }
    }
    let range = json!({ "start": at, "end": { "line": line, "character": character } });
    let document = json!({ "uri": uri(name) });
    for (method, more) in [
        ("inlayHint", json!({ "range": range })),
        ("codeAction", json!({ "range": range, "context": { "diagnostics": [] } })),
        ("formatting", json!({ "options": { "tabSize": 2, "insertSpaces": true } })),
        ("semanticTokens/full", json!({})),
        ("documentSymbol", json!({})),
        ("codeLens", json!({})),
    ] {
        let mut params = more;
        params["textDocument"] = document.clone();
        let answer = editor.ask(&format!("textDocument/{method}"), params);
        assert!(answer.is_ok(), "{method}: {answer:?}");
    }
}

/// A program that is being written, line by line and in the middle of each.
#[test]
fn a_program_cut_at_every_line_is_answered() {
    let whole = include_str!("../../../../programs/press_fit.obv");
    let mut editor = Editor::new();
    editor.open("main.obv", "");
    let mut end = 0;
    for (number, line) in (0..).zip(whole.split_inclusive('\n')) {
        for cut in [line.len() / 2, line.len()] {
            let cut = end + cut;
            editor.change("main.obv", json!([{ "text": &whole[..cut] }]));
            let column = cut - whole[..cut].rfind('\n').map_or(0, |at| at + 1);
            ask_everything(&mut editor, "main.obv", number, column as u64);
        }
        end += line.len();
    }
    assert_eq!(editor.leave(), Ended::Properly);
}

#[test]
fn places_out_of_range_are_answered() {
    let mut editor = Editor::new();
    editor.open("main.obv", "sequence main {\n  wait 1 s // \u{1F916}\n}\n");
    let most = u64::from(u32::MAX);
    for (line, character) in [(0, most), (most, 0), (most, most), (1, 14), (3, 0), (3, 9)] {
        ask_everything(&mut editor, "main.obv", line, character);
    }
    // Beyond what the protocol can say is a wrong parameter.
    let answer = editor.at("hover", "main.obv", json!({ "line": -1, "character": 0 }));
    assert_eq!(answer.expect_err("refused").0, -32602);
}

#[test]
fn changes_out_of_range_change_something_within() {
    let mut editor = Editor::new();
    editor.open("main.obv", "sequence main { wait 1 s }");
    let most = u32::MAX;
    let range = |from: (u32, u32), to: (u32, u32)| {
        json!({ "start": { "line": from.0, "character": from.1 },
                "end": { "line": to.0, "character": to.1 } })
    };
    editor
        .change("main.obv", json!([{ "range": range((most, most), (most, most)), "text": "\n" }]));
    editor.change("main.obv", json!([{ "range": range((0, most), (0, 3)), "text": "" }]));
    editor.change("main.obv", json!([{ "range": range((5, 0), (0, 0)), "text": "ä\u{1F916}" }]));
    editor.change("main.obv", json!([{ "range": range((0, 2), (0, 2)), "text": "x" }]));
    ask_everything(&mut editor, "main.obv", 0, 3);
    // A text that is not open is left alone.
    editor.change("other.obv", json!([{ "text": "sequence main { }" }]));
    assert_eq!(editor.of("documentSymbol", "other.obv"), json!([]));
}

#[test]
fn what_is_not_open_is_answered_with_nothing() {
    let mut editor = Editor::new();
    ask_everything(&mut editor, "nowhere.obv", 0, 0);
    assert_eq!(editor.of("codeLens", "nowhere.obv"), json!([]));
    assert_eq!(editor.of("semanticTokens/full", "nowhere.obv"), Value::Null);
    assert_eq!(editor.leave(), Ended::Properly);
}

#[test]
fn an_address_that_is_no_file_stands_alone() {
    let mut editor = Editor::new();
    for address in ["untitled:Untitled-1", "file:///%zz", "", "obverse-library:press.obv"] {
        let document = json!({ "uri": address, "languageId": "obverse", "version": 1,
                               "text": "import \"a.obv\"\nsequence main { wait 1 s }" });
        editor.tell("textDocument/didOpen", json!({ "textDocument": document }));
        let params = json!({ "textDocument": { "uri": address } });
        let outline = editor.ask("textDocument/documentSymbol", params).expect("an outline");
        assert_eq!(outline[0]["name"], "main", "{address}");
    }
    assert_eq!(editor.leave(), Ended::Properly);
}

#[test]
fn texts_of_any_bytes_are_answered() {
    let mut editor = Editor::new();
    let texts = [
        "\0",
        "\u{FEFF}sequence main { }",
        "\r\r\n\n",
        "\"\"\"",
        "}}}}",
        "((((",
        "ä.ö",
        "sequence main { call main(",
        "item a { keyframe",
        "import library \"",
        "3 mm/",
        "// x",
    ];
    editor.open("main.obv", "");
    for text in texts {
        editor.change("main.obv", json!([{ "text": text }]));
        ask_everything(&mut editor, "main.obv", 0, text.encode_utf16().count() as u64);
        ask_everything(&mut editor, "main.obv", 1, 0);
    }
    let deep = format!("sequence main {{ {}", "if holding { ".repeat(500));
    editor.change("main.obv", json!([{ "text": deep }]));
    ask_everything(&mut editor, "main.obv", 0, 900);
    assert_eq!(editor.leave(), Ended::Properly);
}

/// A program on one line, with letters of every width in it.
#[test]
fn a_line_without_end_is_answered_in_time() {
    let mut text = "joints home = [0, 0, 0, 0, 0, 0] deg sequence main { ".to_owned();
    for _ in 0..2_000 {
        text += "move to home; barrier \"ä\u{1F916}\"; ";
    }
    text += "}";
    let mut editor = Editor::new();
    editor.open("main.obv", &text);
    let begun = std::time::Instant::now();
    ask_everything(&mut editor, "main.obv", 0, 100);
    assert!(begun.elapsed().as_secs() < 30, "{:?}", begun.elapsed());
}
