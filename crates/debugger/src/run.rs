//! One line of history: a machine where its run has come to, the recording of how it came there,
//! and the way back to every moment of it.
//!
//! A run with a workcell is *live*: driving it commands the workcell. One without is a recording,
//! which can only be looked at.

use crate::drive::{Driven, Pace, drive};
use crate::notes::{Note, Noting};
use crate::recorder::{Copies, Recorder, Senses, facts, world};
use crate::recording::{Command, Frame, Log, Moment, Order, Recording, Stretch};
use crate::replay::{Cursor, Replay};
use crate::rewound::Rewound;
use crate::timeline::{Checkpoint, Timeline};
use obverse_bytecode::Verified;
use obverse_tape::{Snapshot, Streams};
use obverse_vm::{LinkError, Machine, Observer, Stop};
use obverse_workcell::{Fault, Workcell};
use std::cell::Cell;
use std::collections::BTreeMap;

/// One line of history.
#[derive(Debug)]
pub struct Run<'p, C> {
    cell: Option<C>,
    past: Past<'p, C>,
}

/// All of a run but its workcell.
#[derive(Debug)]
pub(crate) struct Past<'p, C> {
    pub(crate) machine: Machine<'p>,
    pub(crate) recording: Recording,
    timeline: Timeline,
    notes: Vec<Note>,
    senses: Senses,
    copies: Option<Copies<C>>,
    forced: BTreeMap<u16, bool>,
    /// How many commands there were when the machine was last driven, if the same order goes on
    /// from there: a trap leads back to the beginning of its statement, and ends what was ordered.
    goes_on_at: Option<usize>,
    /// Where going back ends since a variable was changed by hand, in steps of the program.
    changed_at: Option<u64>,
}

/// A run with its workcell, which can be driven.
pub(crate) struct Live<'r, 'p, C> {
    pub(crate) cell: &'r mut C,
    pub(crate) past: &'r mut Past<'p, C>,
}

impl<'p, C: Workcell> Run<'p, C> {
    /// At the start of a program, in a workcell.
    ///
    /// # Errors
    /// All that the program needs and the workcell lacks.
    pub fn new(program: &'p Verified, cell: C) -> Result<Self, Vec<LinkError>> {
        let machine = Machine::new(program, &cell)?;
        let recording = Recording {
            facts: facts(program.module(), &cell),
            start: world(&cell),
            log: Log::default(),
            stretches: vec![Stretch { order: Order::Forward, begin: Moment(0), frame: 0 }],
            end: Moment(0),
        };
        Ok(Self::begin(machine, Some(cell), recording))
    }

    fn begin(machine: Machine<'p>, cell: Option<C>, recording: Recording) -> Self {
        let cursor = Cursor::start(&recording);
        let start = Checkpoint { moment: Moment(0), stretch: 0, cursor, kept: machine.keep() };
        let past = Past {
            machine,
            recording,
            timeline: Timeline::new(start),
            notes: Vec::new(),
            senses: Senses::default(),
            copies: None,
            forced: BTreeMap::new(),
            goes_on_at: Some(0),
            changed_at: None,
        };
        Self { cell, past }
    }

    /// A recording at its end. With the workcell that it began in, if that is simulated, what
    /// would have been can be tried.
    ///
    /// # Errors
    /// What the program needs and the recording lacks; none if the recording is of another run.
    pub fn of_recording(
        program: &'p Verified,
        recording: Recording,
    ) -> Result<Self, Option<Vec<LinkError>>> {
        let mut cursor = Cursor::start(&recording);
        let machine = Machine::new(program, &Replay::new(&recording, &mut cursor)).map_err(Some)?;
        let mut run = Self::begin(machine, None, recording);
        run.replay_all().then_some(run).ok_or(None)
    }

    /// Go through the whole recording, and note what is in it. Whether it fits the program.
    fn replay_all(&mut self) -> bool {
        let mut rewound = Rewound::at(&self.past.machine, self.past.timeline.before(Moment(0)));
        while rewound.moment() < self.past.recording.end && !rewound.cursor().is_lost() {
            let until_due = self.past.timeline.until_due(rewound.moment());
            let to = rewound.moment().after(until_due.unwrap_or(1)).min(self.past.recording.end);
            let offset = rewound.moment().0.wrapping_sub(rewound.machine().executed());
            let (notes, is_telling) = (&mut self.past.notes, &Cell::new(false));
            let mut noting = Noting { notes, offset, observer: &mut (), is_telling };
            let Some(_) = rewound.advance_some(&self.past.recording, to, &mut noting) else {
                break;
            };
            if self.past.timeline.until_due(rewound.moment()).is_none() {
                self.past.timeline.keep(rewound.checkpoint());
            }
        }
        let is_whole = rewound.moment() == self.past.recording.end && !rewound.cursor().is_lost();
        rewound.go_to(&self.past.recording, &self.past.timeline, self.past.recording.end);
        self.past.machine = rewound.machine().clone();
        is_whole
    }

