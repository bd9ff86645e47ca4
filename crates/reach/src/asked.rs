//! Where a program asks for a reversal that cannot be had: an error that is recovered from by going
//! back so far is raised at a place from which something stops going back before that.
//!
//! How far is counted as a recovery counts: actions of the sequence that raised the error, a call
//! being one, and then of those that called it. An action is taken back when its beginning is
//! passed, so that a call is one also on the way out of what it has called.

use crate::graph::{NOWHERE, NodeId};
use crate::search::{Cost, Search, Way};
use crate::{Horizon, Reach, is_never};
use obverse_bytecode::{Extent, FunctionKind, Module, Recovery, Respond};
use obverse_isa::{ErrorId, Instr};
use std::collections::HashMap;

/// The most shortfalls that are told of a module.
const MAX_TOLD: usize = 200;
/// How much is searched for them in all, so that it takes no longer than the program is long.
const MAX_SEARCHED: usize = 2_000_000;

/// A reversal that is asked for and cannot be had, or not always.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shortfall {
    /// The instruction that raises the error; of a fault, where it is responded to.
    pub raise: u32,
    /// The error, as an index.
    pub error: u16,
    /// What is in the way.
    pub kind: ShortfallKind,
}

/// Why a reversal cannot be had.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShortfallKind {
    /// Something stops it.
    Stopped {
        /// What, and how going back comes there.
        way: Way,
        /// How many actions lie between, if actions were asked for.
        after_actions: Option<u32>,
        /// Whether that is so on every way there.
        is_certain: bool,
    },
    /// There is a way there that does not pass the checkpoint.
    NotOnEveryWay,
    /// No way there passes the checkpoint.
    OnNoWay,
}

/// Every reversal that a module asks for and cannot have, by instruction; at most a few hundred.
#[must_use]
pub fn shortfalls(module: &Module) -> Vec<Shortfall> {
    let reverses = |error: &obverse_bytecode::ErrorDeclaration| {
        matches!(error.recovery, Recovery::Reversing(_))
    };
    if !module.errors.iter().any(reverses) {
        return Vec::new();
    }
    let reach = Reach::of(module);
    let mut asked = Asked {
        module,
        callers: reach.calls.reversed(),
        reach,
        begun: actions_begun(module),
        checkpoints: HashMap::new(),
        budget: MAX_SEARCHED,
    };
    let mut found = Vec::new();
    for (pc, instr) in (0_u32..).zip(&module.code) {
        let Instr::ErrorRaise { error } = *instr else { continue };
        if !is_raised_again(module, pc, error) {
            found.extend(asked.shortfall(pc, error));
        }
        if found.len() >= MAX_TOLD {
            return found;
        }
    }
    for (id, _) in (0..).zip(&module.errors).filter(|(_, error)| error.is_raised_by_workcell()) {
        // Almost every act may raise it, and it is gone back from where it is due: the first place
        // will do.
        let due = |instr: &Instr| *instr == Instr::ErrorDue { error: ErrorId(id) };
        let mut sites = (0_u32..).zip(&module.code).filter(|(_, instr)| due(instr));
        found.extend(sites.find_map(|(pc, _)| asked.from(pc, ErrorId(id), &[pc + 1])));
        if found.len() >= MAX_TOLD {
            break;
        }
    }
    found.sort_by_key(|shortfall| shortfall.raise);
    found
}

/// Whether an error is raised here that was pending before a recovery, which has failed: what is
/// to be said of it, has been where it was raised first.
fn is_raised_again(module: &Module, pc: u32, error: ErrorId) -> bool {
    let before = pc.checked_sub(1).and_then(|before| module.code.get(before as usize));
    before == Some(&Instr::ErrorClear { error })
}

/// How many actions begin up to each instruction.
fn actions_begun(module: &Module) -> Vec<u32> {
    let mut begun = vec![0; module.code.len()];
    for entry in module.source_map.iter().filter(|entry| entry.action.is_some()) {
        begun[entry.first as usize] = 1;
    }
    let mut all = 0;
    for count in &mut begun {
        all += *count;
        *count = all;
    }
    begun
}

