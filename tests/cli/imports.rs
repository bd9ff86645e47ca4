//! Programs of several files: what is read, what is not, and where messages say that things are.

use crate::support::Bench;
use serde_json::json;

/// A program of two files, one in a folder, with a mistake or not.
fn write(bench: &Bench, main: &str, poses: &str) {
    bench.write("main.obv", format!("import \"cell/poses.obv\"\n{main}"));
    bench.write("cell/poses.obv", poses);
}

const HOME: &str = "joints home = [0, -90, 90, -90, -90, 0] deg\n";
const MAIN: &str = "sequence main { move to home }\n";

#[test]
fn every_command_takes_a_program_of_several_files() {
    let bench = Bench::new("several");
    write(&bench, MAIN, HOME);
    bench.ends(0, &["check", "main.obv"]);
    bench.ends(0, &["back", "main.obv"]);
    bench.ends(0, &["build", "main.obv"]);
    bench.ends(0, &["run", "main.obc", "--tape", "t.tape"]);
    bench.ends(0, &["tape", "t.tape"]);
    let listing = bench.ends(0, &["dis", "main.obv"]).stdout;
    assert!(listing.contains(".source \"main.obv\"") && listing.contains("cell/poses.obv"));
    bench.write("again.obvasm", &listing);
    bench.ends(0, &["build", "again.obvasm", "-o", "again.obc"]);
    assert!(bench.read("again.obc") == bench.read("main.obc"), "the same bytes");
}

#[test]
fn messages_name_the_file_that_they_are_about() {
    let bench = Bench::new("named");
    write(&bench, MAIN, "joints home = [0, -90, 90] deg\nvar x = 3 mmm\n");
    bench.refuses(&["check", "main.obv"], &["cell/poses.obv:2:", "E0005", "main.obv: 2 errors"]);
    let path = bench.path("main.obv");
    let absolute = path.to_str().expect("text");
    let poses = bench.path("cell/poses.obv");
    bench.refuses(&["check", absolute], &[poses.to_str().expect("text")]);
    write(&bench, "sequence main { move to home.top }", HOME);
    let told = bench.ends(2, &["check", "--json", "main.obv"]).json();
    assert_eq!((&told[0]["file"], &told[0]["line"]), (&json!("main.obv"), &json!(2)));
    assert_eq!(told[0]["labels"][0]["file"], "cell/poses.obv");
}

/// A story, the end of a run, a tape and a listing: where the program is in which file.
#[test]
fn a_run_names_the_file_that_it_is_in() {
    let bench = Bench::new("story");
    let action = "action stop { barrier \"glued\" wait 1 s }\n";
    write(&bench, "sequence main { move to home call stop }", &format!("{HOME}{action}"));
    let told = bench.ends(0, &["back", "main.obv"]).stdout;
    assert!(told.contains("cannot go back past cell/poses.obv:2: glued"), "{told}");
    let summary = bench.ends(0, &["back", "--json", "main.obv"]).summary();
    assert_eq!(summary["stopped_at"]["file"], "cell/poses.obv");
    let events = bench.ends(0, &["run", "--json", "main.obv"]).json();
    let waits = events.iter().find(|event| event["opcode"] == "wait").expect("it waits");
    assert_eq!((&waits["file"], &waits["line"]), (&json!("cell/poses.obv"), &json!(2)));
    let listed = bench.ends(0, &["dis", "--json", "main.obv"]).json();
    let files = listed.iter().filter_map(|one| one["file"].as_str());
    assert!(files.clone().any(|file| file == "main.obv"));
    assert!(files.clone().any(|file| file == "cell/poses.obv"));
    bench.ends(0, &["run", "main.obv", "--tape", "t.tape"]);
    let tape = bench.ends(0, &["tape", "t.tape"]).stdout;
    assert!(tape.contains("cell/poses.obv:2"), "{tape}");
}

#[test]
fn a_file_is_read_once_however_it_is_imported() {
    let bench = Bench::new("once");
    write(&bench, &format!("import \"cell/../cell//poses.obv\"\nimport \"io.obv\"\n{MAIN}"), HOME);
    bench.write("io.obv", "import \"./cell/poses.obv\"\noutput lamp = 1\n");
    bench.ends(0, &["check", "main.obv"]);
    bench.ends(0, &["build", "main.obv"]);
    let listing = bench.ends(0, &["dis", "main.obc"]).stdout;
    assert_eq!(listing.matches("\n.source ").count(), 3, "{listing}");
}

