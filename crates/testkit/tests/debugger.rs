//! A session of the debugger over small programs: what is tried, what is changed by hand, a
//! recording without its workcell, places, conditions, history, hit counts and what is told.

use obverse_bytecode::{Module, Verified, verify};
use obverse_compiler::compile;
use obverse_debugger::recording::Moment;
use obverse_debugger::{
    Breakpoint, Declined, Expression, Grain, Halt, Hit, Mode, Piece, PlaceError, Places, Run,
    Session, Subject, Unit, Value, Walk, Wrong,
};
use obverse_isa::GlobalId;
use obverse_testkit::Ledger;
use obverse_vm::Direction::{Forward, Reverse};
use obverse_vm::Stop;
use obverse_workcell::Fault;
use std::sync::atomic::Ordering;

const PROGRAM: &str = "\
error odd { severity warning }
var count = 0
io clamp { set 2 high }
sequence work(by: int) {
  var twice = by + by
  count += twice
  io clamp
  if input 1 { set 3 high }
  set 2 low
}
sequence main {
  call work(1)
  checkpoint half

  irreversible \"the glue is on\" { set 1 high }
  call work(2)
  throw odd
  if count > 100 { set 0 high }
}
";

const COUNT: Subject = Subject::Global(GlobalId(0));

fn program() -> Verified {
    let compiled = compile("p.obv", PROGRAM);
    let wrong = || panic!("{:?}", compiled.diagnostics);
    verify(compiled.module.unwrap_or_else(wrong)).expect("it verifies")
}

fn session(program: &Verified) -> Session<'_, Ledger> {
    let run = Run::new(program, Ledger::new(1)).expect("it links");
    Session::over(run.simulated(None))
}

fn finished(program: &Verified) -> Session<'_, Ledger> {
    let mut session = session(program);
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
    session
}

fn read(session: &Session<'_, Ledger>, text: &str) -> Value {
    let module = session.module();
    let function = module.function_at(session.position().pc).expect("a function");
    let expression = Expression::parse(module, function, text).expect(text);
    session.look(|look| expression.value(look))
}

fn hit(id: u32) -> Hit {
    Hit { id, change: None, log: None }
}

fn line(session: &Session<'_, Ledger>) -> usize {
    session.position().place.expect("a place").line
}

fn at_line(module: &Module, line: usize) -> Breakpoint {
    Breakpoint::at(Places::of_line(module, None, line).expect("a line"))
}

#[test]
fn what_is_tried_is_another_run_and_leaving_it_shows_what_was_shown() {
    let program = program();
    let mut session = finished(&program);
    let end = (session.digest(), session.recording().end);
    session.go_to(Moment(12)).expect("a moment");
    let shown = session.digest();
    assert_eq!(session.assign(&COUNT, &Value::Int(1)), Err(Declined::NoWhatIf));
    assert_eq!(session.force_input(1, Some(true)), Err(Declined::NoWhatIf));
    session.what_if().expect("a fork");
    assert_eq!((session.mode(), session.tries(), session.digest()), (Mode::WhatIf, 1, shown));
    session.assign(&COUNT, &Value::Int(500)).expect("a value");
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
    assert_eq!(read(&session, "output 0"), Value::Bool(true));
    session.leave_what_if().expect("something is tried");
    assert_eq!((session.mode(), session.digest()), (Mode::Rewound, shown));
    session.go_to_end();
    assert_eq!((session.digest(), session.recording().end), end);
    assert_eq!(session.leave_what_if(), Err(Declined::NoWhatIf));
}

