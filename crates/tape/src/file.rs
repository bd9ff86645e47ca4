//! The tape file: a recording that stands for itself.
//!
//! It holds the module that was run, the state that the run ended in, and the tape, so that whoever
//! opens it can see what happened and walk backwards through it. What it says is not believed until
//! a machine has checked it.

use crate::tape::Streams;
use obverse_bytecode::codec::{self, Format};
use obverse_bytecode::{DecodeError, Module, fingerprint};
use serde::{Deserialize, Serialize};

/// A tape file.
pub const TAPE: Format =
    Format { magic: *b"OBVTAPE\0", version: 4, name: "tape", remedy: "record the run again" };

/// The content of a tape file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TapeFile {
    /// The bytes of the module that was run.
    pub module: Vec<u8>,
    /// The fingerprint of the module.
    pub fingerprint: u64,
    /// The seed of the workcell.
    pub seed: u64,
    /// How the run ended, in words.
    pub ending: String,
    /// The state at the end.
    pub state: Snapshot,
    /// The records.
    pub streams: Streams,
}

/// A machine's state, and what it commands of the workcell, as plain data.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Snapshot {
    /// The next instruction.
    pub pc: u32,
    /// How many instructions lie between the start and here.
    pub steps: u64,
    /// The operand stack, bottom first.
    pub operands: Vec<u64>,
    /// The calls under way, outermost first.
    pub frames: Vec<FrameSnapshot>,
    /// The variables of the program.
    pub globals: Vec<u64>,
    /// The settings by identity.
    pub settings: [u64; 5],
    /// The errors that are pending, oldest first.
    pub raised: Vec<u16>,
    /// How many random numbers have been drawn.
    pub draws: u64,
    /// The act that was begun and not finished: whether it was going in reverse, and the level that
    /// a toggled output had before.
    pub pending: Option<(bool, Option<bool>)>,
    /// The forks that are open, outermost first.
    pub forks: Vec<ForkSnapshot>,
    /// Where the joints were, in radians.
    pub joints: [f64; 6],
    /// The levels of the outputs.
    pub outputs: Vec<bool>,
}

/// An open fork.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ForkSnapshot {
    /// The `fork`.
    pub at: u32,
    /// How many calls are around it.
    pub base: u32,
    /// Whose turn it is.
    pub current: u8,
    /// How many steps have been made in this turn.
    pub turn_steps: u64,
    /// How much time has passed in it, in nanoseconds.
    pub now_ns: u64,
    /// The tasks by branch; that whose turn it is has nothing of its own here.
    pub tasks: Vec<TaskSnapshot>,
}

/// A task that waits for its turn.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct TaskSnapshot {
    /// The next instruction.
    pub pc: u32,
    /// Whether it has come to its end.
    pub is_done: bool,
    /// Until when it waits, in nanoseconds of the fork's time.
    pub until_ns: u64,
    /// Its calls, outermost first.
    pub frames: Vec<FrameSnapshot>,
}

/// A call under way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameSnapshot {
    /// The function.
    pub function: u16,
    /// Where the caller goes on.
    pub return_pc: u32,
    /// Locals, then counters.
    pub words: Vec<u64>,
    /// Remembered positions, in radians.
    pub positions: Vec<[f64; 6]>,
}

impl TapeFile {
    /// Its bytes.
    ///
    /// # Errors
    /// If it is larger than a file may be.
    pub fn to_bytes(&self) -> Result<Vec<u8>, DecodeError> {
        codec::seal(TAPE, self)
    }

    /// The tape file of these bytes, with the module that it carries.
    ///
    /// # Errors
    /// If they are none, or their module is not the one that they say.
    pub fn from_bytes(bytes: &[u8]) -> Result<(Self, Module), DecodeError> {
        let file: Self = codec::open(TAPE, bytes)?;
        if fingerprint(&file.module) != file.fingerprint {
            let why = "its module is not the one that was run".to_owned();
            let kind = obverse_bytecode::DecodeErrorKind::Payload { why };
            return Err(DecodeError { format: TAPE, kind });
        }
        let module = obverse_bytecode::decode(&file.module)?;
        Ok((file, module))
    }
}
