//! The trail of a run: where each action began, so that going back has somewhere to go.
//!
//! An action is what a recovery counts: a move, an advanced move, an I/O operation, a wait, a
//! primitive, or the call of an `action`; sequences are transparent. The trail is kept from what
//! the machine tells, and begins anew at what cannot be taken back. Knows nothing of errors.

use crate::passage::Passage;
use obverse_bytecode::{ActionKind, FunctionKind, Module};
use obverse_geometry::JointConfiguration;
use obverse_isa::{CheckpointId, Class, Family, FunctionId, Instr};
use obverse_vm::{Direction, Event};
use obverse_workcell::Workcell;
use std::collections::VecDeque;

/// The arm is where it was if no joint is farther away than this, in radians: a micrometre at the
/// tool.
const SAME_PLACE_RAD: f64 = 1e-6;

/// How many motions are looked back on for one that began where the arm is.
const MOTIONS_MAX: usize = 64;

/// An action that was begun.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// How many instructions lay before it.
    pub steps: u64,
    /// The first of its instructions that was told of.
    pub pc: u32,
    /// When it began, in seconds of the workcell's clock; later by what has been taken back since,
    /// so that from then to now is what came of it and stayed.
    pub began_s: f64,
    /// Whether nothing but motions of the arm has been commanded in it, outside of blocks with a
    /// reverse of their own.
    pub only_moves: bool,
    /// How far the arm had gone when it began, in metres; further by what has been taken back.
    pub began_way_m: f64,
    /// How long it only waited, in seconds: that is not waited going back.
    waited_s: f64,
    /// How many actions of the run lie before it.
    pub number: u64,
    /// Its entry in the source map, by its first instruction.
    pub entry: u32,
    /// The last of its instructions that was told of.
    last_pc: u32,
    /// How many calls were under way around it.
    pub depth: usize,
    /// The branches that it belongs to.
    branches: Vec<usize>,
    /// How many instructions lay before its end, once it has come to it.
    ended: Option<u64>,
    /// Whether it is a call whose content belongs to it.
    is_call: bool,
    /// The last motion in it, and whether a force was to stop it.
    motion: Option<(u32, bool)>,
}

/// Whether it is a motion of the arm; one that a fault has ended has no report.
fn is_motion(event: &Event) -> bool {
    event.instr.info().family == Family::Kinematic
}

impl Action {
    /// Whether one of these lines of branches leads into the other.
    fn is_in_line(&self, branches: &[usize]) -> bool {
        self.branches.starts_with(branches) || branches.starts_with(&self.branches)
    }

    /// The motion that it is about: the last that a force was to stop, or the last of all.
    #[must_use]
    pub fn motion(&self) -> Option<u32> {
        self.motion.map(|(pc, _)| pc)
    }

    fn note_act(&mut self, event: &Event, took_s: f64) {
        if matches!(event.instr, Instr::Wait { .. } | Instr::WaitInput { .. }) {
            self.waited_s += took_s;
        }
        let is_motion = is_motion(event);
        let acts = event.instr.info().family.commands_workcell();
        self.only_moves &= event.open_blocks == 0 && (is_motion || !acts);
        let is_guarded =
            matches!(event.instr, Instr::MoveGuarded { .. } | Instr::MoveGuardedOpposite { .. });
        let was_guarded = self.motion.is_some_and(|(_, is_guarded)| is_guarded);
        if is_motion && (is_guarded || !was_guarded) {
            self.motion = Some((event.pc, is_guarded));
        }
    }
}

/// A motion that was begun, with nothing but motions since.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Begun {
    /// How many instructions lay before it.
    pub(crate) steps: u64,
    /// Its instruction.
    pub(crate) pc: u32,
    /// When it began, in seconds of the workcell's clock.
    pub(crate) began_s: f64,
    /// How far the arm had gone by then, in metres.
    began_way_m: f64,
    /// Where the arm was.
    joints: JointConfiguration,
}

impl Begun {
    /// Whether it is the motion of an instruction that so many others lay before.
    fn is_at(&self, steps: u64, pc: u32) -> bool {
        (self.steps, self.pc) == (steps, pc)
    }
}

