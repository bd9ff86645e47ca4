//! What a workcell looks at while it acts, beside what the act itself asks for.
//!
//! Knows nothing of why somebody wants to know.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Something that may come to hold while an act is under way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Condition {
    /// An input has a level.
    Input {
        /// Its number.
        bit: u16,
        /// The level.
        level: bool,
    },
    /// The filtered contact force is more than so many newtons.
    Force {
        /// How many.
        above_n: f64,
    },
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input { bit, level: true } => write!(f, "input {bit} high"),
            Self::Input { bit, level: false } => write!(f, "input {bit} low"),
            Self::Force { above_n } => write!(f, "force > {above_n} N"),
        }
    }
}

/// A condition that is watched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Watch {
    /// Who it is watched for: a number that its fault says again.
    pub number: u16,
    /// The condition.
    pub condition: Condition,
    /// Whether the act is stopped where it comes to hold, and held there; otherwise the act is
    /// finished first.
    pub stops: bool,
}
