//! Motions in a cell: goals, limits, refusals, time, guards and collisions.

mod common;

use common::{advance, bench_cell, by_joints, by_line, commanded_bits, push, to_pose, world_bits};
use obverse_geometry::tolerance::same_pose;
use obverse_geometry::{Axis, Frame, JointConfiguration, Pose};
use obverse_sim::kinematics::forward;
use obverse_sim::{Cell, Sim};
use obverse_workcell::{
    Arm, Clock, Fault, FaultKind, ForceTorque, Goal, Items, Motion, MotionEnd, Path, Safety, Speed,
    ToolId,
};
use std::f64::consts::PI;

const ELBOW_UP: JointConfiguration = JointConfiguration([0.3, -1.2, 1.4, -1.7, -1.5, 0.2]);

fn bare() -> Sim {
    Sim::new(&Cell::bare(), 1)
}

fn over_the_table(x: f64, y: f64, z: f64) -> Pose {
    Pose::from_rotation_vector([x, y, z], [PI, 0.0, 0.0])
}

/// The TCP of the tool `gripper` of the bench cell.
fn tcp(sim: &Sim) -> Pose {
    forward(&sim.joints()).compose(&sim.cell().tools[0].tcp)
}

#[test]
fn a_goal_in_joints_is_reached_bit_for_bit_on_either_path() {
    for path in [Path::Joint, Path::Linear] {
        let mut sim = bare();
        sim.execute(&by_joints(ELBOW_UP)).unwrap();
        let near = JointConfiguration(ELBOW_UP.0.map(|joint| joint + 0.1));
        let report = sim.execute(&Motion { path, ..by_joints(near) }).unwrap();
        assert!(sim.joints().same_bits(&near));
        assert_eq!(report.end, MotionEnd::Reached);
    }
}

#[test]
fn a_joint_move_takes_the_time_of_its_longest_joint() {
    let mut sim = bare();
    let home = sim.joints();
    let mut goal = home;
    goal.0[0] += PI;
    goal.0[5] += 0.1;
    let report = sim.execute(&by_joints(goal)).unwrap();
    // 45 deg/s and 180 deg/s2: half a turn and one ramp.
    assert!((report.duration_s - (180.0 / 45.0 + 45.0 / 180.0)).abs() < 1e-9, "{report:?}");
    assert_eq!(sim.now_s(), report.duration_s);
}

#[test]
fn a_joint_outside_its_range_is_refused_before_anything_moves() {
    let mut sim = bare();
    let before = world_bits(&sim);
    let mut goal = sim.joints();
    goal.0[1] = 6.5;
    let fault = sim.execute(&by_joints(goal)).unwrap_err();
    assert!(matches!(fault, Fault::JointLimit { joint: 2, value_rad, .. } if value_rad == 6.5));
    assert_eq!(world_bits(&sim), before);
    assert!(!sim.is_stopped());
}

#[test]
fn a_pose_out_of_reach_is_refused_on_either_path() {
    for path in [Path::Joint, Path::Linear] {
        let mut sim = bare();
        let before = world_bits(&sim);
        let far = over_the_table(1.3, 0.0, 0.2);
        let fault = sim.execute(&to_pose(far, path)).unwrap_err();
        assert_eq!(fault.kind(), FaultKind::OutOfReach, "{fault}");
        assert_eq!(world_bits(&sim), before);
    }
}

