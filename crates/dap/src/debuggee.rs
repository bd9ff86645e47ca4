//! The session over a program, request by request.
//!
//! What goes back is begun before it is answered, so that a step back that is refused is answered
//! with the reason, and nothing has moved.

use crate::begin::{Stops, run};
use crate::message::{
    DataInfo, Disassemble, FrameId, Goto, GotoTargets, Request, SetBreakpoints, SetExceptions,
    SetPoints, SourceText, Step, Variables, Wanted,
};
use crate::motion::{Begun, Going, is_end};
use crate::places;
use crate::points::{Group, Points, data, filters};
use crate::server::{Ended, Loaded, Server};
use crate::story::{Story, Told};
use crate::words::{self, Words};
use obverse_bytecode::FunctionKind;
use obverse_debugger::{Grain, Halt, Mode, Moment, Policy, Session, Walk};
use obverse_recovery::Memory;
use obverse_sim::Sim;
use obverse_vm::Direction;
use serde_json::{Value, json};
use std::sync::atomic::Ordering;

/// A program is one thread to clients, also where it forks: its branches are one history.
pub(crate) const THREAD: u64 = 1;
/// The most instructions between two looks at what log points have told.
const SLICE: u64 = 1 << 16;
/// The most moments that are offered of a line.
const MAX_TARGETS: usize = 50;

/// What follows a request.
pub(crate) enum Next {
    /// The next one.
    Stay,
    /// The run goes on.
    Go(Going),
    /// The end.
    End(Ended),
}

/// What a request comes to: what it is answered, or why it is refused.
pub(crate) type Answer = Result<Value, String>;

/// The session over a program.
pub(crate) struct Debuggee<'a, 's, 'p> {
    pub(crate) server: &'a mut Server<'s>,
    pub(crate) session: Session<'p, Sim>,
    pub(crate) loaded: &'p Loaded,
    launch: Stops,
    points: Points,
    /// What is told of recoveries.
    told: Told,
    /// What the last stop was about.
    stop: Words,
    /// The moments that were offered last.
    targets: Vec<Moment>,
    is_started: bool,
    is_over: bool,
}

impl<'a, 's, 'p> Debuggee<'a, 's, 'p> {
    /// At the start of the program, or at the end of a recording.
    pub(crate) fn begin(
        server: &'a mut Server<'s>,
        loaded: &'p Loaded,
        wanted: &Wanted,
    ) -> Result<Self, String> {
        let mut session = Session::over(run(loaded)?);
        let told = Told::default();
        session.tell_to(Box::new(Story { module: session.module(), told: told.clone() }));
        session.recover_by(Policy::declared(loaded.seed), Memory::default());
        server.inbox.ring(session.interrupter());
        Ok(Self {
            server,
            session,
            loaded,
            launch: Stops::of(wanted),
            points: Points::new(),
            told,
            stop: Words::new("entry", "at the start"),
            targets: Vec::new(),
            is_started: false,
            is_over: false,
        })
    }

    /// Serve the client until it is done.
    pub(crate) fn serve(&mut self, launch: &Request) -> Ended {
        for note in &self.loaded.notes {
            self.server.out.tell("console", note);
        }
        self.server.out.answer(launch, Value::Null);
        let filters = filters(Some(self.session.module()));
        let capabilities = json!({
            "exceptionBreakpointFilters": filters,
            "supportsSetVariable": self.session.can_try(),
        });
        self.server.out.event("capabilities", json!({ "capabilities": capabilities }));
        self.server.out.event("initialized", json!({}));
        loop {
            let request = match self.server.next() {
                Ok(request) => request,
                Err(ended) => return ended,
            };
            match self.handle(&request) {
                Next::Stay => {}
                Next::End(ended) => return ended,
                Next::Go(going) => {
                    if let Some(ended) = self.drive(going) {
                        return ended;
                    }
                }
            }
        }
    }

