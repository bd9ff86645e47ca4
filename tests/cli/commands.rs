//! What each command does when nothing is wrong, and the exit codes.

use crate::support::Bench;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Whether a line of a story has these words, in this order.
fn has_line(story: &str, words: &[&str]) -> bool {
    story.lines().any(|line| {
        let mut rest = line;
        words.iter().all(|word| match rest.find(word) {
            Some(at) => {
                rest = &rest[at + word.len()..];
                true
            }
            None => false,
        })
    })
}

#[test]
fn the_help_lists_the_commands_and_the_exit_codes() {
    let help = Bench::new("help").ends(0, &["--help"]).stdout;
    for command in [
        "check", "fmt", "invert", "build", "run", "back", "dis", "debug", "reach", "trials", "lsp",
        "tape", "isa", "explain",
    ] {
        assert!(help.contains(&format!("\n  {command} ")), "{command} in\n{help}");
    }
    let codes: Vec<&str> = help.lines().skip_while(|line| *line != "Exit codes:").collect();
    let has = |code: &str| codes.iter().any(|line| line.starts_with(code));
    assert!(has("  0  ") && has("  1  ") && has("  2  "), "{help}");
}

#[test]
fn check_says_what_there_is() {
    let bench = Bench::new("check");
    let ran = bench.ends(0, &["check", "tower.obv"]);
    assert!(ran.stdout.starts_with("tower.obv: correct, no warnings; "), "{}", ran.stdout);
    assert!(ran.stdout.contains("workcell: bench_cell.toml"), "{}", ran.stdout);
    assert_eq!(ran.stderr, "");
}

#[test]
fn check_shows_warnings_and_counts_them() {
    let bench = Bench::new("check_warnings");
    bench.write("w.obv", "var unused = 1\nsequence main { return\n  wait 1 s\n}\n");
    let ran = bench.ends(0, &["check", "w.obv"]);
    assert!(ran.stdout.starts_with("w.obv: correct, 2 warnings; "), "{}", ran.stdout);
    assert!(ran.stderr.contains("[W0001]") && ran.stderr.contains("[W0002]"), "{}", ran.stderr);
    let lines = bench.ends(0, &["check", "--json", "w.obv"]).json();
    let found: Vec<(&Value, &Value)> =
        lines.iter().map(|line| (&line["code"], &line["line"])).collect();
    let expected = [(json!("W0001"), json!(1)), (json!("W0002"), json!(3))];
    assert_eq!(found[..2], expected.each_ref().map(|(code, line)| (code, line)));
    assert_eq!(lines[2]["outcome"], "correct");
    assert_eq!((&lines[2]["errors"], &lines[2]["warnings"]), (&json!(0), &json!(2)));
}

#[test]
fn check_tells_machines_every_diagnostic_with_its_places() {
    let bench = Bench::new("check_json");
    bench.write(
        "e.obv",
        "joints a = [0, 0, 0, 0, 0, 0] deg\nvar a = 1\nsequence main {\n  wait 3 mm\n}\n",
    );
    let ran = bench.ends(2, &["check", "--json", "e.obv"]);
    assert_eq!(ran.stderr, "");
    let lines = ran.json();
    let twice = &lines[0];
    assert_eq!(twice["type"], "diagnostic");
    assert_eq!((&twice["code"], &twice["severity"]), (&json!("E0102"), &json!("error")));
    assert_eq!(
        (&twice["file"], &twice["line"], &twice["column"]),
        (&json!("e.obv"), &json!(2), &json!(5))
    );
    assert_eq!(
        (&twice["labels"][0]["line"], &twice["labels"][0]["column"]),
        (&json!(1), &json!(8))
    );
    assert!(twice["message"].as_str().is_some_and(|message| message.contains("`a`")));
    assert_eq!((&lines[1]["code"], &lines[1]["line"]), (&json!("E0202"), &json!(4)));
    let summary = ran.summary();
    assert_eq!((&summary["outcome"], &summary["errors"]), (&json!("wrong"), &json!(2)));
    let missing = bench.ends(2, &["check", "--json", "none.obv"]).json();
    assert_eq!((&missing[0]["file"], &missing[0]["code"]), (&json!("none.obv"), &Value::Null));
}

