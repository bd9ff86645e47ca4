//! A workcell that only keeps the books: commands are done at once and exactly, unless the fault
//! plan says otherwise. No kinematics, no contact: what is tested with it is the machine.

use obverse_geometry::{JointConfiguration, Pose};
use obverse_workcell::{
    Arm, Clock, Dice, DigitalIo, Fault, ForceTorque, Goal, Gripper, ItemId, Items, Motion,
    MotionEnd, MotionReport, Safety, ToolId, Watch, Watching, Workcell,
};

/// How many outputs and inputs there are.
pub const LINES: u16 = 8;

/// The books.
#[derive(Clone, Debug)]
pub struct Ledger {
    /// Where the joints are.
    pub joints: JointConfiguration,
    /// The levels of the outputs.
    pub outputs: [bool; LINES as usize],
    /// Seconds.
    pub now_s: f64,
    /// Fixes every draw and every reading.
    pub seed: u64,
    /// How many acts have been commanded.
    pub acts: u64,
    /// The act that is stopped, and how far into it, 0 to 1.
    pub stop_at: Option<(u64, f64)>,
    /// The act in which the first condition that is watched comes to hold, and how far into it.
    pub comes_at: Option<(u64, f64)>,
    /// Whether a stop holds the arm.
    pub is_stopped: bool,
    watches: Vec<Watch>,
    /// What has come to hold in the act at hand, and how far into it.
    came: Option<(Watch, f64)>,
    way_m: f64,
    last: MotionReport,
}

impl Ledger {
    /// A workcell whose readings and draws follow from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self {
            joints: JointConfiguration([0.1, -0.2, 0.3, -0.4, 0.5, -0.6]),
            outputs: [false; LINES as usize],
            now_s: 0.0,
            seed,
            acts: 0,
            stop_at: None,
            comes_at: None,
            is_stopped: false,
            watches: Vec::new(),
            came: None,
            way_m: 0.0,
            last: MotionReport {
                end: MotionEnd::Reached,
                distance_m: 0.0,
                peak_force_n: 0.0,
                duration_s: 0.0,
            },
        }
    }

    /// The same workcell, which stops its act of this number so far into it.
    #[must_use]
    pub fn stopping_at(mut self, act: u64, fraction: f64) -> Self {
        self.stop_at = Some((act, fraction));
        self
    }

    /// Count an act; how far it comes before it is stopped, if it is.
    fn begin(&mut self) -> Result<Option<f64>, Fault> {
        if self.is_stopped {
            return Err(Fault::Stopped);
        }
        let act = self.acts;
        self.acts += 1;
        let at_hand = |planned: Option<(u64, f64)>| {
            planned.filter(|(at, _)| *at == act).map(|(_, fraction)| fraction)
        };
        let stopped = at_hand(self.stop_at);
        let watch = self.watches.first().copied().filter(|_| stopped.is_none());
        self.came = watch.zip(at_hand(self.comes_at));
        let cut = self.came.filter(|(watch, _)| watch.stops);
        Ok(stopped.or(cut.map(|(_, fraction)| fraction)))
    }

    fn stop(&mut self, fraction: f64) -> Fault {
        if let Some((watch, fraction)) = self.came.take() {
            return Fault::Watched { watch, fraction };
        }
        self.is_stopped = true;
        Fault::ProtectiveStop { fraction }
    }

    /// The act is done: what has come to hold in it and has not stopped it.
    fn tell(&mut self) -> Result<(), Fault> {
        let came = self.came.take();
        came.map_or(Ok(()), |(watch, fraction)| Err(Fault::Watched { watch, fraction }))
    }

    fn hash(&self, salt: u64) -> u64 {
        let mut x = self.seed ^ salt.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ x >> 31
    }

    /// Some configuration that follows from a goal: there is no arm to ask.
    fn end_of(&self, goal: &Goal) -> JointConfiguration {
        let from_numbers = |from: JointConfiguration, numbers: &[f64]| {
            let mut joints = from.0;
            for (joint, number) in joints.iter_mut().zip(numbers) {
                *joint += number;
            }
            JointConfiguration(joints)
        };
        match goal {
            Goal::Joints(joints) => *joints,
            Goal::Pose(pose) => {
                from_numbers(JointConfiguration::ZERO, pose.translation_m.as_slice())
            }
            Goal::Displaced { from, distance_m, axis, .. } => {
                let by = axis.unit() * *distance_m;
                from_numbers(*from, by.as_slice())
            }
            Goal::Offset { from, by_m, .. } => from_numbers(*from, by_m),
            Goal::Turned { from, angle_rad, advance_m, axis, .. } => {
                let [along, about] = [*advance_m, *angle_rad].map(|by| axis.unit() * by);
                from_numbers(*from, &[along.x, along.y, along.z, about.x, about.y, about.z])
            }
        }
    }
}

