//! Going back through the graph, for one question: every horizon of a point, the way to one, or the
//! nearest within bounds.

use crate::graph::{Node, NodeId, Source};
use crate::{Horizon, Reach};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// What going back crosses on its way, beside instructions of one function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// Out of a function, to before this call of it.
    CalledFrom(u32),
    /// Into what this call has called, at its end.
    Within(u32),
    /// Out of what is run in place of the block that ends here, to before that block.
    InPlaceOf(u32),
}

/// How going back ends somewhere.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Way {
    /// What is crossed, in the order of going back.
    pub links: Vec<Link>,
    /// Where it ends.
    pub horizon: Horizon,
}

/// A node, and whether it is met within a call: whose entry is not gone out of, since what lies
/// before that call is looked at from the call.
type State = (NodeId, bool);

struct Step {
    cost: u32,
    parent: Option<State>,
    link: Option<Link>,
}

/// What a way costs.
pub(crate) enum Cost<'a> {
    /// One for each call that is crossed.
    Links,
    /// One for each action that is taken back, by how many begin up to each instruction; ways that
    /// cost as much as this are given up.
    Actions(&'a [u32], u32),
}

pub(crate) struct Search<'s, 'm> {
    reach: &'s Reach<'m>,
    cost: Cost<'s>,
    /// Whether going back leaves a function at its beginning.
    leaves: Box<dyn Fn(usize) -> bool + 's>,
    steps: HashMap<State, Step>,
    queue: BinaryHeap<Reverse<(u32, State)>>,
    last: Option<State>,
    /// How many steps it may take.
    pub(crate) budget: usize,
}

impl<'m> Reach<'m> {
    /// All ways back from before an instruction.
    pub(crate) fn search_from(&self, pc: u32) -> Search<'_, 'm> {
        let mut search = Search::new(self, Cost::Links, Box::new(|_| true));
        if let Some(function) = self.module.function_at(pc) {
            for node in self.nodes_before(function, pc) {
                if self.is_entered(node) {
                    search.add((node, false), 0, None, None);
                }
            }
            search.add_replaced(function);
        }
        search
    }

    /// Whether a run comes to a node.
    pub(crate) fn is_entered(&self, node: NodeId) -> bool {
        self.facts.at(node).is_reached
            && self.beyond.is_entered[self.graph.owners[node as usize] as usize]
    }
}

impl<'s, 'm> Search<'s, 'm> {
    pub(crate) fn new(
        reach: &'s Reach<'m>,
        cost: Cost<'s>,
        leaves: Box<dyn Fn(usize) -> bool + 's>,
    ) -> Self {
        let (steps, queue) = (HashMap::new(), BinaryHeap::new());
        Self { reach, cost, leaves, steps, queue, last: None, budget: usize::MAX }
    }

    /// Begin at a node too, where it has already cost so much.
    pub(crate) fn begin(&mut self, node: NodeId, cost: u32) {
        self.add((node, false), cost, None, None);
    }

    /// Visit horizons, those that cost least first, until the visitor has had enough.
    pub(crate) fn run(&mut self, visit: &mut dyn FnMut(&Self, Horizon) -> bool) {
        while let Some(Reverse((cost, state))) = self.queue.pop() {
            if self.steps.get(&state).is_some_and(|step| step.cost < cost) {
                continue;
            }
            if self.budget == 0 {
                return;
            }
            self.budget -= 1;
            self.last = Some(state);
            let horizon = match self.reach.graph.nodes[state.0 as usize] {
                Node::Horizon { .. } => {
                    Some(Horizon::Never(self.reach.graph.pcs[state.0 as usize]))
                }
                Node::Entry { context: 0 } if !state.1 => Some(Horizon::Start),
                _ => None,
            };
            if horizon.is_some_and(|horizon| !visit(self, horizon)) {
                return;
            }
            self.expand(state, cost);
        }
    }

    /// What the last horizon that was visited has cost.
    pub(crate) fn cost(&self) -> u32 {
        self.last.and_then(|state| self.steps.get(&state)).map_or(0, |step| step.cost)
    }

