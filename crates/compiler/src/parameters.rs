//! What can be said of the parameters of actions without running anything: what each measures, its
//! range and its default; and other defaults in their place. It knows nothing of where those come
//! from.

use crate::types::{TYPE_NAMES, ValueType};
use crate::units::Unit;
use std::collections::BTreeMap;

/// Values that are put in the place of defaults: by action and parameter, in the unit of
/// [`Parameter::unit`]. What a program has no such parameter for is passed over.
pub type Defaults = BTreeMap<(String, String), f64>;

/// An action with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// Its name.
    pub name: String,
    /// Its parameters, in the order of their declaration.
    pub parameters: Vec<Parameter>,
}

/// A parameter of an action.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its type as it is written: `length`.
    pub type_name: &'static str,
    /// The unit of the numbers here: mm, deg, s, N or mm/s; empty for a number without one.
    pub unit: &'static str,
    /// Whether it is a whole number.
    pub is_integer: bool,
    /// The least and the most that it may be.
    pub range: Option<[f64; 2]>,
    /// What it is where a call does not say; none for what is no number too.
    pub default: Option<f64>,
    /// Whether some call leaves it to its default.
    pub is_left_to_default: bool,
}

/// The unit in which values of a type are said, if they are numbers.
pub(crate) fn unit_of(of_type: ValueType) -> Option<&'static str> {
    match of_type {
        ValueType::LENGTH => Some("mm"),
        ValueType::TIME => Some("s"),
        ValueType::FORCE => Some("N"),
        ValueType::ANGLE => Some("deg"),
        ValueType::SPEED => Some("mm/s"),
        ValueType::NUMBER | ValueType::Int => Some(""),
        _ => None,
    }
}

/// The name of a type.
pub(crate) fn name_of(of_type: ValueType) -> &'static str {
    TYPE_NAMES.iter().find(|(_, known)| *known == of_type).map_or("", |(name, _)| name)
}

/// A value of a unit in metres, radians, seconds and newtons.
pub(crate) fn to_si(value: f64, unit: &str) -> f64 {
    Unit::of_name(unit).map_or(value, |unit| unit.to_si(value))
}

/// The other way round, to the twelve digits that a unit made of another keeps.
pub(crate) fn of_si(value: f64, unit: &str) -> f64 {
    let said = value / to_si(1.0, unit);
    format!("{said:.11e}").parse().unwrap_or(said)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_said_as_it_was_written() {
        for (value, unit) in [(20.0, "mm"), (0.3, "mm"), (7.5, "deg"), (8.0, "N"), (0.1, "")] {
            assert_eq!(of_si(to_si(value, unit), unit), value, "{value} {unit}");
        }
        assert_eq!(unit_of(ValueType::Bool), None);
        assert_eq!(name_of(ValueType::FORCE), "force");
    }
}
