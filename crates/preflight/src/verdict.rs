//! What was found out about a motion: its reason, and the numbers that a person needs.

use crate::reason::{Grade, Reason};
use obverse_sim::Plan;
use obverse_sim::plan::BodyKind;
use obverse_vm::Direction;
use obverse_workcell::{Fault, FaultKind, Motion, Path};
use std::rc::Rc;

/// What was found out about a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Why it has its grade.
    pub reason: Reason,
    /// In words, with numbers; empty where the reason says it all.
    pub detail: String,
    /// Where along the path, 0 to 1, if anywhere.
    pub fraction: Option<f64>,
    /// What touches what.
    pub contact: Option<Contact>,
    /// The fault that a run ends with there, if that is known.
    pub fault: Option<FaultKind>,
}

/// Two bodies that touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// A link of the arm, the tool, or the held item.
    pub body: String,
    /// A fixture or an item.
    pub with: String,
    /// How hard they are pressed together where the arm stops, in newtons.
    pub force_n: f64,
}

impl Verdict {
    /// Nothing but a reason.
    #[must_use]
    pub fn new(reason: Reason) -> Self {
        Self { reason, detail: String::new(), fraction: None, contact: None, fault: None }
    }

    /// The grade.
    #[must_use]
    pub fn grade(&self) -> Grade {
        self.reason.grade()
    }
}

/// What was found out on a way that is not followed as it would be run, for this reason.
pub(crate) fn because(
    found: &Rc<Verdict>,
    since: Option<Reason>,
    direction: Direction,
) -> Rc<Verdict> {
    let has_failed = since == Some(Reason::AfterFailure);
    let is_so_since = match found.reason {
        Reason::StartNotKnown | Reason::HeldNotKnown => true,
        // A failure makes no value unknown, but where to go back to.
        Reason::GoalNotKnown | Reason::SettingNotKnown => {
            !has_failed || direction == Direction::Reverse
        }
        // Where a move has failed, the arm may stand where it cannot.
        Reason::LongContact | Reason::StopNotKnown => has_failed,
        _ => false,
    };
    since
        .filter(|_| is_so_since)
        .map_or_else(|| found.clone(), |reason| Verdict::new(reason).into())
}

/// What a fault says of the motion that would meet it.
pub(crate) fn of_fault(fault: &Fault, plan: &Plan, motion: &Motion) -> Verdict {
    // A line that cannot be followed to a goal that can be reached.
    let is_line_alone = motion.path == Path::Linear
        && plan.end_of(&Motion { path: Path::Joint, ..*motion }).is_ok();
    let (mut fraction, mut contact) = (None, None);
    let reason = match fault {
        Fault::Collision { body, with, fraction: at, force_n } => {
            fraction = Some(*at);
            let force_n = *force_n;
            contact = Some(Contact { body: body.clone(), with: with.clone(), force_n });
            match plan.kind_of(body, motion.tool.0) {
                BodyKind::Arm => Reason::ArmCollides,
                BodyKind::Tool => Reason::ToolCollides,
                BodyKind::Held => Reason::HeldCollides,
            }
        }
        Fault::Singular { fraction: at } => {
            fraction = Some(*at);
            Reason::LineSingular
        }
        Fault::JointLimit { .. } if is_line_alone => Reason::LineLeavesRange,
        Fault::OutOfReach { .. } if is_line_alone => Reason::LineLeavesReach,
        Fault::BadCommand { .. } if is_line_alone => Reason::LineEndsOtherwise,
        Fault::ForceLimit { .. } => Reason::StoppedByForce,
        Fault::JointLimit { .. } => Reason::GoalOutOfRange,
        Fault::OutOfReach { .. } => Reason::GoalOutOfReach,
        Fault::BadCommand { .. }
        | Fault::Missing { .. }
        | Fault::Stopped
        | Fault::EmergencyStop { .. }
        | Fault::StoppedShort { .. }
        | Fault::Watched { .. }
        | Fault::ProtectiveStop { .. } => Reason::BadCommand,
    };
    Verdict { reason, detail: fault.to_string(), fraction, contact, fault: Some(fault.kind()) }
}
