//! A workcell as its file describes it: arm, speeds, tools, inputs and outputs, items, fixtures.
//!
//! [`Cell::parse`] reads the file; everything here has been checked and is in metres, radians,
//! seconds and newtons. Knows where things should be and how uncertain that is, not where they
//! are: that is drawn when a [`Sim`](crate::Sim) is made.

mod build;
mod code;
mod error;
mod file;
mod goal;
mod key;
mod number;
mod overlap;
mod places;
mod seat;
mod stand;
#[cfg(test)]
mod tests;
mod uncertainty;
mod uncertainty_build;
mod uncertainty_file;
mod within;

pub use code::CellCode;
pub use error::CellError;
pub use goal::{GoalEnd, GoalSpec};
pub use places::CellPlaces;
pub use uncertainty::{ChanceSpec, FallSpec, FeederSpec, InputFlaw, SlipSpec};

use crate::seat::Seat;
use obverse_geometry::{JOINT_COUNT, JointConfiguration, Pose};
use std::f64::consts::{PI, TAU};

/// The most bytes that a workcell file may have.
pub const FILE_BYTES_MAX: usize = 1 << 20;

/// A workcell.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// The arm.
    pub arm: ArmSpec,
    /// The named speeds, slowest first, in the order of `Speed::ALL`.
    pub speeds: [SpeedSpec; 5],
    /// Tools; the first is mounted at the start.
    pub tools: Vec<ToolSpec>,
    /// The gripper, if there is one.
    pub gripper: Option<GripperSpec>,
    /// How many digital outputs there are.
    pub output_count: u16,
    /// Where each digital input gets its level from.
    pub inputs: Vec<InputRule>,
    /// Items.
    pub items: Vec<ItemSpec>,
    /// What stands in the cell and does not move.
    pub fixtures: Vec<FixtureSpec>,
    /// How things touch.
    pub contact: ContactSpec,
    /// The force-torque sensor.
    pub force_sensor: ForceSensorSpec,
    /// What presents items.
    pub feeders: Vec<FeederSpec>,
    /// What may go wrong in any motion, and on the wires.
    pub chance: ChanceSpec,
    /// When items fall; if none is said, never.
    pub falling: Option<FallSpec>,
    /// What a finished assembly is.
    pub goals: Vec<GoalSpec>,
}

/// The arm: where it starts and how far its joints turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmSpec {
    /// Where the joints are at the start.
    pub home: JointConfiguration,
    /// The range of each joint, in radians.
    pub limits_rad: [(f64, f64); JOINT_COUNT],
}

/// What a named speed means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedSpec {
    /// Of the tool centre point on a straight line, in metres a second.
    pub tool_m_per_s: f64,
    /// Of the fastest joint, in radians a second; also of the tool's rotation on a line.
    pub joint_rad_per_s: f64,
    /// Acceleration of the tool centre point, in metres a second squared.
    pub tool_m_per_s2: f64,
    /// Acceleration of the fastest joint, in radians a second squared.
    pub joint_rad_per_s2: f64,
}

/// A tool.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolSpec {
    /// Its name.
    pub name: String,
    /// The tool centre point in the frame of the tool mount.
    pub tcp: Pose,
    /// Its body in the frame of the tool mount.
    pub parts: Vec<Part>,
}

/// A convex part of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Where its centre is, in the frame of the body.
    pub pose: Pose,
    /// What it looks like.
    pub shape: Shape,
}

/// The shape of a part, around its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A box.
    Cuboid {
        /// Full lengths of the edges, in metres.
        size_m: [f64; 3],
    },
    /// A cylinder along z.
    Cylinder {
        /// In metres.
        diameter_m: f64,
        /// In metres.
        length_m: f64,
    },
}

