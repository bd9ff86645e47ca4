//! Assembly text: whatever is written reads back as the same module, and reads well.

use crate::support::{arbitrary_module, every_instruction, everything};
use obverse_bytecode::text::{disassemble_function, instruction};
use obverse_bytecode::{
    Constant, FunctionKind, Module, SourceEntry, assemble, disassemble, encode, verify,
};
use obverse_isa::{Instr, Label, OPS, Prefix};

/// Written and read back, it is the same module, to the byte.
fn round_trip(module: &Module) {
    let text = disassemble(module);
    let back = assemble(&text).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"));
    // Bytes tell what `==` does not: signs of nought, and reals that are no number.
    assert!(encode(&back) == encode(module), "{back:#?}\nis not\n{module:#?}\nfrom\n{text}");
}

fn assembled(text: &str) -> Module {
    assemble(text).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"))
}

/// What brief text is for: a loop in the start function.
const LOOP: &str = r#"
obvasm 1
.joints "home" 0 0 0 0 0 0
.function "start" start
.local "x" int
.counters 1
    enter
    push.int 3
    store.local x
    push.int 0
    push.int 4
enter: for.enter 0, done
top:
    for.top 0, next     ; its jump is the one below
    add.local.imm x, 1
next:
    for.next 0, top
done:
    for.exit 0, enter
    push.joints home
    move.joint
    halt
"#;

#[test]
fn a_module_with_everything_round_trips() {
    round_trip(&everything());
}

#[test]
fn every_opcode_is_in_what_round_trips() {
    let code = every_instruction();
    for row in OPS {
        assert!(code.iter().any(|instr| instr.opcode() == row.opcode), "{}", row.mnemonic);
    }
}

#[test]
fn the_empty_module_round_trips() {
    round_trip(&Module::default());
    assert_eq!(disassemble(&Module::default()), "obvasm 1\n");
}

#[test]
fn arbitrary_modules_round_trip() {
    arbtest::arbtest(|u| {
        round_trip(&arbitrary_module(u)?);
        Ok(())
    });
}

#[test]
fn functions_that_do_not_cover_the_code_round_trip() {
    let everything = everything();
    let end = everything.code.len() as u32;
    for (first, last) in [(1, end), (0, end - 1), (5, 3), (0, end + 1), (u32::MAX, u32::MAX)] {
        let mut module = everything.clone();
        module.functions.truncate(1);
        (module.functions[0].first, module.functions[0].end) = (first, last);
        round_trip(&module);
    }
    // Functions that overlap, and functions in the wrong order.
    let mut module = everything.clone();
    module.functions[1].first = 3;
    round_trip(&module);
    module.functions.swap(0, 2);
    round_trip(&module);
    // More parameters than locals, and more locals than any frame has.
    let mut module = everything;
    module.functions[0].parameters = 255;
    let locals = module.functions[0].locals.clone();
    module.functions[2].locals = locals.iter().cycle().take(1000).cloned().collect();
    round_trip(&module);
}

#[test]
fn prefixes_that_are_wrong_round_trip() {
    let mut module = assembled(LOOP);
    for at in 0..module.code.len() {
        for prefix in [0, 1, 2, 255] {
            if let Instr::StoreLocal { prefix: old, .. } | Instr::ForEnter { prefix: old, .. } =
                &mut module.code[at]
            {
                *old = Prefix(prefix);
                round_trip(&module);
            }
        }
    }
}

#[test]
fn source_maps_out_of_order_round_trip() {
    let mut module = everything();
    module.source_map.reverse();
    round_trip(&module);
    assert!(disassemble(&module).contains("\n.map 1 0 17 17 move\n"));
    module.source_map = vec![SourceEntry { first: u32::MAX, ..module.source_map[0] }];
    round_trip(&module);
}

#[test]
fn source_text_round_trips_whatever_it_holds() {
    let mut module = everything();
    for text in ["", "\n", "a", "a\n", "\"a\"", " a ", "\r\n\r", "|\n| x\n;", "\0\u{85}\u{2028}"] {
        module.sources[0].text = text.to_owned();
        round_trip(&module);
    }
}

