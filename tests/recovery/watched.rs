//! What is watched while a program acts: an error that responds at once cuts the act at hand, and
//! the others let it, or its sequence, come to an end.

use super::*;
use obverse_geometry::JointConfiguration;
use obverse_vm::{Pending, Stop};

/// When input 0 comes high in every act below, in seconds.
const HIGH_AT_S: f64 = 0.1;

fn watching(clauses: &str, act: &str) -> String {
    format!(
        "error opened {{ on input 0 high  {clauses} }}
        advanced move feel {{
          distance 40 mm up in tcp
          stop if force > 5 N
          on success {{ return to initial position }}
          on failure {{ return to initial position }}
        }}
        joints there = [0.3, -1.4, 1.5, -1.6, -1.5, 0.2] rad
        io settle {{ set 4 high  sleep 0.5 s }}
        sequence help {{ toggle 5 }}
        sequence main {{ set 1 high  set 2 high  {act} }}"
    )
}

const ACTS: [&str; 7] = [
    "move to there",
    "move 40 mm up",
    "move to there linearly",
    "advance feel",
    "wait 0.5 s",
    "io settle",
    "wait until input 1 high for up to 0.5 s",
];

#[test]
fn every_act_is_cut_where_the_condition_comes_to_hold_and_taken_back_from_there() {
    for act in ACTS {
        let policy = "respond at once  recover by reversing 1 action  then return to action";
        let run = Case::new(&watching(policy, act), HIGH_AT_S).run();
        assert_eq!(run.ending, Ending::Finished, "{act}");
        assert_eq!(run.steps.told, ["Fault", "Back", "Again", "Recovered"], "{act}");
        assert_eq!((run.incidents[0].began_s, run.depths()), (HIGH_AT_S, vec![1]), "{act}");
        assert!(run.is_identical, "{act}");
        let again = Case::new(&watching(policy, act), HIGH_AT_S).run();
        assert_eq!(again.sim.now_s(), run.sim.now_s(), "{act}: the same run");
    }
}

#[test]
fn the_machine_holds_the_act_half_done_and_can_go_either_way() {
    for act in &ACTS[..2] {
        let program = verify(module(&watching("respond at once", act))).unwrap();
        let mut cut = Sim::new(&cell(HIGH_AT_S), 0);
        let mut machine = Machine::new(&program, &cut).unwrap();
        let start = (machine.digest(&cut), cut.joints());
        let stop = machine.run(Direction::Forward, Limits::NONE, &mut cut, &mut ());
        assert!(
            matches!(stop, Stop::Fault { fault: Fault::Watched { .. }, .. }),
            "{act}: {stop:?}"
        );
        let pending = machine.state().pending();
        assert!(matches!(pending, Some(Pending { direction: Direction::Forward, .. })), "{act}");
        assert!(!cut.joints().same_bits(&start.1), "{act}: on its way");
        // Forward anew, it comes to where it would have come.
        let (mut forward, mut sim) = (machine.clone(), cut.clone());
        assert_eq!(
            forward.run(Direction::Forward, Limits::NONE, &mut sim, &mut ()),
            Stop::Finished
        );
        let mut undisturbed = Sim::new(&cell(NEVER_S), 0);
        let mut other = Machine::new(&program, &undisturbed).unwrap();
        other.run(Direction::Forward, Limits::NONE, &mut undisturbed, &mut ());
        assert_eq!(forward.digest(&sim), other.digest(&undisturbed), "{act}");
        // In reverse, to the start.
        let stop = machine.run(Direction::Reverse, Limits::NONE, &mut cut, &mut ());
        assert_eq!((stop, machine.digest(&cut)), (Stop::AtStart, start.0), "{act}");
    }
}

