//! Parameters: their ranges and defaults, and which argument of a call is whose.

use super::expression::Need;
use super::names::{Found, Meaning};
use super::operators::binary;
use super::{Checker, Parameter};
use crate::parameters::{self, name_of, of_si, to_si, unit_of};
use crate::tree::{Expression, ExpressionKind, Statement, StatementKind};
use crate::types::ValueType;
use obverse_isa::{FunctionId, Instr, LocalId};
use obverse_syntax::ast::{self, Argument, Name, Sequence, ValueRange};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::format::print_expression;
use obverse_syntax::span::{Span, Spanned};

/// The values between which a parameter lies, both included.
#[derive(Clone, Debug)]
pub(super) struct Range {
    least: Expression,
    most: Expression,
    /// As it is written: `5 mm to 60 mm`.
    text: String,
    /// Where.
    span: Span,
}

impl Range {
    /// Whether a value that is known lies outside.
    fn excludes(&self, value: &Expression) -> bool {
        match (&self.least.kind, &value.kind, &self.most.kind) {
            (ExpressionKind::Int(least), ExpressionKind::Int(value), ExpressionKind::Int(most)) => {
                !(least..=most).contains(&value)
            }
            (
                ExpressionKind::Real(least),
                ExpressionKind::Real(value),
                ExpressionKind::Real(most),
            ) => !(least..=most).contains(&value),
            _ => false,
        }
    }
}

impl<'s> Checker<'s> {
    /// The ranges and defaults of the parameters of a sequence or action.
    pub(super) fn check_parameters(&mut self, sequence: &Sequence<'s>) {
        let Some(id) = self.function_named(sequence.name) else { return };
        for (index, written) in sequence.parameters.iter().enumerate() {
            let Some(parameter) = self.signatures[id.index()].parameters.get(index) else { return };
            let (of_type, place) = (parameter.of_type, written.type_name.span);
            let need = Need::new(of_type, format!("the parameter `{}`", written.name.value));
            let need = need.declared(place);
            let range = written.range.as_ref().and_then(|range| self.range(range, of_type, &need));
            let default = written.default.as_ref().map(|default| self.default(default, &need));
            if let (Some(range), Some(default)) = (&range, &default) {
                self.check_within(default, range, written.name.value, "the default");
            }
            let other = (sequence.name.value.to_owned(), written.name.value.to_owned());
            let other = self.defaults.get(&other).copied();
            let parameter = &mut self.signatures[id.index()].parameters[index];
            parameter.range = range;
            parameter.default = match (default, other) {
                (Some(default), Some(other)) => Some(in_place_of(default, other)),
                (default, _) => default,
            };
        }
    }

    fn function_named(&self, name: Name<'s>) -> Option<FunctionId> {
        let Found::Here(symbol) = self.names.find(name.value) else { return None };
        let (Meaning::Sequence(id) | Meaning::Action(id)) = symbol.meaning else { return None };
        // Of two of one name the first is found.
        let named = self.signatures.get(id.index())?.named;
        (named == name.span).then_some(id)
    }

    fn default(&mut self, written: &ast::Expression<'s>, need: &Need) -> Expression {
        let value = self.constant(written);
        let value = self.fit(value, need);
        if matches!(value.kind, ExpressionKind::Joints(_)) {
            let message = "a default is a number or a truth value".to_owned();
            self.reports.error(Code::TypeMismatch, written.span, message, "neither");
            return Expression::missing(written.span);
        }
        value
    }

    fn range(
        &mut self,
        ValueRange { least, most }: &ValueRange<'s>,
        of_type: ValueType,
        need: &Need,
    ) -> Option<Range> {
        let span = least.span.to(most.span);
        if unit_of(of_type).is_none() {
            if !of_type.is_unknown() {
                let message = format!("{of_type} has no range");
                self.reports.error(Code::TypeMismatch, span, message, "a range is of numbers");
            }
            return None;
        }
        let text = format!("{} to {}", print_expression(least), print_expression(most));
        let [least, most] = [least, most].map(|written| {
            let value = self.constant(written);
            self.fit(value, need)
        });
        let range = Range { least, most, text, span };
        if range.least.of_type.is_unknown() || range.most.of_type.is_unknown() {
            return None;
        }
        if range.excludes(&range.least) {
            let message = "a range goes from the least value to the most".to_owned();
            self.reports.error(Code::OutOfRange, span, message, "nothing lies in it");
            return None;
        }
        Some(range)
    }

