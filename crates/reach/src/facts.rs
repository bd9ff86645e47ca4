//! Two truths of each node, within its context: whether it is come to once the context is entered,
//! and whether it is on a way on which nothing stops going back to the entry.
//!
//! Both only ever become true, and a node is looked at again when one of what it depends on does: a
//! call depends on the end of what it calls. So it takes time linear in the graph, also where
//! functions call themselves.

use crate::edges::Edges;
use crate::flag::VALUES;
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
        let users =
            Edges::reversed(graph.nodes.len(), &|node, visit| graph.each_dependency(node, visit));
        let mut facts = Self(vec![Fact::default(); graph.nodes.len()]);
        let mut changed = Vec::new();
        for (id, node) in (0..).zip(&graph.nodes) {
            match node {
                Node::Entry { .. } => changed.push(id),
                Node::Anywhere { .. } | Node::Around { .. } => {}
                _ => continue,
            }
            facts.0[id as usize] = facts.derive(graph, id);
        }
        while let Some(node) = changed.pop() {
            for &user in users.of_vertex(node) {
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
            Node::Join { fork } => {
                let fork = &graph.forks[fork as usize];
                let ends = graph.ends(fork).map(|(_, end)| self.at(end));
                ends.fold(self.at(fork.before), |all, fact| Fact {
                    is_reached: all.is_reached && fact.is_reached,
                    is_clear: all.is_clear && fact.is_clear,
                })
            }
            Node::Leave { at } => {
                let before = self.at(graph.before_fork(at));
                let at = self.at(at);
                let is_reached = before.is_reached && at.is_reached;
                Fact { is_reached, is_clear: before.is_clear && at.is_clear }
            }
            Node::Anywhere { .. } | Node::Around { .. } => {
                Fact { is_reached: true, is_clear: false }
            }
        }
    }
}

impl Graph {
    /// Of a call: what was before it, and what is at the end of what it calls, by the flags before.
    pub(crate) fn passages(&self, call: NodeId) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        let passages = match self.nodes[call as usize] {
            Node::Call { before, contexts, flags } => std::array::from_fn(|at| {
                let context = self.contexts.get(contexts[at] as usize)?;
                let exit = context.exits[usize::from(flags)];
                (before[at] != NOWHERE && exit != NOWHERE).then_some((before[at], exit))
            }),
            _ => [None; VALUES],
        };
        passages.into_iter().flatten()
    }

    /// What the facts of a node depend on.
    fn each_dependency(&self, node: NodeId, visit: &mut dyn FnMut(NodeId)) {
        match self.nodes[node as usize] {
            Node::Entry { .. } | Node::Anywhere { .. } | Node::Around { .. } => {}
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
            Node::Join { fork } => {
                let fork = &self.forks[fork as usize];
                visit(fork.before);
                let ends = self.ends(fork).map(|(_, end)| end);
                ends.filter(|&end| end != NOWHERE).for_each(visit);
            }
            Node::Leave { at } => {
                let before = self.before_fork(at);
                [at, before].into_iter().filter(|&node| node != NOWHERE).for_each(visit);
            }
        }
    }
}
