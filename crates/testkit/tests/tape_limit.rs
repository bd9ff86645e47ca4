//! A tape that holds as much as it may stops the run going forward, and never going back.

use obverse_bytecode::verify;
use obverse_testkit::Ledger;
use obverse_vm::{Direction, Limits, Machine, Stop, TrapKind};

const SOURCE: &str = "sequence main { var x = 0 while x > -1 { x = (x * 3 + 1) mod 1000 } }";
const LIMIT_BYTES: usize = 1 << 17;

#[test]
fn a_full_tape_stops_the_run_and_leads_back_to_the_start() {
    let module = obverse_compiler::compile("full.obv", SOURCE).module.expect("it compiles");
    let program = verify(module).expect("it verifies");
    let mut cell = Ledger::new(1);
    let machine = Machine::new(&program, &cell).expect("it links");
    let mut machine = machine.with_tape_limit(LIMIT_BYTES);
    let (start, mark) = (machine.digest(&cell), machine.mark());

    let full = machine.run(Direction::Forward, Limits::NONE, &mut cell, &mut ());
    assert!(matches!(full, Stop::Trap(trap) if trap.kind == TrapKind::TapeFull), "{full:?}");
    let held = machine.tape().expect("it has a tape").held_bytes();
    assert!(held < 4 * LIMIT_BYTES, "{held} bytes");

    let back = machine.run(Direction::Reverse, Limits::instructions(1), &mut cell, &mut ());
    assert_eq!(back, Stop::Budget, "a full tape does not stand in the way");
    assert_eq!(machine.reverse_to(mark, &mut cell, &mut ()), Stop::AtMark);
    assert_eq!(machine.digest(&cell), start);
}
