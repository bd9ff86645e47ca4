//! A module as data: tables, functions, code, and the map back to the source.
//!
//! Indices are into the tables of the same module; [`verify`](mod@crate::verify) says what must
//! hold of them. Lengths are metres, angles radians, times seconds.

use crate::fault::{Bounds, FaultName, Watched};
use crate::places::Places;
use obverse_isa::{Instr, Type};
use serde::{Deserialize, Serialize};

/// A compiled program.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Module {
    /// The source files, so that positions can be shown wherever the module goes.
    pub sources: Vec<SourceFile>,
    /// The workcell file as the program names it, relative to the program.
    pub cell: Option<String>,
    /// Numbers.
    pub constants: Vec<Constant>,
    /// Joint configurations by name.
    pub joints: Vec<(String, [f64; 6])>,
    /// Items by name, with the keyframes they have.
    pub items: Vec<Item>,
    /// The names of keyframes.
    pub keyframes: Vec<String>,
    /// The names of tools.
    pub tools: Vec<String>,
    /// The errors that the program declares.
    pub errors: Vec<ErrorDeclaration>,
    /// The names of checkpoints.
    pub checkpoints: Vec<String>,
    /// Reasons in the programmer's words.
    pub reasons: Vec<String>,
    /// Variables of the program.
    pub globals: Vec<Variable>,
    /// Functions in the order of their code; the first is where the program starts.
    pub functions: Vec<Function>,
    /// The function that runs at the end of the program, whatever came before.
    pub cleanup: Option<u16>,
    /// Everything that runs.
    #[serde(with = "crate::wire::code")]
    pub code: Vec<Instr>,
    /// From instructions to the source, by ascending first instruction.
    pub source_map: Vec<SourceEntry>,
    /// Where the program speaks of what its workcell must have.
    pub mentions: Vec<Mention>,
    /// What the program calls the counters of its loops, by ascending instruction.
    pub loops: Vec<LoopName>,
}

/// A source file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceFile {
    /// Its name as given to the compiler.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// A number.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub enum Constant {
    /// An integer.
    Int(i64),
    /// A real; compared by its bits.
    Real(f64),
}

impl PartialEq for Constant {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Int(a), Self::Int(b)) => a == b,
            (Self::Real(a), Self::Real(b)) => a.to_bits() == b.to_bits(),
            _ => false,
        }
    }
}

impl Constant {
    /// Its type.
    #[must_use]
    pub fn of_type(self) -> Type {
        match self {
            Self::Int(_) => Type::Int,
            Self::Real(_) => Type::Real,
        }
    }

    /// Its bits as a value of the machine.
    #[must_use]
    pub fn bits(self) -> u64 {
        match self {
            Self::Int(value) => value.cast_unsigned(),
            Self::Real(value) => value.to_bits(),
        }
    }
}

/// An item of the workcell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Item {
    /// Its name, also in the workcell.
    pub name: String,
    /// Its keyframes, at most one of a name.
    pub keyframes: Vec<Keyframe>,
}

/// A pose of the tool centre point in an item's frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Keyframe {
    /// The name, as an index into the module's keyframe names.
    pub name: u16,
    /// x, y, z in metres.
    pub position_m: [f64; 3],
    /// Axis times angle, in radians.
    pub rotation_rad: [f64; 3],
}

/// A variable of the program or of a function; all begin as zero bits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Variable {
    /// Its name; hidden variables begin with `$`.
    pub name: String,
    /// Its type.
    #[serde(with = "crate::wire::value_type")]
    pub of_type: Type,
    /// What a real measures, for who looks at it: the exponents of metres, radians, seconds and
    /// newtons. None if that is not known.
    pub measures: Option<[i8; 4]>,
}

/// A function: a sequence, an action, an I/O operation, an advanced move, or the start.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// What it was in the source.
    pub kind: FunctionKind,
    /// How many of the locals are parameters, from the first.
    pub parameters: u8,
    /// Its local variables, at most 256.
    pub locals: Vec<Variable>,
    /// How many loop counters it has.
    pub counters: u8,
    /// The names of the positions it can remember.
    pub slots: Vec<String>,
    /// Its first instruction.
    pub first: u32,
    /// One past its last instruction.
    pub end: u32,
}

/// What a function was in the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FunctionKind {
    /// Sets the program's variables to their first values, calls the main sequence, and halts.
    Start,
    /// A sequence.
    Sequence,
    /// An action.
    Action,
    /// An I/O operation.
    Io,
    /// An advanced move.
    AdvancedMove,
    /// A block that takes another one's place in reverse.
    Replacement,
    /// What runs at the end of the program, whatever came before.
    Cleanup,
}

/// Where a row of instructions comes from: from `first` up to the next entry's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceEntry {
    /// The first instruction.
    pub first: u32,
    /// Which source file.
    pub file: u16,
    /// The first byte in it.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
    /// What begins here, if it is an action of the robot that a story tells and a recovery counts.
    pub action: Option<ActionKind>,
}

/// A place where the program speaks of something that its workcell must have.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mention {
    /// Of what.
    pub what: Mentioned,
    /// In which source file.
    pub file: u16,
    /// The first byte in it.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

/// What a program speaks of that its workcell must have.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mentioned {
    /// The workcell file.
    Cell,
    /// An item of the module's table.
    Item(u16),
    /// A tool of the module's table.
    Tool(u16),
    /// A digital output.
    Output {
        /// What the program calls it.
        name: String,
        /// Its number in the workcell.
        bit: u16,
    },
    /// A digital input.
    Input {
        /// What the program calls it.
        name: String,
        /// Its number in the workcell.
        bit: u16,
    },
}

