//! What is said of small modules: of their points, and of what they ask for and cannot have.

mod common;
mod forks;
mod verdicts;
