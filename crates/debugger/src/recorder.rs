//! A workcell that passes everything on to another one and records what it answers.
//!
//! What an observer asks of it is recorded too, so observers keep to what commands leave: joints,
//! outputs, what is held, the clock. Inputs, the force and draws are the machine's to read.

use crate::recording::{Command, Facts, Frame, Log, Moved, Reading, Sense, World};
use crate::replay::Cursor;
use obverse_bytecode::Module;
use obverse_geometry::{JointConfiguration, Pose};
use obverse_workcell::{
    Arm, Clock, Dice, DigitalIo, Fault, ForceTorque, Gripper, ItemId, Items, Motion, MotionReport,
    Safety, ToolId, Watch, Watching, Workcell,
};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

/// How many copies of a workcell are kept along a run.
const MAX_COPIES: usize = 64;

/// What has been read in a run.
#[derive(Clone, Debug, Default)]
pub struct Senses {
    /// How many readings there were.
    count: u64,
    /// What the last reading of each gave.
    known: BTreeMap<Sense, u64>,
    /// What is to be recorded of them.
    fresh: Vec<Reading>,
}

impl Senses {
    /// Those of a run that has come so far in a recording.
    pub(crate) fn at(cursor: &Cursor) -> Self {
        let (count, known) = cursor.known();
        Self { count, known, fresh: Vec::new() }
    }

    /// How many readings there were, and what the last of each gave.
    pub(crate) fn known(&self) -> (u64, BTreeMap<Sense, u64>) {
        (self.count, self.known.clone())
    }

    /// The level of an input when it was last read; none if it was not.
    pub(crate) fn input(&self, bit: u16) -> Option<bool> {
        self.known.get(&Sense::Input(bit)).map(|value| *value == 1)
    }

    fn note(&mut self, sense: Sense, value: u64) {
        self.count += 1;
        let is_draw = matches!(sense, Sense::Draw(_));
        if is_draw || self.known.get(&sense) != Some(&value) {
            self.fresh.push(Reading { number: self.count, sense, value });
        }
        if !is_draw {
            self.known.insert(sense, value);
        }
    }
}

/// Copies of a simulated workcell along a run.
#[derive(Debug)]
pub struct Copies<C> {
    copy: fn(&C) -> C,
    /// Oldest first.
    kept: Vec<CellCopy<C>>,
    every: usize,
}

/// A simulated workcell as it was.
#[derive(Debug)]
struct CellCopy<C> {
    /// How many commands it had been given.
    frame: usize,
    cell: C,
    /// Whether it follows from none that is older: the first, and where it was changed by hand.
    is_anew: bool,
}

impl<C> Copies<C> {
    /// With a copy of the workcell as it is after so many commands.
    pub(crate) fn new(copy: fn(&C) -> C, frame: usize, cell: &C) -> Self {
        let first = CellCopy { frame, cell: copy(cell), is_anew: true };
        Self { copy, kept: vec![first], every: 8 }
    }

    fn note(&mut self, frame: usize, cell: &C) {
        let newest = self.kept.last().map_or(0, |newest| newest.frame);
        if frame < newest + self.every {
            return;
        }
        if self.kept.len() >= MAX_COPIES {
            let mut index = 0;
            self.kept.retain(|kept| {
                index += 1;
                index % 2 == 1 || kept.is_anew
            });
            self.every *= 2;
        }
        self.kept.push(CellCopy { frame, cell: (self.copy)(cell), is_anew: false });
    }

    /// The workcell was changed by hand after so many commands.
    pub(crate) fn note_changed(&mut self, frame: usize, cell: &C) {
        self.kept.push(CellCopy { frame, cell: (self.copy)(cell), is_anew: true });
    }

    /// A copy of the workcell after at most so many commands, and after how many.
    pub(crate) fn before(&self, frame: usize) -> Option<(usize, C)> {
        let after = self.kept.partition_point(|kept| kept.frame <= frame);
        let found = self.kept.get(after.checked_sub(1)?)?;
        Some((found.frame, (self.copy)(&found.cell)))
    }

