//! How the run is driven for requests: where each leads, what is answered before, and what a client
//! may ask for meanwhile.

use crate::debuggee::{Debuggee, Next, THREAD, check_thread};
use crate::message::{FrameId, Request, Step};
use crate::motion::{Begun, Going, SEQUENCE_DEPTH};
use crate::server::Ended;
use crate::words::{self, Words};
use obverse_debugger::{Grain, Halt, Mode, Walk};
use obverse_vm::Direction;
use serde_json::{Value, json};
use std::sync::atomic::Ordering;

/// The most instructions between two looks at what log points have told.
const SLICE: u64 = 1 << 16;

impl Debuggee<'_, '_, '_> {
    pub(crate) fn start(&mut self, request: &Request) -> Next {
        if self.is_started {
            self.server.out.refuse(request, "it has started already");
            return Next::Stay;
        }
        self.is_started = true;
        self.server.out.answer(request, Value::Null);
        self.server.out.event("thread", json!({ "reason": "started", "threadId": THREAD }));
        if self.session.run().cell().is_none() {
            self.stopped(Words::new("entry", "at the end of the recording"), &[]);
            return Next::Stay;
        }
        if self.launch.stop_on_entry && !self.launch.no_debug {
            // What is before sets variables, and commands nothing.
            let next = Walk::Next(Grain::Statement);
            let _ = Going::new(&self.session, Direction::Forward, next).go(&mut self.session);
            self.stopped(Words::new("entry", "at the start of the program"), &[]);
            return Next::Stay;
        }
        Next::Go(Going::new(&self.session, Direction::Forward, Walk::Continue))
    }

    /// Why the run cannot go anywhere, if it cannot.
    pub(crate) fn refuse_moving(&self) -> Result<(), String> {
        match (self.is_over, self.is_started) {
            (true, _) => Err("the session is over".to_owned()),
            (false, false) => Err("`configurationDone` comes first".to_owned()),
            (false, true) => Ok(()),
        }
    }

    pub(crate) fn forward(&mut self, request: &Request) -> Next {
        let walk = self.refuse_moving().and_then(|()| {
            let grain = grain(request)?;
            Ok(match request.command.as_str() {
                "next" => Walk::Next(grain),
                "stepIn" => Walk::Step(grain),
                // What calls the first sequence is written nowhere: behind it is the end.
                "stepOut" if self.session.frames().len() <= SEQUENCE_DEPTH => Walk::Continue,
                "stepOut" => Walk::Finish,
                _ => Walk::Continue,
            })
        });
        let walk = match walk {
            Ok(walk) => walk,
            Err(why) => {
                self.server.out.refuse(request, &why);
                return Next::Stay;
            }
        };
        let position = self.session.position();
        let is_rewound = position.mode == Mode::Rewound;
        if is_rewound && position.moment == position.end {
            let words = words::halt(&self.session, &Halt::EndOfRecording);
            self.server.out.refuse(request, &words.description);
            return Next::Stay;
        }
        if !is_rewound && self.session.is_held() {
            self.server.out.refuse(request, words::HELD);
            return Next::Stay;
        }
        self.server.out.answer(request, going_on(request));
        Next::Go(Going::new(&self.session, Direction::Forward, walk))
    }

    pub(crate) fn back(&mut self, request: &Request) -> Next {
        match self.refuse_moving().and_then(|()| self.way_back(request)) {
            Ok(going) => self.go_back(request, going, going_on(request)),
            Err(why) => {
                self.server.out.refuse(request, &why);
                Next::Stay
            }
        }
    }

    /// Go back, if it can be begun: if not, nothing has moved, and the reason is the answer.
    pub(crate) fn go_back(&mut self, request: &Request, going: Going, body: Value) -> Next {
        match going.begin(&mut self.session) {
            Begun::Refused(halt) => {
                let words = words::halt(&self.session, &halt);
                let text = words.text.map(|text| format!("; {text}")).unwrap_or_default();
                let why = format!("{}{text}", words.description);
                self.server.out.refuse(request, &why);
                self.server.out.tell("console", &why);
                Next::Stay
            }
            Begun::Halted(halt) => {
                self.server.out.answer(request, body);
                self.tell();
                self.halted(&halt, going);
                Next::Stay
            }
            Begun::GoesOn => {
                self.server.out.answer(request, body);
                Next::Go(going)
            }
        }
    }

    fn way_back(&self, request: &Request) -> Result<Going, String> {
        let walk = match request.command.as_str() {
            "restartFrame" => {
                let frame = request.given::<FrameId>()?.frame_id;
                let depth = self.session.frames().len();
                if frame == 0 || frame > depth {
                    return Err(format!("there is no call {frame}: {depth} are under way"));
                }
                return Ok(Going::to_begin_of(frame));
            }
            "reverseContinue" => Walk::Continue,
            _ => match grain(request)? {
                Grain::Instruction => Walk::Step(Grain::Instruction),
                grain => Walk::Next(grain),
            },
        };
        Ok(Going::new(&self.session, Direction::Reverse, walk))
    }

    /// Go on until something stops it, and serve the client meanwhile.
    pub(crate) fn drive(&mut self, going: Going) -> Option<Ended> {
        let interrupter = self.session.interrupter();
        let until = self.session.recording().end.after(self.launch.limit);
        let ended = loop {
            let left = until.0 - self.session.recording().end.0;
            self.session.limit(SLICE.min(left));
            let halt = match left {
                0 => Halt::Limit,
                _ => going.go(&mut self.session),
            };
            self.tell();
            if self.server.out.is_gone {
                break Some(Ended::Gone);
            }
            let is_limit = halt == Halt::Limit && self.session.recording().end >= until;
            match halt {
                Halt::Limit if is_limit => {
                    self.halted(&halt, going);
                    break None;
                }
                Halt::Limit if !interrupter.load(Ordering::Relaxed) => {}
                Halt::Limit | Halt::Interrupted => match self.meanwhile() {
                    // Between two messages the run gets on.
                    Ok(true) => self.session.begin_command(),
                    Ok(false) => {
                        self.halted(&Halt::Interrupted, going);
                        break None;
                    }
                    Err(ended) => break Some(ended),
                },
                halt if self.passes(&halt) => {}
                halt => {
                    self.halted(&halt, going);
                    break None;
                }
            }
        };
        self.session.limit(u64::MAX);
        ended
    }

    /// Whether the run goes on from a halt, since nobody wants to hear of it.
    fn passes(&self, halt: &Halt) -> bool {
        let goes_on = !self.session.is_over() && !self.session.is_held();
        let is_nothing = self.launch.no_debug && matches!(halt, Halt::Stopped(_)) && goes_on;
        is_nothing || self.points.passes(halt)
    }

    /// Serve the client while something is looked for. Whether that goes on.
    pub(crate) fn goes_on_meanwhile(&mut self) -> bool {
        match self.meanwhile() {
            Ok(goes_on) => {
                self.session.begin_command();
                goes_on
            }
            Err(ended) => {
                self.ended = Some(ended);
                false
            }
        }
    }

    /// The message that a run was halted for. Whether the run goes on.
    fn meanwhile(&mut self) -> Result<bool, Ended> {
        let Some(frame) = self.server.inbox.take() else { return Ok(true) };
        let Some(request) = self.server.request(frame)? else { return Ok(true) };
        match request.command.as_str() {
            "pause" => match check_thread(&request) {
                Ok(()) => {
                    self.server.out.answer(&request, Value::Null);
                    return Ok(false);
                }
                Err(why) => self.server.out.refuse(&request, &why),
            },
            "terminate" => {
                self.handle(&request);
                return Ok(false);
            }
            "threads"
            | "setBreakpoints"
            | "setFunctionBreakpoints"
            | "setDataBreakpoints"
            | "setInstructionBreakpoints"
            | "setExceptionBreakpoints"
            | "dataBreakpointInfo"
            | "disassemble"
            | "loadedSources"
            | "source"
            | "disconnect" => {
                if let Next::End(ended) = self.handle(&request) {
                    return Err(ended);
                }
            }
            _ => self.server.out.refuse(&request, "the program is running: pause it first"),
        }
        Ok(true)
    }
}

fn going_on(request: &Request) -> Value {
    match request.command.as_str() {
        "continue" => json!({ "allThreadsContinued": true }),
        _ => Value::Null,
    }
}

fn grain(request: &Request) -> Result<Grain, String> {
    let asked: Step = request.given()?;
    match asked.granularity.as_deref() {
        Some("instruction") => Ok(Grain::Instruction),
        None | Some("statement" | "line") => Ok(Grain::Statement),
        Some(other) => Err(format!("there are no steps of a `{other}`")),
    }
}
