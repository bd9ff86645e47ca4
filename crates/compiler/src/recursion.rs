//! Sequences that call themselves on every way through them. Knows the direct call alone: none in a
//! branch or a loop, and none by way of another sequence.

use crate::effects::Effects;
use crate::report::{Reports, warning};
use crate::tree::{Block, Body, Program, Statement, StatementKind};
use obverse_isa::FunctionId;
use obverse_syntax::codes::Code;
use obverse_syntax::span::Span;

/// Warn of each such sequence, at the call.
pub(crate) fn check(program: &Program, effects: &Effects, reports: &mut Reports) {
    for (id, function) in program.numbered() {
        let Body::Block(block) = &function.body else { continue };
        if let Way::CallsItself(span) = follow(block, id, effects) {
            let message = format!("`{}` calls itself whatever happens, without end", function.name);
            reports.add(
                warning(Code::EndlessRecursion, span, message, "called again on every way")
                    .with_label(function.named, "from within itself")
                    .with_help("to do it again and again write `loop { .. }`"),
            );
        }
    }
}

/// How a block goes on, as far as that is certain.
enum Way {
    /// Behind its end.
    Through,
    /// Possibly out of the sequence.
    MayLeave,
    /// Into the sequence again.
    CallsItself(Span),
}

fn follow(block: &Block, id: FunctionId, effects: &Effects) -> Way {
    for statement in &block.statements {
        let way = match &statement.kind {
            StatementKind::Call(callee, _) if *callee == id => Way::CallsItself(statement.span),
            StatementKind::SetFor { block, .. }
            | StatementKind::Irreversible(_, block)
            | StatementKind::Reversed(block, _) => follow(block, id, effects),
            StatementKind::Fork(branches) => {
                let mut ways = branches.iter().map(|branch| follow(branch, id, effects));
                ways.find(|way| !matches!(way, Way::Through)).unwrap_or(Way::Through)
            }
            _ if may_leave(statement, effects) => Way::MayLeave,
            _ => Way::Through,
        };
        if !matches!(way, Way::Through) {
            return way;
        }
    }
    Way::Through
}

/// Whether a statement, or one within it, may end the sequence.
fn may_leave(statement: &Statement, effects: &Effects) -> bool {
    let mut found = false;
    statement.each(&mut |one| {
        found |= match &one.kind {
            StatementKind::Return | StatementKind::Throw(_) | StatementKind::Requires(..) => true,
            StatementKind::Call(callee, _) | StatementKind::Advance(callee, _) => {
                effects.leaves(*callee) || !effects.left_by(*callee).is_empty()
            }
            _ => false,
        };
    });
    found
}
