//! The text of a condition: words, numbers with units, operators; and what type each part has.

use super::{ConditionError, Node, Operator};
use crate::subject::{NONE, Subject, Value, line, nearest_variable, variable};
use crate::unit::Unit;
use obverse_bytecode::Module;
use obverse_bytecode::text::nearest;
use obverse_isa::{ErrorId, Setting, SpeedId, Type};

/// The longest text, in bytes.
const MAX_TEXT: usize = 1000;
/// The deepest nesting.
const MAX_DEPTH: usize = 50;

/// What a number measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    /// This, or nothing.
    Of(Unit),
    /// Not known, as of a variable of assembly text that leaves it out: it goes with any.
    Unknown,
}

/// What the value of a part is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Number(Measure),
    Bool,
    Name,
    Joints,
}

impl Kind {
    fn of(of_type: Type) -> Self {
        match of_type {
            Type::Int => PLAIN,
            Type::Real => Self::Number(Measure::Unknown),
            Type::Bool => Self::Bool,
            Type::Joints | Type::Item | Type::Speed | Type::Tool => Self::Name,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Bool => "true or false",
            Self::Name => "a name",
            Self::Joints => "six joints",
        }
    }
}

const PLAIN: Kind = Kind::Number(Measure::Of(Unit::NONE));

impl Kind {
    /// What it measures, if it is a number that measures something.
    pub(super) fn unit(self) -> Option<Unit> {
        match self {
            Self::Number(Measure::Of(unit)) if unit != Unit::NONE => Some(unit),
            _ => None,
        }
    }

    /// Whether it is something of the same kind, whatever it measures.
    fn is_like(self, other: Self) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }
}

/// Words that are no variables here.
const WORDS: [&str; 15] = [
    "output", "input", "joint", "joints", "force", "held", "holding", "error", "time", "steps",
    "and", "or", "not", "true", "false",
];

/// Units, what one is in SI units, and what it measures.
const UNITS: [(&str, f64, Unit); 10] = [
    ("um", 1e-6, Unit::LENGTH),
    ("mm", 1e-3, Unit::LENGTH),
    ("cm", 1e-2, Unit::LENGTH),
    ("m", 1.0, Unit::LENGTH),
    ("deg", std::f64::consts::PI / 180.0, Unit::ANGLE),
    ("rad", 1.0, Unit::ANGLE),
    ("ms", 1e-3, Unit::TIME),
    ("s", 1.0, Unit::TIME),
    ("min", 60.0, Unit::TIME),
    ("N", 1.0, Unit::FORCE),
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Token<'t> {
    Word(&'t str),
    Number(&'t str),
    Sign(&'t str),
}

type Parsed = Result<(Node, Kind), ConditionError>;

pub(super) fn parse(module: &Module, function: usize, text: &str) -> Parsed {
    if text.len() > MAX_TEXT {
        let why = format!("a condition is no longer than {MAX_TEXT} bytes");
        return Err(ConditionError { at: MAX_TEXT, why });
    }
    let tokens = tokens(text)?;
    let mut parser = Parser { module, function, tokens, next: 0, end: text.len(), depth: 0 };
    let parsed = parser.or()?;
    match parser.peek() {
        None => Ok(parsed),
        Some(_) => Err(parser.error("an operator is missing before this")),
    }
}

fn tokens(text: &str) -> Result<Vec<(usize, Token<'_>)>, ConditionError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let length_while = |is: &dyn Fn(char) -> bool| rest.find(|c| !is(c)).unwrap_or(rest.len());
        let token = match first {
            c if c.is_whitespace() => {
                at += c.len_utf8();
                continue;
            }
            c if c.is_alphabetic() || c == '_' || c == '$' => {
                let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '$' || c == '.';
                Token::Word(&rest[..length_while(&is_word)])
            }
            c if c.is_ascii_digit() => {
                let length = number_length(rest);
                Token::Number(&rest[..length])
            }
            _ => {
                let two = ["==", "!=", "<=", ">="].into_iter().find(|two| rest.starts_with(two));
                let one = ["<", ">", "+", "-", "*", "/", "(", ")", "="];
                let sign = two.or_else(|| one.into_iter().find(|one| rest.starts_with(one)));
                let why = || format!("`{first}` means nothing in a condition");
                Token::Sign(sign.ok_or_else(|| ConditionError { at, why: why() })?)
            }
        };
        tokens.push((at, token));
        at += match token {
            Token::Word(text) | Token::Number(text) | Token::Sign(text) => text.len(),
        };
    }
    Ok(tokens)
}

/// How much of a text is a number: digits, a point, an exponent.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| {
        let rest = &text[from..];
        from + rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len())
    };
    let mut end = digits(0);
    if text[end..].starts_with('.') && text[end + 1..].starts_with(|c: char| c.is_ascii_digit()) {
        end = digits(end + 1);
    }
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        if digits(end + 1 + sign) > end + 1 + sign {
            end = digits(end + 1 + sign);
        }
    }
    end
}

