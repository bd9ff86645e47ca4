//! Motions that chance ends, wires that stick and flicker, fixtures that are out with all that
//! stands on them, and a sensor that reads what it should not.

mod common;

use common::{AT_PIN, advance, by_joints, is_wrong, lift, pin_on_plate, push};
use obverse_sim::{CauseKind, Cell, FaultPlan, Sim, StopKind};
use obverse_workcell::{
    Arm, Clock, DigitalIo, Fault, FaultKind, ForceTorque, ItemId, Items, MotionEnd, Safety,
};

const PIN: ItemId = ItemId(0);

type Act = fn(&mut Sim) -> Result<(), Fault>;

fn with(more: &str) -> Cell {
    pin_on_plate("", "", "", more)
}

#[test]
fn each_stop_comes_as_often_as_the_file_says_and_holds_the_arm_or_not() {
    let cases = [
        ("stops_short", FaultKind::StoppedShort, false),
        ("protective_stop", FaultKind::ProtectiveStop, true),
        ("emergency_stop", FaultKind::EmergencyStop, true),
    ];
    for (key, kind, holds) in cases {
        let cell = with(&format!("[chance]\n{key} = 0.2"));
        let mut sim = Sim::new(&cell, 5);
        let (mut stops, mut fractions) = (0, Vec::new());
        for _ in 0..500 {
            for goal in [lift(AT_PIN, 0.05), by_joints(AT_PIN)] {
                if let Err(fault) = sim.execute(&goal) {
                    assert_eq!(fault.kind(), kind, "{fault}");
                    assert_eq!(sim.is_stopped(), holds);
                    assert_eq!(is_wrong(&sim, CauseKind::Stopped), holds);
                    assert_eq!(holds, sim.execute(&goal) == Err(Fault::Stopped));
                    let (Fault::StoppedShort { fraction }
                    | Fault::ProtectiveStop { fraction }
                    | Fault::EmergencyStop { fraction }) = fault
                    else {
                        panic!("{fault}")
                    };
                    fractions.push(fraction);
                    stops += 1;
                    sim.release();
                    while sim.execute(&goal).is_err() {
                        sim.release();
                    }
                }
            }
        }
        assert!((160..240).contains(&stops), "{stops} of 1000 {key} at 0.2");
        let mean = fractions.iter().sum::<f64>() / fractions.len() as f64;
        assert!((0.42..0.58).contains(&mean), "{key} at {mean} on average");
    }
}

#[test]
fn any_stop_can_be_injected_into_any_act() {
    for (kind, code) in [
        (StopKind::Short, "stopped_short"),
        (StopKind::Protective, "protective_stop"),
        (StopKind::Emergency, "emergency_stop"),
    ] {
        let acts: [Act; 3] = [
            |sim| sim.execute(&lift(AT_PIN, 0.05)).map(drop),
            |sim| sim.set_output(1, true),
            |sim| sim.wait(1.0),
        ];
        for act in acts {
            let mut sim = Sim::new(&with(""), 1);
            sim.inject_as(FaultPlan { act: 0, fraction: 0.5 }, kind);
            assert_eq!(act(&mut sim).unwrap_err().kind().code(), code);
            assert_eq!(sim.is_stopped(), kind != StopKind::Short);
            sim.release();
            act(&mut sim).unwrap();
        }
    }
}

#[test]
fn an_output_that_sticks_says_what_it_was_set_to_and_does_not_do_it() {
    let more = "[outputs]\ncount = 8\nstick = [{ output = 2, probability = 0.25 }]
        [inputs]\ncount = 1\nrule = [{ input = 0, follows_output = 2 }]";
    let cell = with(more);
    let mut stuck = 0;
    for seed in 0..1_000 {
        let mut sim = Sim::new(&cell, seed);
        sim.set_output(2, true).unwrap();
        assert!(sim.output(2));
        let is_stuck = is_wrong(&sim, CauseKind::OutputStuck);
        assert_eq!(sim.input(0), Ok(!is_stuck));
        stuck += u32::from(is_stuck);
        // Set again as often as it takes, it comes.
        for _ in 0..40 {
            sim.set_output(2, true).unwrap();
        }
        assert_eq!((sim.input(0), sim.truth().len()), (Ok(true), 0));
    }
    assert!((205..295).contains(&stuck), "{stuck} of 1000 at 0.25");
}

#[test]
fn an_input_sticks_until_its_next_change() {
    let more = "[inputs]\ncount = 1\nrule = [{ input = 0, follows_output = 2, delay_s = 0.1 }]
        stick = [{ input = 0, probability = 0.25 }]";
    let cell = with(more);
    let mut stuck = 0;
    for seed in 0..1_000 {
        let mut sim = Sim::new(&cell, seed);
        sim.set_output(2, true).unwrap();
        sim.wait(1.0).unwrap();
        let is_stuck = sim.input(0) == Ok(false);
        assert_eq!(is_wrong(&sim, CauseKind::InputStuck), is_stuck);
        stuck += u32::from(is_stuck);
        sim.set_output(2, false).unwrap();
        sim.wait(1.0).unwrap();
        if is_stuck {
            assert_eq!((sim.input(0), sim.truth().len()), (Ok(false), 0));
        }
    }
    assert!((205..295).contains(&stuck), "{stuck} of 1000 at 0.25");
}

#[test]
fn an_input_that_bounces_flickers_for_its_time_and_then_shows_its_level() {
    let more = "[inputs]\ncount = 1\nrule = [{ input = 0, follows_output = 2 }]
        bounce = [{ input = 0, for_s = 0.05 }]";
    let mut sim = Sim::new(&with(more), 4);
    sim.set_output(2, true).unwrap();
    let read = |sim: &mut Sim| {
        sim.wait(0.001).unwrap();
        sim.input(0).unwrap()
    };
    let early: Vec<bool> = (0..48).map(|_| read(&mut sim)).collect();
    assert!(early.contains(&true) && early.contains(&false), "{early:?}");
    assert!(is_wrong(&sim, CauseKind::InputFlickers));
    sim.wait(0.01).unwrap();
    assert!((0..50).all(|_| read(&mut sim)));
    assert_eq!(sim.truth(), []);
}

