//! A connection: from the first request to where a program is loaded, and then the session over it.

use crate::arguments::wanted;
use crate::debuggee::Debuggee;
use crate::frame::Frame;
use crate::inbox::Inbox;
use crate::message::{Client, Request, Wanted, request};
use crate::outbox::Outbox;
use obverse_bytecode::Verified;
use obverse_debugger::{Policy, Recording};
use obverse_recovery::Memory;
use obverse_sim::Sim;
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// Where a session begins.
pub enum Begin {
    /// At the start of a run in this workcell.
    Live(Box<Sim>),
    /// At the end of a recording, with the workcell that it began in, if that is to be had.
    Recorded(Box<Recording>, Option<Box<Sim>>),
}

/// Keeps what was learned of errors, or says why it cannot.
pub type Keep = Box<dyn Fn(&Memory) -> Result<(), String>>;

/// Where a source file of a module is.
pub enum OnDisk {
    /// In no folder: the module alone has its text.
    No,
    /// In this file, which has the text that the module has.
    Same(PathBuf),
    /// In this file, which has another text now.
    Changed(PathBuf),
}

impl OnDisk {
    /// The file, whatever its text is.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::No => None,
            Self::Same(path) | Self::Changed(path) => Some(path),
        }
    }
}

/// A program that may be run, or was.
pub struct Loaded {
    /// What runs.
    pub program: Verified,
    /// Where the session begins.
    pub begin: Begin,
    /// What is done about errors.
    pub policy: Policy,
    /// What was learned of them before.
    pub memory: Memory,
    /// What is done with what is learned, at the end.
    pub keep: Option<Keep>,
    /// Where each source file of the module is.
    pub files: Vec<OnDisk>,
    /// The path that a path leads to when all links are followed; none if nothing is there.
    pub real: fn(&Path) -> Option<PathBuf>,
    /// What the user is to be told about it, warnings for one.
    pub notes: Vec<String>,
}

/// How a connection ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ended {
    /// The client ended it.
    Done,
    /// It went away without a word, or what it sent ended in the middle.
    Gone,
}

/// Serve one client until it is done. `load` loads what it wants to debug, `log` is told what is
/// wrong with what it sends, and nobody else would learn.
pub fn serve(
    input: impl Read + Send + 'static,
    output: &mut dyn Write,
    load: &mut dyn FnMut(&Wanted) -> Result<Loaded, String>,
    log: &mut dyn FnMut(&str),
) -> Ended {
    let inbox = Inbox::of(input);
    let mut server = Server { inbox, out: Outbox::to(output), log, client: Client::default() };
    let (loaded, wanted, request) = match server.until_launch(load) {
        Ok(launched) => launched,
        Err(ended) => return ended,
    };
    match Debuggee::begin(&mut server, &loaded, &wanted) {
        Ok(mut debuggee) => debuggee.serve(&request),
        Err(why) => {
            server.out.refuse(&request, &why);
            server.out.event("terminated", json!({}));
            server.until_gone()
        }
    }
}

/// A connection.
pub(crate) struct Server<'s> {
    pub(crate) inbox: Inbox,
    pub(crate) out: Outbox<'s>,
    pub(crate) log: &'s mut dyn FnMut(&str),
    pub(crate) client: Client,
}

impl Server<'_> {
    /// The request that something that came in is; none if it is none, which is told.
    pub(crate) fn request(&mut self, frame: Frame) -> Result<Option<Request>, Ended> {
        let why = match frame {
            Frame::Message(bytes) => match request(&bytes) {
                Ok(request) => return Ok(Some(request)),
                Err(why) => why,
            },
            Frame::Wrong(why) => why,
            Frame::End(why) => {
                let why = why.unwrap_or_else(|| "the client went away".to_owned());
                (self.log)(&why);
                return Err(Ended::Gone);
            }
        };
        (self.log)(&why);
        self.out.tell("stderr", &why);
        Ok(None)
    }

    /// The next request.
    pub(crate) fn next(&mut self) -> Result<Request, Ended> {
        loop {
            if self.out.is_gone {
                (self.log)("the client reads no more");
                return Err(Ended::Gone);
            }
            let frame = self.inbox.next();
            if let Some(request) = self.request(frame)? {
                return Ok(request);
            }
        }
    }

    fn until_launch(
        &mut self,
        load: &mut dyn FnMut(&Wanted) -> Result<Loaded, String>,
    ) -> Result<(Loaded, Wanted, Request), Ended> {
        let mut is_initialized = false;
        loop {
            let request = self.next()?;
            match request.command.as_str() {
                "initialize" if is_initialized => {
                    self.out.refuse(&request, "it is initialized already");
                }
                "initialize" => match request.given().and_then(Client::check) {
                    Ok(client) => {
                        self.client = client;
                        is_initialized = true;
                        self.out.answer(&request, capabilities());
                    }
                    Err(why) => self.out.refuse(&request, &why),
                },
                "disconnect" | "terminate" => {
                    self.out.answer(&request, Value::Null);
                    return Err(Ended::Done);
                }
                _ if !is_initialized => {
                    self.out.refuse(&request, "the first request must be `initialize`");
                }
                "launch" | "attach" => match wanted(&request).and_then(|(wanted, passed_over)| {
                    passed_over.iter().for_each(|text| self.out.tell("important", text));
                    let loaded = load(&wanted)?;
                    Ok((loaded, wanted))
                }) {
                    Ok((loaded, wanted)) => return Ok((loaded, wanted, request)),
                    Err(why) => {
                        self.out.tell("stderr", &why);
                        self.out.refuse(&request, &why);
                    }
                },
                _ => self.out.refuse(
                    &request,
                    "no program is loaded: `launch` one, or `attach` to a tape, first",
                ),
            }
        }
    }

    /// Nothing can be done but to end.
    fn until_gone(&mut self) -> Ended {
        loop {
            match self.next() {
                Ok(request) if matches!(request.command.as_str(), "disconnect" | "terminate") => {
                    self.out.answer(&request, Value::Null);
                    return Ended::Done;
                }
                Ok(request) => self.out.refuse(&request, "there is no program to debug"),
                Err(ended) => return ended,
            }
        }
    }
}

/// What is there, and nothing else.
fn capabilities() -> Value {
    json!({
        "supportsConfigurationDoneRequest": true,
        "supportsFunctionBreakpoints": true,
        "supportsConditionalBreakpoints": true,
        "supportsHitConditionalBreakpoints": true,
        "supportsEvaluateForHovers": true,
        "supportsStepBack": true,
        "supportsSetVariable": true,
        "supportsRestartFrame": true,
        "supportsGotoTargetsRequest": true,
        "supportsExceptionInfoRequest": true,
        "supportsExceptionFilterOptions": true,
        "supportsDelayedStackTraceLoading": true,
        "supportsCompletionsRequest": true,
        "supportsLoadedSourcesRequest": true,
        "supportsLogPoints": true,
        "supportsTerminateRequest": true,
        "supportsDataBreakpoints": true,
        "supportsDisassembleRequest": true,
        "supportsSteppingGranularity": true,
        "supportsInstructionBreakpoints": true,
        "exceptionBreakpointFilters": crate::filters::offered(None),
    })
}
