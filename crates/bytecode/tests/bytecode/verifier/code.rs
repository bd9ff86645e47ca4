//! Rules 3, 4 and 7: operands, statements, updates.

use super::{accepted, refuses, start};
use obverse_bytecode::verify;
use obverse_bytecode::verify::{MAX_OPERANDS, Rule};
use obverse_isa::{OPS, OperandKind};

/// For each kind of index the first that is not there, or the last that can be written.
const INDICES: [(OperandKind, &str, &str); 17] = [
    (OperandKind::Constant, "push.const #1", "no constant 1"),
    (OperandKind::Local, "push.local #5", "no local 5"),
    (OperandKind::Local, "store.local #5", "no local 5"),
    (OperandKind::Local, "add.local.local n, #5", "no local 5"),
    (OperandKind::Global, "push.global #2", "no global 2"),
    (OperandKind::Counter, "push.counter 2", "no counter 2"),
    (OperandKind::Slot, "remember #1", "no slot 1"),
    (OperandKind::Joints, "push.joints #1", "no joints 1"),
    (OperandKind::Item, "push.item #1", "no item 1"),
    (OperandKind::Keyframe, "move.item #1, joint", "no keyframe 1"),
    (OperandKind::Tool, "push.tool #1", "no tool 1"),
    (OperandKind::Error, "push.raised #1", "no error 1"),
    (OperandKind::Checkpoint, "checkpoint #1", "no checkpoint 1"),
    (OperandKind::Reason, "barrier #1", "no reason 1"),
    (OperandKind::Function, "call #3", "no function 3"),
    (OperandKind::Label, "jump #8", "no label 8"),
    (OperandKind::Label, "block.skip #4294967295", "no label 4294967295"),
];

#[test]
fn rule_3_every_index_is_in_range() {
    // What is there is accepted in other tests.
    for (_, line, why) in INDICES {
        refuses(&format!("add.local.imm n, 1\n{line}"), Rule::Operands, 2, why);
        refuses(&format!("{line}\nadd.local.imm n, 1"), Rule::Operands, 1, why);
    }
}

#[test]
fn rule_3_the_start_is_not_called() {
    let why = "the start is no function to call";
    refuses("add.local.imm n, 1\ncall #0", Rule::Operands, 2, why);
    refuses("a: block.begin\nblock.replace #0, a", Rule::Operands, 2, why);
}

#[test]
fn rule_3_every_kind_of_operand_is_an_index_or_sound_by_itself() {
    let is_sound = |kind: &OperandKind| {
        matches!(
            kind,
            OperandKind::Prefix
                | OperandKind::Integer
                | OperandKind::Bit
                | OperandKind::Level
                | OperandKind::Speed
                | OperandKind::Setting
                | OperandKind::Axis
                | OperandKind::Frame
                | OperandKind::Path
        )
    };
    for (_, kind) in OPS.iter().flat_map(|row| row.operands) {
        let is_tested = INDICES.iter().any(|(tested, _, _)| tested == kind);
        assert!(is_tested != is_sound(kind), "{kind:?}");
    }
}

#[test]
fn rule_3_a_called_function_gets_its_parameters() {
    let takes = |of: &str, found: &str| format!("call takes {of}, and there is {found}");
    refuses("call helper", Rule::Statements, 1, &takes("real", "nothing"));
    refuses("push.const 0.5\n call helper", Rule::Statements, 2, &takes("int", "nothing"));
    refuses(
        "push.const 0.5\n push.int 1\n call helper",
        Rule::Statements,
        3,
        &takes("real", "int"),
    );
    refuses("push.int 1\n call plain", Rule::Statements, 2, "1 operands are left");
}

