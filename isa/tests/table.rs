//! The laws of the table: what every row keeps, so that what derives from the rows can rely on it.

use obverse_isa::{
    Axis, Class, Family, Frame, Instr, Level, OPS, OpInfo, Opcode, Operand, OperandError,
    OperandKind, Path, RecordKind, Setting, SpeedId, StackItem, Type, reference,
};
use std::collections::BTreeSet;
use std::fmt::Debug;

/// An instruction of a row, with operands of 0.
fn instr(row: &OpInfo) -> Instr {
    let made: Result<_, OperandError> = Instr::from_operands(row.opcode, &mut |_, _| Ok(0));
    made.unwrap_or_else(|error| panic!("{}: {error:?}", row.mnemonic))
}

fn has(row: &OpInfo, kind: OperandKind) -> bool {
    row.operands.iter().any(|(_, found)| *found == kind)
}

#[test]
fn codes_ascend_and_are_not_zero() {
    assert!(OPS.iter().all(|row| row.code > 0));
    assert!(OPS.is_sorted_by(|a, b| a.code < b.code));
}

#[test]
fn a_code_and_its_opcode_are_inverse() {
    for code in 0..=u8::MAX {
        let row = OPS.iter().find(|row| row.code == code);
        assert_eq!(Opcode::from_code(code), row.map(|row| row.opcode));
        assert!(row.is_none_or(|row| row.opcode as u8 == code));
    }
}

#[test]
fn a_mnemonic_and_its_opcode_are_inverse() {
    for row in OPS {
        assert_eq!(Opcode::from_mnemonic(row.mnemonic), Some(row.opcode), "{}", row.mnemonic);
        assert_eq!(row.opcode.info().mnemonic, row.mnemonic);
        assert_eq!(format!("{:?}", row.opcode), row.ident);
        assert_eq!(instr(row).opcode(), row.opcode);
        assert_eq!(instr(row).info().code, row.code);
    }
    for unknown in ["", "push", "Push.int", "push.int ", "PushInt"] {
        assert_eq!(Opcode::from_mnemonic(unknown), None, "{unknown}");
    }
}

#[test]
fn mnemonics_are_words_and_none_is_there_twice() {
    let mnemonics: BTreeSet<_> = OPS.iter().map(|row| row.mnemonic).collect();
    assert_eq!(mnemonics.len(), OPS.len());
    for mnemonic in mnemonics {
        let is_word = |part: &str| {
            part.starts_with(|c: char| c.is_ascii_lowercase())
                && part.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_')
        };
        assert!(mnemonic.split('.').all(is_word), "{mnemonic}");
    }
}

#[test]
fn every_row_is_documented() {
    for row in OPS {
        let prose = reference::prose(row);
        assert!(prose.starts_with(|c: char| c.is_ascii_uppercase()), "{prose}");
        assert!(prose.ends_with('.'), "{prose}");
        assert!(row.doc[0].len() > 2, "{}", row.mnemonic);
    }
}

#[test]
fn an_instruction_is_as_wide_as_its_operands_allow() {
    for row in OPS {
        let mut widths = 0;
        let mut kinds = Vec::new();
        instr(row).each_operand(&mut |kind, width, value| {
            assert_eq!(value, 0);
            widths += width;
            kinds.push(kind);
        });
        assert!(widths < 8, "{} has no room for its code", row.mnemonic);
        assert!(kinds.iter().eq(row.operands.iter().map(|(_, kind)| kind)), "{}", row.mnemonic);
    }
}

#[test]
fn pure_instructions_make_operands_and_need_no_record() {
    for row in OPS.iter().filter(|row| row.family.is_pure()) {
        assert_eq!(row.class, Class::Always, "{}", row.mnemonic);
        assert!(!has(row, OperandKind::Prefix), "{}", row.mnemonic);
        assert_eq!(row.pushes.len(), 1, "{}", row.mnemonic);
    }
}

