//! Campaigns of a case whose truth is known: what is computed depends on the plan alone, files are
//! put together or refused, and the figures are those of the case.

mod campaign;
mod shards;
mod toy;
