//! The steps of a recovery as notes on the tape.

use crate::driven::Driven;
use crate::incident::Incident;
use crate::tell::{Step, Teller};
use obverse_tape::{Note, Noted};
use obverse_workcell::Workcell;

/// Tell a step, and note it on the tape.
pub(crate) fn say<C: Workcell>(
    driven: &mut dyn Driven<'_, C>,
    teller: &mut dyn Teller,
    step: &Step<'_>,
) {
    teller.on_step(step, driven.cell());
    let Some((error, pc, attempts, what)) = noted(step) else { return };
    let (steps, time_s) = (driven.machine().state().steps(), driven.cell().now_s());
    driven.note(Note { steps, time_s, error, pc, attempts, what });
}

fn noted(step: &Step<'_>) -> Option<(u16, u32, u32, Noted)> {
    let of = |incident: &Incident, what| {
        Some((incident.error.0, incident.pc, incident.attempts.len() as u32, what))
    };
    match *step {
        Step::Fault { pc, error, .. } => Some((error.0, pc, 0, Noted::Fault)),
        Step::Back { incident, actions, to, .. } => {
            of(incident, Noted::Back { actions: actions as u32, to })
        }
        Step::InPlace { incident, backed_up_m } => of(incident, Noted::InPlace { backed_up_m }),
        Step::Blocked { incident, pc, .. } => of(incident, Noted::Blocked { at: pc }),
        Step::Again { incident, change } => {
            let change = change.unwrap_or_default();
            let (slower, force_factor) = (change.slower, change.force_factor);
            let aside_m = change.aside.map(|aside| aside.by_m);
            of(incident, Noted::Again { slower, force_factor, aside_m })
        }
        Step::Recovered { incident } => of(incident, Noted::Recovered),
        Step::GivenUp { incident, why } => {
            of(incident, Noted::GivenUp { why: why.code().to_owned() })
        }
        Step::Released
        | Step::PassedOver { .. }
        | Step::RoundTrip { .. }
        | Step::Operator { .. } => None,
    }
}