#[test]
fn check_lets_no_warning_pass_that_is_denied() {
    let bench = Bench::new("check_deny");
    bench.write("w.obv", "var spare = 1\nsequence main {\n  wait 1 s\n}\n");
    for what in ["warnings", "W0001", "w0001"] {
        let ran = bench.ends(1, &["check", "--deny", what, "w.obv"]);
        assert!(ran.stdout.contains("1 warning that is not let pass"), "{}", ran.stdout);
    }
    bench.ends(0, &["check", "--deny", "W0002", "w.obv"]);
    let summary = bench.ends(1, &["check", "--deny", "warnings", "--json", "w.obv"]).summary();
    assert_eq!((&summary["outcome"], &summary["denied"]), (&json!("denied"), &json!(1)));
    let said = bench.ends(2, &["check", "--deny", "waring", "w.obv"]).stderr;
    assert!(said.contains("did you mean `warnings`?"), "{said}");
    bench.write("a.obv", "allow W0001 \"kept\" var spare = 1\nsequence main {\n  wait 1 s\n}\n");
    bench.ends(0, &["check", "--deny", "warnings", "a.obv"]);
}

#[test]
fn check_tells_machines_the_change_that_mends() {
    let bench = Bench::new("check_suggestion");
    bench.write("s.obv", "joints home = [0, 0, 0, 0, 0, 0] deg\nsequence main { move to hoem }\n");
    let lines = bench.ends(2, &["check", "--json", "s.obv"]).json();
    let change = &lines[0]["suggestion"];
    assert_eq!((&change["line"], &change["column"]), (&json!(2), &json!(25)));
    assert_eq!((&change["end_column"], &change["text"]), (&json!(29), &json!("home")));
    assert_eq!((&change["start_byte"], &change["end_byte"]), (&json!(61), &json!(65)));
}

#[test]
fn nothing_is_coloured_that_is_no_terminal() {
    let bench = Bench::new("check_colours");
    bench.write("c.obv", "sequence main { move to nowhere }\n");
    assert!(!bench.ends(2, &["check", "c.obv"]).stderr.contains('\u{1b}'));
}

#[test]
fn explain_lists_the_codes() {
    let bench = Bench::new("explain_all");
    let listed = bench.ends(0, &["explain"]).stdout;
    assert!(listed.contains("W0001  something that is never used\n"), "{listed}");
    let told = bench.ends(0, &["explain", "--json"]).json();
    assert_eq!(told.len(), listed.lines().count() + 1);
    let code = bench.ends(0, &["explain", "--json", "e0101"]).json();
    assert_eq!((&code[0]["code"], &code[1]["type"]), (&json!("E0101"), &json!("summary")));
    assert!(code[0]["wrong"].as_str().is_some_and(|wrong| wrong.contains("move to start")));
}

#[test]
fn run_tells_the_story() {
    let bench = Bench::new("run");
    let story = bench.ends(0, &["run", "bad_pin.obv", "--seed", "1"]).stdout;
    assert!(story.starts_with("bad_pin.obv in pin_cell.toml, seed 1\n"), "{story}");
    for line in [
        ["0.00 s", "sequence main", ""],
        ["action pick(pin_1)", "", ""],
        ["set 0 high; sleep 0.4 s", "output 0 high", ""],
        ["distance 60 mm forward in tcp", " N, ", "stopped by force"],
        ["return to initial position", " mm in ", " s"],
        ["throw pin_jams", "error pin_jams", "recoverable"],
        ["sequence take_the_next_pin", "", ""],
        ["error pin_jams", "dealt with", "the action again"],
    ] {
        assert!(has_line(&story, &line), "{line:?} in\n{story}");
    }
    let end: Vec<&str> = story.lines().rev().take(2).collect();
    assert_eq!(end[1], "finished");
    assert!(end[0].contains(" instructions, ") && end[0].contains(" bits of tape, "), "{}", end[0]);
}

#[test]
fn a_perturbed_attempt_is_told_step_by_step() {
    let bench = Bench::new("perturbed");
    let story = bench.ends(0, &["run", "peg_in_hole.obv", "--seed", "0"]).stdout;
    assert!(has_line(&story, &["return to initial position", " mm in "]), "{story}");
    assert!(has_line(&story, &["perturbation", " mm in "]), "{story}");
    assert!(!story.contains("repeat with perturbation"), "{story}");
}

