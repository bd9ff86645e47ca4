//! What each mistake is called and where it is. Some programs have many: all are found in one go,
//! and none is a consequence of another.

use crate::common::findings;

/// That a program has these diagnostics, in the order of their places.
pub(crate) fn check(source: &str, expected: &[&str]) {
    assert_eq!(findings(source.trim_start()), expected);
}

#[test]
fn vectors_are_checked_by_number_and_unit() {
    check(
        r#"
joints few = [0, -90 deg, 90] deg
joints plain = [0, 1, 2, 3, 4, 5]
joints long = [0, 1, 2, 3, 4, 5] mm
item peg { keyframe grasp = [0, 0] mm [1 deg, 2 s, 3 deg] keyframe grasp = [0, 0, 0] mm }
sequence main { wait 1 s }
"#,
        &[
            r#"E0205 1:14 "[0, -90 deg, 90] deg""#,
            r#"E0204 1:18 "-90 deg""#,
            r#"E0203 2:16 "[0, 1, 2, 3, 4, 5]""#,
            r#"E0202 3:34 "mm""#,
            r#"E0205 4:29 "[0, 0] mm""#,
            r#"E0202 4:47 "2 s""#,
            r#"E0102 4:68 "grasp""#,
        ],
    );
}

#[test]
fn a_name_is_of_its_kind() {
    check(
        r#"
joints start = [0, -90, 90, -90, -90, 0] deg
item peg { }
io open { set 0 low } reverse start
error jam { recover using start }
sequence main {
  move to open
  move to peg
  move to peg.grasp
  move to start.grasp
  io start
  call start
  advance main
  throw open
  var n = main + 1
}
"#,
        &[
            r#"E0103 3:31 "start""#,
            r#"E0103 4:27 "start""#,
            r#"E0103 6:11 "open""#,
            r#"E0103 7:11 "peg""#,
            r#"E0104 8:15 "grasp""#,
            r#"E0103 9:11 "start""#,
            r#"E0103 10:6 "start""#,
            r#"E0103 11:8 "start""#,
            r#"E0103 12:11 "main""#,
            r#"E0103 13:9 "open""#,
            r#"E0103 14:11 "main""#,
        ],
    );
}

#[test]
fn an_unknown_name_is_reported_once_and_followed_by_nothing() {
    check(
        r#"
joints start = [0, -90, 90, -90, -90, 0] deg
var x = y
sequence main {
  move to strat
  call nothing(x + 1, start)
  var a = x + 3 mm
  a = a + 2 s
  x = true
  z = a
  throw jam
}
"#,
        &[
            r#"E0101 2:9 "y""#,
            r#"E0101 4:11 "strat""#,
            r#"E0101 5:8 "nothing""#,
            r#"E0101 9:3 "z""#,
            r#"E0101 10:9 "jam""#,
        ],
    );
}

