//! The library: each of its files compiles in a program that has what it asks for, without a word
//! of complaint, and is formatted; and the mistakes of who imports it.

use crate::common::findings;
use obverse_compiler::{compile, library};
use obverse_syntax::format::format;

/// What the files ask of a program.
const PRELUDE: &str = r#"
output feeder = 1
input part_there = 1
io grip    { set 0 high; sleep 0.3 s }
io release { set 0 low;  sleep 0.3 s }
item part {
  keyframe above = [0, 0, -80] mm
  keyframe grasp = [0, 0, 0] mm
  keyframe put   = [0, 0, 0] mm
}
"#;

/// A program that calls every action of a file with its defaults.
fn program(file: &str) -> String {
    let call = match file {
        "feeder" => "call pick_from_feeder(part)",
        "insert" => "call insert_with_spiral_search",
        "pick" => "call pick(part)",
        "place" => "call place(part)",
        "press" => "call press",
        "probe" => "call probe move probe_offset forward in tcp",
        "regrasp" => "call regrasp(part)",
        "round" => "call insert_with_round_search",
        "snap" => "call snap",
        "tilt" => "call insert_with_tilt",
        "turn" => "call turn_home",
        _ => panic!("say how `{file}` is called"),
    };
    format!(
        "import library \"{file}\"\n{PRELUDE}\
         sequence main {{ io release set feeder low io grip if input part_there {{ wait 1 s }} \
         move to part.above move to part.grasp move to part.put {call} }}"
    )
}

#[test]
fn every_file_compiles_without_a_word() {
    for (name, _) in library::FILES {
        let program = program(name);
        let compiled = compile("main.obv", &program);
        assert_eq!(compiled.diagnostics, [], "{name}");
        assert!(compiled.module.is_some(), "{name}");
        let action = compiled.actions.first().unwrap_or_else(|| panic!("no action in {name}"));
        for parameter in &action.parameters {
            let is_item = parameter.type_name == "item";
            assert_eq!(parameter.default.is_none(), is_item, "{name}: {}", parameter.name);
            assert_eq!(parameter.range.is_none(), is_item, "{name}: {}", parameter.name);
        }
    }
}

#[test]
fn every_file_is_formatted_and_says_what_it_is() {
    for (name, text) in library::FILES {
        let text = text();
        assert_eq!(format(text).as_deref(), Ok(text), "{name}");
        let head: Vec<&str> = text.lines().take_while(|line| line.starts_with("//")).collect();
        let head = head.join(" ").replace("// ", "");
        for word in ["It needs", "Class: "] {
            assert!(head.contains(word), "{name} does not say {word:?}");
        }
    }
}

#[test]
fn what_the_library_lacks_is_said_with_what_it_has() {
    let compiled = compile("main.obv", "import library \"insret\" sequence main { wait 1 s }");
    let [found] = compiled.diagnostics.as_slice() else { panic!("{:?}", compiled.diagnostics) };
    assert_eq!(found.code.as_str(), "E0501");
    assert_eq!(found.help.as_deref(), Some("did you mean `\"insert\"`?"));
    assert!(found.notes[0].contains("regrasp"), "{:?}", found.notes);
}

#[test]
fn a_file_that_is_imported_twice_is_there_once() {
    let twice = "import library \"probe\" import library \"probe\" sequence main { call probe }";
    assert_eq!(findings(twice), Vec::<String>::new());
}
