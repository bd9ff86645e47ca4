//! Expressions of a type. Reals stay finite, and none is ever no number, whose bits would be open.

use super::Generator;
use super::scope::Type;
use arbitrary::Result;

/// How deep an expression is.
const DEPTH: usize = 3;

impl Generator<'_, '_> {
    /// An expression of a type.
    pub(super) fn expression(&mut self, of_type: Type) -> Result<String> {
        let depth = self.below(DEPTH + 1)?;
        self.expression_of(of_type, depth)
    }

    /// One that reads nothing outside the program.
    pub(super) fn inner_expression(&mut self, of_type: Type) -> Result<String> {
        let may_read = std::mem::replace(&mut self.frame.may_read, false);
        let expression = self.expression(of_type);
        self.frame.may_read = may_read;
        expression
    }

    /// A real that stays within bounds however often it is added up.
    pub(super) fn bounded(&mut self, of_type: Type) -> Result<String> {
        match bounds(of_type) {
            Some(_) if of_type == Type::Int => self.expression(of_type),
            bounds => self.within(of_type, bounds),
        }
    }

    /// A value that is within bounds, if there are any.
    pub(super) fn within(
        &mut self,
        of_type: Type,
        bounds: Option<(&'static str, &'static str)>,
    ) -> Result<String> {
        let value = self.expression(of_type)?;
        Ok(match bounds {
            Some((low, high)) => format!("max(min({value}, {high}), {low})"),
            None => value,
        })
    }

    fn expression_of(&mut self, of_type: Type, depth: usize) -> Result<String> {
        match of_type {
            Type::Int => self.int(depth),
            Type::Bool => self.boolean(depth),
            Type::Joints => self.joints(),
            Type::Item => self.item(),
            _ => self.real(of_type, depth),
        }
    }

    /// A variable of a type, or else what is given.
    fn variable_or(&mut self, of_type: Type, other: String) -> Result<String> {
        let names = self.readable(of_type);
        if names.is_empty() || self.one_in(3)? { Ok(other) } else { self.choose(&names) }
    }

    fn joints(&mut self) -> Result<String> {
        let constant = self.choose(&self.joints.clone())?;
        self.variable_or(Type::Joints, constant)
    }

    fn item(&mut self) -> Result<String> {
        let items = self.items.clone();
        let item = self.choose(&items)?;
        self.variable_or(Type::Item, item)
    }

    fn int_literal(&mut self) -> Result<String> {
        Ok(match self.below(12)? {
            0..=8 => self.below(10)?.to_string(),
            9 => format!("-{}", self.below(1000)?),
            10 => self.u.int_in_range(0..=i64::MAX)?.to_string(),
            _ => i64::MAX.to_string(),
        })
    }

    fn int(&mut self, depth: usize) -> Result<String> {
        if depth == 0 {
            let literal = self.int_literal()?;
            return self.variable_or(Type::Int, literal);
        }
        let a = self.int(depth - 1)?;
        let choice = self.below(12)?;
        if choice >= 9 {
            return Ok(match choice {
                9 => format!("abs({a})"),
                10 => format!("-{}", parenthesized(&a)),
                _ => {
                    let real = self.bounded(Type::Number)?;
                    let scaled = if self.traps()? { format!("({real} * 1e17)") } else { real };
                    format!("int({scaled})")
                }
            });
        }
        let b = self.int(depth - 1)?;
        Ok(match choice {
            0 | 1 => format!("({a} + {b})"),
            2 => format!("({a} - {b})"),
            3 => format!("({a} * {b})"),
            4 => format!("min({a}, {b})"),
            5 => format!("max({a}, {b})"),
            6 => format!("({a} / {})", self.divisor(&b)?),
            7 => format!("({a} mod {})", self.divisor(&b)?),
            // Precedence, and the other side of it.
            _ => format!("({a} - {b} * 2 + {a})"),
        })
    }

    /// A divisor that is not zero, or one that may be.
    fn divisor(&mut self, other: &str) -> Result<String> {
        let names = self.readable(Type::Int);
        if !names.is_empty() && self.traps()? {
            return self.choose(&names);
        }
        Ok(match self.below(2)? {
            0 => (self.below(9)? + 1).to_string(),
            _ => format!("(abs({other}) mod 7 + 7)"),
        })
    }

    /// Whether to risk a trap, which is not often.
    pub(super) fn traps(&mut self) -> Result<bool> {
        Ok(self.options.allow_traps && self.frame.claim.is_none() && self.one_in(24)?)
    }

    fn real_literal(&mut self, of_type: Type) -> Result<String> {
        let units: &[&str] = match of_type {
            Type::Length => &["mm", "um", "cm", "m"],
            Type::Time => &["ms", "s"],
            Type::Force => &["N"],
            Type::Angle => &["deg", "rad"],
            _ => &[""],
        };
        let unit = self.choose(units)?;
        let whole = self.below(100)?;
        let number = match self.below(3)? {
            0 => format!("{whole}.{}", self.below(1000)?),
            1 => format!("{whole}.5e-1"),
            _ if unit.is_empty() => format!("{whole}.0"),
            _ => whole.to_string(),
        };
        Ok(format!("{number} {unit}").trim_end().to_owned())
    }

