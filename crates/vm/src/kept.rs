//! Copies of where a machine is in a run, to come back to.
//!
//! A copy shares with the machine what of the tape does not change any more, so that many can be
//! kept along a long run. When that is wise is not known here.

use crate::alter::Alteration;
use crate::machine::Machine;
use crate::state::State;
use obverse_isa::{GlobalId, LocalId};
use obverse_tape::Tape;

/// Where a machine was: its state, its tape, and what it counts.
#[derive(Clone, Debug)]
pub struct Kept {
    state: State,
    tape: Option<Tape>,
    commands: u64,
    executed: u64,
    alteration: Option<Alteration>,
}

impl Machine<'_> {
    /// A copy of where the machine is.
    #[must_use]
    pub fn keep(&self) -> Kept {
        Kept {
            state: self.state.clone(),
            tape: self.tape.clone(),
            commands: self.commands,
            executed: self.executed,
            alteration: self.alteration,
        }
    }

    /// Be where a machine of the same program was.
    pub fn restore(&mut self, kept: &Kept) {
        let Kept { state, tape, commands, executed, alteration } = kept.clone();
        self.state = state;
        self.tape = tape;
        self.commands = commands;
        self.executed = executed;
        self.alteration = alteration;
    }

    /// Give a variable of the program another value, as no program could: going back further than
    /// here does not lead to what was before. Whether there is such a variable.
    pub fn set_global(&mut self, global: GlobalId, value: u64) -> bool {
        let place = self.state.globals.get_mut(global.index());
        place.map(|place| *place = value).is_some()
    }

    /// The same for a local variable of a call under way, counted from the outermost.
    pub fn set_local(&mut self, frame: usize, local: LocalId, value: u64) -> bool {
        let Some(frame) = self.state.frames.get_mut(frame) else { return false };
        let function = &self.program.module().functions[usize::from(frame.function)];
        let is_one = local.index() < function.locals.len();
        if is_one {
            *frame.words.slot_mut(local.0) = value;
        }
        is_one
    }
}

impl Kept {
    /// How many instructions the machine had run or reversed.
    #[must_use]
    pub fn executed(&self) -> u64 {
        self.executed
    }
}
