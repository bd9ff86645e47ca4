//! Whether an assembly is as the workcell file says that it should be in the end: for observers
//! and reports. A program cannot ask; what it believes of its work may be wrong.

use crate::cell::{Cell, GoalEnd, GoalSpec};
use crate::gripper::Rest;
use crate::seating::Seating;
use crate::sim::Sim;
use crate::world::{Hole, Owner, World};
use nalgebra::Vector3;
use obverse_geometry::Pose;
use obverse_geometry::tolerance::pose_distance;
use std::fmt;

/// A goal that is not met.
#[derive(Clone, Debug, PartialEq)]
pub struct Missed {
    /// Which, by its place in the workcell file, from 0.
    pub goal: usize,
    /// What must be where, in words.
    pub what: String,
    /// How it is instead.
    pub why: Miss,
}

/// How an item is that is not where it must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Miss {
    /// It is still in the gripper.
    Held,
    /// It is not in the gripper.
    NotHeld,
    /// It was knocked over.
    Knocked,
    /// It fell.
    Dropped,
    /// It is not in the cell.
    Gone,
    /// Its end is so far from the axis of the hole, or not below its mouth; in metres.
    Beside {
        /// How far.
        by_m: f64,
    },
    /// Its end is at another depth.
    Depth {
        /// How deep, in metres.
        is_m: f64,
        /// How deep it must be, at least and at most.
        must_m: (f64, f64),
    },
    /// Its axis leans so far from that of the hole, in radians.
    Leans {
        /// How far.
        by_rad: f64,
    },
    /// It has not snapped in, is not held by the press, or is not tight.
    NotSeated,
    /// It is so far from its place.
    Off {
        /// How far, in metres.
        by_m: f64,
        /// How far it is turned, in radians.
        by_rad: f64,
    },
}

impl Miss {
    /// The stable word for it that machines read.
    #[must_use]
    pub fn code(self) -> &'static str {
        match self {
            Self::Held => "held",
            Self::NotHeld => "not_held",
            Self::Knocked => "knocked",
            Self::Dropped => "dropped",
            Self::Gone => "gone",
            Self::Beside { .. } => "beside",
            Self::Depth { .. } => "depth",
            Self::Leans { .. } => "leans",
            Self::NotSeated => "not_seated",
            Self::Off { .. } => "off",
        }
    }
}

impl fmt::Display for Miss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mm = |metres: f64| metres * 1e3;
        match *self {
            Self::Held => write!(f, "the gripper still holds it"),
            Self::NotHeld => write!(f, "the gripper does not hold it"),
            Self::Knocked => write!(f, "it was knocked over"),
            Self::Dropped => write!(f, "it fell"),
            Self::Gone => write!(f, "it is not in the cell"),
            Self::Beside { by_m } => write!(f, "it is {:.1} mm beside the hole", mm(by_m)),
            Self::Depth { is_m, must_m: (least, most) } => write!(
                f,
                "it is {:.2} mm deep, and must be {:.2} to {:.2} mm",
                mm(is_m),
                mm(least),
                mm(most)
            ),
            Self::Leans { by_rad } => write!(f, "it leans by {:.1} deg", by_rad.to_degrees()),
            Self::NotSeated => write!(f, "it does not sit fast"),
            Self::Off { by_m, by_rad } => {
                write!(f, "it is off by {:.2} mm, {:.2} deg", mm(by_m), by_rad.to_degrees())
            }
        }
    }
}

impl fmt::Display for Missed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.what, self.why)
    }
}

/// What a goal asks for, in words.
fn words(cell: &Cell, goal: &GoalSpec) -> String {
    let item = &cell.items[goal.item].name;
    match goal.end {
        GoalEnd::Held => format!("`{item}` in the gripper"),
        GoalEnd::InHole { fixture, hole, .. } => {
            let fixture = &cell.fixtures[fixture];
            match fixture.holes.len() {
                1 => format!("`{item}` in the hole of `{}`", fixture.name),
                _ => format!("`{item}` in hole {} of `{}`", hole + 1, fixture.name),
            }
        }
        GoalEnd::At { .. } => format!("`{item}` at its place"),
    }
}

