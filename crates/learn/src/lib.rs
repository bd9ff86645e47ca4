//! Learning the parameters of an action: which values, within their ranges, succeed most often.
//!
//! [`space`] says which values are tried, [`mod@search`] which of them to try again and which to
//! leave out, and [`mod@file`] what is kept of it on a disk. Knows nothing of programs, machines
//! and workcells: whether an attempt succeeds it asks.

pub mod file;
pub mod search;
pub mod space;

pub use file::{Evidence, FileError, ParameterFile, Value};
pub use search::{Budget, Learned, Standing, least_runs, search};
pub use space::Axis;
