//! Sequences that call themselves on every way through them, by way of others or not. Knows the
//! calls that are made for certain: none in a branch or a loop, and none behind what may leave.
//!
//! Linear in the calls of the program.

use crate::effects::Effects;
use crate::report::{Reports, warning};
use crate::tree::{Block, Body, Program, Statement, StatementKind};
use obverse_isa::FunctionId;
use obverse_syntax::codes::Code;
use obverse_syntax::span::Span;

/// How many calls of a circle are shown.
const MAX_SHOWN: usize = 6;

/// A call that is made whatever happens.
#[derive(Clone, Copy)]
struct Edge {
    callee: FunctionId,
    span: Span,
}

/// Warn of each circle of such calls, at the call that closes it.
pub(crate) fn check(program: &Program, effects: &Effects, reports: &mut Reports) {
    let certain = program.numbered().map(|(_, function)| {
        let mut calls = Vec::new();
        if let Body::Block(block) = &function.body {
            follow(block, effects, &mut calls);
        }
        calls
    });
    let certain: Vec<Vec<Edge>> = certain.collect();
    let calls_of = |function: FunctionId| &certain[function.index() - 1];
    let mut seen = vec![Seen::No; certain.len() + 1];
    for (root, _) in program.numbered() {
        if seen[root.index()] != Seen::No {
            continue;
        }
        seen[root.index()] = Seen::UnderWay;
        // The functions under way, and how many calls of each have been followed.
        let mut row = vec![(root, 0)];
        while let Some((function, followed)) = row.last_mut() {
            let Some(&edge) = calls_of(*function).get(*followed) else {
                seen[function.index()] = Seen::Done;
                row.pop();
                continue;
            };
            *followed += 1;
            match seen[edge.callee.index()] {
                Seen::No => {
                    seen[edge.callee.index()] = Seen::UnderWay;
                    row.push((edge.callee, 0));
                }
                Seen::UnderWay => {
                    seen[edge.callee.index()] = Seen::Reported;
                    let begin = row.iter().position(|(function, _)| *function == edge.callee);
                    let followed = row[begin.unwrap_or(0)..].iter();
                    let last_call =
                        |(function, count): &(FunctionId, usize)| calls_of(*function)[count - 1];
                    report(program, &followed.map(last_call).collect::<Vec<_>>(), reports);
                }
                Seen::Reported | Seen::Done => {}
            }
        }
    }
}

/// What is known of a function.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Seen {
    No,
    /// It leads to what is being followed.
    UnderWay,
    /// The same, and a circle that it closes has been reported.
    Reported,
    Done,
}

/// A circle of calls; the last one closes it.
fn report(program: &Program, circle: &[Edge], reports: &mut Reports) {
    let Some((last, links)) = circle.split_last() else { return };
    let function = program.function(last.callee);
    let name = &function.name;
    let by_way = match links.first() {
        Some(first) => format!(", by way of `{}`,", program.function(first.callee).name),
        None => String::new(),
    };
    let message = format!("`{name}` calls itself{by_way} whatever happens, without end");
    let mut diagnostic =
        warning(Code::EndlessRecursion, last.span, message, "called again on every way")
            .with_label(
                function.named,
                if links.is_empty() { "from within itself" } else { "this" },
            );
    for link in links.iter().take(MAX_SHOWN) {
        let text = format!("which calls `{}`", program.function(link.callee).name);
        diagnostic = diagnostic.with_label(link.span, text);
    }
    reports.add(diagnostic.with_help("to do it again and again write `loop { .. }`"));
}

/// Gather the calls of a block that are made for certain; whether what is behind it is, too.
fn follow(block: &Block, effects: &Effects, calls: &mut Vec<Edge>) -> bool {
    block.statements.iter().all(|statement| {
        let span = statement.span;
        match &statement.kind {
            StatementKind::Call(callee, _) => {
                calls.push(Edge { callee: *callee, span });
                !may_leave(statement, effects)
            }
            StatementKind::SetFor { block, .. }
            | StatementKind::Irreversible(_, block)
            | StatementKind::Reversed(block, _) => follow(block, effects, calls),
            StatementKind::Fork(branches) => {
                let mut goes_on = true;
                for branch in branches {
                    goes_on &= follow(branch, effects, calls);
                }
                goes_on
            }
            _ => !may_leave(statement, effects),
        }
    })
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
