//! Functions: what surrounds their bodies.

use super::Lower;
use super::frame::{Frame, Role};
use crate::tree::{Body, Function};
use obverse_bytecode::{Continuation, FunctionKind};
use obverse_isa::{FunctionId, Instr, Type};

impl<'p> Lower<'p> {
    /// A function other than the start.
    pub(super) fn function(&mut self, id: FunctionId, function: &'p Function) {
        use FunctionKind::{Action, AdvancedMove, Cleanup, Io, Replacement, Sequence};
        let first = self.code.here();
        let layout = match function.kept {
            Some(kept) => self.layout_around(kept),
            None => function.layout.clone(),
        };
        self.frame = Frame {
            named: function.named,
            layout,
            modal: &function.modal,
            has_actions: matches!(function.kind, Action | Replacement | Sequence | Cleanup),
            role: match function.kind {
                Replacement => Role::InReverse,
                Io | AdvancedMove => Role::Ends,
                _ => Role::Responds,
            },
            is_reached: true,
            may_nest_recovery: self.effects.recovers_in_recovery(id),
            ..Frame::default()
        };
        self.at(function.named, None);
        self.push(Instr::Enter {});
        match &function.body {
            Body::Block(block) if function.kept.is_some() => self.kept_body(id, block),
            Body::Block(block) => self.body(block),
            Body::Guarded(guarded) => self.guarded(guarded),
        }
        self.push(Instr::Return {});
        self.close_function(&function.name, function.kind, first);
    }

    /// Keep a function whose code is complete.
    pub(super) fn close_function(&mut self, name: &str, kind: FunctionKind, first: u32) {
        let layout = std::mem::take(&mut self.frame.layout);
        self.functions.push(obverse_bytecode::Function {
            name: name.to_owned(),
            kind,
            parameters: layout.parameters,
            locals: layout.locals,
            counters: layout.counters,
            slots: layout.slots,
            first,
            end: self.code.here(),
        });
    }

    /// Statements, and around them what begins them again, and what makes settings right.
    fn body(&mut self, block: &'p crate::tree::Block) {
        for &(setting, local) in self.frame.modal {
            self.keep(setting, local);
        }
        let top = self.begins_again(block).then(|| {
            self.frame.rounds = Some(self.hidden("rounds", Type::Int));
            self.join_ahead()
        });
        self.block(block);
        self.at(block.end, None);
        if let Some(top) = top {
            let over = self.frame.is_reached.then(|| self.jump());
            let restarts = std::mem::take(&mut self.frame.restarts);
            self.join_all(restarts);
            if let Some(local) = self.frame.rounds {
                self.push(Instr::AddLocalImmediate { local, value: 1 });
            }
            self.restore_modal();
            self.jump_back(top);
            over.into_iter().for_each(|over| self.join_one(over));
        }
        let exits = std::mem::take(&mut self.frame.exits);
        self.join_all(exits);
        self.restore_modal();
    }

    /// Whether an error of a block may have the function begin again.
    fn begins_again(&self, block: &crate::tree::Block) -> bool {
        let mut begins_again = false;
        block.each_statement(&mut |statement| {
            begins_again |= match self.kept_block(&statement.kind) {
                Some(kept) => self.begins_again(kept),
                None => {
                    let due = self.due(&statement.kind);
                    let mut continuations = due.into_iter().map(|error| self.continuation(error));
                    continuations.any(|then| then == Some(Continuation::Sequence))
                }
            };
        });
        begins_again
    }

    fn restore_modal(&mut self) {
        for &(setting, local) in self.frame.modal {
            self.restore(setting, local);
        }
    }
}
