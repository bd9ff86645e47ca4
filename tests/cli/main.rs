//! The command line, through its binary: what each command prints, writes and ends with, and what
//! it says to wrong input.

mod commands;
mod debug;
mod debug_after;
mod debug_commands;
mod debug_data;
mod debug_errors;
mod fmt;
mod imports;
mod invert;
mod learn;
mod lsp;
mod memory;
mod moves;
mod reach;
mod stops;
mod support;
mod trials;
mod wrong_files;
mod wrong_input;
