//! Modules and tapes that are damaged or foreign, and outputs that cannot or must not be written.

use crate::support::Bench;
use obverse_debugger::file::Piece;
use obverse_debugger::recording::{Facts, Log, Order, Stretch};
use obverse_debugger::{Head, Moment, Recording, TapeFile, Writer};
use obverse_isa::ErrorId;
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
        if file == "m.obc" {
            bench.write(&name, [&whole[..], &[0]].concat());
            bench.refuses(&[command, &name], &[&format!("{name}: byte 20"), "added to"]);
        }
        // Of a tape, behind its head, what is there is shown.
        let late = if file == "m.obc" { whole.len() - 1 } else { 100 };
        for length in [0, 1, 7, 8, 20, 35, 36, 37, late / 2, late] {
            bench.write(&name, &whole[..length]);
            bench.refuses(&[command, &name], &[&format!("{name}: byte ")]);
        }
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

/// A tape of one program with the module of another.
#[test]
fn a_foreign_tape_is_refused() {
    use obverse_bytecode::encode;
    let bench = bench("foreign");
    let other = obverse_compiler::compile("other.obv", "sequence main { wait 1 s }");
    let module = encode(&other.module.expect("a module")).expect("bytes");
    bench.write("f.tape", altered(&bench.read("t.tape"), |head, _| head.module = module.clone()));
    for command in [&["tape", "f.tape"][..], &["debug", "--tape", "f.tape"]] {
        bench.refuses(command, &["f.tape: what it records is not what its program does"]);
    }
}

/// A tape of the right program from which answers of the workcell are missing.
#[test]
fn a_tape_without_its_answers_is_refused() {
    let bench = bench("hollow");
    let hollow = altered(&bench.read("t.tape"), |_, pieces| {
        pieces.iter_mut().for_each(|piece| piece.log = Log::default());
    });
    bench.write("h.tape", hollow);
    bench.refuses(&["tape", "h.tape"], &["h.tape: what it records is not what its program does"]);
}

