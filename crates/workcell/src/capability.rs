//! One trait a capability; a workcell has them all.
//!
//! What a call may change is said at each method; reading never changes anything.

use crate::{Fault, ItemId, Motion, MotionReport, ToolId, Watch};
use obverse_geometry::{JointConfiguration, Pose};

/// An arm with six joints.
pub trait Arm {
    /// Where the joints are.
    fn joints(&self) -> JointConfiguration;

    /// Carry out a motion. On success the arm stands at the goal, exactly there if the goal is
    /// given in joints, or where its force limit stopped it.
    ///
    /// # Errors
    /// A goal outside limits or reach is refused before anything moves; a motion that could not be
    /// finished leaves the arm where it stopped. Nothing is ever clipped.
    fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Fault>;

    /// What came of the last motion that [`execute`](Self::execute) finished.
    fn last_motion(&self) -> MotionReport;

    /// How far the tool centre point has gone in all motions, in metres: each from where it began
    /// to where it ended, those included that a fault ended.
    fn way_m(&self) -> f64;
}

/// What may be asked after a stop.
pub trait Safety {
    /// Whether the arm is held by a stop and refuses to move.
    fn is_stopped(&self) -> bool;

    /// The fresh command that lets it move again.
    fn release(&mut self);
}

/// Digital outputs and inputs, numbered from 0.
pub trait DigitalIo {
    /// How many outputs there are.
    fn output_count(&self) -> u16;

    /// The level an output was last set to.
    fn output(&self, bit: u16) -> bool;

    /// Set an output.
    ///
    /// # Errors
    /// [`Fault::Missing`] for an output that is not there; faults of the wiring.
    fn set_output(&mut self, bit: u16, level: bool) -> Result<(), Fault>;

    /// How many inputs there are.
    fn input_count(&self) -> u16;

    /// Read an input.
    ///
    /// # Errors
    /// [`Fault::Missing`] for an input that is not there.
    fn input(&self, bit: u16) -> Result<bool, Fault>;
}

/// A gripper, driven by an output and sensed by what it holds.
pub trait Gripper {
    /// The item in the gripper.
    fn held(&self) -> Option<ItemId>;
}

/// A force-torque sensor at the tool mount.
pub trait ForceTorque {
    /// The magnitude of the filtered force, in newtons.
    fn force_n(&self) -> f64;
}

/// The workcell's own time.
pub trait Clock {
    /// Seconds since the workcell started; never goes back.
    fn now_s(&self) -> f64;

    /// Let time pass.
    ///
    /// # Errors
    /// [`Fault::BadCommand`] for a time that is negative or not finite.
    fn wait(&mut self, duration_s: f64) -> Result<(), Fault>;
}

/// Looking at conditions while acts (motions, outputs, waits) are under way.
pub trait Watching {
    /// From the next act on, look at these conditions and no others. An act during which one comes
    /// to hold ends in [`Fault::Watched`]: at that instant if the watch stops it, and otherwise
    /// when it is finished. What holds already when it is first looked at, or has come to hold
    /// while nobody looked, counts as coming to hold where an act begins; it counts once, until it
    /// has been seen not to hold. Of several at one instant the first of the list is told.
    fn watch(&mut self, watches: &[Watch]);

    /// What was told of the watches of a number has been taken back: those of their conditions that
    /// hold still count once more, where the next act begins.
    fn watch_again(&mut self, number: u16);
}

/// Random numbers for programs. The machine keeps the counter, as part of its state; the workcell
/// keeps the seed.
pub trait Dice {
    /// The draw of this number, uniform in [0, 1): the same for the same seed and counter.
    fn draw(&self, counter: u64) -> f64;
}

/// Items and tools by name, and where items should be.
pub trait Items {
    /// The item of this name.
    fn item(&self, name: &str) -> Option<ItemId>;

    /// Where the workcell file says the item is, in the base frame: what a program may know, not
    /// where the item truly lies.
    fn nominal_pose(&self, item: ItemId) -> Option<Pose>;

    /// The tool of this name.
    fn tool(&self, name: &str) -> Option<ToolId>;

    /// The tool that is mounted when a program starts.
    fn initial_tool(&self) -> ToolId;
}

/// Everything a machine needs of a workcell.
pub trait Workcell:
    Arm + Safety + DigitalIo + Gripper + ForceTorque + Clock + Watching + Dice + Items
{
    /// Every observable of the workcell that a program can command, as numbers: what the digest of
    /// a state covers beside the machine's own part. The clock, the world's randomness and sensor
    /// noise are not among them.
    fn commanded_state(&self, sink: &mut dyn FnMut(u64)) {
        for joint in self.joints().bits() {
            sink(joint);
        }
        for bit in 0..self.output_count() {
            sink(u64::from(self.output(bit)));
        }
        sink(self.held().map_or(u64::MAX, |item| u64::from(item.0)));
    }
}