#[test]
fn what_is_tried_can_be_left_for_another_try_from_before_it_began() {
    let program = program();
    let mut session = finished(&program);
    let (end, digest) = (session.moment(), session.digest());
    session.go_to(Moment(end.0 - 4)).expect("there is such a moment");
    session.what_if().expect("it is simulated");
    session.change_workcell(|cell| cell.acts += 1).expect("something is tried");
    session.go(Forward, Walk::Continue);
    session.go_to(Moment(2)).expect("there is such a moment");
    session.what_if().expect("the workcell of before the first try is known");
    assert_eq!(session.tries(), 2);
    session.go(Forward, Walk::Continue);
    assert_eq!((session.moment(), session.digest()), (end, digest), "the same again");
    session.leave_what_if().expect("something is tried");
    session.leave_what_if().expect("something is tried");
    session.go_to_end();
    assert_eq!((session.mode(), session.digest()), (Mode::Live, digest));
}

#[test]
fn an_act_that_was_cut_by_what_is_watched_is_shown_so_and_can_be_gone_on_from() {
    let source = "error opened { on input 0 high  respond at once  then stop }
                  sequence main { move 10 mm up  move 20 mm up  set 2 high }";
    let Some(module) = compile("p.obv", source).module else { panic!("it compiles") };
    let program = verify(module).expect("it verifies");
    let mut cell = Ledger::new(1);
    cell.comes_at = Some((1, 0.5));
    let mut session = Session::over(Run::new(&program, cell).expect("it links").simulated(None));
    let halt = session.go(Forward, Walk::Continue);
    assert!(
        matches!(halt, Halt::Stopped(Stop::Fault { fault: Fault::Watched { .. }, .. })),
        "{halt:?}"
    );
    let cut = (session.digest(), session.recording().end);
    // What was noticed is the program's error, at which it stops.
    let due = session.go(Forward, Walk::Continue);
    assert!(matches!(due, Halt::Stopped(Stop::Due { .. })), "{due:?}");
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
    assert_eq!(session.machine().state().raised().len(), 1);
    let end = session.digest();
    session.go_to(cut.1).expect("a moment");
    assert_eq!(session.digest(), cut.0);
    session.what_if().expect("the workcell does again what it did");
    assert_eq!(session.digest(), cut.0);
    assert_eq!(session.go(Forward, Walk::Continue), due);
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
    assert_eq!(session.digest(), end);
    session.leave_what_if().expect("something is tried");
    // Taken back by hand and gone forward again, nothing comes any more.
    session.go_to_end();
    assert_eq!(session.go(Reverse, Walk::Continue), Halt::Stopped(Stop::AtStart));
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
    assert!(session.machine().state().raised().is_empty());
}

#[test]
fn going_back_ends_where_a_variable_was_changed_by_hand() {
    let program = program();
    let mut session = session(&program);
    session.add_breakpoint(at_line(session.module(), 6));
    session.go(Forward, Walk::Continue);
    session.what_if().expect("a fork");
    session.assign(&COUNT, &Value::Int(7)).expect("a value");
    session.go(Forward, Walk::Step(Grain::Statement));
    assert_eq!(read(&session, "count"), Value::Int(9));
    session.breakpoints().iter().map(|it| it.id).collect::<Vec<_>>().into_iter().for_each(|id| {
        session.drop_breakpoint(id).expect("it is there");
    });
    assert_eq!(session.go(Reverse, Walk::Continue), Halt::Changed);
    assert_eq!(read(&session, "count"), Value::Int(7));
    assert_eq!(session.assign(&COUNT, &Value::Bool(true)), Err(Declined::NotAssignable));
    assert_eq!(session.assign(&Subject::Force, &Value::Real(1.0)), Err(Declined::NotAssignable));
}

#[test]
fn an_input_that_is_forced_is_read_so_until_it_is_let_go() {
    let program = program();
    let ends = |level| {
        let mut session = session(&program);
        session.what_if().expect("a fork");
        session.force_input(1, Some(level)).expect("something is tried");
        assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
        // What was tried is a recording like any other.
        session.go_to(Moment(0)).expect("the start");
        assert_eq!(session.go(Forward, Walk::Continue), Halt::EndOfRecording);
        read(&session, "output 3")
    };
    assert_eq!((ends(true), ends(false)), (Value::Bool(true), Value::Bool(false)));
}

