//! Acts that are stopped part way: on demand, for tests, and by chance.
//!
//! Knows the number of an act and where in it the stop falls, not what the act does.

use crate::cell::ChanceSpec;
use crate::random::{self, Stream};
use obverse_workcell::Fault;

/// A stop in an act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultPlan {
    /// The number of the act, from 0: every call of `execute`, `set_output` and `wait` is one,
    /// counted from the start of the workcell.
    pub act: u64,
    /// Where in the act the stop falls, 0 to 1. A motion holds at this fraction of its way, a wait
    /// ends after this fraction of its time; an output is set if it is at least one half.
    pub fraction: f64,
}

/// What stops an act part way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopKind {
    /// The arm is held until it is released.
    Protective,
    /// Likewise, and so is all else in the cell.
    Emergency,
    /// The act just ends early: nothing is held.
    Short,
}

/// A stop in the act that begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interruption {
    pub(crate) kind: StopKind,
    pub(crate) fraction: f64,
}

impl Interruption {
    /// The fault that it is.
    pub(crate) fn fault(self) -> Fault {
        let fraction = self.fraction;
        match self.kind {
            StopKind::Protective => Fault::ProtectiveStop { fraction },
            StopKind::Emergency => Fault::EmergencyStop { fraction },
            StopKind::Short => Fault::StoppedShort { fraction },
        }
    }

    /// What chance does to the motion of this number.
    pub(crate) fn by_chance(chance: &ChanceSpec, seed: u64, motion: u64) -> Option<Self> {
        let kinds = [
            (chance.emergency_stop, Stream::EmergencyStop, StopKind::Emergency),
            (chance.protective_stop, Stream::ProtectiveStop, StopKind::Protective),
            (chance.stops_short, Stream::StopsShort, StopKind::Short),
        ];
        let happens = |of: &&(f64, Stream, StopKind)| random::happens(of.0, seed, of.1, motion);
        let (_, _, kind) = *kinds.iter().find(happens)?;
        Some(Self { kind, fraction: random::unit(seed, Stream::StopAt, motion) })
    }
}

/// The acts that were begun and the plans that wait for theirs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Acts {
    begun: u64,
    plans: Vec<(FaultPlan, StopKind)>,
}

impl Acts {
    pub(crate) fn inject(&mut self, plan: FaultPlan, kind: StopKind) {
        self.plans.push((plan, kind));
    }

    pub(crate) fn begun(&self) -> u64 {
        self.begun
    }

    /// Begin an act: where it is to be stopped, if it is.
    pub(crate) fn begin(&mut self) -> Option<Interruption> {
        let act = self.begun;
        self.begun += 1;
        if self.plans.is_empty() {
            return None;
        }
        let found = self.plans.iter().find(|(plan, _)| plan.act == act).copied();
        self.plans.retain(|(plan, _)| plan.act > act);
        let (plan, kind) = found?;
        // A fraction that is not a number stops at once.
        let fraction = if plan.fraction.is_nan() { 0.0 } else { plan.fraction.clamp(0.0, 1.0) };
        Some(Interruption { kind, fraction })
    }
}
