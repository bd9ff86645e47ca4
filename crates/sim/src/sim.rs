//! The workcell in motion: the state of a [`Sim`] and the capabilities it offers.
//!
//! Holds what changes (joints, levels, items, time) beside what does not (the [`Cell`] and the
//! seed). How a motion is carried out is in `travel`.

use crate::cell::Cell;
use crate::faults::{Acts, FaultPlan, Interruption, StopKind};
use crate::feeders::Feeder;
use crate::gripper::Inventory;
use crate::inputs::{Output, Sources, Wire};
use crate::kinematics::forward;
use crate::random::{self, Stream, counter_of};
use crate::seating::Seating;
use crate::sensor::Sensor;
use crate::watching::{Of, Watched};
use crate::world::World;
use obverse_geometry::{JointConfiguration, Pose};
use obverse_workcell::{
    Arm, Clock, Dice, DigitalIo, Fault, ForceTorque, Gripper, ItemId, Items, Motion, MotionEnd,
    MotionReport, Safety, ToolId, Workcell,
};
use std::sync::Arc;

/// No act of waiting is longer, in seconds: a year.
const WAIT_S_MAX: f64 = 366.0 * 86_400.0;

/// A kinematic workcell. Everything it does follows from its cell, its seed and the commands.
#[derive(Clone, Debug)]
pub struct Sim {
    pub(crate) world: Arc<World>,
    pub(crate) joints: JointConfiguration,
    pub(crate) now_s: f64,
    pub(crate) stopped: bool,
    pub(crate) acts: Acts,
    pub(crate) outputs: Vec<Output>,
    /// The wires of the inputs; none if all are as they should be.
    pub(crate) wires: Vec<Wire>,
    pub(crate) feeders: Vec<Feeder>,
    /// How many motions were begun.
    pub(crate) motions: u64,
    /// How many things have fallen.
    pub(crate) falls: u64,
    pub(crate) items: Inventory,
    /// How each item is in a seat, if it is in one.
    pub(crate) seatings: Vec<Option<Seating>>,
    /// By goal: whether a part has met it that is no longer called by its name.
    pub(crate) goals_met_before: Vec<bool>,
    /// The contact force where the arm stands, in newtons.
    pub(crate) force_n: f64,
    pub(crate) last_motion: MotionReport,
    /// How far the tool centre point has gone, in metres.
    pub(crate) way_m: f64,
    pub(crate) watched: Watched,
    /// How often one motion may be looked at for contact, if not as often as it takes.
    pub(crate) looks_max: Option<u32>,
}

impl Sim {
    /// A workcell as its file describes it; the seed decides what the file leaves uncertain.
    #[must_use]
    pub fn new(cell: &Cell, seed: u64) -> Self {
        Self::shared(Arc::new(cell.clone()), seed)
    }

    /// The same, of a cell that many have in common: nothing of it is copied.
    #[must_use]
    pub fn shared(cell: Arc<Cell>, seed: u64) -> Self {
        let world = World::new(cell, seed);
        let cell = &world.cell;
        let mut items = Inventory::new(world.item_poses());
        let feeders = Feeder::all(&world, &mut items);
        let mut sim = Self {
            joints: cell.arm.home,
            now_s: 0.0,
            stopped: false,
            acts: Acts::default(),
            outputs: vec![Output::default(); usize::from(cell.output_count)],
            wires: Vec::new(),
            feeders,
            motions: 0,
            falls: 0,
            items,
            seatings: vec![None; world.cell.items.len()],
            goals_met_before: vec![false; world.cell.goals.len()],
            force_n: 0.0,
            last_motion: MotionReport {
                end: MotionEnd::Reached,
                distance_m: 0.0,
                peak_force_n: 0.0,
                duration_s: 0.0,
            },
            way_m: 0.0,
            world: Arc::new(world),
            watched: Watched::default(),
            looks_max: None,
        };
        // A gripper that is closed without power holds what is in it from the start.
        if sim.world.cell.gripper.is_some_and(|gripper| !gripper.closed_level) {
            sim.close_gripper();
        }
        sim.wire();
        sim
    }

    /// Draw anew what is still to come: where fixtures truly are, noise, and chance. Items stay
    /// where they are.
    pub fn reseed(&mut self, seed: u64) {
        self.world = Arc::new(World::new(self.world.cell.clone(), seed));
    }

    /// Stop an act part way by a protective stop; a plan for an act that was begun already does
    /// nothing.
    pub fn inject(&mut self, plan: FaultPlan) {
        self.inject_as(plan, StopKind::Protective);
    }

    /// Stop an act part way; a plan for an act that was begun already does nothing.
    pub fn inject_as(&mut self, plan: FaultPlan, kind: StopKind) {
        self.acts.inject(plan, kind);
    }

    /// How many acts (calls of `execute`, `set_output` and `wait`) were begun.
    #[must_use]
    pub fn acts_begun(&self) -> u64 {
        self.acts.begun()
    }

    /// The cell as its file describes it.
    #[must_use]
    pub fn cell(&self) -> &Cell {
        &self.world.cell
    }