/// A gripper that an output drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GripperSpec {
    /// The tool it is part of, by its place in the list.
    pub tool: u16,
    /// The output that drives it.
    pub output: u16,
    /// The level of the output that closes it.
    pub closed_level: bool,
    /// How near the tool centre point must be to an item's grasp to take it, in metres.
    pub near_m: f64,
    /// How near in orientation, in radians.
    pub near_rad: f64,
    /// Whether closing centres an item along x and along y of the tool centre point.
    pub centres: [bool; 2],
    /// By how much taking an item moves it in the gripper, in the frame of the tool centre point.
    pub grasp_offset: OffsetSpec,
    /// How what is held slips, if it does.
    pub slip: Option<SlipSpec>,
}

/// Where an input gets its level from.
#[derive(Clone, Debug, PartialEq)]
pub enum InputRule {
    /// It never changes.
    Constant(bool),
    /// It has the level that an output had a while ago.
    FollowsOutput {
        /// The output.
        output: u16,
        /// How long ago, in seconds.
        delay_s: f64,
    },
    /// It changes at given times.
    At(Vec<(f64, bool)>),
    /// It is high while the gripper holds an item.
    Holding,
    /// It is high while a feeder's part is at its place.
    PartThere {
        /// The feeder, by its place in the list.
        feeder: usize,
    },
}

/// An item.
#[derive(Clone, Debug, PartialEq)]
pub struct ItemSpec {
    /// Its name.
    pub name: String,
    /// Where it should be at the start.
    pub pose: Pose,
    /// The fixture that it stands on, if it moves with one.
    pub on: Option<On>,
    /// How far it may truly be from there.
    pub offset: OffsetSpec,
    /// The tool centre point in the frame of the item when it is gripped as it should be.
    pub grasp: Pose,
    /// Its body.
    pub parts: Vec<Part>,
    /// What makes it fit a hole, if it does.
    pub peg: Option<PegSpec>,
}

/// A round peg: a cylinder along z of the item's frame, centred there, its tip at +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PegSpec {
    /// In metres.
    pub diameter_m: f64,
    /// In metres.
    pub length_m: f64,
    /// The width of the chamfer of 45 degrees at the tip, in metres.
    pub chamfer_m: f64,
}

/// A fixture.
#[derive(Clone, Debug, PartialEq)]
pub struct FixtureSpec {
    /// Its name.
    pub name: String,
    /// Where it should stand.
    pub pose: Pose,
    /// The fixture that it stands on, if it moves with one.
    pub on: Option<On>,
    /// How far it may truly be from there.
    pub offset: OffsetSpec,
    /// Its body, without its holes.
    pub parts: Vec<Part>,
    /// The round holes in it.
    pub holes: Vec<HoleSpec>,
}

/// What a thing stands on, whose true offset it shares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct On {
    /// The fixture, by its place in the list: for a fixture, one before it.
    pub fixture: usize,
    /// Where the thing should be in the frame of that fixture.
    pub place: Pose,
}

/// A round blind hole in a fixture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoleSpec {
    /// Its place in the fixture's list of holes.
    pub number: usize,
    /// The part of the fixture that it is in, by its place in the list.
    pub part: usize,
    /// The middle of its mouth in the frame of the fixture; z points into the hole.
    pub mouth: Pose,
    /// In metres.
    pub diameter_m: f64,
    /// From the mouth to the bottom, in metres.
    pub depth_m: f64,
    /// The width of the chamfer of 45 degrees at the mouth, in metres.
    pub chamfer_m: f64,
    /// What it does to an item beside guiding it.
    pub seat: Option<Seat>,
}

/// How far a thing may truly be from where it should be, in its own frame: a fixed part, a part
/// uniform within plus and minus, and a part normal with a standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct OffsetSpec {
    /// x, y, z in metres, then a rotation vector in radians.
    pub fixed: [f64; 6],
    /// Half the width of the uniform part.
    pub uniform: [f64; 6],
    /// The standard deviation of the normal part.
    pub normal: [f64; 6],
}

/// How things touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSpec {
    /// Of two bodies pressed on each other, in newtons a metre.
    pub stiffness_n_per_m: f64,
    /// Of the grasp of a peg that is pushed aside, in newtons a metre.
    pub lateral_n_per_m: f64,
    /// Of the grasp of a peg that is tilted, in newton metres a radian.
    pub angular_nm_per_rad: f64,
    /// The coefficient of friction.
    pub friction: f64,
    /// The contact force at which the arm stops by itself, in newtons.
    pub stop_force_n: f64,
}

