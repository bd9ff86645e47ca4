//! The frames a relative motion can be given in, and the six axes of a frame.
//!
//! Knows nothing of the words (forward, left, up) that a language has for them.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The frame in which a direction is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Frame {
    /// The tool centre point.
    Tcp,
    /// The flange that carries the tool.
    ToolMount,
    /// The maker's base frame of the arm (a URDF's base link is turned by half a turn against it).
    Base,
}

/// A signed axis of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Axis {
    /// +x
    PlusX,
    /// -x
    MinusX,
    /// +y
    PlusY,
    /// -y
    MinusY,
    /// +z
    PlusZ,
    /// -z
    MinusZ,
}

impl Axis {
    /// The unit vector of this axis.
    #[must_use]
    pub fn unit(self) -> Vector3<f64> {
        match self {
            Self::PlusX => Vector3::new(1.0, 0.0, 0.0),
            Self::MinusX => Vector3::new(-1.0, 0.0, 0.0),
            Self::PlusY => Vector3::new(0.0, 1.0, 0.0),
            Self::MinusY => Vector3::new(0.0, -1.0, 0.0),
            Self::PlusZ => Vector3::new(0.0, 0.0, 1.0),
            Self::MinusZ => Vector3::new(0.0, 0.0, -1.0),
        }
    }
}
