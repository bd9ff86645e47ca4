//! Every opcode, by family: save, forward and reverse of one stand side by side.

pub(crate) mod acts;
mod error;
pub(crate) mod flow;
mod io;
mod kinematic;
mod reversal;
mod sense;
mod setting;
mod value;
mod variable;
