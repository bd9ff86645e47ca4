//! Warnings where an error asks for a reversal that cannot be had: the place where it is raised,
//! the clause that asks, what stops it, and the calls between.
//!
//! What can be gone back over is the knowledge of `obverse-reach`, which reads the module; here it
//! is brought back to the source.

use crate::report::{Reports, warning};
use obverse_bytecode::{Extent, Module, Recovery};
use obverse_isa::Instr;
use obverse_reach::{Horizon, Link, Shortfall, ShortfallKind, Way, reason, shortfalls};
use obverse_syntax::ast::{ErrorClause, Item, Program};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use std::collections::HashSet;

/// A module, and the texts that it was made of.
#[derive(Clone, Copy)]
struct Source<'s> {
    sources: &'s Sources,
    module: &'s Module,
}

impl Source<'_> {
    fn span_of(self, pc: u32) -> Option<Span> {
        let entry = self.module.source_at(pc)?;
        let first = u32::try_from(self.sources.range(usize::from(entry.file)).start).ok()?;
        Some(Span::new(first + entry.start, first + entry.end))
    }
}

/// Report every reversal that a module asks for and cannot have.
pub(crate) fn check(
    sources: &Sources,
    program: &Program<'_>,
    module: &Module,
    reports: &mut Reports,
) {
    let mut told = HashSet::new();
    let source = Source { sources, module };
    for shortfall in shortfalls(module) {
        let Some(raised) = source.span_of(shortfall.raise) else { continue };
        // A throw stands in the code more than once where a block is left at several places.
        if told.insert((raised, shortfall.error)) {
            reports.add(diagnostic(program, source, &shortfall, raised));
        }
    }
}

fn diagnostic(
    program: &Program<'_>,
    source: Source<'_>,
    shortfall: &Shortfall,
    raised: Span,
) -> Diagnostic {
    let module = source.module;
    let error = &module.errors[usize::from(shortfall.error)];
    let goal = match &error.recovery {
        Recovery::Reversing(policy) => goal(module, policy.extent),
        Recovery::None | Recovery::Using(_) => String::new(),
    };
    let says = format!("`{}` is recovered from by going back {goal}", error.name);
    let diagnostic = match &shortfall.kind {
        ShortfallKind::Stopped { way, after_actions, is_certain } => {
            let far = far(*after_actions, *is_certain);
            let message = format!("{says}, and {far}");
            let found = warning(Code::ReversalStopped, raised, message, "raised here");
            chain(found, source, way)
        }
        ShortfallKind::NotOnEveryWay => {
            let message = format!("{says}, which is not on every way here");
            warning(Code::CheckpointNotOnEveryWay, raised, message, "raised here")
                .with_help("put the checkpoint before the ways part, or raise it on one of them")
        }
        ShortfallKind::OnNoWay => {
            let message = format!("{says}, which is on no way here");
            warning(Code::CheckpointOnNoWay, raised, message, "raised here")
                .with_help("put the checkpoint on the way here, outside blocks passed in reverse")
        }
    };
    let asked = clause(program, &error.name);
    asked.into_iter().fold(diagnostic, |found, span| found.with_label(span, "asked for here"))
}

fn far(after_actions: Option<u32>, is_certain: bool) -> String {
    match after_actions {
        Some(0) => "may be stopped before the first".to_owned(),
        Some(actions) => format!("may be stopped after {actions}"),
        None if is_certain => "is stopped before that".to_owned(),
        None => "may be stopped before that".to_owned(),
    }
}

fn goal(module: &Module, extent: Extent) -> String {
    match extent {
        Extent::Actions(1) => "1 action".to_owned(),
        Extent::Actions(count) => format!("{count} actions"),
        Extent::Checkpoint(checkpoint) => {
            let name = module.checkpoints.get(usize::from(checkpoint));
            format!("to checkpoint `{}`", name.map_or("", String::as_str))
        }
        Extent::Sequence => "to the start of the sequence".to_owned(),
    }
}

/// With what stops it, and the calls on the way there.
fn chain(found: Diagnostic, source: Source<'_>, way: &Way) -> Diagnostic {
    let module = source.module;
    let mut found = found;
    for link in &way.links {
        let (pc, text) = match *link {
            Link::CalledFrom(pc) => (pc, "called from here"),
            Link::Within(pc) => (pc, "going back leads into this call"),
            Link::InPlaceOf(pc) => (pc, "run in place of this"),
            Link::Beside(pc) => (pc, "another branch of this may have run"),
            Link::Again(pc) => (pc, "begun again, after a round of this"),
        };
        // The start calls the first sequence without a word.
        let is_written = module.function_at(pc).is_some_and(|function| function > 0);
        if let Some(span) = source.span_of(pc).filter(|_| is_written) {
            found = found.with_label(span, text);
        }
    }
    let Horizon::Never(pc) = way.horizon else { return found };
    let reason = reason(module, pc);
    match source.span_of(pc) {
        Some(span) => found.with_label(span, format!("this is not taken back: {reason}")),
        None => found,
    }
    .with_help(match module.code.get(pc as usize) {
        Some(Instr::Barrier { .. }) => "go back less far, or raise the error before the barrier",
        _ => "go back less far, or raise the error before what cannot be taken back",
    })
}

/// Where an error says how it is recovered from.
fn clause(program: &Program<'_>, error: &str) -> Option<Span> {
    let mut items = program.items.iter();
    items.find_map(|item| match item {
        Item::Error(declared) if declared.name.value == error => {
            let mut clauses = declared.clauses.iter();
            clauses
                .find(|clause| matches!(clause.value, ErrorClause::Recover(_)))
                .map(|clause| clause.span)
        }
        _ => None,
    })
}
