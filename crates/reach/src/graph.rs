//! The program as a graph of what may stop going back: a node where that changes, and from each
//! node edges to what was there before.
//!
//! A function is one pass over its code, since every join names its jump, and a row of instructions
//! between two nodes shares the node before it. So the graph is linear in the program, and the sets
//! of horizons, which are not, need not be written down. A function that is called while
//! a [`flag`](crate::flag) is set is another *context* of it; so is each branch of a fork, which
//! [`fork`] adds. Knows nothing of what stops.

mod fork;

use crate::flag::{Flag, Flags, Touch, VALUES};
use crate::turns::Turns;
use obverse_bytecode::Module;
use obverse_isa::{Instr, Label};

pub(crate) type NodeId = u32;

/// Stands for no node: a point that is not come to.
pub(crate) const NOWHERE: NodeId = NodeId::MAX;

/// By the value of the flags: a node, or nowhere.
pub(crate) type ByFlags = [NodeId; VALUES];

/// The state of a point that is not come to.
const UNREACHED: ByFlags = [NOWHERE; VALUES];

/// What was there before a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source {
    pub(crate) node: NodeId,
    /// The last instruction between that node and this one.
    pub(crate) until: u32,
}

/// Where what stops going back changes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Node {
    /// The beginning of a context.
    Entry { context: u32 },
    /// An instruction that cannot be gone back over.
    Horizon { before: NodeId },
    /// Two ways meet, or one comes here.
    Merge { sources: [Option<Source>; 2] },
    /// Behind a call: by the flags before it, what was there, and the context that is called; with
    /// the flags that it returns with.
    Call { before: ByFlags, contexts: [u32; VALUES], flags: u8 },
    /// Behind a block with a reverse of its own, which is passed over: what was before it, and
    /// what was at its end.
    Block { before: ByFlags, inside: NodeId },
    /// Behind a fork of which all branches have been run through.
    Join { fork: u32 },
    /// Behind a fork that was left: what was there in the branch that it was left from.
    Leave { at: NodeId },
    /// What a context may have run when another branch of a fork has its turn.
    Anywhere { context: u32 },
    /// What other branches may have run while a context is under way.
    Around { context: u32 },
}

/// A function, called with the flags at a value; or a branch of a fork in it.
#[derive(Clone, Debug)]
pub(crate) struct Context {
    pub(crate) function: usize,
    /// What is there at its end, by the flags.
    pub(crate) exits: ByFlags,
    /// The fork that it is a branch of.
    pub(crate) fork: Option<u32>,
    /// The node of [`Node::Anywhere`]; nowhere in a module without forks, as the next.
    pub(crate) anywhere: NodeId,
    /// The node of [`Node::Around`].
    pub(crate) around: NodeId,
    /// Its horizons, calls and joins of forks, but for those in a block with a reverse of its own:
    /// while that is run no other branch has its turn.
    pub(crate) loose: Vec<NodeId>,
    /// Where its points begin in those of the graph; those of a branch are among its function's.
    points: usize,
}

/// A fork, in one context.
#[derive(Clone, Debug)]
pub(crate) struct Fork {
    pub(crate) pc: u32,
    pub(crate) before: NodeId,
    pub(crate) branches: Vec<Branch>,
}

/// A branch of a fork.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Branch {
    pub(crate) context: u32,
    /// The `fork.next` or `fork.join` that ends it.
    pub(crate) end: u32,
}

/// Where a context is entered from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entrance {
    /// The call, or the fork.
    pub(crate) pc: u32,
    pub(crate) before: NodeId,
    pub(crate) callee: u32,
}

/// A block in whose place a function is run in reverse.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Replacement {
    /// The end of the block.
    pub(crate) pc: u32,
    pub(crate) before: ByFlags,
    pub(crate) inside: NodeId,
    pub(crate) function: usize,
}

