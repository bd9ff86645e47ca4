//! What a grasp does to what it takes, and what is lost on the way: every draw once, and no error
//! that the state of the cell does not explain.

mod common;

use common::{AT_PIN, by_joints, is_wrong, lift, pin_on_plate, push, shift, world_bits};
use obverse_geometry::Pose;
use obverse_geometry::tolerance::pose_distance;
use obverse_sim::kinematics::forward;
use obverse_sim::{CauseKind, Cell, Sim};
use obverse_workcell::{Arm, DigitalIo, Gripper, ItemId, MotionReport, Speed};

const PIN: ItemId = ItemId(0);
const OFFSET: &str = "grasp_offset = { normal_mm = [0.5, 0.5, 0], uniform_deg = [0, 0, 1] }";

fn slipping(slip: &str) -> Cell {
    pin_on_plate(&format!("slip = {slip}"), "", "", "")
}

/// The pin in the frame of the tool mount.
fn in_hand(sim: &Sim) -> Pose {
    forward(&sim.joints()).inverse().compose(&sim.true_pose(PIN).unwrap())
}

fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    (mean, variance.sqrt())
}

#[test]
fn a_grasp_moves_the_item_in_the_gripper_as_the_file_says() {
    let cell = pin_on_plate(OFFSET, "", "", "");
    let (mut along_mm, mut turns_deg) = (Vec::new(), Vec::new());
    for seed in 0..2_000 {
        let mut sim = Sim::new(&cell, seed);
        let lay = sim.true_pose(PIN).unwrap();
        sim.set_output(0, true).unwrap();
        let moved = lay.inverse().compose(&sim.true_pose(PIN).unwrap());
        along_mm.push(moved.translation_m.x * 1e3);
        turns_deg.push(moved.rotation_vector_rad()[2].to_degrees());
        assert!(moved.translation_m.z.abs() < 1e-9);
    }
    let (mean, deviation) = mean_and_deviation(&along_mm);
    assert!(mean.abs() < 0.05 && (deviation - 0.5).abs() < 0.03, "{mean} {deviation}");
    let (mean, deviation) = mean_and_deviation(&turns_deg);
    let uniform = 1.0 / 3.0_f64.sqrt();
    assert!(mean.abs() < 0.05 && (deviation - uniform).abs() < 0.03, "{mean} {deviation}");
}

#[test]
fn what_is_given_back_where_it_was_taken_lies_there_again_and_is_grasped_anew() {
    let cell = pin_on_plate(OFFSET, "", "", "");
    let mut sim = Sim::new(&cell, 3);
    let lay = sim.true_pose(PIN).unwrap();
    let mut grasps = Vec::new();
    for _ in 0..3 {
        sim.set_output(0, true).unwrap();
        sim.execute(&lift(AT_PIN, 0.05)).unwrap();
        grasps.push(in_hand(&sim));
        assert!(is_wrong(&sim, CauseKind::GraspOffset));
        sim.execute(&by_joints(AT_PIN)).unwrap();
        sim.set_output(0, false).unwrap();
        assert_eq!(sim.true_pose(PIN).unwrap(), lay);
    }
    assert!(grasps[0] != grasps[1] && grasps[1] != grasps[2]);
}

#[test]
fn closing_again_right_where_it_was_let_go_takes_it_as_it_was() {
    let cell = pin_on_plate(OFFSET, "", "", "");
    let mut sim = Sim::new(&cell, 3);
    sim.set_output(0, true).unwrap();
    sim.execute(&shift(AT_PIN, 0.05)).unwrap();
    let held = in_hand(&sim);
    sim.set_output(0, false).unwrap();
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), Some(PIN));
    assert_eq!(in_hand(&sim), held);
}

#[test]
fn without_an_offset_what_is_held_is_held_as_it_lay() {
    let mut sim = Sim::new(&pin_on_plate("", "", "", ""), 3);
    let lay = sim.true_pose(PIN).unwrap();
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.true_pose(PIN).unwrap(), lay);
    assert_eq!(sim.truth(), []);
}

