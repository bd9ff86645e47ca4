//! Places where contact stopped the arm.
//!
//! The force is read from time to time, and when, relative to a motion, is not known before
//! running: so neither is where exactly a contact stops the arm, and how hard it presses there.
//! Knows for which motions that decides whether they end in a fault.

use crate::command::Guard;
use obverse_geometry::{JOINT_COUNT, JointConfiguration};
use obverse_sim::Plan;
use obverse_workcell::{Arm, Fault, Goal, Motion, MotionEnd, MotionReport};
use std::collections::HashMap;

/// What is left for what was not tried, when a contact may press harder in a run.
const MARGIN: f64 = 1.25;
/// What presses harder by less than this, in newtons, does not.
const LEAST_N: f64 = 0.01;
/// What meets something after this part of its way to a place of contact may get there in a run,
/// and likewise at the other end.
const NEAR_THE_END: f64 = 0.9;

/// What came of a motion in thought.
type Outcome = Result<MotionReport, Fault>;

/// The joints where contact stopped the arm, or counted from there, and how many times as hard as
/// in thought it may press in a run.
#[derive(Default)]
pub(crate) struct Felt(HashMap<[u64; JOINT_COUNT], f64>);

impl Felt {
    fn at(&self, joints: &JointConfiguration) -> Option<f64> {
        self.0.get(&joints.bits()).copied()
    }

    /// Whether it depends on when the force is read if a motion ends in a fault.
    pub(crate) fn decides(
        &mut self,
        before: &Plan,
        motion: &Motion,
        guard: Guard,
        (outcome, after): (&Outcome, &Plan),
    ) -> bool {
        let is_stopped = matches!(outcome, Ok(report) if report.end == MotionEnd::StoppedByForce);
        let mut most_n: f64 = 0.0;
        if guard != Guard::None && (is_stopped || before.contact_n() > 0.0) {
            let phases = before.after_in_phases(motion);
            let is_other = |other: &Outcome| is_fault(other, guard) != is_fault(outcome, guard);
            if begins_above(before, guard) || phases.iter().any(|(other, _)| is_other(other)) {
                return true;
            }
            most_n = phases.iter().map(|(_, plan)| plan.contact_n()).fold(0.0, f64::max);
        }
        let begins = self.at(&before.workcell().joints());
        let ends = match &motion.goal {
            Goal::Joints(to) => self.at(to),
            Goal::Pose(_) => None,
            Goal::Displaced { from, .. }
            | Goal::Offset { from, .. }
            | Goal::Turned { from, .. } => self.at(from),
        };
        if let (true, Guard::Ends(_)) = (is_stopped, guard) {
            let times = MARGIN * (most_n / after.contact_n()).max(1.0);
            self.0.insert(after.workcell().joints().bits(), times);
        } else if let (Ok(_), Some(times)) = (outcome, ends) {
            self.0.insert(after.workcell().joints().bits(), times);
        }
        match outcome {
            Ok(report) => {
                let presses = ends.filter(|_| !matches!(guard, Guard::Ends(_)));
                begins.is_some_and(|times| goes_deeper(before, report, times))
                    || presses.is_some_and(|times| after.contact_n() * times > most(before, guard))
            }
            Err(Fault::Collision { fraction, .. }) => {
                begins.is_some() && *fraction <= 1.0 - NEAR_THE_END
                    || ends.is_some() && *fraction >= NEAR_THE_END
            }
            Err(_) => false,
        }
    }
}

/// What came of a motion, as the machine takes it.
pub(crate) fn as_taken(report: MotionReport, guard: Guard) -> Outcome {
    match (report.end, guard) {
        (MotionEnd::StoppedByForce, Guard::Faults(Some(limit_n))) => {
            Err(Fault::ForceLimit { force_n: report.peak_force_n, limit_n })
        }
        _ => Ok(report),
    }
}

fn is_fault(outcome: &Outcome, guard: Guard) -> bool {
    outcome.clone().and_then(|report| as_taken(report, guard)).is_err()
}

/// Whether a motion begins pressed harder than its limit, which is read when it has left, or not.
fn begins_above(before: &Plan, guard: Guard) -> bool {
    matches!(guard, Guard::Faults(Some(limit_n)) if before.contact_n() > limit_n)
}

/// The force that a motion may end with, in newtons.
fn most(before: &Plan, guard: Guard) -> f64 {
    let stop_n = before.workcell().cell().contact.stop_force_n;
    match guard {
        Guard::Faults(Some(limit_n)) => limit_n.min(stop_n),
        _ => stop_n,
    }
}

/// Whether a motion that begins where contact stopped the arm may press on too hard: what leads
/// away presses nowhere harder than where it begins.
fn goes_deeper(before: &Plan, report: &MotionReport, times: f64) -> bool {
    let cell = before.workcell().cell();
    let peak_n = report.peak_force_n;
    let is_deeper = peak_n > before.contact_n() + cell.force_sensor.bias_n.abs() + LEAST_N;
    is_deeper && peak_n * times > cell.contact.stop_force_n
}
