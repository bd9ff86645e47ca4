//! Forks in the machine, by source text: whose turn it is, how an error in a branch leaves the
//! fork, and that all of it is taken back exactly.

use obverse_bytecode::{Verified, verify};
use obverse_compiler::compile;
use obverse_isa::Instr;
use obverse_testkit::logged::{Command, Logged};
use obverse_vm::{Direction, Limits, Machine, Stop};

const DECLARATIONS: &str = "
var x = 0
error dead { severity fatal }
error again { recover using note then return to sequence }
error anew { recover using note then restart program }
error noted { severity warning }
sequence note { x += 100 }
";

fn program(source: &str) -> Verified {
    let compiled = compile("test.obv", &format!("{DECLARATIONS}{source}"));
    let Some(module) = compiled.module else { panic!("{:#?}", compiled.diagnostics) };
    verify(module).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// What a run came to.
struct Run {
    /// What was commanded, in short.
    log: Vec<String>,
    /// The variable `x`.
    x: i64,
    /// The errors that are pending.
    raised: usize,
    /// The speed at the end, by identity.
    speed: u64,
    /// Where going back stopped.
    back: Stop,
}

/// Run a program to its end, and take it back step by step; each state on the way is met again.
fn run(source: &str) -> Run {
    let program = program(source);
    let mut cell = Logged::new(1);
    let mut machine = Machine::new(&program, &cell).unwrap_or_else(|errors| panic!("{errors:?}"));
    let mut way = vec![machine.digest(&cell)];
    let end = loop {
        match machine.step(Direction::Forward, &mut cell, &mut ()) {
            Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }) => way.push(machine.digest(&cell)),
            Err(stop) => break stop,
        }
    };
    assert_eq!(end, Stop::Finished);
    let log = cell.log.iter().map(short).collect();
    let state = machine.state();
    let (x, raised) = (state.globals()[0].cast_signed(), state.raised().len());
    let speed = state.settings()[0];
    let back = loop {
        assert_eq!(way.pop(), Some(machine.digest(&cell)), "in reverse");
        match machine.step(Direction::Reverse, &mut cell, &mut ()) {
            Ok(()) => {}
            Err(stop) => break stop,
        }
    };
    Run { log, x, raised, speed, back }
}

/// A run that can be taken back to its start.
fn there_and_back(source: &str) -> Run {
    let run = run(source);
    assert_eq!(run.back, Stop::AtStart);
    run
}

fn short(command: &Command) -> String {
    match command {
        Command::Execute(_) => "move".to_owned(),
        Command::Output(bit, level) => format!("{bit}{}", if *level { "+" } else { "-" }),
        Command::Wait(_) => "wait".to_owned(),
    }
}

#[test]
fn branches_take_turns_by_command() {
    let run = there_and_back(
        "sequence main {
  fork { repeat 2 times { toggle 1 } x += 1 } and { toggle 2 } and { repeat 3 times { toggle 3 } }
  toggle 4
}",
    );
    assert_eq!(run.log, ["1+", "2+", "3+", "1-", "3-", "3+", "4+"]);
    assert_eq!(run.x, 1);
}

#[test]
fn an_error_ends_the_program_with_the_others_held() {
    let run = there_and_back(
        "sequence main {
  fork { repeat 4 times { toggle 1 } } and { toggle 2 toggle 2 throw dead } toggle 3
}",
    );
    // Raised in the third turn of its branch.
    assert_eq!(run.log, ["1+", "2+", "1-", "2-", "1+"]);
    assert_eq!(run.raised, 1);
}

#[test]
fn an_error_deep_in_calls_leaves_too() {
    let run = there_and_back(
        "action deep { toggle 2 if x == 0 { throw dead } }
action outer { call deep toggle 2 }
action other { repeat 3 times { toggle 1 wait 1 s } }
sequence work { fork { call other } and { call outer } toggle 3 }
sequence main { call work toggle 4 }",
    );
    assert_eq!(run.log, ["1+", "2+", "wait"]);
    assert_eq!(run.raised, 1);
}

#[test]
fn an_error_that_is_noted_leaves_nothing() {
    let run = there_and_back(
        "sequence main {
  fork { toggle 1 toggle 1 } and { toggle 2 throw noted toggle 2 } toggle 3
}",
    );
    assert_eq!(run.log, ["1+", "2+", "1-", "2-", "3+"]);
    assert_eq!(run.raised, 0);
}

#[test]
fn the_sequence_begins_again_with_all_branches() {
    let run = there_and_back(
        "sequence main {
  fork { toggle 1 toggle 1 } and { if x == 0 { throw again } toggle 2 } toggle 3
}",
    );
    assert_eq!(run.log, ["1+", "1-", "2+", "1+", "3+"]);
    assert_eq!((run.x, run.raised), (100, 0));
}

#[test]
fn the_program_begins_again_from_a_nested_fork() {
    let run = there_and_back(
        "sequence main {
  fork { toggle 1 toggle 1 } and {
    fork { toggle 2 } and { toggle 3 throw anew }
  }
  toggle 4
}",
    );
    // Three times more, and then it is given up.
    let round = ["1+", "2+", "3+", "1-", "2-", "3-"];
    assert_eq!(run.log, [round, round].concat());
    assert_eq!(run.raised, 1);
}

#[test]
fn settings_of_held_branches_are_put_right() {
    let normal = there_and_back("sequence main { toggle 1 }").speed;
    for held in ["call work", "speed fast { move 1 mm up move 1 mm up }"] {
        let run = there_and_back(&format!(
            "action work {{ speed very fast move 1 mm up move 1 mm up }}
sequence main {{
  fork {{ {held} }} and {{ toggle 2 if x == 0 {{ throw again }} }}
  call work
}}"
        ));
        // The sequence has begun again, and so would have kept the speed that it found.
        assert_eq!((run.speed, run.x), (normal, 100), "{held}");
    }
}

#[test]
fn what_a_held_branch_cannot_take_back_stops_the_way_back() {
    let run = run("sequence main {
  fork { irreversible \"welded\" { toggle 1 toggle 1 } } and { toggle 2 throw dead }
}");
    assert_eq!(run.log, ["1+", "2+", "1-"]);
    let Stop::Refused(_) = run.back else { panic!("{:?}", run.back) };
}

#[test]
fn a_run_at_once_is_the_same_as_its_steps() {
    let source = "action count { repeat 3 times { toggle 1 x += 1 } }
sequence main { repeat 2 times { fork { call count } and { repeat 2 times { toggle 2 } } } }";
    let stepped = there_and_back(source);
    let program = program(source);
    assert!(program.module().code.iter().any(|instr| matches!(instr, Instr::Fork { .. })));
    let mut cell = Logged::new(1);
    let mut machine = Machine::new(&program, &cell).unwrap_or_else(|errors| panic!("{errors:?}"));
    let start = machine.digest(&cell);
    assert_eq!(machine.run(Direction::Forward, Limits::NONE, &mut cell, &mut ()), Stop::Finished);
    assert_eq!(cell.log.iter().map(short).collect::<Vec<_>>(), stepped.log);
    assert_eq!(machine.run(Direction::Reverse, Limits::NONE, &mut cell, &mut ()), Stop::AtStart);
    assert_eq!(machine.digest(&cell), start);
}
