//! A joint configuration: what the tape records and what a move is commanded to.
//!
//! Poses do not fix the turn of the wrist, so nothing that must be restored is kept as a pose.
//! Knows nothing of limits, which belong to an arm.

use serde::{Deserialize, Serialize};

/// The number of joints of every arm this system drives.
pub const JOINT_COUNT: usize = 6;

/// Joint positions from base to wrist, in radians.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointConfiguration(pub [f64; JOINT_COUNT]);

impl JointConfiguration {
    /// All joints at zero.
    pub const ZERO: Self = Self([0.0; JOINT_COUNT]);

    /// Whether every joint value is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|joint| joint.is_finite())
    }

    /// Whether two configurations are the same bits: the comparison of all reversal laws.
    #[must_use]
    pub fn same_bits(&self, other: &Self) -> bool {
        self.bits() == other.bits()
    }

    /// The raw bits of the joint values, for digests and comparison.
    #[must_use]
    pub fn bits(&self) -> [u64; JOINT_COUNT] {
        self.0.map(f64::to_bits)
    }

    /// The configuration a fraction of the way to `goal` along a straight line in joint space;
    /// exactly `self` at 0 and exactly `goal` at 1.
    #[must_use]
    pub fn towards(&self, goal: &Self, fraction: f64) -> Self {
        if fraction <= 0.0 {
            return *self;
        }
        if fraction >= 1.0 {
            return *goal;
        }
        let mut joints = self.0;
        for (joint, end) in joints.iter_mut().zip(goal.0) {
            *joint += (end - *joint) * fraction;
        }
        Self(joints)
    }

    /// The largest absolute difference of any joint, in radians.
    #[must_use]
    pub fn largest_difference_rad(&self, other: &Self) -> f64 {
        self.0.iter().zip(other.0).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}
