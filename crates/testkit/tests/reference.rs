//! The reference interpreter on programs whose outcome is known.

use obverse_testkit::logged::{Command, Logged};
use obverse_testkit::reference::{Ending, Limits, Outcome, Trap, run};
use obverse_workcell::{Goal, Speed};

fn run_in(source: &str, cell: &mut Logged, limits: Limits) -> Outcome {
    let parsed = obverse_syntax::parse(source);
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
    run(&parsed.program, cell, limits)
}

fn outcome(source: &str) -> Outcome {
    run_in(source, &mut Logged::new(1), Limits::default())
}

fn int(outcome: &Outcome, name: &str) -> i64 {
    let globals = &outcome.last.globals;
    let found = globals.iter().find(|(global, _)| global == name);
    found.expect("a variable of this name").1.cast_signed()
}

/// The value of `x` after these statements.
fn after(statements: &str) -> i64 {
    let outcome = outcome(&format!("var x = 0\nsequence main {{ {statements} }}"));
    assert_eq!(outcome.ending, Ending::Finished);
    int(&outcome, "x")
}

#[test]
fn statements_do_what_they_say() {
    assert_eq!(after("x = 7 x -= 2 x += x"), 10);
    assert_eq!(after("if x == 0 { x = 1 } else { x = 2 }"), 1);
    assert_eq!(after("while x < 5 { x += 2 }"), 6);
    assert_eq!(after("for i from 3 to 5 { x += i }"), 12);
    assert_eq!(after("for i from 5 to 3 { x += i }"), 0);
    assert_eq!(after("for i from 5 down to 3 { x = x * 10 + i }"), 543);
    assert_eq!(after("for i from 3 down to 5 { x += i }"), 0);
    assert_eq!(after("for i from 9223372036854775806 to 9223372036854775807 { x += 1 }"), 2);
    assert_eq!(after("repeat 4 times { x += 1 if x == 3 { break } }"), 3);
    assert_eq!(after("loop { x += 1 if x == 3 { return } } x = 9"), 3);
    assert_eq!(after("repeat 2 times { var y = 5 y += 1 x += y }"), 12);
    assert_eq!(after("var y = 1 fork { x += 1 } and { y += 1 } and { wait 1 s } x += y"), 3);
    assert_eq!(after("skip in reverse { x += 1 } do { x += 10 } in reverse { x = 0 }"), 11);
    assert_eq!(after("if true { var n = 2 x = n } ending when x == 2"), 2);
}

#[test]
fn the_state_is_kept_before_every_statement() {
    let outcome = outcome("var x = 1\nsequence main { x += 1 if x == 2 { var y = x } x = 5 }");
    let kept: Vec<u64> = outcome.history.iter().map(|copy| copy.globals[0].1).collect();
    assert_eq!(kept, [1, 2, 2, 2]);
    assert!(outcome.history[2].locals.is_empty());
    assert_eq!(outcome.history[3].locals["y"], 2);
    assert!(outcome.history.iter().all(|copy| copy.calls == 2 && copy.function == "main"));
    assert_eq!(int(&outcome, "x"), 5);
}

#[test]
fn a_trap_leaves_its_statement_undone() {
    let outcome = outcome("var x = 1\nsequence main { var z = 0 x = 2 x = 1 / z x = 3 }");
    assert_eq!(outcome.ending, Ending::Trap(Trap::Arithmetic));
    assert_eq!(int(&outcome, "x"), 2);
    assert_eq!(outcome.history.len(), 3);
}

#[test]
fn assertions_hold_in_both_ways() {
    let ending =
        |statement: &str| outcome(&format!("var x = 0\nsequence main {{ {statement} }}")).ending;
    assert_eq!(ending("if x == 0 { x = 1 } ending when x == 1"), Ending::Finished);
    let wrong = Ending::Trap(Trap::Assertion);
    assert_eq!(ending("if x == 0 { x = 1 } ending when x == 0"), wrong);
    assert_eq!(ending("if x == 1 { x = 2 } ending when x == 0"), wrong);
    assert_eq!(ending("while x < 2 entered when x == 0 { x += 1 }"), Ending::Finished);
    assert_eq!(ending("while x < 2 entered when x == 1 { x += 1 }"), wrong);
    assert_eq!(ending("while x < 2 entered when x < 2 { x += 1 }"), wrong);
}

