//! The last change of something in runs that are long enough for the machine to run through them
//! by itself: what is found is what going through all of it, step by step, finds.

use obverse_bytecode::{Verified, verify};
use obverse_compiler::compile;
use obverse_debugger::drive::Pace;
use obverse_debugger::recording::{Moment, Order};
use obverse_debugger::rewound::Halted;
use obverse_debugger::{Change, Declined, Expression, Halt, Run, Session, Value, Walk};
use obverse_testkit::Ledger;
use obverse_vm::{Direction, Stop};
use std::sync::atomic::{AtomicBool, Ordering};

const PROGRAM: &str = "\
var sum = 0
var calls = 0
sequence add(by: int) {
  var twice = by + by
  sum += twice
  calls += 1
}
sequence main {
  for round from 1 to 40 {
    var left = round
    while left > 0 {
      call add(left)
      left -= 1
    }
    if round mod 8 == 0 { set 2 high } else { set 2 low }
    if round mod 9 == 0 { sum = 0 }
  }
}
";

const ASKED: [&str; 15] = [
    "sum",
    "sum == 12",
    "sum == 0",
    "sum > 400 and output 2",
    "left == 3",
    "twice",
    "twice > 70",
    "calls == 300",
    "steps > 5000",
    "steps - calls * 10 > 1000",
    "steps < 9000 and left == 2",
    "steps / 1000 == left",
    "round",
    "round == 17 and left > 3",
    "sum == 1 and steps > 3",
];

fn program() -> Verified {
    let compiled = compile("p.obv", PROGRAM);
    let wrong = || panic!("{:?}", compiled.diagnostics);
    verify(compiled.module.unwrap_or_else(wrong)).expect("it verifies")
}

/// Its name means something in one of the two.
fn expression(program: &Verified, text: &str) -> Expression {
    let module = program.module();
    let of = |name: &str| module.functions.iter().position(|it| it.name == name).expect(name);
    let found = Expression::parse(module, of("main"), text);
    found.or_else(|_| Expression::parse(module, of("add"), text)).expect(text)
}

/// Forward to the end, back for a while, and forward again.
fn there_and_back(program: &Verified) -> Run<'_, Ledger> {
    let mut run = Run::new(program, Ledger::new(1)).expect("it links");
    for (order, most) in
        [(Order::Forward, u64::MAX), (Order::Reverse, 2_000), (Order::Forward, u64::MAX)]
    {
        let until = run.recording().end.after(most);
        while run.recording().end < until {
            let left = until.0 - run.recording().end.0;
            let driven = run.drive(order, Pace::Run(left), &mut ()).expect("it is live");
            if driven.stop.is_some() {
                break;
            }
        }
    }
    run
}

/// The value at every moment.
fn all(run: &Run<'_, Ledger>, expression: &Expression) -> Vec<(Moment, Value)> {
    let mut shown = run.rewound();
    shown.go_to(run.recording(), run.timeline(), Moment(0));
    let mut all = Vec::new();
    loop {
        let value = shown.look(run.recording(), |look| expression.value(look));
        all.push((shown.moment(), value));
        if shown.walk_on(run.recording(), run.recording().end, None) == Halted::There {
            let value = shown.look(run.recording(), |look| expression.value(look));
            all.push((shown.moment(), value));
            return all;
        }
    }
}

#[test]
fn the_last_changes_are_those_that_going_through_all_of_it_finds() {
    let program = program();
    for text in ASKED {
        let expression = expression(&program, text);
        let run = there_and_back(&program);
        let all = all(&run, &expression);
        assert!(all.len() > 12_000, "{} moments", all.len());
        let pairs = all.windows(2).rev();
        let mut expected = pairs.filter(|pair| pair[0].1 != pair[1].1).map(|pair| Change {
            moment: pair[0].0,
            before: pair[0].1.clone(),
            after: pair[1].1.clone(),
        });
        let mut session = Session::over(run);
        for _ in 0..12 {
            let found = session.go_to_last_change(&expression);
            assert_eq!(found.ok(), expected.next(), "{text}");
        }
    }
}

#[test]
fn a_search_that_takes_long_can_be_interrupted() {
    let source = "var x = 0\nsequence main { while x >= 0 { x += 1 } }\n";
    let compiled = compile("p.obv", source);
    let program = verify(compiled.module.expect("it compiles")).expect("it verifies");
    let mut session = Session::over(Run::new(&program, Ledger::new(1)).expect("it links"));
    session.limit(3 << 20);
    assert_eq!(session.go(Direction::Forward, Walk::Continue), Halt::Limit);
    let moment = session.moment();
    let (interrupt, is_over) = (session.interrupter(), AtomicBool::new(false));
    let never = expression(&program, "x == -5");
    // Who interrupts may be late, and is not waited for: asked again and again, it comes to it.
    const TIMES: usize = 2_000;
    let is_interrupted = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_over.load(Ordering::Relaxed) {
                interrupt.store(true, Ordering::Relaxed);
            }
        });
        let mut search = || session.go_to_last_change(&never) == Err(Declined::Interrupted);
        let search = (0..TIMES).any(|_| search());
        let mut back = || {
            let is_there = session.go_to(Moment(moment.0 - 1)).is_ok();
            is_there && session.go(Direction::Reverse, Walk::Continue) == Halt::Interrupted
        };
        let back = (0..TIMES).any(|_| back());
        is_over.store(true, Ordering::Relaxed);
        [search, back]
    });
    assert_eq!(is_interrupted, [true; 2]);
    assert_eq!(session.go_to_last_change(&never), Err(Declined::NotBefore));
    session.go_to_end();
    assert_eq!(session.moment(), moment);
    let step = Walk::Step(obverse_debugger::Grain::Instruction);
    assert_ne!(session.go(Direction::Forward, step), Halt::Stopped(Stop::AtStart));
}