#[test]
fn a_workcell_is_beside_the_file_that_names_it() {
    let bench = Bench::new("beside");
    bench.write("cell/pin.toml", bench.read("pin_cell.toml"));
    write(&bench, MAIN, &format!("{HOME}cell \"pin.toml\"\n"));
    let checked = bench.ends(0, &["check", "main.obv"]).stdout;
    assert!(checked.contains("workcell: cell/pin.toml"), "{checked}");
    write(&bench, MAIN, &format!("{HOME}cell \"none.toml\"\n"));
    bench.refuses(&["run", "main.obv"], &["cell/none.toml: cannot be read", "cell/poses.obv:2:6:"]);
}

#[test]
fn no_output_replaces_a_file_that_is_imported() {
    let bench = Bench::new("replace");
    bench.write("main.obv", format!("import \"poses\"\n{MAIN}"));
    bench.write("poses", HOME);
    bench.refuses(&["build", "main.obv", "-o", "poses"], &["would overwrite poses"]);
    bench.refuses(&["run", "main.obv", "--tape", "./poses"], &["would overwrite"]);
}

#[test]
fn what_cannot_be_imported_is_said_at_the_import() {
    let bench = Bench::new("cannot");
    bench.write("latin.obv", b"joints h\xf6he = 1");
    bench.write("module.obv", b"OBVERSE\0\x01\0");
    bench.write("folder/x.obv", "");
    let cases = [
        ("none.obv", "no such file"),
        ("folder", "this is a folder"),
        ("latin.obv", "byte 8 (counted from 0) is not UTF-8"),
        ("module.obv", "a NUL byte"),
        ("latin.obv/x", "not a directory"),
    ];
    for (path, why) in cases {
        bench.write("main.obv", format!("\n import \"{path}\"\nsequence main {{ wait 1 s }}"));
        bench.refuses(&["check", "main.obv"], &["E0501", "main.obv:2:9", why]);
    }
    bench.write("main.obv", "import \"../cli_cannot/main.obv\"\nsequence main { wait 1 s }");
    bench.refuses(&["check", "main.obv"], &["E0502", "main.obv:1:8"]);
}

#[cfg(unix)]
#[test]
fn links_are_followed_within_the_folder_of_the_program() {
    use std::os::unix::fs::symlink;
    let bench = Bench::new("links");
    write(&bench, MAIN, HOME);
    symlink("poses.obv", bench.path("cell/same.obv")).expect("a link");
    write(&bench, &format!("import \"cell/same.obv\"\n{MAIN}"), HOME);
    bench.ends(0, &["check", "main.obv"]);
    symlink("/etc/hostname", bench.path("cell/out.obv")).expect("a link");
    symlink("round.obv", bench.path("cell/round.obv")).expect("a link");
    for (path, why) in [("out", "a link leads out of the program's folder"), ("round", "imported")]
    {
        write(&bench, &format!("import \"cell/{path}.obv\"\n{MAIN}"), HOME);
        bench.refuses(&["check", "main.obv"], &["E0501", why]);
    }
    // A device has no end, and a pipe may have no beginning.
    symlink("/dev/zero", bench.path("cell/zero.obv")).expect("a link");
    write(&bench, &format!("import \"cell/zero.obv\"\n{MAIN}"), HOME);
    bench.refuses(&["check", "main.obv"], &["E0501"]);
}

#[cfg(unix)]
#[test]
fn a_pipe_is_not_waited_for() {
    let bench = Bench::new("pipe");
    let made = std::process::Command::new("mkfifo").arg(bench.path("pipe.obv")).status();
    if !made.is_ok_and(|status| status.success()) {
        return;
    }
    bench.write("main.obv", format!("import \"pipe.obv\"\n{MAIN}"));
    let ran = bench.ends(2, &["check", "main.obv"]);
    assert!(ran.stderr.contains("this is no regular file"), "{}", ran.stderr);
}

#[test]
fn a_row_of_imports_has_an_end() {
    let bench = Bench::new("row");
    for index in 0..80 {
        bench.write(&format!("{index}.obv"), format!("import \"{}.obv\"\n", index + 1));
    }
    bench.write("80.obv", MAIN);
    bench.refuses(&["check", "0.obv"], &["E0504", "64.obv:1:8", "at most 64 files"]);
    bench.ends(2, &["check", "20.obv"]);
}

