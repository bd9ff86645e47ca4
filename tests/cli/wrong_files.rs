//! Modules and tapes that are damaged or foreign, and outputs that cannot or must not be written.

use crate::support::Bench;
use serde_json::json;
use std::process::Stdio;

/// A folder with a module `m.obc` and a tape `t.tape` of the same program.
fn bench(test: &str) -> Bench {
    let bench = Bench::new(test);
    bench.ends(0, &["build", "tower.obv", "-o", "m.obc"]);
    bench.ends(0, &["run", "m.obc", "--tape", "t.tape"]);
    bench
}

fn flipped(bytes: &[u8], at: usize) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[at] ^= 0x10;
    bytes
}

#[test]
fn a_truncated_file_is_refused_wherever_it_ends() {
    let bench = bench("truncated");
    for (file, command) in [("m.obc", "run"), ("t.tape", "tape")] {
        let whole = bench.read(file);
        let name = format!("cut_{file}");
        for length in [0, 1, 7, 8, 20, 35, 36, 37, whole.len() / 2, whole.len() - 1] {
            bench.write(&name, &whole[..length]);
            bench.refuses(&[command, &name], &[&format!("{name}: byte ")]);
        }
        let longer: Vec<u8> = whole.iter().copied().chain([0]).collect();
        bench.write(&name, longer);
        bench.refuses(&[command, &name], &[&format!("{name}: byte 20"), "added to"]);
    }
}

#[test]
fn a_flipped_bit_is_found_wherever_it_is() {
    let bench = bench("flipped");
    for (file, command) in [("m.obc", "run"), ("t.tape", "tape")] {
        let whole = bench.read(file);
        let name = format!("flip_{file}");
        for at in [0, 8, 12, 20, 28, 36, 100, whole.len() - 1] {
            bench.write(&name, flipped(&whole, at));
            bench.refuses(&[command, &name], &[&format!("{name}: byte ")]);
        }
    }
}

#[test]
fn a_file_of_another_table_or_version_says_so() {
    let bench = bench("other_table");
    let (module, tape) = (bench.read("m.obc"), bench.read("t.tape"));
    bench.write("table.obc", flipped(&module, 12));
    bench.refuses(
        &["run", "table.obc"],
        &["byte 12", "instruction table", "compile the program again"],
    );
    bench.write("version.obc", flipped(&module, 8));
    bench.refuses(
        &["dis", "version.obc"],
        &["byte 8", "format version", "compile the program again"],
    );
    bench.write("table.tape", flipped(&tape, 12));
    bench.refuses(&["tape", "table.tape"], &["byte 12", "record the run again"]);
}

#[test]
fn a_file_of_another_kind_is_no_tape_and_no_program() {
    let bench = bench("other_kind");
    bench.refuses(&["tape", "m.obc"], &["m.obc: byte 0", "no tape"]);
    bench.refuses(&["tape", "tower.obv"], &["tower.obv: byte 0", "no tape"]);
    for command in ["check", "build", "run", "back", "dis"] {
        bench.refuses(&[command, "t.tape"], &["t.tape: this is a tape", "`obverse tape t.tape`"]);
    }
}

/// A tape whose header is right, with the module of one program and the state of another.
#[test]
fn a_foreign_tape_is_refused() {
    use obverse_bytecode::{encode, fingerprint};
    use obverse_tape::TapeFile;
    let bench = bench("foreign");
    let (mut file, _) = TapeFile::from_bytes(&bench.read("t.tape")).expect("a tape");
    let other = obverse_compiler::compile("other.obv", "sequence main { wait 1 s }");
    let module = encode(&other.module.expect("a module")).expect("bytes");
    file.module.clone_from(&module);
    bench.write("f.tape", file.to_bytes().expect("bytes"));
    bench.refuses(&["tape", "f.tape"], &["f.tape", "its module is not the one that was run"]);
    file.fingerprint = fingerprint(&module);
    bench.write("f.tape", file.to_bytes().expect("bytes"));
    bench.refuses(&["tape", "f.tape"], &["f.tape: its records do not fit the program"]);
}

