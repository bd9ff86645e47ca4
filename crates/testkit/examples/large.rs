//! Writes a program of so many lines to a file, to measure the front end on:
//! `cargo run -p obverse-testkit --example large -- 1000000 line.obv`.

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [lines, file] = arguments.as_slice() else { return ExitCode::from(2) };
    let Ok(lines) = lines.parse() else { return ExitCode::from(2) };
    let written = std::fs::write(file, obverse_testkit::large::program(lines));
    if written.is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