/// Something on the way other than an action.
#[derive(Clone, Debug, PartialEq)]
enum Post {
    Checkpoint(CheckpointId),
    /// A sequence began, with so many calls around its own.
    Sequence {
        depth: usize,
        branches: Vec<usize>,
    },
}

/// Where a run may be taken back to, newest last.
#[derive(Clone, Debug)]
pub struct Trail<'m> {
    module: &'m Module,
    actions: Vec<Action>,
    posts: Vec<(u64, Post)>,
    /// The motions since anything else was commanded, the newest last.
    motions: VecDeque<Begun>,
    /// How many actions of the run are no longer on the trail.
    dropped: u64,
    never: Option<u32>,
    /// What the run has yet to get past, by the number that it was awaited under.
    awaited: Vec<(u64, Passage)>,
    /// How often something was awaited.
    await_count: u64,
    /// When the last event was, in seconds.
    now_s: f64,
    /// Where the arm was then.
    joints: JointConfiguration,
    /// How far the arm had gone then, in metres.
    way_m: f64,
}

impl<'m> Trail<'m> {
    /// The trail of a run at its start, with the arm there.
    #[must_use]
    pub fn new(module: &'m Module, joints: JointConfiguration) -> Self {
        Self {
            joints,
            module,
            actions: Vec::new(),
            posts: Vec::new(),
            motions: VecDeque::new(),
            dropped: 0,
            never: None,
            awaited: Vec::new(),
            await_count: 0,
            now_s: 0.0,
            way_m: 0.0,
        }
    }

