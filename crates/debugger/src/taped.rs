//! A run that is written to a tape file as it goes.
//!
//! It keeps nothing of what has been written, so that a run may take as long as it likes. What was
//! commanded is written as soon as the workcell's clock has gone on by a tenth of a second, or
//! where it is a few dozen commands: a run that is killed loses no more, and the act it was in.

use crate::drive::{Driven, Pace, drive};
use crate::file::{CellFile, Head, Piece, Writer};
use crate::recorder::{Recorder, Senses, facts, world};
use crate::recording::{Log, Moment, Order, Stretch};
use crate::writers::commands;
use obverse_bytecode::{DecodeError, Module, encode};
use obverse_isa::ErrorId;
use obverse_recovery as recovery;
use obverse_tape::Note;
use obverse_vm::{Alteration, Direction, Event, Machine, Mark, Observer, Stop, Stops};
use obverse_workcell::{Arm, Fault, Motion, Safety, Watching, Workcell};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The most instructions at once, and in a piece that commands nothing.
const BURST: u64 = 1 << 20;
/// The same in reverse where it commands the workcell, which takes longer.
const SLOW_BURST: u64 = 256;
/// The most commands that are not written yet.
const MAX_FRAMES: usize = 64;
/// The most readings that are not written yet.
const MAX_READINGS: usize = 256;
/// How long commands may wait to be written, in seconds of the workcell's clock.
const LATE_S: f64 = 0.1;

/// A machine and its workcell, with all that drives them recorded.
pub struct Taped<'t, 'w, 'p, C> {
    machine: &'t mut Machine<'p>,
    cell: &'t mut C,
    writer: Writer<'w>,
    /// Before everything that commands the workcell, which is gone over step by step.
    stops: Rc<Stops>,
    /// What has not been written yet.
    piece: Piece,
    /// Where what has been written ends.
    written: Moment,
    /// When that was, by the workcell's clock in seconds.
    written_s: f64,
    /// How many commands have been written.
    frames: u64,
    senses: Senses,
    /// The order that goes on if nothing was commanded since so many commands.
    order: Option<(Order, u64)>,
}

/// What a tape file begins with, of a run that is about to begin with nothing run before it.
///
/// # Errors
/// If the module is larger than one may be.
pub fn head(
    module: &Module,
    cell: &impl Workcell,
    (program, cell_file): (String, Option<CellFile>),
    seed: u64,
) -> Result<Head, DecodeError> {
    let (facts, start) = (facts(module, cell), world(cell));
    let module = encode(module)?;
    Ok(Head { module, program, cell: cell_file, seed, after: None, facts, start })
}

impl<'t, 'w, 'p, C: Workcell> Taped<'t, 'w, 'p, C> {
    /// At the start of a program.
    pub fn new(machine: &'t mut Machine<'p>, cell: &'t mut C, writer: Writer<'w>) -> Self {
        let module = machine.program().module();
        let acts = (0..).zip(&module.code).filter(|(_, instr)| commands(instr));
        Self {
            stops: Rc::new(Stops::new(module, acts.map(|(pc, _)| pc))),
            written_s: cell.now_s(),
            machine,
            cell,
            writer,
            piece: Piece::default(),
            written: Moment(0),
            frames: 0,
            senses: Senses::default(),
            order: Some((Order::Forward, 0)),
        }
    }

    /// Write what is left, and how the run ended.
    ///
    /// # Errors
    /// The first thing that could not be written.
    pub fn end(mut self, ending: &str) -> std::io::Result<()> {
        self.write();
        self.writer.end(ending)
    }

    fn commands(&self) -> u64 {
        self.frames + self.piece.log.frames.len() as u64
    }

    /// The workcell, with what it answers recorded.
    fn recorded<T>(&mut self, with: impl FnOnce(&mut Machine<'p>, &mut Recorder<'_, C>) -> T) -> T {
        self.overheard(|machine, recorder, _| with(machine, recorder))
    }

    /// The same, with a flag to raise while others than the program read.
    fn overheard<T>(
        &mut self,
        with: impl FnOnce(&mut Machine<'p>, &mut Recorder<'_, C>, &Cell<bool>) -> T,
    ) -> T {
        let (nothing, is_told) = (BTreeMap::new(), Cell::new(false));
        let (log, senses) = (&mut self.piece.log, &mut self.senses);
        let mut recorder = Recorder::new(self.cell, log, senses, None, &nothing, &is_told);
        with(self.machine, &mut recorder, &is_told)
    }

    /// The order under which the machine is driven from here on.
    fn begin(&mut self, order: Order) {
        let frame = self.commands();
        let is_way = matches!(order, Order::Forward | Order::Reverse | Order::Unwind);
        if !(is_way && self.order == Some((order, frame))) {
            self.piece.stretches.push(Stretch { order, begin: self.piece.end, frame });
        }
    }

    fn drive(&mut self, order: Order, pace: Pace<'_>, observer: &mut dyn Observer) -> Driven {
        self.begin(order);
        let driven = self.overheard(|machine, recorder, is_told| {
            drive(machine, order, pace, recorder, &mut Overheard { observer, is_told })
        });
        self.piece.end = self.piece.end.after(driven.ticks);
        let is_trapped = matches!(driven.stop, Some(Stop::Trap(_)));
        self.order = (!is_trapped).then_some((order, self.commands()));
        if self.is_due() {
            self.write();
        }
        driven
    }

