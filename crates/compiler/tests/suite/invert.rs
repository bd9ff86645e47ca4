//! Inversion by examples: what each statement becomes, and what it needs of those before it. That
//! it takes back what was done is a law over generated programs.

use obverse_compiler::{NoInverse, invert};

/// What the sequence `work` needs, before it.
const DECLARATIONS: &str = "\
joints a = [0, 0, 0, 0, 0, 0] deg
joints b = [1, 0, 0, 0, 0, 0] deg
joints c = [2, 0, 0, 0, 0, 0] deg
item part { keyframe grasp = [0, 0, 0] mm }
io lamp { set 2 high; sleep 10 ms }
io dark { set 2 low; sleep 10 ms }
io on { set 5 high } reverse off
io off { set 5 low } reverse on
var x = 0
var y = 1
advanced move press {
  distance 9 mm down
  on success { return to initial position }
  on failure { return to initial position }
} reverse lift
advanced move lift {
  distance 9 mm up
  on success { return to initial position }
  on failure { return to initial position }
} reverse press
advanced move stays { distance 9 mm down } reverse leaves
advanced move leaves { distance 9 mm up } reverse stays
action pick { move to a; move to b linearly; move to a }
action nudge { move 2 mm up; move 2 mm down }
action stray { move 2 mm up }
action goes(there: joints) { move to there; wait 1 s }
action reads { repeat x times { toggle 4 } }
";

fn program(body: &str) -> String {
    format!("{DECLARATIONS}sequence work {{\n{body}\n}}\nsequence main {{}}\n")
}

/// The statements of the inverse of `work`, one a line.
fn inverse(body: &str) -> Result<Vec<String>, Vec<String>> {
    match invert("work.obv", &program(body), "work") {
        Ok(inverse) => {
            let (_, rest) =
                inverse.text.split_once("sequence work_inverse {\n").expect("it is there");
            let (body, _) = rest.split_once("\n}\n").expect("it has an end");
            Ok(body.lines().map(|line| line.trim().to_owned()).collect())
        }
        Err(NoInverse::Diagnosed(found)) => Err(found.into_iter().map(|one| one.message).collect()),
        Err(unknown) => panic!("{unknown:?}"),
    }
}

/// The inverse has these statements, and its inverse the first ones.
#[track_caller]
fn becomes(body: &[&str], expected: &[&str]) {
    let found = inverse(&body.join("\n"));
    assert_eq!(
        found.as_deref(),
        Ok(&expected.iter().map(|line| (*line).to_owned()).collect::<Vec<_>>()[..])
    );
    let once = invert("work.obv", &program(&body.join("\n")), "work").expect("an inverse");
    let twice = invert("work.obv", &once.text, &once.name).expect("an inverse again");
    for line in body {
        assert!(twice.text.lines().any(|found| found.trim() == *line), "{line}\n{}", twice.text);
    }
}

#[track_caller]
fn refused(body: &str, words: &str) {
    let found = inverse(body).expect_err("there is no inverse");
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(found[0].contains(words), "{found:#?}");
}

#[test]
fn a_path_is_gone_backwards() {
    becomes(
        &["move to a linearly", "move to b", "wait 1 s", "move to c linearly"],
        &["move to c linearly", "move to b linearly", "wait 1 s", "move to a"],
    );
    becomes(
        &["move to a", "move to b reversible always", "move to c reversible always"],
        &["move to c", "move to b reversible always", "move to a reversible always"],
    );
}

#[test]
fn a_way_that_is_followed_back_needs_no_name() {
    becomes(
        &["move to a", "move 2 mm up in base", "wait 1 s", "move 2 mm down in base", "move to b"],
        &["move to b", "move to a", "move 2 mm up in base", "wait 1 s", "move 2 mm down in base"],
    );
    becomes(
        &[
            "move to a",
            "turn 540 deg advancing 2 mm forward",
            "wait 1 s",
            "turn 540 deg advancing 2 mm backward",
        ],
        &[
            "move to a",
            "turn 540 deg advancing 2 mm forward",
            "wait 1 s",
            "turn 540 deg advancing 2 mm backward",
        ],
    );
    refused(
        "move to a\nturn 9 deg up\nturn 9 deg advancing 1 mm down\nmove to b",
        "without a name",
    );
    refused("move to a\nmove 2 mm up\nmove to b", "a place without a name");
    refused("move to a\nmove 2 mm up\nmove 2 mm down in base\nmove to b", "without a name");
    refused("move to a\nmove 2 mm up", "a place without a name");
    refused("wait 1 s\nmove to a", "a place without a name");
}

#[test]
fn a_call_is_taken_back_as_far_as_its_first_move() {
    // From c to where `pick` begins is a move of its own, which the call implies.
    becomes(
        &["move to c", "call pick", "move to b"],
        &["move to b", "call pick_inverse", "move to c"],
    );
    becomes(&["call pick", "move to c"], &["move to c", "call pick_inverse"]);
    becomes(&["call goes(c)", "call goes(b)"], &["call goes_inverse(b)", "call goes_inverse(c)"]);
    becomes(
        &["move to a", "call nudge", "move to b"],
        &["move to b", "move to a", "call nudge_inverse"],
    );
    refused("move to a\ncall stray\nmove to b", "a place without a name");
}

