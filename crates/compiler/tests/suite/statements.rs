//! What motions, outputs, waits, settings and the start become.

use crate::common::check_code as check;

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
        store.local $initial_speed
        push.setting tool
        store.local $initial_tool
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
        push.local $initial_speed
        setting.set speed
        push.local $initial_tool
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
        store.local $speed
        push.speed very_slow
        setting.set speed
        sense.holding $1
        push.local $1
        jump.unless +4
        push.local $speed
        setting.set speed
        jump +20
        land -4
        push.setting tool
        store.local $tool
        push.tool gripper
        setting.set tool
        sense.input $1 1
        push.local $1
        jump.unless +6
        push.local $tool
        setting.set tool
        push.local $speed
        setting.set speed
        jump +8
        land -6
        push.local $tool
        setting.set tool
        push.local $speed
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
