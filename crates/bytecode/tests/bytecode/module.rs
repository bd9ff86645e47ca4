//! What a module is asked: whose an instruction is, and where in the source it comes from.

use obverse_bytecode::{Constant, Module, SourceEntry, assemble};
use obverse_isa::Type;

/// Two functions, of instructions 0 and 1 and of 2 to 4; code of none from 5.
const TEXT: &str = "obvasm 1
.function main start
    enter
@ 0 0 4 move
    halt
.function other action
    enter
@ 0 7 8
    checkpoint #0
    return
.code
    halt
.source s
| move
| \u{fc}x
";

fn module() -> Module {
    assemble(TEXT).unwrap_or_else(|errors| panic!("{errors:?}"))
}

#[test]
fn an_instruction_is_of_the_function_around_it() {
    let module = module();
    let functions: Vec<_> = (0..7).map(|pc| module.function_at(pc)).collect();
    let (main, other) = (Some(0), Some(1));
    assert_eq!(functions, [main, main, other, other, other, None, None]);
    assert_eq!(Module::default().function_at(0), None);
}

#[test]
fn an_instruction_is_of_the_last_entry_before_it() {
    let module = module();
    let starts: Vec<_> = (0..6).map(|pc| module.source_at(pc).map(|entry| entry.start)).collect();
    assert_eq!(starts, [None, Some(0), Some(0), Some(7), Some(7), Some(7)]);
}

#[test]
fn places_are_lines_and_characters() {
    let mut module = module();
    assert_eq!(module.place_of(0), None);
    assert_eq!(module.place_of(1), Some(("s", 1, 1)));
    assert_eq!(module.place_of(3), Some(("s", 2, 2)));
    // Whatever ends the lines: the place is the second character of the last of them.
    for (text, start) in [("move\rx\u{fc}", 6), ("move\r\nx\u{fc}", 7), ("\n\rmove", 3)] {
        module.sources[0].text = text.to_owned();
        module.source_map[1].start = start;
        let line = if text.starts_with('\n') { 3 } else { 2 };
        assert_eq!(module.place_of(3), Some(("s", line, 2)), "{text:?}");
    }
    let mut module = self::module();
    // In the middle of a character, behind the text, and in no file.
    for (file, start) in [(0, 6), (0, 99), (1, 0)] {
        module.source_map[1] = SourceEntry { file, start, ..module.source_map[1] };
        assert_eq!(module.place_of(3), None);
    }
}

#[test]
fn constants_are_their_bits() {
    let (int, real) = (Constant::Int(0), Constant::Real(0.0));
    assert_ne!(int, real);
    assert_ne!(real, int);
    assert_ne!(int, Constant::Int(1));
    assert_ne!(real, Constant::Real(-0.0));
    assert_eq!(Constant::Real(f64::NAN), Constant::Real(f64::NAN));
    assert_eq!((int.of_type(), real.of_type()), (Type::Int, Type::Real));
    assert_eq!(Constant::Int(-1).bits(), u64::MAX);
    assert_eq!(Constant::Real(1.0).bits(), 1.0f64.to_bits());
}
