//! `obverse dap`: debug a program from an editor, by the Debug Adapter Protocol.
//!
//! Serves one client on standard input and output, or one after the other on a loopback port. What
//! goes wrong beside the protocol is told on standard error.

use super::Result;
use crate::load::Program;
use crate::problem::{Problem, plain};
use crate::{Outcome, after, load, show, taping};
use obverse_dap::{Attach, Begin, Ended, Launch, Loaded, Wanted, serve};
use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{PathBuf, absolute};

/// Why standard output is left alone.
const AFTER_HELP: &str = "\
Standard output carries the protocol and nothing else; what goes wrong beside it is told on
standard error. `launch` understands:
  program      the program: source, assembly text or module
  cell         the workcell file, in place of the one that the program names
  seed         what all chance in the workcell follows from (0)
  after        the program after which it begins, run in the same workcell first
  stopOnEntry  stop before the first action (false)
  stopAtEnd    stay at the end of the program, from where one can go back (true)
`attach` opens the tape of a run at its end; it understands:
  tape         the tape file
  program      the program that it must be of; a tape has its own
  cell         the workcell file to try otherwise in, in place of the tape's
  after        the program that the run began after, in place of where the tape says it is";

#[derive(clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Arguments {
    /// Listen on this port of the loopback address, in place of standard input; 0 is any that is
    /// free, which is told.
    #[arg(long, value_name = "N")]
    port: Option<u16>,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    match arguments.port {
        None => Ok(outcome(&one(std::io::stdin(), &mut std::io::stdout()))),
        Some(port) => listen(port),
    }
}

fn outcome(ended: &Ended) -> Outcome {
    match ended {
        Ended::Done => Outcome::Done,
        Ended::Gone => Outcome::EndedOtherwise,
    }
}

/// Serve clients, one after the other, for ever.
fn listen(port: u16) -> Result {
    let cannot = |error: std::io::Error| {
        Problem::new(format!("cannot listen on port {port}: {}", plain(&error)))
    };
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(cannot)?;
    let port = listener.local_addr().map_err(cannot)?.port();
    show::note(&format!("listening on port {port}"));
    loop {
        let served = listener.accept().and_then(|(stream, _)| connected(stream));
        if let Err(error) = served {
            show::note(&format!("a client could not be served: {}", plain(&error)));
        }
    }
}

fn connected(stream: TcpStream) -> std::io::Result<()> {
    stream.set_nodelay(true)?;
    let mut output = stream.try_clone()?;
    one(stream, &mut output);
    // Who reads of it is woken so.
    match output.shutdown(std::net::Shutdown::Both) {
        Err(error) if error.kind() != std::io::ErrorKind::NotConnected => Err(error),
        _ => Ok(()),
    }
}

fn one(input: impl Read + Send + 'static, output: &mut dyn Write) -> Ended {
    serve(input, output, &mut |launch| loaded(launch), &mut |text| show::note(text))
}

/// What a client wants to debug.
fn loaded(wanted: &Wanted) -> std::result::Result<Loaded, String> {
    let loaded = match wanted {
        Wanted::Launch(launch) => launched(launch),
        Wanted::Attach(attach) => attached(attach),
    };
    loaded.map_err(|problem| words(&problem))
}

/// A tape at its end, with the sources of the program that it is said to be of, if it is.
fn attached(attach: &Attach) -> std::result::Result<Loaded, Problem> {
    let opened = taping::open(&attach.tape)?;
    let paths = match &attach.program {
        Some(program) => {
            let program = load::quietly(program)?;
            opened.check_is_of(&program)?;
            paths(&program)
        }
        None => opened.paths(),
    };
    let named = attach.cell.as_deref();
    let start = opened.start(named);
    let mut notes = vec![opened.title(), opened.ending()];
    notes.extend(opened.lacks(start.as_ref().err()));
    let start = match start {
        Err(problem) if named.is_some() => return Err(problem),
        start => start.ok().map(Box::new),
    };
    let seed = opened.file.head.seed;
    let begin = Begin::Recorded(Box::new(opened.file.recording), start);
    Ok(Loaded { program: opened.program.verified, begin, seed, paths, notes })
}

/// The source files of a program that are on disk.
fn paths(program: &Program) -> Vec<Option<PathBuf>> {
    let path = |name: &str| {
        let path = program.path_of(name);
        path.is_file().then(|| absolute(&path).unwrap_or(path))
    };
    program.verified.module().sources.iter().map(|file| path(&file.name)).collect()
}

/// The program and the workcell of a launch.
fn launched(launch: &Launch) -> std::result::Result<Loaded, Problem> {
    let program = load::quietly(&launch.program)?;
    let named = launch.cell.as_deref();
    let (mut cell, file) = load::workcell(&program, named, launch.seed)?;
    after::lead(launch.after.as_deref(), &mut cell, &file)?;
    load::machine(&program, &cell, &file)?;
    let paths = paths(&program);
    let notes = program.source.iter().flat_map(show::diagnostic_lines).collect();
    let place = file.name;
    let mut notes: Vec<String> = notes;
    let after = after::words(launch.after.as_deref());
    notes.push(format!("{} in {place}, seed {}{after}", launch.program.display(), launch.seed));
    let begin = Begin::Live(Box::new(cell));
    Ok(Loaded { program: program.verified, begin, seed: launch.seed, paths, notes })
}

fn words(problem: &Problem) -> String {
    let of_source = problem.source.iter().flat_map(show::diagnostic_lines);
    let messages = problem.messages.iter().map(ToString::to_string);
    of_source.chain(messages).collect::<Vec<_>>().join("\n")
}
