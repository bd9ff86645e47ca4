//! Faults on demand, for tests: an act that is stopped part way.
//!
//! Knows the number of an act and where in it the stop falls, not what the act does.

/// A protective stop in an act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultPlan {
    /// The number of the act, from 0: every call of `execute`, `set_output` and `wait` is one,
    /// counted from the start of the workcell.
    pub act: u64,
    /// Where in the act the stop falls, 0 to 1. A motion holds at this fraction of its way, a wait
    /// ends after this fraction of its time; an output is set if it is at least one half.
    pub fraction: f64,
}

/// The acts that were begun and the plans that wait for theirs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Acts {
    begun: u64,
    plans: Vec<FaultPlan>,
}

impl Acts {
    pub(crate) fn inject(&mut self, plan: FaultPlan) {
        self.plans.push(plan);
    }

    pub(crate) fn begun(&self) -> u64 {
        self.begun
    }

    /// Begin an act: the fraction at which it is to be stopped, if it is.
    pub(crate) fn begin(&mut self) -> Option<f64> {
        let act = self.begun;
        self.begun += 1;
        if self.plans.is_empty() {
            return None;
        }
        let plan = self.plans.iter().find(|plan| plan.act == act).map(|plan| plan.fraction);
        self.plans.retain(|plan| plan.act > act);
        // A fraction that is not a number stops at once.
        plan.map(|fraction| fraction.clamp(0.0, 1.0)).map(|f| if f.is_nan() { 0.0 } else { f })
    }
}
