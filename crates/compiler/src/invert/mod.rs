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
mod checked;
mod control;
mod effect;
mod guarded;
mod head;
mod motion;
mod output;
mod place;
mod program;
mod pure;
mod refusal;
mod reversal;
mod walk;

use crate::allow::{self, Allows};
use crate::load::{self, Loaded, Loader};
use crate::report::Reports;
use crate::{Built, Defaults, Lowered, compile, compile_loaded, compile_tree, merge};
use checked::Checked;
use obverse_syntax::ast::{Item, Program};
use obverse_syntax::diagnostic::{Diagnostic, Severity};
use obverse_syntax::format::print;
use obverse_syntax::sources::Sources;
use program::Plan;
use refusal::refusal;

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
    /// What has this name is done by a statement, and has its reverse with it.
    OtherKind(OtherKind),
}

/// What is no sequence, and is done by a statement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OtherKind {
    /// What it is: `an I/O operation`.
    pub kind: &'static str,
    /// How it is done: `io close`.
    pub statement: String,
}

impl OtherKind {
    fn of(program: &Program<'_>, name: &str) -> Option<Self> {
        let of = |kind, word: &str| Some(Self { kind, statement: format!("{word} {name}") });
        program.items.iter().find_map(|item| match item {
            Item::Io(io) if io.name.value == name => of("an I/O operation", "io"),
            Item::AdvancedMove(guarded) if guarded.name.value == name => {
                of("an advanced move", "advance")
            }
            _ => None,
        })
    }
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
    let Built { module, diagnostics, .. } = compile_loaded(loaded, &Defaults::new());
    let Some(module) = module else { return Err(NoInverse::Diagnosed(diagnostics)) };
    let mut program = merge::parse(loaded).program;
    allow::leave_out(&mut program);
    // Where the cell is, seen from the one file that the inverse is.
    for item in &mut program.items {
        if let (Item::Cell(path), Some(cell)) = (item, &module.cell) {
            path.value = cell;
        }
    }
    if !program.items.iter().any(|item| name_of(item) == Some(sequence)) {
        if let Some(other) = OtherKind::of(&program, sequence) {
            return Err(NoInverse::OtherKind(other));
        }
        let names = program.items.iter().filter_map(name_of);
        let meant = obverse_syntax::nearest(sequence, names);
        return Err(NoInverse::UnknownSequence(meant.map(str::to_owned)));
    }
    let checked = Checked::of(&loaded.sources, &program, &module);
    let plan = Plan::of(&program, checked, sequence).map_err(NoInverse::Diagnosed)?;
    let (inverse, is_begun_with) = plan.inverse().map_err(NoInverse::Diagnosed)?;
    let text = print(&inverse);
    if compile(name, &text).module.is_none() {
        return Err(NoInverse::Diagnosed(does_not_compile(&loaded.sources, &inverse, sequence)));
    }
    Ok(Inverse { text, name: program::inverse_name(sequence), is_begun_with })
}

/// The name of a sequence.
fn name_of<'s>(item: &Item<'s>) -> Option<&'s str> {
    match item {
        Item::Sequence(sequence) => Some(sequence.name.value),
        _ => None,
    }
}

/// What is said where an inverse keeps all rules of inversion and yet is no program. Its statements
/// stand where those stand that they are the inverses of, and so does what is wrong with them.
fn does_not_compile(sources: &Sources, inverse: &Program<'_>, name: &str) -> Vec<Diagnostic> {
    let reports = Reports::new(None, Allows::default());
    let Lowered { reports, .. } = compile_tree(sources, inverse, &Defaults::new(), reports);
    let found = reports.into_diagnostics().into_iter();
    let errors = found.filter(|found| found.severity == Severity::Error);
    let refused = |found: Diagnostic| {
        let (span, why) = (found.primary.span, format!("in the inverse, {}", found.message));
        let message = "what takes this back does not compile";
        let refused = refusal(span, message, &why).with_help(
            "write it in other words, or write its inverse by hand: `do { .. } in reverse { .. }`",
        );
        let labels = found.labels.into_iter();
        labels.fold(refused, |refused, label| {
            refused.with_label(label.span, format!("in the inverse, {}", label.text))
        })
    };
    let refused: Vec<Diagnostic> = errors.map(refused).collect();
    match refused.is_empty() {
        true => vec![cannot_be_written(inverse, name)],
        false => refused,
    }
}

/// What is said of an inverse that is a program only as long as nobody writes it down.
fn cannot_be_written(inverse: &Program<'_>, name: &str) -> Diagnostic {
    let name = program::inverse_name(name);
    let place = inverse.items.iter().find_map(|item| match item {
        Item::Sequence(sequence) if sequence.name.value == name => Some(sequence.name.span),
        _ => None,
    });
    let message = "the inverse of this sequence is too large";
    let why = "its blocks are too deep in one another, or its conditions too long";
    refusal(place.unwrap_or_default(), message, why).with_help("divide it into several sequences")
}
