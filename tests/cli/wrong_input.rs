//! Programs, workcells and command lines that are wrong.

use crate::support::Bench;
use obverse_bytecode::ModuleCode;
use obverse_sim::CellCode;
use serde_json::{Value, json};

#[test]
fn files_that_are_not_there_or_no_files() {
    let bench = Bench::new("wrong_files");
    for command in ["check", "build", "run", "back", "dis", "tape"] {
        bench.refuses(&[command, "missing.obv"], &["missing.obv", "no such file"]);
        bench.refuses(&[command, "."], &[".: this is a folder"]);
        bench.refuses(&[command], &["<FILE>"]);
    }
}

#[test]
fn files_that_are_no_programs() {
    let bench = Bench::new("no_programs");
    bench.write("empty.obv", "");
    bench.write("binary.obv", [0x7f, b'E', b'L', b'F', 0xff, 0x00, 0x1b]);
    bench.write("zeros.obv", [0; 100]);
    bench.write("text.obc", "sequence main { wait 1 s }");
    bench.write("empty.obc", "");
    bench.write("empty.obvasm", "");
    bench.write("binary.obvasm", [0xff; 9]);
    for command in ["check", "build", "run", "back", "dis"] {
        bench.refuses(&[command, "empty.obv"], &["empty.obv:1:1", "E0301"]);
        bench.refuses(&[command, "binary.obv"], &["binary.obv:1:1", "E0007", "not text"]);
        bench.refuses(&[command, "zeros.obv"], &["zeros.obv", "E0007", "NUL"]);
        bench.refuses(&[command, "text.obc"], &["text.obc: byte 0", "no module"]);
        bench.refuses(&[command, "empty.obc"], &["empty.obc: byte 0", "no module"]);
        bench.refuses(&[command, "empty.obvasm"], &["empty.obvasm:1:1", "obvasm 1"]);
        bench.refuses(&[command, "binary.obvasm"], &["binary.obvasm: not text"]);
        bench.refuses(&[command, "pin_cell.toml"], &["pin_cell.toml: this is a workcell"]);
    }
}

#[test]
fn mistakes_are_all_reported_with_their_places() {
    let bench = Bench::new("mistakes");
    let text = "sequence main {\n  move to nowhere\n  wait 3 mm\n  set 0 hihg\n}\n";
    bench.write("m.obv", text);
    bench.refuses(&["run", "m.obv"], &["m.obv:4:", "E0010"]);
    bench.write("m.obv", text.replace("hihg", "high"));
    bench.refuses(&["build", "m.obv"], &["m.obv:2:11", "E0101", "m.obv:3:8", "E0202", "2 errors"]);
}

#[test]
fn what_is_very_deep_or_very_long_is_refused_briefly() {
    let bench = Bench::new("deep");
    let open = "(".repeat(1_000_000);
    bench.write("deep.obv", format!("sequence main {{ var x = {open}"));
    bench.write("bare.obv", &open);
    bench.write("blocks.obv", format!("sequence main {}", "{".repeat(1_000_000)));
    bench.write("minus.obv", format!("var x = {}1", "-".repeat(1_000_000)));
    bench.write("word.obv", "a".repeat(1_000_000));
    bench.write("deep.toml", format!("a = {}", "[".repeat(1_000_000)));
    bench.write("dots.obvasm", ".".repeat(1_000_000));
    for file in ["deep.obv", "bare.obv", "blocks.obv", "minus.obv", "word.obv", "dots.obvasm"] {
        bench.refuses(&["check", file], &[&format!("{file}:1:")]);
        let said = bench.run(&["check", file]).stderr;
        assert!(said.len() < 20_000, "{file}: {} bytes are said", said.len());
    }
    bench.refuses(&["run", "tower.obv", "--cell", "deep.toml"], &["deep.toml:1:"]);
}

/// What a hostile file would write to the terminal is not written there.
#[test]
fn control_characters_do_not_reach_the_terminal() {
    let bench = Bench::new("control");
    bench.write("esc.obv", "sequence main { move to \u{1b}[31mhome } // \u{9b}2J\n");
    let said = bench.ends(2, &["check", "esc.obv"]).stderr;
    assert!(!said.contains(['\u{1b}', '\u{9b}']), "{said:?}");
    bench.write("text.obv", "sequence main { barrier \"\u{1b}]0;gone\" }");
    let told = bench.run(&["run", "text.obv"]);
    assert!(!told.stdout.contains('\u{1b}'), "{:?}", told.stdout);
}

