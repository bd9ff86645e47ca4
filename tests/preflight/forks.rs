//! What the check finds of forks: the branches take turns as the machine has them do, also where
//! several of them move the arm, which only assembly text can say.

use crate::support::{CELL, Found, with_wall};
use obverse_preflight::Reason;

const ITEMS: &str = r#"obvasm 1
.const real 0.0
.const real 0.01
.const real 0.1
.const real 0.3
.const real 3.0
.keyframe "above"
.keyframe "grasp"
.item "part"
    .at above 0 0 -0.1 0 0 0
    .at grasp 0 0 0 0 0 0
.item "spot"
    .at above 0 0 -0.03 0 0 0
"#;

/// A start in which the arm stands at the part, and two branches.
fn fork(first: &str, second: &str) -> String {
    format!(
        "{ITEMS}
.function \"$start\" start
    enter
    push.item part
    move.item grasp, joint
begin:
    fork end
{first}
    fork.next
{second}
end:
    fork.join begin
    halt
"
    )
}

const TAKE: &str = "push.const 0.0
    output.set 0, high";
const CARRY: &str = "push.item part
    move.item above, linear
    push.item spot
    move.item above, joint";

fn wall() -> String {
    with_wall(450, -150, 60)
}

/// A wait of so many seconds, which must be among the constants.
fn wait(duration_s: &str) -> String {
    format!("push.const {duration_s}\n    wait\n    ")
}

/// The gripper that closes first takes the part, which does not get over the wall; one that closes
/// when the arm has left takes nothing. A branch that begins with a motion begins last.
#[test]
fn branches_take_turns_in_their_order() {
    for (first, second) in [(TAKE, CARRY), (CARRY, TAKE)] {
        let taken = Found::of_assembly(&wall(), &fork(first, second));
        assert_eq!(taken.forward(2).verdict.reason, Reason::HeldCollides);
    }
    let left = Found::of_assembly(&wall(), &fork(CARRY, &(wait("0.0") + TAKE)));
    assert!(left.report.is_fine(true), "{:?}", left.report);
}

/// Who waits has no turn until the time is over, by what the motions take: the gripper closes on
/// the part before the arm leaves, behind its first motion, or when it has come back.
#[test]
fn who_waits_is_passed_over() {
    let up = "push.const 0.01\n    move.relative +z, base\n    ";
    let down = "push.const 0.01\n    move.relative -z, base\n    ";
    let there_and_back = format!("{up}{down}{CARRY}");
    let fault = |waits: &str| {
        let program = fork(&(waits.to_owned() + TAKE), &there_and_back);
        let found = Found::of_assembly(&wall(), &program);
        let carried = found.forward(4).verdict.reason;
        assert!(
            carried == Reason::HeldCollides || found.report.is_fine(true),
            "{:?}",
            found.report
        );
        carried
    };
    assert_eq!(fault(""), Reason::HeldCollides);
    // Behind the first motion nothing is near enough.
    assert_eq!(fault(&wait("0.0")), Reason::Fine);
    // The first motion takes longer than this, and this ends while the second one is made.
    assert_eq!(fault(&wait("0.1")), Reason::Fine);
    assert_eq!(fault(&wait("0.3")), Reason::HeldCollides);
    // All of them together take less.
    assert_eq!(fault(&wait("3.0")), Reason::Fine);
}

/// How long a wait takes that depends on an input is not known: the branches go on in every order.
#[test]
fn where_times_are_not_known_every_order_is_followed() {
    let read = ".function \"$start\" start\n    .local late real\n    enter\n    draw late";
    let late = format!("push.local late\n    wait\n    {TAKE}");
    let up = "push.const 0.01\n    move.relative +z, base\n    ";
    let program = fork(&late, &format!("{up}{CARRY}"));
    let program = program.replacen(".function \"$start\" start\n    enter", read, 1);
    let found = Found::of_assembly(&wall(), &program);
    assert!(found.report.is_complete);
    assert!(found.forward(2).visits > 1 && found.forward(3).visits > 1, "{:?}", found.report);
}

/// The same in the language, where one branch alone moves the arm.
#[test]
fn what_one_branch_takes_the_other_one_carries() {
    let program = "
item part { keyframe above = [0, 0, -100] mm  keyframe grasp = [0, 0, 0] mm }
item spot { keyframe above = [0, 0, -30] mm }
sequence main {
  move to part.above
  move to part.grasp linearly
  fork { set 0 LEVEL } and { move to part.above linearly  move to spot.above }
}";
    let taken = Found::of(&wall(), &program.replace("LEVEL", "high"));
    assert_eq!(taken.forward(3).verdict.reason, Reason::HeldCollides);
    let left = Found::of(&wall(), &program.replace("LEVEL", "low"));
    assert!(left.report.is_fine(true), "{:?}", left.report);
}

/// A wait is an act: it takes a turn, and lets the arm leave.
#[test]
fn every_act_takes_a_turn() {
    let found = Found::of_assembly(&wall(), &fork(&(wait("0.0") + TAKE), CARRY));
    assert!(found.report.is_fine(true), "{:?}", found.report);
    // What is no act takes none.
    let set = "push.speed slow\n    setting.set speed\n    ";
    let found = Found::of_assembly(&wall(), &fork(&format!("{set}{TAKE}"), CARRY));
    assert_eq!(found.forward(2).verdict.reason, Reason::HeldCollides);
}

