//! What the check before anything moves finds: a small cell and a few lines for each grade, each
//! reason and each way through a program that may lead to one.

mod back;
mod forks;
mod since;
mod support;

use obverse_preflight::{Grade, Reason};
use support::{CELL, Found, with_wall};

/// The moves of a program in the small cell have these reasons, forward and in reverse.
fn has(cell: &str, program: &str, expected: &[(Reason, Reason)]) -> Found {
    let found = Found::of(cell, program);
    assert!(found.report.is_complete);
    let reasons: Vec<_> = found.report.moves.iter().map(support::reasons).collect();
    let expected: Vec<_> =
        expected.iter().map(|(there, back)| (Some(*there), Some(*back))).collect();
    assert_eq!(reasons, expected, "{program}");
    found
}

const FINE: (Reason, Reason) = (Reason::Fine, Reason::Fine);

#[test]
fn a_move_that_meets_nothing_is_reachable() {
    let found = has(
        CELL,
        "item part { keyframe above = [0, 0, -100] mm }
         sequence main { move to part.above; move 60 mm down in base }",
        &[FINE, FINE],
    );
    assert!(found.report.is_fine(true));
}

#[test]
fn a_joint_beyond_its_range_is_out_of_limits() {
    let found = has(
        CELL,
        "joints far = [0, -90, 90, -90, -90, 190] deg
         sequence main { move to far }",
        &[(Reason::GoalOutOfRange, Reason::StartNotKnown)],
    );
    assert!(!found.report.is_fine(false));
}

#[test]
fn what_is_too_far_is_out_of_reach() {
    has(
        CELL,
        "sequence main { move 3 m forward in base }",
        &[(Reason::GoalOutOfReach, Reason::StartNotKnown)],
    );
}

#[test]
fn a_displacement_longer_than_any_arm_is_refused() {
    let found = Found::of(CELL, "sequence main { move 30 m forward in base }");
    assert_eq!(found.forward(0).verdict.reason, Reason::BadCommand);
}

/// The other elbow: the pose is the same, and the straight line has no length.
#[test]
fn a_line_to_joints_of_another_configuration_cannot_be_followed() {
    has(
        CELL,
        "joints here = [0, -90, 90, -90, -90, 0] deg
         joints there = [0, -90, 90, -90, 90, 0] deg
         sequence main { move to here; move to there linearly }",
        &[FINE, (Reason::LineEndsOtherwise, Reason::LineEndsOtherwise)],
    );
}

#[test]
fn a_line_past_the_base_leaves_the_reach() {
    let found = Found::of(
        CELL,
        "item part { keyframe above = [0, 0, -100] mm  keyframe beyond = [-900, 300, -100] mm }
         sequence main { move to part.above; move to part.beyond linearly }",
    );
    let verdict = &found.forward(1).verdict;
    assert_eq!(verdict.grade(), Grade::OtherConfiguration, "{verdict:?}");
}

#[test]
fn the_tool_meets_a_wall() {
    let found = has(
        &with_wall(450, 150, 60),
        "item part { keyframe above = [0, 0, -100] mm  keyframe low = [0, 0, 30] mm }
         sequence main { move to part.above; move to part.low linearly }",
        &[FINE, (Reason::ToolCollides, Reason::Fine)],
    );
    let verdict = &found.forward(1).verdict;
    let contact = verdict.contact.as_ref().expect("a contact");
    assert_eq!((contact.body.as_str(), contact.with.as_str()), ("gripper", "wall"));
    let fraction = verdict.fraction.expect("a place on the path");
    assert!((0.0..1.0).contains(&fraction), "{fraction}");
}

#[test]
fn the_arm_meets_a_post_and_not_the_tool() {
    let post = "
[[fixture]]
name = \"post\"
place = { xyz_mm = [-300, -300, 500] }
body = [{ cuboid_mm = [60, 60, 1000] }]
";
    let found = Found::of(
        &format!("{CELL}{post}"),
        "joints ahead = [90, -20, 0, -90, -90, 0] deg
         joints round = [0, -20, 0, -90, -90, 0] deg
         sequence main { move to ahead; move to round }",
    );
    let worst: Vec<_> = found.report.moves.iter().map(|found| found.verdict().reason).collect();
    assert!(worst.contains(&Reason::ArmCollides), "{worst:?}");
}

