//! What a move meets going back where the program says how to go back: settings for that, what
//! replaces a block, and blocks that keep their order.

use crate::support::{CELL, Found, bodiless, reasons, with_wall};
use obverse_preflight::Reason;
use obverse_workcell::FaultKind;

/// The gripper is closed for good, so that what it holds is carried back over a wall.
const HELD_ON_THE_WAY_BACK: &str = "
item part { keyframe above = [0, 0, -100] mm  keyframe grasp = [0, 0, 0] mm }
item spot { keyframe above = [0, 0, -30] mm }
sequence main {
  move to spot.above
  with LIMIT in reverse { move to part.above }
  move to part.grasp linearly
  skip in reverse { set 0 high }
}";

#[test]
fn a_way_back_with_a_force_limit_is_stopped_by_it() {
    let cell = with_wall(450, -150, 60);
    let found = Found::of(&cell, &HELD_ON_THE_WAY_BACK.replace("LIMIT", "force limit 5 N"));
    let back = &found.reverse(1).verdict;
    assert_eq!((back.reason, back.fault), (Reason::StoppedByForce, Some(FaultKind::ForceLimit)));
    assert_eq!(found.forward(1).verdict.reason, Reason::Fine);
    // A limit beyond what the workcell allows changes nothing.
    let found = Found::of(&cell, &HELD_ON_THE_WAY_BACK.replace("LIMIT", "force limit 500 N"));
    assert_eq!(found.reverse(1).verdict.reason, Reason::HeldCollides);
}

#[test]
fn a_limit_that_nothing_meets_is_fine() {
    let program = HELD_ON_THE_WAY_BACK.replace("LIMIT", "force limit 5 N");
    let found = Found::of(CELL, &program);
    assert!(found.report.is_fine(true), "{:?}", found.report);
}

/// Between two elbows of one pose there is a way by joints, and no straight line.
#[test]
fn a_way_back_on_a_straight_line_is_looked_at_as_one() {
    let program = "
joints here = [0, -90, 90, -90, -90, 0] deg
joints there = [0, -90, 90, -90, 90, 0] deg
sequence main {
  move to here
  HOW { move to there }
}";
    let straight = Found::of(CELL, &program.replace("HOW", "with straight moves in reverse"));
    assert_eq!(straight.forward(1).verdict.reason, Reason::Fine);
    assert_eq!(straight.reverse(1).verdict.reason, Reason::LineEndsOtherwise);
    let by_joints = Found::of(CELL, &program.replace("HOW", "with speed slow in reverse"));
    assert!(by_joints.report.is_fine(true), "{:?}", by_joints.report);
}

/// As planned nothing is met on the way back; where contact stopped the move, going back against a
/// limit may be stopped too.
#[test]
fn the_opposite_force_may_stop_the_way_back_from_a_contact() {
    let program = "
item part { keyframe above = [0, 0, -100] mm }
advanced move feel { distance 60 mm down in base; stop if force > 5 N; speed slow  BACK }
sequence main { move to part.above; advance feel }";
    let opposite = Found::of(CELL, &program.replace("BACK", "opposite force in reverse"));
    let back = opposite.reverse(0);
    assert_eq!((back.verdict.reason, back.elsewhere), (Reason::Fine, Some(Reason::StartNotKnown)));
    let plain = Found::of(CELL, &program.replace("BACK", ""));
    let back = plain.reverse(0);
    assert_eq!((back.verdict.reason, back.elsewhere), (Reason::Fine, None));
}

#[test]
fn what_replaces_a_block_has_the_values_around_the_block() {
    let program = "
item part { keyframe above = [0, 0, -100] mm }
sequence main {
  var lift = LIFT
  move to part.above
  do { set 1 high } in reverse { move lift up in base }
  lift = 1 mm
}";
    let reason = |lift| {
        let found = Found::of(CELL, &program.replace("LIFT", lift));
        let replaced = found.at_line(6);
        assert!(replaced.forward.is_none());
        replaced.reverse.as_ref().map(|back| back.verdict.reason)
    };
    assert_eq!(reason("30 mm"), Some(Reason::Fine));
    assert_eq!(reason("3 m"), Some(Reason::GoalOutOfReach));
}

#[test]
fn what_replaces_a_block_has_the_positions_around_the_block() {
    let program = "
joints home = [0, -90, 90, -90, -90, 0] deg
joints away = [20, -90, 90, -90, -90, 0] deg
sequence main {
  move to home
  position before
  do { move to away } in reverse { move to before linearly }
}";
    let found = Found::of(CELL, program);
    assert!(found.report.is_fine(true), "{:?}", found.report);
}

/// In reverse the block is run as it is written, from where it ended: from there the arm does not
/// get over the wall.
#[test]
fn a_block_that_keeps_its_order_is_looked_at_again_from_its_end() {
    let program = "
item part { keyframe above = [0, 0, -100] mm  keyframe low = [0, 0, -10] mm }
item spot { keyframe above = [0, 0, -100] mm  keyframe low = [0, 0, -10] mm }
sequence main {
  move to spot.above
  keep in reverse {
    move to part.above linearly
    move to part.low linearly
    move to spot.low linearly
  }
}";
    let found = Found::of(&with_wall(450, 0, 130), program);
    let forward: Vec<_> = found.report.moves.iter().filter(|one| one.forward.is_some()).collect();
    let backward: Vec<_> = found.report.moves.iter().filter(|one| one.forward.is_none()).collect();
    let there: Vec<_> = forward.iter().map(|one| reasons(one).0).collect();
    let back: Vec<_> = backward.iter().map(|one| reasons(one).1).collect();
    let [fine, collides] = [Some(Reason::Fine), Some(Reason::ToolCollides)];
    assert_eq!(there, [fine, fine, fine, collides]);
    assert_eq!(back, [collides, fine, collides]);
}

/// How hard the arm presses where contact stopped it depends on when the force is read: what goes
/// there again without a guard may be stopped.
#[test]
fn going_back_to_a_hard_contact_is_not_known() {
    let program = "
item part { keyframe above = [0, 0, -100] mm }
advanced move feel { distance 120 mm down in base; stop if force > 5 N; speed SPEED }
sequence main {
  move to part.above
  advance feel
  move to part.above linearly
}";
    let cell = with_wall(450, 150, 60);
    let back = |speed| {
        let found = Found::of(&cell, &program.replace("SPEED", speed));
        found.at_line(7).reverse.as_ref().map(|back| back.verdict.reason)
    };
    assert_eq!(back("very fast"), Some(Reason::StopNotKnown));
    assert_eq!(back("very slow"), Some(Reason::Fine));
}

/// Along a table that the tool touches all the way.
#[test]
fn a_long_way_in_contact_is_not_looked_at_to_its_end() {
    let table = "
[[fixture]]
name = \"table\"
place = { xyz_mm = [450, 0, 85] }
body = [{ cuboid_mm = [200, 600, 170] }]
";
    let program = "
item part { keyframe above = [0, 0, -100] mm }
sequence main { move to part.above; move LENGTH -y in base }";
    let reason = |length| {
        let cell = format!("{}{table}", bodiless());
        let found = Found::of(&cell, &program.replace("LENGTH", length));
        found.forward(1).verdict.reason
    };
    assert_eq!(reason("50 mm"), Reason::Fine);
    assert_eq!(reason("300 mm"), Reason::LongContact);
}
