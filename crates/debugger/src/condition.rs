//! Conditions in a few words: `x > 3 and output 2`, `force > 5 N or not holding`.
//!
//! Their names are those of a place in a program. What is wrong with one is said with its place in
//! the text; a text and its nesting are bounded. Read `parse`, which makes them, beside this.

use crate::recording::Facts;
use crate::subject::{Look, Subject, Value, Wrong};
use crate::unit::Unit;
use obverse_bytecode::Module;

mod parse;
mod span;

/// Why a text is no condition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConditionError {
    /// Where in the text, in bytes.
    pub at: usize,
    /// What is wrong.
    pub why: String,
}

impl std::fmt::Display for ConditionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}, at column {}", self.why, self.at + 1)
    }
}

impl std::error::Error for ConditionError {}

/// What is worked out at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: String,
    root: Node,
    /// What it measures, if that is known.
    unit: Option<Unit>,
}

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Value(Value),
    Subject(Subject),
    Not(Box<Node>),
    Minus(Box<Node>),
    Two(Operator, Box<Node>, Box<Node>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Or,
    And,
    Equal,
    Unequal,
    Less,
    AtMost,
    More,
    AtLeast,
    Plus,
    Minus,
    Times,
    Over,
}

impl Expression {
    /// The expression of a text, whose names are those of a function.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn parse(module: &Module, function: usize, text: &str) -> Result<Self, ConditionError> {
        let (root, kind) = parse::parse(module, function, text)?;
        Ok(Self { text: text.trim().to_owned(), root, unit: kind.unit() })
    }

    /// The same, if it is true or false.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn condition(module: &Module, function: usize, text: &str) -> Result<Self, ConditionError> {
        let (root, kind) = parse::parse(module, function, text)?;
        if kind != parse::Kind::Bool {
            let why = "this is neither true nor false: compare it with something".to_owned();
            return Err(ConditionError { at: 0, why });
        }
        Ok(Self { text: text.trim().to_owned(), root, unit: None })
    }

    /// Of one thing.
    #[must_use]
    pub fn of(module: &Module, subject: Subject) -> Self {
        Self { text: subject.name(module), root: Node::Subject(subject), unit: None }
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What it is at a moment.
    #[must_use]
    pub fn value(&self, look: &Look<'_>) -> Value {
        match (self.root.value(look), self.unit) {
            (Value::Real(value), Some(unit)) => Value::Quantity(value, unit),
            (value, _) => value,
        }
    }

    /// Whether a workcell has the outputs and the inputs that it asks about.
    ///
    /// # Errors
    /// One that it has not, and which there are.
    pub fn check_lines(&self, facts: &Facts) -> Result<(), ConditionError> {
        for subject in self.subjects() {
            let (bit, kind, count) = match *subject {
                Subject::Output(bit) => (bit, "output", facts.outputs),
                Subject::Input(bit) => (bit, "input", facts.inputs),
                _ => continue,
            };
            if bit >= count {
                let why = match count {
                    0 => format!("the workcell has no {kind}s"),
                    1 => format!("there is no {kind} {bit}: the workcell has {kind} 0 alone"),
                    _ => format!(
                        "there is no {kind} {bit}: they are numbered from 0 to {}",
                        count - 1
                    ),
                };
                let at = self.text.find(&bit.to_string()).unwrap_or(0);
                return Err(ConditionError { at, why });
            }
        }
        Ok(())
    }

    /// Whether it is true at a moment.
    #[must_use]
    pub fn holds(&self, look: &Look<'_>) -> bool {
        self.value(look) == Value::Bool(true)
    }

    /// What it asks about.
    #[must_use]
    pub fn subjects(&self) -> Vec<&Subject> {
        let mut all = Vec::new();
        self.root.subjects(&mut all);
        all
    }
}

