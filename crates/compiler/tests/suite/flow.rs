//! What branches and loops become; jumps are written as distances.

use crate::common::check_code as check;

#[test]
fn a_branch_is_a_jump_and_a_recorded_join() {
    check(
        r"
        sequence main {
        var x = 1
        if x < 5 { x = 2 }
        if x > 5 { x = 3 } else { x = 4 }
        }
        ",
        "main",
        "
        enter
        push.int 1
        store.local x
        jump.unless.local.lt.imm x 5 +3
        push.int 2
        store.local x
        join -3
        push.int 5
        push.local x
        jump.unless.lt +4
        push.int 3
        store.local x
        jump +4
        land -4
        push.int 4
        store.local x
        join -4
        return
        ",
    );
}

#[test]
fn comparisons_of_integers_are_jumps() {
    check(
        r"
        sequence main {
        var x = 1
        var y = 2
        if x < y { wait 1 s }
        if x <= 7 { wait 1 s }
        if x <= y { wait 1 s }
        if x == 7 { wait 1 s }
        if 7 == y { wait 1 s }
        if x != y { wait 1 s }
        if not (x < 40000) { wait 1 s }
        if x == 40000 { wait 1 s }
        }
        ",
        "main",
        "
        enter
        push.int 1
        store.local x
        push.int 2
        store.local y
        jump.unless.local.lt.local x y +3
        push.const 1.0
        wait
        join -3
        jump.unless.local.lt.imm x 8 +3
        push.const 1.0
        wait
        join -3
        push.local x
        push.local y
        jump.unless.le +3
        push.const 1.0
        wait
        join -3
        push.local x
        jump.unless.eq.imm 7 +3
        push.const 1.0
        wait
        join -3
        push.local y
        jump.unless.eq.imm 7 +3
        push.const 1.0
        wait
        join -3
        push.local x
        push.local y
        jump.unless.ne +3
        push.const 1.0
        wait
        join -3
        push.int 40000
        push.local x
        jump.unless.le +3
        push.const 1.0
        wait
        join -3
        push.local x
        push.int 40000
        jump.unless.eq +3
        push.const 1.0
        wait
        join -3
        return
        ",
    );
}

#[test]
fn an_asserted_join_is_true_where_the_jump_comes() {
    check(
        r"
        sequence main {
        var x = 1
        if x < 5 { x = 9 } ending when x == 9
        if x < 5 { x = 9 } else { x = 8 } ending when not (x == 8)
        }
        ",
        "main",
        "
        enter
        push.int 1
        store.local x
        jump.unless.local.lt.imm x 5 +7
        push.int 9
        store.local x
        push.local x
        push.int 9
        int.eq
        bool.not
        join.assert -7
        jump.unless.local.lt.imm x 5 +4
        push.int 9
        store.local x
        jump +8
        land -4
        push.int 8
        store.local x
        push.local x
        push.int 8
        int.eq
        bool.not
        join.assert -8
        return
        ",
    );
}

#[test]
fn a_while_loop_tests_at_its_end() {
    check(
        r"
        sequence main {
        var x = 1
        while x != 9 { x += 1 }
        while force > 3 N { move 1 mm up }
        }
        ",
        "main",
        "
        enter
        push.int 1
        store.local x
        push.local x
        push.int 9
        jump.unless.ne +5
        join +3
        add.local.imm x 1
        push.local x
        jump.unless.eq.imm 9 -3
        join -5
        sense.force $1
        push.const 3.0
        push.local $1
        real.lt
        jump.unless +9
        join +7
        push.const 0.001
        move.relative -y tcp
        sense.force $1
        push.const 3.0
        push.local $1
        real.lt
        jump.if -7
        join -9
        return
        ",
    );
}

#[test]
fn a_while_loop_with_a_test_of_one_instruction_tests_at_its_top() {
    check(
        r"
        sequence main {
        var x = 1
        while x < 10 { x += 1 }
        }
        ",
        "main",
        "
        enter
        push.int 1
        store.local x
        join +3
        jump.unless.local.lt.imm x 10 +3
        add.local.imm x 1
        jump -3
        land -3
        return
        ",
    );
}

#[test]
fn a_while_loop_with_an_asserted_join() {
    check(
        r"
        sequence main {
        var x = 0
        while x < 10 entered when x == 0 { x += 1 }
        }
        ",
        "main",
        "
        enter
        push.int 0
        store.local x
        push.local x
        push.int 0
        int.eq
        bool.not
        join.assert +3
        jump.unless.local.lt.imm x 10 +3
        add.local.imm x 1
        jump -3
        land -3
        return
        ",
    );
}

#[test]
fn counted_loops_have_a_counter_each() {
    check(
        r"
        sequence main {
        var x = 0
        for i from 0 to 9 { repeat x times { x += i * 2 } }
        repeat 2 times { wait 1 s }
        }
        ",
        "main",
        "
        enter
        push.int 0
        store.local x
        push.int 0
        push.int 9
        for.enter 0 +11
        for.top 0 +9
        push.int 1
        push.local x
        for.enter 1 +5
        for.top 1 +3
        int.mul.counter.imm 0 2
        add.local x
        for.next 1 -3
        for.exit 1 -5
        for.next 0 -9
        for.exit 0 -11
        push.int 1
        push.int 2
        for.enter 0 +5
        for.top 0 +3
        push.const 1.0
        wait
        for.next 0 -3
        for.exit 0 -5
        return
        ",
    );
}

#[test]
fn a_break_is_a_recorded_join_after_the_loop() {
    check(
        r"
        sequence main {
        var x = 0
        loop {
        x += 1
        if x > 5 { break }
        if x == 4 { wait 1 s break }
        }
        for i from 1 to 3 { if x == i { break } }
        }
        ",
        "main",
        "
        enter
        push.int 0
        store.local x
        join +9
        add.local.imm x 1
        jump.unless.local.lt.imm x 6 +8
        push.local x
        jump.unless.eq.imm 4 +4
        push.const 1.0
        wait
        jump +4
        land -4
        jump -9
        land -8
        join -4
        push.int 1
        push.int 3
        for.enter 0 +6
        for.top 0 +4
        push.local x
        push.counter 0
        jump.unless.ne +3
        for.next 0 -4
        for.exit 0 -6
        join -3
        return
        ",
    );
}

#[test]
fn a_loop_that_never_comes_round_is_none() {
    check(
        r"
        sequence main {
        loop { wait 1 s break }
        while holding { break }
        repeat 3 times { break }
        }
        ",
        "main",
        "
        enter
        push.const 1.0
        wait
        jump +1
        land -1
        sense.holding $0
        push.local $0
        jump.unless +2
        jump +2
        land -2
        join -2
        push.int 1
        push.int 3
        for.enter 0 +7
        for.top 0 +5
        push.bool low
        jump.if +2
        jump +4
        land -2
        for.next 0 -5
        for.exit 0 -7
        join -4
        return
        ",
    );
}

#[test]
fn a_loop_without_end_still_reaches_the_return() {
    check(
        r"
        sequence main {
        loop { wait 1 s }
        }
        ",
        "main",
        "
        enter
        join +4
        push.const 1.0
        wait
        push.bool high
        jump.if -4
        return
        ",
    );
}

#[test]
fn a_return_is_a_recorded_join_at_the_end() {
    check(
        r"
        sequence main {
        if holding { return }
        wait 1 s
        }
        ",
        "main",
        "
        enter
        sense.holding $0
        push.local $0
        jump.unless +2
        jump +4
        land -2
        push.const 1.0
        wait
        join -4
        return
        ",
    );
}
