//! The general cell: everything in it can be reached, taken, put back and sensed.

mod common;

use common::{bench_cell, by_joints, push, to_pose, world_bits};
use nalgebra::Vector3;
use obverse_geometry::Pose;
use obverse_sim::Sim;
use obverse_workcell::{
    Arm, Clock, DigitalIo, Fault, Gripper, ItemId, Items, Motion, MotionEnd, Path, Safety, ToolId,
};

fn above(pose: &Pose, height_m: f64) -> Pose {
    pose.displaced(Vector3::new(0.0, 0.0, height_m))
}

/// Over the item, down to it, close, and up again.
fn pick(sim: &mut Sim, name: &str) -> ItemId {
    let item = sim.item(name).unwrap();
    let pose = sim.nominal_pose(item).unwrap();
    sim.execute(&to_pose(above(&pose, 0.1), Path::Joint)).unwrap();
    sim.execute(&to_pose(pose, Path::Linear)).unwrap();
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), Some(item), "{name}");
    sim.execute(&to_pose(above(&pose, 0.1), Path::Linear)).unwrap();
    item
}

#[test]
fn every_item_can_be_picked() {
    for name in ["block_a", "block_b", "block_c", "pin"] {
        pick(&mut Sim::new(&bench_cell(), 1), name);
    }
}

#[test]
fn a_block_can_be_stacked_on_another() {
    let mut sim = Sim::new(&bench_cell(), 1);
    let block = pick(&mut sim, "block_a");
    let below = sim.nominal_pose(sim.item("block_c").unwrap()).unwrap();
    let on_top = above(&below, 0.04);
    sim.execute(&to_pose(above(&on_top, 0.1), Path::Joint)).unwrap();
    sim.execute(&to_pose(on_top, Path::Linear)).unwrap();
    sim.set_output(0, false).unwrap();
    sim.execute(&to_pose(above(&on_top, 0.1), Path::Linear)).unwrap();
    let lies = sim.true_pose(block).unwrap();
    assert!((lies.translation_m - on_top.translation_m).norm() < 1e-9);
}

#[test]
fn a_held_block_collides_with_one_that_lies_there() {
    let mut sim = Sim::new(&bench_cell(), 1);
    pick(&mut sim, "block_a");
    let below = sim.nominal_pose(sim.item("block_c").unwrap()).unwrap();
    sim.execute(&to_pose(above(&below, 0.1), Path::Joint)).unwrap();
    let from = sim.joints();
    let report = sim.execute(&push(from, 0.1, 5.0)).unwrap();
    assert_eq!(report.end, MotionEnd::StoppedByForce);
    assert!((report.distance_m - 0.06).abs() < 1e-3, "{report:?}");
}

#[test]
fn the_pin_goes_into_the_socket() {
    let mut sim = Sim::new(&bench_cell(), 1);
    pick(&mut sim, "pin");
    // The pin's end is 30 mm below the tool centre point, the socket's face at 50 mm.
    let over = Pose { translation_m: Vector3::new(0.55, -0.15, 0.15), ..tcp(&sim) };
    sim.execute(&to_pose(over, Path::Joint)).unwrap();
    let from = sim.joints();
    let report = sim.execute(&push(from, 0.2, 5.0)).unwrap();
    assert_eq!(report.end, MotionEnd::StoppedByForce);
    assert!((report.distance_m - 0.09).abs() < 1e-3, "{report:?}");
    sim.set_output(0, false).unwrap();
    sim.execute(&to_pose(over, Path::Linear)).unwrap();
}