/// What the program calls the counter of a loop, for who looks at it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LoopName {
    /// The instruction that enters the loop.
    pub enter: u32,
    /// The name.
    pub name: String,
    /// Whether it counts down: it is the complement of the counter then.
    pub is_down: bool,
}

/// The kinds of action, in the words of a story.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ActionKind {
    /// A move.
    Move,
    /// An advanced move.
    Advance,
    /// A call of a sequence or an action.
    Call,
    /// An I/O operation.
    Io,
    /// A primitive outside an I/O operation.
    Primitive,
    /// A wait.
    Wait,
}

/// An error that the program declares.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorDeclaration {
    /// Its name.
    pub name: String,
    /// How bad it is.
    pub severity: Severity,
    /// The faults of the workcell that raise it, ascending; none of them raises another error.
    pub faults: Vec<FaultName>,
    /// What raises it when it comes to hold while the program acts.
    pub watches: Vec<Watched>,
    /// What recovering from one incident may cost.
    pub bounds: Bounds,
    /// How it is recovered from.
    pub recovery: Recovery,
    /// What follows when recovering has been given up.
    pub otherwise: Otherwise,
    /// When it is responded to.
    pub respond: Respond,
    /// How the program goes on afterwards.
    pub continuation: Continuation,
}

impl ErrorDeclaration {
    /// Whether the workcell may raise it, by whatever acts.
    #[must_use]
    pub fn is_raised_by_workcell(&self) -> bool {
        !self.faults.is_empty() || !self.watches.is_empty()
    }

    /// Whether an act ends where what is watched for it comes to hold. A warning is noted, and
    /// stops nothing.
    #[must_use]
    pub fn interrupts(&self) -> bool {
        self.respond == Respond::AtOnce && self.severity != Severity::Warning
    }

    /// Whether what raises it ends the act at hand before it is done.
    #[must_use]
    pub fn ends_acts(&self) -> bool {
        !self.faults.is_empty() || (!self.watches.is_empty() && self.interrupts())
    }
}

/// How bad an error is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Severity {
    /// It is noted, and the program goes on.
    Warning,
    /// Its recovery is tried.
    Recoverable,
    /// The program stops.
    Fatal,
}

/// How an error is recovered from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Recovery {
    /// Not at all: what `otherwise` says follows at once.
    None,
    /// By a function, which the code itself calls.
    Using(u16),
    /// By reversal.
    Reversing(Reversal),
}

/// A policy of recovery by reversal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reversal {
    /// How the depth changes from one attempt to the next.
    pub depth: Depth,
    /// How far it may go.
    pub extent: Extent,
    /// How the failed motion is offset sideways on the way forward again, if it is.
    pub perturbation: Option<Perturbation>,
    /// Whether it goes forward again slower.
    pub slower: bool,
    /// Whether it goes forward again with less force.
    pub lighter: bool,
}

/// How the depth of a reversal changes from one attempt to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Depth {
    /// It does not.
    Fixed,
    /// Further each time the same error comes from the same place.
    Escalating {
        /// Whether twice as far each time, instead of one action further.
        doubling: bool,
    },
    /// As far as experience says.
    Learned,
}

/// How a motion is offset sideways when it is tried again.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Perturbation {
    /// The largest offset, in metres.
    pub limit_m: f64,
    /// How the offsets of one attempt and the next lie.
    pub pattern: Pattern,
}

/// How the offsets of one attempt and the next lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Pattern {
    /// On a spiral from the middle outwards.
    Spiral,
    /// At random within the limit.
    Random,
}

/// The bound of a reversal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Extent {
    /// So many actions.
    Actions(u32),
    /// To a checkpoint.
    Checkpoint(u16),
    /// To the start of the sequence.
    Sequence,
}

/// What follows when recovering has been given up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Otherwise {
    /// A function, which the code itself calls.
    Using(u16),
    /// A person is called.
    Operator,
    /// The program stops.
    Stop,
}

/// When an error is responded to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Respond {
    /// At once.
    AtOnce,
    /// After the action that raised it.
    AfterAction,
    /// After the sequence that raised it.
    AfterSequence,
}

/// How the program goes on after a recovery.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Continuation {
    /// The action again.
    Action,
    /// The next action.
    NextAction,
    /// The sequence again.
    Sequence,
    /// The program again.
    Program,
    /// Not at all.
    Stop,
}

impl Module {
    /// The function that an instruction belongs to, as an index.
    #[must_use]
    pub fn function_at(&self, pc: u32) -> Option<usize> {
        let after = self.functions.partition_point(|function| function.first <= pc);
        let index = after.checked_sub(1)?;
        (pc < self.functions[index].end).then_some(index)
    }

    /// The source entry that an instruction belongs to.
    #[must_use]
    pub fn source_at(&self, pc: u32) -> Option<&SourceEntry> {
        let after = self.source_map.partition_point(|entry| entry.first <= pc);
        self.source_map.get(after.checked_sub(1)?)
    }

    /// The line and column, from 1, of an instruction's source, with the file's name. Reads the
    /// sources: who asks of many instructions keeps [`Places`].
    #[must_use]
    pub fn place_of(&self, pc: u32) -> Option<(&str, usize, usize)> {
        Places::new(self).of(pc)
    }

    /// The line and column, from 1, of where the program speaks of something, with the file's name.
    #[must_use]
    pub fn place_of_mention(&self, mention: &Mention) -> Option<(&str, usize, usize)> {
        Places::new(self).of_mention(mention)
    }
}