#[test]
fn recursion_ends_at_the_limit_of_calls() {
    let source = "var x = 0\nsequence f { x += 1 call f }\nsequence main { call f }";
    let run = move || run_in(source, &mut Logged::new(1), Limits::default());
    let thread = std::thread::Builder::new().stack_size(256 << 20).spawn(run);
    let outcome = thread.expect("a thread").join().expect("no overflow");
    assert_eq!(outcome.ending, Ending::Trap(Trap::CallDepth));
    // The start and main are calls too.
    assert_eq!(int(&outcome, "x"), 1022);
    let few = Limits { calls: 10, ..Limits::default() };
    assert_eq!(run_in(source, &mut Logged::new(1), few).ending, Ending::Limit);
}

#[test]
fn an_endless_program_meets_the_limit_of_steps() {
    assert_eq!(outcome("sequence main { loop { } }").ending, Ending::Limit);
}

#[test]
fn outputs_settle_and_settings_end_with_their_scope() {
    let source = "
joints there = [1, 2, 3, 4, 5, 6] rad
io grip { set 1 high sleep 100 ms sleep 50 ms }
sequence slowly { speed slow move to there }
sequence main { io grip call slowly move to there speed fast { move to there } toggle 1 }";
    let mut cell = Logged::new(1);
    assert_eq!(run_in(source, &mut cell, Limits::default()).ending, Ending::Finished);
    let seen: Vec<String> = cell.log.iter().map(short).collect();
    assert_eq!(
        seen,
        ["output 1 true", "wait 0.15", "move Slow", "move Normal", "move Fast", "output 1 false"]
    );
}

fn short(command: &Command) -> String {
    match command {
        Command::Execute(motion) => {
            assert!(matches!(motion.goal, Goal::Joints(_)));
            assert!(Speed::ALL.contains(&motion.speed));
            format!("move {:?}", motion.speed)
        }
        Command::Output(bit, level) => format!("output {bit} {level}"),
        Command::Wait(seconds) => format!("wait {seconds:.2}"),
    }
}

#[test]
fn errors_are_responded_to_as_they_say() {
    let with = |clauses: &str| {
        outcome(&format!(
            "var x = 0
error e {{ {clauses} }}
sequence mend {{ x += 100 }}
sequence work {{ x += 1 if x != 203 {{ throw e }} x += 1000 }}
sequence main {{ call work x += 10000 }}"
        ))
    };
    // Noted; mended and gone on with; done again until it is given up; stopped.
    assert_eq!(int(&with("severity warning"), "x"), 11001);
    assert_eq!(int(&with("recover using mend then continue"), "x"), 11101);
    assert_eq!(int(&with("recover using mend"), "x"), 11203);
    let stopped = with("severity fatal");
    assert_eq!((int(&stopped, "x"), stopped.last.raised.as_slice()), (1, &["e".to_owned()][..]));
    // After the sequence: the rest of it is done first, and then all of it again.
    let after = with("recover using mend respond after current sequence then return to action");
    assert_eq!(int(&after, "x"), 4304);
    assert_eq!(after.last.raised, ["e"]);
    // The program begins again, and so do its variables.
    let restarted = with("recover using mend then restart program");
    assert_eq!((int(&restarted, "x"), restarted.last.raised.len()), (101, 1));
}

#[test]
fn an_advanced_move_is_judged_by_how_far_it_came() {
    let source = |condition: &str| {
        format!(
            "error e {{ severity fatal }}
advanced move push {{ distance 300 mm x stop if force > 5 N succeeds if {condition}
  on failure {{ return to initial position repeat with perturbation 2 times throw e }} }}
sequence main {{ advance push }}"
        )
    };
    let good = outcome(&source("distance > 100 mm"));
    assert!(good.last.raised.is_empty());
    assert_eq!(good.last.draws, 0);
    let bad = outcome(&source("distance > 400 mm"));
    assert_eq!(bad.last.raised, ["e"]);
    assert_eq!(bad.last.draws, 4, "two a repetition");
    assert_eq!(bad.last.joints, bad.history[0].joints);
}

#[test]
fn parameters_are_given_by_name_and_by_default_and_lie_in_their_ranges() {
    let after_call = |call: &str| {
        let action = "action a(n: int in 1 to 5 = 3, m: int = 10) { x = n * m }";
        outcome(&format!("var x = 0\n{action}\nsequence main {{ var z = 7 {call} }}"))
    };
    for (call, x) in [("call a", 30), ("call a(m: 2, n: 1)", 2), ("call a(5, m: 1)", 5)] {
        let outcome = after_call(call);
        assert_eq!((int(&outcome, "x"), outcome.ending), (x, Ending::Finished), "{call}");
    }
    for call in ["call a(z)", "call a(n: z - 7)"] {
        assert_eq!(after_call(call).ending, Ending::Trap(Trap::Required), "{call}");
    }
}
