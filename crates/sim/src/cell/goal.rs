//! What a finished assembly is: the goals of a workcell file, their keys and what they must be
//! together. Knows nothing of how things truly are in the end.

use super::build::{Builder, DEG, MM};
use super::file::{CellFile, PlaceFile};
use super::number::{CoordinateMm, NearDeg, NearMm};
use super::{CellCode, CellError, FixtureSpec, ItemSpec, On};
use obverse_geometry::Pose;
use serde::Deserialize;
use toml::Spanned;

const GOALS_MAX: usize = 1_000;
/// How far an item's axis may lean from that of its hole, if it is not said, in degrees.
const LEAN_DEG: f64 = 10.0;

/// Something that must be so when an assembly is finished.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoalSpec {
    /// The item, by its place in the list.
    pub item: usize,
    /// Where it must be.
    pub end: GoalEnd,
}

/// Where an item must be in the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GoalEnd {
    /// In the gripper.
    Held,
    /// In a hole, let go; where the hole is a seat, in it as it should be.
    InHole {
        /// The fixture, by its place in the list.
        fixture: usize,
        /// The hole, by its place in the fixture's list.
        hole: usize,
        /// How deep the item's end is, at least and at most, in metres.
        depth_m: (f64, f64),
        /// How far its end may be from the axis of the hole, in metres.
        within_m: f64,
        /// How far its axis may lean from that of the hole, in radians.
        within_rad: f64,
    },
    /// At a place, let go and as it was put.
    At {
        /// In the base frame, if everything stands where it should.
        pose: Pose,
        /// The fixture that the place moves with, if it moves with one.
        on: Option<On>,
        /// How far it may be from there, in metres.
        within_m: f64,
        /// How far it may be turned, in radians.
        within_rad: f64,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GoalFile {
    pub(super) item: Spanned<String>,
    pub(super) held: Option<bool>,
    pub(super) fixture: Option<Spanned<String>>,
    pub(super) hole: Option<Spanned<usize>>,
    pub(super) depth_mm: Option<Spanned<[CoordinateMm; 2]>>,
    pub(super) place: Option<PlaceFile>,
    pub(super) on: Option<Spanned<String>>,
    pub(super) within_mm: Option<Spanned<NearMm>>,
    pub(super) within_deg: Option<Spanned<NearDeg>>,
}

impl Builder<'_> {
    pub(super) fn goals(
        &self,
        file: &CellFile,
        tcp: &Pose,
        (items, fixtures): (&[ItemSpec], &[FixtureSpec]),
    ) -> Result<Vec<GoalSpec>, CellError> {
        self.at_most("goals", file.goal.len(), GOALS_MAX)?;
        let goal = |goal: &GoalFile| {
            let item = items.iter().position(|item| &item.name == goal.item.get_ref());
            let item = item.ok_or_else(|| self.unknown("item", &goal.item))?;
            let end = match (goal.held, &goal.fixture, &goal.place) {
                (Some(true), None, None) => self.held(goal),
                (None, Some(fixture), None) => self.in_hole(goal, fixture, &items[item], fixtures),
                (None, None, Some(place)) => self.at_place(goal, place, tcp, fixtures),
                _ => Err(self.error(
                    &goal.item,
                    "a goal has one of `held = true`, `fixture` and `place`: where must the item \
                     be in the end?",
                )),
            };
            Ok(GoalSpec { item, end: end? })
        };
        file.goal.iter().map(goal).collect()
    }

    fn unknown(&self, what: &str, name: &Spanned<String>) -> CellError {
        let message = format!("there is no {what} `{}`", name.get_ref());
        self.error(name, message).of(CellCode::UnknownName)
    }

    /// Refuse a key that means nothing in a goal of this kind.
    fn not_of<T>(&self, key: Option<&Spanned<T>>, name: &str, of: &str) -> Result<(), CellError> {
        key.map_or(Ok(()), |key| Err(self.error(key, format!("`{name}` belongs to {of}"))))
    }

    fn held(&self, goal: &GoalFile) -> Result<GoalEnd, CellError> {
        self.only_in_hole(goal)?;
        self.not_of(goal.on.as_ref(), "on", "a goal with `place`")?;
        let other = "a goal with `fixture` or `place`";
        self.not_of(goal.within_mm.as_ref(), "within_mm", other)?;
        self.not_of(goal.within_deg.as_ref(), "within_deg", other)?;
        Ok(GoalEnd::Held)
    }

    fn only_in_hole(&self, goal: &GoalFile) -> Result<(), CellError> {
        self.not_of(goal.hole.as_ref(), "hole", "a goal with `fixture`")?;
        self.not_of(goal.depth_mm.as_ref(), "depth_mm", "a goal with `fixture`")
    }

    fn in_hole(
        &self,
        goal: &GoalFile,
        name: &Spanned<String>,
        item: &ItemSpec,
        fixtures: &[FixtureSpec],
    ) -> Result<GoalEnd, CellError> {
        self.not_of(goal.on.as_ref(), "on", "a goal with `place`")?;
        if item.peg.is_none() {
            let message = format!("`{}` has no `peg`, and fits no hole", item.name);
            return Err(self.error(&goal.item, message));
        }
        let fixture = fixtures.iter().position(|fixture| &fixture.name == name.get_ref());
        let fixture = fixture.ok_or_else(|| self.unknown("fixture", name))?;
        let hole = self.hole_of(goal, name, &fixtures[fixture])?;
        let spec = &fixtures[fixture].holes[hole];
        let depth = goal.depth_mm.as_ref().ok_or_else(|| {
            let message = "a goal in a hole says how deep, at least and at most: `depth_mm`";
            self.error(name, message).of(CellCode::Key)
        })?;
        let [least, most] = depth.get_ref().map(|depth| depth.0 * MM);
        if least > most || most <= 0.0 || least >= spec.depth_m {
            let message = format!(
                "nothing can be {} to {} mm deep in a hole of {} mm",
                least / MM,
                most / MM,
                spec.depth_m / MM
            );
            return Err(self.error(depth, message));
        }
        let within_m = goal.within_mm.as_ref().map(|within| within.get_ref().0 * MM);
        let within_deg = goal.within_deg.as_ref().map_or(LEAN_DEG, |within| within.get_ref().0);
        Ok(GoalEnd::InHole {
            fixture,
            hole,
            depth_m: (least, most),
            within_m: within_m.unwrap_or(0.5 * spec.diameter_m),
            within_rad: within_deg * DEG,
        })
    }

    /// Which hole, by its place in the list; files count from 1.
    fn hole_of(
        &self,
        goal: &GoalFile,
        name: &Spanned<String>,
        fixture: &FixtureSpec,
    ) -> Result<usize, CellError> {
        let count = fixture.holes.len();
        match (&goal.hole, count) {
            (_, 0) => Err(self.error(name, format!("`{}` has no hole", fixture.name))),
            (None, 1) => Ok(0),
            (None, _) => {
                let message = format!("`{}` has {count} holes: say `hole`", fixture.name);
                Err(self.error(name, message))
            }
            (Some(hole), _) if (1..=count).contains(hole.get_ref()) => Ok(hole.get_ref() - 1),
            (Some(hole), _) => {
                let number = hole.get_ref();
                let message = format!(
                    "`{}` has no hole {number}: its holes are 1 to {count}, in the file's order",
                    fixture.name
                );
                Err(self.error(hole, message).of(CellCode::UnknownName))
            }
        }
    }

    fn at_place(
        &self,
        goal: &GoalFile,
        place: &PlaceFile,
        tcp: &Pose,
        fixtures: &[FixtureSpec],
    ) -> Result<GoalEnd, CellError> {
        self.only_in_hole(goal)?;
        let (Some(within_mm), Some(within_deg)) = (&goal.within_mm, &goal.within_deg) else {
            let message = "a goal at a place says how near: `within_mm` and `within_deg`";
            return Err(self.error(&goal.item, message).of(CellCode::Key));
        };
        let stand = self.stand(goal.on.as_ref(), place, tcp, fixtures)?;
        Ok(GoalEnd::At {
            pose: stand.pose,
            on: stand.on,
            within_m: within_mm.get_ref().0 * MM,
            within_rad: within_deg.get_ref().0 * DEG,
        })
    }
}
