//! Which functions the program can come to from its main sequence, and a warning for each that
//! something names and nothing comes to. Knows nothing of why.

use crate::report::{Reports, warning};
use crate::tree::{Body, Function, Program, StatementKind};
use obverse_bytecode::{FunctionKind, Otherwise, Recovery};
use obverse_isa::{ErrorId, FunctionId};
use obverse_syntax::codes::Code;
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use std::collections::HashSet;

/// Warn of the functions that only functions call that are never run; of those that nothing names
/// at all (`unnamed`, by the place of their names) it is said elsewhere. What imported files
/// declare serves other programs as well.
pub(crate) fn check(
    program: &Program,
    sources: &Sources,
    unnamed: &HashSet<Span>,
    reports: &mut Reports,
) {
    // What is allowed to be there though nothing names it keeps what it runs.
    let mut is_allowed = |function: &Function| {
        let at = function.named;
        unnamed.contains(&at) && reports.permits(Code::Unused, at.start)
    };
    let kept = program.numbered().filter(|(_, function)| is_allowed(function));
    let begun = kept.map(|(id, _)| id).chain([program.main]).collect();
    let reached = reached_from(program, begun);
    let (mut first_uses, mut uses) = (vec![None; reached.len()], Vec::new());
    for (id, function) in program.numbered().filter(|(id, _)| !reached[id.index()]) {
        uses_of(program, function, &mut uses);
        for (used, place) in uses.drain(..) {
            first_uses[used.index()].get_or_insert((id, place));
        }
    }
    for (id, function) in program.numbered() {
        let is_meant = function.name.starts_with('_') || unnamed.contains(&function.named);
        let is_offered = sources.locate(function.named).file != 0;
        let is_block = function.kind == FunctionKind::Replacement;
        if reached[id.index()] || is_meant || is_offered || is_block {
            continue;
        }
        let message = format!("`{}` is never run, though something names it", function.name);
        let mut diagnostic = warning(Code::NeverReached, function.named, message, "never run")
            .with_help(format!("leave it out, or call it `_{}`", function.name));
        if let Some((user, Some(place))) = first_uses[id.index()] {
            let text = match user == id {
                true => "named here, in itself".to_owned(),
                false => {
                    format!("named here, in `{}`, which is never run", program.function(user).name)
                }
            };
            diagnostic = diagnostic.with_label(place, text);
        }
        reports.add(diagnostic);
    }
}

/// By function: whether one can come to it from one of these.
fn reached_from(program: &Program, mut to_visit: Vec<FunctionId>) -> Vec<bool> {
    let mut reached = vec![false; program.functions.len() + 1];
    to_visit.extend(program.cleanup);
    let raised =
        (0..).zip(&program.module.errors).filter(|(_, error)| error.is_raised_by_workcell());
    for (error, _) in raised {
        to_visit.extend(recoveries(program, ErrorId(error)).map(|(used, _)| used));
    }
    let mut uses = Vec::new();
    while let Some(id) = to_visit.pop() {
        if id.index() == 0 || std::mem::replace(&mut reached[id.index()], true) {
            continue;
        }
        uses_of(program, program.function(id), &mut uses);
        to_visit.extend(uses.drain(..).map(|(used, _)| used));
    }
    reached
}

/// A function that another one names, and where, if it does so itself.
type Use = (FunctionId, Option<Span>);

fn uses_of(program: &Program, function: &Function, uses: &mut Vec<Use>) {
    match &function.body {
        Body::Guarded(guarded) => {
            for (error, _) in guarded.throws() {
                uses.extend(recoveries(program, error));
            }
        }
        Body::Block(block) => block.each_statement(&mut |statement| {
            let place = Some(statement.span);
            match &statement.kind {
                StatementKind::Call(used, _) | StatementKind::Kept(used) => {
                    uses.push((*used, place));
                }
                StatementKind::Io(used, counterpart)
                | StatementKind::Advance(used, counterpart) => {
                    uses.push((*used, place));
                    uses.extend(counterpart.map(|used| (used, None)));
                }
                StatementKind::Reversed(_, Some(used)) => uses.push((*used, place)),
                StatementKind::Throw(error) | StatementKind::Requires(_, error) => {
                    uses.extend(recoveries(program, *error));
                }
                _ => {}
            }
        }),
    }
}

/// The sequences that are run to recover from an error.
fn recoveries(program: &Program, error: ErrorId) -> impl Iterator<Item = Use> {
    let declared = program.module.errors.get(error.index());
    let using = declared.and_then(|error| match error.recovery {
        Recovery::Using(used) => Some(used),
        _ => None,
    });
    let otherwise = declared.and_then(|error| match error.otherwise {
        Otherwise::Using(used) => Some(used),
        _ => None,
    });
    using.into_iter().chain(otherwise).map(|used| (FunctionId(used), None))
}
