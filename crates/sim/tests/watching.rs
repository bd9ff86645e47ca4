//! What is watched while the workcell acts: where an act is cut, where it is not, and what counts.

mod common;

use common::{advance, bench_cell, by_joints, by_line, push, to_pose};
use obverse_geometry::{JointConfiguration, Pose};
use obverse_sim::cell::InputRule;
use obverse_sim::{Cell, FaultPlan, Sim};
use obverse_workcell::{
    Arm, Clock, Condition, DigitalIo, Fault, ForceTorque, Motion, MotionEnd, Path, Safety, ToolId,
    Watch, Watching,
};
use std::f64::consts::PI;

/// Input 0 is high from 0.25 s to 0.5 s and from 0.75 s on; input 1 follows output 1 after 0.1 s.
fn sim() -> Sim {
    let mut cell = Cell::bare();
    cell.inputs[0] = InputRule::At(vec![(0.25, true), (0.5, false), (0.75, true)]);
    cell.inputs[1] = InputRule::FollowsOutput { output: 1, delay_s: 0.1 };
    Sim::new(&cell, 1)
}

fn over_the_table(x: f64, y: f64, z: f64) -> Pose {
    Pose::from_rotation_vector([x, y, z], [PI, 0.0, 0.0])
}

fn input(bit: u16, level: bool, stops: bool) -> Watch {
    Watch { number: 7, condition: Condition::Input { bit, level }, stops }
}

fn force(above_n: f64, stops: bool) -> Watch {
    Watch { number: 8, condition: Condition::Force { above_n }, stops }
}

fn goal(sim: &Sim) -> JointConfiguration {
    let mut goal = sim.joints();
    goal.0[0] += 0.5;
    goal
}

/// What was watched and how far the act had come, if that ended it.
fn watched<T: std::fmt::Debug>(result: Result<T, Fault>) -> (Watch, f64) {
    match result {
        Err(Fault::Watched { watch, fraction }) => (watch, fraction),
        other => panic!("{other:?}"),
    }
}

#[test]
fn every_act_is_cut_at_the_instant_at_which_an_input_changes() {
    let high = input(0, true, true);
    for path in [Path::Joint, Path::Linear] {
        let mut sim = sim();
        sim.watch(&[high]);
        let (home, goal) = (sim.joints(), goal(&sim));
        let motion = match path {
            Path::Joint => by_joints(goal),
            Path::Linear => advance(home, 0.1),
        };
        let (watch, fraction) = watched(sim.execute(&motion));
        assert_eq!((watch, sim.now_s()), (high, 0.25));
        assert!(fraction > 0.0 && fraction < 1.0);
        assert!(!sim.is_stopped(), "nothing has to be released");
        if path == Path::Joint {
            assert!(sim.joints().same_bits(&home.towards(&goal, fraction)));
        }
        // It can be finished from there, and gone back from.
        sim.watch(&[]);
        sim.execute(&by_joints(goal)).unwrap();
        sim.execute(&by_joints(home)).unwrap();
        assert!(sim.joints().same_bits(&home));
    }
    let mut guarded = sim();
    guarded.watch(&[high]);
    let home = guarded.joints();
    watched(guarded.execute(&push(home, 0.1, 5.0)));
    assert_eq!(guarded.now_s(), 0.25);
    let mut waits = sim();
    waits.watch(&[high]);
    assert_eq!(watched(waits.wait(1.0)), (high, 0.25));
    assert_eq!(waits.now_s(), 0.25);
    let mut follows = sim();
    follows.watch(&[input(1, true, true)]);
    follows.set_output(1, true).unwrap();
    watched(follows.wait(1.0));
    assert!((follows.now_s() - 0.1).abs() < 1e-12 && follows.input(1) == Ok(true));
}

#[test]
fn an_act_that_is_not_stopped_is_done_and_told_of() {
    let high = input(0, true, false);
    let mut plain = sim();
    let goal = goal(&plain);
    let report = plain.execute(&by_joints(goal)).unwrap();
    let mut sim = sim();
    sim.watch(&[high]);
    let (watch, fraction) = watched(sim.execute(&by_joints(goal)));
    assert_eq!((watch, sim.now_s(), sim.last_motion()), (high, plain.now_s(), report));
    assert!(fraction < 1.0 && sim.joints().same_bits(&goal));
}

#[test]
fn what_comes_to_hold_counts_once_until_it_has_been_seen_not_to() {
    let mut sim = sim();
    sim.watch(&[input(0, true, true)]);
    watched(sim.wait(0.3));
    assert_eq!(sim.wait(0.1), Ok(()), "it holds still");
    // Low at 0.5 s, and high again.
    watched(sim.wait(1.0));
    assert_eq!(sim.now_s(), 0.75);
}

