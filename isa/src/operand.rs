//! The types of operands: how each is laid out, read back from hostile bytes, and named.

use crate::columns::Type;

/// The kinds of operand, as the assembler, the verifier and the reference tell them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OperandKind {
    /// How many pure instructions come before this effect in its statement.
    Prefix,
    /// A signed number.
    Integer,
    /// An index into the constants of the module.
    Constant,
    /// A local variable of the frame.
    Local,
    /// A variable of the program.
    Global,
    /// A loop counter of the frame.
    Counter,
    /// A remembered position of the frame.
    Slot,
    /// A joint configuration of the module.
    Joints,
    /// An item of the module.
    Item,
    /// A keyframe of the module.
    Keyframe,
    /// A tool of the module.
    Tool,
    /// An error of the module.
    Error,
    /// A checkpoint of the module.
    Checkpoint,
    /// A reason of the module, in the programmer's words.
    Reason,
    /// A function of the module.
    Function,
    /// An instruction of the module.
    Label,
    /// A digital output or input of the workcell.
    Bit,
    /// `low` or `high`; `false` or `true`.
    Level,
    /// One of the speeds.
    Speed,
    /// Which setting.
    Setting,
    /// A signed axis.
    Axis,
    /// A frame.
    Frame,
    /// The path of a motion.
    Path,
}

/// An operand that has no such value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OperandError {
    /// The kind of the operand.
    pub kind: OperandKind,
    /// What was found.
    pub value: i64,
}

/// A type that can be an operand of an instruction.
pub trait Operand: Copy {
    /// Its kind.
    const KIND: OperandKind;
    /// How many bytes it takes.
    const BYTES: usize;

    /// Its value as a number.
    fn to_number(self) -> i64;

    /// The operand of this value.
    ///
    /// # Errors
    /// If there is none.
    fn from_number(value: i64) -> Result<Self, OperandError>;

    /// The prefix length, if this operand is one.
    #[inline(always)]
    fn as_prefix(self) -> u8 {
        0
    }
}

