//! The language server through its protocol, in memory: a test a feature, then what is half
//! written, what is out of range, and what is no question at all. Places in the sources are marked
//! `«so»`.

mod colours;
mod going_back;
mod lifecycle;
mod mistakes;
mod names;
mod robustness;
mod several_files;
mod signatures;
mod support;
mod writing;
