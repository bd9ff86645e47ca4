//! The numbers of a workcell file, each checked where it is read.
//!
//! A number out of range (or not a number) is refused by the reader itself, which knows its place
//! in the file. Knows the ranges; knows nothing of what is built from the numbers.

use serde::Deserialize;

/// How it is said that a number is out of range.
pub(super) const MUST_BE_FROM: &str = "it must be from";

/// Defines a checked number: its name, what to call it, and the closed range it must lie in.
macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident, $what:literal, $low:expr, $high:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(try_from = "f64")]
        pub(super) struct $name(pub(super) f64);

        impl TryFrom<f64> for $name {
            type Error = String;

            fn try_from(value: f64) -> Result<Self, String> {
                let (low, high): (f64, f64) = ($low, $high);
                if value >= low && value <= high {
                    Ok(Self(value))
                } else {
                    Err(format!("{value} is not {}: {MUST_BE_FROM} {low} to {high}", $what))
                }
            }
        }
    )*};
}

numbers! {
    /// A coordinate in millimetres.
    CoordinateMm, "a coordinate in mm", -10_000.0, 10_000.0;
    /// A component of a rotation vector in degrees.
    TurnDeg, "a rotation in degrees", -360.0, 360.0;
    /// A joint angle in degrees.
    JointDeg, "a joint angle in degrees", -720.0, 720.0;
    /// A joint angle in radians.
    JointRad, "a joint angle in radians", -4.0 * std::f64::consts::PI, 4.0 * std::f64::consts::PI;
    /// The size of a body in millimetres.
    SizeMm, "a size in mm", 0.01, 10_000.0;
    /// The width of a chamfer in millimetres.
    ChamferMm, "the width of a chamfer in mm", 0.0, 100.0;
    /// A spread of positions in millimetres.
    SpreadMm, "a spread in mm", 0.0, 1_000.0;
    /// A spread of orientations in degrees.
    SpreadDeg, "a spread in degrees", 0.0, 180.0;
    /// How near the gripper must be, in millimetres.
    NearMm, "a distance in mm", 0.0, 1_000.0;
    /// How near in orientation the gripper must be, in degrees.
    NearDeg, "an angle in degrees", 0.0, 180.0;
    /// A speed of the tool in millimetres a second.
    ToolSpeedMmPerS, "a tool speed in mm/s", 0.1, 3_000.0;
    /// A speed of a joint in degrees a second.
    JointSpeedDegPerS, "a joint speed in deg/s", 0.1, 720.0;
    /// An acceleration of the tool in millimetres a second squared.
    ToolAccelerationMmPerS2, "a tool acceleration in mm/s2", 1.0, 100_000.0;
    /// An acceleration of a joint in degrees a second squared.
    JointAccelerationDegPerS2, "a joint acceleration in deg/s2", 1.0, 10_000.0;
    /// The lead of a thread in millimetres a turn; none for a bayonet.
    PitchMm, "a pitch in mm", 0.0, 100.0;
    /// A number of turns.
    Turns, "a number of turns", 0.01, 1_000.0;
    /// How a force grows with an angle, in newtons a degree.
    TighteningNPerDeg, "a force in N a degree", 0.01, 10_000.0;
    /// A time in seconds.
    TimeS, "a time in s", 0.0, 86_400.0;
    /// A stiffness in newtons a millimetre.
    StiffnessNPerMm, "a stiffness in N/mm", 0.01, 100_000.0;
    /// A stiffness in newton metres a degree.
    StiffnessNmPerDeg, "a stiffness in Nm/deg", 0.01, 100_000.0;
    /// A coefficient of friction. At 1 a chamfer of 45 degrees lets nothing pass.
    Friction, "a coefficient of friction", 0.0, 0.9;
    /// A force in newtons, not negative.
    ForceN, "a force in N", 0.0, 10_000.0;
    /// A force that something must exceed, in newtons.
    ForceLimitN, "a force limit in N", 0.1, 10_000.0;
    /// The bias of a sensor in newtons.
    BiasN, "a bias in N", -1_000.0, 1_000.0;
    /// A probability.
    Probability, "a probability", 0.0, 1.0;
    /// The time between two samples of a sensor in seconds.
    SampleS, "a sampling time in s", 0.000_5, 1.0;
}
