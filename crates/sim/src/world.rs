//! What does not change while a workcell runs: the cell, the seed, and what the seed decided.
//!
//! Knows where fixtures truly stand and items truly lay at the start, and nothing of motion.

use crate::cell::{Cell, HoleSpec, OffsetSpec};
use crate::collision::Obstacle;
use crate::random::{self, Stream};
use obverse_geometry::Pose;

/// A cell as the seed made it.
#[derive(Clone, Debug)]
pub(crate) struct World {
    pub(crate) cell: Cell,
    pub(crate) seed: u64,
    /// The parts of all fixtures.
    pub(crate) fixed: Vec<Standing>,
}

/// A part of something that stands still.
#[derive(Clone, Debug)]
pub(crate) struct Standing {
    pub(crate) owner: Owner,
    pub(crate) obstacle: Obstacle,
    /// The holes in this part.
    pub(crate) holes: Vec<Hole>,
}

/// What a part belongs to, by its place in the cell's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner {
    Fixture(usize),
    Item(usize),
}

/// A hole where it truly is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hole {
    pub(crate) spec: HoleSpec,
    /// In the base frame; z points into the hole.
    pub(crate) mouth: Pose,
    /// From the base frame into that of the hole.
    pub(crate) from_base: Pose,
}

impl World {
    pub(crate) fn new(cell: &Cell, seed: u64) -> Self {
        let mut fixed = Vec::new();
        for (index, fixture) in cell.fixtures.iter().enumerate() {
            let streams = (Stream::FixtureUniform, Stream::FixtureNormal);
            let pose = fixture.pose.compose(&offset(&fixture.offset, seed, streams, index));
            for (number, part) in fixture.parts.iter().enumerate() {
                let drilled = fixture.holes.iter().filter(|hole| hole.part == number);
                let holes = drilled.map(|spec| {
                    let mouth = pose.compose(&spec.mouth);
                    Hole { spec: *spec, mouth, from_base: mouth.inverse() }
                });
                fixed.push(Standing {
                    owner: Owner::Fixture(index),
                    obstacle: Obstacle::of(part, &pose),
                    holes: holes.collect(),
                });
            }
        }
        Self { cell: cell.clone(), seed, fixed }
    }

    /// Where each item truly is at the start.
    pub(crate) fn item_poses(&self) -> impl Iterator<Item = Pose> {
        let streams = (Stream::ItemUniform, Stream::ItemNormal);
        self.cell.items.iter().enumerate().map(move |(index, item)| {
            item.pose.compose(&offset(&item.offset, self.seed, streams, index))
        })
    }
}

/// The true offset of the thing of this number, in its own frame.
fn offset(spec: &OffsetSpec, seed: u64, streams: (Stream, Stream), number: usize) -> Pose {
    if *spec == OffsetSpec::default() {
        return Pose::identity();
    }
    let mut offset = spec.fixed;
    for (axis, value) in offset.iter_mut().enumerate() {
        let counter = (number * 6 + axis) as u64;
        *value += spec.uniform[axis] * random::signed(seed, streams.0, counter);
        *value += spec.normal[axis] * random::normal(seed, streams.1, counter);
    }
    let [x, y, z, a, b, c] = offset;
    Pose::from_rotation_vector([x, y, z], [a, b, c])
}
