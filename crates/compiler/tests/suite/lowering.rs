//! What each statement and expression becomes; prefixes are left out, jumps are distances.

use crate::common::{code, lines, module};

/// That a function of a program becomes this code.
fn check(source: &str, function: &str, expected: &str) {
    assert_eq!(code(&module(source), function), lines(expected));
}

#[test]
fn integers_fuse_with_small_numbers_and_locals() {
    check(
        r"
        sequence main {
        var x = 1
        var y = 2
        x = y
        x = x + y
        x = x * 3 + 7
        x = (x + 1) * (y - 2) mod 5
        x = y mod 7 + x
        x = x * 5000000000
        }
        ",
        "main",
        "
        enter
        push.int 1
        store.local x
        push.int 2
        store.local y
        push.local y
        store.local x
        int.add.locals x y
        store.local x
        int.mul.local.imm x 3
        int.add.imm 7
        store.local x
        push.local x
        int.add.imm 1
        push.local y
        int.add.imm -2
        int.mul
        int.rem.imm 5
        store.local x
        int.rem.local.imm y 7
        int.add.local x
        store.local x
        push.local x
        push.const 5000000000
        int.mul
        store.local x
        return
        ",
    );
}

#[test]
fn constants_are_computed_at_compile_time() {
    check(
        r"
        sequence main {
        var x = -3 + 2 * 5
        var r = 1.5 / 2
        var s = abs(-2 mm) + sqrt(4 mm * 4 mm)
        var t = 90 deg == 3.141592653589793 rad / 2
        if t and r * 1 m > s { x = 1 }
        wait min(2 s, 300 ms)
        }
        ",
        "main",
        "
        enter
        push.int 7
        store.local x
        push.const 0.75
        store.local r
        push.const 0.006
        store.local s
        push.bool high
        store.local t
        push.local t
        push.local s
        push.local r
        push.const 1.0
        real.mul
        real.lt
        bool.and
        jump.unless +3
        push.int 1
        store.local x
        join -3
        push.const 0.3
        wait
        return
        ",
    );
}

#[test]
fn updates_are_always_where_the_value_does_not_read_the_variable() {
    check(
        r"
        var n = 0
        sequence main {
        var x = 1
        var y = 2
        x += 1
        x -= 5
        x += y
        x -= y
        x += x
        x += y * 3
        n += x
        n -= 2
        n += n
        for i from 1 to n { x += i }
        }
        ",
        "main",
        "
        enter
        push.int 1
        store.local x
        push.int 2
        store.local y
        add.local.imm x 1
        add.local.imm x -5
        add.local.local x y
        push.local y
        sub.local x
        int.add.locals x x
        store.local x
        int.mul.local.imm y 3
        add.local x
        push.local x
        add.global n
        push.int 2
        sub.global n
        push.global n
        push.global n
        int.add
        store.global n
        push.int 1
        push.global n
        for.enter 0 +4
        for.top 0 +2
        add.local.counter x 0
        for.next 0 -2
        for.exit 0 -4
        return
        ",
    );
}

#[test]
fn a_sum_of_reals_is_recorded() {
    check(
        r"
        var gap = 3 mm
        sequence main {
        gap += 1 mm
        var r = 0.5
        r -= gap / 1 mm
        }
        ",
        "main",
        "
        enter
        push.global gap
        push.const 0.001
        real.add
        store.global gap
        push.const 0.5
        store.local r
        push.local r
        push.global gap
        push.const 0.001
        real.div
        real.sub
        store.local r
        return
        ",
    );
}

#[test]
fn reals_compare_and_combine() {
    check(
        r"
        sequence main {
        var x = 1
        var r = real(x) / 3
        var ok = r >= 0.5 and not (r == 1) or x != 2
        ok = ok != true
        x = int(max(r, 0.25))
        }
        ",
        "main",
        "
        enter
        push.int 1
        store.local x
        push.local x
        int.to_real
        push.const 3.0
        real.div
        store.local r
        push.const 0.5
        push.local r
        real.le
        push.local r
        push.const 1.0
        real.eq
        bool.not
        bool.and
        push.local x
        push.int 2
        int.ne
        bool.or
        store.local ok
        push.local ok
        push.bool high
        bool.eq
        bool.not
        store.local ok
        push.local r
        push.const 0.25
        real.max
        real.to_int
        store.local x
        return
        ",
    );
}

