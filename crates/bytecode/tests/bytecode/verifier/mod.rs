//! The verifier: for each rule of its charter, modules that break that rule alone, each refused for
//! it where it is broken; and modules at the edge of what is allowed, accepted.

mod code;
mod flow;
mod tables;

use obverse_bytecode::verify::{MAX_ERRORS, Rule};
use obverse_bytecode::{Module, VerifyError, assemble, verify};

/// Tables with one of each, and functions to call. What is tested comes before it, as the start.
const TABLES: &str = r#"
.function helper action
    .parameter p int
    .parameter q real
    enter
    return
.function plain action
    enter
    return
.const real 0.5
.joints home 0 0 0 0 0 0
.keyframe grasp
.item peg
    .at grasp 0 0 0 0 0 0
.tool gripper
.error jam recoverable
    .recover reversing escalating checkpoint begun perturbed spiral 0.001
.checkpoint begun
.reason "wet"
.global g int
.global h real
"#;

const FRAME: &str = "
.local n int
.local m int
.local r real
.local b bool
.local j joints
.counters 2
.slot here
";

fn module(text: &str) -> Module {
    assemble(text).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"))
}

/// A module whose start function does this, from instruction 1.
fn start(body: &str) -> Module {
    module(&format!("obvasm 1\n.function main start{FRAME}enter\n{body}\nhalt\n{TABLES}"))
}

#[track_caller]
fn accepted(module: Module) {
    if let Err(errors) = verify(module) {
        panic!("{errors:?}");
    }
}

/// Each error is of this rule, and the first is at this instruction and says this.
#[track_caller]
fn refused(module: Module, rule: Rule, pc: Option<u32>, why: &str) {
    let errors = verify(module).expect_err(why);
    assert!(errors.iter().all(|error| error.rule == rule), "{errors:?}");
    assert_eq!(errors[0].pc, pc, "{errors:?}");
    assert!(errors[0].why.contains(why), "{errors:?}");
}

/// As [`refused`], of a start function that does this.
#[track_caller]
fn refuses(body: &str, rule: Rule, pc: u32, why: &str) {
    refused(start(body), rule, Some(pc), why);
}

/// As [`refused`], of a module that is sound but for what `change` does to it.
#[track_caller]
fn refuses_changed(rule: Rule, why: &str, change: impl FnOnce(&mut Module)) {
    let mut module = start("");
    change(&mut module);
    refused(module, rule, None, why);
}

#[test]
fn sound_modules_are_accepted() {
    accepted(start(""));
    accepted(start(
        "push.int 3\n store.local n\n push.local n\n push.local n\n int.add\n store.global g",
    ));
    accepted(start("push.int 1\n push.const 0.5\n call helper\n call plain"));
    accepted(start("push.joints home\n store.local j\n push.local j\n move.joint"));
    accepted(start(
        "push.item peg\n move.item grasp, linear\n remember here\n move.slot here, joint",
    ));
    accepted(start("push.speed slow\n setting.set speed\n push.tool gripper\n setting.set tool"));
    accepted(start("push.raised jam\n require \"wet\"\n error.raise jam\n error.clear jam"));
    accepted(start(
        "sense.input b, 3\n sense.force r\n draw r\n push.const 0.5\n wait.input b, 3, low",
    ));
    accepted(start("barrier \"wet\"\n checkpoint begun\n irreversible \"wet\""));
}

#[test]
fn sound_flow_is_accepted() {
    // A branch with a recorded join, one with an asserted join, a loop that is left by a jump.
    accepted(start(
        "push.local b\n i: jump.unless e\n add.local.imm n, 1\n d: jump o\n e: land\n o: join d",
    ));
    accepted(start("i: jump.unless.local.lt.imm n, 3, o\n push.local b\n o: join.assert"));
    accepted(start(
        "t: join b\n push.local b\n x: jump.unless o\n add.local.imm n, 1\n b: jump t\n o: land x",
    ));
    accepted(start(LOOP));
    accepted(start(&LOOP.replace("add.local.imm n, 1", LOOP_1)));
    accepted(start(&format!(
        "{LOOP}{}",
        LOOP.replace(':', "2:").replace(", t", ", t2").replace(", d", ", d2")
    )));
    accepted(start(
        &LOOP
            .replace("add.local.imm n, 1", "push.local b\n jump.if out\n")
            .replace("d: for.exit 0", "d: for.exit 0\n jump over\n out: land\n over: join"),
    ));
    accepted(start(
        "a: block.begin\n add.local.imm n, 1\n b: block.begin\n block.skip b\n \
         block.replace plain, a",
    ));
    accepted(start(&format!("a: block.begin\n {LOOP}\n block.skip a")));
    accepted(start(&LOOP.replace(
        "add.local.imm n, 1",
        "a: block.begin\n push.local b\n jump.if x\n x: join\n block.skip a",
    )));
}

/// A counted loop, from instruction 1 to 6: `for.enter` is 3, `for.top` 4, `for.next` 6.
const LOOP: &str = "
push.int 1
push.int 3
for.enter 0, d
t: for.top 0
add.local.imm n, 1
for.next 0, t
d: for.exit 0
";

/// Another one, with the other counter.
const LOOP_1: &str = "
push.int 1
push.int 3
for.enter 1, dd
tt: for.top 1
add.local.imm m, 1
for.next 1, tt
dd: for.exit 1
";

/// Refused for this among others, which break of necessity with it.
#[track_caller]
fn refused_among(body: &str, rule: Rule, pc: u32, why: &str) {
    let errors = verify(start(body)).expect_err(why);
    let is_meant =
        |error: &VerifyError| error.rule == rule && error.pc == Some(pc) && error.why.contains(why);
    assert!(errors.iter().any(is_meant), "{errors:?}");
}

#[test]
fn a_refusal_says_where() {
    let errors = verify(start("push.int 1\n store.local r")).unwrap_err();
    let expected = "instruction 2: store.local takes real, and there is int";
    assert_eq!(errors[0].to_string(), expected);
    let errors = verify(Module::default()).unwrap_err();
    assert_eq!(errors[0].to_string(), "there is code that belongs to no function");
}

#[test]
fn refusals_are_bounded() {
    let mut module = start("");
    module.joints = vec![("j".repeat(100_000), [f64::NAN; 6]); 1000];
    let errors = verify(module).unwrap_err();
    assert_eq!(errors.len(), MAX_ERRORS);
    assert!(errors.iter().all(|error| error.why.len() < 1000));
}

#[test]
fn a_verified_module_is_the_one_that_was_given() {
    let module = start(LOOP);
    assert_eq!(verify(module.clone()).unwrap().module(), &module);
}

#[test]
fn whatever_the_module_the_verifier_returns() {
    arbtest::arbtest(|u| {
        let _ = verify(crate::support::arbitrary_module(u)?);
        Ok(())
    });
}

/// Sound code with one instruction changed: the verifier gets as far as it can, and returns.
#[test]
fn whatever_is_changed_the_verifier_returns() {
    let block = "a: block.begin\n push.local b\n jump.if x\n x: join\n block.skip a";
    let sound = start(&format!("{block}\n{}", LOOP.replace("add.local.imm n, 1", LOOP_1)));
    accepted(sound.clone());
    let mut refused = 0;
    for at in 0..sound.code.len() {
        for instr in crate::support::every_instruction().into_iter().chain(sound.code.clone()) {
            let mut module = sound.clone();
            module.code[at] = instr;
            refused += u32::from(verify(module).is_err());
        }
    }
    assert!(refused > 0);
}
