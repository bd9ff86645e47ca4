//! Operators and functions of expressions: which types they take, and which instruction they are.

use super::Checker;
use super::expression::Need;
use super::names::Found;
use crate::fold;
use crate::report::warning;
use crate::tree::{Expression, ExpressionKind, Hoist};
use crate::types::ValueType;
use obverse_isa::Instr;
use obverse_syntax::ast::{self, BinaryOperator, UnaryOperator};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::Span;
use obverse_syntax::value_elsewhere;

/// The functions of expressions and how many arguments each takes.
pub(crate) const FUNCTIONS: [(&str, usize); 7] =
    [("abs", 1), ("min", 2), ("max", 2), ("sqrt", 1), ("int", 1), ("real", 1), ("random", 2)];

/// An instruction on integers and its like on reals.
#[derive(Clone, Copy)]
struct Arithmetic {
    int: Instr,
    real: Instr,
    /// What is done, for messages: `added`.
    done: &'static str,
}

impl<'s> Checker<'s> {
    /// `-operand`, `not operand`
    pub(super) fn unary_operator(
        &mut self,
        operator: UnaryOperator,
        operand: Expression,
        span: Span,
    ) -> Expression {
        let instr = match (operator, operand.of_type) {
            (_, ValueType::Unknown) => return Expression::missing(span),
            (UnaryOperator::Negate, ValueType::Int) => Instr::IntNeg {},
            (UnaryOperator::Negate, ValueType::Real(_)) => Instr::RealNeg {},
            (UnaryOperator::Not, ValueType::Bool) => Instr::BoolNot {},
            (UnaryOperator::Negate, _) => {
                return self.wrong_operand(&operand, "`-` needs a number");
            }
            (UnaryOperator::Not, _) => {
                return self.wrong_operand(&operand, "`not` needs a truth value");
            }
        };
        let of_type = operand.of_type;
        unary(instr, operand, of_type, span)
    }

    /// `left operator right`
    pub(super) fn binary_operator(
        &mut self,
        operator: BinaryOperator,
        left: Expression,
        right: Expression,
        span: Span,
    ) -> Expression {
        if left.of_type.is_unknown() || right.of_type.is_unknown() {
            return Expression::missing(span);
        }
        use BinaryOperator::{
            Add, And, Divide, Equal, Greater, GreaterOrEqual, Less, LessOrEqual, Multiply,
            NotEqual, Or, Remainder, Subtract,
        };
        match operator {
            Add => self.sum(Instr::IntAdd {}, Instr::RealAdd {}, "added", left, right, span),
            Subtract => {
                self.sum(Instr::IntSub {}, Instr::RealSub {}, "subtracted", left, right, span)
            }
            Multiply | Divide => self.product(operator == Divide, left, right, span),
            Remainder => self.remainder(left, right, span),
            Less => self.order(Instr::IntLt {}, Instr::RealLt {}, left, right, span),
            LessOrEqual => self.order(Instr::IntLe {}, Instr::RealLe {}, left, right, span),
            Greater => self.order(Instr::IntLt {}, Instr::RealLt {}, right, left, span),
            GreaterOrEqual => self.order(Instr::IntLe {}, Instr::RealLe {}, right, left, span),
            Equal | NotEqual => self.equality(operator == NotEqual, left, right, span),
            And => self.logic(Instr::BoolAnd {}, "and", left, right, span),
            Or => self.logic(Instr::BoolOr {}, "or", left, right, span),
        }
    }

    fn sum(
        &mut self,
        int: Instr,
        real: Instr,
        done: &'static str,
        left: Expression,
        right: Expression,
        span: Span,
    ) -> Expression {
        let arithmetic = Arithmetic { int, real, done };
        let Some((instr, left, right)) = self.alike(arithmetic, left, right) else {
            return Expression::missing(span);
        };
        let of_type = left.of_type;
        self.finite(binary(instr, left, right, of_type, span))
    }

    fn order(
        &mut self,
        int: Instr,
        real: Instr,
        left: Expression,
        right: Expression,
        span: Span,
    ) -> Expression {
        let arithmetic = Arithmetic { int, real, done: "compared" };
        match self.alike(arithmetic, left, right) {
            Some((instr, left, right)) => binary(instr, left, right, ValueType::Bool, span),
            None => Expression::missing(span),
        }
    }

    fn equality(
        &mut self,
        is_negated: bool,
        left: Expression,
        right: Expression,
        span: Span,
    ) -> Expression {
        if left.of_type == ValueType::Bool && right.of_type == ValueType::Bool {
            let equal = binary(Instr::BoolEq {}, left, right, ValueType::Bool, span);
            return match is_negated {
                true => unary(Instr::BoolNot {}, equal, ValueType::Bool, span),
                false => equal,
            };
        }
        let (int, real) = match is_negated {
            true => (Instr::IntNe {}, Instr::RealNe {}),
            false => (Instr::IntEq {}, Instr::RealEq {}),
        };
        self.order(int, real, left, right, span)
    }

