//! What is known of outputs and variables at a place, and what statements change of it: constant
//! propagation over the syntax tree, as far as the former level of an output or the former value of
//! a variable is asked for. It knows nothing of inverses.

use obverse_syntax::ast::{
    AssignOperator, BinaryOperator, Block, Expression, ExpressionKind, IoOperation, Primitive,
    Signal, Statement, StatementKind, UnaryOperator,
};
use obverse_syntax::format::print_expression;
use obverse_syntax::span::Span;
use std::collections::BTreeMap;

/// Something that has one value at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Key<'s> {
    Output(u64),
    Variable(&'s str),
}

/// A value that is known before the program runs.
#[derive(Clone, Debug)]
pub(super) enum Value<'s> {
    Level(bool),
    /// A literal, or the name of a joint configuration.
    Constant(Expression<'s>),
}

impl PartialEq for Value<'_> {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Level(a), Self::Level(b)) => a == b,
            (Self::Constant(a), Self::Constant(b)) => print_expression(a) == print_expression(b),
            _ => false,
        }
    }
}

/// What is known at a place; the others may have any value.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Facts<'s>(BTreeMap<Key<'s>, Value<'s>>);

/// What becomes of something.
#[derive(Clone, Debug, PartialEq)]
enum Change<'s> {
    Set(Value<'s>),
    /// Set on some ways, and left alone on the others.
    SetOrKept(Value<'s>),
    /// An integer is added to.
    Added(i64),
    /// The other level.
    Flipped,
    Unknown,
}

/// What statements change.
#[derive(Clone, Debug, Default)]
pub(super) struct Effect<'s> {
    changes: BTreeMap<Key<'s>, Change<'s>>,
    /// Whether they may change anything else as well.
    is_open: bool,
}

/// What declarations say about names.
pub(super) trait Declared<'s> {
    /// The I/O operation of this name.
    fn io(&self, name: &str) -> Option<&IoOperation<'s>>;

    /// What a call changes of outputs and of the variables of the program.
    fn effect_of_call(&self, name: &str) -> Effect<'s>;

    /// The number of an output in the workcell.
    fn number(&self, output: Signal<'_>) -> u64;

    /// Whether a name is that of a joint configuration.
    fn is_joints(&self, name: &str) -> bool;
}

