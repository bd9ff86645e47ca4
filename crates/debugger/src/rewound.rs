//! A machine that shows a moment of a recording. It commands nothing.

use crate::drive::{Driven, Pace, drive};
use crate::recording::{Moment, Order, Recording};
use crate::replay::{Cursor, Replay};
use crate::timeline::{Checkpoint, Timeline};
use obverse_vm::{Direction, Machine, Observer, Stop, Stops};

/// How far before a moment that is shown copies are kept beside those of the time line, so that
/// what is looked at next, which is mostly near, is found at once.
const NEAR: [u64; 3] = [1 << 16, 1 << 12, 1 << 8];

/// The most that a run may go beyond where it was to end, beside the length of the code: a
/// statement.
const STATEMENT: u64 = 260;

/// A machine in a recording.
#[derive(Clone, Debug)]
pub struct Rewound<'p> {
    machine: Machine<'p>,
    moment: Moment,
    /// The stretch that it is in, or at the end of.
    stretch: usize,
    cursor: Cursor,
    near: Vec<Checkpoint>,
}

/// Why a walk over a recording halted.
#[derive(Clone, Debug, PartialEq)]
pub enum Halted {
    /// At the moment that it was to end at, or the first after it that there is.
    There,
    /// Before a stop, or after a step where there are no stops.
    Here,
    /// The recorded run was stopped here by something.
    Stopped(Stop),
    /// The recording does not fit the program.
    Lost,
}

impl<'p> Rewound<'p> {
    /// A machine where a copy of it was.
    #[must_use]
    pub fn at(machine: &Machine<'p>, checkpoint: &Checkpoint) -> Self {
        let mut machine = machine.clone();
        machine.restore(&checkpoint.kept);
        let Checkpoint { moment, stretch, cursor, .. } = checkpoint.clone();
        Self { machine, moment, stretch, cursor, near: Vec::new() }
    }