    fn logic(
        &mut self,
        instr: Instr,
        word: &str,
        left: Expression,
        right: Expression,
        span: Span,
    ) -> Expression {
        for side in [&left, &right] {
            if side.of_type != ValueType::Bool {
                return self.wrong_operand(side, &format!("`{word}` needs truth values"));
            }
        }
        binary(instr, left, right, ValueType::Bool, span)
    }

    fn product(
        &mut self,
        divides: bool,
        left: Expression,
        right: Expression,
        span: Span,
    ) -> Expression {
        let word = if divides { "`/`" } else { "`*`" };
        if left.of_type == ValueType::Int && right.of_type == ValueType::Int {
            let instr = if divides { Instr::IntDiv {} } else { Instr::IntMul {} };
            if divides && !self.check_divisor(&left, &right, span) {
                return Expression::missing(span);
            }
            return binary(instr, left, right, ValueType::Int, span);
        }
        let needs = format!("{word} needs numbers");
        let (Some(left), Some(right)) = (self.as_real(left, &needs), self.as_real(right, &needs))
        else {
            return Expression::missing(span);
        };
        let combined = match (left.of_type, right.of_type, divides) {
            (ValueType::Real(left), ValueType::Real(right), false) => left.times(right),
            (ValueType::Real(left), ValueType::Real(right), true) => left.over(right),
            _ => None,
        };
        let Some(dimension) = combined else {
            let message = "an exponent of a unit goes from -128 to 127".to_owned();
            self.reports.error(Code::OutOfRange, span, message, "beyond");
            return Expression::missing(span);
        };
        let instr = if divides { Instr::RealDiv {} } else { Instr::RealMul {} };
        self.finite(binary(instr, left, right, ValueType::Real(dimension), span))
    }

    fn remainder(&mut self, left: Expression, right: Expression, span: Span) -> Expression {
        for side in [&left, &right] {
            if side.of_type != ValueType::Int {
                return self.wrong_operand(side, "`mod` needs integers");
            }
        }
        if is_zero(&right) {
            self.report_zero_divisor(right.span);
            return Expression::missing(span);
        }
        binary(Instr::IntRem {}, left, right, ValueType::Int, span)
    }

    /// Whether a division of integers can be; a remainder that is lost is warned about.
    fn check_divisor(&mut self, left: &Expression, right: &Expression, span: Span) -> bool {
        if is_zero(right) {
            self.report_zero_divisor(right.span);
            return false;
        }
        if let (ExpressionKind::Int(left), ExpressionKind::Int(right)) = (&left.kind, &right.kind)
            && left.wrapping_rem(*right) != 0
        {
            let quotient = left.wrapping_div(*right);
            let message =
                format!("{left} / {right} is {quotient}: integers are divided towards zero");
            self.reports.add(
                warning(Code::IntegerDivision, span, message, "loses its remainder")
                    .with_help(format!("for a real write `{left}.0 / {right}`")),
            );
        }
        true
    }

    fn report_zero_divisor(&mut self, span: Span) {
        let message = "an integer cannot be divided by zero".to_owned();
        self.reports.error(Code::DivisionByZero, span, message, "zero");
    }

    /// The operands as two integers, or two reals of one dimension; a mistake is reported.
    fn alike(
        &mut self,
        arithmetic: Arithmetic,
        left: Expression,
        right: Expression,
    ) -> Option<(Instr, Expression, Expression)> {
        if left.of_type == ValueType::Int && right.of_type == ValueType::Int {
            return Some((arithmetic.int, left, right));
        }
        for side in [&left, &right] {
            if !matches!(side.of_type, ValueType::Int | ValueType::Real(_)) {
                let needs = format!("only numbers can be {}", arithmetic.done);
                self.wrong_operand(side, &needs);
                return None;
            }
        }
        // A number that is written out has no unit of its own to differ by: it lacks one.
        for (side, other) in [(&left, &right), (&right, &left)] {
            let lacks_unit = matches!(side.of_type, ValueType::Int | ValueType::NUMBER)
                && other.of_type != ValueType::Int
                && other.of_type != ValueType::NUMBER;
            if lacks_unit && side.is_constant() {
                let what = format!("beside {}, a number", other.of_type);
                let need = Need::new(other.of_type, what).declared(other.span);
                self.fit(side.clone(), &need);
                return None;
            }
        }
        let needs = format!("integers and reals cannot be {} together", arithmetic.done);
        let (left, right) = (self.as_real(left, &needs)?, self.as_real(right, &needs)?);
        if left.of_type != right.of_type {
            self.report_unlike(arithmetic.done, &left, &right);
            return None;
        }
        Some((arithmetic.real, left, right))
    }