/// The same tape with its head and its pieces changed.
fn altered(bytes: &[u8], change: impl FnOnce(&mut Head, &mut [Piece])) -> Vec<u8> {
    let file = TapeFile::from_bytes(bytes).expect("a tape");
    let (mut head, recording) = (file.head, file.recording);
    let Recording { log, mut stretches, end, .. } = recording;
    stretches.remove(0);
    let mut pieces = [Piece { log, stretches, end }];
    change(&mut head, &mut pieces);
    let mut altered = Vec::new();
    let mut writer = Writer::begin(&mut altered, head);
    pieces.into_iter().for_each(|piece| writer.piece(piece));
    writer.end("finished").expect("memory can be written");
    altered
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

/// A tape whose checksums are right and whose content is not: shown as far as it makes sense, or
/// refused, and the process ends well.
#[test]
fn a_tape_with_anything_in_it_is_shown_or_refused() {
    type Change = fn(&mut Head, &mut [Piece]);
    let bench = bench("hostile");
    let whole = bench.read("t.tape");
    let changes: &[Change] = &[
        |head, _| head.module.clear(),
        |head, _| head.program.clear(),
        |head, _| head.facts = Facts::default(),
        |head, _| head.facts.outputs = u16::MAX,
        |head, _| head.start.outputs.clear(),
        |head, _| head.start.joints.0 = [f64::NAN; 6],
        |head, _| head.start.now_s = f64::NEG_INFINITY,
        |_, pieces| pieces[0].end = Moment(0),
        |_, pieces| pieces[0].end = Moment(u64::MAX),
        |_, pieces| pieces[0].end = pieces[0].end.after(1000),
        |_, pieces| pieces[0].log.frames.truncate(3),
        |_, pieces| pieces[0].log.frames.reverse(),
        |_, pieces| pieces[0].log.motions.clear(),
        |_, pieces| pieces[0].log.motions.iter_mut().for_each(|it| it.joints.0 = [f64::NAN; 6]),
        |_, pieces| pieces[0].log.frames.iter_mut().for_each(|it| it.fault = Some(9)),
        |_, pieces| pieces[0].stretches.push(stretch(Order::Note(7), 0, 0)),
        |_, pieces| pieces[0].stretches.push(stretch(Order::Reverse, 0, 0)),
        |_, pieces| pieces[0].stretches.push(stretch(Order::Reverse, 1, u64::MAX)),
        |_, pieces| pieces[0].stretches.push(stretch(Order::Raise(ErrorId(9)), 2, 0)),
    ];
    for (number, change) in changes.iter().enumerate() {
        bench.write("x.tape", altered(&whole, change));
        for command in [&["tape", "x.tape"][..], &["debug", "--tape", "x.tape"]] {
            let ran = bench.run(command);
            let why = format!("change {number}: {}\n{}", ran.code, ran.stderr);
            assert!(ran.code == 0 || ran.code == 2, "{why}");
            assert!(!ran.stderr.contains("panicked"), "{why}");
            assert_eq!(ran.code == 2, ran.stderr.starts_with("error: x.tape: "), "{why}");
        }
    }
}

fn stretch(order: Order, begin: u64, frame: u64) -> Stretch {
    Stretch { order, begin: Moment(begin), frame }
}

/// Cut off behind its head anywhere, as by a run that is killed, a tape is shown up to there.
#[test]
fn a_tape_that_is_cut_off_is_shown_as_far_as_it_goes() {
    let bench = bench("cut");
    let whole = bench.read("t.tape");
    let head = TapeFile::from_bytes(&whole).expect("a tape").head;
    let mut begun = Vec::new();
    drop(Writer::begin(&mut begun, head));
    let rest = whole.len() - begun.len();
    let mut moments = Vec::new();
    for length in [begun.len(), begun.len() + 5, begun.len() + rest / 2, whole.len() - 1] {
        bench.write("c.tape", &whole[..length]);
        let shown = bench.ends(0, &["tape", "c.tape"]).stdout;
        assert!(shown.contains("cut off before its end"), "{length}: {shown}");
        let told = bench.ends(0, &["debug", "--json", "--tape", "c.tape"]);
        let lines = told.json();
        assert_eq!(lines[0]["type"], "tape");
        assert_eq!(lines[0]["ending"], json!(null));
        assert_eq!(lines[0]["torn_bytes"] == 0, length == begun.len(), "{length}");
        moments.push(told.summary()["position"]["moment"].as_u64());
    }
    assert_eq!(moments[..2], [Some(0); 2]);
    assert!(moments[1] < moments[2] && moments[2] < moments[3], "{moments:?}");
    bench.write("g.tape", [&whole[..], &whole[begun.len()..]].concat());
    bench.refuses(&["tape", "g.tape"], &["goes on behind its end"]);
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

/// A tape is written as the run goes: without it, there is none.
#[test]
fn nothing_runs_whose_tape_cannot_be_made() {
    let bench = Bench::new("lost_tape");
    // No folder takes such a name, which is only known when the file is made.
    let name = "t".repeat(300);
    for command in ["run", "back"] {
        let ran = bench.ends(2, &[command, "tower.obv", "--tape", &name]);
        assert!(ran.stderr.contains("cannot be written"), "{}", ran.stderr);
        assert_eq!(ran.stdout, "");
        let summary = bench.ends(2, &[command, "--json", "tower.obv", "--tape", &name]).summary();
        assert_eq!(summary["outcome"], "refused");
        assert_eq!(summary["messages"][0]["file"], json!(name));
    }
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

/// What cannot be built is refused before anything moves, by every command that reads it.
#[test]
fn a_workcell_with_two_things_in_one_place_is_refused_by_check_and_run() {
    let bench = Bench::new("wrong_geometry");
    let cell = String::from_utf8(bench.read("peg_in_hole.toml")).expect("text");
    let wall = |xyz: &str| {
        format!(
            "{cell}\n[[fixture]]\nname = \"wall\"\nplace = {{ xyz_mm = {xyz} }}\n\
             body = [{{ cuboid_mm = [30, 30, 30] }}]\n"
        )
    };
    // In the shoulder of the arm; and where nothing is.
    bench.write("shoulder.toml", wall("[0, 0, 60]"));
    bench.write("aside.toml", wall("[0, 700, 600]"));
    let with = |command, file| [command, "reversal_policy.obv", "--cell", file];
    for command in ["check", "run", "trials"] {
        let words = ["C0108", "shoulder.toml:", "at home the shoulder of the arm", "`wall`"];
        bench.refuses(&with(command, "shoulder.toml"), &words);
        if command != "trials" {
            assert!(bench.run(&with(command, "aside.toml")).code < 2, "{command}");
        }
    }
}
