//! What a program says of faults: which of them it raises as errors, by name, what it has watched
//! while it acts, and how much one incident may cost. Knows nothing of a workcell: the names are
//! its codes, and nothing else.

use serde::{Deserialize, Serialize};

/// A kind of fault, by the code that a workcell gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum FaultName {
    /// A goal, or the way to it, leaves the range of a joint.
    JointLimit,
    /// No joint configuration reaches the goal or a point of the way to it.
    OutOfReach,
    /// A straight line passes too near a singularity.
    Singular,
    /// The arm, the tool or what is held met something it was not allowed to touch.
    Collision,
    /// A motion that had to come all the way was stopped by its force limit.
    ForceLimit,
    /// The arm was stopped on the way and holds its position.
    ProtectiveStop,
    /// Somebody pressed the emergency stop.
    EmergencyStop,
    /// A motion ended before its goal, and nothing said why.
    StoppedShort,
    /// A command was refused since the arm is stopped and has not been released.
    Stopped,
    /// A number in a command is not one the workcell can act on.
    BadCommand,
    /// The workcell has no such output, input, item or tool.
    Missing,
}

impl FaultName {
    /// Every one, in the order of a module's lists.
    pub const ALL: [Self; 11] = [
        Self::JointLimit,
        Self::OutOfReach,
        Self::Singular,
        Self::Collision,
        Self::ForceLimit,
        Self::ProtectiveStop,
        Self::EmergencyStop,
        Self::StoppedShort,
        Self::Stopped,
        Self::BadCommand,
        Self::Missing,
    ];

    /// The code that a workcell gives this kind of fault.
    #[must_use]
    pub fn code(self) -> &'static str {
        match self {
            Self::JointLimit => "joint_limit",
            Self::OutOfReach => "out_of_reach",
            Self::Singular => "singular",
            Self::Collision => "collision",
            Self::ForceLimit => "force_limit",
            Self::ProtectiveStop => "protective_stop",
            Self::EmergencyStop => "emergency_stop",
            Self::StoppedShort => "stopped_short",
            Self::Stopped => "stopped",
            Self::BadCommand => "bad_command",
            Self::Missing => "missing",
        }
    }

    /// The kind of this code, if a program can name it.
    #[must_use]
    pub fn from_code(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|name| name.code() == code)
    }
}

/// What a program has watched while it acts: an error is raised when it comes to hold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Watched {
    /// An input at a level.
    Input {
        /// Its number in the workcell.
        bit: u16,
        /// The level.
        level: bool,
    },
    /// A contact force of more than so many newtons, which are more than nothing.
    Force {
        /// How many.
        above_n: f64,
    },
}

/// How much recovering from one incident may cost before it is given up; what is not said is not
/// bounded by the program.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Bounds {
    /// How many attempts, at least 1.
    pub attempts: Option<u32>,
    /// How long, in seconds, more than nothing.
    pub time_s: Option<f64>,
    /// How far the tool centre point may travel, in metres, more than nothing.
    pub distance_m: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::FaultName;

    #[test]
    fn every_code_is_that_of_its_name_alone() {
        for name in FaultName::ALL {
            assert_eq!(FaultName::from_code(name.code()), Some(name));
        }
        assert!(FaultName::ALL.is_sorted(), "lists of them are sorted so");
        assert_eq!(FaultName::from_code("protective stop"), None);
    }
}
