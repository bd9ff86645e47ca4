//! The family `error`: the errors that the program has raised and not yet dealt with, oldest first.

use super::acts::Acts;
use crate::class::{AfterForward, Always, Failure};
use crate::stop::TrapKind;
use obverse_isa::op;
use obverse_tape::record::Word;

impl Always<Acts<'_>> for op::ErrorRaise {
    fn forward(self, acts: &mut Acts<'_>) -> Result<(), Failure> {
        acts.raised.push(self.error);
        Ok(())
    }

    fn reverse(self, acts: &mut Acts<'_>) -> Result<(), Failure> {
        acts.raised.pop();
        Ok(())
    }
}

impl Always<Acts<'_>> for op::ErrorDue {
    fn forward(self, _: &mut Acts<'_>) -> Result<(), Failure> {
        Ok(())
    }

    fn reverse(self, _: &mut Acts<'_>) -> Result<(), Failure> {
        Ok(())
    }
}

/// Stands on the tape where an error that was cleared was not pending.
const NOWHERE: u64 = u64::MAX;

impl AfterForward<Acts<'_>> for op::ErrorClear {
    type Saved = Word;

    fn save(&self, acts: &Acts<'_>) -> Word {
        let place = acts.raised.iter().position(|error| *error == self.error);
        Word(place.map_or(NOWHERE, |place| place as u64))
    }

    fn forward(self, acts: &mut Acts<'_>, saved: &Word) -> Result<(), Failure> {
        if saved.0 != NOWHERE {
            acts.raised.remove(saved.0 as usize);
        }
        Ok(())
    }

    fn reverse(self, acts: &mut Acts<'_>, saved: &Word) -> Result<(), Failure> {
        if saved.0 != NOWHERE {
            let place = (saved.0 as usize).min(acts.raised.len());
            acts.raised.insert(place, self.error);
        }
        Ok(())
    }
}

impl Always<Acts<'_>> for op::Require {
    fn forward(self, acts: &mut Acts<'_>) -> Result<(), Failure> {
        if acts.operand(0) == 0 {
            return Err(TrapKind::Required(self.reason).into());
        }
        Ok(())
    }

    fn reverse(self, _: &mut Acts<'_>) -> Result<(), Failure> {
        Ok(())
    }
}
