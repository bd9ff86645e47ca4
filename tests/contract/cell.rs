//! The workcell that contracts run on: the bookkeeping one, with a log of what it was commanded,
//! and with readings and draws that are said beforehand.

use obverse_geometry::{JointConfiguration, Pose};
use obverse_testkit::Ledger;
use obverse_testkit::logged::Command;
use obverse_workcell::{
    Arm, Clock, Dice, DigitalIo, Fault, ForceTorque, Goal, Gripper, ItemId, Items, Motion,
    MotionEnd, MotionReport, Safety, ToolId, Watch, Watching, Workcell,
};
use std::collections::BTreeMap;

/// The bookkeeping workcell, told what to read.
pub(crate) struct Cell {
    pub(crate) ledger: Ledger,
    pub(crate) log: Vec<Command>,
    /// The inputs that are high.
    pub(crate) high: Vec<u16>,
    pub(crate) force_n: f64,
    pub(crate) draws: BTreeMap<u64, f64>,
    /// How far a motion with a force limit comes before something is in its way, 0 to 1.
    pub(crate) in_the_way: Option<f64>,
    /// How far the next motion with a force limit that goes to joints comes, 0 to 1.
    pub(crate) holds_back: Option<f64>,
    last: MotionReport,
}

impl Cell {
    pub(crate) fn new() -> Self {
        let ledger = Ledger::new(0);
        Self {
            log: Vec::new(),
            high: Vec::new(),
            force_n: 0.0,
            draws: BTreeMap::new(),
            in_the_way: None,
            holds_back: None,
            last: ledger.last_motion(),
            ledger,
        }
    }
}

impl Arm for Cell {
    fn joints(&self) -> JointConfiguration {
        self.ledger.joints()
    }

    fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Fault> {
        self.log.push(Command::Execute(*motion));
        let start = self.ledger.joints;
        self.last = self.ledger.execute(motion)?;
        let met = match motion.goal {
            Goal::Joints(_) => motion.force_limit_n.and_then(|_| self.holds_back.take()),
            _ => self.in_the_way,
        };
        if let (Some(limit_n), Some(fraction)) = (motion.force_limit_n, met) {
            self.ledger.joints = start.towards(&self.ledger.joints, fraction);
            self.last.end = MotionEnd::StoppedByForce;
            self.last.distance_m *= fraction;
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

impl Safety for Cell {
    fn is_stopped(&self) -> bool {
        self.ledger.is_stopped()
    }

    fn release(&mut self) {
        self.ledger.release();
    }
}

impl DigitalIo for Cell {
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
        Ok(self.high.contains(&bit))
    }
}

impl Gripper for Cell {
    fn held(&self) -> Option<ItemId> {
        self.ledger.held()
    }
}

impl ForceTorque for Cell {
    fn force_n(&self) -> f64 {
        self.force_n
    }
}

impl Clock for Cell {
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

impl Watching for Cell {
    fn watch(&mut self, watches: &[Watch]) {
        self.ledger.watch(watches);
    }

    fn watch_again(&mut self, number: u16) {
        self.ledger.watch_again(number);
    }
}

impl Dice for Cell {
    fn draw(&self, counter: u64) -> f64 {
        self.draws.get(&counter).copied().unwrap_or_else(|| self.ledger.draw(counter))
    }
}

impl Items for Cell {
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

impl Workcell for Cell {}
