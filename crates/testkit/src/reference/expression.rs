//! Expressions: first what they read of the outside, from left to right, and then their value.

use super::value::{Value, binary, function, si, unary};
use super::{Interpreter, Run, Trap};
use obverse_syntax::ast::{Expression, ExpressionKind};
use obverse_syntax::span::Span;
use std::collections::BTreeMap;

/// What has been read for a statement, by the place of the reading in the source.
pub(super) type Readings = BTreeMap<Span, Value>;

/// The value of an expression whose readings have been taken.
///
/// # Errors
/// If it has none.
pub(super) fn evaluate(
    expression: &Expression<'_>,
    variable: &dyn Fn(&str) -> Option<Value>,
    readings: &Readings,
) -> Result<Value, Trap> {
    let value = |expression| evaluate(expression, variable, readings);
    // No checked program needs it.
    let unknown = Value::Int(0);
    Ok(match &expression.kind {
        ExpressionKind::Integer(value) => Value::Int(*value),
        ExpressionKind::Real(value) => Value::Real(*value),
        ExpressionKind::Quantity { value, unit } => Value::Real(si(*value, unit.value)),
        ExpressionKind::Boolean(value) => Value::Bool(*value),
        ExpressionKind::Name(name) => variable(name).unwrap_or(unknown),
        ExpressionKind::Unary { operator, operand } => unary(*operator, value(operand)?),
        ExpressionKind::Binary { operator, left, right } => {
            binary(*operator, value(left)?, value(right)?)?
        }
        ExpressionKind::Function { name, arguments } => {
            let values: Result<Vec<Value>, Trap> = arguments.iter().map(value).collect();
            match (name.value, values?.as_slice()) {
                ("random", [low, high]) => {
                    let draw = readings.get(&expression.span).copied().unwrap_or(unknown).real();
                    Value::Real(low.real() + draw * (high.real() - low.real()))
                }
                (name, values) => function(name, values)?,
            }
        }
        ExpressionKind::Input(_)
        | ExpressionKind::Force
        | ExpressionKind::Distance
        | ExpressionKind::Holding => readings.get(&expression.span).copied().unwrap_or(unknown),
        ExpressionKind::Missing => unknown,
    })
}

/// Whether an expression reads something outside the program, or draws a random number.
pub(super) fn reads_outside(expression: &Expression<'_>) -> bool {
    match &expression.kind {
        ExpressionKind::Input(_)
        | ExpressionKind::Force
        | ExpressionKind::Distance
        | ExpressionKind::Holding => true,
        ExpressionKind::Unary { operand, .. } => reads_outside(operand),
        ExpressionKind::Binary { left, right, .. } => reads_outside(left) || reads_outside(right),
        ExpressionKind::Function { name, arguments } => {
            name.value == "random" || arguments.iter().any(reads_outside)
        }
        _ => false,
    }
}

impl<'p> Interpreter<'p, '_> {
    /// The value of an expression, with its readings.
    pub(super) fn value(&mut self, expression: &Expression<'p>) -> Run<Value> {
        Ok(self.values([expression])?[0])
    }

    /// The values of the expressions of one statement: all readings come before all values.
    pub(super) fn values<const COUNT: usize>(
        &mut self,
        expressions: [&Expression<'p>; COUNT],
    ) -> Run<[Value; COUNT]> {
        let mut readings = Readings::new();
        for expression in expressions {
            self.read(expression, &mut readings)?;
        }
        let mut values = [Value::Int(0); COUNT];
        for (value, expression) in values.iter_mut().zip(expressions) {
            *value = self.evaluate(expression, &readings)?;
        }
        Ok(values)
    }

    /// The same for any number of them.
    pub(super) fn all_values(&mut self, expressions: &[&Expression<'p>]) -> Run<Vec<Value>> {
        let mut readings = Readings::new();
        for expression in expressions {
            self.read(expression, &mut readings)?;
        }
        expressions.iter().map(|expression| self.evaluate(expression, &readings)).collect()
    }

    fn evaluate(&self, expression: &Expression<'p>, readings: &Readings) -> Run<Value> {
        Ok(evaluate(expression, &|name| self.variable(name), readings)?)
    }

    /// What a name stands for.
    pub(super) fn variable(&self, name: &str) -> Option<Value> {
        let frame = self.frame();
        let counter = frame.counters.iter().rev().find(|counter| counter.name == Some(name));
        let global = self.globals.iter().find(|(global, _)| *global == name);
        frame
            .locals
            .get(name)
            .copied()
            .or(counter.map(|counter| Value::Int(counter.count)))
            .or(global.map(|(_, value)| *value))
            .or_else(|| self.names.value(name))
    }

    /// Take the readings of an expression, from left to right.
    fn read(&mut self, expression: &Expression<'p>, readings: &mut Readings) -> Run<()> {
        let reading = match &expression.kind {
            ExpressionKind::Unary { operand, .. } => return self.read(operand, readings),
            ExpressionKind::Binary { left, right, .. } => {
                self.read(left, readings)?;
                return self.read(right, readings);
            }
            ExpressionKind::Function { name, arguments } => {
                for argument in arguments {
                    self.read(argument, readings)?;
                }
                match (name.value, arguments.first()) {
                    ("random", Some(low)) => self.draw(low, readings)?,
                    _ => return Ok(()),
                }
            }
            ExpressionKind::Input(line) => {
                Value::Bool(self.cell.input(self.names.line(line.value))?)
            }
            ExpressionKind::Force => Value::Real(match self.judged {
                Some(report) => report.peak_force_n,
                None => self.cell.force_n(),
            }),
            ExpressionKind::Distance => Value::Real(match self.judged {
                Some(report) => report.distance_m,
                None => self.cell.last_motion().distance_m,
            }),
            ExpressionKind::Holding => Value::Bool(self.cell.held().is_some()),
            _ => return Ok(()),
        };
        readings.insert(expression.span, reading);
        Ok(())
    }

    /// A random number of [0, 1). The lower bound is known before it is drawn.
    fn draw(&mut self, low: &Expression<'p>, readings: &Readings) -> Run<Value> {
        self.evaluate(low, readings)?;
        let drawn = self.cell.draw(self.draws);
        self.draws = self.draws.wrapping_add(1);
        Ok(Value::Real(drawn))
    }
}
