//! Errors that come up again on the way forward from another, and what former attempts took.

use crate::{Case, NEVER_S, program, run};
use obverse_recovery::Ending;
use obverse_sim::cell::InputRule;
use obverse_sim::{Cell, Sim};

const TWO_ERRORS: &str = "
error late  { recover by reversing 1 action respond after current action then return to action }
error later { recover by reversing 2 actions respond after current action then return to action }
sequence main {
  set 1 high
  move 10 mm up
  call asks()
  call wants()
}
action asks() {
  move 100 mm up
  if not input 0 { throw late }
}
action wants() {
  move 100 mm up
  if not input 1 { throw later }
}
";

/// How often each error was an incident, and after how many attempts, with inputs that change so.
fn incidents(inputs: [&[(f64, bool)]; 2]) -> Vec<(u16, usize)> {
    let mut cell = Cell::bare();
    for (input, changes) in cell.inputs.iter_mut().zip(inputs) {
        *input = InputRule::At(changes.to_vec());
    }
    let mut case = Case::new(TWO_ERRORS, NEVER_S);
    case.sim = Sim::new(&cell, 0);
    let run = case.run();
    assert_eq!(run.ending, Ending::Finished);
    let of = |incident: &obverse_recovery::Incident| (incident.error.0, incident.attempts.len());
    run.incidents.iter().map(of).collect()
}

/// The first error comes up on the way forward from the second and is got past; the second leads
/// back over it, and it comes up again: what was done about it has not helped for good, so it is
/// tried on, not from the beginning.
#[test]
fn what_comes_up_again_over_the_way_back_of_another_is_the_same_incident() {
    let flickers = [(3.0, true), (6.0, false), (9.5, true), (12.0, false), (16.0, true)];
    assert_eq!(incidents([&flickers, &[(13.0, true)]]), [(0, 1), (0, 2), (1, 2)]);
    // Without the second error it is got past once.
    assert_eq!(incidents([&flickers, &[(0.0, true)]]), [(0, 1)]);
}

/// What led to an action takes no longer because it was tried to get past it meanwhile.
#[test]
fn what_attempts_took_is_not_expected_again_of_the_next() {
    let policy = "recover by reversing escalating up to 4 actions";
    let free = run(policy, NEVER_S);
    assert_eq!(free.depths()[..5], [1, 2, 3, 4, 4]);
    let incident = &free.incidents[0];
    let four_s = incident.attempts[4].began_s - incident.began_s;
    let mut case = Case::new(&program(policy), NEVER_S);
    let none = obverse_bytecode::Bounds::default();
    case.module.errors[0].bounds = obverse_bytecode::Bounds { time_s: Some(four_s + 1.5), ..none };
    assert_eq!(case.run().depths(), [1, 2, 3, 4]);
}
