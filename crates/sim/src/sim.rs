//! The workcell in motion: the state of a [`Sim`] and the capabilities it offers.
//!
//! Holds what changes (joints, levels, items, time) beside what does not (the [`Cell`] and the
//! seed). How a motion is carried out is in `travel`.

use crate::cell::Cell;
use crate::faults::{Acts, FaultPlan};
use crate::gripper::Inventory;
use crate::inputs::{self, Output};
use crate::kinematics::forward;
use crate::random::{self, Stream};
use crate::seating::Seating;
use crate::sensor::Sensor;
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
    outputs: Vec<Output>,
    pub(crate) items: Inventory,
    /// How each item is in a seat, if it is in one.
    pub(crate) seatings: Vec<Option<Seating>>,
    /// The contact force where the arm stands, in newtons.
    pub(crate) force_n: f64,
    pub(crate) last_motion: MotionReport,
    /// How often one motion may be looked at for contact, if not as often as it takes.
    pub(crate) looks_max: Option<u32>,
}

impl Sim {
    /// A workcell as its file describes it; the seed decides what the file leaves uncertain.
    #[must_use]
    pub fn new(cell: &Cell, seed: u64) -> Self {
        let world = World::new(cell, seed);
        let mut sim = Self {
            joints: cell.arm.home,
            now_s: 0.0,
            stopped: false,
            acts: Acts::default(),
            outputs: vec![Output::default(); usize::from(cell.output_count)],
            items: Inventory::new(world.item_poses()),
            seatings: vec![None; cell.items.len()],
            force_n: 0.0,
            last_motion: MotionReport {
                end: MotionEnd::Reached,
                distance_m: 0.0,
                peak_force_n: 0.0,
                duration_s: 0.0,
            },
            world: Arc::new(world),
            looks_max: None,
        };
        // A gripper that is closed without power holds what is in it from the start.
        if cell.gripper.is_some_and(|gripper| !gripper.closed_level) {
            sim.close_gripper();
        }
        sim
    }

    /// Stop an act part way; a plan for an act that was begun already does nothing.
    pub fn inject(&mut self, plan: FaultPlan) {
        self.acts.inject(plan);
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

    /// Where an item truly is, in the base frame: what tests and observers may know, not programs.
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
        let changed = self.outputs[bit].level != level;
        self.outputs[bit].set(level, self.now_s);
        let Some(gripper) = self.world.cell.gripper else { return };
        if !changed || usize::from(gripper.output) != bit {
            return;
        }
        if level == gripper.closed_level {
            self.close_gripper();
        } else {
            if let Some(seating) = self.items.held().and_then(|item| self.seatings[item].as_mut()) {
                seating.is_held = false;
            }
            // What is let go no longer presses on the sensor.
            self.items.open(&self.joints);
            self.force_n = 0.0;
        }
    }

    fn close_gripper(&mut self) {
        let cell = &self.world.cell;
        let Some(gripper) = &cell.gripper else { return };
        let tcp = cell.tools.get(usize::from(gripper.tool)).map_or(Pose::identity(), |t| t.tcp);
        self.items.close(&cell.items, gripper, &tcp, &self.joints);
    }

    /// Stop in the middle of an act.
    pub(crate) fn protective_stop(&mut self, fraction: f64) -> Fault {
        self.stopped = true;
        Fault::ProtectiveStop { fraction }
    }
}

impl Arm for Sim {
    fn joints(&self) -> JointConfiguration {
        self.joints
    }

    fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Fault> {
        let interruption = self.acts.begin();
        if self.stopped {
            return Err(Fault::Stopped);
        }
        self.travel(motion, interruption)
    }

    fn last_motion(&self) -> MotionReport {
        self.last_motion
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
        if let Some(fraction) = interruption {
            if fraction >= 0.5 {
                self.drive(index, level);
            }
            return Err(self.protective_stop(fraction));
        }
        self.drive(index, level);
        Ok(())
    }

    fn input_count(&self) -> u16 {
        u16::try_from(self.world.cell.inputs.len()).unwrap_or(u16::MAX)
    }

    fn input(&self, bit: u16) -> Result<bool, Fault> {
        let rule = self.world.cell.inputs.get(usize::from(bit));
        let rule = rule.ok_or_else(|| Fault::Missing { what: format!("input {bit}") })?;
        Ok(inputs::level(rule, &self.outputs, self.now_s, self.items.held().is_some()))
    }
}

impl Gripper for Sim {
    fn held(&self) -> Option<ItemId> {
        self.items.held().and_then(|index| u16::try_from(index).ok()).map(ItemId)
    }
}

impl ForceTorque for Sim {
    fn force_n(&self) -> f64 {
        let sensor = Sensor { spec: &self.world.cell.force_sensor, seed: self.world.seed };
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
        self.now_s += duration_s * interruption.unwrap_or(1.0);
        interruption.map_or(Ok(()), |fraction| Err(self.protective_stop(fraction)))
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