#[test]
fn an_output_goes_back_to_the_level_before() {
    becomes(
        &["set 3 low", "move to a", "set 3 high", "wait 1 s", "set 3 low"],
        &["set 3 low", "move to a", "set 3 high", "wait 1 s", "set 3 low"],
    );
    becomes(
        &["io dark", "move to a", "io lamp", "wait 1 s", "io on"],
        &["io lamp", "move to a", "io off", "wait 1 s", "io dark"],
    );
    becomes(&["toggle 4", "sleep 1 s", "wait 2 s"], &["wait 2 s", "toggle 4", "sleep 1 s"]);
    refused("io lamp", "which level output 2 had");
    refused("set 3 high", "which level output 3 had");
    refused("set 3 low\nmove to a\nif y > 0 { set 3 high }\nset 3 low", "which level output 3");
    refused("io dark\nmove to a\nskip in reverse { io lamp }\nio dark", "which level output 2");
}

#[test]
fn updates_are_taken_back() {
    becomes(&["x += 2 * y", "y -= 1"], &["y += 1", "x -= 2 * y"]);
    becomes(
        &["x = 3", "move to a", "x = 5", "x += 2", "x = 1"],
        &["x = 1", "move to a", "x = 7", "x -= 2", "x = 3"],
    );
    refused("x += x", "updated by its own value");
    refused("x = 5", "what `x` was before");
    refused("x = 3\nmove to a\nx = y", "what `x` was before");
}

#[test]
fn variables_begin_with_what_they_end_with() {
    becomes(
        &["var n = 0", "while n != 2 entered when n == 0 { n += 1 }"],
        &["var n = 2", "while n != 0 entered when n == 2 { n -= 1 }"],
    );
    becomes(&["var m = y * 2", "x += m"], &["var m = y * 2", "x -= m"]);
    refused("var m = y * 2\ny += m", "what `m` is at its end");
    refused("var m = 1\nwait 1 s\nx += m", "declared before it is needed");
    refused("var m = 1\nwait 1 s", "declared before it is needed");
}

#[test]
fn branches_swap_their_tests() {
    becomes(
        &["if x == 0 { x += 1 } else { x += 2 } ending when x == 1"],
        &["if x == 1 { x -= 1 } else { x -= 2 } ending when x == 0"],
    );
    becomes(&["if y > 0 { x += 1 }"], &["if y > 0 { x -= 1 }"]);
    refused("if x > 0 { x += 1 }", "changes its own condition");
}

#[test]
fn loops_count_the_other_way() {
    becomes(&["for i from 1 to y { x += i * 2 }"], &["for i from y down to 1 { x -= i * 2 }"]);
    becomes(&["repeat y times { x += 3 }"], &["repeat y times { x -= 3 }"]);
    becomes(
        &["while x < 5 entered when not x == 3 { x += 1 }"],
        &["while not not x == 3 entered when not x < 5 { x -= 1 }"],
    );
    refused("repeat x times { x += 1 }", "changes its own bound");
    refused("move to a\nrepeat 2 times { move to b }", "ends elsewhere than it begins");
}

#[test]
fn blocks_with_a_reverse_of_their_own_change_places() {
    becomes(
        &["do { set 6 high } in reverse { set 7 low }"],
        &["do { set 7 low } in reverse { set 6 high }"],
    );
    becomes(&["skip in reverse { toggle 6 }"], &["do {} in reverse { toggle 6 }"]);
    becomes(&["keep in reverse { toggle 6 }"], &["keep in reverse { toggle 6 }"]);
    refused("do { set 6 high } in reverse {}", "nothing replaces");
    refused("move to a\ndo { move to b } in reverse { wait 1 s }", "where these blocks end");
}

#[test]
fn an_unknown_sequence_is_perhaps_another() {
    let unknown = invert("work.obv", &program(""), "wark");
    assert_eq!(unknown, Err(NoInverse::UnknownSequence(Some("work".to_owned()))));
    let found = invert("work.obv", "sequence main { mov }", "main");
    assert!(matches!(found, Err(NoInverse::Diagnosed(found)) if found[0].code.as_str() == "E0010"));
}

#[test]
fn what_is_allowed_is_said_of_the_sequence_alone() {
    let plain =
        ["move to a", "toggle 2", "sleep 10 ms", "repeat 2 times { toggle 3 }", "move to b"];
    let allowing = plain.map(|line| format!("allow W0003 \"why\"\n{line}"));
    let nested = allowing.join("\n").replace("{ toggle", "{ allow W0003 \"why\" toggle");
    assert_eq!(inverse(&nested).err(), None);
    assert_eq!(inverse(&nested), inverse(&plain.join("\n")));
}