/// While an error is pending the other branches are held.
#[test]
fn a_pending_error_holds_the_turn() {
    let error = ".error \"jam\" recoverable
    .recover none
    .otherwise stop
    .respond after_action
    .then stop
.function";
    let branch = format!("error.raise jam\n    {}{TAKE}\n    error.clear jam", wait("0.0"));
    let program = fork(&branch, CARRY).replacen(".function", error, 1);
    let found = Found::of_assembly(&wall(), &program);
    assert_eq!(found.forward(2).verdict.reason, Reason::HeldCollides);
}

/// The arm is moved by turns from both branches: only together do the moves lead too far.
#[test]
fn two_branches_may_move_one_arm() {
    let up = "push.const 0.01\n    move.relative +z, base\n    ";
    let far = "push.const 3.0\n    move.relative -z, base\n    ";
    let found = Found::of_assembly(CELL, &fork(&up.repeat(2), &(up.repeat(2) + far)));
    let reasons: Vec<_> = (1..6).map(|number| found.forward(number).verdict.reason).collect();
    let fine = Reason::Fine;
    assert_eq!(reasons, [fine, fine, fine, fine, Reason::GoalOutOfReach]);
    assert_eq!(found.reverse(1).verdict.reason, fine);
}

/// Going back, the turns are taken back: the part is still held when the arm goes back down, since
/// the grip is passed over in reverse.
#[test]
fn turns_are_taken_back_in_reverse() {
    let closed = "over:
    block.begin
    push.const 0.0
    output.set 0, high
    block.skip over";
    let lift = "push.item part
    move.item above, linear";
    let before = "    push.item spot
    move.item above, joint
    push.item part
    move.item grasp, joint
";
    let program = |first: &str, second: &str| {
        fork(first, second).replace("    push.item part\n    move.item grasp, joint\n", before)
    };
    let held = Found::of_assembly(&wall(), &program(closed, lift));
    assert_eq!(held.forward(1).verdict.reason, Reason::Fine);
    assert_eq!(held.reverse(1).verdict.reason, Reason::HeldCollides);
    let left = Found::of_assembly(&wall(), &program(lift, &(wait("0.0") + closed)));
    assert_eq!(left.reverse(1).verdict.reason, Reason::Fine);
}

/// The first branch leaves in its second turn: what the other one had still to do is not done.
#[test]
fn who_leaves_a_fork_leaves_the_rest_undone() {
    let leave = "push.const 0.0
    wait
    push.bool true
stay:
    jump.unless on
    fork.leave end
on:
    land stay";
    let after = "push.item spot\n    move.item above, joint\n    halt";
    let program = fork(leave, CARRY).replace("halt", after);
    let found = Found::of_assembly(CELL, &program);
    assert_eq!(found.forward(1).verdict.reason, Reason::Fine);
    assert_eq!(found.report.moves[2].verdict().reason, Reason::NoWay);
    assert_eq!(found.forward(3).verdict.reason, Reason::Fine);
    assert_eq!(found.reverse(1).verdict.reason, Reason::Fine);
}

/// Who takes how many turns is not known behind calls that are not followed.
#[test]
fn behind_calls_that_are_not_followed_turns_are_not_known() {
    let again = "    halt
.function \"again\" sequence
    .local drawn real
    enter
    push.const 0.0
    wait
    draw drawn
    push.local drawn
    push.const 0.01
    real.lt
skip:
    jump.unless on
    call again
on:
    join skip
    return
";
    let after = "    push.item spot\n    move.item above, joint\n";
    let program = fork("call again", CARRY).replace("    halt\n", &format!("{after}{again}"));
    let found = Found::of_assembly(CELL, &program);
    assert!(found.report.is_complete);
    let elsewhere = [1, 2].map(|number| found.report.moves[number].forward.clone());
    for found in elsewhere {
        let reason = found.map(|graded| graded.elsewhere.unwrap_or(graded.verdict.reason));
        assert_eq!(reason, Some(Reason::DeepCalls));
    }
    let behind = found.forward(3);
    assert_eq!(behind.verdict.reason, Reason::SettingNotKnown, "{behind:?}");
}

/// Endless branches come to an end, and so does a fork that calls itself.
#[test]
fn forks_without_an_end_come_to_an_end() {
    let endless = |label: &str, step: &str| {
        format!(
            "{label}_top:
    join {label}_again
    {step}
    push.bool true
{label}_again:
    jump.if {label}_top"
        )
    };
    let up = "push.const 0.01\n    move.relative +z, base";
    let down = "push.const 0.01\n    move.relative -z, base";
    let found = Found::of_assembly(CELL, &fork(&endless("a", up), &endless("b", down)));
    assert!(found.report.is_complete);
    assert_eq!(found.forward(1).verdict.reason, Reason::Fine);
    assert_eq!(found.forward(2).verdict.reason, Reason::Fine);
}
