//! What each expression and assignment becomes; prefixes are left out.

use crate::common::check_code as check;

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
        sub.local.local x y
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
        sense.holding $2
        sense.input $3 3
        push.local $2
        push.local $3
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
        draw $5
        push.local $0
        push.local $5
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
