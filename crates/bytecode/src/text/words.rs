//! The words of assembly text for values that are one of a few, and numbers as text.

use crate::fault::FaultName;
use crate::module::{
    ActionKind, Constant, Continuation, Depth, FunctionKind, Pattern, Respond, Severity,
};
use obverse_isa::{Axis, Frame, Level, Operand, OperandKind, Path, Setting, SpeedId, Type};

/// A value that is written as a word.
pub(super) trait Word: Copy + 'static {
    /// What it is, for messages.
    const WHAT: &'static str;
    /// Every value.
    const ALL: &'static [Self];

    /// Its word.
    fn word(self) -> &'static str;

    /// The value of a word, if there is one.
    fn from_word(word: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|value| value.word() == word)
    }
}

macro_rules! words {
    ($($type:ident $what:literal { $($variant:ident $word:literal)* })*) => {$(
        impl Word for $type {
            const WHAT: &'static str = $what;
            const ALL: &'static [Self] = &[$(Self::$variant),*];

            fn word(self) -> &'static str {
                match self { $(Self::$variant => $word),* }
            }
        }
    )*};
}

words! {
    FunctionKind "kind of function" {
        Start "start"
        Sequence "sequence"
        Action "action"
        Io "io"
        AdvancedMove "advanced_move"
        Replacement "replacement"
        Cleanup "cleanup"
    }
    ActionKind "kind of action" {
        Move "move"
        Advance "advance"
        Call "call"
        Io "io"
        Primitive "primitive"
        Wait "wait"
    }
    Severity "severity" {
        Warning "warning"
        Recoverable "recoverable"
        Fatal "fatal"
    }
    Pattern "pattern" {
        Spiral "spiral"
        Random "random"
    }
    Respond "time to respond" {
        AtOnce "at_once"
        AfterAction "after_action"
        AfterSequence "after_sequence"
    }
    Continuation "continuation" {
        Action "action"
        NextAction "next_action"
        Sequence "sequence"
        Program "program"
        Stop "stop"
    }
}

impl Word for Depth {
    const WHAT: &'static str = "depth";
    const ALL: &'static [Self] = &[
        Self::Fixed,
        Self::Escalating { doubling: false },
        Self::Escalating { doubling: true },
        Self::Learned,
    ];

    fn word(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Escalating { doubling: false } => "escalating",
            Self::Escalating { doubling: true } => "doubling",
            Self::Learned => "learned",
        }
    }
}

impl Word for FaultName {
    const WHAT: &'static str = "fault";
    const ALL: &'static [Self] = &Self::ALL;

    fn word(self) -> &'static str {
        self.code()
    }
}

impl Word for Type {
    const WHAT: &'static str = "type";
    const ALL: &'static [Self] = &Type::ALL;

    fn word(self) -> &'static str {
        self.name()
    }
}

/// The word of an operand that is one of a few, if it is.
pub(super) fn choice_word(kind: OperandKind, number: i64) -> Option<&'static str> {
    match kind {
        OperandKind::Level => Level::from_number(number).ok().map(Level::name),
        OperandKind::Speed => SpeedId::from_number(number).ok().map(SpeedId::name),
        OperandKind::Setting => Setting::from_number(number).ok().map(Setting::name),
        OperandKind::Axis => Axis::from_number(number).ok().map(Axis::name),
        OperandKind::Frame => Frame::from_number(number).ok().map(Frame::name),
        OperandKind::Path => Path::from_number(number).ok().map(Path::name),
        _ => None,
    }
}

/// The words that an operand of a kind can be, in order; none if it is a number or a name.
pub(super) fn choices(kind: OperandKind) -> impl Iterator<Item = &'static str> {
    (0..).map_while(move |number| choice_word(kind, number))
}

/// The number of an operand that is one of a few; a level may be written as a truth value.
pub(super) fn choice_number(kind: OperandKind, word: &str) -> Option<i64> {
    match (kind, word) {
        (OperandKind::Level, "false") => Some(0),
        (OperandKind::Level, "true") => Some(1),
        _ => (0..).zip(choices(kind)).find(|(_, choice)| *choice == word).map(|(number, _)| number),
    }
}

