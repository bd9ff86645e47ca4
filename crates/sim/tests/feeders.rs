//! Feeders: parts come when they are asked for, after a while, and not always as they should.

mod common;

use common::{AT_PIN, is_wrong, lift, pin_on_plate, shift, world_bits};
use obverse_sim::{CauseKind, Cell, Sim};
use obverse_workcell::{Arm, Clock, DigitalIo, Gripper, ItemId, Items};

const PIN: ItemId = ItemId(0);

fn fed(keys: &str) -> Cell {
    fed_with("", keys)
}

fn fed_with(pin: &str, keys: &str) -> Cell {
    let more = format!(
        "[[feeder]]\nname = \"tray\"\nitem = \"pin\"\noutput = 3\ninput = 4\ndelay_s = 0.5\n{keys}"
    );
    pin_on_plate("", pin, "", &more)
}

fn ask(sim: &mut Sim) {
    sim.set_output(3, false).unwrap();
    sim.set_output(3, true).unwrap();
    sim.wait(0.5).unwrap();
}

#[test]
fn a_part_comes_when_it_was_asked_for_and_its_time_has_passed() {
    let mut sim = Sim::new(&fed(""), 1);
    assert_eq!((sim.input(4), sim.true_pose(PIN)), (Ok(false), None));
    sim.set_output(3, true).unwrap();
    sim.wait(0.4).unwrap();
    assert_eq!((sim.input(4), sim.true_pose(PIN)), (Ok(false), None));
    sim.wait(0.11).unwrap();
    assert_eq!((sim.input(4), sim.true_pose(PIN)), (Ok(true), sim.nominal_pose(PIN)));
    assert_eq!(sim.truth(), []);
    sim.set_output(0, true).unwrap();
    sim.execute(&lift(AT_PIN, 0.05)).unwrap();
    assert_eq!((sim.held(), sim.input(4)), (Some(PIN), Ok(false)));
}

#[test]
fn a_feeder_that_is_ready_has_a_part_at_the_start() {
    let sim = Sim::new(&fed("ready = true"), 1);
    assert_eq!((sim.input(4), sim.true_pose(PIN)), (Ok(true), sim.nominal_pose(PIN)));
}

#[test]
fn while_the_gripper_holds_the_part_no_other_comes() {
    let mut sim = Sim::new(&fed("ready = true"), 1);
    sim.set_output(0, true).unwrap();
    ask(&mut sim);
    assert_eq!((sim.held(), sim.input(4)), (Some(PIN), Ok(true)));
}

#[test]
fn every_asking_brings_a_fresh_part_with_a_place_of_its_own() {
    let mut sim = Sim::new(&fed_with("offset = { uniform_mm = [1, 1, 0] }", ""), 1);
    ask(&mut sim);
    let first = sim.true_pose(PIN).unwrap();
    // Dropped elsewhere.
    sim.set_output(0, true).unwrap();
    sim.execute(&shift(AT_PIN, 0.1)).unwrap();
    sim.set_output(0, false).unwrap();
    assert_eq!(sim.input(4), Ok(false));
    ask(&mut sim);
    let second = sim.true_pose(PIN).unwrap();
    assert!(first != second && (first.translation_m - second.translation_m).norm() < 3e-3);
    assert_eq!(sim.input(4), Ok(true));
    ask(&mut sim);
    assert_ne!(sim.true_pose(PIN), Some(second));
}

#[test]
fn a_feeder_is_empty_as_often_as_the_file_says_and_can_be_asked_again() {
    let cell = fed("empty = 0.3");
    let (mut empty, mut came_later) = (0, 0);
    for seed in 0..1_000 {
        let mut sim = Sim::new(&cell, seed);
        ask(&mut sim);
        assert_eq!(is_wrong(&sim, CauseKind::Empty), sim.input(4) == Ok(false));
        if is_wrong(&sim, CauseKind::Empty) {
            empty += 1;
            ask(&mut sim);
            came_later += u32::from(sim.input(4) == Ok(true));
        }
    }
    assert!((250..350).contains(&empty), "{empty} of 1000 at 0.3");
    let share = f64::from(came_later) / f64::from(empty);
    assert!((0.6..0.8).contains(&share), "{share} came later, at 0.7");
}

#[test]
fn a_feeder_runs_out_after_its_parts() {
    let mut sim = Sim::new(&fed("parts = 2"), 1);
    let came: Vec<bool> = (0..4)
        .map(|_| {
            ask(&mut sim);
            sim.input(4).unwrap()
        })
        .collect();
    assert_eq!(came, [true, true, false, false]);
    assert!(is_wrong(&sim, CauseKind::Empty));
}

#[test]
fn a_part_lies_askew_as_often_as_the_file_says() {
    let cell = fed("askew = 0.2\naskew_offset = { fixed_deg = [15, 0, 0] }");
    let mut askew = 0;
    for seed in 0..1_000 {
        let mut sim = Sim::new(&cell, seed);
        ask(&mut sim);
        let is_tilted = sim.true_pose(PIN) != sim.nominal_pose(PIN);
        assert_eq!(is_wrong(&sim, CauseKind::Askew), is_tilted);
        askew += u32::from(is_tilted);
        // Taken or not, it is the same part; a fresh one is as good as any.
        sim.set_output(0, true).unwrap();
        assert_eq!(is_wrong(&sim, CauseKind::Askew), is_tilted);
    }
    assert!((160..240).contains(&askew), "{askew} of 1000 at 0.2");
}

#[test]
fn a_part_comes_where_the_fixture_truly_is_that_the_feeder_stands_on() {
    let text = "[[feeder]]\nname = \"tray\"\nitem = \"pin\"\noutput = 3\ninput = 4\nnear_mm = 2";
    let pin = "on = \"plate\"";
    let cell = pin_on_plate("", pin, "offset = { fixed_mm = [5, 0, 0] }", text);
    let mut sim = Sim::new(&cell, 1);
    sim.set_output(3, true).unwrap();
    let off_m =
        sim.true_pose(PIN).unwrap().translation_m - sim.nominal_pose(PIN).unwrap().translation_m;
    assert!((off_m.norm() - 5e-3).abs() < 1e-9);
    assert_eq!(sim.input(4), Ok(true));
}

#[test]
fn a_run_with_a_feeder_is_the_same_bits_again() {
    let cell = fed("empty = 0.3\naskew = 0.3\naskew_offset = { normal_deg = [9, 9, 9] }");
    let run = |seed| {
        let mut sim = Sim::new(&cell, seed);
        let mut bits = Vec::new();
        for _ in 0..10 {
            ask(&mut sim);
            bits.extend(world_bits(&sim));
        }
        bits
    };
    assert!((0..20).all(|seed| run(seed) == run(seed)));
}
