//! Source text to syntax tree: lexer, grammar, tree, spans, diagnostics.
//!
//! [`parse`] is the way in, and [`parse_file`] for one file of several; GRAMMAR.md
//! beside this crate has the grammar on a page. What a program means (names, types, units,
//! reversal) is not known here.

mod advice;
mod ahead;
pub mod ast;
pub mod codes;
pub mod diagnostic;
mod elsewhere;
mod expectation;
pub mod expected;
mod foreign;
pub mod format;
mod habits;
pub mod highlight;
mod imports;
mod left_out;
mod lexer;
mod nearest;
mod nesting;
mod parse_error;
mod sink;
pub mod source;
pub mod sources;
pub mod span;
mod surroundings;
mod token;
mod tree;

pub use elsewhere::value_elsewhere;
pub use imports::imports;
pub use left_out::LeftOut;
pub use nearest::nearest;
pub use token::{FREE_WORDS, RESERVED_WORDS, UNITS};

use codes::Code;
use diagnostic::Diagnostic;
use sources::Sources;
use span::Span;

lalrpop_util::lalrpop_mod!(
    #[allow(
        clippy::all,
        clippy::pedantic,
        clippy::allow_attributes_without_reason,
        missing_docs,
        unused,
        unreachable_pub,
        reason = "written by lalrpop"
    )]
    #[rustfmt::skip]
    grammar
);

/// The largest source text that is read, in bytes; all files of a program together.
pub const MAX_SOURCE_BYTES: usize = 256 << 20;

/// How deep blocks, brackets and the links of `else if` chains may be in one another.
pub const MAX_NESTING: usize = 64;

/// How many operators an expression may have. With [`MAX_NESTING`] this bounds how deep a tree is,
/// so that one can be walked and dropped by recursion.
pub const MAX_OPERATORS: usize = 256;

/// What became of a source text.
#[derive(Clone, Debug, Default)]
pub struct Parsed<'s> {
    /// The tree, as far as it could be built: whole if there are no diagnostics; otherwise without
    /// the statements and declarations that are wrong, and empty if reading ended early.
    pub program: ast::Program<'s>,
    /// What is wrong with the text, by place.
    pub diagnostics: Vec<Diagnostic>,
    /// What the tree lacks; none if there are no diagnostics.
    pub left_out: Option<LeftOut>,
}

/// The tree of a source text, and what is wrong with it. Never fails and never panics; at most
/// twenty mistakes are reported, and reading ends there.
#[must_use]
pub fn parse(source: &str) -> Parsed<'_> {
    parse_from(source, 0)
}

/// The tree of one file of several; its places are in the space of all of them. Imports stand in
/// it as written.
#[must_use]
pub fn parse_file(sources: &Sources, file: usize) -> Parsed<'_> {
    let range = sources.range(file);
    let whole = sources.whole();
    parse_from(whole.get(..range.end).unwrap_or(whole), range.start)
}

/// The tree of what stands from an offset to the end of the source.
fn parse_from(source: &str, start: usize) -> Parsed<'_> {
    if let Some(diagnostic) = refuse(source, start) {
        let left_out = Some(LeftOut::endless());
        return Parsed { diagnostics: vec![diagnostic], left_out, ..Parsed::default() };
    }
    let sink = sink::Sink::default();
    let lexer = lexer::Lexer::new(source, start, &sink);
    let result = grammar::ProgramParser::new().parse(source, &sink, lexer);
    let program = result.map_err(|error| sink.unexpected(error, source.len() as u32)).ok();
    let found = sink.into_findings();
    let is_cut = found.is_cut || program.is_none();
    let mut program = program.unwrap_or_default();
    program.items.extend(found.misplaced);
    let diagnostics = parse_error::explain(source, start, found.diagnostics, &found.syntax_errors);
    let left_out = (!diagnostics.is_empty()).then(|| match is_cut {
        true => LeftOut::endless(),
        false => LeftOut::of(source, start, &program, &diagnostics, &found.given_up),
    });
    Parsed { program, diagnostics, left_out }
}

/// A file's bytes as text.
///
/// # Errors
/// A diagnostic if they are not UTF-8.
pub fn text_of(bytes: &[u8]) -> Result<&str, Box<Diagnostic>> {
    std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        let message = "this file is not text";
        let diagnostic = Diagnostic::error(Code::NotText, Span::default(), message, "not UTF-8")
            .with_note(format!("byte {at} (counted from 0) is not UTF-8"));
        let is_wide = bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]);
        let help = if is_wide {
            "it begins as UTF-16 does: have the editor save it as UTF-8"
        } else if error.error_len().is_none() {
            "it ends within a letter: it may have been cut off"
        } else {
            "give a source text, saved as UTF-8"
        };
        diagnostic.with_help(help).into()
    })
}

/// Why a text is not read at all.
fn refuse(source: &str, start: usize) -> Option<Diagnostic> {
    if source.len() > MAX_SOURCE_BYTES {
        let message = format!("this source text has {} bytes", source.len());
        let span = Span::new(start as u32, start as u32);
        let diagnostic = Diagnostic::error(Code::SourceTooLarge, span, message, "too large");
        return Some(diagnostic.with_note(format!("the limit is {MAX_SOURCE_BYTES} bytes")));
    }
    let zero = start + source.get(start..)?.bytes().position(|byte| byte == 0)?;
    let span = Span::new(zero as u32, zero as u32 + 1);
    let diagnostic = Diagnostic::error(Code::NotText, span, "this file is not text", "a NUL byte");
    Some(diagnostic.with_help("give a source text, not a module or a tape"))
}
