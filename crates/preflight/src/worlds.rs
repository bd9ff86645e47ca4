//! The workcell as it may be at a place of the program, and what would come of a motion there.
//!
//! Workcells that are alike in all that a motion depends on are one, and each is asked about each
//! motion once. Knows nothing of programs.

use crate::command::{Aim, Command, Guard};
use crate::felt::{Felt, as_taken};
use crate::reason::Reason;
use crate::verdict::{Verdict, of_fault};
use obverse_geometry::JointConfiguration;
use obverse_sim::{Cell, Plan, Sim};
use obverse_workcell::{Arm, DigitalIo, Fault, Goal, Gripper, Motion, MotionReport, Path};
use std::collections::HashMap;
use std::rc::Rc;

/// The most motions that are looked at.
const MAX_QUESTIONS: usize = 20_000;
/// The most bodies that are looked at in all motions together, with a hundred for the rest of one.
const MAX_LOOKS: usize = 2_000_000;
/// The most workcells that are kept, times the items in each and a few for the rest.
const MAX_KEPT: usize = 400_000;

/// A workcell, among those of one check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct WorldId(u32);

/// Where the arm stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stand {
    /// Where the plan says.
    Known,
    /// Somewhere on the straight line that a guarded move took from here.
    OnLineFrom(JointConfiguration),
    /// Somewhere on the way of a guarded turn from here.
    OnTurnFrom(JointConfiguration),
    NotKnown,
}

/// A workcell in thought, and what of it is known.
#[derive(Clone, Debug)]
struct World {
    plan: Plan,
    stand: Stand,
    /// Whether it is known what is held, how, and where items lie; if not, the plan has none.
    knows_items: bool,
    /// The level of the output that drives the gripper.
    level: Option<bool>,
}

/// What would come of a motion.
#[derive(Clone, Debug)]
pub(crate) struct Answer {
    pub(crate) verdict: Rc<Verdict>,
    /// How the workcell is left, if all is where it should be; after a fault, as if the motion had
    /// got there, so that what follows can be looked at too.
    pub(crate) after: WorldId,
    /// How it may be left by a motion that waits for contact, if not all is where it should be.
    pub(crate) otherwise: Option<WorldId>,
    pub(crate) report: Option<MotionReport>,
}

/// All workcells of a check.
pub(crate) struct Worlds {
    list: Vec<World>,
    by_numbers: HashMap<Vec<u64>, WorldId>,
    answers: HashMap<(WorldId, Vec<u64>), Answer>,
    felt: Felt,
    gripper_output: Option<u16>,
    max_worlds: usize,
    max_questions: usize,
    is_given_up: bool,
}

impl Worlds {
    /// The first workcell is the one at the start, the second one of which nothing is known.
    pub(crate) fn new(start: Plan) -> Self {
        let cell = start.workcell().cell();
        let gripper_output = cell.gripper.map(|gripper| gripper.output);
        let max_worlds = (MAX_KEPT / (cell.items.len() + 8)).max(16);
        let fixtures = cell.fixtures.iter().map(|fixture| fixture.parts.len());
        let bodies: usize = fixtures.chain(cell.items.iter().map(|item| item.parts.len())).sum();
        let max_questions = (MAX_LOOKS / (bodies + 100)).clamp(16, MAX_QUESTIONS);
        let nothing = World {
            plan: start.without_items(),
            stand: Stand::NotKnown,
            knows_items: false,
            level: None,
        };
        let level = gripper_output.is_some_and(|bit| start.workcell().output(bit));
        let start =
            World { plan: start, stand: Stand::Known, knows_items: true, level: Some(level) };
        let mut worlds = Self {
            list: Vec::new(),
            by_numbers: HashMap::new(),
            answers: HashMap::new(),
            felt: Felt::default(),
            gripper_output,
            max_worlds,
            max_questions,
            is_given_up: false,
        };
        worlds.keep(start);
        worlds.keep(nothing);
        worlds
    }

    pub(crate) fn start(&self) -> WorldId {
        WorldId(0)
    }

    pub(crate) fn nothing_known(&self) -> WorldId {
        WorldId(1)
    }

    /// Whether there were more questions than are answered.
    pub(crate) fn is_given_up(&self) -> bool {
        self.is_given_up
    }

    /// The workcell at the start.
    pub(crate) fn workcell(&self) -> &Sim {
        self.of(self.start()).plan.workcell()
    }

    /// The cell, without chance.
    pub(crate) fn cell(&self) -> &Cell {
        self.workcell().cell()
    }

    fn of(&self, id: WorldId) -> &World {
        &self.list[id.0 as usize]
    }

