//! The laws of the machine over generated modules: there and back, runs are steps, parsimony, write
//! ahead, barrier, blocks, turns, round trips, and waits in forks; those of the formatter and of
//! inversion; those of compiler and machine together over generated programs, against the reference
//! interpreter; and that of reach, over both and over modules of forks. `LAW_RUNS` sets how many
//! programs each law sees; a failure prints the number of the program, and `LAW_SEED` runs that one
//! alone.

use arbitrary::{Result, Unstructured};
use obverse_testkit::{
    always_laws, files, format_laws, front_laws, invert_laws, laws, machine_laws, preflight_laws,
    reach_laws, recovery_laws, wait_laws, word_laws,
};
use std::collections::BTreeSet;

/// How many programs each law sees.
const RUNS: u64 = 10_000;

/// Random bytes that follow from a number.
fn bytes(seed: u64) -> Vec<u8> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0xd1b5_4a32_d192_ed03;
    let length = 64 + seed % 3000;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        (x ^ x >> 31) as u8
    };
    (0..length).map(|_| next()).collect()
}

/// The law holds of every program, and of at least so many of a hundred it says something.
fn holds_of(name: &str, law: fn(&mut Unstructured<'_>) -> Result<bool>, least: u64) {
    let number = |variable: &str| std::env::var(variable).ok().and_then(|text| text.parse().ok());
    let alone: Option<u64> = number("LAW_SEED");
    let runs = number("LAW_RUNS").unwrap_or(RUNS);
    let mut compared = 0;
    for seed in alone.map_or(0..runs, |seed| seed..seed + 1) {
        let held = std::panic::catch_unwind(|| law(&mut Unstructured::new(&bytes(seed))));
        match held {
            Ok(Ok(is_compared)) => compared += u64::from(is_compared),
            _ => panic!("the law `{name}` does not hold: LAW_SEED={seed}"),
        }
    }
    let is_enough = alone.is_some() || compared * 100 >= least * runs;
    assert!(is_enough, "the law `{name}` compared only {compared} of {runs} runs");
}

macro_rules! laws {
    ($($module:ident: $($name:ident >= $least:literal)*;)*) => {$($(
        #[test]
        fn $name() {
            holds_of(stringify!($name), $module::$name, $least);
        }
    )*)*};
}

// Of a hundred runs, how many must really be compared.
laws! {
    machine_laws:
        there_and_back >= 100
        runs_are_steps >= 90
        parsimony >= 100
        write_ahead >= 60
        barrier >= 25
        blocks >= 100
        write_ahead_with_blocks >= 60
        turns >= 12
        round_trips >= 100;
    wait_laws: waits_are_waited >= 10;
    recovery_laws: goes_back_along_the_trail >= 60 recovers_within_bounds >= 5
        keeps_the_trail_over_a_blocked_return >= 10 comes_back_to_what_was_left >= 10;
    preflight_laws: foretells >= 60 foretells_of_modules >= 10;
    format_laws: formats >= 100 cut_off >= 100;
    invert_laws:
        inverts_twice >= 45
        inverse_goes_back >= 45
        inverts_anything_twice >= 20;
    laws: compiles >= 100 agrees_forward >= 95 agrees_backward >= 75;
    always_laws: always_leads_where_the_arm_was >= 15;
    files: files_are_one_program >= 60;
    word_laws:
        words_restore_the_program >= 50
        skipped_blocks_command_nothing >= 30
        replacements_command_what_they_say >= 30
        kept_blocks_command_the_same_again >= 10
        parameters_hold_going_back >= 10
        io_counterparts_command_what_they_say >= 50
        move_counterparts_command_what_they_say >= 50;
}

#[test]
fn reach_of_modules() {
    holds_of("reach_of_modules", reach_laws::reach_of_modules, 8);
}

#[test]
fn reach_of_programs() {
    holds_of("reach_of_programs", reach_laws::reach_of_programs, 90);
}

#[test]
fn reach_of_forks() {
    holds_of("reach_of_forks", reach_laws::reach_of_forks, 25);
}

/// What is said of points is met, by and by: the verdict is no larger than it needs to be, but for
/// conditions that are never true.
#[test]
fn reach_is_met() {
    let (mut met, mut said) = (0, 0);
    for seed in 0..200 {
        let Ok((some, all)) = reach_laws::met_and_said(&mut Unstructured::new(&bytes(seed))) else {
            continue;
        };
        assert!(some.is_subset(&all), "LAW_SEED={seed}");
        met += some.len();
        said += all.len();
    }
    assert!(met * 100 >= said * 75, "of {said} horizons that points may have, {met} were met");
}

/// The same of programs of the language, in which errors lead on in every way; of a hundred that
/// are said so many are met at the least.
fn reach_of_programs_is_met_of(with_forks: bool, least: usize) {
    let (mut met, mut said) = (0, 0);
    for seed in 0..40 {
        let bytes = bytes(500 + seed);
        let found =
            reach_laws::met_and_said_of_programs(&mut Unstructured::new(&bytes), with_forks);
        let Ok((some, all)) = found else { continue };
        assert!(some.is_subset(&all), "seed {seed}");
        met += some.len();
        said += all.len();
    }
    assert!(met * 100 >= said * least, "of {said} horizons that points may have, {met} were met");
}

#[test]
fn reach_of_programs_is_met() {
    reach_of_programs_is_met_of(false, 97);
}

/// In what order branches take their turns is not followed.
#[test]
fn reach_of_programs_with_forks_is_met() {
    reach_of_programs_is_met_of(true, 80);
}

#[test]
fn a_program_cut_off_anywhere_gives_messages() {
    holds_of("cut_off_anywhere", front_laws::cut_off_anywhere, 90);
}

#[test]
fn line_ends_mean_nothing() {
    holds_of("line_ends_mean_nothing", front_laws::line_ends_mean_nothing, 100);
}

#[test]
fn every_opcode_occurs_in_generated_modules() {
    let mut missing: BTreeSet<_> = obverse_isa::OPS.iter().map(|row| row.opcode).collect();
    for seed in 0..RUNS {
        let generated =
            machine_laws::opcodes(&mut Unstructured::new(&bytes(seed)), &mut |opcode| {
                missing.remove(&opcode);
            });
        assert!(generated.is_ok());
    }
    assert!(missing.is_empty(), "never generated: {missing:?}");
}
