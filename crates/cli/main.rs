//! The command line of Obverse.

fn main() {}
