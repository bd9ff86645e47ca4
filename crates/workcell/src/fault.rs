//! Faults: the workcell did not do as commanded.
//!
//! A fault is data with the numbers a person needs; what follows from it is decided elsewhere.

use crate::watch::Watch;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Why the workcell did not do as commanded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Fault {
    /// A goal, or the way to it, leaves the range of a joint (numbered from 1).
    JointLimit {
        /// From 1 at the base to 6 at the wrist.
        joint: u8,
        /// What it would have to be, in radians.
        value_rad: f64,
        /// The range it has, in radians.
        range_rad: (f64, f64),
    },
    /// No joint configuration reaches the goal or a point of the straight line to it.
    OutOfReach {
        /// The point that cannot be reached, metres in the base frame.
        at_m: [f64; 3],
    },
    /// A straight line passes too near a singularity to be followed.
    Singular {
        /// Where along the path, 0 to 1.
        fraction: f64,
    },
    /// The arm, the tool or the held item met something the motion was not allowed to touch.
    Collision {
        /// The part of the robot, or the held item.
        body: String,
        /// What it met.
        with: String,
        /// Where along the path, 0 to 1.
        fraction: f64,
        /// The contact force when the arm stopped, in newtons.
        force_n: f64,
    },
    /// A motion that had to come all the way was stopped by its force limit.
    ForceLimit {
        /// The largest filtered force, in newtons.
        force_n: f64,
        /// The limit, in newtons.
        limit_n: f64,
    },
    /// The arm was stopped on the way and holds its position.
    ProtectiveStop {
        /// Where along the path, 0 to 1.
        fraction: f64,
    },
    /// Everything in the cell was stopped on the way; the arm holds its position.
    EmergencyStop {
        /// Where along the path, 0 to 1.
        fraction: f64,
    },
    /// The motion ended before its goal without a stop: the next command may follow at once.
    StoppedShort {
        /// Where along the path, 0 to 1.
        fraction: f64,
    },
    /// What was [watched](crate::Watching) has come to hold. The act was stopped there if the watch
    /// stops, with nothing that has to be released; otherwise it was done all the same.
    Watched {
        /// What.
        watch: Watch,
        /// Where along the path, or in the time, 0 to 1.
        fraction: f64,
    },
    /// A command was refused since the arm is stopped and has not been released.
    Stopped,
    /// A number in a command is not one the workcell can act on.
    BadCommand {
        /// What is wrong with it.
        why: String,
    },
    /// The workcell has no such output, input, item or tool.
    Missing {
        /// What was asked for.
        what: String,
    },
}

macro_rules! kinds {
    ($($kind:ident $code:literal)*) => {
        /// A fault without its numbers, for tables and statistics.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum FaultKind {
            $(#[doc = concat!("See [`Fault::", stringify!($kind), "`].")] $kind,)*
        }

        impl FaultKind {
            /// Every kind.
            pub const ALL: &'static [Self] = &[$(Self::$kind),*];

            /// The stable code of this kind, as machines read it.
            #[must_use]
            pub fn code(self) -> &'static str {
                match self { $(Self::$kind => $code,)* }
            }
        }
    };
}

kinds! {
    JointLimit "joint_limit"
    OutOfReach "out_of_reach"
    Singular "singular"
    Collision "collision"
    ForceLimit "force_limit"
    ProtectiveStop "protective_stop"
    EmergencyStop "emergency_stop"
    StoppedShort "stopped_short"
    Watched "watched"
    Stopped "stopped"
    BadCommand "bad_command"
    Missing "missing"
}

impl Fault {
    /// The kind of this fault.
    #[must_use]
    pub fn kind(&self) -> FaultKind {
        match self {
            Self::JointLimit { .. } => FaultKind::JointLimit,
            Self::OutOfReach { .. } => FaultKind::OutOfReach,
            Self::Singular { .. } => FaultKind::Singular,
            Self::Collision { .. } => FaultKind::Collision,
            Self::ForceLimit { .. } => FaultKind::ForceLimit,
            Self::ProtectiveStop { .. } => FaultKind::ProtectiveStop,
            Self::EmergencyStop { .. } => FaultKind::EmergencyStop,
            Self::StoppedShort { .. } => FaultKind::StoppedShort,
            Self::Watched { .. } => FaultKind::Watched,
            Self::Stopped => FaultKind::Stopped,
            Self::BadCommand { .. } => FaultKind::BadCommand,
            Self::Missing { .. } => FaultKind::Missing,
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::JointLimit { joint, value_rad, range_rad: (low, high) } => write!(
                f,
                "joint {joint} would have to be at {value_rad:.4} rad, and its range is \
                 {low:.4} to {high:.4} rad"
            ),
            Self::OutOfReach { at_m: [x, y, z] } => write!(
                f,
                "the arm cannot reach ({:.1}, {:.1}, {:.1}) mm",
                x * 1e3,
                y * 1e3,
                z * 1e3
            ),
            Self::Singular { fraction } => write!(
                f,
                "the straight line passes a singularity at {:.0} % of the way",
                fraction * 1e2
            ),
            Self::Collision { body, with, fraction, force_n } => write!(
                f,
                "{body} met {with} at {:.0} % of the way, with {force_n:.1} N",
                fraction * 1e2
            ),
            Self::ForceLimit { force_n, limit_n } => {
                write!(f, "stopped on the way by {force_n:.1} N, and the limit is {limit_n:.1} N")
            }
            Self::ProtectiveStop { fraction } => {
                write!(f, "protective stop at {:.0} % of the way", fraction * 1e2)
            }
            Self::EmergencyStop { fraction } => {
                write!(f, "emergency stop at {:.0} % of the way", fraction * 1e2)
            }
            Self::StoppedShort { fraction } => {
                write!(f, "the motion stopped short at {:.0} % of the way", fraction * 1e2)
            }
            Self::Watched { watch, fraction } => {
                let done = if watch.stops { "stopped by" } else { "noticed" };
                write!(f, "{done} {} at {:.0} % of the way", watch.condition, fraction * 1e2)
            }
            Self::Stopped => write!(f, "the arm is stopped and waits to be released"),
            Self::BadCommand { why } => write!(f, "the command makes no sense: {why}"),
            Self::Missing { what } => write!(f, "the workcell has no {what}"),
        }
    }
}

impl std::error::Error for Fault {}
