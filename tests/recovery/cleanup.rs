//! What follows when a run cannot go on: what the error says, and the cleanup, unless the arm is
//! held.

use super::*;

/// What a fault in a program with a cleanup is followed by.
const CLEANED_UP: &str = "
error halted {
  on stopped short
  recover by reversing escalating up to 4 actions
  give up after 3 times
  otherwise using help
  then return to action
}
sequence help { set 5 high }
sequence main { set 2 high  move 10 mm up  move 20 mm up }
cleanup { set 6 high  move 5 mm down  set 2 low }
";

/// Every motion stops short from an act on.
fn stops_short_from(case: &mut Case, act: u64) {
    for act in act..act + MOTIONS_MAX {
        case.sim.inject_as(FaultPlan { act, fraction: 0.5 }, StopKind::Short);
    }
}

#[test]
fn a_way_back_that_stays_blocked_counts_and_what_follows_follows() {
    let mut case = Case::new(CLEANED_UP, NEVER_S);
    stops_short_from(&mut case, 1);
    let run = case.run();
    assert_eq!(run.incidents[0].attempts.len(), 3, "{:?}", run.incidents[0]);
    assert_eq!(run.outcome(), Outcome::GivenUp(GiveUp::Attempts(3)));
    assert!(matches!(run.ending, Ending::Unhandled(_)), "{:?}", run.ending);
    assert!(run.sim.output(5), "otherwise using help");
    assert!(run.sim.output(6) && !run.sim.output(2), "the cleanup, to its end");
    assert!(run.is_identical);
}

#[test]
fn a_fault_that_nobody_named_is_followed_by_the_cleanup_unless_the_arm_is_held() {
    let stopped = |kind| {
        let source = CLEANED_UP.replace("on stopped short", "");
        let mut case = Case::new(&source, NEVER_S);
        case.sim.inject_as(FaultPlan { act: 2, fraction: 0.5 }, kind);
        case.run()
    };
    let run = stopped(StopKind::Short);
    assert!(matches!(run.ending, Ending::Fault { .. }), "{:?}", run.ending);
    assert!(run.sim.output(6) && !run.sim.output(2));
    assert!(run.is_identical, "going back leads through what was left");
    let held = stopped(StopKind::Protective);
    assert!(matches!(held.ending, Ending::Fault { .. }), "{:?}", held.ending);
    assert!(!held.sim.output(6) && held.sim.output(2) && held.sim.is_stopped());
    assert!(held.is_identical);
}

#[test]
fn the_cleanup_follows_whatever_the_strategy() {
    let source = program("recover by reversing 4 actions") + "cleanup { set 6 high }\n";
    for strategy in [
        Strategy::Stop,
        Strategy::Retry { times: 1 },
        Strategy::BackUp { distance_m: 0.05, times: 1 },
        Strategy::Restart { times: 1 },
    ] {
        let run = Case::new(&source, NEVER_S).with(strategy).run();
        assert!(matches!(run.ending, Ending::GivenUp { .. }), "{strategy:?}: {:?}", run.ending);
        assert!(run.sim.output(6), "{strategy:?}");
    }
}

#[test]
fn a_fault_in_the_cleanup_does_not_end_it() {
    let mut case = Case::new(CLEANED_UP, NEVER_S);
    // The acts: two outputs and three motions; the motion of the cleanup is the fifth.
    case.sim.inject_as(FaultPlan { act: 4, fraction: 0.5 }, StopKind::Short);
    let run = case.run();
    assert!(matches!(run.ending, Ending::Fault { .. }), "{:?}", run.ending);
    assert!(run.sim.output(6) && !run.sim.output(2), "{:?}", run.steps.told);
    assert_eq!(run.steps.told, ["PassedOver"]);
}

#[test]
fn an_incident_that_the_program_gave_up_in_stays_so_when_the_cleanup_begins() {
    // The incident is at the last action, and is past when the cleanup begins.
    let source =
        program("recover by reversing escalating up to 4 actions") + "cleanup { set 6 high }";
    let run = Case::new(&source, 3.5).run();
    assert_eq!((run.ending.clone(), run.outcome()), (Ending::Finished, Outcome::Recovered));
    let at = run.incidents[0].outcome.unwrap().1;
    assert!(at <= run.sim.now_s());
    let recovered = run.steps.told.iter().position(|told| told == "Recovered").unwrap();
    assert_eq!(recovered + 1, run.steps.told.len());
}
