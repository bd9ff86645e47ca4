//! The laws of the machine over generated modules: there and back, runs are steps, parsimony, write
//! ahead, barrier, blocks, turns, round trips, and waits in forks; those of the formatter and of
//! inversion; those of compiler and machine together over generated programs, against the reference
//! interpreter; and that of reach, over both and over modules of forks. `LAW_RUNS` sets how many
//! programs each law sees; a failure prints the number of the program, and `LAW_SEED` runs that one
//! alone.

use arbitrary::{Result, Unstructured};
use obverse_testkit::{
    always_laws, debug_laws, files, format_laws, front_laws, invert_laws, laws, machine_laws,
    preflight_laws, reach_laws, recovery_laws, session_laws, symbol_laws, tape_laws, wait_laws,
    word_laws,
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

/// How often a law is tried.
struct Tries {
    /// How many runs it is given.
    runs: u64,
    /// How many of them must be such that it says something.
    least: u64,
    /// Whether it may stop when it has said something so often.
    stops_there: bool,
}

/// The law holds of every program, and says something of enough of them.
fn holds(name: &str, law: fn(&mut Unstructured<'_>) -> Result<bool>, tries: impl Fn(u64) -> Tries) {
    let number = |variable: &str| std::env::var(variable).ok().and_then(|text| text.parse().ok());
    let alone: Option<u64> = number("LAW_SEED");
    let Tries { runs, least, stops_there } = tries(number("LAW_RUNS").unwrap_or(RUNS));
    let mut compared = 0;
    for seed in alone.map_or(0..runs, |seed| seed..seed + 1) {
        let held = std::panic::catch_unwind(|| law(&mut Unstructured::new(&bytes(seed))));
        match held {
            Ok(Ok(is_compared)) => compared += u64::from(is_compared),
            _ => panic!("the law `{name}` does not hold: LAW_SEED={seed}"),
        }
        if stops_there && compared == least {
            return;
        }
    }
    let is_enough = alone.is_some() || compared >= least;
    assert!(is_enough, "the law `{name}` compared only {compared} of {runs} runs");
}

/// The law holds of every program, and of at least so many of a hundred it says something.
fn holds_of(name: &str, law: fn(&mut Unstructured<'_>) -> Result<bool>, least: u64) {
    holds(name, law, |runs| Tries {
        runs,
        least: (runs * least).div_ceil(100),
        stops_there: false,
    });
}

/// How many programs are generated for one of which a law says something, at the most.
const MOST_FOR_ONE: u64 = 12;

/// The law says something of as many programs as there are runs, and holds of each.
fn holds_of_as_many(name: &str, law: fn(&mut Unstructured<'_>) -> Result<bool>) {
    holds(name, law, |runs| Tries { runs: runs * MOST_FOR_ONE, least: runs, stops_there: true });
}

macro_rules! laws {
    ($($module:ident: $($name:ident >= $least:literal)*;)*) => {$($(
        #[test]
        fn $name() {
            holds_of(stringify!($name), $module::$name, $least);
        }
    )*)*};
}

macro_rules! laws_of_as_many {
    ($($module:ident: $($name:ident)*;)*) => {$($(
        #[test]
        fn $name() {
            holds_of_as_many(stringify!($name), $module::$name);
        }
    )*)*};
}

laws_of_as_many! {
    machine_laws: there_and_back turns round_trips;
    format_laws: formats cut_off;
    invert_laws: inverts_twice inverse_goes_back;
    reach_laws: reach_of_programs;
}

// Of a hundred runs, how many must really be compared.
laws! {
    machine_laws:
        runs_are_steps >= 90
        parsimony >= 100
        write_ahead >= 60
        barrier >= 25
        blocks >= 100
        write_ahead_with_blocks >= 60;
    debug_laws: shows_what_was >= 80 moves_lead_where_they_say >= 50;
    wait_laws: waits_are_waited >= 10;
    recovery_laws: goes_back_along_the_trail >= 60 recovers_within_bounds >= 5
        keeps_the_trail_over_a_blocked_return >= 10 comes_back_to_what_was_left >= 10;
    session_laws: is_a_run >= 8 takes_a_hand >= 3;
    tape_laws: shows_the_run_again >= 20;
    preflight_laws: foretells >= 60 foretells_of_modules >= 10;
    invert_laws: inverts_anything_twice >= 20;
    laws: compiles >= 100 agrees_forward >= 95 agrees_backward >= 75;
    always_laws: always_leads_where_the_arm_was >= 15;
    files: files_are_one_program >= 60;
    symbol_laws: renames >= 95;
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
fn reach_of_forks() {
    holds_of("reach_of_forks", reach_laws::reach_of_forks, 25);
}

/// What is said of points is met, by and by: the verdict is no larger than it needs to be, but for
/// conditions that are never true.
#[test]
fn reach_is_met() {
    let (mut met, mut said) = (0, 0);
    for seed in 0..500 {
        let Ok((some, all)) = reach_laws::met_and_said(&mut Unstructured::new(&bytes(seed))) else {
            continue;
        };
        assert!(some.is_subset(&all), "LAW_SEED={seed}");
        met += some.len();
        said += all.len();
    }
    assert!(met * 100 >= said * 74, "of {said} horizons that points may have, {met} were met");
}

/// The same of programs of the language, in which errors lead on in every way; of a hundred that
/// are said so many are met at the least.
fn reach_of_programs_is_met_of(with_forks: bool, least: usize) {
    let (mut met, mut said) = (0, 0);
    for seed in 0..150 {
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
    reach_of_programs_is_met_of(false, 92);
}

/// In what order branches take their turns is not followed.
#[test]
fn reach_of_programs_with_forks_is_met() {
    reach_of_programs_is_met_of(true, 80);
}

#[test]
fn a_program_cut_off_anywhere_gives_messages() {
    holds_of_as_many("cut_off_anywhere", front_laws::cut_off_anywhere);
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
