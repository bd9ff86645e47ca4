//! What the code does about an error where it is due, as its declaration says.
//!
//! Reversal is not among it: whoever drives the machine goes back when the code says that the error
//! is due, and the code after that is what follows once reversing has been given up.

use obverse_bytecode::{Continuation, ErrorDeclaration, Otherwise, Recovery, Respond, Severity};
use obverse_isa::FunctionId;

/// What is done about an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Response {
    /// It is dealt with by noting it.
    Ignore,
    /// The program stops with the error pending.
    Stop,
    /// The program goes on after a recovery.
    Recover {
        /// The sequence that is run, if there is one.
        using: Option<FunctionId>,
        /// How it goes on.
        then: Continuation,
    },
}

/// What is done about an error.
pub(crate) fn response(error: &ErrorDeclaration) -> Response {
    match error.severity {
        Severity::Warning => return Response::Ignore,
        Severity::Fatal => return Response::Stop,
        Severity::Recoverable => {}
    }
    let using = match (&error.recovery, error.otherwise) {
        (Recovery::Using(function), _) => Some(FunctionId(*function)),
        (_, Otherwise::Using(function)) => Some(FunctionId(function)),
        _ => None,
    };
    match (using, &error.recovery, error.continuation) {
        (None, Recovery::Reversing(_), _) | (None, _, Continuation::Stop) => Response::Stop,
        (None, _, Continuation::NextAction) => Response::Ignore,
        (using, _, then) => Response::Recover { using, then },
    }
}

/// How urgent it is to respond to an error: of several that are due at one place the least comes
/// first, and of those alike the one that is declared first.
pub(crate) fn urgency(error: &ErrorDeclaration) -> u8 {
    match error.severity {
        Severity::Fatal => 0,
        Severity::Recoverable => 1,
        Severity::Warning => 2,
    }
}

/// Whether it is responded to where the sequence that raised it was called.
pub(crate) fn is_for_caller(error: &ErrorDeclaration) -> bool {
    error.respond == Respond::AfterSequence
}

/// Whether what follows a `throw` of this error is reached.
pub(crate) fn goes_on_after_throw(error: &ErrorDeclaration) -> bool {
    let continues = Continuation::NextAction;
    is_for_caller(error)
        || match response(error) {
            Response::Ignore => true,
            Response::Stop => false,
            Response::Recover { then, .. } => then == continues,
        }
}
