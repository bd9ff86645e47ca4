//! A pose: where a frame is and how it is turned.
//!
//! Kept as a 3x3 rotation matrix and a translation, since forward kinematics multiplies matrices.
//! Knows nothing of joints.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// A rigid transform: rotation matrix and translation in metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "[f64; 12]", from = "[f64; 12]")]
pub struct Pose {
    /// Orthonormal, right-handed.
    pub rotation: Matrix3<f64>,
    /// In metres.
    pub translation_m: Vector3<f64>,
}

impl From<Pose> for [f64; 12] {
    /// The rotation column by column, then the translation.
    fn from(pose: Pose) -> Self {
        let numbers = pose.rotation.iter().chain(&pose.translation_m);
        let mut all = [0.0; 12];
        all.iter_mut().zip(numbers).for_each(|(place, number)| *place = *number);
        all
    }
}

impl From<[f64; 12]> for Pose {
    fn from(numbers: [f64; 12]) -> Self {
        let (rotation, translation_m) = numbers.split_at(9);
        Self {
            rotation: Matrix3::from_column_slice(rotation),
            translation_m: Vector3::from_column_slice(translation_m),
        }
    }
}

impl Pose {
    /// The identity.
    #[must_use]
    pub fn identity() -> Self {
        Self { rotation: Matrix3::identity(), translation_m: Vector3::zeros() }
    }

    /// From x, y, z in metres and a rotation vector (axis times angle) in radians, as the maker of
    /// the arm and the workcell file write poses.
    #[must_use]
    pub fn from_rotation_vector(xyz_m: [f64; 3], rotation_vector_rad: [f64; 3]) -> Self {
        let [x, y, z] = rotation_vector_rad;
        let angle = libm::sqrt(x * x + y * y + z * z);
        let rotation = if angle < 1e-12 {
            Matrix3::identity()
        } else {
            let (sin, cos) = libm::sincos(angle);
            let (ux, uy, uz) = (x / angle, y / angle, z / angle);
            let one = 1.0 - cos;
            Matrix3::new(
                cos + ux * ux * one,
                ux * uy * one - uz * sin,
                ux * uz * one + uy * sin,
                uy * ux * one + uz * sin,
                cos + uy * uy * one,
                uy * uz * one - ux * sin,
                uz * ux * one - uy * sin,
                uz * uy * one + ux * sin,
                cos + uz * uz * one,
            )
        };
        Self { rotation, translation_m: Vector3::from(xyz_m) }
    }

    /// The rotation as a rotation vector (axis times angle) in radians, of a length of at most half
    /// a turn; zero for a rotation that is nothing but rounding.
    #[must_use]
    pub fn rotation_vector_rad(&self) -> [f64; 3] {
        let m = &self.rotation;
        let twice_sine =
            Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]);
        let sin = 0.5 * twice_sine.norm();
        let cos = 0.5 * (m.trace() - 1.0);
        let angle = libm::atan2(sin, cos);
        if angle < 1e-12 {
            return [0.0; 3];
        }
        if cos > 0.0 || sin > 1e-6 {
            return (twice_sine * (0.5 * angle / sin)).into();
        }
        // Near half a turn the antisymmetric part vanishes; the symmetric part is then twice the
        // axis times itself, less the identity, and its longest column shows the axis best.
        let longest = m.diagonal().imax();
        let mut axis = ((m + m.transpose()) * 0.5).column(longest).into_owned();
        axis[longest] += 1.0;
        let sign = if twice_sine.dot(&axis) < 0.0 { -1.0 } else { 1.0 };
        (axis.normalize() * (sign * angle)).into()
    }

    /// `self` followed by `inner`: the pose of a frame given in this one.
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            translation_m: self.rotation * inner.translation_m + self.translation_m,
        }
    }

    /// The inverse transform.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation_m: -(rotation * self.translation_m) }
    }

    /// The same orientation, displaced by a vector given in the parent frame.
    #[must_use]
    pub fn displaced(&self, by_m: Vector3<f64>) -> Self {
        Self { rotation: self.rotation, translation_m: self.translation_m + by_m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tolerance::{pose_distance, same_pose};
    use std::f64::consts::PI;

    #[test]
    fn a_rotation_vector_comes_back_up_to_half_a_turn() {
        for axis in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.0, 0.8], [-0.48, 0.6, -0.64]] {
            for angle in [1e-9, 1e-3, 1.0, 3.0, PI - 1e-4, PI - 1e-9, PI] {
                let vector = axis.map(|component: f64| component * angle);
                let pose = Pose::from_rotation_vector([0.0; 3], vector);
                let back = Pose::from_rotation_vector([0.0; 3], pose.rotation_vector_rad());
                let (_, away) = pose_distance(&pose, &back);
                assert!(away < 1e-9, "{axis:?} by {angle}: {away}");
            }
        }
        assert_eq!(Pose::identity().rotation_vector_rad(), [0.0; 3]);
    }

    #[test]
    fn a_pose_and_its_inverse_are_nothing() {
        let pose = Pose::from_rotation_vector([0.1, -0.2, 0.3], [0.4, 1.5, -0.6]);
        assert!(same_pose(&pose.compose(&pose.inverse()), &Pose::identity()));
        assert!(same_pose(&pose.inverse().compose(&pose), &Pose::identity()));
    }

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let pose = Pose::from_rotation_vector([1.0, 0.0, 0.0], [0.0, 0.0, PI / 2.0]);
        let point = pose.compose(&Pose::identity().displaced(Vector3::x())).translation_m;
        assert!((point - Vector3::new(1.0, 1.0, 0.0)).norm() < 1e-15);
    }
}
