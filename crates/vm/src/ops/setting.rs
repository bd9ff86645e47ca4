//! The family `setting`: what holds for the motions that follow, restored by identity.

use super::acts::Acts;
use crate::class::{AfterForward, Failure};
use obverse_isa::op;
use obverse_tape::record::Word;

impl AfterForward<Acts<'_>> for op::SettingSet {
    type Saved = Word;

    fn save(&self, acts: &Acts<'_>) -> Word {
        Word(acts.settings[self.setting as usize])
    }

    fn forward(self, acts: &mut Acts<'_>, _: &Word) -> Result<(), Failure> {
        acts.settings[self.setting as usize] = acts.operand(0);
        Ok(())
    }

    fn reverse(self, acts: &mut Acts<'_>, saved: &Word) -> Result<(), Failure> {
        acts.settings[self.setting as usize] = saved.0;
        Ok(())
    }
}
