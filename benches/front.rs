//! The front end: lines a second of lexing and parsing, and of all that leads to a module, on a
//! program of a million lines; and what it takes to say that a program is wrong.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use obverse_testkit::large;

/// How long the program is: a million lines, or little where it is only tried whether this runs.
fn lines() -> usize {
    if std::env::args().any(|argument| argument == "--test") { 1_000 } else { 1_000_000 }
}

fn front(criterion: &mut Criterion) {
    let text = large::program(lines());
    let mut group = criterion.benchmark_group("front");
    group.throughput(Throughput::Elements(text.lines().count() as u64)).sample_size(10);
    group.bench_function("parse", |bencher| {
        bencher.iter(|| {
            let parsed = obverse_syntax::parse(&text);
            assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics.first());
        });
    });
    group.bench_function("compile", |bencher| {
        bencher.iter(|| {
            let compiled = obverse_compiler::compile("line.obv", &text);
            assert!(compiled.module.is_some(), "{:?}", compiled.diagnostics.first());
        });
    });
    // A slip in each station: what cannot be known before all has been read.
    let wrong = text.replace("advance insert", "advance isnert");
    group.bench_function("mistakes", |bencher| {
        bencher.iter(|| {
            let compiled = obverse_compiler::compile("line.obv", &wrong);
            assert!(compiled.module.is_none());
        });
    });
}

criterion_group!(benches, front);
criterion_main!(benches);
