//! Where names lead: definition, references, highlights, rename, outline.

use crate::support::{Editor, edited, marked, opened, uri};
use serde_json::{Value, json};

const PROGRAM: &str = "\
joints «home» = [0, 0, 0, 0, 0, 0] deg
item peg { keyframe grasp = [0, 0, 0] mm }
sequence main {
  var gap = 3 mm
  move to «home»
  move to peg.grasp
  move (gap) up
  // home
  move to «home» linearly
}
";

/// Locations in the one file as ranges.
fn ranges(answer: &Value) -> Vec<Value> {
    let locations = answer.as_array().expect("locations").iter();
    locations
        .map(|location| {
            assert_eq!(location["uri"], uri("main.obv"));
            location["range"].clone()
        })
        .collect()
}

#[test]
fn a_use_leads_to_its_declaration() {
    let (mut editor, places) = opened(PROGRAM);
    for place in &places {
        let answer = editor.at("definition", "main.obv", place["start"].clone()).expect("it leads");
        assert_eq!(ranges(&answer), [places[0].clone()]);
    }
}

#[test]
fn all_uses_are_found_and_nothing_else() {
    let (mut editor, places) = opened(PROGRAM);
    let mut references = |with_declaration: bool| {
        let params = json!({
            "textDocument": { "uri": uri("main.obv") },
            "position": places[1]["start"],
            "context": { "includeDeclaration": with_declaration },
        });
        ranges(&editor.ask("textDocument/references", params).expect("a list"))
    };
    assert_eq!(references(true), places);
    assert_eq!(references(false), places[1..]);
}

#[test]
fn highlights_tell_what_is_assigned() {
    let (mut editor, places) =
        opened("sequence main {\n  var «x» = 1\n  «x» += 2\n  wait real(«x») * 1 s\n}\n");
    let answer = editor.at("documentHighlight", "main.obv", places[0]["start"].clone());
    let kinds: Vec<_> = answer
        .expect("a list")
        .as_array()
        .expect("a list")
        .iter()
        .map(|one| (one["range"].clone(), one["kind"].clone()))
        .collect();
    let expected: Vec<_> = places.into_iter().zip([json!(3), json!(3), json!(2)]).collect();
    assert_eq!(kinds, expected);
}

#[test]
fn a_rename_changes_every_place() {
    let (text, places) = marked(PROGRAM);
    let mut editor = Editor::new();
    editor.open("main.obv", &text);
    let rename = |editor: &mut Editor, name: &str| {
        let params = json!({
            "textDocument": { "uri": uri("main.obv") },
            "position": places[1]["start"],
            "newName": name,
        });
        editor.ask("textDocument/rename", params)
    };
    let prepared = editor.at("prepareRename", "main.obv", places[1]["start"].clone());
    assert_eq!(prepared, Ok(json!({ "range": places[1], "placeholder": "home" })));
    let edit = rename(&mut editor, "start_of_day").expect("it is renamed");
    let renamed = edited(&text, &edit["changes"][uri("main.obv")]);
    let expected = text.replace("home", "start_of_day").replace("// start_of_day", "// home");
    assert_eq!(renamed, expected);
    let refused = |editor: &mut Editor, name: &str| rename(editor, name).expect_err("refused").1;
    assert!(refused(&mut editor, "2nd").contains("no name"));
    assert!(refused(&mut editor, "").contains("no name"));
    assert!(refused(&mut editor, "move").contains("cannot be a name"));
    assert!(refused(&mut editor, "gap").contains("a variable of the name `gap`"));
    assert!(refused(&mut editor, "main").contains("`main` is where a program begins"));
    // Errors and I/O operations are spoken with another article.
    for (declared, told) in [
        ("error odd { severity warning }", "there is an error of the name `odd` already"),
        ("io odd { set 1 high }", "there is an I/O operation of the name `odd` already"),
    ] {
        let (mut editor, places) = opened(&format!("{declared} io «on» {{ set 0 high }}"));
        let params = json!({
            "textDocument": { "uri": uri("main.obv") },
            "position": places[0]["start"],
            "newName": "odd",
        });
        let why = editor.ask("textDocument/rename", params).expect_err("refused").1;
        assert_eq!(why, told);
    }
}

#[test]
fn what_is_not_the_programs_own_keeps_its_name() {
    let why = |source: &str| {
        let (mut editor, places) = opened(source);
        let answer = editor.at("prepareRename", "main.obv", places[0]["start"].clone());
        answer.expect_err("refused").1
    };
    assert!(why("sequence «main» { wait 1 s }").contains("where a program begins"));
    assert!(why("sequence main { tool «probe» }").contains("from the workcell file"));
    assert!(why("item «peg» { } sequence main { }").contains("from the workcell file"));
    assert!(why("sequence main { wait «abs»(1 s) }").contains("a word of the language"));
    assert!(why("var x: «length» = 1 mm").contains("a word of the language"));
    let library = "import library \"press\" sequence main { call «press»() }";
    assert!(why(library).contains("the library"), "{}", why(library));
    let broken = "var «x» = 1\nsequence main {\n  wait real(x) * 1 s\n  move move\n}\n";
    assert!(why(broken).contains("line 4 of main.obv cannot be read"), "{}", why(broken));
}

/// A word of the language that can be a name, where it would be read as the word.
#[test]
fn a_name_that_would_be_read_otherwise_is_refused() {
    let (mut editor, places) = opened(
        "error jam { severity fatal }\nsequence main(«d»: length) {\n  move d up\n  throw jam\n}\n",
    );
    let params = json!({
        "textDocument": { "uri": uri("main.obv") },
        "position": places[0]["start"],
        "newName": "to",
    });
    assert!(editor.ask("textDocument/rename", params).is_err());
}

#[test]
fn nothing_is_renamed_where_there_is_no_name() {
    let (mut editor, places) = opened("sequence main { «wait» 1 s }");
    let place = places[0]["start"].clone();
    assert_eq!(editor.at("prepareRename", "main.obv", place.clone()), Ok(Value::Null));
    let found = editor.at("definition", "main.obv", place);
    assert_eq!(found, Ok(json!([])));
}

#[test]
fn the_outline_has_what_is_declared() {
    let (mut editor, _) = opened(PROGRAM);
    let outline = editor.of("documentSymbol", "main.obv");
    let name = |symbol: &Value| symbol["name"].as_str().unwrap_or_default().to_owned();
    let names: Vec<String> = outline.as_array().expect("a list").iter().map(name).collect();
    assert_eq!(names, ["home", "peg", "main"]);
    assert_eq!(name(&outline[1]["children"][0]), "grasp");
    assert_eq!(outline[2]["range"]["end"]["line"], 9);
    assert_eq!(outline[2]["selectionRange"]["start"], json!({ "line": 2, "character": 9 }));
}
