//! The programs for people: each is checked, run and taken back, and ends as its head says.
//!
//! Runs go through the binary; what became of the items in the workcell, which no program can
//! observe, is asked of the libraries.

use obverse_bytecode::verify;
use obverse_geometry::Pose;
use obverse_recovery::{Ending, drive};
use obverse_sim::{Cell, Sim};
use obverse_testkit::files::Folder;
use obverse_vm::{Direction, Limits, Machine};
use obverse_workcell::{Clock, DigitalIo, ItemId, Items};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The seeds that each program is run with.
const SEEDS: std::ops::Range<u64> = 0..5;

/// What is expected of a program.
struct Expected {
    file: &'static str,
    /// With these seeds it ends with an error pending; else it finishes.
    ends_with_error: &'static [u64],
    back: Back,
}

/// How far back a program goes.
enum Back {
    /// To the start, bit for bit.
    Identical,
    /// To this line, which cannot be taken back.
    StopsAt(u64),
}

const fn identical(file: &'static str) -> Expected {
    Expected { file, ends_with_error: &[], back: Back::Identical }
}

const PROGRAMS: &[Expected] = &[
    identical("bad_pin.obv"),
    identical("feeder.obv"),
    identical("find_edge.obv"),
    Expected { file: "glue.obv", ends_with_error: &[], back: Back::StopsAt(21) },
    identical("handover.obv"),
    identical("leak_test.obv"),
    Expected { file: "marking.obv", ends_with_error: &[], back: Back::StopsAt(46) },
    identical("peg_in_hole.obv"),
    Expected { file: "peg_search.obv", ends_with_error: &[0, 3], back: Back::Identical },
    identical("reversal_policy.obv"),
    Expected { file: "press_fit.obv", ends_with_error: &[], back: Back::StopsAt(76) },
    identical("screws.obv"),
    identical("sheets.obv"),
    identical("sorting.obv"),
    identical("tidy.obv"),
    identical("tower.obv"),
    identical("warm_up.obv"),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("programs")
}

fn source(file: &str) -> String {
    fs::read_to_string(folder().join(file)).expect("a program")
}

fn files(extension: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(folder()).expect("the folder of programs");
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    let names = names.map(|name| name.into_string().expect("a plain name"));
    names.filter(|name| name.ends_with(extension)).collect()
}

/// The last line that a command prints, as JSON.
fn summary(command: &str, file: &str, more: &[&str]) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_obverse"))
        .args([command, "--json"])
        .args(more)
        .arg(folder().join(file))
        .output()
        .expect("the binary");
    let text = String::from_utf8(output.stdout).expect("text");
    let last = text.lines().last().unwrap_or_else(|| panic!("{command} {file} prints nothing"));
    let value: Value = serde_json::from_str(last).expect("JSON");
    assert_eq!(value["type"], "summary", "{command} {file}");
    value
}

#[test]
fn every_program_is_in_the_table_and_every_cell_in_a_program() {
    let listed: BTreeSet<String> = PROGRAMS.iter().map(|row| row.file.to_owned()).collect();
    assert_eq!(files(".obv"), listed);
    let cells: BTreeSet<String> = PROGRAMS.iter().filter_map(|row| cell_of(row.file)).collect();
    assert_eq!(files(".toml"), cells);
}

/// The workcell that a program names.
fn cell_of(file: &str) -> Option<String> {
    let text = source(file);
    let named = text.lines().find_map(|line| line.strip_prefix("cell \""))?;
    Some(named.trim_end_matches('"').to_owned())
}

#[test]
fn every_program_begins_with_what_it_shows() {
    for row in PROGRAMS {
        let text = source(row.file);
        let head: Vec<&str> = text.lines().take_while(|line| line.starts_with("//")).collect();
        assert!(head.len() >= 2, "{} has no head", row.file);
        let says_start = head.join(" ").contains("Goes back to the start");
        let is_identical = matches!(row.back, Back::Identical);
        // The paper's example is told in the paper's own words.
        assert!(says_start == is_identical || row.file == "peg_in_hole.obv", "{}", row.file);
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{}", row.file);
    }
}

#[test]
fn every_program_is_correct_and_warned_about_in_nothing() {
    for row in PROGRAMS {
        let summary = summary("check", row.file, &[]);
        assert_eq!((&summary["outcome"], &summary["warnings"]), (&"correct".into(), &0.into()));
    }
}

