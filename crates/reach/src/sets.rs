//! The first few horizons of every node, and of the entry of every context.
//!
//! Both graphs are condensed first: what lies on one cycle has one set, and each set is the union
//! of those that its component leads to.

use crate::Horizon;
use crate::condense::Components;
use crate::edges::Edges;
use crate::facts::Facts;
use crate::few::Few;
use crate::graph::{Graph, NOWHERE, Node, NodeId};

/// The horizons within a context, by component of the graph.
pub(crate) struct Within {
    components: Components,
    sets: Vec<Few>,
}

impl Within {
    pub(crate) fn of(graph: &Graph, facts: &Facts, is_entered: &[bool]) -> Self {
        let sources = Edges::of(graph.nodes.len(), &|node, visit| {
            each_source(graph, facts, is_entered, node, visit);
        });
        let components =
            Components::of(graph.nodes.len(), |node, at| sources.of_vertex(node).get(at).copied());
        let mut sets: Vec<Few> = Vec::with_capacity(components.len());
        for members in components.iter() {
            let mut set = Few::default();
            for &node in members {
                if let (Node::Horizon { .. }, true) =
                    (graph.nodes[node as usize], facts.at(node).is_reached)
                {
                    set.add(&Few::of(Horizon::Never(graph.pcs[node as usize])));
                }
                for &source in sources.of_vertex(node) {
                    let of = components.of[source as usize] as usize;
                    // One of this component is not there yet, and adds nothing.
                    sets.get(of).into_iter().for_each(|other| set.add(other));
                }
            }
            sets.push(set);
        }
        Self { components, sets }
    }

    /// The never-instructions that may stop a run at a node, of those that its context has run.
    pub(crate) fn at(&self, node: NodeId) -> Few {
        let component = self.components.of.get(node as usize);
        component.map_or(Few::default(), |&component| self.sets[component as usize])
    }
}

/// Visit the nodes from which a node has its horizons, within its context.
fn each_source(
    graph: &Graph,
    facts: &Facts,
    is_entered: &[bool],
    node: NodeId,
    visit: &mut dyn FnMut(NodeId),
) {
    let is_reached = |node: NodeId| facts.at(node).is_reached;
    let mut add = |node: NodeId| {
        if is_reached(node) {
            visit(node);
        }
    };
    match graph.nodes[node as usize] {
        _ if !is_reached(node) => {}
        Node::Entry { .. } | Node::Horizon { .. } => {}
        Node::Merge { sources } => {
            sources.into_iter().flatten().for_each(|source| add(source.node));
        }
        Node::Block { before, .. } => before.into_iter().for_each(add),
        Node::Call { .. } => {
            for (before, exit) in graph.passages(node) {
                if is_reached(before) {
                    add(exit);
                    if facts.at(exit).is_clear {
                        add(before);
                    }
                }
            }
        }
        Node::Join { fork } => {
            let fork = &graph.forks[fork as usize];
            graph.ends(fork).for_each(|(_, end)| add(end));
            if graph.ends(fork).all(|(_, end)| facts.at(end).is_clear) {
                add(fork.before);
            }
        }
        Node::Leave { at } => {
            add(at);
            graph.beside(graph.owners[at as usize]).for_each(&mut add);
            if facts.at(at).is_clear {
                add(graph.before_fork(at));
            }
        }
        Node::Anywhere { context } => {
            for &loose in &graph.contexts[context as usize].loose {
                graph.each_run_by(facts, loose, &mut add);
            }
        }
        Node::Around { context } => {
            graph.beside(context).for_each(&mut add);
            graph.each_around(context, &mut |entrance| {
                let owner = graph.owners[entrance.before as usize] as usize;
                if is_entered[owner] && is_reached(entrance.before) {
                    add(graph.contexts[owner].around);
                }
            });
        }
    }
}

/// The horizons beyond the entries of contexts, and around functions that replace a block.
pub(crate) struct Beyond {
    /// By context: whether it is entered by calls and forks from the start.
    pub(crate) is_entered: Vec<bool>,
    /// By context: the horizons of its entry.
    pub(crate) entries: Vec<Few>,
    /// By function: the horizons of the blocks in whose place it is run; none if it is not.
    pub(crate) around: Vec<Option<Few>>,
}

impl Beyond {
    pub(crate) fn of(
        graph: &Graph,
        facts: &Facts,
        is_entered: Vec<bool>,
        within: &Within,
        calls: &Calls,
    ) -> Self {
        let entries = entries(graph, facts, within, &is_entered);
        let mut beyond = Self { is_entered, entries, around: Vec::new() };
        beyond.around = beyond.replaced(graph, facts, within, calls);
        beyond
    }

    /// The horizons of a node, with what lies beyond its context.
    pub(crate) fn at(&self, graph: &Graph, facts: &Facts, within: &Within, node: NodeId) -> Few {
        let fact = facts.at(node);
        if node == NOWHERE || !fact.is_reached {
            return Few::default();
        }
        let owner = graph.owners[node as usize] as usize;
        if !self.is_entered[owner] {
            return Few::default();
        }
        let mut set = within.at(node);
        set.add(&within.at(graph.contexts[owner].around));
        if fact.is_clear {
            set.add(&self.entries[owner]);
        }
        set
    }