#[test]
fn after_the_action_and_after_the_sequence_let_what_is_under_way_come_to_its_end() {
    let source = "
        error opened { on input 0 high  respond WHEN  recover using help  then continue }
        sequence help { toggle 5 }
        sequence main { move 40 mm up  call more  set 2 high }
        sequence more { move 10 mm up  move 10 mm up }
    ";
    // In the middle of the first motion of the sequence that is called.
    let first_s = {
        let run = Case::new(&source.replace("WHEN", "at once"), NEVER_S).run();
        run.sim.last_motion().duration_s
    };
    let end_s = Case::new(&source.replace("WHEN", "at once"), NEVER_S).run().sim.now_s();
    let at_s = end_s - 1.5 * first_s;
    let began = |when: &str| {
        let run = Case::new(&source.replace("WHEN", when), at_s).run();
        assert_eq!((run.ending, run.is_identical), (Ending::Finished, true), "{when}");
        assert!(run.sim.output(5) && run.sim.output(2), "{when}");
        (run.incidents[0].began_s, run.sim.joints())
    };
    let undisturbed = Case::new(&source.replace("WHEN", "at once"), NEVER_S).run().sim.joints();
    let (at_once_s, cut) = began("at once");
    assert_eq!(at_once_s, at_s);
    assert!(!cut.same_bits(&undisturbed), "the next action follows where the arm was cut short");
    let (action_s, joints) = began("after current action");
    assert!((action_s - (end_s - first_s)).abs() < 1e-9, "{action_s}");
    assert!(joints.same_bits(&undisturbed));
    let (sequence_s, joints) = began("after current sequence");
    assert!((sequence_s - end_s).abs() < 1e-9, "{sequence_s}");
    assert!(joints.same_bits(&undisturbed));
}

#[test]
fn an_advanced_move_is_an_action_and_returns_before_a_response_after_it() {
    let joints = |respond: &str| {
        let policy = format!("{respond}  recover using help  then continue");
        let run = Case::new(&watching(&policy, "advance feel"), HIGH_AT_S).run();
        assert_eq!((&run.ending, run.incidents.len()), (&Ending::Finished, 1));
        run.sim.joints()
    };
    let home = Sim::new(&cell(NEVER_S), 0).joints();
    let far = |joints: JointConfiguration| joints.largest_difference_rad(&home) > 1e-6;
    assert!(far(joints("respond at once")), "it ends where it is cut");
    assert!(!far(joints("respond after current action")), "it returns to where it began");
}

#[test]
fn a_warning_stops_nothing_and_a_fatal_error_ends_the_program_on_the_way() {
    let warned = watching("severity warning  respond at once", "move 40 mm up  set 6 high");
    let run = Case::new(&warned, HIGH_AT_S).run();
    let undisturbed = Case::new(&warned, NEVER_S).run();
    assert_eq!(run.ending, Ending::Finished);
    assert!(run.sim.joints().same_bits(&undisturbed.sim.joints()) && run.sim.output(6));
    let fatal = watching("severity fatal  respond at once", "move 40 mm up  set 6 high");
    let run = Case::new(&fatal, HIGH_AT_S).run();
    assert!(matches!(run.ending, Ending::Unhandled(_)), "{:?}", run.ending);
    assert_eq!((run.sim.now_s(), run.sim.output(6)), (HIGH_AT_S, false));
    assert!(run.is_identical);
}

#[test]
fn nothing_is_cut_in_reverse_or_in_the_cleanup() {
    // Low at the start, the input comes high while the wait is taken back.
    let source = "
        error opened { on input 0 high  respond at once  then stop }
        error late { recover by reversing 2 actions  give up after 1 times  otherwise stop }
        sequence main { move 100 mm up  if not input 1 { throw late } }
        cleanup { move 100 mm up  set 6 high }
    ";
    let forward_s = Case::new(source, NEVER_S).with(Strategy::Explicit).run();
    let up_s = 0.5 * forward_s.sim.now_s();
    let back = Case::new(source, 1.5 * up_s).run();
    assert_eq!(back.steps.told[0], "Back");
    assert!(!back.steps.told.contains(&"Blocked".to_owned()), "{:?}", back.steps.told);
    // What came to hold meanwhile is told where the way forward begins again.
    assert_eq!(back.steps.told[2], "Fault", "{:?}", back.steps.told);
    let cleanup = Case::new(source, 3.5 * up_s).run();
    assert!(!cleanup.steps.told.contains(&"PassedOver".to_owned()), "{:?}", cleanup.steps.told);
    assert!(cleanup.sim.output(6));
}

#[test]
fn a_stop_at_any_act_of_such_a_run_leaves_a_way_back_to_the_start() {
    let policy = "respond at once  recover by reversing 2 actions  then return to action";
    let source = watching(policy, "move 40 mm up  move to there  wait 0.5 s");
    let acts = Case::new(&source, 0.4).run().sim.acts_begun();
    for act in 0..acts {
        for fraction in [0.0, 0.5, 1.0] {
            let mut case = Case::new(&source, 0.4);
            case.module.errors[0].faults = vec![FaultName::ProtectiveStop];
            case.sim.inject(FaultPlan { act, fraction });
            case.releases = 9;
            let run = case.run();
            assert_eq!(run.ending, Ending::Finished, "act {act} at {fraction}");
            assert!(run.is_identical, "act {act} at {fraction}");
        }
    }
}

