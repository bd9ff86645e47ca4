//! Two truths of each node, within its context: whether it is come to once the context is entered,
//! and whether it is on a way on which nothing stops going back to the entry.
//!
//! Both only ever become true, and a node is looked at again when one of what it depends on does: a
//! call depends on the end of what it calls. So it takes time linear in the graph, also where
//! functions call themselves.

use crate::graph::{Graph, NOWHERE, Node, NodeId};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Fact {
    pub(crate) is_reached: bool,
    /// There is a way to it from the entry without a horizon.
    pub(crate) is_clear: bool,
}

pub(crate) struct Facts(Vec<Fact>);

impl Facts {
    pub(crate) fn of(graph: &Graph) -> Self {
        let users = Users::of(graph);
        let mut facts = Self(vec![Fact::default(); graph.nodes.len()]);
        let is_entry = |id: &NodeId| matches!(graph.nodes[*id as usize], Node::Entry { .. });
        let mut changed: Vec<NodeId> = (0..graph.nodes.len() as NodeId).filter(is_entry).collect();
        for &entry in &changed {
            facts.0[entry as usize] = Fact { is_reached: true, is_clear: true };
        }
        while let Some(node) = changed.pop() {
            for &user in users.of_node(node) {
                let fact = facts.derive(graph, user);
                if std::mem::replace(&mut facts.0[user as usize], fact) != fact {
                    changed.push(user);
                }
            }
        }
        facts
    }

    /// That of a node; of nowhere, neither is true.
    pub(crate) fn at(&self, node: NodeId) -> Fact {
        self.0.get(node as usize).copied().unwrap_or_default()
    }

    fn derive(&self, graph: &Graph, node: NodeId) -> Fact {
        let any = |nodes: &mut dyn Iterator<Item = NodeId>| {
            nodes.map(|node| self.at(node)).fold(Fact::default(), |any, fact| Fact {
                is_reached: any.is_reached || fact.is_reached,
                is_clear: any.is_clear || fact.is_clear,
            })
        };
        match graph.nodes[node as usize] {
            Node::Entry { .. } => Fact { is_reached: true, is_clear: true },
            Node::Horizon { before } => Fact { is_clear: false, ..self.at(before) },
            Node::Merge { sources } => {
                any(&mut sources.into_iter().flatten().map(|source| source.node))
            }
            Node::Call { .. } => {
                let mut fact = Fact::default();
                for (before, exit) in graph.passages(node) {
                    let (before, exit) = (self.at(before), self.at(exit));
                    fact.is_reached |= before.is_reached && exit.is_reached;
                    fact.is_clear |= before.is_clear && exit.is_clear;
                }
                fact
            }
            Node::Block { before, inside } => {
                let is_reached = self.at(inside).is_reached;
                let is_clear = is_reached && any(&mut before.into_iter()).is_clear;
                Fact { is_reached, is_clear }
            }
        }
    }
}

impl Graph {
    /// Of a call: what was before it, and what is at the end of what it calls, by the flag before.
    pub(crate) fn passages(&self, call: NodeId) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        let passages = match self.nodes[call as usize] {
            Node::Call { before, contexts, flag } => [0, 1].map(|at| {
                let context = self.contexts.get(contexts[at] as usize)?;
                let exit = context.exits[usize::from(flag)];
                (before[at] != NOWHERE && exit != NOWHERE).then_some((before[at], exit))
            }),
            _ => [None; 2],
        };
        passages.into_iter().flatten()
    }

    /// What the facts of a node depend on.
    fn each_dependency(&self, node: NodeId, visit: &mut dyn FnMut(NodeId)) {
        match self.nodes[node as usize] {
            Node::Entry { .. } => {}
            Node::Horizon { before } => visit(before),
            Node::Merge { sources } => {
                sources.into_iter().flatten().for_each(|source| visit(source.node));
            }
            Node::Call { .. } => {
                for (before, exit) in self.passages(node) {
                    visit(before);
                    visit(exit);
                }
            }
            Node::Block { before, inside } => {
                before.into_iter().filter(|&node| node != NOWHERE).for_each(&mut *visit);
                visit(inside);
            }
        }
    }
}

/// The nodes whose facts depend on each node.
struct Users {
    all: Vec<NodeId>,
    bounds: Vec<u32>,
}

impl Users {
    fn of(graph: &Graph) -> Self {
        let mut bounds = vec![0_u32; graph.nodes.len() + 1];
        for node in 0..graph.nodes.len() as NodeId {
            graph.each_dependency(node, &mut |used| bounds[used as usize + 1] += 1);
        }
        for at in 1..bounds.len() {
            bounds[at] += bounds[at - 1];
        }
        let mut all = vec![0; bounds.last().map_or(0, |&count| count as usize)];
        let mut next = bounds.clone();
        for node in 0..graph.nodes.len() as NodeId {
            graph.each_dependency(node, &mut |used| {
                let at = &mut next[used as usize];
                all[*at as usize] = node;
                *at += 1;
            });
        }
        Self { all, bounds }
    }

    fn of_node(&self, node: NodeId) -> &[NodeId] {
        let node = node as usize;
        &self.all[self.bounds[node] as usize..self.bounds[node + 1] as usize]
    }
}
