//! What advanced moves become: attempts, success, and what follows.

use crate::common::check_code as check;

#[test]
fn an_advanced_move_without_an_aftermath() {
    check(
        r"
        advanced move go { distance 5 mm forward stop if force > 3 N }
        sequence main { advance go }
        ",
        "go",
        "
        enter
        push.const 0.005
        push.const 3.0
        move.guarded +z tcp
        sense.distance $distance
        sense.peak_force $force
        return
        ",
    );
}

#[test]
fn an_advanced_move_with_behaviours() {
    check(
        r"
        error e { }
        advanced move go { distance 5 mm left in base speed slow
        succeeds if distance > 3 mm and force < 2 N
        on success { return to initial position }
        on failure { throw e } }
        sequence main { advance go }
        ",
        "go",
        "
        enter
        remember $initial
        push.setting speed
        store.local $speed
        push.speed slow
        setting.set speed
        push.const 0.005
        move.relative +y base
        sense.distance $distance
        sense.peak_force $force
        push.local $speed
        setting.set speed
        push.const 0.003
        push.local $distance
        real.lt
        push.local $force
        push.const 2.0
        real.lt
        bool.and
        jump.if +3
        error.raise e
        jump +3
        land -3
        move.slot $initial linear
        join -3
        return
        ",
    );
}

#[test]
fn an_advanced_move_that_is_tried_again() {
    check(
        r"
        error e { }
        advanced move go { distance 5 mm x
        on failure { return to initial position repeat with perturbation 2 mm 3 times throw e } }
        sequence main { advance go }
        ",
        "go",
        "
        enter
        remember $initial
        push.int 0
        push.int 3
        for.enter 0 +34
        for.top 0 +32
        push.counter 0
        push.int 0
        jump.unless.ne +20
        draw $aside
        draw $aside3
        move.slot $initial linear
        push.const 0.0
        push.local $aside
        push.const 2.0
        real.mul
        push.const 1.0
        real.sub
        push.const 0.002
        real.mul
        push.local $aside3
        push.const 2.0
        real.mul
        push.const 1.0
        real.sub
        push.const 0.002
        real.mul
        move.offset tcp
        join -20
        push.const 0.005
        move.relative +x tcp
        sense.distance $distance
        sense.peak_force $force
        push.const 0.004999
        push.local $distance
        real.le
        jump.if +5
        for.next 0 -32
        for.exit 0 -34
        move.slot $initial linear
        error.raise e
        join -5
        return
        ",
    );
}

#[test]
fn a_requirement_traps_or_throws() {
    check(
        r"
        advanced move go { requires holding   and
         not input 2 distance 1 mm x }
        sequence main { advance go }
        ",
        "go",
        "
        enter
        sense.holding $0
        sense.input $1 2
        push.local $0
        push.local $1
        bool.not
        bool.and
        require go requires holding and not input 2
        push.const 0.001
        move.relative +x tcp
        sense.distance $distance
        sense.peak_force $force
        return
        ",
    );
}

#[test]
fn a_requirement_that_fails_throws_what_failure_throws() {
    check(
        r"
        error e { }
        advanced move go { requires holding distance 1 mm x on failure { throw e } }
        sequence main { advance go }
        ",
        "go",
        "
        enter
        sense.holding $0
        push.local $0
        jump.unless +9
        push.const 0.001
        move.relative +x tcp
        sense.distance $distance
        sense.peak_force $force
        push.const 0.000999
        push.local $distance
        real.le
        jump.if +3
        join -9
        error.raise e
        join -3
        return
        ",
    );
}
