//! From a commanded motion to a route: where the joints are at each fraction of the way, and when.
//!
//! Everything about a motion that can be refused before anything moves is refused here. Knows
//! nothing of contact.

use crate::cell::{Cell, SpeedSpec, ToolSpec};
use crate::kinematics::{forward, inverse};
use crate::limits;
use crate::line::{Line, nearest};
use crate::profile::Profile;
use crate::turned::{self, Turn};
use nalgebra::{Matrix3, Vector3};
use obverse_geometry::{Frame, JOINT_COUNT, JointConfiguration, Pose};
use obverse_workcell::{Fault, Goal, Motion, Path, Speed, ToolId};

/// No arm of this kind goes further than this, in metres.
const FAR_M: f64 = 10.0;
/// No goal is farther away from the base than this, in metres.
const GOAL_FAR_M: f64 = 1_000.0;
/// How far a rotation matrix may be from orthonormal.
const ORTHONORMAL: f64 = 1e-6;
/// How near the joints at the end of a line must come to those it was commanded to, in radians.
const SAME_JOINTS_RAD: f64 = 1e-6;
/// More newtons than any sensor of such an arm reads.
const FORCE_N_MAX: f64 = 100_000.0;

/// The way of a motion.
#[derive(Clone, Debug)]
pub(crate) struct Route {
    pub(crate) from: JointConfiguration,
    pub(crate) to: JointConfiguration,
    /// What the distance of the report counts from.
    pub(crate) origin: JointConfiguration,
    pub(crate) profile: Profile,
    pub(crate) line: Option<Line>,
}

impl Route {
    /// The route of a motion from where the joints are.
    pub(crate) fn plan(
        cell: &Cell,
        joints: &JointConfiguration,
        motion: &Motion,
    ) -> Result<Self, Fault> {
        let tool = tool(cell, motion.tool)?;
        check_force(motion.force_limit_n)?;
        let goal = Target::of(cell, &motion.goal, joints, tool)?;
        if let Target::Joints(to) = &goal {
            limits::check(to, &cell.arm.limits_rad)?;
        }
        let speed = &cell.speeds[speed_index(motion.speed)];
        let origin = origin(&motion.goal, joints);
        match motion.path {
            Path::Joint => {
                let to = goal.joints(cell, joints, tool)?;
                let profile = joint_profile(joints, &to, speed);
                Ok(Self { from: *joints, to, origin, profile, line: None })
            }
            Path::Linear => {
                let (line, to) = goal.line(cell, joints, tool)?;
                let profile = line_profile(&line, speed);
                Ok(Self { from: *joints, to, origin, profile, line: Some(line) })
            }
        }
    }

    /// The tool mount at a fraction of the way.
    pub(crate) fn mount_at(&self, fraction: f64) -> Pose {
        match &self.line {
            Some(line) => line.mount_at(fraction),
            None => forward(&self.joints_at(fraction)),
        }
    }

    /// The whole turn of the tool about an axis of the base frame that is near that of joint 6.
    pub(crate) fn turn_about_rad(&self, axis: &Vector3<f64>) -> f64 {
        match &self.line {
            Some(line) => line.turn_about_rad(axis),
            None => {
                let wrist_axis = forward(&self.from).rotation.column(2).into_owned();
                (self.to.0[5] - self.from.0[5]) * wrist_axis.dot(axis)
            }
        }
    }

    /// The joints at a fraction of the way, exactly the ends at 0 and 1.
    pub(crate) fn joints_at(&self, fraction: f64) -> JointConfiguration {
        match &self.line {
            Some(line) if fraction > 0.0 && fraction < 1.0 => line.joints_at(fraction),
            _ => self.from.towards(&self.to, fraction),
        }
    }
}

/// The tool of a motion.
pub(crate) fn tool(cell: &Cell, id: ToolId) -> Result<&ToolSpec, Fault> {
    cell.tools
        .get(usize::from(id.0))
        .ok_or_else(|| Fault::Missing { what: format!("tool {}", id.0) })
}

fn speed_index(speed: Speed) -> usize {
    match speed {
        Speed::VerySlow => 0,
        Speed::Slow => 1,
        Speed::Normal => 2,
        Speed::Fast => 3,
        Speed::VeryFast => 4,
    }
}

