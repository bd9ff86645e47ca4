//! Errors that faults raise, what an incident may cost, what must hold before, and the cleanup.

use crate::common::{check_code, findings, function, listing, module};
use obverse_bytecode::{Bounds, FaultName, Watched};
use obverse_isa::Instr;

const HOME: &str = "joints a = [0, -90, 90, -90, -90, 0] deg\n";

fn with_home(source: &str) -> String {
    format!("{HOME}{source}")
}

#[test]
fn a_module_says_which_faults_raise_an_error_and_what_an_incident_may_cost() {
    let module = module(
        "error e { on missing, collision give up after 2 m, 6 times, 1.5 min }
         error f { on protective stop }
         sequence main { move 1 mm up }",
    );
    let [e, f] = &module.errors[..] else { panic!("two errors") };
    assert_eq!(e.faults, [FaultName::Collision, FaultName::Missing]);
    assert_eq!(f.faults, [FaultName::ProtectiveStop]);
    let bounds = Bounds { attempts: Some(6), time_s: Some(90.0), distance_m: Some(2.0) };
    assert_eq!((e.bounds, f.bounds), (bounds, Bounds::default()));
}

#[test]
fn a_module_says_what_is_watched_for_an_error() {
    let module = module(
        "input door = 3
         error e { on input door low, force > 2 * 15 N respond at once }
         error f { on input 2 high }
         sequence main { move 1 mm up }",
    );
    let [e, f] = &module.errors[..] else { panic!("two errors") };
    let door = Watched::Input { bit: 3, level: false };
    assert_eq!(e.watches, [door, Watched::Force { above_n: 30.0 }]);
    assert_eq!((e.interrupts(), f.interrupts()), (true, false));
    for (wrong, code) in [
        ("on force > 3 mm", "E0202"),
        ("on force > 0 N", "E0210"),
        ("on input nowhere high", "E0101"),
    ] {
        let source = format!("error e {{ {wrong} }} sequence main {{ move 1 mm up }}");
        let found = findings(&source);
        assert!(found.iter().any(|it| it.contains(code)), "{wrong}: {found:?}");
    }
}

#[test]
fn an_act_is_followed_by_a_test_for_what_it_may_raise() {
    check_code(
        &with_home("error e { on collision } sequence main { move to a wait 1 s }"),
        "main",
        "
        enter
        push.joints a
        move.joint
        push.raised e
        jump.unless +5
        error.due e
        push.bool high
        store.global $leaving
        jump +4
        land -5
        push.const 1.0
        wait
        join -4
        return
        ",
    );
}

#[test]
fn the_worst_error_comes_first() {
    let text = listing(&module(
        "error odd { severity warning on collision }
         error e { on protective stop }
         error f { on stopped short }
         error bad { severity fatal on emergency stop }
         sequence main { move 1 mm up }",
    ));
    let places = ["push.raised bad", "push.raised e", "push.raised f", "error.clear odd"];
    let found = places.map(|place| text.find(place).unwrap_or_else(|| panic!("{place}\n{text}")));
    assert!(found.is_sorted(), "{text}");
}

#[test]
fn the_parts_of_an_action_end_and_leave_the_error_to_it() {
    let source = with_home(
        "error e { on emergency stop }
         io open { set 0 low set 1 low }
         sequence main { io open }",
    );
    check_code(
        &source,
        "open",
        "
        enter
        push.const 0.0
        output.set 0 low
        push.raised e
        jump.if +5
        push.const 0.0
        output.set 1 low
        push.raised e
        jump.if +2
        join -5
        join -2
        return
        ",
    );
    let text = listing(&module(&source));
    assert!(text.contains("call open\npush.raised e\n"), "{text}");
}

#[test]
fn nothing_is_raised_in_reverse() {
    let source = with_home(
        "error e { on collision then stop }
         action park { move to a }
         sequence main { do { move to a } in reverse { call park move 1 mm up } }",
    );
    let module = module(&source);
    let replacement = function(&module, "main$reverse0");
    let code = &module.code[replacement.first as usize..replacement.end as usize];
    assert!(!code.iter().any(|instr| matches!(instr, Instr::PushRaised { .. })), "{code:?}");
}

