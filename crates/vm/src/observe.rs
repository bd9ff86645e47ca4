//! What a machine tells of its doings. Knows nothing of how they are told on.

use crate::state::{Direction, State};
use obverse_isa::Instr;
use obverse_workcell::{MotionReport, Workcell};

/// Something that a machine did, for whoever tells or counts it.
#[derive(Clone, Debug)]
pub struct Event {
    /// Which way it was done.
    pub direction: Direction,
    /// The instruction.
    pub pc: u32,
    /// The same, decoded.
    pub instr: Instr,
    /// What came of it, if it was a motion.
    pub report: Option<MotionReport>,
    /// How many instructions lie between the start of the program and here, after it.
    pub steps: u64,
    /// How many instructions the machine had run or reversed before it.
    pub executed: u64,
    /// How many blocks with a reverse of their own are open around it: what is never taken back
    /// outside such a block cannot be passed over.
    pub open_blocks: u32,
    /// How many calls are under way after it.
    pub frames: usize,
    /// Which branch did it of each fork that is open, outermost first.
    pub branches: Vec<usize>,
}

/// Who is told what a machine does. Told of acts, calls, returns, errors, forks that are left, ends
/// of branches where all others wait, and the reversal words.
pub trait Observer {
    /// It was done.
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell);

    /// A run that goes past stops stands before one, having run or reversed so many instructions.
    fn before_stop(&mut self, _: &State, _executed: u64) {}

    /// It has gone past it, by one step.
    fn behind_stop(&mut self, _: &State, _executed: u64) {}
}

impl Observer for () {
    fn on_event(&mut self, _: &Event, _: &dyn Workcell) {}
}
