//! Names: what each means, where it is seen, whether it is used. Knows nothing of statements.

use crate::types::ValueType;
use obverse_isa::{
    Bit, CounterId, ErrorId, FunctionId, GlobalId, ItemId, JointsId, LocalId, SlotId,
};
use obverse_syntax::ast::Name;
use obverse_syntax::span::Span;
use std::collections::HashMap;

/// What a name means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    /// An I/O operation.
    Io(FunctionId),
    /// An output of the workcell.
    Output(Bit),
    /// An input of the workcell.
    Input(Bit),
    /// A joint configuration.
    Joints(JointsId),
    /// An item.
    Item(ItemId),
    /// An error.
    Error(ErrorId),
    /// An advanced move.
    Guarded(FunctionId),
    /// A sequence.
    Sequence(FunctionId),
    /// An action.
    Action(FunctionId),
    /// A variable of the program.
    Global(GlobalId, ValueType),
    /// A variable or a parameter of a sequence.
    Local(LocalId, ValueType),
    /// The counter of a loop that counts up.
    Counter(CounterId),
    /// The counter of a loop that counts down: the loop counts up the complements of its values.
    CountDown(CounterId),
    /// A remembered position.
    Position(SlotId),
}

impl Meaning {
    /// The kind of thing in words.
    pub(crate) fn kind(self) -> &'static str {
        match self {
            Self::Io(_) => "an I/O operation",
            Self::Output(_) => "an output",
            Self::Input(_) => "an input",
            Self::Joints(_) => "a joint configuration",
            Self::Item(_) | Self::Local(_, ValueType::Item) => "an item",
            Self::Error(_) => "an error",
            Self::Guarded(_) => "an advanced move",
            Self::Sequence(_) => "a sequence",
            Self::Action(_) => "an action",
            Self::Global(..) | Self::Local(..) => "a variable",
            Self::Counter(_) | Self::CountDown(_) => "the counter of a loop",
            Self::Position(_) => "a position",
        }
    }

    /// The statement that a thing of this kind is used by, with its name put in.
    pub(crate) fn use_of(self, name: &str) -> Option<String> {
        match self {
            Self::Io(_) => Some(format!("`io {name}`")),
            Self::Output(_) => Some(format!("`set {name} high`")),
            Self::Input(_) => Some(format!("`input {name}`")),
            Self::Joints(_) | Self::Position(_) => Some(format!("`move to {name}`")),
            Self::Item(_) | Self::Local(_, ValueType::Item) => {
                Some(format!("`move to {name}.KEYFRAME`, or as an argument"))
            }
            Self::Error(_) => Some(format!("`throw {name}`")),
            Self::Guarded(_) => Some(format!("`advance {name}`")),
            Self::Sequence(_) | Self::Action(_) => Some(format!("`call {name}`")),
            _ => None,
        }
    }

    /// The type of its values, if it has a value.
    fn of_type(self) -> Option<ValueType> {
        match self {
            Self::Global(_, of_type) | Self::Local(_, of_type) => Some(of_type),
            Self::Counter(_) | Self::CountDown(_) => Some(ValueType::Int),
            Self::Joints(_) | Self::Position(_) => Some(ValueType::Joints),
            _ => None,
        }
    }

    /// Whether it is declared at the top of a file.
    pub(crate) fn is_declared(self) -> bool {
        !self.is_of_frame()
    }

    /// The same, if it is a variable, of no type that anything follows from.
    pub(crate) fn of_unknown_type(self) -> Self {
        match self {
            Self::Global(id, _) => Self::Global(id, ValueType::Unknown),
            Self::Local(id, _) => Self::Local(id, ValueType::Unknown),
            _ => self,
        }
    }

    fn is_of_frame(self) -> bool {
        matches!(self, Self::Local(..) | Self::Counter(_) | Self::CountDown(_) | Self::Position(_))
    }
}

/// A name and what it means.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Symbol<'s> {
    /// The name as declared.
    pub(crate) name: Name<'s>,
    /// What it means.
    pub(crate) meaning: Meaning,
    /// Whether something needs it.
    pub(crate) is_used: bool,
    /// Whether something is assigned to it.
    pub(crate) is_assigned: bool,
    /// Whether a caller gives it its value.
    pub(crate) is_parameter: bool,
    frame: u32,
}