    /// The machine where the run has come to.
    #[must_use]
    pub fn machine(&self) -> &Machine<'p> {
        &self.past.machine
    }

    /// The workcell, if the run is live.
    #[must_use]
    pub fn cell(&self) -> Option<&C> {
        self.cell.as_ref()
    }

    /// Whether copies of its workcell are kept, so that it can go on otherwise.
    #[must_use]
    pub fn is_simulated(&self) -> bool {
        self.past.copies.is_some()
    }

    /// How it came there.
    #[must_use]
    pub fn recording(&self) -> &Recording {
        &self.past.recording
    }

    /// Places along it.
    #[must_use]
    pub fn timeline(&self) -> &Timeline {
        &self.past.timeline
    }

    /// What it did that is worth telling, oldest first.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
        &self.past.notes
    }

    /// Where going back ends since a variable was changed by hand, in steps of the program.
    #[must_use]
    pub fn changed_at(&self) -> Option<u64> {
        self.past.changed_at
    }

    /// The level of an input when it was last read; none if it was not.
    #[must_use]
    pub fn input(&self, bit: u16) -> Option<bool> {
        self.past.senses.input(bit)
    }

    /// The run at its end, as a recording shows it.
    #[must_use]
    pub fn rewound(&self) -> Rewound<'p> {
        let mut rewound =
            Rewound::at(&self.past.machine, self.past.timeline.before(self.past.recording.end));
        rewound.go_to(&self.past.recording, &self.past.timeline, self.past.recording.end);
        rewound
    }

    /// The state at its end and the tape there, as plain data.
    #[must_use]
    pub fn as_data(&self) -> (Snapshot, Streams) {
        let streams = self.past.machine.streams();
        match &self.cell {
            Some(cell) => (self.past.machine.snapshot(cell), streams),
            None => {
                let mut cursor = self.rewound().cursor().clone();
                (
                    self.past.machine.snapshot(&Replay::new(&self.past.recording, &mut cursor)),
                    streams,
                )
            }
        }
    }

    /// The run with its workcell; none of a recording.
    pub(crate) fn live(&mut self) -> Option<Live<'_, 'p, C>> {
        let cell = self.cell.as_mut()?;
        Some(Live { cell, past: &mut self.past })
    }

    /// Drive the machine where the run has come to, and record it; none of a recording. It stops
    /// early where a copy is due: `stop` is none then.
    pub fn drive(
        &mut self,
        order: Order,
        pace: Pace<'_>,
        observer: &mut dyn Observer,
    ) -> Option<Driven> {
        self.live().map(|mut live| live.drive(order, pace, observer))
    }

    /// Give the command without which nothing moves after a stop.
    pub fn release(&mut self) {
        if let Some(mut live) = self.live() {
            live.release();
        }
    }
}

impl<C: Workcell> Live<'_, '_, C> {
    /// Drive the machine, and record it. It stops early where a copy is due: `stop` is none then.
    pub(crate) fn drive(
        &mut self,
        order: Order,
        pace: Pace<'_>,
        observer: &mut dyn Observer,
    ) -> Driven {
        let past = &mut *self.past;
        begin(&mut past.recording, order, past.goes_on_at);
        let until_due = past.timeline.until_due(past.recording.end).unwrap_or(1);
        let pace = match pace {
            Pace::Step => Pace::Step,
            Pace::Run(most) => Pace::Run(most.min(until_due)),
            Pace::To(stops, most) => Pace::To(stops, most.min(until_due)),
            Pace::Past(stops, most) => Pace::Past(stops, most.min(until_due)),
        };
        let (log, senses) = (&mut past.recording.log, &mut past.senses);
        let (copies, is_telling) = (past.copies.as_mut(), Cell::new(false));
        let mut recorder = Recorder::new(self.cell, log, senses, copies, &past.forced, &is_telling);
        let offset = past.recording.end.0.wrapping_sub(past.machine.executed());
        let (notes, is_telling) = (&mut past.notes, &is_telling);
        let mut noting = Noting { notes, offset, observer, is_telling };
        let driven = drive(&mut past.machine, order, pace, &mut recorder, &mut noting);
        drop(recorder);
        let is_trapped = matches!(driven.stop, Some(Stop::Trap(_)));
        past.goes_on_at = (!is_trapped).then_some(past.recording.log.frames.len());
        past.recording.end = past.recording.end.after(driven.ticks);
        if matches!(order, Order::SetGlobal(..) | Order::SetLocal(..)) {
            past.changed_at = Some(past.machine.state().steps());
        }
        self.keep_if_due();
        driven
    }

