//! What bounds a recovery over the whole of a run, wherever the program goes on.

use crate::{Case, NEVER_S, Run};
use obverse_recovery::{Ending, GiveUp, Incident, Outcome};
use obverse_workcell::DigitalIo;

fn outcomes(run: &Run) -> Vec<Outcome> {
    run.incidents.iter().map(|incident| incident.outcome.unwrap().0).collect()
}

fn attempts(run: &Run) -> usize {
    run.incidents.iter().map(|incident| incident.attempts.len()).sum()
}

fn begun_anew(then: &str) -> Run {
    let source = format!(
        "error late {{
          recover by reversing 9 actions
          give up after 2 times
          otherwise using other
          then {then}
        }}
        sequence other {{ toggle 5 }}
        sequence main {{ set 1 high  move 10 mm up  set 2 high  throw late }}"
    );
    Case::new(&source, NEVER_S).run()
}

#[test]
fn what_was_given_up_is_not_gone_back_for_again_where_the_sequence_or_the_program_begins_anew() {
    for then in ["return to action", "return to sequence", "restart program"] {
        let run = begun_anew(then);
        assert!(matches!(run.ending, Ending::Unhandled(_)), "{then}: {:?}", run.ending);
        let outcomes = outcomes(&run);
        assert_eq!(outcomes[0], Outcome::GivenUp(GiveUp::Attempts(2)), "{then}");
        let before = Outcome::GivenUp(GiveUp::Before);
        assert!(outcomes[1..].iter().all(|outcome| *outcome == before), "{then}: {outcomes:?}");
        // Three rounds of the program's own, and one that is one too many.
        assert_eq!((attempts(&run), outcomes.len()), (2, 4), "{then}");
        assert!(run.is_identical, "{then}");
    }
}

#[test]
fn nothing_goes_back_over_what_follows_a_recovery_that_was_given_up() {
    // `later` asks for more actions than there are since `late` was given up and got past.
    let source = "
        error late { recover by reversing 2 actions  give up after 1 times  otherwise using other
                     then continue }
        error later { recover by reversing 9 actions  give up after 1 times }
        sequence other { set 3 high }
        sequence main { move 10 mm up  throw late  move 10 mm down  set 4 high  throw later }
    ";
    let run = Case::new(source, NEVER_S).run();
    let depths: Vec<Vec<usize>> = run.incidents.iter().map(Incident::depths).collect();
    assert_eq!(depths, [vec![1], vec![2]], "the move down and `set 4 high`, and not `set 3 high`");
    assert!(run.sim.output(3) && run.is_identical);
}

#[test]
fn nor_where_the_program_begins_something_anew_and_another_error_comes_up_there() {
    // `away` is run, and then `other` asks to go back further than what has begun since.
    let depths = |recovery: &str, then: &str| {
        let source = format!(
            "error late {{ {recovery} away  then {then} }}
            error other {{ recover by reversing 20 actions  give up after 1 times }}
            sequence away {{ set 2 high  move 50 mm up }}
            sequence main {{
              set 5 high
              if input 0 {{ throw other }}
              throw late
            }}"
        );
        // The input comes high while `away` moves.
        let run = Case::new(&source, 0.3).run();
        assert!(run.sim.output(2), "{recovery} {then}: `away` stays done");
        run.incidents.last().unwrap().depths()
    };
    let reversing = "recover by reversing 1 action  give up after 1 times  otherwise using";
    for recovery in ["recover using", reversing] {
        for then in ["return to sequence", "restart program"] {
            assert_eq!(depths(recovery, then), [1], "{recovery} {then}");
        }
    }
}

#[test]
fn what_cannot_be_taken_back_in_what_follows_is_not_past_it() {
    let source = "
        error late { recover by reversing 1 action  give up after 2 times  otherwise using other
                     then return to action }
        sequence other { set 3 high  barrier \"it is glued\"  set 4 high }
        sequence main { set 1 high  call asks() }
        action asks() { wait 1 s  if not input 0 { throw late } }
    ";
    let run = Case::new(source, NEVER_S).run();
    assert!(matches!(run.ending, Ending::Unhandled(_)), "{:?}", run.ending);
    assert_eq!((attempts(&run), outcomes(&run).len()), (2, 4));
}

#[test]
fn what_the_run_got_past_may_be_gone_back_for_again() {
    let given_up = |then: &str| {
        let source = format!(
            "error late {{ recover by reversing 1 action  give up after 2 times
                           otherwise using other  then {then} }}
            sequence other {{ toggle 3 }}
            sequence part {{ move 10 mm up  if not input 0 {{ throw late }}  move 10 mm down }}
            sequence main {{ repeat 3 times {{ call part }} }}"
        );
        Case::new(&source, NEVER_S).run()
    };
    let run = given_up("continue");
    assert_eq!(run.ending, Ending::Finished);
    assert_eq!(outcomes(&run), [Outcome::GivenUp(GiveUp::Attempts(2)); 3]);
    assert_eq!(attempts(&run), 6);
}

#[test]
fn a_wait_is_not_waited_going_back_and_not_expected_to_be() {
    // An attempt takes the move twice and the wait once: 3.5 s, of 5.
    let source = "
        error late { recover by reversing 2 actions  give up after 8 times, 5 s }
        sequence main { move 10 mm up  wait 2.5 s  if not input 0 { throw late } }
    ";
    let run = Case::new(source, NEVER_S).run();
    assert_eq!(run.outcome(), Outcome::GivenUp(GiveUp::Time(5.0)));
    assert_eq!(run.depths(), [2]);
    let incident = &run.incidents[0];
    assert!(incident.duration_s().unwrap() <= 5.0, "{incident:?}");
}