#[test]
fn numbers_that_make_no_sense_are_bad_commands() {
    let mut sim = bare();
    let home = sim.joints();
    let nan = JointConfiguration([f64::NAN; 6]);
    let displaced = |from, distance_m| Goal::Displaced {
        from,
        distance_m,
        axis: Axis::PlusZ,
        frame: Frame::Tcp,
    };
    let mut skewed = Pose::identity();
    skewed.rotation *= 2.0;
    let mut lost = Pose::identity();
    lost.translation_m.x = f64::INFINITY;
    let goals = [
        Goal::Joints(nan),
        displaced(nan, 0.1),
        displaced(home, f64::NAN),
        displaced(home, 1e9),
        Goal::Offset { from: home, by_m: [0.0, f64::INFINITY, 0.0], frame: Frame::Base },
        Goal::Pose(skewed),
        Goal::Pose(lost),
    ];
    for goal in goals {
        for path in [Path::Joint, Path::Linear] {
            let fault = sim.execute(&Motion { goal, path, ..by_joints(home) }).unwrap_err();
            assert_eq!(fault.kind(), FaultKind::BadCommand, "{goal:?}: {fault}");
        }
    }
    for limit in [f64::NAN, -1.0, 0.0, f64::INFINITY] {
        let motion = Motion { force_limit_n: Some(limit), ..by_joints(home) };
        assert_eq!(sim.execute(&motion).unwrap_err().kind(), FaultKind::BadCommand);
    }
    let motion = Motion { tool: ToolId(9), ..by_joints(home) };
    assert_eq!(sim.execute(&motion).unwrap_err().kind(), FaultKind::Missing);
    for wait_s in [f64::NAN, -1.0, f64::INFINITY] {
        assert_eq!(sim.wait(wait_s).unwrap_err().kind(), FaultKind::BadCommand);
    }
    assert!(sim.joints().same_bits(&home) && sim.now_s() == 0.0);
}

#[test]
fn displacements_count_from_their_own_start() {
    let mut sim = bare();
    sim.execute(&by_joints(ELBOW_UP)).unwrap();
    let start = forward(&ELBOW_UP);
    // Twice the same command, from different places, ends in the same place.
    for _ in 0..2 {
        let report = sim.execute(&advance(ELBOW_UP, 0.05)).unwrap();
        let expected = start.displaced(start.rotation.column(2) * 0.05);
        assert!(same_pose(&forward(&sim.joints()), &expected));
        assert!((report.distance_m - 0.05).abs() < 1e-9);
    }
    let goal = Goal::Offset { from: ELBOW_UP, by_m: [0.01, 0.02, -0.03], frame: Frame::Base };
    sim.execute(&Motion { goal, ..by_line(ELBOW_UP) }).unwrap();
    let expected = start.displaced([0.01, 0.02, -0.03].into());
    assert!(same_pose(&forward(&sim.joints()), &expected));
}

#[test]
fn a_line_is_straight_and_keeps_its_branch() {
    let mut sim = Sim::new(&bench_cell(), 1);
    let pose = over_the_table(0.45, 0.0, 0.3);
    sim.execute(&to_pose(pose, Path::Joint)).unwrap();
    let from = tcp(&sim).translation_m;
    let goal = over_the_table(0.6, -0.25, 0.2);
    for part in 1..=20 {
        // A line to a part of the way is a part of the line.
        let share = f64::from(part) / 20.0;
        let point = from + (goal.translation_m - from) * share;
        let before = sim.joints();
        sim.execute(&to_pose(Pose { translation_m: point, ..goal }, Path::Linear)).unwrap();
        assert!((tcp(&sim).translation_m - point).norm() < 1e-9);
        assert!(sim.joints().largest_difference_rad(&before) < 0.2);
    }
}

#[test]
fn a_line_through_the_column_of_the_arm_is_refused() {
    let mut sim = Sim::new(&bench_cell(), 1);
    sim.execute(&to_pose(over_the_table(0.4, 0.0, 0.3), Path::Joint)).unwrap();
    let through = to_pose(over_the_table(-0.4, 0.0, 0.3), Path::Linear);
    let fault = sim.execute(&through).unwrap_err();
    assert!(matches!(fault.kind(), FaultKind::OutOfReach | FaultKind::Singular), "{fault}");
}