/// So that the operand stack is empty between statements.
#[test]
fn effects_take_operands_and_make_none() {
    for row in OPS.iter().filter(|row| !row.family.is_pure()) {
        assert!(row.pushes.is_empty(), "{}", row.mnemonic);
        assert_eq!(has(row, OperandKind::Prefix), !row.pops.is_empty(), "{}", row.mnemonic);
        let rest = row.operands.iter().skip(1);
        assert!(rest.clone().all(|(_, kind)| *kind != OperandKind::Prefix), "{}", row.mnemonic);
    }
}

#[test]
fn the_prefix_is_read_where_there_is_one() {
    for row in OPS {
        let made: Result<_, OperandError> = Instr::from_operands(row.opcode, &mut |kind, _| {
            Ok(if kind == OperandKind::Prefix { 7 } else { 0 })
        });
        let expected = if has(row, OperandKind::Prefix) { 7 } else { 0 };
        assert_eq!(made.map(|instr| instr.prefix()), Ok(expected), "{}", row.mnemonic);
    }
}

#[test]
fn a_stack_picture_refers_to_an_operand() {
    for row in OPS {
        for item in row.pops.iter().chain(row.pushes) {
            let needed = match item {
                StackItem::Of(_) => continue,
                StackItem::Local => OperandKind::Local,
                StackItem::Global => OperandKind::Global,
                StackItem::Constant => OperandKind::Constant,
                StackItem::Setting => OperandKind::Setting,
                StackItem::Parameters => OperandKind::Function,
            };
            assert!(has(row, needed), "{}: {item}", row.mnemonic);
        }
    }
}

/// Which instructions name which others.
#[test]
fn jumps_joins_and_ends_of_blocks_name_an_instruction() {
    for row in OPS {
        let instr = instr(row);
        let (jumps, joins) = (instr.jump_target().is_some(), instr.join_from().is_some());
        assert!(!(jumps && joins), "{}", row.mnemonic);
        let ends_block = has(row, OperandKind::Label) && row.family == Family::Reversal;
        // Where its fork comes together, which names the fork.
        let leaves = row.mnemonic == "fork.leave";
        let names_one = jumps || joins || ends_block || leaves;
        assert_eq!(names_one, has(row, OperandKind::Label), "{}", row.mnemonic);
        let labels = row.operands.iter().filter(|(_, kind)| *kind == OperandKind::Label);
        assert!(labels.count() <= 1, "{}", row.mnemonic);
        // The assembler lets a join leave out this operand.
        let last = row.operands.last().map(|(name, _)| *name);
        let is_join = last == Some("from") && matches!(row.family, Family::Flow | Family::Task);
        assert_eq!(joins, is_join, "{}", row.mnemonic);
    }
}

#[test]
fn a_label_is_read_where_there_is_one() {
    for row in OPS {
        let made: Result<_, OperandError> = Instr::from_operands(row.opcode, &mut |kind, _| {
            Ok(if kind == OperandKind::Label { 9 } else { 0 })
        });
        let made = made.unwrap_or_else(|error| panic!("{error:?}"));
        let label = made.jump_target().or(made.join_from()).map(|label| label.0);
        assert!(label.is_none_or(|label| label == 9), "{}", row.mnemonic);
    }
}

#[test]
fn what_never_falls_through_ends_a_stretch_of_code() {
    let ends = OPS.iter().filter(|row| instr(row).never_falls_through());
    let ends: Vec<_> = ends.map(|row| row.mnemonic).collect();
    assert_eq!(ends, ["jump", "return", "halt", "fork.leave"]);
}

#[test]
fn classes_are_as_the_families_demand() {
    for row in OPS {
        let saves = |kinds: &[RecordKind]| match row.class {
            Class::AfterForward(kind) => kinds.contains(&kind),
            Class::Always | Class::Never(_) => true,
        };
        let is_right = match row.family {
            Family::Value | Family::Reversal => saves(&[]),
            Family::Variable | Family::Setting | Family::Error => saves(&[RecordKind::Word]),
            Family::Flow => saves(&[RecordKind::Bit, RecordKind::Counter]),
            Family::Frame => saves(&[RecordKind::Frame]),
            Family::Kinematic => saves(&[RecordKind::Joints]),
            Family::Sense => saves(&[RecordKind::Word, RecordKind::Joints]),
            Family::Io => saves(&[RecordKind::Bit]),
            Family::Task => saves(&[RecordKind::Switch, RecordKind::Tasks]),
        };
        assert!(is_right, "{}: {}", row.mnemonic, row.class);
        if let Class::Never(why) = row.class {
            assert!(!why.is_empty() && row.family == Family::Reversal, "{}", row.mnemonic);
        }
    }
}

