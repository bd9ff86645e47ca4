//! A workcell that answers from a recording and commands nothing.
//!
//! A machine that is driven on it as it was driven before goes through the same states, bit for
//! bit. Asked for what the recording does not hold it gives a fault and says so, so that a
//! recording of another run is found out.

use crate::recording::{Command, Frame, Recording, Sense, World};
use obverse_geometry::{JointConfiguration, Pose};
use obverse_workcell::{
    Arm, Clock, Dice, DigitalIo, Fault, ForceTorque, Gripper, ItemId, Items, Motion, MotionReport,
    Safety, ToolId, Watch, Watching, Workcell,
};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// A place in a recording.
#[derive(Clone, Debug)]
pub struct Cursor {
    /// How many commands have been answered.
    frame: usize,
    /// The workcell after them.
    world: World,
    /// Readings: shared with those that only look.
    senses: RefCell<Readings>,
    /// Whether something was asked that the recording does not hold.
    is_lost: bool,
}

#[derive(Clone, Debug, Default)]
struct Readings {
    /// How many there were.
    count: u64,
    /// The next that is not as the one before.
    next: usize,
    known: BTreeMap<Sense, u64>,
}

impl Cursor {
    /// The start of a recording.
    #[must_use]
    pub fn start(recording: &Recording) -> Self {
        let world = recording.start.clone();
        Self { frame: 0, world, senses: RefCell::default(), is_lost: false }
    }

    /// The end of a recording that goes on: the workcell there, how many commands it was given,
    /// how many readings are recorded, and how many there were with what the last of each gave.
    pub(crate) fn here(
        world: World,
        frame: usize,
        next: usize,
        (count, known): (u64, BTreeMap<Sense, u64>),
    ) -> Self {
        Self { frame, world, senses: RefCell::new(Readings { count, next, known }), is_lost: false }
    }

    /// How many commands have been answered.
    #[must_use]
    pub fn frame(&self) -> usize {
        self.frame
    }

    /// The workcell here.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The level of an input when it was last read; none if it was not.
    #[must_use]
    pub fn input(&self, bit: u16) -> Option<bool> {
        let known = self.senses.borrow();
        known.known.get(&Sense::Input(bit)).map(|value| *value == 1)
    }

    /// Whether something was asked that the recording does not hold.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.is_lost
    }

    /// How many readings there were, how many of them are recorded, and what the last of each gave.
    pub(crate) fn known(&self) -> (u64, BTreeMap<Sense, u64>) {
        let senses = self.senses.borrow();
        (senses.count, senses.known.clone())
    }

    /// How many of the recorded readings have been given.
    pub(crate) fn readings(&self) -> usize {
        self.senses.borrow().next
    }

    /// Let all commands up to a number be done.
    pub(crate) fn go_to_frame(&mut self, recording: &Recording, frame: usize) {
        while self.frame < frame {
            let Some(next) = recording.log.frames.get(self.frame) else { return };
            recording.log.apply(next, &mut self.world);
            self.frame += 1;
        }
    }
}

/// A workcell that answers from a recording.
pub struct Replay<'r> {
    recording: &'r Recording,
    cursor: &'r mut Cursor,
}

impl<'r> Replay<'r> {
    /// From a place on.
    pub fn new(recording: &'r Recording, cursor: &'r mut Cursor) -> Self {
        Self { recording, cursor }
    }

    /// The next command of the recording, if it is one that was asked for.
    fn next(&mut self, is_asked: impl Fn(&Command) -> bool) -> Result<&'r Frame, Fault> {
        let next = self.recording.log.frames.get(self.cursor.frame);
        match next.filter(|frame| is_asked(&frame.command)) {
            Some(frame) => {
                self.recording.log.apply(frame, &mut self.cursor.world);
                self.cursor.frame += 1;
                match self.recording.log.fault(frame) {
                    Some(fault) => Err(fault.clone()),
                    None => Ok(frame),
                }
            }
            None => {
                self.cursor.is_lost = true;
                Err(Fault::BadCommand { why: "the recording is of another run".to_owned() })
            }
        }
    }

    fn sense(&self, sense: Sense) -> Option<u64> {
        let mut senses = self.cursor.senses.borrow_mut();
        senses.count += 1;
        let next = self.recording.log.readings.get(senses.next);
        if let Some(reading) = next.filter(|next| next.number == senses.count) {
            senses.next += 1;
            if let Sense::Draw(_) = sense {
                return Some(reading.value);
            }
            senses.known.insert(reading.sense, reading.value);
        }
        senses.known.get(&sense).copied()
    }
}

