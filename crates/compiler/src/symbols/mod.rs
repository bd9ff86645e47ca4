//! Where each name of a program is declared, used and assigned.
//!
//! The table is of the tree as far as there is one, and of the same scopes as the check: what the
//! check resolves stands here, also of a program that has mistakes elsewhere. Names that are not
//! the program's own (types, functions, the tools of the workcell) are among them, declared
//! nowhere. Read [`Symbol`], [`Occurrence`], [`Symbols`]; `scopes` knows what can be seen where,
//! `walk` goes through declarations and `body` through statements. It knows no machine and no code.

mod body;
mod scopes;
mod walk;

use crate::check::FUNCTIONS;
use crate::types::{TYPE_NAMES, ValueType};
use obverse_syntax::ast::Program;
use obverse_syntax::span::Span;
use std::collections::HashMap;

/// What a name is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SymbolKind {
    /// An I/O operation.
    Io,
    /// An output of the workcell.
    Output,
    /// An input of the workcell.
    Input,
    /// A joint configuration.
    Joints,
    /// An item.
    Item,
    /// A keyframe of an item.
    Keyframe,
    /// An error.
    Error,
    /// An advanced move.
    AdvancedMove,
    /// A variable of the program.
    Variable,
    /// A sequence.
    Sequence,
    /// An action.
    Action,
    /// A parameter of a sequence or an action.
    Parameter,
    /// A variable of a sequence.
    Local,
    /// The counter of a loop.
    Counter,
    /// A remembered position.
    Position,
    /// A checkpoint.
    Checkpoint,
    /// A tool of the workcell.
    Tool,
    /// A type of the language.
    Type,
    /// A function of the language.
    Function,
}

impl SymbolKind {
    /// The kind in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Io => "I/O operation",
            Self::Output => "output",
            Self::Input => "input",
            Self::Joints => "joint configuration",
            Self::Item => "item",
            Self::Keyframe => "keyframe",
            Self::Error => "error",
            Self::AdvancedMove => "advanced move",
            Self::Variable => "variable of the program",
            Self::Sequence => "sequence",
            Self::Action => "action",
            Self::Parameter => "parameter",
            Self::Local => "variable",
            Self::Counter => "counter of a loop",
            Self::Position => "position",
            Self::Checkpoint => "checkpoint",
            Self::Tool => "tool of the workcell",
            Self::Type => "type",
            Self::Function => "function",
        }
    }

    /// Whether names of this kind are seen together with those of variables, so that one of them
    /// hides another. Keyframes, checkpoints and what is not the program's own are apart.
    #[must_use]
    pub fn is_common(self) -> bool {
        !matches!(
            self,
            Self::Keyframe | Self::Checkpoint | Self::Tool | Self::Type | Self::Function
        )
    }
}

/// Something with a name, as an index into [`Symbols::symbols`].
pub type SymbolId = usize;

/// Something with a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: SymbolKind,
    /// Where its name is given: once, but for checkpoints that are set in several places, positions
    /// that are remembered anew, and keyframes that items share through a parameter. Empty for what
    /// is not the program's own.
    pub declared: Vec<Span>,
    /// All that is written of its first declaration.
    pub whole: Span,
    /// Where it can be named.
    pub scope: Span,
    /// What it is declared in: the item of a keyframe, the sequence of a variable.
    pub parent: Option<SymbolId>,
    /// The type of its values in words, if it has values and their type is known: `a length`.
    pub of_type: Option<String>,
}

/// The names of the types of the language.
#[must_use]
pub fn types() -> Vec<&'static str> {
    TYPE_NAMES.iter().map(|(name, _)| *name).collect()
}

/// The names of the functions of the language, and how many arguments each takes.
#[must_use]
pub fn functions() -> Vec<(&'static str, usize)> {
    FUNCTIONS.to_vec()
}

/// What is done with a name where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// It is given.
    Declares,
    /// What it names is used.
    Uses,
    /// Something is assigned to what it names.
    Assigns,
}

/// A place where a name stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// Where.
    pub span: Span,
    /// What it names; none for a name that nothing has.
    pub symbol: Option<SymbolId>,
    /// What is done with it.
    pub role: Role,
}

/// All names of a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Symbols {
    /// What they name: first what is declared at the top of files, in the order of the program.
    pub symbols: Vec<Symbol>,
    /// Where they stand, by place.
    pub occurrences: Vec<Occurrence>,
}

impl Symbols {
    /// Those of a tree of a source, with the types that the check has found for what is declared at
    /// a place.
    pub(crate) fn of(source: &str, program: &Program<'_>, types: Vec<(Span, ValueType)>) -> Self {
        let types: HashMap<Span, ValueType> = types.into_iter().collect();
        let mut symbols = walk::walk(source, program);
        for symbol in &mut symbols.symbols {
            let of_type = symbol.declared.first().and_then(|span| types.get(span));
            symbol.of_type = of_type.filter(|found| !found.is_unknown()).map(ToString::to_string);
        }
        symbols
    }

    /// The name that stands at a position, or ends there.
    #[must_use]
    pub fn at(&self, offset: u32) -> Option<&Occurrence> {
        let after = self.occurrences.partition_point(|one| one.span.start <= offset);
        let before = self.occurrences.get(after.checked_sub(1)?)?;
        (offset <= before.span.end).then_some(before)
    }

    /// Where something is named.
    pub fn of_symbol(&self, symbol: SymbolId) -> impl Iterator<Item = &Occurrence> {
        self.occurrences.iter().filter(move |one| one.symbol == Some(symbol))
    }

    /// What can be named at a position among what names common things; of two of one name, the
    /// later one.
    pub fn visible(&self, offset: u32) -> impl Iterator<Item = (SymbolId, &Symbol)> {
        let is_visible = move |(_, symbol): &(SymbolId, &Symbol)| {
            let Span { start, end } = symbol.scope;
            symbol.kind.is_common() && start <= offset && offset <= end
        };
        self.symbols.iter().enumerate().filter(is_visible)
    }

    /// What is declared in something, in the order written.
    pub fn children(&self, parent: SymbolId) -> impl Iterator<Item = (SymbolId, &Symbol)> {
        self.symbols.iter().enumerate().filter(move |(_, symbol)| symbol.parent == Some(parent))
    }
}
