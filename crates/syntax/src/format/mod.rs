//! Source text in its canonical layout, and syntax trees as source text.
//!
//! One writer walks the tree and says of which pieces it consists (`writer`, and beside it what
//! is written of declarations, statements and expressions); one layout makes lines of the pieces
//! (`layout`, `line`). With a source text the pieces are its tokens, with the comments between
//! them (`cursor`); without one, those that the tree asks for. What a program means is not known
//! here.
//!
//! Blocks stay on one line if they were written on one and fit; rows of statements with `;` between
//! as well. Blank lines stay, one where there were several. Lines end with LF, whatever they ended
//! with before. Numbers, names and the order of everything stay as written.

mod cursor;
mod declaration;
mod expression;
mod layout;
mod line;
mod piece;
mod statement;
mod writer;

use crate::ast::{Expression, Program};
use crate::diagnostic::{Diagnostic, Severity};
use writer::Writer;

/// How long a line may be, in characters, where it can be broken.
const MAX_COLUMNS: usize = 100;

/// How much further a block stands to the right than what is around it.
const INDENT: usize = 2;

/// A source text in its canonical layout. Its meaning is the same, and so are its comments; to
/// format again changes nothing.
///
/// # Errors
/// The diagnostics of a text that is not a program in form. What its names mean is not looked at.
pub fn format(source: &str) -> Result<String, Vec<Diagnostic>> {
    let parsed = crate::parse(source);
    if parsed.diagnostics.iter().any(|found| found.severity == Severity::Error) {
        return Err(parsed.diagnostics);
    }
    let file = Writer::of_source(source).program(&parsed.program);
    Ok(layout::text(&file))
}

/// A tree as source text in its canonical layout; places in the tree do not matter, but that an
/// `else` whose block is at the place of its one `if` is an `else if`.
#[must_use]
pub fn print(program: &Program<'_>) -> String {
    layout::text(&Writer::of_tree().program(program))
}

/// An expression as source text, on one line.
#[must_use]
pub fn print_expression(expression: &Expression<'_>) -> String {
    layout::line(&Writer::of_tree().member(|writer| writer.expression(expression)))
}
