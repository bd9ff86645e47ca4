//! What a run did that is worth telling, by moment: commands, errors, checkpoints, and what cannot
//! be taken back. Kept from what the machine tells; arithmetic and calls leave nothing here.

use crate::recording::Moment;
use obverse_isa::{Class, Instr};
use obverse_vm::{Direction, Event, Observer};
use obverse_workcell::Workcell;
use std::cell::Cell;

/// Something that a run did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Note {
    /// When it began.
    pub moment: Moment,
    /// The instruction.
    pub pc: u32,
    /// Which way.
    pub direction: Direction,
    /// How many calls were under way.
    pub depth: usize,
    /// How many instructions lay between the start of the program and here, after it.
    pub steps: u64,
    /// When it was over, in seconds of the workcell's clock.
    pub now_s: f64,
    /// How many blocks with a reverse of their own were open around it.
    pub open_blocks: u32,
}

/// Whether an instruction is noted.
pub(crate) fn is_noted(instr: &Instr) -> bool {
    let info = instr.info();
    info.family.commands_workcell()
        || matches!(info.class, Class::Never(_))
        || matches!(
            instr,
            Instr::WaitInput { .. } | Instr::ErrorRaise { .. } | Instr::Checkpoint { .. }
        )
}

/// Notes what a machine tells while it is driven, and tells it on.
pub(crate) struct Noting<'n> {
    pub(crate) notes: &'n mut Vec<Note>,
    /// What is to be added to the machine's count for the moment.
    pub(crate) offset: u64,
    pub(crate) observer: &'n mut dyn Observer,
    /// Raised while it is told: what it reads, the program did not.
    pub(crate) is_telling: &'n Cell<bool>,
}

impl Observer for Noting<'_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        if is_noted(&event.instr) {
            self.notes.push(Note {
                moment: Moment(event.executed.wrapping_add(self.offset)),
                pc: event.pc,
                direction: event.direction,
                depth: event.frames,
                steps: event.steps,
                now_s: cell.now_s(),
                open_blocks: event.open_blocks,
            });
        }
        self.is_telling.set(true);
        self.observer.on_event(event, cell);
        self.is_telling.set(false);
    }
}