/// What reads the outside or commands the workcell is never pure.
#[test]
fn families_say_what_is_touched() {
    for family in Family::ALL {
        assert_eq!(family.is_pure(), family == Family::Value);
        assert!(!(family.is_pure() && family.commands_workcell()));
        assert!(OPS.iter().any(|row| row.family == family), "{}", family.name());
    }
    let commands = OPS.iter().filter(|row| row.family.commands_workcell());
    assert!(commands.clone().any(|row| row.mnemonic == "move.joint"));
    assert!(commands.clone().any(|row| row.mnemonic == "output.set"));
    assert!(commands.clone().all(|row| row.mnemonic != "sense.force"));
}

#[test]
fn families_stand_in_order() {
    let order = |row: &OpInfo| Family::ALL.iter().position(|family| *family == row.family);
    assert!(OPS.is_sorted_by_key(order));
}

fn choices_are_words<T: Operand + PartialEq + Debug>(all: &[T], name: fn(T) -> &'static str) {
    let names: BTreeSet<_> = all.iter().map(|choice| name(*choice)).collect();
    assert_eq!(names.len(), all.len());
    for (number, choice) in (0..).zip(all) {
        assert_eq!(choice.to_number(), number);
        assert_eq!(T::from_number(number), Ok(*choice));
    }
    for value in [-1, all.len() as i64, 255, 256, i64::MAX] {
        assert_eq!(T::from_number(value), Err(OperandError { kind: T::KIND, value }));
    }
}

#[test]
fn choices_number_from_zero() {
    choices_are_words(Level::ALL, Level::name);
    choices_are_words(SpeedId::ALL, SpeedId::name);
    choices_are_words(Setting::ALL, Setting::name);
    choices_are_words(Axis::ALL, Axis::name);
    choices_are_words(Frame::ALL, Frame::name);
    choices_are_words(Path::ALL, Path::name);
    assert!(Level::High.is_high() && !Level::Low.is_high());
}

#[test]
fn types_are_listed_in_the_order_of_their_codes() {
    for (code, of) in Type::ALL.iter().enumerate() {
        assert_eq!(*of as usize, code);
        assert_eq!(of.to_string(), of.name());
    }
}

#[test]
fn the_page_has_every_row_once() {
    let page = reference::page();
    for row in OPS {
        let begin = format!("| 0x{:02x} | `{}` | ", row.code, row.mnemonic);
        let lines: Vec<_> = page.lines().filter(|line| line.starts_with(&begin)).collect();
        assert_eq!(lines.len(), 1, "{begin}");
        assert!(lines[0].ends_with(&format!(" | {} | {} |", row.class, reference::prose(row))));
    }
    // A bar in a cell would end it.
    let columns = |line: &&str| line.matches('|').count() == 7;
    assert!(page.lines().filter(|line| line.starts_with('|')).all(|line| columns(&line)));
}

#[test]
fn an_instruction_is_explained_by_what_its_row_says() {
    let expected = "\
output.set (0xa0, io)

Set an output and let it settle for so many seconds. In reverse, its former level, and the same \
time to settle.

operands  bit, level
stack     real --
class     after-forward
          reversed from what it recorded: bit
";
    assert_eq!(reference::explain(Opcode::OutputSet.info()), expected);
    let barrier = reference::explain(Opcode::Barrier.info());
    assert!(barrier.ends_with("          never reversed: the program has a barrier here\n"));
    let add = reference::explain(Opcode::IntAdd.info());
    assert!(add.contains("\nstack     int int -- int\n") && !add.contains("operands"));
    assert!(add.ends_with("reversed in any state, without a record\n"));
}
