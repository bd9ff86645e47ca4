//! Motions in few words.

#![allow(dead_code, reason = "each test file uses its own part of this")]

use obverse_geometry::{Axis, Frame, JointConfiguration, Pose};
use obverse_sim::{CauseKind, Cell, Sim};
use obverse_workcell::{Goal, Motion, Path, Speed, ToolId, Workcell};

pub(crate) fn peg_in_hole() -> Cell {
    Cell::parse(include_str!("../../../../programs/peg_in_hole.toml")).expect("peg_in_hole.toml")
}

pub(crate) fn bench_cell() -> Cell {
    Cell::parse(include_str!("../../../../programs/bench_cell.toml")).expect("bench_cell.toml")
}

pub(crate) fn by_joints(joints: JointConfiguration) -> Motion {
    Motion {
        goal: Goal::Joints(joints),
        path: Path::Joint,
        speed: Speed::Normal,
        tool: ToolId(0),
        force_limit_n: None,
    }
}

pub(crate) fn by_line(joints: JointConfiguration) -> Motion {
    Motion { path: Path::Linear, ..by_joints(joints) }
}

pub(crate) fn to_pose(pose: Pose, path: Path) -> Motion {
    Motion { goal: Goal::Pose(pose), path, ..by_joints(JointConfiguration::ZERO) }
}

/// Along the tool's z from `from`, stopping at a force.
pub(crate) fn push(from: JointConfiguration, distance_m: f64, limit_n: f64) -> Motion {
    Motion {
        goal: Goal::Displaced { from, distance_m, axis: Axis::PlusZ, frame: Frame::Tcp },
        path: Path::Linear,
        speed: Speed::Slow,
        tool: ToolId(0),
        force_limit_n: Some(limit_n),
    }
}

/// Along the tool's z from `from`, without a guard.
pub(crate) fn advance(from: JointConfiguration, distance_m: f64) -> Motion {
    Motion { force_limit_n: None, ..push(from, distance_m, 1.0) }
}

/// Everything about a workcell, commanded or not, as bits.
pub(crate) fn world_bits(sim: &Sim) -> Vec<u64> {
    let mut bits = Vec::new();
    sim.world_state(&mut |word| bits.push(word));
    bits
}

/// What a program can command, as bits.
pub(crate) fn commanded_bits(sim: &Sim) -> Vec<u64> {
    let mut bits = Vec::new();
    sim.commanded_state(&mut |word| bits.push(word));
    bits
}

/// Where the arm of [`pin_on_plate`] waits, with the gripper around the pin.
pub(crate) const AT_PIN: JointConfiguration =
    JointConfiguration([0.4, -1.4, 1.6, -1.77, -1.57, 0.3]);

/// The gripper points straight down at a pin that stands on a plate; `gripper`, `pin` and `plate`
/// are more keys of each, `more` are more tables.
pub(crate) fn pin_on_plate(gripper: &str, pin: &str, plate: &str, more: &str) -> Cell {
    let text = format!(
        "[arm]
        home_rad = {home}
        [[tool]]
        name = \"hand\"
        tcp = {{ xyz_mm = [0, 0, 100] }}
        [gripper]
        output = 0
        near_mm = 8
        near_deg = 20
        {gripper}
        [[fixture]]
        name = \"plate\"
        place = {{ taught_at_rad = {home}, xyz_mm = [0, 0, 30.01] }}
        body = [{{ cuboid_mm = [300, 300, 20] }}]
        {plate}
        [[item]]
        name = \"pin\"
        place = {{ taught_at_rad = {home} }}
        body = [{{ cylinder = {{ diameter_mm = 16, length_mm = 40 }} }}]
        {pin}
        {more}",
        home = "[0.4, -1.4, 1.6, -1.77, -1.57, 0.3]",
    );
    Cell::parse(&text).expect("a cell")
}

/// Straight up in the base frame.
pub(crate) fn lift(from: JointConfiguration, by_m: f64) -> Motion {
    Motion {
        goal: Goal::Displaced { from, distance_m: by_m, axis: Axis::PlusZ, frame: Frame::Base },
        speed: Speed::Normal,
        ..by_line(from)
    }
}

/// Aside in the base frame.
pub(crate) fn shift(from: JointConfiguration, by_m: f64) -> Motion {
    Motion {
        goal: Goal::Displaced { from, distance_m: by_m, axis: Axis::PlusX, frame: Frame::Base },
        ..lift(from, 0.0)
    }
}

/// Whether something of this kind is wrong now.
pub(crate) fn is_wrong(sim: &Sim, kind: CauseKind) -> bool {
    sim.truth().iter().any(|cause| cause.kind == kind)
}