#[test]
fn in_a_fork_it_is_answered_in_the_branch_whose_turn_it_is() {
    let source = "
        error opened { on input 0 high  respond at once  recover by reversing 1 action }
        sequence main {
          fork { move 40 mm up  move 40 mm down } and { set 3 high  wait 0.2 s  set 4 high }
        }
    ";
    for tenth in 1..11 {
        let run = Case::new(source, 0.1 * f64::from(tenth)).run();
        assert_eq!(run.ending, Ending::Finished, "{tenth}");
        assert!(run.is_identical, "{tenth}");
        // Acts are watched at every instant of the branches' time.
        let began_s: Vec<f64> = run.incidents.iter().map(|incident| incident.began_s).collect();
        assert_eq!(began_s, [0.1 * f64::from(tenth)]);
    }
}

#[test]
fn what_another_error_takes_back_is_noticed_again_if_it_holds_still() {
    // `seen` is pending when `late` leads back over where it was noticed.
    let source = "
        error seen { on input 0 high  respond after current sequence  recover using help
                     then continue }
        error late { recover by reversing 1 action  then return to action }
        sequence help { set 7 high }
        sequence main { call inner  wait 1 s }
        sequence inner { wait 1 s  if not input 1 { throw late }  move 5 mm up }
    ";
    let with_input_0 = |changes: &[(f64, bool)]| {
        let mut case = Case::new(source, NEVER_S);
        let mut cell = Cell::bare();
        cell.inputs[0] = InputRule::At(changes.to_vec());
        cell.inputs[1] = InputRule::At(vec![(1.9, true)]);
        case.sim = Sim::new(&cell, 0);
        case.run()
    };
    let holds = with_input_0(&[(0.5, true)]);
    assert_eq!(holds.ending, Ending::Finished);
    assert_eq!(holds.steps.told, ["Fault", "Back", "Again", "Fault", "Recovered", "GivenUp"]);
    assert!(holds.sim.output(7) && holds.is_identical);
    // It has ceased to hold by the time the run goes forward again.
    let ceased = with_input_0(&[(0.5, true), (1.0, false)]);
    assert_eq!(ceased.steps.told, ["Fault", "Back", "Again", "Recovered"]);
    assert!(!ceased.sim.output(7));
}

#[test]
fn what_was_noticed_before_is_not_taken_for_an_error_of_another_recovery() {
    for policy in [
        "recover using other",
        "recover by reversing 1 action  give up after 1 times  otherwise using other",
    ] {
        let source = format!(
            "error seen {{ on input 0 high  respond after current sequence  recover using help
                          then continue }}
            error late {{ {policy}  then continue }}
            sequence help {{ set 7 high }}
            sequence other {{ move 5 mm up  set 6 high }}
            sequence main {{ call inner  wait 1 s }}
            sequence inner {{ wait 1 s  if not input 1 {{ throw late }}  set 5 high }}"
        );
        let run = Case::new(&source, 0.5).run();
        assert_eq!(run.ending, Ending::Finished, "{policy}");
        for output in [5, 6, 7] {
            assert!(run.sim.output(output), "{policy}: output {output}");
        }
        assert!(run.is_identical, "{policy}");
    }
}

#[test]
fn how_far_a_wait_for_an_input_was_is_said_of_all_of_it() {
    for (respond, expected) in [("at once", 0.25), ("after current action", 0.25)] {
        let source = format!(
            "error seen {{ on input 0 high  respond {respond}  then stop }}
            sequence main {{ wait until input 1 high for up to 2 s else {{ }} }}"
        );
        let program = verify(module(&source)).unwrap();
        let mut sim = Sim::new(&cell(0.5), 0);
        let mut machine = Machine::new(&program, &sim).unwrap();
        let stop = machine.run(Direction::Forward, Limits::NONE, &mut sim, &mut ());
        let Stop::Fault { fault: Fault::Watched { fraction, .. }, .. } = stop else {
            panic!("{respond}: {stop:?}")
        };
        assert!((fraction - expected).abs() < 0.01, "{respond}: {fraction}");
    }
}
