//! The laws over generated programs, on a few hundred programs that are the same every time.

use arbitrary::{Result, Unstructured};
use obverse_testkit::{files, laws};

/// How many programs each law is held against.
const PROGRAMS: u64 = 400;

/// How many bytes a program is made of at the most.
const BYTES: u64 = 8192;

/// Bytes that follow from a number (splitmix64).
fn bytes(seed: u64) -> Vec<u8> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    };
    let length = next() % BYTES;
    (0..length).map(|_| next().to_le_bytes()[0]).collect()
}

fn hold(law: fn(&mut Unstructured<'_>) -> Result<bool>) {
    for seed in 0..PROGRAMS {
        let bytes = bytes(seed);
        // Randomness that runs out is no failure of a law.
        _ = law(&mut Unstructured::new(&bytes));
    }
}

#[test]
fn every_program_compiles() {
    hold(laws::compiles);
}

#[test]
fn a_program_in_files_is_the_program() {
    hold(files::files_are_one_program);
}

#[test]
fn the_machine_agrees_with_the_reference_forward() {
    hold(laws::agrees_forward);
}

#[test]
fn the_machine_agrees_with_the_reference_in_reverse() {
    hold(laws::agrees_backward);
}
