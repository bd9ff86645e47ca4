//! The instruction set: one table, and what derives from it.
//!
//! [`table`] holds a row an opcode with every property as a typed column; [`instr`], [`codec`] and
//! [`mod@reference`] derive from the rows. No dependencies, and no knowledge of modules, machines
//! or robots. To add an instruction, read `isa/README.md`.

pub mod codec;
pub mod columns;
pub mod instr;
pub mod operand;
pub mod reference;
pub mod table;

pub use codec::{DecodeError, FINGERPRINT, INSTR_BYTES};
pub use columns::{Class, Family, RecordKind, StackItem, Type};
pub use instr::{Instr, OPS, OpInfo, Opcode, op};
pub use operand::{
    Axis, Bit, CheckpointId, ConstantId, CounterId, ErrorId, Frame, FunctionId, GlobalId, ItemId,
    JointsId, KeyframeId, Label, Level, LocalId, Operand, OperandError, OperandKind, Path, Prefix,
    ReasonId, Setting, SlotId, SpeedId, ToolId,
};
