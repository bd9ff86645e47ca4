//! The only place that says when two numbers count as equal.

use crate::Pose;

/// Positions closer than this are the same place, in metres.
pub const POSITION_M: f64 = 1e-9;
/// Orientations closer than this are the same, in radians.
pub const ANGLE_RAD: f64 = 1e-9;

/// The distance between two poses: metres between the origins, radians between the orientations.
#[must_use]
pub fn pose_distance(a: &Pose, b: &Pose) -> (f64, f64) {
    let position_m = (a.translation_m - b.translation_m).norm();
    let relative = a.rotation.transpose() * b.rotation;
    // Taken from the antisymmetric part, since the trace loses half the digits near zero.
    let sin = 0.5
        * libm::sqrt(
            (relative[(2, 1)] - relative[(1, 2)]).powi(2)
                + (relative[(0, 2)] - relative[(2, 0)]).powi(2)
                + (relative[(1, 0)] - relative[(0, 1)]).powi(2),
        );
    let cos = 0.5 * (relative.trace() - 1.0);
    (position_m, libm::atan2(sin, cos))
}

/// Whether two poses are the same within [`POSITION_M`] and [`ANGLE_RAD`].
#[must_use]
pub fn same_pose(a: &Pose, b: &Pose) -> bool {
    let (position_m, angle_rad) = pose_distance(a, b);
    position_m <= POSITION_M && angle_rad <= ANGLE_RAD
}
