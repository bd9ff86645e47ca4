//! The kinematics of a UR5: where the links are for given joints, and all joints for a given mount.
//!
//! Frames follow the maker: `base` has z up and is the frame of all poses (a URDF's base link is
//! turned by half a turn about z against it). Joints 2, 3 and 4 have parallel axes, so in the plane
//! of the arm only the sums q2+q3 and q2+q3+q4 occur; both directions are written out in closed
//! form on that fact. Knows nothing of limits, time, tools or obstacles. Metres and radians;
//! trigonometry is `libm`'s, so that results are the same bits on every machine.
//!
//! With `r`, `v` the horizontal and vertical direction of the arm's plane and `n` its normal,
//! the wrist frames are
//!
//! ```text
//! r = (cos q1, sin q1, 0)   n = (sin q1, -cos q1, 0)   v = (0, 0, 1)
//! x4 =  cos q234 r + sin q234 v        z4 = sin q234 r - cos q234 v
//! x5 =  cos q5 x4 + sin q5 n           z5 = -sin q5 x4 + cos q5 n
//! x6 =  cos q6 x5 - sin q6 z4          y6 = -sin q6 x5 - cos q6 z4          z6 = z5
//! p6 = (D1 + a2 sin q2 + a3 sin q23) v + (a2 cos q2 + a3 cos q23) r + D4 n + D5 z4 + D6 z6
//! ```

use nalgebra::{Matrix3, Vector3};
use obverse_geometry::{JointConfiguration, Pose};
use std::f64::consts::{PI, TAU};

/// Height of the shoulder axis over the base, in metres.
pub const D1_M: f64 = 0.089_159;
/// Length of the upper arm, in metres; negative as in the maker's table.
pub const A2_M: f64 = -0.425;
/// Length of the forearm, in metres; negative as in the maker's table.
pub const A3_M: f64 = -0.392_25;
/// Offset of the wrist from the shoulder along the axes of joints 2 to 4, in metres.
pub const D4_M: f64 = 0.109_15;
/// From the axis of joint 4 to that of joint 6, in metres.
pub const D5_M: f64 = 0.094_65;
/// From the axis of joint 5 to the tool mount, in metres.
pub const D6_M: f64 = 0.082_3;

/// The sine of joint 5 below which joints 4 and 6 turn about one line and joint 6 is free.
const WRIST_SINGULAR: f64 = 1e-10;
/// How far beyond its range a cosine may be and still mean a stretched arm: rounding only.
const ROUNDING: f64 = 1e-12;

/// Where the joints' frames are, in the base frame: what a collision model hangs its shapes on.
#[derive(Clone, Copy, Debug)]
pub struct LinkFrames {
    /// Along the axes of joints 2, 3 and 4.
    pub normal: Vector3<f64>,
    /// On the axis of joint 1, at the height of the shoulder.
    pub shoulder_m: Vector3<f64>,
    /// On the axis of joint 3, in the plane of the shoulder.
    pub elbow_m: Vector3<f64>,
    /// On the axis of joint 4, in the plane of the shoulder.
    pub wrist_m: Vector3<f64>,
    /// Where the axes of joints 4 and 5 meet.
    pub wrist_1_m: Vector3<f64>,
    /// Where the axes of joints 5 and 6 meet.
    pub wrist_2_m: Vector3<f64>,
    /// The tool mount.
    pub mount: Pose,
}

/// The pose of the tool mount.
#[must_use]
pub fn forward(joints: &JointConfiguration) -> Pose {
    links(joints).mount
}

/// The frames of all links.
#[must_use]
#[inline]
pub fn links(joints: &JointConfiguration) -> LinkFrames {
    let [q1, q2, q3, q4, q5, q6] = joints.0;
    let (s1, c1) = libm::sincos(q1);
    let (s2, c2) = libm::sincos(q2);
    let (s23, c23) = libm::sincos(q2 + q3);
    let (s234, c234) = libm::sincos(q2 + q3 + q4);
    let (s5, c5) = libm::sincos(q5);
    let (s6, c6) = libm::sincos(q6);
    let radial = Vector3::new(c1, s1, 0.0);
    let normal = Vector3::new(s1, -c1, 0.0);
    let up = Vector3::z();
    let x4 = radial * c234 + up * s234;
    let z4 = radial * s234 - up * c234;
    let x5 = x4 * c5 + normal * s5;
    let z5 = normal * c5 - x4 * s5;
    let shoulder_m = up * D1_M;
    let elbow_m = shoulder_m + radial * (A2_M * c2) + up * (A2_M * s2);
    let wrist_m = elbow_m + radial * (A3_M * c23) + up * (A3_M * s23);
    let wrist_1_m = wrist_m + normal * D4_M;
    let wrist_2_m = wrist_1_m + z4 * D5_M;
    let rotation = Matrix3::from_columns(&[x5 * c6 - z4 * s6, -x5 * s6 - z4 * c6, z5]);
    let mount = Pose { rotation, translation_m: wrist_2_m + z5 * D6_M };
    LinkFrames { normal, shoulder_m, elbow_m, wrist_m, wrist_1_m, wrist_2_m, mount }
}

