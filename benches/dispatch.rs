//! The machine: forward without a tape, forward with one, and in reverse, on the same programs.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use obverse_benches::{branches, stores};
use obverse_bytecode::Verified;
use obverse_testkit::Ledger;
use obverse_vm::state::Direction;
use obverse_vm::{Limits, Machine, Stop};
use std::time::{Duration, Instant};

fn machine<'p>(program: &'p Verified, cell: &Ledger) -> Machine<'p> {
    match Machine::new(program, cell) {
        Ok(machine) => machine,
        Err(errors) => panic!("{errors:?}"),
    }
}

fn timed(machine: &mut Machine<'_>, direction: Direction, cell: &mut Ledger) -> Duration {
    let begin = Instant::now();
    let stop = machine.run(direction, Limits::NONE, cell, &mut ());
    let took = begin.elapsed();
    assert!(matches!(stop, Stop::Finished | Stop::AtStart), "{stop:?}");
    took
}

fn dispatch(criterion: &mut Criterion) {
    let mut cell = Ledger::new(1);
    for (name, program) in [("branches", branches(1_000_000)), ("stores", stores(1000))] {
        let mut probe = machine(&program, &cell);
        timed(&mut probe, Direction::Forward, &mut cell);
        let instructions = probe.executed();
        let mut group = criterion.benchmark_group("dispatch");
        group.throughput(Throughput::Elements(instructions)).sample_size(20);
        group.bench_function(format!("forward/{name}"), |bencher| {
            bencher.iter_custom(|rounds| {
                let run = |_| {
                    let mut untaped = machine(&program, &cell).without_tape();
                    timed(&mut untaped, Direction::Forward, &mut cell)
                };
                (0..rounds).map(run).sum()
            });
        });
        group.bench_function(format!("forward_taped/{name}"), |bencher| {
            let mut taped = machine(&program, &cell);
            bencher.iter_custom(|rounds| {
                let run = |_| {
                    let took = timed(&mut taped, Direction::Forward, &mut cell);
                    timed(&mut taped, Direction::Reverse, &mut cell);
                    took
                };
                (0..rounds).map(run).sum()
            });
        });
        group.bench_function(format!("reverse/{name}"), |bencher| {
            let mut taped = machine(&program, &cell);
            bencher.iter_custom(|rounds| {
                let run = |_| {
                    timed(&mut taped, Direction::Forward, &mut cell);
                    timed(&mut taped, Direction::Reverse, &mut cell)
                };
                (0..rounds).map(run).sum()
            });
        });
    }
}

criterion_group!(benches, dispatch);
criterion_main!(benches);
