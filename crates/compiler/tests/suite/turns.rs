//! Turns: what they become, what is checked of them, and their inverse.

use crate::common::check_code;
use crate::diagnostics::check;

#[test]
fn a_turn_has_an_angle_and_may_advance() {
    check_code(
        r"
        sequence main {
        turn 0.5 rad forward
        turn 0.5 rad advancing 2 mm left in base
        }
        ",
        "main",
        "
        enter
        push.const 0.5
        push.const 0.0
        move.turn +z tcp
        push.const 0.5
        push.const 0.002
        move.turn +y base
        return
        ",
    );
}

#[test]
fn a_guarded_turn_has_succeeded_unless_it_was_stopped() {
    check_code(
        r"
        error tight { }
        advanced move drive { turn 3 rad advancing 2 mm -z in toolmount
        stop if force > 12 N on failure { throw tight } }
        sequence main { advance drive }
        ",
        "drive",
        "
        enter
        push.const 3.0
        push.const 0.002
        push.const 12.0
        move.turn.guarded -z toolmount
        sense.distance $distance
        sense.peak_force $force
        push.local $force
        push.const 12.0
        real.le
        jump.if +2
        error.raise tight
        join -2
        return
        ",
    );
}

#[test]
fn a_turn_is_by_an_angle_and_advances_by_a_length() {
    check(
        r#"
sequence main {
  turn 5 mm forward
  turn 90 deg advancing 1 s forward
  turn 2 forward
}
"#,
        &[r#"E0202 2:8 "5 mm""#, r#"E0202 3:25 "1 s""#, r#"E0203 4:8 "2""#],
    );
}

#[test]
fn a_turn_is_not_led_back_but_by_reversing() {
    let program = |clauses: &str| {
        format!(
            "error e {{ }}\nadvanced move drive {{ turn 9 rad forward; stop if force > 5 N;\n\
             {clauses}\n}}\nsequence main {{ advance drive }}\n"
        )
    };
    for (clauses, expected) in [
        (
            "on success { return to initial position }; on failure { throw e }",
            r#"E0312 3:14 "return to initial position""#,
        ),
        (
            "on failure { return to initial position; throw e }",
            r#"E0312 3:14 "return to initial position""#,
        ),
        (
            "on failure { repeat with perturbation 2 times; throw e }",
            r#"E0312 3:14 "repeat with perturbation 2 times""#,
        ),
        (
            "on failure { throw e }; opposite force in reverse",
            r#"E0312 3:25 "opposite force in reverse""#,
        ),
        ("on failure { throw e }; distance 5 mm up", r#"E0303 3:25 "distance 5 mm up""#),
    ] {
        check(&program(clauses), &[expected]);
    }
    check(&program("on failure { throw e }"), &[]);
}