#[test]
fn readings_and_draws_come_before_their_statement() {
    check(
        r"
        sequence main {
        var f = force
        if holding and input 3 and f > 3 N { wait 1 s }
        var near = random(f, 10 N)
        var far = random(f * 2, 10 N)
        if near < far and distance > 3 mm { wait 1 s }
        }
        ",
        "main",
        "
        enter
        sense.force $0
        push.local $0
        store.local f
        sense.holding $1
        sense.input $2 3
        push.local $1
        push.local $2
        bool.and
        push.const 3.0
        push.local f
        real.lt
        bool.and
        jump.unless +3
        push.const 1.0
        wait
        join -3
        draw $0
        push.local f
        push.local $0
        push.const 10.0
        push.local f
        real.sub
        real.mul
        real.add
        store.local near
        push.local f
        push.const 2.0
        real.mul
        store.local $0
        draw $3
        push.local $0
        push.local $3
        push.const 10.0
        push.local $0
        real.sub
        real.mul
        real.add
        store.local far
        sense.distance $0
        push.local near
        push.local far
        real.lt
        push.const 0.003
        push.local $0
        real.lt
        bool.and
        jump.unless +3
        push.const 1.0
        wait
        join -3
        return
        ",
    );
}

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
        sense.force $0
        push.const 3.0
        push.local $0
        real.lt
        jump.unless +9
        join +7
        push.const 0.001
        move.relative -y tcp
        sense.force $0
        push.const 3.0
        push.local $0
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
        for.enter 0 +12
        for.top 0 +10
        push.int 1
        push.local x
        for.enter 1 +6
        for.top 1 +4
        push.counter 0
        int.mul.imm 2
        add.local x
        for.next 1 -4
        for.exit 1 -6
        for.next 0 -10
        for.exit 0 -12
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

#[test]
fn motions() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        joints b = [9, -90, 90, -90, -90, 0] deg
        item peg { keyframe grasp = [0, 0, 20] mm }
        sequence main {
        move to a
        move to b linearly
        move to peg.grasp
        move to peg.grasp linearly
        move 20 mm up in base
        move 20 mm left in toolmount
        move 3 mm -x
        position here
        move to b
        move to here
        move to here linearly
        var c = a
        move to c
        }
        ",
        "main",
        "
        enter
        push.joints a
        move.joint
        push.joints b
        move.linear
        push.item peg
        move.item grasp joint
        push.item peg
        move.item grasp linear
        push.const 0.02
        move.relative +z base
        push.const 0.02
        move.relative -x toolmount
        push.const 0.003
        move.relative -x tcp
        remember here
        push.joints b
        move.joint
        move.slot here joint
        move.slot here linear
        push.joints a
        store.local c
        push.local c
        move.joint
        return
        ",
    );
}

#[test]
fn parameters_are_the_first_locals() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        joints b = [9, -90, 90, -90, -90, 0] deg
        item peg { keyframe grasp = [0, 0, 20] mm }
        sequence main { call go(a, peg, 3 mm, 1, true) }
        action go(where: joints, part: item, height: length, n: int, fast: bool) {
        move to where
        move to part.grasp
        move height * real(n) up
        if fast { wait 1 s }
        }
        ",
        "go",
        "
        enter
        push.local where
        move.joint
        push.local part
        move.item grasp joint
        push.local height
        push.local n
        int.to_real
        real.mul
        move.relative -y tcp
        push.local fast
        jump.unless +3
        push.const 1.0
        wait
        join -3
        return
        ",
    );
}

