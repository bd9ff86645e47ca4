//! What is said of ordinary programs, with errors of every response, is neither more nor less than
//! what runs meet: every horizon of a point that runs come to is where going back from there ends
//! in one of them.

use obverse_isa::Instr;
use obverse_reach::{Horizon, Reach};
use obverse_testkit::reach_laws::met_and_said_of;
use obverse_testkit::reach_programs::ERRORS;

/// How many runs each program gets: the cell answers otherwise in each.
const RUNS: u64 = 200;

#[track_caller]
fn exact(source: &str) {
    let source = format!("{ERRORS}{source}");
    let (met, said) = met_and_said_of(&source, RUNS);
    let unmet: Vec<_> = said.difference(&met).collect();
    assert!(met.is_subset(&said) && !met.is_empty());
    assert!(unmet.is_empty(), "said, and never met: {unmet:?}\n{source}");
}

/// Where going back from behind a fork may end: from before `toggle 3`.
#[track_caller]
fn behind(fork: &str, expected: &[&str]) {
    let source = format!("{ERRORS}sequence main {{ toggle 0 {fork} toggle 3 }}");
    // In what order branches take their turns is not followed: so not everything is met.
    let (met, said) = met_and_said_of(&source, RUNS);
    assert!(met.is_subset(&said) && !met.is_empty());
    let module = obverse_compiler::compile("fork.obv", &source).module.expect("a module");
    let is_it = |instr: &Instr| matches!(instr, Instr::OutputToggle { bit, .. } if bit.0 == 3);
    let at = module.code.iter().position(is_it).expect("what is behind the fork") as u32;
    let reach = Reach::of(&module);
    let ends: Vec<&str> = reach
        .at(at)
        .horizons
        .iter()
        .map(|end| match *end {
            Horizon::Start => "start",
            Horizon::Never(pc) => reach.reason(pc),
        })
        .collect();
    assert_eq!(ends, expected, "{source}");
}

#[test]
fn a_fork_that_an_error_leaves_is_not_gone_on_behind() {
    behind(
        r#"fork { toggle 1 wait 1 s barrier "glued" wait 1 s }
        and { wait 2 s wait 2 s if input 3 { throw dead } }"#,
        &["glued"],
    );
    behind(
        r#"fork { toggle 1 wait 1 s irreversible "x" { toggle 4 } wait 1 s }
        and { wait 2 s wait until input 3 high for up to 1 s else { throw dead } }"#,
        &["x"],
    );
    behind(
        r#"fork { if input 3 { throw dead } barrier "glued" wait 1 s } and { wait 1 s }"#,
        &["glued"],
    );
    behind(
        r#"fork {
          if input 3 { throw again } if input 4 { throw anew } if input 5 { throw dead }
          barrier "glued"
          wait 1 s
        } and { wait 1 s }"#,
        &["glued"],
    );
}

#[test]
fn behind_a_branch_that_is_always_left_there_is_no_way_on() {
    let source = format!("{ERRORS}sequence main {{ fork {{ throw dead }} and {{ wait 1 s }} }}");
    let (met, said) = met_and_said_of(&source, 1);
    assert!(met.is_subset(&said) && !met.is_empty());
}

#[test]
fn a_fork_within_a_branch_is_left_with_it() {
    behind(
        r#"fork {
          fork { if input 1 { throw dead } toggle 1 } and { wait 1 s }
          barrier "glued"
          wait 1 s
        } and { wait 1 s }"#,
        &["glued"],
    );
}

#[test]
fn a_fork_within_what_is_skipped_in_reverse_is_left_with_it() {
    behind(
        r#"skip in reverse { fork { if input 1 { throw dead } toggle 1 } and { wait 1 s } }
        barrier "glued""#,
        &["glued"],
    );
}

#[test]
fn a_fork_that_is_left_leads_to_the_start_of_the_program() {
    exact(
        r#"sequence main {
          toggle 0
          fork { toggle 1 if input 1 { throw anew } toggle 2 } and { wait 1 s wait 1 s }
          barrier "the end"
          toggle 3
        }"#,
    );
}

#[test]
fn the_end_of_the_program_is_not_before_its_beginning() {
    exact(
        r#"sequence work { if input 4 { throw again } toggle 5 }
        sequence main {
          toggle 0
          call work
          call work
          if input 3 { throw anew }
          barrier "the end"
          toggle 3
        }"#,
    );
}

/// A program that stops does not begin again, although both errors leave all sequences.
#[test]
fn what_stops_the_program_is_not_before_its_beginning() {
    exact(
        r#"sequence work { if input 4 { throw anew } toggle 5 }
        sequence main {
          toggle 0
          call work
          barrier "half"
          if input 3 { throw dead }
          toggle 1
        }"#,
    );
}

#[test]
fn flags_of_the_program_do_not_come_before_those_of_its_errors() {
    exact(
        r#"var done = false
        sequence work { if input 4 { throw dead } barrier "worked" }
        sequence main {
          toggle 0
          call work
          if done { toggle 1 } if done { toggle 1 } if done { toggle 1 }
          if input 2 { done = true }
          if done { toggle 2 } if done { toggle 1 } if done { toggle 1 }
        }"#,
    );
}

#[test]
fn what_is_begun_again_comes_after_its_recovery() {
    exact(
        r#"sequence work { toggle 1 if input 4 { throw again } barrier "worked" }
        sequence main { toggle 0 call work if input 5 { throw on } toggle 3 }"#,
    );
    exact(
        r#"sequence work { toggle 1 if input 4 { throw late } barrier "worked" toggle 2 }
        sequence main { toggle 0 call work toggle 3 if input 3 { throw anew } }"#,
    );
}

/// The last barrier of a program is not behind its first line.
#[test]
fn the_first_line_goes_back_to_the_start_alone() {
    let source = format!(
        r#"{ERRORS}sequence main {{
          toggle 0
          if input 3 {{ throw again }}
          if input 4 {{ throw anew }}
          barrier "the end"
        }}"#
    );
    let module = obverse_compiler::compile("first.obv", &source).module.expect("a module");
    let main = module.functions.iter().find(|function| function.name == "main").expect("main");
    let is_toggle = |pc: &u32| matches!(module.code[*pc as usize], Instr::OutputToggle { .. });
    let first = (main.first..main.end).find(is_toggle).expect("a line that does something");
    assert_eq!(Reach::of(&module).at(first).horizons, [Horizon::Start]);
}