#[test]
fn a_recording_without_its_workcell_is_rewound_and_nothing_else() {
    let program = program();
    let live = finished(&program);
    let run = Run::<Ledger>::of_recording(&program, live.recording().clone()).expect("it fits");
    let mut session = Session::over(run);
    assert_eq!((session.mode(), session.digest()), (Mode::Rewound, live.digest()));
    assert_eq!(session.history(), live.history());
    assert_eq!(session.why(), live.why());
    assert_eq!(session.release(), Err(Declined::NotLive));
    assert!(matches!(session.what_if(), Err(Declined::NoFork(_))));
    assert_eq!(session.go(Reverse, Walk::Continue), Halt::StartOfRecording);
    assert_eq!(session.go(Forward, Walk::Continue), Halt::EndOfRecording);
    let asked = Moment(live.recording().end.0 + 1);
    let end = live.recording().end;
    assert_eq!(session.go_to(asked), Err(Declined::NoMoment { asked, end }));
}

#[test]
fn reverse_is_refused_at_a_never_and_why_has_said_so() {
    let program = program();
    let mut session = session(&program);
    session.add_breakpoint(at_line(session.module(), 17));
    session.go(Forward, Walk::Continue);
    let why = session.why();
    let never = why.never.expect("it is irreversible");
    assert_eq!((never.place.map(|place| place.line), &*never.reason), (Some(15), "the glue is on"));
    assert_eq!((why.actions, why.is_refused_here), (2, false));
    let halt = session.go(Reverse, Walk::Continue);
    assert_eq!(halt.refusal().map(|refusal| refusal.pc), Some(never.pc));
    assert_eq!((session.mode(), session.why().actions), (Mode::Live, 0));
    assert!(session.why().is_refused_here);
    let digest = session.digest();
    assert!(session.go(Reverse, Walk::Step(Grain::Instruction)).refusal().is_some());
    assert_eq!(session.digest(), digest, "a refusal changes nothing");
}

#[test]
fn what_has_been_taken_back_stops_nothing() {
    let program = program();
    let mut session = session(&program);
    session.add_breakpoint(at_line(session.module(), 13));
    session.go(Forward, Walk::Continue);
    let actions = session.why().actions;
    assert!(actions > 0);
    assert_eq!(session.go(Reverse, Walk::Continue), Halt::Stopped(Stop::AtStart));
    assert_eq!((session.why().never, session.why().actions), (None, 0));
    session.go(Forward, Walk::Continue);
    assert_eq!(session.why().actions, actions);
}

#[test]
fn the_counter_of_a_loop_is_there_within_it_by_its_name() {
    let source = "sequence inner(n: int) {\n  for j from n down to 1 { set 2 high }\n}\n\
                  sequence main {\n  for i from 1 to 3 {\n    call inner(i)\n  }\n\
                  for i from 7 to 8 { set 3 high }\n}\n";
    let compiled = compile("p.obv", source);
    let program = verify(compiled.module.expect("it compiles")).expect("it verifies");
    let mut session = session(&program);
    let names = |session: &Session<'_, Ledger>, frame: usize| -> Vec<(String, Value)> {
        let locals = session.locals(frame).into_iter();
        locals.map(|local| (local.name, local.value)).collect()
    };
    session.add_breakpoint(at_line(program.module(), 2));
    let set = Places::of_name(program.module(), "output.set").expect("there are some");
    session.add_breakpoint(Breakpoint::at(set));
    let mut seen = Vec::new();
    while let Halt::Hits(_) = session.go(Forward, Walk::Continue) {
        let frames = session.frames().len();
        let top = names(&session, frames - 1);
        seen.push(top.iter().map(|(name, value)| format!("{name}={value}")).collect::<String>());
        if frames == 3 {
            let caller = names(&session, 1);
            assert_eq!((caller.len(), &caller[0].0[..]), (1, "i"));
        }
    }
    let expected = ["n=1", "n=1j=1", "n=2", "n=2j=2", "n=2j=1", "n=3", "n=3j=3", "n=3j=2"];
    assert_eq!(seen[..8], expected);
    assert_eq!(seen[seen.len() - 2..], ["i=7", "i=8"]);
}

