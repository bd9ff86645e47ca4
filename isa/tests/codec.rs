//! Eight bytes and their instruction: every instruction has one encoding, and every other row of
//! bytes is refused.

use obverse_isa::{
    DecodeError, INSTR_BYTES, Instr, LocalId, OPS, OpInfo, Opcode, OperandError, OperandKind,
    Prefix,
};

/// How many values an operand of a kind and a width has, if it is no signed number.
fn choices(kind: OperandKind, width: usize) -> i64 {
    match kind {
        OperandKind::Level | OperandKind::Path => 2,
        OperandKind::Frame => 3,
        OperandKind::Setting => 5,
        OperandKind::Speed => 6,
        OperandKind::Axis => 6,
        _ => 1 << (8 * width as u32),
    }
}

/// Instructions of a row: the least operands, the greatest, and all between in steps of `step`.
fn instructions(row: &OpInfo, step: i64) -> Vec<Instr> {
    let with = |value: i64| {
        let made: Result<_, OperandError> = Instr::from_operands(row.opcode, &mut |kind, width| {
            let choices = choices(kind, width);
            let is_signed = kind == OperandKind::Integer;
            let value = value.min(choices - 1);
            Ok(if is_signed { value - choices / 2 } else { value })
        });
        made.unwrap_or_else(|error| panic!("{}: {error:?}", row.mnemonic))
    };
    (0..1i64 << 33).step_by(step as usize).chain([1, 2, 255, i64::MAX]).map(with).collect()
}

#[test]
fn every_instruction_round_trips() {
    for instr in OPS.iter().flat_map(|row| instructions(row, 0x0123_4567)) {
        assert_eq!(Instr::decode(instr.encode()), Ok(instr));
    }
}

#[test]
fn every_beginning_is_an_instruction_or_refused() {
    let mut instructions = 0;
    for rest in [0, 1, 0x7f, 0xff] {
        for first in 0..=u16::MAX {
            let mut bytes = [rest; INSTR_BYTES];
            bytes[..2].copy_from_slice(&first.to_le_bytes());
            if let Ok(instr) = Instr::decode(bytes) {
                assert_eq!(instr.encode(), bytes);
                instructions += 1;
            }
        }
    }
    assert!(instructions > 0);
}

#[test]
fn codes_of_no_opcode_are_refused() {
    for code in (0..=u8::MAX).filter(|code| OPS.iter().all(|row| row.code != *code)) {
        let mut bytes = [0; INSTR_BYTES];
        bytes[0] = code;
        assert_eq!(Instr::decode(bytes), Err(DecodeError::Code(code)));
    }
}

#[test]
fn the_bytes_after_the_operands_are_zero() {
    for row in OPS {
        let instr = instructions(row, 1 << 32)[0];
        let mut width = 1;
        instr.each_operand(&mut |_, bytes, _| width += bytes);
        for at in width..INSTR_BYTES {
            for bit in 0..8 {
                let mut bytes = instr.encode();
                assert_eq!(bytes[at], 0, "{}", row.mnemonic);
                bytes[at] = 1 << bit;
                assert_eq!(Instr::decode(bytes), Err(DecodeError::Padding), "{}", row.mnemonic);
            }
        }
    }
}

#[test]
fn every_byte_of_every_operand_counts() {
    for row in OPS {
        let instr = instructions(row, 1 << 32)[0];
        let mut at = 1;
        instr.each_operand(&mut |kind, width, _| {
            for byte in at..at + width {
                let mut bytes = instr.encode();
                bytes[byte] ^= 1;
                let changed = Instr::decode(bytes).unwrap_or_else(|error| panic!("{error}"));
                assert!(changed != instr, "{} {kind:?}", row.mnemonic);
            }
            at += width;
        });
    }
}

#[test]
fn choices_that_are_none_are_refused() {
    for row in OPS {
        let instr = instructions(row, 1 << 32)[0];
        let mut at = 1;
        instr.each_operand(&mut |kind, width, _| {
            let choices = choices(kind, width);
            if width == 1 && choices < 256 {
                for value in choices..256 {
                    let mut bytes = instr.encode();
                    bytes[at] = value as u8;
                    let expected = DecodeError::Operand(OperandError { kind, value });
                    assert_eq!(Instr::decode(bytes), Err(expected), "{}", row.mnemonic);
                }
            }
            at += width;
        });
    }
}

#[test]
fn operands_stand_in_order_little_endian() {
    let jump = [0x57, 3, 0xfe, 0xff, 0x04, 0x03, 0x02, 0x01];
    let expected = Instr::JumpUnlessEqImmediate {
        prefix: Prefix(3),
        value: -2,
        target: obverse_isa::Label(0x0102_0304),
    };
    assert_eq!(Instr::decode(jump), Ok(expected));
    let add = [0x46, 9, 0xff, 0xff, 0xff, 0xff, 0, 0];
    let expected = Instr::AddLocalImmediate { local: LocalId(9), value: -1 };
    assert_eq!(Instr::decode(add), Ok(expected));
}

#[test]
fn numbers_that_do_not_fit_are_no_operands() {
    let refused = |opcode: Opcode, value: i64| -> Option<OperandError> {
        Instr::from_operands::<OperandError>(opcode, &mut |_, _| Ok(value)).err()
    };
    let error = |kind, value| Some(OperandError { kind, value });
    let (integer, local, label) = (OperandKind::Integer, OperandKind::Local, OperandKind::Label);
    for (opcode, kind, least, most) in [
        (Opcode::PushInt, integer, i64::from(i32::MIN), i64::from(i32::MAX)),
        (Opcode::PushLocal, local, 0, 255),
        (Opcode::PushConstant, OperandKind::Constant, 0, 65535),
        (Opcode::Jump, label, 0, i64::from(u32::MAX)),
    ] {
        assert_eq!((refused(opcode, least), refused(opcode, most)), (None, None));
        assert_eq!(refused(opcode, least - 1), error(kind, least - 1));
        assert_eq!(refused(opcode, most + 1), error(kind, most + 1));
    }
}

#[test]
fn refusals_say_what_is_wrong() {
    let text = |bytes: [u8; INSTR_BYTES]| Instr::decode(bytes).unwrap_err().to_string();
    assert_eq!(text([0xff; 8]), "no opcode has the code 0xff");
    assert_eq!(text([0x03, 2, 0, 0, 0, 0, 0, 0]), "2 is no operand of the kind Level");
    assert_eq!(text([0x6a, 0, 0, 0, 0, 0, 0, 1]), "the bytes after the operands are not zero");
}