/// The same way with an empty gripper is free: what the gripper holds reaches lower.
const OVER_A_WALL: &str = "
item part { keyframe above = [0, 0, -100] mm  keyframe grasp = [0, 0, 0] mm }
item spot { keyframe above = [0, 0, -30] mm }
io grip { set 0 high; sleep 0.1 s }
sequence main {
  move to spot.above
  move to part.above
  move to part.grasp linearly
  GRIP
  move to part.above linearly
  move to spot.above
}";

#[test]
fn only_the_held_item_meets_the_wall() {
    let cell = with_wall(450, -150, 60);
    let empty = Found::of(&cell, &OVER_A_WALL.replace("GRIP", "wait 1 s"));
    assert!(empty.report.is_fine(true), "{:?}", empty.report);
    let full = Found::of(&cell, &OVER_A_WALL.replace("GRIP", "io grip"));
    let reasons: Vec<_> = full.report.moves.iter().map(|found| found.verdict().reason).collect();
    assert_eq!(
        reasons,
        [Reason::Fine, Reason::Fine, Reason::Fine, Reason::Fine, Reason::HeldCollides]
    );
    let contact = full.forward(4).verdict.contact.clone().expect("a contact");
    assert_eq!((contact.body.as_str(), contact.with.as_str()), ("part", "wall"));
}

/// The grip is passed over in reverse, so that the way back is gone with the item in the gripper.
#[test]
fn a_way_that_is_free_forward_may_not_be_in_reverse() {
    let cell = with_wall(450, -150, 60);
    let program = "
item part { keyframe above = [0, 0, -100] mm  keyframe grasp = [0, 0, 0] mm }
item spot { keyframe above = [0, 0, -30] mm }
sequence main {
  move to spot.above
  move to part.above
  move to part.grasp linearly
  skip in reverse { set 0 high }
}";
    let found = Found::of(&cell, program);
    assert!(found.report.moves.iter().all(|found| {
        found.forward.as_ref().is_some_and(|there| there.verdict.reason == Reason::Fine)
    }));
    let back = found.reverse(1);
    assert_eq!(back.verdict.reason, Reason::HeldCollides, "{back:?}");
    assert!(!found.report.is_fine(false));
}

#[test]
fn what_replaces_a_block_is_looked_at_in_reverse_alone() {
    let program = "
item part { keyframe above = [0, 0, -100] mm  keyframe low = [0, 0, 30] mm }
sequence main {
  move to part.above
  do { set 1 high } in reverse { move to part.low linearly }
}";
    let found = Found::of(&with_wall(450, 150, 60), program);
    let replaced = found.report.moves.iter().find(|found| found.forward.is_none());
    let replaced = replaced.expect("a move that is done in reverse alone");
    let reason = replaced.reverse.as_ref().map(|back| back.verdict.reason);
    assert_eq!(reason, Some(Reason::ToolCollides));
}

#[test]
fn a_guarded_move_is_meant_to_touch() {
    let program = "
item part { keyframe above = [0, 0, -100] mm }
advanced move feel { distance 120 mm down in base; stop if force > 5 N; speed slow }
sequence main { move to part.above; advance feel }";
    let found = Found::of(&with_wall(450, 150, 60), program);
    assert!(found.report.is_fine(true), "{:?}", found.report);
    let unguarded =
        Found::of(&with_wall(450, 150, 60), &program.replace("stop if force > 5 N;", ""));
    assert_eq!(unguarded.report.count(Grade::InCollision), 1, "{:?}", unguarded.report);
    let too_far = program.replace("120 mm", "5 m");
    let found = Found::of(&with_wall(450, 150, 60), &too_far);
    assert_eq!(found.report.count(Grade::OutOfReach), 1, "{:?}", found.report);
}

#[test]
fn after_a_contact_the_arm_stands_nobody_knows_where() {
    let program = "
item part { keyframe above = [0, 0, -100] mm }
joints home = [0, -90, 90, -90, -90, 0] deg
advanced move feel { distance 80 mm down in base; stop if force > 5 N; speed slow }
sequence main {
  move to part.above
  advance feel
  move to part.above linearly
  move to home
}";
    let found = Found::of(CELL, program);
    let there = found.at_line(8).forward.clone().expect("a way there");
    assert_eq!(
        (there.verdict.reason, there.elsewhere),
        (Reason::Fine, Some(Reason::StartNotKnown))
    );
}

