//! The command line, through its binary: what each command prints, writes and ends with, and what
//! it says to wrong input.

mod commands;
mod fmt;
mod invert;
mod support;
mod wrong_files;
mod wrong_input;