/// A tape of the right program from which records are missing.
#[test]
fn a_tape_without_its_records_is_refused() {
    use obverse_tape::TapeFile;
    let bench = bench("hollow");
    let (mut file, _) = TapeFile::from_bytes(&bench.read("t.tape")).expect("a tape");
    file.streams = Default::default();
    bench.write("h.tape", file.to_bytes().expect("bytes"));
    bench.refuses(&["tape", "h.tape"], &["h.tape: its records do not fit the program"]);
}

/// A tape that says that the run was shorter than its records: the walk ends all the same.
#[test]
fn a_tape_that_leads_past_its_start_is_refused() {
    use obverse_tape::TapeFile;
    let bench = bench("short");
    let (mut file, _) = TapeFile::from_bytes(&bench.read("t.tape")).expect("a tape");
    for steps in [0, 1, 5, file.state.steps - 1] {
        file.state.steps = steps;
        bench.write("s.tape", file.to_bytes().expect("bytes"));
        bench.refuses(&["tape", "s.tape"], &["s.tape: its records do not fit the program: "]);
    }
}

/// A module whose checksum is right and whose content is not: it is not run, and can be looked at.
#[test]
fn a_module_that_does_not_verify_is_not_run() {
    use obverse_bytecode::{Module, decode, encode};
    type Change = fn(&mut Module);
    let bench = bench("unverified");
    let module = decode(&bench.read("m.obc")).expect("a module");
    let changes: &[Change] = &[
        |module| module.constants.clear(),
        |module| module.items.clear(),
        |module| module.keyframes.clear(),
        |module| module.functions.clear(),
        |module| module.functions.truncate(2),
        |module| module.functions[1].end = u32::MAX,
        |module| module.functions[1].first = u32::MAX,
        |module| module.code.clear(),
        |module| module.code.truncate(5),
        |module| module.code.reverse(),
    ];
    for (number, change) in changes.iter().enumerate() {
        let mut changed = module.clone();
        change(&mut changed);
        bench.write("x.obc", encode(&changed).expect("bytes"));
        for command in ["check", "run", "back"] {
            bench.refuses(&[command, "x.obc"], &["]: x.obc: "]);
        }
        let shown = bench.run(&["dis", "x.obc"]);
        assert_eq!((shown.code, shown.stderr.as_str()), (0, ""), "change {number}");
    }
}

/// A tape whose checksum is right and whose content is not: shown as far as it makes sense, or
/// refused, and the process ends well.
#[test]
fn a_tape_with_anything_in_it_is_shown_or_refused() {
    use obverse_tape::{Snapshot, TapeFile};
    type Change = fn(&mut Snapshot);
    let bench = bench("hostile");
    let (file, module) = TapeFile::from_bytes(&bench.read("t.tape")).expect("a tape");
    let changes: &[Change] = &[
        |state| state.steps = 0,
        |state| state.steps = u64::MAX,
        |state| state.operands = vec![7; 300],
        |state| state.frames.clear(),
        |state| state.frames = vec![state.frames[0].clone(); 2000],
        |state| state.frames.push(state.frames[0].clone()),
        |state| state.frames[0].return_pc = u32::MAX,
        |state| state.frames[0].function = u16::MAX,
        |state| state.frames[0].words = vec![u64::MAX; 1000],
        |state| state.frames[0].positions = vec![[f64::NAN; 6]; 1000],
        |state| state.globals = vec![u64::MAX; 1000],
        |state| state.settings = [u64::MAX; 5],
        |state| state.raised = vec![u16::MAX; 1000],
        |state| state.pending = Some((false, None)),
        |state| state.pending = Some((true, Some(true))),
        |state| state.joints = [f64::NAN; 6],
        |state| state.outputs = Vec::new(),
    ];
    let show = |state: Snapshot, what: &str| {
        let changed = TapeFile { state, ..file.clone() };
        bench.write("x.tape", changed.to_bytes().expect("bytes"));
        let ran = bench.run(&["tape", "x.tape"]);
        assert!(ran.code == 0 || ran.code == 2, "{what}: {}\n{}", ran.code, ran.stderr);
        assert!(!ran.stderr.contains("panicked"), "{what}: {}", ran.stderr);
        assert_eq!(
            ran.code == 2,
            ran.stderr.starts_with("error: x.tape: "),
            "{what}: {}",
            ran.stderr
        );
    };
    for (number, change) in changes.iter().enumerate() {
        let mut state = file.state.clone();
        change(&mut state);
        show(state, &format!("change {number}"));
    }
    let end = u32::try_from(module.code.len()).expect("a short program");
    for pc in (0..=end).chain([u32::MAX]) {
        show(Snapshot { pc, ..file.state.clone() }, &format!("at {pc}"));
    }
}

