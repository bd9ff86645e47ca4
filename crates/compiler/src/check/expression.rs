//! Expressions: names, literals and readings, and whether a value is what is needed.

use super::control::complement;
use super::frame::Readings;
use super::names::{Found, Meaning};
use super::{A_VALUE, Checker};
use crate::tree::{Expression, ExpressionKind, Hoist, Prepared};
use crate::types::ValueType;
use crate::units::{Dimension, Unit};
use obverse_isa::{Instr, LocalId};
use obverse_syntax::ast;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::{Span, Spanned};

/// How many values a statement computes at the most.
pub(super) const MAX_COMPUTED: usize = 200;
/// How many values a statement holds at a time at the most.
pub(super) const MAX_HELD: usize = 120;

/// Numbers that are longer, in bytes, are not written again in a message.
const MAX_REPEATED: usize = 20;

/// What a value is needed for.
#[derive(Clone, Debug)]
pub(super) struct Need {
    of_type: ValueType,
    what: String,
    declared: Option<Span>,
}

impl Need {
    /// A value of this type; `what` needs it.
    pub(super) fn new(of_type: ValueType, what: impl Into<String>) -> Self {
        Self { of_type, what: what.into(), declared: None }
    }

    /// The same, with the place that says so.
    pub(super) fn declared(mut self, place: Span) -> Self {
        self.declared = Some(place);
        self
    }
}

impl<'s> Checker<'s> {
    /// A value of a type that is needed.
    pub(super) fn value(&mut self, written: &ast::Expression<'s>, need: &Need) -> Expression {
        let value = self.any_value(written);
        self.fit(value, need)
    }

    /// A value of whatever type.
    pub(super) fn any_value(&mut self, written: &ast::Expression<'s>) -> Expression {
        let value = self.expression(written);
        let (computed, held) = value.size();
        if computed > MAX_COMPUTED || held > MAX_HELD {
            self.report_too_large(written.span, computed, held);
            return Expression::missing(written.span);
        }
        value
    }

    /// A truth value.
    pub(super) fn condition(&mut self, written: &ast::Expression<'s>, what: &str) -> Expression {
        self.value(written, &Need::new(ValueType::Bool, what))
    }

    /// A value with what is read for it, apart from the statement it is of.
    pub(super) fn prepared(&mut self, written: &ast::Expression<'s>, need: &Need) -> Prepared {
        let before = self.frame.take_hoists();
        let value = self.value(written, need);
        let hoists = self.frame.take_hoists();
        before.into_iter().for_each(|hoist| self.frame.hoist(hoist));
        Prepared { hoists, value }
    }

    /// A value that is known now.
    pub(super) fn constant(&mut self, written: &ast::Expression<'s>) -> Expression {
        let readings = std::mem::replace(&mut self.frame.readings, Readings::Constant);
        let value = self.any_value(written);
        self.frame.readings = readings;
        if value.is_constant() || value.of_type.is_unknown() {
            return value;
        }
        let message = "a value is needed that is known before the program runs".to_owned();
        self.reports.error(Code::NotConstant, written.span, message, "not known then");
        Expression::missing(written.span)
    }

    /// A truth value that reads nothing outside, so that it can be asserted in both directions.
    pub(super) fn assertion(&mut self, written: &ast::Expression<'s>, what: &str) -> Expression {
        let readings = std::mem::replace(&mut self.frame.readings, Readings::Asserted);
        let value = self.condition(written, what);
        self.frame.readings = readings;
        value
    }

    pub(super) fn report_too_large(&mut self, span: Span, computed: usize, held: usize) {
        let message = format!(
            "this computes {computed} values and holds {held} at a time; a statement has room for \
             {MAX_COMPUTED} and {MAX_HELD}"
        );
        let diagnostic = Diagnostic::error(Code::ExpressionTooLarge, span, message, "too large")
            .with_help("name a part of it with `var`");
        self.reports.add(diagnostic);
    }

    /// The value as what is needed; a mistake is reported.
    pub(super) fn fit(&mut self, value: Expression, need: &Need) -> Expression {
        if value.of_type == need.of_type {
            return value;
        }
        if value.of_type.is_unknown() || need.of_type.is_unknown() {
            return Expression::missing(value.span);
        }
        if let (ValueType::NUMBER, ExpressionKind::Int(number)) = (need.of_type, &value.kind) {
            return Expression::real(*number as f64, ValueType::NUMBER, value.span);
        }
        self.report_misfit(&value, need);
        Expression::missing(value.span)
    }

