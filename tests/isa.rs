//! Laws of the instruction table, and its reference page, which `UPDATE=1 cargo test --test isa`
//! writes. That an opcode's code fits its class is the compiler's to say: see `obverse_vm::class`.

use obverse_isa::{
    Class, DecodeError, Family, INSTR_BYTES, Instr, OPS, OpInfo, Opcode, OperandError, OperandKind,
    RecordKind, reference,
};
use std::collections::BTreeSet;

fn has_prefix(row: &OpInfo) -> bool {
    row.operands.iter().any(|(_, kind)| *kind == OperandKind::Prefix)
}

/// The instruction of a row whose operands are all this number, if it is one of theirs.
fn with_operands(row: &OpInfo, number: i64) -> Result<Instr, OperandError> {
    Instr::from_operands(row.opcode, &mut |_, _| Ok(number))
}

#[test]
fn codes_ascend_and_names_are_unique() {
    for rows in OPS.windows(2) {
        assert!(rows[0].code < rows[1].code, "{}", rows[1].mnemonic);
    }
    let mnemonics: BTreeSet<_> = OPS.iter().map(|row| row.mnemonic).collect();
    assert_eq!(mnemonics.len(), OPS.len());
    for row in OPS {
        assert_eq!(Opcode::from_code(row.code), Some(row.opcode));
        assert_eq!(Opcode::from_mnemonic(row.mnemonic), Some(row.opcode));
        assert_eq!(row.opcode.info().mnemonic, row.mnemonic);
    }
}

#[test]
fn a_mnemonic_is_words_with_dots_between() {
    for row in OPS {
        let is_word = |word: &str| {
            !word.is_empty() && word.bytes().all(|b| b.is_ascii_lowercase() || b == b'_')
        };
        assert!(row.mnemonic.split('.').all(is_word), "{}", row.mnemonic);
    }
}

#[test]
fn every_row_says_what_it_does_in_sentences() {
    for row in OPS {
        let prose = reference::prose(row);
        assert!(prose.starts_with(char::is_uppercase), "{}: {prose}", row.mnemonic);
        assert!(prose.ends_with('.'), "{}: {prose}", row.mnemonic);
    }
}

#[test]
fn families_stand_together_in_their_order() {
    assert!(OPS.is_sorted_by_key(|row| row.family));
    for family in Family::ALL {
        assert!(OPS.iter().any(|row| row.family == family), "{}", family.name());
    }
}

#[test]
fn what_is_pure_is_always_and_has_no_prefix() {
    for row in OPS.iter().filter(|row| row.family.is_pure()) {
        assert_eq!(row.class, Class::Always, "{}", row.mnemonic);
        assert!(!has_prefix(row), "{}", row.mnemonic);
        assert_eq!(row.pushes.len(), 1, "{}: a value is what it is for", row.mnemonic);
    }
}

#[test]
fn an_effect_pushes_nothing_and_knows_the_prefix_that_made_its_operands() {
    for row in OPS.iter().filter(|row| !row.family.is_pure()) {
        assert!(row.pushes.is_empty(), "{}", row.mnemonic);
        assert_eq!(has_prefix(row), !row.pops.is_empty(), "{}", row.mnemonic);
        let place = row.operands.iter().position(|(_, kind)| *kind == OperandKind::Prefix);
        assert!(place.is_none_or(|place| place == 0), "{}", row.mnemonic);
    }
}

#[test]
fn a_class_fits_its_family() {
    use RecordKind::{Bit, Counter, Frame, Joints, Switch, Tasks, Word};
    for row in OPS {
        let records: &[RecordKind] = match row.family {
            Family::Value | Family::Reversal => &[],
            Family::Variable | Family::Setting | Family::Error => &[Word],
            Family::Flow => &[Bit, Counter],
            Family::Frame => &[Frame],
            Family::Kinematic => &[Joints],
            Family::Sense => &[Word, Joints],
            Family::Io => &[Bit],
            Family::Task => &[Switch, Tasks],
        };
        match row.class {
            Class::Always => {}
            Class::AfterForward(kind) => assert!(records.contains(&kind), "{}", row.mnemonic),
            Class::Never(_) => assert_eq!(row.family, Family::Reversal, "{}", row.mnemonic),
        }
    }
}

