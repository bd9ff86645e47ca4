//! Campaigns: many seeded assemblies by several strategies, and what they show.
//!
//! A campaign is a [`plan`]: how many assemblies, from which seed, by which strategies. Every
//! assembly is a pure function of its seed, its strategy and what was learned before
//! ([`mod@learn`]), so that neither threads ([`pool`]) nor shards ([`shard`]) nor a stop half-way
//! change a byte of what comes out. [`mod@case`] is what a campaign asks of whatever it tries,
//! [`machine`] the case that is a program in its workcell, where `stops` sees which errors a person
//! had to release the arm for; [`outcome`] says how an assembly ended.
//! [`tally`] counts, with the formulas of [`statistics`]; [`table`] and [`plots`] show.
//!
//! Knows nothing of how a strategy recovers, of files and of terminals.

pub mod campaign;
pub mod case;
pub mod learn;
pub mod machine;
pub mod outcome;
pub mod plan;
pub mod plots;
pub mod pool;
pub mod shard;
pub mod statistics;
mod stops;
pub mod strategy;
mod svg;
pub mod table;
pub mod tally;

pub use campaign::run;
pub use case::{Case, Stand};
pub use learn::learn;
pub use machine::MachineCase;
pub use outcome::{Ending, Incident, Outcome, Record, Stop};
pub use plan::{Plan, Shard};
pub use shard::{Part, ShardError, merge};
pub use strategy::Strategy;
pub use tally::{Summary, summary};
