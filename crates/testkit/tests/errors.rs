//! Errors in a session: what a walk does at one that is due, what stops it on the way back, who
//! goes back by hand, and what is tried from there.

use obverse_bytecode::{Verified, verify};
use obverse_compiler::compile;
use obverse_debugger::{
    Breakpoint, Declined, Expression, Grain, Halt, Mode, Places, Run, Session, Value, Walk,
};
use obverse_recovery::{GiveUp, Intended, Outcome};
use obverse_sim::cell::InputRule;
use obverse_sim::{Cell, Sim};
use obverse_testkit::Ledger;
use obverse_vm::Direction::{Forward, Reverse};
use obverse_vm::Stop;
use obverse_workcell::Fault;

/// Whether the error is raised depends on an input, which is low.
const PROGRAM: &str = "\
error odd {
  recover by reversing escalating up to 2 actions, slower
  give up after 2 times
  otherwise using mend
  then return to action
}
var mended = false
sequence mend { set 7 high  mended = true }
sequence main {
  set 1 high
  set 2 high
  set 3 high
  requires input 0 or mended else throw odd
  set 4 high
}
";

fn program_of(source: &str) -> Verified {
    let compiled = compile("p.obv", source);
    let wrong = || panic!("{:?}", compiled.diagnostics);
    verify(compiled.module.unwrap_or_else(wrong)).expect("it verifies")
}

fn program() -> Verified {
    program_of(PROGRAM)
}

/// A workcell whose input 0 reads low until it is forced.
fn session(program: &Verified) -> Session<'_, Ledger> {
    let low = (0..100).map(Ledger::new).find(|cell| {
        use obverse_workcell::DigitalIo;
        (0..40).all(|_| cell.input(0) == Ok(false))
    });
    let run = Run::new(program, low.expect("a workcell")).expect("it links");
    Session::over(run.simulated(None))
}

fn due(session: &mut Session<'_, Ledger>) {
    let halt = session.go(Forward, Walk::Continue);
    assert!(matches!(halt, Halt::Stopped(Stop::Due { .. })), "{halt:?}");
}

fn outputs(session: &Session<'_, Ledger>) -> Vec<u8> {
    let is_high = |bit: &u8| {
        let expression = Expression::parse(session.module(), 0, &format!("output {bit}"));
        let value = session.look(|look| expression.expect("an output").value(look));
        value == Value::Bool(true)
    };
    (0..8).filter(is_high).collect()
}

fn line(session: &Session<'_, Ledger>) -> usize {
    session.position().place.expect("a place").line
}

#[test]
fn an_error_that_is_due_says_what_comes_next_and_does_it() {
    let program = program();
    let mut session = session(&program);
    assert_eq!((session.intent(), session.recover()), (None, Err(Declined::NothingDue)));
    due(&mut session);
    let intended = |session: &mut Session<'_, Ledger>| session.intent().map(|it| it.what);
    assert!(matches!(intended(&mut session), Some(Intended::Back { actions: 1, .. })));
    assert_eq!(outputs(&session), [1, 2, 3], "to say it moves nothing");
    due(&mut session);
    assert!(matches!(intended(&mut session), Some(Intended::Back { actions: 2, .. })));
    due(&mut session);
    assert_eq!(intended(&mut session), Some(Intended::GiveUp(GiveUp::Attempts(2))));
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
    assert_eq!(outputs(&session), [1, 2, 3, 4, 7]);
    let incident = &session.incidents()[0];
    assert_eq!(incident.depths(), [1, 2]);
    assert_eq!(incident.outcome.map(|(it, _)| it), Some(Outcome::GivenUp(GiveUp::Attempts(2))));
}

#[test]
fn recover_goes_on_over_every_attempt_to_where_the_error_is_given_up() {
    let program = program();
    let mut session = session(&program);
    due(&mut session);
    assert_eq!(session.recover(), Ok(Halt::Done));
    assert!(!session.is_recovering() && !session.is_over());
    assert_eq!((session.incidents().len(), outputs(&session)), (1, vec![1, 2, 3]));
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
}