#[test]
fn variables_are_of_their_units_and_take_no_other() {
    let source = "action go(d: length, n: number) {\n  var v = d / 2 s\n  wait d / v\n  \
                  wait n * 1 s\n}\nsequence main { call go(20 mm, 0.5) }\n";
    let compiled = compile("p.obv", source);
    let program = verify(compiled.module.expect("it compiles")).expect("it verifies");
    let mut session = session(&program);
    session.add_breakpoint(at_line(program.module(), 3));
    assert!(matches!(session.go(Forward, Walk::Continue), Halt::Hits(_)));
    session.what_if().expect("it is simulated");
    let shown = |session: &Session<'_, Ledger>, text: &str| read(session, text).to_string();
    assert_eq!(shown(&session, "v"), "10 mm/s");
    assert_eq!(shown(&session, "d + v * 3 s"), "50 mm");
    let function = program.module().functions.iter().position(|it| it.name == "go").expect("go");
    let parse = |text: &str| Expression::parse(program.module(), function, text);
    assert!(parse("d + 1 s").is_err_and(|error| error.why.contains("a length and a time")));
    let set = |session: &mut Session<'_, Ledger>, name: &str, value: &str| {
        let (subject, value) = (parse(name).expect(name), parse(value).expect(value));
        let value = session.look(|look| value.value(look));
        session.assign(subject.subjects()[0], &value)
    };
    for (name, value) in [("d", "7 s"), ("d", "2"), ("n", "3 mm"), ("v", "1 mm")] {
        let refused = Err(Declined::NotAssignable);
        assert_eq!(set(&mut session, name, value), refused, "{name} = {value}");
    }
    for (name, value) in [("d", "7 mm"), ("n", "2"), ("n", "2.5"), ("v", "1 mm / 1 s")] {
        assert_eq!(set(&mut session, name, value), Ok(()), "{name} = {value}");
    }
    assert_eq!(shown(&session, "d"), "7 mm");
}

#[test]
fn history_tells_each_action_once_with_its_way() {
    let program = program();
    let mut session = session(&program);
    session.add_breakpoint(at_line(session.module(), 13));
    session.go(Forward, Walk::Continue);
    session.go(Reverse, Walk::Continue);
    let history = session.history();
    let told: Vec<(&str, _)> =
        history.iter().map(|action| (action.text.as_str(), action.direction)).collect();
    let expected = [
        ("set 2 high", Forward),
        ("set 2 low", Forward),
        ("set 2 low", Reverse),
        ("set 2 high", Reverse),
    ];
    assert_eq!(told, expected);
    assert!(history.windows(2).all(|pair| pair[0].moment < pair[1].moment));
}

#[test]
fn places_are_lines_names_errors_and_opcodes() {
    let program = program();
    let module = program.module();
    let of_line = |line| Places::of_line(module, None, line);
    assert_eq!(of_line(1).map(|places| places.line), Ok(Some(2)));
    assert_eq!(of_line(99), Err(PlaceError::NoCode { line: 99 }));
    let elsewhere = Places::of_line(module, Some("q.obv"), 3);
    assert!(matches!(elsewhere, Err(PlaceError::NoFile { known, .. }) if known == ["p.obv"]));
    for name in ["work", "half", "io", "call", "output.set"] {
        assert!(!Places::of_name(module, name).expect(name).pcs.is_empty(), "{name}");
    }
    let meant = |found: Result<Places, PlaceError>| match found {
        Err(PlaceError::NoName { meant, .. }) => meant,
        found => panic!("{found:?}"),
    };
    assert_eq!(meant(Places::of_name(module, "worc")).as_deref(), Some("work"));
    assert_eq!(meant(Places::of_error(module, "od")).as_deref(), Some("odd"));
    assert_eq!(Places::of_error(module, "odd").expect("an error").pcs.len(), 1);
    assert!(Places::of_instruction(module, u32::MAX).is_err());
}