    /// Where an item truly is, in the base frame, if it is in the cell: what tests and observers
    /// may know, not programs.
    #[must_use]
    pub fn true_pose(&self, item: ItemId) -> Option<Pose> {
        self.items.pose(usize::from(item.0), &self.joints)
    }

    /// How an item is in a seat, if it was brought into one: what tests and observers may know.
    #[must_use]
    pub fn seating(&self, item: ItemId) -> Option<&Seating> {
        self.seatings.get(usize::from(item.0))?.as_ref()
    }

    /// The whole state of the world as numbers, beyond what a program can command: the clock, a
    /// stop, and where every item truly is.
    pub fn world_state(&self, sink: &mut dyn FnMut(u64)) {
        self.commanded_state(sink);
        sink(self.now_s.to_bits());
        sink(u64::from(self.stopped));
        for index in 0..self.items.count() {
            if let Some(pose) = self.items.pose(index, &self.joints) {
                pose.rotation.iter().for_each(|x| sink(x.to_bits()));
                pose.translation_m.iter().for_each(|x| sink(x.to_bits()));
            }
        }
        self.seatings_as_numbers(sink);
    }

    /// How items are in seats, as numbers.
    pub(crate) fn seatings_as_numbers(&self, sink: &mut dyn FnMut(u64)) {
        for seating in self.seatings.iter().flatten() {
            sink(seating.depth_m.to_bits());
            sink(seating.turned_rad.to_bits());
            sink(u64::from(seating.crossed));
        }
    }

    fn bit(&self, bit: u16) -> Result<usize, Fault> {
        let index = usize::from(bit);
        if index < self.outputs.len() {
            Ok(index)
        } else {
            Err(Fault::Missing { what: format!("output {bit}") })
        }
    }

    fn drive(&mut self, bit: usize, level: bool) {
        let cell = &self.world.cell;
        let (seed, now_s) = (self.world.seed, self.now_s);
        let stick = cell.chance.output_sticks.get(bit).copied().unwrap_or_default();
        let changed = self.outputs[bit].set(level, now_s, |change| {
            random::happens(stick, seed, Stream::OutputStick, counter_of(bit, change))
        });
        if changed {
            self.follow(bit, level);
            self.settle();
        }
    }

    /// Do what follows from the change of an output.
    fn follow(&mut self, bit: usize, level: bool) {
        let world = self.world.clone();
        for (index, spec) in world.cell.feeders.iter().enumerate() {
            if usize::from(spec.output) == bit && spec.asks_level == level {
                self.keep_met_goals(spec.item);
                self.feeders[index].ask(index, self.now_s, &world, &mut self.items);
                if self.items.held() != Some(spec.item) {
                    self.seatings[spec.item] = None;
                }
            }
        }
        let Some(gripper) = &world.cell.gripper else { return };
        if usize::from(gripper.output) != bit {
            return;
        }
        if level == gripper.closed_level {
            self.close_gripper();
        } else {
            if let Some(seating) = self.items.held().and_then(|item| self.seatings[item].as_mut()) {
                seating.is_held = false;
            }
            // What is let go no longer presses on the sensor.
            let let_go = self.items.open(gripper, &self.joints);
            self.force_n = 0.0;
            if let Some((item, false)) = let_go {
                self.fall_unless_supported(item);
            }
        }
    }

    fn close_gripper(&mut self) {
        let world = self.world.clone();
        if let Some(hand) = world.hand() {
            self.items.close(&world.cell.items, &hand, &self.joints);
        }
    }

    /// Let what time has brought come to pass.
    pub(crate) fn settle(&mut self) {
        if !self.feeders.is_empty() {
            let world = self.world.clone();
            for (index, feeder) in self.feeders.iter_mut().enumerate() {
                feeder.arrive(index, self.now_s, &world, &mut self.items);
            }
        }
        if !self.wires.is_empty() {
            let mut wires = std::mem::take(&mut self.wires);
            let chance = &self.world.cell.chance;
            let rules = chance.input_flaws.iter().zip(&self.world.cell.inputs);
            self.with_sources(|sources| {
                for (input, (wire, (flaw, rule))) in wires.iter_mut().zip(rules).enumerate() {
                    wire.follow(flaw, rule, sources, self.world.seed, input);
                }
            });
            self.wires = wires;
        }
    }

    /// Connect the wires that may be flawed, each at its level.
    fn wire(&mut self) {
        let flawed = self.world.cell.chance.input_flaws.len();
        let rules = self.world.cell.inputs.iter().take(flawed);
        let levels =
            self.with_sources(|sources| rules.map(|rule| sources.level(rule)).collect::<Vec<_>>());
        self.wires = levels.into_iter().map(Wire::new).collect();
    }