#[test]
fn back_tells_both_ways_and_compares() {
    let bench = Bench::new("back");
    let story = bench.ends(0, &["back", "screws.obv", "--seed", "1"]).stdout;
    let (there, back) = story.split_once("\nand back\n").expect("both ways");
    assert!(there.contains("\nfinished\n"));
    let arrows = back.lines().filter(|line| line.contains(" s < ")).count();
    assert!(arrows > 20, "{back}");
    assert!(has_line(back, &["in reverse", "in place of going back"]), "{back}");
    assert!(back.contains("the state is identical to the start, bit for bit"), "{back}");
    let glue = bench.ends(0, &["back", "glue.obv"]).stdout;
    assert_eq!(glue.matches("  end of what is irreversible ").count(), 1, "{glue}");
    assert!(glue.contains("cannot go back past glue.obv:21: the glue is on the block"), "{glue}");
}

#[test]
fn a_call_in_which_nothing_happens_is_not_told() {
    let bench = Bench::new("quiet");
    let text = "sequence quiet { return }\nsequence loud { set 1 high }\n\
                sequence main { call quiet call loud call quiet }\n";
    bench.write("q.obv", text);
    let story = bench.ends(0, &["back", "q.obv"]).stdout;
    assert!(!story.contains("sequence quiet"), "{story}");
    assert_eq!(story.matches("sequence loud").count(), 2, "{story}");
    assert_eq!(story.matches("sequence main").count(), 2, "{story}");
}

/// What is passed over in reverse stays as it is, and is not called identical.
#[test]
fn back_names_the_force_that_holds_a_motion_back() {
    let bench = Bench::new("back_held");
    let program = "cell \"peg_in_hole.toml\"\n\
        joints start = [3.425, -1.0, 1.2, -1.8, -1.57, 0.3] rad\n\
        advanced move insert { distance 300 mm forward stop if force > 5 N speed slow\n\
        succeeds if distance > 200 mm opposite force in reverse }\n\
        sequence main { set 0 high sleep 0.5 s move to start advance insert }\n";
    bench.write("held.obv", program);
    // The peg jams with this seed, and goes straight in with the other.
    let held = bench.ends(1, &["back", "--seed", "5", "held.obv"]);
    let said = "fault: going back over held.obv:3 `distance 300 mm forward`: stopped on the way by";
    assert!(held.stdout.contains(said), "{}", held.stdout);
    assert!(held.stdout.contains(", and the limit is 5.0 N"), "{}", held.stdout);
    bench.ends(0, &["back", "--seed", "1", "held.obv"]);
}

#[test]
fn back_says_where_the_workcell_is_left_otherwise() {
    let bench = Bench::new("otherwise");
    bench.write("s.obv", "sequence main { skip in reverse { set 1 high } }\n");
    let ran = bench.ends(0, &["back", "--json", "s.obv"]);
    let summary = ran.summary();
    assert_eq!((&summary["outcome"], &summary["identical"]), (&json!("at_start"), &json!(false)));
    let story = bench.ends(0, &["back", "s.obv"]).stdout;
    assert!(story.contains("left the workcell otherwise"), "{story}");
}

#[test]
fn the_summaries_have_their_figures() {
    let bench = Bench::new("summaries");
    for command in ["run", "back"] {
        let ran = bench.ends(0, &[command, "--json", "tower.obv", "--seed", "1"]);
        let lines = ran.json();
        let summary = ran.summary();
        let summaries = lines.iter().filter(|line| line["type"] == "summary").count();
        assert_eq!(summaries, 1);
        for figure in ["instructions", "commands", "tape_bits"] {
            assert!(summary[figure].as_u64() > Some(0), "{figure}: {summary}");
        }
        let events = &lines[..lines.len() - 1];
        assert!(events.iter().all(|line| line["type"] == "event" && line["line"].is_u64()));
        let moves = events.iter().filter(|line| line["distance_m"].is_f64()).count();
        assert!(moves >= 11, "{moves} moves are told");
    }
    let run = bench.run(&["run", "--json", "tower.obv"]).summary();
    assert_eq!((&run["outcome"], &run["stopped_at"]), (&json!("finished"), &Value::Null));
    let back = bench.run(&["back", "--json", "tower.obv"]).summary();
    assert_eq!((&back["outcome"], &back["there"]), (&json!("at_start"), &json!("finished")));
    assert_eq!((&back["identical"], &back["stopped_at"]), (&json!(true), &Value::Null));
    let glue = bench.run(&["back", "--json", "glue.obv"]).summary();
    assert_eq!((&glue["outcome"], &glue["identical"]), (&json!("refused"), &json!(false)));
    assert_eq!(glue["stopped_at"]["line"], 21);
    assert_eq!(glue["stopped_at"]["file"], "glue.obv");
}

