//! Errors and how a run goes on after them.
