//! Mistakes about reversal: what cannot be had, and the place that stands in the way.

use crate::diagnostics::check;

#[test]
fn the_position_named_last() {
    check(
        r#"
joints a = [0, -90, 90, -90, -90, 0] deg
joints b = [9, -90, 90, -90, -90, 0] deg
sequence other { move to a }
action go(where: joints) { move to a move to where reversible always }
sequence main {
  move to a reversible always
  move to a
  move 3 mm up
  move to b reversible always
  call other
  move to a reversible always
  if holding { move to b reversible always move to a }
  move to b reversible always
  loop { move to a reversible always move to b reversible always if holding { break } }
  move to a
  move 2 mm up reversible always
  call go(a)
}
"#,
        &[
            r#"E0401 4:52 "reversible always""#,
            r#"E0401 6:13 "reversible always""#,
            r#"E0401 9:13 "reversible always""#,
            r#"E0401 11:13 "reversible always""#,
            r#"E0401 14:20 "reversible always""#,
            r#"E0401 16:16 "reversible always""#,
        ],
    );
}

#[test]
fn a_block_in_reverse_reads_what_is_around_it_and_changes_what_is_its_own() {
    check(
        r#"
var total = 0
sequence main { call work(1) }
sequence work(part: int) {
  var n = 1
  position p
  for i from 1 to 3 {
    do { n = 2 } in reverse { total = n + i + part move to p var m = total m = n position q }
    do { n = 2 } in reverse { n = 2 part += 1 position p }
    do { wait 1 s } in reverse { do { wait 1 s } in reverse { n = i move to p } }
  }
}
"#,
        &[r#"E0405 8:31 "n""#, r#"E0405 8:37 "part""#, r#"E0405 8:56 "p""#, r#"E0405 9:63 "n""#],
    );
}

#[test]
fn errors_and_barriers_in_blocks_with_a_reverse() {
    check(
        r#"
error jam { }
advanced move go { distance 1 mm x on failure { throw jam } }
sequence fails { throw jam }
sequence seals { barrier "sealed" }
sequence main {
  do { wait 1 s } in reverse { throw jam }
  do { wait 1 s } in reverse { advance go }
  do { wait 1 s } in reverse { call fails }
  do { wait 1 s } in reverse { irreversible "glued" { wait 1 s } }
  skip in reverse { barrier "x" }
  skip in reverse { if holding { call seals } }
}
"#,
        &[
            r#"E0406 6:32 "throw jam""#,
            r#"E0406 7:32 "advance go""#,
            r#"E0406 8:32 "call fails""#,
            r#"E0407 9:32 "irreversible \"glued\"""#,
            r#"E0407 10:21 "barrier \"x\"""#,
            r#"E0407 11:34 "call seals""#,
        ],
    );
}

#[test]
fn the_position_named_last_in_loops_branches_and_blocks() {
    check(
        r#"
joints a = [0, -90, 90, -90, -90, 0] deg
joints b = [9, -90, 90, -90, -90, 0] deg
error e { recover using home then continue }
sequence home { move to a }
advanced move go { distance 1 mm x }
sequence main {
  move to a while holding { call home } move to b reversible always
  move to a for i from 1 to 2 { move to b reversible always }
  move to a repeat 2 times { move to a move to b reversible always }
  move to a if holding { move to b } else { move to b } move to a reversible always
  move to a if holding { wait 1 s } else { move to b reversible always }
  move to a wait until input 1 high for up to 1 s else { move to b } move to b reversible always
  move to a advance go move to b reversible always
  move to a if holding { throw e } move to b reversible always
  move to a skip in reverse { move to b reversible always } move to a reversible always
  move to a do { wait 1 s } in reverse { move to b reversible always }
  move to b reversible always
  move to a keep in reverse { move to b reversible always } move to a reversible always
  move to a with speed slow in reverse { move to b reversible always }
  move to a reversible always
  position p move to p move to b reversible always
}
"#,
        &[
            r#"E0401 7:51 "reversible always""#,
            r#"E0401 8:43 "reversible always""#,
            r#"E0401 12:80 "reversible always""#,
            r#"E0401 13:34 "reversible always""#,
            r#"E0401 14:46 "reversible always""#,
            r#"E0401 15:71 "reversible always""#,
            r#"E0401 16:52 "reversible always""#,
            r#"E0401 18:41 "reversible always""#,
            r#"E0401 18:71 "reversible always""#,
            r#"E0401 21:34 "reversible always""#,
        ],
    );
}

#[test]
fn what_leaves_the_arm_alone_forgets_no_position() {
    check(
        r#"
joints a = [0, -90, 90, -90, -90, 0] deg
joints b = [9, -90, 90, -90, -90, 0] deg
io lamp { set 2 high }
error noted { severity warning }
error told { recover using tell then continue }
error back { recover by reversing 2 actions otherwise using tell then continue }
sequence tell { toggle 3 call tell_more }
sequence tell_more { throw noted io lamp }
sequence walk { call tell call walk_on }
sequence walk_on { if holding { throw back } }
sequence main {
  move to a call tell move to b reversible always
  while holding { toggle 3 } loop { wait 1 s if holding { break } } move to a reversible always
  if holding { toggle 3 } else if force > 1 N { throw told } move to b reversible always
  if holding { move to a } else { move to b move to a } move to b reversible always
  if holding { move 2 mm up return } move to a reversible always
  wait until input 1 high for up to 1 s else { toggle 3 } move to b reversible always
  wait until input 1 high for up to 1 s else { move to a return } move to a reversible always
  fork { toggle 3 } and { wait 1 s } move to b reversible always
  fork { toggle 3 } and { move to b move to a } move to b reversible always
  skip in reverse { toggle 3 } do { toggle 3 } in reverse { toggle 4 } move to a reversible always
  keep in reverse { toggle 3 } irreversible "glued" { toggle 4 } move to b reversible always
  speed fast tool gripper position p checkpoint c barrier "gone" move to a reversible always
  call walk move to b reversible always
  fork { move 1 mm up } and { toggle 3 } move to a reversible always
}
"#,
        &[r#"E0401 24:23 "reversible always""#, r#"E0401 25:52 "reversible always""#],
    );
}

#[test]
fn ways_out_of_a_kept_block() {
    check(
        r#"
sequence main {
  loop { keep in reverse { break } }
  keep in reverse { return }
  keep in reverse { loop { break } }
}
"#,
        &[r#"E0402 2:28 "break""#, r#"E0402 3:21 "return""#],
    );
}

#[test]
fn what_may_fail_in_reverse() {
    check(
        r#"
error jam { }
sequence fails { throw jam }
sequence seals { barrier "sealed" }
advanced move pull { distance 1 mm -x on failure { throw jam } }
advanced move push { distance 1 mm x } reverse pull
sequence main {
  advance push advance push
  keep in reverse { if holding { throw jam } }
  keep in reverse { call fails }
  keep in reverse { barrier "x" }
  skip in reverse { keep in reverse { call seals } }
}
"#,
        &[
            r#"E0407 3:18 "barrier \"sealed\"""#,
            r#"E0406 4:52 "throw jam""#,
            r#"E0406 8:34 "throw jam""#,
            r#"E0406 9:21 "call fails""#,
            r#"E0407 10:21 "barrier \"x\"""#,
            r#"E0407 11:21 "keep in reverse""#,
        ],
    );
}

#[test]
fn what_goes_back_otherwise_is_said_once_and_makes_sense() {
    check(
        r#"
sequence main {
  with speed slow, straight moves, speed fast in reverse { wait 1 s }
  with force limit 0 N in reverse { wait 1 s }
  with force limit 3 mm in reverse { wait 1 s }
}
"#,
        &[r#"E0303 2:36 "speed fast""#, r#"E0210 3:20 "0 N""#, r#"E0202 4:20 "3 mm""#],
    );
}

#[test]
fn what_an_advanced_move_does_in_reverse() {
    check(
        r#"
error jam { }
advanced move push { distance 1 mm x opposite force in reverse }
advanced move pull {
  distance 1 mm -x
  opposite force in reverse
  stop if force > 2 N
  opposite force in reverse
  on failure { throw jam }
} reverse push
advanced move turn { distance 1 mm y } reverse main
advanced move back { distance 1 mm y } reverse pull
sequence main { advance push advance pull advance turn advance back advance back }
"#,
        &[
            r#"E0304 2:38 "opposite force in reverse""#,
            r#"E0303 7:3 "opposite force in reverse""#,
            r#"E0103 10:48 "main""#,
        ],
    );
}
