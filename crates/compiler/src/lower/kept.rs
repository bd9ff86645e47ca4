//! Blocks that keep their order in reverse: their code where they stand, and once more as the
//! function that takes their place going back.
//!
//! The function begins with the frame around it as it is at the end of the block. What the block
//! changes is therefore kept before it, and put right at the beginning of the function: it then
//! does what the block did.

use super::Lower;
use super::statement::PREFIX;
use crate::tree::{Block, Body, Kept, Layout, Place, StatementKind};
use obverse_isa::{FunctionId, GlobalId, Instr, LocalId, Setting, Type};
use std::collections::BTreeSet;

/// Something that a block changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Changed {
    Local(LocalId),
    Global(GlobalId),
    Setting(Setting),
}

impl<'p> Lower<'p> {
    /// A block that keeps its order, where it stands.
    pub(super) fn kept(&mut self, function: FunctionId) {
        let declared = self.program.function(function);
        let (Some(kept), Body::Block(block)) = (declared.kept, &declared.body) else { return };
        for (changed, local) in self.kept_values(function, kept) {
            self.push(match changed {
                Changed::Local(local) => Instr::PushLocal { local },
                Changed::Global(global) => Instr::PushGlobal { global },
                Changed::Setting(setting) => Instr::PushSetting { setting },
            });
            self.push(Instr::StoreLocal { prefix: PREFIX, local });
        }
        self.reversed(block, Some(function));
    }

    /// The block of a statement that keeps its order in reverse.
    pub(super) fn kept_block(&self, kind: &StatementKind) -> Option<&'p Block> {
        let StatementKind::Kept(function) = kind else { return None };
        match &self.program.function(*function).body {
            Body::Block(block) => Some(block),
            Body::Guarded(_) => None,
        }
    }

    /// The same block as a function.
    pub(super) fn kept_body(&mut self, function: FunctionId, block: &Block) {
        for (changed, local) in self.kept.get(&function).cloned().unwrap_or_default() {
            self.push(Instr::PushLocal { local });
            self.push(match changed {
                Changed::Local(local) => Instr::StoreLocal { prefix: PREFIX, local },
                Changed::Global(global) => Instr::StoreGlobal { prefix: PREFIX, global },
                Changed::Setting(setting) => Instr::SettingSet { prefix: PREFIX, setting },
            });
        }
        self.block(block);
        self.at(block.end, None);
    }

    /// The frame of a block that keeps its order: all of the frame around it.
    pub(super) fn layout_around(&mut self, kept: Kept) -> Layout {
        let Some(around) = self.functions.get(kept.around.index()) else {
            return Layout::default();
        };
        let layout = Layout {
            parameters: u8::try_from(around.locals.len()).unwrap_or(u8::MAX),
            locals: around.locals.clone(),
            counters: around.counters,
            slots: around.slots.clone(),
        };
        if layout.locals.len() > usize::from(u8::MAX) {
            self.too_many("a sequence has no room for the variables of a block in reverse");
        }
        layout
    }

    /// What a block changes, and where it is kept before it. The same wherever the block is a part
    /// of another one that keeps its order.
    fn kept_values(&mut self, function: FunctionId, kept: Kept) -> Vec<(Changed, LocalId)> {
        if let Some(known) = self.kept.get(&function) {
            return known.clone();
        }
        let values: Vec<_> = self
            .changed(function, kept)
            .into_iter()
            .map(|changed| (changed, self.hidden("kept", self.type_of(changed))))
            .collect();
        self.kept.insert(function, values.clone());
        values
    }

    fn type_of(&self, changed: Changed) -> Type {
        match changed {
            Changed::Local(local) => self.frame.layout.locals[local.index()].of_type,
            Changed::Global(global) => self.program.module.globals[global.index()].of_type,
            Changed::Setting(setting) => setting.of_type(),
        }
    }

    /// What a block changes of what is there before it, itself, by the blocks within it that keep
    /// their order, and by what it calls.
    fn changed(&self, function: FunctionId, kept: Kept) -> BTreeSet<Changed> {
        let mut changed = BTreeSet::new();
        let mut seen = BTreeSet::from([function]);
        let mut to_visit = vec![function];
        while let Some(function) = to_visit.pop() {
            let visited = self.program.function(function);
            let shares = visited.kept.is_some_and(|part| part.around == kept.around);
            if let Body::Block(block) = &visited.body {
                block.each_statement(&mut |statement| {
                    let is_known = |changed: &Changed| match changed {
                        Changed::Local(local) => shares && local.index() < kept.locals_before,
                        Changed::Setting(_) => shares,
                        Changed::Global(_) => true,
                    };
                    changed.extend(changed_by(&statement.kind).filter(is_known));
                });
            }
            let calls = self.effects.calls(function).iter().map(|(callee, _)| *callee);
            to_visit.extend(calls.filter(|callee| seen.insert(*callee)));
        }
        changed
    }
}

fn changed_by(kind: &StatementKind) -> Option<Changed> {
    match kind {
        StatementKind::Store(place, _) | StatementKind::Update { place, .. } => Some(match place {
            Place::Local(local) => Changed::Local(*local),
            Place::Global(global) => Changed::Global(*global),
        }),
        StatementKind::Set(value) => Some(Changed::Setting(value.setting())),
        _ => None,
    }
}
