//! Which names stand for which indices, in a module and in one of its functions. Knows nothing of
//! text.

use crate::module::{Constant, Function, Module};
use obverse_isa::OperandKind;
use std::collections::HashMap;

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// The one thing of this name, by index.
    One(usize),
    /// Several things have the name.
    Several,
}

type Index<K> = HashMap<K, Found>;

fn index<K: std::hash::Hash + Eq>(keys: impl Iterator<Item = K>) -> Index<K> {
    let mut index = Index::new();
    for (at, key) in keys.enumerate() {
        index.entry(key).and_modify(|found| *found = Found::Several).or_insert(Found::One(at));
    }
    index
}

/// The kinds of operand that name an entry of a table of the module; reasons are their own names.
const OF_MODULE: [OperandKind; 9] = [
    OperandKind::Global,
    OperandKind::Joints,
    OperandKind::Item,
    OperandKind::Keyframe,
    OperandKind::Tool,
    OperandKind::Error,
    OperandKind::Checkpoint,
    OperandKind::Reason,
    OperandKind::Function,
];

/// The kinds that name something of a frame.
const OF_FRAME: [OperandKind; 2] = [OperandKind::Local, OperandKind::Slot];

/// The name of the entry `at` of what operands of a kind index.
fn name_of<'m>(
    module: &'m Module,
    function: Option<&'m Function>,
    kind: OperandKind,
    at: usize,
) -> Option<&'m str> {
    let name = match kind {
        OperandKind::Global => &module.globals.get(at)?.name,
        OperandKind::Joints => &module.joints.get(at)?.0,
        OperandKind::Item => &module.items.get(at)?.name,
        OperandKind::Keyframe => module.keyframes.get(at)?,
        OperandKind::Tool => module.tools.get(at)?,
        OperandKind::Error => &module.errors.get(at)?.name,
        OperandKind::Checkpoint => module.checkpoints.get(at)?,
        OperandKind::Reason => module.reasons.get(at)?,
        OperandKind::Function => &module.functions.get(at)?.name,
        OperandKind::Local => &function?.locals.get(at)?.name,
        OperandKind::Slot => function?.slots.get(at)?,
        _ => return None,
    };
    Some(name)
}

/// Whether operands of a kind are written as names.
pub(super) fn is_named(kind: OperandKind) -> bool {
    OF_MODULE.contains(&kind) || OF_FRAME.contains(&kind)
}

/// The names of a module.
pub(super) struct Names<'m> {
    module: &'m Module,
    tables: Vec<(OperandKind, Index<&'m str>)>,
    constants: Index<(bool, u64)>,
}

fn constant_key(constant: Constant) -> (bool, u64) {
    (matches!(constant, Constant::Real(_)), constant.bits())
}

impl<'m> Names<'m> {
    pub(super) fn new(module: &'m Module) -> Self {
        let names = |kind| (0..).map_while(move |at| name_of(module, None, kind, at));
        Self {
            module,
            tables: OF_MODULE.iter().map(|&kind| (kind, index(names(kind)))).collect(),
            constants: index(module.constants.iter().map(|&constant| constant_key(constant))),
        }
    }

    /// Where a constant is.
    pub(super) fn constant(&self, constant: Constant) -> Option<Found> {
        self.constants.get(&constant_key(constant)).copied()
    }
}

/// The names that code of one function sees.
pub(super) struct Scope<'n, 'm> {
    pub(super) names: &'n Names<'m>,
    pub(super) module: &'m Module,
    function: Option<&'m Function>,
    locals: Vec<(OperandKind, Index<&'m str>)>,
}

impl<'n, 'm> Scope<'n, 'm> {
    /// In a function, or outside of all.
    pub(super) fn new(names: &'n Names<'m>, function: Option<&'m Function>) -> Self {
        let module = names.module;
        let in_frame = |kind| (0..).map_while(move |at| name_of(module, function, kind, at));
        let locals = OF_FRAME.iter().map(|&kind| (kind, index(in_frame(kind)))).collect();
        Self { names, module, function, locals }
    }

    /// The name at an index, if there is one.
    pub(super) fn name(&self, kind: OperandKind, at: usize) -> Option<&'m str> {
        name_of(self.module, self.function, kind, at)
    }

    /// What a name stands for.
    pub(super) fn find(&self, kind: OperandKind, name: &str) -> Option<Found> {
        let mut tables = self.names.tables.iter().chain(&self.locals);
        tables.find(|(of, _)| *of == kind)?.1.get(name).copied()
    }

    /// All names of a kind, in order.
    pub(super) fn all(&self, kind: OperandKind) -> impl Iterator<Item = &'m str> {
        (0..).map_while(move |at| self.name(kind, at))
    }
}
