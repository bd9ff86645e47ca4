//! Variables: their updates, and where the inverse declares them with which value.

use super::block::{Emitted, Inverter};
use super::effect::{Effect, constant};
use super::refusal::refusal;
use super::walk;
use obverse_syntax::ast::{
    AssignOperator, Expression, Name, Statement, StatementKind, VariableDeclaration,
};
use obverse_syntax::span::Span;
use std::collections::HashMap;
use std::ops::Range;

/// A variable of a block: the statements from after its declaration to its last use.
pub(super) type Scope<'p> = (Range<usize>, &'p VariableDeclaration<'p>);

impl<'p> Inverter<'p> {
    /// The variables that a block declares. Each must be declared right before the statement that
    /// first uses it: that is where the inverse of an inverse has it.
    pub(super) fn variables(&mut self, statements: &'p [Statement<'p>]) -> Vec<Scope<'p>> {
        let mut uses: HashMap<&str, Range<usize>> = HashMap::new();
        for (index, statement) in statements.iter().enumerate() {
            for name in walk::mentioned(statement) {
                uses.entry(name).or_insert(index..index).end = index;
            }
        }
        let is_declaration =
            |statement: &Statement<'p>| matches!(statement.kind, StatementKind::Variable(_));
        let mut scopes = Vec::new();
        let mut next_other = statements.len();
        for (index, statement) in statements.iter().enumerate().rev() {
            if !is_declaration(statement) {
                next_other = index;
            }
            let StatementKind::Variable(variable) = &statement.kind else { continue };
            match uses.get(variable.name.value) {
                Some(used) if used.start <= next_other => {
                    scopes.push((index + 1..used.end + 1, variable));
                }
                used => {
                    let first = used.and_then(|used| statements.get(used.start));
                    self.refuse_early_declaration(variable, first.map(|first| first.span));
                }
            }
        }
        scopes.reverse();
        scopes
    }

    fn refuse_early_declaration(
        &mut self,
        variable: &VariableDeclaration<'p>,
        first_use: Option<Span>,
    ) {
        let name = variable.name.value;
        let message = format!("`{name}` is declared before it is needed");
        let why = "an inverse declares it right before its first use";
        let diagnostic = refusal(variable.span, &message, why);
        self.refuse(match first_use {
            Some(first) => diagnostic
                .with_label(first, "first used here")
                .with_help("move the declaration to right before that"),
            None => diagnostic.with_help("leave it out: nothing uses it"),
        });
    }

    /// The declaration of a variable in the inverse: with the value that it has after its last
    /// use, where the inverse begins to use it. `scope` is what may change it.
    pub(super) fn declaration(
        &mut self,
        scope: &[Statement<'p>],
        variable: &'p VariableDeclaration<'p>,
    ) -> Option<Emitted<'p>> {
        self.require_pure(&variable.value);
        let name = variable.name.value;
        let inputs = walk::names_of(&variable.value);
        let mut assigned = None;
        let mut input_changed = None;
        for statement in scope {
            let effect = Effect::of_statement(statement, self.plan);
            if effect.changes(name) {
                assigned = assigned.or(Some(statement.span));
            }
            if effect.changes_any(&inputs) {
                input_changed = input_changed.or(Some(statement.span));
            }
        }
        let value = match (assigned, input_changed) {
            (None, None) => Some(variable.value.clone()),
            (Some(_), _) if constant(&variable.value, self.plan).is_some() => {
                self.facts.constant(name).cloned()
            }
            _ => None,
        };
        let Some(value) = value else {
            self.refuse_unknown_end(variable, assigned.or(input_changed));
            return None;
        };
        let declaration = VariableDeclaration { value, ..variable.clone() };
        Some(Emitted::new(StatementKind::Variable(declaration), variable.span))
    }

    fn refuse_unknown_end(&mut self, variable: &VariableDeclaration<'p>, changed: Option<Span>) {
        let name = variable.name.value;
        let message = format!("what `{name}` is at its end is not known");
        let why = "the inverse begins with the value that this ends with";
        let mut diagnostic = refusal(variable.span, &message, why);
        if let Some(span) = changed {
            diagnostic = diagnostic.with_label(span, "it may change here");
        }
        self.refuse(diagnostic.with_help(
            "a loop that ends at a known value is written `while n != 3 entered when n == 0`",
        ));
    }

    /// `n += e` is undone by `n -= e`, where `n` is an integer; `x = 5` by what `x` was, if that is
    /// known.
    pub(super) fn assign(
        &mut self,
        name: Name<'p>,
        operator: AssignOperator,
        value: &'p Expression<'p>,
        span: Span,
    ) -> Option<Emitted<'p>> {
        self.require_pure(value);
        let is_parameter = self.parameters.contains(&name.value);
        if is_parameter {
            let message = "a parameter that is changed has no inverse";
            let why = "whoever calls the inverse would have to give its last value";
            self.refuse(
                refusal(span, message, why)
                    .with_help("declare a variable with the value of the parameter"),
            );
        }
        let operator = match operator {
            AssignOperator::Set => return self.assign_former(name, value, span),
            AssignOperator::Add => AssignOperator::Subtract,
            AssignOperator::Subtract => AssignOperator::Add,
        };
        if !self.plan.checked.is_integer(self.name, name.value) {
            let message = "an update of a real has no exact inverse";
            let why = format!("`{}` would come back rounded", name.value);
            self.refuse(refusal(span, message, &why).with_help(
                "keep an `int` counter and multiply: `n += 1`, and `real(n) * 0.2 mm` where it \
                 is needed",
            ));
        }
        if walk::names_of(value).contains(&name.value) {
            let message = "a variable that is updated by its own value has no inverse";
            let why = format!("once `{}` has changed, this is no longer known", name.value);
            self.refuse(
                refusal(value.span, message, &why)
                    .with_help("keep the amount in a variable, and update by that"),
            );
        }
        let kind = StatementKind::Assign { name, operator, value: value.clone() };
        Some(Emitted::new(kind, span))
    }

    fn assign_former(
        &mut self,
        name: Name<'p>,
        value: &Expression<'p>,
        span: Span,
    ) -> Option<Emitted<'p>> {
        let former = self.facts.constant(name.value).cloned();
        match former.filter(|_| constant(value, self.plan).is_some()) {
            Some(value) => {
                let operator = AssignOperator::Set;
                Some(Emitted::new(StatementKind::Assign { name, operator, value }, span))
            }
            None => {
                let message = format!("what `{}` was before is not known", name.value);
                let why = "this overwrites a value that the inverse would need";
                self.refuse(refusal(span, &message, why).with_help(
                    "use `+=` or `-=`, or assign what is written out as a number, here and before",
                ));
                None
            }
        }
    }
}