/// One of the eight ways to reach a pose: a choice each for shoulder, wrist and elbow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Branch(u8);

impl Branch {
    /// All eight.
    pub const ALL: [Self; 8] =
        [Self(0), Self(1), Self(2), Self(3), Self(4), Self(5), Self(6), Self(7)];

    /// The branch that a configuration is on.
    #[must_use]
    pub fn of(joints: &JointConfiguration) -> Self {
        let [_, q2, q3, q4, q5, _] = joints.0;
        // The wrist's distance from the axis of joint 1 in the plane of the arm tells the two
        // shoulders apart: p5 = X r + D4 n, so the sine of q1 against p5 has the sign of -X.
        let (s5, _) = libm::sincos(q5);
        let (s3, _) = libm::sincos(q3);
        let reach =
            A2_M * libm::cos(q2) + A3_M * libm::cos(q2 + q3) + D5_M * libm::sin(q2 + q3 + q4);
        Self(u8::from(reach < 0.0) << 2 | u8::from(s5 < 0.0) << 1 | u8::from(s3 < 0.0))
    }

    fn shoulder_behind(self) -> bool {
        self.0 & 4 != 0
    }

    fn wrist_flipped(self) -> bool {
        self.0 & 2 != 0
    }

    fn elbow_negative(self) -> bool {
        self.0 & 1 != 0
    }
}

/// All joint configurations that reach a pose, at most eight.
#[derive(Clone, Copy, Debug)]
pub struct Solutions {
    joints: [JointConfiguration; 8],
    count: usize,
}

impl Solutions {
    /// The solutions, in a fixed order.
    #[must_use]
    pub fn as_slice(&self) -> &[JointConfiguration] {
        &self.joints[..self.count]
    }

    fn push(&mut self, joints: JointConfiguration) {
        self.joints[self.count] = joints;
        self.count += 1;
    }
}

/// All configurations whose tool mount is at `mount`, each joint turned to within half a turn of
/// `reference`.
///
/// Where the wrist is singular (joints 4 and 6 turn about one line) joint 6 keeps its value in
/// `reference`, and the two wrists are one. Empty when the pose is out of reach.
#[must_use]
pub fn inverse(mount: &Pose, reference: &JointConfiguration) -> Solutions {
    let mut found = Solutions { joints: [JointConfiguration::ZERO; 8], count: 0 };
    for behind in [false, true] {
        let Some(shoulder) = Shoulder::solve(mount, behind) else { continue };
        let wrists: &[bool] = if shoulder.wrist_is_singular() { &[false] } else { &[false, true] };
        for &flipped in wrists {
            let wrist = shoulder.wrist(mount, flipped, reference.0[5]);
            for negative in [false, true] {
                if let Some(joints) = wrist.elbow(&shoulder, negative) {
                    found.push(turned_near(joints, reference));
                }
            }
        }
    }
    found
}

/// The configuration of one branch whose tool mount is at `mount`, each joint turned to within half
/// a turn of `reference`.
#[must_use]
pub fn inverse_on_branch(
    mount: &Pose,
    branch: Branch,
    reference: &JointConfiguration,
) -> Option<JointConfiguration> {
    let shoulder = Shoulder::solve(mount, branch.shoulder_behind())?;
    let wrist = shoulder.wrist(mount, branch.wrist_flipped(), reference.0[5]);
    let joints = wrist.elbow(&shoulder, branch.elbow_negative())?;
    Some(turned_near(joints, reference))
}

/// Joint 1, and the mount as the plane of the arm sees it.
struct Shoulder {
    q1: f64,
    radial: Vector3<f64>,
    normal: Vector3<f64>,
    /// Where the axes of joints 5 and 6 meet.
    wrist_2_m: Vector3<f64>,
    /// The normal of the arm's plane in the frame of the mount.
    normal_in_mount: Vector3<f64>,
    /// The absolute sine of joint 5.
    sin_wrist: f64,
}

