//! A workcell in thought: what would come of a command, asked before anything is commanded.
//!
//! A [`Plan`] is a [`Sim`] without chance: everything is where the workcell file says that it
//! should be, and the force sensor has no noise. It answers by a copy of itself that does as asked,
//! with the code that carries out real motions, so that question and act cannot differ. Knows
//! nothing of programs.

use crate::cell::{Cell, ChanceSpec, OffsetSpec};
use crate::robot::LINK_NAMES;
use crate::route::Route;
use crate::sim::Sim;
use obverse_geometry::JointConfiguration;
use obverse_workcell::{Arm, DigitalIo, Fault, Gripper, Motion, MotionReport, Safety};
use std::sync::Arc;

/// How often one motion is looked at for contact: enough for a quarter of a metre along something
/// that it touches all the way.
const LOOKS_MAX: u32 = 1_000;

/// How many times within a period of the force sensor a motion is begun at.
const PHASES: u32 = 8;

/// A workcell that can be asked what would come of a command.
#[derive(Clone, Debug)]
pub struct Plan {
    sim: Sim,
}

/// What of the robot something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    /// A link of the arm.
    Arm,
    /// The tool.
    Tool,
    /// The held item.
    Held,
}

impl Cell {
    /// The same cell without chance: all things where they should be, and no noise.
    #[must_use]
    pub fn nominal(&self) -> Self {
        let mut cell = self.clone();
        cell.items.iter_mut().for_each(|item| item.offset = OffsetSpec::default());
        cell.fixtures.iter_mut().for_each(|fixture| fixture.offset = OffsetSpec::default());
        cell.force_sensor.noise_n = 0.0;
        cell.force_sensor.bias_uniform_n = 0.0;
        cell.force_sensor.bias_normal_n = 0.0;
        for feeder in &mut cell.feeders {
            (feeder.empty, feeder.askew) = (0.0, 0.0);
        }
        if let Some(gripper) = &mut cell.gripper {
            // What centres an item does so without chance.
            (gripper.grasp_offset, gripper.slip) = (OffsetSpec::default(), None);
        }
        cell.chance = ChanceSpec::default();
        cell
    }
}

impl Plan {
    /// A cell at its start, without chance.
    #[must_use]
    pub fn new(cell: &Cell) -> Self {
        let mut cell = cell.nominal();
        // In thought no time passes: what was asked for is there.
        cell.feeders.iter_mut().for_each(|feeder| feeder.delay_s = 0.0);
        let mut sim = Sim::shared(Arc::new(cell), 0);
        sim.looks_max = Some(LOOKS_MAX);
        Self { sim }
    }

    /// The same workcell as something leaves it that is done there first.
    ///
    /// # Errors
    /// Whatever keeps that from being done.
    pub fn led<E>(mut self, lead: impl FnOnce(&mut Sim) -> Result<(), E>) -> Result<Self, E> {
        lead(&mut self.sim)?;
        Ok(self)
    }

    /// The workcell as it would be now.
    #[must_use]
    pub fn workcell(&self) -> &Sim {
        &self.sim
    }

    /// What would come of a motion, and how the workcell would be left; none if it moves in contact
    /// for longer than is looked at.
    #[must_use]
    pub fn after(&self, motion: &Motion) -> Option<(Result<MotionReport, Fault>, Self)> {
        let mut after = self.clone();
        let outcome = after.sim.execute(motion);
        after.sim.release();
        // Nothing else stops a workcell in thought.
        (outcome != Err(Fault::Stopped)).then_some((outcome, after))
    }

    /// What may come of a motion that is stopped by force: that is read from time to time, and
    /// when, relative to the motion, is not known beforehand.
    #[must_use]
    pub fn after_in_phases(&self, motion: &Motion) -> Vec<(Result<MotionReport, Fault>, Self)> {
        let sample_s = self.sim.cell().force_sensor.sample_s;
        let after = |phase: u32| {
            let mut later = self.clone();
            later.sim.now_s += sample_s * f64::from(phase) / f64::from(PHASES);
            later.after(motion)
        };
        (0..PHASES).filter_map(after).collect()
    }

    /// The contact force where the arm stands, in newtons.
    #[must_use]
    pub fn contact_n(&self) -> f64 {
        self.sim.force_n
    }

    /// Where a motion would end if it met nothing.
    ///
    /// # Errors
    /// Why there is no way there: reach, the ranges of the joints, a command that makes no sense.
    pub fn end_of(&self, motion: &Motion) -> Result<JointConfiguration, Fault> {
        Route::plan(&self.sim.world.cell, &self.sim.joints, motion).map(|route| route.to)
    }

    /// The same workcell with the arm elsewhere, with what it holds, however it came there.
    #[must_use]
    pub fn placed_at(&self, joints: JointConfiguration) -> Self {
        let mut placed = self.clone();
        placed.sim.joints = joints;
        placed.sim.force_n = 0.0;
        if let Some(item) = placed.sim.items.held() {
            placed.sim.seatings[item] = None;
        }
        placed
    }

    /// The same workcell with an output at a level, and what follows for the gripper.
    ///
    /// # Errors
    /// There is no such output.
    pub fn with_output(&self, bit: u16, level: bool) -> Result<Self, Fault> {
        let mut set = self.clone();
        set.sim.set_output(bit, level)?;
        Ok(set)
    }

    /// The same workcell without any item.
    #[must_use]
    pub fn without_items(&self) -> Self {
        let mut emptied = self.clone();
        emptied.sim.items.clear();
        emptied
    }

    /// What of the robot a fault means by a name, with such a tool.
    #[must_use]
    pub fn kind_of(&self, body: &str, tool: u16) -> BodyKind {
        let cell = self.sim.cell();
        let held = self.sim.held().and_then(|item| cell.items.get(usize::from(item.0)));
        if cell.tools.get(usize::from(tool)).is_some_and(|tool| tool.name == body) {
            BodyKind::Tool
        } else if held.is_some_and(|item| item.name == body) || !LINK_NAMES.contains(&body) {
            BodyKind::Held
        } else {
            BodyKind::Arm
        }
    }

    /// What the gripper holds and how, and where every other item is, as numbers.
    pub fn items_as_numbers(&self, sink: &mut dyn FnMut(u64)) {
        self.sim.items.each_number(sink);
        self.sim.seatings_as_numbers(sink);
    }
}