#[test]
fn a_text_says_the_module_that_one_would_build() {
    let module = assembled(LOOP);
    let label = Label;
    let counter = obverse_isa::CounterId(0);
    let local = obverse_isa::LocalId(0);
    let expected = [
        Instr::Enter {},
        Instr::PushInt { value: 3 },
        Instr::StoreLocal { prefix: Prefix(1), local },
        Instr::PushInt { value: 0 },
        Instr::PushInt { value: 4 },
        Instr::ForEnter { prefix: Prefix(2), counter, exit: label(9) },
        Instr::ForTop { counter, from: label(8) },
        Instr::AddLocalImmediate { local, value: 1 },
        Instr::ForNext { counter, target: label(6) },
        Instr::ForExit { counter, from: label(5) },
        Instr::PushJoints { joints: obverse_isa::JointsId(0) },
        Instr::MoveJoint { prefix: Prefix(1) },
        Instr::Halt {},
    ];
    assert_eq!(module.code, expected);
    let start = &module.functions[0];
    assert_eq!((start.kind, start.first, start.end), (FunctionKind::Start, 0, 13));
    assert!(verify(module).is_ok());
}

#[test]
fn joins_find_the_one_jump_that_names_them() {
    let named = assembled(LOOP);
    let unnamed =
        LOOP.replace("for.top 0, next", "for.top 0").replace("for.exit 0, enter", "for.exit 0");
    assert_eq!(assembled(&unnamed), named);
}

#[test]
fn constants_and_reasons_are_added_once() {
    let text = "obvasm 1
        .const real 0.5
        .reason \"wet\"
        .function main start
            push.const 7
            push.const 0.5
            push.const 7
            push.const 7.0
            barrier \"dry\"
            barrier \"wet\"
            barrier \"dry\"";
    let module = assembled(text);
    let (half, seven) = (Constant::Real(0.5), Constant::Int(7));
    assert_eq!(module.constants, [half, seven, Constant::Real(7.0)]);
    assert_eq!(module.reasons, ["wet", "dry"]);
    let numbers = |code: &[Instr]| {
        let mut numbers = Vec::new();
        code.iter().for_each(|instr| instr.each_operand(&mut |_, _, number| numbers.push(number)));
        numbers
    };
    assert_eq!(numbers(&module.code), [1, 0, 1, 2, 1, 0, 1]);
}

#[test]
fn the_forms_of_an_operand_are_one() {
    let line = |operand: &str| {
        format!("obvasm 1\n.joints home 0 0 0 0 0 0\n.function f start\npush.joints {operand}\n")
    };
    let expected = assembled(&line("home"));
    for operand in ["\"home\"", "#0", "home#0", " home ; comment"] {
        assert_eq!(assembled(&line(operand)), expected, "{operand}");
    }
}

#[test]
fn tables_may_stand_anywhere_and_labels_belong_to_their_function() {
    let text = "\u{feff}; a comment\r\n\r\nobvasm 1 ; and another\r
        .function a start\r
        here: there: jump here
        call b
        .function b action
        here:
            jump here
            push.global x
        .global x int
        .const int 1";
    let module = assembled(text);
    let jumps: Vec<_> = module.code.iter().filter_map(Instr::jump_target).collect();
    assert_eq!(jumps, [Label(0), Label(2)]);
    assert_eq!(module.functions[1].first, 2);
}

#[test]
fn errors_have_defaults() {
    let text = "obvasm 1\n.error e warning\n.error f fatal\n.then program\n.respond after_action";
    let module = assembled(text);
    let written = disassemble(&module);
    let expected = "\
obvasm 1
.error \"e\" warning
    .recover none
    .otherwise stop
    .respond at_once
    .then stop
.error \"f\" fatal
    .recover none
    .otherwise stop
    .respond after_action
    .then program
";
    assert_eq!(written, expected);
}

/// A program with its source, as the compiler makes it.
const PICK: &str = r#"obvasm 1
.joints "start" 0.0 0.0 0.0 0.0 0.0 0.5
.tool "gripper"
.reason "the glue is wet"

.function "main" start
    .local "x" int
    .local "x" int
    .slot "initial"
    enter                                     ; always
  @ 0 0 13 move                               ; 1 | move to start
        push.joints start
    move.joint                                ; after-forward(joints)
  @ 0 14 20                                   ; 2 | if x#1
        push.local x#1
        push.const #9
        int.lt
    jump.unless L7                            ; always
L7:
    join #4000000000                          ; after-forward(bit)
    barrier "the glue is wet"                 ; never: the glue is wet
        push.bool true
    .prefix 9
    require #1                                ; always
    move.slot initial, linear                 ; after-forward(joints)
    halt                                      ; always

