//! What the words become that say how a block goes back.

use crate::common::check_code as check;

#[test]
fn a_block_in_reverse_begins_with_the_frame_around_it() {
    let source = r"
        joints a = [0, -90, 90, -90, -90, 0] deg

        sequence main {
        var pause = 1 s
        position before
        for i from 1 to 2 {
        do { move to a } in reverse { var own = pause * real(i) wait own move to before }
        }
        }
        ";
    check(
        source,
        "main$reverse0",
        "
        enter
        push.local pause
        push.counter 0
        int.to_real
        real.mul
        store.local own
        push.local own
        wait
        move.slot before joint
        return
        ",
    );
    let module = crate::common::module(source);
    let function = crate::common::function(&module, "main$reverse0");
    assert_eq!((function.parameters, function.counters), (1, 1));
    let names: Vec<&str> = function.locals.iter().map(|local| local.name.as_str()).collect();
    assert_eq!(names, ["pause", "own"]);
    assert_eq!(function.slots, ["before"]);
}

#[test]
fn a_kept_block_is_there_twice_and_finds_again_what_it_changes() {
    let source = r"
        var total = 0
        joints a = [0, -90, 90, -90, -90, 0] deg

        sequence count { total += 1 }
        sequence main {
        var n = 1
        keep in reverse {
        var own = n
        n += own
        speed slow
        move to a
        call count
        }
        }
        ";
    check(
        source,
        "main",
        "
        enter
        push.setting speed
        store.local $initial_speed
        push.int 1
        store.local n
        push.local n
        store.local $kept
        push.global total
        store.local $kept4
        push.setting speed
        store.local $kept5
        block.begin
        push.local n
        store.local own
        add.local.local n own
        push.speed slow
        setting.set speed
        push.joints a
        move.joint
        call count
        block.replace main$reverse0 -9
        push.local $initial_speed
        setting.set speed
        return
        ",
    );
    check(
        source,
        "main$reverse0",
        "
        enter
        push.local $kept
        store.local n
        push.local $kept4
        store.global total
        push.local $kept5
        setting.set speed
        push.local n
        store.local own
        add.local.local n own
        push.speed slow
        setting.set speed
        push.joints a
        move.joint
        call count
        return
        ",
    );
}

#[test]
fn kept_blocks_in_one_another_are_functions_with_one_frame() {
    let source = r"
        sequence main {
        var n = 1
        keep in reverse { keep in reverse { n += 1 } wait 1 s }
        }
        ";
    check(
        source,
        "main",
        "
        enter
        push.int 1
        store.local n
        push.local n
        store.local $kept
        block.begin
        push.local n
        store.local $kept2
        block.begin
        add.local.imm n 1
        block.replace main$reverse1 -2
        push.const 1.0
        wait
        block.replace main$reverse0 -8
        return
        ",
    );
    check(
        source,
        "main$reverse0",
        "
        enter
        push.local $kept
        store.local n
        push.local n
        store.local $kept2
        block.begin
        add.local.imm n 1
        block.replace main$reverse1 -2
        push.const 1.0
        wait
        return
        ",
    );
    check(
        source,
        "main$reverse1",
        "
        enter
        push.local $kept2
        store.local n
        add.local.imm n 1
        return
        ",
    );
}

#[test]
fn the_parameters_of_the_way_back_are_settings_for_a_block() {
    check(
        r"
        joints a = [0, -90, 90, -90, -90, 0] deg

        sequence main {
        with speed very slow, force limit 20 N in reverse { move to a }
        with straight moves in reverse { if holding { return } }
        }
        ",
        "main",
        "
        enter
        push.setting reverse.speed
        store.local $reverse_speed
        push.speed very_slow
        setting.set reverse.speed
        push.setting reverse.force_limit
        store.local $reverse_force_limit
        push.const 20.0
        setting.set reverse.force_limit
        push.joints a
        move.joint
        push.local $reverse_force_limit
        setting.set reverse.force_limit
        push.local $reverse_speed
        setting.set reverse.speed
        push.setting reverse.straight
        store.local $reverse_straight
        push.bool high
        setting.set reverse.straight
        sense.holding $3
        push.local $3
        jump.unless +4
        push.local $reverse_straight
        setting.set reverse.straight
        jump +4
        land -4
        push.local $reverse_straight
        setting.set reverse.straight
        join -4
        return
        ",
    );
}

#[test]
fn an_advanced_move_goes_back_by_its_counterpart_or_against_its_force() {
    let source = r"
        error jam { then continue }
        advanced move insert {
        distance 10 mm forward
        stop if force > 5 N
        on failure { throw jam }
        } reverse pull
        advanced move pull {
        distance 10 mm backward
        stop if force > 5 N
        succeeds if force > 0 N
        opposite force in reverse
        }
        sequence main { advance insert }
        ";
    check(
        source,
        "main",
        "
        enter
        block.begin
        call insert
        block.replace pull -2
        push.raised jam
        jump.unless +2
        error.clear jam
        join -2
        return
        ",
    );
    check(
        source,
        "pull",
        "
        enter
        push.const 0.01
        push.const 5.0
        move.guarded.opposite -z tcp
        sense.distance $distance
        sense.peak_force $force
        return
        ",
    );
}
