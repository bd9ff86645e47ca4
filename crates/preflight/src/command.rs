//! A motion as far as it is known: what a workcell in thought is asked about.

use obverse_geometry::{Axis, Frame, JointConfiguration, Pose};
use obverse_workcell::{Goal, Motion, Path, Speed, ToolId};

/// Where a motion leads, as far as that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Aim {
    Joints(JointConfiguration),
    Pose(Pose),
    /// From where the arm stands.
    Displaced {
        distance_m: f64,
        axis: Axis,
        frame: Frame,
    },
    /// From where the arm stands.
    Offset {
        by_m: [f64; 3],
        frame: Frame,
    },
    /// From where the arm stands, or from elsewhere where it leads back.
    Turned {
        from: Option<JointConfiguration>,
        angle_rad: f64,
        advance_m: f64,
        axis: Axis,
        frame: Frame,
    },
    NotKnown,
}

/// What it means that a motion meets more than so many newtons, if that number is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Guard {
    /// There is no such number: to meet something too hard is a collision.
    None,
    /// The motion ends there, as it should.
    Ends(Option<f64>),
    /// The motion is stopped with a fault: going back, the arm is not where it was.
    Faults(Option<f64>),
}

/// A motion as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Command {
    pub(crate) aim: Aim,
    pub(crate) path: Option<Path>,
    pub(crate) tool: Option<ToolId>,
    pub(crate) speed: Option<Speed>,
    pub(crate) guard: Guard,
}

impl Aim {
    /// Whether it leads to a configuration, bit for bit, from wherever the arm stands.
    pub(crate) fn leads_back_to(&self, start: &JointConfiguration) -> bool {
        match self {
            Self::Joints(to) => to.same_bits(start),
            Self::Turned { from: Some(from), angle_rad, advance_m, .. } => {
                from.same_bits(start) && *angle_rad == 0.0 && *advance_m == 0.0
            }
            _ => false,
        }
    }
}

impl Command {
    /// The motion, from where the arm stands; none if part of it is not known.
    pub(crate) fn motion(&self, from: JointConfiguration) -> Option<Motion> {
        let goal = match self.aim {
            Aim::Joints(joints) => Goal::Joints(joints),
            Aim::Pose(pose) => Goal::Pose(pose),
            Aim::Displaced { distance_m, axis, frame } => {
                Goal::Displaced { from, distance_m, axis, frame }
            }
            Aim::Offset { by_m, frame } => Goal::Offset { from, by_m, frame },
            Aim::Turned { from: fixed, angle_rad, advance_m, axis, frame } => {
                let from = fixed.unwrap_or(from);
                Goal::Turned { from, angle_rad, advance_m, axis, frame }
            }
            Aim::NotKnown => return None,
        };
        let (path, speed, tool) = (self.path?, self.speed?, self.tool?);
        let force_limit_n = match self.guard {
            Guard::None => None,
            Guard::Ends(limit_n) | Guard::Faults(limit_n) => Some(limit_n?),
        };
        Some(Motion { goal, path, speed, tool, force_limit_n })
    }

    /// All of it as numbers: two commands with the same numbers are the same.
    pub(crate) fn numbers(&self) -> Vec<u64> {
        let (guard, limit_n) = match self.guard {
            Guard::None => (0, None),
            Guard::Ends(limit_n) => (1, limit_n),
            Guard::Faults(limit_n) => (2, limit_n),
        };
        let mut numbers = vec![
            self.path.map_or(u64::MAX, |path| path as u64),
            self.tool.map_or(u64::MAX, |tool| u64::from(tool.0)),
            self.speed.map_or(u64::MAX, |speed| speed as u64),
            guard,
            u64::from(limit_n.is_some()),
            limit_n.map_or(0, f64::to_bits),
        ];
        match &self.aim {
            Aim::Joints(joints) => {
                numbers.push(0);
                numbers.extend(joints.bits());
            }
            Aim::Pose(pose) => {
                numbers.push(1);
                let all = pose.rotation.iter().chain(pose.translation_m.iter());
                numbers.extend(all.map(|x| x.to_bits()));
            }
            Aim::Displaced { distance_m, axis, frame } => {
                numbers.extend([2, distance_m.to_bits(), *axis as u64, *frame as u64]);
            }
            Aim::Offset { by_m, frame } => {
                numbers.extend([3, *frame as u64]);
                numbers.extend(by_m.map(f64::to_bits));
            }
            Aim::Turned { from, angle_rad, advance_m, axis, frame } => {
                numbers.extend([5, *axis as u64, *frame as u64]);
                numbers.extend([angle_rad, advance_m].map(|by| by.to_bits()));
                numbers.extend(from.iter().flat_map(JointConfiguration::bits));
            }
            Aim::NotKnown => numbers.push(4),
        }
        numbers
    }
}