/// The force-torque sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceSensorSpec {
    /// Noise of a sample, uniform within plus and minus, in newtons.
    pub noise_n: f64,
    /// What it reads without load, in newtons.
    pub bias_n: f64,
    /// Half the width of what a run adds to that, in newtons: the uniform part.
    pub bias_uniform_n: f64,
    /// The standard deviation of the normal part of it, in newtons.
    pub bias_normal_n: f64,
    /// How many samples the running average takes in.
    pub window: u32,
    /// The time between two samples, in seconds.
    pub sample_s: f64,
}

impl Cell {
    /// Read a workcell file.
    ///
    /// # Errors
    /// The first thing that is wrong with it, with its place. All numbers are checked before
    /// anything is made of them; keys that mean nothing are refused.
    pub fn parse(text: &str) -> Result<Self, CellError> {
        build::parse(text)
    }

    /// An empty cell: the arm, a tool `flange`, eight outputs, eight inputs and an item `part`
    /// without a body, that a gripper on output 0 can take where it lies.
    #[must_use]
    pub fn bare() -> Self {
        let home = JointConfiguration([0.0, -PI / 2.0, PI / 2.0, -PI / 2.0, -PI / 2.0, 0.0]);
        Self {
            arm: ArmSpec { home, ..ArmSpec::default() },
            speeds: DEFAULT_SPEEDS,
            tools: vec![ToolSpec {
                name: "flange".to_owned(),
                tcp: Pose::identity(),
                parts: Vec::new(),
            }],
            gripper: Some(GripperSpec {
                tool: 0,
                output: 0,
                closed_level: true,
                near_m: 5e-3,
                near_rad: PI / 18.0,
                centres: [false; 2],
                grasp_offset: OffsetSpec::default(),
                slip: None,
            }),
            output_count: 8,
            inputs: vec![InputRule::Constant(false); 8],
            items: vec![ItemSpec {
                name: "part".to_owned(),
                pose: crate::kinematics::forward(&home),
                on: None,
                offset: OffsetSpec::default(),
                grasp: Pose::identity(),
                parts: Vec::new(),
                peg: None,
            }],
            fixtures: Vec::new(),
            contact: ContactSpec::default(),
            force_sensor: ForceSensorSpec::default(),
            feeders: Vec::new(),
            chance: ChanceSpec::default(),
            falling: None,
            goals: Vec::new(),
        }
    }
}

impl Default for ArmSpec {
    fn default() -> Self {
        Self { home: JointConfiguration::ZERO, limits_rad: [(-TAU, TAU); JOINT_COUNT] }
    }
}

/// From 10 to 500 mm/s; every speed reaches its value within a fraction of a second.
pub(crate) const DEFAULT_SPEEDS: [SpeedSpec; 5] = [
    default_speed(0.01, 5.0),
    default_speed(0.025, 15.0),
    default_speed(0.1, 45.0),
    default_speed(0.25, 90.0),
    default_speed(0.5, 180.0),
];

const fn default_speed(tool_m_per_s: f64, joint_deg_per_s: f64) -> SpeedSpec {
    SpeedSpec {
        tool_m_per_s,
        joint_rad_per_s: joint_deg_per_s * (PI / 180.0),
        tool_m_per_s2: 1.0,
        joint_rad_per_s2: 180.0 * (PI / 180.0),
    }
}

impl Default for ContactSpec {
    fn default() -> Self {
        Self {
            stiffness_n_per_m: 50_000.0,
            lateral_n_per_m: 8_000.0,
            angular_nm_per_rad: 100.0,
            friction: 0.15,
            stop_force_n: 40.0,
        }
    }
}

impl Default for ForceSensorSpec {
    fn default() -> Self {
        Self {
            noise_n: 0.0,
            bias_n: 0.0,
            bias_uniform_n: 0.0,
            bias_normal_n: 0.0,
            window: 4,
            sample_s: 0.008,
        }
    }
}
