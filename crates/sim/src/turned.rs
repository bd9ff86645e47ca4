//! Turns of the tool: where one ends, and how many whole turns are left to go.
//!
//! A pose forgets whole turns; joint 6 does not. Knows nothing of speed or obstacles.

use crate::cell::ToolSpec;
use crate::kinematics::forward;
use crate::limits::Ranges;
use crate::line::{Line, turn_between};
use nalgebra::Vector3;
use obverse_geometry::{Frame, JointConfiguration, Pose};
use obverse_workcell::Fault;
use std::f64::consts::TAU;

/// No arm of this kind turns its tool further than this, in radians.
pub(crate) const ANGLE_RAD_MAX: f64 = 4.0 * TAU;
/// A shorter turn than this is none, in radians.
const NO_TURN_RAD: f64 = 1e-9;

/// The last joint.
const WRIST_3: usize = 5;

/// A turn about an axis of the tool, and the way along it meanwhile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    pub(crate) angle_rad: f64,
    pub(crate) advance_m: f64,
    /// In the frame it is given in.
    pub(crate) axis: Vector3<f64>,
    pub(crate) frame: Frame,
}

impl Turn {
    /// Where the tool centre point and the joints are after all of the turn from `from`: exactly
    /// there for no turn.
    ///
    /// # Errors
    /// What the arm cannot follow.
    pub(crate) fn end(
        &self,
        from: &JointConfiguration,
        tool: &ToolSpec,
        ranges: &Ranges,
    ) -> Result<(Pose, JointConfiguration), Fault> {
        let mount = forward(from);
        let start = mount.compose(&tool.tcp);
        if self.angle_rad == 0.0 && self.advance_m == 0.0 {
            return Ok((start, *from));
        }
        let axis = match self.frame {
            Frame::Tcp => start.rotation * self.axis,
            Frame::ToolMount => mount.rotation * self.axis,
            Frame::Base => self.axis,
        };
        let turn_rad = start.rotation.tr_mul(&axis) * self.angle_rad;
        let way = (axis * self.advance_m, turn_rad);
        let line = Line::turning(from, start, way, &tool.tcp, ranges)?;
        let mut pose = start.displaced(way.0);
        pose.rotation *= Pose::from_rotation_vector([0.0; 3], turn_rad.into()).rotation;
        Ok((pose, line.end()))
    }
}

/// The turn of the tool centre point from `start` to `goal`, axis times angle in the frame of the
/// start, if it takes whole turns beside the shorter way to bring joint 6 to where it shall end.
pub(crate) fn whole_turn(
    joints: &JointConfiguration,
    start: &Pose,
    goal: &Pose,
    end: &JointConfiguration,
    tool: &ToolSpec,
) -> Option<Vector3<f64>> {
    let shortest = turn_between(start, goal);
    let by_wrist = end.0[WRIST_3] - joints.0[WRIST_3];
    let wrist_axis = tool.tcp.rotation.tr_mul(&Vector3::z());
    let angle = shortest.norm();
    let axis = if angle < NO_TURN_RAD { wrist_axis } else { shortest / angle };
    let along = axis.dot(&wrist_axis);
    if along.abs() < 0.5 {
        return None;
    }
    let turns = libm::round((by_wrist * along.signum() - angle) / TAU);
    (turns != 0.0).then(|| axis * (angle + turns * TAU))
}
