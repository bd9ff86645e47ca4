//! Mistakes about reversal: what cannot be had, and the place that stands in the way.

use crate::diagnostics::check;

#[test]
fn the_position_named_last() {
    check(
        r#"
joints a = [0, -90, 90, -90, -90, 0] deg
joints b = [9, -90, 90, -90, -90, 0] deg
sequence other { wait 1 s }
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
            r#"E0401 13:13 "reversible always""#,
            r#"E0401 14:20 "reversible always""#,
            r#"E0401 16:16 "reversible always""#,
        ],
    );
}

#[test]
fn what_a_block_in_reverse_sees() {
    check(
        r#"
var total = 0
sequence main {
  var n = 1
  do { n = 2 } in reverse { total = 1 var m = total m = n position p move to p }
}
"#,
        &[r#"E0405 4:57 "n""#],
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