impl Arm for Replay<'_> {
    fn joints(&self) -> JointConfiguration {
        self.cursor.world.joints
    }

    fn execute(&mut self, _: &Motion) -> Result<MotionReport, Fault> {
        self.next(|command| matches!(command, Command::Execute(_)))?;
        Ok(self.cursor.world.last_motion)
    }

    fn last_motion(&self) -> MotionReport {
        self.cursor.world.last_motion
    }

    fn way_m(&self) -> f64 {
        self.cursor.world.way_m
    }
}

impl Safety for Replay<'_> {
    fn is_stopped(&self) -> bool {
        self.cursor.world.is_stopped
    }

    fn release(&mut self) {}
}

impl DigitalIo for Replay<'_> {
    fn output_count(&self) -> u16 {
        self.recording.facts.outputs
    }

    fn output(&self, bit: u16) -> bool {
        self.cursor.world.outputs.get(usize::from(bit)).copied().unwrap_or(false)
    }

    fn set_output(&mut self, bit: u16, level: bool) -> Result<(), Fault> {
        let is_asked = |command: &Command| match command {
            Command::Output { bit: of, level: to, .. } => (*of, *to) == (bit, level),
            _ => false,
        };
        self.next(is_asked).map(|_| ())
    }

    fn input_count(&self) -> u16 {
        self.recording.facts.inputs
    }

    fn input(&self, bit: u16) -> Result<bool, Fault> {
        match self.sense(Sense::Input(bit)) {
            Some(value @ 0..=1) => Ok(value == 1),
            _ => Err(Fault::Missing { what: format!("input {bit}") }),
        }
    }
}

impl Gripper for Replay<'_> {
    fn held(&self) -> Option<ItemId> {
        self.cursor.world.held
    }
}

impl ForceTorque for Replay<'_> {
    fn force_n(&self) -> f64 {
        f64::from_bits(self.sense(Sense::Force).unwrap_or(0))
    }
}

impl Clock for Replay<'_> {
    fn now_s(&self) -> f64 {
        self.cursor.world.now_s
    }

    fn wait(&mut self, duration_s: f64) -> Result<(), Fault> {
        let is_asked = |command: &Command| match command {
            Command::Wait(recorded_s) => recorded_s.to_bits() == duration_s.to_bits(),
            _ => false,
        };
        self.next(is_asked).map(|_| ())
    }
}

impl Watching for Replay<'_> {
    /// What came to hold is in the recording.
    fn watch(&mut self, _: &[Watch]) {}

    fn watch_again(&mut self, _: u16) {}
}

impl Dice for Replay<'_> {
    fn draw(&self, counter: u64) -> f64 {
        f64::from_bits(self.sense(Sense::Draw(counter)).unwrap_or(0))
    }
}

impl Items for Replay<'_> {
    fn item(&self, name: &str) -> Option<ItemId> {
        let mut items = self.recording.facts.items.iter();
        items.find(|(known, ..)| known == name).map(|(_, id, _)| *id)
    }

    fn nominal_pose(&self, item: ItemId) -> Option<Pose> {
        let mut items = self.recording.facts.items.iter();
        items.find(|(_, id, _)| *id == item).and_then(|(.., pose)| *pose)
    }

    fn tool(&self, name: &str) -> Option<ToolId> {
        let mut tools = self.recording.facts.tools.iter();
        tools.find(|(known, _)| known == name).map(|(_, id)| *id)
    }

    fn initial_tool(&self) -> ToolId {
        self.recording.facts.initial_tool.unwrap_or(ToolId(0))
    }
}

impl Workcell for Replay<'_> {}
