//! The debugger over a run of ten million instructions: what recording it costs, how fast any
//! moment of it is reached, how fast the last change of something is found, and what a step back
//! takes.
//!
//! `OBVERSE_FIGURES=1 cargo bench -p obverse-benches --bench history` prints the figures with their
//! worst cases.

use criterion::{Criterion, criterion_group, criterion_main};
use obverse_benches::{machine, program, timed};
use obverse_bytecode::Verified;
use obverse_debugger::drive::Pace;
use obverse_debugger::recording::{Moment, Order};
use obverse_debugger::{Expression, Grain, Run, Session, Walk};
use obverse_testkit::Ledger;
use obverse_vm::Direction;
use std::time::{Duration, Instant};

const SOURCE: &str = include_str!("programs/long.obv");
/// How often steps back are taken from the same end.
const RUNS: usize = 7;
/// What is asked for: a change long ago, one just now, one that only commands make, a mixture, and
/// what never came to hold of something that changes all the time.
const ASKED: [&str; 7] = [
    "_early",
    "_sum",
    "output 2",
    "_early > 0 and output 2",
    "_sum == 5",
    "_early == 2 and x > 3",
    "steps < 100",
];

fn recorded(program: &Verified) -> (Run<'_, Ledger>, Duration) {
    let run = Run::new(program, Ledger::new(1));
    let Ok(mut run) = run else { panic!("the program links") };
    let begin = Instant::now();
    while run.drive(Order::Forward, Pace::Run(1 << 18), &mut ()).is_some_and(|it| it.stop.is_none())
    {
    }
    (run, begin.elapsed())
}

fn asked(session: &Session<'_, Ledger>, text: &str) -> Expression {
    let module = session.module();
    let main = module.functions.iter().position(|function| function.name == "main");
    match Expression::parse(module, main.unwrap_or(0), text) {
        Ok(expression) => expression,
        Err(error) => panic!("{text}: {error}"),
    }
}

/// Moments all over a run, in no order.
fn moments(end: Moment, count: u64) -> impl Iterator<Item = Moment> {
    (0..count).map(move |number| Moment(number.wrapping_mul(0x9e37_79b9_7f4a_7c15) % end.0))
}

fn history(criterion: &mut Criterion) {
    let program = program("long.obv", SOURCE);
    let (run, _) = recorded(&program);
    let end = run.recording().end;
    let mut group = criterion.benchmark_group("history");
    group.sample_size(10);
    let mut shown = run.rewound();
    let mut places = moments(end, u64::MAX);
    group.bench_function("position", |bencher| {
        bencher.iter(|| {
            let moment = places.next().unwrap_or(end);
            shown.go_to(run.recording(), run.timeline(), moment);
        });
    });
    let mut session = Session::over(run);
    for text in ASKED {
        let expression = asked(&session, text);
        group.bench_function(format!("last_change/{text}"), |bencher| {
            bencher.iter(|| session.last_change(&expression));
        });
    }
    let step = Walk::Step(Grain::Instruction);
    group.bench_function("reverse_step/live", |bencher| {
        bencher.iter(|| session.go(Direction::Reverse, step));
    });
}

fn seconds(work: impl FnOnce()) -> f64 {
    let begin = Instant::now();
    work();
    begin.elapsed().as_secs_f64()
}

/// The mean and the worst of some times, in milliseconds.
fn shown_ms(times_s: &[f64]) -> String {
    let mean_s = times_s.iter().sum::<f64>() / times_s.len() as f64;
    let worst_s = times_s.iter().copied().fold(0.0, f64::max);
    format!("{:.4} ms, worst {:.4} ms of {}", mean_s * 1e3, worst_s * 1e3, times_s.len())
}

/// The memory that this process holds, in megabytes, where the system says so.
fn held_mb() -> f64 {
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages = statm.split(' ').nth(1).and_then(|pages| pages.parse::<f64>().ok());
    pages.unwrap_or(f64::NAN) * 4096.0 / 1e6
}

