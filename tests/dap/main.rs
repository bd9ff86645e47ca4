//! The debug adapter as a client meets it: a session forward and back, and whatever else may come.
//!
//! What the adapter sends is left as transcripts, which `check.sh` beside this holds against the
//! protocol's own schema.

mod bad;
mod client;
mod recovery;
mod session;
mod tape;
