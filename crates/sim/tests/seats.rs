//! Snap fits, press fits, threads and bayonets, by an arm that holds an item over them.

mod common;

use common::{by_joints, by_line, push, world_bits};
use obverse_geometry::{Axis, Frame, JointConfiguration};
use obverse_sim::{Cell, CellError, Sim};
use obverse_workcell::{
    Arm, DigitalIo, Fault, Goal, ItemId, Motion, MotionEnd, MotionReport, Path, Speed,
};

/// The tool points down; the end of the pin is 20 mm over the hole.
const OVER: JointConfiguration = JointConfiguration([3.1, -1.57, 1.56, -1.56, -1.57, -6.0]);
const PIN: ItemId = ItemId(0);
const TURN: f64 = std::f64::consts::TAU;

fn cell(pin: &str, hole: &str, offset: &str) -> Result<Cell, CellError> {
    Cell::parse(&format!(
        r#"
        [arm]
        home_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6]
        [[tool]]
        name = "hand"
        tcp = {{ xyz_mm = [0, 0, 100] }}
        [gripper]
        output = 0
        near_mm = 3
        near_deg = 5
        [[item]]
        name = "pin"
        place = {{ taught_at_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6] }}
        grasp = {{ xyz_mm = [0, 0, -10] }}
        peg = {pin}
        [[fixture]]
        name = "block"
        body = [{{ cuboid_mm = [60, 60, 60], at = {{ xyz_mm = [0, 0, 30] }} }}]
        hole = [{hole}]
        offset = {offset}
        [fixture.place]
        taught_at_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6]
        xyz_mm = [0, 0, 50]
        [contact]
        stiffness_n_per_mm = 60
        stop_force_n = 48
        "#
    ))
}

const PIN_10: &str = "{ diameter_mm = 10, length_mm = 40, chamfer_mm = 0.5 }";
const SNAP: &str = "{ diameter_mm = 10.1, depth_mm = 15, chamfer_mm = 1, \
     snap = { at_mm = 12, travel_mm = 3, peak_n = 15, hold_n = 25 } }";
const PRESS: &str = "{ diameter_mm = 9.98, depth_mm = 15, chamfer_mm = 1, \
     press = { force_n_per_mm = 3, hold_n = 30 } }";
const THREAD: &str = "{ diameter_mm = 10.1, depth_mm = 15, chamfer_mm = 1, thread = { at_mm = 3, \
     pitch_mm = 1.5, turns = 1.6, catch_mm = 0.3, catch_deg = 1, give_n_per_mm = 10 } }";
const BAYONET: &str = "{ diameter_mm = 10.1, depth_mm = 15, chamfer_mm = 1, thread = \
     { at_mm = 8, pitch_mm = 0, turns = 0.125, catch_mm = 0.3, catch_deg = 1 } }";

/// Over the hole, holding the pin.
fn over(hole: &str, offset: &str) -> Sim {
    let mut sim = Sim::new(&cell(PIN_10, hole, offset).expect("a cell"), 1);
    sim.set_output(0, true).unwrap();
    sim
}

/// Down from over the hole, until a force.
fn down(sim: &mut Sim, distance_m: f64, limit_n: f64) -> MotionReport {
    sim.execute(&push(OVER, distance_m, limit_n)).unwrap()
}

/// Out of the hole, as slowly as a guard that reads late asks for.
fn up(sim: &mut Sim, limit_n: f64) -> MotionReport {
    let pull = push(sim.joints(), -0.04, limit_n);
    sim.execute(&Motion { speed: Speed::VerySlow, ..pull }).unwrap()
}

fn turn(sim: &Sim, turns: f64, advance_m: f64, limit_n: Option<f64>) -> Motion {
    let (from, axis) = (sim.joints(), Axis::PlusZ);
    let goal = Goal::Turned { from, angle_rad: turns * TURN, advance_m, axis, frame: Frame::Tcp };
    Motion { goal, force_limit_n: limit_n, ..by_line(from) }
}

fn depth_mm(sim: &Sim) -> f64 {
    sim.seating(PIN).expect("it is in the hole").depth_m * 1e3
}

/// The way back of a turn that began there.
fn unturned(from: JointConfiguration) -> Motion {
    let (angle_rad, advance_m, axis) = (0.0, 0.0, Axis::PlusZ);
    let goal = Goal::Turned { from, angle_rad, advance_m, axis, frame: Frame::Tcp };
    Motion { goal, ..by_line(from) }
}

