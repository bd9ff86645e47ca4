//! Errors: when to go back, how far, what to change, when to go on, when to give up.
//!
//! Recovery owns the loop and asks the machine to step; the machine never calls up. It alone
//! decides how a run goes on after an error; it knows nothing of how motions, tapes or source texts
//! work.
//!
//! Reading order: [`ending`], how a run ends; [`mod@drive`], a run that never goes back by itself;
//! [`driven`], what is driven;
//! [`trail`], what it may be taken back to; [`strategy`], the ways of recovering; [`incident`], an
//! error at a place and what has been tried, with the words for a place, a fault that becomes an
//! error and what the program asks for (`place`, `fault`, `asked`); [`depth`], how far to go back
//! next; [`memory`], what was learned of that, with the codes of what is wrong with its text
//! ([`mod@code`]), and `belief`, what follows; [`foresight`], who would know better; [`change`],
//! what is done otherwise on the way forward again; [`tell`], what a person is told, in words
//! ([`words`](mod@words)), and the tape (`noted`); [`recovering`], where a run stands between two
//! looks at it; [`mod@recover`], the loop, `plan`, what is decided in it, and `attempt`, one way
//! back and forward again.

mod asked;
mod attempt;
mod belief;
pub mod change;
pub mod code;
pub mod depth;
pub mod drive;
pub mod driven;
pub mod ending;
mod fault;
pub mod foresight;
pub mod incident;
pub mod memory;
mod noted;
mod passage;
mod place;
mod plan;
pub mod recover;
pub mod recovering;
pub mod strategy;
pub mod tell;
pub mod trail;
pub mod words;

pub use asked::sequence;
pub use code::MemoryCode;
pub use drive::{drive, drive_in};
pub use driven::{Direct, Driven};
pub use ending::{Ending, GiveUp};
pub use foresight::Clairvoyant;
pub use incident::{Attempt, Incident, Outcome, Search};
pub use memory::{Memory, MemoryError, Subject};
pub use place::{has_place, place};
pub use recover::{Foresight, Recovery, Site, recover, recover_in};
pub use recovering::{Advance, Intended, Intent, Recovering};
pub use strategy::{Bounds, PERSON_S, Strategy};
pub use tell::{Operator, Step, Teller, Unattended, Why};
pub use trail::{Action, Trail};
pub use words::{changed, name, words};
