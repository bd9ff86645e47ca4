//! Units and what they measure: metres, radians, seconds and newtons with their exponents.
//!
//! Knows nothing of expressions.

use std::f64::consts::PI;
use std::fmt;

/// What a real measures, as exponents of the base units; all zero for a plain number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct Dimension {
    length: i8,
    angle: i8,
    time: i8,
    force: i8,
}

impl Dimension {
    /// A plain number.
    pub(crate) const NONE: Self = Self { length: 0, angle: 0, time: 0, force: 0 };
    /// In metres.
    pub(crate) const LENGTH: Self = Self { length: 1, ..Self::NONE };
    /// In radians.
    pub(crate) const ANGLE: Self = Self { angle: 1, ..Self::NONE };
    /// In seconds.
    pub(crate) const TIME: Self = Self { time: 1, ..Self::NONE };
    /// In newtons.
    pub(crate) const FORCE: Self = Self { force: 1, ..Self::NONE };
    /// In metres per second.
    pub(crate) const SPEED: Self = Self { length: 1, time: -1, ..Self::NONE };
    /// In radians per second.
    const TURN: Self = Self { angle: 1, time: -1, ..Self::NONE };

    /// Its exponents of metres, radians, seconds and newtons.
    pub(crate) fn exponents(self) -> [i8; 4] {
        [self.length, self.angle, self.time, self.force]
    }

    /// Whether it is a plain number.
    pub(crate) fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// That of a product; none if an exponent becomes too large.
    pub(crate) fn times(self, other: Self) -> Option<Self> {
        self.combine(other, i8::checked_add)
    }

    /// That of a quotient; none if an exponent becomes too large.
    pub(crate) fn over(self, other: Self) -> Option<Self> {
        self.combine(other, i8::checked_sub)
    }

    /// That of the square root, if it has one.
    pub(crate) fn root(self) -> Option<Self> {
        self.exponents().iter().all(|exponent| exponent % 2 == 0).then_some(Self {
            length: self.length / 2,
            angle: self.angle / 2,
            time: self.time / 2,
            force: self.force / 2,
        })
    }

    fn combine(self, other: Self, with: fn(i8, i8) -> Option<i8>) -> Option<Self> {
        Some(Self {
            length: with(self.length, other.length)?,
            angle: with(self.angle, other.angle)?,
            time: with(self.time, other.time)?,
            force: with(self.force, other.force)?,
        })
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match *self {
            Self::NONE => "a number without a unit",
            Self::LENGTH => "a length",
            Self::ANGLE => "an angle",
            Self::TIME => "a time",
            Self::FORCE => "a force",
            Self::SPEED => "a speed",
            Self::TURN => "a turning speed",
            _ => return self.fmt_units(f),
        };
        f.write_str(name)
    }
}

impl Dimension {
    /// `a value in m^2 s^-1`
    fn fmt_units(self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value in")?;
        let units = [("m", self.length), ("rad", self.angle), ("N", self.force), ("s", self.time)];
        for (unit, exponent) in units {
            match exponent {
                0 => {}
                1 => write!(f, " {unit}")?,
                _ => write!(f, " {unit}^{exponent}")?,
            }
        }
        Ok(())
    }

    /// Units that measure this, to be named where one is missing.
    pub(crate) fn examples(self) -> &'static str {
        match self {
            Self::LENGTH => "mm or m",
            Self::ANGLE => "deg or rad",
            Self::TIME => "s or ms",
            Self::FORCE => "N",
            Self::SPEED => "mm/s or m/s",
            Self::TURN => "deg/s or rad/s",
            _ => "one",
        }
    }

    /// The same, each by itself; none where no unit can be named.
    pub(crate) fn units(self) -> Vec<&'static str> {
        self.examples().split(" or ").filter(|unit| *unit != "one").collect()
    }
}

/// A unit: what it measures, and the value of one, as a quotient, so that tenths of millimetres
/// become the nearest double.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unit {
    /// What it measures.
    pub(crate) dimension: Dimension,
    times: f64,
    over: f64,
}

impl Unit {
    /// The unit of this name.
    pub(crate) fn of_name(name: &str) -> Option<Self> {
        let unit = |dimension, times, over| Some(Self { dimension, times, over });
        match name {
            "um" => unit(Dimension::LENGTH, 1.0, 1e6),
            "mm" => unit(Dimension::LENGTH, 1.0, 1e3),
            "cm" => unit(Dimension::LENGTH, 1.0, 1e2),
            "m" => unit(Dimension::LENGTH, 1.0, 1.0),
            "deg" => unit(Dimension::ANGLE, PI, 180.0),
            "rad" => unit(Dimension::ANGLE, 1.0, 1.0),
            "ms" => unit(Dimension::TIME, 1.0, 1e3),
            "s" => unit(Dimension::TIME, 1.0, 1.0),
            "min" => unit(Dimension::TIME, 60.0, 1.0),
            "N" => unit(Dimension::FORCE, 1.0, 1.0),
            "mm/s" => unit(Dimension::SPEED, 1.0, 1e3),
            "m/s" => unit(Dimension::SPEED, 1.0, 1.0),
            "deg/s" => unit(Dimension::TURN, PI, 180.0),
            "rad/s" => unit(Dimension::TURN, 1.0, 1.0),
            _ => None,
        }
    }

    /// A number of this unit in metres, radians, seconds and newtons.
    pub(crate) fn to_si(self, value: f64) -> f64 {
        value * self.times / self.over
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_of_the_lexer_is_known() {
        for name in obverse_syntax::UNITS {
            assert!(Unit::of_name(name).is_some(), "{name}");
        }
        assert_eq!(Unit::of_name("mmm"), None);
    }

    #[test]
    fn values_are_the_nearest_doubles() {
        let si = |value, name| Unit::of_name(name).map(|unit| unit.to_si(value));
        assert_eq!(si(0.1, "mm"), Some(0.0001));
        assert_eq!(si(300.0, "mm"), Some(0.3));
        assert_eq!(si(180.0, "deg"), Some(PI));
        assert_eq!(si(2.0, "min"), Some(120.0));
        assert_eq!(si(500.0, "ms"), Some(0.5));
    }

    #[test]
    fn products_quotients_and_roots_combine() {
        let area = Dimension::LENGTH.times(Dimension::LENGTH);
        assert_eq!(area.and_then(Dimension::root), Some(Dimension::LENGTH));
        assert_eq!(Dimension::LENGTH.root(), None);
        assert_eq!(Dimension::LENGTH.over(Dimension::TIME), Some(Dimension::SPEED));
        assert_eq!(Dimension::LENGTH.over(Dimension::LENGTH), Some(Dimension::NONE));
        assert_eq!(Dimension { length: 127, ..Dimension::NONE }.times(Dimension::LENGTH), None);
    }

    #[test]
    fn a_dimension_is_told_in_words_or_units() {
        assert_eq!(Dimension::SPEED.to_string(), "a speed");
        let stiffness = Dimension::FORCE.over(Dimension::LENGTH).expect("small exponents");
        assert_eq!(stiffness.to_string(), "a value in m^-1 N");
    }
}
