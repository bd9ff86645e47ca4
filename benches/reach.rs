//! Reach: that it is linear in the program. The time an instruction should be about the same at
//! every size, for many short sequences that call each other and for one long one in which points
//! have more and more horizons.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use obverse_benches::program;
use obverse_bytecode::Verified;
use obverse_reach::Reach;
use std::fmt::Write;

/// How many instructions a program is to have.
const SIZES: [u32; 3] = [10_000, 100_000, 1_000_000];

/// The instructions of a round of each, as they compile.
const SEQUENCE: u32 = 32;
const ROUND: u32 = 20;

/// Sequences that branch, loop, cannot always be taken back, and call the one before.
fn sequences(instructions: u32) -> Verified {
    let mut text = String::from("sequence part_0 { wait 1 s }\n");
    let count = instructions / SEQUENCE;
    for index in 1..count {
        let before = if index % 50 == 0 { 0 } else { index - 1 };
        let _ = write!(
            text,
            "sequence part_{index} {{\n  \
             if input 1 {{ call part_{before} }} else {{ wait 1 s }}\n  \
             for i from 1 to 3 {{ move 10 mm up in base if input 2 {{ break }} }}\n  \
             if input 3 {{ irreversible \"cut\" {{ wait 1 s }} }}\n}}\n"
        );
    }
    text.push_str("sequence main {\n");
    (0..count).for_each(|index| _ = writeln!(text, "  call part_{index}"));
    text.push_str("}\n");
    program("sequences.obv", &text)
}

/// One sequence of branches and loops with a barrier in every third.
fn rounds(instructions: u32) -> Verified {
    let mut text = String::from("sequence main {\n");
    for index in 0..instructions / ROUND {
        let barrier = if index % 3 == 0 { "barrier \"drilled\"" } else { "wait 1 s" };
        let _ = writeln!(
            text,
            "  for i from 1 to 2 {{ if input 1 {{ {barrier} }} else {{ wait 2 s }}\n\
             if input 2 {{ break }} }}"
        );
    }
    text.push_str("}\n");
    program("rounds.obv", &text)
}

fn reach(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("reach");
    group.sample_size(10);
    for size in SIZES {
        for (name, program) in [("sequences", sequences(size)), ("rounds", rounds(size))] {
            let module = program.module();
            let instructions = module.code.len();
            group.throughput(Throughput::Elements(instructions as u64));
            group.bench_function(BenchmarkId::new(name, instructions), |bencher| {
                bencher.iter(|| {
                    let reach = Reach::of(module);
                    assert!(reach.is_reached(instructions as u32 - 1));
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, reach);
criterion_main!(benches);
