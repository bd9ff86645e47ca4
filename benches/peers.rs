//! The same loops on the machine, on Lua 5.4 and on wasmi, interleaved in one run:
//! `cargo bench -p obverse-benches --features peers --bench peers`.
//!
//! Each figure is the fastest of many rounds, so that a noisy machine disturbs all alike; what
//! counts are the ratios. All three must come to the same number.

use mlua::Lua;
use obverse_benches::{SOURCES, machine, program, timed};
use obverse_testkit::Ledger;
use obverse_vm::{Direction, Machine};
use std::time::{Duration, Instant};

/// The variables that hold what the programs come to.
const RESULTS: [&str; 2] = ["_odd", "_checksum"];

const LUA: [&str; 2] = [
    "local total, rest = 0, 0
     for i = 1, 1000000 do
       if i % 2 == 0 then total = total + i * 3 else total = total - i end
       if i % 3 == 0 then rest = rest + 1 else rest = rest - (total - i * 2) end
     end
     return rest",
    "local best, check = 0, 1
     for start = 1, 3000 do
       local x, steps = start, 0
       while x ~= 1 do
         if x % 2 == 0 then x = x // 2 else x = x * 3 + 1 end
         steps = steps + 1
       end
       if steps > best then best = steps end
       check = (check * 31 + steps) % 1000003
     end
     return check",
];

const WASM: [&str; 2] = [
    r#"(module (func (export "main") (result i64)
        (local $i i64) (local $total i64) (local $rest i64)
        (local.set $i (i64.const 1))
        (loop $top
          (if (i64.eqz (i64.rem_s (local.get $i) (i64.const 2)))
            (then (local.set $total
              (i64.add (local.get $total) (i64.mul (local.get $i) (i64.const 3)))))
            (else (local.set $total (i64.sub (local.get $total) (local.get $i)))))
          (if (i64.eqz (i64.rem_s (local.get $i) (i64.const 3)))
            (then (local.set $rest (i64.add (local.get $rest) (i64.const 1))))
            (else (local.set $rest (i64.sub (local.get $rest)
              (i64.sub (local.get $total) (i64.mul (local.get $i) (i64.const 2)))))))
          (local.set $i (i64.add (local.get $i) (i64.const 1)))
          (br_if $top (i64.le_s (local.get $i) (i64.const 1000000))))
        (local.get $rest)))"#,
    r#"(module (func (export "main") (result i64)
        (local $start i64) (local $x i64) (local $steps i64) (local $best i64) (local $check i64)
        (local.set $check (i64.const 1))
        (local.set $start (i64.const 1))
        (loop $outer
          (local.set $x (local.get $start))
          (local.set $steps (i64.const 0))
          (block $done (loop $top
            (br_if $done (i64.eq (local.get $x) (i64.const 1)))
            (if (i64.eqz (i64.rem_s (local.get $x) (i64.const 2)))
              (then (local.set $x (i64.div_s (local.get $x) (i64.const 2))))
              (else (local.set $x (i64.add (i64.mul (local.get $x) (i64.const 3)) (i64.const 1)))))
            (local.set $steps (i64.add (local.get $steps) (i64.const 1)))
            (br $top)))
          (if (i64.gt_s (local.get $steps) (local.get $best))
            (then (local.set $best (local.get $steps))))
          (local.set $check (i64.rem_s
            (i64.add (i64.mul (local.get $check) (i64.const 31)) (local.get $steps))
            (i64.const 1000003)))
          (local.set $start (i64.add (local.get $start) (i64.const 1)))
          (br_if $outer (i64.le_s (local.get $start) (i64.const 3000))))
        (local.get $check)))"#,
];

#[expect(clippy::print_stdout, reason = "a benchmark reports on standard output")]
fn main() {
    let rounds = if std::env::args().any(|argument| argument == "--test") { 1 } else { 30 };
    println!("milliseconds, the fastest of {rounds} interleaved rounds");
    println!("program     obverse with tape   Lua 5.4   wasmi   obverse/Lua   obverse/wasmi");
    for (index, (name, source)) in SOURCES.into_iter().enumerate() {
        let program = program(name, source);
        let mut cell = Ledger::new(1);
        let mut taped = machine(&program, &cell);
        let lua = Lua::new();
        let chunk = expect(lua.load(LUA[index]).into_function());
        let mut wasm = wasm(WASM[index]);
        let mut best = [Duration::MAX; 3];
        for _ in 0..rounds {
            best[0] = best[0].min(timed(&mut taped, Direction::Forward, &mut cell));
            let ours = result(&taped, RESULTS[index]);
            let theirs = [expect(chunk.call::<i64>(())), wasm()];
            assert_eq!([ours; 2], theirs, "{name}: left Obverse twice, right Lua and wasmi");
            timed(&mut taped, Direction::Reverse, &mut cell);
            best[1] = best[1].min(clock(|| expect(chunk.call::<i64>(()))));
            best[2] = best[2].min(clock(&mut wasm));
        }
        let [ours, lua, wasmi] = best.map(|took| took.as_secs_f64() * 1e3);
        println!(
            "{name:10} {ours:18.2} {lua:9.2} {wasmi:7.2} {:13.2} {:15.2}",
            ours / lua,
            ours / wasmi
        );
    }
}

/// An integer variable of a program.
fn result(machine: &Machine<'_>, name: &str) -> i64 {
    let globals = &machine.program().module().globals;
    let Some(index) = globals.iter().position(|global| global.name == name) else {
        panic!("there is no variable {name}")
    };
    machine.state().globals()[index].cast_signed()
}

fn clock(run: impl FnOnce() -> i64) -> Duration {
    let begin = Instant::now();
    std::hint::black_box(run());
    begin.elapsed()
}

fn wasm(text: &str) -> impl FnMut() -> i64 {
    let engine = wasmi::Engine::default();
    let module = expect(wasmi::Module::new(&engine, text));
    let mut store = wasmi::Store::new(&engine, ());
    let instance = expect(wasmi::Linker::new(&engine).instantiate_and_start(&mut store, &module));
    let main = expect(instance.get_typed_func::<(), i64>(&store, "main"));
    move || expect(main.call(&mut store, ()))
}

fn expect<T, E: std::fmt::Display>(result: Result<T, E>) -> T {
    match result {
        Ok(value) => value,
        Err(error) => panic!("{error}"),
    }
}
