//! Going back through the graph, for one question: every horizon of a point, the way to one, or the
//! nearest within bounds.

use crate::graph::{Fork, Node, NodeId, Source};
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
    /// Into another branch of this fork, which may have had turns.
    Beside(u32),
    /// Back over a jump back to this join: a round of a loop, or what was begun again.
    Again(u32),
}

/// How going back ends somewhere.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Way {
    /// What is crossed, in the order of going back.
    pub links: Vec<Link>,
    /// Where it ends.
    pub horizon: Horizon,
}

/// Where a node is met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Met {
    /// On a way whose beginning is gone out of, to what has called it.
    Open,
    /// Within a branch that has been run through, whose beginning is not gone out of: what lies
    /// before the fork is looked at from its join.
    Branch,
    /// Within a call, likewise, or anywhere in another branch: its actions are not counted.
    Inner,
}

impl Met {
    /// Where the ends of branches are met from a join.
    fn within_branch(self) -> Self {
        self.max(Self::Branch)
    }
}

type State = (NodeId, Met);

struct Step {
    cost: u32,
    parent: Option<State>,
    link: Option<Link>,
}

/// What a way costs.
pub(crate) enum Cost<'a> {
    /// One for each call that is crossed, and each jump back.
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
                    search.add((node, Met::Open), 0, None, None);
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
        self.add((node, Met::Open), cost, None, None);
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
                Node::Entry { context: 0 } if state.1 == Met::Open => Some(Horizon::Start),
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
                        self.add((before, Met::Open), 1, None, link);
                    }
                }
            }
        }
    }

    fn expand(&mut self, state: State, cost: u32) {
        let (node, met) = state;
        let reach = self.reach;
        let (graph, pc) = (&reach.graph, reach.graph.pcs[node as usize]);
        if met == Met::Open {
            let owner = &graph.contexts[graph.owners[node as usize] as usize];
            self.follow(state, cost, (owner.around, Met::Inner), pc, None);
        }
        match graph.nodes[node as usize] {
            Node::Horizon { .. } => {}
            Node::Entry { context } if met == Met::Open => self.leave(state, cost, context),
            Node::Entry { .. } => {}
            Node::Merge { sources } => {
                for Source { node, until } in sources.into_iter().flatten() {
                    let link = (until > pc).then_some(Link::Again(pc));
                    self.follow(state, cost, (node, met), until, link);
                }
            }
            Node::Block { before, .. } => {
                for before in before {
                    self.follow(state, cost, (before, met), pc, None);
                }
            }
            Node::Call { .. } => {
                for (before, exit) in graph.passages(node) {
                    if reach.facts.at(before).is_reached {
                        self.enter(state, cost, exit, Link::Within(pc));
                        if reach.facts.at(exit).is_clear {
                            self.follow(state, cost, (before, met), pc, None);
                        }
                    }
                }
            }
            Node::Join { fork } => self.join(state, cost, &graph.forks[fork as usize]),
            Node::Leave { at } => self.left(state, cost, at),
            Node::Anywhere { .. } | Node::Around { .. } => self.other(state, cost),
        }
    }

    /// Into branches that have been run through; and to before the fork, if nothing stops in any.
    fn join(&mut self, state: State, cost: u32, fork: &Fork) {
        let (reach, met) = (self.reach, state.1);
        for (branch, end) in reach.graph.ends(fork) {
            self.follow(state, cost, (end, met.within_branch()), branch.end, None);
        }
        if reach.graph.ends(fork).all(|(_, end)| reach.facts.at(end).is_clear) {
            let join = reach.graph.pcs[state.0 as usize];
            self.follow(state, cost, (fork.before, met), join, None);
        }
    }

    /// Into the branch that a fork was left from, and the others; and to before the fork, of whose
    /// actions who knows how many were run.
    fn left(&mut self, state: State, cost: u32, at: NodeId) {
        let (reach, met) = (self.reach, state.1);
        let context = reach.graph.owners[at as usize];
        let until = reach.graph.pcs[at as usize];
        self.follow(state, cost, (at, met.within_branch()), until, None);
        self.beside(state, cost, context);
        if let (Some(fork), true) = (reach.graph.fork_of(context), reach.facts.at(at).is_clear) {
            self.follow(state, cost, (fork.before, met), fork.pc, None);
        }
    }

    /// Into the other branches of the fork that a context is a branch of.
    fn beside(&mut self, state: State, cost: u32, context: u32) {
        let graph = &self.reach.graph;
        if let Some(fork) = graph.fork_of(context) {
            for other in graph.beside(context) {
                self.enter(state, cost, other, Link::Beside(fork.pc));
            }
        }
    }

    /// What may have been run in turns between.
    fn other(&mut self, state: State, cost: u32) {
        let reach = self.reach;
        let graph = &reach.graph;
        match graph.nodes[state.0 as usize] {
            Node::Anywhere { context } => {
                for &loose in &graph.contexts[context as usize].loose {
                    let pc = graph.pcs[loose as usize];
                    let is_call = matches!(graph.nodes[loose as usize], Node::Call { .. });
                    let link = is_call.then_some(Link::Within(pc));
                    graph.each_run_by(&reach.facts, loose, &mut |node| {
                        self.follow(state, cost, (node, Met::Inner), pc, link);
                    });
                }
            }
            Node::Around { context } => {
                self.beside(state, cost, context);
                graph.each_around(context, &mut |entrance| {
                    if reach.is_entered(entrance.before) {
                        let owner = graph.owners[entrance.before as usize] as usize;
                        let around = (graph.contexts[owner].around, Met::Inner);
                        let link = Some(Link::CalledFrom(entrance.pc));
                        self.follow(state, cost, around, entrance.pc, link);
                    }
                });
            }
            _ => {}
        }
    }

    fn enter(&mut self, state: State, cost: u32, inner: NodeId, link: Link) {
        self.follow(state, cost, (inner, Met::Inner), 0, Some(link));
    }

    /// Out of a context, to each place that it is entered from.
    fn leave(&mut self, state: State, cost: u32, context: u32) {
        let reach = self.reach;
        let is_branch = reach.graph.contexts[context as usize].fork.is_some();
        if !is_branch && !(self.leaves)(reach.graph.contexts[context as usize].function) {
            return;
        }
        for entrance in reach.graph.entrances_of(context) {
            if reach.is_entered(entrance.before) {
                let link = (!is_branch).then_some(Link::CalledFrom(entrance.pc));
                self.follow(state, cost, (entrance.before, Met::Open), entrance.pc, link);
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
            Cost::Actions(..) if to.1 == Met::Inner => 0,
            Cost::Actions(begun, _) => {
                let at = self.reach.graph.pcs[to.0 as usize] as usize;
                begun[until as usize].saturating_sub(begun[at])
            }
        };
        self.add(to, cost.saturating_add(more), Some(from), link);
    }
}
