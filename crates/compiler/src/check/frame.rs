//! The frame of the function that is being checked: its locals, hidden ones among them, and what
//! stands around the statement in hand. Knows nothing of names.

use crate::tree::{Hoist, Layout, MoveResults};
use obverse_isa::{FunctionId, JointsId, LocalId, Setting, Type};
use obverse_syntax::span::Span;

/// What becomes of a reading in an expression.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Readings {
    /// It is taken before the statement.
    Taken,
    /// `distance` and `force` are those of the move; others are taken.
    OfMove(MoveResults),
    /// It is a mistake, since the expression is an assertion.
    Asserted,
    /// It is a mistake, since the value must be known now.
    Constant,
}

/// What stands around a statement, from the outside in.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Around {
    /// A loop, and whether a `break` that is reached leaves it.
    Loop {
        /// Whether it does.
        breaks: bool,
    },
    /// A block with a reverse of its own.
    Reversed(Span),
    /// A branch of this fork.
    Branch(Span),
}

/// The position that the program named last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NamedPosition {
    /// This configuration.
    Known(JointsId),
    /// None, since this came between.
    Lost(&'static str, Span),
}

/// What is known of the function that is being checked.
#[derive(Debug)]
pub(crate) struct FrameScope {
    /// Which function it is.
    pub(crate) function: FunctionId,
    /// Its name.
    pub(crate) name: String,
    /// Its layout so far.
    pub(crate) layout: Layout,
    /// Settings that hold to its end.
    pub(crate) modal: Vec<(Setting, LocalId)>,
    /// What becomes of readings.
    pub(crate) readings: Readings,
    /// What stands around.
    pub(crate) around: Vec<Around>,
    /// How many counters are in use.
    pub(crate) counters: u8,
    /// How many were in use at a time, since the branch of a fork began.
    pub(crate) counter_peak: u8,
    /// The position named last.
    pub(crate) named: NamedPosition,
    /// Whether what is being checked is never reached.
    pub(crate) is_dead: bool,
    /// Whether a limit has been reported.
    pub(crate) is_full: bool,
    /// How many blocks in reverse have been made functions of.
    pub(crate) replacements: usize,
    /// In a block that keeps its order in reverse: how many positions were remembered before it.
    pub(crate) kept_positions: usize,
    hoists: Vec<Hoist>,
    busy: Vec<LocalId>,
    /// The hidden locals that nothing keeps.
    pub(crate) free: Vec<LocalId>,
}

impl FrameScope {
    /// The frame of a function that begins here.
    pub(crate) fn new(function: FunctionId, name: &str, begins: Span) -> Self {
        Self {
            function,
            name: name.to_owned(),
            layout: Layout::default(),
            modal: Vec::new(),
            readings: Readings::Taken,
            around: Vec::new(),
            counters: 0,
            counter_peak: 0,
            named: NamedPosition::Lost("the sequence begins here, wherever the arm is", begins),
            is_dead: false,
            is_full: false,
            replacements: 0,
            kept_positions: 0,
            hoists: Vec::new(),
            busy: Vec::new(),
            free: Vec::new(),
        }
    }

    /// A hidden local that is kept until it is given back.
    pub(crate) fn hidden(&mut self, name: &str, of_type: Type) -> Option<LocalId> {
        let is_fit = |local: &LocalId| {
            let known = &self.layout.locals[local.index()];
            known.of_type == of_type
                && known.name.trim_end_matches(|c: char| c.is_ascii_digit()) == format!("${name}")
        };
        match self.free.iter().position(is_fit) {
            Some(index) => Some(self.free.remove(index)),
            None => self.layout.add_hidden(name, of_type),
        }
    }

    /// A hidden local for the statement in hand.
    pub(crate) fn temporary(&mut self, of_type: Type) -> Option<LocalId> {
        let local = self.hidden("", of_type)?;
        self.busy.push(local);
        Some(local)
    }

    /// Give a hidden local back.
    pub(crate) fn give_back(&mut self, local: LocalId) {
        self.free.push(local);
        self.free.sort_unstable();
    }

    /// A new statement: the hidden locals of the one before are free again.
    pub(crate) fn begin_statement(&mut self) {
        self.free.append(&mut self.busy);
        self.free.sort_unstable();
    }

    /// Something to be done before the statement in hand.
    pub(crate) fn hoist(&mut self, hoist: Hoist) {
        self.hoists.push(hoist);
    }

    /// What is to be done before the statement in hand.
    pub(crate) fn take_hoists(&mut self) -> Vec<Hoist> {
        std::mem::take(&mut self.hoists)
    }
}