impl Shoulder {
    fn solve(mount: &Pose, behind: bool) -> Option<Self> {
        let wrist_2_m = mount.translation_m - mount.rotation.column(2) * D6_M;
        let (x, y) = (wrist_2_m.x, wrist_2_m.y);
        let squared = x * x + y * y;
        let reach_squared = squared - D4_M * D4_M;
        if reach_squared < -ROUNDING * squared {
            return None;
        }
        // n . p = D4 and r . p = reach, by components, without a detour over angles.
        let reach = reach_squared.max(0.0).sqrt() * if behind { -1.0 } else { 1.0 };
        let cos = (reach * x - D4_M * y) / squared;
        let sin = (reach * y + D4_M * x) / squared;
        let normal = Vector3::new(sin, -cos, 0.0);
        let normal_in_mount = mount.rotation.tr_mul(&normal);
        let sin_wrist =
            (normal_in_mount.x * normal_in_mount.x + normal_in_mount.y * normal_in_mount.y).sqrt();
        Some(Self {
            q1: libm::atan2(sin, cos),
            radial: Vector3::new(cos, sin, 0.0),
            normal,
            wrist_2_m,
            normal_in_mount,
            sin_wrist,
        })
    }

    fn wrist_is_singular(&self) -> bool {
        self.sin_wrist < WRIST_SINGULAR
    }

    fn wrist(&self, mount: &Pose, flipped: bool, reference_q6: f64) -> Wrist {
        let sign = if flipped { -1.0 } else { 1.0 };
        let (q6, sin6, cos6) = if self.wrist_is_singular() {
            let (sin, cos) = libm::sincos(reference_q6);
            (reference_q6, sin, cos)
        } else {
            let sin = -sign * self.normal_in_mount.y / self.sin_wrist;
            let cos = sign * self.normal_in_mount.x / self.sin_wrist;
            (libm::atan2(sin, cos), sin, cos)
        };
        let z4 = -(mount.rotation.column(0) * sin6 + mount.rotation.column(1) * cos6);
        let q234 = libm::atan2(z4.dot(&self.radial), -z4.z);
        let q5 = libm::atan2(sign * self.sin_wrist, self.normal_in_mount.z);
        let wrist_m = self.wrist_2_m - z4 * D5_M - self.normal * D4_M;
        Wrist { q5, q6, q234, across_m: wrist_m.dot(&self.radial), up_m: wrist_m.z - D1_M }
    }
}

/// Joints 5 and 6, and what is left for joints 2 to 4: a plane arm of two links.
struct Wrist {
    q5: f64,
    q6: f64,
    q234: f64,
    across_m: f64,
    up_m: f64,
}

impl Wrist {
    fn elbow(&self, shoulder: &Shoulder, negative: bool) -> Option<JointConfiguration> {
        let squared = self.across_m * self.across_m + self.up_m * self.up_m;
        let cos3 = (squared - A2_M * A2_M - A3_M * A3_M) / (2.0 * A2_M * A3_M);
        if cos3.abs() > 1.0 + ROUNDING {
            return None;
        }
        let cos3 = cos3.clamp(-1.0, 1.0);
        let sin3 = (1.0 - cos3 * cos3).sqrt() * if negative { -1.0 } else { 1.0 };
        let q3 = libm::atan2(sin3, cos3);
        let (along, aside) = (A2_M + A3_M * cos3, A3_M * sin3);
        // atan2 of the difference of two angles, by the components of their quotient.
        let q2 = libm::atan2(
            self.up_m * along - self.across_m * aside,
            self.across_m * along + self.up_m * aside,
        );
        let q4 = self.q234 - q2 - q3;
        Some(JointConfiguration([shoulder.q1, q2, q3, q4, self.q5, self.q6]))
    }
}

/// Each joint moved by whole turns to within half a turn of the reference.
fn turned_near(joints: JointConfiguration, reference: &JointConfiguration) -> JointConfiguration {
    let mut turned = joints.0;
    for (joint, near) in turned.iter_mut().zip(reference.0) {
        let away = near - *joint;
        if away.abs() > PI {
            *joint += libm::round(away / TAU) * TAU;
        }
    }
    JointConfiguration(turned)
}

#[cfg(test)]
mod tests;