#[test]
fn conditions_say_where_they_are_wrong() {
    let program = program();
    let module = program.module();
    let main = module.function_at(module.code.len() as u32 - 1).expect("a function");
    for (text, value) in [
        ("1 + 2 * 3 == 7 and not false", Value::Bool(true)),
        ("-(2 - 3)", Value::Int(1)),
        ("7 / 2", Value::Int(3)),
        ("1 / 0", Value::Wrong(Wrong::DivisionByZero)),
        ("9223372036854775807 + 1", Value::Wrong(Wrong::Overflow)),
        ("-9223372036854775807 - 2 < 0", Value::Wrong(Wrong::Overflow)),
        ("3000000000 * -4000000000", Value::Wrong(Wrong::Overflow)),
        ("2 * 3 N", Value::Quantity(6.0, Unit::FORCE)),
        ("3 m + 2 m", Value::Quantity(5.0, Unit::LENGTH)),
        ("8 m / 2 m", Value::Real(4.0)),
        ("time * 0", Value::Quantity(0.0, Unit::TIME)),
        ("force < 1000 and time >= 0", Value::Bool(true)),
        ("5 mm < 1 cm", Value::Bool(true)),
        ("180 deg > 3.1 rad", Value::Bool(true)),
        ("holding or output 1", Value::Bool(true)),
        ("error odd or steps < 1", Value::Bool(false)),
    ] {
        let expression = Expression::parse(module, main, text).expect(text);
        let session = finished(&program);
        assert_eq!(session.look(|look| expression.value(look)), value, "{text}");
    }
    let deep = "(".repeat(60) + "1" + &")".repeat(60);
    let long = "1 + ".repeat(300) + "1";
    for (text, at, words) in [
        ("", 0, "a value is missing"),
        ("count >", 7, "a value is missing at the end"),
        ("(count", 6, "`)` is missing"),
        ("count 3", 6, "operator is missing"),
        ("count = 3", 6, "`==` compares"),
        ("coumt", 0, "`count`?"),
        ("count and true", 6, "true or false"),
        ("joint 7", 6, "from 1 to 6"),
        ("error no", 6, "no error `no`"),
        ("2 # 3", 2, "means nothing"),
        ("3 mm + 2", 7, "a length and a number without a unit cannot be added; write its unit: um"),
        ("2 - 3 s", 4, "a number without a unit and a time cannot be subtracted"),
        ("3 mm < 2 s", 7, "a length and a time cannot be compared"),
        ("joint 1 > 90", 10, "an angle and a number without a unit cannot be compared"),
        ("force + count", 8, "a force and a number without a unit cannot be added"),
        ("3 mm / 2 s > 3 mm", 13, "a speed and a length cannot be compared"),
        ("99999999999999999999", 0, "no number"),
        (&deep, 51, "nested"),
        (&long, 1000, "no longer"),
    ] {
        let wrong = Expression::parse(module, main, text).expect_err(text);
        assert!(wrong.why.contains(words), "{text}: {wrong}");
        assert_eq!(wrong.at, at, "{text}: {wrong}");
    }
}

#[test]
fn breakpoints_count_tell_and_pass() {
    let program = program();
    let mut session = session(&program);
    let module = session.module();
    let work = Places::of_name(module, "work").expect("a sequence");
    let counted = session.add_breakpoint(Breakpoint { ignored: 1, ..Breakpoint::at(work) });
    let value = Expression::of(module, COUNT);
    let pieces = vec![Piece::Text("count is ".to_owned()), Piece::Value(value)];
    let log = Breakpoint { log: Some(pieces), ..at_line(module, 9) };
    let told = session.add_breakpoint(log);
    let Halt::Hits(hits) = session.go(Forward, Walk::Continue) else {
        panic!("it is passed twice")
    };
    assert_eq!((hits.len(), hits[0].id), (1, counted));
    assert_eq!(session.breakpoints()[0].hits, 2);
    assert_eq!(session.take_told(), [(told, "count is 2".to_owned())]);
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
    assert_eq!(session.take_told(), [(told, "count is 6".to_owned())]);
    assert_eq!(session.take_told(), []);
}

