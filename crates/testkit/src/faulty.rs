//! A simulated workcell in which acts go wrong as planned, by any kind of fault there is.

use obverse_geometry::{JointConfiguration, Pose};
use obverse_sim::{FaultPlan, Sim, StopKind};
use obverse_workcell::{
    Arm, Clock, Condition, Dice, DigitalIo, Fault, FaultKind, ForceTorque, Gripper, ItemId, Items,
    Motion, MotionReport, Safety, ToolId, Watch, Watching, Workcell,
};
use std::collections::BTreeMap;

/// A simulated workcell and the acts that go wrong in it.
#[derive(Clone, Debug)]
pub struct Faulty {
    /// The workcell.
    pub sim: Sim,
    /// The acts that are refused, by number.
    refused: BTreeMap<u64, FaultKind>,
}

impl Faulty {
    /// A workcell in which nothing goes wrong but by itself.
    #[must_use]
    pub fn new(sim: Sim) -> Self {
        Self { sim, refused: BTreeMap::new() }
    }

    /// Let an act go wrong by a kind of fault: a stop after a part of its way, what else there is
    /// before anything moves.
    pub fn plan(&mut self, kind: FaultKind, plan: FaultPlan) {
        let stop = match kind {
            FaultKind::ProtectiveStop => StopKind::Protective,
            FaultKind::EmergencyStop => StopKind::Emergency,
            FaultKind::StoppedShort => StopKind::Short,
            _ => {
                self.refused.insert(plan.act, kind);
                return;
            }
        };
        self.sim.inject_as(plan, stop);
    }

    /// Whether the act that is due is refused, which it is once.
    fn refuse(&mut self) -> Result<(), Fault> {
        self.refused.remove(&self.sim.acts_begun()).map_or(Ok(()), |kind| Err(fault(kind)))
    }
}

/// Some fault of a kind.
fn fault(kind: FaultKind) -> Fault {
    match kind {
        FaultKind::JointLimit => {
            Fault::JointLimit { joint: 1, value_rad: 7.0, range_rad: (-6.0, 6.0) }
        }
        FaultKind::OutOfReach => Fault::OutOfReach { at_m: [9.0, 0.0, 0.0] },
        FaultKind::Singular => Fault::Singular { fraction: 0.5 },
        FaultKind::Collision => {
            let (body, with) = ("hand".to_owned(), "table".to_owned());
            Fault::Collision { body, with, fraction: 0.0, force_n: 50.0 }
        }
        FaultKind::ForceLimit => Fault::ForceLimit { force_n: 50.0, limit_n: 20.0 },
        FaultKind::ProtectiveStop => Fault::ProtectiveStop { fraction: 0.0 },
        FaultKind::EmergencyStop => Fault::EmergencyStop { fraction: 0.0 },
        FaultKind::StoppedShort => Fault::StoppedShort { fraction: 0.0 },
        FaultKind::Watched => {
            let condition = Condition::Input { bit: 0, level: true };
            Fault::Watched { watch: Watch { number: 0, condition, stops: true }, fraction: 0.0 }
        }
        FaultKind::Stopped => Fault::Stopped,
        FaultKind::BadCommand => Fault::BadCommand { why: "it is no number".to_owned() },
        FaultKind::Missing => Fault::Missing { what: "output 99".to_owned() },
    }
}

impl Arm for Faulty {
    fn joints(&self) -> JointConfiguration {
        self.sim.joints()
    }

    fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Fault> {
        self.refuse()?;
        self.sim.execute(motion)
    }

    fn last_motion(&self) -> MotionReport {
        self.sim.last_motion()
    }

    fn way_m(&self) -> f64 {
        self.sim.way_m()
    }
}

impl Safety for Faulty {
    fn is_stopped(&self) -> bool {
        self.sim.is_stopped()
    }

    fn release(&mut self) {
        self.sim.release();
    }
}

impl DigitalIo for Faulty {
    fn output_count(&self) -> u16 {
        self.sim.output_count()
    }

    fn output(&self, bit: u16) -> bool {
        self.sim.output(bit)
    }

    fn set_output(&mut self, bit: u16, level: bool) -> Result<(), Fault> {
        self.refuse()?;
        self.sim.set_output(bit, level)
    }

    fn input_count(&self) -> u16 {
        self.sim.input_count()
    }

    fn input(&self, bit: u16) -> Result<bool, Fault> {
        self.sim.input(bit)
    }
}

impl Gripper for Faulty {
    fn held(&self) -> Option<ItemId> {
        self.sim.held()
    }
}

impl ForceTorque for Faulty {
    fn force_n(&self) -> f64 {
        self.sim.force_n()
    }
}

impl Clock for Faulty {
    fn now_s(&self) -> f64 {
        self.sim.now_s()
    }

    fn wait(&mut self, duration_s: f64) -> Result<(), Fault> {
        self.refuse()?;
        self.sim.wait(duration_s)
    }
}

impl Watching for Faulty {
    fn watch(&mut self, watches: &[Watch]) {
        self.sim.watch(watches);
    }

    fn watch_again(&mut self, number: u16) {
        self.sim.watch_again(number);
    }
}

impl Dice for Faulty {
    fn draw(&self, counter: u64) -> f64 {
        self.sim.draw(counter)
    }
}

impl Items for Faulty {
    fn item(&self, name: &str) -> Option<ItemId> {
        self.sim.item(name)
    }

    fn nominal_pose(&self, item: ItemId) -> Option<Pose> {
        self.sim.nominal_pose(item)
    }

    fn tool(&self, name: &str) -> Option<ToolId> {
        self.sim.tool(name)
    }

    fn initial_tool(&self) -> ToolId {
        self.sim.initial_tool()
    }
}

impl Workcell for Faulty {}
