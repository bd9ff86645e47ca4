//! Warnings that are meant: where an `allow` holds, and what is said of one that allows nothing.

use crate::common::{findings, module};

fn check(source: &str, expected: &[&str]) {
    assert_eq!(findings(source.trim_start()), expected);
}

#[test]
fn it_holds_for_the_declaration_that_follows() {
    check(
        r#"
allow W0001 "taught, and used by other programs"
joints spare = [0, -90, 90, -90, -90, 0] deg
joints other = [0, -90, 90, -90, -90, 0] deg
sequence main { wait 1 s }
"#,
        &[r#"W0001 3:8 "other""#],
    );
}

#[test]
fn it_holds_for_the_statement_that_follows_with_all_in_it() {
    check(
        r#"
sequence main {
  allow W0001 "it is looked at while stepping"
  if holding { var inner = 1 }
  var outer = 1
}
"#,
        &[r#"W0001 4:7 "outer""#],
    );
}

#[test]
fn it_holds_for_a_sequence_with_all_in_it_and_for_a_file() {
    check(
        r#"
allow W0001 "it is being written"
sequence main { var a = 1 return wait 1 s }
allow W0002 in file "it is being written"
"#,
        &[],
    );
}

#[test]
fn the_innermost_one_is_the_one_that_is_used() {
    check(
        r#"
allow W0001 "the outer one"
sequence main {
  allow W0001 "the inner one"
  var a = 1
}
"#,
        &[r#"W0010 1:1 "allow W0001 \"the outer one\"""#],
    );
}

#[test]
fn several_may_stand_before_one_statement() {
    check(
        r#"
sequence main {
  allow W0012 "tried out" allow W0001 "tried out"
  if 1 > 2 { var a = 1 }
  return
  allow W0002 "tried out"
  wait 1 s
}
"#,
        &[],
    );
}

#[test]
fn one_that_allows_nothing_is_said_to_unless_that_is_meant() {
    check(
        r#"
sequence main {
  wait 1 s
  allow W0002 "nothing follows"
}
"#,
        &[r#"W0010 3:3 "allow W0002 \"nothing follows\"""#],
    );
    check("allow W0010 in file \"kept\" allow W0002 \"kept\" sequence main { wait 1 s }", &[]);
}

#[test]
fn it_is_nothing_in_the_module() {
    let plain = module("sequence main { set 0 high sleep 1 s wait 2 s }");
    let allowed = module("sequence main { set 0 high allow W0002 \"x\" sleep 1 s wait 2 s }");
    assert_eq!(plain.code, allowed.code);
    assert_eq!(plain.constants, allowed.constants);
}

#[test]
fn what_is_kept_keeps_what_it_runs() {
    let program = |before: &str| {
        format!(
            "{before}\nsequence spare {{ call step io lamp }}\nsequence step {{ io lamp }}\n\
             io lamp {{ set 2 high }}\nsequence main {{ wait 1 s }}\n"
        )
    };
    check(
        &program("// nothing is said of it"),
        &[r#"W0001 2:10 "spare""#, r#"W0011 3:10 "step""#, r#"W0011 4:4 "lamp""#],
    );
    check(&program("allow W0001 \"for the fitter\""), &[]);
}
