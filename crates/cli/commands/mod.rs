//! The commands, one a file.

pub(crate) mod back;
pub(crate) mod build;
pub(crate) mod check;
pub(crate) mod dap;
pub(crate) mod debug;
pub(crate) mod dis;
mod dry;
pub(crate) mod explain;
pub(crate) mod fmt;
pub(crate) mod invert;
pub(crate) mod isa;
pub(crate) mod learn;
pub(crate) mod lsp;
pub(crate) mod reach;
pub(crate) mod run;
pub(crate) mod tape;
pub(crate) mod trials;

use crate::Outcome;
use crate::problem::Problem;

/// What every command returns.
pub(crate) type Result = std::result::Result<Outcome, Problem>;
