//! What is inside something else when the cell starts: items, and the arm at home.
//!
//! An item may lie on things, stand in a hole that it fits, and be in the gripper; what a feeder
//! has yet to bring is in the way of no item. Looked at where things should be. Knows nothing of
//! how two fixtures are to each other, and nothing of motion.

use super::build::Builder;
use super::file::CellFile;
use super::overlap::{PAIRS_MAX, Solid, bodies, overlap};
use super::{Cell, CellCode, CellError, FixtureSpec, HoleSpec, Part, Shape};
use crate::collision::{Body, Obstacle};
use crate::kinematics::{forward, links};
use crate::robot::{self, LINK_NAMES};
use nalgebra::Vector3;
use obverse_geometry::tolerance::pose_distance;
use obverse_geometry::{JOINT_COUNT, Pose};

/// How deep things may be in each other, in millimetres: places are measured, and bodies give way.
const DEEP_MM: f64 = 0.5;
/// The same in metres: how much wider or longer than a hole a thing may be that stands in it.
const DEEP_M: f64 = DEEP_MM * 1e-3;
/// How straight a thing stands in a hole, as the cosine of its angle to the axis: five degrees.
const STRAIGHT: f64 = 0.996;

/// The items that are in the cell when it starts, and those that a feeder brings later.
struct Items<'c> {
    cell: &'c Cell,
    /// By item, whether it is there from the start.
    is_there: Vec<bool>,
}

impl<'c> Items<'c> {
    fn of(cell: &'c Cell) -> Self {
        let mut is_there = vec![true; cell.items.len()];
        for feeder in &cell.feeders {
            is_there[feeder.item] = feeder.is_ready;
        }
        Self { cell, is_there }
    }

    /// Their bodies, owned behind the fixtures.
    fn solids(&self) -> impl Iterator<Item = Solid> {
        let fixtures = self.cell.fixtures.len();
        self.cell.items.iter().enumerate().flat_map(move |(index, item)| {
            item.parts.iter().map(move |part| Solid::new(fixtures + index, *part, item.pose))
        })
    }

    /// Whether a part of an item and one of another thing are in one place, and may not be.
    fn is_within(&self, one: &Solid, other: &Solid) -> bool {
        let fixtures = &self.cell.fixtures;
        let (first, item) = if one.owner <= other.owner { (one, other) } else { (other, one) };
        let Some(index) = item.owner.checked_sub(fixtures.len()) else { return false };
        let is_allowed = || match fixtures.get(first.owner) {
            Some(fixture) => is_in_hole(item, fixture),
            None => !self.is_there[index] || !self.is_there[first.owner - fixtures.len()],
        };
        first.overlaps(item, DEEP_MM) && !is_allowed()
    }

    /// Whether an item is in the gripper when the arm is at home, or could be taken there.
    fn is_in_gripper(&self, index: usize) -> bool {
        let Some(gripper) = &self.cell.gripper else { return false };
        let tcp = self.cell.tools[usize::from(gripper.tool)].tcp;
        let tool = forward(&self.cell.arm.home).compose(&tcp);
        let item = &self.cell.items[index];
        let (far_m, turned_rad) = pose_distance(&tool, &item.pose.compose(&item.grasp));
        far_m <= gripper.near_m && turned_rad <= gripper.near_rad
    }
}

/// Whether a part of an item stands in a hole of a fixture that it fits.
fn is_in_hole(item: &Solid, fixture: &FixtureSpec) -> bool {
    let placed = item.pose.compose(&item.part.pose);
    let in_hole = |hole: &HoleSpec| fixture.pose.compose(&hole.mouth).inverse().compose(&placed);
    fixture.holes.iter().any(|hole| fits(&item.part, &in_hole(hole), hole))
}