/// A real: the shortest decimal that reads back as the same bits, or the bits where none does.
pub(super) fn real(value: f64) -> String {
    if value.is_finite() { format!("{value:?}") } else { format!("0x{:016x}", value.to_bits()) }
}

/// The real that a word is.
pub(super) fn parse_real(word: &str) -> Option<f64> {
    if let Some(bits) = word.strip_prefix("0x") {
        // `from_str_radix` would take a sign.
        let is_hex = bits.bytes().all(|byte| byte.is_ascii_hexdigit());
        return u64::from_str_radix(bits, 16).ok().filter(|_| is_hex).map(f64::from_bits);
    }
    let is_decimal = word.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    word.parse::<f64>().ok().filter(|value| is_decimal && value.is_finite())
}

/// A constant as an operand: an integer has neither point nor exponent, a real has.
pub(super) fn constant(value: Constant) -> String {
    match value {
        Constant::Int(value) => value.to_string(),
        Constant::Real(value) => real(value),
    }
}

/// The constant that an operand is.
pub(super) fn parse_constant(word: &str) -> Option<Constant> {
    match word.parse() {
        Ok(value) => Some(Constant::Int(value)),
        Err(_) if word.contains(['.', 'e', 'E', 'x']) => parse_real(word).map(Constant::Real),
        Err(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words_are_inverse<T: Word + PartialEq + std::fmt::Debug>() {
        for value in T::ALL {
            assert_eq!(T::from_word(value.word()), Some(*value));
        }
        assert_eq!(T::from_word("nonsense"), None);
    }

    #[test]
    fn every_word_reads_back() {
        words_are_inverse::<FunctionKind>();
        words_are_inverse::<ActionKind>();
        words_are_inverse::<Severity>();
        words_are_inverse::<Depth>();
        words_are_inverse::<Pattern>();
        words_are_inverse::<FaultName>();
        words_are_inverse::<Respond>();
        words_are_inverse::<Continuation>();
        words_are_inverse::<Type>();
    }

    #[test]
    fn every_choice_reads_back() {
        let kinds = [
            (OperandKind::Level, 2),
            (OperandKind::Speed, 6),
            (OperandKind::Setting, 5),
            (OperandKind::Axis, 6),
            (OperandKind::Frame, 3),
            (OperandKind::Path, 2),
            (OperandKind::Local, 0),
        ];
        for (kind, count) in kinds {
            assert_eq!(choices(kind).count(), count, "{kind:?}");
            for (number, word) in (0..).zip(choices(kind)) {
                assert_eq!(choice_number(kind, word), Some(number));
            }
            assert_eq!(choice_number(kind, "nonsense"), None);
        }
        assert_eq!(choice_number(OperandKind::Level, "true"), Some(1));
        assert_eq!(choice_number(OperandKind::Level, "false"), Some(0));
        assert_eq!(choice_number(OperandKind::Path, "true"), None);
    }

    #[test]
    fn reals_keep_their_bits() {
        let values = [
            0.0,
            -0.0,
            0.1,
            1.0,
            1e300,
            -1e-300,
            f64::MIN_POSITIVE,
            5e-324,
            f64::MAX,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            f64::from_bits(0xfff0_0000_dead_beef),
        ];
        for value in values {
            let text = real(value);
            assert_eq!(parse_real(&text).map(f64::to_bits), Some(value.to_bits()), "{text}");
            let constant = parse_constant(&text);
            assert_eq!(constant, Some(Constant::Real(value)), "{text}");
        }
    }

    #[test]
    fn what_is_no_real_is_refused() {
        for word in
            ["", "nan", "inf", "infinity", "1e999", "0x", "0x+1", "0x11111111111111111", "1_0"]
        {
            assert_eq!(parse_real(word), None, "{word}");
        }
    }

    #[test]
    fn integers_are_no_reals() {
        assert_eq!(parse_constant("5"), Some(Constant::Int(5)));
        assert_eq!(parse_constant("5.0"), Some(Constant::Real(5.0)));
        assert_eq!(parse_constant("-9223372036854775808"), Some(Constant::Int(i64::MIN)));
        assert_eq!(parse_constant("9223372036854775808"), None);
        assert_eq!(parse_constant("five"), None);
    }
}