#[test]
fn what_stops_a_run_stops_it_on_the_way_back_too_and_it_goes_on_from_there() {
    let program = program();
    let mut session = session(&program);
    due(&mut session);
    let module = session.module();
    let watched = Expression::parse(module, 0, "output 3").expect("an output");
    let watch = session.add_breakpoint(Breakpoint::on_change(watched));
    let hit = |halt: &Halt| matches!(halt, Halt::Hits(hits) if hits[0].id == watch);
    let halt = session.go(Forward, Walk::Continue);
    assert!(hit(&halt) && session.is_recovering(), "{halt:?}");
    assert_eq!((outputs(&session), session.mode()), (vec![1, 2], Mode::Live));
    // What was is looked at, and nothing comes of it.
    session.go_to(obverse_debugger::Moment(0)).expect("the start");
    session.go(Forward, Walk::Step(Grain::Statement));
    session.go_to_end();
    let halt = session.recover().expect("it is under way");
    assert!(hit(&halt), "forward again: {halt:?}");
    assert_eq!(outputs(&session), [1, 2, 3]);
    due(&mut session);
    session.drop_breakpoint(watch).expect("it is there");
    let place = Places::of_line(module, None, 11).expect("a line");
    session.add_breakpoint(Breakpoint::at(place));
    let halt = session.recover().expect("it is due");
    assert!(matches!(halt, Halt::Hits(_)), "{halt:?}");
    assert_eq!((line(&session), outputs(&session)), (11, vec![1]));
    assert_eq!(session.recover(), Ok(Halt::Done));
    assert_eq!(session.incidents()[0].depths(), [1, 2]);
}

#[test]
fn steps_go_the_way_the_run_goes() {
    let program = program();
    let mut session = session(&program);
    due(&mut session);
    let mut lines = Vec::new();
    while session.go(Forward, Walk::Next(Grain::Statement)) == Halt::Done {
        lines.push((line(&session), outputs(&session).len()));
    }
    // Back over the question and the output, and forward over both.
    assert_eq!(lines, [(13, 3), (12, 2), (13, 3)]);
}

#[test]
fn who_goes_back_by_hand_puts_aside_what_was_tried() {
    let program = program();
    let mut session = session(&program);
    due(&mut session);
    due(&mut session);
    assert_eq!(session.intent().map(|intent| intent.incident.attempts.len()), Some(1));
    assert_eq!(session.go(Reverse, Walk::Continue), Halt::Stopped(Stop::AtStart));
    assert!(!session.is_recovering());
    due(&mut session);
    assert_eq!(session.intent().map(|intent| intent.incident.attempts.len()), Some(0));
    assert_eq!(session.incidents().len(), 1);
    assert_eq!(session.incidents()[0].outcome.map(|(it, _)| it), Some(Outcome::Lost));
    // A step back that is not made puts nothing aside.
    due(&mut session);
    assert_eq!(session.recover(), Ok(Halt::Done));
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
}

#[test]
fn what_is_tried_at_an_error_goes_its_own_way_and_teaches_nothing() {
    let program = program();
    let mut session = session(&program);
    due(&mut session);
    let shown = session.moment();
    let (digest, memory) = (session.digest(), session.memory().clone());
    for from_the_past in [false, true] {
        if from_the_past {
            session.go_to(shown).expect("a moment");
        }
        session.what_if().expect("a fork");
        session.force_input(0, Some(true)).expect("something is tried");
        assert_eq!(session.recover(), Ok(Halt::Done));
        assert_eq!(session.incidents()[0].depths(), [1]);
        assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
        assert_eq!(outputs(&session), [1, 2, 3, 4]);
        session.leave_what_if().expect("something is tried");
        session.go_to_end();
        assert_eq!((session.digest(), session.incidents().len()), (digest, 0));
        assert_eq!(*session.memory(), memory);
        assert!(session.is_recovering());
    }
    due(&mut session);
}

#[test]
fn nothing_is_gone_back_over_that_was_changed_by_hand() {
    let program = program();
    let mut session = session(&program);
    due(&mut session);
    session.what_if().expect("a fork");
    let mended = Expression::parse(session.module(), 0, "mended").expect("a variable");
    let subject = mended.subjects()[0].clone();
    session.assign(&subject, &Value::Bool(true)).expect("a variable");
    let never = Intended::GiveUp(GiveUp::NoWayBack { never: None });
    assert_eq!(session.intent().map(|intent| intent.what), Some(never));
}

