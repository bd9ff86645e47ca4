//! What is let go over nothing falls, what is pushed from the side is knocked over, and both stay
//! so.

mod common;

use common::{AT_PIN, advance, by_joints, by_line, is_wrong, lift, pin_on_plate, push, shift};
use obverse_geometry::{Axis, Frame};
use obverse_sim::{CauseKind, Cell, Sim};
use obverse_workcell::{Arm, DigitalIo, Fault, Goal, Gripper, ItemId, Motion, Safety};

const PIN: ItemId = ItemId(0);

fn falling() -> Cell {
    pin_on_plate("", "", "", "[falling]\nsupport_mm = 5\nknock_n = 10")
}

/// The pin carried up, and let go there.
fn dropped_from(height_m: f64, cell: &Cell) -> Sim {
    let mut sim = Sim::new(cell, 1);
    sim.set_output(0, true).unwrap();
    sim.execute(&lift(AT_PIN, height_m)).unwrap();
    sim.set_output(0, false).unwrap();
    sim
}

#[test]
fn what_is_let_go_too_high_falls_over_and_cannot_be_taken() {
    let mut sim = dropped_from(0.03, &falling());
    assert!(is_wrong(&sim, CauseKind::Dropped));
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), None);
}

#[test]
fn what_is_let_go_just_above_something_stays() {
    let mut sim = dropped_from(0.003, &falling());
    assert_eq!(sim.truth(), []);
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), Some(PIN));
}

#[test]
fn nothing_falls_in_a_cell_that_does_not_say_so() {
    assert_eq!(dropped_from(0.3, &pin_on_plate("", "", "", "")).truth(), []);
}

#[test]
fn what_falls_beside_everything_is_gone() {
    let mut sim = Sim::new(&falling(), 1);
    sim.set_output(0, true).unwrap();
    sim.execute(&lift(AT_PIN, 0.05)).unwrap();
    sim.execute(&shift(sim.joints(), 0.4)).unwrap();
    sim.set_output(0, false).unwrap();
    assert_eq!(sim.true_pose(PIN), None);
    assert!(is_wrong(&sim, CauseKind::Absent));
}

#[test]
fn what_is_put_back_where_it_lay_is_held_by_what_held_it_before() {
    // Nothing is below: what hands it over has no body.
    let cell = pin_on_plate("", "offset = { fixed_mm = [0, 0, -50] }", "", "[falling]");
    let mut sim = Sim::new(&cell, 1);
    sim.execute(&lift(AT_PIN, 0.05)).unwrap();
    let high = sim.joints();
    let lay = sim.true_pose(PIN).unwrap();
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), Some(PIN));
    sim.execute(&lift(high, 0.05)).unwrap();
    sim.execute(&by_joints(high)).unwrap();
    sim.set_output(0, false).unwrap();
    assert_eq!((sim.true_pose(PIN), sim.truth()), (Some(lay), Vec::new()));
}

/// A second pin in the gripper, to push the first one with.
fn two_pins(knock_n: f64) -> Sim {
    let home = "[0.4, -1.4, 1.6, -1.77, -1.57, 0.3]";
    let more = format!(
        "[falling]\nknock_n = {knock_n}\n[[item]]\nname = \"stick\"
        place = {{ taught_at_rad = {home}, xyz_mm = [60, 0, 0] }}
        body = [{{ cylinder = {{ diameter_mm = 16, length_mm = 38 }} }}]"
    );
    let cell = pin_on_plate("", "", "", &more);
    let mut sim = Sim::new(&cell, 1);
    let beside = Motion {
        goal: Goal::Displaced {
            from: AT_PIN,
            distance_m: 0.06,
            axis: Axis::PlusX,
            frame: Frame::Tcp,
        },
        ..by_line(AT_PIN)
    };
    sim.execute(&beside).unwrap();
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.held(), Some(ItemId(1)));
    sim
}

fn push_aside(sim: &mut Sim, limit_n: Option<f64>) -> Result<(), Fault> {
    let mut motion = push(sim.joints(), 0.1, 1.0);
    motion.goal = Goal::Displaced {
        from: sim.joints(),
        distance_m: 0.1,
        axis: Axis::MinusX,
        frame: Frame::Tcp,
    };
    motion.force_limit_n = limit_n;
    sim.execute(&motion).map(drop)
}

#[test]
fn a_collision_knocks_over_what_stands() {
    let mut sim = two_pins(10.0);
    let stood = sim.true_pose(PIN).unwrap();
    let fault = push_aside(&mut sim, None).unwrap_err();
    assert!(matches!(fault, Fault::Collision { ref with, .. } if with == "pin"), "{fault}");
    assert!(is_wrong(&sim, CauseKind::Knocked));
    let lies = sim.true_pose(PIN).unwrap();
    assert!(lies.rotation[(2, 2)].abs() < 5e-3);
    // It fell away from what pushed it, and lies lower than it stood.
    assert!(lies.translation_m.z < stood.translation_m.z - 5e-3);
    // It stays so, and going away is possible.
    sim.release();
    sim.execute(&lift(sim.joints(), 0.05)).unwrap();
    assert_eq!(sim.true_pose(PIN), Some(lies));
    assert!(is_wrong(&sim, CauseKind::Knocked));
}

#[test]
fn a_soft_touch_does_not() {
    let mut sim = two_pins(30.0);
    push_aside(&mut sim, Some(3.0)).unwrap();
    assert!(!is_wrong(&sim, CauseKind::Knocked));
}

#[test]
fn pressing_from_above_knocks_nothing_over() {
    let cell = pin_on_plate("", "", "", "[falling]\nknock_n = 1");
    let mut sim = Sim::new(&cell, 1);
    sim.execute(&lift(AT_PIN, 0.1)).unwrap();
    // The wrist comes down on the pin from above: the hand has no body.
    let fault = sim.execute(&advance(sim.joints(), 0.3)).unwrap_err();
    assert!(matches!(fault, Fault::Collision { .. }), "{fault}");
    assert!(!is_wrong(&sim, CauseKind::Knocked), "{:?}", sim.truth());
}

#[test]
fn a_push_on_the_way_knocks_over_too() {
    // The stick goes over the pin's edge by less than would stop the arm.
    for (knock_n, is_knocked) in [(5.0, true), (39.0, false)] {
        let mut sim = two_pins(knock_n);
        let at = sim.joints();
        let mut motion = push(at, 0.1, 1.0);
        motion.force_limit_n = None;
        motion.goal =
            Goal::Displaced { from: at, distance_m: 0.0443, axis: Axis::MinusX, frame: Frame::Tcp };
        sim.execute(&motion).unwrap();
        assert_eq!(is_wrong(&sim, CauseKind::Knocked), is_knocked, "{knock_n} N");
    }
}
