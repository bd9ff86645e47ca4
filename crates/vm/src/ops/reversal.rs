//! The family `reversal`, as far as opcodes do anything: what is of class never has no reverse.
//! Blocks and checkpoints are the step loop's, since they change what going back means.

use super::acts::Acts;
use crate::class::{Failure, Never};
use obverse_isa::op;

impl Never<Acts<'_>> for op::Barrier {
    fn forward(self, _: &mut Acts<'_>) -> Result<(), Failure> {
        Ok(())
    }
}

impl Never<Acts<'_>> for op::Irreversible {
    fn forward(self, _: &mut Acts<'_>) -> Result<(), Failure> {
        Ok(())
    }
}