    /// A real that is no literal without a unit, nor an integer.
    fn real(&mut self, of_type: Type, depth: usize) -> Result<String> {
        if depth == 0 {
            return self.real_leaf(of_type);
        }
        let a = self.real(of_type, depth - 1)?;
        Ok(match self.below(11)? {
            0 | 1 => format!("({a} + {})", self.real(of_type, depth - 1)?),
            2 => format!("({a} - {})", self.real(of_type, depth - 1)?),
            3 => format!("({a} * {})", self.real(Type::Number, depth - 1)?),
            4 => format!("({} * {a})", self.below(5)?),
            5 => format!("({a} / (abs({}) + 1.0))", self.real(Type::Number, depth - 1)?),
            6 => format!("min({a}, {})", self.real(of_type, depth - 1)?),
            7 => format!("abs({a})"),
            8 => format!("-{}", parenthesized(&a)),
            9 => format!("sqrt(abs({a} * {}))", self.real(of_type, depth - 1)?),
            _ if of_type == Type::Number => self.ratio(depth - 1)?,
            _ => format!("max({a}, {})", self.real(of_type, depth - 1)?),
        })
    }

    /// A number without a unit that is made of something else.
    fn ratio(&mut self, depth: usize) -> Result<String> {
        Ok(match self.below(3)? {
            0 => format!("real({})", self.int(depth)?),
            1 => {
                let of_type = self.choose(&Type::REALS[1..])?;
                let (a, b) = (self.real(of_type, depth)?, self.real(of_type, 0)?);
                let one = match of_type {
                    Type::Length => "1 mm",
                    Type::Time => "1 s",
                    Type::Force => "1 N",
                    _ => "1 rad",
                };
                format!("({a} / (abs({b}) + {one}))")
            }
            _ => format!("({} + {})", self.real(Type::Number, depth)?, self.below(5)?),
        })
    }

    fn real_leaf(&mut self, of_type: Type) -> Result<String> {
        let literal = self.real_literal(of_type)?;
        if self.frame.may_read && self.one_in(4)? {
            return match (of_type, self.below(3)?) {
                (Type::Force, 0) if self.has_arm() => Ok("force".to_owned()),
                (Type::Length, 0) if self.has_arm() => Ok("distance".to_owned()),
                _ if !self.has_dice() => self.variable_or(of_type, literal),
                (Type::Number, 0) => Ok(format!("random(0, {})", self.below(9)? + 1)),
                (_, 1) => {
                    let high = self.real_literal(of_type)?;
                    Ok(format!("random(-{literal}, {high})"))
                }
                _ => {
                    let low = self.variable_or(of_type, literal.clone())?;
                    Ok(format!("random(({low} + {literal}), {literal})"))
                }
            };
        }
        self.variable_or(of_type, literal)
    }

    fn boolean(&mut self, depth: usize) -> Result<String> {
        if depth == 0 {
            return self.boolean_leaf();
        }
        Ok(match self.below(9)? {
            0..=2 => {
                let operator = self.comparison()?;
                format!("({} {operator} {})", self.int(depth - 1)?, self.int(depth - 1)?)
            }
            3 | 4 => {
                let of_type = self.choose(&Type::REALS)?;
                let operator = self.comparison()?;
                let (a, b) = (self.real(of_type, depth - 1)?, self.real(of_type, depth - 1)?);
                format!("({a} {operator} {b})")
            }
            5 => format!("({} and {})", self.boolean(depth - 1)?, self.boolean(depth - 1)?),
            6 => format!("({} or {})", self.boolean(depth - 1)?, self.boolean(depth - 1)?),
            7 => {
                let operator = self.choose(&["==", "!="])?;
                format!("({} {operator} {})", self.boolean(depth - 1)?, self.boolean(depth - 1)?)
            }
            _ => format!("(not {})", self.boolean(depth - 1)?),
        })
    }

    fn boolean_leaf(&mut self) -> Result<String> {
        if self.frame.may_read && self.one_in(3)? {
            return Ok(match self.below(3)? {
                0 if self.has_arm() => "holding".to_owned(),
                _ => format!("input {}", self.signal(&self.inputs.clone())?),
            });
        }
        let literal = self.choose(&["true", "false"])?.to_owned();
        self.variable_or(Type::Bool, literal)
    }

    fn comparison(&mut self) -> Result<&'static str> {
        self.choose(&["<", "<=", ">", ">=", "==", "!="])
    }
}

/// An operand of a sign.
fn parenthesized(operand: &str) -> String {
    format!("({operand})")
}

/// Bounds of the values of a type, if they are numbers.
pub(super) fn bounds(of_type: Type) -> Option<(&'static str, &'static str)> {
    Some(match of_type {
        Type::Int => ("-5", "9"),
        Type::Number => ("-1000.0", "1000"),
        Type::Length => ("-2 m", "2000 mm"),
        Type::Time => ("-500 ms", "0.5 s"),
        Type::Force => ("-100 N", "1e2 N"),
        Type::Angle => ("-3.5 rad", "180 deg"),
        Type::Bool | Type::Joints | Type::Item => return None,
    })
}