#[test]
fn what_is_come_to_is_counted_going_back_over_a_recording_too() {
    let program = program();
    let mut session = finished(&program);
    let (end, at) = (session.moment(), at_line(program.module(), 6));
    session.go_to(end).expect("there is such a moment");
    let id = session.add_breakpoint(Breakpoint { ignored: 1, ..at.clone() });
    let told = vec![Piece::Text("by it".to_owned())];
    session.add_breakpoint(Breakpoint { log: Some(told), ..at.clone() });
    assert!(matches!(session.go(Reverse, Walk::Continue), Halt::Hits(_)));
    let there = session.moment();
    assert_eq!(session.breakpoints()[0].hits, 2, "one was passed");
    assert_eq!(session.take_told().len(), 2, "each is told");
    // It is the first of the two calls.
    session.drop_breakpoint(id).expect("it is there");
    assert_eq!(session.go(Reverse, Walk::Continue), Halt::StartOfRecording);
    let first = session.add_breakpoint(at);
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Hits(vec![hit(first)]));
    assert_eq!(session.moment(), there);
}

#[test]
fn who_interrupts_between_two_walks_of_a_command_halts_the_next() {
    let program = program();
    let mut session = finished(&program);
    let step = Walk::Step(Grain::Instruction);
    session.begin_command();
    assert_eq!(session.go(Reverse, step), Halt::Done);
    session.interrupter().store(true, Ordering::Relaxed);
    let moment = session.moment();
    assert_eq!((session.go(Reverse, step), session.moment()), (Halt::Interrupted, moment));
    session.interrupter().store(true, Ordering::Relaxed);
    session.begin_command();
    assert_eq!(session.go(Reverse, step), Halt::Done, "another command was meant");
}

#[test]
fn live_reverse_walks_as_forward_does_the_other_way() {
    let program = program();
    let mut session = session(&program);
    session.add_breakpoint(at_line(session.module(), 13));
    session.go(Forward, Walk::Continue);
    session.go(Reverse, Walk::Next(Grain::Statement));
    assert_eq!((line(&session), session.position().depth), (12, 2));
    session.go(Forward, Walk::Step(Grain::Statement));
    assert_eq!((line(&session), session.position().depth), (5, 3));
    session.go(Forward, Walk::Step(Grain::Statement));
    session.go(Reverse, Walk::Step(Grain::Statement));
    assert_eq!(line(&session), 5);
    session.go(Forward, Walk::Step(Grain::Statement));
    session.go(Reverse, Walk::Finish);
    assert_eq!(line(&session), 12);
    assert_eq!(session.mode(), Mode::Live);
}

/// A disk that is full.
struct Full(usize);

impl std::io::Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 = self.0.checked_sub(bytes.len()).ok_or(std::io::ErrorKind::StorageFull)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_run_whose_tape_cannot_be_written_runs_all_the_same_and_says_so_in_the_end() {
    use obverse_debugger::{Taped, Writer, taped};
    use obverse_recovery::Driven;
    let program = program();
    let recorded = |file: &mut dyn std::io::Write| {
        let mut cell = Ledger::new(1);
        let mut machine = obverse_vm::Machine::new(&program, &cell).expect("it links");
        let names = ("p.obv".to_owned(), None);
        let head = taped::head(program.module(), &cell, names, 1).expect("it is no larger");
        let mut taped = Taped::new(&mut machine, &mut cell, Writer::begin(file, head));
        while taped.run(Forward, u64::MAX, &mut ()) != Stop::Finished {}
        taped.end("finished").map_err(|error| error.kind())
    };
    let mut whole = Vec::new();
    assert_eq!(recorded(&mut whole), Ok(()));
    for room in [0, whole.len() / 2, whole.len() - 1] {
        assert_eq!(recorded(&mut Full(room)), Err(std::io::ErrorKind::StorageFull), "{room}");
    }
}
