//! Where an error is due, whose action it is, how far the tool really went, and what a tape keeps.

use super::*;

#[test]
fn an_explicit_recovery_is_not_taken_back_for_the_error_that_it_dealt_with() {
    let source = "
        error e { recover by reversing 1 action give up after 1 times otherwise using help
          then return to action }
        sequence help { set 5 high }
        sequence main { move 10 mm up  if not input 0 { throw e }  set 6 high }
    ";
    let run = Case::new(source, NEVER_S).run();
    let outcomes: Vec<Outcome> =
        run.incidents.iter().map(|incident| incident.outcome.unwrap().0).collect();
    assert_eq!(outcomes[0], Outcome::GivenUp(GiveUp::Attempts(1)));
    assert!(outcomes[1..].iter().all(|it| *it == Outcome::GivenUp(GiveUp::Before)), "{outcomes:?}");
    assert_eq!(run.steps.reverse, 1, "the move alone was taken back, once");
}

#[test]
fn an_error_of_a_branch_is_that_of_its_own_action() {
    let source = "
        error e { recover by reversing 1 action, perturbed 5 mm give up after 1 times }
        sequence main {
          fork { move 100 mm up  move 100 mm down } and {
            set 3 high
            wait 1 s
            if not input 0 { throw e }
          }
        }
    ";
    let run = Case::new(source, NEVER_S).run();
    let incident = &run.incidents[0];
    assert!(incident.place.contains("wait 1 s"), "{}", incident.place);
    assert!(!run.steps.changes.contains(&true), "no motion of the other branch is made aside");
    // What the other branch has done since is taken back with it.
    assert_eq!(run.depths(), [2]);
}

#[test]
fn backing_up_goes_as_far_as_it_goes_and_says_how_far() {
    let source = program("recover by reversing 4 actions");
    let far = Strategy::BackUp { distance_m: 3.0, times: 1 };
    let run = Case::new(&source, NEVER_S).with(far).run();
    let stop = Case::new(&source, NEVER_S).with(Strategy::Stop).run();
    let [Some(told_m)] = run.steps.backed_up_m[..] else { panic!("{:?}", run.steps.backed_up_m) };
    let gone_m = run.sim.way_m() - stop.sim.way_m();
    assert!((told_m - gone_m).abs() < 1e-9 && told_m > 0.05 && told_m < 1.5, "{told_m} {gone_m}");
}

#[test]
fn the_tape_notes_what_happened_in_recoveries_and_going_back_takes_nothing_from_it() {
    let run = run("recover by reversing escalating up to 4 actions, slower", 3.5);
    let noted: Vec<String> = run
        .notes
        .iter()
        .map(|note| format!("{:?}", note.what))
        .map(|text| text.split(|c: char| !c.is_alphanumeric()).next().unwrap().to_owned())
        .collect();
    let attempts = run.incidents[0].attempts.len();
    assert_eq!(noted.len(), 2 * attempts + 1, "{noted:?}");
    assert_eq!(noted[..2], ["Back", "Again"]);
    assert_eq!(noted.last().map(String::as_str), Some("Recovered"));
    assert!(run.is_identical);
}
