//! Errors that answer each other: what one recovery does, the other one undoes. Each pair ends by a
//! bound, and it is named.

use super::*;

/// `a` wants output 5 high, which its sequence sets; `b` wants it low, and goes back to before.
fn pair(bounds_of_b: &str) -> Case {
    let source = format!(
        "
        error a {{ recover using raise_it  then return to action }}
        error b {{ recover by reversing 3 actions  {bounds_of_b}  then return to action }}
        sequence raise_it {{ set 5 high }}
        sequence main {{
          set 1 high
          call wants_high()
          move 10 mm up
          call wants_low()
        }}
        action wants_high() {{ move 10 mm up  requires input 0 else throw a }}
        action wants_low() {{ move 10 mm up  if input 0 {{ throw b }} }}
    "
    );
    let mut case = Case::new(&source, NEVER_S);
    let mut cell = Cell::bare();
    cell.inputs[0] = InputRule::FollowsOutput { output: 5, delay_s: 0.0 };
    case.sim = Sim::new(&cell, 0);
    case
}

/// The incidents of an error of the pair, by number.
fn incidents_of(run: &Run, error: u16) -> Vec<&Incident> {
    run.incidents.iter().filter(|incident| incident.error.0 == error).collect()
}

#[test]
fn a_pair_ends_by_the_bound_of_the_error_that_the_run_never_gets_past() {
    let run = pair("").run();
    assert!(matches!(run.ending, Ending::Unhandled(_)), "{:?}", run.ending);
    let [b] = incidents_of(&run, 1)[..] else { panic!("{:?}", run.incidents) };
    assert_eq!(b.attempts.len(), 8);
    assert_eq!(b.outcome.map(|(outcome, _)| outcome), Some(Outcome::GivenUp(GiveUp::Attempts(8))));
    // Each attempt at the one leads to the other once more, and into its sequence.
    assert_eq!(incidents_of(&run, 0).len(), 9);
    assert!(run.is_identical);
}

#[test]
fn a_pair_whose_errors_allow_more_ends_where_nothing_gets_the_run_any_further() {
    let run = pair("give up after 1000 times").run();
    assert!(matches!(run.ending, Ending::Unhandled(_)), "{:?}", run.ending);
    let [b] = incidents_of(&run, 1)[..] else { panic!("{:?}", run.incidents) };
    let Some((Outcome::GivenUp(why), _)) = b.outcome else { panic!("{b:?}") };
    assert_eq!((why.code(), b.attempts.len()), ("stuck", 64));
    assert!(run.is_identical);
}

#[test]
fn two_sequences_that_throw_the_errors_of_each_other_end_at_the_first() {
    let source = "
        error a { recover using one  then return to action }
        error b { recover using other  then return to action }
        sequence one { move 10 mm up  throw b }
        sequence other { move 10 mm up  throw a }
        sequence main { move 10 mm up  if not input 0 { throw a }  set 6 high }
    ";
    let run = Case::new(source, NEVER_S).run();
    let Ending::Unhandled(pending) = &run.ending else { panic!("{:?}", run.ending) };
    assert_eq!(pending.len(), 2, "what was recovered from, and what went wrong with that");
    assert!(!run.sim.output(6) && run.steps.forward <= 3, "{}", run.steps.forward);
    assert!(run.is_identical);
}