/// The graph of a module, as far as calls lead.
pub(crate) struct Graph {
    pub(crate) nodes: Vec<Node>,
    /// The instruction of each node.
    pub(crate) pcs: Vec<u32>,
    /// The context of each node.
    pub(crate) owners: Vec<u32>,
    pub(crate) contexts: Vec<Context>,
    /// The contexts of each function, by the flags.
    pub(crate) by_function: Vec<[Option<u32>; VALUES]>,
    pub(crate) entrances: Vec<Entrance>,
    pub(crate) replacements: Vec<Replacement>,
    pub(crate) forks: Vec<Fork>,
    /// What is come to only if a turn may end while a flag is set.
    pub(crate) set_at_turns: Vec<NodeId>,
    /// What is there behind each instruction of each context, by the flags.
    points: Vec<ByFlags>,
}

impl Graph {
    /// The graph of a module that keeps the rules of the verifier; `stops` says which instructions
    /// are horizons, and `turns` what is known of the flags where they end.
    pub(crate) fn of(module: &Module, stops: &dyn Fn(&Instr) -> bool, turns: &Turns) -> Self {
        let graph = Self {
            nodes: Vec::new(),
            pcs: Vec::new(),
            owners: Vec::new(),
            contexts: Vec::new(),
            by_function: vec![[None; VALUES]; module.functions.len()],
            entrances: Vec::new(),
            replacements: Vec::new(),
            forks: Vec::new(),
            set_at_turns: Vec::new(),
            points: Vec::new(),
        };
        let mut builder = Builder { module, stops, turns, flags: Flags::of(module), graph };
        if !module.functions.is_empty() {
            builder.context(0, 0);
        }
        let mut done = 0;
        while let Some(context) = builder.graph.contexts.get(done) {
            // A branch is gone through with the function that it is in.
            if context.fork.is_none() {
                builder.function(done as u32);
            }
            done += 1;
        }
        let mut graph = builder.graph;
        graph.entrances.sort_by_key(|entrance| entrance.callee);
        graph
    }

    /// Where a context is entered from.
    pub(crate) fn entrances_of(&self, context: u32) -> &[Entrance] {
        let first = self.entrances.partition_point(|entrance| entrance.callee < context);
        let count = self.entrances[first..].partition_point(|one| one.callee == context);
        &self.entrances[first..first + count]
    }

    /// What is there before an instruction, in a context that holds it: by the flags.
    pub(crate) fn before(&self, module: &Module, context: u32, pc: u32) -> ByFlags {
        let context = &self.contexts[context as usize];
        let first = module.functions[context.function].first;
        // Nothing stands before the first instruction, which is landed on.
        let at = (pc.saturating_sub(first) as usize).saturating_sub(1);
        self.points.get(context.points + at).copied().unwrap_or(UNREACHED)
    }

    /// The contexts of a function.
    pub(crate) fn contexts_of(&self, function: usize) -> impl Iterator<Item = u32> + '_ {
        self.by_function.get(function).into_iter().flatten().copied().flatten()
    }
}

struct Builder<'m> {
    module: &'m Module,
    stops: &'m dyn Fn(&Instr) -> bool,
    turns: &'m Turns,
    flags: Flags,
    graph: Graph,
}