#[test]
fn a_snap_needs_its_peak_and_then_holds() {
    let mut sim = over(SNAP, "{}");
    let weak = down(&mut sim, 0.034, 10.0);
    assert_eq!(weak.end, MotionEnd::StoppedByForce);
    assert!(!sim.seating(PIN).unwrap().is_seated);
    assert_eq!(up(&mut sim, 5.0).end, MotionEnd::Reached);
    let strong = down(&mut sim, 0.034, 20.0);
    assert_eq!(strong.end, MotionEnd::Reached, "{strong:?}");
    assert!((12.0..16.0).contains(&strong.peak_force_n), "{strong:?}");
    assert!(sim.seating(PIN).unwrap().is_seated);
    // It is in: pulled gently it stays, however often; pulled harder it comes.
    for _ in 0..3 {
        assert_eq!(up(&mut sim, 10.0).end, MotionEnd::StoppedByForce);
        assert!(sim.seating(PIN).unwrap().is_seated);
        down(&mut sim, 0.034, 20.0);
    }
    assert_eq!(up(&mut sim, 40.0).end, MotionEnd::Reached);
    assert_eq!(sim.seating(PIN), None);
}

#[test]
fn a_snapped_item_stays_when_the_hand_leaves_without_it() {
    let mut sim = over(SNAP, "{}");
    down(&mut sim, 0.034, 20.0);
    sim.set_output(0, false).unwrap();
    sim.execute(&by_line(OVER)).unwrap();
    assert!(sim.seating(PIN).unwrap().is_seated);
    // Fetched again it holds as before.
    down(&mut sim, 0.034, 20.0);
    sim.set_output(0, true).unwrap();
    assert_eq!(up(&mut sim, 10.0).end, MotionEnd::StoppedByForce);
    assert_eq!(up(&mut sim, 40.0).end, MotionEnd::Reached);
}

#[test]
fn a_press_goes_as_deep_as_the_force_allows() {
    let mut sim = over(PRESS, "{}");
    down(&mut sim, 0.04, 15.0);
    let shallow_mm = depth_mm(&sim);
    // 1.5 mm of chamfers and 3 N a millimetre; the guard reads a little late.
    assert!((6.0..8.5).contains(&shallow_mm), "{shallow_mm}");
    down(&mut sim, 0.04, 30.0);
    assert!((11.0..13.5).contains(&depth_mm(&sim)), "{}", depth_mm(&sim));
    let seated_mm = depth_mm(&sim);
    assert_eq!(up(&mut sim, 20.0).end, MotionEnd::StoppedByForce);
    assert_eq!(depth_mm(&sim), seated_mm);
    assert_eq!(up(&mut sim, 45.0).end, MotionEnd::Reached);
}

#[test]
fn a_misaligned_press_takes_more_force_and_a_tilted_one_is_stuck() {
    let depth = |offset: &str| {
        let mut sim = over(PRESS, offset);
        down(&mut sim, 0.04, 20.0);
        sim.seating(PIN).map_or(0.0, |seating| seating.depth_m * 1e3)
    };
    let straight_mm = depth("{}");
    let aside_mm = depth("{ fixed_mm = [0.6, 0, 0] }");
    let tilted_mm = depth("{ fixed_deg = [1.5, 0, 0] }");
    assert!(aside_mm < straight_mm - 0.2, "{aside_mm} {straight_mm}");
    assert!(tilted_mm < 3.0 && aside_mm > 4.0, "{tilted_mm} {aside_mm}");
}

#[test]
fn a_loose_item_is_not_pressed() {
    let loose = "{ diameter_mm = 9.9, length_mm = 40, chamfer_mm = 0.5 }";
    let mut sim = Sim::new(&cell(loose, PRESS, "{}").unwrap(), 1);
    sim.set_output(0, true).unwrap();
    assert_eq!(down(&mut sim, 0.034, 5.0).end, MotionEnd::Reached);
}

#[test]
fn a_screw_is_driven_to_its_end_and_out_again() {
    let mut sim = over(THREAD, "{}");
    down(&mut sim, 0.04, 3.0);
    assert!((depth_mm(&sim) - 3.0).abs() < 1e-9);
    let on_thread = sim.joints();
    let drive = turn(&sim, 1.9, 1.9 * 1.5e-3, Some(20.0));
    let driven = sim.execute(&drive).unwrap();
    assert_eq!(driven.end, MotionEnd::StoppedByForce);
    let seating = *sim.seating(PIN).unwrap();
    assert!(seating.is_seated && !seating.crossed, "{seating:?}");
    assert!((seating.depth_m - (3e-3 + 1.6 * 1.5e-3)).abs() < 1e-9, "{seating:?}");
    // It is held; turned back the way it came, it is free. Joint 6 knows the whole turn.
    assert_eq!(up(&mut sim.clone(), 30.0).end, MotionEnd::StoppedByForce);
    sim.execute(&unturned(on_thread)).unwrap();
    assert!(sim.joints().same_bits(&on_thread));
    assert_eq!(sim.seating(PIN).unwrap().turned_rad, 0.0);
    assert_eq!(up(&mut sim, 5.0).end, MotionEnd::Reached);
}

