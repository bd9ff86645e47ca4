//! Modules to be looked at, in assembly text.

use obverse_bytecode::{Verified, assemble, verify};
use obverse_isa::Instr;
use obverse_reach::{Horizon, MAX_KEPT, Reach};

/// A module of assembly text.
pub(crate) fn verified(text: &str) -> Verified {
    let module = match assemble(&format!("obvasm 1\n{text}")) {
        Ok(module) => module,
        Err(errors) => panic!("{errors:?}"),
    };
    match verify(module) {
        Ok(verified) => verified,
        Err(errors) => panic!("{errors:?}"),
    }
}

/// The instruction of the checkpoint of this name.
pub(crate) fn point(program: &Verified, name: &str) -> u32 {
    let module = program.module();
    let is_it = |instr: &Instr| match *instr {
        Instr::Checkpoint { checkpoint } => module.checkpoints[checkpoint.index()] == name,
        _ => false,
    };
    let at = module.code.iter().position(is_it);
    at.unwrap_or_else(|| panic!("no checkpoint {name}")) as u32
}

/// Where going back from a checkpoint may end.
fn ends(program: &Verified, name: &str) -> Vec<String> {
    let reach = Reach::of(program.module());
    let at = point(program, name);
    let verdict = reach.at(at);
    let every: Vec<Horizon> = reach.every(at).into_iter().collect();
    assert_eq!(verdict.horizons[..], every[..every.len().min(MAX_KEPT)], "both ways to ask");
    let told = verdict.horizons.iter().map(|horizon| match *horizon {
        Horizon::Start => "start".to_owned(),
        Horizon::Never(pc) => reach.reason(pc).to_owned(),
    });
    told.collect()
}

/// These are the horizons of these points, and no others.
#[track_caller]
pub(crate) fn said(text: &str, expected: &[(&str, &[&str])]) {
    let names: String =
        expected.iter().map(|(name, _)| format!(".checkpoint \"{name}\"\n")).collect();
    let program = verified(&format!("{names}{text}"));
    for (name, horizons) in expected {
        assert_eq!(ends(&program, name), *horizons, "at {name}");
    }
}

/// The start, which calls `main`.
pub(crate) const START: &str = "
    .function \"$start\" start
    enter
    call main
    halt
";

/// The same of the only sequence.
#[track_caller]
pub(crate) fn of_main(body: &str, expected: &[(&str, &[&str])]) {
    of_main_with("", body, expected);
}

/// The same with what its frame holds.
#[track_caller]
pub(crate) fn of_main_with(frame: &str, body: &str, expected: &[(&str, &[&str])]) {
    let text = format!("{START}.function \"main\" sequence\n{frame}\nenter\n{body}\nreturn");
    said(&text, expected);
}