    /// Report a value that is known and lies outside of the range of its parameter.
    fn check_within(&mut self, value: &Expression, range: &Range, name: &str, what: &str) {
        if !range.excludes(value) {
            return;
        }
        let message = format!("{what} of `{name}` is not in its range, {}", range.text);
        let diagnostic =
            Diagnostic::error(Code::OutsideRange, value.span, message, "outside of the range")
                .with_label(range.span, "the range");
        self.reports.add(diagnostic);
    }

    /// What holds of the parameters when a sequence begins, so that values are looked at that are
    /// not known before.
    pub(super) fn require_ranges(&mut self, id: FunctionId) -> Vec<Statement> {
        let ranged: Vec<(usize, Parameter)> = self.signatures[id.index()]
            .parameters
            .iter()
            .cloned()
            .enumerate()
            .filter(|(_, parameter)| parameter.range.is_some())
            .collect();
        let mut statements = Vec::new();
        for (index, parameter) in ranged {
            let (Some(range), Ok(local)) = (&parameter.range, u8::try_from(index)) else {
                continue;
            };
            let reason =
                format!("{} requires {} in {}", self.frame.name, parameter.name, range.text);
            let reason = self.reason(Spanned::new(&reason, range.span));
            let condition = within(range, LocalId(local), parameter.of_type);
            let kind = StatementKind::Demand(condition, reason);
            statements.push(Statement { hoists: Vec::new(), kind, span: range.span });
        }
        statements
    }

    /// The value of each parameter of what is called; none where there is a mistake.
    pub(super) fn bind(
        &mut self,
        name: Name<'s>,
        callee: FunctionId,
        arguments: &[Argument<'s>],
        span: Span,
    ) -> Option<Vec<Expression>> {
        let parameters = self.signatures[callee.index()].parameters.clone();
        let mut values: Vec<Option<Expression>> = vec![None; parameters.len()];
        let mut is_whole = true;
        let mut named: Option<Span> = None;
        for (position, argument) in arguments.iter().enumerate() {
            let index = match argument.name {
                Some(name) => parameters.iter().position(|known| known.name == name.value),
                None => Some(position),
            };
            let place = index.and_then(|index| parameters.get(index).zip(values.get_mut(index)));
            let is_free = place.as_ref().is_some_and(|(_, value)| value.is_none());
            let is_ordered = argument.name.is_some() || named.is_none();
            named = named.or(argument.name.map(|name| name.span));
            let Some((parameter, value)) = place.filter(|_| is_free && is_ordered) else {
                self.any_value(&argument.value);
                let is_known = index.is_some_and(|index| index < parameters.len());
                match argument.name {
                    Some(named) => self.report_argument(named, name, &parameters, is_known),
                    None if !is_ordered => self.report_order(argument, named),
                    None => {}
                }
                is_whole &= argument.name.is_none() && is_ordered;
                continue;
            };
            *value = Some(self.argument(parameter, &argument.value));
        }
        if !is_whole {
            return None;
        }
        let missing = |(parameter, value): (&Parameter, &Option<Expression>)| {
            value.is_none() && parameter.default.is_none()
        };
        if arguments.len() > parameters.len() || parameters.iter().zip(&values).any(missing) {
            self.report_argument_count(name, callee, &parameters, arguments.len(), span);
            return None;
        }
        let signature = &mut self.signatures[callee.index()];
        let known = signature.parameters.iter_mut().zip(values);
        let value = |(parameter, value): (&mut Parameter, Option<Expression>)| {
            parameter.is_left_to_default |= value.is_none();
            value.or_else(|| parameter.default.clone())
        };
        known.map(value).collect()
    }

    fn argument(&mut self, parameter: &Parameter, written: &ast::Expression<'s>) -> Expression {
        let need = Need::new(parameter.of_type, format!("the parameter `{}`", parameter.name));
        let value = self.value(written, &need.declared(parameter.span));
        if let Some(range) = &parameter.range {
            self.check_within(&value, range, &parameter.name, "the value");
        }
        value
    }

    /// An argument whose name is that of no parameter, or of one that has its value already.
    fn report_argument(
        &mut self,
        named: Name<'s>,
        callee: Name<'s>,
        parameters: &[Parameter],
        is_known: bool,
    ) {
        let (callee, name) = (callee.value, named.value);
        if is_known {
            let message = format!("the parameter `{name}` of `{callee}` is given twice");
            let at = "given again here";
            return self.reports.error(Code::WrongArgument, named.span, message, at);
        }
        let message = format!("`{callee}` has no parameter `{name}`");
        let at = "no parameter";
        let mut diagnostic = Diagnostic::error(Code::WrongArgument, named.span, message, at);
        let names = parameters.iter().map(|parameter| parameter.name.as_str());
        if let Some(meant) = self.reports.meant(name, names.clone()) {
            diagnostic = diagnostic.did_you_mean(named.span, meant);
        } else if !parameters.is_empty() {
            let names: Vec<&str> = names.collect();
            diagnostic = diagnostic.with_note(format!("it has {}", names.join(", ")));
        }
        self.reports.add(diagnostic);
    }

    fn report_order(&mut self, argument: &Argument<'s>, named: Option<Span>) {
        let span = argument.value.span;
        let message = "an argument without a name stands before those with one".to_owned();
        let mut diagnostic = Diagnostic::error(Code::WrongArgument, span, message, "has no name");
        if let Some(first) = named {
            diagnostic = diagnostic.with_label(first, "the first with a name");
        }
        self.reports.add(diagnostic.with_help("write the name of its parameter before it"));
    }

    fn report_argument_count(
        &mut self,
        name: Name<'s>,
        callee: FunctionId,
        parameters: &[Parameter],
        given: usize,
        span: Span,
    ) {
        let needed = parameters.iter().filter(|parameter| parameter.default.is_none()).count();
        let most = parameters.len();
        let plural = if most == 1 { "" } else { "s" };
        let takes = if needed == most { most.to_string() } else { format!("{needed} to {most}") };
        let message = format!("`{}` takes {takes} argument{plural}", name.value);
        let declared = self.signatures[callee.index()].named;
        let diagnostic =
            Diagnostic::error(Code::ArgumentCount, span, message, format!("given {given}"))
                .with_label(declared, "declared here");
        self.reports.add(diagnostic);
    }

    /// The actions of the program with their parameters.
    pub(super) fn actions(&self, program: &ast::Program<'s>) -> Vec<parameters::Action> {
        let action = |item: &ast::Item<'s>| {
            let ast::Item::Sequence(sequence) = item else { return None };
            let id = self.function_named(sequence.name).filter(|_| sequence.is_action)?;
            let known = self.signatures[id.index()].parameters.iter().map(described).collect();
            Some(parameters::Action { name: sequence.name.value.to_owned(), parameters: known })
        };
        program.items.iter().filter_map(action).collect()
    }
}