/// What a step back takes, live: as it came, and the worst that recurs. A step that is slow in
/// every one of some runs is slow by itself; one that is slow in one of them was interrupted, as
/// the clock is that is asked without any step.
#[expect(clippy::print_stdout, reason = "a benchmark reports on standard output")]
fn tell_steps(program: &Verified) {
    for (grain, name, count) in [
        (Grain::Instruction, "a reverse step", 20_000),
        (Grain::Statement, "a reverse step by a statement", 5_000),
    ] {
        let mut all: Vec<f64> = Vec::new();
        let mut least = vec![f64::INFINITY; count];
        for _ in 0..RUNS {
            let mut session = Session::over(recorded(program).0);
            for least in &mut least {
                let took = seconds(|| drop(session.go(Direction::Reverse, Walk::Step(grain))));
                *least = least.min(took);
                all.push(took);
            }
        }
        let worst = least.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        let (step, worst_s) = worst.unwrap_or_default();
        println!("{name}, live: {}", shown_ms(&all));
        println!("  the worst that recurs in {RUNS} runs: {:.4} ms, step {step}", worst_s * 1e3);
    }
    let nothing: Vec<f64> = (0..RUNS * 20_000).map(|_| seconds(|| ())).collect();
    println!("no step at all: {}", shown_ms(&nothing));
}

/// The figures, as lines.
#[expect(clippy::print_stdout, reason = "a benchmark reports on standard output")]
fn figures(_: &mut Criterion) {
    if std::env::var_os("OBVERSE_FIGURES").is_none() {
        return;
    }
    let program = program("long.obv", SOURCE);
    let before_mb = held_mb();
    let (run, _) = recorded(&program);
    let held_mb = held_mb() - before_mb;
    let (end, copies) = (run.recording().end, run.timeline().len());
    let tape_mb = run.machine().tape().map_or(0, obverse_tape::Tape::held_bytes) as f64 / 1e6;
    println!("{end} instructions, {} commands", run.recording().log.frames.len());
    println!("memory {held_mb:.1} MB, of which the tape is {tape_mb:.1} MB");
    let mut best_s = [f64::INFINITY; 3];
    for _ in 0..20 {
        let mut cell = Ledger::new(1);
        let mut plain = machine(&program, &cell);
        best_s[0] = best_s[0].min(timed(&mut plain, Direction::Forward, &mut cell).as_secs_f64());
        best_s[1] = best_s[1].min(recorded(&program).1.as_secs_f64());
        best_s[2] = best_s[2].min(seconds(|| drop(std::hint::black_box(run.machine().keep()))));
    }
    let [plain_s, recorded_s, copy_s] = best_s;
    println!("run {:.2} ms, recorded {:.2} ms", plain_s * 1e3, recorded_s * 1e3);
    let percent = copy_s * copies as f64 / plain_s * 1e2;
    println!("{copies} copies of {:.3} ms are {percent:.2} % of the run", copy_s * 1e3);
    let mut shown = run.rewound();
    let reach = |moment| seconds(|| shown.go_to(run.recording(), run.timeline(), moment));
    let reached: Vec<f64> = moments(end, 300).map(reach).collect();
    println!("a position: {}", shown_ms(&reached));
    let mut session = Session::over(run);
    for text in ASKED {
        let expression = asked(&session, text);
        let find = |_| seconds(|| drop(std::hint::black_box(session.last_change(&expression))));
        println!("last change of {text}: {}", shown_ms(&(0..20).map(find).collect::<Vec<f64>>()));
    }
    tell_steps(&program);
    let _shown = session.go_to(Moment(end.0 / 2));
    let mut back =
        || seconds(|| drop(session.go(Direction::Reverse, Walk::Step(Grain::Statement))));
    let shown: Vec<f64> = (0..200).map(|_| back()).collect();
    println!("a step back, rewound: {}", shown_ms(&shown));
}

// First what says how much memory is held, while nothing else has been.
criterion_group!(benches, figures, history);
criterion_main!(benches);