#[test]
fn what_is_drawn_is_not_known_and_fails_only_when_asked_strictly() {
    let found = has(
        CELL,
        "item part { keyframe above = [0, 0, -100] mm }
         sequence main { move to part.above; move random(1 mm, 9 mm) up in base }",
        &[FINE, (Reason::GoalNotKnown, Reason::StartNotKnown)],
    );
    assert!(found.report.is_fine(false) && !found.report.is_fine(true));
}

/// The probe is longer than the gripper: with it the same pose is another one of the arm.
#[test]
fn a_tool_holds_to_the_end_of_its_block() {
    let program = "
item part { keyframe above = [0, 0, -100] mm }
sequence main {
  if input 0 { tool probe }
  move to part.above
}";
    assert!(Found::of(CELL, program).report.is_fine(true));
}

/// What a call within itself leaves is not known, and neither is the tool.
#[test]
fn behind_calls_that_are_not_followed_the_tool_is_not_known() {
    let program = "
item part { keyframe above = [0, 0, -100] mm }
sequence again { if random(0, 1) > 0.5 { call again } }
sequence main {
  call again
  move to part.above
}";
    let found = Found::of(CELL, program);
    assert_eq!(found.forward(0).verdict.reason, Reason::SettingNotKnown);
}

#[test]
fn what_is_read_of_a_contact_decides_what_follows_as_planned() {
    let program = "
item part { keyframe above = [0, 0, -100] mm }
error nothing_there { severity fatal }
advanced move feel {
  distance 120 mm down in base
  stop if force > 5 N
  succeeds if force > 5 N and distance < 119 mm
  speed slow
  on failure { throw nothing_there }
}
sequence main {
  move to part.above
  advance feel
  move 9 mm up in base
}";
    // Stopped by the wall it goes on from there; where there is none, only otherwise.
    let found = Found::of(&with_wall(450, 150, 60), program);
    assert_eq!(found.at_line(14).verdict().reason, Reason::Fine, "{:?}", found.report);
    let found = Found::of(CELL, &program.replace("above = [0", "above = [100"));
    assert_eq!(found.at_line(14).verdict().reason, Reason::StartNotKnown, "{:?}", found.report);
}

#[test]
fn where_the_gripper_does_not_hold_what_it_should_items_are_not_known() {
    let program = "
item part { keyframe above = [0, 0, -100] mm  keyframe grasp = [0, 0, 0] mm }
io grip { set 0 high; sleep 0.1 s }
sequence main {
  move to part.above
  move to part.grasp linearly
  io grip
  if not holding { move to part.above }
  move to part.above linearly
}";
    let found = Found::of(CELL, program);
    let otherwise = found.at_line(8).forward.clone().expect("a way there");
    assert_eq!(otherwise.verdict.reason, Reason::HeldNotKnown);
    let after = found.at_line(9).forward.clone().expect("a way there");
    assert_eq!((after.verdict.reason, after.elsewhere.is_some()), (Reason::Fine, true));
}

#[test]
fn a_move_that_nothing_leads_to_is_not_known() {
    let program = "
joints home = [0, -90, 90, -90, -90, 0] deg
sequence never { move to home }
sequence main { if 1 > 2 { move to home } }";
    let found = Found::of(CELL, program);
    let reasons: Vec<_> = found.report.moves.iter().map(|found| found.verdict().reason).collect();
    assert_eq!(reasons, [Reason::NoWay, Reason::NoWay]);
}

#[test]
fn both_sides_of_a_branch_on_an_input_are_looked_at() {
    let program = "
joints far = [0, -90, 90, -90, -90, 190] deg
joints home = [0, -90, 90, -90, -90, 0] deg
sequence main { if input 0 { move to home } else { move to far } }";
    let found = Found::of(CELL, program);
    assert_eq!(found.report.count(Grade::Reachable), 1);
    assert_eq!(found.report.count(Grade::OutOfLimits), 1);
}

/// Of a row of places the last one alone is out of reach: every round is looked at.
#[test]
fn a_counted_loop_is_followed_round_by_round() {
    let program = "
item part { keyframe above = [0, 0, -100] mm }
sequence main {
  for place from 0 to LAST {
    move to part.above
    move 50 mm * real(place) forward in base
  }
}";
    let fine = Found::of(CELL, &program.replace("LAST", "4"));
    assert!(fine.report.is_fine(true), "{:?}", fine.report);
    assert_eq!(fine.forward(1).visits, 5);
    let far = Found::of(CELL, &program.replace("LAST", "12"));
    let found = far.forward(1);
    assert_eq!(found.verdict.reason, Reason::GoalOutOfReach);
    assert!(!found.always_fails && found.visits == 13, "{found:?}");
}

