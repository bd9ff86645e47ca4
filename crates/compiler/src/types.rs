//! The types of the language, and how each is kept in the machine.

use crate::units::Dimension;
use obverse_isa::Type;
use std::fmt;

/// The type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ValueType {
    /// A 64-bit integer that wraps.
    Int,
    /// A double of a dimension, in SI units.
    Real(Dimension),
    /// True or false.
    Bool,
    /// A joint configuration.
    Joints,
    /// An item.
    Item,
    /// That of an expression with a mistake: nothing more is said about it.
    Unknown,
}

/// The names of the types, as they stand in declarations.
pub(crate) const TYPE_NAMES: [(&str, ValueType); 10] = [
    ("int", ValueType::Int),
    ("number", ValueType::Real(Dimension::NONE)),
    ("length", ValueType::Real(Dimension::LENGTH)),
    ("angle", ValueType::Real(Dimension::ANGLE)),
    ("time", ValueType::Real(Dimension::TIME)),
    ("force", ValueType::Real(Dimension::FORCE)),
    ("speed", ValueType::Real(Dimension::SPEED)),
    ("bool", ValueType::Bool),
    ("joints", ValueType::Joints),
    ("item", ValueType::Item),
];

impl ValueType {
    /// A real without a unit.
    pub(crate) const NUMBER: Self = Self::Real(Dimension::NONE);
    /// A real in metres.
    pub(crate) const LENGTH: Self = Self::Real(Dimension::LENGTH);
    /// A real in seconds.
    pub(crate) const TIME: Self = Self::Real(Dimension::TIME);
    /// A real in radians.
    pub(crate) const ANGLE: Self = Self::Real(Dimension::ANGLE);
    /// A real in metres per second.
    pub(crate) const SPEED: Self = Self::Real(Dimension::SPEED);
    /// A real in newtons.
    pub(crate) const FORCE: Self = Self::Real(Dimension::FORCE);

    /// The type of this name.
    pub(crate) fn of_name(name: &str) -> Option<Self> {
        TYPE_NAMES.iter().find(|(known, _)| *known == name).map(|(_, of_type)| *of_type)
    }

    /// How a value of this type is kept in the machine.
    pub(crate) fn machine(self) -> Type {
        match self {
            Self::Int | Self::Unknown => Type::Int,
            Self::Real(_) => Type::Real,
            Self::Bool => Type::Bool,
            Self::Joints => Type::Joints,
            Self::Item => Type::Item,
        }
    }

    /// What a real of this type measures: exponents of metres, radians, seconds and newtons.
    pub(crate) fn measures(self) -> Option<[i8; 4]> {
        match self {
            Self::Real(dimension) => Some(dimension.exponents()),
            Self::Int | Self::Bool | Self::Joints | Self::Item | Self::Unknown => None,
        }
    }

    /// Whether a mistake has been reported already.
    pub(crate) fn is_unknown(self) -> bool {
        self == Self::Unknown
    }
}

impl fmt::Display for ValueType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Int => f.write_str("an integer"),
            Self::Real(dimension) => dimension.fmt(f),
            Self::Bool => f.write_str("a truth value"),
            Self::Joints => f.write_str("a joint configuration"),
            Self::Item => f.write_str("an item"),
            Self::Unknown => f.write_str("a value"),
        }
    }
}