    fn keep(&mut self, world: World) -> WorldId {
        let numbers = world.numbers();
        if let Some(&known) = self.by_numbers.get(&numbers) {
            return known;
        }
        if self.list.len() >= self.max_worlds {
            self.is_given_up = true;
            return self.nothing_known();
        }
        let id = WorldId(self.list.len() as u32);
        self.by_numbers.insert(numbers, id);
        self.list.push(world);
        id
    }

    /// Where the arm stands, if that is known.
    pub(crate) fn joints(&self, id: WorldId) -> Option<JointConfiguration> {
        let world = self.of(id);
        (world.stand == Stand::Known).then(|| world.plan.workcell().joints())
    }

    /// Whether nothing of it is left open, so that two of them are the same.
    pub(crate) fn is_known(&self, id: WorldId) -> bool {
        let world = self.of(id);
        world.stand == Stand::Known && world.knows_items && world.level.is_some()
    }

    /// The level of the gripper's output, if there is a gripper and it is known.
    pub(crate) fn level(&self, id: WorldId) -> Option<bool> {
        self.of(id).level
    }

    /// Whether an output drives the gripper: no other one changes what a motion meets.
    pub(crate) fn drives_gripper(&self, bit: u16) -> bool {
        self.gripper_output == Some(bit)
    }

    /// Whether the gripper holds something.
    pub(crate) fn is_holding(&self, id: WorldId) -> Option<bool> {
        let world = self.of(id);
        world.knows_items.then(|| world.plan.workcell().held().is_some())
    }

    /// The same with the gripper's output at a level.
    pub(crate) fn with_level(&mut self, id: WorldId, level: Option<bool>) -> WorldId {
        let world = self.of(id);
        if world.level == level && level.is_some() {
            return id;
        }
        let (Some(bit), Some(wanted)) = (self.gripper_output, level) else {
            return self.without_items(id, level);
        };
        // A gripper that is open and holds nothing lets nothing go.
        let stays = self.is_holding(id) == Some(false) && !self.closes(wanted);
        if !(stays || world.stand == Stand::Known && world.knows_items && world.level.is_some()) {
            return self.without_items(id, level);
        }
        match world.plan.with_output(bit, wanted) {
            Ok(plan) => {
                let set = World { plan, level, ..world.clone() };
                self.keep(set)
            }
            Err(_) => self.without_items(id, level),
        }
    }

    fn closes(&self, level: bool) -> bool {
        let gripper = self.cell().gripper;
        gripper.is_some_and(|gripper| gripper.closed_level == level)
    }

    /// The same, but what is held and where items lie is not known.
    pub(crate) fn forget_items(&mut self, id: WorldId) -> WorldId {
        self.without_items(id, self.of(id).level)
    }

    fn without_items(&mut self, id: WorldId, level: Option<bool>) -> WorldId {
        let world = self.of(id);
        let plan = world.plan.without_items();
        let forgotten = World { plan, knows_items: false, level, ..world.clone() };
        self.keep(forgotten)
    }

    /// What would come of a motion.
    pub(crate) fn ask(&mut self, id: WorldId, command: &Command) -> Answer {
        let key = (id, command.numbers());
        if let Some(answer) = self.answers.get(&key) {
            return answer.clone();
        }
        if self.answers.len() >= self.max_questions {
            self.is_given_up = true;
            return self.unclear(Reason::TooMany, self.nothing_known());
        }
        let answer = self.answer(id, command);
        self.answers.insert(key, answer.clone());
        answer
    }

    fn answer(&mut self, id: WorldId, command: &Command) -> Answer {
        let world = self.of(id).clone();
        let Some(motion) = command.motion(world.plan.workcell().joints()) else {
            let reason = match command.aim {
                Aim::NotKnown => Reason::GoalNotKnown,
                _ => Reason::SettingNotKnown,
            };
            let after = self.lost(&world);
            return self.unclear(reason, after);
        };
        match world.stand {
            Stand::Known => self.answer_known(&world, &motion, command.guard),
            Stand::OnLineFrom(start) | Stand::OnTurnFrom(start)
                if leads_back(command, world.stand) =>
            {
                // A part of a way that was looked at already, the other way round.
                let after = self.placed(&world, start);
                self.said(Verdict::new(Reason::Fine), after)
            }
            Stand::OnLineFrom(_) | Stand::OnTurnFrom(_) | Stand::NotKnown => {
                self.answer_from_anywhere(&world, command, &motion)
            }
        }
    }

