//! Warnings where what is done again is a throw.

use obverse_compiler::compile;

const ERRORS: &str = "\
error explicit { recover using help; then return to action }
error reversed { recover by reversing 1 action; otherwise using help; then return to action }
error bare { recover by reversing 1 action; then return to action }
error later { recover using help; respond after current sequence; then return to action }
sequence help { set 1 high }
";

/// The places of the warnings in a program: what is thrown, and what asks for it again.
fn warned(program: &str) -> Vec<(String, String)> {
    let source = format!("{ERRORS}{program}");
    let compiled = compile("test.obv", &source);
    assert!(compiled.module.is_some(), "{:?}", compiled.diagnostics);
    let text = |start: u32, end: u32| source[start as usize..end as usize].to_owned();
    let found = compiled.diagnostics.iter().filter(|one| one.code.as_str() == "W0405");
    let places = found.map(|one| {
        let (thrown, asked) = (one.primary.span, one.labels[0].span);
        (text(thrown.start, thrown.end), text(asked.start, asked.end))
    });
    places.collect()
}

#[test]
fn a_throw_behind_a_condition_is_warned_about_with_both_places() {
    let asked = "then return to action".to_owned();
    for error in ["explicit", "reversed"] {
        let found = warned(&format!("sequence main {{ if input 1 {{ throw {error} }} }}"));
        assert_eq!(found, [(format!("throw {error}"), asked.clone())]);
    }
}

#[test]
fn what_looks_again_or_is_not_done_again_is_not() {
    for program in [
        "sequence main { requires input 1 else throw explicit }",
        "sequence main { if input 1 { throw bare } }",
        "sequence look { if input 1 { throw later } }\nsequence main { call look }",
        "advanced move feel { distance 1 mm up; on failure { throw explicit } }\n\
         sequence main { advance feel }",
    ] {
        assert_eq!(warned(program), [], "{program}");
    }
}
