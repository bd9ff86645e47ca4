//! The family `io`: digital outputs and time. An output's settling time belongs to its change, so
//! that it follows the change in either direction.

use super::acts::Acts;
use crate::class::{AfterForward, Always, Failure};
use obverse_isa::op;
use obverse_tape::record::Bit;

impl Acts<'_> {
    fn set_and_settle(&mut self, bit: u16, level: bool, settle_s: f64) -> Result<(), Failure> {
        let set = self.cell.set_output(bit, level);
        self.noting(set)?;
        self.rest(settle_s)
    }
}

impl AfterForward<Acts<'_>> for op::OutputSet {
    type Saved = Bit;

    fn save(&self, acts: &Acts<'_>) -> Bit {
        Bit(acts.cell.output(self.bit.0))
    }

    fn forward(self, acts: &mut Acts<'_>, _: &Bit) -> Result<(), Failure> {
        let settle_s = acts.duration_s(0)?;
        acts.set_and_settle(self.bit.0, self.level.is_high(), settle_s)
    }

    fn reverse(self, acts: &mut Acts<'_>, saved: &Bit) -> Result<(), Failure> {
        let settle_s = acts.duration_s(0)?;
        acts.set_and_settle(self.bit.0, saved.0, settle_s)
    }
}

impl Always<Acts<'_>> for op::OutputToggle {
    fn forward(self, acts: &mut Acts<'_>) -> Result<(), Failure> {
        let settle_s = acts.duration_s(0)?;
        let before = acts.level_before.unwrap_or_else(|| acts.cell.output(self.bit.0));
        acts.level_before = Some(before);
        acts.set_and_settle(self.bit.0, !before, settle_s)
    }

    fn reverse(self, acts: &mut Acts<'_>) -> Result<(), Failure> {
        let settle_s = acts.duration_s(0)?;
        let before = acts.level_before.unwrap_or_else(|| !acts.cell.output(self.bit.0));
        acts.level_before = Some(before);
        acts.set_and_settle(self.bit.0, before, settle_s)
    }
}

impl Always<Acts<'_>> for op::Wait {
    fn forward(self, acts: &mut Acts<'_>) -> Result<(), Failure> {
        let duration_s = acts.duration_s(0)?;
        acts.rest(duration_s)
    }

    fn reverse(self, _: &mut Acts<'_>) -> Result<(), Failure> {
        // What was waited for has happened.
        Ok(())
    }
}