#[test]
fn what_holds_already_counts_where_the_act_begins() {
    let mut sim = sim();
    sim.wait(0.3).unwrap();
    let low = input(1, false, true);
    sim.watch(&[low]);
    let home = sim.joints();
    assert_eq!(watched(sim.execute(&by_joints(goal(&sim)))), (low, 0.0));
    assert!(sim.joints().same_bits(&home));
    sim.execute(&by_joints(goal(&sim))).unwrap();
    // While nobody looked it has ceased to hold, and held again: that cannot be known.
    sim.watch(&[]);
    sim.set_output(1, true).unwrap();
    sim.wait(0.2).unwrap();
    sim.watch(&[low]);
    sim.wait(0.0).unwrap();
    sim.watch(&[]);
    sim.set_output(1, false).unwrap();
    sim.wait(0.2).unwrap();
    sim.watch(&[low]);
    assert_eq!(watched(sim.set_output(2, true)), (low, 0.0));
    assert!(!sim.output(2), "it was not set");
}

#[test]
fn of_two_at_once_the_first_is_told_and_the_other_in_the_next_act() {
    let mut sim = sim();
    let (first, second) = (input(0, true, true), input(0, true, false));
    sim.watch(&[first, second]);
    assert_eq!(watched(sim.wait(1.0)).0, first);
    sim.watch(&[first, second]);
    assert_eq!(watched(sim.wait(0.1)).0, second);
    assert_eq!(sim.wait(0.1), Ok(()));
}

#[test]
fn the_stop_of_an_act_that_comes_first_ends_it() {
    let begun = |fraction| {
        let mut sim = sim();
        sim.inject(FaultPlan { act: 0, fraction });
        sim.watch(&[input(0, true, true)]);
        sim.wait(1.0).unwrap_err()
    };
    assert!(matches!(begun(0.2), Fault::ProtectiveStop { .. }));
    assert!(matches!(begun(0.3), Fault::Watched { .. }));
}

#[test]
fn a_motion_is_cut_by_force_as_a_guarded_one_is() {
    let probe = ToolId(1);
    let over = |cell: &Cell| {
        let mut sim = Sim::new(cell, 1);
        let above = Motion { tool: probe, ..to_pose(over_the_table(0.4, -0.3, 0.15), Path::Joint) };
        sim.execute(&above).unwrap();
        sim
    };
    let cell = bench_cell();
    let mut guarded = over(&cell);
    let from = guarded.joints();
    let report = guarded.execute(&Motion { tool: probe, ..push(from, 0.3, 10.0) }).unwrap();
    assert_eq!(report.end, MotionEnd::StoppedByForce);

    let mut sim = over(&cell);
    sim.watch(&[force(10.0, true)]);
    let down = Motion { tool: probe, ..advance(from, 0.3) };
    assert_eq!(watched(sim.execute(&down)).0, force(10.0, true));
    assert!(sim.joints().same_bits(&guarded.joints()) && sim.now_s() == guarded.now_s());
    assert!(!sim.is_stopped() && sim.force_n() > 10.0);
    // It holds still, and does not keep the arm from going out.
    sim.execute(&Motion { tool: probe, ..by_line(from) }).unwrap();

    // A guard that is lower stops the motion itself.
    let mut sim = over(&cell);
    sim.watch(&[force(60.0, true)]);
    let report = sim.execute(&Motion { tool: probe, ..push(from, 0.3, 10.0) }).unwrap();
    assert_eq!(report.end, MotionEnd::StoppedByForce);

    // One that stops nothing is told of behind the motion.
    let mut sim = over(&cell);
    sim.watch(&[force(5.0, false)]);
    assert_eq!(
        watched(sim.execute(&Motion { tool: probe, ..push(from, 0.3, 10.0) })).0,
        force(5.0, false)
    );
    assert_eq!(sim.last_motion(), report);
}

#[test]
fn looking_changes_nothing_of_what_happens() {
    let mut plain = sim();
    let mut looks = sim();
    looks.watch(&[input(5, true, true), force(1e4, true)]);
    let goal = goal(&plain);
    for sim in [&mut plain, &mut looks] {
        sim.set_output(1, true).unwrap();
        sim.execute(&by_joints(goal)).unwrap();
        sim.wait(0.4).unwrap();
    }
    assert_eq!(common::world_bits(&plain), common::world_bits(&looks));
    assert_eq!(plain.last_motion(), looks.last_motion());
}