    fn report_misfit(&mut self, value: &Expression, need: &Need) {
        let (span, found, needed) = (value.span, value.of_type, need.of_type);
        let Need { what, declared, .. } = need;
        let message = format!("{what} needs {needed}, and this is {found}");
        let is_literal = matches!(value.kind, ExpressionKind::Int(_) | ExpressionKind::Real(_));
        let mut diagnostic = match (needed, found) {
            (ValueType::Real(unit), ValueType::Int | ValueType::NUMBER) if is_literal => {
                let message = format!("{what} needs {needed}, and this number has no unit");
                let written = self.with_units(span, unit);
                let help = match written.len() {
                    0 => unit.examples().to_owned(),
                    _ => format!("`{}`", written.join("` or `")),
                };
                Diagnostic::error(Code::MissingUnit, span, message, "a number without a unit")
                    .with_help(format!("write the unit after it: {help}"))
                    .with_choices(span, written)
            }
            (ValueType::Real(unit), ValueType::Real(_)) => {
                let diagnostic =
                    Diagnostic::error(Code::UnitMismatch, span, message, found.to_string());
                match is_literal && !unit.is_none() {
                    true => {
                        diagnostic.with_help(format!("{needed} is written in {}", unit.examples()))
                    }
                    false => diagnostic,
                }
            }
            _ => Diagnostic::error(Code::TypeMismatch, span, message, found.to_string()),
        };
        match (needed, found) {
            (ValueType::NUMBER, ValueType::Int) => {
                diagnostic = diagnostic.with_help("`real(..)` makes a number of an integer");
            }
            (ValueType::Int, ValueType::NUMBER) => {
                diagnostic =
                    diagnostic.with_help("`int(..)` makes an integer of a number, towards zero");
            }
            _ => {}
        }
        if let Some(place) = declared {
            diagnostic = diagnostic.with_label(*place, format!("{needed}, says this"));
        }
        self.reports.add(diagnostic);
    }

