//! What the code does about errors: where each is due, and how it goes on.

use crate::common::check_code as check;

#[test]
fn a_warning_is_noted() {
    check(
        r"
        error e { severity warning }
        sequence main {
        throw e wait 1 s
        }
        ",
        "main",
        "
        enter
        error.raise e
        error.clear e
        push.const 1.0
        wait
        return
        ",
    );
}

#[test]
fn an_error_without_recovery_stops_with_the_error_pending() {
    check(
        r"
        error e { }
        sequence main {
        if holding { throw e } wait 1 s
        }
        ",
        "main",
        "
        enter
        sense.holding $0
        push.local $0
        jump.unless +6
        error.raise e
        error.due e
        push.bool high
        store.global $leaving
        jump +4
        land -6
        push.const 1.0
        wait
        join -4
        return
        ",
    );
}

#[test]
fn a_fatal_error_stops() {
    check(
        r"
        error e { severity fatal }
        sequence main {
        if holding { throw e }
        }
        ",
        "main",
        "
        enter
        sense.holding $0
        push.local $0
        jump.unless +6
        error.raise e
        error.due e
        push.bool high
        store.global $leaving
        jump +2
        land -6
        join -2
        return
        ",
    );
}

#[test]
fn recover_and_go_on() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix then continue }
        sequence fix { move to a }
        sequence main {
        throw e wait 1 s
        }
        ",
        "main",
        "
        enter
        error.raise e
        error.due e
        call fix
        error.clear e
        push.const 1.0
        wait
        return
        ",
    );
}

#[test]
fn recover_and_do_the_action_again() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix then return to action }
        sequence fix { move to a }
        advanced move go { distance 1 mm x on failure { throw e } }
        sequence main {
        advance go wait 1 s
        }
        ",
        "main",
        "
        enter
        push.int 0
        store.local $rounds
        join +9
        call go
        push.raised e
        jump.unless +11
        error.due e
        jump.unless.local.lt.imm $rounds 3 +5
        call fix
        error.clear e
        add.local.imm $rounds 1
        jump -9
        land -5
        push.bool high
        store.global $leaving
        jump +4
        land -11
        push.const 1.0
        wait
        join -4
        return
        ",
    );
}

#[test]
fn recover_and_do_the_sequence_again() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix then return to sequence }
        sequence fix { move to a }
        advanced move go { distance 1 mm x on failure { throw e } }
        sequence main {
        speed slow advance go wait 1 s
        }
        ",
        "main",
        "
        enter
        push.setting speed
        store.local $initial_speed
        join +23
        push.speed slow
        setting.set speed
        call go
        push.raised e
        jump.unless +10
        error.due e
        jump.unless.local.lt.imm $rounds 3 +4
        call fix
        error.clear e
        jump +9
        land -4
        push.bool high
        store.global $leaving
        jump +11
        land -10
        push.const 1.0
        wait
        jump +6
        land -9
        add.local.imm $rounds 1
        push.local $initial_speed
        setting.set speed
        jump -23
        land -6
        join -11
        push.local $initial_speed
        setting.set speed
        return
        ",
    );
}

#[test]
fn recover_and_stop() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix then stop }
        sequence fix { move to a }
        sequence main {
        if holding { throw e } wait 1 s
        }
        ",
        "main",
        "
        enter
        sense.holding $0
        push.local $0
        jump.unless +7
        error.raise e
        error.due e
        call fix
        push.bool high
        store.global $leaving
        jump +4
        land -7
        push.const 1.0
        wait
        join -4
        return
        ",
    );
}

#[test]
fn recover_and_restart_the_program() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix then restart program }
        sequence fix { move to a }
        var n = 1
        sequence main { if n > 0 { throw e } }
        ",
        "$start",
        "
        enter
        join +18
        push.int 1
        store.global n
        call main
        push.global $leaving
        jump.unless +14
        push.global $restart
        jump.unless +13
        jump.unless.local.lt.imm $rounds 3 +13
        add.local.imm $rounds 1
        push.raised e
        jump.unless +2
        error.clear e
        join -2
        push.bool low
        store.global $restart
        push.bool low
        store.global $leaving
        jump -18
        land -14
        join -13
        join -13
        halt
        ",
    );
}

#[test]
fn the_handler_of_a_restart_leaves_the_error_pending() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix then restart program }
        sequence fix { move to a }
        sequence main {
        if holding { throw e }
        }
        ",
        "main",
        "
        enter
        sense.holding $0
        push.local $0
        jump.unless +9
        error.raise e
        error.due e
        call fix
        push.bool high
        store.global $restart
        push.bool high
        store.global $leaving
        jump +2
        land -9
        join -2
        return
        ",
    );
}

