//! The check of moves and the dry run, as a user meets them.

use crate::support::Bench;
use serde_json::json;

/// In the bench cell: reachable, drawn at random, out of limits, called from one line.
const PROGRAM: &str = "cell \"bench_cell.toml\"
joints ready = [180, -90, 90, -90, -90, 0] deg
joints far   = [180, -90, 90, -90, -90, 400] deg
sequence again { move to far }
sequence main {
  move to ready
  move random(1 mm, 9 mm) up in base
  move to ready
  call again
}
";

#[test]
fn a_move_that_fails_is_told_with_its_line_its_reason_and_its_call() {
    let bench = Bench::new("moves");
    bench.write("m.obv", PROGRAM);
    let ran = bench.ends(1, &["check", "m.obv"]);
    let lines: Vec<&str> = ran.stdout.lines().collect();
    let row = |line: &str| {
        let at = lines.iter().position(|row| row.starts_with(line));
        at.unwrap_or_else(|| panic!("no row {line}\n{}", ran.stdout))
    };
    assert!(lines[row("     6  move to ready")].ends_with("  reachable"));
    assert!(lines[row("     7  move random")].ends_with("not known before running (P0602)"));
    let far = row("     4  move to far");
    assert!(lines[far].ends_with("out of limits (P0301)"), "{}", ran.stdout);
    assert!(lines[far + 1].contains("joint 6"), "{}", ran.stdout);
    assert!(lines[far + 1].ends_with("called from line 9"), "{}", ran.stdout);
    assert!(ran.stdout.contains("4 moves: 1 reachable, 2 not known"), "{}", ran.stdout);
}

#[test]
fn machines_are_told_a_move_a_line_and_a_summary_last() {
    let bench = Bench::new("moves_json");
    bench.write("m.obv", PROGRAM);
    let ran = bench.ends(1, &["check", "--json", "m.obv"]);
    let lines = ran.json();
    let moves: Vec<_> = lines.iter().filter(|line| line["type"] == "move").collect();
    assert_eq!(moves.len(), 4);
    let far = moves.iter().find(|line| line["line"] == 4).expect("the move of line 4");
    assert_eq!((&far["grade"], &far["code"]), (&json!("out_of_limits"), &json!("P0301")));
    assert_eq!(far["forward"]["always_fails"], json!(true));
    assert_eq!(far["forward"]["called_from_lines"].as_array().map(Vec::len), Some(2));
    let summary = ran.summary();
    assert_eq!((&summary["outcome"], &summary["complete"]), (&json!("moves_fail"), &json!(true)));
    assert_eq!(summary["moves"]["out_of_limits"], json!(1));
}

#[test]
fn what_is_not_known_fails_a_strict_check_alone() {
    let bench = Bench::new("moves_strict");
    bench.ends(0, &["check", "warm_up.obv"]);
    bench.ends(1, &["check", "--strict", "warm_up.obv"]);
    bench.ends(0, &["check", "--strict", "tower.obv"]);
    assert_eq!(
        bench.ends(1, &["check", "--strict", "--json", "warm_up.obv"]).summary()["outcome"],
        "moves_fail"
    );
}

/// What cannot be checked is not fine.
#[test]
fn a_workcell_that_cannot_be_read_fails_the_check() {
    let bench = Bench::new("moves_no_cell");
    bench.refuses(&["check", "tower.obv", "--cell", "none.toml"], &["none.toml: cannot be read"]);
    bench.write("w.toml", "arm = 3");
    bench.refuses(&["check", "tower.obv", "--cell", "w.toml"], &["w.toml:1:"]);
    let summary = bench.ends(2, &["check", "--json", "tower.obv", "--cell", "w.toml"]).summary();
    assert_eq!(summary["outcome"], "wrong");
    assert_eq!(summary["moves"], json!(null));
}

#[test]
fn what_the_tool_meets_is_named() {
    let bench = Bench::new("moves_collide");
    let text = String::from_utf8(bench.read("tower.obv")).expect("text");
    bench.write("t.obv", text.replace("[0, 0, -40.2] mm", "[0, 0, -30] mm"));
    let ran = bench.ends(1, &["check", "t.obv"]);
    assert!(ran.stdout.contains("in collision (P0503)"), "{}", ran.stdout);
    assert!(ran.stdout.contains("block_c met block_a at "), "{}", ran.stdout);
    let fault = bench.ends(1, &["run", "t.obv"]).stdout;
    assert!(fault.contains("block_c met block_a at "), "{fault}");
}

#[test]
fn every_reason_is_explained() {
    let bench = Bench::new("moves_explain");
    let page = bench.ends(0, &["explain", "p0503"]).stdout;
    assert!(page.starts_with("P0503: the held item meets something"), "{page}");
    assert!(page.lines().all(|line| line.chars().count() <= 80), "{page}");
    bench.refuses(&["explain", "P0599"], &["neither an opcode nor a code", "did you mean `P05"]);
}

