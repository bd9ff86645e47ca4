//! What the tests and the benchmarks share: a workcell of pure bookkeeping, programs, oracles,
//! laws.
//!
//! A dev-dependency only: nothing that ships links it.

pub mod altered;
pub mod always_laws;
pub mod code;
pub mod debug_laws;
pub mod faulty;
pub mod files;
pub mod fork_code;
pub mod format_laws;
pub mod front_laws;
pub mod hostile;
pub mod invert_laws;
pub mod invertible;
pub mod large;
pub mod laws;
pub mod ledger;
pub mod logged;
pub mod machine_laws;
pub mod preflight_laws;
pub mod programs;
pub mod reach_laws;
pub mod reach_programs;
pub mod recovery_laws;
pub mod reference;
pub mod session_laws;
pub mod symbol_laws;
pub mod tape_laws;
pub mod wait_laws;
pub mod word_laws;

pub use ledger::Ledger;
