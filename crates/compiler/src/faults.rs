//! The errors that the workcell raises, by faults or by what is watched: which faults there are to
//! name, and after which acts each may be found pending. What is done about them is as for those
//! that are thrown.

use crate::report::{Reports, warning};
use crate::tree::{Body, Program, StatementKind};
use obverse_bytecode::{ErrorDeclaration, FaultName};
use obverse_isa::ErrorId;
use obverse_syntax::ast::FaultWord;
use obverse_syntax::codes::Code;
use obverse_syntax::span::Span;

/// What commands the workcell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Act {
    /// A motion.
    Motion,
    /// An output that is set, or a wait.
    Other,
}

/// What a statement commands by itself.
pub(crate) fn act_of(kind: &StatementKind) -> Option<Act> {
    match kind {
        StatementKind::Move(_) => Some(Act::Motion),
        StatementKind::Output { .. } | StatementKind::Wait(_) | StatementKind::WaitInput { .. } => {
            Some(Act::Other)
        }
        _ => None,
    }
}

/// Whether an act may meet a fault.
fn may_meet(act: Act, fault: FaultName) -> bool {
    use FaultName::{EmergencyStop, Missing, ProtectiveStop};
    act == Act::Motion || matches!(fault, EmergencyStop | Missing | ProtectiveStop)
}

/// The name of a fault.
pub(crate) fn named(word: FaultWord) -> FaultName {
    match word {
        FaultWord::JointLimit => FaultName::JointLimit,
        FaultWord::OutOfReach => FaultName::OutOfReach,
        FaultWord::Singularity => FaultName::Singular,
        FaultWord::Collision => FaultName::Collision,
        FaultWord::ForceLimit => FaultName::ForceLimit,
        FaultWord::ProtectiveStop => FaultName::ProtectiveStop,
        FaultWord::EmergencyStop => FaultName::EmergencyStop,
        FaultWord::StoppedShort => FaultName::StoppedShort,
        FaultWord::Missing => FaultName::Missing,
    }
}

/// By act: the errors that a fault of it raises.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    by_motion: Vec<ErrorId>,
    by_other: Vec<ErrorId>,
}

impl Faults {
    /// Those of a program.
    pub(crate) fn of(errors: &[ErrorDeclaration]) -> Self {
        let by = |act| {
            let raises = |error: &ErrorDeclaration| {
                let is_met = error.faults.iter().any(|fault| may_meet(act, *fault));
                is_met || !error.watches.is_empty()
            };
            let raised = (0..).zip(errors).filter(|(_, error)| raises(error));
            raised.map(|(id, _)| ErrorId(id)).collect()
        };
        Self { by_motion: by(Act::Motion), by_other: by(Act::Other) }
    }

    /// The errors that a fault of an act may raise, in the order of their declarations.
    pub(crate) fn raised_by(&self, act: Act) -> &[ErrorId] {
        match act {
            Act::Motion => &self.by_motion,
            Act::Other => &self.by_other,
        }
    }
}

/// Where a program names a fault.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NamedFault {
    /// Which.
    pub(crate) word: FaultWord,
    /// Where.
    pub(crate) span: Span,
}

/// Warn of faults that nothing in the program can meet.
pub(crate) fn check(program: &Program, named_faults: &[NamedFault], reports: &mut Reports) {
    if named_faults.is_empty() {
        return;
    }
    let (mut moves, mut acts) = (false, false);
    for (_, function) in program.numbered() {
        match &function.body {
            Body::Guarded(_) => moves = true,
            Body::Block(block) => {
                block.each_statement(&mut |statement| match act_of(&statement.kind) {
                    Some(Act::Motion) => moves = true,
                    Some(Act::Other) => acts = true,
                    None => {}
                });
            }
        }
    }
    for NamedFault { word, span } in named_faults {
        if moves || acts && may_meet(Act::Other, named(*word)) {
            continue;
        }
        let message = format!("nothing in the program can meet this fault, {}", word.text());
        reports.add(
            warning(Code::FaultNeverMet, *span, message, "never raised")
                .with_help("leave it out; or what moves the arm is missing"),
        );
    }
}