#[test]
fn devices_without_an_end_are_not_read_to_it() {
    if !cfg!(target_os = "linux") {
        return;
    }
    let bench = Bench::new("devices");
    bench.refuses(&["check", "/dev/zero"], &["/dev/zero: this is no regular file"]);
}

#[test]
fn workcells_that_are_wrong_are_shown_where() {
    let bench = Bench::new("workcells");
    let good = String::from_utf8(bench.read("pin_cell.toml")).expect("text");
    let wrong = [
        ("x = ", "w.toml:1:5"),
        ("[arm]\nhome_rad = 3\n", "w.toml:2:12"),
        ("[arm]\nhome_rad = [0, 0, 0, 0, 0, 99]\n", "w.toml:2:"),
        ("[arms]\n", "w.toml:1:"),
        ("\u{0}", "w.toml:1:"),
    ];
    for (text, place) in wrong {
        bench.write("w.toml", text);
        bench.refuses(&["run", "bad_pin.obv", "--cell", "w.toml"], &[place]);
    }
    let line_of =
        |needle: &str| good.lines().position(|line| line.contains(needle)).map(|at| at + 1);
    let place = format!("w.toml:{}:", line_of("near_mm").expect("a line"));
    bench.write("w.toml", good.replace("near_mm = 5", "near_mm = nan"));
    bench.refuses(&["check", "bad_pin.obv", "--cell", "w.toml"], &[&place]);
    bench.write("w.toml", [0xff, 0xfe]);
    bench.refuses(&["check", "bad_pin.obv", "--cell", "w.toml"], &["w.toml: not text"]);
    bench.refuses(&["run", "bad_pin.obv", "--cell", "none.toml"], &["none.toml: cannot be read"]);
    bench.refuses(&["run", "bad_pin.obv", "--cell", "."], &["this is a folder"]);
}

#[test]
fn workcells_that_lack_something_are_told_what() {
    let bench = Bench::new("lacking");
    let lacks_items = ["`block_a`", "`block_b`", "`block_c`", "tower.obv", "pin_cell.toml"];
    bench.refuses(&["check", "tower.obv", "--cell", "pin_cell.toml"], &lacks_items);
    bench.refuses(&["run", "find_edge.obv", "--cell", "pin_cell.toml"], &["no tool `probe`"]);
    bench.write(
        "io.obv",
        "sequence main {\n  set 8 high\n  wait until input 9 high for up to 1 s\n}\n",
    );
    let words = ["io.obv:2:3: there is no output 8", "io.obv:3:3: there is no input 9"];
    bench.refuses(&["run", "io.obv", "--cell", "pin_cell.toml"], &words);
    bench.refuses(&["run", "io.obv"], &["a bare arm"]);
    bench.write("lost.obv", "cell \"lost.toml\"\nsequence main { wait 1 s }\n");
    bench.refuses(
        &["run", "lost.obv"],
        &["lost.toml: cannot be read", "lost.obv:1:6: it is named", "--cell"],
    );
}

#[test]
fn command_lines_that_are_wrong() {
    let bench = Bench::new("command_lines");
    bench.refuses(&["frobnicate"], &["frobnicate"]);
    bench.refuses(&["run", "tower.obv", "--seed", "some"], &["--seed", "some"]);
    bench.refuses(&["run", "tower.obv", "--seed", "99999999999999999999"], &["--seed"]);
    bench.refuses(&["run", "tower.obv", "--limit", "-1"], &["-1"]);
    bench.refuses(&["run", "tower.obv", "screws.obv"], &["screws.obv"]);
    bench.refuses(&["explain", "frobnicate"], &["`frobnicate` is neither an opcode"]);
    bench.refuses(&["explain", "move.joins"], &["did you mean `move.joint`?"]);
    bench.refuses(&["explain", ""], &["neither"]);
    bench.refuses(&[], &["Usage"]);
}