#[test]
fn rule_4_effects_know_their_prefix() {
    let says = "says that its prefix has";
    refuses("push.int 1\n .prefix 0\n store.local n", Rule::Statements, 2, says);
    refuses("push.int 1\n .prefix 2\n store.local n", Rule::Statements, 2, says);
    refuses(
        "push.int 1\n push.int 2\n int.add\n .prefix 255\n store.local n",
        Rule::Statements,
        4,
        says,
    );
    refuses(
        "push.int 1\n store.local n\n push.bool true\n .prefix 3\n require \"wet\"",
        Rule::Statements,
        4,
        says,
    );
    // The longest that one byte can say, and one more.
    let long =
        |negations: usize| format!("push.int 1\n{}store.local n", "int.neg\n".repeat(negations));
    accepted(start(&long(254)));
    refuses(&long(255), Rule::Statements, 257, says);
}

#[test]
fn rule_4_nothing_is_left_between_statements() {
    let left = "operands are left after the statement";
    refuses("push.int 1\n push.int 2\n store.local n", Rule::Statements, 3, "1 operands are left");
    refuses(
        "push.int 1\n .prefix 1\n move.joint",
        Rule::Statements,
        2,
        "move.joint takes joints, and there is int",
    );
    // An effect without operands, after a prefix.
    let errors = verify(start("push.int 1\n add.local.imm n, 1")).unwrap_err();
    assert!(errors.iter().all(|error| error.rule == Rule::Statements && error.pc == Some(2)));
    assert!(errors[1].why.contains(left), "{errors:?}");
}

#[test]
fn rule_4_types_fit() {
    for (line, pc, why) in [
        ("store.local n", 1, "store.local takes int, and there is nothing"),
        ("int.add", 1, "int.add takes int, and there is nothing"),
        ("push.const 0.5\n store.local n", 2, "store.local takes int, and there is real"),
        ("push.int 1\n store.local r", 2, "store.local takes real, and there is int"),
        ("push.int 1\n store.global h", 2, "store.global takes real, and there is int"),
        ("push.local r\n store.global g", 2, "store.global takes int, and there is real"),
        ("push.global h\n store.local n", 2, "store.local takes int, and there is real"),
        ("push.int 1\n push.local r\n int.add", 3, "int.add takes int, and there is real"),
        ("push.local r\n push.int 1\n real.add", 3, "real.add takes real, and there is int"),
        ("push.counter 0\n wait", 2, "wait takes real, and there is int"),
        ("push.int 1\n int.to_real\n add.local n", 3, "add.local takes int, and there is real"),
        ("push.speed slow\n setting.set tool", 2, "setting.set takes tool, and there is speed"),
        ("push.setting tool\n setting.set speed", 2, "setting.set takes speed, and there is tool"),
        ("push.item peg\n move.joint", 2, "move.joint takes joints, and there is item"),
        (
            "push.joints home\n move.item grasp, joint",
            2,
            "move.item takes item, and there is joints",
        ),
        ("push.int 1\n require \"wet\"", 2, "require takes bool, and there is int"),
        ("push.raised jam\n wait", 2, "wait takes real, and there is bool"),
        (
            "push.int 1\n push.bool true\n for.enter 0, #1",
            3,
            "for.enter takes int, and there is bool",
        ),
    ] {
        refuses(line, Rule::Statements, pc, why);
        // What follows from it is not told as well.
        assert_eq!(verify(start(line)).map_err(|errors| errors.len()).err(), Some(1), "{line}");
    }
}