#[test]
fn a_never_says_why_in_words_for_a_message() {
    let mut nevers = 0;
    for row in OPS {
        let Class::Never(why) = row.class else { continue };
        nevers += 1;
        assert!(why.starts_with(char::is_lowercase), "{}: {why}", row.mnemonic);
        assert!(!why.ends_with('.') && why.contains(' '), "{}: {why}", row.mnemonic);
        assert!(reference::explain(row).contains(why), "{}", row.mnemonic);
        let says_the_programs_reason =
            row.operands.iter().any(|(_, kind)| *kind == OperandKind::Reason);
        assert!(says_the_programs_reason, "{}", row.mnemonic);
    }
    assert!(nevers > 0);
}

/// Which operands are places in the code is known by name, and the two functions that say where
/// control may go, by opcode.
#[test]
fn labels_are_targets_or_where_one_comes_from() {
    for row in OPS {
        let labels: Vec<_> =
            row.operands.iter().filter(|(_, kind)| *kind == OperandKind::Label).collect();
        let instr = with_operands(row, 0).expect("nought is an operand of every kind");
        let is_block_end = matches!(instr, Instr::BlockSkip { .. } | Instr::BlockReplace { .. });
        let found = (instr.jump_target().is_some(), instr.join_from().is_some(), is_block_end);
        let expected = match labels[..] {
            [] => (false, false, false),
            [("target" | "exit", _)] => (true, false, false),
            // Where branches come together: that names the fork, and not who leaves.
            [("join", _)] => (matches!(instr, Instr::Fork { .. }), false, false),
            [("from", _)] => (false, !is_block_end, is_block_end),
            _ => panic!("{}: more than one label, or one of another name", row.mnemonic),
        };
        assert_eq!(found, expected, "{}", row.mnemonic);
    }
}

#[test]
fn instructions_are_the_bytes_that_they_are_of() {
    for row in OPS {
        let mut encoded = 0;
        for number in [0, 1, 2, -1, 127, 255, 32_767, 65_535, i64::from(i32::MIN), 0xffff_ffff] {
            // Not every number is an operand of every kind.
            let Ok(instr) = with_operands(row, number) else { continue };
            encoded += 1;
            let bytes = instr.encode();
            assert_eq!(bytes[0], row.code);
            assert_eq!(Instr::decode(bytes), Ok(instr), "{}", row.mnemonic);
        }
        assert!(encoded > 0, "{}", row.mnemonic);
        let mut width = 1;
        let instr = with_operands(row, 0).expect("nought is an operand of every kind");
        instr.each_operand(&mut |_, bytes, _| width += bytes);
        for at in width..INSTR_BYTES {
            let mut bytes = instr.encode();
            bytes[at] = 1;
            assert_eq!(Instr::decode(bytes), Err(DecodeError::Padding), "{}", row.mnemonic);
        }
    }
}

#[test]
fn codes_of_no_row_are_refused() {
    for code in 0..=u8::MAX {
        let is_row = OPS.iter().any(|row| row.code == code);
        let decoded = Instr::decode([code, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(decoded.is_ok(), is_row, "0x{code:02x}");
        assert!(is_row || decoded == Err(DecodeError::Code(code)));
    }
}

#[test]
fn the_reference_page_is_fresh() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/isa/ISA.md");
    let page = reference::page();
    for row in OPS {
        let cells = format!("| 0x{:02x} | `{}` |", row.code, row.mnemonic);
        assert_eq!(page.matches(&cells).count(), 1, "{}", row.mnemonic);
    }
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(path, &page).expect("isa/ISA.md can be written");
    }
    let written = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        written == page,
        "isa/ISA.md is not what the table says: `UPDATE=1 cargo test --test isa` writes it"
    );
}