/// Whether a part with its centre at a pose in the frame of a hole is in it.
fn fits(part: &Part, pose: &Pose, hole: &HoleSpec) -> bool {
    let (radius_m, length_m) = match part.shape {
        Shape::Cylinder { diameter_m, length_m } => (0.5 * diameter_m, length_m),
        Shape::Cuboid { size_m: [x, y, z] } => (0.5 * libm::hypot(x, y), z),
    };
    let axis = pose.rotation.column(2).into_owned();
    if axis.z.abs() < STRAIGHT {
        return false;
    }
    let into = axis * axis.z.signum();
    let tip_m = pose.translation_m + into * (0.5 * length_m);
    let at_mouth_m = tip_m - into * (tip_m.z / into.z).min(length_m);
    let aside_m = |point_m: &Vector3<f64>| libm::hypot(point_m.x, point_m.y);
    let widest_m = aside_m(&tip_m).max(aside_m(&at_mouth_m)) + radius_m;
    tip_m.z > 0.0 && tip_m.z <= hole.depth_m + DEEP_M && widest_m <= 0.5 * hole.diameter_m + DEEP_M
}

/// The arm and its tool at home: a name, a body and where it is.
fn arm(cell: &Cell) -> Vec<(String, Body, Pose)> {
    let frames = links(&cell.arm.home);
    let link = |index: usize| {
        let name = format!("the {} of the arm", LINK_NAMES[index]);
        (name, robot::link(index, &frames), Pose::identity())
    };
    let tool =
        |part: &Part| (format!("the tool `{}`", cell.tools[0].name), Body::of(part), frames.mount);
    (0..JOINT_COUNT).map(link).chain(cell.tools[0].parts.iter().map(tool)).collect()
}

impl Builder<'_> {
    /// Refuse items that are in a fixture or in one another, and an arm that is in either at home.
    pub(super) fn free(&self, file: &CellFile, cell: &Cell) -> Result<(), CellError> {
        let (items, fixtures) = (Items::of(cell), &cell.fixtures);
        let name = |owner: usize| match fixtures.get(owner) {
            Some(fixture) => format!("the fixture `{}`", fixture.name),
            None => format!("the item `{}`", cell.items[owner - fixtures.len()].name),
        };
        let solids: Vec<Solid> = bodies(fixtures).into_iter().chain(items.solids()).collect();
        let home = self.home(cell, &items, &solids);
        if let Some((earlier, later)) = overlap(solids, |one, other| items.is_within(one, other)) {
            let item = &file.item[later - fixtures.len()];
            let message = format!(
                "the item `{}` is in {}: their bodies are in one place, where `place` says that \
                 they should be; move one of them, so that they touch and no more, or into a hole \
                 that it fits",
                item.name.get_ref(),
                name(earlier)
            );
            return Err(self.error(&item.name, message).of(CellCode::Overlap));
        }
        let Some((of_arm, owner)) = home else { return Ok(()) };
        let message = format!(
            "at home {of_arm} is in {}: say another `home_rad`, or move that away from the arm",
            name(owner)
        );
        Err(self.error(&file.arm.home_rad, message).of(CellCode::Overlap))
    }

    /// What of the arm is in what at home.
    fn home(&self, cell: &Cell, items: &Items<'_>, solids: &[Solid]) -> Option<(String, usize)> {
        let arm = arm(cell);
        let is_there = |solid: &&Solid| match solid.owner.checked_sub(cell.fixtures.len()) {
            None => true,
            Some(index) => items.is_there[index] && !items.is_in_gripper(index),
        };
        let pairs = solids.iter().filter(is_there).flat_map(|solid| {
            let obstacle = Obstacle::of(&solid.part, &solid.pose);
            arm.iter().map(move |of_arm| (of_arm, obstacle, solid.owner))
        });
        let found = pairs.take(PAIRS_MAX).find(|((_, body, pose), obstacle, _)| {
            obstacle.at_least_mm(body, pose) < 0.0
                && obstacle.gap(body, pose).distance_mm < -DEEP_MM.min(0.8 * body.margin_mm())
        });
        found.map(|((name, ..), _, owner)| (name.clone(), owner))
    }
}
