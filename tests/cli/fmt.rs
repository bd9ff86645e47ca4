//! `obverse fmt` through its binary: what is written, what is left alone, what is said.

use crate::support::{Bench, Ran};
use serde_json::json;
use std::io::Write;
use std::process::Stdio;

const UNTIDY: &str = "// head\nsequence main{wait 1s // behind\n}\n";
const TIDY: &str = "// head\nsequence main {\n  wait 1 s // behind\n}\n";

/// Runs with a text on standard input.
fn given(bench: &Bench, arguments: &[&str], input: &str) -> Ran {
    let mut command = bench.command(arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the binary runs");
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("it reads");
    Ran::from(child.wait_with_output().expect("it ends"))
}

#[test]
fn files_are_written_again_where_something_changes() {
    let bench = Bench::new("fmt");
    bench.write("untidy.obv", UNTIDY);
    let ran = bench.ends(0, &["fmt", "untidy.obv", "tower.obv"]);
    assert_eq!((ran.stdout.as_str(), ran.stderr.as_str()), ("untidy.obv: formatted\n", ""));
    assert_eq!(bench.read("untidy.obv"), TIDY.as_bytes());
    assert_eq!(bench.ends(0, &["fmt", "untidy.obv"]).stdout, "");
}

#[test]
fn the_programs_for_people_are_formatted() {
    let bench = Bench::new("fmt_programs");
    let files: Vec<String> =
        bench.files().into_keys().filter(|name| name.ends_with(".obv")).collect();
    let mut arguments = vec!["fmt", "--check"];
    arguments.extend(files.iter().map(String::as_str));
    assert!(files.len() >= 12);
    assert_eq!(bench.ends(0, &arguments).stdout, "");
}

#[test]
fn check_names_the_files_that_would_change_and_changes_none() {
    let bench = Bench::new("fmt_check");
    bench.write("untidy.obv", UNTIDY);
    let before = bench.files();
    let ran = bench.ends(1, &["fmt", "--check", "tower.obv", "untidy.obv"]);
    assert_eq!(ran.stdout, "untidy.obv: would be formatted otherwise\n");
    let lines = bench.ends(1, &["fmt", "--check", "--json", "tower.obv", "untidy.obv"]).json();
    let outcomes: Vec<_> = lines.iter().map(|line| &line["outcome"]).collect();
    assert_eq!(outcomes, [&json!("unchanged"), &json!("differs"), &json!("differs")]);
    assert_eq!((&lines[2]["files"], &lines[2]["changed"]), (&json!(2), &json!(1)));
    assert!(before == bench.files());
}

#[test]
fn one_text_can_be_printed() {
    let bench = Bench::new("fmt_stdout");
    bench.write("untidy.obv", UNTIDY);
    let before = bench.files();
    assert_eq!(bench.ends(0, &["fmt", "--stdout", "untidy.obv"]).stdout, TIDY);
    let ran = given(&bench, &["fmt", "-"], &format!("// \u{1b}[1m\r\n{UNTIDY}"));
    assert_eq!((ran.code, ran.stdout), (0, format!("// \u{1b}[1m\n{TIDY}")));
    let ran = given(&bench, &["fmt", "--check", "-"], UNTIDY);
    assert_eq!((ran.code, ran.stdout.as_str()), (1, "-: would be formatted otherwise\n"));
    assert!(before == bench.files());
    bench.refuses(&["fmt", "--stdout", "untidy.obv", "tower.obv"], &["only one text"]);
    bench.refuses(&["fmt", "--stdout", "--check", "untidy.obv"], &["cannot be used with"]);
    assert_eq!(bench.refuses_as_json(&["fmt", "--json", "-"]).len(), 1);
}

#[test]
fn a_file_with_mistakes_is_left_alone_and_the_others_are_formatted() {
    let bench = Bench::new("fmt_wrong");
    bench.write("untidy.obv", UNTIDY);
    bench.write("wrong.obv", "sequence main { mov to a }\n");
    bench.write("binary.obv", b"\xff\x00");
    let wrong = bench.read("wrong.obv");
    let ran = bench.ends(2, &["fmt", "wrong.obv", "binary.obv", "none.obv", "untidy.obv"]);
    for words in ["[E0010]", "[E0007]", "none.obv: cannot be read"] {
        assert!(ran.stderr.contains(words), "{}", ran.stderr);
    }
    assert_eq!(ran.stdout, "untidy.obv: formatted\n");
    assert_eq!(bench.read("untidy.obv"), TIDY.as_bytes());
    assert_eq!(bench.read("wrong.obv"), wrong);
    let lines = bench.ends(2, &["fmt", "--json", "wrong.obv"]).json();
    assert_eq!(lines[0]["type"], "diagnostic");
    assert_eq!((&lines[2]["outcome"], &lines[2]["wrong"]), (&json!("wrong"), &json!(1)));
    bench.refuses(&["fmt", "bench_cell.toml"], &["is not for source text"]);
    bench.refuses(&["fmt", "."], &["this is a folder"]);
}

#[test]
fn a_mistake_of_any_kind_leaves_a_file_alone_and_a_part_of_a_program_is_formatted() {
    let bench = Bench::new("fmt_meaning");
    let wrong = [
        ("name.obv", "sequence main{move to nowhere}\n", "E0101"),
        ("unit.obv", "sequence main{wait 3}\n", "E0203"),
        ("fork.obv", "sequence main{fork{set 1 high}and{set 1 low}}\n", "E0603"),
        ("part.obv", "joints _a=[0,0] deg\n", "E0205"),
    ];
    for (name, text, code) in wrong {
        bench.write(name, text);
        for arguments in [&["fmt", name][..], &["fmt", "--check", name], &["fmt", "--stdout", name]]
        {
            let ran = bench.ends(2, arguments);
            assert!(ran.stderr.contains(code) && ran.stdout.is_empty(), "{name}: {}", ran.stderr);
        }
        assert_eq!(bench.read(name), text.as_bytes());
    }
    let right = [
        ("poses.obv", "joints _home=[0,0,0,0,0,0] deg\n"),
        ("io.obv", "error jam{recover using free}\n"),
        ("unused.obv", "import \"poses.obv\"\nsequence main{wait 1 s}sequence never{wait 1 s}\n"),
        ("in_vain.obv", "import \"none.obv\"\nsequence main{move to home}\n"),
        ("beside.obv", "import \"unit.obv\"\naction _pick{wait 1 s}\n"),
    ];
    for (name, text) in right {
        bench.write(name, text);
        let ran = bench.ends(0, &["fmt", name]);
        assert_eq!(ran.stdout, format!("{name}: formatted\n"), "{}", ran.stderr);
    }
}

/// In time that goes with the square of the line it would take longer than anybody waits.
#[test]
fn a_line_of_many_statements_becomes_many_lines() {
    let bench = Bench::new("fmt_long_line");
    let statements = "x += 1; ".repeat(30_000);
    bench.write("long.obv", format!("sequence main {{ var x = 0 {statements}}}\n"));
    let ran = bench.ends(0, &["fmt", "long.obv"]);
    assert_eq!(ran.stdout, "long.obv: formatted\n", "{}", ran.stderr);
    assert!(String::from_utf8_lossy(&bench.read("long.obv")).lines().count() > 29_900);
}

#[cfg(unix)]
#[test]
fn who_may_read_a_file_stays_as_it_was_and_a_link_stays_a_link() {
    use std::fs;
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::new("fmt_mode");
    bench.write("untidy.obv", UNTIDY);
    fs::set_permissions(bench.path("untidy.obv"), fs::Permissions::from_mode(0o640)).expect("set");
    std::os::unix::fs::symlink("untidy.obv", bench.path("link.obv")).expect("a link");
    bench.ends(0, &["fmt", "link.obv"]);
    let mode = fs::metadata(bench.path("untidy.obv")).expect("the file").permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
    assert!(fs::symlink_metadata(bench.path("link.obv")).expect("the link").is_symlink());
    assert_eq!(bench.read("untidy.obv"), TIDY.as_bytes());
}
