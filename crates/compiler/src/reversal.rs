//! What blocks with a reverse of their own may not contain, however deep in calls.

use crate::effects::Effects;
use crate::report::Reports;
use crate::tree::{Body, Function, Program, Statement, StatementKind};
use obverse_bytecode::FunctionKind;
use obverse_isa::FunctionId;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::Span;
use std::collections::HashSet;

/// Report what cannot be in a block that is skipped, replaced, or replaces another.
pub(crate) fn check(program: &Program, effects: &Effects, reports: &mut Reports) {
    let mut reported = HashSet::new();
    let mut opposites = HashSet::new();
    for (id, function) in program.numbered() {
        let Body::Block(block) = &function.body else { continue };
        block.each_statement(&mut |statement| {
            if let StatementKind::Advance(_, Some(counterpart)) = &statement.kind
                && opposites.insert(*counterpart)
            {
                check_opposite(program.function(*counterpart), reports);
            }
            if let StatementKind::Reversed(inner, _) = &statement.kind {
                inner.each_statement(&mut |within| {
                    if reported.insert(within.span) {
                        check_barrier(within, statement.span, effects, reports);
                    }
                });
            }
        });
        if function.kind == FunctionKind::Replacement {
            check_replacement(id, function, effects, reports);
        }
    }
}

fn check_barrier(within: &Statement, block: Span, effects: &Effects, reports: &mut Reports) {
    let barrier = match &within.kind {
        StatementKind::Barrier(_) | StatementKind::Irreversible(..) => Some(within.span),
        StatementKind::Call(callee, _) | StatementKind::Kept(callee) => effects.barrier(*callee),
        _ => None,
    };
    let Some(barrier) = barrier else { return };
    let message = "a block with a reverse of its own cannot contain a barrier";
    let mut diagnostic =
        Diagnostic::error(Code::BarrierInReversedBlock, within.span, message, "in the block")
            .with_label(block, "this block is passed in reverse");
    if barrier != within.span {
        diagnostic = diagnostic.with_label(barrier, "this stops it");
    }
    reports.add(diagnostic);
}

fn check_replacement(
    id: FunctionId,
    function: &Function,
    effects: &Effects,
    reports: &mut Reports,
) {
    if let Some(barrier) = effects.barrier(id) {
        let message = "a block that is run in reverse cannot contain a barrier";
        reports.add(
            Diagnostic::error(Code::BarrierInReversedBlock, barrier, message, "a barrier")
                .with_label(function.named, "this block is run in reverse"),
        );
    }
    let fails = |callee: &FunctionId| effects.may_fail(*callee);
    let call = effects.calls(id).iter().find(|(callee, _)| fails(callee)).map(|(_, span)| *span);
    if let Some(place) = call.or_else(|| first_throw(function, effects)) {
        let message = "no error is responded to in reverse, and this may raise one";
        reports.add(
            Diagnostic::error(Code::ErrorInReverse, place, message, "may raise an error")
                .with_label(function.named, "this block is run in reverse"),
        );
    }
}

/// An advanced move that takes another one's place in reverse throws nothing.
fn check_opposite(function: &Function, reports: &mut Reports) {
    let Body::Guarded(guarded) = &function.body else { return };
    if let Some((_, place)) = guarded.throws().next() {
        let message = "no error is responded to in reverse, and this raises one";
        reports.add(
            Diagnostic::error(Code::ErrorInReverse, place, message, "raises an error")
                .with_label(function.named, "this takes another move's place in reverse"),
        );
    }
}

fn first_throw(function: &Function, effects: &Effects) -> Option<Span> {
    let Body::Block(block) = &function.body else { return None };
    let mut first = None;
    block.each_statement(&mut |statement| {
        let throws = match &statement.kind {
            StatementKind::Throw(_) | StatementKind::Requires(..) => true,
            StatementKind::Advance(guarded, _) => effects.may_fail(*guarded),
            _ => false,
        };
        if throws && first.is_none() {
            first = Some(statement.span);
        }
    });
    first
}