#[test]
fn a_line_that_would_pass_a_singular_wrist_is_refused() {
    // Joints 4 and 6 in one line half way: the tool would have to flip.
    let mut sim = bare();
    let from = JointConfiguration([0.3, -1.2, 1.4, -1.7, -0.3, 0.2]);
    let to = JointConfiguration([0.3, -1.2, 1.4, -1.7, 0.3, 0.2]);
    sim.execute(&by_joints(from)).unwrap();
    let before = world_bits(&sim);
    let fault = sim.execute(&by_line(to)).unwrap_err();
    assert!(matches!(fault.kind(), FaultKind::Singular | FaultKind::BadCommand), "{fault}");
    assert_eq!(world_bits(&sim), before);
}

#[test]
fn a_line_to_joints_with_a_wrist_turned_once_more_is_refused() {
    let mut sim = bare();
    sim.execute(&by_joints(ELBOW_UP)).unwrap();
    let mut turned = ELBOW_UP;
    turned.0[5] -= 2.0 * PI;
    let fault = sim.execute(&by_line(turned)).unwrap_err();
    assert_eq!(fault.kind(), FaultKind::BadCommand, "{fault}");
}

#[test]
fn a_guarded_motion_stops_at_the_table_and_can_leave_it_again() {
    let mut sim = Sim::new(&bench_cell(), 1);
    // The probe touches the table 150 mm below.
    let probe = ToolId(1);
    let above = Motion { tool: probe, ..to_pose(over_the_table(0.4, -0.3, 0.15), Path::Joint) };
    sim.execute(&above).unwrap();
    let from = sim.joints();
    for limit_n in [5.0, 20.0] {
        let report = sim.execute(&Motion { tool: probe, ..push(from, 0.3, limit_n) }).unwrap();
        assert_eq!(report.end, MotionEnd::StoppedByForce);
        // The table gives way by a millimetre for 50 N.
        assert!((0.15..0.1515).contains(&report.distance_m), "{report:?}");
        assert!(report.peak_force_n > limit_n && sim.force_n() > limit_n, "{report:?}");
        assert!(!sim.is_stopped());
        // Guarded or not, it can go back the way it came.
        let back = Motion { tool: probe, force_limit_n: Some(limit_n), ..by_line(from) };
        assert_eq!(sim.execute(&back).unwrap().end, MotionEnd::Reached);
        assert!(sim.joints().same_bits(&from));
        assert!(sim.force_n() < 1.0);
    }
}

#[test]
fn an_unguarded_motion_into_the_table_is_a_collision() {
    let mut sim = Sim::new(&bench_cell(), 1);
    let probe = ToolId(1);
    sim.execute(&Motion { tool: probe, ..to_pose(over_the_table(0.4, -0.3, 0.15), Path::Joint) })
        .unwrap();
    let from = sim.joints();
    let down = Motion { tool: probe, ..advance(from, 0.3) };
    let before_s = sim.now_s();
    let fault = sim.execute(&down).unwrap_err();
    let Fault::Collision { body, with, fraction, force_n } = &fault else { panic!("{fault}") };
    assert_eq!((body.as_str(), with.as_str()), ("probe", "table"));
    // 40 N press 0.8 mm.
    assert!((fraction * 0.3 - 0.1508).abs() < 1e-6, "{fraction}");
    assert!((force_n - 40.0).abs() < 1e-3, "{force_n}");
    assert!(sim.is_stopped() && sim.now_s() > before_s);
    // Nothing moves until released; then further in is refused where it stands, and out is free.
    assert_eq!(sim.execute(&by_line(from)), Err(Fault::Stopped));
    sim.release();
    let stopped_at = sim.joints();
    assert_eq!(sim.execute(&down).unwrap_err().kind(), FaultKind::Collision);
    assert!(sim.joints().largest_difference_rad(&stopped_at) < 1e-6);
    sim.release();
    sim.execute(&Motion { tool: probe, ..by_line(from) }).unwrap();
    assert!(sim.joints().same_bits(&from));
}