    fn answer_known(&mut self, world: &World, motion: &Motion, guard: Guard) -> Answer {
        let may_end_before = matches!(guard, Guard::Ends(_));
        let start = world.plan.workcell().joints();
        let stand = match motion.goal {
            Goal::Turned { .. } => Stand::OnTurnFrom(start),
            _ => Stand::OnLineFrom(start),
        };
        let otherwise = may_end_before.then(|| self.keep(World { stand, ..world.clone() }));
        let Some((outcome, plan)) = world.plan.after(motion) else {
            let after = match world.plan.end_of(motion) {
                Ok(end) if guard == Guard::None => self.placed(world, end),
                _ => self.lost(world),
            };
            return self.unclear(Reason::LongContact, after);
        };
        let is_open = self.felt.decides(&world.plan, motion, guard, (&outcome, &plan));
        match outcome.and_then(|report| as_taken(report, guard)) {
            Ok(report) => {
                let after = self.keep(World { plan, ..world.clone() });
                let reason = match (world.knows_items, is_open) {
                    (false, _) => Reason::HeldNotKnown,
                    (true, true) => Reason::StopNotKnown,
                    (true, false) => Reason::Fine,
                };
                let verdict = Rc::new(Verdict::new(reason));
                Answer { verdict, after, otherwise, report: Some(report) }
            }
            Err(fault) => {
                // What follows is looked at from where the motion should have led, if one can get
                // there at all.
                let by_joints = Motion { path: Path::Joint, ..*motion };
                let end = world.plan.end_of(motion).or_else(|_| world.plan.end_of(&by_joints));
                let after = match (otherwise, end) {
                    (Some(otherwise), _) => otherwise,
                    (None, Ok(end)) => self.placed(world, end),
                    (None, Err(_)) => self.lost(world),
                };
                match is_open {
                    true => self.unclear(Reason::StopNotKnown, after),
                    false => self.said(of_fault(&fault, &world.plan, motion), after),
                }
            }
        }
    }

    /// Of a motion that begins nobody knows where, only its goal can be looked at.
    fn answer_from_anywhere(
        &mut self,
        world: &World,
        command: &Command,
        motion: &Motion,
    ) -> Answer {
        let by_joints = Motion { path: Path::Joint, ..*motion };
        let goal: Result<JointConfiguration, Fault> = match command.aim {
            Aim::Joints(_) | Aim::Pose(_) => world.plan.end_of(&by_joints),
            Aim::Displaced { .. } | Aim::Offset { .. } | Aim::Turned { .. } | Aim::NotKnown => {
                let after = self.lost(world);
                return self.unclear(Reason::StartNotKnown, after);
            }
        };
        match goal {
            Ok(end) => {
                let is_sure = matches!(command.aim, Aim::Joints(_));
                let after = if is_sure { self.placed(world, end) } else { self.lost(world) };
                self.unclear(Reason::StartNotKnown, after)
            }
            Err(fault) => {
                let after = self.lost(world);
                // On the way from where it is, a run may meet another fault before.
                let verdict = of_fault(&fault, &world.plan, &by_joints);
                self.said(Verdict { fault: None, ..verdict }, after)
            }
        }
    }

    fn placed(&mut self, world: &World, joints: JointConfiguration) -> WorldId {
        let plan = world.plan.placed_at(joints);
        self.keep(World { plan, stand: Stand::Known, ..world.clone() })
    }

    fn lost(&mut self, world: &World) -> WorldId {
        self.keep(World { stand: Stand::NotKnown, ..world.clone() })
    }

    fn unclear(&self, reason: Reason, after: WorldId) -> Answer {
        self.said(Verdict::new(reason), after)
    }

    fn said(&self, verdict: Verdict, after: WorldId) -> Answer {
        Answer { verdict: Rc::new(verdict), after, otherwise: None, report: None }
    }
}

/// Whether a motion goes back by the way of a guarded one to where that began.
fn leads_back(command: &Command, stand: Stand) -> bool {
    let is_turn = matches!(command.aim, Aim::Turned { .. });
    let is_there = match stand {
        Stand::OnLineFrom(start) => !is_turn && command.aim.leads_back_to(&start),
        Stand::OnTurnFrom(start) => is_turn && command.aim.leads_back_to(&start),
        Stand::Known | Stand::NotKnown => false,
    };
    is_there && command.path == Some(Path::Linear) && command.guard == Guard::None
}

impl World {
    /// All that a motion depends on: two workcells with the same numbers are the same.
    fn numbers(&self) -> Vec<u64> {
        let mut numbers = Vec::with_capacity(64);
        match &self.stand {
            Stand::Known => {
                numbers.push(0);
                numbers.extend(self.plan.workcell().joints().bits());
                // A force that is there already is not read as one that comes.
                numbers.push(self.plan.contact_n().to_bits());
            }
            Stand::OnLineFrom(start) => {
                numbers.push(1);
                numbers.extend(start.bits());
            }
            Stand::OnTurnFrom(start) => {
                numbers.push(3);
                numbers.extend(start.bits());
            }
            Stand::NotKnown => numbers.push(2),
        }
        numbers.push(self.level.map_or(2, u64::from));
        numbers.push(u64::from(self.knows_items));
        if self.knows_items {
            self.plan.items_as_numbers(&mut |number| numbers.push(number));
        }
        numbers
    }
}