#[test]
fn headings_depend_on_the_frame() {
    check(
        r"
        sequence main {
        move 1 mm forward 
        move 1 mm backward 
        move 1 mm left 
        move 1 mm right 
        move 1 mm up 
        move 1 mm down 
        move 1 mm forward in base
        move 1 mm backward in base
        move 1 mm left in base
        move 1 mm right in base
        move 1 mm up in base
        move 1 mm down in base
        }
        ",
        "main",
        "
        enter
        push.const 0.001
        move.relative +z tcp
        push.const 0.001
        move.relative -z tcp
        push.const 0.001
        move.relative -x tcp
        push.const 0.001
        move.relative +x tcp
        push.const 0.001
        move.relative -y tcp
        push.const 0.001
        move.relative +y tcp
        push.const 0.001
        move.relative +x base
        push.const 0.001
        move.relative -x base
        push.const 0.001
        move.relative +y base
        push.const 0.001
        move.relative -y base
        push.const 0.001
        move.relative +z base
        push.const 0.001
        move.relative -z base
        return
        ",
    );
}

#[test]
fn an_io_operation_is_a_function() {
    check(
        r"
        io open { set 0 low sleep 0.5 s sleep 0.25 s toggle 1 sleep 1 s set 2 high }
        sequence main { io open }
        ",
        "open",
        "
        enter
        push.const 0.75
        output.set 0 low
        push.const 1.0
        output.toggle 1
        push.const 0.0
        output.set 2 high
        return
        ",
    );
}

#[test]
fn a_sleep_is_the_settling_time_of_the_output_before_it() {
    check(
        r"
        sequence main {
        set 3 high
        sleep 1 s
        sleep 250 ms
        toggle 4
        wait 1 s
        sleep 2 s
        }
        ",
        "main",
        "
        enter
        push.const 1.25
        output.set 3 high
        push.const 0.0
        output.toggle 4
        push.const 1.0
        wait
        push.const 2.0
        wait
        return
        ",
    );
}

#[test]
fn waits() {
    check(
        r"
        sequence main {
        wait 0.5 s
        wait until input 3 high for up to 2 s
        wait until input 3 low for up to 2 s else { set 0 low }
        }
        ",
        "main",
        "
        enter
        push.const 0.5
        wait
        push.const 2.0
        wait.input $0 3 high
        push.const 2.0
        wait.input $0 3 low
        push.local $0
        jump.if +3
        push.const 0.0
        output.set 0 low
        join -3
        return
        ",
    );
}

#[test]
fn a_setting_holds_to_the_end_of_the_sequence() {
    check(
        r"
        sequence main {
        wait 1 s
        speed slow
        tool gripper
        speed fast
        if holding { return }
        }
        ",
        "main",
        "
        enter
        push.setting speed
        store.local $0
        push.setting tool
        store.local $1
        push.const 1.0
        wait
        push.speed slow
        setting.set speed
        push.tool gripper
        setting.set tool
        push.speed fast
        setting.set speed
        sense.holding $2
        push.local $2
        jump.unless +2
        jump +2
        land -2
        join -2
        push.local $0
        setting.set speed
        push.local $1
        setting.set tool
        return
        ",
    );
}

#[test]
fn a_setting_for_a_block_is_put_right_on_each_way_out() {
    check(
        r"
        sequence main {
        loop {
        speed very slow {
        if holding { break }
        tool gripper { if input 1 { return } }
        }
        }
        }
        ",
        "main",
        "
        enter
        join +29
        push.setting speed
        store.local $0
        push.speed very_slow
        setting.set speed
        sense.holding $1
        push.local $1
        jump.unless +4
        push.local $0
        setting.set speed
        jump +20
        land -4
        push.setting tool
        store.local $2
        push.tool gripper
        setting.set tool
        sense.input $1 1
        push.local $1
        jump.unless +6
        push.local $2
        setting.set tool
        push.local $0
        setting.set speed
        jump +8
        land -6
        push.local $2
        setting.set tool
        push.local $0
        setting.set speed
        jump -29
        land -20
        join -8
        return
        ",
    );
}

#[test]
fn the_start_stores_first_values_and_calls_main() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg
        var n = 2 * 3
        var r = 1.5 N
        var ok = not false
        var home = a
        sequence main { if n > 3 and r > 1 N and ok { move to home } }
        ",
        "$start",
        "
        enter
        push.int 6
        store.global n
        push.const 1.5
        store.global r
        push.bool high
        store.global ok
        push.joints a
        store.global home
        call main
        halt
        ",
    );
}
