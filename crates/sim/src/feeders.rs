//! Feeders: what presents an item when an output asks, after a while, and not always as it should.
//!
//! Every asking brings a fresh part under the item's name: what was called so before is gone from
//! where it lay. While the gripper holds the item nothing comes. Knows nothing of wires.

use crate::cell::{FeederSpec, OffsetSpec};
use crate::gripper::Inventory;
use crate::random::{self, Stream, counter_of};
use crate::world::{World, drawn_offset};
use obverse_geometry::{JointConfiguration, Pose};

/// A feeder now.
#[derive(Clone, Debug)]
pub(crate) struct Feeder {
    askings: u64,
    /// How many parts it presented.
    parts: u64,
    /// How many it has left, if that is limited.
    left: Option<u32>,
    /// When the part is there that is on its way.
    due_s: Option<f64>,
    /// Whether it had nothing when it was asked last.
    pub(crate) is_empty: bool,
}

impl Feeder {
    /// Every feeder of a cell; what is not ready has no part yet.
    pub(crate) fn all(world: &World, items: &mut Inventory) -> Vec<Self> {
        let feeder = |(index, spec): (usize, &FeederSpec)| {
            let (left, is_empty) = (spec.parts, false);
            let mut feeder = Self { askings: 0, parts: 0, left, due_s: None, is_empty };
            items.remove(spec.item);
            if spec.is_ready {
                feeder.present(index, world, items);
            }
            feeder
        };
        world.cell.feeders.iter().enumerate().map(feeder).collect()
    }

    /// It is asked for a part.
    pub(crate) fn ask(&mut self, index: usize, now_s: f64, world: &World, items: &mut Inventory) {
        let spec = &world.cell.feeders[index];
        if items.held() == Some(spec.item) {
            return;
        }
        items.remove(spec.item);
        let number = counter_of(index, self.askings);
        self.askings += 1;
        self.is_empty = self.left == Some(0)
            || random::happens(spec.empty, world.seed, Stream::FeederEmpty, number);
        self.due_s = (!self.is_empty).then_some(now_s + spec.delay_s);
        if !self.is_empty {
            self.left = self.left.map(|left| left - 1);
        }
    }

    /// Present what is due by now.
    pub(crate) fn arrive(
        &mut self,
        index: usize,
        now_s: f64,
        world: &World,
        items: &mut Inventory,
    ) {
        if self.due_s.is_some_and(|due_s| due_s <= now_s) {
            self.due_s = None;
            self.present(index, world, items);
        }
    }

    fn present(&mut self, index: usize, world: &World, items: &mut Inventory) {
        let (spec, seed) = (&world.cell.feeders[index], world.seed);
        let number = counter_of(index, self.parts);
        self.parts += 1;
        let draw = |offset: &OffsetSpec, streams| drawn_offset(offset, seed, streams, number);
        let usual = &world.cell.items[spec.item].offset;
        let mut offset = draw(usual, (Stream::PartUniform, Stream::PartNormal));
        let is_askew = random::happens(spec.askew, seed, Stream::FeederAskew, number);
        if is_askew {
            let streams = (Stream::AskewUniform, Stream::AskewNormal);
            offset = offset.compose(&draw(&spec.askew_offset, streams));
        }
        items.present(spec.item, world.item_place(spec.item).compose(&offset), is_askew);
    }

    /// When the part is there that is on its way, if that is after a time.
    pub(crate) fn due_after_s(&self, time_s: f64) -> Option<f64> {
        self.due_s.filter(|due_s| *due_s > time_s)
    }

    /// Whether the part is at its place, held or not.
    pub(crate) fn has_part(
        spec: &FeederSpec,
        world: &World,
        items: &Inventory,
        joints: &JointConfiguration,
    ) -> bool {
        items.pose(spec.item, joints).is_some_and(|pose| {
            let place: Pose = world.item_place(spec.item);
            (pose.translation_m - place.translation_m).norm() <= spec.near_m
        })
    }
}
