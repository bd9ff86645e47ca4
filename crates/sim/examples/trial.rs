use obverse_geometry::*;
use obverse_sim::*;
use obverse_workcell::*;
use std::time::Instant;
const START: JointConfiguration = JointConfiguration([3.425, -1.0, 1.2, -1.8, -1.57, 0.3]);
fn mv(goal: Goal, path: Path, speed: Speed, f: Option<f64>) -> Motion {
    Motion { goal, path, speed, tool: ToolId(0), force_limit_n: f }
}
fn main() {
    if std::env::var("PER").is_ok() {
        per();
    }
    let cell = Cell::parse(&std::fs::read_to_string("programs/peg_in_hole.toml").unwrap()).unwrap();
    let n = 200u64;
    let mut done = 0;
    let bases: Vec<_> = (0..n).map(|s| Sim::new(&cell, s)).collect();
    for _ in 0..1 {
        let t = Instant::now();
        let (mut a, mut b, mut c) = (0u128, 0u128, 0u128);
        for _ in 0..100 {
            for base in &bases {
                let mut sim = base.clone();
                let t0 = Instant::now();
                sim.set_output(0, true).unwrap();
                sim.execute(&mv(Goal::Joints(START), Path::Joint, Speed::Normal, None)).unwrap();
                let t1 = Instant::now();
                let r = sim
                    .execute(&mv(
                        Goal::Displaced {
                            from: START,
                            distance_m: 0.3,
                            axis: Axis::PlusZ,
                            frame: Frame::Tcp,
                        },
                        Path::Linear,
                        Speed::Slow,
                        Some(5.0),
                    ))
                    .unwrap();
                let t2 = Instant::now();
                sim.execute(&mv(Goal::Joints(START), Path::Linear, Speed::Normal, None)).unwrap();
                let t3 = Instant::now();
                a += (t1 - t0).as_nanos();
                b += (t2 - t1).as_nanos();
                c += (t3 - t2).as_nanos();
                if r.distance_m > 0.2 {
                    done += 1
                }
            }
        }
        let k = n as u128 * 100;
        println!(
            "{:.0} trials/s approach {} insert {} retract {} ns; {done}",
            k as f64 / t.elapsed().as_secs_f64(),
            a / k,
            b / k,
            c / k
        );
    }
}

fn per() {
    let cell = Cell::parse(&std::fs::read_to_string("programs/peg_in_hole.toml").unwrap()).unwrap();
    for seed in 0..24 {
        let base = Sim::new(&cell, seed);
        let mut base = base.clone();
        base.set_output(0, true).unwrap();
        base.execute(&mv(Goal::Joints(START), Path::Joint, Speed::Normal, None)).unwrap();
        let mut t = (0, 0);
        let mut d = 0.0;
        for _ in 0..300 {
            let mut sim = base.clone();
            let t1 = Instant::now();
            let r = sim
                .execute(&mv(
                    Goal::Displaced {
                        from: START,
                        distance_m: 0.3,
                        axis: Axis::PlusZ,
                        frame: Frame::Tcp,
                    },
                    Path::Linear,
                    Speed::Slow,
                    Some(5.0),
                ))
                .unwrap();
            let t2 = Instant::now();
            sim.execute(&mv(Goal::Joints(START), Path::Linear, Speed::Normal, None)).unwrap();
            let t3 = Instant::now();
            t.0 += (t2 - t1).as_nanos();
            t.1 += (t3 - t2).as_nanos();
            d = r.distance_m * 1e3;
        }
        println!("{seed} {d:.1} {} {}", t.0 / 300, t.1 / 300);
    }
}