#[test]
fn a_dry_run_tells_where_the_time_goes() {
    let bench = Bench::new("dry");
    let ran = bench.ends(0, &["run", "--dry", "tower.obv"]);
    assert!(ran.stdout.contains("finished; a cycle takes "), "{}", ran.stdout);
    let begins = |line: &str| ran.stdout.lines().any(|row| row.starts_with(line));
    assert!(begins("    34  main  ") && begins("    27  pick  "), "{}", ran.stdout);
    assert!(ran.stdout.contains("what a dry run does not show:"), "{}", ran.stdout);
    assert!(ran.stdout.lines().all(|line| line.chars().count() <= 120), "{}", ran.stdout);
    assert_eq!(ran.stdout, bench.ends(0, &["run", "--dry", "tower.obv"]).stdout);
}

/// The parts are the whole: what sequences and actions took is what the cycle took.
#[test]
fn the_times_of_a_dry_run_add_up() {
    let bench = Bench::new("dry_json");
    let ran = bench.ends(0, &["run", "--dry", "--json", "sorting.obv"]);
    let lines = ran.json();
    let total = |kind: &str, name: Option<&str>| -> f64 {
        let rows = lines.iter().filter(|line| line["type"] == kind);
        let rows = rows.filter(|line| name.is_none_or(|name| line["text"] == name));
        rows.filter_map(|line| line["total_s"].as_f64()).sum()
    };
    let cycle_s = ran.summary()["time_s"].as_f64().expect("a time");
    assert!(cycle_s > 0.0 && (total("action", None) - cycle_s).abs() < 1e-9);
    assert!((total("sequence", Some("main")) - cycle_s).abs() < 1e-9);
    assert!((total("sequence", Some("sort")) - cycle_s).abs() < 1e-9);
    let put = lines.iter().find(|line| line["text"] == "put").expect("the action");
    assert_eq!(put["count"], json!(3));
    assert!(put["least_s"].as_f64() <= put["mean_s"].as_f64());
    assert!(put["mean_s"].as_f64() <= put["most_s"].as_f64());
    assert_eq!(ran.summary()["guarded_moves"], json!(3));
    assert!(lines.iter().any(|line| line["type"] == "reading"));
    // A real run has noise, and all else alike.
    let real_s = bench.ends(0, &["run", "--json", "sorting.obv"]).summary()["time_s"].as_f64();
    assert!(real_s.is_some_and(|real_s| (real_s - cycle_s).abs() < 0.05 * cycle_s));
}

/// What settles beside a motion costs no time, whichever branch is written first.
#[test]
fn a_dry_run_shows_what_a_fork_saves() {
    let bench = Bench::new("dry_fork");
    let cycle_s = |body: &str| {
        let program = format!(
            "joints a = [0, -90, 90, -90, -90, 0] deg
joints b = [40, -90, 90, -90, -90, 0] deg
io close {{ set 1 high sleep 1 s }}
sequence main {{ move to a speed slow {body} }}"
        );
        bench.write("f.obv", program);
        let ran = bench.ends(0, &["run", "--dry", "--json", "f.obv"]);
        let actions = ran.json().into_iter().filter(|line| line["type"] == "action");
        let actions_s: f64 = actions.filter_map(|line| line["total_s"].as_f64()).sum();
        let time_s = ran.summary()["time_s"].as_f64().expect("it has a time");
        assert!((actions_s - time_s).abs() < 1e-9, "{body}: {actions_s} s of {time_s} s");
        time_s
    };
    let motion_s = cycle_s("move to b");
    assert!(motion_s > 1.5, "{motion_s}");
    assert!(cycle_s("move to b io close") > motion_s + 0.9);
    for fork in ["fork { move to b } and { io close }", "fork { io close } and { move to b }"] {
        let fork_s = cycle_s(fork);
        assert!((fork_s - motion_s).abs() < 1e-6, "{fork}: {fork_s} s, and {motion_s} s without");
    }
    // Here the other branch waits when one has ended.
    let fork_s = cycle_s("fork { move to b } and { wait 9 s }");
    assert!((fork_s - 9.0).abs() < 1e-6, "{fork_s}");
}

#[test]
fn a_dry_run_that_ends_otherwise_says_so() {
    let bench = Bench::new("dry_fault");
    bench.write("m.obv", PROGRAM);
    let ran = bench.ends(1, &["run", "--dry", "m.obv"]);
    assert!(ran.stdout.contains("fault: m.obv:4 `move to far`"), "{}", ran.stdout);
    let summary = bench.ends(1, &["run", "--dry", "--json", "m.obv"]).summary();
    assert_eq!((&summary["outcome"], &summary["stopped_at"]["line"]), (&json!("fault"), &json!(4)));
    bench.refuses(&["run", "--dry", "--tape", "t.tape", "m.obv"], &["cannot be used with"]);
}
