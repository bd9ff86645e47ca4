//! What a program asks for about an error, before anybody decides how far to go back.

use crate::ending::GiveUp;
use crate::strategy::Strategy;
use obverse_bytecode::{ErrorDeclaration, Otherwise, Recovery, Reversal, Severity};
use obverse_isa::FunctionId;

/// How the program wants an error to be gone back from, if it does.
pub(crate) fn reversal(error: &ErrorDeclaration) -> Option<&Reversal> {
    match &error.recovery {
        Recovery::Reversing(reversal) => Some(reversal),
        _ => None,
    }
}

/// The sequence that a program has against an error, if it has one.
#[must_use]
pub fn sequence(error: &ErrorDeclaration) -> Option<FunctionId> {
    match (&error.recovery, error.otherwise) {
        (Recovery::Using(function), _) => Some(FunctionId(*function)),
        (_, Otherwise::Using(function)) => Some(FunctionId(function)),
        _ => None,
    }
}

/// Whether going back is asked for at all, by the program or in its place by a strategy.
pub(crate) fn check(error: &ErrorDeclaration, strategy: Strategy) -> Result<(), GiveUp> {
    let (reverses, has_sequence) = (reversal(error).is_some(), sequence(error).is_some());
    if error.severity != Severity::Recoverable || !reverses && !has_sequence {
        return Err(GiveUp::NoRecovery);
    }
    let is_explicit = match strategy {
        Strategy::Declared => !reverses,
        Strategy::Explicit => has_sequence,
        _ => false,
    };
    if is_explicit { Err(GiveUp::Explicit) } else { Ok(()) }
}