#[test]
fn an_output_that_cannot_be_written_is_known_before_the_run() {
    let bench = bench("unwritable");
    let nowhere = ["there is no folder nowhere"];
    bench.refuses(&["build", "tower.obv", "-o", "nowhere/x.obc"], &nowhere);
    bench.refuses(&["run", "tower.obv", "--tape", "nowhere/x.tape"], &nowhere);
    bench.refuses(&["back", "tower.obv", "--tape", "nowhere/x.tape"], &nowhere);
    bench.refuses(&["build", "tower.obv", "-o", "."], &["this is a folder"]);
    bench.refuses(&["run", "tower.obv", "--tape", ".."], &["this is a folder"]);
    bench.refuses(&["build", "tower.obv", "-o", ""], &["a value is required"]);
    if cfg!(target_os = "linux") {
        bench.refuses(
            &["build", "tower.obv", "-o", "/proc/x.obc"],
            &["/proc/x.obc: cannot be written"],
        );
    }
}

#[test]
fn an_output_never_takes_the_place_of_what_people_write() {
    let bench = bench("overwrite");
    bench.refuses(&["build", "tower.obv", "-o", "tower.obv"], &["would overwrite tower.obv"]);
    bench.refuses(&["build", "tower.obv", "-o", "./tower.obv"], &["would overwrite tower.obv"]);
    bench.refuses(&["build", "m.obc"], &["would overwrite m.obc"]);
    bench.refuses(&["build", "tower.obv", "-o", "screws.obv"], &["`.obv`"]);
    bench.refuses(&["build", "tower.obv", "-o", "new.toml"], &["`.toml`"]);
    bench.refuses(&["run", "tower.obv", "--tape", "tower.obv"], &["would overwrite tower.obv"]);
    bench.refuses(&["run", "m.obc", "--tape", "m.obc"], &["would overwrite m.obc"]);
    bench.refuses(
        &["run", "tower.obv", "--tape", "bench_cell.toml"],
        &["overwrite bench_cell.toml"],
    );
    bench.refuses(&["back", "tower.obv", "--tape", "sheets.obv"], &["`.obv`"]);
}

#[cfg(unix)]
#[test]
fn an_output_by_another_name_is_known_for_the_same_file() {
    let bench = bench("linked");
    std::os::unix::fs::symlink(bench.path("m.obc"), bench.path("link.obc")).expect("a link");
    bench.refuses(&["build", "m.obc", "-o", "link.obc"], &["would overwrite m.obc"]);
}