/// What a product or a quotient measures.
fn measured((left, right): (Kind, Kind), with: fn(Unit, Unit) -> Option<Unit>) -> Kind {
    let of = match (left, right) {
        (Kind::Number(Measure::Of(one)), Kind::Number(Measure::Of(other))) => with(one, other),
        _ => None,
    };
    Kind::Number(of.map_or(Measure::Unknown, Measure::Of))
}

struct Parser<'t, 'm> {
    module: &'m Module,
    function: usize,
    tokens: Vec<(usize, Token<'t>)>,
    next: usize,
    end: usize,
    depth: usize,
}

impl<'t> Parser<'t, '_> {
    fn peek(&self) -> Option<Token<'t>> {
        self.tokens.get(self.next).map(|(_, token)| *token)
    }

    fn at(&self) -> usize {
        self.tokens.get(self.next).map_or(self.end, |(at, _)| *at)
    }

    fn error(&self, why: impl Into<String>) -> ConditionError {
        ConditionError { at: self.at(), why: why.into() }
    }

    fn take(&mut self, token: Token<'_>) -> bool {
        let is_it = self.peek() == Some(token);
        self.next += usize::from(is_it);
        is_it
    }

    fn or(&mut self) -> Parsed {
        self.logical("or", Operator::Or, Self::and)
    }

    fn and(&mut self) -> Parsed {
        self.logical("and", Operator::And, Self::not)
    }

    fn logical(&mut self, word: &str, operator: Operator, part: fn(&mut Self) -> Parsed) -> Parsed {
        let mut left = part(self)?;
        while self.peek() == Some(Token::Word(word)) {
            self.require(left.1, Kind::Bool)?;
            self.next += 1;
            let at = self.next;
            let right = part(self)?;
            self.require_at(at, right.1, Kind::Bool)?;
            left = (Node::Two(operator, Box::new(left.0), Box::new(right.0)), Kind::Bool);
        }
        Ok(left)
    }

    fn require(&self, found: Kind, wanted: Kind) -> Result<(), ConditionError> {
        self.require_at(self.next, found, wanted)
    }

    fn require_at(&self, token: usize, found: Kind, wanted: Kind) -> Result<(), ConditionError> {
        if found.is_like(wanted) {
            return Ok(());
        }
        let why = format!("here must be {}, and this is {}", wanted.words(), found.words());
        Err(self.error_at(token, why))
    }

    fn error_at(&self, token: usize, why: String) -> ConditionError {
        ConditionError { at: self.tokens.get(token).map_or(self.end, |(at, _)| *at), why }
    }

    /// What two parts measure that are added, subtracted or compared: the same.
    fn same(
        &self,
        token: usize,
        (left, right): (Kind, Kind),
        done: &str,
    ) -> Result<Kind, ConditionError> {
        let (Kind::Number(Measure::Of(one)), Kind::Number(Measure::Of(other))) = (left, right)
        else {
            let is_known = matches!(left, Kind::Number(Measure::Of(_)));
            return Ok(if is_known { left } else { right });
        };
        if one == other {
            return Ok(left);
        }
        let plain = [one, other]
            .into_iter()
            .find(|unit| *unit != Unit::NONE && [one, other].contains(&Unit::NONE));
        let units = plain.map(|unit| UNITS.iter().filter(move |it| it.2 == unit).map(|it| it.0));
        let units: Vec<&str> = units.into_iter().flatten().collect();
        let hint = match units[..] {
            [] => String::new(),
            _ => format!("; write its unit: {}", units.join(", ")),
        };
        let why = format!("{} and {} cannot be {done}{hint}", one.words(), other.words());
        Err(self.error_at(token, why))
    }

    /// One level deeper, as long as that is not too deep.
    fn deeper(&mut self, part: fn(&mut Self) -> Parsed) -> Parsed {
        if self.depth == MAX_DEPTH {
            return Err(self.error(format!("this is nested more than {MAX_DEPTH} deep")));
        }
        self.depth += 1;
        let parsed = part(self);
        self.depth -= 1;
        parsed
    }

    fn not(&mut self) -> Parsed {
        if !self.take(Token::Word("not")) {
            return self.comparison();
        }
        let at = self.next;
        let (inner, kind) = self.deeper(Self::not)?;
        self.require_at(at, kind, Kind::Bool)?;
        Ok((Node::Not(Box::new(inner)), Kind::Bool))
    }

    fn comparison(&mut self) -> Parsed {
        let (left, kind) = self.sum()?;
        let Some(Token::Sign(sign)) = self.peek() else { return Ok((left, kind)) };
        let operator = match sign {
            "==" => Operator::Equal,
            "!=" => Operator::Unequal,
            "<" => Operator::Less,
            "<=" => Operator::AtMost,
            ">" => Operator::More,
            ">=" => Operator::AtLeast,
            "=" => return Err(self.error("`==` compares; `=` gives a value")),
            _ => return Ok((left, kind)),
        };
        let orders = !matches!(operator, Operator::Equal | Operator::Unequal);
        if orders {
            self.require(kind, PLAIN)?;
        }
        self.next += 1;
        let at = self.next;
        let (right, other) = self.sum()?;
        self.require_at(at, other, kind)?;
        // A force and a time have one unit each, in which a bare number beside them is meant.
        let has_one = |kind: Kind| [Some(Unit::FORCE), Some(Unit::TIME)].contains(&kind.unit());
        let is_meant = (has_one(kind) && other == PLAIN) || (has_one(other) && kind == PLAIN);
        if !is_meant {
            self.same(at, (kind, other), "compared")?;
        }
        Ok((Node::Two(operator, Box::new(left), Box::new(right)), Kind::Bool))
    }

    fn sum(&mut self) -> Parsed {
        self.arithmetic(&[("+", Operator::Plus), ("-", Operator::Minus)], Self::product)
    }

    fn product(&mut self) -> Parsed {
        self.arithmetic(&[("*", Operator::Times), ("/", Operator::Over)], Self::negated)
    }

    fn arithmetic(&mut self, signs: &[(&str, Operator)], part: fn(&mut Self) -> Parsed) -> Parsed {
        let mut left = part(self)?;
        while let Some(Token::Sign(sign)) = self.peek() {
            let Some((_, operator)) = signs.iter().find(|(known, _)| *known == sign) else { break };
            self.require(left.1, PLAIN)?;
            self.next += 1;
            let at = self.next;
            let right = part(self)?;
            self.require_at(at, right.1, PLAIN)?;
            let kinds = (left.1, right.1);
            let kind = match operator {
                Operator::Plus => self.same(at, kinds, "added")?,
                Operator::Minus => self.same(at, kinds, "subtracted")?,
                Operator::Times => measured(kinds, Unit::times),
                _ => measured(kinds, Unit::over),
            };
            left = (Node::Two(*operator, Box::new(left.0), Box::new(right.0)), kind);
        }
        Ok(left)
    }

    fn negated(&mut self) -> Parsed {
        if !self.take(Token::Sign("-")) {
            return self.atom();
        }
        let at = self.next;
        let (inner, kind) = self.deeper(Self::negated)?;
        self.require_at(at, kind, PLAIN)?;
        Ok((Node::Minus(Box::new(inner)), kind))
    }

    fn atom(&mut self) -> Parsed {
        match self.peek() {
            Some(Token::Number(number)) => self.number(number),
            Some(Token::Word(word)) => {
                let at = self.at();
                self.next += 1;
                self.word(word, at)
            }
            Some(Token::Sign("(")) => {
                self.next += 1;
                let parsed = self.deeper(Self::or)?;
                if self.take(Token::Sign(")")) {
                    return Ok(parsed);
                }
                Err(self.error("a `)` is missing"))
            }
            Some(Token::Sign(sign)) => {
                Err(self.error(format!("a value is missing before `{sign}`")))
            }
            None => Err(self.error("a value is missing at the end")),
        }
    }

    fn number(&mut self, text: &str) -> Parsed {
        let wrong = self.error(format!("`{text}` is no number that can be had"));
        self.next += 1;
        let unit = match self.peek() {
            Some(Token::Word(word)) => UNITS.iter().find(|(unit, ..)| *unit == word),
            _ => None,
        };
        if let Some((_, factor, unit)) = unit {
            self.next += 1;
            let number: f64 = text.parse().map_err(|_| wrong)?;
            let kind = Kind::Number(Measure::Of(*unit));
            return Ok((Node::Value(Value::Real(number * factor)), kind));
        }
        let is_real = text.contains(['.', 'e', 'E']);
        let value = if is_real {
            text.parse().map(Value::Real).ok()
        } else {
            text.parse().map(Value::Int).ok()
        };
        Ok((Node::Value(value.ok_or(wrong)?), PLAIN))
    }

    fn word(&mut self, word: &str, at: usize) -> Parsed {
        let subject = |subject, kind| Ok((Node::Subject(subject), kind));
        let measured = |unit| Kind::Number(Measure::Of(unit));
        if let Some((found, of_type, unit)) = variable(self.module, self.function, word) {
            let kind = match (of_type, unit) {
                (Type::Real, Some(unit)) => measured(unit),
                _ => Kind::of(of_type),
            };
            return subject(found, kind);
        }
        match word {
            "true" | "high" => Ok((Node::Value(Value::Bool(true)), Kind::Bool)),
            "false" | "low" => Ok((Node::Value(Value::Bool(false)), Kind::Bool)),
            "output" => subject(Subject::Output(self.line(true)?), Kind::Bool),
            "input" => subject(Subject::Input(self.line(false)?), Kind::Bool),
            "joint" => subject(Subject::Joint(self.joint()?), measured(Unit::ANGLE)),
            "joints" => subject(Subject::Joints, Kind::Joints),
            "force" => subject(Subject::Force, measured(Unit::FORCE)),
            "held" => subject(Subject::Held, Kind::Name),
            "holding" => {
                let nothing = Node::Value(Value::Name("nothing".to_owned()));
                let held = Node::Subject(Subject::Held);
                let node = Node::Two(Operator::Unequal, Box::new(held), Box::new(nothing));
                Ok((node, Kind::Bool))
            }
            "error" => subject(Subject::Error(self.declared_error()?), Kind::Bool),
            "time" => subject(Subject::Time, measured(Unit::TIME)),
            "steps" => subject(Subject::Steps, PLAIN),
            name => match Setting::ALL.iter().find(|setting| setting.name() == name) {
                Some(setting) => {
                    let kind = match setting {
                        Setting::ReverseForceLimit => measured(Unit::FORCE),
                        _ => Kind::of(setting.of_type()),
                    };
                    subject(Subject::Setting(*setting), kind)
                }
                None => self.name(name, at),
            },
        }
    }

    /// A name that is a value: of an item, a tool, joints, a speed.
    fn name(&self, name: &str, at: usize) -> Parsed {
        let module = self.module;
        let is_known = module.items.iter().any(|item| item.name == name)
            || module.tools.iter().any(|tool| tool == name)
            || module.joints.iter().any(|(joints, _)| joints == name)
            || SpeedId::ALL.iter().any(|speed| speed.name() == name)
            || ["nothing", NONE].contains(&name);
        if is_known {
            let is_speed = SpeedId::ALL.iter().any(|speed| speed.name() == name);
            let name = if is_speed { name.replace('_', " ") } else { name.to_owned() };
            return Ok((Node::Value(Value::Name(name)), Kind::Name));
        }
        let words = WORDS.into_iter().chain(Setting::ALL.iter().map(|setting| setting.name()));
        let meant = nearest_variable(module, self.function, name).or_else(|| nearest(name, words));
        let hint = meant.map(|meant| format!("; `{meant}`?")).unwrap_or_default();
        Err(ConditionError { at, why: format!("nothing is called `{name}` here{hint}") })
    }

    fn line(&mut self, is_output: bool) -> Result<u16, ConditionError> {
        let kind = if is_output { "an output" } else { "an input" };
        let missing = self.error(format!("here must be the number or the name of {kind}"));
        let (Some(Token::Word(name)) | Some(Token::Number(name))) = self.peek() else {
            return Err(missing);
        };
        let line = line(self.module, name, is_output);
        let unknown = self.error(format!("`{name}` is not {kind} of this program"));
        self.next += 1;
        line.ok_or(unknown)
    }

    fn joint(&mut self) -> Result<u8, ConditionError> {
        let wrong = self.error("the joints are numbered from 1 to 6");
        let Some(Token::Number(number)) = self.peek() else { return Err(wrong) };
        self.next += 1;
        match number.parse::<u8>() {
            Ok(joint @ 1..=6) => Ok(joint - 1),
            _ => Err(wrong),
        }
    }

    fn declared_error(&mut self) -> Result<ErrorId, ConditionError> {
        let Some(Token::Word(name)) = self.peek() else {
            return Err(self.error("here must be the name of an error"));
        };
        let errors = &self.module.errors;
        let found = errors.iter().position(|error| error.name == name);
        let meant = nearest(name, errors.iter().map(|error| error.name.as_str()));
        let hint = meant.map(|meant| format!("; `{meant}`?")).unwrap_or_default();
        let unknown = self.error(format!("the program has no error `{name}`{hint}"));
        self.next += 1;
        found.map(|index| ErrorId(index as u16)).ok_or(unknown)
    }
}
