//! A run that records more than the tape has memory for is the same as its steps: getting memory in
//! the middle of it does nothing twice and leaves nothing out.

use obverse_bytecode::{Verified, verify};
use obverse_testkit::Ledger;
use obverse_vm::{Direction, Limits, Machine, Stop};

/// Joins reached both ways, stores, counters of loops that go round and of some that do not.
const SOURCE: &str = "var total = 0
sequence main {
  var x = 1
  for i from 1 to 900 {
    x = (x * 31 + i) mod 1009
    if x mod 3 == 0 { total += x } else { total = total + x * i }
    for j from 1 to x mod 4 { if j == 2 { x = x + j } }
    while x mod 5 > 2 { x = x - 1 }
  }
}";

fn program() -> Verified {
    let module = obverse_compiler::compile("long.obv", SOURCE).module.expect("it compiles");
    verify(module).expect("it verifies")
}

#[test]
fn a_run_that_needs_memory_on_the_way_is_its_steps() {
    let program = program();
    let mut cell = Ledger::new(1);
    let mut at_once = Machine::new(&program, &cell).expect("it links");
    let mut by_steps = at_once.clone();
    let start = at_once.digest(&cell);

    let stop = at_once.run(Direction::Forward, Limits::NONE, &mut cell, &mut ());
    assert_eq!(stop, Stop::Finished);
    while by_steps.step(Direction::Forward, &mut cell, &mut ()).is_ok() {}
    assert_eq!(by_steps.digest(&cell), at_once.digest(&cell));
    let streams = |machine: &Machine<'_>| machine.tape().map(obverse_tape::Tape::streams);
    assert!(streams(&by_steps) == streams(&at_once), "the tapes differ");
    let place = at_once.tape().expect("it has a tape").place();
    assert!(place.bits > 2000 && place.words > 4096, "it needs memory: {place:?}");

    let stop = at_once.run(Direction::Reverse, Limits::NONE, &mut cell, &mut ());
    assert_eq!(stop, Stop::AtStart);
    assert_eq!(at_once.digest(&cell), start);
    while by_steps.step(Direction::Reverse, &mut cell, &mut ()).is_ok() {}
    assert_eq!(by_steps.digest(&cell), start);
}

#[test]
fn a_copy_of_a_machine_goes_on_as_the_machine_does() {
    let program = program();
    let mut cell = Ledger::new(1);
    let mut machine = Machine::new(&program, &cell).expect("it links");
    let start = machine.digest(&cell);
    for budget in [1, 100, 10_000] {
        machine.run(Direction::Forward, Limits::instructions(budget), &mut cell, &mut ());
        let mut copy = machine.clone();
        assert_eq!(copy.run(Direction::Forward, Limits::NONE, &mut cell, &mut ()), Stop::Finished);
        assert_eq!(copy.run(Direction::Reverse, Limits::NONE, &mut cell, &mut ()), Stop::AtStart);
        assert_eq!(copy.digest(&cell), start, "copied after {budget} instructions");
    }
}
