//! What the benchmarks share: the programs they run.

use obverse_bytecode::{CodeBuilder, Function, FunctionKind, Module, Variable, Verified, verify};
use obverse_isa::{CounterId, Instr, Label, LocalId, Prefix, Type, op};

fn module(code: Vec<Instr>, locals: usize, counters: u8) -> Verified {
    let end = code.len() as u32;
    let start = Function {
        name: "start".to_owned(),
        kind: FunctionKind::Start,
        parameters: 0,
        locals: (0..locals)
            .map(|index| Variable { name: format!("l{index}"), of_type: Type::Int })
            .collect(),
        counters,
        slots: Vec::new(),
        first: 0,
        end,
    };
    let module = Module { functions: vec![start], code, ..Module::default() };
    match verify(module) {
        Ok(verified) => verified,
        Err(errors) => panic!("{errors:?}"),
    }
}

/// `for i from 1 to n { if i mod 2 == 0 { sum += i } else { sum -= 1 } }`, with a recorded join.
#[must_use]
pub fn branches(n: i32) -> Verified {
    let (sum, counter) = (LocalId(0), CounterId(0));
    let prefix = Prefix(0);
    let mut code = CodeBuilder::new();
    code.push(op::Enter {});
    code.push(op::PushInt { value: 1 });
    code.push(op::PushInt { value: n });
    let enter = code.jump(|exit| op::ForEnter { prefix, counter, exit });
    let top = code.join_ahead(|from| op::ForTop { counter, from });
    code.push(op::IntRemCounterImmediate { counter, value: 2 });
    let odd = code.jump(|target| op::JumpUnlessEqImmediate { prefix, value: 0, target });
    code.push(op::AddLocalCounter { local: sum, counter });
    let done = code.jump(|target| op::Jump { target });
    code.join(odd, |from| op::Land { from });
    code.push(op::AddLocalImmediate { local: sum, value: -1 });
    code.join(done, |from| op::Join { from });
    code.jump_back(top, |target: Label| op::ForNext { counter, target });
    code.join(enter, |from| op::ForExit { counter, from });
    code.push(op::Halt {});
    module(code.finish(), 1, 1)
}

/// `while i < n { i += 1; a = a * 3 + i; if a > b { b += a } else { b = b - i * 2 } }`: stores that
/// save what they overwrite.
#[must_use]
pub fn stores(n: i16) -> Verified {
    let (i, a, b, outer) = (LocalId(0), LocalId(1), LocalId(2), CounterId(0));
    let prefix = Prefix(0);
    let mut code = CodeBuilder::new();
    code.push(op::Enter {});
    code.push(op::PushInt { value: 1 });
    code.push(op::PushInt { value: 1000 });
    let enter = code.jump(|exit| op::ForEnter { prefix, counter: outer, exit });
    let round = code.join_ahead(|from| op::ForTop { counter: outer, from });
    code.push(op::PushInt { value: 0 });
    code.push(op::StoreLocal { prefix, local: i });
    let top = code.join_ahead(|from| op::Join { from });
    let exit = code.jump(|target| op::JumpUnlessLocalLtImmediate { local: i, value: n, target });
    code.push(op::AddLocalImmediate { local: i, value: 1 });
    code.push(op::IntMulLocalImmediate { local: a, value: 3 });
    code.push(op::IntAddLocal { local: i });
    code.push(op::StoreLocal { prefix, local: a });
    let less = code.jump(|target| op::JumpUnlessLocalLtLocal { left: b, right: a, target });
    code.push(op::AddLocalLocal { local: b, value: a });
    let done = code.jump(|target| op::Jump { target });
    code.join(less, |from| op::Land { from });
    code.push(op::IntMulLocalImmediate { local: i, value: -2 });
    code.push(op::IntAddLocal { local: b });
    code.push(op::StoreLocal { prefix, local: b });
    code.join(done, |from| op::Join { from });
    code.jump_back(top, |target| op::Jump { target });
    code.join(exit, |from| op::Land { from });
    code.jump_back(round, |target| op::ForNext { counter: outer, target });
    code.join(enter, |from| op::ForExit { counter: outer, from });
    code.push(op::Halt {});
    module(code.finish(), 3, 1)
}