impl World {
    /// A hole where it truly is.
    fn hole(&self, fixture: usize, number: usize) -> Option<&Hole> {
        let of = self.fixed.iter().filter(|part| part.owner == Owner::Fixture(fixture));
        of.flat_map(|part| &part.holes).find(|hole| hole.spec.number == number)
    }
}

impl Sim {
    /// The goals of the workcell file that are not met now, in its order; none where all are, or
    /// where it has none.
    #[must_use]
    pub fn missed_goals(&self) -> Vec<Missed> {
        let cell = &self.world.cell;
        let goals = cell.goals.iter().enumerate();
        let missed = goals.filter(|(index, _)| !self.goals_met_before[*index]);
        let missed = missed.filter_map(|(index, goal)| {
            let why = self.misses(goal)?;
            Some(Missed { goal: index, what: words(cell, goal), why })
        });
        missed.collect()
    }

    /// A part is about to leave the cell, another one coming under its name: what it has met stays
    /// met, as it stays where it is in truth.
    pub(crate) fn keep_met_goals(&mut self, item: usize) {
        let world = self.world.clone();
        for (index, goal) in world.cell.goals.iter().enumerate() {
            if goal.item == item && !self.goals_met_before[index] {
                self.goals_met_before[index] = self.misses(goal).is_none();
            }
        }
    }

    /// How a goal is missed, if it is.
    fn misses(&self, goal: &GoalSpec) -> Option<Miss> {
        let item = goal.item;
        let is_held = self.items.held() == Some(item);
        match (goal.end, is_held) {
            (GoalEnd::Held, true) => return None,
            (GoalEnd::Held, false) => return Some(Miss::NotHeld),
            (_, true) => return Some(Miss::Held),
            (_, false) => {}
        }
        match self.items.rest(item) {
            Rest::Standing => {}
            Rest::Knocked => return Some(Miss::Knocked),
            Rest::Dropped => return Some(Miss::Dropped),
            Rest::Absent => return Some(Miss::Gone),
        }
        let Some(pose) = self.items.pose(item, &self.joints) else { return Some(Miss::Gone) };
        match goal.end {
            GoalEnd::Held => None,
            GoalEnd::InHole { fixture, hole, .. } => {
                let hole = self.world.hole(fixture, hole)?;
                self.misses_hole(goal, hole, &pose)
            }
            GoalEnd::At { pose: place, on, within_m, within_rad } => {
                let place = self.world.place(on.as_ref(), &place);
                let (by_m, by_rad) = pose_distance(&place, &pose);
                (by_m > within_m || by_rad > within_rad).then_some(Miss::Off { by_m, by_rad })
            }
        }
    }

    /// How an item that lies at a pose misses a hole, if it does.
    fn misses_hole(&self, goal: &GoalSpec, hole: &Hole, pose: &Pose) -> Option<Miss> {
        let GoalEnd::InHole { fixture, depth_m, within_m, within_rad, .. } = goal.end else {
            return None;
        };
        let peg = self.world.cell.items[goal.item].peg?;
        let in_hole = hole.from_base.compose(pose);
        let end = Vector3::new(0.0, 0.0, 0.5 * peg.length_m);
        let end_m = in_hole.rotation * end + in_hole.translation_m;
        let by_m = end_m.xy().norm();
        if by_m > within_m || end_m.z <= 0.0 {
            return Some(Miss::Beside { by_m });
        }
        let axis = in_hole.rotation.column(2);
        let by_rad = libm::atan2(axis.xy().norm(), axis.z);
        if by_rad > within_rad {
            return Some(Miss::Leans { by_rad });
        }
        let is_here = |left: &&Seating| (left.fixture, left.hole) == (fixture, hole.spec.number);
        let seating = self.seatings[goal.item].as_ref().filter(is_here);
        // What is pressed on the bottom gives way where it is held, and comes back when let go.
        let is_m = seating.map_or(end_m.z.min(hole.spec.depth_m), |seating| seating.depth_m);
        if is_m < depth_m.0 || is_m > depth_m.1 {
            return Some(Miss::Depth { is_m, must_m: depth_m });
        }
        let must_sit = hole.spec.seat.is_some();
        let sits = seating.is_some_and(|seating| seating.is_seated);
        (must_sit && !sits).then_some(Miss::NotSeated)
    }
}