fn bad(why: impl Into<String>) -> Fault {
    Fault::BadCommand { why: why.into() }
}

fn check_force(limit_n: Option<f64>) -> Result<(), Fault> {
    match limit_n {
        Some(limit) if !(limit > 0.0 && limit <= FORCE_N_MAX) => Err(bad(format!(
            "a force limit of {limit} N, which must be above 0 and at most {FORCE_N_MAX} N"
        ))),
        _ => Ok(()),
    }
}

/// The configuration that the distance to the goal counts from.
fn origin(goal: &Goal, joints: &JointConfiguration) -> JointConfiguration {
    match goal {
        Goal::Displaced { from, .. } | Goal::Offset { from, .. } | Goal::Turned { from, .. } => {
            *from
        }
        Goal::Joints(_) | Goal::Pose(_) => *joints,
    }
}

/// A goal: in joints, as a pose of the tool centre point, or after a turn as both, of which the
/// pose is exact and the joints tell the whole turns.
enum Target {
    Joints(JointConfiguration),
    Tcp(Pose),
    Turned(Pose, JointConfiguration),
}

impl Target {
    fn of(
        cell: &Cell,
        goal: &Goal,
        joints: &JointConfiguration,
        tool: &ToolSpec,
    ) -> Result<Self, Fault> {
        let origin = origin(goal, joints);
        if !origin.is_finite() {
            return Err(bad("the start of a displacement has joints that are not finite"));
        }
        match goal {
            Goal::Joints(to) if to.is_finite() => Ok(Self::Joints(*to)),
            Goal::Joints(_) => Err(bad("the goal has joints that are not finite")),
            Goal::Pose(pose) => {
                check_pose(pose)?;
                Ok(Self::Tcp(*pose))
            }
            Goal::Displaced { distance_m, axis, frame, .. } => {
                displaced(&origin, axis.unit() * *distance_m, *frame, tool)
            }
            Goal::Offset { by_m, frame, .. } => {
                displaced(&origin, Vector3::from(*by_m), *frame, tool)
            }
            Goal::Turned { angle_rad, advance_m, axis, frame, .. } => {
                check_turn(*angle_rad, *advance_m)?;
                let (angle_rad, advance_m) = (*angle_rad, *advance_m);
                let turn = Turn { angle_rad, advance_m, axis: axis.unit(), frame: *frame };
                let (pose, end) = turn.end(&origin, tool, &cell.arm.limits_rad)?;
                Ok(Self::Turned(pose, end))
            }
        }
    }

    fn tcp(&self, tool: &ToolSpec) -> Pose {
        match self {
            Self::Joints(joints) => forward(joints).compose(&tool.tcp),
            Self::Tcp(pose) | Self::Turned(pose, _) => *pose,
        }
    }

    /// The straight line there, and the joints at its end. Only a turn takes more than the shorter
    /// way around.
    fn line(
        &self,
        cell: &Cell,
        joints: &JointConfiguration,
        tool: &ToolSpec,
    ) -> Result<(Line, JointConfiguration), Fault> {
        let ranges = &cell.arm.limits_rad;
        let start = forward(joints).compose(&tool.tcp);
        let pose = self.tcp(tool);
        let turn_rad = match self {
            Self::Turned(_, end) => turned::whole_turn(joints, &start, &pose, end, tool),
            Self::Joints(_) | Self::Tcp(_) => None,
        };
        let line = match turn_rad {
            Some(turn_rad) => {
                let shift_m = pose.translation_m - start.translation_m;
                Line::turning(joints, start, (shift_m, turn_rad), &tool.tcp, ranges)?
            }
            None => Line::follow(joints, start, &pose, &tool.tcp, ranges)?,
        };
        let to = match self {
            Self::Tcp(_) => line.end(),
            Self::Joints(to) | Self::Turned(_, to) => line_end(to, &line)?,
        };
        Ok((line, to))
    }