#[test]
fn rule_4_variables_that_are_read_without_a_push_have_types() {
    for (line, why) in [
        (
            "push.local n\n int.add.local r\n store.local n",
            "int.add.local needs int, and `r` is real",
        ),
        ("push.global g\n int.add.locals n, b", "int.add.locals needs int, and `b` is bool"),
        ("push.global g\n int.mul.local.imm r, 2", "int.mul.local.imm needs int, and `r` is real"),
        ("push.global g\n int.rem.local.imm r, 2", "int.rem.local.imm needs int, and `r` is real"),
        ("push.int 1\n add.local r", "add.local needs int, and `r` is real"),
        ("push.int 1\n sub.local r", "sub.local needs int, and `r` is real"),
        ("push.int 1\n add.global h", "add.global needs int, and `h` is real"),
        ("push.int 1\n sub.global h", "sub.global needs int, and `h` is real"),
        ("checkpoint begun\n add.local.imm b, 1", "add.local.imm needs int, and `b` is bool"),
        ("checkpoint begun\n add.local.local n, r", "add.local.local needs int, and `r` is real"),
        (
            "checkpoint begun\n add.local.counter r, 0",
            "add.local.counter needs int, and `r` is real",
        ),
        ("checkpoint begun\n jump.unless.local.lt.imm b, 1, #1", "needs int, and `b` is bool"),
        ("checkpoint begun\n jump.unless.local.lt.local n, r, #1", "needs int, and `r` is real"),
        ("checkpoint begun\n sense.input n, 0", "sense.input needs bool, and `n` is int"),
        ("checkpoint begun\n sense.holding r", "sense.holding needs bool, and `r` is real"),
        ("checkpoint begun\n sense.force n", "sense.force needs real, and `n` is int"),
        ("checkpoint begun\n sense.distance b", "sense.distance needs real, and `b` is bool"),
        ("checkpoint begun\n sense.peak_force n", "sense.peak_force needs real, and `n` is int"),
        ("checkpoint begun\n draw n", "draw needs real, and `n` is int"),
        ("push.const 0.5\n wait.input r, 0, low", "wait.input needs bool, and `r` is real"),
    ] {
        refuses(line, Rule::Statements, 2, why);
        assert_eq!(verify(start(line)).map_err(|errors| errors.len()).err(), Some(1), "{line}");
    }
}

#[test]
fn rule_4_operands_are_bounded() {
    let deep = |pushes: usize| {
        let (pushes, adds) = ("push.int 1\n".repeat(pushes), "int.add\n".repeat(pushes - 1));
        format!("{pushes}{adds}store.local n")
    };
    accepted(start(&deep(MAX_OPERANDS)));
    let (why, one_more) = ("more than 128 operands at once", deep(MAX_OPERANDS + 1));
    refuses(&one_more, Rule::Statements, 1 + MAX_OPERANDS as u32, why);
    assert_eq!(verify(start(&one_more)).map_err(|errors| errors.len()).err(), Some(1));
}

#[test]
fn rule_7_an_update_does_not_read_what_it_updates() {
    let reads = "the operand of the update reads the variable that it changes";
    for update in ["add", "sub"] {
        refuses(&format!("push.local n\n {update}.local n"), Rule::Updates, 2, reads);
        refuses(&format!("push.global g\n {update}.global g"), Rule::Updates, 2, reads);
        refuses(
            &format!("push.int 1\n int.add.local n\n {update}.local n"),
            Rule::Updates,
            3,
            reads,
        );
        refuses(&format!("int.add.locals m, n\n {update}.local n"), Rule::Updates, 2, reads);
        refuses(&format!("int.mul.local.imm n, 2\n {update}.local n"), Rule::Updates, 2, reads);
        refuses(&format!("int.rem.local.imm n, 2\n {update}.local n"), Rule::Updates, 2, reads);
        // Another variable, the same index in the other table, the statement before: all right.
        accepted(start(&format!("push.local m\n {update}.local n")));
        accepted(start(&format!("push.global g\n {update}.local n")));
        accepted(start(&format!("push.local n\n {update}.global g")));
        accepted(start(&format!("push.counter 0\n {update}.local n")));
        accepted(start(&format!("push.local n\n store.local m\n push.int 1\n {update}.local n")));
        accepted(start(&format!("push.local n\n {update}.local m")));
    }
    let itself = "the update reads the variable that it changes";
    refuses("add.local.local n, n", Rule::Updates, 1, itself);
    refuses("push.int 1\n store.local n\n add.local.local m, m", Rule::Updates, 3, itself);
    accepted(start("add.local.local n, m"));
    accepted(start("push.local n\n store.local n"));
}