impl<'s> Facts<'s> {
    pub(super) fn get(&self, key: Key<'s>) -> Option<&Value<'s>> {
        self.0.get(&key)
    }

    /// The level of an output.
    pub(super) fn level(&self, output: Signal<'_>, declared: &impl Declared<'s>) -> Option<bool> {
        match self.get(Key::Output(declared.number(output))) {
            Some(Value::Level(level)) => Some(*level),
            _ => None,
        }
    }

    pub(super) fn constant(&self, name: &'s str) -> Option<&Expression<'s>> {
        match self.get(Key::Variable(name)) {
            Some(Value::Constant(value)) => Some(value),
            _ => None,
        }
    }

    pub(super) fn set(&mut self, key: Key<'s>, value: Value<'s>) {
        self.0.insert(key, value);
    }

    /// What is known here and there.
    pub(super) fn meet(&mut self, other: &Self) {
        self.0.retain(|key, value| other.0.get(key) == Some(value));
    }

    /// After something that has this effect.
    pub(super) fn apply(&mut self, effect: &Effect<'s>) {
        if effect.is_open {
            self.0.clear();
        }
        for (key, change) in &effect.changes {
            match change {
                Change::Set(value) => self.set(*key, value.clone()),
                Change::SetOrKept(value) if self.get(*key) == Some(value) => {}
                Change::SetOrKept(_) | Change::Unknown => _ = self.0.remove(key),
                Change::Added(_) | Change::Flipped => {
                    let value = self.0.remove(key);
                    if let Some(value) = value.and_then(|value| change.of_value(&value)) {
                        self.set(*key, value);
                    }
                }
            }
        }
    }

    /// What of it is known in every sequence: of outputs, and of the variables of the program.
    pub(super) fn of_program(mut self, is_global: impl Fn(&str) -> bool) -> Self {
        self.0.retain(|key, _| match key {
            Key::Output(_) => true,
            Key::Variable(name) => is_global(name),
        });
        self
    }

    /// Where the blocks of a statement begin: each time, if it is a loop.
    pub(super) fn at_head(&mut self, statement: &Statement<'s>, declared: &impl Declared<'s>) {
        if let StatementKind::While { body, .. }
        | StatementKind::Repeat { body, .. }
        | StatementKind::For { body, .. }
        | StatementKind::Loop(body) = &statement.kind
        {
            self.apply(&Effect::of_block(body, declared).or(&Effect::default()));
        }
    }

    /// After a statement.
    pub(super) fn after(&mut self, statement: &Statement<'s>, declared: &impl Declared<'s>) {
        self.apply(&Effect::of_statement(statement, declared));
    }

    /// After a primitive of an I/O operation.
    pub(super) fn after_primitive(
        &mut self,
        primitive: &Primitive<'s>,
        declared: &impl Declared<'s>,
    ) {
        self.apply(&Effect::of_primitive(primitive, declared));
    }
}

impl<'s> Change<'s> {
    /// What becomes of a value, if that can be said.
    fn of_value(&self, value: &Value<'s>) -> Option<Value<'s>> {
        match (self, value) {
            (Self::Set(value), _) => Some(value.clone()),
            (Self::SetOrKept(set), value) if set == value => Some(value.clone()),
            (Self::Added(by), Value::Constant(value)) => {
                literal(integer(value)?.checked_add(*by)?, value.span).map(Value::Constant)
            }
            (Self::Flipped, Value::Level(level)) => Some(Value::Level(!level)),
            _ => None,
        }
    }

    /// This, and then another.
    fn then(self, next: Self) -> Self {
        match (self, next) {
            (_, next @ (Self::Set(_) | Self::Unknown)) => next,
            (Self::Set(value), next) => next.of_value(&value).map_or(Self::Unknown, Self::Set),
            (Self::SetOrKept(a), Self::SetOrKept(b)) if a == b => Self::SetOrKept(a),
            (Self::Added(a), Self::Added(b)) => a.checked_add(b).map_or(Self::Unknown, Self::Added),
            _ => Self::Unknown,
        }
    }
}

impl<'s> Effect<'s> {
    /// Anything may be changed.
    pub(super) fn open() -> Self {
        Self { changes: BTreeMap::new(), is_open: true }
    }

    /// Whether this is changed, or may be.
    pub(super) fn changes(&self, name: &'s str) -> bool {
        self.is_open || self.changes.contains_key(&Key::Variable(name))
    }

    /// Whether any of these variables is.
    pub(super) fn changes_any(&self, names: &[&'s str]) -> bool {
        names.iter().any(|name| self.changes(name))
    }

    /// Whether an output is changed, or may be.
    pub(super) fn sets(&self, bit: u64) -> bool {
        self.is_open || self.changes.contains_key(&Key::Output(bit))
    }

    /// The variables that are changed.
    pub(super) fn variables(&self) -> impl Iterator<Item = &'s str> {
        self.changes.keys().filter_map(|key| match key {
            Key::Variable(name) => Some(*name),
            Key::Output(_) => None,
        })
    }

    /// Whether nothing can be said of what is changed.
    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Without what is changed of other variables than these.
    pub(super) fn of_variables(mut self, is_kept: impl Fn(&str) -> bool) -> Self {
        self.changes.retain(|key, _| match key {
            Key::Output(_) => true,
            Key::Variable(name) => is_kept(name),
        });
        self
    }

    /// That of a block.
    pub(super) fn of_block(block: &Block<'s>, declared: &impl Declared<'s>) -> Self {
        let mut effect = Self::default();
        for statement in &block.statements {
            effect.then(Self::of_statement(statement, declared));
        }
        effect
    }

    /// That of a statement.
    pub(super) fn of_statement(statement: &Statement<'s>, declared: &impl Declared<'s>) -> Self {
        match &statement.kind {
            StatementKind::Io(name) => {
                let io = declared.io(name.value);
                let counterpart = io.and_then(|io| io.counterpart);
                let counterpart = counterpart.and_then(|other| declared.io(other.value));
                match counterpart {
                    Some(_) => Self::of_io(io, declared).either(Self::of_io(counterpart, declared)),
                    None => Self::of_io(io, declared),
                }
            }
            StatementKind::Primitive(primitive) => Self::of_primitive(primitive, declared),
            StatementKind::Call { name, .. } => declared.effect_of_call(name.value),
            StatementKind::Variable(variable) => {
                Self::one(variable.name.value, constant(&variable.value, declared))
            }
            StatementKind::Assign { name, operator: AssignOperator::Set, value } => {
                Self::one(name.value, constant(value, declared))
            }
            StatementKind::Assign { name, operator, value } => {
                let by = integer(value).and_then(|by| match operator {
                    AssignOperator::Subtract => by.checked_neg(),
                    AssignOperator::Set | AssignOperator::Add => Some(by),
                });
                let change = by.map_or(Change::Unknown, Change::Added);
                Self::only(Key::Variable(name.value), change)
            }
            StatementKind::If { then, otherwise, .. } => {
                let otherwise = otherwise.as_ref().map(|block| Self::of_block(block, declared));
                Self::of_block(then, declared).or(&otherwise.unwrap_or_default())
            }
            StatementKind::While { condition, body, .. } => {
                let mut effect = Self::of_block(body, declared).or(&Self::default());
                if let Some((name, value)) = left_at(condition, declared)
                    && !effect.is_open
                {
                    effect.changes.insert(Key::Variable(name), Change::Set(Value::Constant(value)));
                }
                effect
            }
            StatementKind::Repeat { body, .. } | StatementKind::For { body, .. } => {
                Self::of_block(body, declared).or(&Self::default())
            }
            StatementKind::WaitUntil { otherwise, .. } => {
                let otherwise = otherwise.as_ref().map(|block| Self::of_block(block, declared));
                otherwise.unwrap_or_default().or(&Self::default())
            }
            StatementKind::Speed { block, .. } | StatementKind::Tool { block, .. } => {
                block.as_ref().map(|block| Self::of_block(block, declared)).unwrap_or_default()
            }
            StatementKind::Irreversible { block, .. } => Self::of_block(block, declared),
            StatementKind::SkipInReverse(block) => {
                Self::of_block(block, declared).either(Self::default())
            }
            StatementKind::ReplaceInReverse { block, replacement } => {
                Self::of_block(block, declared).either(Self::of_block(replacement, declared))
            }
            StatementKind::KeepInReverse(block) => {
                Self::of_block(block, declared).either(Self::default())
            }
            StatementKind::WithInReverse { block, .. } => Self::of_block(block, declared),
            // Branches change nothing that another one does.
            StatementKind::Fork(branches) => {
                let mut effect = Self::default();
                branches.iter().for_each(|branch| effect.then(Self::of_block(branch, declared)));
                effect
            }
            // Statements behind these may be left out, and errors may have anything done.
            StatementKind::Loop(_)
            | StatementKind::Break
            | StatementKind::Return
            | StatementKind::Advance(_)
            | StatementKind::Throw(_)
            | StatementKind::Requires { .. } => Self::open(),
            StatementKind::Move { .. }
            | StatementKind::Wait(_)
            | StatementKind::Remember(_)
            | StatementKind::Checkpoint(_)
            | StatementKind::Barrier(_)
            | StatementKind::Allow(_) => Self::default(),
        }
    }

    /// That of an I/O operation.
    pub(super) fn of_io(io: Option<&IoOperation<'s>>, declared: &impl Declared<'s>) -> Self {
        let mut effect = Self::default();
        for primitive in io.iter().flat_map(|io| &io.primitives) {
            effect.then(Self::of_primitive(primitive, declared));
        }
        effect
    }

    fn of_primitive(primitive: &Primitive<'s>, declared: &impl Declared<'s>) -> Self {
        match primitive {
            Primitive::Set { bit, high, .. } => {
                let output = Key::Output(declared.number(bit.value));
                Self::only(output, Change::Set(Value::Level(*high)))
            }
            Primitive::Toggle { bit, .. } => {
                Self::only(Key::Output(declared.number(bit.value)), Change::Flipped)
            }
            Primitive::Sleep { .. } => Self::default(),
        }
    }

    fn one(name: &'s str, value: Option<Expression<'s>>) -> Self {
        let change = value.map_or(Change::Unknown, |value| Change::Set(Value::Constant(value)));
        Self::only(Key::Variable(name), change)
    }

    fn only(key: Key<'s>, change: Change<'s>) -> Self {
        Self { changes: BTreeMap::from([(key, change)]), is_open: false }
    }

    /// This, and then another.
    fn then(&mut self, next: Self) {
        self.is_open |= next.is_open;
        if next.is_open {
            self.changes.values_mut().for_each(|change| *change = Change::Unknown);
        }
        for (key, change) in next.changes {
            let joined = match self.changes.remove(&key) {
                Some(former) => former.then(change),
                None => change,
            };
            match joined {
                // There and back is no change.
                Change::Added(0) => {}
                joined => _ = self.changes.insert(key, joined),
            }
        }
    }

    /// What has one effect going forward and another in reverse: what either changes is not known,
    /// so that nothing is known of a sequence that is not known of its inverse.
    fn either(mut self, other: Self) -> Self {
        self.changes.extend(other.changes);
        self.changes.values_mut().for_each(|change| *change = Change::Unknown);
        self.is_open |= other.is_open;
        self
    }

    /// This or another.
    fn or(mut self, other: &Self) -> Self {
        let keys: Vec<Key<'s>> = self.changes.keys().chain(other.changes.keys()).copied().collect();
        for key in keys {
            let joined = match (self.changes.get(&key), other.changes.get(&key)) {
                (Some(a), Some(b)) if a == b => continue,
                (Some(Change::Set(a) | Change::SetOrKept(a)), None)
                | (None, Some(Change::Set(a) | Change::SetOrKept(a))) => {
                    Change::SetOrKept(a.clone())
                }
                (
                    Some(Change::Set(a) | Change::SetOrKept(a)),
                    Some(Change::Set(b) | Change::SetOrKept(b)),
                ) if a == b => Change::SetOrKept(a.clone()),
                _ => Change::Unknown,
            };
            self.changes.insert(key, joined);
        }
        self.is_open |= other.is_open;
        self
    }
}

/// The value of an expression, if it is a literal or the name of a joint configuration.
pub(super) fn constant<'s>(
    expression: &Expression<'s>,
    declared: &impl Declared<'s>,
) -> Option<Expression<'s>> {
    let is_literal = match &expression.kind {
        ExpressionKind::Integer(_)
        | ExpressionKind::Real(_)
        | ExpressionKind::Quantity { .. }
        | ExpressionKind::Boolean(_) => true,
        ExpressionKind::Name(name) => declared.is_joints(name),
        ExpressionKind::Unary { operator: UnaryOperator::Negate, operand } => matches!(
            operand.kind,
            ExpressionKind::Integer(_) | ExpressionKind::Real(_) | ExpressionKind::Quantity { .. }
        ),
        _ => false,
    };
    is_literal.then(|| expression.clone())
}

/// What a variable must be when a loop with this condition is over: `while x != 3` ends at 3.
fn left_at<'s>(
    condition: &Expression<'s>,
    declared: &impl Declared<'s>,
) -> Option<(&'s str, Expression<'s>)> {
    match &condition.kind {
        ExpressionKind::Binary { operator: BinaryOperator::NotEqual, left, right } => {
            let ExpressionKind::Name(name) = left.kind else { return None };
            constant(right, declared).map(|value| (name, value))
        }
        _ => None,
    }
}

/// An integer as it is written.
fn literal<'s>(value: i64, span: Span) -> Option<Expression<'s>> {
    let literal = Expression { kind: ExpressionKind::Integer(value.checked_abs()?), span };
    Some(match value < 0 {
        false => literal,
        true => {
            let operand = Box::new(literal);
            let kind = ExpressionKind::Unary { operator: UnaryOperator::Negate, operand };
            Expression { kind, span }
        }
    })
}

fn integer(expression: &Expression<'_>) -> Option<i64> {
    match &expression.kind {
        ExpressionKind::Integer(value) => Some(*value),
        ExpressionKind::Unary { operator: UnaryOperator::Negate, operand } => match operand.kind {
            ExpressionKind::Integer(value) => value.checked_neg(),
            _ => None,
        },
        _ => None,
    }
}
