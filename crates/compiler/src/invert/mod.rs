//! The inverse of a sequence as a program of its own: a disassembly program from an assembly
//! program.
//!
//! [`invert`] is the way in. A sequence is a path: statements that bind where it begins (its
//! [`head`]), and statements between them. Its inverse has the inverses of the statements in
//! reverse order, and a head that binds where the sequence ends. What a statement's inverse needs
//! of what was before (the place that a move leaves, the level that an output had) is found by
//! following the sequence forward ([`effect`], [`place`]). What has no inverse is said with its
//! reason, and there is no inverse then. It works on the syntax tree of a program that compiles; of
//! code and machines it knows nothing.

mod assign;
mod block;
mod control;
mod effect;
mod head;
mod motion;
mod output;
mod place;
mod program;
mod pure;
mod refusal;
mod reversal;
mod walk;

use crate::compile;
use obverse_syntax::ast::{Item, Program};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{Diagnostic, Severity};
use obverse_syntax::format::print;
use obverse_syntax::span::Span;
use program::Plan;

/// The inverse of a sequence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inverse {
    /// The formatted source text of a program.
    pub text: String,
    /// The name that the inverse has in it.
    pub name: String,
    /// Whether the program begins with it. Otherwise its main sequence is empty, since nobody but
    /// who calls the inverse knows its arguments, or what the variables of the program are then.
    pub is_begun_with: bool,
}

/// Why there is no inverse.
#[derive(Clone, Debug, PartialEq)]
pub enum NoInverse {
    /// The program has mistakes, or the sequence cannot be inverted: the diagnostics say why.
    Diagnosed(Vec<Diagnostic>),
    /// The program has no sequence or action of this name; one that was perhaps meant.
    UnknownSequence(Option<String>),
}

/// The inverse of a sequence or action, as a program. To invert it again gives a program that
/// compiles to the code and tables of the sequence, with what it needs.
///
/// # Errors
/// Diagnostics, if the program does not compile or the sequence has no inverse; and if there is no
/// such sequence.
pub fn invert(source_name: &str, source: &str, sequence: &str) -> Result<Inverse, NoInverse> {
    let compiled = compile(source_name, source);
    if compiled.module.is_none() {
        return Err(NoInverse::Diagnosed(compiled.diagnostics));
    }
    let parsed = obverse_syntax::parse(source);
    let Some(place) = place_of(&parsed.program, sequence) else {
        let names = parsed.program.items.iter().filter_map(|item| match item {
            Item::Sequence(sequence) => Some(sequence.name.value),
            _ => None,
        });
        let meant = obverse_syntax::nearest(sequence, names);
        return Err(NoInverse::UnknownSequence(meant.map(str::to_owned)));
    };
    let inverse = inverted(&parsed.program, sequence)?;
    let found = compile(source_name, &inverse.text);
    match found.module {
        Some(_) => Ok(inverse),
        None => Err(NoInverse::Diagnosed(vec![does_not_compile(place, &found.diagnostics)])),
    }
}

fn place_of(program: &Program<'_>, name: &str) -> Option<Span> {
    program.items.iter().find_map(|item| match item {
        Item::Sequence(sequence) if sequence.name.value == name => Some(sequence.name.span),
        _ => None,
    })
}

fn inverted(program: &Program<'_>, root: &str) -> Result<Inverse, NoInverse> {
    let plan = Plan::of(program, root).map_err(NoInverse::Diagnosed)?;
    let (inverse, is_begun_with) = plan.inverse().map_err(NoInverse::Diagnosed)?;
    let name = program::inverse_name(root);
    Ok(Inverse { text: print(&inverse), name, is_begun_with })
}

/// What is said where an inverse keeps all rules of inversion and yet is no program: it needs a
/// name where that cannot be seen, for example.
fn does_not_compile(place: Span, found: &[Diagnostic]) -> Diagnostic {
    let message = "what would be the inverse of this sequence does not compile";
    let diagnostic = Diagnostic::error(Code::NotInvertible, place, message, "has no inverse");
    let error = found.iter().find(|found| found.severity == Severity::Error);
    match error {
        Some(error) => diagnostic.with_note(format!("in the inverse {}", error.message)),
        None => diagnostic,
    }
}