#[test]
fn a_turn_that_was_interrupted_goes_on_to_the_same_end() {
    let mut whole = over(THREAD, "{}");
    down(&mut whole, 0.04, 3.0);
    let mut cut = whole.clone();
    let drive = turn(&whole, 1.5, 1.5 * 1.5e-3, None);
    whole.execute(&drive).unwrap();
    for fraction in [0.1, 0.8] {
        cut.inject(obverse_sim::FaultPlan { act: cut.acts_begun(), fraction });
        assert_eq!(cut.execute(&drive), Err(Fault::ProtectiveStop { fraction }));
        obverse_workcell::Safety::release(&mut cut);
    }
    let report = cut.execute(&drive).unwrap();
    assert!((report.distance_m - 1.5 * 1.5e-3).abs() < 1e-9, "{report:?}");
    assert!(whole.joints().largest_difference_rad(&cut.joints()) < 1e-9);
    assert!((depth_mm(&whole) - depth_mm(&cut)).abs() < 1e-6);
}

#[test]
fn a_screw_beside_its_thread_catches_across_and_can_be_freed() {
    let mut sim = over(THREAD, "{ fixed_mm = [0.5, 0, 0] }");
    down(&mut sim, 0.04, 8.0);
    let on_thread = sim.joints();
    let drive = turn(&sim, 1.9, 1.9 * 1.5e-3, Some(20.0));
    let driven = sim.execute(&drive).unwrap();
    assert_eq!(driven.end, MotionEnd::StoppedByForce);
    assert!(driven.distance_m < 0.5 * 1.5e-3, "{driven:?}");
    let seating = *sim.seating(PIN).unwrap();
    assert!(seating.crossed && !seating.is_seated, "{seating:?}");
    sim.execute(&unturned(on_thread)).unwrap();
    assert_eq!(up(&mut sim, 10.0).end, MotionEnd::Reached);
}

#[test]
fn a_bayonet_locks_by_an_eighth_of_a_turn() {
    let mut sim = over(BAYONET, "{}");
    down(&mut sim, 0.04, 3.0);
    let on_slot = sim.joints();
    let lock = turn(&sim, 0.2, 0.0, Some(15.0));
    assert_eq!(sim.execute(&lock).unwrap().end, MotionEnd::StoppedByForce);
    assert!(sim.seating(PIN).unwrap().is_seated);
    assert_eq!(up(&mut sim.clone(), 15.0).end, MotionEnd::StoppedByForce);
    sim.execute(&by_joints(on_slot)).unwrap();
    assert_eq!(up(&mut sim, 15.0).end, MotionEnd::Reached);
}

#[test]
fn runs_are_the_same_bits_for_the_same_commands() {
    let run = || {
        let mut sim = over(THREAD, "{ normal_mm = [0.1, 0.1, 0] }");
        down(&mut sim, 0.04, 3.0);
        let drive = turn(&sim, 1.9, 1.9 * 1.5e-3, Some(20.0));
        sim.execute(&drive).unwrap();
        world_bits(&sim)
    };
    assert_eq!(run(), run());
}

#[test]
fn turns_that_no_arm_can_make_are_refused() {
    let mut sim = over(THREAD, "{}");
    for turns in [5.0, f64::NAN, f64::INFINITY] {
        let drive = turn(&sim, turns, 0.0, None);
        assert!(matches!(sim.execute(&drive), Err(Fault::BadCommand { .. })));
    }
    let drive = turn(&sim, 1.0, f64::NAN, None);
    assert!(matches!(sim.execute(&drive), Err(Fault::BadCommand { .. })));
    let drive = turn(&sim, 2.2, 0.0, None);
    assert!(matches!(sim.execute(&drive), Err(Fault::JointLimit { joint: 6, .. })));
    let by_joints = Motion { path: Path::Joint, ..turn(&sim, 0.9, 0.0, None) };
    assert_eq!(sim.execute(&by_joints).unwrap().end, MotionEnd::Reached);
    assert!((sim.joints().0[5] - 0.9 * TURN + 6.0).abs() < 1e-9);
}

#[test]
fn seats_that_cannot_be_are_refused() {
    let refused = |hole: &str, word: &str| {
        let error = cell(PIN_10, hole, "{}").expect_err(hole);
        assert!(error.message.contains(word), "{error}");
    };
    refused(&SNAP.replace("at_mm = 12", "at_mm = 16"), "below the bottom");
    refused(&SNAP.replace("travel_mm = 3", "travel_mm = 13"), "above the hole");
    refused(&SNAP.replace("peak_n = 15", "peak_n = -1"), "a force limit");
    refused(&SNAP.replace("hold_n = 25", "hold_N = 25"), "hold_N");
    refused(&PRESS.replace("hold_n = 30", "hold_n = nan"), "a force in N");
    refused(&THREAD.replace("turns = 1.6", "turns = 10"), "below the bottom");
    refused(&THREAD.replace("turns = 1.6", "turns = 1.6, cross_turns = 2"), "cannot turn 2");
    refused(
        &PRESS
            .replace("press", "snap = { at_mm = 9, travel_mm = 1, peak_n = 1, hold_n = 1 }, press"),
        "at most one",
    );
}