.function "grip" io
    .parameter "seconds" real
    enter                                     ; always
    return                                    ; after-forward(frame)

.source "pick.obv"
| move to start
| if x#1
"#;

#[test]
fn a_disassembly_shows_names_classes_and_source() {
    assert_eq!(disassemble(&assembled(PICK)), PICK);
}

#[test]
fn one_function_and_one_instruction_can_be_shown() {
    let module = assembled(PICK);
    let function = disassemble_function(&module, 0).unwrap();
    assert!(PICK.contains(&format!("\n\n{function}\n")), "{function}");
    let grip = disassemble_function(&module, 1).unwrap();
    assert!(PICK.contains(&format!("\n\n{grip}\n")), "{grip}");
    assert_eq!(disassemble_function(&module, 2), None);
    assert_eq!(instruction(&module, 1).as_deref(), Some("push.joints start"));
    assert_eq!(instruction(&module, 6).as_deref(), Some("jump.unless L7"));
    assert_eq!(instruction(&module, 8).as_deref(), Some("barrier \"the glue is wet\""));
    assert_eq!(instruction(&module, 13).as_deref(), Some("enter"));
    assert_eq!(instruction(&module, 15), None);
}

#[test]
fn each_instruction_is_shown_as_in_the_whole() {
    let module = everything();
    let whole = disassemble(&module);
    for pc in 0..module.code.len() as u32 {
        let line = instruction(&module, pc).unwrap();
        let is_there = whole.lines().any(|whole| {
            whole.trim() == line || whole.trim_start().starts_with(&format!("{line} "))
        });
        assert!(is_there, "{line}");
    }
}

#[test]
fn nothing_in_a_module_can_move_a_cursor() {
    let hostile = "\u{1b}[2J\u{202e}\r\u{7}\u{9b}";
    let mut module = assembled(PICK);
    module.functions[0].name = hostile.to_owned();
    module.joints[0].0 = hostile.to_owned();
    module.reasons[0] = hostile.to_owned();
    module.sources[0].text = format!("{hostile}\n{hostile}");
    module.source_map[0].end = 1;
    let text = disassemble(&module);
    assert!(text.chars().all(|c| c == '\n' || !hostile.contains(c) || c.is_ascii_graphic()));
    round_trip(&module);
}

#[test]
fn a_long_name_is_not_repeated() {
    let mut module = assembled(PICK);
    module.joints[0].0 = "j".repeat(100_000);
    module.reasons[0] = "r".repeat(100_000);
    module.code = [module.code[1], module.code[8]].repeat(1000);
    module.functions.clear();
    module.source_map.clear();
    assert!(disassemble(&module).len() < 500_000);
    round_trip(&module);
}

#[test]
fn whatever_the_text_the_assembler_returns() {
    arbtest::arbtest(|u| {
        let text: String = u.arbitrary()?;
        assert!(assemble(&text).is_err() || text.contains("obvasm"));
        let _ = assemble(&format!("obvasm 1\n{text}"));
        Ok(())
    });
}

/// A text with a few characters changed is refused, or says a module that round-trips.
#[test]
fn damaged_text_is_refused_or_says_a_module() {
    let text = disassemble(&everything());
    let pieces = ["\"", "#", ",", ";", ":", "\n", " ", ".", "0x", "-", "9", "@", "|", "halt", "é"];
    arbtest::arbtest(|u| {
        let mut damaged = text.clone();
        for _ in 0..u.int_in_range(1..=4)? {
            let boundaries: Vec<usize> = damaged.char_indices().map(|(at, _)| at).collect();
            let at = u.choose_index(boundaries.len())?;
            let end = (at + u.int_in_range(0..=8)?).min(boundaries.len() - 1);
            let (at, end) = (boundaries[at], boundaries[end]);
            damaged.replace_range(at..end, u.choose(&pieces)?);
        }
        if let Ok(module) = assemble(&damaged) {
            round_trip(&module);
        }
        Ok(())
    });
}

#[test]
fn a_text_cut_off_anywhere_is_refused_or_says_a_module() {
    let whole = disassemble(&everything());
    let ends = (0..PICK.len()).map(|end| &PICK[..end]);
    let ends = ends.chain((0..whole.len()).step_by(100).filter_map(|end| whole.get(..end)));
    for cut in ends {
        if let Ok(module) = assemble(cut) {
            round_trip(&module);
        }
    }
}