#[test]
fn a_fault_that_the_program_names_is_its_error_once_the_arm_is_released() {
    let source = "error slipped {
                    on protective stop
                    recover by reversing 1 action
                    then return to action
                  }
                  sequence main { set 1 high  move 10 mm up  set 2 high }";
    let program = program_of(source);
    let cell = Ledger::new(1).stopping_at(1, 0.5);
    let mut session = Session::over(Run::new(&program, cell).expect("it links"));
    let halt = session.go(Forward, Walk::Continue);
    let is_stop = |halt: &Halt| {
        matches!(halt, Halt::Stopped(Stop::Fault { fault: Fault::ProtectiveStop { .. }, .. }))
    };
    assert!(is_stop(&halt) && session.is_recovering(), "{halt:?}");
    let before = (session.digest(), session.recording().end);
    for walk in [Walk::Continue, Walk::Recover, Walk::Step(Grain::Instruction)] {
        assert_eq!(session.go(Forward, walk), Halt::Held);
        assert_eq!(session.go(Reverse, walk), Halt::Held);
    }
    assert_eq!((session.digest(), session.recording().end), before, "nothing has moved");
    session.release().expect("it is live");
    assert_eq!(session.digest(), before.0, "nothing moves by a release alone");
    assert_eq!(session.recover(), Ok(Halt::Done));
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
    assert_eq!(session.incidents()[0].depths(), [1]);
}

#[test]
fn a_fault_that_no_error_names_ends_the_run_and_is_tried_again_by_hand() {
    let source = "sequence main { set 1 high  move 10 mm up  set 2 high }";
    let program = program_of(source);
    let cell = Ledger::new(1).stopping_at(1, 0.5);
    let mut session = Session::over(Run::new(&program, cell).expect("it links"));
    let halt = session.go(Forward, Walk::Continue);
    assert!(matches!(halt, Halt::Stopped(Stop::Fault { .. })) && session.is_over(), "{halt:?}");
    session.release().expect("it is live");
    assert_eq!(session.go(Forward, Walk::Continue), Halt::Stopped(Stop::Finished));
}

#[test]
fn the_cleanup_follows_what_ends_a_run_and_the_run_ends_in_that() {
    let program = program_of(
        "cleanup { set 5 high }
         var none = 0
         sequence main { set 1 high  none = 1 / none  set 2 high }",
    );
    let mut session = Session::over(Run::new(&program, Ledger::new(1)).expect("it links"));
    let halt = session.go(Forward, Walk::Continue);
    assert!(matches!(halt, Halt::Stopped(Stop::Trap(_))) && !session.is_over(), "{halt:?}");
    assert_eq!(outputs(&session), [1]);
    assert_eq!(session.go(Forward, Walk::Continue), halt);
    assert_eq!((outputs(&session), session.is_over()), (vec![1, 5], true));
}

#[test]
fn what_was_noticed_and_is_gone_back_over_by_hand_is_noticed_again() {
    let program = program_of(
        "error seen { on input 0 high  recover using help  then continue }
        sequence help { set 5 high }
        sequence main { set 1 high  wait 1 s  set 2 high }",
    );
    let mut cell = Cell::bare();
    cell.inputs[0] = InputRule::At(vec![(0.5, true)]);
    let run = Run::new(&program, Sim::new(&cell, 0)).expect("it links");
    let mut session = Session::over(run.simulated(None));
    for round in 1..=2 {
        let mut halts = (0..9).map(|_| session.go(Forward, Walk::Continue));
        assert!(halts.any(|halt| halt == Halt::Stopped(Stop::Finished)), "round {round}");
        let helped = Expression::parse(session.module(), 0, "output 5").expect("an output");
        assert_eq!(session.look(|look| helped.value(look)), Value::Bool(true), "round {round}");
        let back = session.go(Reverse, Walk::Continue);
        assert_eq!(back, Halt::Stopped(Stop::AtStart), "round {round}");
    }
}
