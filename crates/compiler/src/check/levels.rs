//! Levels where other languages have values: `input 2 == high`, `lamp = 1`. Here an input is a
//! truth value, and an output is set. It knows what was meant by them, and no types but that.

use super::Checker;
use super::names::{Found, Meaning};
use crate::tree::Expression;
use crate::types::ValueType;
use obverse_syntax::ast::{self, BinaryOperator, ExpressionKind, Name};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::Span;

impl<'s> Checker<'s> {
    /// Whether a truth value is compared with a level, which is then reported.
    pub(super) fn is_compared_with_level(
        &mut self,
        operator: BinaryOperator,
        left: (&Expression, &ast::Expression<'s>),
        right: &ast::Expression<'s>,
    ) -> bool {
        let is_equal = match operator {
            BinaryOperator::Equal => true,
            BinaryOperator::NotEqual => false,
            _ => return false,
        };
        let (value, written) = left;
        let level = self.level_of(right).filter(|_| value.of_type == ValueType::Bool);
        let Some(level) = level.filter(|_| !matches!(right.kind, ExpressionKind::Boolean(_)))
        else {
            return false;
        };
        let text = |span: Span| self.text(span).to_owned();
        let behind = Span::new(written.span.end, right.span.end);
        let message = format!("a truth value is compared with `{}`", text(right.span));
        let diagnostic =
            Diagnostic::error(Code::TypeMismatch, right.span, message, "not a truth value");
        let condition = match written.kind {
            ExpressionKind::Binary { .. } => format!("({})", text(written.span)),
            _ => text(written.span),
        };
        let diagnostic = match level == is_equal {
            true => {
                let help = format!("leave out `{}`: write `{condition}`", text(behind).trim());
                diagnostic.with_help(help).replacing(behind, "")
            }
            false => {
                let whole = written.span.to(right.span);
                diagnostic.write_instead(whole, &format!("not {condition}"))
            }
        };
        self.reports.add(diagnostic);
        true
    }

    /// Whether an output is assigned a level, which is then reported.
    pub(super) fn is_output_assigned(
        &mut self,
        name: Name<'s>,
        written: &ast::Expression<'s>,
    ) -> bool {
        let Found::Here(symbol) = self.names.find(name.value) else { return false };
        let level = self.level_of(written).filter(|_| matches!(symbol.meaning, Meaning::Output(_)));
        let Some(level) = level else { return false };
        self.names.mark_used(name.value);
        let message = format!("`{}` is an output and cannot be assigned", name.value);
        let instead = format!("set {} {}", name.value, if level { "high" } else { "low" });
        self.reports.add(
            Diagnostic::error(Code::NotAssignable, name.span, message, "assigned here")
                .with_label(symbol.name.span, "an output, declared here")
                .write_instead(name.span.to(written.span), &instead),
        );
        true
    }

    /// The level that is meant by a value, if one can be: whether it is high.
    fn level_of(&self, written: &ast::Expression<'s>) -> Option<bool> {
        match written.kind {
            ExpressionKind::Integer(1) => Some(true),
            ExpressionKind::Integer(0) => Some(false),
            ExpressionKind::Boolean(value) => Some(value),
            ExpressionKind::Name(name) if matches!(self.names.find(name), Found::Nothing) => {
                match name.to_lowercase().as_str() {
                    "high" | "on" | "true" => Some(true),
                    "low" | "off" | "false" => Some(false),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// What stands at a place.
    pub(super) fn text(&self, span: Span) -> &str {
        let range = span.start as usize..span.end as usize;
        self.sources.whole().get(range).unwrap_or_default()
    }
}
