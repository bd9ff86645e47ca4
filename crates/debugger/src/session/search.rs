//! Finding a moment: pieces of the recording from the newest back, the last error, a checkpoint of
//! the program.

use super::{Declined, PIECE, Session};
use crate::recording::{Moment, Order};
use crate::rewound::{Halted, Rewound};
use obverse_isa::{CheckpointId, Instr};
use obverse_vm::{Direction, Stops};
use obverse_workcell::Workcell;

impl<'p, C: Workcell> Session<'p, C> {
    /// Go through the newest piece of the recording that lies before a moment, forward, that
    /// moment included, and look at every place that may matter. Where the piece begins.
    ///
    /// # Errors
    /// If somebody interrupts.
    pub(super) fn look_through(
        &self,
        shown: &mut Rewound<'p>,
        end: Moment,
        stops: Option<&Stops>,
        mut look: impl FnMut(&Rewound<'p>),
    ) -> Result<Moment, Declined> {
        shown.go_before(self.run.timeline(), end);
        let begin = shown.moment();
        look(shown);
        loop {
            let to = shown.moment().after(PIECE).min(end);
            let halted = shown.walk_on(self.run.recording(), to, stops);
            look(shown);
            if self.take_interrupt() {
                return Err(Declined::Interrupted);
            }
            if is_over(&halted, shown, to, end) {
                return Ok(begin);
            }
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

/// Whether a walk that goes on to a moment piece by piece is over, having been halted on the way to
/// the end of a piece: it is there, or there is no more that could be shown.
pub(super) fn is_over(halted: &Halted, shown: &Rewound<'_>, piece: Moment, end: Moment) -> bool {
    match halted {
        Halted::There => piece >= end || shown.moment() < piece,
        Halted::Lost => true,
        Halted::Here | Halted::Stopped(_) => false,
    }
}