    fn report_unlike(&mut self, done: &str, left: &Expression, right: &Expression) {
        // Comparisons turn their operands round; the places tell which was written first.
        let (first, second) = if left.span <= right.span { (left, right) } else { (right, left) };
        let message = format!("{} and {} cannot be {done}", first.of_type, second.of_type);
        let mut diagnostic =
            Diagnostic::error(Code::UnitMismatch, second.span, message, second.of_type.to_string())
                .with_label(first.span, first.of_type.to_string());
        for side in [first, second] {
            if let Some(declared) = self.declared_as(side) {
                diagnostic = diagnostic.with_label(declared, "declared here");
            }
        }
        self.reports.add(diagnostic);
    }

    /// Where the variable is declared that an expression is.
    fn declared_as(&self, value: &Expression) -> Option<Span> {
        if !matches!(value.kind, ExpressionKind::Local(_) | ExpressionKind::Global(_)) {
            return None;
        }
        let Span { start, end } = value.span;
        let name = self.sources.whole().get(start as usize..end as usize)?;
        match self.names.find(name) {
            Found::Here(symbol) | Found::Outside(symbol) => Some(symbol.name.span),
            Found::Nothing => None,
        }
    }

    /// A real, or an integer that is written out as one; a mistake is reported.
    fn as_real(&mut self, value: Expression, needs: &str) -> Option<Expression> {
        match (value.of_type, &value.kind) {
            (ValueType::Real(_), _) => Some(value),
            (ValueType::Int, ExpressionKind::Int(number)) => {
                Some(Expression::real(*number as f64, ValueType::NUMBER, value.span))
            }
            (ValueType::Int, _) => {
                let message = format!("{needs}; this is an integer beside a real");
                let diagnostic =
                    Diagnostic::error(Code::TypeMismatch, value.span, message, "an integer")
                        .with_help("`real(..)` makes a number of an integer");
                self.reports.add(diagnostic);
                None
            }
            _ => {
                self.wrong_operand(&value, needs);
                None
            }
        }
    }

    fn wrong_operand(&mut self, operand: &Expression, needs: &str) -> Expression {
        let message = format!("{needs}, and this is {}", operand.of_type);
        let at = operand.of_type.to_string();
        self.reports.error(Code::TypeMismatch, operand.span, message, &at);
        Expression::missing(operand.span)
    }

    /// A constant that has become too large is a mistake.
    fn finite(&mut self, value: Expression) -> Expression {
        use Instr::{RealAdd, RealDiv, RealMul, RealSub};
        if let ExpressionKind::Binary(instr, operands) = &value.kind
            && matches!(instr, RealAdd {} | RealSub {} | RealMul {} | RealDiv {})
            && let (ExpressionKind::Real(left), ExpressionKind::Real(right)) =
                (&operands.0.kind, &operands.1.kind)
            && left.is_finite()
            && right.is_finite()
        {
            // Folding has refused it.
            return self.not_finite(value.span);
        }
        value
    }

