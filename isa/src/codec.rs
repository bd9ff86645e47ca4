//! An instruction as eight bytes: the code, the operands in the order of the row, little endian,
//! and zeros. Every instruction has exactly one encoding.

use crate::instr::{Instr, OPS, Opcode};
use crate::operand::{OperandError, OperandKind};
use std::fmt;

/// The width of every instruction.
pub const INSTR_BYTES: usize = 8;

/// Bytes that are no instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DecodeError {
    /// No opcode has this code.
    Code(u8),
    /// An operand has no such value.
    Operand(OperandError),
    /// A byte after the operands is not zero.
    Padding,
}

impl From<OperandError> for DecodeError {
    fn from(error: OperandError) -> Self {
        Self::Operand(error)
    }
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Code(code) => write!(f, "no opcode has the code 0x{code:02x}"),
            Self::Operand(OperandError { kind, value }) => {
                write!(f, "{value} is no operand of the kind {kind:?}")
            }
            Self::Padding => write!(f, "the bytes after the operands are not zero"),
        }
    }
}

impl std::error::Error for DecodeError {}

/// The fingerprint of the table: of all that bytes and their meaning depend on. A module or a tape
/// made under another table is refused.
pub const FINGERPRINT: u64 = fingerprint();

const fn fingerprint() -> u64 {
    // FNV-1a, 64 bits, over the columns that a module depends on.
    let mut hash = 0xcbf2_9ce4_8422_2325;
    let mut row = 0;
    while row < OPS.len() {
        let info = &OPS[row];
        hash = mix(hash, info.code);
        hash = mix_text(hash, info.mnemonic);
        let mut operand = 0;
        while operand < info.operands.len() {
            hash = mix(hash, info.operands[operand].1 as u8);
            operand += 1;
        }
        hash = match info.class {
            crate::Class::Always => mix(hash, 1),
            crate::Class::AfterForward(kind) => mix(mix(hash, 2), kind as u8),
            crate::Class::Never(_) => mix(hash, 3),
        };
        row += 1;
    }
    hash
}

const fn mix(hash: u64, byte: u8) -> u64 {
    (hash ^ byte as u64).wrapping_mul(0x0000_0100_0000_01b3)
}

const fn mix_text(mut hash: u64, text: &str) -> u64 {
    let bytes = text.as_bytes();
    let mut index = 0;
    while index < bytes.len() {
        hash = mix(hash, bytes[index]);
        index += 1;
    }
    mix(hash, 0)
}

impl Instr {
    /// The bytes of this instruction.
    #[must_use]
    pub fn encode(&self) -> [u8; INSTR_BYTES] {
        let mut bytes = [0; INSTR_BYTES];
        bytes[0] = self.opcode() as u8;
        let mut at = 1;
        self.each_operand(&mut |_, width, value| {
            bytes[at..at + width].copy_from_slice(&value.to_le_bytes()[..width]);
            at += width;
        });
        bytes
    }

    /// The instruction of these bytes.
    ///
    /// # Errors
    /// If they are none.
    pub fn decode(bytes: [u8; INSTR_BYTES]) -> Result<Self, DecodeError> {
        let opcode = Opcode::from_code(bytes[0]).ok_or(DecodeError::Code(bytes[0]))?;
        let mut at = 1;
        let instr = Self::from_operands(opcode, &mut |kind, width| {
            let mut wide = [0; 8];
            wide[..width].copy_from_slice(&bytes[at..at + width]);
            at += width;
            let unsigned = i64::from_le_bytes(wide);
            let shift = 64 - 8 * width as u32;
            let is_signed = kind == OperandKind::Integer;
            Ok::<_, DecodeError>(if is_signed { unsigned << shift >> shift } else { unsigned })
        })?;
        if bytes[at..].iter().any(|&byte| byte != 0) {
            return Err(DecodeError::Padding);
        }
        Ok(instr)
    }
}
