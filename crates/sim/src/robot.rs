//! The bodies of the arm's links, and how far a turn of a joint can carry them.
//!
//! Links are bars with round ends, as thick as the maker's housings. Knows no obstacles.

use crate::collision::Body;
use crate::kinematics::{A2_M, A3_M, D4_M, D5_M, D6_M, LinkFrames};
use nalgebra::Vector3;
use obverse_geometry::JOINT_COUNT;

/// What each link is called.
pub(crate) const LINK_NAMES: [&str; JOINT_COUNT] =
    ["shoulder", "upper arm", "forearm", "wrist 1", "wrist 2", "wrist 3"];

/// How far the upper arm is from the plane of the shoulder, along the normal, in metres.
const UPPER_ARM_ASIDE_M: f64 = 0.136;
/// How far the forearm is from it.
const FOREARM_ASIDE_M: f64 = 0.016_5;
/// How much of the last link is thick.
const WRIST_3_M: f64 = 0.044;
/// The radius of each link, in metres.
const RADII_M: [f64; JOINT_COUNT] = [0.060, 0.058, 0.045, 0.045, 0.045, 0.038];

/// Where the axis of each joint lies along the chain of links, in metres.
const ALONG_M: [f64; JOINT_COUNT] =
    [0.0, 0.0, -A2_M, -A2_M - A3_M, -A2_M - A3_M + D4_M, -A2_M - A3_M + D4_M + D5_M];
/// The farthest point of each link from the axis of its own joint, without its radius.
const LENGTHS_M: [f64; JOINT_COUNT] = [UPPER_ARM_ASIDE_M, 0.447, 0.393, D4_M, D5_M, WRIST_3_M];

/// The body of a link, in the base frame.
pub(crate) fn link(index: usize, frames: &LinkFrames) -> Body {
    Body::bar(link_ends_m(index, frames), RADII_M[index.min(JOINT_COUNT - 1)])
}

/// The ends of the axis of a link's bar.
pub(crate) fn link_ends_m(index: usize, frames: &LinkFrames) -> [Vector3<f64>; 2] {
    let aside = frames.normal * UPPER_ARM_ASIDE_M;
    let inside = frames.normal * FOREARM_ASIDE_M;
    match index {
        0 => [frames.shoulder_m, frames.shoulder_m + aside],
        1 => [frames.shoulder_m + aside, frames.elbow_m + aside],
        2 => [frames.elbow_m + inside, frames.wrist_m + inside],
        3 => [frames.wrist_m + inside, frames.wrist_1_m],
        4 => [frames.wrist_1_m, frames.wrist_2_m],
        _ => {
            let out = frames.mount.rotation.column(2) * WRIST_3_M;
            [frames.wrist_2_m, frames.wrist_2_m + out]
        }
    }
}

/// An upper bound on the way of any point of a link when each joint turns by an angle, in
/// millimetres.
pub(crate) fn link_way_mm(index: usize, turns_rad: &[f64; JOINT_COUNT]) -> f64 {
    way_mm(index, LENGTHS_M[index] + RADII_M[index], turns_rad)
}

/// The same for a point that the tool mount carries, at most `extent_mm` away from the mount.
pub(crate) fn mount_way_mm(extent_mm: f64, turns_rad: &[f64; JOINT_COUNT]) -> f64 {
    way_mm(JOINT_COUNT - 1, D6_M + extent_mm * 1e-3, turns_rad)
}

fn way_mm(index: usize, extent_m: f64, turns_rad: &[f64; JOINT_COUNT]) -> f64 {
    let joints = ALONG_M.iter().zip(turns_rad).take(index + 1);
    joints.map(|(along, turn)| turn.abs() * (ALONG_M[index] - along + extent_m) * 1e3).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::links;
    use crate::random::{Stream, signed};
    use obverse_geometry::JointConfiguration;

    #[test]
    fn no_link_moves_farther_than_its_bound() {
        for number in 0..2_000_u64 {
            let draw = |axis| signed(21, Stream::Dice, number * 12 + axis);
            let joints: [f64; 6] = std::array::from_fn(|axis| 3.0 * draw(axis as u64));
            let turns: [f64; 6] = std::array::from_fn(|axis| 0.1 * draw(6 + axis as u64));
            let after: [f64; 6] = std::array::from_fn(|axis| joints[axis] + turns[axis]);
            let (before, after) =
                (links(&JointConfiguration(joints)), links(&JointConfiguration(after)));
            let ends = |frames: &LinkFrames| -> Vec<Vector3<f64>> {
                vec![frames.elbow_m, frames.wrist_m, frames.wrist_1_m, frames.wrist_2_m]
            };
            for (link, (a, b)) in (1..).zip(ends(&before).iter().zip(ends(&after))) {
                let way_mm = (a - b).norm() * 1e3;
                assert!(way_mm <= link_way_mm(link, &turns), "link {link}: {way_mm} mm");
            }
            let tip = |frames: &LinkFrames| {
                frames.mount.displaced(frames.mount.rotation * Vector3::new(0.1, 0.0, 0.2))
            };
            let way_mm = (tip(&before).translation_m - tip(&after).translation_m).norm() * 1e3;
            assert!(way_mm <= mount_way_mm(224.0, &turns), "tip: {way_mm} mm");
        }
    }
}
