//! The command line of Obverse: the only crate that prints, exits and reads the environment.
//!
//! Each command stands in a file of its own under `commands`; [`load`] brings programs and
//! workcells from files, [`story`] tells a run to people, [`report`] to machines, [`show`] shows a
//! [`problem`].

mod after;
mod commands;
mod cycle;
mod debug;
mod files;
mod lacking;
mod load;
mod moves;
mod parameters;
mod problem;
mod recovering;
mod report;
mod show;
mod story;
mod taping;
mod write;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Undo for robots: compile, run and take back robot assembly programs.
#[derive(Parser)]
#[command(name = "obverse", version, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  done; for `run`, the program ended with no error pending; for `back`, the run went back
     as far as the program lets it; for `check`, no move is found to fail
  1  the run ended otherwise: an error pending, a fault of the workcell, a trap, the limit, or an
     assembly that is not as the workcell file says;
     for `check`, a move fails, the check of the moves could not be done as a whole, or there is
     a warning that `--deny` names; for `fmt --check`, a file would change; for `invert`, the
     sequence has no inverse; for `debug`, a command from a file or a pipe was not carried out
  2  the input is wrong (command line, source, module, tape, workcell file), and nothing was run;
     or the output cannot be written. With `--json` the last line on standard output is then
     a summary with the outcome `refused`, and the messages";

#[derive(Subcommand)]
enum Command {
    /// Check a program, and every move of it in its workcell, before anything moves.
    Check(commands::check::Arguments),
    /// Show how far back each line of a program can go, and what stops it.
    Reach(commands::reach::Arguments),
    /// Run a program on the simulated workcell and tell what happens.
    Run(commands::run::RunArguments),
    /// Run a program, then take it back as far as it goes.
    Back(commands::back::Arguments),
    /// Walk through a run in both directions, and try what would have been.
    Debug(commands::debug::Arguments),
    /// Show what is on a recorded tape.
    Tape(commands::tape::Arguments),
    /// Try a program over many seeded assemblies, by one strategy or several.
    Trials(commands::trials::Arguments),
    /// Learn the parameters of an action in simulation.
    Learn(commands::learn::Arguments),
    /// Bring source files into their canonical layout.
    Fmt(commands::fmt::Arguments),
    /// Print the inverse of a sequence: a disassembly program from an assembly program.
    Invert(commands::invert::Arguments),
    /// Compile a program to a module.
    Build(commands::build::Arguments),
    /// Show the instructions of a program, with the class of each.
    Dis(commands::dis::Arguments),
    /// Serve an editor: the language server on standard input and output.
    Lsp(commands::lsp::Arguments),
    /// Debug a program from an editor, in both directions, by the Debug Adapter Protocol.
    Dap(commands::dap::Arguments),
    /// Show the instruction set.
    Isa(commands::isa::Arguments),
    /// Explain an opcode, the code of a diagnostic, or that of a check of moves.
    Explain(commands::explain::Arguments),
}

impl Command {
    /// Whether machines are told, who then learn what is wrong with the input, too.
    fn is_json(&self) -> bool {
        match self {
            Self::Fmt(arguments) => arguments.json,
            Self::Invert(arguments) => arguments.json,
            Self::Build(arguments) => arguments.json,
            Self::Run(arguments) => arguments.common.json,
            Self::Back(arguments) => arguments.json,
            Self::Debug(arguments) => arguments.json,
            Self::Dis(arguments) => arguments.json,
            Self::Reach(arguments) => arguments.json,
            Self::Trials(arguments) => arguments.json,
            Self::Learn(arguments) => arguments.json,
            Self::Tape(arguments) => arguments.json,
            Self::Explain(arguments) => arguments.json,
            Self::Check(_) | Self::Dap(_) | Self::Isa(_) | Self::Lsp(_) => false,
        }
    }
}

/// How a command ended, if it could be carried out at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// Exit code 0.
    Done,
    /// Exit code 1.
    EndedOtherwise,
    /// Exit code 2, with everything said already.
    Wrong,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let is_json = arguments.command.is_json();
    let outcome = match arguments.command {
        Command::Check(arguments) => commands::check::run(&arguments),
        Command::Fmt(arguments) => commands::fmt::run(&arguments),
        Command::Invert(arguments) => commands::invert::run(&arguments),
        Command::Build(arguments) => commands::build::run(&arguments),
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Back(arguments) => commands::back::run(&arguments),
        Command::Dap(arguments) => commands::dap::run(&arguments),
        Command::Reach(arguments) => commands::reach::run(&arguments),
        Command::Debug(arguments) => commands::debug::run(&arguments),
        Command::Dis(arguments) => commands::dis::run(&arguments),
        Command::Trials(arguments) => commands::trials::run(&arguments),
        Command::Learn(arguments) => commands::learn::run(&arguments),
        Command::Lsp(arguments) => commands::lsp::run(&arguments),
        Command::Tape(arguments) => commands::tape::run(&arguments),
        Command::Isa(arguments) => commands::isa::run(&arguments),
        Command::Explain(arguments) => commands::explain::run(&arguments),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::EndedOtherwise) => ExitCode::from(1),
        Ok(Outcome::Wrong) => ExitCode::from(2),
        Err(problem) => {
            show::problem(&problem);
            if is_json {
                report::refused(&problem);
            }
            ExitCode::from(2)
        }
    }
}
