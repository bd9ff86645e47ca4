//! The session over a program, request by request.
//!
//! What goes back is begun before it is answered, so that a step back that is refused is answered
//! with the reason, and nothing has moved.

use crate::begin::{Stops, run};
use crate::filters;
use crate::message::{
    DataInfo, Disassemble, FilterOption, FrameId, Request, SetBreakpoints, SetExceptions,
    SetPoints, SourceText, ThreadId, Variables, Wanted,
};
use crate::motion::{Going, is_end};
use crate::places;
use crate::points::{Group, Points, data, none_set};
use crate::server::{Ended, Loaded, Server};
use crate::story::{Story, Told};
use crate::words::{self, Words};
use obverse_debugger::{Halt, Moment, Session};
use obverse_sim::Sim;
use serde_json::{Value, json};

/// A program is one thread to clients, also where it forks: its branches are one history.
pub(crate) const THREAD: u64 = 1;

/// The requests that are about the thread, and must name it.
const OF_THREAD: [&str; 10] = [
    "continue",
    "next",
    "stepIn",
    "stepOut",
    "stepBack",
    "reverseContinue",
    "goto",
    "pause",
    "stackTrace",
    "exceptionInfo",
];

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
    pub(crate) launch: Stops,
    pub(crate) points: Points,
    /// What is told of recoveries.
    pub(crate) told: Told,
    /// What the last stop was about.
    stop: Words,
    /// The moments that were offered last.
    pub(crate) targets: Vec<Moment>,
    pub(crate) is_started: bool,
    pub(crate) is_over: bool,
    /// How it ended while something was looked for.
    pub(crate) ended: Option<Ended>,
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
        session.recover_by(loaded.policy, loaded.memory.clone());
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
            ended: None,
        })
    }

    /// Serve the client until it is done.
    pub(crate) fn serve(&mut self, launch: &Request) -> Ended {
        for note in &self.loaded.notes {
            self.server.out.tell("console", note);
        }
        self.server.out.answer(launch, Value::Null);
        let capabilities = json!({
            "exceptionBreakpointFilters": filters::offered(Some(self.session.module())),
            "supportsSetVariable": self.session.can_try(),
        });
        self.server.out.event("capabilities", json!({ "capabilities": capabilities }));
        self.server.out.event("initialized", json!({}));
        let ended = self.until_done();
        let kept = self.loaded.keep.as_ref().map_or(Ok(()), |keep| keep(self.session.memory()));
        if let Err(why) = kept {
            (self.server.log)(&why);
            self.server.out.tell("stderr", &why);
        }
        ended
    }

    fn until_done(&mut self) -> Ended {
        loop {
            let request = match self.server.next() {
                Ok(request) => request,
                Err(ended) => return ended,
            };
            self.session.begin_command();
            let next = self.handle(&request);
            if let Some(ended) = self.ended.take() {
                return ended;
            }
            match next {
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

    pub(crate) fn handle(&mut self, request: &Request) -> Next {
        if let Err(why) = check_thread(request) {
            self.server.out.refuse(request, &why);
            return Next::Stay;
        }
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
            "completions" => self.completions(&request.given()?),
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

    /// What log points have told, and what was done about errors.
    pub(crate) fn tell(&mut self) {
        for text in self.told.take() {
            self.server.out.tell("console", &text);
        }
        for (_, text) in self.session.take_told() {
            self.server.out.tell("console", &text);
        }
    }

    /// It has come to a halt, and a client is told why.
    pub(crate) fn halted(&mut self, halt: &Halt, going: Going) {
        if self.is_over {
            return;
        }
        let mut words = match halt {
            Halt::Done if going.is_restart() => Words::new("restart", "back where it was called"),
            halt => words::halt(&self.session, halt),
        };
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
    pub(crate) fn stopped(&mut self, words: Words, ids: &[u32]) {
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
        // Older clients say lines, and nothing else of them.
        let lines = || asked.lines.iter().map(|line| json!({ "line": line })).collect();
        let points = asked.breakpoints.unwrap_or_else(lines);
        match places::file(self.loaded, &asked.source) {
            Ok(file) => self.set_group(&Group::Lines(file.to_owned()), points),
            Err(why) => Ok(none_set(points.len(), &why)),
        }
    }

    fn set(&mut self, request: &Request, group: &Group) -> Answer {
        self.set_group(group, request.given::<SetPoints>()?.breakpoints)
    }

    fn set_group(&mut self, group: &Group, asked: Vec<Value>) -> Answer {
        if self.launch.no_debug {
            return Ok(none_set(asked.len(), NO_STOPS));
        }
        let about = (self.loaded, &self.server.client);
        self.points.set(&mut self.session, about, group, asked)
    }

    fn set_errors(&mut self, request: &Request) -> Answer {
        let asked: SetExceptions = request.given()?;
        let plain = asked.filters.into_iter();
        let plain = plain.map(|filter_id| FilterOption { filter_id, condition: None });
        let all = plain.chain(asked.filter_options).collect();
        if self.launch.no_debug {
            let count = Vec::len(&all);
            self.points.set_errors(&mut self.session, Vec::new());
            return Ok(none_set(count, NO_STOPS));
        }
        Ok(self.points.set_errors(&mut self.session, all))
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
        Ok(data(module, &self.session.recording().facts, function, &asked.name))
    }

    fn exception_info(&self) -> Answer {
        let id = self.stop.exception.as_ref().ok_or("nothing went wrong here")?;
        let words = self.stop.text.as_ref().unwrap_or(&self.stop.description);
        Ok(json!({ "exceptionId": id, "description": words, "breakMode": "always" }))
    }
}

/// That a request names the thread that there is, if it is about one.
pub(crate) fn check_thread(request: &Request) -> Result<(), String> {
    if !OF_THREAD.contains(&request.command.as_str()) {
        return Ok(());
    }
    let ThreadId { thread_id } = request.given()?;
    match thread_id {
        THREAD => Ok(()),
        other => Err(format!("there is no thread {other}: the only one is {THREAD}")),
    }
}

const NO_STOPS: &str = "it was launched to run without stops";
