//! `obverse dap`: debug a program from an editor, by the Debug Adapter Protocol.
//!
//! Serves one client on standard input and output, or one after the other on a loopback port. What
//! goes wrong beside the protocol is told on standard error.

use super::Result;
use crate::load::Program;
use crate::problem::{Problem, plain};
use crate::recovering::{self, Kept};
use crate::{Outcome, after, files, load, show, taping, write};
use obverse_bytecode::SourceFile;
use obverse_dap::arguments::{self, Argument};
use obverse_dap::{Attach, Begin, Ended, Launch, Loaded, OnDisk, Wanted, serve};
use obverse_debugger::Policy;
use obverse_recovery::Memory;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf, absolute};

/// Why standard output is left alone, and what a client can ask for.
fn after_help() -> String {
    let lines = |known: &[Argument]| -> String {
        let line = |one: &Argument| format!("\n  {:<12} {}", one.name, one.about);
        known.iter().map(line).collect()
    };
    format!(
        "Standard output carries the protocol and nothing else; what goes wrong beside it is told \
         on\nstandard error. `launch` understands:{}\n`attach` opens the tape of a run at its end; \
         it understands:{}",
        lines(arguments::LAUNCH),
        lines(arguments::ATTACH)
    )
}

#[derive(clap::Args)]
#[command(after_help = after_help())]
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
    let files = match &attach.program {
        Some(program) => {
            let program = load::quietly_with(program, &attach.parameters)?;
            opened.check_is_of(&program)?;
            on_disk(&program)
        }
        None => on_disk(&opened.program),
    };
    let named = attach.cell.as_deref();
    let start = opened.start(named);
    let mut notes = vec![opened.title(), opened.ending()];
    notes.extend(opened.lacks(start.as_ref().err()));
    let start = match start {
        Err(problem) if named.is_some() => return Err(problem),
        start => start.ok().map(Box::new),
    };
    let policy = policy(attach.strategy.as_deref(), opened.file.head.seed)?;
    let begin = Begin::Recorded(Box::new(opened.file.recording), start);
    let (program, memory) = (opened.program.verified, Memory::default());
    Ok(Loaded { program, begin, policy, memory, keep: None, files, real, notes })
}

/// What is done about errors.
fn policy(strategy: Option<&str>, seed: u64) -> std::result::Result<Policy, Problem> {
    let named = strategy.map(|name| {
        let wrong = |why| Problem::new(format!("`strategy` is `{name}`: {why}"));
        recovering::strategy(name).map_err(wrong)
    });
    let declared = Policy::declared(seed);
    Ok(Policy { strategy: named.transpose()?.unwrap_or(declared.strategy), ..declared })
}

/// Where the source files of a program are: beside it, wherever this process was started.
fn on_disk(program: &Program) -> Vec<OnDisk> {
    let folder = program.path.with_file_name("");
    let found = |source: &SourceFile| {
        let path = folder.join(&source.name);
        let Ok(bytes) = files::read(&path) else { return OnDisk::No };
        let path = absolute(&path).unwrap_or(path);
        // Assembly text may name its source without having it.
        let is_same = source.text.is_empty() || bytes == source.text.as_bytes();
        if is_same { OnDisk::Same(path) } else { OnDisk::Changed(path) }
    };
    program.verified.module().sources.iter().map(found).collect()
}

fn real(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}

/// The program and the workcell of a launch.
fn launched(launch: &Launch) -> std::result::Result<Loaded, Problem> {
    let program = load::quietly_with(&launch.program, &launch.parameters)?;
    let named = launch.cell.as_deref();
    if let Some(memory) = &launch.memory {
        let cell = load::workcell_path(&program, named);
        let inputs: Vec<PathBuf> = program.files().into_iter().chain(cell).collect();
        write::check_text(memory, "memory", &inputs)?;
    }
    let (mut cell, file) = load::workcell(&program, named, launch.seed)?;
    after::lead(launch.after.as_deref(), &mut cell, &file)?;
    load::machine(&program, &cell, &file)?;
    let policy = policy(launch.strategy.as_deref(), launch.seed)?;
    let kept = Kept::read(launch.memory.as_deref(), &program, &file.name)?;
    let files = on_disk(&program);
    let mut notes: Vec<String> = program.source.iter().flat_map(show::diagnostic_lines).collect();
    let after = after::words(launch.after.as_deref());
    let (shown, place) = (launch.program.display(), file.name);
    notes.push(format!("{shown} in {place}, seed {}{after}", launch.seed));
    Ok(Loaded {
        program: program.verified,
        begin: Begin::Live(Box::new(cell)),
        policy,
        memory: kept.memory(),
        keep: Some(Box::new(move |memory| kept.keep(memory).map_err(|why| words(&why)))),
        files,
        real,
        notes,
    })
}

fn words(problem: &Problem) -> String {
    let of_source = problem.source.iter().flat_map(show::diagnostic_lines);
    let messages = problem.messages.iter().map(ToString::to_string);
    of_source.chain(messages).collect::<Vec<_>>().join("\n")
}
