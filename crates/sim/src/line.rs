//! Straight lines of the tool centre point, followed by the joints.
//!
//! A line is a pose at each fraction of the way; the joints are found by the closed-form inverse on
//! the branch that the line starts on, from knot to knot, and refused where they would have to
//! jump. Knows nothing of time or obstacles.

use crate::kinematics::{Branch, inverse, inverse_on_branch};
use crate::limits::{self, Ranges};
use nalgebra::Vector3;
use obverse_geometry::{JointConfiguration, Pose};
use obverse_workcell::Fault;

/// The way of the tool centre point between two knots, at most, in metres.
const KNOT_M: f64 = 0.05;
/// The turn of the tool between two knots, at most, in radians.
const KNOT_RAD: f64 = 0.2;
/// The turn of a joint between two knots, at most, in radians.
const JOINT_STEP_RAD: f64 = 0.2;
/// How often the way between two knots is halved before the line counts as singular.
const HALVINGS_MAX: u32 = 9;

/// A configuration on the line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Knot {
    pub(crate) fraction: f64,
    pub(crate) joints: JointConfiguration,
}

/// A straight line of the tool centre point.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    start: Pose,
    shift_m: Vector3<f64>,
    /// Axis times angle of the whole turn, in the frame of the start.
    turn_rad: Vector3<f64>,
    /// The tool mount in the frame of the tool centre point.
    mount_in_tcp: Pose,
    branch: Branch,
    knots: Vec<Knot>,
}

impl Line {
    /// The line from where the tool centre point `tcp` is with the joints at `from`, to `goal`.
    ///
    /// # Errors
    /// A point that is out of reach, out of a joint's range, or too near a singularity.
    pub(crate) fn follow(
        from: &JointConfiguration,
        start: Pose,
        goal: &Pose,
        tcp: &Pose,
        ranges: &Ranges,
    ) -> Result<Self, Fault> {
        let shift_m = goal.translation_m - start.translation_m;
        Self::turning(from, start, (shift_m, turn_between(&start, goal)), tcp, ranges)
    }

    /// The line along a shift, in the base frame, and a turn meanwhile, axis times angle in the
    /// frame of the start: a helix if they have one axis. Whole turns count.
    ///
    /// # Errors
    /// As of [`follow`](Self::follow).
    pub(crate) fn turning(
        from: &JointConfiguration,
        start: Pose,
        (shift_m, turn_rad): (Vector3<f64>, Vector3<f64>),
        tcp: &Pose,
        ranges: &Ranges,
    ) -> Result<Self, Fault> {
        let mut line = Self {
            start,
            shift_m,
            turn_rad,
            mount_in_tcp: tcp.inverse(),
            branch: Branch::of(from),
            knots: Vec::with_capacity(32),
        };
        line.knots.push(Knot { fraction: 0.0, joints: *from });
        line.track(ranges)?;
        Ok(line)
    }

    /// The length of the way of the tool centre point, in metres.
    pub(crate) fn length_m(&self) -> f64 {
        self.shift_m.norm()
    }

    /// The whole turn of the tool, in radians.
    pub(crate) fn angle_rad(&self) -> f64 {
        self.turn_rad.norm()
    }

    /// The whole turn of the tool about an axis of the base frame, in radians.
    pub(crate) fn turn_about_rad(&self, axis: &Vector3<f64>) -> f64 {
        (self.start.rotation * self.turn_rad).dot(axis)
    }

    /// Configurations along the line, the first at its start and the last at its end.
    pub(crate) fn knots(&self) -> &[Knot] {
        &self.knots
    }

    /// Where the joints end.
    pub(crate) fn end(&self) -> JointConfiguration {
        self.knots[self.knots.len() - 1].joints
    }

    /// The tool mount at a fraction of the way.
    pub(crate) fn mount_at(&self, fraction: f64) -> Pose {
        self.tcp_at(fraction).compose(&self.mount_in_tcp)
    }

    /// The joints at a fraction of the way.
    pub(crate) fn joints_at(&self, fraction: f64) -> JointConfiguration {
        let after = self.knots.partition_point(|knot| knot.fraction <= fraction);
        let before = &self.knots[after.max(1) - 1];
        if before.fraction == fraction {
            return before.joints;
        }
        // The neighbouring knots are reachable, so that a point between them fails by rounding
        // only, at the very edge of the reach.
        inverse_on_branch(&self.mount_at(fraction), self.branch, &before.joints)
            .unwrap_or(before.joints)
    }

    fn tcp_at(&self, fraction: f64) -> Pose {
        let mut pose = self.start.displaced(self.shift_m * fraction);
        if self.turn_rad != Vector3::zeros() {
            let turn = Pose::from_rotation_vector([0.0; 3], (self.turn_rad * fraction).into());
            pose.rotation *= turn.rotation;
        }
        pose
    }

    fn track(&mut self, ranges: &Ranges) -> Result<(), Fault> {
        let pieces = (self.length_m() / KNOT_M).max(self.angle_rad() / KNOT_RAD).ceil().max(1.0);
        let whole = 1.0 / pieces;
        let mut step = whole;
        let mut last = self.knots[0];
        while last.fraction < 1.0 {
            // What a rounding error leaves of the line is no piece of its own.
            let left = 1.0 - last.fraction;
            let fraction = if left <= step * 1.000_001 { 1.0 } else { last.fraction + step };
            let joints = self.solve(fraction, &last)?;
            if joints.largest_difference_rad(&last.joints) > JOINT_STEP_RAD {
                step *= 0.5;
                if step < whole / f64::from(1 << HALVINGS_MAX) {
                    return Err(Fault::Singular { fraction: last.fraction });
                }
                continue;
            }
            limits::check(&joints, ranges)?;
            last = Knot { fraction, joints };
            self.knots.push(last);
            step = (step * 2.0).min(whole);
        }
        Ok(())
    }

    fn solve(&mut self, fraction: f64, last: &Knot) -> Result<JointConfiguration, Fault> {
        let mount = self.mount_at(fraction);
        let found = if last.fraction > 0.0 {
            inverse_on_branch(&mount, self.branch, &last.joints)
        } else {
            // A start at a singularity is on two branches: the line leaves on the nearer one.
            let solutions = inverse(&mount, &last.joints);
            let nearest = nearest(solutions.as_slice(), &last.joints);
            self.branch = nearest.as_ref().map_or(self.branch, Branch::of);
            nearest
        };
        found.ok_or_else(|| Fault::OutOfReach { at_m: self.tcp_at(fraction).translation_m.into() })
    }
}

/// The turn from one pose to another by the shorter way, axis times angle in the frame of the
/// first.
pub(crate) fn turn_between(from: &Pose, to: &Pose) -> Vector3<f64> {
    from.inverse().compose(to).rotation_vector_rad().into()
}

/// The configuration with the least sum of squared differences to a reference.
pub(crate) fn nearest(
    candidates: &[JointConfiguration],
    reference: &JointConfiguration,
) -> Option<JointConfiguration> {
    let squared = |joints: &JointConfiguration| -> f64 {
        joints.0.iter().zip(reference.0).map(|(a, b)| (a - b) * (a - b)).sum()
    };
    candidates.iter().min_by(|a, b| squared(a).total_cmp(&squared(b))).copied()
}
