use obverse_geometry::*;
use obverse_sim::*;
use obverse_workcell::*;
use std::time::Instant;
const START: JointConfiguration = JointConfiguration([3.425, -1.0, 1.2, -1.8, -1.57, 0.3]);
const HANDLE: JointConfiguration = JointConfiguration([3.379, -1.2, 1.3, -1.7, -1.57, 0.3]);
fn mv(goal: Goal, path: Path, speed: Speed, f: Option<f64>) -> Motion {
    Motion { goal, path, speed, tool: ToolId(0), force_limit_n: f }
}
fn main() {
    let cell = Cell::parse(&std::fs::read_to_string("programs/peg_in_hole.toml").unwrap()).unwrap();
    let mut hist = [0; 6];
    for seed in 1..=40u64 {
        let mut sim = Sim::new(&cell, seed);
        sim.set_output(0, true).unwrap();
        sim.wait(0.5).unwrap();
        assert_eq!(sim.held(), Some(ItemId(0)));
        sim.execute(&mv(Goal::Joints(START), Path::Joint, Speed::Normal, None)).unwrap();
        let mut tries = String::new();
        let mut n = 0;
        for attempt in 0..4u64 {
            if attempt > 0 {
                let d = |k| 2.0 * sim.draw(attempt * 2 + k) - 1.0;
                let by = [d(0) * 1e-3, d(1) * 1e-3, 0.0];
                sim.execute(&mv(
                    Goal::Offset { from: START, by_m: by, frame: Frame::Tcp },
                    Path::Linear,
                    Speed::Slow,
                    None,
                ))
                .unwrap();
            }
            let from = sim.joints();
            let r = sim.execute(&mv(
                Goal::Displaced { from, distance_m: 0.3, axis: Axis::PlusZ, frame: Frame::Tcp },
                Path::Linear,
                Speed::Slow,
                Some(5.0),
            ));
            match r {
                Ok(r) => {
                    tries += &format!(
                        " {:?} {:.2}mm {:.1}N {:.2}s f{:.2}",
                        r.end,
                        r.distance_m * 1e3,
                        r.peak_force_n,
                        r.duration_s,
                        sim.force_n()
                    );
                    let ok = r.distance_m > 0.2;
                    sim.execute(&mv(Goal::Joints(START), Path::Linear, Speed::Normal, None))
                        .map_err(|e| tries += &format!(" RET {e}"))
                        .ok();
                    n = attempt + 1;
                    if ok {
                        break;
                    }
                    n = 5;
                }
                Err(e) => {
                    tries += &format!(" ERR {e}");
                    break;
                }
            }
        }
        hist[n as usize] += 1;
        println!("{seed}: {tries}");
    }
    println!("{hist:?}");
    let base = Sim::new(&cell, 1);
    for seed in [1u64, 2, 3, 4, 5] {
        let base = Sim::new(&cell, seed);
        let t = Instant::now();
        let n = 20000;
        let mut c = 0;
        for _ in 0..n {
            let mut sim = base.clone();
            sim.set_output(0, true).unwrap();
            sim.execute(&mv(Goal::Joints(START), Path::Joint, Speed::Normal, None)).unwrap();
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
            sim.execute(&mv(Goal::Joints(START), Path::Linear, Speed::Normal, None)).unwrap();
            if r.distance_m > 0.2 {
                c += 1
            }
        }
        println!("seed {seed}: {} trials/s, {c}", n as f64 / t.elapsed().as_secs_f64());
    }
    let t = Instant::now();
    for s in 0..20000 {
        std::hint::black_box(Sim::new(&cell, s));
    }
    println!("new {:?}", t.elapsed() / 20000);
    let t = Instant::now();
    for _ in 0..20000 {
        std::hint::black_box(base.clone());
    }
    println!("clone {:?}", t.elapsed() / 20000);
    let bare = Cell::bare();
    let t = Instant::now();
    for s in 0..20000 {
        std::hint::black_box(Sim::new(&bare, s));
    }
    println!("bare new {:?}", t.elapsed() / 20000);
    let mut sim = Sim::new(&bare, 1);
    let a = sim.joints();
    let t = Instant::now();
    for _ in 0..100000 {
        sim.execute(&mv(Goal::Joints(START), Path::Joint, Speed::Normal, None)).unwrap();
        sim.execute(&mv(Goal::Joints(a), Path::Joint, Speed::Normal, None)).unwrap();
    }
    println!("bare move {:?}", t.elapsed() / 200000);
    let mut sim = base.clone();
    sim.set_output(0, true).unwrap();
    let t = Instant::now();
    for _ in 0..20000 {
        sim.execute(&mv(Goal::Joints(START), Path::Joint, Speed::Normal, None)).unwrap();
        sim.execute(&mv(Goal::Joints(HANDLE), Path::Joint, Speed::Normal, None)).unwrap();
    }
    println!("cell joint move {:?}", t.elapsed() / 40000);
    sim.execute(&mv(Goal::Joints(START), Path::Joint, Speed::Normal, None)).unwrap();
    let g = |d| {
        mv(
            Goal::Displaced { from: START, distance_m: d, axis: Axis::PlusZ, frame: Frame::Tcp },
            Path::Linear,
            Speed::Slow,
            Some(5.0),
        )
    };
    let t = Instant::now();
    for _ in 0..20000 {
        sim.execute(&g(0.1)).unwrap();
        sim.execute(&g(0.0)).unwrap();
    }
    println!("cell 100mm free linear {:?}", t.elapsed() / 40000);
    use obverse_sim::kinematics::*;
    let t = Instant::now();
    let mut acc = 0.0;
    let n = 4_000_000;
    for i in 0..n {
        let mut j = START;
        j.0[0] += i as f64 * 1e-7;
        j.0[2] += i as f64 * 1e-7;
        acc += forward(&j).translation_m.x;
    }
    println!("fk {:.1} M/s {acc}", n as f64 / t.elapsed().as_secs_f64() / 1e6);
    let poses: Vec<_> = (0..1000)
        .map(|i| {
            let mut j = START;
            j.0[0] += i as f64 * 1e-3;
            j.0[2] += i as f64 * 1e-4;
            forward(&j)
        })
        .collect();
    let t = Instant::now();
    let mut k = 0;
    for _ in 0..1000 {
        for p in &poses {
            k += inverse(p, &START).as_slice().len();
        }
    }
    println!("ik {:.1} k/s {k}", 1e6 / t.elapsed().as_secs_f64() / 1e3);
}
