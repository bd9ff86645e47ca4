//! What can be said of each move before anything moves.
//!
//! [`check`] follows a verified program on all the ways that it may take, with values that are
//! known or not, and asks a workcell in thought about each motion that it comes by, forward and
//! in reverse. Every move gets a [`Grade`] with a [`Reason`]. The workcell answers with the code
//! that carries out real motions; everything is taken to be where the workcell file says.
//!
//! Read `state` and `worlds`, then `explore`, `act` and `tasks`, then `seen` (why it ends) and
//! `back`.
//! Knows nothing of source languages, of files, or of how its findings are shown.

mod act;
mod back;
mod command;
mod explore;
mod felt;
mod notes;
pub mod reason;
mod report;
mod seen;
mod state;
mod tasks;
mod trace;
mod value;
mod verdict;
mod worlds;

pub use notes::Graded;
pub use reason::{Grade, Reason};
pub use report::{MoveReport, Report, check};
pub use verdict::{Contact, Verdict};
