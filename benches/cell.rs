//! The workcell: forward and inverse kinematics, and one whole trial of the paper's insertion.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use obverse_geometry::JointConfiguration;
use obverse_sim::{Cell, Sim, kinematics};
use obverse_workcell::{Arm, Clock, DigitalIo, Goal, Motion, Path, Safety, Speed};
use std::hint::black_box;
use std::sync::Arc;

const START: JointConfiguration = JointConfiguration([3.425, -1.0, 1.2, -1.8, -1.57, 0.3]);

fn configurations() -> Vec<JointConfiguration> {
    (0..256)
        .map(|index| {
            let turn = f64::from(index) * 0.37;
            JointConfiguration([turn % 3.0, -1.0 - turn % 0.9, 1.2, -1.8 + turn % 1.1, -1.57, 0.3])
        })
        .collect()
}

fn kinematics_of_the_arm(criterion: &mut Criterion) {
    let configurations = configurations();
    let poses: Vec<_> = configurations.iter().map(kinematics::forward).collect();
    let mut group = criterion.benchmark_group("kinematics");
    group.throughput(Throughput::Elements(configurations.len() as u64));
    group.bench_function("forward", |bencher| {
        bencher.iter(|| {
            for configuration in &configurations {
                black_box(kinematics::forward(black_box(configuration)));
            }
        });
    });
    group.bench_function("inverse", |bencher| {
        bencher.iter(|| {
            for pose in &poses {
                black_box(kinematics::inverse(black_box(pose), &START));
            }
        });
    });
}

/// Grip, approach, insert or jam, retract.
fn trial(cell: &Cell, seed: u64) -> f64 {
    let mut sim = Sim::new(cell, seed);
    let tool = obverse_workcell::Items::initial_tool(&sim);
    let motion =
        |goal, path, force_limit_n| Motion { goal, path, speed: Speed::Slow, tool, force_limit_n };
    let gripped = sim.set_output(0, true);
    assert!(gripped.is_ok(), "{gripped:?}");
    let approach = sim.execute(&motion(Goal::Joints(START), Path::Joint, None));
    assert!(approach.is_ok(), "{approach:?}");
    let insertion = Goal::Displaced {
        from: START,
        distance_m: 0.3,
        axis: obverse_geometry::Axis::PlusZ,
        frame: obverse_geometry::Frame::Tcp,
    };
    let inserted = sim.execute(&motion(insertion, Path::Linear, Some(5.0)));
    let depth_m = inserted.map_or(0.0, |report| report.distance_m);
    sim.release();
    let retracted = sim.execute(&motion(Goal::Joints(START), Path::Linear, None));
    assert!(retracted.is_ok(), "{retracted:?}");
    depth_m
}

/// Eight actions: grip, lift, approach, insert, let go, draw back, go home, wait. How far it came.
fn assembly(cell: &Arc<Cell>, seed: u64) -> f64 {
    let mut sim = Sim::shared(cell.clone(), seed);
    let tool = obverse_workcell::Items::initial_tool(&sim);
    let home = sim.joints();
    let motion =
        |goal, path, speed, force_limit_n| Motion { goal, path, speed, tool, force_limit_n };
    let along = |from, distance_m, frame| Goal::Displaced {
        from,
        distance_m,
        axis: obverse_geometry::Axis::PlusZ,
        frame,
    };
    let (base, tcp) = (obverse_geometry::Frame::Base, obverse_geometry::Frame::Tcp);
    let mut worked = sim.set_output(0, true).is_ok();
    worked &=
        sim.execute(&motion(along(home, 0.05, base), Path::Linear, Speed::Normal, None)).is_ok();
    worked &= sim.execute(&motion(Goal::Joints(START), Path::Joint, Speed::Normal, None)).is_ok();
    assert!(worked, "{seed}");
    let inserted =
        sim.execute(&motion(along(START, 0.3, tcp), Path::Linear, Speed::Slow, Some(5.0)));
    let _ = sim.set_output(0, false);
    sim.release();
    let _ = sim.execute(&motion(Goal::Joints(START), Path::Linear, Speed::Normal, None));
    let _ = sim.execute(&motion(Goal::Joints(home), Path::Joint, Speed::Normal, None));
    let _ = sim.wait(0.5);
    inserted.map_or(0.0, |report| report.distance_m)
}

fn trials(criterion: &mut Criterion) {
    let text = include_str!("../programs/peg_in_hole.toml");
    let cell = match Cell::parse(text) {
        Ok(cell) => cell,
        Err(error) => panic!("{error}"),
    };
    let shared = Arc::new(cell.clone());
    let mut group = criterion.benchmark_group("trial");
    group.throughput(Throughput::Elements(64));
    group.bench_function("peg_insertion", |bencher| {
        bencher.iter(|| (0..64).map(|seed| trial(&cell, seed)).sum::<f64>());
    });
    group.bench_function("assembly_of_8_actions", |bencher| {
        bencher.iter(|| (0..64).map(|seed| assembly(&shared, seed)).sum::<f64>());
    });
    group.bench_function("new", |bencher| {
        bencher.iter(|| {
            (0..64).map(|seed| Sim::shared(shared.clone(), seed).joints().0[0]).sum::<f64>()
        });
    });
}

criterion_group!(benches, kinematics_of_the_arm, trials);
criterion_main!(benches);
