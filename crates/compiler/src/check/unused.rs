//! Names that nothing uses, and conditions that nothing can change. Knows how a name is used; where
//! it is used is noted elsewhere.

use super::Checker;
use super::names::{Meaning, Symbol};
use crate::report::warning;
use crate::tree::{Expression, ExpressionKind};
use obverse_isa::FunctionId;
use obverse_syntax::codes::Code;
use obverse_syntax::span::Span;
use std::collections::HashSet;

impl Checker<'_> {
    /// Warn of names that nothing uses; the places of the functions among them.
    pub(super) fn warn_of_unused(&mut self, main: Option<FunctionId>) -> HashSet<Span> {
        let mut functions = HashSet::new();
        if self.reports.has_errors() {
            // What would use a thing may be what has the mistake.
            return functions;
        }
        for symbol in self.names.all() {
            let name = symbol.name.value;
            let is_main = matches!(symbol.meaning, Meaning::Sequence(id) if Some(id) == main);
            // The counter of a loop counts, whether it is read or not; and what a file offers
            // serves other programs as well.
            let is_meant = matches!(symbol.meaning, Meaning::Counter(_) | Meaning::CountDown(_));
            let is_offered = symbol.meaning.is_declared() && !self.is_own(symbol.name.span);
            if symbol.is_used || is_main || is_meant || is_offered {
                continue;
            }
            functions.insert(symbol.name.span);
            if name.starts_with('_') {
                continue;
            }
            let (kind, how) = kind_and_use(symbol);
            let message = format!("`{name}` is {kind} that is {how}");
            let help = match symbol.is_parameter {
                true => format!("leave it out, here and where it is given, or call it `_{name}`"),
                false => format!("leave it out, or call it `_{name}`"),
            };
            let at = Span::new(symbol.name.span.start, symbol.name.span.start);
            let mut diagnostic =
                warning(Code::Unused, symbol.name.span, message, how).with_help(help);
            if !symbol.is_assigned {
                diagnostic = diagnostic.replacing(at, "_");
            }
            self.reports.add(diagnostic);
        }
        functions
    }

    /// Warn of a condition that was computed to be always the same.
    pub(super) fn warn_of_constant(&mut self, condition: &Expression, help: &str) {
        let ExpressionKind::Bool(holds) = condition.kind else { return };
        if self.frame.is_dead {
            return;
        }
        let how = if holds { "always holds" } else { "never holds" };
        let message = format!("this condition {how}");
        self.reports
            .add(warning(Code::ConstantCondition, condition.span, message, how).with_help(help));
    }

    /// Warn of a loop that counts up to less than what it begins with, or down to more.
    pub(super) fn warn_of_empty_count(
        &mut self,
        first: &Expression,
        down: bool,
        last: &Expression,
    ) {
        let (ExpressionKind::Int(from), ExpressionKind::Int(to)) = (&first.kind, &last.kind) else {
            return;
        };
        let (way, at, is_empty) = match down {
            false => ("up", "less than the first", from > to),
            true => ("down", "more than the first", from < to),
        };
        if !is_empty || self.frame.is_dead {
            return;
        }
        // The ends of `repeat 0 times` stand both where its number does.
        self.reports.add(if first.span == last.span {
            let message = format!("this loop is never run: it is repeated {to} times");
            warning(Code::ConstantCondition, last.span, message, "less than once")
        } else {
            let message = format!("this loop is never run: it counts {way} from {from} to {to}");
            warning(Code::ConstantCondition, last.span, message, at)
                .with_label(first.span, "the first")
        });
    }
}

fn kind_and_use(symbol: &Symbol<'_>) -> (&'static str, &'static str) {
    match symbol.meaning {
        _ if symbol.is_parameter && symbol.is_assigned => {
            ("a parameter", "assigned and never read")
        }
        _ if symbol.is_parameter => ("a parameter", "never read"),
        Meaning::Sequence(_) | Meaning::Action(_) => (symbol.meaning.kind(), "never called"),
        Meaning::Error(_) => ("an error", "never thrown"),
        Meaning::Global(..) | Meaning::Local(..) if symbol.is_assigned => {
            ("a variable", "assigned and never read")
        }
        Meaning::Global(..) | Meaning::Local(..) => ("a variable", "never read"),
        _ => (symbol.meaning.kind(), "never used"),
    }
}