#[test]
fn a_name_is_given_once_where_it_is_seen() {
    check(
        r#"
var n = 1
sequence n { wait 1 s }
action go(a: int, a: int) { var b = a }
sequence main {
  var c = 1
  if c > 0 { var c = 2 }
  for c from 1 to 2 { wait 1 s }
  if c > 1 { var d = 1 } else { var d = 2 }
}
"#,
        &[r#"E0102 2:10 "n""#, r#"E0102 3:19 "a""#, r#"E0102 6:18 "c""#, r#"E0102 7:7 "c""#],
    );
}

#[test]
fn values_are_of_their_type() {
    check(
        r#"
action go(n: int, r: number, l: length, b: bool) { wait 1 s }
sequence main {
  call go(1, 2, 3 mm, true)
  call go(1.5, 2, 3 mm, 4)
  call go(1, 2 s, 3, false)
  call go(1)
  var n = 3
  var r = n * 2.5
  var ok = true
  ok = 1 and true
  if n { wait 1 s }
  while 3 mm { wait 1 s }
  repeat 1.5 times { wait 1 s }
  for i from 1 mm to 2 { wait 1 s }
  ok += true
  n = -true + 1
  n = not 3
}
"#,
        &[
            r#"E0201 4:11 "1.5""#,
            r#"E0201 4:25 "4""#,
            r#"E0202 5:14 "2 s""#,
            r#"E0203 5:19 "3""#,
            r#"E0208 6:3 "call go(1)""#,
            r#"E0201 8:11 "n""#,
            r#"E0201 10:8 "1""#,
            r#"E0201 11:6 "n""#,
            r#"E0201 12:9 "3 mm""#,
            r#"E0201 13:10 "1.5""#,
            r#"E0201 14:14 "1 mm""#,
            r#"E0201 15:3 "ok""#,
            r#"E0201 16:8 "true""#,
            r#"E0201 17:11 "3""#,
        ],
    );
}

#[test]
fn units_are_told_apart() {
    check(
        r#"
sequence main {
  wait 3 mm
  wait 3
  move 2 s up
  var a = 3 mm + 2 s
  var b = 3 mm < 4
  var c = 1 N > 2 mm
  var d: time = 3 mm / 2
  var e: speed = 3 mm / 2 s
  e = 3 deg / 2 s
  d += 1 mm
  var f = random(1, 2 mm)
  var g = min(1 s, 2 N)
  var h = sqrt(2 mm)
}
"#,
        &[
            r#"E0202 2:8 "3 mm""#,
            r#"E0203 3:8 "3""#,
            r#"E0202 4:8 "2 s""#,
            r#"E0202 5:18 "2 s""#,
            r#"E0203 6:18 "4""#,
            r#"E0202 7:17 "2 mm""#,
            r#"E0202 8:17 "3 mm / 2""#,
            r#"E0202 10:7 "3 deg / 2 s""#,
            r#"E0202 11:8 "1 mm""#,
            r#"E0203 12:18 "1""#,
            r#"E0202 13:20 "2 N""#,
            r#"E0209 14:16 "2 mm""#,
        ],
    );
}

#[test]
fn functions_take_what_they_take() {
    check(
        r#"
sequence main {
  var a = squrt(4)
  var b = min(1)
  var c = int(3 mm)
  var d = real(2.5)
  var e = abs(true)
  var f = random(true, 2)
  var n = 1
  var g = random(n, n)
}
"#,
        &[
            r#"E0105 2:11 "squrt""#,
            r#"E0208 3:11 "min(1)""#,
            r#"E0202 4:15 "3 mm""#,
            r#"E0201 5:16 "2.5""#,
            r#"E0201 6:15 "true""#,
            r#"E0201 7:18 "true""#,
            r#"E0201 9:18 "n""#,
        ],
    );
}

#[test]
fn what_is_fixed_before_the_program_runs_is_constant() {
    check(
        r#"
joints start = [0, -90, 90, -90, -90, 0] deg
var n = 1
var a = n + 1
var b = force
var c = random(1, 2)
var d = holding
error jam { recover by reversing 2 actions, perturbed distance }
sequence main { wait 1 s }
"#,
        &[
            r#"E0206 3:9 "n""#,
            r#"E0206 4:9 "force""#,
            r#"E0206 5:9 "random(1, 2)""#,
            r#"E0206 6:9 "holding""#,
            r#"E0206 7:55 "distance""#,
        ],
    );
}

#[test]
fn values_that_cannot_be_meant() {
    check(
        r#"
io open { set 70000 low sleep -1 s }
error jam { recover by reversing 0 actions, perturbed -1 mm }
advanced move go { distance 0 mm x stop if force > -1 N
  on failure { repeat with perturbation 0 times } }
var big = 1e200 * 1e200
sequence main { wait -1 s var n = 1 / 0 n = n mod 0 }
"#,
        &[
            r#"E0210 1:15 "70000""#,
            r#"E0210 1:31 "-1 s""#,
            r#"E0210 2:34 "0""#,
            r#"E0210 2:45 "perturbed -1 mm""#,
            r#"E0210 3:29 "0 mm""#,
            r#"E0210 3:36 "stop if force > -1 N""#,
            r#"E0210 4:41 "0""#,
            r#"E0210 5:11 "1e200 * 1e200""#,
            r#"E0210 6:22 "-1 s""#,
            r#"E0207 6:39 "0""#,
        ],
    );
}

#[test]
fn clauses_stand_once_and_advanced_moves_have_a_distance() {
    check(
        r#"
cell "a.toml"
cell "b.toml"
error jam { severity fatal severity warning then stop then continue }
error two { recover by reversing 2 actions, slower, slower otherwise stop
  otherwise operator respond at once respond at once }
advanced move go { speed slow speed fast }
advanced move on { distance 1 mm x distance 2 mm y }
sequence main { wait 1 s }
"#,
        &[
            r#"E0303 2:6 "\"b.toml\"""#,
            r#"E0303 3:28 "severity warning""#,
            r#"E0303 3:55 "then continue""#,
            r#"E0303 4:53 "slower""#,
            r#"E0303 5:3 "otherwise operator""#,
            r#"E0303 5:38 "respond at once""#,
            r#"E0304 6:15 "go""#,
            r#"E0303 6:31 "speed fast""#,
            r#"E0303 7:36 "distance 2 mm y""#,
        ],
    );
}

#[test]
fn an_advanced_move_is_stopped_by_a_force_and_repeated_after_a_failure() {
    check(
        r#"
advanced move a { distance 1 mm x stop if distance > 1 mm }
advanced move b { distance 1 mm x stop if force < 1 N }
advanced move c { distance 1 mm x stop if 5 N < force
  succeeds if force > 5 N on success { repeat with perturbation 2 times } }
advanced move d { distance 1 mm x
  on failure { repeat with perturbation 2 times repeat with perturbation 2 times } }
advanced move e { distance 1 mm x stop if force > 1 mm succeeds if force }
sequence main { wait 1 s }
"#,
        &[
            r#"E0305 1:43 "distance > 1 mm""#,
            r#"E0305 2:43 "force < 1 N""#,
            r#"E0312 4:40 "repeat with perturbation 2 times""#,
            r#"E0312 6:49 "repeat with perturbation 2 times""#,
            r#"E0202 7:51 "1 mm""#,
            r#"E0201 7:68 "force""#,
        ],
    );
}

#[test]
fn a_stop_that_counts_as_failure_and_that_nothing_follows_is_warned_of() {
    check(
        r#"
error missed { }
advanced move silent { distance 1 mm x stop if force > 5 N }
advanced move told { distance 1 mm x stop if force > 5 N on failure { throw missed } }
advanced move meant { distance 1 mm x stop if force > 5 N succeeds if force > 5 N }
advanced move free { distance 1 mm x }
sequence main { advance silent advance told advance meant advance free }
"#,
        &[r#"W0004 2:40 "stop if force > 5 N""#],
    );
}

#[test]
fn a_move_to_an_item_is_told_its_keyframes() {
    let help = |item: &str| {
        let source = format!("{item}\nsequence main {{ move to block }}");
        let diagnostics = obverse_compiler::compile("test.obv", &source).diagnostics;
        assert_eq!(diagnostics.len(), 1, "{diagnostics:#?}");
        diagnostics[0].help.clone().unwrap_or_default()
    };
    assert_eq!(help("item block { keyframe grasp = [0, 0, 1] mm }"), "write `block.grasp`");
    assert_eq!(
        help("item block { keyframe grasp = [0, 0, 1] mm keyframe above = [0, 0, 9] mm }"),
        "write for example `block.grasp`; it has grasp, above"
    );
    assert_eq!(help("item block { }"), "give it one: `item block { keyframe grasp = .. }`");
}

#[test]
fn errors_do_not_contradict_themselves() {
    check(
        r#"
joints start = [0, -90, 90, -90, -90, 0] deg
error a { severity fatal recover using fix then return to action }
error b { severity warning otherwise operator }
error c { recover using fix otherwise using fix }
error d { recover using part }
error e { recover by reversing to checkpoint nowhere }
error f { severity fatal otherwise operator then stop }
sequence fix { move to start }
sequence part(n: int) { wait 1 s }
sequence main { wait 1 s }
"#,
        &[
            r#"E0309 2:26 "recover using fix""#,
            r#"E0309 2:44 "then return to action""#,
            r#"E0309 3:28 "otherwise operator""#,
            r#"E0309 4:29 "otherwise using fix""#,
            r#"E0308 5:25 "part""#,
            r#"E0107 6:46 "nowhere""#,
        ],
    );
}

#[test]
fn keyframes_of_items_that_are_passed_on() {
    check(
        r#"
item peg { keyframe grasp = [0, 0, 20] mm }
item nut { keyframe above = [0, 0, 20] mm }
action outer(p: item) { call pick(p) }
action pick(part: item) { move to part.grasp move to part.above }
sequence main {
  call outer(peg)
  call outer(nut)
  move to peg.gasp
  var held = peg
}
"#,
        &[
            r#"E0104 6:14 "peg""#,
            r#"E0104 7:14 "nut""#,
            r#"E0104 8:15 "gasp""#,
            r#"E0211 9:7 "held""#,
        ],
    );
}

#[test]
fn only_variables_are_assigned() {
    check(
        r#"
joints start = [0, -90, 90, -90, -90, 0] deg
item peg { }
action go(part: item, n: int) { n = 3 part = peg }
sequence main { start = start for i from 1 to 2 { i += 1 } position p p = 3 }
"#,
        &[
            r#"E0307 3:39 "part""#,
            r#"E0307 4:17 "start""#,
            r#"E0307 4:51 "i""#,
            r#"E0307 4:71 "p""#,
        ],
    );
}

#[test]
fn ways_out_of_loops_and_blocks() {
    check(
        r#"
sequence main {
  break
  if holding { break }
  skip in reverse { loop { break } }
  loop { skip in reverse { break } }
  do { return } in reverse { return }
  do { wait 1 s } in reverse { break }
}
"#,
        &[
            r#"E0306 2:3 "break""#,
            r#"E0306 3:16 "break""#,
            r#"E0402 5:28 "break""#,
            r#"E0402 6:8 "return""#,
            r#"E0306 7:32 "break""#,
        ],
    );
}

#[test]
fn assertions() {
    check(
        r#"
sequence main {
  var n = 1
  if n > 0 { n = 2 } ending when force > 1 N
  if n > 0 { return } else { n = 3 } ending when n == 3
  if n > 0 { n = 2 } ending when n
  while n > 0 entered when random(0.0, 1.0) > 0.5 { n += 1 }
  while n > 0 entered when n == 1 { return }
}
"#,
        &[
            r#"E0403 3:34 "force""#,
            r#"E0404 4:50 "n == 3""#,
            r#"E0201 5:34 "n""#,
            r#"E0403 6:28 "random(0.0, 1.0)""#,
            r#"E0404 7:28 "n == 1""#,
        ],
    );
}

#[test]
fn warnings() {
    check(
        r#"
joints unused = [0, 0, 0, 0, 0, 0] deg
joints _spare = [0, 0, 0, 0, 0, 0] deg
output unused_output = 3 input unused_input = 3 output _lamp = 4
io unused_io { set 0 low }
error unused_error { }
sequence unused_sequence { wait 1 s }
var written = 1
sequence main {
  written = 2
  position here
  var half = 1 / 2
  if half > 0 { return wait 1 s wait 2 s }
  loop { wait 1 s }
  wait 3 s
}
"#,
        &[
            r#"W0001 1:8 "unused""#,
            r#"W0001 3:8 "unused_output""#,
            r#"W0001 3:32 "unused_input""#,
            r#"W0001 4:4 "unused_io""#,
            r#"W0001 5:7 "unused_error""#,
            r#"W0001 6:10 "unused_sequence""#,
            r#"W0001 7:5 "written""#,
            r#"W0001 10:12 "here""#,
            r#"W0003 11:14 "1 / 2""#,
            r#"W0002 12:24 "wait 1 s""#,
            r#"W0002 14:3 "wait 3 s""#,
        ],
    );
}

#[test]
fn a_mistake_of_grammar_hides_no_mistake_of_meaning_and_makes_none() {
    check(
        r#"
joints start = [0, -90, 90, -90, -90, 0] deg
joints broken [1]
sequence main {
  move to start
  move to broken
  wait 3 mm
  var = 3
}
"#,
        &[r#"E0010 2:15 "[""#, r#"E0202 6:8 "3 mm""#, r#"E0010 7:7 "=""#],
    );
}

#[test]
fn a_program_begins_somewhere() {
    check(
        r#"
action main { wait 1 s }
"#,
        &[r#"E0302 1:8 "main""#],
    );
}

#[test]
fn a_type_needs_a_value_somewhere() {
    check(
        r#"
action go(part: item, where: joints) { wait 1 s }
sequence main { wait 1 s }
"#,
        &[r#"E0106 1:17 "item""#, r#"E0106 1:30 "joints""#],
    );
}

#[test]
fn what_is_certain_is_said_of_a_text_that_lacks_its_last_brace() {
    let source = "joints start = [0, 0, 0, 0, 0] rad\nsequence main {\n  move to strat\n  \
                  wait 5 mm\n  var x = 3 mm + 2 s\n";
    let expected = [
        r#"E0205 1:16 "[0, 0, 0, 0, 0] rad""#,
        r#"E0011 2:15 "{""#,
        r#"E0202 4:8 "5 mm""#,
        r#"E0202 5:18 "2 s""#,
    ];
    assert_eq!(crate::common::findings(source), expected);
}