#[test]
fn machines_are_told_what_is_wrong_with_the_input() {
    let bench = Bench::new("refused_json");
    bench.write("e.obv", "sequence main {\n  wait 3 mm\n}\n");
    bench.write("e.obvasm", "nothing\n");
    for command in ["run", "back", "build", "dis", "tape"] {
        let missing = bench.refuses_as_json(&[command, "--json", "none.obv"]);
        assert_eq!(missing.len(), 1);
        assert_eq!((&missing[0]["file"], &missing[0]["code"]), (&json!("none.obv"), &Value::Null));
        assert!(missing[0]["message"].as_str().is_some_and(|text| text.contains("no such file")));
    }
    for command in ["run", "back", "build", "dis"] {
        let checked = bench.ends(2, &["check", "--json", "e.obv"]).json();
        let wrong = bench.refuses_as_json(&[command, "--json", "e.obv"]);
        assert_eq!((&wrong[0]["code"], &wrong[0]["line"]), (&json!("E0202"), &json!(2)));
        assert_eq!(wrong, checked[..checked.len() - 1], "as `check` says it");
        let assembly = bench.refuses_as_json(&[command, "--json", "e.obvasm"]);
        assert_eq!(assembly[0]["line"], 1);
    }
    let lacking = ["run", "--json", "tower.obv", "--cell", "pin_cell.toml"];
    assert_eq!(bench.refuses_as_json(&lacking).len(), 3);
    bench.refuses_as_json(&["run", "--json", "tower.obv", "--tape", "tower.obv"]);
}

/// What opens it would wait for who writes to it.
#[cfg(unix)]
#[test]
fn a_pipe_in_place_of_a_file_is_not_waited_for() {
    let bench = Bench::new("pipes_in");
    for name in ["pipe.obv", "pipe.toml"] {
        let made = std::process::Command::new("mkfifo").arg(bench.path(name)).status();
        assert!(made.expect("mkfifo").success());
    }
    let said = "this is no regular file";
    for command in ["check", "run", "fmt", "reach", "build", "dis"] {
        let ran = bench.ends(2, &[command, "pipe.obv"]);
        assert!(ran.stderr.contains(said), "{command}: {}", ran.stderr);
    }
    let ran = bench.ends(2, &["check", "bad_pin.obv", "--cell", "pipe.toml"]);
    assert!(ran.stderr.contains(said), "{}", ran.stderr);
}

/// The codes of the diagnostics of `check`.
fn codes(bench: &Bench, arguments: &[&str]) -> Vec<String> {
    let ran = bench.run(&[&["check", "--json"], arguments].concat());
    let diagnostics = ran.json().into_iter().filter(|one| one["type"] == "diagnostic");
    diagnostics.map(|one| one["code"].as_str().unwrap_or("none").to_owned()).collect()
}

#[test]
fn what_a_program_needs_and_its_workcell_lacks_has_the_code_of_its_page() {
    let bench = Bench::new("codes_of_cells");
    let needs = "item vial { keyframe above = [0, 0, 0] mm }\n\
                 sequence main {\n  if input 3 { set 3 high }\n  \
                 tool gripper { move 1 mm up }\n  move to vial.above\n}\n";
    bench.write("needs.obv", needs);
    for code in CellCode::ALL.iter().filter(|code| code.as_str().starts_with("C02")) {
        bench.write("c.toml", code.page().wrong);
        assert_eq!(codes(&bench, &["needs.obv", "--cell", "c.toml"]), [code.as_str()]);
        bench.write("c.toml", code.page().right);
        assert_eq!(codes(&bench, &["needs.obv", "--cell", "c.toml"]), [""; 0]);
    }
}

#[test]
fn whatever_is_wrong_with_a_file_has_a_code_that_is_explained() {
    let bench = Bench::new("codes_of_files");
    let mut seen = Vec::new();
    for code in CellCode::ALL.iter().filter(|code| code.as_str().starts_with("C01")) {
        bench.write("c.toml", code.page().wrong);
        let found = codes(&bench, &["bad_pin.obv", "--cell", "c.toml"]);
        assert_eq!(found, [code.as_str()]);
        seen.extend(found);
    }
    for code in ModuleCode::ALL.iter().filter(|code| !code.page().wrong.is_empty()) {
        bench.write("x.obvasm", code.page().wrong);
        let found = codes(&bench, &["x.obvasm"]);
        assert_eq!(found.first().map(String::as_str), Some(code.as_str()));
        seen.extend(found);
    }
    bench.write("x.obc", "OBVERSE");
    let found = codes(&bench, &["x.obc"]);
    assert_eq!(found, [ModuleCode::Bytes.as_str()]);
    seen.extend(found);
    for code in seen {
        let page = bench.ends(0, &["explain", &code]).stdout;
        assert!(page.starts_with(&format!("{code}: ")), "{page}");
    }
    let all = bench.ends(0, &["explain"]).stdout;
    let listed = |code: &str| all.lines().any(|line| line.starts_with(&format!("{code}  ")));
    assert!(ModuleCode::ALL.iter().all(|code| listed(code.as_str())));
    assert!(CellCode::ALL.iter().all(|code| listed(code.as_str())));
}
