//! Modules: what a compiler writes and a machine runs.
//!
//! [`module`] is the data ([`fault`] what it says of faults, [`places`] where it was written),
//! [`codec`] its bytes, [`builder`] how code is put together, [`text`] the assembler and
//! disassembler, [`mod@verify`] what a machine may rely on, [`code`] the codes of what is wrong.
//! Knows nothing of source languages, tapes or robots.

pub mod builder;
pub mod code;
pub mod codec;
pub mod fault;
pub mod module;
pub mod places;
pub mod text;
pub mod verify;
mod wire;

pub use builder::{CodeBuilder, Mark};
pub use code::ModuleCode;
pub use codec::{DecodeError, DecodeErrorKind, decode, encode, fingerprint};
pub use fault::{Bounds, FaultName, Watched};
pub use module::{
    ActionKind, Constant, Continuation, Depth, ErrorDeclaration, Extent, Function, FunctionKind,
    Item, Keyframe, LoopName, Mention, Mentioned, Module, Otherwise, Pattern, Perturbation,
    Recovery, Respond, Reversal, Severity, SourceEntry, SourceFile, Variable,
};
pub use places::Places;
pub use text::{AsmError, assemble, disassemble};
pub use verify::{Verified, VerifyError, verify};