    /// What is run in place of a block goes on to the start of that block, and so does all that it
    /// calls.
    fn replaced(
        &self,
        graph: &Graph,
        facts: &Facts,
        within: &Within,
        calls: &Calls,
    ) -> Vec<Option<Few>> {
        let mut own: Vec<Option<Few>> = vec![None; calls.callees.len()];
        for replacement in &graph.replacements {
            let owner = graph.owners[replacement.inside as usize] as usize;
            if self.is_entered[owner] && facts.at(replacement.inside).is_reached {
                let set = own[replacement.function].get_or_insert_default();
                for before in replacement.before {
                    set.add(&self.at(graph, facts, within, before));
                }
            }
        }
        let callers = calls.reversed();
        let count = own.len();
        let components =
            Components::of(count, |function, at| callers[function as usize].get(at).copied());
        let mut sets: Vec<Option<Few>> = Vec::with_capacity(components.len());
        for members in components.iter() {
            let mut set: Option<Few> = None;
            for &function in members {
                let outer = callers[function as usize].iter();
                let outer = outer.filter_map(|&f| *sets.get(components.of[f as usize] as usize)?);
                for other in outer.chain(own[function as usize]) {
                    set.get_or_insert_default().add(&other);
                }
            }
            sets.push(set);
        }
        (0..count).map(|function| sets[components.of[function] as usize]).collect()
    }
}

/// By context: whether it is entered by calls and forks from the start.
pub(crate) fn entered(graph: &Graph, facts: &Facts) -> Vec<bool> {
    let mut calls: Vec<Vec<u32>> = vec![Vec::new(); graph.contexts.len()];
    for entrance in &graph.entrances {
        if facts.at(entrance.before).is_reached {
            calls[graph.owners[entrance.before as usize] as usize].push(entrance.callee);
        }
    }
    let mut is_entered = vec![false; graph.contexts.len()];
    let mut to_visit: Vec<u32> = if is_entered.is_empty() { Vec::new() } else { vec![0] };
    while let Some(context) = to_visit.pop() {
        if !std::mem::replace(&mut is_entered[context as usize], true) {
            to_visit.append(&mut calls[context as usize]);
        }
    }
    is_entered
}

fn entries(graph: &Graph, facts: &Facts, within: &Within, is_entered: &[bool]) -> Vec<Few> {
    let mut own = vec![Few::default(); graph.contexts.len()];
    let mut callers: Vec<Vec<u32>> = vec![Vec::new(); graph.contexts.len()];
    for entrance in &graph.entrances {
        let (fact, owner) = (facts.at(entrance.before), graph.owners[entrance.before as usize]);
        if fact.is_reached && is_entered[owner as usize] {
            let callee = &mut own[entrance.callee as usize];
            callee.add(&within.at(entrance.before));
            callee.add(&within.at(graph.contexts[owner as usize].around));
            if fact.is_clear {
                callers[entrance.callee as usize].push(owner);
            }
        }
    }
    own.first_mut().into_iter().for_each(|start| start.add(&Few::of(Horizon::Start)));
    let components =
        Components::of(own.len(), |context, at| callers[context as usize].get(at).copied());
    let mut sets: Vec<Few> = Vec::with_capacity(components.len());
    for members in components.iter() {
        let mut set = Few::default();
        for &context in members {
            set.add(&own[context as usize]);
            for &caller in &callers[context as usize] {
                let of = components.of[caller as usize] as usize;
                sets.get(of).into_iter().for_each(|other| set.add(other));
            }
        }
        sets.push(set);
    }
    (0..own.len()).map(|context| sets[components.of[context] as usize]).collect()
}

/// Which functions call which, whether or not that is ever come to.
pub(crate) struct Calls {
    pub(crate) callees: Vec<Vec<u32>>,
}

impl Calls {
    pub(crate) fn of(module: &obverse_bytecode::Module) -> Self {
        let callees = module.functions.iter().map(|function| {
            let code = &module.code[function.first as usize..function.end as usize];
            let mut callees: Vec<u32> = code
                .iter()
                .filter_map(|instr| match instr {
                    obverse_isa::Instr::Call { function, .. } => Some(u32::from(function.0)),
                    _ => None,
                })
                .collect();
            callees.sort_unstable();
            callees.dedup();
            callees
        });
        Self { callees: callees.collect() }
    }

    /// The callers of each function.
    pub(crate) fn reversed(&self) -> Vec<Vec<u32>> {
        let mut callers = vec![Vec::new(); self.callees.len()];
        for (caller, callees) in self.callees.iter().enumerate() {
            for &callee in callees {
                callers[callee as usize].push(caller as u32);
            }
        }
        callers
    }
}
