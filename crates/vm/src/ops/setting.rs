//! The family `setting`: what holds for the motions that follow, restored by identity.

use super::acts::Acts;
use crate::class::{AfterForward, Failure};
use crate::stop::TrapKind;
use obverse_isa::{Setting, op};
use obverse_tape::record::Word;

impl AfterForward<Acts<'_>> for op::SettingSet {
    type Saved = Word;

    fn save(&self, acts: &Acts<'_>) -> Word {
        Word(acts.settings[self.setting as usize])
    }

    fn forward(self, acts: &mut Acts<'_>, _: &Word) -> Result<(), Failure> {
        // Written so that what is no number fails.
        let is_force = self.setting != Setting::ReverseForceLimit || acts.real(0) > 0.0;
        if !is_force {
            return Err(TrapKind::NotAForceLimit.into());
        }
        acts.settings[self.setting as usize] = acts.operand(0);
        Ok(())
    }

    fn reverse(self, acts: &mut Acts<'_>, saved: &Word) -> Result<(), Failure> {
        acts.settings[self.setting as usize] = saved.0;
        Ok(())
    }
}
