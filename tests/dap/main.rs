//! The debug adapter as a client meets it: a session forward and back, and whatever else may come.
//!
//! What the adapter sends is left as transcripts, which `check.sh` beside this holds against the
//! protocol's own schema.

mod back;
mod bad;
mod begin;
mod client;
mod console;
mod files;
mod recovery;
mod session;
mod tape;
