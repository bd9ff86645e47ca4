//! What numbers measure: metres, radians, seconds and newtons with their exponents; and how that is
//! written, in the units that people read.

use std::fmt;

/// How many digits behind the point are written at the most.
const DIGITS: usize = 4;

/// What a number measures. Its value is in SI units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// Of metres, radians, seconds and newtons.
    exponents: [i8; 4],
}

impl Unit {
    /// In metres.
    pub const LENGTH: Self = Self { exponents: [1, 0, 0, 0] };
    /// In radians.
    pub const ANGLE: Self = Self { exponents: [0, 1, 0, 0] };
    /// In seconds.
    pub const TIME: Self = Self { exponents: [0, 0, 1, 0] };
    /// In newtons.
    pub const FORCE: Self = Self { exponents: [0, 0, 0, 1] };
    const SPEED: Self = Self { exponents: [1, 0, -1, 0] };
    const TURN: Self = Self { exponents: [0, 1, -1, 0] };
    /// A plain number.
    pub(crate) const NONE: Self = Self { exponents: [0; 4] };

    /// Of these exponents of metres, radians, seconds and newtons.
    pub(crate) fn of(exponents: [i8; 4]) -> Self {
        Self { exponents }
    }

    /// That of a product; none if an exponent becomes too large.
    pub(crate) fn times(self, other: Self) -> Option<Self> {
        self.combine(other, i8::checked_add)
    }

    /// That of a quotient; none if an exponent becomes too large.
    pub(crate) fn over(self, other: Self) -> Option<Self> {
        self.combine(other, i8::checked_sub)
    }

    fn combine(self, other: Self, with: fn(i8, i8) -> Option<i8>) -> Option<Self> {
        let mut exponents = [0; 4];
        for (at, exponent) in exponents.iter_mut().enumerate() {
            *exponent = with(self.exponents[at], other.exponents[at])?;
        }
        Some(Self { exponents })
    }

    /// What it measures, in words.
    pub(crate) fn words(self) -> String {
        match self {
            Self::NONE => "a number without a unit".to_owned(),
            Self::LENGTH => "a length".to_owned(),
            Self::ANGLE => "an angle".to_owned(),
            Self::TIME => "a time".to_owned(),
            Self::FORCE => "a force".to_owned(),
            Self::SPEED => "a speed".to_owned(),
            Self::TURN => "a turning speed".to_owned(),
            _ => format!("a value in {self}"),
        }
    }

    /// A value of it, in SI units, as people read it.
    pub(crate) fn shown(self, value: f64) -> String {
        match self {
            Self::LENGTH => format!("{} mm", rounded(value * 1e3)),
            Self::ANGLE => format!("{} deg", rounded(value.to_degrees())),
            Self::SPEED => format!("{} mm/s", rounded(value * 1e3)),
            Self::TURN => format!("{} deg/s", rounded(value.to_degrees())),
            Self::TIME | Self::FORCE => format!("{} {self}", rounded(value)),
            _ => format!("{value:?} {self}"),
        }
    }
}

/// A number without digits that say nothing; nothing is no less than nothing.
fn rounded(value: f64) -> String {
    let text = format!("{value:.DIGITS$}");
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// The SI unit.
impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = ["m", "rad", "s", "N"].into_iter().zip(self.exponents);
        let power = |(name, exponent): (&str, i8)| match exponent {
            1 => name.to_owned(),
            _ => format!("{name}^{exponent}"),
        };
        let powers: Vec<String> = names.filter(|(_, exponent)| *exponent != 0).map(power).collect();
        f.write_str(&powers.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_written_in_the_units_that_people_read() {
        assert_eq!(Unit::LENGTH.shown(0.003), "3 mm");
        assert_eq!(Unit::ANGLE.shown(std::f64::consts::FRAC_PI_2), "90 deg");
        assert_eq!(Unit::FORCE.shown(-0.000_01), "0 N");
        assert_eq!(Unit::FORCE.shown(f64::INFINITY), "inf N");
        assert_eq!(Unit::TIME.shown(100.0), "100 s");
        assert_eq!(Unit::LENGTH.over(Unit::TIME).expect("small").shown(0.0015), "1.5 mm/s");
        assert_eq!(Unit::LENGTH.times(Unit::FORCE).expect("small").shown(0.5), "0.5 m N");
        assert_eq!(Unit::LENGTH.over(Unit::LENGTH), Some(Unit::NONE));
    }
}
