//! The generator of programs: the same bytes give the same text, and options are kept.

use arbitrary::Unstructured;
use obverse_testkit::programs::{Options, generate};

const NOTHING: Options = Options {
    allow_never: false,
    allow_overrides: false,
    allow_errors: false,
    allow_traps: false,
    allow_forks: false,
    max_statements: 80,
};

/// Bytes of some variety.
fn bytes(seed: usize) -> Vec<u8> {
    (0..6000_usize).map(|at| ((at + seed) * (at + 7919) / 3 % 251) as u8).collect()
}

fn texts(options: Options) -> Vec<String> {
    let text = |seed| generate(&mut Unstructured::new(&bytes(seed)), options).unwrap_or_default();
    (0..200).map(text).collect()
}

#[test]
fn the_same_bytes_give_the_same_program() {
    assert_eq!(texts(Options::default()), texts(Options::default()));
}

#[test]
fn no_bytes_give_a_program() {
    let text = generate(&mut Unstructured::new(&[]), Options::default());
    assert!(text.is_ok_and(|text| text.contains("sequence main")));
}

#[test]
fn what_is_not_allowed_is_not_there() {
    let words = [
        "barrier",
        "irreversible",
        "skip in reverse",
        "} in reverse {",
        "keep in reverse",
        "} reverse io",
        "} reverse m",
        "fork",
        "throw",
        "error",
    ];
    let all = texts(Options::default()).concat();
    let none = texts(NOTHING).concat();
    for word in words {
        assert!(all.contains(word), "{word} is never made");
        assert!(!none.contains(word), "{word} is made");
    }
}

#[test]
fn every_statement_is_made_sometimes() {
    let all = texts(Options::default()).concat();
    let beginnings = [
        "move to q",
        "move to v",
        "move to here",
        "move to part",
        " mm up",
        "linearly",
        "reversible always",
        "straight moves",
        "force limit ",
        "opposite force in reverse",
        "advance m",
        "call f",
        "io io",
        "wait ",
        "wait until input",
        "else {",
        "set ",
        "toggle ",
        "sleep ",
        "var ",
        "position here",
        " += ",
        " -= ",
        " = ",
        "if ",
        "else if ",
        "ending when",
        "while ",
        "entered when",
        "repeat ",
        "for ",
        "loop {",
        "fork {",
        "} and {",
        "break",
        "return",
        "speed slow {",
        "speed very slow\n",
        "tool probe {",
        "checkpoint ",
        "on success {",
        "repeat with perturbation",
        "requires ",
        "stop if ",
        "succeeds if ",
        "recover using",
        "recover by reversing",
        "respond after current sequence",
        "then restart program",
        "random(",
        "holding",
        "force",
        "distance",
        "input ",
    ];
    for beginning in beginnings {
        assert!(all.contains(beginning), "`{beginning}` is never made");
    }
}