#[test]
fn the_arm_itself_collides_with_the_table() {
    let mut sim = Sim::new(&bench_cell(), 1);
    // Turned away from the items, the elbow goes down and the wrist up.
    let raised = JointConfiguration([PI / 2.0, -0.6, -0.6, -PI / 2.0, -PI / 2.0, 0.0]);
    sim.execute(&by_joints(raised)).unwrap();
    let mut low = raised;
    low.0[1] = 0.4;
    low.0[2] = -1.6;
    let fault = sim.execute(&by_joints(low)).unwrap_err();
    let Fault::Collision { body, with, .. } = &fault else { panic!("{fault}") };
    assert_eq!(with, "table");
    assert!(["upper arm", "forearm"].contains(&body.as_str()), "{fault}");
}

#[test]
fn a_fast_motion_does_not_jump_over_a_thin_wall() {
    let mut sim = Sim::new(&bench_cell(), 1);
    // Sideways through the rim of the tray, 5 mm thick, in one sweep of 300 mm.
    let probe = ToolId(1);
    let at = |x: f64| Motion {
        tool: probe,
        speed: Speed::VeryFast,
        ..to_pose(over_the_table(x, 0.31, 0.015), Path::Linear)
    };
    let start = Motion { path: Path::Joint, ..at(0.30) };
    sim.execute(&Motion { goal: Goal::Pose(over_the_table(0.30, 0.31, 0.1)), ..start }).unwrap();
    sim.execute(&at(0.30)).unwrap();
    let goal = Goal::Pose(over_the_table(0.34, 0.05, 0.015));
    let beside = Motion { goal, ..at(0.30) };
    sim.execute(&beside).unwrap();
    let goal = Goal::Pose(over_the_table(0.56, 0.19, 0.015));
    let fault = sim.execute(&Motion { goal, ..at(0.30) }).unwrap_err();
    let Fault::Collision { with, .. } = &fault else { panic!("{fault}") };
    assert_eq!(with, "tray");
}

#[test]
fn noise_near_the_limit_can_stop_a_motion_in_free_air() {
    let mut cell = Cell::bare();
    cell.force_sensor.noise_n = 2.0;
    cell.force_sensor.window = 1;
    let mut sim = Sim::new(&cell, 1);
    let home = sim.joints();
    let report = sim.execute(&push(home, 0.1, 1.5)).unwrap();
    assert_eq!(report.end, MotionEnd::StoppedByForce);
    assert!(report.distance_m < 0.1);
    // And never does where the limit is above it.
    sim.execute(&by_line(home)).unwrap();
    assert_eq!(sim.execute(&push(home, 0.1, 2.1)).unwrap().end, MotionEnd::Reached);
}

#[test]
fn reading_changes_nothing() {
    let sim = Sim::new(&bench_cell(), 3);
    let before = (world_bits(&sim), commanded_bits(&sim));
    let first = sim.force_n();
    assert_eq!(sim.force_n(), first);
    assert_eq!(sim.nominal_pose(sim.item("pin").unwrap()), Some(sim.cell().items[3].pose));
    assert_eq!((world_bits(&sim), commanded_bits(&sim)), before);
}

#[test]
fn there_and_back_is_the_same_commanded_state_for_random_goals() {
    let mut sim = bare();
    let start = commanded_bits(&sim);
    let home = sim.joints();
    let mut visited = vec![home];
    for number in 0..50_u64 {
        let draw = |axis: u64| obverse_workcell::Dice::draw(&sim, number * 6 + axis);
        let goal = JointConfiguration(std::array::from_fn(|axis| 6.0 * draw(axis as u64) - 3.0));
        sim.execute(&by_joints(goal)).unwrap();
        visited.push(goal);
    }
    for goal in visited.iter().rev() {
        sim.execute(&by_joints(*goal)).unwrap();
    }
    assert_eq!(commanded_bits(&sim), start);
}
