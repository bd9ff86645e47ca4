//! The builder: prefixes are counted, and jumps and joins find each other.

use obverse_bytecode::CodeBuilder;
use obverse_isa::{CounterId, Instr, Label, LocalId, Prefix, op};

const X: LocalId = LocalId(0);
const NONE: Prefix = Prefix(0);

fn store() -> op::StoreLocal {
    op::StoreLocal { prefix: NONE, local: X }
}

#[test]
fn effects_get_the_length_of_their_prefix() {
    let mut code = CodeBuilder::new();
    assert_eq!(code.push(op::Enter {}), 0);
    for (value, before) in [(1, 0), (2, 1)] {
        assert_eq!(code.prefix(), before);
        code.push(op::PushInt { value });
    }
    code.push(op::IntAdd {});
    assert_eq!((code.prefix(), code.here()), (3, 4));
    assert_eq!(code.push(store()), 4);
    assert_eq!(code.prefix(), 0);
    code.push(op::PushInt { value: 3 });
    code.push(store());
    code.push(op::AddLocalImmediate { local: X, value: 1 });
    let code = code.finish();
    let prefixes: Vec<u8> = code.iter().map(Instr::prefix).collect();
    assert_eq!(prefixes, [0, 0, 0, 0, 3, 0, 1, 0]);
    assert_eq!(code[7], Instr::AddLocalImmediate { local: X, value: 1 });
}

#[test]
fn a_prefix_that_is_too_long_is_not_taken_for_a_short_one() {
    let mut code = CodeBuilder::new();
    for value in 0..256 {
        code.push(op::PushInt { value });
    }
    code.push(store());
    assert_eq!(code.finish().last().map(Instr::prefix), Some(255));
}

#[test]
fn a_jump_forward_and_its_join_name_each_other() {
    let mut code = CodeBuilder::new();
    code.push(op::PushBool { value: obverse_isa::Level::High });
    let jump = code.jump(|target| op::JumpIf { prefix: NONE, target });
    assert_eq!(jump.at(), Label(1));
    code.push(op::AddLocalImmediate { local: X, value: 1 });
    assert_eq!(code.join(jump, |from| op::Join { from }), 3);
    let code = code.finish();
    assert_eq!(code[1], Instr::JumpIf { prefix: Prefix(1), target: Label(3) });
    assert_eq!(code[3], Instr::Join { from: Label(1) });
}

#[test]
fn a_jump_back_and_its_join_name_each_other() {
    let mut code = CodeBuilder::new();
    let counter = CounterId(3);
    let top = code.join_ahead(|from| op::ForTop { counter, from });
    code.push(op::AddLocalImmediate { local: X, value: 1 });
    assert_eq!(code.jump_back(top, |target| op::ForNext { counter, target }), 2);
    let code = code.finish();
    assert_eq!(code[0], Instr::ForTop { counter, from: Label(2) });
    assert_eq!(code[2], Instr::ForNext { counter, target: Label(0) });
}

#[test]
fn a_join_keeps_its_prefix_when_its_jump_comes() {
    let mut code = CodeBuilder::new();
    code.push(op::PushBool { value: obverse_isa::Level::Low });
    let join = code.join_ahead(|from| op::JoinAssert { prefix: NONE, from });
    code.jump_back(join, |target| op::Jump { target });
    assert_eq!(code.finish()[1], Instr::JoinAssert { prefix: Prefix(1), from: Label(2) });
}

#[test]
fn crossing_jumps_find_their_own_joins() {
    let mut code = CodeBuilder::new();
    let first = code.jump(|target| op::Jump { target });
    let second = code.jump(|target| op::Jump { target });
    code.join(first, |from| op::Land { from });
    code.join(second, |from| op::Land { from });
    let code = code.finish();
    let targets: Vec<_> = code.iter().filter_map(Instr::jump_target).collect();
    let sources: Vec<_> = code.iter().filter_map(Instr::join_from).collect();
    assert_eq!((targets, sources), (vec![Label(2), Label(3)], vec![Label(0), Label(1)]));
}

#[test]
fn only_the_prefix_of_this_statement_can_be_taken_back() {
    let mut code = CodeBuilder::new();
    code.push(op::PushInt { value: 1 });
    code.push(store());
    assert!(code.last_pure().is_empty());
    assert_eq!(code.pop_pure(), None);
    code.push(op::PushLocal { local: X });
    code.push(op::PushInt { value: 2 });
    let pushes = [Instr::PushLocal { local: X }, Instr::PushInt { value: 2 }];
    assert_eq!(code.last_pure(), pushes);
    assert_eq!(code.pop_pure(), Some(pushes[1]));
    assert_eq!(code.pop_pure(), Some(pushes[0]));
    assert_eq!(code.pop_pure(), None);
    code.push(op::IntMulLocalImmediate { local: X, value: 2 });
    code.push(store());
    assert_eq!(code.finish().last().map(Instr::prefix), Some(1));
}