#[test]
fn every_program_goes_there_and_back() {
    for row in PROGRAMS {
        for seed in SEEDS {
            let context = format!("{} with seed {seed}", row.file);
            let summary = summary("back", row.file, &["--seed", &seed.to_string()]);
            let fails = row.ends_with_error.contains(&seed);
            let there = if fails { "unhandled_error" } else { "finished" };
            assert_eq!(summary["there"], there, "{context}: {summary}");
            match row.back {
                Back::Identical => {
                    assert_eq!(summary["outcome"], "at_start", "{context}: {summary}");
                    assert_eq!(summary["identical"], true, "{context}: {summary}");
                    assert_eq!(summary["stopped_at"], Value::Null, "{context}: {summary}");
                }
                Back::StopsAt(line) => {
                    assert_eq!(summary["outcome"], "refused", "{context}: {summary}");
                    assert_eq!(summary["identical"], false, "{context}: {summary}");
                    assert_eq!(summary["stopped_at"]["line"], line, "{context}: {summary}");
                }
            }
            assert!(summary["commands"].as_u64() > Some(0), "{context} commands something");
        }
    }
}

/// The programs for trials, each in a folder of its own with its workcell: written as they should
/// be, and, where nothing goes wrong, through without an error.
#[test]
fn every_case_is_correct_and_goes_through() {
    let cases = fs::read_dir(folder().join("cases")).expect("the folder of cases");
    let mut names: Vec<String> = cases
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("a plain name"))
        .collect();
    names.sort();
    assert!(names.contains(&"cover".to_owned()), "{names:?}");
    for name in names {
        let file = format!("cases/{name}/{name}.obv");
        let checked = summary("check", &file, &[]);
        assert_eq!((&checked["outcome"], &checked["warnings"]), (&"correct".into(), &0.into()));
        let path = folder().join(&file);
        let formatted = Command::new(env!("CARGO_BIN_EXE_obverse"))
            .args(["fmt", "--check"])
            .arg(path)
            .output()
            .expect("the binary");
        assert!(formatted.status.success(), "{file} is laid out otherwise");
        let run = summary("run", &file, &["--seed", "0"]);
        assert_eq!(run["outcome"], "finished", "{file}: {run}");
    }
}

/// What of the language each program is there for.
#[test]
fn the_language_is_shown() {
    let shown = [
        ("sorting.obv", "ending when"),
        ("feeder.obv", "entered when"),
        ("feeder.obv", "while not"),
        ("feeder.obv", "for up to"),
        ("feeder.obv", "toggle"),
        ("screws.obv", "for row from"),
        ("screws.obv", "skip in reverse"),
        ("screws.obv", "} in reverse {"),
        ("sheets.obv", "reverse suck"),
        ("leak_test.obv", "fork {"),
        ("leak_test.obv", "} and {"),
        ("find_edge.obv", "call refine("),
        ("find_edge.obv", "tool probe {"),
        ("find_edge.obv", "speed very slow {"),
        ("glue.obv", "irreversible \""),
        ("marking.obv", "barrier \""),
        ("marking.obv", "loop {"),
        ("marking.obv", "requires"),
        ("bad_pin.obv", "then return to action"),
        ("peg_in_hole.obv", "then return to sequence"),
        ("peg_in_hole.obv", "repeat with perturbation"),
        ("reversal_policy.obv", "recover by reversing"),
        ("reversal_policy.obv", "checkpoint"),
        ("press_fit.obv", "irreversible \""),
        ("press_fit.obv", "reversing up to checkpoint"),
        ("tidy.obv", "on protective stop"),
        ("tidy.obv", "else throw feeder_is_empty"),
        ("tidy.obv", "give up after"),
        ("tidy.obv", "cleanup {"),
        ("tower.obv", "keyframe"),
        ("handover.obv", "import \"handover/"),
        ("handover.obv", "set lamp high"),
        ("handover.obv", "until input button"),
        ("warm_up.obv", "reversible always"),
        ("warm_up.obv", "position centre"),
        ("warm_up.obv", "random("),
        ("cases/cover/cover.obv", "turn 550 deg"),
    ];
    for (file, words) in shown {
        let text = source(file);
        let code: Vec<&str> = text.lines().map(without_comment).collect();
        assert!(code.join("\n").contains(words), "{file} shows `{words}`");
    }
}

/// A line of a program without its comment; no text in quotes there has two strokes.
fn without_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

