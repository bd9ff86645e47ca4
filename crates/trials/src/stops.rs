//! Which errors of a run a stop of the workcell came with, and whether a person released the arm.
//!
//! A recovery tells of faults, of blocked ways back and of fresh commands as they come. Knows
//! nothing of how an error is dealt with.

use obverse_isa::ErrorId;
use obverse_recovery::{Ending, Incident, Step, Teller};
use obverse_vm::{Event, Observer};
use obverse_workcell::Workcell;

/// What was told of stops in a run.
#[derive(Default)]
pub(crate) struct Stops {
    /// Whose stop it is that is told of next.
    of: Of,
    /// Whose stops were released, and when, in seconds of the workcell's clock.
    released: Vec<(Of, f64)>,
    /// The error of the fault that was told of last, and the act, if nothing has come of it yet.
    named: Option<(ErrorId, u32)>,
}

/// What a stop belongs to.
#[derive(Clone, Copy, Default, PartialEq)]
enum Of {
    /// The error that came up last of those that are open.
    #[default]
    Newest,
    /// This error, where it came up last.
    Error(ErrorId),
    /// None of them: it was in the cleanup.
    Nothing,
}

impl Observer for Stops {
    fn on_event(&mut self, _: &Event, _: &dyn Workcell) {}
}

impl Teller for Stops {
    fn on_step(&mut self, step: &Step<'_>, cell: &dyn Workcell) {
        if *step == Step::Released {
            self.released.push((self.of, cell.now_s()));
        }
        self.named = None;
        self.of = match step {
            Step::Fault { error, pc, .. } => {
                self.named = Some((*error, *pc));
                Of::Error(*error)
            }
            Step::Blocked { incident, .. } => Of::Error(incident.error),
            Step::PassedOver { .. } => Of::Nothing,
            _ => Of::Newest,
        };
    }
}

impl Stops {
    /// For which incidents of the run a person released the arm.
    pub(crate) fn released(&self, incidents: &[Incident]) -> Vec<bool> {
        let mut released = vec![false; incidents.len()];
        for (of, at_s) in &self.released {
            let is_its = |incident: &Incident| {
                let ended_s = incident.outcome.map_or(f64::INFINITY, |(_, ended_s)| ended_s);
                let is_open = incident.began_s <= *at_s && *at_s <= ended_s;
                is_open && (*of == Of::Newest || *of == Of::Error(incident.error))
            };
            let open = incidents.iter().enumerate().filter(|(_, incident)| is_its(incident));
            let newest = open.max_by(|(_, one), (_, other)| one.began_s.total_cmp(&other.began_s));
            if let Some((index, _)) = newest {
                released[index] = true;
            }
        }
        released
    }

    /// The error, and the act, of the fault that a run ended in because nobody released the arm.
    pub(crate) fn held(&self, ended: &Ending) -> Option<(ErrorId, u32)> {
        self.named.filter(|(_, at)| matches!(ended, Ending::Fault { pc, .. } if pc == at))
    }
}
