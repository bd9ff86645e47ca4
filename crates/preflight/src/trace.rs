//! What a program does on its ways forward, in the form in which it is gone back over.

use crate::command::Command;
use crate::reason::Reason;
use crate::state::State;
use crate::worlds::WorldId;
use obverse_isa::FunctionId;
use std::rc::Rc;

/// Something done, among those of one check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct NodeId(u32);

impl NodeId {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// What was done, as far as going back over it commands the workcell.
#[derive(Clone, Debug)]
pub(crate) enum Deed {
    /// The program began.
    Begin,
    /// Ways through the program met.
    Merge,
    /// A motion, which goes back as this one says.
    Move { pc: u32, back: Command, calls: Rc<[u32]>, is_planned: bool, since: Option<Reason> },
    /// The gripper's output was set.
    Output,
    /// The gripper's output was changed.
    Toggle,
    /// A block with a reverse of its own began.
    BlockBegin,
    /// It ended, and is passed over in reverse.
    BlockSkip { begin: NodeId },
    /// It ended, and a function takes its place in reverse, called in this state.
    BlockReplace { begin: NodeId, function: FunctionId, state: Rc<State> },
    /// Something that is not followed, and whether going back over it leads to where it began.
    Unfollowed { restores: bool },
    /// Something that cannot be taken back.
    Never,
}

/// Something done.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) deed: Deed,
    pub(crate) before: WorldId,
    pub(crate) after: WorldId,
    /// What was done before it.
    pub(crate) from: Vec<NodeId>,
}

/// All that was done on the ways of one check.
pub(crate) struct Trace {
    nodes: Vec<Node>,
}

impl Trace {
    /// The first node is the beginning.
    pub(crate) fn new(start: WorldId) -> (Self, NodeId) {
        let begin = Node { deed: Deed::Begin, before: start, after: start, from: Vec::new() };
        (Self { nodes: vec![begin] }, NodeId(0))
    }

    pub(crate) fn add(&mut self, node: Node) -> NodeId {
        let id = NodeId(self.nodes.len() as u32);
        self.nodes.push(node);
        id
    }

    pub(crate) fn of(&self, id: NodeId) -> &Node {
        &self.nodes[id.index()]
    }

    /// Another way leads to a merge.
    pub(crate) fn lead(&mut self, to: NodeId, from: NodeId) {
        let ways = &mut self.nodes[to.index()].from;
        if !ways.contains(&from) {
            ways.push(from);
        }
    }

    pub(crate) fn ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..self.nodes.len() as u32).map(NodeId)
    }
}