#[test]
fn reversal_given_up_calls_otherwise() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover by reversing 2 actions otherwise using fix then continue }
        sequence fix { move to a }
        sequence main {
        throw e wait 1 s
        }
        ",
        "main",
        "
        enter
        error.raise e
        error.due e
        call fix
        error.clear e
        push.const 1.0
        wait
        return
        ",
    );
}

#[test]
fn an_error_for_after_the_sequence_is_due_in_its_caller() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix respond after current sequence then return to action }
        sequence fix { move to a }
        sequence inner { throw e wait 1 s }
        sequence main {
        call inner wait 2 s
        }
        ",
        "main",
        "
        enter
        push.int 0
        store.local $rounds
        join +9
        call inner
        push.raised e
        jump.unless +11
        error.due e
        jump.unless.local.lt.imm $rounds 3 +5
        call fix
        error.clear e
        add.local.imm $rounds 1
        jump -9
        land -5
        push.bool high
        store.global $leaving
        jump +4
        land -11
        push.const 2.0
        wait
        join -4
        return
        ",
    );
}

#[test]
fn the_sequence_goes_on_meanwhile() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix respond after current sequence then return to action }
        sequence fix { move to a }
        sequence inner { throw e wait 1 s }
        sequence main { call inner wait 2 s }
        ",
        "inner",
        "
        enter
        push.raised e
        jump.if +2
        error.raise e
        join -2
        push.const 1.0
        wait
        return
        ",
    );
}

#[test]
fn what_is_due_after_main_is_due_in_the_start() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix respond after current sequence then return to sequence }
        sequence fix { move to a }
        sequence main { throw e wait 1 s }
        ",
        "$start",
        "
        enter
        push.int 0
        store.local $rounds
        join +9
        call main
        push.raised e
        jump.unless +9
        error.due e
        jump.unless.local.lt.imm $rounds 3 +5
        call fix
        error.clear e
        add.local.imm $rounds 1
        jump -9
        land -5
        jump +2
        land -9
        join -2
        halt
        ",
    );
}

#[test]
fn a_caller_leaves_with_its_callee() {
    check(
        r"
        error e { }
        sequence inner { throw e }
        sequence main {
        speed slow { call inner } call inner wait 1 s
        }
        ",
        "main",
        "
        enter
        push.setting speed
        store.local $speed
        push.speed slow
        setting.set speed
        call inner
        push.global $leaving
        jump.unless +4
        push.local $speed
        setting.set speed
        jump +9
        land -4
        push.local $speed
        setting.set speed
        call inner
        push.global $leaving
        jump.if +4
        push.const 1.0
        wait
        join -9
        join -4
        return
        ",
    );
}

#[test]
fn a_recovery_does_not_begin_within_another() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix }
        sequence fix { throw e }
        sequence main {
        throw e
        }
        ",
        "fix",
        "
        enter
        join +25
        error.raise e
        error.due e
        push.global $recovering
        jump.if +14
        jump.unless.local.lt.imm $rounds 3 +14
        error.clear e
        push.bool high
        store.global $recovering
        call fix
        push.bool low
        store.global $recovering
        push.global $leaving
        jump.if +2
        jump +9
        land -2
        error.clear e
        error.raise e
        join -14
        join -14
        push.bool high
        store.global $leaving
        jump +4
        land -9
        add.local.imm $rounds 1
        jump -25
        land -4
        return
        ",
    );
}

#[test]
fn a_block_with_a_reverse_is_left_by_its_end() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        error e { recover using fix }
        sequence fix { move to a }
        sequence main {
        skip in reverse { if holding { throw e } wait 1 s }
        }
        ",
        "main",
        "
        enter
        join +40
        block.begin
        push.int 0
        store.local $way
        sense.holding $0
        push.local $0
        jump.unless +15
        error.raise e
        error.due e
        jump.unless.local.lt.imm $rounds 3 +6
        call fix
        error.clear e
        push.int 2
        store.local $way
        jump +10
        land -6
        push.bool low
        store.global $leaving
        push.int 1
        store.local $way
        jump +5
        land -15
        push.const 1.0
        wait
        join -10
        join -5
        block.skip -25
        push.local $way
        jump.unless.eq.imm 1 +4
        push.bool high
        store.global $leaving
        jump +11
        land -4
        push.local $way
        jump.unless.eq.imm 2 +2
        jump +3
        land -2
        jump +4
        land -3
        add.local.imm $rounds 1
        jump -40
        land -4
        join -11
        return
        ",
    );
}
