//! `obverse invert` through its binary: what is printed, what is refused, with which exit codes.

use crate::support::Bench;
use serde_json::json;

#[test]
fn the_inverse_is_a_program_that_is_formatted_and_correct() {
    let bench = Bench::new("invert");
    let inverse = bench.ends(0, &["invert", "sheets.obv", "main"]).stdout;
    assert!(inverse.starts_with("// The inverse of `main` in sheets.obv.\n// It "), "{inverse}");
    bench.write("back.obv", &inverse);
    bench.ends(0, &["fmt", "--check", "back.obv"]);
    // The sheets lie in the tray yet.
    let checked = bench.ends(1, &["check", "back.obv"]).stdout;
    assert!(checked.starts_with("back.obv: correct, no warnings;"), "{checked}");
    let checked = bench.ends(0, &["check", "back.obv", "--after", "sheets.obv"]).stdout;
    assert!(checked.contains("6 moves: all reachable"), "{checked}");
    assert!(checked.contains("where the workcell has it after sheets.obv"), "{checked}");
    let again = bench.ends(0, &["invert", "back.obv", "main_inverse"]).stdout;
    let same = |words: &str| again.contains(words);
    assert!(same("sequence main {\n  call lay(sheet_1)\n") && same("var laid = 0\n"), "{again}");
}

#[test]
fn the_inverse_takes_apart_what_was_put_together() {
    let bench = Bench::new("invert_after");
    for program in ["sheets.obv", "tower.obv"] {
        let inverse = bench.ends(0, &["invert", program, "main"]).stdout;
        bench.write("apart.obv", &inverse);
        for command in ["run", "back"] {
            let ran = bench.ends(0, &[command, "apart.obv", "--after", program]).stdout;
            let head = ran.lines().next().expect("a head");
            assert!(head.ends_with(&format!("seed 0, after {program}")), "{ran}");
            assert!(ran.contains("\nfinished\n"), "{ran}");
        }
        // The cycle is that of what comes after alone.
        let dry = bench.ends(0, &["run", "--dry", "--json", "apart.obv", "--after", program]);
        let alone = bench.ends(0, &["run", "--dry", "--json", program]).summary();
        let (dry, alone) = (&dry.summary()["time_s"], &alone["time_s"]);
        let (dry_s, alone_s) = (dry.as_f64().expect("a time"), alone.as_f64().expect("a time"));
        assert!(dry_s > 0.5 * alone_s && dry_s < 1.5 * alone_s, "{dry_s} s, {alone_s} s");
    }
}

#[test]
fn nothing_begins_after_what_does_not_end_or_does_not_fit() {
    let bench = Bench::new("invert_after_wrong");
    let ran = bench.ends(2, &["run", "sheets.obv", "--after", "glue.obv"]);
    assert!(
        ran.stderr.contains("glue.obv:13:6: the workcell has no item `block_c`"),
        "{}",
        ran.stderr
    );
    bench.write("ends.obv", "cell \"vacuum_cell.toml\"\nsequence main { move to item_0.above }");
    let ran = bench.ends(2, &["check", "sheets.obv", "--after", "ends.obv"]);
    assert!(ran.stderr.contains("`item_0`"), "{}", ran.stderr);
    let away = "cell \"vacuum_cell.toml\"\nsequence main { move 5 m down in base }\n";
    bench.write("away.obv", away);
    let ran = bench.ends(2, &["run", "sheets.obv", "--after", "away.obv"]);
    let why = "away.obv: nothing can begin after it, since it does not end: fault:";
    assert!(ran.stderr.contains(why), "{}", ran.stderr);
}

#[test]
fn what_nobody_knows_is_left_to_who_calls_the_inverse() {
    let bench = Bench::new("invert_action");
    let inverse = bench.ends(0, &["invert", "sheets.obv", "lay"]).stdout;
    assert!(inverse.contains("// `main` is empty:"), "{inverse}");
    assert!(inverse.ends_with("sequence main {}\n"), "{inverse}");
    bench.write("lay_back.obv", &inverse);
    bench.ends(0, &["fmt", "--check", "lay_back.obv"]);
    let checked = bench.ends(0, &["check", "lay_back.obv"]).stdout;
    assert!(checked.starts_with("lay_back.obv: correct, no warnings;"), "{checked}");
    let lines = bench.ends(0, &["invert", "--json", "sheets.obv", "lay"]).json();
    assert_eq!(lines[0]["type"], "inverse");
    assert_eq!(
        (&lines[0]["name"], &lines[0]["is_begun_with"]),
        (&json!("lay_inverse"), &json!(false))
    );
    assert_eq!(lines[0]["text"], json!(inverse));
    assert_eq!((&lines[1]["type"], &lines[1]["outcome"]), (&json!("summary"), &json!("inverted")));
}

#[test]
fn a_sequence_without_an_inverse_is_found_wanting() {
    let bench = Bench::new("invert_refused");
    let ran = bench.ends(1, &["invert", "glue.obv", "draw_bead"]);
    assert_eq!(ran.stdout, "");
    assert!(
        ran.stderr.contains("[E0701]") && ran.stderr.contains("glue.obv:21:3"),
        "{}",
        ran.stderr
    );
    let lines = bench.ends(1, &["invert", "--json", "glue.obv", "main"]).json();
    let first = &lines[0];
    assert_eq!((&first["code"], &first["line"]), (&json!("E0701"), &json!(21)));
    assert_eq!(first["labels"][0]["text"], "called here");
    let summary = &lines[lines.len() - 1];
    assert_eq!((&summary["type"], &summary["outcome"]), (&json!("summary"), &json!("no inverse")));
}

#[test]
fn wrong_input_is_refused() {
    let bench = Bench::new("invert_wrong");
    bench.write("wrong.obv", "sequence main { move to nowhere }\n");
    bench.write("binary.obv", b"\xff\x00");
    bench.refuses(&["invert", "tower.obv", "pock"], &["no sequence or action `pock`", "`pick`?"]);
    bench.refuses(&["invert", "wrong.obv", "main"], &["[E0101]", "nowhere"]);
    bench.refuses(&["invert", "binary.obv", "main"], &["[E0007]"]);
    bench.refuses(&["invert", "none.obv", "main"], &["cannot be read"]);
    let assembly = bench.ends(0, &["dis", "tower.obv"]).stdout;
    bench.write("tower.obvasm", &assembly);
    bench.refuses(&["invert", "tower.obvasm", "main"], &["`.obvasm` is not for source text"]);
    bench.refuses(
        &["invert", "tower.obv", "grip"],
        &["`grip` is an I/O operation", "put `io grip` into an action"],
    );
    assert_eq!(bench.refuses_as_json(&["invert", "--json", "tower.obv", "pock"]).len(), 1);
}