impl Reach<'_> {
    /// A node, and what was there before each fork around it in its function, outwards.
    fn outwards(&self, node: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        let before = |node: &NodeId| Some(self.graph.before_fork(*node));
        std::iter::successors(Some(node), move |node| before(node).filter(|&node| node != NOWHERE))
    }

    /// The context of the function that a node is in.
    fn context_of_function(&self, node: NodeId) -> u32 {
        let outermost = self.outwards(node).last().unwrap_or(node);
        self.graph.owners[outermost as usize]
    }

    /// Whether there is a way to a node from the beginning of its function on which nothing stops.
    fn is_clear_in_function(&self, node: NodeId) -> bool {
        self.outwards(node).all(|node| self.facts.at(node).is_clear)
    }

    /// Whether something may stop going back from a node that its function has run, or that other
    /// branches have.
    fn may_stop_in_function(&self, node: NodeId) -> bool {
        let around =
            |node: NodeId| self.graph.contexts[self.graph.owners[node as usize] as usize].around;
        let mut nodes = self.outwards(node).flat_map(|node| [node, around(node)]);
        nodes.any(|node| !self.within.at(node).is_empty())
    }
}

struct Asked<'m> {
    module: &'m Module,
    reach: Reach<'m>,
    begun: Vec<u32>,
    /// The callers of each function.
    callers: Vec<Vec<u32>>,
    /// By checkpoint: the module with that as a horizon, too.
    checkpoints: HashMap<u16, Reach<'m>>,
    budget: usize,
}

impl<'m> Asked<'m> {
    /// What is in the way of the reversal that an error asks for that is raised here.
    fn shortfall(&mut self, raise: u32, error: ErrorId) -> Option<Shortfall> {
        let begin = self.begin(raise, self.module.errors[error.index()].respond);
        self.from(raise, error, &begin)
    }

    /// The same where it is gone back from before these instructions.
    fn from(&mut self, raise: u32, error: ErrorId, begin: &[u32]) -> Option<Shortfall> {
        let declared = &self.module.errors[error.index()];
        let Recovery::Reversing(policy) = &declared.recovery else { return None };
        let kind = match policy.extent {
            Extent::Actions(count) => self.within_actions(begin, count),
            Extent::Sequence => self.within_sequence(begin),
            Extent::Checkpoint(checkpoint) => self.before_checkpoint(begin, checkpoint),
        };
        kind.map(|kind| Shortfall { raise, error: error.0, kind })
    }

    /// Where going back begins for an error that is raised here: before these instructions.
    fn begin(&self, raise: u32, respond: Respond) -> Vec<u32> {
        let function = self.module.function_at(raise).unwrap_or(0);
        let end = |function: usize| self.module.functions[function].end - 1;
        match (respond, self.is_move(function)) {
            (Respond::AfterSequence, true) => {
                let callers = self.callers[function].iter();
                callers.map(|&caller| end(caller as usize)).collect()
            }
            (Respond::AfterSequence, false) | (Respond::AfterAction, true) => vec![end(function)],
            (Respond::AtOnce, _) | (Respond::AfterAction, false) => vec![raise + 1],
        }
    }