/// What became of looking up a name.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Found<'s> {
    /// It means this.
    Here(Symbol<'s>),
    /// It is of the sequence around a block that is run in reverse, which may read it.
    Outside(Symbol<'s>),
    /// It means nothing.
    Nothing,
}

/// All names.
#[derive(Debug, Default)]
pub(crate) struct Names<'s> {
    symbols: Vec<Symbol<'s>>,
    visible: HashMap<&'s str, usize>,
    hidden: Vec<(&'s str, Option<usize>)>,
    frame: u32,
    frames: u32,
}

/// Where a scope began.
#[must_use = "a scope that is not closed is seen for ever"]
pub(crate) struct Scope(usize);

/// The frame around another.
#[must_use = "a frame that is not closed hides the one around it"]
pub(crate) struct OuterFrame(u32);

impl<'s> Names<'s> {
    /// Give a name a meaning from here on; the place where it has one already.
    pub(crate) fn declare(&mut self, name: Name<'s>, meaning: Meaning) -> Option<Span> {
        let (is_used, is_assigned, is_parameter) = (false, false, false);
        let frame = self.frame;
        let symbol = Symbol { name, meaning, is_used, is_assigned, is_parameter, frame };
        let before = self.visible.insert(name.value, self.symbols.len());
        self.symbols.push(symbol);
        self.hidden.push((name.value, before));
        before.map(|index| self.symbols[index].name.span)
    }

    /// What a name means here.
    pub(crate) fn find(&self, name: &str) -> Found<'s> {
        match self.visible.get(name) {
            None => Found::Nothing,
            Some(&index) => {
                let symbol = self.symbols[index];
                let is_outside = symbol.meaning.is_of_frame() && symbol.frame != self.frame;
                if is_outside { Found::Outside(symbol) } else { Found::Here(symbol) }
            }
        }
    }

    /// Note that something needs a name.
    pub(crate) fn mark_used(&mut self, name: &str) {
        if let Some(&index) = self.visible.get(name) {
            self.symbols[index].is_used = true;
        }
    }

    /// Note that something is assigned to a name.
    pub(crate) fn mark_assigned(&mut self, name: &str) {
        if let Some(&index) = self.visible.get(name) {
            self.symbols[index].is_assigned = true;
        }
    }

    /// Note that a name is that of a parameter.
    pub(crate) fn mark_parameter(&mut self, name: &str) {
        if let Some(&index) = self.visible.get(name) {
            self.symbols[index].is_parameter = true;
        }
    }

    /// Give a variable of the program its type, now that it is known.
    pub(crate) fn set_global_type(&mut self, name: &str, of_type: ValueType) {
        if let Some(&index) = self.visible.get(name)
            && let Meaning::Global(_, known) = &mut self.symbols[index].meaning
        {
            *known = of_type;
        }
    }

    /// Begin a scope.
    pub(crate) fn open(&mut self) -> Scope {
        Scope(self.hidden.len())
    }

    /// End a scope: what was declared in it means nothing any more.
    pub(crate) fn close(&mut self, scope: &Scope) {
        for (name, before) in self.hidden.drain(scope.0..).rev() {
            match before {
                Some(index) => self.visible.insert(name, index),
                None => self.visible.remove(name),
            };
        }
    }

    /// Begin a frame of its own.
    pub(crate) fn open_frame(&mut self) -> OuterFrame {
        self.frames += 1;
        OuterFrame(std::mem::replace(&mut self.frame, self.frames))
    }

    /// End a frame.
    pub(crate) fn close_frame(&mut self, outer: &OuterFrame) {
        self.frame = outer.0;
    }

    /// Every name ever declared, in the order of declaration.
    pub(crate) fn all(&self) -> &[Symbol<'s>] {
        &self.symbols
    }

    /// Of which type the values are that have a name, by where the name is given.
    pub(crate) fn types(&self) -> Vec<(Span, ValueType)> {
        let typed = |symbol: &Symbol<'s>| Some((symbol.name.span, symbol.meaning.of_type()?));
        self.symbols.iter().filter_map(typed).collect()
    }

    /// The names that can be seen here and whose meaning is wanted.
    pub(crate) fn candidates(&self, wanted: fn(Meaning) -> bool) -> impl Iterator<Item = &'s str> {
        let is_candidate = move |(index, symbol): &(usize, &Symbol<'s>)| {
            wanted(symbol.meaning) && self.visible.get(symbol.name.value) == Some(index)
        };
        self.symbols.iter().enumerate().filter(is_candidate).map(|(_, symbol)| symbol.name.value)
    }
}