    fn handle(&mut self, request: &Request) -> Next {
        match request.command.as_str() {
            "configurationDone" => self.start(request),
            "continue" | "next" | "stepIn" | "stepOut" => self.forward(request),
            "stepBack" | "reverseContinue" | "restartFrame" => self.back(request),
            "goto" => self.reply_and_stop(request, Self::jump),
            "disconnect" => {
                self.server.out.answer(request, Value::Null);
                Next::End(Ended::Done)
            }
            "terminate" => {
                self.server.out.answer(request, Value::Null);
                self.over(1);
                Next::Stay
            }
            "evaluate" => self.evaluate(request),
            "setVariable" => {
                self.reply(request, Self::set_variable);
                Next::Stay
            }
            _ => {
                self.reply(request, Self::answer);
                Next::Stay
            }
        }
    }

    /// What is asked of a session that stays where it is.
    fn answer(&mut self, request: &Request) -> Answer {
        let module = self.session.module();
        match request.command.as_str() {
            "threads" => {
                let name = format!("robot ({})", words::mode(&self.session));
                Ok(json!({ "threads": [{ "id": THREAD, "name": name }] }))
            }
            "pause" => Ok(Value::Null),
            "setBreakpoints" => self.set_lines(request),
            "setFunctionBreakpoints" => self.set(request, &Group::Functions),
            "setInstructionBreakpoints" => self.set(request, &Group::Instructions),
            "setDataBreakpoints" => self.set(request, &Group::Data),
            "setExceptionBreakpoints" => self.set_errors(request),
            "dataBreakpointInfo" => self.data_info(&request.given()?),
            "stackTrace" => Ok(self.stack(&request.given()?)),
            "scopes" => self.scopes(request.given::<FrameId>()?.frame_id),
            "variables" => self.variables(request.given::<Variables>()?.variables_reference),
            "exceptionInfo" => self.exception_info(),
            "gotoTargets" => self.goto_targets(&request.given()?),
            "disassemble" => {
                let asked: Disassemble = request.given()?;
                places::disassembled(self.loaded, &self.server.client, &asked)
            }
            "loadedSources" => Ok(places::sources(self.loaded)),
            "source" => {
                let asked: SourceText = request.given()?;
                let of_source = asked.source.and_then(|source| source.source_reference);
                places::text(module, of_source.unwrap_or(asked.source_reference))
            }
            "initialize" | "launch" | "attach" => Err("a program is loaded already".to_owned()),
            other => Err(format!("`{other}` is not understood here")),
        }
    }

    pub(crate) fn reply(&mut self, request: &Request, work: fn(&mut Self, &Request) -> Answer) {
        match work(self, request) {
            Ok(body) => self.server.out.answer(request, body),
            Err(why) => self.server.out.refuse(request, &why),
        }
    }

    fn reply_and_stop(
        &mut self,
        request: &Request,
        work: fn(&mut Self, &Request) -> Answer,
    ) -> Next {
        match work(self, request) {
            Ok(body) => {
                self.server.out.answer(request, body);
                self.jumped();
            }
            Err(why) => self.server.out.refuse(request, &why),
        }
        Next::Stay
    }

