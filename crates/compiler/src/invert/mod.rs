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

use crate::load::{self, Loaded, Loader};
use crate::{allow, compile, compile_loaded, merge};
use obverse_syntax::ast::{Item, Program};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{Diagnostic, Severity};
use obverse_syntax::format::print;
use obverse_syntax::sources::Sources;
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

/// The inverse of a sequence or action, as a program of one file. To invert it again gives a
/// program that compiles to the code and tables of the sequence, with what it needs.
///
/// # Errors
/// Diagnostics, if the program does not compile or the sequence has no inverse; and if there is no
/// such sequence.
pub fn invert(source_name: &str, source: &str, sequence: &str) -> Result<Inverse, NoInverse> {
    invert_files(source_name, source, sequence, &mut load::OneFile).1
}

/// The same for a program whose other files `loader` reads; with the files, in which the places of
/// diagnostics are.
///
/// # Errors
/// Those of [`invert`].
pub fn invert_files(
    source_name: &str,
    source: &str,
    sequence: &str,
    loader: &mut dyn Loader,
) -> (Sources, Result<Inverse, NoInverse>) {
    let loaded = load::load(source_name, source, loader);
    let inverse = invert_loaded(&loaded, source_name, sequence);
    (loaded.sources, inverse)
}

fn invert_loaded(loaded: &Loaded, name: &str, sequence: &str) -> Result<Inverse, NoInverse> {
    let (module, diagnostics) = compile_loaded(loaded);
    let Some(module) = module else { return Err(NoInverse::Diagnosed(diagnostics)) };
    let mut program = merge::parse(loaded).program;
    allow::leave_out(&mut program);
    // Where the cell is, seen from the one file that the inverse is.
    for item in &mut program.items {
        if let (Item::Cell(path), Some(cell)) = (item, &module.cell) {
            path.value = cell;
        }
    }
    let Some(place) = place_of(&program, sequence) else {
        let names = program.items.iter().filter_map(|item| match item {
            Item::Sequence(sequence) => Some(sequence.name.value),
            _ => None,
        });
        let meant = obverse_syntax::nearest(sequence, names);
        return Err(NoInverse::UnknownSequence(meant.map(str::to_owned)));
    };
    let inverse = inverted(&program, sequence)?;
    let found = compile(name, &inverse.text);
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