impl Node {
    fn subjects<'n>(&'n self, all: &mut Vec<&'n Subject>) {
        match self {
            Self::Value(_) => {}
            Self::Subject(subject) => all.push(subject),
            Self::Not(inner) | Self::Minus(inner) => inner.subjects(all),
            Self::Two(_, left, right) => {
                left.subjects(all);
                right.subjects(all);
            }
        }
    }

    fn value(&self, look: &Look<'_>) -> Value {
        match self {
            Self::Value(value) => value.clone(),
            Self::Subject(subject) => subject.read(look),
            Self::Not(inner) | Self::Minus(inner) => self.of_one(inner.value(look)),
            Self::Two(operator, left, right) => {
                let left = left.value(look);
                match (operator, &left) {
                    (Operator::Or, Value::Bool(true)) | (Operator::And, Value::Bool(false)) => left,
                    _ => operator.of(&left, &right.value(look)),
                }
            }
        }
    }
}

impl Node {
    /// What a node of one operand makes of it.
    fn of_one(&self, operand: Value) -> Value {
        match (self, operand) {
            (Self::Not(_), Value::Bool(value)) => Value::Bool(!value),
            (Self::Minus(_), Value::Int(value)) => integer(value.checked_neg()),
            (Self::Minus(_), Value::Real(value) | Value::Quantity(value, _)) => Value::Real(-value),
            (Self::Minus(_), Value::Unlimited) => Value::Real(f64::NEG_INFINITY),
            (_, Value::Wrong(why)) => Value::Wrong(why),
            _ => Value::Absent,
        }
    }
}

impl Operator {
    fn of(self, left: &Value, right: &Value) -> Value {
        match (left, right) {
            (Value::Wrong(why), _) | (_, Value::Wrong(why)) => Value::Wrong(*why),
            (Value::Absent, _) | (_, Value::Absent) => Value::Absent,
            (Value::Bool(left), Value::Bool(right)) => match self {
                Self::Or => Value::Bool(*left || *right),
                Self::And => Value::Bool(*left && *right),
                Self::Equal => Value::Bool(left == right),
                Self::Unequal => Value::Bool(left != right),
                _ => Value::Absent,
            },
            (Value::Name(left), Value::Name(right)) => match self {
                Self::Equal => Value::Bool(left == right),
                Self::Unequal => Value::Bool(left != right),
                _ => Value::Absent,
            },
            (Value::Int(left), Value::Int(right)) => self.of_integers(*left, *right),
            _ => match (real(left), real(right)) {
                (Some(left), Some(right)) => self.of_reals(left, right),
                _ => Value::Absent,
            },
        }
    }

    fn of_integers(self, left: i64, right: i64) -> Value {
        match self {
            Self::Plus => integer(left.checked_add(right)),
            Self::Minus => integer(left.checked_sub(right)),
            Self::Times => integer(left.checked_mul(right)),
            Self::Over if right == 0 => Value::Wrong(Wrong::DivisionByZero),
            Self::Over => integer(left.checked_div(right)),
            Self::Equal => Value::Bool(left == right),
            Self::Unequal => Value::Bool(left != right),
            Self::Less => Value::Bool(left < right),
            Self::AtMost => Value::Bool(left <= right),
            Self::More => Value::Bool(left > right),
            Self::AtLeast => Value::Bool(left >= right),
            Self::Or | Self::And => Value::Absent,
        }
    }

    fn of_reals(self, left: f64, right: f64) -> Value {
        match self {
            Self::Plus => Value::Real(left + right),
            Self::Minus => Value::Real(left - right),
            Self::Times => Value::Real(left * right),
            Self::Over => Value::Real(left / right),
            Self::Equal => Value::Bool(left == right),
            Self::Unequal => Value::Bool(left != right),
            Self::Less => Value::Bool(left < right),
            Self::AtMost => Value::Bool(left <= right),
            Self::More => Value::Bool(left > right),
            Self::AtLeast => Value::Bool(left >= right),
            Self::Or | Self::And => Value::Absent,
        }
    }
}

fn integer(value: Option<i64>) -> Value {
    value.map_or(Value::Wrong(Wrong::Overflow), Value::Int)
}

fn real(value: &Value) -> Option<f64> {
    match value {
        Value::Int(value) => Some(*value as f64),
        Value::Real(value) | Value::Quantity(value, _) => Some(*value),
        Value::Unlimited => Some(f64::INFINITY),
        _ => None,
    }
}