    fn keep_if_due(&mut self) {
        let past = &mut *self.past;
        if past.timeline.until_due(past.recording.end).is_some() {
            return;
        }
        let stretch = past.recording.stretches.len() - 1;
        let (log, moment) = (&past.recording.log, past.recording.end);
        let (frames, readings) = (log.frames.len(), log.readings.len());
        let cursor = Cursor::here(world(self.cell), frames, readings, past.senses.known());
        past.timeline.keep(Checkpoint { moment, stretch, cursor, kept: past.machine.keep() });
    }

    /// Note on the tape what happened.
    pub(crate) fn note(&mut self, note: obverse_tape::Note) {
        let recording = &mut self.past.recording;
        let index = recording.log.notes.len() as u32;
        begin(recording, Order::Note(index), self.past.goes_on_at);
        recording.log.notes.push(note.clone());
        self.past.machine.note(note);
    }

    /// What is commanded beside the program, recorded.
    pub(crate) fn beside<T>(&mut self, command: impl FnOnce(&mut Recorder<'_, C>) -> T) -> T {
        let past = &mut *self.past;
        let (log, senses) = (&mut past.recording.log, &mut past.senses);
        let (copies, nobody) = (past.copies.as_mut(), Cell::new(false));
        let mut recorder = Recorder::new(self.cell, log, senses, copies, &past.forced, &nobody);
        command(&mut recorder)
    }

    /// Give the command without which nothing moves after a stop.
    pub(crate) fn release(&mut self) {
        self.beside(|recorder| obverse_workcell::Safety::release(recorder));
    }
}

impl<'p, C: Workcell + Clone> Run<'p, C> {
    /// The same run in a simulated workcell, of which copies are kept: what would have been can be
    /// tried. Of a recording: in the workcell that it began in.
    #[must_use]
    pub fn simulated(mut self, start: Option<C>) -> Self {
        let (frame, cell) = match (&self.cell, &start) {
            (Some(cell), _) => (self.past.recording.log.frames.len(), cell),
            (None, Some(start)) => (0, start),
            (None, None) => return self,
        };
        self.past.copies = Some(Copies::new(C::clone, frame, cell));
        self
    }
}

/// An order is given at the end of a recording. It goes on with the last one where that can go on,
/// after so many commands, unless something was commanded meanwhile.
fn begin(recording: &mut Recording, order: Order, goes_on_at: Option<usize>) {
    let frames = recording.log.frames.len();
    let is_way = matches!(order, Order::Forward | Order::Reverse | Order::Unwind);
    let is_last = recording.stretches.last().is_some_and(|last| last.order == order);
    if !(is_way && is_last && goes_on_at == Some(frames)) {
        let begin = recording.end;
        recording.stretches.push(Stretch { order, begin, frame: frames as u64 });
    }
}

/// Why there is no going on from a moment otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoFork {
    /// No copy of the workcell is kept: it is none that is simulated.
    NotSimulated,
    /// The workcell does not do again what it did: it is another one.
    AnotherWorkcell {
        /// The first command that it did otherwise, from 1; 0 if it does not begin so.
        frame: usize,
    },
}

impl std::fmt::Display for NoFork {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotSimulated => write!(f, "only a simulated workcell can go on otherwise"),
            Self::AnotherWorkcell { frame: 0 } => {
                write!(f, "the workcell does not begin as it did in the run: it is another one")
            }
            Self::AnotherWorkcell { frame } => write!(
                f,
                "the workcell does not do again what it did at command {frame}: it is another one"
            ),
        }
    }
}