/// How many of 1,000 motions let the pin slip.
fn slips(cell: &Cell, act: impl Fn(&mut Sim) -> MotionReport) -> u32 {
    let slipped = (0..1_000).filter(|&seed| {
        let mut sim = Sim::new(cell, seed);
        sim.set_output(0, true).unwrap();
        act(&mut sim);
        is_wrong(&sim, CauseKind::Slipped)
    });
    slipped.count() as u32
}

#[test]
fn what_is_held_slips_as_often_as_the_file_says() {
    let cell = slipping("{ probability = 0.2, offset = { normal_mm = [1, 1, 1] } }");
    let count = slips(&cell, |sim| sim.execute(&lift(AT_PIN, 0.05)).unwrap());
    assert!((160..240).contains(&count), "{count} of 1000 at 0.2");
}

#[test]
fn it_slips_more_often_in_contact() {
    let cell = slipping("{ in_contact = 0.5, contact_n = 3, offset = { normal_mm = [1, 1, 1] } }");
    assert_eq!(slips(&cell, |sim| sim.execute(&lift(AT_PIN, 0.05)).unwrap()), 0);
    let count = slips(&cell, |sim| sim.execute(&push(AT_PIN, 0.01, 5.0)).unwrap());
    assert!((440..560).contains(&count), "{count} of 1000 at 0.5");
}

#[test]
fn it_slips_more_often_when_it_is_fast() {
    let cell = slipping(
        "{ probability = 0.01, fast = 0.5, fast_mm_per_s = 200, \
         offset = { normal_mm = [1, 1, 1] } }",
    );
    let at = |speed| {
        slips(&cell, |sim| {
            let mut motion = lift(AT_PIN, 0.2);
            motion.speed = speed;
            sim.execute(&motion).unwrap()
        })
    };
    let (slow, fast) = (at(Speed::Normal), at(Speed::VeryFast));
    assert!(slow < 30 && (440..560).contains(&fast), "{slow} slow, {fast} fast of 1000");
}

#[test]
fn what_touches_slips_back_into_the_gripper() {
    let cell = slipping("{ in_contact = 1, offset = { fixed_mm = [1, 0, 0] } }");
    let mut sim = Sim::new(&cell, 1);
    sim.set_output(0, true).unwrap();
    let before = in_hand(&sim);
    sim.execute(&push(AT_PIN, 0.01, 5.0)).unwrap();
    let moved = in_hand(&sim).translation_m - before.translation_m;
    assert!(moved.x.abs() < 1e-9 && (moved.z + 1e-3).abs() < 1e-9, "{moved:?}");
}

#[test]
fn what_is_lost_is_held_no_longer_and_lies_on_the_plate() {
    let more = "[inputs]\ncount = 1\nrule = [{ input = 0, holding = true }]\n[falling]\n";
    let cell = pin_on_plate("slip = { probability = 1, lost = 1 }", "", "", more);
    let mut sim = Sim::new(&cell, 1);
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.input(0), Ok(true));
    sim.execute(&lift(AT_PIN, 0.1)).unwrap();
    assert_eq!((sim.held(), sim.input(0)), (None, Ok(false)));
    assert!(is_wrong(&sim, CauseKind::Dropped));
    // On its side, eight millimetres above the plate.
    let lies = sim.true_pose(PIN).unwrap();
    assert!(lies.rotation[(2, 2)].abs() < 5e-3, "{lies:?}");
    let taught = forward(&AT_PIN).displaced(forward(&AT_PIN).rotation.column(2) * 0.1);
    let top_z = taught.translation_m.z - 0.02;
    assert!((lies.translation_m.z - top_z - 8e-3).abs() < 1e-3, "{} {top_z}", lies.translation_m.z);
    // It cannot be taken as it should, wherever the gripper is.
    sim.set_output(0, false).unwrap();
    sim.execute(&by_joints(AT_PIN)).unwrap();
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), None);
}

#[test]
fn a_run_with_every_uncertainty_is_the_same_bits_again() {
    let cell =
        slipping("{ probability = 0.5, in_contact = 0.5, offset = { normal_mm = [1, 1, 1] } }");
    let run = |seed| {
        let mut sim = Sim::new(&cell, seed);
        let mut bits = Vec::new();
        for _ in 0..4 {
            sim.set_output(0, true).unwrap();
            let _ = sim.execute(&lift(AT_PIN, 0.05));
            let _ = sim.execute(&push(AT_PIN, 0.01, 5.0));
            bits.extend(world_bits(&sim));
            sim.set_output(0, false).unwrap();
        }
        bits
    };
    assert!((0..20).all(|seed| run(seed) == run(seed)));
    assert_ne!(run(1), run(2));
}

