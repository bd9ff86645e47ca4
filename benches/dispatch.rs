//! The machine: forward without a tape, forward with one, and in reverse, on the same programs.
//!
//! `OBVERSE_FIGURES=1 cargo bench -p obverse-benches --bench dispatch` prints the ratios of one
//! run, each from the fastest of many interleaved rounds, so that a noisy machine disturbs all
//! alike.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use obverse_benches::{SOURCES, machine, program, timed};
use obverse_testkit::Ledger;
use obverse_vm::Direction;
use std::time::Duration;

fn dispatch(criterion: &mut Criterion) {
    let mut cell = Ledger::new(1);
    for (name, source) in SOURCES {
        let program = program(name, source);
        let mut probe = machine(&program, &cell);
        timed(&mut probe, Direction::Forward, &mut cell);
        let mut group = criterion.benchmark_group("dispatch");
        group.throughput(Throughput::Elements(probe.executed())).sample_size(20);
        group.bench_function(format!("forward/{name}"), |bencher| {
            bencher.iter_custom(|rounds| {
                let run = |_| {
                    let mut untaped = machine(&program, &cell).without_tape();
                    timed(&mut untaped, Direction::Forward, &mut cell)
                };
                (0..rounds).map(run).sum()
            });
        });
        let mut taped = machine(&program, &cell);
        let mut there_and_back = |measured: Direction, rounds: u64| -> Duration {
            let run = |_| {
                let forward = timed(&mut taped, Direction::Forward, &mut cell);
                let reverse = timed(&mut taped, Direction::Reverse, &mut cell);
                if measured == Direction::Forward { forward } else { reverse }
            };
            (0..rounds).map(run).sum()
        };
        group.bench_function(format!("forward_taped/{name}"), |bencher| {
            bencher.iter_custom(|rounds| there_and_back(Direction::Forward, rounds));
        });
        group.bench_function(format!("reverse/{name}"), |bencher| {
            bencher.iter_custom(|rounds| there_and_back(Direction::Reverse, rounds));
        });
    }
}

/// The ratios, as a table.
#[expect(clippy::print_stdout, reason = "a benchmark reports on standard output")]
fn figures(_: &mut Criterion) {
    if std::env::var_os("OBVERSE_FIGURES").is_none() {
        return;
    }
    println!("program    instructions   M/s taped   taped/plain   reverse/taped   tape bits/instr");
    let mut cell = Ledger::new(1);
    for (name, source) in SOURCES {
        let program = program(name, source);
        let mut taped = machine(&program, &cell);
        let mut best = [Duration::MAX; 3];
        let (mut instructions, mut bits) = (0, 0);
        for _ in 0..40 {
            let mut plain = machine(&program, &cell).without_tape();
            best[0] = best[0].min(timed(&mut plain, Direction::Forward, &mut cell));
            best[1] = best[1].min(timed(&mut taped, Direction::Forward, &mut cell));
            instructions = taped.state().steps();
            bits = taped.tape().map_or(0, obverse_tape::Tape::recorded_bits);
            best[2] = best[2].min(timed(&mut taped, Direction::Reverse, &mut cell));
        }
        let [plain, forward, reverse] = best.map(|took| took.as_secs_f64());
        println!(
            "{name:10} {instructions:12} {:11.0} {:13.2} {:15.2} {:17.2}",
            instructions as f64 / forward / 1e6,
            forward / plain,
            reverse / forward,
            bits as f64 / instructions as f64
        );
    }
}

criterion_group!(benches, dispatch, figures);
criterion_main!(benches);