/// The refusals, as `line "text" message`.
fn refusals(source: &str, sequence: &str) -> Vec<String> {
    let Err(NoInverse::Diagnosed(found)) = invert("work.obv", source, sequence) else {
        panic!("it has an inverse");
    };
    let told = |one: obverse_syntax::diagnostic::Diagnostic| {
        assert_eq!(one.code.as_str(), "E0701");
        assert!(one.help.is_some(), "{one:?}");
        let span = one.primary.span;
        let line = source[..span.start as usize].lines().count().max(1);
        let text = &source[span.start as usize..span.end as usize];
        format!("{line} {text:?} {}", one.message)
    };
    found.into_iter().map(told).collect()
}

#[test]
fn an_update_of_a_real_comes_back_rounded() {
    let source = "\
var gap = 0.1 mm
var n = 0
sequence work(by: length) {
  n += 2
  gap += 0.2 mm
  var m = n
  n -= m
  var far: length = by
  far -= 2 * by
  if gap < by { n += 1 }
}
sequence main { call work(1 mm) }
";
    let found = refusals(source, "work");
    let expected = [
        r#"5 "gap += 0.2 mm" an update of a real has no exact inverse"#,
        r#"9 "far -= 2 * by" an update of a real has no exact inverse"#,
    ];
    let is_expected = |one: &&str| found.iter().any(|found| found == *one);
    assert!(expected.iter().all(is_expected), "{found:#?}");
    becomes(
        &["x += 1", "var near = 1 mm", "if near < 2 mm { y += 2 }"],
        &["var near = 1 mm", "if near < 2 mm { y -= 2 }", "x -= 1"],
    );
}

#[test]
fn a_fork_whose_branches_read_what_others_assign() {
    let fork = "fork { x += 1 wait 1 s } and { wait 1 s repeat x times { toggle 4 } }";
    let message = "a fork whose branches read what others assign has no inverse";
    refused(fork, message);
    refused(&format!("allow W0601 \"meant\" {fork}"), message);
    refused("fork { call reads } and { x += 1 }", message);
    refused("repeat 2 times { fork { var z = x + 1 y += z } and { x += 1 } }", message);
    becomes(
        &["fork {", "x += 1", "} and {", "toggle 4", "wait 1 s", "}"],
        &["fork {", "x -= 1", "} and {", "wait 1 s", "toggle 4", "}"],
    );
}

#[test]
fn what_is_no_sequence_has_its_reverse_with_it() {
    let Err(NoInverse::OtherKind(other)) = invert("work.obv", &program(""), "lamp") else {
        panic!("it is an I/O operation")
    };
    assert_eq!((other.kind, other.statement.as_str()), ("an I/O operation", "io lamp"));
}

/// What has no warning has no inverse with one.
#[test]
fn an_inverse_that_nobody_calls_is_meant_so() {
    let source = "\
output lamp = 2
output left_out = 3
var n = 0
action work { n += 1 toggle lamp }
sequence main { set left_out high call work if n > 3 { wait 1 s } }
";
    let inverse = invert("work.obv", source, "work").expect("an inverse");
    let found = obverse_compiler::compile("inverse.obv", &inverse.text).diagnostics;
    assert_eq!(found, [], "{}", inverse.text);
    assert!(!inverse.text.contains("left_out"), "{}", inverse.text);
}

/// What does not compile is said where it comes from.
#[test]
fn an_inverse_that_does_not_compile_names_its_statement() {
    let source = "\
joints a = [0, 0, 0, 0, 0, 0] deg
joints b = [1, 0, 0, 0, 0, 0] deg
sequence work {
  move to a
  move to b reversible always
  move 2 mm up
  move 2 mm down
}
sequence main { call work }
";
    let message = "what takes this back does not compile";
    assert_eq!(refusals(source, "work"), [format!("5 \"reversible always\" {message}")]);
}

#[test]
fn an_advanced_move_that_ends_where_it_begins_becomes_its_counterpart() {
    becomes(
        &["move to a", "advance press", "move to b", "advance lift"],
        &["move to b", "advance press", "move to a", "advance lift"],
    );
    refused("move to a\nadvance stays\nmove to b", "an advanced move has no inverse");
}

#[test]
fn what_is_said_of_an_advanced_move_has_an_inverse() {
    let body = "move to a\nadvance stays\nmove to c";
    let Err(NoInverse::Diagnosed(found)) = invert("work.obv", &program(body), "work") else {
        panic!("it has an inverse")
    };
    let help = found[0].help.clone().unwrap_or_default();
    let written = help.split('`').nth(1).unwrap_or_default();
    let written = written.replace("advance ..", "advance stays").replace("THERE", "b");
    let body = body.replace("advance stays", &written);
    let inverse = inverse(&body).expect("it has an inverse now").join("\n");
    assert!(inverse.contains("advance leaves"), "{inverse}");
}