    /// Those after at most so many commands.
    pub(crate) fn up_to(&self, frame: usize) -> Self {
        let until = self.kept.partition_point(|kept| kept.frame <= frame);
        let copy = |kept: &CellCopy<C>| CellCopy { cell: (self.copy)(&kept.cell), ..*kept };
        Self { copy: self.copy, kept: self.kept[..until].iter().map(copy).collect(), ..*self }
    }

    /// What the run began with, if it began so.
    pub(crate) fn first(&self) -> Option<&C> {
        self.kept.first().filter(|first| first.frame == 0).map(|first| &first.cell)
    }
}

/// A workcell that records what another one answers.
pub struct Recorder<'r, C> {
    cell: &'r mut C,
    log: &'r mut Log,
    senses: RefCell<&'r mut Senses>,
    copies: Option<&'r mut Copies<C>>,
    /// Inputs that are read as these levels, whatever they are.
    forced: &'r BTreeMap<u16, bool>,
    /// Whether who reads is told of the run, and not the program: that is not recorded.
    is_overheard: &'r Cell<bool>,
    /// Whether the workcell watches what the program says.
    is_watched: bool,
}

impl<'r, C: Workcell> Recorder<'r, C> {
    /// Record what a workcell answers.
    pub fn new(
        cell: &'r mut C,
        log: &'r mut Log,
        senses: &'r mut Senses,
        copies: Option<&'r mut Copies<C>>,
        forced: &'r BTreeMap<u16, bool>,
        is_overheard: &'r Cell<bool>,
    ) -> Self {
        let senses = RefCell::new(senses);
        Self { cell, log, senses, copies, forced, is_overheard, is_watched: false }
    }

    /// The workcell was changed by hand.
    pub(crate) fn changed(&mut self) {
        self.note(Command::Change, None);
    }

    fn read(&self, sense: Sense, value: u64) {
        if !self.is_overheard.get() {
            self.senses.borrow_mut().note(sense, value);
        }
    }

    fn note(&mut self, command: Command, fault: Option<&Fault>) {
        let fault = fault.map(|fault| {
            self.log.faults.push(fault.clone());
            (self.log.faults.len() - 1) as u32
        });
        self.log.frames.push(Frame {
            command,
            fault,
            is_watched: self.is_watched,
            held: self.cell.held(),
            force_n: self.cell.force_n(),
            now_s: self.cell.now_s(),
            is_stopped: self.cell.is_stopped(),
        });
        if let Some(copies) = &mut self.copies {
            copies.note(self.log.frames.len(), self.cell);
        }
    }
}

impl<C> Drop for Recorder<'_, C> {
    fn drop(&mut self) {
        self.log.readings.append(&mut self.senses.get_mut().fresh);
    }
}

/// What a workcell is like.
pub(crate) fn world(cell: &impl Workcell) -> World {
    World {
        joints: cell.joints(),
        outputs: (0..cell.output_count()).map(|bit| cell.output(bit)).collect(),
        held: cell.held(),
        force_n: cell.force_n(),
        last_motion: cell.last_motion(),
        way_m: cell.way_m(),
        now_s: cell.now_s(),
        is_stopped: cell.is_stopped(),
    }
}

/// What a program asks of a workcell that does not change.
pub(crate) fn facts(module: &Module, cell: &impl Workcell) -> Facts {
    let item = |item: &obverse_bytecode::Item| {
        let id = cell.item(&item.name)?;
        Some((item.name.clone(), id, cell.nominal_pose(id)))
    };
    let tool = |name: &String| Some((name.clone(), cell.tool(name)?));
    Facts {
        outputs: cell.output_count(),
        inputs: cell.input_count(),
        items: module.items.iter().filter_map(item).collect(),
        tools: module.tools.iter().filter_map(tool).collect(),
        initial_tool: Some(cell.initial_tool()),
    }
}

