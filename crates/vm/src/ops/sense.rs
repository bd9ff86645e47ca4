//! The family `sense`: readings of the outside, stored into a variable; what was there is saved.

use super::acts::Acts;
use crate::class::{AfterForward, Failure};
use obverse_isa::op;
use obverse_tape::record::{Joints, Word};
use obverse_workcell::Fault;

/// Readings into a local: what is read.
macro_rules! readings {
    ($($op:ident($this:ident, $acts:ident) => $reading:expr;)*) => {$(
        impl AfterForward<Acts<'_>> for op::$op {
            type Saved = Word;

            fn save(&self, acts: &Acts<'_>) -> Word {
                Word(acts.slots[self.local.index()])
            }

            fn forward(self, $acts: &mut Acts<'_>, _: &Word) -> Result<(), Failure> {
                let $this = self;
                let reading: u64 = $reading;
                *$acts.local($this.local) = reading;
                Ok(())
            }

            fn reverse(self, acts: &mut Acts<'_>, saved: &Word) -> Result<(), Failure> {
                *acts.local(self.local) = saved.0;
                Ok(())
            }
        }
    )*};
}

readings! {
    SenseInput(op, acts) => u64::from(acts.cell.input(op.bit.0)?);
    SenseForce(op, acts) => acts.cell.force_n().to_bits();
    SenseDistance(op, acts) => acts.cell.last_motion().distance_m.to_bits();
    SensePeakForce(op, acts) => acts.cell.last_motion().peak_force_n.to_bits();
    SenseHolding(op, acts) => u64::from(acts.cell.held().is_some());
    WaitInput(op, acts) => u64::from(wait_for(acts, op)?);
}

/// How often an input is looked at while it is waited for, in seconds.
const POLL_S: f64 = 0.01;
/// The most looks at an input that is waited for: more than a day of them.
const MAX_POLLS: f64 = 1e7;

/// Counts the looks, and not the time that has passed, since a clock that is far on may not be
/// moved by the little that is left to wait.
fn wait_for(acts: &mut Acts<'_>, op: op::WaitInput) -> Result<bool, Failure> {
    let longest_s = acts.duration_s(0)?;
    let polls = (longest_s / POLL_S).min(MAX_POLLS).ceil() as u64;
    for poll in 0..polls {
        if acts.cell.input(op.bit.0)? == op.level.is_high() {
            return Ok(true);
        }
        let left_s = longest_s - poll as f64 * POLL_S;
        wait_between(acts, left_s.clamp(0.0, POLL_S), poll, polls)?;
    }
    Ok(acts.cell.input(op.bit.0)? == op.level.is_high())
}

/// Wait between two looks; what comes to hold does so after a fraction of all that is waited for at
/// the most.
fn wait_between(acts: &mut Acts<'_>, wait_s: f64, poll: u64, polls: u64) -> Result<(), Failure> {
    let of_all = |fraction: f64| (poll as f64 + fraction) / polls as f64;
    let has_noticed = acts.done.noticed.is_some();
    let waited = acts.wait(wait_s);
    if let (false, Some((_, fraction))) = (has_noticed, &mut acts.done.noticed) {
        *fraction = of_all(*fraction);
    }
    waited.map_err(|failure| match failure {
        Failure::Fault(Fault::Watched { watch, fraction }) => {
            Failure::Fault(Fault::Watched { watch, fraction: of_all(fraction) })
        }
        other => other,
    })
}

impl AfterForward<Acts<'_>> for op::Draw {
    type Saved = Word;

    fn save(&self, acts: &Acts<'_>) -> Word {
        Word(acts.slots[self.local.index()])
    }

    fn forward(self, acts: &mut Acts<'_>, _: &Word) -> Result<(), Failure> {
        *acts.local(self.local) = acts.cell.draw(*acts.draws).to_bits();
        *acts.draws = acts.draws.wrapping_add(1);
        Ok(())
    }

    fn reverse(self, acts: &mut Acts<'_>, saved: &Word) -> Result<(), Failure> {
        *acts.local(self.local) = saved.0;
        *acts.draws = acts.draws.wrapping_sub(1);
        Ok(())
    }
}

impl AfterForward<Acts<'_>> for op::Remember {
    type Saved = Joints;

    fn save(&self, acts: &Acts<'_>) -> Joints {
        Joints(acts.positions[self.slot.index()])
    }

    fn forward(self, acts: &mut Acts<'_>, _: &Joints) -> Result<(), Failure> {
        *acts.position(self.slot) = acts.cell.joints();
        Ok(())
    }

    fn reverse(self, acts: &mut Acts<'_>, saved: &Joints) -> Result<(), Failure> {
        *acts.position(self.slot) = saved.0;
        Ok(())
    }
}