impl<'p, C: Workcell> Run<'p, C> {
    /// A live run that goes on from a moment of this one, which stays as it is.
    ///
    /// # Errors
    /// If the workcell of that moment cannot be had.
    pub fn fork(&self, at: &Rewound<'p>) -> Result<Self, NoFork> {
        let frame = at.cursor().frame();
        let copies = self.past.copies.as_ref().ok_or(NoFork::NotSimulated)?;
        if copies.first().is_some_and(|first| !self.begins_in(first)) {
            return Err(NoFork::AnotherWorkcell { frame: 0 });
        }
        let (from, mut cell) = copies.before(frame).ok_or(NoFork::NotSimulated)?;
        for number in from..frame {
            self.do_again(number, &mut cell)
                .ok_or(NoFork::AnotherWorkcell { frame: number + 1 })?;
        }
        let recording = self.past.recording.up_to(at);
        let past = Past {
            machine: at.machine().clone(),
            copies: Some(copies.up_to(frame)),
            timeline: self.past.timeline.before_all_of(at.moment()),
            notes: self
                .past
                .notes
                .iter()
                .filter(|note| note.moment < at.moment())
                .copied()
                .collect(),
            senses: Senses::at(at.cursor()),
            forced: self.past.forced.clone(),
            goes_on_at: Some(frame),
            changed_at: self.past.changed_at.filter(|steps| *steps <= at.machine().state().steps()),
            recording,
        };
        Ok(Self { cell: Some(cell), past })
    }

    /// Whether this is the workcell that the run began in, as far as a program sees.
    fn begins_in(&self, cell: &C) -> bool {
        let recording = &self.past.recording;
        let module = self.past.machine.program().module();
        world(cell) == recording.start && facts(module, cell) == recording.facts
    }

    /// Let a workcell do a command of the recording; none if it comes to something else.
    fn do_again(&self, number: usize, cell: &mut C) -> Option<()> {
        let log = &self.past.recording.log;
        let frame = log.frames.get(number)?;
        cell.watch(if frame.is_watched { self.past.machine.watches() } else { &[] });
        let done: Result<(), Fault> = match frame.command {
            Command::Execute(index) => {
                let moved = log.motions.get(index as usize)?;
                let done = cell.execute(&moved.motion).map(|_| ());
                if cell.joints().bits() != moved.joints.bits() {
                    return None;
                }
                done
            }
            Command::Output { bit, level, .. } => cell.set_output(bit, level),
            Command::Wait(duration_s) => cell.wait(duration_s),
            Command::Release => {
                cell.release();
                Ok(())
            }
            Command::WatchAgain(number) => {
                cell.watch_again(number);
                Ok(())
            }
            // A copy is kept of what it was then.
            Command::Change => return None,
        };
        let is_same = done.err().as_ref() == log.fault(frame)
            && cell.held() == frame.held
            && cell.now_s().to_bits() == frame.now_s.to_bits();
        is_same.then_some(())
    }

    /// From here on, an input is read as this level, or as what it is.
    pub fn force_input(&mut self, bit: u16, level: Option<bool>) {
        match level {
            Some(level) => drop(self.past.forced.insert(bit, level)),
            None => drop(self.past.forced.remove(&bit)),
        }
    }

    /// Change the workcell by hand, if there is one. What is seen of it then is a moment of its
    /// own; what was done to it is not recorded.
    pub fn change_cell(&mut self, change: impl FnOnce(&mut C)) -> Option<()> {
        change(self.cell.as_mut()?);
        let mut live = self.live()?;
        live.beside(|recorder| {
            recorder.changed();
        });
        let frames = live.past.recording.log.frames.len();
        if let Some(copies) = &mut live.past.copies {
            copies.note_changed(frames, live.cell);
        }
        live.drive(Order::Change, Pace::Step, &mut ());
        Some(())
    }
}

impl Recording {
    /// The recording up to where it is shown.
    fn up_to(&self, at: &Rewound<'_>) -> Self {
        let log = &self.log;
        let taken = &log.frames[..at.cursor().frame().min(log.frames.len())];
        let is_motion = |frame: &&Frame| matches!(frame.command, Command::Execute(_));
        let motions = taken.iter().filter(is_motion).count();
        let faults = taken.iter().filter(|frame| frame.fault.is_some()).count();
        Self {
            facts: self.facts.clone(),
            start: self.start.clone(),
            log: Log {
                frames: taken.to_vec(),
                motions: log.motions[..motions].to_vec(),
                faults: log.faults[..faults].to_vec(),
                readings: log.readings[..at.cursor().readings()].to_vec(),
                notes: log.notes.clone(),
            },
            stretches: self.stretches.iter().take(at.stretch() + 1).copied().collect(),
            end: at.moment(),
        }
    }
}
