//! Faults on demand: an act that is stopped part way, and what holds afterwards.

mod common;

use common::{bench_cell, by_joints, world_bits};
use obverse_geometry::JointConfiguration;
use obverse_sim::{Cell, FaultPlan, Sim};
use obverse_workcell::{Arm, Clock, DigitalIo, Fault, Gripper, Safety};

fn goal(sim: &Sim) -> JointConfiguration {
    let mut goal = sim.joints();
    goal.0[0] += 0.5;
    goal
}

fn with_plan(act: u64, fraction: f64) -> Sim {
    let mut sim = Sim::new(&Cell::bare(), 1);
    sim.inject(FaultPlan { act, fraction });
    sim
}

#[test]
fn a_motion_holds_part_way_and_can_be_finished_after_release() {
    let mut sim = with_plan(1, 0.25);
    let home = sim.joints();
    let goal = goal(&sim);
    sim.wait(1.0).unwrap();
    let fault = sim.execute(&by_joints(goal)).unwrap_err();
    assert_eq!(fault, Fault::ProtectiveStop { fraction: 0.25 });
    assert!(sim.joints().same_bits(&home.towards(&goal, 0.25)));
    assert!(sim.is_stopped());
    assert_eq!(sim.execute(&by_joints(goal)), Err(Fault::Stopped));
    sim.release();
    sim.execute(&by_joints(goal)).unwrap();
    assert!(sim.joints().same_bits(&goal));
}

#[test]
fn a_stop_at_the_ends_of_a_motion_has_moved_nothing_or_everything() {
    for (fraction, moved) in [(0.0, false), (1.0, true)] {
        let mut sim = with_plan(0, fraction);
        let (home, goal) = (sim.joints(), goal(&sim));
        assert_eq!(sim.execute(&by_joints(goal)), Err(Fault::ProtectiveStop { fraction }));
        assert!(sim.joints().same_bits(if moved { &goal } else { &home }));
    }
}

#[test]
fn an_output_fails_before_or_after_it_takes_effect() {
    for (fraction, taken) in [(0.0, false), (0.49, false), (0.5, true), (1.0, true)] {
        let mut sim = with_plan(0, fraction);
        assert_eq!(sim.set_output(0, true), Err(Fault::ProtectiveStop { fraction }));
        assert_eq!((sim.output(0), sim.held().is_some()), (taken, taken));
        assert!(sim.is_stopped());
        sim.release();
        sim.set_output(0, true).unwrap();
        assert!(sim.output(0) && sim.held().is_some());
    }
}

#[test]
fn a_wait_ends_early() {
    let mut sim = with_plan(0, 0.25);
    assert_eq!(sim.wait(2.0), Err(Fault::ProtectiveStop { fraction: 0.25 }));
    assert_eq!(sim.now_s(), 0.5);
}

#[test]
fn acts_are_counted_and_a_plan_fires_once() {
    let mut sim = with_plan(2, 0.5);
    sim.wait(0.1).unwrap();
    sim.set_output(3, true).unwrap();
    assert_eq!(sim.acts_begun(), 2);
    assert!(sim.wait(0.1).is_err());
    sim.release();
    sim.wait(0.1).unwrap();
    assert_eq!(sim.acts_begun(), 4);
    // Too late for an act that was begun already.
    sim.inject(FaultPlan { act: 1, fraction: 0.5 });
    sim.wait(0.1).unwrap();
}

#[test]
fn a_refused_command_does_not_fire_the_plan_but_uses_its_act() {
    let mut sim = with_plan(0, 0.5);
    let mut far = sim.joints();
    far.0[0] = 7.0;
    assert!(matches!(sim.execute(&by_joints(far)), Err(Fault::JointLimit { .. })));
    assert!(!sim.is_stopped());
    sim.execute(&by_joints(goal(&sim))).unwrap();
}

#[test]
fn a_stopped_run_is_the_same_bits_again() {
    let run = || {
        let mut sim = Sim::new(&bench_cell(), 5);
        sim.inject(FaultPlan { act: 1, fraction: 0.3 });
        sim.set_output(1, true).unwrap();
        let _ = sim.execute(&by_joints(goal(&sim)));
        world_bits(&sim)
    };
    assert_eq!(run(), run());
}
