//! What the words about reversal become.

use crate::common::check_code as check;

#[test]
fn a_move_that_is_always_reversible_names_both_ends() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        joints b = [9, -90, 90, -90, -90, 0] deg

        sequence main {
        move to a
        wait 1 s
        move to b reversible always
        speed slow { move to a linearly reversible always }
        }
        ",
        "main",
        "
        enter
        push.joints a
        move.joint
        push.const 1.0
        wait
        push.joints a
        push.joints b
        move.always joint
        push.setting speed
        store.local $speed
        push.speed slow
        setting.set speed
        push.joints b
        push.joints a
        move.always linear
        push.local $speed
        setting.set speed
        return
        ",
    );
}

#[test]
fn a_counterpart_takes_the_place_of_the_call() {
    check(
        r"
        io open { set 0 low } reverse close
        io close { set 0 high } reverse open
        sequence main {
        io open
        }
        ",
        "main",
        "
        enter
        block.begin
        call open
        block.replace close -2
        return
        ",
    );
}

#[test]
fn reversal_words() {
    check(
        r#"
        sequence main {
        checkpoint here
        barrier "glued"
        irreversible "glue" { wait 1 s }
        skip in reverse { wait 2 s }
        do { wait 3 s } in reverse { wait 4 s }
        }
        "#,
        "main",
        "
        enter
        checkpoint here
        barrier glued
        irreversible glue
        push.const 1.0
        wait
        irreversible glue
        block.begin
        push.const 2.0
        wait
        block.skip -3
        block.begin
        push.const 3.0
        wait
        block.replace main$reverse0 -3
        return
        ",
    );
}

#[test]
fn a_replacement_is_a_function_of_its_own() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg

        sequence main {
        do { wait 3 s } in reverse { var x = 1 speed slow if x > 0 { return } move to a }
        }
        ",
        "main$reverse0",
        "
        enter
        push.setting speed
        store.local $initial_speed
        push.int 1
        store.local x
        push.speed slow
        setting.set speed
        push.int 0
        push.local x
        jump.unless.lt +2
        jump +4
        land -2
        push.joints a
        move.joint
        join -4
        push.local $initial_speed
        setting.set speed
        return
        ",
    );
}

#[test]
fn a_way_out_of_what_is_irreversible_passes_its_end() {
    check(
        r#"
        sequence main {
        loop { irreversible "glue" { if holding { break } wait 1 s } }
        }
        "#,
        "main",
        "
        enter
        join +11
        irreversible glue
        sense.holding $0
        push.local $0
        jump.unless +3
        irreversible glue
        jump +6
        land -3
        push.const 1.0
        wait
        irreversible glue
        jump -11
        land -6
        return
        ",
    );
}