    /// What is there before instructions, in all contexts that are entered.
    fn entered<'a>(
        reach: &'a Reach<'m>,
        points: &'a [u32],
    ) -> impl Iterator<Item = (u32, NodeId)> + 'a {
        points.iter().flat_map(move |&pc| {
            let function = reach.module.function_at(pc).unwrap_or(0);
            let nodes = reach.nodes_before(function, pc);
            nodes.filter(|&node| reach.is_entered(node)).map(move |node| (pc, node))
        })
    }

    /// Whether a function is part of the sequence that calls it.
    fn is_move(&self, function: usize) -> bool {
        self.module.functions[function].kind == FunctionKind::AdvancedMove
    }

    /// The nearest horizon but the start, as far as a search goes, and after how many actions.
    fn nearest(&mut self, points: &[u32], most: u32, goes_on: bool) -> Option<(Way, u32)> {
        let module = self.module;
        let leaves = move |function: usize| {
            goes_on || module.functions[function].kind == FunctionKind::AdvancedMove
        };
        let cost = Cost::Actions(&self.begun, most);
        let mut search = Search::new(&self.reach, cost, Box::new(leaves));
        search.budget = self.budget;
        for (pc, node) in Self::entered(&self.reach, points) {
            let before = self.begun[self.reach.graph.pcs[node as usize] as usize];
            search.begin(node, self.begun[pc as usize - 1].saturating_sub(before));
        }
        let mut nearest = None;
        search.run(&mut |search, horizon| {
            if matches!(horizon, Horizon::Never(_)) {
                nearest = Some((search.way(horizon), search.cost()));
            }
            nearest.is_none()
        });
        self.budget = search.budget;
        nearest
    }

    fn within_actions(&mut self, points: &[u32], count: u32) -> Option<ShortfallKind> {
        let (way, after) = self.nearest(points, count, true)?;
        let after_actions = Some(after);
        Some(ShortfallKind::Stopped { way, after_actions, is_certain: false })
    }

    fn within_sequence(&mut self, points: &[u32]) -> Option<ShortfallKind> {
        let reach = &self.reach;
        let is_move = |node: NodeId| {
            let owner = reach.graph.owners[node as usize];
            self.is_move(reach.graph.contexts[owner as usize].function)
        };
        let is_clear_before = |node: NodeId| {
            let entrances = reach.graph.entrances_of(reach.context_of_function(node));
            entrances.iter().any(|entrance| {
                reach.is_entered(entrance.before) && reach.is_clear_in_function(entrance.before)
            })
        };
        let is_clear =
            |node| reach.is_clear_in_function(node) && (!is_move(node) || is_clear_before(node));
        let may_stop = Self::entered(reach, points)
            .any(|(_, node)| reach.may_stop_in_function(node) || is_move(node));
        let is_certain = !Self::entered(reach, points).any(|(_, node)| is_clear(node));
        let (way, _) = may_stop.then(|| self.nearest(points, u32::MAX, false)).flatten()?;
        Some(ShortfallKind::Stopped { way, after_actions: None, is_certain })
    }

    fn before_checkpoint(&mut self, points: &[u32], checkpoint: u16) -> Option<ShortfallKind> {
        let module = self.module;
        let marks = |instr: &Instr| match *instr {
            Instr::Checkpoint { checkpoint: marked } => marked.0 == checkpoint,
            _ => false,
        };
        let stops = |instr: &Instr| is_never(instr) || marks(instr);
        let reach =
            self.checkpoints.entry(checkpoint).or_insert_with(|| Reach::with(module, &stops));
        let is_it = |horizon: &Horizon| match *horizon {
            Horizon::Start => false,
            Horizon::Never(pc) => marks(&module.code[pc as usize]),
        };
        points.iter().find_map(|&pc| {
            let found = reach.at(pc);
            let is_on_a_way = found.is_more || found.horizons.iter().any(is_it);
            let is_never = |horizon: &&Horizon| **horizon != Horizon::Start && !is_it(horizon);
            let never = found.horizons.iter().find(is_never);
            if let Some(way) = never.and_then(|never| reach.way(pc, *never)) {
                let is_certain = !is_on_a_way;
                return Some(ShortfallKind::Stopped { way, after_actions: None, is_certain });
            }
            match (is_on_a_way, found.horizons.contains(&Horizon::Start)) {
                (false, true) => Some(ShortfallKind::OnNoWay),
                (true, true) => Some(ShortfallKind::NotOnEveryWay),
                (_, false) => None,
            }
        })
    }
}
