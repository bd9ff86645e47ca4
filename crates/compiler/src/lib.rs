//! Source text to module: resolve, check units and types, lower to statements.
//!
//! [`compile`] is the way in. Read `types` and `units`, then `check` (syntax tree to checked tree),
//! `effects` (errors and barriers across calls), `lower` (checked tree to code). Knows nothing of
//! machines and robots; [`invert`] makes of a sequence its inverse; the parser is `obverse-syntax`.

mod check;
mod effects;
mod fold;
mod invert;
mod keyframes;
mod lower;
mod recursion;
mod report;
mod response;
mod reversal;
mod tree;
mod types;
mod units;

use effects::Effects;
use obverse_bytecode::Module;
use obverse_syntax::diagnostic::{Diagnostic, Severity};
use report::Reports;

pub use invert::{Inverse, NoInverse, invert};

/// What became of a source text.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The module, if there is no error. It keeps the rules of the verifier.
    pub module: Option<Module>,
    /// What is wrong with the program, by place; at most a few hundred. Warnings are among them.
    pub diagnostics: Vec<Diagnostic>,
}

/// Compile a source text; `source_name` is how messages call it. Never fails and never panics.
#[must_use]
pub fn compile(source_name: &str, source: &str) -> Compiled {
    let parsed = obverse_syntax::parse(source);
    let is_whole = parsed.diagnostics.iter().all(|found| found.severity != Severity::Error);
    let reports = Reports::new(is_whole);
    let (program, mut reports) = check::check(source_name, source, &parsed.program, reports);
    let module = program.filter(|_| is_whole).and_then(|program| {
        let effects = Effects::of(&program);
        reversal::check(&program, &effects, &mut reports);
        recursion::check(&program, &effects, &mut reports);
        match reports.has_errors() {
            true => None,
            false => lower::lower(program, &effects, &mut reports),
        }
    });
    let mut diagnostics = parsed.diagnostics;
    diagnostics.extend(reports.into_diagnostics());
    diagnostics.sort_by_key(|diagnostic| diagnostic.primary.span);
    Compiled { module, diagnostics }
}