#[test]
fn all_chance_follows_from_the_seed() {
    let bench = Bench::new("seed");
    let run = |seed: &str| bench.run(&["run", "--json", "warm_up.obv", "--seed", seed]).stdout;
    assert_eq!(run("7"), run("7"));
    assert_ne!(run("7"), run("8"));
}

#[test]
fn exit_code_one_is_for_runs_that_end_otherwise() {
    let bench = Bench::new("exit_codes");
    let stop = ["run", "--json", "reversal_policy.obv", "--seed", "0", "--strategy", "stop"];
    let error = bench.ends(1, &stop).summary();
    assert_eq!(error["outcome"], "given_up");
    assert_eq!(error["errors"], json!(["peg_meets_rim"]));
    assert_eq!(error["incidents"][0]["outcome"], "strategy");
    let limit = bench.ends(1, &["run", "--json", "warm_up.obv", "--limit", "20"]).summary();
    assert_eq!(limit["outcome"], "budget");
    bench.write(
        "trap.obv",
        "sequence main {\n  var none = 0\n  var x = 1 / none\n  wait real(x) * 1 s\n}\n",
    );
    let trap = bench.ends(1, &["run", "--json", "trap.obv"]).summary();
    assert_eq!((&trap["outcome"], &trap["stopped_at"]["line"]), (&json!("trap"), &json!(3)));
    bench.write("far.obv", "sequence main {\n  move 3 m up in base\n}\n");
    let fault = bench.ends(1, &["run", "--json", "far.obv"]).summary();
    assert_eq!((&fault["outcome"], &fault["stopped_at"]["line"]), (&json!("fault"), &json!(2)));
    // What ended with an error goes back all the same, and that is what `back` is asked for.
    bench.ends(0, &["back", "reversal_policy.obv", "--seed", "0", "--strategy", "stop"]);
}

#[test]
fn reach_is_told_of_sources_modules_and_assembly() {
    let bench = Bench::new("reach");
    bench.ends(0, &["build", "glue.obv"]);
    let drawn = bench.ends(0, &["reach", "glue.obv"]).stdout;
    assert_eq!(bench.ends(0, &["reach", "glue.obc"]).stdout, drawn);
    assert!(drawn.contains("━━━ the glue is on the block ━━━"), "{drawn}");
    let ascii = bench.ends(0, &["reach", "--ascii", "glue.obv"]).stdout;
    assert!(ascii.is_ascii() && ascii.lines().count() == drawn.lines().count(), "{ascii}");
    // Without a map to the source, instructions are told of.
    let text = bench.ends(0, &["dis", "glue.obv"]).stdout;
    let bare: Vec<&str> = text.lines().filter(|line| !line.trim().starts_with('@')).collect();
    bench.write("bare.obvasm", bare.join("\n"));
    let listed = bench.ends(0, &["reach", "bare.obvasm"]).stdout;
    assert!(listed.contains("just after instruction"), "{listed}");
}

#[test]
fn reach_says_of_each_statement_what_stops_it() {
    let bench = Bench::new("reach_json");
    let ran = bench.ends(0, &["reach", "--json", "glue.obv"]);
    let lines = ran.json();
    assert_eq!(ran.summary()["statements"], lines.len() - 1);
    let of = |line: u64| {
        let found = lines.iter().find(|one| one["line"] == line);
        found.unwrap_or_else(|| panic!("line {line} is told of"))
    };
    assert_eq!((&of(20)["class"], &of(20)["action"]), (&json!("after-forward"), &json!(true)));
    assert_eq!(of(20)["stops"], json!([{ "at": "start" }]));
    assert_eq!((&of(21)["class"], &of(36)["class"]), (&json!("never"), &json!("always")));
    let stop = &of(46)["stops"][0];
    assert_eq!((&stop["at"], &stop["line"]), (&json!("never"), &json!(21)));
    assert_eq!(stop["reason"], "the glue is on the block");
    assert_eq!((&of(46)["reached"], &of(46)["more"]), (&json!(true), &json!(false)));
}

