//! What a run depended on that was outside the machine, in the order in which it came: what the
//! workcell answered, and which way the machine was driven.
//!
//! With the program it is all that is needed to make every state of the run again, bit for bit.
//! Plain arithmetic leaves nothing here: what acts and readings cost is stated at the types. Knows
//! nothing of how it is written or used.

use obverse_geometry::{JointConfiguration, Pose};
use obverse_isa::{ErrorId, GlobalId, LocalId};
use obverse_tape::Note;
use obverse_vm::Alteration;
use obverse_workcell::{Fault, ItemId, Motion, MotionReport, ToolId};
use serde::{Deserialize, Serialize};

/// A place on the time line of a run: how many instructions had been run or reversed, an act that
/// failed counting as one. Never goes back, whichever way the machine goes.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct Moment(pub u64);

impl std::fmt::Display for Moment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl Moment {
    /// So many instructions later.
    #[must_use]
    pub fn after(self, ticks: u64) -> Self {
        Self(self.0.saturating_add(ticks))
    }
}

/// A run as it was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What does not change of the workcell.
    pub facts: Facts,
    /// The workcell at the start.
    pub start: World,
    /// What it answered.
    pub log: Log,
    /// How the machine was driven, oldest first.
    pub stretches: Vec<Stretch>,
    /// Where the recording ends.
    pub end: Moment,
}

/// What a program asks of a workcell that does not change.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// How many outputs there are.
    pub outputs: u16,
    /// How many inputs there are.
    pub inputs: u16,
    /// The program's items by name, with where the workcell file says they are.
    pub items: Vec<(String, ItemId, Option<Pose>)>,
    /// The program's tools by name.
    pub tools: Vec<(String, ToolId)>,
    /// The tool that is mounted when a program starts.
    pub initial_tool: Option<ToolId>,
}

/// What can be seen of a workcell between two commands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct World {
    /// Where the joints are.
    pub joints: JointConfiguration,
    /// The levels of the outputs.
    pub outputs: Vec<bool>,
    /// What the gripper holds.
    pub held: Option<ItemId>,
    /// The filtered force, in newtons.
    pub force_n: f64,
    /// What came of the last motion.
    pub last_motion: MotionReport,
    /// How far the tool has gone in all motions, in metres.
    pub way_m: f64,
    /// The workcell's clock, in seconds.
    pub now_s: f64,
    /// Whether a stop holds the arm.
    pub is_stopped: bool,
}

/// What a workcell answered.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Log {
    /// One a command, in their order: some 56 bytes each.
    pub frames: Vec<Frame>,
    /// One a motion, in their order: some 300 bytes each.
    pub motions: Vec<Moved>,
    /// The faults, in their order.
    pub faults: Vec<Fault>,
    /// What readings gave, each where it was not the same as the time before: 32 bytes each.
    pub readings: Vec<Reading>,
    /// What was noted on the tape, in its order.
    pub notes: Vec<Note>,
}

/// What came of a command.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// The command.
    pub command: Command,
    /// Which of the faults it ended in.
    pub fault: Option<u32>,
    /// Whether the workcell watched meanwhile what the program says.
    pub is_watched: bool,
    /// What the gripper holds after it.
    pub held: Option<ItemId>,
    /// The force after it, in newtons.
    pub force_n: f64,
    /// The clock after it, in seconds.
    pub now_s: f64,
    /// Whether a stop holds the arm after it.
    pub is_stopped: bool,
}

/// A command.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// A motion: which of the recording's.
    Execute(u32),
    /// An output.
    Output {
        /// Which.
        bit: u16,
        /// What it was to be.
        level: bool,
        /// What it was then.
        became: bool,
    },
    /// A wait of so many seconds.
    Wait(f64),
    /// A person's, without which nothing moves after a stop.
    Release,
    /// What was noticed for an error of this number is to be noticed again if it holds still.
    WatchAgain(u16),
    /// Somebody changed the workcell by hand.
    Change,
}

/// A motion and what came of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moved {
    /// What was commanded.
    pub motion: Motion,
    /// Where the joints were then.
    pub joints: JointConfiguration,
    /// What the workcell reported as the last motion then.
    pub last: MotionReport,
    /// How far the tool had gone in all motions then, in metres.
    pub way_m: f64,
}

/// Something that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Sense {
    /// An input.
    Input(u16),
    /// The force.
    Force,
    /// A random number, by its counter.
    Draw(u64),
}

/// What a reading gave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reading {
    /// Which reading of the run it was.
    pub number: u64,
    /// What was read.
    pub sense: Sense,
    /// The bits of what it gave; 2 for an input that is not there.
    pub value: u64,
}

/// A row of steps that the machine was driven by one order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stretch {
    /// The order.
    pub order: Order,
    /// When it began.
    pub begin: Moment,
    /// How many commands the workcell had been given then, by whomever.
    pub frame: u64,
}

/// How a machine is driven.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "crate::wire::Order", from = "crate::wire::Order")]
pub enum Order {
    /// Forward.
    Forward,
    /// In reverse, commanding the workcell.
    Reverse,
    /// Back in the program alone, commanding nothing.
    Unwind,
    /// The fault that stopped the act at hand became an error of the program.
    Raise(ErrorId),
    /// On behind the act that a fault has stopped.
    PassOver,
    /// All that is under way was left for the cleanup.
    Leave,
    /// Something was noted on the tape: which of the recording's notes.
    Note(u32),
    /// From here on otherwise than the program says.
    Alter(Option<Alteration>),
    /// The workcell was changed by hand, which is in the log.
    Change,
    /// A variable of the program was given these bits.
    SetGlobal(GlobalId, u64),
    /// A local variable of a call, counted from the outermost, was given these bits.
    SetLocal(u32, LocalId, u64),
}

impl Log {
    /// What the workcell is like after a command, if it was like this before.
    pub fn apply(&self, frame: &Frame, world: &mut World) {
        world.held = frame.held;
        world.force_n = frame.force_n;
        world.now_s = frame.now_s;
        world.is_stopped = frame.is_stopped;
        match frame.command {
            Command::Execute(index) => {
                if let Some(moved) = self.motions.get(index as usize) {
                    world.joints = moved.joints;
                    world.last_motion = moved.last;
                    world.way_m = moved.way_m;
                }
            }
            Command::Output { bit, became, .. } => {
                if let Some(level) = world.outputs.get_mut(usize::from(bit)) {
                    *level = became;
                }
            }
            Command::Wait(_) | Command::Release | Command::WatchAgain(_) | Command::Change => {}
        }
    }

    /// The fault that a command ended in.
    #[must_use]
    pub fn fault(&self, frame: &Frame) -> Option<&Fault> {
        self.faults.get(frame.fault? as usize)
    }
}