#[test]
fn a_block_that_keeps_its_order_responds_where_it_stands() {
    let text = listing(&module(&with_home(
        "error e { on collision recover using free then return to sequence }
         sequence free { wait 1 s }
         sequence main { keep in reverse { move to a } }",
    )));
    let main = text.split_once("\nmain:").map(|(_, rest)| rest);
    let parts = main.and_then(|rest| rest.split_once("main$reverse0:"));
    let (main, after) = parts.expect("main is followed by what runs in reverse");
    assert!(main.contains("push.raised e"), "{text}");
    assert!(!after.contains("push.raised"), "{text}");
}

#[test]
fn a_program_without_such_errors_has_no_test() {
    let text = listing(&module(&with_home(
        "io open { set 0 low } sequence main { move to a io open wait 1 s }",
    )));
    assert!(!text.contains("push.raised"), "{text}");
}

#[test]
fn what_is_required_is_looked_at_again_when_the_action_is_done_again() {
    check_code(
        "error e { recover using feed give up after 2 times then return to action }
         sequence feed { wait 1 s }
         sequence main {
         requires input 1 else throw e
         }",
        "main",
        "
        enter
        push.int 0
        store.local $rounds
        join +10
        sense.input $0 1
        push.local $0
        jump.if +12
        error.raise e
        error.due e
        jump.unless.local.lt.imm $rounds 2 +5
        call feed
        error.clear e
        add.local.imm $rounds 1
        jump -10
        land -5
        push.bool high
        store.global $leaving
        jump +2
        land -12
        join -2
        return
        ",
    );
}

#[test]
fn an_error_that_its_own_recovery_may_raise_is_not_pending_meanwhile() {
    check_code(
        &with_home(
            "error e { on collision recover using free then continue }
             sequence free { wait 1 s move to a }
             sequence main { move to a }",
        ),
        "main",
        "
        enter
        push.joints a
        move.joint
        push.raised e
        jump.unless +18
        error.due e
        error.clear e
        push.bool high
        store.global $recovering
        call free
        push.bool low
        store.global $recovering
        push.global $leaving
        jump.if +2
        jump +7
        land -2
        error.clear e
        error.raise e
        push.bool high
        store.global $leaving
        jump +3
        land -7
        join -18
        join -3
        return
        ",
    );
}

#[test]
fn the_cleanup_is_called_at_the_end_whatever_came_before() {
    let module = module("error e { } sequence main { throw e } cleanup { set 0 low }");
    assert_eq!(module.cleanup, Some(2));
    let text = listing(&module);
    let start = text.split("main:").next().unwrap_or_default();
    assert!(start.ends_with("call main\ncall cleanup\nhalt\n"), "{start}");
}

#[test]
fn mistakes_of_incidents() {
    let source = "
error e { on collision, missing, collision }
error f { on missing recover using fix give up after 6 times, 3 s }
error g { recover by reversing 1 action give up after 0 times, 3 N, -1 m, 2 s, 3 s }
error h { severity fatal give up after 3 times }
error i { on force limit }
sequence fix { wait 1 s }
sequence main { requires 1 else throw e requires input 1 else throw fix throw g throw h throw f }
cleanup { wait 1 s }
cleanup { wait 1 s }
";
    let expected = [
        r#"E0313 1:34 "collision""#,
        r#"E0313 2:14 "missing""#,
        r#"E0309 2:63 "3 s""#,
        r#"E0210 3:55 "0""#,
        r#"E0201 3:64 "3 N""#,
        r#"E0210 3:69 "-1 m""#,
        r#"E0303 3:80 "3 s""#,
        r#"E0309 4:26 "give up after 3 times""#,
        r#"E0201 7:26 "1""#,
        r#"E0103 7:69 "fix""#,
        r#"W0002 7:81 "throw h""#,
        r#"E0303 9:1 "cleanup""#,
    ];
    assert_eq!(findings(source.trim_start()), expected);
}