    fn start(&mut self, request: &Request) -> Next {
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
            self.enter();
            self.stopped(Words::new("entry", "at the start of the program"), &[]);
            return Next::Stay;
        }
        Next::Go(Going::new(&self.session, Direction::Forward, Walk::Continue))
    }

    /// To the first statement that a person wrote into a sequence: what is before sets variables,
    /// and commands nothing.
    fn enter(&mut self) {
        let module = self.session.module();
        let is_before = |session: &Session<'_, Sim>| {
            let function = module.function_at(session.machine().state().pc());
            let function = function.and_then(|function| module.functions.get(function));
            function.is_some_and(|function| function.kind == FunctionKind::Start)
        };
        let step = Walk::Step(Grain::Statement);
        while is_before(&self.session) {
            if self.session.go(Direction::Forward, step) != Halt::Done {
                break;
            }
        }
    }

    /// Why the run cannot go anywhere, if it cannot.
    pub(crate) fn refuse_moving(&self) -> Result<(), String> {
        match (self.is_over, self.is_started) {
            (true, _) => Err("the session is over".to_owned()),
            (false, false) => Err("`configurationDone` comes first".to_owned()),
            (false, true) => Ok(()),
        }
    }

    fn forward(&mut self, request: &Request) -> Next {
        let walk = self.refuse_moving().and_then(|()| {
            let grain = grain(request)?;
            Ok(match request.command.as_str() {
                "next" => Walk::Next(grain),
                "stepIn" => Walk::Step(grain),
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

    fn back(&mut self, request: &Request) -> Next {
        let going = self.refuse_moving().and_then(|()| self.way_back(request));
        let going = match going {
            Ok(going) => going,
            Err(why) => {
                self.server.out.refuse(request, &why);
                return Next::Stay;
            }
        };
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
                self.server.out.answer(request, going_on(request));
                self.tell();
                self.halted(&halt);
                Next::Stay
            }
            Begun::GoesOn => {
                self.server.out.answer(request, going_on(request));
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
    fn drive(&mut self, going: Going) -> Option<Ended> {
        let interrupter = self.session.interrupter();
        self.session.limit(SLICE);
        let ended = loop {
            let halt = going.go(&mut self.session);
            self.tell();
            if self.server.out.is_gone {
                break Some(Ended::Gone);
            }
            match halt {
                Halt::Limit if !interrupter.load(Ordering::Relaxed) => {}
                Halt::Limit | Halt::Interrupted => match self.meanwhile() {
                    Ok(true) => {}
                    Ok(false) => {
                        self.halted(&Halt::Interrupted);
                        break None;
                    }
                    Err(ended) => break Some(ended),
                },
                halt if self.passes(&halt) => {}
                halt => {
                    self.halted(&halt);
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
        is_nothing || self.points.passes(self.session.module(), halt)
    }

    /// The message that a run was halted for. Whether the run goes on.
    fn meanwhile(&mut self) -> Result<bool, Ended> {
        let Some(frame) = self.server.inbox.take() else { return Ok(true) };
        let Some(request) = self.server.request(frame)? else { return Ok(true) };
        match request.command.as_str() {
            "pause" => {
                self.server.out.answer(&request, Value::Null);
                return Ok(false);
            }
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

    /// What log points have told, and what was done about errors.
    fn tell(&mut self) {
        for text in self.told.take() {
            self.server.out.tell("console", &text);
        }
        for (_, text) in self.session.take_told() {
            self.server.out.tell("console", &text);
        }
    }

    /// It has come to a halt, and a client is told why.
    fn halted(&mut self, halt: &Halt) {
        if self.is_over {
            return;
        }
        let mut words = words::halt(&self.session, halt);
        words.add_intent(&mut self.session, halt);
        let mut ids = Vec::new();
        if let Halt::Hits(hits) = halt {
            ids = hits.iter().map(|hit| hit.id).collect();
            (words.reason, words.exception) = self.points.reason(&ids);
            if let Some(error) = &words.exception {
                "error raised".clone_into(&mut words.description);
                words.text = Some(format!("error {error} is raised"));
            } else if let Some((before, after)) = hits.iter().find_map(|hit| hit.change.as_ref()) {
                words.text = Some(format!("it was {before} and is {after}"));
            }
        }
        let is_finished = is_end(halt);
        if self.launch.no_debug || is_finished && !self.launch.stop_at_end {
            if !is_finished {
                let text = words.text.as_ref().unwrap_or(&words.description);
                self.server.out.tell("stderr", text);
            }
            let is_fine = is_finished && self.session.machine().state().raised().is_empty();
            self.over(u8::from(!is_fine));
            return;
        }
        let ids = self.points.told(&ids);
        self.stopped(words, &ids);
    }

    /// A client is told that it stands somewhere, and why.
    fn stopped(&mut self, words: Words, ids: &[u32]) {
        let mode = words::mode(&self.session);
        let mut body = json!({
            "reason": words.reason,
            "description": format!("{} ({mode})", words.description),
            "threadId": THREAD,
            "allThreadsStopped": true,
        });
        if let Some(text) = &words.text {
            body["text"] = json!(text);
        }
        if !ids.is_empty() {
            body["hitBreakpointIds"] = json!(ids);
        }
        if matches!(words.reason, "exception" | "never" | "end") {
            let text = words.text.as_ref().map(|text| format!(": {text}")).unwrap_or_default();
            self.server.out.tell("console", &format!("{}{text}", words.description));
        }
        self.stop = words;
        self.server.out.event("stopped", body);
    }

    /// What is shown is another moment.
    pub(crate) fn jumped(&mut self) {
        self.stopped(Words::new("goto", "gone to"), &[]);
    }

    fn over(&mut self, exit_code: u8) {
        if !self.is_over {
            self.is_over = true;
            self.server.out.event("exited", json!({ "exitCode": exit_code }));
            self.server.out.event("terminated", json!({}));
        }
    }

    fn set_lines(&mut self, request: &Request) -> Answer {
        let asked: SetBreakpoints = request.given()?;
        let file = places::file(self.loaded, &asked.source)?;
        self.set_group(&Group::Lines(file.to_owned()), asked.breakpoints)
    }

    fn set(&mut self, request: &Request, group: &Group) -> Answer {
        self.set_group(group, request.given::<SetPoints>()?.breakpoints)
    }

    fn set_group(&mut self, group: &Group, asked: Vec<Value>) -> Answer {
        if self.launch.no_debug {
            return Err(NO_STOPS.to_owned());
        }
        let about = (self.loaded, &self.server.client);
        self.points.set(&mut self.session, about, group, asked)
    }

    fn set_errors(&mut self, request: &Request) -> Answer {
        let asked: SetExceptions = request.given()?;
        let filters = if self.launch.no_debug { Vec::new() } else { asked.filters };
        Ok(self.points.set_errors(&mut self.session, filters))
    }

    fn data_info(&self, asked: &DataInfo) -> Answer {
        let module = self.session.module();
        let function = match asked.variables_reference {
            Some(reference) => {
                self.named(reference, &asked.name)?;
                self.function_of_variables(reference)
            }
            None => self.function_of(asked.frame_id),
        };
        Ok(data(module, function, &asked.name))
    }

    fn exception_info(&self) -> Answer {
        let id = self.stop.exception.as_ref().ok_or("nothing went wrong here")?;
        let words = self.stop.text.as_ref().unwrap_or(&self.stop.description);
        Ok(json!({ "exceptionId": id, "description": words, "breakMode": "always" }))
    }

    /// The moments at which something was done on a line, newest first.
    fn goto_targets(&mut self, asked: &GotoTargets) -> Answer {
        let file = places::file(self.loaded, &asked.source)?;
        let line = self.server.client.line_of(asked.line);
        let mut actions = self.session.history();
        actions.retain(|action| places::is_on(action.place.as_ref(), file, line));
        actions.reverse();
        actions.truncate(MAX_TARGETS);
        self.targets = actions.iter().map(|action| action.moment).collect();
        let target = |(id, action): (usize, &obverse_debugger::session::Action)| {
            let back = if action.direction == Direction::Reverse { "going back over " } else { "" };
            json!({
                "id": id,
                "label": format!("moment {}: {back}{}", action.moment, action.text),
                "line": asked.line,
                "instructionPointerReference": action.pc.to_string(),
            })
        };
        let targets: Vec<Value> = actions.iter().enumerate().map(target).collect();
        Ok(json!({ "targets": targets }))
    }

    fn jump(&mut self, request: &Request) -> Answer {
        self.refuse_moving()?;
        let asked: Goto = request.given()?;
        let moment = self.targets.get(asked.target_id).copied();
        let moment = moment.ok_or("ask for `gotoTargets` first: there is no such target")?;
        self.session.go_to(moment).map_err(|why| why.to_string())?;
        Ok(Value::Null)
    }
}

const NO_STOPS: &str = "it was launched to run without stops";

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