    fn with_sources<T>(&self, ask: impl FnOnce(&Sources<'_>) -> T) -> T {
        let feeders = &self.world.cell.feeders;
        let is_part_there = |feeder: usize| {
            let spec = feeders.get(feeder);
            spec.is_some_and(|spec| Feeder::has_part(spec, &self.world, &self.items, &self.joints))
        };
        ask(&Sources {
            outputs: &self.outputs,
            now_s: self.now_s,
            is_holding: self.items.held().is_some(),
            is_part_there: &is_part_there,
        })
    }

    /// Stop in the middle of an act.
    pub(crate) fn interrupt(&mut self, interruption: Interruption) -> Fault {
        self.stopped |= interruption.kind != StopKind::Short;
        interruption.fault()
    }
}

impl Arm for Sim {
    fn joints(&self) -> JointConfiguration {
        self.joints
    }

    fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Fault> {
        let planned = self.acts.begin();
        if self.stopped {
            return Err(Fault::Stopped);
        }
        self.look(Of::All, 0.0)?;
        let number = self.motions;
        self.motions += 1;
        let by_chance = Interruption::by_chance(&self.world.cell.chance, self.world.seed, number);
        self.travel(motion, planned.or(by_chance))
    }

    fn last_motion(&self) -> MotionReport {
        self.last_motion
    }

    fn way_m(&self) -> f64 {
        self.way_m
    }
}

impl Safety for Sim {
    fn is_stopped(&self) -> bool {
        self.stopped
    }

    fn release(&mut self) {
        self.stopped = false;
    }
}

impl DigitalIo for Sim {
    fn output_count(&self) -> u16 {
        self.world.cell.output_count
    }

    fn output(&self, bit: u16) -> bool {
        self.outputs.get(usize::from(bit)).is_some_and(|output| output.level)
    }

    fn set_output(&mut self, bit: u16, level: bool) -> Result<(), Fault> {
        let interruption = self.acts.begin();
        let index = self.bit(bit)?;
        self.look(Of::All, 0.0)?;
        if let Some(interruption) = interruption {
            if interruption.fraction >= 0.5 {
                self.drive(index, level);
            }
            return Err(self.interrupt(interruption));
        }
        self.drive(index, level);
        self.look(Of::All, 1.0)?;
        self.watched.take_noticed()
    }

    fn input_count(&self) -> u16 {
        u16::try_from(self.world.cell.inputs.len()).unwrap_or(u16::MAX)
    }

    fn input(&self, bit: u16) -> Result<bool, Fault> {
        let rule = self.world.cell.inputs.get(usize::from(bit));
        let rule = rule.ok_or_else(|| Fault::Missing { what: format!("input {bit}") })?;
        Ok(match self.wires.get(usize::from(bit)) {
            Some(wire) => wire.level(self.now_s, self.world.seed, usize::from(bit)),
            None => self.with_sources(|sources| sources.level(rule)),
        })
    }
}

impl Gripper for Sim {
    fn held(&self) -> Option<ItemId> {
        self.items.held().and_then(|index| u16::try_from(index).ok()).map(ItemId)
    }
}

impl ForceTorque for Sim {
    fn force_n(&self) -> f64 {
        let sensor = Sensor { spec: &self.world.sensor, seed: self.world.seed };
        sensor.settled_n(self.force_n, self.now_s)
    }
}

impl Clock for Sim {
    fn now_s(&self) -> f64 {
        self.now_s
    }

    fn wait(&mut self, duration_s: f64) -> Result<(), Fault> {
        let interruption = self.acts.begin();
        if !(0.0..=WAIT_S_MAX).contains(&duration_s) {
            let why = format!("a wait of {duration_s} s, which must be from 0 to {WAIT_S_MAX} s");
            return Err(Fault::BadCommand { why });
        }
        self.look(Of::All, 0.0)?;
        let whole = interruption.map_or(1.0, |interruption| interruption.fraction);
        self.pass(self.now_s + duration_s * whole, |passed_s| passed_s / duration_s)?;
        self.settle();
        if let Some(interruption) = interruption {
            return Err(self.interrupt(interruption));
        }
        self.look(Of::All, 1.0)?;
        self.watched.take_noticed()
    }
}

impl Dice for Sim {
    fn draw(&self, counter: u64) -> f64 {
        random::unit(self.world.seed, Stream::Dice, counter)
    }
}

impl Items for Sim {
    fn item(&self, name: &str) -> Option<ItemId> {
        let index = self.world.cell.items.iter().position(|item| item.name == name)?;
        u16::try_from(index).ok().map(ItemId)
    }

    fn nominal_pose(&self, item: ItemId) -> Option<Pose> {
        self.world.cell.items.get(usize::from(item.0)).map(|item| item.pose)
    }

    fn tool(&self, name: &str) -> Option<ToolId> {
        let index = self.world.cell.tools.iter().position(|tool| tool.name == name)?;
        u16::try_from(index).ok().map(ToolId)
    }

    fn initial_tool(&self) -> ToolId {
        ToolId(0)
    }
}

impl Workcell for Sim {}

/// Where the tool centre point is.
pub(crate) fn tcp_of(joints: &JointConfiguration, tcp: &Pose) -> Pose {
    forward(joints).compose(tcp)
}
