//! Campaigns: whole assemblies a second, on one thread and on all cores.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use obverse_benches::program;
use obverse_recovery::Memory;
use obverse_sim::Cell;
use obverse_trials::machine::Terms;
use obverse_trials::{MachineCase, Plan, Shard, Strategy};
use std::convert::Infallible;
use std::hint::black_box;
use std::num::NonZero;

const RUNS: u64 = 512;

fn plan() -> Plan {
    Plan {
        version: String::new(),
        program: String::new(),
        program_digest: String::new(),
        cell_digest: String::new(),
        memory_digest: None,
        goals: 0,
        sequences: 1,
        strategies: vec![Strategy::Explicit],
        seed: 0,
        runs: RUNS,
        person_s: 300.0,
        releases: 0,
        instructions: 1_000_000,
    }
}

fn assemblies(criterion: &mut Criterion) {
    let verified = program("peg_in_hole.obv", include_str!("../programs/peg_in_hole.obv"));
    let cell = match Cell::parse(include_str!("../programs/peg_in_hole.toml")) {
        Ok(cell) => cell,
        Err(error) => panic!("{error}"),
    };
    let terms = Terms { person_s: 300.0, releases: 0, instructions: 1_000_000 };
    let case = match MachineCase::new(&verified, &cell, terms) {
        Ok(case) => case,
        Err(errors) => panic!("{errors:?}"),
    };
    let (plan, memory) = (plan(), Memory::default());
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    let mut group = criterion.benchmark_group("assemblies");
    group.throughput(Throughput::Elements(RUNS));
    for (name, jobs) in [("one_thread", 1), ("all_cores", cores)] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let keep = |records| {
                    black_box::<Vec<_>>(records);
                    Ok::<(), Infallible>(())
                };
                let runs = Shard::WHOLE.runs(plan.runs);
                let Ok(()) = obverse_trials::run(&case, &memory, &plan, runs, jobs, keep);
            });
        });
    }
}

criterion_group!(benches, assemblies);
criterion_main!(benches);
