//! The front end: lines a second of lexing and parsing, and of all that leads to a module.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::fmt::Write;

/// What every sequence does.
const BODY: &str = "
  var offset = gap * 2 + 0.5 mm
  var rounds = times mod 7
  io gripper_open
  move to start
  while rounds > 0 {
    if input 3 and rounds < 5 {
      move 20 mm up in base
      done += 1
    } else {
      offset = offset + 1 mm
      wait 0.1 s
    }
    rounds -= 1
  }
  for i from 1 to 3 {
    done += i * 2
  }
  speed slow { move to start linearly }";

/// A program of so many sequences, each of some twenty lines.
fn long_program(sequences: usize) -> String {
    let mut text = String::from("joints start = [0.1, -1.2, 1.3, -1.7, -1.57, 0.3] rad\n");
    text.push_str("io gripper_open { set 0 low; sleep 0.5 s }\nvar done = 0\n\n");
    for index in 0..sequences {
        let _ = writeln!(text, "sequence part_{index}(gap: length, times: int) {{{BODY}");
        let _ = writeln!(text, "  checkpoint after_{index}\n}}\n");
    }
    text.push_str("sequence main {\n");
    for index in 0..sequences {
        let _ = writeln!(text, "  call part_{index}(3 mm, {index})");
    }
    text.push_str("}\n");
    text
}

fn front(criterion: &mut Criterion) {
    let text = long_program(2_000);
    let lines = text.lines().count() as u64;
    let mut group = criterion.benchmark_group("front");
    group.throughput(Throughput::Elements(lines)).sample_size(10);
    group.bench_function("parse", |bencher| {
        bencher.iter(|| {
            let parsed = obverse_syntax::parse(&text);
            assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics.first());
        });
    });
    group.bench_function("compile", |bencher| {
        bencher.iter(|| {
            let compiled = obverse_compiler::compile("long.obv", &text);
            assert!(compiled.module.is_some(), "{:?}", compiled.diagnostics.first());
        });
    });
}

criterion_group!(benches, front);
criterion_main!(benches);
