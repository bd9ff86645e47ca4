//! Moves of which nothing is known for what came before: a move that fails, or more rounds of a
//! loop than are followed one by one.

use crate::support::{CELL, Found, reasons};
use obverse_preflight::Reason;

#[test]
fn behind_a_move_that_fails_that_is_the_reason() {
    let found = Found::of(
        CELL,
        "joints far = [0, -90, 90, -90, -90, 190] deg
         joints home = [0, -90, 90, -90, -90, 0] deg
         sequence main {
           move to far
           move to home
           move to home
         }",
    );
    let after = (Some(Reason::AfterFailure), Some(Reason::AfterFailure));
    assert_eq!(reasons(found.at_line(5)), after, "{:?}", found.report);
    // From there on it is known again.
    assert_eq!(reasons(found.at_line(6)), (Some(Reason::Fine), Some(Reason::Fine)));
    assert!(found.report.is_complete, "all of it was looked at");
}

#[test]
fn what_is_drawn_is_not_known_whatever_failed_before() {
    let found = Found::of(
        CELL,
        "sequence main {
           move 3 m forward in base
           move random(1 mm, 9 mm) up in base
         }",
    );
    assert_eq!(reasons(found.at_line(3)).0, Some(Reason::GoalNotKnown), "{:?}", found.report);
}

/// Where a run may fault beyond the rounds that are followed, the check does not pass.
#[test]
fn a_loop_of_more_rounds_than_are_followed_is_no_check() {
    let climb = |rounds: u32| {
        Found::of(
            CELL,
            &format!("sequence main {{ repeat {rounds} times {{ move 0.1 mm up in base }} }}"),
        )
    };
    assert!(climb(500).report.is_fine(true));
    for rounds in [600, 4000] {
        let found = climb(rounds);
        assert_eq!(found.forward(0).verdict.reason, Reason::TooManyRounds, "{rounds}");
        assert!(!found.report.is_complete && !found.report.is_fine(false), "{rounds}");
    }
    assert!(Reason::TooManyRounds.title().contains("512"));
}

#[test]
fn a_goal_that_rounds_beyond_those_decide_is_no_check_either() {
    let found = Found::of(
        CELL,
        "joints home = [0, -90, 90, -90, -90, 0] deg
         sequence main {
           for round from 1 to 2000 {
             move to home
             move 0.01 mm * real(round) up in base
           }
         }",
    );
    assert_eq!(reasons(found.at_line(5)).0, Some(Reason::TooManyRounds), "{:?}", found.report);
    assert!(!found.report.is_complete);
}

/// A production loop that counts is the same in every round, as far as the arm goes.
#[test]
fn rounds_that_only_count_are_all_followed() {
    let found = Found::of(
        CELL,
        "joints home = [0, -90, 90, -90, -90, 0] deg
         joints away = [10, -90, 90, -90, -90, 0] deg
         var parts = 0
         sequence main {
           loop {
             move to home
             move random(1 mm, 9 mm) up in base
             move to away
             parts += 1
             if parts > 1000000 { break }
           }
         }",
    );
    assert!(found.report.is_complete && found.report.is_fine(false), "{:?}", found.report);
    assert_eq!(reasons(found.at_line(7)).0, Some(Reason::GoalNotKnown));
}
