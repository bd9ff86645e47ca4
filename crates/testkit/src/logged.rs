//! The bookkeeping workcell with a log of what it was commanded, and with things in the way: every
//! third motion that a force may stop is stopped by it half-way.

use crate::Ledger;
use obverse_geometry::{JointConfiguration, Pose};
use obverse_workcell::{
    Arm, Clock, Dice, DigitalIo, Fault, ForceTorque, Gripper, ItemId, Items, Motion, MotionEnd,
    MotionReport, Safety, ToolId, Watch, Watching, Workcell,
};

/// Something that a workcell was told to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// A motion.
    Execute(Motion),
    /// An output and its level.
    Output(u16, bool),
    /// A wait of so many seconds, unless it is none.
    Wait(f64),
}

/// A ledger that remembers its commands.
#[derive(Clone, Debug)]
pub struct Logged {
    /// The workcell.
    pub ledger: Ledger,
    /// What it was told to do.
    pub log: Vec<Command>,
    /// Whether every draw is the same and nothing is ever in the way.
    pub is_steady: bool,
    last: MotionReport,
    motions: u64,
}

impl Logged {
    /// A workcell whose readings and draws follow from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let ledger = Ledger::new(seed);
        let last = ledger.last_motion();
        Self { ledger, log: Vec::new(), is_steady: false, last, motions: 0 }
    }

    /// The same workcell, in which every draw is the same and nothing is ever in the way.
    #[must_use]
    pub fn steady(self) -> Self {
        Self { is_steady: true, ..self }
    }

    /// Whether the motion that is counted last meets something, if it feels for it: whatever other
    /// devices were told meanwhile.
    fn meets_something(&self) -> bool {
        !self.is_steady && (self.ledger.seed ^ self.motions).is_multiple_of(3)
    }
}

impl Arm for Logged {
    fn joints(&self) -> JointConfiguration {
        self.ledger.joints()
    }

    fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Fault> {
        self.log.push(Command::Execute(*motion));
        self.motions += 1;
        let start = self.ledger.joints;
        self.last = self.ledger.execute(motion)?;
        if let Some(limit_n) = motion.force_limit_n.filter(|_| self.meets_something()) {
            self.ledger.joints = start.towards(&self.ledger.joints, 0.5);
            self.last.end = MotionEnd::StoppedByForce;
            self.last.distance_m *= 0.5;
            self.last.peak_force_n = limit_n;
        }
        Ok(self.last)
    }

    fn last_motion(&self) -> MotionReport {
        self.last
    }

    fn way_m(&self) -> f64 {
        self.ledger.way_m()
    }
}

impl Safety for Logged {
    fn is_stopped(&self) -> bool {
        self.ledger.is_stopped()
    }

    fn release(&mut self) {
        self.ledger.release();
    }
}

impl DigitalIo for Logged {
    fn output_count(&self) -> u16 {
        self.ledger.output_count()
    }

    fn output(&self, bit: u16) -> bool {
        self.ledger.output(bit)
    }

    fn set_output(&mut self, bit: u16, level: bool) -> Result<(), Fault> {
        self.log.push(Command::Output(bit, level));
        self.ledger.set_output(bit, level)
    }

    fn input_count(&self) -> u16 {
        self.ledger.input_count()
    }

    fn input(&self, bit: u16) -> Result<bool, Fault> {
        self.ledger.input(bit)
    }
}

impl Gripper for Logged {
    fn held(&self) -> Option<ItemId> {
        self.ledger.held()
    }
}

impl ForceTorque for Logged {
    fn force_n(&self) -> f64 {
        self.ledger.force_n()
    }
}

impl Clock for Logged {
    fn now_s(&self) -> f64 {
        self.ledger.now_s()
    }

    fn wait(&mut self, duration_s: f64) -> Result<(), Fault> {
        if duration_s != 0.0 {
            self.log.push(Command::Wait(duration_s));
        }
        self.ledger.wait(duration_s)
    }
}

impl Watching for Logged {
    fn watch(&mut self, watches: &[Watch]) {
        self.ledger.watch(watches);
    }

    fn watch_again(&mut self, number: u16) {
        self.ledger.watch_again(number);
    }
}

impl Dice for Logged {
    fn draw(&self, counter: u64) -> f64 {
        self.ledger.draw(if self.is_steady { 0 } else { counter })
    }
}

impl Items for Logged {
    fn item(&self, name: &str) -> Option<ItemId> {
        self.ledger.item(name)
    }

    fn nominal_pose(&self, item: ItemId) -> Option<Pose> {
        self.ledger.nominal_pose(item)
    }

    fn tool(&self, name: &str) -> Option<ToolId> {
        self.ledger.tool(name)
    }

    fn initial_tool(&self) -> ToolId {
        self.ledger.initial_tool()
    }
}

impl Workcell for Logged {}