macro_rules! index_operand {
    ($($(#[doc = $doc:literal])+ $name:ident($repr:ty) $kind:ident;)*) => {$(
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub $repr);

        impl Operand for $name {
            const KIND: OperandKind = OperandKind::$kind;
            const BYTES: usize = size_of::<$repr>();

            fn to_number(self) -> i64 {
                i64::from(self.0)
            }

            fn from_number(value: i64) -> Result<Self, OperandError> {
                let index = <$repr>::try_from(value).map(Self);
                index.map_err(|_| OperandError { kind: Self::KIND, value })
            }
        }

        impl $name {
            /// As an index.
            #[inline(always)]
            #[must_use]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

index_operand! {
    /// A constant of the module.
    ConstantId(u16) Constant;
    /// A local variable of the frame.
    LocalId(u8) Local;
    /// A variable of the program.
    GlobalId(u16) Global;
    /// A loop counter of the frame.
    CounterId(u8) Counter;
    /// A remembered position of the frame.
    SlotId(u8) Slot;
    /// A joint configuration of the module.
    JointsId(u16) Joints;
    /// An item of the module.
    ItemId(u16) Item;
    /// A keyframe of the module.
    KeyframeId(u16) Keyframe;
    /// A tool of the module.
    ToolId(u16) Tool;
    /// An error of the module.
    ErrorId(u16) Error;
    /// A checkpoint of the module.
    CheckpointId(u16) Checkpoint;
    /// A reason of the module.
    ReasonId(u16) Reason;
    /// A function of the module.
    FunctionId(u16) Function;
    /// The index of an instruction.
    Label(u32) Label;
    /// A digital output or input.
    Bit(u16) Bit;
}

/// How many pure instructions come before an effect in its statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Prefix(pub u8);

impl Operand for Prefix {
    const KIND: OperandKind = OperandKind::Prefix;
    const BYTES: usize = 1;

    fn to_number(self) -> i64 {
        i64::from(self.0)
    }

    fn from_number(value: i64) -> Result<Self, OperandError> {
        u8::try_from(value).map(Self).map_err(|_| OperandError { kind: Self::KIND, value })
    }

    #[inline(always)]
    fn as_prefix(self) -> u8 {
        self.0
    }
}

macro_rules! number_operand {
    ($($name:ty)*) => {$(
        impl Operand for $name {
            const KIND: OperandKind = OperandKind::Integer;
            const BYTES: usize = size_of::<$name>();

            fn to_number(self) -> i64 {
                i64::from(self)
            }

            fn from_number(value: i64) -> Result<Self, OperandError> {
                <$name>::try_from(value).map_err(|_| OperandError { kind: Self::KIND, value })
            }
        }
    )*};
}

number_operand! { i16 i32 }

macro_rules! choice_operand {
    ($($(#[doc = $doc:literal])+ $name:ident $kind:ident {
        $($(#[doc = $item_doc:literal])+ $item:ident = $number:literal $text:literal,)*
    })*) => {$(
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name { $($(#[doc = $item_doc])+ $item = $number,)* }

        impl $name {
            /// Every choice.
            pub const ALL: &'static [Self] = &[$(Self::$item,)*];

            /// The word in assembly text.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$item => $text,)* }
            }
        }

        impl Operand for $name {
            const KIND: OperandKind = OperandKind::$kind;
            const BYTES: usize = 1;

            fn to_number(self) -> i64 {
                self as i64
            }

            fn from_number(value: i64) -> Result<Self, OperandError> {
                match value {
                    $($number => Ok(Self::$item),)*
                    _ => Err(OperandError { kind: Self::KIND, value }),
                }
            }
        }
    )*};
}

choice_operand! {
    /// A level of a digital line, or a truth value.
    Level Level {
        /// Low; false.
        Low = 0 "low",
        /// High; true.
        High = 1 "high",
    }
    /// A speed by identity, slowest first.
    SpeedId Speed {
        /// The slowest.
        VerySlow = 0 "very_slow",
        /// Below normal.
        Slow = 1 "slow",
        /// What holds where a program names none.
        Normal = 2 "normal",
        /// Above normal.
        Fast = 3 "fast",
        /// The fastest.
        VeryFast = 4 "very_fast",
        /// None is named: normal going forward; in reverse, that of the way forward.
        Unnamed = 5 "unnamed",
    }
    /// What holds for the motions that follow.
    Setting Setting {
        /// The speed.
        Speed = 0 "speed",
        /// The tool.
        Tool = 1 "tool",
        /// The speed of motions that go back.
        ReverseSpeed = 2 "reverse.speed",
        /// The force in newtons that stops a motion that goes back; infinite for none.
        ReverseForceLimit = 3 "reverse.force_limit",
        /// Whether motions go back on a straight line of the tool, whatever way they came.
        ReverseStraight = 4 "reverse.straight",
    }
    /// A signed axis of a frame.
    Axis Axis {
        /// +x
        PlusX = 0 "+x",
        /// -x
        MinusX = 1 "-x",
        /// +y
        PlusY = 2 "+y",
        /// -y
        MinusY = 3 "-y",
        /// +z
        PlusZ = 4 "+z",
        /// -z
        MinusZ = 5 "-z",
    }
    /// The frame of a direction.
    Frame Frame {
        /// The tool centre point.
        Tcp = 0 "tcp",
        /// The flange that carries the tool.
        ToolMount = 1 "toolmount",
        /// The base of the arm.
        Base = 2 "base",
    }
    /// The path of a motion.
    Path Path {
        /// Straight in joint space.
        Joint = 0 "joint",
        /// The tool centre point on a straight line.
        Linear = 1 "linear",
    }
}

impl Level {
    /// Whether this is high, or true.
    #[must_use]
    pub fn is_high(self) -> bool {
        self == Self::High
    }
}

impl Setting {
    /// The type of its values.
    #[must_use]
    pub fn of_type(self) -> Type {
        match self {
            Self::Speed | Self::ReverseSpeed => Type::Speed,
            Self::Tool => Type::Tool,
            Self::ReverseForceLimit => Type::Real,
            Self::ReverseStraight => Type::Bool,
        }
    }

    /// What it is before a program sets it: the bits of a value of its type. The tool is the
    /// workcell's to say.
    #[must_use]
    pub fn initial(self) -> u64 {
        match self {
            Self::Speed => SpeedId::Normal as u64,
            Self::ReverseSpeed => SpeedId::Unnamed as u64,
            Self::ReverseForceLimit => f64::INFINITY.to_bits(),
            Self::Tool | Self::ReverseStraight => 0,
        }
    }
}