#[test]
fn loops_without_an_end_and_calls_without_a_bound_come_to_an_end() {
    let program = "
joints home = [0, -90, 90, -90, -90, 0] deg
var rounds = 0
action again(times: int) {
  move to home
  if times > 0 { call again(times - 1) }
}
sequence main {
  loop {
    rounds += 1
    move to home
    if input 0 { call again(rounds) }
    if rounds > 1000000 { break }
  }
}";
    let found = Found::of(CELL, program);
    assert!(found.report.is_complete);
    let deep = found.at_line(5).forward.clone().expect("a way there");
    assert_eq!((deep.verdict.reason, deep.elsewhere), (Reason::Fine, Some(Reason::DeepCalls)));
}

/// Every branch leads elsewhere, so that a thousand million ways lead to the end.
#[test]
fn many_branches_are_not_many_ways() {
    let branch = |lift: usize| format!("  if input 0 {{ move {lift}.5 mm up in base }}\n");
    let branches: String = (1..=30).map(branch).collect();
    let program = format!("sequence main {{\n  move 9 mm up in base\n{branches}}}\n");
    let found = Found::of(CELL, &program);
    assert!(found.report.is_complete);
    assert_eq!(found.forward(0).verdict.reason, Reason::Fine);
    let last = found.forward(30);
    assert_eq!((last.verdict.reason, last.elsewhere), (Reason::Fine, Some(Reason::StartNotKnown)));
}

/// Deep calls of large frames are many words, not many states.
#[test]
fn calls_with_many_variables_take_bounded_memory() {
    let variables: String = (0..100).map(|number| format!("  var v{number} = depth\n")).collect();
    let program = format!(
        "action deep(depth: int) {{\n{variables}  move 1 mm up in base\n  \
         if depth > 0 {{ call deep(depth - 1) }}\n}}\n\
         sequence main {{ loop {{ call deep(200) }} }}\n"
    );
    let report = Found::of(CELL, &program).report;
    assert!(!report.is_fine(true), "{report:?}");
}

#[test]
fn a_cell_of_too_many_bodies_is_not_called_fine() {
    let found = Found::in_cell(&support::crowded(), support::MANY_MOVES);
    assert!(!found.report.is_complete && !found.report.is_fine(false));
    let unseen =
        found.report.moves.iter().filter(|found| found.verdict().reason == Reason::TooMany);
    assert!(unseen.count() > 0, "{:?}", found.report);
}

#[test]
fn every_reason_has_a_code_of_its_own_and_a_page() {
    let mut codes: Vec<&str> = Reason::ALL.iter().map(|reason| reason.code()).collect();
    assert!(codes.is_sorted(), "{codes:?}");
    codes.dedup();
    assert_eq!(codes.len(), Reason::ALL.len());
    for reason in Reason::ALL {
        assert!(reason.explanation().starts_with(&format!("{}: ", reason.code())));
        assert_eq!(reason.code().parse(), Ok(*reason));
    }
}

/// What is left aside by an error is never mixed with what goes well, however many ways there are:
/// with an error nothing is let go, and nobody comes to the wall.
#[test]
fn behind_an_error_nothing_is_met() {
    let program = "
        io grip { set 0 high; sleep 0.3 s }
        io free { set 0 low;  sleep 0.3 s }
        item part { keyframe above = [0, 0, -100] mm  keyframe at = [0, 0, 0] mm }
        item spot { keyframe above = [0, 0, -100] mm  keyframe at = [0, 0, 0] mm }
        error missed { }
        advanced move feel { distance 40 mm forward in tcp stop if force > 10 N
                             on failure { return to initial position } }
        action feel_for(tries: int) {
          advance feel
          var n = 1
          while n < tries and distance < 33 mm { n += 1 }
          if distance < 33 mm { throw missed }
        }
        sequence put {
          move to part.above
          move to part.at linearly
          io grip
          move to part.above linearly
          call feel_for(6)
          io free
          move 10 mm up in base
        }
        sequence main { call put  move to spot.above  move to spot.at linearly }";
    let found = Found::of(&with_wall(450, -150, 60), program);
    assert!(found.report.is_complete);
    assert_eq!(found.report.moves.last().map(|last| last.verdict().reason), Some(Reason::Fine));
}