/// Motions in a row, each of which begins where the one before was stopped.
#[test]
fn a_row_of_guarded_motions_presses_no_harder_than_the_first() {
    let mut sim = Sim::new(&bench_cell(), 1);
    let tool = sim.tool("probe").unwrap();
    let block = sim.nominal_pose(sim.item("block_c").unwrap()).unwrap();
    sim.execute(&Motion { tool, ..to_pose(above(&block, 0.025), Path::Joint) }).unwrap();
    let first = sim.execute(&Motion { tool, ..push(sim.joints(), 0.02, 15.0) }).unwrap();
    assert_eq!(first.end, MotionEnd::StoppedByForce);
    let stopped_at = sim.joints();
    for _ in 0..20 {
        let next = sim.execute(&Motion { tool, ..push(sim.joints(), 0.02, 15.0) }).unwrap();
        assert_eq!(next.end, MotionEnd::StoppedByForce);
        assert!(next.distance_m < 1e-9, "{next:?}");
    }
    // With a limit that is never read, it is the stop force that ends it.
    let harder = sim.execute(&Motion { tool, ..push(stopped_at, 0.02, 500.0) });
    assert!(matches!(harder, Err(Fault::Collision { .. })), "{harder:?}");
    sim.release();
    // The way out is free.
    let out = sim.execute(&Motion { tool, ..push(sim.joints(), -0.02, 15.0) });
    assert_eq!(out.unwrap().end, MotionEnd::Reached);
}

fn tcp(sim: &Sim) -> Pose {
    obverse_sim::kinematics::forward(&sim.joints()).compose(&sim.cell().tools[0].tcp)
}

#[test]
fn an_item_given_back_where_it_was_taken_lies_there_bit_for_bit() {
    let mut sim = Sim::new(&bench_cell(), 1);
    let item = sim.item("block_a").unwrap();
    let at_rest = sim.true_pose(item).unwrap();
    let pose = sim.nominal_pose(item).unwrap();
    sim.execute(&to_pose(above(&pose, 0.1), Path::Joint)).unwrap();
    sim.execute(&to_pose(pose, Path::Linear)).unwrap();
    let taken_at = sim.joints();
    sim.set_output(0, true).unwrap();
    sim.execute(&to_pose(above(&pose, 0.1), Path::Linear)).unwrap();
    let up = sim.joints();
    // Let go in the air, then all of it backwards: take, down, let go.
    sim.set_output(0, false).unwrap();
    let in_the_air = sim.true_pose(item).unwrap();
    assert_ne!(in_the_air, at_rest);
    sim.set_output(0, true).unwrap();
    sim.execute(&by_joints(taken_at)).unwrap();
    sim.set_output(0, false).unwrap();
    assert_eq!(sim.true_pose(item), Some(at_rest));
    // And forwards again, to the same bits.
    sim.set_output(0, true).unwrap();
    sim.execute(&by_joints(up)).unwrap();
    sim.set_output(0, false).unwrap();
    assert_eq!(sim.true_pose(item), Some(in_the_air));
}

#[test]
fn a_gripper_that_closes_on_nothing_holds_nothing() {
    let mut sim = Sim::new(&bench_cell(), 1);
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), None);
    assert_eq!(sim.input(0), Ok(false));
    sim.set_output(0, false).unwrap();
    pick(&mut sim, "block_c");
    assert_eq!(sim.input(0), Ok(true));
}

#[test]
fn inputs_follow_their_rules() {
    let mut sim = Sim::new(&bench_cell(), 1);
    assert_eq!((sim.input(2), sim.input(3), sim.input(7)), (Ok(true), Ok(false), Ok(false)));
    sim.set_output(1, true).unwrap();
    sim.wait(0.9).unwrap();
    assert_eq!(sim.input(1), Ok(false));
    sim.wait(0.2).unwrap();
    assert_eq!(sim.input(1), Ok(true));
    sim.wait(1.0).unwrap();
    assert_eq!(sim.input(3), Ok(true));
    sim.wait(1.0).unwrap();
    assert_eq!(sim.input(3), Ok(false));
    assert!(sim.input(8).is_err() && sim.set_output(8, true).is_err());
}

#[test]
fn names_are_found() {
    let sim = Sim::new(&bench_cell(), 1);
    assert_eq!(sim.tool("probe"), Some(ToolId(1)));
    assert_eq!(sim.initial_tool(), ToolId(0));
    assert_eq!((sim.tool("hammer"), sim.item("bolt")), (None, None));
    assert_eq!(sim.nominal_pose(ItemId(99)), None);
}

#[test]
fn nothing_in_this_cell_depends_on_the_seed_but_noise() {
    let run = |seed| {
        let mut sim = Sim::new(&bench_cell(), seed);
        pick(&mut sim, "pin");
        world_bits(&sim)
    };
    assert_eq!(run(1), run(2));
}
