//! What a motion does to items beside moving them: what is held slips, what stands is knocked over,
//! and what is let go over nothing falls.
//!
//! Everything follows from the motion and the state of the cell, and from draws by the number of
//! the motion. Knows nothing of programs.

use crate::bodies::resting;
use crate::cell::{SlipSpec, ToolSpec};
use crate::fall::Falling;
use crate::gripper::Rest;
use crate::random::{self, Stream};
use crate::route::Route;
use crate::sim::{Sim, tcp_of};
use crate::sweep::Push;
use crate::world::{Owner, World, drawn_offset};
use obverse_geometry::Pose;
use std::f64::consts::TAU;

/// How deep a peg must be in a hole so as not to be knocked over, in metres.
const SEATED_M: f64 = 1e-3;

/// A motion that was carried out, as far as it came.
pub(crate) struct Travelled<'a> {
    pub(crate) route: &'a Route,
    /// How far it came.
    pub(crate) fraction: f64,
    /// The largest contact force that it met, in newtons.
    pub(crate) most_n: f64,
    pub(crate) pushed: Option<Push>,
    pub(crate) tool: &'a ToolSpec,
}

impl Travelled<'_> {
    /// The greatest speed of the tool centre point, in metres a second. A motion by joints counts
    /// as one on the arc that its ends and its largest turn are of.
    fn speed_m_per_s(&self) -> f64 {
        let speed = self.route.profile.speed();
        if self.route.line.is_some() {
            return speed;
        }
        let tcp = |joints| tcp_of(joints, &self.tool.tcp).translation_m;
        let way_m = (tcp(&self.route.from) - tcp(&self.route.to)).norm();
        let turn_rad = self.route.from.largest_difference_rad(&self.route.to);
        if turn_rad > 0.0 { speed * way_m / turn_rad } else { 0.0 }
    }
}

impl Sim {
    /// Let happen to items what follows from a motion.
    pub(crate) fn suffer(&mut self, travelled: &Travelled<'_>) {
        if let (Some(push), Some(falling)) = (travelled.pushed, self.world.cell.falling)
            && push.force_n > falling.knock_n
            && self.items.rest(push.item) == Rest::Standing
            && !self.is_seated(push.item)
        {
            let towards = push.towards_n.map(|component_n| component_n / push.force_n);
            self.fall(push.item, towards, Rest::Knocked);
        }
        let slip = self.world.cell.gripper.and_then(|gripper| gripper.slip);
        if let Some(slip) = slip
            && travelled.fraction > 0.0
        {
            self.slip(&slip, travelled);
        }
    }

    fn slip(&mut self, slip: &SlipSpec, travelled: &Travelled<'_>) {
        let world = self.world.clone();
        let (Some(item), Some(hand)) = (self.items.held(), world.hand()) else { return };
        let (seed, number) = (world.seed, self.motions);
        let mut probability = slip.probability;
        if travelled.most_n > slip.contact_n {
            probability = probability.max(slip.in_contact);
        }
        if slip.fast > probability && travelled.speed_m_per_s() > slip.fast_m_per_s {
            probability = slip.fast;
        }
        if !random::happens(probability, seed, Stream::Slip, number) {
            return;
        }
        if random::happens(slip.lost, seed, Stream::SlipLost, number) {
            self.lose(item);
            return;
        }
        let streams = (Stream::SlipUniform, Stream::SlipNormal);
        let mut by = drawn_offset(&slip.offset, seed, streams, number);
        if self.force_n > 0.0 {
            // What touches is pushed back into the gripper: it gives way there and no other.
            let along_m = by.translation_m.norm();
            by = Pose::from_rotation_vector([0.0, 0.0, -along_m], [0.0; 3]);
        }
        self.items.slip(&hand, &by);
    }

    /// The gripper loses what it holds; a peg that is in a hole stays there.
    fn lose(&mut self, item: usize) {
        let world = self.world.clone();
        if let Some(gripper) = &world.cell.gripper {
            self.items.open(gripper, &self.joints);
            self.force_n = 0.0;
            if let Some(seating) = &mut self.seatings[item] {
                seating.is_held = false;
            }
            if !self.is_seated(item) {
                self.fall_anyhow(item);
            }
        }
    }

    /// What was let go falls if nothing is right below it, in a cell where things fall.
    pub(crate) fn fall_unless_supported(&mut self, item: usize) {
        let Some(falling) = self.world.cell.falling else { return };
        let world = self.world.clone();
        let is_supported = self.items.pose(item, &self.joints).is_none_or(|pose| {
            self.with_falling(&world, item, |thing| thing.is_supported(&pose, falling.support_m))
        });
        if !is_supported {
            self.fall_anyhow(item);
        }
    }

    /// It falls to a side that is drawn.
    fn fall_anyhow(&mut self, item: usize) {
        let angle_rad = TAU * random::unit(self.world.seed, Stream::Fall, self.falls);
        self.falls += 1;
        self.fall(item, [libm::cos(angle_rad), libm::sin(angle_rad)], Rest::Dropped);
    }

    fn fall(&mut self, item: usize, towards: [f64; 2], rest: Rest) {
        let world = self.world.clone();
        let Some(from) = self.items.pose(item, &self.joints) else { return };
        self.seatings[item] = None;
        match self.with_falling(&world, item, |thing| thing.lies(&from, towards)) {
            Some(pose) => self.items.lay(item, pose, rest),
            None => self.items.remove(item),
        }
    }

    /// Ask about an item among all else that stands in the cell.
    fn with_falling<T>(
        &self,
        world: &World,
        item: usize,
        ask: impl FnOnce(&Falling<'_>) -> T,
    ) -> T {
        let resting = resting(&world.cell, &self.items);
        let others = resting.iter().filter(|standing| standing.owner != Owner::Item(item));
        let obstacles = world.fixed.iter().chain(others).map(|standing| &standing.obstacle);
        ask(&Falling::new(&world.cell.items[item].parts, obstacles.collect()))
    }

    /// Whether an item is a peg in a hole.
    fn is_seated(&self, item: usize) -> bool {
        if self.seatings[item].is_some() {
            return true;
        }
        let (Some(peg), Some(pose)) =
            (self.world.cell.items[item].peg, self.items.pose(item, &self.joints))
        else {
            return false;
        };
        let tip_m = pose.translation_m + pose.rotation.column(2) * (0.5 * peg.length_m);
        let mut holes = self.world.fixed.iter().flat_map(|standing| &standing.holes);
        holes.any(|hole| {
            let tip_m = hole.from_base.rotation * tip_m + hole.from_base.translation_m;
            tip_m.z > SEATED_M && tip_m.xy().norm() <= 0.5 * hole.spec.diameter_m
        })
    }
}
