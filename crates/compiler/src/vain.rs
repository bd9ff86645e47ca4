//! Throws that are the action which is to be done again: done again, one throws again, and what it
//! was thrown for is not looked at. Knows nothing of what a recovery does.

use crate::effects::Effects;
use crate::report::{Reports, warning};
use crate::response::{Response, is_for_caller};
use crate::tree::{Body, Program, Statement, StatementKind};
use obverse_bytecode::{Continuation, FunctionKind};
use obverse_isa::ErrorId;
use obverse_syntax::ast::{self, ErrorClause, Item};
use obverse_syntax::codes::Code;
use obverse_syntax::span::Span;

/// Warn of each such `throw`, with what asks for it again.
pub(crate) fn check(
    tree: &ast::Program<'_>,
    program: &Program,
    effects: &Effects,
    reports: &mut Reports,
) {
    for (_, function) in program.numbered() {
        // Those of an advanced move or an I/O operation are responded to where it was called.
        let responds = matches!(
            function.kind,
            FunctionKind::Sequence | FunctionKind::Action | FunctionKind::Cleanup
        );
        let Body::Block(block) = &function.body else { continue };
        if responds {
            block.each_statement(&mut |statement| {
                if let Some(error) = thrown_again(statement, program, effects) {
                    report(tree, program, (statement.span, error), reports);
                }
            });
        }
    }
}

/// The error that a statement throws, if it is what is done again after a recovery.
fn thrown_again(statement: &Statement, program: &Program, effects: &Effects) -> Option<ErrorId> {
    let StatementKind::Throw(error) = statement.kind else { return None };
    let response = effects.response(error);
    let is_again =
        matches!(response, Response::Recover { using: Some(_), then: Continuation::Action });
    let is_here = !is_for_caller(program.module.errors.get(error.index())?);
    (is_again && is_here).then_some(error)
}

fn report(
    tree: &ast::Program<'_>,
    program: &Program,
    (thrown, error): (Span, ErrorId),
    reports: &mut Reports,
) {
    let name = &program.module.errors[error.index()].name;
    let message =
        format!("after its recovery `{name}` is thrown again, whatever has become of its cause");
    let found = warning(Code::ThrownAgain, thrown, message, "this throw is the action").with_help(
        "write `requires CONDITION else throw NAME`, which looks again; or return to the sequence",
    );
    let asked = clause(tree, name);
    reports
        .add(asked.into_iter().fold(found, |found, span| found.with_label(span, "asked for here")));
}

/// Where the error says how the program goes on.
fn clause(tree: &ast::Program<'_>, name: &str) -> Option<Span> {
    let clauses = tree.items.iter().find_map(|item| match item {
        Item::Error(error) if error.name.value == name => Some(&error.clauses),
        _ => None,
    })?;
    let then = |clause: &ErrorClause<'_>| matches!(clause, ErrorClause::Then(_));
    clauses.iter().find(|clause| then(&clause.value)).map(|clause| clause.span)
}