#[test]
fn the_bias_of_the_sensor_is_drawn_once_a_run() {
    let cell = with("[force_sensor]\nbias_n = 10\nbias_normal_n = 0.5\nbias_uniform_n = 1");
    let readings: Vec<f64> = (0..1_000)
        .map(|seed| {
            let mut sim = Sim::new(&cell, seed);
            let first_n = sim.force_n();
            sim.wait(1.0).unwrap();
            assert_eq!(sim.force_n(), first_n);
            first_n
        })
        .collect();
    let mean = readings.iter().sum::<f64>() / 1e3;
    let variance = readings.iter().map(|n| (n - mean).powi(2)).sum::<f64>() / 1e3;
    assert!((mean - 10.0).abs() < 0.1, "{mean}");
    assert!((variance - (0.25 + 1.0 / 3.0)).abs() < 0.08, "{variance}");
}

#[test]
fn what_stands_on_a_fixture_shares_its_true_offset() {
    let plate = "offset = { normal_mm = [2, 2, 0], normal_deg = [0, 0, 1] }";
    let more = "[[fixture]]\nname = \"nest\"\non = \"plate\"\nplace = { xyz_mm = [50, 0, -20] }
        body = [{ cuboid_mm = [20, 20, 20] }]";
    let cell = pin_on_plate("", "on = \"plate\"", plate, more);
    for seed in 0..50 {
        let sim = Sim::new(&cell, seed);
        let causes = sim.truth();
        let by_m = |name: &str| {
            let cause = causes.iter().find(|cause| cause.of == name);
            cause.map_or(0.0, |cause| cause.by_m)
        };
        assert!(by_m("plate") > 0.0 && by_m("nest") > 0.0, "{causes:?}");
        // A program knows the nominal place; the pin's own is where the plate truly is.
        let (nominal, lies) = (sim.nominal_pose(PIN).unwrap(), sim.true_pose(PIN).unwrap());
        assert!((nominal.translation_m - lies.translation_m).norm() > 0.0);
        assert_eq!(by_m("pin"), 0.0, "it is off by nothing of its own");
        assert_eq!(cell.items[0].pose, nominal);
    }
}

#[test]
fn touching_a_fixture_measures_where_it_truly_stands() {
    for off_mm in [-4.0, -1.0, 0.0, 2.5] {
        let plate = format!("offset = {{ fixed_mm = [0, 0, {off_mm}] }}");
        let cell = pin_on_plate("", "on = \"plate\"", &plate, "");
        let mut sim = Sim::new(&cell, 1);
        sim.set_output(0, true).unwrap();
        sim.execute(&lift(AT_PIN, 0.03)).unwrap();
        let high = sim.joints();
        // The pin stands on the plate that is off, and was taken there.
        let report = sim.execute(&push(high, 0.1, 2.0)).unwrap();
        assert_eq!(report.end, MotionEnd::StoppedByForce);
        let measured_mm = (report.distance_m - 0.03) * 1e3;
        assert!((measured_mm - 0.01).abs() < 0.5, "pin: {measured_mm} mm");
        // With the last link against the plate itself: as far as it is off.
        sim.execute(&by_joints(AT_PIN)).unwrap();
        sim.set_output(0, false).unwrap();
        sim.execute(&lift(AT_PIN, 0.03)).unwrap();
        let aside = common::shift(sim.joints(), 0.07);
        sim.execute(&aside).unwrap();
        let felt = sim.execute(&push(sim.joints(), 0.3, 2.0)).unwrap();
        assert_eq!(felt.end, MotionEnd::StoppedByForce);
        let nominal = pin_on_plate("", "on = \"plate\"", "", "");
        let mut other = Sim::new(&nominal, 1);
        other.execute(&lift(AT_PIN, 0.03)).unwrap();
        other.execute(&common::shift(other.joints(), 0.07)).unwrap();
        let usual = other.execute(&push(other.joints(), 0.3, 2.0)).unwrap();
        let measured_mm = (felt.distance_m - usual.distance_m) * 1e3;
        assert!((measured_mm - off_mm).abs() < 0.2, "plate: {measured_mm} mm of {off_mm}");
    }
}

#[test]
fn a_cell_without_chance_is_what_a_plan_thinks_of() {
    let more = "[chance]\nstops_short = 0.5\nprotective_stop = 0.5\n[outputs]\ncount = 8
        stick = [{ output = 0, probability = 1 }]\n[force_sensor]\nbias_uniform_n = 2
        [[feeder]]\nname = \"tray\"\nitem = \"pin\"\noutput = 3\nempty = 1\naskew = 1
        askew_offset = { fixed_mm = [9, 0, 0] }";
    let slip = "slip = { probability = 1, lost = 1 }\ngrasp_offset = { fixed_mm = [3, 0, 0] }";
    let cell = pin_on_plate(slip, "", "offset = { fixed_mm = [3, 0, 0] }", more).nominal();
    let mut sim = Sim::new(&cell, 1);
    sim.set_output(3, true).unwrap();
    sim.set_output(0, true).unwrap();
    for _ in 0..20 {
        sim.execute(&lift(AT_PIN, 0.05)).unwrap();
        sim.execute(&advance(AT_PIN, 0.0)).unwrap();
    }
    assert_eq!((sim.truth(), sim.force_n()), (Vec::new(), 0.0));
}
