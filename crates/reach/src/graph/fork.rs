//! Forks in the graph: each branch is a context of its own, which the fork enters as a call does,
//! and behind which the branches come together, run through or left.
//!
//! Between the turns of a branch others go on. So flags may be altered there, and what they may
//! have run by then lies *around* the branch and all that it calls.

use super::{Branch, Builder, ByFlags, Entrance, Fork, NOWHERE, Node, NodeId, Pass, UNREACHED};
use crate::facts::Facts;
use crate::graph::Graph;

/// A fork whose join has not come yet.
pub(super) struct Open {
    fork: u32,
    /// The context that it is in, and how many blocks are open there.
    around: u32,
    blocks: u32,
    /// Each `fork.leave`.
    leaves: Vec<u32>,
}

/// Nothing comes directly behind; the join looks at what was there.
pub(super) fn leave(pass: &mut Pass, pc: u32) -> ByFlags {
    pass.forks.last_mut().into_iter().for_each(|open| open.leaves.push(pc));
    UNREACHED
}

impl Builder<'_> {
    /// What is there when a branch goes on whose turn has ended.
    pub(super) fn turn(&mut self, pass: &Pass, pc: u32, state: ByFlags) -> ByFlags {
        if self.turns.are_flags_altered() {
            let node = state.into_iter().fold(NOWHERE, |all, node| match (all, node) {
                (all, NOWHERE) => all,
                (all, node) => self.merge(pass, pc, [all, node]),
            });
            return self.at_turn(node);
        }
        let [unset, set @ ..] = state;
        self.graph.set_at_turns.extend(set.into_iter().filter(|&node| node != NOWHERE));
        self.at_turn(unset)
    }

    /// A node where a turn begins: by the flags.
    fn at_turn(&self, node: NodeId) -> ByFlags {
        let may_be = if self.turns.are_flags_altered() { self.flags.values() } else { 1 };
        std::array::from_fn(|flags| if flags < may_be { node } else { NOWHERE })
    }

    pub(super) fn fork(&mut self, pass: &mut Pass, pc: u32, before: ByFlags) -> ByFlags {
        let [before, ..] = self.turn(pass, pc, before);
        let (fork, around) = (self.graph.forks.len() as u32, pass.context);
        let blocks = std::mem::take(&mut pass.blocks);
        self.graph.forks.push(Fork { pc, before, branches: Vec::new() });
        pass.forks.push(Open { fork, around, blocks, leaves: Vec::new() });
        self.branch(pass, pc, fork)
    }

    pub(super) fn fork_next(&mut self, pass: &mut Pass, pc: u32, before: ByFlags) -> ByFlags {
        let Some(fork) = pass.forks.last().map(|open| open.fork) else { return UNREACHED };
        self.end_branch(pass, pc, before);
        self.branch(pass, pc, fork)
    }

    pub(super) fn fork_join(&mut self, pass: &mut Pass, pc: u32, before: ByFlags) -> ByFlags {
        let Some(open) = pass.forks.pop() else { return UNREACHED };
        self.end_branch(pass, pc, before);
        (pass.context, pass.blocks) = (open.around, open.blocks);
        let before = self.graph.forks[open.fork as usize].before;
        let join = self.unless_nowhere(pass, pc, before, Node::Join { fork: open.fork });
        self.loose(pass, join);
        open.leaves.iter().fold(self.at_turn(join), |state, &leave| {
            let left = self.point(pass, leave - 1);
            std::array::from_fn(|flags| match left[flags] {
                NOWHERE => state[flags],
                at => {
                    let behind = self.node(pass.context, pc, Node::Leave { at });
                    self.merge(pass, pc, [state[flags], behind])
                }
            })
        })
    }

    /// Begin a branch; an instruction before its first.
    fn branch(&mut self, pass: &mut Pass, pc: u32, fork: u32) -> ByFlags {
        let function = self.graph.contexts[pass.context as usize].function;
        let context = self.new_context(function, pc, Some(fork));
        let Fork { pc: entrance, before, branches } = &mut self.graph.forks[fork as usize];
        branches.push(Branch { context, end: pc });
        let (entrance, before) = (*entrance, *before);
        pass.context = context;
        if before == NOWHERE {
            return UNREACHED;
        }
        self.graph.entrances.push(Entrance { pc: entrance, before, callee: context });
        let entry = self.node(context, pc, Node::Entry { context });
        self.at_turn(entry)
    }

    fn end_branch(&mut self, pass: &Pass, pc: u32, state: ByFlags) {
        let [exit, ..] = self.turn(pass, pc, state);
        let context = &mut self.graph.contexts[pass.context as usize];
        context.exits = UNREACHED;
        context.exits[0] = exit;
        let fork = context.fork.map(|fork| &mut self.graph.forks[fork as usize]);
        let branch = fork.and_then(|fork| fork.branches.last_mut());
        branch.into_iter().for_each(|branch| branch.end = pc);
    }
}

impl Graph {
    /// The fork that a context is a branch of.
    pub(crate) fn fork_of(&self, context: u32) -> Option<&Fork> {
        self.contexts[context as usize].fork.map(|fork| &self.forks[fork as usize])
    }

    /// What was there before the fork, for a node in a branch of it.
    pub(crate) fn before_fork(&self, node: NodeId) -> NodeId {
        self.fork_of(self.owners[node as usize]).map_or(NOWHERE, |fork| fork.before)
    }

    /// Each branch of a fork, and what is there at its end.
    pub(crate) fn ends(&self, fork: &Fork) -> impl Iterator<Item = (Branch, NodeId)> {
        let end = |branch: &Branch| (*branch, self.contexts[branch.context as usize].exits[0]);
        fork.branches.iter().map(end)
    }

    /// Of a branch: what the others of its fork may have run when it has its turn.
    pub(crate) fn beside(&self, context: u32) -> impl Iterator<Item = NodeId> {
        let branches = self.fork_of(context).map_or(&[][..], |fork| &fork.branches);
        let others = branches.iter().filter(move |branch| branch.context != context);
        others.map(|other| self.contexts[other.context as usize].anywhere)
    }

    /// Where a function is called whose context this is. Those around a branch stand still: only
    /// branches of the innermost fork take turns.
    pub(crate) fn each_around(&self, context: u32, visit: &mut dyn FnMut(&Entrance)) {
        if self.contexts[context as usize].fork.is_none() {
            self.entrances_of(context).iter().for_each(visit);
        }
    }

    /// What a context has run at a horizon, a call or a fork, and may be in the middle of.
    pub(crate) fn each_run_by(&self, facts: &Facts, node: NodeId, visit: &mut dyn FnMut(NodeId)) {
        match self.nodes[node as usize] {
            Node::Call { before, contexts, .. } => {
                let called = before.into_iter().zip(contexts);
                let called = called.filter(|&(before, _)| facts.at(before).is_reached);
                called.for_each(|(_, callee)| visit(self.contexts[callee as usize].anywhere));
            }
            Node::Join { fork } => {
                let Fork { before, branches, .. } = &self.forks[fork as usize];
                if facts.at(*before).is_reached {
                    let contexts = branches.iter().map(|branch| branch.context as usize);
                    contexts.for_each(|context| visit(self.contexts[context].anywhere));
                }
            }
            _ => visit(node),
        }
    }
}
