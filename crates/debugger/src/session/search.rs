//! Finding a moment: the last change of something, the last error, a checkpoint of the program.
//!
//! What lies between is gone through from the newest piece back, each piece forward once. What only
//! commands change is looked for in the recording first, and then in one piece.

use super::{Declined, SeenIn, Session, look_at};
use crate::condition::Expression;
use crate::recording::{Moment, Order, Recording, World};
use crate::rewound::{Halted, Rewound};
use crate::subject::{Look, Value};
use crate::writers::{commands, writers};
use obverse_bytecode::Module;
use obverse_isa::{CheckpointId, Instr};
use obverse_vm::{Direction, Stops};
use obverse_workcell::Workcell;

/// A change of something.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The moment before the instruction that changed it.
    pub moment: Moment,
    /// What it was.
    pub before: Value,
    /// What it became.
    pub after: Value,
}

impl<'p, C: Workcell> Session<'p, C> {
    /// Go through the recording before a moment, from the newest piece back. Each piece is shown
    /// forward, its last moment included, at every place that may matter; after a piece in which
    /// something was found the search is over. Whether anything was.
    pub(super) fn search(
        &self,
        from: Rewound<'p>,
        now: Moment,
        stops: Option<&Stops>,
        mut look: impl FnMut(&Rewound<'p>) -> bool,
    ) -> bool {
        let mut shown = from;
        let mut end = now;
        loop {
            shown.go_before(self.run.timeline(), end);
            let begin = shown.moment();
            let mut is_found = look(&shown);
            loop {
                let halted = shown.walk_on(self.run.recording(), end, stops);
                is_found |= look(&shown);
                if matches!(halted, Halted::There | Halted::Lost) {
                    break;
                }
            }
            if is_found || begin == Moment(0) {
                return is_found;
            }
            end = begin;
        }
    }

    /// To right before the last change of something; again, to the one before that.
    ///
    /// # Errors
    /// If it did not change before.
    pub fn go_to_last_change(&mut self, expression: &Expression) -> Result<Change, Declined> {
        let change = self.last_change(expression).ok_or(Declined::NotBefore)?;
        self.jumped();
        self.show(Some(change.moment));
        Ok(change)
    }

    /// The last change of something before what is shown.
    #[must_use]
    pub fn last_change(&self, expression: &Expression) -> Option<Change> {
        let view = self.view.clone().unwrap_or_else(|| self.run.rewound());
        let subjects = expression.subjects();
        let is_world = subjects.iter().all(|subject| subject.is_of_the_workcell());
        if is_world {
            return self.last_command(view, expression);
        }
        let stops = writers(self.module(), expression).map(|pcs| Stops::new(self.module(), pcs));
        self.last_change_between(view, expression, stops.as_ref())
    }

    fn last_change_between(
        &self,
        view: Rewound<'p>,
        expression: &Expression,
        stops: Option<&Stops>,
    ) -> Option<Change> {
        let (module, recording) = (self.module(), self.run.recording());
        let now = view.moment();
        let mut last: Option<(Moment, Value)> = None;
        let mut change = None;
        self.search(view, now, stops, |shown| {
            let value = look_at(module, recording, shown, |look| expression.value(look));
            if let Some((moment, before)) = &last {
                // Another piece begins before the one that was looked at.
                if shown.moment() > *moment && *before != value && *moment < now {
                    let (moment, before) = (*moment, before.clone());
                    change = Some(Change { moment, before, after: value.clone() });
                }
            }
            last = Some((shown.moment(), value));
            change.is_some()
        });
        change
    }

    /// The last command that changed something of the workcell, and then its moment.
    fn last_command(&self, view: Rewound<'p>, expression: &Expression) -> Option<Change> {
        let (module, recording) = (self.module(), self.run.recording());
        let mut limit = view.cursor().frame();
        let now = view.moment();
        loop {
            let frame = last_frame(module, recording, &view, expression, limit)?;
            let mut shown = view.clone();
            shown.go_before_frame(self.run.timeline(), frame);
            let pcs = (0..).zip(&module.code).filter(|(_, instr)| commands(instr));
            let stops = Stops::new(module, pcs.map(|(pc, _)| pc));
            let value = |shown: &Rewound<'p>| {
                look_at(module, recording, shown, |look| expression.value(look))
            };
            let mut before = (shown.moment(), value(&shown));
            while shown.cursor().frame() < frame {
                before = (shown.moment(), value(&shown));
                let halted = shown.walk_on(recording, now, Some(&stops));
                if matches!(halted, Halted::There | Halted::Lost) {
                    break;
                }
            }
            let after = value(&shown);
            if shown.cursor().frame() >= frame && before.0 < now && before.1 != after {
                let (moment, before) = before;
                return Some(Change { moment, before, after });
            }
            // Commanded beside the program, or taken back within one instruction.
            limit = frame - 1;
        }
    }

    /// To right before the last error was raised, and which.
    ///
    /// # Errors
    /// If none was.
    pub fn go_to_last_error(&mut self) -> Result<Moment, Declined> {
        let module = self.module();
        let now = self.moment();
        let is_raise =
            |pc: u32| matches!(module.code.get(pc as usize), Some(Instr::ErrorRaise { .. }));
        let notes = self.run.notes().iter().rev().filter(|note| note.moment < now);
        let mut raised =
            notes.filter(|note| note.direction == Direction::Forward && is_raise(note.pc));
        let by_code = raised.next().map(|note| note.moment);
        let stretches = self.recording().stretches.iter().rev();
        let mut faults = stretches
            .filter(|stretch| matches!(stretch.order, Order::Raise(_)) && stretch.begin < now);
        let by_fault = faults.next().map(|stretch| stretch.begin);
        let moment = by_code.max(by_fault).ok_or(Declined::NotBefore)?;
        self.jumped();
        self.show(Some(moment));
        Ok(moment)
    }

    /// To where a checkpoint of the program was last passed.
    ///
    /// # Errors
    /// If it was not passed before.
    pub fn go_to_checkpoint(&mut self, checkpoint: CheckpointId) -> Result<Moment, Declined> {
        let module = self.module();
        let now = self.moment();
        let is_it =
            |pc: u32| module.code.get(pc as usize) == Some(&Instr::Checkpoint { checkpoint });
        let mut notes = self.run.notes().iter().rev();
        let passed = notes.find(|note| note.moment < now && is_it(note.pc));
        let moment = passed.map(|note| note.moment).ok_or(Declined::NotBefore)?;
        self.jumped();
        self.show(Some(moment));
        Ok(moment)
    }
}

/// The newest command, of the first so many, after which an expression is another than before it.
fn last_frame(
    module: &Module,
    recording: &Recording,
    view: &Rewound<'_>,
    expression: &Expression,
    limit: usize,
) -> Option<usize> {
    let log = &recording.log;
    let mut world = recording.start.clone();
    let state = view.machine().state();
    let value = |world: &World| {
        let seen = SeenIn { recording, world, cursor: None };
        expression.value(&Look { module, state, world: &seen })
    };
    let mut before = value(&world);
    let mut last = None;
    for (index, frame) in log.frames.iter().take(limit).enumerate() {
        log.apply(frame, &mut world);
        let after = value(&world);
        if after != before {
            last = Some(index + 1);
        }
        before = after;
    }
    last
}