    /// The program.
    pub(crate) fn module(&self) -> &'m Module {
        self.module
    }

    /// The actions that can be taken back, newest last.
    #[must_use]
    pub fn actions(&self) -> &[Action] {
        &self.actions
    }

    /// The newest action of these branches, or around them: other branches have theirs.
    #[must_use]
    pub fn newest_of(&self, branches: &[usize]) -> Option<&Action> {
        self.actions.iter().rev().find(|action| action.is_in_line(branches))
    }

    /// How many actions are taken back with the newest one of these branches.
    #[must_use]
    pub fn back_to_newest_of(&self, branches: &[usize]) -> usize {
        let others = self.actions.iter().rev().take_while(|action| !action.is_in_line(branches));
        others.count() + 1
    }

    /// How many actions the run has begun, those included that it can no longer take back.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.dropped + self.actions.len() as u64
    }

    /// From now on, see whether the run gets past a place; the number to ask by.
    pub(crate) fn await_passage(&mut self, passage: Passage) -> u64 {
        self.await_count += 1;
        self.awaited.push((self.await_count, passage));
        self.await_count
    }

    /// Whether the run has yet to get past the place of a number.
    pub(crate) fn is_awaited(&self, number: u64) -> bool {
        self.awaited.iter().any(|(awaited, _)| *awaited == number)
    }

    /// Whether the run has begun an action of these branches since the one of a number and entry.
    #[must_use]
    pub fn has_passed(&self, number: u64, entry: u32, branches: &[usize]) -> bool {
        if branches.is_empty() {
            return self.count() > number + 1;
        }
        let is_on = |action: &Action| {
            action.number > number && action.entry != entry && action.is_in_line(branches)
        };
        self.dropped > number + 1 || self.actions.iter().rev().any(is_on)
    }

    /// What it takes to go back so many actions and to come again, in seconds and in metres: twice
    /// what they took, but for waits, and for motions that ended where they began. None if there
    /// are not so many.
    pub(crate) fn there_and_back(
        &self,
        actions: usize,
        cell: &(impl Workcell + ?Sized),
    ) -> Option<(f64, f64)> {
        let to = self.actions.get(self.actions.len().checked_sub(actions)?)?;
        let passed = self.round_trip(to.steps, &cell.joints());
        let twice = |now: f64, began: f64, passed: Option<f64>| {
            let again = (now - began).max(0.0);
            again + passed.map_or(again, |passed| (passed - began).max(0.0))
        };
        let moved_s = twice(cell.now_s(), to.began_s, passed.map(|motion| motion.began_s));
        let taken_back = self.actions.iter().rev().take(actions);
        let waited_s: f64 = taken_back.map(|action| action.waited_s).sum();
        let time_s = (moved_s - waited_s).max(cell.now_s() - to.began_s);
        let passed_m = passed.map(|motion| motion.began_way_m);
        Some((time_s, twice(cell.way_m(), to.began_way_m, passed_m)))
    }

    /// What stands in the way of going back further than the trail, if anything does.
    #[must_use]
    pub fn never(&self) -> Option<u32> {
        self.never
    }

    /// Whether going back so many actions takes back more than motions of the arm, so that what is
    /// held, and how, is done anew on the way forward again.
    #[must_use]
    pub fn takes_back_more_than_moves(&self, actions: usize) -> bool {
        self.actions.iter().rev().take(actions).any(|action| !action.only_moves)
    }

    /// The first motion since so many instructions that began where the arm is now, with nothing
    /// but motions since: all that came of them in the world is undone already.
    pub(crate) fn round_trip(&self, since: u64, now: &JointConfiguration) -> Option<&Begun> {
        self.motions.iter().find(|motion| {
            motion.steps >= since && motion.joints.largest_difference_rad(now) < SAME_PLACE_RAD
        })
    }

    /// How many actions lie between here and the newest passage of a checkpoint; none if it does
    /// not lie on the trail.
    #[must_use]
    pub fn back_to_checkpoint(&self, checkpoint: CheckpointId) -> Option<usize> {
        let is_it = |post: &Post| matches!(post, Post::Checkpoint(passed) if *passed == checkpoint);
        self.back_to(is_it)
    }

    /// How many actions the sequence has begun that the newest action is in; none if it began
    /// before the trail.
    #[must_use]
    pub fn back_to_sequence(&self) -> Option<usize> {
        let newest = self.actions.last()?;
        self.back_to(|post| match post {
            Post::Sequence { depth, branches } => {
                *depth < newest.depth && newest.branches.starts_with(branches)
            }
            Post::Checkpoint(_) => false,
        })
    }

    fn back_to(&self, is_it: impl Fn(&Post) -> bool) -> Option<usize> {
        let (steps, _) = self.posts.iter().rev().find(|(_, post)| is_it(post))?;
        Some(self.actions.len() - self.actions.partition_point(|action| action.steps < *steps))
    }

    /// Something happened; the workcell is as it was left.
    pub fn note(&mut self, event: &Event, cell: &dyn Workcell) {
        if event.direction == Direction::Forward {
            self.forward(event, cell.now_s() - self.now_s);
        }
        self.now_s = cell.now_s();
        self.joints = cell.joints();
        self.way_m = cell.way_m();
    }

    fn forward(&mut self, event: &Event, took_s: f64) {
        let is_never = matches!(event.instr.info().class, Class::Never(_));
        if is_never && event.open_blocks == 0 {
            self.begin_anew();
            self.awaited.retain(|(_, passage)| !passage.is_passed_with_a_barrier());
            self.never = Some(event.pc);
            return;
        }
        let began = event.steps.saturating_sub(1 + u64::from(event.instr.prefix()));
        self.note_motion(event, began);
        match event.instr {
            Instr::Checkpoint { checkpoint } => {
                self.posts.push((began, Post::Checkpoint(checkpoint)));
            }
            Instr::Return {} => {
                self.end_call(event);
                let mut is_answered = false;
                for (_, passage) in &mut self.awaited {
                    is_answered |= passage.is_answered_with(event.frames);
                }
                if is_answered {
                    self.begin_anew();
                }
            }
            Instr::Call { function, .. } if self.is_transparent(function) => {
                let depth = event.frames.saturating_sub(1);
                let post = Post::Sequence { depth, branches: event.branches.clone() };
                self.posts.push((began, post));
            }
            _ => self.act(event, began, took_s),
        }
    }

    /// Nothing of what was before can be gone back to.
    pub(crate) fn begin_anew(&mut self) {
        self.dropped += self.actions.len() as u64;
        self.actions.clear();
        self.posts.clear();
        self.motions.clear();
    }

    fn note_motion(&mut self, event: &Event, steps: u64) {
        if !event.instr.info().family.commands_workcell() {
            return;
        }
        if event.open_blocks > 0 || !is_motion(event) {
            return self.motions.clear();
        }
        // One that was taken back half way and is done again began where it began first.
        if self.motions.back().is_some_and(|newest| newest.is_at(steps, event.pc)) {
            return;
        }
        if self.motions.len() == MOTIONS_MAX {
            self.motions.pop_front();
        }
        let (began_s, began_way_m, joints) = (self.now_s, self.way_m, self.joints);
        self.motions.push_back(Begun { steps, pc: event.pc, began_s, began_way_m, joints });
    }

    fn is_transparent(&self, function: FunctionId) -> bool {
        let kind = self.module.functions.get(function.index()).map(|function| function.kind);
        kind == Some(FunctionKind::Sequence)
    }

    fn act(&mut self, event: &Event, began: u64, took_s: f64) {
        let is_call = matches!(event.instr, Instr::Call { .. });
        let depth = event.frames - usize::from(is_call);
        let Some(entry) = self.module.source_at(event.pc) else { return };
        let acts = is_call || event.instr.info().family.commands_workcell();
        let is_action = entry.action.is_some_and(|kind| is_call || kind != ActionKind::Call);
        let newest = self.actions.iter_mut().rev().find(|it| it.branches == event.branches);
        if let Some(newest) = newest {
            let is_within = newest.is_call && newest.ended.is_none() && depth > newest.depth;
            let goes_on = !newest.is_call
                && (newest.entry, newest.depth) == (entry.first, depth)
                && newest.last_pc < event.pc;
            if is_within || goes_on {
                newest.last_pc = event.pc;
                return newest.note_act(event, took_s);
            }
        }
        if acts && is_action {
            let mut action = Action {
                steps: began,
                pc: event.pc,
                began_s: self.now_s,
                began_way_m: self.way_m,
                only_moves: true,
                waited_s: 0.0,
                number: self.count(),
                entry: entry.first,
                last_pc: event.pc,
                depth,
                branches: event.branches.clone(),
                ended: None,
                is_call,
                motion: None,
            };
            action.note_act(event, took_s);
            let (entry, depth) = (action.entry, action.depth);
            self.awaited.retain_mut(|(_, passage)| !passage.is_passed_with(entry, depth));
            self.actions.push(action);
        }
    }

    fn end_call(&mut self, event: &Event) {
        let ended = |action: &&mut Action| {
            action.is_call && action.ended.is_none() && action.branches == event.branches
        };
        let newest = self.actions.iter_mut().rev().find(ended);
        if let Some(action) = newest.filter(|action| action.depth == event.frames) {
            action.ended = Some(event.steps);
        }
    }

    /// The run was taken back to where so many instructions lay before it.
    pub fn cut(&mut self, steps: u64) {
        let left = self.actions.partition_point(|action| action.steps < steps);
        if let Some(first) = self.actions.get(left) {
            self.pass_over(self.now_s - first.began_s, self.way_m - first.began_way_m);
        }
        self.actions.truncate(left);
        for action in &mut self.actions {
            action.ended = action.ended.filter(|ended| *ended <= steps);
        }
        self.motions.retain(|motion| motion.steps < steps);
        let left = self.posts.partition_point(|(at, _)| *at < steps);
        self.posts.truncate(left);
    }

    /// So much time and way went into what is taken back, there and back: what led there took none
    /// of it, and will not take it when it is done again.
    fn pass_over(&mut self, time_s: f64, way_m: f64) {
        for action in &mut self.actions {
            action.began_s += time_s;
            action.began_way_m += way_m;
        }
        for motion in &mut self.motions {
            motion.began_s += time_s;
            motion.began_way_m += way_m;
        }
    }

    /// The run was taken back into an act, at this instruction, that so many instructions lie
    /// before: it is to be done anew, as part of what it was part of.
    pub fn cut_into(&mut self, steps: u64, pc: u32) {
        let next = self.actions.iter().find(|action| action.steps >= steps);
        let began_an_action = next.is_some_and(|action| action.steps == steps);
        let begun = self.motions.iter().find(|motion| motion.is_at(steps, pc)).copied();
        self.cut(steps);
        self.motions.extend(begun);
        if let (false, Some(newest)) = (began_an_action, self.actions.last_mut()) {
            newest.last_pc = newest.last_pc.min(pc.saturating_sub(1));
        }
    }
}
