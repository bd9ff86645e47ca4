//! What is in one place with another: fixtures where they should stand, and holes of a fixture.
//!
//! A body of a fixture may be made of parts that overlap; two fixtures, or two holes, may touch and
//! no more. Knows nothing of items and the arm, and nothing of how far things truly are from where
//! they should be.

use super::build::Builder;
use super::file::FixtureFile;
use super::{CellCode, CellError, FixtureSpec, Part, Shape};
use crate::collision::{Body, Obstacle};
use nalgebra::Vector3;
use obverse_geometry::Pose;

/// Nearer than this two bodies only touch, in millimetres.
const TOUCH_MM: f64 = 0.01;
/// The part of a margin up to which the depth of what is pressed is told apart from more.
const KNOWN_SHARE: f64 = 0.8;
/// How many pairs of parts are looked at: as many as a cell of a thousand parts can have. What a
/// larger one overlaps in may remain unsaid.
pub(super) const PAIRS_MAX: usize = 1 << 20;

/// A part where it should be, and whose it is.
pub(super) struct Solid {
    pub(super) owner: usize,
    pub(super) part: Part,
    /// Where its body is.
    pub(super) pose: Pose,
    /// The corners of the box around it, along the axes of the base frame, in metres.
    low_m: Vector3<f64>,
    high_m: Vector3<f64>,
}

impl Solid {
    pub(super) fn new(owner: usize, part: Part, pose: Pose) -> Self {
        let placed = pose.compose(&part.pose);
        let half_m = match part.shape {
            Shape::Cuboid { size_m } => Vector3::from(size_m) * 0.5,
            Shape::Cylinder { diameter_m, length_m } => {
                Vector3::new(diameter_m, diameter_m, length_m) * 0.5
            }
        };
        let reach_m = placed.rotation.abs() * half_m;
        let (low_m, high_m) = (placed.translation_m - reach_m, placed.translation_m + reach_m);
        Self { owner, part, pose, low_m, high_m }
    }

    /// Whether two solids of different owners are pressed into each other deeper than this, in
    /// millimetres, or as deep as is known of them.
    pub(super) fn overlaps(&self, other: &Self, touch_mm: f64) -> bool {
        let is_beside = |axis: usize| {
            self.high_m[axis] <= other.low_m[axis] || other.high_m[axis] <= self.low_m[axis]
        };
        if self.owner == other.owner || (0..3).any(is_beside) {
            return false;
        }
        let (mine, its) = (Body::of(&self.part), Body::of(&other.part));
        // How deep is known as far as the margin of the one that moves.
        let (still, moves, body) = match mine.margin_mm() > its.margin_mm() {
            true => (other, self, mine),
            false => (self, other, its),
        };
        let still = Obstacle::of(&still.part, &still.pose);
        let known_mm = KNOWN_SHARE * body.margin_mm();
        still.gap(&body, &moves.pose).distance_mm < -touch_mm.min(known_mm)
    }
}

/// The owners of two solids of which this is true, the earlier first: of all such the pair whose
/// later one stands first. Only what is beside each other along x is asked about.
pub(super) fn overlap(
    mut solids: Vec<Solid>,
    is_wrong: impl Fn(&Solid, &Solid) -> bool,
) -> Option<(usize, usize)> {
    solids.sort_by(|a, b| a.low_m.x.total_cmp(&b.low_m.x));
    let solids = &solids;
    let pairs = solids.iter().enumerate().flat_map(|(index, solid)| {
        let behind = &solids[index + 1..];
        let is_beside = move |other: &&Solid| other.low_m.x < solid.high_m.x;
        behind.iter().take_while(is_beside).map(move |other| (solid, other))
    });
    let found = pairs.take(PAIRS_MAX).filter(|(one, other)| is_wrong(one, other));
    let owners = found.map(|(one, other)| (one.owner.max(other.owner), one.owner.min(other.owner)));
    owners.min().map(|(later, earlier)| (earlier, later))
}

/// The bodies of fixtures, whose owners are their places in the list.
pub(super) fn bodies(fixtures: &[FixtureSpec]) -> Vec<Solid> {
    let of = |(owner, fixture): (usize, &FixtureSpec)| {
        let pose = fixture.pose;
        fixture.parts.iter().map(move |part| Solid::new(owner, *part, pose)).collect::<Vec<_>>()
    };
    fixtures.iter().enumerate().flat_map(of).collect()
}

/// The holes of a fixture, in its frame.
fn holes(fixture: &FixtureSpec) -> Vec<Solid> {
    let solid = |(owner, hole): (usize, &super::HoleSpec)| {
        let middle = Pose::identity().displaced(Vector3::z() * (0.5 * hole.depth_m));
        let shape = Shape::Cylinder { diameter_m: hole.diameter_m, length_m: hole.depth_m };
        Solid::new(owner, Part { pose: middle, shape }, hole.mouth)
    };
    fixture.holes.iter().enumerate().map(solid).collect()
}

impl Builder<'_> {
    /// Refuse fixtures and holes that are in one place with others.
    pub(super) fn apart(
        &self,
        files: &[FixtureFile],
        fixtures: &[FixtureSpec],
    ) -> Result<(), CellError> {
        let overlaps = |one: &Solid, other: &Solid| one.overlaps(other, TOUCH_MM);
        if let Some((earlier, later)) = overlap(bodies(fixtures), overlaps) {
            let message = format!(
                "the fixtures `{}` and `{}` overlap: their bodies are in one place, where `place` \
                 says that they should stand",
                fixtures[earlier].name, fixtures[later].name
            );
            return Err(self.error(&files[later].name, message).of(CellCode::Overlap));
        }
        for (file, fixture) in files.iter().zip(fixtures) {
            if let Some((earlier, later)) = overlap(holes(fixture), overlaps) {
                let message = format!(
                    "`hole` {} and {} of `{}`, in the order of the file, run into each other",
                    earlier + 1,
                    later + 1,
                    fixture.name
                );
                return Err(self.error(&file.hole[later], message).of(CellCode::Overlap));
            }
        }
        Ok(())
    }
}
