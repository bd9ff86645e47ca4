//! How many machine instructions a run takes without a tape, with one, and in reverse: counted by
//! callgrind, so that the figures are the same on a busy machine as on a calm one. Fails if one of
//! the ratios is above its bound; without valgrind it counts nothing, and says so.
//!
//! `cargo bench -p obverse-benches --bench counts` prints them. It runs itself under callgrind,
//! once for each program and way of running it, which it is told as its arguments.

use obverse_benches::{SOURCES, machine, program, timed};
use obverse_testkit::Ledger;
use obverse_vm::{Direction, Machine};
use std::process::{Command, ExitCode};

/// The most that a run with a tape takes, as a part of the run without.
const MOST_TAPED: f64 = 1.12;
/// The most that a run in reverse takes, as a part of the run forward with a tape.
const MOST_REVERSE: f64 = 0.70;

/// Without a tape, with one, and in reverse.
const WAYS: [&str; 3] = ["plain", "taped", "reverse"];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    match arguments.get(1..) {
        Some([name, way]) if WAYS.contains(&way.as_str()) => {
            run(name, way);
            ExitCode::SUCCESS
        }
        // As cargo starts it.
        _ => report(),
    }
}

/// One run, of which the part in question is counted.
fn run(name: &str, way: &str) {
    let Some((_, source)) = SOURCES.iter().find(|(known, _)| *known == name) else {
        panic!("no program is named {name}")
    };
    let program = program(name, source);
    let mut cell = Ledger::new(1);
    let machine = machine(&program, &cell);
    let mut machine = if way == "plain" { machine.without_tape() } else { machine };
    match way {
        "plain" | "taped" => counted(&mut machine, Direction::Forward, &mut cell),
        _ => {
            timed(&mut machine, Direction::Forward, &mut cell);
            counted(&mut machine, Direction::Reverse, &mut cell);
        }
    }
}

/// What is counted: callgrind knows it by its name.
#[inline(never)]
fn counted(machine: &mut Machine<'_>, direction: Direction, cell: &mut Ledger) {
    timed(machine, direction, cell);
}

/// What callgrind counts of a run, in machine instructions.
fn count(name: &str, way: &str) -> Result<u64, String> {
    let own = std::env::current_exe().map_err(|error| format!("no path to run again: {error}"))?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg("--toggle-collect=*counts::counted*")
        .args([own.as_os_str(), name.as_ref(), way.as_ref()])
        .output()
        .map_err(|error| format!("valgrind cannot be run: {error}"))?;
    let said = String::from_utf8_lossy(&output.stderr);
    let collected = said.lines().find_map(|line| line.split_once("Collected : "));
    match collected.map(|(_, number)| number.trim().parse()) {
        Some(Ok(number)) if output.status.success() && number > 0 => Ok(number),
        _ => Err(format!("{name}, {way}: callgrind counted nothing:\n{said}")),
    }
}

fn counts(name: &str) -> Result<[u64; 3], String> {
    let [plain, taped, reverse] = WAYS.map(|way| count(name, way));
    Ok([plain?, taped?, reverse?])
}

fn is_valgrind_there() -> bool {
    Command::new("valgrind").arg("--version").output().is_ok_and(|output| output.status.success())
}

/// Count everything, print a table, and say whether all ratios are within their bounds.
#[expect(clippy::print_stdout, clippy::print_stderr, reason = "a benchmark reports")]
fn report() -> ExitCode {
    if !is_valgrind_there() {
        println!("valgrind is not installed: nothing is counted");
        return ExitCode::SUCCESS;
    }
    println!("program        plain      taped    reverse   taped/plain   reverse/taped");
    let mut is_within = true;
    for (name, _) in SOURCES {
        let [plain, taped, reverse] = match counts(name) {
            Ok(counts) => counts,
            Err(message) => {
                eprintln!("{message}");
                return ExitCode::FAILURE;
            }
        };
        let (recording, reversing) = (taped as f64 / plain as f64, reverse as f64 / taped as f64);
        println!("{name:8} {plain:11} {taped:10} {reverse:10} {recording:13.3} {reversing:15.3}");
        is_within &= recording <= MOST_TAPED && reversing <= MOST_REVERSE;
    }
    println!("at most {MOST_TAPED:49.3} {MOST_REVERSE:15.3}");
    if is_within { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