/// A run of a program by the libraries: where each item was, where it was after the run, and where
/// it is when the run has been taken back.
struct Trip {
    cell: Cell,
    before: Vec<Pose>,
    after: Vec<Pose>,
    back: Ending,
    again: Vec<Pose>,
}

impl Trip {
    fn of(file: &str, seed: u64) -> Self {
        let program = verify(compiled(file)).expect("a program that verifies");
        let name = program.module().cell.as_ref().expect("a workcell");
        let text = fs::read_to_string(folder().join(name)).expect("a workcell file");
        let cell = Cell::parse(&text).expect("a workcell");
        let mut sim = Sim::new(&cell, seed);
        let mut machine = Machine::new(&program, &sim).expect("a machine");
        let before = poses(&cell, &sim);
        let there = drive(&mut machine, Direction::Forward, Limits::NONE, &mut sim, &mut ());
        assert_eq!(there, Ending::Finished, "{file}");
        let after = poses(&cell, &sim);
        let back = drive(&mut machine, Direction::Reverse, Limits::NONE, &mut sim, &mut ());
        let again = poses(&cell, &sim);
        Self { cell, before, after, back, again }
    }

    /// Where an item is after the run forward, in whole millimetres.
    fn ends_up_at(&self, item: &str) -> [i64; 3] {
        let index = self.cell.items.iter().position(|known| known.name == item);
        let place_m = self.after[index.expect("an item")].translation_m;
        [0, 1, 2].map(|axis| (place_m[axis] * 1e3).round() as i64)
    }
}

fn compiled(file: &str) -> obverse_bytecode::Module {
    let compiled = Folder::read(&folder()).compile(file);
    compiled.module.unwrap_or_else(|| panic!("{file}: {:?}", compiled.diagnostics))
}

fn poses(cell: &Cell, sim: &Sim) -> Vec<Pose> {
    let items = cell.items.iter().map(|item| sim.item(&item.name).expect("an item"));
    items.map(|item: ItemId| sim.true_pose(item).expect("an item has a pose")).collect()
}

/// What is done to the items is undone: a law of the robot, beyond that of the machine's state.
#[test]
fn items_are_put_back_to_where_they_were() {
    for row in PROGRAMS.iter().filter(|row| matches!(row.back, Back::Identical)) {
        let trip = Trip::of(row.file, 1);
        assert_eq!(trip.back, Ending::AtStart, "{}", row.file);
        assert_eq!(trip.before, trip.again, "{}", row.file);
    }
}

#[test]
fn the_tower_stands_on_its_first_block() {
    let trip = Trip::of("tower.obv", 1);
    assert_eq!(trip.ends_up_at("block_c"), [450, 150, 80]);
    assert_eq!(trip.ends_up_at("block_b"), [450, 150, 120]);
}

#[test]
fn the_sheets_lie_in_the_press_upside_down_in_order() {
    let trip = Trip::of("sheets.obv", 1);
    let places = ["sheet_1", "sheet_2", "sheet_3"].map(|sheet| trip.ends_up_at(sheet));
    assert_eq!(places, [[450, -150, 44], [450, -150, 47], [450, -150, 50]]);
}

#[test]
fn the_blocks_are_sorted_by_height() {
    let trip = Trip::of("sorting.obv", 1);
    let rows = ["first", "second", "third"].map(|block| trip.ends_up_at(block)[1]);
    assert_eq!(rows, [-120, -240, -120]);
}

#[test]
fn the_thick_pin_is_in_the_box_and_the_next_one_in_the_socket() {
    let trip = Trip::of("bad_pin.obv", 1);
    let thick = trip.ends_up_at("pin_1");
    assert_eq!((thick[0], thick[1]), (600, -150));
    // 40 mm deep in a hole whose mouth is at 60 mm: the middle of 80 mm is 20 mm above it.
    let [x, y, z] = trip.ends_up_at("pin_2");
    assert_eq!((x, y), (450, -150));
    assert!((58..=62).contains(&z), "{z}");
    assert_eq!(trip.before[2], trip.after[2], "the third pin stays in the rack");
}

/// Where a run stops going back is where its reach says that it does, and on the way there the pin
/// is back in the rack, and the bushing is not.
#[test]
fn the_pin_comes_out_again_and_the_bushing_does_not() {
    let trip = Trip::of("press_fit.obv", 1);
    assert!(matches!(trip.back, Ending::Refused(_)), "{:?}", trip.back);
    assert_eq!(trip.before[1], trip.again[1], "the pin");
    assert_ne!(trip.before[1], trip.after[1]);
    assert_eq!(trip.after[0], trip.again[0], "the bushing");
    assert_ne!(trip.before[0], trip.again[0]);
    let summary = summary("reach", "press_fit.obv", &[]);
    let [.., last] = &summary["stretches"].as_array().expect("stretches")[..] else {
        panic!("{summary}")
    };
    assert_eq!(last["stops"][0]["line"], 76, "{summary}");
}

