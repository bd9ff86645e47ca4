//! Statements but for control: each does one thing, after the state has been kept.

use super::expression::reads_outside;
use super::value::{Value, binary};
use super::{Frame, Interpreter, Run, Trap};
use crate::reference::control::Flow;
use obverse_syntax::ast::{
    Argument, AssignOperator, BinaryOperator, Block, Expression, IoOperation, Item, Primitive,
    Sequence, SpeedWord, Statement, StatementKind, ValueRange, VariableDeclaration,
};
use obverse_workcell::Speed;

/// How often an input is looked at while it is waited for, in seconds.
const POLL_S: f64 = 0.01;

impl<'p> Interpreter<'p, '_> {
    /// The whole program.
    pub(super) fn program(&mut self) -> Run<()> {
        self.first_values()?;
        match self.names.main {
            Some(main) => self.begin(main)?,
            None => return Ok(()),
        }
        self.clean_up()
    }

    /// The variables of the program get their first values.
    pub(super) fn first_values(&mut self) -> Run<()> {
        self.globals.clear();
        for item in &self.program.items {
            if let Item::Variable(variable) = item {
                let value = self.first_value(variable)?;
                self.globals.push((variable.name.value, value));
            }
        }
        Ok(())
    }

    /// The value that a variable begins with.
    fn first_value(&mut self, variable: &VariableDeclaration<'p>) -> Run<Value> {
        let value = self.value(&variable.value)?;
        Ok(variable.type_name.map_or(value, |type_name| value.declared(type_name.value)))
    }

    /// What a call gives to each parameter: by position, by name, or its default.
    pub(super) fn bound(&mut self, callee: &str, arguments: &'p [Argument<'p>]) -> Run<Vec<Value>> {
        let values: Vec<&Expression<'p>> = arguments.iter().map(|one| &one.value).collect();
        let values = self.all_values(&values)?;
        let given = |name: &str, position: usize| {
            let is_it = |(index, argument): (usize, &Argument<'_>)| match argument.name {
                Some(named) => named.value == name,
                None => index == position,
            };
            arguments.iter().enumerate().position(is_it)
        };
        let Some(sequence) = self.names.sequences.get(callee).copied() else {
            return Ok(values);
        };
        let mut bound = Vec::new();
        for (position, parameter) in sequence.parameters.iter().enumerate() {
            let value = match (given(parameter.name.value, position), &parameter.default) {
                (Some(index), _) => values[index],
                (None, Some(default)) => self.value(default)?,
                (None, None) => continue,
            };
            bound.push(value);
        }
        Ok(bound)
    }

    /// Whether what a parameter is given lies in its range.
    fn is_in_range(&mut self, range: &'p ValueRange<'p>, value: Value) -> Run<bool> {
        let (least, most) = (self.value(&range.least)?, self.value(&range.most)?);
        Ok(match (least, value, most) {
            (Value::Int(least), Value::Int(value), Value::Int(most)) => {
                least <= value && value <= most
            }
            _ => least.real() <= value.real() && value.real() <= most.real(),
        })
    }

    /// Call a sequence or an action.
    pub(super) fn call(&mut self, sequence: &'p Sequence<'p>, arguments: &[Value]) -> Run<Flow> {
        let parameters = sequence.parameters.iter().zip(arguments);
        let parameters = parameters.map(|(parameter, value)| {
            (parameter.name.value, value.declared(parameter.type_name.value))
        });
        let frame = Frame {
            function: sequence.name.value,
            locals: parameters.collect(),
            ..Frame::default()
        };
        self.within(frame, |interpreter| {
            for (parameter, value) in sequence.parameters.iter().zip(arguments) {
                if let Some(range) = &parameter.range
                    && !interpreter.is_in_range(range, *value)?
                {
                    return Err(Trap::Required.into());
                }
            }
            interpreter.body(&sequence.body)
        })
    }

    /// Do something in a frame of its own. Settings that are changed in it hold to its end.
    pub(super) fn within<T>(
        &mut self,
        frame: Frame<'p>,
        run: impl FnOnce(&mut Self) -> Run<T>,
    ) -> Run<T> {
        if self.frames.len() >= super::MAX_CALLS {
            return Err(Trap::CallDepth.into());
        }
        if self.frames.len() >= self.limits.calls {
            return Err(super::Halt(super::Ending::Limit));
        }
        let settings = (self.speed, self.tool);
        self.frames.push(frame);
        let result = run(self)?;
        self.frames.pop();
        (self.speed, self.tool) = settings;
        Ok(result)
    }

    /// An I/O operation: its primitives in order.
    fn io(&mut self, io: &'p IoOperation<'p>) -> Run<()> {
        let frame = Frame { function: io.name.value, ..Frame::default() };
        self.within(frame, |interpreter| {
            for (index, primitive) in io.primitives.iter().enumerate() {
                let before = &io.primitives[..index];
                let after = &io.primitives[index + 1..];
                interpreter.primitive(primitive, before.iter().rev(), after.iter())?;
            }
            Ok(())
        })
    }

    /// A primitive, given those before it (the nearest first) and after it in the same block. A
    /// `sleep` right after an output, or after another such `sleep`, is the settling time of that
    /// output, and done with it.
    pub(super) fn primitive<'a>(
        &mut self,
        primitive: &'a Primitive<'p>,
        before: impl Iterator<Item = &'a Primitive<'p>>,
        after: impl Iterator<Item = &'a Primitive<'p>>,
    ) -> Run<()>
    where
        'p: 'a,
    {
        let (bit, level) = match primitive {
            Primitive::Sleep { duration, span } => {
                return match is_settling(primitive, before) {
                    true => Ok(()),
                    false => {
                        self.step()?;
                        self.remember_state(*span);
                        self.wait(duration)
                    }
                };
            }
            Primitive::Set { bit, high, .. } => (bit.value, Some(*high)),
            Primitive::Toggle { bit, .. } => (bit.value, None),
        };
        let (Primitive::Set { span, .. }
        | Primitive::Toggle { span, .. }
        | Primitive::Sleep { span, .. }) = primitive;
        self.step()?;
        self.remember_state(*span);
        let bit = self.names.line(bit);
        let mut settle_s: Option<f64> = None;
        for duration in after.map_while(settling_time) {
            let time_s = self.value(duration)?.real();
            settle_s = Some(settle_s.map_or(time_s, |before_s| before_s + time_s));
        }
        let level = level.unwrap_or_else(|| !self.cell.output(bit));
        self.cell.set_output(bit, level)?;
        self.cell.wait(settle_s.unwrap_or(0.0))?;
        Ok(())
    }

    /// A statement that neither branches nor loops nor leaves.
    pub(super) fn simple(&mut self, statement: &'p Statement<'p>) -> Run<()> {
        match &statement.kind {
            StatementKind::Move { target, linear, .. } => self.motion(target, *linear),
            StatementKind::Io(name) => match self.names.io.get(name.value) {
                Some(io) => self.io(io),
                None => Ok(()),
            },
            StatementKind::Wait(duration) => self.wait(duration),
            StatementKind::Variable(variable) => {
                let value = self.first_value(variable)?;
                self.frame_mut().locals.insert(variable.name.value, value);
                Ok(())
            }
            StatementKind::Remember(name) => {
                let joints = self.cell.joints();
                self.frame_mut().positions.insert(name.value, joints);
                Ok(())
            }
            StatementKind::Assign { name, operator, value } => {
                self.assign(name.value, *operator, value)
            }
            // Going forward, these are nothing.
            StatementKind::Checkpoint(_) | StatementKind::Barrier(_) => Ok(()),
            _ => Ok(()),
        }
    }

    fn wait(&mut self, duration: &Expression<'p>) -> Run<()> {
        let duration_s = self.value(duration)?.real();
        Ok(self.cell.wait(duration_s)?)
    }

    fn assign(
        &mut self,
        name: &'p str,
        operator: AssignOperator,
        written: &Expression<'p>,
    ) -> Run<()> {
        let value = self.value(written)?;
        let local = self.frame().locals.get(name).copied();
        let index = self.globals.iter().position(|(global, _)| *global == name);
        let global = index.map(|index| self.globals[index].1);
        let Some(former) = local.or(global) else { return Ok(()) };
        let value = match operator {
            AssignOperator::Set => value.like(former),
            AssignOperator::Add => binary(BinaryOperator::Add, former, value)?,
            AssignOperator::Subtract => binary(BinaryOperator::Subtract, former, value)?,
        };
        match (local, index) {
            (None, Some(index)) => self.globals[index].1 = value,
            _ => _ = self.frame_mut().locals.insert(name, value),
        }
        Ok(())
    }

    /// Wait for an input; what is to be done if it does not come.
    pub(super) fn wait_until(
        &mut self,
        (bit, high): (u16, bool),
        timeout: &Expression<'p>,
        otherwise: Option<&'p Block<'p>>,
    ) -> Run<Option<&'p Block<'p>>> {
        let longest_s = self.value(timeout)?.real();
        let looks = (longest_s / POLL_S).ceil();
        let mut looked = 0.0;
        while self.cell.input(bit)? != high {
            self.step()?;
            if looked >= looks || looks.is_nan() {
                return Ok(otherwise);
            }
            let left_s = longest_s - looked * POLL_S;
            looked += 1.0;
            self.cell.wait(left_s.clamp(0.0, POLL_S))?;
        }
        Ok(None)
    }

    /// A tool of the workcell by its number.
    pub(super) fn tool_number(&self, name: &str) -> u16 {
        self.cell.tool(name).map_or(u16::MAX, |tool| tool.0)
    }
}

/// The time of a `sleep` that can be the settling time of an output before it.
fn settling_time<'a, 'p>(primitive: &'a Primitive<'p>) -> Option<&'a Expression<'p>> {
    match primitive {
        Primitive::Sleep { duration, .. } if !reads_outside(duration) => Some(duration),
        _ => None,
    }
}

/// Whether a `sleep` is done with an output before it.
fn is_settling<'a, 'p: 'a>(
    primitive: &Primitive<'p>,
    before: impl Iterator<Item = &'a Primitive<'p>>,
) -> bool {
    if settling_time(primitive).is_none() {
        return false;
    }
    let mut before = before.skip_while(|primitive| settling_time(primitive).is_some());
    matches!(before.next(), Some(Primitive::Set { .. } | Primitive::Toggle { .. }))
}

/// The speed of a word.
pub(super) fn speed(word: SpeedWord) -> Speed {
    match word {
        SpeedWord::VerySlow => Speed::VerySlow,
        SpeedWord::Slow => Speed::Slow,
        SpeedWord::Normal => Speed::Normal,
        SpeedWord::Fast => Speed::Fast,
        SpeedWord::VeryFast => Speed::VeryFast,
    }
}