#[test]
fn reach_explains_one_line() {
    let bench = Bench::new("reach_at");
    let told = bench.ends(0, &["reach", "glue.obv", "--at", "46"]).stdout;
    assert_eq!(
        told,
        "line 46 `call look`, in sequence main: after-forward\n\n\
         goes back to just after line 21: the glue is on the block\n  \
         back into sequence draw_bead, by line 45 `call draw_bead`\n  \
         to line 21 `irreversible \"the glue is on the block\"`, which is not taken back\n"
    );
    let one = bench.ends(0, &["reach", "glue.obv", "--json", "--at", "46"]);
    assert_eq!(one.summary()["statements"], 1);
    let way = one.json()[0]["stops"][0]["way"].clone();
    assert_eq!(way.as_array().map(Vec::len), Some(2), "{way}");
    let nothing = bench.ends(2, &["reach", "glue.obv", "--at", "1"]);
    assert!(nothing.stderr.contains("line 1 does nothing"), "{}", nothing.stderr);
}

#[test]
fn a_built_module_runs_as_its_source_does() {
    let bench = Bench::new("build");
    let built = bench.ends(0, &["build", "sheets.obv"]).stdout;
    let bytes = bench.read("sheets.obc").len();
    assert_eq!(built, format!("sheets.obc: {bytes} bytes\n"));
    bench.ends(0, &["build", "sheets.obv", "-o", "other.obc"]);
    assert_eq!(
        bench.read("other.obc"),
        bench.read("sheets.obc"),
        "the same source, the same bytes"
    );
    let of = |file: &str| bench.ends(0, &["run", "--json", file, "--seed", "3"]).stdout;
    assert_eq!(of("sheets.obc"), of("sheets.obv"));
    bench.ends(0, &["check", "sheets.obc"]);
    // A module is known by its first bytes, not by its name.
    bench.write("renamed.bin", bench.read("sheets.obc"));
    assert_eq!(of("renamed.bin"), of("sheets.obv"));
}

#[test]
fn a_disassembly_assembled_again_runs_the_same() {
    let bench = Bench::new("dis");
    for program in ["bad_pin", "screws", "find_edge"] {
        let source = format!("{program}.obv");
        let text = bench.ends(0, &["dis", &source]).stdout;
        let assembly = format!("{program}.obvasm");
        bench.write(&assembly, &text);
        let of = |file: &str| bench.ends(0, &["back", "--json", file, "--seed", "2"]).summary();
        assert_eq!(of(&assembly), of(&source));
        assert_eq!(bench.ends(0, &["dis", &assembly]).stdout, text);
    }
}

#[test]
fn a_tape_is_recorded_and_shown() {
    let bench = Bench::new("tape");
    let ran = bench.ends(0, &["run", "--json", "tower.obv", "--tape", "t.tape", "--seed", "5"]);
    let shown = bench.ends(0, &["tape", "t.tape"]).stdout;
    assert!(shown.starts_with("tower.obv, fingerprint "), "{shown}");
    assert!(shown.contains("seed 5\nended: finished\n"), "{shown}");
    assert!(has_line(&shown, &["move.item", "move to part.grasp linearly", "joints ["]), "{shown}");
    assert!(has_line(&shown, &["output.set", "set 0 low", "bit 1"]), "{shown}");
    assert!(has_line(&shown, &["return", "frame of "]), "{shown}");
    assert!(!shown.contains(" call "), "a call leaves no record: {shown}");
    assert!(shown.ends_with("they lead back to the start\n"), "{shown}");
    let told = bench.ends(0, &["tape", "--json", "t.tape"]);
    let lines = told.json();
    let records = lines.iter().filter(|line| line["type"] == "record");
    let records: u64 = records.filter_map(|line| line["bits"].as_u64()).sum();
    assert_eq!(ran.summary()["tape_bits"], records, "every bit is accounted for");
    let costs = &told.summary()["costs"];
    let bits: u64 =
        costs.as_array().expect("costs").iter().filter_map(|c| c["bits"].as_u64()).sum();
    assert_eq!(bits, records);
    let summary = told.summary();
    assert_eq!((&summary["outcome"], &summary["bits"]), (&json!("shown"), &json!(records)));
    assert_eq!(summary["back_to"]["outcome"], "at_start");
    assert_eq!(summary["records_not_told"], 0);
    let cut = bench.ends(0, &["tape", "--json", "t.tape", "--records", "3"]);
    assert_eq!(cut.json().len(), 4);
    let all = summary["records"].as_u64().expect("a number");
    assert_eq!(cut.summary()["records_not_told"], all - 3, "what is cut is said");
}