/// Another value in the place of a default, in the unit of its type.
fn in_place_of(default: Expression, other: f64) -> Expression {
    let kind = match (&default.kind, unit_of(default.of_type)) {
        (ExpressionKind::Int(_), _) => ExpressionKind::Int(other as i64),
        (ExpressionKind::Real(_), Some(unit)) => ExpressionKind::Real(to_si(other, unit)),
        _ => default.kind,
    };
    Expression { kind, ..default }
}

/// `least <= value and value <= most`
fn within(range: &Range, local: LocalId, of_type: ValueType) -> Expression {
    let span = range.span;
    let compare = match of_type {
        ValueType::Int => Instr::IntLe {},
        _ => Instr::RealLe {},
    };
    let value = Expression::local(local, of_type, span);
    let above = binary(compare, range.least.clone(), value.clone(), ValueType::Bool, span);
    let below = binary(compare, value, range.most.clone(), ValueType::Bool, span);
    binary(Instr::BoolAnd {}, above, below, ValueType::Bool, span)
}

fn described(parameter: &Parameter) -> parameters::Parameter {
    let unit = unit_of(parameter.of_type).unwrap_or("");
    let number = |value: &Expression| match value.kind {
        ExpressionKind::Int(value) => Some(value as f64),
        ExpressionKind::Real(value) => Some(of_si(value, unit)),
        _ => None,
    };
    let range = parameter.range.as_ref();
    parameters::Parameter {
        name: parameter.name.clone(),
        type_name: name_of(parameter.of_type),
        unit,
        is_integer: parameter.of_type == ValueType::Int,
        range: range.and_then(|range| Some([number(&range.least)?, number(&range.most)?])),
        default: parameter.default.as_ref().and_then(number),
        is_left_to_default: parameter.is_left_to_default,
    }
}
