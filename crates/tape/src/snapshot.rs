//! A machine's state as plain data, for what leaves it, keeps it and comes back to it.
//!
//! What it says is not believed until a machine has checked it.

/// A machine's state, and what it commands of the workcell, as plain data.
#[derive(Clone, Debug, PartialEq, Default)]
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
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq, Default)]
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
#[derive(Clone, Debug, PartialEq)]
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