/// What a tape costs by instruction and by robot command is the sum of its records.
#[test]
fn the_cost_of_a_tape_is_told_by_instruction_and_by_command() {
    let bench = Bench::new("tape_cost");
    let ran = bench.ends(0, &["run", "--json", "tower.obv", "--tape", "t.tape"]).summary();
    let told = bench.ends(0, &["tape", "--json", "t.tape"]);
    let mut bits = BTreeMap::new();
    for line in told.json().iter().filter(|line| line["type"] == "record") {
        let sum = bits.entry(line["instruction"].as_u64()).or_insert(0);
        *sum += line["bits"].as_u64().expect("bits");
    }
    let summary = told.summary();
    let costs = summary["by_instruction"].as_array().expect("costs");
    let summed = costs.iter().map(|cost| (cost["instruction"].as_u64(), cost["bits"].as_u64()));
    assert_eq!(
        summed.collect::<BTreeMap<_, _>>(),
        bits.iter().map(|(&a, &b)| (a, Some(b))).collect()
    );
    let dear_first = |pair: &[Value]| pair[0]["bits"].as_u64() >= pair[1]["bits"].as_u64();
    assert!(costs.windows(2).all(dear_first), "{costs:?}");
    assert!(costs.iter().all(|cost| cost["line"].is_u64() && cost["text"].is_string()));
    let command = &summary["by_command"];
    assert_eq!(command["commands"], ran["commands"], "each command is walked over");
    let of_opcodes = summary["costs"].as_array().expect("costs").iter();
    let of_commands = of_opcodes.filter(|cost| cost["robot_command"] == true);
    let sum: u64 = of_commands.filter_map(|cost| cost["bits"].as_u64()).sum();
    assert_eq!(command["bits"], sum);
    let count = ran["commands"].as_f64().expect("a number");
    assert_eq!(command["bits_per_command"], sum as f64 / count);
    let shown = bench.ends(0, &["tape", "t.tape"]).stdout;
    assert!(shown.contains(&format!("\n{count} robot commands: ")), "{shown}");
}

#[test]
fn words_on_a_tape_are_shown_by_their_type() {
    let bench = Bench::new("tape_words");
    let text = "sequence main {\n  var n = 7\n  var r = 0.25\n  var b = true\n  \
                n = n * n\n  r = r * r\n  b = not b\n  wait 1 s\n}\n";
    bench.write("w.obv", text);
    bench.ends(0, &["run", "w.obv", "--tape", "w.tape"]);
    let lines = bench.ends(0, &["tape", "--json", "w.tape"]).json();
    let found = |line: u64| {
        let mut of_line = lines.iter().filter(|record| record["line"] == line);
        of_line.find_map(|record| record["record"].as_str()).unwrap_or_default().to_owned()
    };
    assert_eq!(
        (found(5), found(6), found(7)),
        ("int 7".into(), "real 0.25".into(), "bool true".into())
    );
    bench.ends(0, &["run", "peg_in_hole.obv", "--tape", "p.tape"]);
    let shown = bench.ends(0, &["tape", "p.tape", "--records", "100000"]).stdout;
    assert!(has_line(&shown, &["setting.set", "speed normal"]), "{shown}");
}

/// However long a run was, its tape is shown in bounded time, and what is left out is said.
#[test]
fn the_walk_over_a_tape_is_bounded() {
    let bench = Bench::new("tape_long");
    bench.write("l.obv", "sequence main {\n  var n = 0\n  repeat 600000 times { n = n + 1 }\n}\n");
    let ran = bench.ends(0, &["run", "--json", "l.obv", "--tape", "l.tape"]).summary();
    assert!(ran["instructions"].as_u64() > Some(1_000_000), "{ran}");
    let summary = bench.ends(0, &["tape", "--json", "l.tape"]).summary();
    assert_eq!(summary["back_to"]["outcome"], "limit");
    assert_eq!(summary["back_to"]["at"]["line"], 3);
    assert_eq!(summary["bits"], ran["tape_bits"]);
    let shown = bench.ends(0, &["tape", "l.tape"]).stdout;
    assert!(shown.contains("l.obv:3 after 1000000 instructions, and further"), "{shown}");
}

