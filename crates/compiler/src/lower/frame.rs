//! The function that is being lowered: its frame, and the ways that wait for their join.

use super::Lower;
use super::leave::Way;
use crate::tree::Layout;
use obverse_bytecode::Mark;
use obverse_isa::{ErrorId, Instr, Label, LocalId, ReasonId, Setting, Type};
use obverse_syntax::span::Span;

/// What is known of the function in hand.
#[derive(Default)]
pub(super) struct Frame<'p> {
    /// Where it is named.
    pub(super) named: Span,
    /// What its frame holds.
    pub(super) layout: Layout,
    /// The settings that hold to its end.
    pub(super) modal: &'p [(Setting, LocalId)],
    /// Whether its statements are actions of the robot that a story tells.
    pub(super) has_actions: bool,
    /// Whether it is the start, which leaves nothing and restarts by itself.
    pub(super) is_start: bool,
    /// What it does about errors.
    pub(super) role: Role,
    /// Whether the next instruction is reached from the one before it.
    pub(super) is_reached: bool,
    /// Whether a recovery may begin while another one is under way.
    pub(super) may_nest_recovery: bool,
    /// The loops around, innermost last: the jumps out of each.
    pub(super) loops: Vec<Loop>,
    /// The scopes around, innermost last.
    pub(super) scopes: Vec<Scope>,
    /// The jumps to its end.
    pub(super) exits: Vec<Mark>,
    /// The jumps to its beginning.
    pub(super) restarts: Vec<Mark>,
    /// How often the action in hand has been done again in a row, if any can; branches of a fork
    /// have one each.
    pub(super) again: Option<LocalId>,
    /// Whether errors were pending that are not so while another is recovered from, by error.
    pub(super) aside: Vec<(ErrorId, LocalId)>,
    /// How often it has begun again, if it can.
    pub(super) rounds: Option<LocalId>,
    /// Which way leads out of a block with a reverse of its own, if any does.
    pub(super) way: Option<LocalId>,
}

/// What a function does about the errors that are raised in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Role {
    /// It responds to them.
    #[default]
    Responds,
    /// It ends, and leaves them to its caller: an advanced move, an I/O operation.
    Ends,
    /// Nothing: it is run in reverse, where none is raised.
    InReverse,
}

/// A loop.
pub(super) struct Loop {
    /// The jumps out of it.
    pub(super) breaks: Vec<Mark>,
    /// How many scopes are around it.
    pub(super) depth: usize,
}

/// Something that is put right when it is left.
pub(super) enum Scope {
    /// A setting gets its former value.
    Setting(Setting, LocalId),
    /// The end of what cannot be taken back.
    Irreversible(ReasonId),
    /// A block with a reverse of its own is left by its end alone.
    Reversed(Vec<(Mark, Way)>),
    /// So is the branch of a fork; the local says which way leads out of the fork, if any does.
    Branch(Option<LocalId>, Vec<(Mark, Way)>),
}

impl Lower<'_> {
    /// A hidden local more.
    pub(super) fn hidden(&mut self, name: &str, of_type: Type) -> LocalId {
        self.frame.layout.add_hidden(name, of_type).unwrap_or_else(|| {
            self.too_many("a sequence has no room for the hidden variables that it needs");
            LocalId(0)
        })
    }

    /// Jumps come together here: the first is landed on if nothing comes from above, all others
    /// are told apart by a record.
    pub(super) fn join_all(&mut self, marks: Vec<Mark>) {
        for mark in marks {
            self.join_one(mark);
        }
    }

    /// A jump comes to here.
    pub(super) fn join_one(&mut self, mark: Mark) {
        match self.frame.is_reached {
            true => self.code.join(mark, |from| Instr::Join { from }),
            false => self.code.join(mark, |from| Instr::Land { from }),
        };
        self.frame.is_reached = true;
    }

    /// A jump that is always taken.
    pub(super) fn jump(&mut self) -> Mark {
        self.frame.is_reached = false;
        self.code.jump(|target| Instr::Jump { target })
    }

    /// A jump back that is always taken.
    pub(super) fn jump_back(&mut self, top: Mark) {
        self.frame.is_reached = false;
        self.code.jump_back(top, |target| Instr::Jump { target });
    }

    /// A recorded join of the way from above and of a jump that comes later.
    pub(super) fn join_ahead(&mut self) -> Mark {
        self.code.join_ahead(|from: Label| Instr::Join { from })
    }
}