impl<C: Workcell> Arm for Recorder<'_, C> {
    fn joints(&self) -> JointConfiguration {
        self.cell.joints()
    }

    fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Fault> {
        let result = self.cell.execute(motion);
        let (joints, last, way_m) =
            (self.cell.joints(), self.cell.last_motion(), self.cell.way_m());
        self.log.motions.push(Moved { motion: *motion, joints, last, way_m });
        let index = (self.log.motions.len() - 1) as u32;
        self.note(Command::Execute(index), result.as_ref().err());
        result
    }

    fn last_motion(&self) -> MotionReport {
        self.cell.last_motion()
    }

    fn way_m(&self) -> f64 {
        self.cell.way_m()
    }
}

impl<C: Workcell> Safety for Recorder<'_, C> {
    fn is_stopped(&self) -> bool {
        self.cell.is_stopped()
    }

    fn release(&mut self) {
        self.cell.release();
        self.note(Command::Release, None);
    }
}

impl<C: Workcell> DigitalIo for Recorder<'_, C> {
    fn output_count(&self) -> u16 {
        self.cell.output_count()
    }

    fn output(&self, bit: u16) -> bool {
        self.cell.output(bit)
    }

    fn set_output(&mut self, bit: u16, level: bool) -> Result<(), Fault> {
        let result = self.cell.set_output(bit, level);
        let became = self.cell.output(bit);
        self.note(Command::Output { bit, level, became }, result.as_ref().err());
        result
    }

    fn input_count(&self) -> u16 {
        self.cell.input_count()
    }

    fn input(&self, bit: u16) -> Result<bool, Fault> {
        let read = match self.forced.get(&bit) {
            Some(level) => Ok(*level),
            None => self.cell.input(bit),
        };
        let value = read.as_ref().map_or(2, |level| u64::from(*level));
        self.read(Sense::Input(bit), value);
        read
    }
}

impl<C: Workcell> Gripper for Recorder<'_, C> {
    fn held(&self) -> Option<ItemId> {
        self.cell.held()
    }
}

impl<C: Workcell> ForceTorque for Recorder<'_, C> {
    fn force_n(&self) -> f64 {
        let force_n = self.cell.force_n();
        self.read(Sense::Force, force_n.to_bits());
        force_n
    }
}

impl<C: Workcell> Clock for Recorder<'_, C> {
    fn now_s(&self) -> f64 {
        self.cell.now_s()
    }

    fn wait(&mut self, duration_s: f64) -> Result<(), Fault> {
        let result = self.cell.wait(duration_s);
        self.note(Command::Wait(duration_s), result.as_ref().err());
        result
    }
}

impl<C: Workcell> Watching for Recorder<'_, C> {
    fn watch(&mut self, watches: &[Watch]) {
        self.is_watched = !watches.is_empty();
        self.cell.watch(watches);
    }

    fn watch_again(&mut self, number: u16) {
        self.cell.watch_again(number);
        self.note(Command::WatchAgain(number), None);
    }
}

impl<C: Workcell> Dice for Recorder<'_, C> {
    fn draw(&self, counter: u64) -> f64 {
        let draw = self.cell.draw(counter);
        self.read(Sense::Draw(counter), draw.to_bits());
        draw
    }
}

impl<C: Workcell> Items for Recorder<'_, C> {
    fn item(&self, name: &str) -> Option<ItemId> {
        self.cell.item(name)
    }

    fn nominal_pose(&self, item: ItemId) -> Option<Pose> {
        self.cell.nominal_pose(item)
    }

    fn tool(&self, name: &str) -> Option<ToolId> {
        self.cell.tool(name)
    }

    fn initial_tool(&self) -> ToolId {
        self.cell.initial_tool()
    }
}

impl<C: Workcell> Workcell for Recorder<'_, C> {
    fn commanded_state(&self, sink: &mut dyn FnMut(u64)) {
        self.cell.commanded_state(sink);
    }
}