/// The jaws close and the pressure builds up while the arm is under way.
#[test]
fn the_station_tests_while_the_arm_moves() {
    let duration_s = |text: &str| {
        let compiled = obverse_compiler::compile("leak_test.obv", text);
        let program = verify(compiled.module.expect("it compiles")).expect("a program");
        let cell = fs::read_to_string(folder().join("leak_cell.toml")).expect("a workcell");
        let mut sim = Sim::new(&Cell::parse(&cell).expect("a workcell"), 1);
        let mut machine = Machine::new(&program, &sim).expect("a machine");
        let end = drive(&mut machine, Direction::Forward, Limits::NONE, &mut sim, &mut ());
        assert_eq!(end, Ending::Finished);
        assert!(sim.output(4), "both are tested");
        sim.now_s()
    };
    let text = source("leak_test.obv");
    let one_after_another =
        text.replace("  fork {", "  if true {").replace("  } and {", "  }\n  if true {");
    let (in_turns_s, in_a_row_s) = (duration_s(&text), duration_s(&one_after_another));
    assert!(in_turns_s + 1.5 < in_a_row_s, "{in_turns_s} s in turns, {in_a_row_s} s in a row");
}

#[test]
fn the_tested_blocks_are_back_in_their_places() {
    let trip = Trip::of("leak_test.obv", 1);
    let places = ["block_a", "block_b"].map(|block| trip.ends_up_at(block));
    assert_eq!(places, [[420, 150, 30], [540, 150, 30]]);
}

/// A production loop with a barrier in it: a hundred times the rounds, the same tape.
#[test]
fn a_barrier_keeps_the_tape_of_a_production_loop_from_growing() {
    let text = source("marking.obv");
    assert!(text.contains("rounds = 10"));
    let tape_bytes = |rounds: u32| {
        let text = text.replace("rounds = 10", &format!("rounds = {rounds}"));
        let program = obverse_compiler::compile("marking.obv", &text).module;
        let program = verify(program.expect("a module")).expect("a program");
        let cell = fs::read_to_string(folder().join("bench_cell.toml")).expect("a workcell");
        let mut sim = Sim::new(&Cell::parse(&cell).expect("a workcell"), 1);
        let mut machine = Machine::new(&program, &sim).expect("a machine");
        let end = drive(&mut machine, Direction::Forward, Limits::NONE, &mut sim, &mut ());
        assert_eq!(end, Ending::Finished);
        let tape = machine.tape().expect("a tape");
        (tape.held_bytes(), tape.recorded_bits())
    };
    let (few_bytes, few_bits) = tape_bytes(2);
    let (many_bytes, many_bits) = tape_bytes(200);
    assert!(many_bits > 50 * few_bits, "more is recorded");
    assert!(many_bytes <= few_bytes, "{few_bytes} bytes are held, and then {many_bytes}");
}

/// A pose is taught anew in the file of poses, and a lamp is wired elsewhere in the I/O map: the
/// logic is not touched, and what it does follows.
#[test]
fn poses_and_the_io_map_are_edited_apart_from_the_logic() {
    let mut files = Folder::read(&folder());
    let before = files.compile("handover.obv").module.expect("a module");
    let mut edit = |file: &str, from: &str, to: &str| {
        let text = files.0.get_mut(file).expect("a file");
        assert!(text.contains(from), "{file}");
        *text = text.replace(from, to);
    };
    edit("handover/poses.obv", "waving  = [180,", "waving  = [170,");
    edit("handover/io.obv", "lamp    = 2", "lamp    = 3");
    let after = files.compile("handover.obv").module.expect("a module");
    assert_eq!(before.code.len(), after.code.len());
    assert_eq!(before.sources[0], after.sources[0]);
    let changed = before.code.iter().zip(&after.code).filter(|(a, b)| a != b).count();
    assert_eq!(changed, 2, "the lamp is set twice");
    let angles = |module: &obverse_bytecode::Module| module.joints[1].1[0].to_degrees().round();
    assert_eq!((angles(&before), angles(&after)), (180.0, 170.0));
}