#[test]
fn the_workcell_is_told_from_the_program_in_both_places() {
    let bench = Bench::new("both");
    bench.write("io.obv", "output lamp = 2\noutput horn = 12\ninput door = 9\n");
    let main = "cell \"pin_cell.toml\"\nimport \"io.obv\"\n\
                item pin_11 { keyframe k = [0, 0, 0] mm }\n\
                item widget { keyframe k = [0, 0, 0] mm }\n\
                sequence main {\n  tool griper\n  set horn high\n  move to pin_11.k\n\
                set 9 low\n}\n";
    bench.write("main.obv", main);
    let cell = String::from_utf8(bench.read("pin_cell.toml")).expect("text");
    let place = |needle: &str, after: usize| {
        let at = cell.lines().position(|line| line == needle).expect(needle) + 1;
        format!("pin_cell.toml:{}:", at + after)
    };
    let expected = [
        "main.obv:3:6: the workcell has no item `pin_11`",
        &format!("{}8: did you mean `pin_1`", place("name = \"pin_1\"", 0)),
        "main.obv:4:6: the workcell has no item `widget`",
        &format!("{}8: its items begin here: `pin_1`, `pin_2`", place("name = \"pin_1\"", 0)),
        "main.obv:6:8: the workcell has no tool `griper`",
        &format!("{}8: did you mean `gripper`", place("name = \"gripper\"", 0)),
        "main.obv:9:1: there is no output 9: the workcell has 8",
        "io.obv:2:1: there is no output 12: the workcell has 8",
        "main.obv:7:3: it is needed here",
        &format!("{}9: it says here that it has 8 outputs", place("[outputs]", 1)),
        "io.obv:3:1: there is no input 9: the workcell has 8",
    ];
    bench.refuses(&["check", "main.obv"], &expected);
    bench.refuses(&["run", "main.obv"], &expected);
    let told = bench.refuses_as_json(&["run", "--json", "main.obv"]);
    assert_eq!((&told[0]["file"], &told[0]["line"]), (&json!("main.obv"), &json!(3)));
    assert_eq!(told[0]["labels"][0]["file"], "pin_cell.toml");
    assert!(told[0]["labels"][0]["line"].as_u64() > Some(1));
    // A module says it of its sources as well.
    bench.ends(0, &["build", "main.obv"]);
    bench.refuses(&["run", "main.obc", "--cell", "pin_cell.toml"], &["main.obv:3:6", "io.obv:2:1"]);
}

/// Whatever speaks of lines says of which file where there are several, in columns as wide as that.
#[test]
fn tables_name_the_files_of_their_lines() {
    let bench = Bench::new("files_of_lines");
    let poses = "joints home = [0, -90, 90, -90, -90, 0] deg
action visit {
  move to home
}";
    let main = "import \"taught_poses.obv\"
sequence main {
  wait until input 1 high for up to 1 s
  irreversible \"glued\" { toggle 2 }
  call visit
  move to home
}";
    bench.write("taught_poses.obv", poses);
    bench.write("main.obv", main);
    let checked = bench.ends(0, &["check", "main.obv"]).stdout;
    let columns = |table: &str, word: &str, lines: &[&str]| {
        let header = table.lines().find(|line| line.trim_start().starts_with("line  "));
        let column = header.and_then(|header| header.find(word)).expect("a table");
        for line in lines {
            let row = table.lines().find(|row| row.trim_start().starts_with(line));
            let row = row.unwrap_or_else(|| panic!("no {line} in {table}"));
            assert_eq!(row.find(line).map(|at| at + line.len() + 2), Some(column), "{table}");
        }
    };
    columns(&checked, "move", &["taught_poses.obv:3", "main.obv:6"]);
    let dry = bench.ends(0, &["run", "--dry", "main.obv"]).stdout;
    let (sequences, rest) = dry.split_once("action  ").expect("two tables");
    columns(sequences, "sequence", &["main.obv:2", "taught_poses.obv:2"]);
    let (_, header) = sequences.rsplit_once('\n').expect("a header");
    columns(&format!("{header}action  {rest}"), "action", &["main.obv:6", "taught_poses.obv:3"]);
    assert!(dry.contains("main.obv:3  input 1"), "{dry}");
    let rows = bench.ends(0, &["run", "--dry", "--json", "main.obv"]).json();
    let visit = rows.iter().find(|row| row["text"] == "visit").expect("the action");
    assert_eq!(
        (visit["file"].as_str(), visit["line"].as_u64()),
        (Some("taught_poses.obv"), Some(2))
    );
    let drawn = bench.ends(0, &["reach", "--ascii", "main.obv"]).stdout;
    let at = |what: &str| drawn.find(what).unwrap_or_else(|| panic!("no {what} in {drawn}"));
    assert!(at("  main.obv\n") < at("call visit") && at("call visit") < at("  taught_poses.obv\n"));
    assert!(drawn.contains("main.obv:5-6, taught_poses.obv:3"), "{drawn}");
    let reach = bench.ends(0, &["reach", "--json", "main.obv"]).json();
    let stops = reach.iter().find(|row| row["text"] == "move to home").expect("the move");
    assert_eq!(stops["stops"][0]["file"], "main.obv", "{stops}");
}
