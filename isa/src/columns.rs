//! The vocabulary of the table's columns: types, stack pictures, classes, records, families.

use std::fmt;

/// The type of a value on the operand stack or in a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Type {
    /// A 64-bit integer that wraps.
    Int,
    /// An IEEE double.
    Real,
    /// True or false.
    Bool,
    /// A joint configuration of the module, by index.
    Joints,
    /// An item of the module, by index.
    Item,
    /// A speed, by identity.
    Speed,
    /// A tool of the module, by index.
    Tool,
}

impl Type {
    /// Every type.
    pub const ALL: [Self; 7] =
        [Self::Int, Self::Real, Self::Bool, Self::Joints, Self::Item, Self::Speed, Self::Tool];

    /// The name in assembly text and messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Int => "int",
            Self::Real => "real",
            Self::Bool => "bool",
            Self::Joints => "joints",
            Self::Item => "item",
            Self::Speed => "speed",
            Self::Tool => "tool",
        }
    }
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One entry of a stack picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StackItem {
    /// Of this type.
    Of(Type),
    /// Of the type of the local that the instruction names.
    Local,
    /// Of the type of the global that the instruction names.
    Global,
    /// Of the type of the constant that the instruction names.
    Constant,
    /// Of the type of the setting that the instruction names.
    Setting,
    /// The parameters of the function that the instruction names.
    Parameters,
}

impl fmt::Display for StackItem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Of(of) => f.write_str(of.name()),
            Self::Local => f.write_str("local"),
            Self::Global => f.write_str("global"),
            Self::Constant => f.write_str("constant"),
            Self::Setting => f.write_str("setting"),
            Self::Parameters => f.write_str("parameters"),
        }
    }
}

/// What an instruction leaves on the tape so that it can be reversed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordKind {
    /// One bit.
    Bit,
    /// One word of 64 bits.
    Word,
    /// The three words of a loop counter.
    Counter,
    /// A joint configuration: 48 bytes.
    Joints,
    /// The locals, counters and remembered positions of a frame.
    Frame,
    /// Which task's turn ended, after how many steps, and the times that this changed: three words.
    Switch,
    /// The tasks that were held when a fork was left.
    Tasks,
}

impl RecordKind {
    /// The name in documents.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bit => "bit",
            Self::Word => "word",
            Self::Counter => "counter",
            Self::Joints => "joints",
            Self::Frame => "frame",
            Self::Switch => "switch",
            Self::Tasks => "tasks",
        }
    }
}

/// Whether an instruction can be reversed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// In any state, without a record.
    Always,
    /// Once it has been run forward and has left its record.
    AfterForward(RecordKind),
    /// Not at all, for this reason.
    Never(&'static str),
}

impl Class {
    /// The class's name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Always => "always",
            Self::AfterForward(_) => "after-forward",
            Self::Never(_) => "never",
        }
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Always => f.write_str("always"),
            Self::AfterForward(kind) => write!(f, "after-forward({})", kind.name()),
            Self::Never(why) => write!(f, "never({why})"),
        }
    }
}

/// What part of the machine an instruction touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Pure: the operand stack alone. All other families are effects, which end a statement.
    Value,
    /// A variable.
    Variable,
    /// Where the program goes on within a function.
    Flow,
    /// Calls, returns, and the end.
    Frame,
    /// What holds for the motions that follow.
    Setting,
    /// The arm.
    Kinematic,
    /// A reading of the outside, stored into a variable.
    Sense,
    /// Outputs and time.
    Io,
    /// How far and how the program can be reversed.
    Reversal,
    /// The errors that the program has raised.
    Error,
    /// The branches of a fork, which take turns.
    Task,
}

impl Family {
    /// Every family in the order of the table.
    pub const ALL: [Self; 11] = [
        Self::Value,
        Self::Variable,
        Self::Flow,
        Self::Frame,
        Self::Setting,
        Self::Kinematic,
        Self::Sense,
        Self::Io,
        Self::Reversal,
        Self::Error,
        Self::Task,
    ];

    /// The family's name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Value => "value",
            Self::Variable => "variable",
            Self::Flow => "flow",
            Self::Frame => "frame",
            Self::Setting => "setting",
            Self::Kinematic => "kinematic",
            Self::Sense => "sense",
            Self::Io => "io",
            Self::Reversal => "reversal",
            Self::Error => "error",
            Self::Task => "task",
        }
    }

    /// Whether instructions of this family touch the operand stack alone.
    #[must_use]
    pub fn is_pure(self) -> bool {
        self == Self::Value
    }

    /// Whether instructions of this family command the workcell.
    #[must_use]
    pub fn commands_workcell(self) -> bool {
        matches!(self, Self::Kinematic | Self::Io)
    }
}
