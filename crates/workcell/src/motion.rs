//! Motions as data: where to, along which path, how fast, and when to stop early.
//!
//! Knows nothing of how an arm carries one out.

use obverse_geometry::{Axis, Frame, JointConfiguration, Pose};
use serde::{Deserialize, Serialize};

/// One motion of the arm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Where the motion ends unless its guard stops it.
    pub goal: Goal,
    /// The way there.
    pub path: Path,
    /// How fast.
    pub speed: Speed,
    /// The tool whose centre point moves.
    pub tool: ToolId,
    /// Stop, as a success, once the filtered contact force exceeds this many newtons.
    pub force_limit_n: Option<f64>,
}

/// Where a motion ends. All are absolute: commanding one twice ends in the same place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Goal {
    /// Exactly these joint values, bit for bit, however they are reached.
    Joints(JointConfiguration),
    /// The tool centre point at this pose in the base frame, in the configuration nearest to the
    /// present one.
    Pose(Pose),
    /// The tool centre point displaced from where it is at `from`, along an axis of a frame taken
    /// at `from`.
    Displaced {
        /// The configuration that the displacement starts from.
        from: JointConfiguration,
        /// In metres, along the axis.
        distance_m: f64,
        /// The direction.
        axis: Axis,
        /// The frame of the direction.
        frame: Frame,
    },
    /// The tool centre point displaced sideways from where it is at `from`, in metres along x, y
    /// and z of a frame taken at `from`.
    Offset {
        /// The configuration that the offset starts from.
        from: JointConfiguration,
        /// x, y, z in metres.
        by_m: [f64; 3],
        /// The frame of the offset.
        frame: Frame,
    },
    /// The tool centre point turned, and moved on at the same time, about an axis through where it
    /// is at `from`: what drives a screw or locks a bayonet. Whole turns count. By nothing it leads
    /// back to `from`, bit for bit, as often around as it was turned.
    Turned {
        /// The configuration that the turn starts from.
        from: JointConfiguration,
        /// In radians, by the right hand about the axis.
        angle_rad: f64,
        /// How far along the axis meanwhile, in metres.
        advance_m: f64,
        /// The axis.
        axis: Axis,
        /// The frame of the axis, taken at `from`.
        frame: Frame,
    },
}

/// The way of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Path {
    /// All joints in proportion: straight in joint space.
    Joint,
    /// The tool centre point on a straight line.
    Linear,
}

/// A named speed, which the workcell file gives a number. Restored by identity, never by value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Speed {
    /// The slowest.
    VerySlow,
    /// Below normal.
    Slow,
    /// What holds where a program names none.
    Normal,
    /// Above normal.
    Fast,
    /// The fastest.
    VeryFast,
}

impl Speed {
    /// All speeds, slowest first; the index is the speed's identity in programs and tapes.
    pub const ALL: [Self; 5] =
        [Self::VerySlow, Self::Slow, Self::Normal, Self::Fast, Self::VeryFast];
}

/// A tool of the workcell, by its place in the workcell's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ToolId(pub u16);

/// An item of the workcell, by its place in the workcell's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ItemId(pub u16);

/// What came of a motion that was carried out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionReport {
    /// How it ended.
    pub end: MotionEnd,
    /// How far the tool centre point came from where this motion's goal counts from (`from` of a
    /// displacement, else from where the motion started), in metres.
    pub distance_m: f64,
    /// The largest filtered contact force during the motion, in newtons.
    pub peak_force_n: f64,
    /// How long it took, in seconds of the workcell's clock.
    pub duration_s: f64,
}

/// How a motion ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum MotionEnd {
    /// At its goal.
    Reached,
    /// Before its goal, by its own force limit.
    StoppedByForce,
}
