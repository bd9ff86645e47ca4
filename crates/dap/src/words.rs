//! What stops are called, to clients and to people.

use obverse_bytecode::Module;
pub(crate) use obverse_bytecode::text::line_of as line;
use obverse_debugger::{Halt, Mode, Session};
use obverse_recovery::Ending;
use obverse_sim::Sim;
use obverse_vm::{Direction, Refusal, Stop, Trap, TrapKind};

/// Why a session stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Words {
    /// The protocol's word, or one of ours.
    pub(crate) reason: &'static str,
    /// The same in few words.
    pub(crate) description: String,
    /// What else there is to say about it.
    pub(crate) text: Option<String>,
    /// What went wrong, if something did, by which a client may ask about it.
    pub(crate) exception: Option<String>,
}

impl Words {
    pub(crate) fn new(reason: &'static str, description: impl Into<String>) -> Self {
        Self { reason, description: description.into(), text: None, exception: None }
    }

    fn wrong(id: &str, description: &str, text: String) -> Self {
        let (description, exception) = (description.to_owned(), Some(id.to_owned()));
        Self { reason: "exception", description, text: Some(text), exception }
    }

    /// With what will be done about the error, if that is what it stopped for.
    pub(crate) fn add_intent(&mut self, session: &mut Session<'_, Sim>, halt: &Halt) {
        if !matches!(halt, Halt::Stopped(Stop::Due { .. })) {
            return;
        }
        if let (Some(intent), Some(text)) = (session.intent(), &mut self.text) {
            text.push_str("; next: ");
            text.push_str(&intent.words(session.module()));
        }
    }
}

/// Of a halt.
pub(crate) fn halt(session: &Session<'_, Sim>, halt: &Halt) -> Words {
    match halt {
        Halt::Done => Words::new("step", "stepped"),
        Halt::Hits(_) => Words::new("breakpoint", "at a breakpoint"),
        Halt::Stopped(Stop::Refused(refusal)) => refused(session, refusal),
        Halt::Stopped(stop) => stopped(session.module(), stop),
        Halt::Ended(ending) => ended(session.module(), ending),
        Halt::Held => Words::wrong("fault", "the arm is held", HELD.to_owned()),
        Halt::Changed => Words::new("step", CHANGED),
        Halt::EndOfRecording if session.run().cell().is_none() => {
            Words::new("step", "at the end of the recording")
        }
        Halt::EndOfRecording => Words::new("step", END_OF_RECORDING),
        Halt::StartOfRecording => Words::new("entry", "at the start of what is recorded"),
        Halt::Interrupted => Words::new("pause", "paused"),
        Halt::Limit => Words::new("pause", "paused at the limit that it was launched with"),
        Halt::Lost => {
            let text = "the run cannot be shown again: this is a mistake of the debugger";
            Words::wrong("lost", "lost", text.to_owned())
        }
    }
}

pub(crate) const HELD: &str =
    "nothing moves before a person's command: `release` in the debug console gives it";
const CHANGED: &str =
    "a variable was changed by hand here, and nothing recorded what was before: going back ends";
const END_OF_RECORDING: &str = "at the end of what is recorded: `goto end` in the debug console \
                                goes on from here, and commands the workcell";

fn stopped(module: &Module, stop: &Stop) -> Words {
    let error = |index: usize| module.errors.get(index).map_or("", |error| error.name.as_str());
    match stop {
        Stop::Finished => Words::new("end", "the program has ended"),
        Stop::AtStart => Words::new("entry", "back at the start of the program"),
        Stop::AtMark | Stop::OffMark | Stop::Budget => Words::new("step", "stepped"),
        Stop::Raised { error: raised, .. } => {
            let name = error(raised.index());
            Words::wrong(name, "error raised", format!("error {name} is raised"))
        }
        Stop::Due { error: due, pc } => {
            let name = error(due.index());
            let text = format!("error {name} is due at {}", line(module, *pc));
            Words::wrong(name, "error due", text)
        }
        Stop::Fault { fault, pc, direction } => {
            let back = if *direction == Direction::Reverse { "going back over " } else { "" };
            Words::wrong("fault", "fault", format!("{back}{}: {fault}", line(module, *pc)))
        }
        Stop::Refused(refusal) => Words::new("never", why_not(module, refusal)),
        Stop::Trap(trap) => Words::wrong("trap", "trap", trapped(module, trap)),
    }
}

/// Of a run that has ended in an error that was given up.
fn ended(module: &Module, ending: &Ending) -> Words {
    match ending {
        Ending::GivenUp { error, pc, why } => {
            let name = module.errors.get(error.index()).map_or("", |error| error.name.as_str());
            let text = format!("error {name}, due at {}: {why}", line(module, *pc));
            Words::wrong(name, "error given up", text)
        }
        _ => Words::new("end", "the program has ended"),
    }
}

/// With how to look at what was before.
fn refused(session: &Session<'_, Sim>, refusal: &Refusal) -> Words {
    let passed = session.why().never.map(|never| never.moment);
    let text = passed.map(|moment| {
        format!("`goto {moment}` in the debug console shows what was, and commands nothing")
    });
    Words { text, ..Words::new("never", why_not(session.module(), refusal)) }
}

fn why_not(module: &Module, refusal: &Refusal) -> String {
    let own = refusal.reason.and_then(|reason| module.reasons.get(reason.index()));
    let why = own.map_or(refusal.why, String::as_str);
    format!("cannot go back past {}: {why}", line(module, refusal.pc))
}

fn trapped(module: &Module, trap: &Trap) -> String {
    let own = match trap.kind {
        TrapKind::Required(reason) => module.reasons.get(reason.index()).cloned(),
        _ => None,
    };
    format!("{}: {}", line(module, trap.pc), own.unwrap_or_else(|| trap.kind.to_string()))
}

/// What is shown, in a few words: a what-if within another by how many they are.
pub(crate) fn mode(session: &Session<'_, Sim>) -> String {
    let tried = match session.tries() {
        0 => String::new(),
        1 => Mode::WhatIf.name().to_owned(),
        tries => format!("{} {tries}", Mode::WhatIf.name()),
    };
    match session.mode() {
        Mode::Live => Mode::Live.name().to_owned(),
        Mode::WhatIf => tried,
        Mode::Rewound => {
            let rewound = format!("rewound to {} of {}", session.moment(), session.recording().end);
            format!("{tried} {rewound}").trim_start().to_owned()
        }
    }
}
