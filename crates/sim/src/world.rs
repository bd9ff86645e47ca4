//! What does not change while a workcell runs: the cell, the seed, and what the seed decided.
//!
//! Knows where fixtures truly stand and items truly lay at the start, and nothing of motion.

use crate::cell::{Cell, ForceSensorSpec, HoleSpec, OffsetSpec, On};
use crate::collision::Obstacle;
use crate::gripper::Hand;
use crate::random::{self, Stream};
use obverse_geometry::Pose;
use std::sync::Arc;

/// A cell as the seed made it.
#[derive(Clone, Debug)]
pub(crate) struct World {
    pub(crate) cell: Arc<Cell>,
    pub(crate) seed: u64,
    /// The parts of all fixtures.
    pub(crate) fixed: Vec<Standing>,
    /// Where each fixture truly stands.
    pub(crate) fixtures: Vec<Pose>,
    /// The force sensor with its bias in this run.
    pub(crate) sensor: ForceSensorSpec,
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
    pub(crate) fn new(cell: Arc<Cell>, seed: u64) -> Self {
        let mut fixed = Vec::new();
        let mut fixtures: Vec<Pose> = Vec::with_capacity(cell.fixtures.len());
        for (index, fixture) in cell.fixtures.iter().enumerate() {
            let streams = (Stream::FixtureUniform, Stream::FixtureNormal);
            let place = place(&fixtures, fixture.on.as_ref(), &fixture.pose);
            let offset = drawn_offset(&fixture.offset, seed, streams, index as u64);
            let pose = place.compose(&offset);
            fixtures.push(pose);
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
        let sensor = sensor_of_run(&cell.force_sensor, seed);
        Self { cell, seed, fixed, fixtures, sensor }
    }

    /// Where an item should truly be: with what it stands on, but without an offset of its own.
    pub(crate) fn item_place(&self, index: usize) -> Pose {
        let item = &self.cell.items[index];
        self.place(item.on.as_ref(), &item.pose)
    }

    /// Where a place truly is that may move with a fixture.
    pub(crate) fn place(&self, on: Option<&On>, nominal: &Pose) -> Pose {
        place(&self.fixtures, on, nominal)
    }

    /// The gripper with its tool, if there is one.
    pub(crate) fn hand(&self) -> Option<Hand<'_>> {
        let gripper = self.cell.gripper.as_ref()?;
        let tool = self.cell.tools.get(usize::from(gripper.tool));
        let tcp = tool.map_or(Pose::identity(), |tool| tool.tcp);
        Some(Hand { gripper, tcp, seed: self.seed })
    }

    /// Where each item truly is at the start.
    pub(crate) fn item_poses(&self) -> impl Iterator<Item = Pose> {
        let streams = (Stream::ItemUniform, Stream::ItemNormal);
        self.cell.items.iter().enumerate().map(move |(index, item)| {
            let offset = drawn_offset(&item.offset, self.seed, streams, index as u64);
            self.item_place(index).compose(&offset)
        })
    }
}

/// Where a thing should truly be, given where the fixtures truly are.
fn place(fixtures: &[Pose], on: Option<&On>, nominal: &Pose) -> Pose {
    on.map_or(*nominal, |on| fixtures[on.fixture].compose(&on.place))
}

/// The sensor with the bias that it has in this run.
fn sensor_of_run(spec: &ForceSensorSpec, seed: u64) -> ForceSensorSpec {
    let mut sensor = *spec;
    if spec.bias_uniform_n > 0.0 {
        sensor.bias_n += spec.bias_uniform_n * random::signed(seed, Stream::BiasUniform, 0);
    }
    if spec.bias_normal_n > 0.0 {
        sensor.bias_n += spec.bias_normal_n * random::normal(seed, Stream::BiasNormal, 0);
    }
    sensor
}

/// The offset of this number.
pub(crate) fn drawn_offset(
    spec: &OffsetSpec,
    seed: u64,
    streams: (Stream, Stream),
    number: u64,
) -> Pose {
    if *spec == OffsetSpec::default() {
        return Pose::identity();
    }
    let mut offset = spec.fixed;
    for (axis, value) in offset.iter_mut().enumerate() {
        let counter = number.wrapping_mul(6).wrapping_add(axis as u64);
        *value += spec.uniform[axis] * random::signed(seed, streams.0, counter);
        *value += spec.normal[axis] * random::normal(seed, streams.1, counter);
    }
    let [x, y, z, a, b, c] = offset;
    Pose::from_rotation_vector([x, y, z], [a, b, c])
}