/// What a link leads to is written, and the link stays one.
#[cfg(unix)]
#[test]
fn an_output_through_a_link_goes_where_the_link_leads() {
    use std::os::unix::fs::symlink;
    let bench = bench("through_link");
    bench.write("kept.obc", "old");
    symlink("kept.obc", bench.path("link.obc")).expect("a link");
    bench.ends(0, &["build", "screws.obv", "-o", "link.obc"]);
    bench.ends(0, &["check", "kept.obc"]);
    assert!(std::fs::symlink_metadata(bench.path("link.obc")).expect("a file").is_symlink());
    symlink("screws.obv", bench.path("text.obc")).expect("a link");
    bench.refuses(&["build", "tower.obv", "-o", "text.obc"], &["`.obv`"]);
    symlink("nothing.obc", bench.path("lost.obc")).expect("a link");
    bench
        .refuses(&["build", "tower.obv", "-o", "lost.obc"], &["lost.obc: this link leads nowhere"]);
    symlink("round.obc", bench.path("round.obc")).expect("a link");
    bench.refuses(&["build", "tower.obv", "-o", "round.obc"], &["this link leads nowhere"]);
}

/// A pipe or a device would be replaced by a file.
#[cfg(unix)]
#[test]
fn an_output_that_is_no_regular_file_is_refused() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let folder = Bench::new("pipes");
    let made = std::process::Command::new("mkfifo").arg(folder.path("pipe")).status();
    assert!(made.expect("mkfifo").success());
    symlink("pipe", folder.path("link")).expect("a link");
    for name in ["pipe", "link"] {
        let build = ["build", "tower.obv", "-o", name];
        let run = ["run", "tower.obv", "--tape", name];
        let back = ["back", "tower.obv", "--tape", name];
        for arguments in [build, run, back] {
            let ran = folder.ends(2, &arguments);
            assert!(ran.stderr.contains("no regular file"), "{}", ran.stderr);
            assert_eq!(ran.stdout, "");
        }
    }
    let pipe = std::fs::symlink_metadata(folder.path("pipe")).expect("the pipe");
    assert!(pipe.file_type().is_fifo());
}

/// The run was made: what came of it is told, although its tape is lost.
#[test]
fn a_tape_that_cannot_be_written_loses_no_figures() {
    let bench = Bench::new("lost_tape");
    // No folder takes such a name, which is only known when the file is made.
    let name = "t".repeat(300);
    for (command, last) in [("run", " bits of tape, "), ("back", " instructions taken back, ")] {
        let ran = bench.ends(2, &[command, "tower.obv", "--tape", &name]);
        assert!(ran.stderr.contains("cannot be written"), "{}", ran.stderr);
        assert!(ran.stdout.lines().last().is_some_and(|line| line.contains(last)));
        let ran = bench.ends(2, &[command, "--json", "tower.obv", "--tape", &name]);
        let (lines, summary) = (ran.json(), ran.summary());
        assert_eq!(lines.iter().filter(|line| line["type"] == "summary").count(), 1);
        assert!(summary["tape_bits"].as_u64() > Some(0), "{summary}");
        assert_eq!(summary["messages"][0]["file"], json!(name));
    }
    assert!(bench.files().keys().all(|name| !name.contains(".part")));
    // As long as a name can be.
    bench.ends(0, &["run", "tower.obv", "--tape", &"t".repeat(250)]);
}

/// What was there before stays if the new program is wrong, and goes as a whole if it is right.
#[test]
fn an_older_output_is_replaced_as_a_whole_or_not_at_all() {
    let bench = bench("replaced");
    let before = bench.read("m.obc");
    bench.write("wrong.obv", "sequence main { wait 3 mm }");
    bench.refuses(&["build", "wrong.obv", "-o", "m.obc"], &["E0202"]);
    assert_eq!(bench.read("m.obc"), before);
    bench.ends(0, &["build", "screws.obv", "-o", "m.obc"]);
    bench.ends(0, &["check", "m.obc"]);
    assert!(bench.files().keys().all(|name| !name.contains(".part")));
}

#[test]
fn a_full_standard_output_is_an_error() {
    if !cfg!(target_os = "linux") {
        return;
    }
    let bench = bench("full");
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("/dev/full");
    let mut command = bench.command(&["isa"]);
    let output = command.stdout(Stdio::from(full)).output().expect("the binary runs");
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("standard output cannot be written"), "{said}");
}