    /// The way to the last horizon that was visited.
    pub(crate) fn way(&self, horizon: Horizon) -> Way {
        let mut links = Vec::new();
        let mut at = self.last;
        while let Some(step) = at.and_then(|state| self.steps.get(&state)) {
            links.extend(step.link);
            at = step.parent;
        }
        links.reverse();
        Way { links, horizon }
    }

    fn add(&mut self, state: State, cost: u32, parent: Option<State>, link: Option<Link>) {
        if matches!(self.cost, Cost::Actions(_, most) if cost >= most) {
            return;
        }
        if self.steps.get(&state).is_none_or(|known| cost < known.cost) {
            self.steps.insert(state, Step { cost, parent, link });
            self.queue.push(Reverse((cost, state)));
        }
    }

    /// Behind a function that is run in place of a block, or is called by one, lies what was before
    /// the block.
    fn add_replaced(&mut self, function: usize) {
        let reach = self.reach;
        let callers = reach.calls.reversed();
        let mut is_known = vec![false; callers.len()];
        let mut to_visit = vec![function as u32];
        while let Some(function) = to_visit.pop() {
            if !std::mem::replace(&mut is_known[function as usize], true) {
                to_visit.extend(&callers[function as usize]);
            }
        }
        for replacement in &reach.graph.replacements {
            if is_known[replacement.function] && reach.is_entered(replacement.inside) {
                for before in replacement.before {
                    if reach.facts.at(before).is_reached {
                        let link = Some(Link::InPlaceOf(replacement.pc));
                        self.add((before, false), 1, None, link);
                    }
                }
            }
        }
    }

    fn expand(&mut self, state: State, cost: u32) {
        let (node, is_within) = state;
        let graph = &self.reach.graph;
        let pc = graph.pcs[node as usize];
        match graph.nodes[node as usize] {
            Node::Horizon { .. } => {}
            Node::Entry { context } if !is_within => self.leave(state, cost, context),
            Node::Entry { .. } => {}
            Node::Merge { sources } => {
                for Source { node, until } in sources.into_iter().flatten() {
                    self.follow(state, cost, (node, is_within), until, None);
                }
            }
            Node::Block { before, .. } => {
                for before in before {
                    self.follow(state, cost, (before, is_within), pc, None);
                }
            }
            Node::Call { .. } => {
                for (before, exit) in graph.passages(node) {
                    if self.reach.facts.at(before).is_reached {
                        self.enter(state, cost, exit, pc);
                        if self.reach.facts.at(exit).is_clear {
                            self.follow(state, cost, (before, is_within), pc, None);
                        }
                    }
                }
            }
        }
    }

    fn enter(&mut self, state: State, cost: u32, exit: NodeId, call: u32) {
        if self.reach.facts.at(exit).is_reached {
            let more = u32::from(matches!(self.cost, Cost::Links));
            self.add((exit, true), cost + more, Some(state), Some(Link::Within(call)));
        }
    }

    /// Out of a context, to each place that it is called from.
    fn leave(&mut self, state: State, cost: u32, context: u32) {
        let reach = self.reach;
        if !(self.leaves)(reach.graph.contexts[context as usize].function) {
            return;
        }
        for entrance in reach.graph.entrances_of(context) {
            if reach.is_entered(entrance.before) {
                let link = Some(Link::CalledFrom(entrance.pc));
                self.follow(state, cost, (entrance.before, false), entrance.pc, link);
            }
        }
    }

    /// Go on at a source, with all actions taken back that begin behind it up to an instruction.
    fn follow(&mut self, from: State, cost: u32, to: State, until: u32, link: Option<Link>) {
        if !self.reach.facts.at(to.0).is_reached {
            return;
        }
        let more = match self.cost {
            Cost::Links => u32::from(link.is_some()),
            // What a call has called is the call's action.
            Cost::Actions(..) if to.1 => 0,
            Cost::Actions(begun, _) => {
                let at = self.reach.graph.pcs[to.0 as usize] as usize;
                begun[until as usize].saturating_sub(begun[at])
            }
        };
        self.add(to, cost.saturating_add(more), Some(from), link);
    }
}