#[test]
fn machines_are_told_of_a_module_and_its_instructions() {
    let bench = Bench::new("build_json");
    let built = bench.ends(0, &["build", "--json", "sheets.obv"]).summary();
    assert_eq!((&built["outcome"], &built["file"]), (&json!("built"), &json!("sheets.obc")));
    assert_eq!(built["bytes"], bench.read("sheets.obc").len());
    let dis = bench.ends(0, &["dis", "--json", "sheets.obc"]);
    let lines = dis.json();
    assert_eq!(dis.summary()["instructions"], lines.len() - 1);
    for line in &lines[..lines.len() - 1] {
        let opcode = line["opcode"].as_str().expect("an opcode");
        let row = obverse_isa::OPS.iter().find(|row| row.mnemonic == opcode).expect("a row");
        assert_eq!(line["class"], row.class.name());
        let operands = line["operands"].as_object().expect("operands");
        assert!(row.operands.iter().all(|(name, _)| operands.contains_key(*name)), "{line}");
    }
}

#[test]
fn the_tape_of_a_run_with_a_barrier_leads_back_to_it() {
    let bench = Bench::new("tape_barrier");
    bench.ends(0, &["run", "glue.obv", "--tape", "g.tape"]);
    let shown = bench.ends(0, &["tape", "g.tape"]).stdout;
    assert!(
        shown.ends_with("they lead back to glue.obv:21: the glue is on the block\n"),
        "{shown}"
    );
    let told = bench.ends(0, &["tape", "--json", "g.tape"]).summary();
    assert_eq!(told["back_to"]["outcome"], "refused");
    assert_eq!(told["back_to"]["at"]["line"], 21);
    // Taken back all the way, nothing is left on it.
    bench.ends(0, &["back", "tower.obv", "--tape", "b.tape"]);
    let empty = bench.ends(0, &["tape", "--json", "b.tape"]).summary();
    assert_eq!((&empty["records"], &empty["ending"]), (&json!(0), &json!("back at the start")));
}

#[test]
fn the_instruction_set_is_listed() {
    let bench = Bench::new("isa");
    let text = bench.ends(0, &["isa"]).stdout;
    let table = bench.ends(0, &["isa", "--json"]).json().remove(0);
    let opcodes = table["opcodes"].as_array().expect("opcodes");
    assert_eq!(opcodes.len(), obverse_isa::OPS.len());
    for row in opcodes {
        let mnemonic = row["mnemonic"].as_str().expect("a mnemonic");
        assert!(has_line(
            &text,
            &[&format!("  {mnemonic} "), row["class"].as_str().expect("a class")]
        ));
        let why = row["why"].is_string();
        assert_eq!(why, row["class"] == "never", "{row}");
    }
}

#[test]
fn explain_knows_every_opcode_and_every_code() {
    let bench = Bench::new("explain");
    let explained = bench.ends(0, &["explain", "move.joint"]).stdout;
    assert!(explained.starts_with("move.joint (0x80, kinematic)\n"), "{explained}");
    let explained = bench.ends(0, &["explain", "e0202"]).stdout;
    assert!(explained.starts_with("E0202: a value of another unit\n"), "{explained}");
    assert_eq!(explained.matches("a value of another unit").count(), 1, "{explained}");
    for code in obverse_syntax::codes::Code::ALL {
        let explained = bench.ends(0, &["explain", code.as_str()]).stdout;
        let prose = explained.split("\nWrong:").next().unwrap_or_default();
        assert!(prose.lines().all(|line| line.chars().count() <= 80), "{explained}");
    }
}

/// A reader that has seen enough ends the writer quietly.
#[test]
fn a_pipe_closed_early_is_no_error() {
    use std::io::Read;
    use std::process::Stdio;
    let bench = Bench::new("pipe");
    // More than any pipe holds.
    let text = String::from_utf8(bench.read("marking.obv")).expect("text");
    bench.write("long.obv", text.replace("rounds = 10", "rounds = 300"));
    let mut command = bench.command(&["run", "--json", "long.obv"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("a child");
    let mut first = [0; 1];
    child.stdout.take().expect("a pipe").read_exact(&mut first).expect("a byte");
    let output = child.wait_with_output().expect("an end");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}
