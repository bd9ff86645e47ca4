//! What is offered while one writes.

use crate::support::{hover, offered, opened};

const HEAD: &str = "\
output lamp = 3
input part = 4
io grip { set lamp high }
joints home = [0, 0, 0, 0, 0, 0] deg
item peg { keyframe grasp = [0, 0, 0] mm keyframe above = [0, 0, 0] mm }
item hole { keyframe entry = [0, 0, 0] mm }
error jam { severity fatal }
advanced move insert { distance 3 mm forward }
action push(depth: length, twice: bool) { move depth up if twice { move depth up } }
sequence main {
  position here
  var gap = 3 mm
";

fn at(rest: &str) -> Vec<String> {
    offered(&format!("{HEAD}  {rest}"))
}

#[test]
fn names_are_of_the_kind_that_is_needed() {
    assert_eq!(at("advance «»"), ["insert"]);
    assert_eq!(at("io «»"), ["grip"]);
    assert_eq!(at("throw «»"), ["jam"]);
    assert_eq!(at("set «»"), ["lamp"]);
    assert_eq!(at("wait until input «»"), ["part"]);
    assert_eq!(at("call «»"), ["main", "push"]);
    assert_eq!(at("move to «»"), ["gap", "here", "hole", "home", "peg"]);
    assert_eq!(at("move to ho«»"), ["gap", "here", "hole", "home", "peg"]);
}

#[test]
fn keyframes_follow_their_item() {
    assert_eq!(at("move to peg.«»"), ["above", "grasp"]);
    assert_eq!(at("move to peg.gr«»"), ["above", "grasp"]);
    assert_eq!(at("move to hole.«»\n}"), ["entry"]);
    let of_parameter = offered(&format!("{HEAD}}}\naction go(what: item) {{ move to what.«»"));
    assert_eq!(of_parameter, ["above", "entry", "grasp"]);
}

#[test]
fn values_are_offered_where_one_can_stand() {
    let value = at("wait «»");
    for word in ["gap", "abs", "holding", "until"] {
        assert!(value.iter().any(|offered| offered == word), "{word}: {value:?}");
    }
    assert!(!value.iter().any(|offered| offered == "jam" || offered == "move"), "{value:?}");
    let argument = at("call push(«»");
    assert_eq!(argument[0], "depth: ", "{argument:?}");
    assert!(argument.iter().any(|offered| offered == "peg"), "{argument:?}");
}

#[test]
fn units_follow_a_number() {
    assert_eq!(at("wait 3 «»")[..3], ["ms", "s", "and"]);
    assert_eq!(at("wait 3 «»\n}")[..3], ["ms", "s", "and"]);
    assert_eq!(at("move 3 «»up\n}")[..2], ["m", "mm"]);
    // Nothing says what it measures.
    let after = at("var many = 3 «»");
    assert!(after.starts_with(&["N".to_owned(), "cm".to_owned()]), "{after:?}");
    assert!(at("wait 3m«»").iter().any(|offered| offered == "mm/s"));
    assert!(!at("wait 3 mm\n  «»").iter().any(|offered| offered == "mm"));
}

#[test]
fn words_are_those_that_may_follow() {
    let statement = at("«»");
    for word in ["move", "wait", "checkpoint", "skip", "gap"] {
        assert!(statement.iter().any(|offered| offered == word), "{word}: {statement:?}");
    }
    assert!(!statement.iter().any(|offered| offered == "sequence"), "{statement:?}");
    assert_eq!(at("speed «»"), ["fast", "normal", "slow", "very"]);
    assert_eq!(at("speed ve«»"), ["fast", "normal", "slow", "very"]);
    let move_on = at("move to home «»");
    assert!(move_on.iter().any(|offered| offered == "linearly"), "{move_on:?}");
    assert!(!move_on.iter().any(|offered| offered == "wait"), "{move_on:?}");
    let top = offered("«»");
    assert!(top.contains(&"sequence".to_owned()) && !top.contains(&"move".to_owned()), "{top:?}");
    assert_eq!(offered("error e { severity «»"), ["fatal", "recoverable", "warning"]);
    let types = offered("action go(what: «»");
    assert!(types.contains(&"length".to_owned()) && types.contains(&"item".to_owned()));
    assert!(offered("allow «»").contains(&"W0001".to_owned()));
}

#[test]
fn nothing_is_offered_in_a_comment_or_a_text() {
    assert!(at("// move «»").is_empty());
    assert!(at("barrier \"the «»").is_empty());
    assert!(!at("// move\n  «»").is_empty());
}

#[test]
fn a_mistake_elsewhere_takes_nothing_away() {
    assert_eq!(at("move move\n  io «»"), ["grip"]);
    assert_eq!(at("speed «»\n  move to home }\nsequence other { move }"), at("speed «»"));
}

#[test]
fn what_is_declared_further_down_is_not_seen_yet() {
    let before = at("wait «»\n  var later = 3 s\n}");
    assert!(!before.iter().any(|offered| offered == "later"), "{before:?}");
}

#[test]
fn what_is_below_a_head_that_is_being_written_is_known() {
    for head in [
        "action two(x: int) {",
        "action two(x: int, ) {",
        "action two(x: int, y) {",
        "action two(x: int, y: ) {",
        "action two(x: int {",
        "action two(x: int)",
    ] {
        let source = format!(
            "var g = 1\nsequence main {{\n  call two(1)\n  g += 1\n}}\n{head}\n  wait 0.1 s\n  \
             g += «»\n}}\nsequence last {{ g += 2 }}\n"
        );
        let known = offered(&source);
        assert!(known.iter().any(|name| name == "x"), "{head}: {known:?}");
        let source = source.replace("«»", "«x»");
        assert!(hover(&source).contains("int"), "{head}: {}", hover(&source));
        let (mut editor, _) = opened(&source);
        let outline = editor.of("documentSymbol", "main.obv").to_string();
        for name in ["g", "main", "two", "last"] {
            assert!(outline.contains(&format!("\"name\":\"{name}\"")), "{head}: {outline}");
        }
    }
    let bare = "var g = 1\nsequence f\n  g += 1\n  g += 2\n}\n";
    let (mut editor, _) = opened(bare);
    let outline = editor.of("documentSymbol", "main.obv").to_string();
    assert!(outline.contains("\"name\":\"f\""), "{outline}");
}