impl Builder<'_> {
    /// The context of a function that is called with the flags at a value.
    fn context(&mut self, function: usize, flags: usize) -> u32 {
        let known = self.graph.by_function[function][flags];
        known.unwrap_or_else(|| {
            let first = self.module.functions[function].first;
            let index = self.new_context(function, first, None);
            self.graph.by_function[function][flags] = Some(index);
            index
        })
    }

    fn new_context(&mut self, function: usize, pc: u32, fork: Option<u32>) -> u32 {
        let context = self.graph.contexts.len() as u32;
        let (mut anywhere, mut around) = (NOWHERE, NOWHERE);
        if self.turns.has_forks() {
            anywhere = self.node(context, pc, Node::Anywhere { context });
            around = self.node(context, pc, Node::Around { context });
        }
        let (exits, loose, points) = (UNREACHED, Vec::new(), 0);
        let new = Context { function, exits, fork, anywhere, around, loose, points };
        self.graph.contexts.push(new);
        context
    }

    /// One pass over the code of a context.
    fn function(&mut self, context: u32) {
        let function = self.graph.contexts[context as usize].function;
        let (first, end) =
            (self.module.functions[function].first, self.module.functions[function].end);
        let contexts = &self.graph.by_function[function];
        let flags = contexts.iter().position(|known| *known == Some(context)).unwrap_or(0);
        let points = self.graph.points.len();
        let mut entry = UNREACHED;
        entry[flags] = self.node(context, first, Node::Entry { context });
        self.graph.points.push(entry);
        let (jumps_back, forks) = (Vec::new(), Vec::new());
        let mut pass = Pass { context, points, first, jumps_back, forks, blocks: 0 };
        for pc in first + 1..end {
            let mut state = self.step(&mut pass, pc);
            if self.module.code[pc as usize].ends_turn() && self.turns.is_in_fork(pc) {
                state = self.turn(&pass, pc, state);
            }
            self.graph.points.push(state);
        }
        for (node, flags, from) in std::mem::take(&mut pass.jumps_back) {
            let came = self.jumped(&pass, from)[flags];
            if let Node::Merge { sources } = &mut self.graph.nodes[node as usize] {
                sources[1] = (came != NOWHERE).then_some(Source { node: came, until: from });
            }
        }
        let exits = self.graph.points[points..].iter().nth_back(1).copied();
        let done = &mut self.graph.contexts[context as usize];
        done.exits = exits.unwrap_or(UNREACHED);
        done.points = points;
    }

    fn node(&mut self, context: u32, pc: u32, node: Node) -> NodeId {
        let id = self.graph.nodes.len() as NodeId;
        self.graph.nodes.push(node);
        self.graph.pcs.push(pc);
        self.graph.owners.push(context);
        id
    }

    /// What is there behind an instruction.
    fn step(&mut self, pass: &mut Pass, pc: u32) -> ByFlags {
        let instr = self.module.code[pc as usize];
        let before = self.point(pass, pc - 1);
        if (self.stops)(&instr) {
            return before.map(|before| {
                let node = self.unless_nowhere(pass, pc, before, Node::Horizon { before });
                self.loose(pass, node);
                node
            });
        }
        match instr {
            Instr::Call { function, .. } => self.call(pass, pc, before, function.index()),
            Instr::BlockBegin {} => {
                pass.blocks += 1;
                before
            }
            Instr::BlockSkip { from } => self.block(pass, pc, before, from, None),
            Instr::BlockReplace { from, function } => {
                self.block(pass, pc, before, from, Some(function.index()))
            }
            Instr::Fork { .. } => self.fork(pass, pc, before),
            Instr::ForkNext {} => self.fork_next(pass, pc, before),
            Instr::ForkJoin { .. } => self.fork_join(pass, pc, before),
            Instr::ForkLeave { .. } => fork::leave(pass, pc),
            _ => match (instr.join_from(), self.flags.touch(self.module, pc as usize)) {
                (Some(from), _) => self.join(pass, pc, &instr, from.0),
                (None, Touch::Set(flag, value)) => self.set(pass, pc, before, flag, value),
                (None, Touch::JumpsIf(flag, value)) => only(before, flag, !value),
                (None, Touch::None) => before,
            },
        }
    }

    fn point(&self, pass: &Pass, pc: u32) -> ByFlags {
        self.graph.points[pass.points + (pc - pass.first) as usize]
    }

    fn unless_nowhere(&mut self, pass: &Pass, pc: u32, before: NodeId, node: Node) -> NodeId {
        if before == NOWHERE { NOWHERE } else { self.node(pass.context, pc, node) }
    }

    /// What a jump takes along.
    fn jumped(&self, pass: &Pass, from: u32) -> ByFlags {
        if is_surely_entered(self.module, from as usize) {
            return UNREACHED;
        }
        let before = self.point(pass, from - 1);
        match self.flags.touch(self.module, from as usize) {
            Touch::JumpsIf(flag, value) => only(before, flag, value),
            _ => before,
        }
    }

    fn join(&mut self, pass: &mut Pass, pc: u32, instr: &Instr, from: u32) -> ByFlags {
        let is_land = matches!(instr, Instr::Land { .. });
        let beside = if is_land { UNREACHED } else { self.point(pass, pc - 1) };
        let comes_later = from > pc;
        let jumped = if comes_later { UNREACHED } else { self.jumped(pass, from) };
        std::array::from_fn(|flags| {
            let is_back = comes_later && flags < self.flags.values();
            let source = |node: NodeId, until| (node != NOWHERE).then_some(Source { node, until });
            let sources = [source(beside[flags], pc - 1), source(jumped[flags], from)];
            let is_reached = is_back || sources.iter().any(Option::is_some);
            if !is_reached {
                return NOWHERE;
            }
            let node = self.node(pass.context, pc, Node::Merge { sources });
            if is_back {
                pass.jumps_back.push((node, flags, from));
            }
            node
        })
    }

    /// A flag is set: whatever it was before.
    fn set(&mut self, pass: &Pass, pc: u32, before: ByFlags, flag: Flag, value: bool) -> ByFlags {
        std::array::from_fn(|flags| match flag.is_set(flags) == value {
            true => self.merge(pass, pc, [before[flags], before[flags ^ flag.bit()]]),
            false => NOWHERE,
        })
    }

    /// Either of two nodes, if any.
    fn merge(&mut self, pass: &Pass, pc: u32, nodes: [NodeId; 2]) -> NodeId {
        let sources = nodes.map(|node| (node != NOWHERE).then_some(Source { node, until: pc }));
        match sources.iter().any(Option::is_some) {
            true => self.node(pass.context, pc, Node::Merge { sources }),
            false => NOWHERE,
        }
    }

    /// Note what may have been run when another branch has its turn.
    fn loose(&mut self, pass: &Pass, node: NodeId) {
        if self.turns.has_forks() && pass.blocks == 0 && node != NOWHERE {
            self.graph.contexts[pass.context as usize].loose.push(node);
        }
    }

    fn call(&mut self, pass: &Pass, pc: u32, before: ByFlags, function: usize) -> ByFlags {
        let mut contexts = [u32::MAX; VALUES];
        for (flags, before) in before.into_iter().enumerate() {
            if before != NOWHERE {
                let callee = self.context(function, flags);
                contexts[flags] = callee;
                self.graph.entrances.push(Entrance { pc, before, callee });
            }
        }
        if before == UNREACHED {
            return UNREACHED;
        }
        let behind = std::array::from_fn(|flags| match flags < self.flags.values() {
            true => {
                self.node(pass.context, pc, Node::Call { before, contexts, flags: flags as u8 })
            }
            false => NOWHERE,
        });
        // With whatever flags it returns, it has been called.
        self.loose(pass, behind[0]);
        behind
    }

    fn block(
        &mut self,
        pass: &mut Pass,
        pc: u32,
        at_end: ByFlags,
        from: Label,
        function: Option<usize>,
    ) -> ByFlags {
        pass.blocks = pass.blocks.saturating_sub(1);
        let before = self.point(pass, from.0 - 1);
        at_end.map(|inside| {
            if let (Some(function), true) = (function, inside != NOWHERE) {
                let replacement = Replacement { pc, before, inside, function };
                self.graph.replacements.push(replacement);
            }
            self.unless_nowhere(pass, pc, inside, Node::Block { before, inside })
        })
    }
}

/// Whether this begins a counted loop whose bounds are written there, and which has a round.
fn is_surely_entered(module: &Module, at: usize) -> bool {
    let instr = &module.code[at];
    if !matches!(instr, Instr::ForEnter { .. }) || instr.prefix() != 2 {
        return false;
    }
    match at.checked_sub(2).map(|first| &module.code[first..at]) {
        Some([Instr::PushInt { value: first }, Instr::PushInt { value: last }]) => first <= last,
        _ => false,
    }
}

/// Of a state, what is so with a flag at a value.
fn only(state: ByFlags, flag: Flag, value: bool) -> ByFlags {
    let is_so = |flags: usize| flag.is_set(flags) == value;
    std::array::from_fn(|flags| if is_so(flags) { state[flags] } else { NOWHERE })
}

/// A pass over the code of a context.
struct Pass {
    /// Of the function, or of the innermost branch.
    context: u32,
    points: usize,
    first: u32,
    /// The joins of jumps that come later: the node, the flags, the jump.
    jumps_back: Vec<(NodeId, usize, u32)>,
    /// The forks that are open.
    forks: Vec<fork::Open>,
    /// How many blocks with a reverse of their own are open, of the innermost branch or function.
    blocks: u32,
}
