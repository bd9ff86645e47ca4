//! The ways back: what each move meets when the machine goes back over it.
//!
//! Going back over a deed from the workcell that it left is looked at for every deed: a reversal
//! may begin behind any of them. That leads to the workcell before it, behind the deed before,
//! which is looked at anyway. Only where it leads elsewhere (a block that is passed over or
//! replaced, a move to the position that was named last) the workcell is carried further back.
//! Two workcells of which not all is known may be different ones.

use crate::command::Aim;
use crate::explore::{Course, Explorer};
use crate::state::{Frame, State};
use crate::trace::{Deed, Node, NodeId};
use crate::verdict::because;
use crate::worlds::WorldId;
use obverse_isa::FunctionId;
use obverse_vm::Direction;
use std::collections::HashSet;
use std::rc::Rc;

/// The most deeds that are gone back over from a workcell that they did not leave.
const MAX_DEVIATIONS: usize = 50_000;

/// A machine that is about to go back over a deed.
struct Back {
    over: NodeId,
    from: WorldId,
    /// Whether it may be another workcell than the deed left.
    is_elsewhere: bool,
}

impl Explorer<'_> {
    /// Look at every move in reverse; whether all of it was looked at.
    pub(crate) fn go_back(&mut self) -> bool {
        let mut open: Vec<Back> = Vec::new();
        for over in self.trace.ids() {
            let from = self.trace.of(over).after;
            open.push(Back { over, from, is_elsewhere: false });
        }
        let mut seen: HashSet<(NodeId, WorldId, bool)> = HashSet::new();
        let mut deviations = 0;
        while let Some(back) = open.pop() {
            if !seen.insert((back.over, back.from, back.is_elsewhere)) {
                continue;
            }
            deviations += usize::from(back.is_elsewhere);
            if deviations > MAX_DEVIATIONS {
                return false;
            }
            self.back_over(&back, &mut open);
        }
        true
    }

    fn back_over(&mut self, back: &Back, open: &mut Vec<Back>) {
        let node = self.trace.of(back.over).clone();
        // Undone where it was done, it leaves what was before, however little of that is known.
        let restores = !back.is_elsewhere && self.restores(&node);
        let (mut before, mut behind) = (node.before, node.from);
        let arrived = match node.deed {
            Deed::Begin | Deed::Never => return,
            Deed::Move { pc, back: command, calls, is_planned, since } => {
                let answer = self.worlds.ask(back.from, &command);
                let verdict = because(&answer.verdict, since, Direction::Reverse);
                self.notes.add(pc, Direction::Reverse, &verdict, &calls, is_planned);
                vec![answer.after]
            }
            _ if restores => return,
            Deed::Merge | Deed::BlockBegin => vec![back.from],
            Deed::Unfollowed { .. } => vec![self.worlds.nothing_known()],
            Deed::Output => {
                let level = self.worlds.level(node.before);
                vec![self.worlds.with_level(back.from, level)]
            }
            Deed::Toggle => {
                let level = self.worlds.level(back.from).map(|level| !level);
                vec![self.worlds.with_level(back.from, level)]
            }
            Deed::BlockSkip { begin } => {
                let begin = self.trace.of(begin);
                (before, behind) = (begin.before, begin.from.clone());
                vec![back.from]
            }
            Deed::BlockReplace { begin, function, state } => {
                let begin = self.trace.of(begin);
                (before, behind) = (begin.before, begin.from.clone());
                self.replace(&state, back.from, function)
            }
        };
        if restores {
            return;
        }
        for from in arrived {
            if from != before || !self.worlds.is_known(from) {
                let to = |&over| Back { over, from, is_elsewhere: true };
                open.extend(behind.iter().map(to));
            }
        }
    }

    /// Whether a deed's own reversal, from where the deed led, leads to where it began.
    fn restores(&self, node: &Node) -> bool {
        match &node.deed {
            Deed::Move { back, .. } => match (back.aim, self.worlds.joints(node.before)) {
                // Recorded, and not known here.
                (Aim::NotKnown, _) => true,
                (aim, from) => from.is_some_and(|from| aim.leads_back_to(&from)),
            },
            Deed::Unfollowed { restores } => *restores,
            Deed::BlockSkip { .. } | Deed::BlockReplace { .. } => false,
            _ => true,
        }
    }

    /// Run a function in place of going back over a block; the workcells that it may leave.
    fn replace(&mut self, state: &Rc<State>, world: WorldId, function: FunctionId) -> Vec<WorldId> {
        let mut state = State::clone(state);
        let functions = &self.values.module.functions;
        let declared = &functions[function.index()];
        let mut frame = Frame::new(function.index(), declared, state.pc + 1);
        frame.begin_with(state.frame(), declared);
        // Going back moves too, so that what the last motion reported is another one.
        (state.distance, state.peak_force, state.duration) = (None, None, None);
        state.frames = vec![frame];
        (state.blocks, state.forks) = (Vec::new(), Vec::new());
        state.world = world;
        state.pc = declared.first as usize + 1;
        let mut left = self.follow(state, Course::InReverse);
        left.sort_unstable();
        left.dedup();
        left
    }
}