    /// `abs(e)`, `min(a, b)`
    pub(super) fn function_call(
        &mut self,
        name: ast::Name<'s>,
        arguments: &[ast::Expression<'s>],
        span: Span,
    ) -> Expression {
        let known = FUNCTIONS.iter().find(|(known, _)| *known == name.value);
        let Some(&(_, count)) = known else {
            arguments.iter().for_each(|argument| _ = self.expression(argument));
            self.report_unknown_function(name);
            return Expression::missing(span);
        };
        let values: Vec<Expression> =
            arguments.iter().map(|argument| self.expression(argument)).collect();
        if values.len() != count {
            let message = format!("`{}` takes {count} arguments", name.value);
            let message = if count == 1 { message.trim_end_matches('s') } else { &message };
            let at = format!("given {}", values.len());
            self.reports.error(Code::ArgumentCount, span, message.to_owned(), &at);
            return Expression::missing(span);
        }
        if values.iter().any(|value| value.of_type.is_unknown()) {
            return Expression::missing(span);
        }
        let mut values = values.into_iter();
        match (name.value, values.next(), values.next()) {
            ("min", Some(a), Some(b)) => {
                self.sum(Instr::IntMin {}, Instr::RealMin {}, "compared", a, b, span)
            }
            ("max", Some(a), Some(b)) => {
                self.sum(Instr::IntMax {}, Instr::RealMax {}, "compared", a, b, span)
            }
            ("random", Some(a), Some(b)) => self.random(a, b, span),
            ("abs", Some(value), None) => self.absolute(value, span),
            ("sqrt", Some(value), None) => self.square_root(value, span),
            ("int", Some(value), None) => {
                let value = self.fit(value, &Need::new(ValueType::NUMBER, "`int`"));
                unary(Instr::RealToInt {}, value, ValueType::Int, span)
            }
            (_, Some(value), _) => {
                let value = self.fit(value, &Need::new(ValueType::Int, "`real`"));
                unary(Instr::IntToReal {}, value, ValueType::NUMBER, span)
            }
            _ => Expression::missing(span),
        }
    }

    fn report_unknown_function(&mut self, name: ast::Name<'s>) {
        let names = FUNCTIONS.map(|(name, _)| name);
        let message = format!("there is no function `{}`", name.value);
        let mut diagnostic =
            Diagnostic::error(Code::UnknownFunction, name.span, message, "not a function")
                .with_note(format!("the functions are {}", names.join(", ")));
        if let Some(help) = value_elsewhere(name.value) {
            diagnostic = diagnostic.with_help(help);
        } else if let Some(meant) = self.reports.meant(name.value, names.into_iter()) {
            diagnostic = diagnostic.did_you_mean(name.span, meant);
        }
        self.reports.add(diagnostic);
    }

    fn absolute(&mut self, value: Expression, span: Span) -> Expression {
        let of_type = value.of_type;
        match of_type {
            ValueType::Int => unary(Instr::IntAbs {}, value, of_type, span),
            ValueType::Real(_) => unary(Instr::RealAbs {}, value, of_type, span),
            _ => self.wrong_operand(&value, "`abs` needs a number"),
        }
    }

    fn square_root(&mut self, value: Expression, span: Span) -> Expression {
        let Some(value) = self.as_real(value, "`sqrt` needs a real") else {
            return Expression::missing(span);
        };
        let ValueType::Real(dimension) = value.of_type else { return Expression::missing(span) };
        let Some(root) = dimension.root() else {
            let message = format!("{dimension} has no square root: a unit would be halved");
            self.reports.error(Code::NoSquareRoot, value.span, message, "not a square");
            return Expression::missing(span);
        };
        unary(Instr::RealSqrt {}, value, ValueType::Real(root), span)
    }

    /// `random(a, b)` is `a + draw * (b - a)`, drawn before the statement.
    fn random(&mut self, low: Expression, high: Expression, span: Span) -> Expression {
        if !self.may_read(span, "a random draw") {
            return Expression::missing(span);
        }
        let is_integer = |value: &Expression| matches!(value.kind, ExpressionKind::Int(_));
        let mut sides = [low, high];
        if sides.iter().all(is_integer) {
            sides = sides.map(|side| self.fit(side, &Need::new(ValueType::NUMBER, "`random`")));
        }
        let [low, high] = sides;
        let arithmetic =
            Arithmetic { int: Instr::IntSub {}, real: Instr::RealSub {}, done: "drawn between" };
        let Some((instr, low, high)) = self.alike(arithmetic, low, high) else {
            return Expression::missing(span);
        };
        let of_type = low.of_type;
        if of_type == ValueType::Int {
            return self.wrong_operand(&low, "`random` needs reals");
        }
        let low = self.twice(low);
        let read = |local| Instr::Draw { local };
        let draw = self.reading(ValueType::NUMBER, span, "a random draw", read);
        let width = binary(instr, high, low.clone(), of_type, span);
        let offset = binary(Instr::RealMul {}, draw, width, of_type, span);
        binary(Instr::RealAdd {}, low, offset, of_type, span)
    }

    /// A value that can be named twice at no cost: computed ones are stored before the statement.
    pub(super) fn twice(&mut self, value: Expression) -> Expression {
        let is_computed =
            matches!(value.kind, ExpressionKind::Unary(..) | ExpressionKind::Binary(..));
        if !is_computed {
            return value;
        }
        let local = self.temporary(value.of_type.machine(), value.span);
        let stored = Expression::local(local, value.of_type, value.span);
        self.frame.hoist(Hoist::Store { local, value });
        stored
    }
}

fn is_zero(value: &Expression) -> bool {
    matches!(value.kind, ExpressionKind::Int(0))
}

/// An instruction of one operand, or its value if that is known.
pub(super) fn unary(
    instr: Instr,
    operand: Expression,
    of_type: ValueType,
    span: Span,
) -> Expression {
    if operand.of_type.is_unknown() {
        return Expression::missing(span);
    }
    let folded = fold::unary(instr, &operand.kind);
    let kind = folded.unwrap_or_else(|| ExpressionKind::Unary(instr, Box::new(operand)));
    Expression { kind, of_type, span }
}

/// An instruction of two operands, or its value if that is known.
pub(super) fn binary(
    instr: Instr,
    left: Expression,
    right: Expression,
    of_type: ValueType,
    span: Span,
) -> Expression {
    let folded = fold::binary(instr, &left.kind, &right.kind);
    let kind = folded.unwrap_or_else(|| ExpressionKind::Binary(instr, Box::new((left, right))));
    Expression { kind, of_type, span }
}