    fn joints(
        &self,
        cell: &Cell,
        from: &JointConfiguration,
        tool: &ToolSpec,
    ) -> Result<JointConfiguration, Fault> {
        let pose = match self {
            Self::Joints(joints) | Self::Turned(_, joints) => return Ok(*joints),
            Self::Tcp(pose) => pose,
        };
        let ranges = &cell.arm.limits_rad;
        let solutions = inverse(&pose.compose(&tool.tcp.inverse()), from);
        let turned: Vec<_> = solutions
            .as_slice()
            .iter()
            .map(|solution| limits::turned_into(solution, ranges, from))
            .collect();
        let fitting: Vec<_> = turned
            .iter()
            .copied()
            .filter(|solution| limits::check(solution, ranges).is_ok())
            .collect();
        if let Some(joints) = nearest(&fitting, from) {
            return Ok(joints);
        }
        match nearest(&turned, from) {
            Some(joints) => limits::check(&joints, ranges).map(|()| joints),
            None => Err(Fault::OutOfReach { at_m: pose.translation_m.into() }),
        }
    }
}

fn displaced(
    origin: &JointConfiguration,
    by_m: Vector3<f64>,
    frame: Frame,
    tool: &ToolSpec,
) -> Result<Target, Fault> {
    if !by_m.iter().all(|component| component.abs() <= FAR_M) {
        let [x, y, z]: [f64; 3] = by_m.into();
        return Err(bad(format!(
            "a displacement by ({x}, {y}, {z}) m, where each must be within {FAR_M} m"
        )));
    }
    let mount = forward(origin);
    let tcp = mount.compose(&tool.tcp);
    let by_m = match frame {
        Frame::Tcp => tcp.rotation * by_m,
        Frame::ToolMount => mount.rotation * by_m,
        Frame::Base => by_m,
    };
    Ok(Target::Tcp(tcp.displaced(by_m)))
}

fn check_turn(angle_rad: f64, advance_m: f64) -> Result<(), Fault> {
    let within = |value: f64, most: f64| (-most..=most).contains(&value);
    if !within(angle_rad, turned::ANGLE_RAD_MAX) {
        let most = turned::ANGLE_RAD_MAX;
        return Err(bad(format!("a turn by {angle_rad} rad, which must be within {most:.1} rad")));
    }
    if !within(advance_m, FAR_M) {
        return Err(bad(format!("an advance by {advance_m} m, which must be within {FAR_M} m")));
    }
    Ok(())
}

fn check_pose(pose: &Pose) -> Result<(), Fault> {
    let defect = (pose.rotation * pose.rotation.transpose() - Matrix3::identity()).abs().max();
    // Written so that a value that is not a number fails.
    if !(defect <= ORTHONORMAL && pose.rotation.determinant() > 0.0) {
        return Err(bad("the goal's rotation is not a rotation"));
    }
    // A goal that is so far away is no goal, and a line to it would never be walked along.
    if !pose.translation_m.iter().all(|component| component.abs() <= GOAL_FAR_M) {
        let [x, y, z]: [f64; 3] = pose.translation_m.into();
        return Err(bad(format!(
            "a goal at ({x:e}, {y:e}, {z:e}) m, where each must be within {GOAL_FAR_M} m"
        )));
    }
    Ok(())
}

/// The joints at the end of a line to joints: those commanded, if the line leads there.
fn line_end(to: &JointConfiguration, line: &Line) -> Result<JointConfiguration, Fault> {
    let end = line.end();
    for (number, (reached, wanted)) in (1..=JOINT_COUNT).zip(end.0.iter().zip(to.0)) {
        if (reached - wanted).abs() > SAME_JOINTS_RAD {
            return Err(bad(format!(
                "a straight line to the goal ends with joint {number} at {reached:.4} rad and \
                 not at {wanted:.4} rad: go there by joints"
            )));
        }
    }
    Ok(*to)
}

fn joint_profile(from: &JointConfiguration, to: &JointConfiguration, speed: &SpeedSpec) -> Profile {
    let length = from.largest_difference_rad(to);
    Profile::new(length, speed.joint_rad_per_s, speed.joint_rad_per_s2)
}

/// The slower of shift and turn governs.
fn line_profile(line: &Line, speed: &SpeedSpec) -> Profile {
    let shift = Profile::new(line.length_m(), speed.tool_m_per_s, speed.tool_m_per_s2);
    let turn = Profile::new(line.angle_rad(), speed.joint_rad_per_s, speed.joint_rad_per_s2);
    if turn.duration_s() > shift.duration_s() { turn } else { shift }
}
