//! Damaged workcell files and wild commands: an error or a fault, never a panic.

mod common;

use common::by_joints;
use nalgebra::{Matrix3, Vector3};
use obverse_geometry::{Axis, Frame, JointConfiguration, Pose};
use obverse_sim::random::{Stream, bits, unit};
use obverse_sim::{Cell, FaultPlan, Sim};
use obverse_workcell::{Arm, Clock, DigitalIo, Goal, Motion, Path, Safety, Speed, ToolId};

const FILES: [&str; 3] = [
    include_str!("../../../programs/bench_cell.toml"),
    include_str!("../../../programs/peg_in_hole.toml"),
    include_str!("uncertain.toml"),
];

/// A file with a few of its bytes changed, cut or repeated.
fn damaged(file: &str, number: u64) -> String {
    let mut bytes = file.as_bytes().to_vec();
    let draw = |counter: u64| bits(number, Stream::Dice, counter);
    for change in 0..1 + draw(0) % 4 {
        let at = (draw(10 + change) % bytes.len() as u64) as usize;
        match draw(20 + change) % 4 {
            0 => bytes[at] = b"0123456789-.e[]{}=\"x\n"[(draw(30 + change) % 21) as usize],
            1 => drop(bytes.remove(at)),
            2 => bytes.insert(at, b"0-9e.,"[(draw(30 + change) % 6) as usize]),
            _ => bytes.truncate(at.max(1)),
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn a_damaged_file_is_refused_or_makes_a_cell_that_runs() {
    let (mut refused, mut run) = (0, 0);
    for number in 0..900 {
        let text = damaged(FILES[(number % 3) as usize], number);
        match Cell::parse(&text) {
            Err(error) => {
                assert!(error.line >= 1 && error.column >= 1 && !error.message.is_empty());
                refused += 1;
            }
            Ok(cell) => {
                let mut sim = Sim::new(&cell, number);
                let mut goal = sim.joints();
                goal.0[0] += 0.3;
                for is_asked in [true, false] {
                    let _ = sim.set_output(3, is_asked);
                    let _ = sim.wait(0.3);
                    let _ = sim.set_output(0, is_asked);
                    let _ = sim.execute(&by_joints(goal));
                    sim.release();
                }
                let _ = (sim.truth(), sim.missed_goals());
                run += 1;
            }
        }
    }
    assert!(refused > 50 && run > 50, "{refused} refused, {run} run");
}

/// A number that may be anything.
fn wild(seed: u64, counter: u64) -> f64 {
    match bits(seed, Stream::Dice, counter) % 8 {
        0 => f64::NAN,
        1 => f64::INFINITY,
        2 => -1e300,
        3 => 0.0,
        4 => f64::MIN_POSITIVE,
        _ => 4.0 * unit(seed, Stream::Dice, counter + 1_000) - 2.0,
    }
}

fn wild_motion(seed: u64, from: JointConfiguration) -> Motion {
    let number = |counter| wild(seed, counter);
    let choice = |counter: u64, count: u64| bits(seed, Stream::Dice, 500 + counter) % count;
    let goal = match choice(0, 5) {
        0 => Goal::Joints(JointConfiguration(std::array::from_fn(|joint| number(joint as u64)))),
        1 => Goal::Pose(Pose {
            rotation: match choice(5, 2) {
                0 => Matrix3::identity(),
                _ => Matrix3::from_fn(|row, column| number((3 * row + column) as u64)),
            },
            translation_m: Vector3::new(number(20), number(21), number(22)),
        }),
        2 => Goal::Displaced {
            from,
            distance_m: number(30),
            axis: Axis::MinusZ,
            frame: Frame::ToolMount,
        },
        3 => Goal::Offset { from, by_m: [number(40), number(41), number(42)], frame: Frame::Base },
        _ => Goal::Turned {
            from,
            angle_rad: number(43),
            advance_m: number(44),
            axis: Axis::PlusX,
            frame: Frame::Tcp,
        },
    };
    Motion {
        goal,
        path: if choice(1, 2) == 0 { Path::Joint } else { Path::Linear },
        speed: Speed::ALL[choice(2, 5) as usize],
        tool: ToolId(choice(3, 3) as u16),
        force_limit_n: (choice(4, 2) == 0).then(|| number(50)),
    }
}

#[test]
fn wild_commands_leave_finite_joints_and_a_clock_that_never_goes_back() {
    for file in FILES {
        wildly(&Cell::parse(file).unwrap());
    }
}

fn wildly(cell: &Cell) {
    let mut sim = Sim::new(cell, 1);
    for seed in 0..2_000 {
        if seed % 5 == 0 {
            sim.inject(FaultPlan { act: sim.acts_begun(), fraction: wild(seed, 60) });
        }
        let before_s = sim.now_s();
        let _ = sim.execute(&wild_motion(seed, sim.joints()));
        let _ = sim.wait(wild(seed, 61));
        let _ = sim.set_output((seed % 11) as u16, seed % 3 == 0);
        assert!(sim.joints().is_finite() && sim.now_s() >= before_s);
        sim.release();
    }
}