impl Arm for Ledger {
    fn joints(&self) -> JointConfiguration {
        self.joints
    }

    fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Fault> {
        let goal = self.end_of(&motion.goal);
        if !goal.is_finite() {
            return Err(Fault::BadCommand { why: "a joint value is no number".to_owned() });
        }
        let stopped = self.begin()?;
        let began = self.joints;
        let whole_m = began.largest_difference_rad(&goal);
        self.way_m += stopped.unwrap_or(1.0) * whole_m;
        if let Some(fraction) = stopped {
            self.joints = self.joints.towards(&goal, fraction);
            return Err(self.stop(fraction));
        }
        let from = match &motion.goal {
            Goal::Displaced { from, .. }
            | Goal::Offset { from, .. }
            | Goal::Turned { from, .. } => *from,
            Goal::Joints(_) | Goal::Pose(_) => self.joints,
        };
        let distance_m = from.largest_difference_rad(&goal);
        self.joints = goal;
        self.now_s += 1.0;
        self.last = MotionReport {
            end: MotionEnd::Reached,
            distance_m,
            peak_force_n: 0.0,
            duration_s: 1.0,
        };
        self.tell()?;
        Ok(self.last)
    }

    fn last_motion(&self) -> MotionReport {
        self.last
    }

    fn way_m(&self) -> f64 {
        self.way_m
    }
}

impl Safety for Ledger {
    fn is_stopped(&self) -> bool {
        self.is_stopped
    }

    fn release(&mut self) {
        self.is_stopped = false;
    }
}

impl DigitalIo for Ledger {
    fn output_count(&self) -> u16 {
        LINES
    }

    fn output(&self, bit: u16) -> bool {
        self.outputs.get(usize::from(bit)).copied().unwrap_or(false)
    }

    fn set_output(&mut self, bit: u16, level: bool) -> Result<(), Fault> {
        let stopped = self.begin()?;
        if stopped.is_some_and(|fraction| fraction < 0.5) {
            return Err(self.stop(0.0));
        }
        let line = self.outputs.get_mut(usize::from(bit));
        *line.ok_or_else(|| Fault::Missing { what: format!("output {bit}") })? = level;
        match stopped {
            Some(fraction) => Err(self.stop(fraction)),
            None => self.tell(),
        }
    }

    fn input_count(&self) -> u16 {
        LINES
    }

    fn input(&self, bit: u16) -> Result<bool, Fault> {
        Ok(self.hash(u64::from(bit)) & 1 == 1)
    }
}

impl Gripper for Ledger {
    fn held(&self) -> Option<ItemId> {
        self.outputs[0].then_some(ItemId(0))
    }
}

impl ForceTorque for Ledger {
    fn force_n(&self) -> f64 {
        (self.hash(1000) % 100) as f64 / 10.0
    }
}

impl Clock for Ledger {
    fn now_s(&self) -> f64 {
        self.now_s
    }

    fn wait(&mut self, duration_s: f64) -> Result<(), Fault> {
        if !(duration_s >= 0.0 && duration_s.is_finite()) {
            return Err(Fault::BadCommand { why: format!("a wait of {duration_s} s") });
        }
        if let Some(fraction) = self.begin()? {
            self.now_s += duration_s * fraction;
            return Err(self.stop(fraction));
        }
        self.now_s += duration_s;
        self.tell()
    }
}

impl Watching for Ledger {
    fn watch(&mut self, watches: &[Watch]) {
        self.watches = watches.to_vec();
    }

    fn watch_again(&mut self, _: u16) {}
}

impl Dice for Ledger {
    fn draw(&self, counter: u64) -> f64 {
        (self.hash(counter.wrapping_add(1 << 32)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

impl Items for Ledger {
    fn item(&self, _: &str) -> Option<ItemId> {
        Some(ItemId(0))
    }

    fn nominal_pose(&self, _: ItemId) -> Option<Pose> {
        Some(Pose::identity())
    }

    fn tool(&self, name: &str) -> Option<ToolId> {
        Some(ToolId(name.len() as u16))
    }

    fn initial_tool(&self) -> ToolId {
        ToolId(0)
    }
}

impl Workcell for Ledger {}