    fn is_due(&self) -> bool {
        let Log { frames, readings, .. } = &self.piece.log;
        let is_late = !frames.is_empty() && self.cell.now_s() - self.written_s >= LATE_S;
        let is_long = self.piece.end.0 - self.written.0 >= BURST;
        is_late || is_long || frames.len() >= MAX_FRAMES || readings.len() >= MAX_READINGS
    }

    fn write(&mut self) {
        let end = self.piece.end;
        let next = Piece { end, ..Piece::default() };
        let piece = std::mem::replace(&mut self.piece, next);
        self.frames += piece.log.frames.len() as u64;
        (self.written, self.written_s) = (end, self.cell.now_s());
        self.writer.piece(piece);
    }

    /// In reverse, about so many instructions at the most: fewer at once where the last ones have
    /// commanded something.
    fn back(&mut self, burst: &mut u64, left: u64, observer: &mut dyn Observer) -> Option<Stop> {
        let before = self.commands();
        let pace = Pace::Run(left.min(*burst));
        let stop = self.drive(Order::Reverse, pace, observer).stop;
        *burst = if self.commands() > before { SLOW_BURST } else { BURST.min(*burst * 2) };
        stop
    }

    /// Forward up to what commands the workcell, or over it.
    fn on(&mut self, left: u64, observer: &mut dyn Observer) -> Option<Stop> {
        let stops = Rc::clone(&self.stops);
        let state = self.machine.state();
        let is_before_act = stops.has(state.pc()) || state.is_compensating();
        let pace = if is_before_act { Pace::Step } else { Pace::To(&stops, left.min(BURST)) };
        self.drive(Order::Forward, pace, observer).stop
    }
}

impl<'p, C: Workcell> recovery::Driven<'p, C> for Taped<'_, '_, 'p, C> {
    fn machine(&self) -> &Machine<'p> {
        self.machine
    }

    fn cell(&self) -> &C {
        self.cell
    }

    fn run(
        &mut self,
        direction: Direction,
        instructions: u64,
        observer: &mut dyn Observer,
    ) -> Stop {
        let allowed = self.machine.executed().saturating_add(instructions);
        let mut burst = SLOW_BURST;
        loop {
            let left = allowed.saturating_sub(self.machine.executed());
            if left == 0 {
                return Stop::Budget;
            }
            let stop = match direction {
                Direction::Forward => self.on(left, observer),
                Direction::Reverse => self.back(&mut burst, left, observer),
            };
            if let Some(stop) = stop {
                return stop;
            }
        }
    }

    fn step(&mut self, observer: &mut dyn Observer) -> Result<(), Stop> {
        self.drive(Order::Forward, Pace::Step, observer).stop.map_or(Ok(()), Err)
    }

    fn reverse_to(&mut self, mark: Mark, observer: &mut dyn Observer) -> Stop {
        let mut burst = SLOW_BURST;
        loop {
            let state = self.machine.state();
            let left = state.steps().saturating_sub(mark.steps());
            if left == 0 && !state.is_compensating() {
                let is_there = state.steps() == mark.steps();
                return if is_there { Stop::AtMark } else { Stop::OffMark };
            }
            if let Some(stop) = self.back(&mut burst, left.max(1), observer) {
                return stop;
            }
        }
    }

    fn unwind_to(&mut self, mark: Mark) -> Result<(), Stop> {
        while self.machine.state().steps() > mark.steps() {
            let stop = self.drive(Order::Unwind, Pace::Step, &mut ()).stop;
            stop.map_or(Ok(()), Err)?;
        }
        Ok(())
    }

    fn alter(&mut self, alteration: Option<Alteration>) {
        self.drive(Order::Alter(alteration), Pace::Step, &mut ());
    }

    fn raise(&mut self, error: ErrorId) -> bool {
        self.drive(Order::Raise(error), Pace::Step, &mut ()).ticks > 0
    }

    fn pass_over_fault(&mut self) -> bool {
        self.drive(Order::PassOver, Pace::Step, &mut ()).ticks > 0
    }

    fn leave(&mut self) -> bool {
        self.drive(Order::Leave, Pace::Step, &mut ()).ticks > 0
    }

    fn note(&mut self, note: Note) {
        self.begin(Order::Note(self.piece.log.notes.len() as u32));
        self.order = None;
        self.piece.log.notes.push(note.clone());
        self.machine.note(note);
    }

    fn execute(&mut self, motion: &Motion) -> Result<(), Fault> {
        self.recorded(|_, recorder| {
            recorder.watch(&[]);
            recorder.execute(motion).map(|_| ())
        })
    }

    fn watch_again(&mut self, number: u16) {
        self.recorded(|_, recorder| recorder.watch_again(number));
    }

    fn release(&mut self) {
        self.recorded(|_, recorder| recorder.release());
    }
}

/// Who is told of a run, and reads what the program does not.
struct Overheard<'o> {
    observer: &'o mut dyn Observer,
    is_told: &'o Cell<bool>,
}

impl Observer for Overheard<'_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        self.is_told.set(true);
        self.observer.on_event(event, cell);
        self.is_told.set(false);
    }
}
