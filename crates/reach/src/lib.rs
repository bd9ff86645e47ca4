//! Reach: for every point of a program, how far back it can go and what stops it.
//!
//! Going back ends at a *horizon*: the newest instruction of class never that was run and not
//! passed over, or the start. [`Reach::of`] finds for every point which horizons it may have, on
//! all ways there: through calls, branches, loops, forks, and blocks with a reverse of their own.
//! It errs on one side: what a machine meets is always among them.
//!
//! The branches of a fork run in turns, and there is one line of history: going back from a branch
//! takes back the turns of the others, too. So what may stop it is also whatever another branch may
//! have run by then. This relies on two rules of the machine: only branches of the innermost fork
//! take turns, and a turn does not end in a block with a reverse of its own.
//!
//! It takes time and memory linear in the program: each function is looked at once or twice, calls
//! are followed by what a function adds to what was there before, and of each set the first
//! [`MAX_KEPT`] are kept; [`Reach::every`] and [`Reach::way`] ask for all of one point, and for the
//! reasons, in time linear in the program for each question.
//!
//! Read `graph` and `graph/fork`, then `facts`, `sets` and `search`; [`statement`] is for those who
//! show what was found. Knows modules, and neither sources nor machines; that a run may also end in
//! a fault or a trap is not its subject.

mod asked;
mod class;
mod condense;
mod edges;
mod facts;
mod few;
mod flag;
mod graph;
mod search;
mod sets;
pub mod statement;
mod turns;

pub use asked::{Shortfall, ShortfallKind, shortfalls};
pub use class::Standing;
pub use few::MAX_KEPT;
pub use search::{Link, Way};

use facts::Facts;
use graph::{Graph, NOWHERE, NodeId};
use obverse_bytecode::Module;
use obverse_isa::{Class, Instr};
use sets::{Beyond, Calls, Within};
use std::collections::BTreeSet;
use turns::Turns;

/// Where going back ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Horizon {
    /// The start of the program.
    Start,
    /// This instruction, which cannot be gone back over.
    Never(u32),
}

/// How far back a point can go.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Verdict {
    /// The horizons that it may have, the start first and then by instruction: at most
    /// [`MAX_KEPT`]. None if no run comes there.
    pub horizons: Vec<Horizon>,
    /// Whether it may have others.
    pub is_more: bool,
}

/// How far back a module can go from each of its points.
pub struct Reach<'m> {
    module: &'m Module,
    graph: Graph,
    facts: Facts,
    within: Within,
    beyond: Beyond,
    calls: Calls,
    standings: Vec<Standing>,
}

impl<'m> Reach<'m> {
    /// The reach of a module that keeps the rules of the verifier.
    #[must_use]
    pub fn of(module: &'m Module) -> Self {
        Self::with(module, &is_never)
    }

    /// The same where other instructions are horizons.
    fn with(module: &'m Module, stops: &dyn Fn(&Instr) -> bool) -> Self {
        let turns = Turns::of(module);
        let mut graph = Graph::of(module, stops, &turns);
        let mut facts = Facts::of(&graph);
        let mut is_entered = sets::entered(&graph, &facts);
        let is_come_to = |&node: &NodeId| {
            facts.at(node).is_reached && is_entered[graph.owners[node as usize] as usize]
        };
        if graph.set_at_turns.iter().any(is_come_to) {
            graph = Graph::of(module, stops, &turns.with_altered_flags());
            facts = Facts::of(&graph);
            is_entered = sets::entered(&graph, &facts);
        }
        let within = Within::of(&graph, &facts, &is_entered);
        let calls = Calls::of(module);
        let beyond = Beyond::of(&graph, &facts, is_entered, &within, &calls);
        let standings = class::of_functions(module, &calls);
        Self { module, graph, facts, within, beyond, calls, standings }
    }

    /// How far back a run can go that stands before an instruction.
    #[must_use]
    pub fn at(&self, pc: u32) -> Verdict {
        let Some(function) = self.module.function_at(pc) else { return Verdict::default() };
        let mut set = few::Few::default();
        for node in self.nodes_before(function, pc) {
            set.add(&self.beyond.at(&self.graph, &self.facts, &self.within, node));
        }
        if let Some(around) = &self.beyond.around[function] {
            set.add(around);
        }
        Verdict { horizons: set.horizons().collect(), is_more: set.is_more() }
    }

    /// Every horizon of a point, however many.
    #[must_use]
    pub fn every(&self, pc: u32) -> BTreeSet<Horizon> {
        let mut all = BTreeSet::new();
        self.search_from(pc).run(&mut |_, found| {
            all.insert(found);
            true
        });
        all
    }

    /// How going back from a point ends at a horizon, if it may: by the fewest calls and rounds.
    #[must_use]
    pub fn way(&self, pc: u32, horizon: Horizon) -> Option<Way> {
        let mut way = None;
        self.search_from(pc).run(&mut |search, found| {
            if found == horizon {
                way = Some(search.way(found));
            }
            way.is_none()
        });
        way
    }

    /// Whether a run can come to an instruction, as far as its calls and jumps say.
    #[must_use]
    pub fn is_reached(&self, pc: u32) -> bool {
        !self.at(pc).horizons.is_empty()
    }

    /// Why an instruction of class never cannot be gone back over: in the program's own words where
    /// it has them.
    #[must_use]
    pub fn reason(&self, pc: u32) -> &'m str {
        reason(self.module, pc)
    }

    /// What is there before an instruction, in all contexts.
    fn nodes_before(&self, function: usize, pc: u32) -> impl Iterator<Item = NodeId> + '_ {
        let contexts = self.graph.contexts_of(function);
        let nodes = contexts.flat_map(move |at| self.graph.before(self.module, at, pc));
        nodes.filter(|&node| node != NOWHERE)
    }
}

/// Why an instruction of class never cannot be gone back over: in the program's own words where it
/// has them. Empty for others.
#[must_use]
pub fn reason(module: &Module, pc: u32) -> &str {
    let Some(instr) = module.code.get(pc as usize) else { return "" };
    let own = match *instr {
        Instr::Barrier { reason } | Instr::Irreversible { reason } => {
            module.reasons.get(reason.index())
        }
        _ => None,
    };
    match (own, instr.info().class) {
        (Some(own), _) => own,
        (None, Class::Never(why)) => why,
        (None, _) => "",
    }
}

fn is_never(instr: &Instr) -> bool {
    matches!(instr.info().class, Class::Never(_))
}