    /// A number as it is written, with each unit that it may lack; none of one that is long.
    fn with_units(&self, span: Span, of: Dimension) -> Vec<String> {
        let mut number = self.text(span);
        while let Some(inner) = number.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
            number = inner.trim();
        }
        let is_plain = number.len() <= MAX_REPEATED
            && number.starts_with(|c: char| c.is_ascii_digit() || c == '-');
        let units = of.units().into_iter().filter(|_| is_plain);
        units.map(|unit| format!("{number} {unit}")).collect()
    }

    /// An expression with its type.
    pub(super) fn expression(&mut self, written: &ast::Expression<'s>) -> Expression {
        let span = written.span;
        let of = |kind, of_type| Expression { kind, of_type, span };
        match &written.kind {
            ast::ExpressionKind::Integer(value) => Expression::int(*value, span),
            ast::ExpressionKind::Real(value) => Expression::real(*value, ValueType::NUMBER, span),
            ast::ExpressionKind::Quantity { value, unit } => self.quantity(*value, *unit, span),
            ast::ExpressionKind::Boolean(value) => {
                of(ExpressionKind::Bool(*value), ValueType::Bool)
            }
            ast::ExpressionKind::Name(name) => self.named_value(Spanned::new(*name, span)),
            ast::ExpressionKind::Unary { operator, operand } => {
                let operand = self.expression(operand);
                self.unary_operator(*operator, operand, span)
            }
            ast::ExpressionKind::Binary { operator, left, right } => {
                let value = self.expression(left);
                if self.is_compared_with_level(*operator, (&value, left), right) {
                    return Expression::missing(span);
                }
                let right = self.expression(right);
                self.binary_operator(*operator, value, right, span)
            }
            ast::ExpressionKind::Function { name, arguments } => {
                self.function_call(*name, arguments, span)
            }
            ast::ExpressionKind::Input(line) => {
                let bit = self.input(*line);
                let read = |local| Instr::SenseInput { local, bit };
                self.reading(ValueType::Bool, span, "an input", read)
            }
            ast::ExpressionKind::Force => self.force(span),
            ast::ExpressionKind::Distance => self.distance(span),
            ast::ExpressionKind::Holding => {
                let read = |local| Instr::SenseHolding { local };
                self.reading(ValueType::Bool, span, "what the gripper holds", read)
            }
            ast::ExpressionKind::Missing => Expression::missing(span),
        }
    }

    /// A number with a unit, in SI units.
    pub(super) fn quantity(&mut self, value: f64, unit: ast::Name<'s>, span: Span) -> Expression {
        let Some(known) = Unit::of_name(unit.value) else {
            let message = format!("`{}` is not a unit", unit.value);
            self.reports.error(Code::UnknownUnit, unit.span, message, "not a unit");
            return Expression::missing(span);
        };
        let si = known.to_si(value);
        if !si.is_finite() {
            return self.not_finite(span);
        }
        Expression::real(si, ValueType::Real(known.dimension), span)
    }

    pub(super) fn not_finite(&mut self, span: Span) -> Expression {
        let message = "this is no finite real; the largest is about 1.8e308".to_owned();
        self.reports.error(Code::OutOfRange, span, message, "not finite");
        Expression::missing(span)
    }

    fn force(&mut self, span: Span) -> Expression {
        if let Readings::OfMove(results) = self.frame.readings {
            return Expression::local(results.force, ValueType::FORCE, span);
        }
        self.reading(ValueType::FORCE, span, "a force", |local| Instr::SenseForce { local })
    }

    fn distance(&mut self, span: Span) -> Expression {
        if let Readings::OfMove(results) = self.frame.readings {
            return Expression::local(results.distance, ValueType::LENGTH, span);
        }
        let read = |local| Instr::SenseDistance { local };
        self.reading(ValueType::LENGTH, span, "how far a move came", read)
    }

    /// What `read` stores into a hidden local before the statement.
    pub(super) fn reading(
        &mut self,
        of_type: ValueType,
        span: Span,
        what: &str,
        read: impl FnOnce(LocalId) -> Instr,
    ) -> Expression {
        if !self.may_read(span, what) {
            return Expression::missing(span);
        }
        let local = self.temporary(of_type.machine(), span);
        self.frame.hoist(Hoist::Read(read(local)));
        Expression::local(local, of_type, span)
    }

    /// Whether the outside may be read here; otherwise it is reported.
    pub(super) fn may_read(&mut self, span: Span, what: &str) -> bool {
        match self.frame.readings {
            Readings::Taken | Readings::OfMove(_) => return true,
            Readings::Asserted => {
                let message = format!(
                    "an assertion must say the same in both directions, and {what} need not"
                );
                let diagnostic =
                    Diagnostic::error(Code::ReadingInAssertion, span, message, "reads the outside")
                        .with_help("store the reading with `var` before, and assert that");
                self.reports.add(diagnostic);
            }
            Readings::Constant => {
                let message =
                    format!("this is fixed before the program runs, and {what} is not known then");
                self.reports.error(Code::NotConstant, span, message, "not known then");
            }
        }
        false
    }

    /// The value that a name stands for.
    fn named_value(&mut self, name: ast::Name<'s>) -> Expression {
        let is_value = |meaning| {
            use Meaning::{CountDown, Counter, Global, Item, Joints, Local};
            matches!(
                meaning,
                Joints(_) | Item(_) | Global(..) | Local(..) | Counter(_) | CountDown(_)
            )
        };
        let Some(meaning) = self.resolve(name, A_VALUE, is_value) else {
            return Expression::missing(name.span);
        };
        let (kind, of_type) = match meaning {
            Meaning::Joints(joints) => (ExpressionKind::Joints(joints), ValueType::Joints),
            Meaning::Item(item) => (ExpressionKind::Item(item), ValueType::Item),
            Meaning::Global(global, of_type) => (ExpressionKind::Global(global), of_type),
            Meaning::Local(local, of_type) => (ExpressionKind::Local(local), of_type),
            Meaning::Counter(counter) | Meaning::CountDown(counter) => {
                (ExpressionKind::Counter(counter), ValueType::Int)
            }
            _ => (ExpressionKind::Missing, ValueType::Unknown),
        };
        if of_type.is_unknown() {
            return Expression::missing(name.span);
        }
        if matches!(self.frame.readings, Readings::Constant) && !is_fixed(&kind) {
            self.report_variable_in_constant(name);
            return Expression::missing(name.span);
        }
        let value = Expression { kind, of_type, span: name.span };
        if matches!(meaning, Meaning::CountDown(_)) { complement(value) } else { value }
    }

    fn report_variable_in_constant(&mut self, name: ast::Name<'s>) {
        let message =
            format!("this is fixed before the program runs, and `{}` is a variable", name.value);
        let mut diagnostic =
            Diagnostic::error(Code::NotConstant, name.span, message, "not known then");
        if let Found::Here(symbol) | Found::Outside(symbol) = self.names.find(name.value) {
            diagnostic = diagnostic.with_label(symbol.name.span, "a variable, declared here");
        }
        self.reports.add(diagnostic);
    }
}

fn is_fixed(kind: &ExpressionKind) -> bool {
    matches!(kind, ExpressionKind::Joints(_) | ExpressionKind::Item(_))
}