    /// The machine.
    #[must_use]
    pub fn machine(&self) -> &Machine<'p> {
        &self.machine
    }

    /// When.
    #[must_use]
    pub fn moment(&self) -> Moment {
        self.moment
    }

    /// The stretch that it is in, or at the end of.
    #[must_use]
    pub fn stretch(&self) -> usize {
        self.stretch
    }

    /// The place in the recording.
    #[must_use]
    pub fn cursor(&self) -> &Cursor {
        &self.cursor
    }

    /// A copy of it.
    #[must_use]
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            moment: self.moment,
            stretch: self.stretch,
            cursor: self.cursor.clone(),
            kept: self.machine.keep(),
        }
    }

    /// A digest of the whole state: the machine's part, and what it commands of the workcell.
    #[must_use]
    pub fn digest(&self, recording: &Recording) -> u64 {
        let mut cursor = self.cursor.clone();
        self.machine.digest(&Replay::new(recording, &mut cursor))
    }

    /// The order that the machine follows next.
    #[must_use]
    pub fn order(&self, recording: &Recording) -> Option<Order> {
        recording.stretches.get(self.stretch).map(|stretch| stretch.order)
    }

    /// Which way it goes next.
    #[must_use]
    pub fn direction(&self, recording: &Recording) -> Direction {
        match self.order(recording) {
            Some(Order::Reverse | Order::Unwind) => Direction::Reverse,
            _ => Direction::Forward,
        }
    }

    /// The nearest place at or before a moment that is known: of the time line, or kept near.
    fn nearest<'a>(&'a self, timeline: &'a Timeline, moment: Moment) -> &'a Checkpoint {
        let far = timeline.before(moment);
        let near = self.near.iter().filter(|near| near.moment <= moment);
        near.fold(far, |best, near| if near.moment > best.moment { near } else { best })
    }

    fn place_at(&mut self, checkpoint: &Checkpoint) {
        self.machine.restore(&checkpoint.kept);
        self.moment = checkpoint.moment;
        self.stretch = checkpoint.stretch;
        self.cursor = checkpoint.cursor.clone();
    }

    /// Show a moment: the state that the machine had then, or where there was none, the next.
    pub fn go_to(&mut self, recording: &Recording, timeline: &Timeline, moment: Moment) {
        let moment = moment.min(recording.end);
        let from = self.nearest(timeline, moment);
        if moment < self.moment || self.moment < from.moment {
            let from = from.clone();
            self.place_at(&from);
        }
        self.near.retain(|near| near.moment <= moment);
        for before in NEAR {
            let stand = Moment(moment.0.saturating_sub(before));
            if stand > self.moment {
                self.walk(recording, stand);
                if self.moment <= moment {
                    self.near.push(self.checkpoint());
                }
            }
        }
        if self.moment > moment {
            let from = timeline.before(moment).clone();
            self.place_at(&from);
        }
        self.walk(recording, moment);
        if self.moment >= recording.end {
            // What was ordered there and took no time, and what was commanded beside the program.
            self.enter(recording);
            self.cursor.go_to_frame(recording, recording.log.frames.len());
        }
    }

    /// Go to the nearest place that is known before a moment, and strictly before it unless it is
    /// the start.
    pub(crate) fn go_before(&mut self, timeline: &Timeline, moment: Moment) {
        let from = self.nearest(timeline, Moment(moment.0.saturating_sub(1))).clone();
        self.place_at(&from);
    }

    /// Go where the recording had answered fewer than so many commands.
    pub(crate) fn go_before_frame(&mut self, timeline: &Timeline, frame: usize) {
        let from = timeline.before_frame(frame).clone();
        self.place_at(&from);
    }

    /// On to a moment, as fast as can be.
    fn walk(&mut self, recording: &Recording, to: Moment) {
        while self.moment < to && !self.cursor.is_lost() {
            let pace = self.pace(self.left(recording, to));
            if self.advance(recording, to, pace, &mut ()).is_none() {
                return;
            }
        }
    }

    /// As many instructions at once as cannot lead further than so many.
    fn pace(&self, left: u64) -> Pace<'static> {
        let slack = self.machine.program().module().code.len() as u64 + STATEMENT;
        if left > slack { Pace::Run(left - slack) } else { Pace::Step }
    }

    /// On to a moment or the next place worth looking at: before a stop, behind one, or, without
    /// stops, behind every step.
    pub fn walk_on(&mut self, recording: &Recording, to: Moment, stops: Option<&Stops>) -> Halted {
        let mut is_moved = false;
        loop {
            if self.cursor.is_lost() {
                return Halted::Lost;
            }
            if self.moment >= to {
                return Halted::There;
            }
            self.enter(recording);
            let left = self.left(recording, to);
            let is_forward = self.order(recording) == Some(Order::Forward)
                && !self.machine.state().is_compensating();
            if stops.is_some() && !is_forward && is_moved {
                // Here every step is looked at, and what was before it.
                return Halted::Here;
            }
            is_moved = true;
            let pace = match (stops, self.pace(left)) {
                (Some(stops), Pace::Run(sure)) if is_forward => Pace::To(stops, sure),
                _ => Pace::Step,
            };
            let was_at_stop = stops.is_some_and(|stops| stops.has(self.machine.state().pc()));
            // Behind a stop is a place to look at, too.
            let pace = if was_at_stop { Pace::Step } else { pace };
            let before = self.moment;
            let driven = self.advance(recording, to, pace, &mut ());
            let Some(driven) = driven else { return Halted::There };
            if let Some(stop) = driven.stop {
                return Halted::Stopped(stop);
            }
            let is_at_stop = stops.is_some_and(|stops| stops.has(self.machine.state().pc()));
            let is_looked_at = stops.is_none() || was_at_stop || is_at_stop || !is_forward;
            if is_looked_at && self.moment > before {
                return Halted::Here;
            }
        }
    }

    /// On towards a moment as far as the program runs forward by itself, telling before and behind
    /// each stop; no further than to one where the workcell is asked or commanded, to an act that
    /// was not done, or to the end of the stretch, which `walk_on` goes over.
    pub(crate) fn walk_past(
        &mut self,
        recording: &Recording,
        to: Moment,
        stops: &Stops,
        observer: &mut dyn Observer,
    ) {
        self.enter(recording);
        let state = self.machine.state();
        let is_between = state.pending().is_none() && state.operands().is_empty();
        let is_forward = self.order(recording) == Some(Order::Forward);
        if let Pace::Run(sure) = self.pace(self.left(recording, to))
            && is_between
            && is_forward
        {
            self.advance(recording, to, Pace::Past(stops, sure), observer);
        }
    }

    /// How many instructions are left of the stretch, or to a moment in it.
    fn left(&self, recording: &Recording, to: Moment) -> u64 {
        let end = self.stretch_end(recording);
        to.min(end).0.saturating_sub(self.moment.0)
    }

    fn stretch_end(&self, recording: &Recording) -> Moment {
        recording.stretches.get(self.stretch + 1).map_or(recording.end, |next| next.begin)
    }

    /// Where a stretch is over, be at the beginning of the next.
    fn enter(&mut self, recording: &Recording) {
        while self.moment >= self.stretch_end(recording) {
            let Some(next) = recording.stretches.get(self.stretch + 1) else { return };
            self.stretch += 1;
            self.cursor.go_to_frame(recording, next.frame as usize);
            match next.order {
                Order::Alter(alteration) => self.machine.alter(alteration),
                Order::Note(index) => {
                    let note = recording.log.notes.get(index as usize);
                    note.into_iter().for_each(|note| self.machine.note(note.clone()));
                }
                _ => {}
            }
        }
    }

    /// As far towards a moment as can be gone at once; none if there is no more to do.
    pub(crate) fn advance_some(
        &mut self,
        recording: &Recording,
        to: Moment,
        observer: &mut dyn Observer,
    ) -> Option<Driven> {
        let pace = self.pace(self.left(recording, to));
        self.advance(recording, to, pace, observer)
    }

    /// One drive on towards a moment; none if there is no more to do.
    pub(crate) fn advance(
        &mut self,
        recording: &Recording,
        to: Moment,
        pace: Pace<'_>,
        observer: &mut dyn Observer,
    ) -> Option<Driven> {
        self.enter(recording);
        if self.moment >= to {
            return None;
        }
        let order = self.order(recording)?;
        let mut replay = Replay::new(recording, &mut self.cursor);
        let driven = drive(&mut self.machine, order, pace, &mut replay, observer);
        self.moment = self.moment.after(driven.ticks);
        // With no time passed, what was to happen here did not.
        (driven.ticks > 0).then_some(driven)
    }
}
