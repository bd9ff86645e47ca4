//! The tape: pushing and popping records, and what instructions cost on it.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use obverse_geometry::JointConfiguration;
use obverse_tape::{Recorder, Tape};
use std::hint::black_box;

const RECORDS: u64 = 100_000;

fn tape(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("tape");
    group.throughput(Throughput::Elements(RECORDS));
    let mut tape = Tape::default();
    let start = tape.place();
    group.bench_function("bits", |bencher| {
        bencher.iter(|| {
            for number in 0..RECORDS {
                tape.bit(black_box(number & 3 == 0));
            }
            tape.cut(start);
        });
    });
    group.bench_function("words", |bencher| {
        bencher.iter(|| {
            for number in 0..RECORDS {
                tape.word(black_box(number));
            }
            tape.cut(start);
        });
    });
    group.bench_function("joints", |bencher| {
        bencher.iter(|| {
            for _ in 0..RECORDS {
                tape.joints(black_box(JointConfiguration::ZERO));
            }
            tape.cut(start);
        });
    });
}

criterion_group!(benches, tape);
criterion_main!(benches);