#[test]
fn a_bad_grasp_is_put_right_by_going_back_to_the_pick() {
    let cell = pin_on_plate("grasp_offset = { normal_mm = [1, 1, 0] }", "", "", "");
    let off_m = |sim: &Sim| {
        let cause = sim.truth().into_iter().find(|cause| cause.kind == CauseKind::GraspOffset);
        cause.map_or(0.0, |cause| cause.by_m)
    };
    let mut sim = Sim::new(&cell, 11);
    let mut good = 0;
    for _ in 0..200 {
        sim.set_output(0, true).unwrap();
        good += u32::from(off_m(&sim) < 1e-3);
        let lay = sim.true_pose(PIN).unwrap();
        sim.set_output(0, false).unwrap();
        assert!(pose_distance(&lay, &sim.true_pose(PIN).unwrap()).0 < 6e-3);
    }
    // Within one deviation in a plane: 1 - exp(-1/2).
    assert!((60..98).contains(&good), "{good} of 200");
}

#[test]
fn fingers_centre_what_they_take_along_their_axes_and_no_other() {
    let pin = "offset = { fixed_mm = [3, 2, 1] }";
    for (key, expected_mm) in [
        ("nothing", [3.0, 2.0, 1.0]),
        ("x", [0.0, 2.0, 1.0]),
        ("y", [3.0, 0.0, 1.0]),
        ("xy", [0.0, 0.0, 1.0]),
    ] {
        let cell = pin_on_plate(&format!("centres = \"{key}\""), pin, "", "");
        let mut sim = Sim::new(&cell, 1);
        let lay = sim.true_pose(PIN).unwrap();
        sim.set_output(0, true).unwrap();
        // The mount is a tenth of a metre behind the tool centre point.
        let off_mm = (in_hand(&sim).translation_m - nalgebra::Vector3::new(0.0, 0.0, 0.1)) * 1e3;
        let expected_mm = nalgebra::Vector3::from(expected_mm);
        assert!((off_mm - expected_mm).norm() < 1e-9, "{key}: {off_mm}");
        assert!(!is_wrong(&sim, CauseKind::GraspOffset), "centred as it should be");
        sim.set_output(0, false).unwrap();
        assert_eq!(sim.true_pose(PIN).unwrap(), lay);
    }
}

#[test]
fn a_peg_that_is_lost_in_its_hole_stays_there() {
    let home = "[0.4, -1.4, 1.6, -1.77, -1.57, 0.3]";
    let text = format!(
        "[arm]
        home_rad = {home}
        [gripper]
        output = 0
        near_mm = 5
        near_deg = 10
        slip = {{ in_contact = 1, lost = 1 }}
        [[fixture]]
        name = \"block\"
        place = {{ taught_at_rad = {home}, xyz_mm = [0, 0, 80] }}
        body = [{{ cuboid_mm = [80, 80, 80], at = {{ xyz_mm = [0, 0, 40] }} }}]
        hole = [{{ diameter_mm = 20.4, depth_mm = 30, chamfer_mm = 1 }}]
        [[item]]
        name = \"peg\"
        place = {{ taught_at_rad = {home} }}
        grasp = {{ xyz_mm = [0, 0, -40] }}
        peg = {{ diameter_mm = 20, length_mm = 60, chamfer_mm = 1 }}
        [falling]"
    );
    let mut sim = Sim::new(&Cell::parse(&text).unwrap(), 1);
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), Some(PIN));
    let report = sim.execute(&push(AT_PIN, 0.1, 5.0)).unwrap();
    assert!((report.distance_m - 0.04).abs() < 1e-3, "on the bottom: {report:?}");
    assert_eq!((sim.held(), sim.truth()), (None, Vec::new()));
    // The gripper can take it where it is.
    sim.set_output(0, false).unwrap();
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), Some(PIN));
}
