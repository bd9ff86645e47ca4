//! Source text to module: resolve, check units and types, lower to statements.
//!
//! [`compile`] is the way in, and [`compile_files`] for a program of several files, which `load`
//! gathers and `merge` makes one tree of. Read `types` and `units`, then `check` (syntax tree to
//! checked tree), `effects` (errors and barriers across calls), `lower` (checked tree to code),
//! `shortfall` (reversals that cannot be had). [`invert`] makes of a sequence its inverse, and
//! [`symbols`] says where each name stands. Knows nothing of machines and robots; the parser is
//! `obverse-syntax`.

mod allow;
mod check;
mod effects;
mod faults;
mod fold;
mod forks;
mod invert;
mod keyframes;
pub mod library;
mod load;
mod lower;
mod merge;
mod parameters;
mod path;
mod reached;
mod recursion;
mod report;
mod response;
mod reversal;
mod shortfall;
pub mod symbols;
mod tree;
mod types;
mod units;
mod uses;
mod vain;

pub use load::{Loader, MAX_IMPORT_DEPTH, MAX_IMPORTED};
pub use parameters::{Action, Defaults, Parameter};

use allow::Allows;
use check::Checked;
use effects::Effects;
use load::Loaded;
use obverse_bytecode::Module;
use obverse_syntax::ast::Program;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{Diagnostic, Severity};
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use obverse_syntax::{LeftOut, Parsed};
use report::Reports;
use symbols::Symbols;
use types::ValueType;

pub use invert::{Inverse, NoInverse, OtherKind, invert, invert_files};

/// What became of a program's text.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The module, if there is no error. It keeps the rules of the verifier.
    pub module: Option<Module>,
    /// What is wrong with the program, by place; at most a few hundred. Warnings are among them.
    /// Its places are those of the sources.
    pub diagnostics: Vec<Diagnostic>,
    /// The actions of the program with their parameters, in the order of their declaration.
    pub actions: Vec<Action>,
    /// The files that were read, each as it was read. The first is the one that was asked for.
    pub sources: Sources,
}

/// Compile a source text that imports nothing; `name` is how messages call it. Never fails and
/// never panics.
#[must_use]
pub fn compile(name: &str, source: &str) -> Compiled {
    compile_files(name, source, &mut load::OneFile)
}

/// Compile a source text and all that it imports; `name` is that of its file, in the folder that
/// `loader` reads from. Never fails and never panics.
pub fn compile_files(name: &str, source: &str, loader: &mut dyn Loader) -> Compiled {
    compile_with(name, source, loader, &Defaults::new())
}

/// The same with other values in the place of the defaults of parameters.
pub fn compile_with(
    name: &str,
    source: &str,
    loader: &mut dyn Loader,
    defaults: &Defaults,
) -> Compiled {
    let loaded = load::load(name, source, loader);
    let Built { module, actions, diagnostics, .. } = compile_loaded(&loaded, defaults);
    Compiled { module, diagnostics, actions, sources: loaded.sources }
}

/// The same as [`compile_files`], with the names of the program, also of one that has mistakes.
pub fn analyse(name: &str, source: &str, loader: &mut dyn Loader) -> (Compiled, Symbols) {
    let loaded = load::load(name, source, loader);
    let parsed = merge::parse(&loaded);
    let Built { module, actions, diagnostics, types } =
        compile_parsed(&loaded.sources, &parsed, &Defaults::new());
    let symbols = Symbols::of(loaded.sources.whole(), &parsed.program, types);
    (Compiled { module, diagnostics, actions, sources: loaded.sources }, symbols)
}

/// The names of the files that a program is of, the one that was asked for first. Nothing is
/// compiled; what cannot be imported is left out.
pub fn files(name: &str, source: &str, loader: &mut dyn Loader) -> Vec<String> {
    let sources = load::load(name, source, loader).sources;
    (0..sources.len()).map(|file| sources.name(file).to_owned()).collect()
}

/// The mistakes in a source text itself, as far as they can be known without what it is imported by
/// and what it imports in vain: a file without a sequence may be a part of a program, whose other
/// files may declare any name. With the files that were read; the first is the text.
pub fn mistakes_in(
    name: &str,
    source: &str,
    loader: &mut dyn Loader,
) -> (Sources, Vec<Diagnostic>) {
    let loaded = load::load(name, source, loader);
    let mut found = compile_loaded(&loaded, &Defaults::new()).diagnostics;
    if found.iter().any(|one| one.code == Code::NoMain) {
        let parsed = merge::parse(&loaded);
        let allows = Allows::of(&loaded.sources, &parsed.program);
        let reports = Reports::new(Some(LeftOut::endless()), allows);
        let defaults = Defaults::new();
        let Lowered { reports, .. } =
            compile_tree(&loaded.sources, &parsed.program, &defaults, reports);
        found = parsed.diagnostics;
        found.extend(reports.into_diagnostics());
        found.sort_by_key(|diagnostic| diagnostic.primary.span);
    }
    found.retain(|one| {
        let is_here = loaded.sources.locate(one.primary.span).file == 0;
        is_here && one.severity == Severity::Error && one.code != Code::CannotImport
    });
    (loaded.sources, found)
}

/// What became of the files of a program.
struct Built {
    module: Option<Module>,
    actions: Vec<Action>,
    diagnostics: Vec<Diagnostic>,
    types: Vec<(Span, ValueType)>,
}

/// What became of a tree.
struct Lowered {
    module: Option<Module>,
    actions: Vec<Action>,
    reports: Reports,
    types: Vec<(Span, ValueType)>,
}

/// The module of a syntax tree whose places are those of the sources.
fn compile_tree(
    sources: &Sources,
    tree: &Program<'_>,
    defaults: &Defaults,
    reports: Reports,
) -> Lowered {
    let Checked { program: checked, actions, types, mut reports } =
        check::check(sources, tree, defaults, reports);
    let module = checked.filter(|_| reports.is_whole()).and_then(|program| {
        let effects = Effects::of(&program);
        if reports.has_errors() {
            // What branches share they share whatever else is wrong.
            forks::check(&program, &effects, &mut reports);
            return None;
        }
        reversal::check(&program, &effects, &mut reports);
        forks::check(&program, &effects, &mut reports);
        recursion::check(&program, &effects, &mut reports);
        vain::check(tree, &program, &effects, &mut reports);
        match reports.has_errors() {
            true => None,
            false => lower::lower(program, sources, &effects, &mut reports),
        }
    });
    Lowered { module, actions, reports, types }
}

fn compile_loaded(loaded: &Loaded, defaults: &Defaults) -> Built {
    compile_parsed(&loaded.sources, &merge::parse(loaded), defaults)
}

fn compile_parsed(sources: &Sources, parsed: &Parsed<'_>, defaults: &Defaults) -> Built {
    let reports = Reports::new(parsed.left_out.clone(), Allows::of(sources, &parsed.program));
    let Lowered { module, actions, mut reports, types } =
        compile_tree(sources, &parsed.program, defaults, reports);
    if let Some(module) = &module {
        shortfall::check(sources, &parsed.program, module, &mut reports);
    }
    reports.warn_of_useless();
    let mut diagnostics = parsed.diagnostics.clone();
    diagnostics.extend(reports.into_diagnostics());
    diagnostics.sort_by_key(|diagnostic| diagnostic.primary.span);
    Built { module, actions, diagnostics, types }
}
