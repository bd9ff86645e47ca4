//! The loop of a run that recovers: forward, and back where an error is due, until it ends.

use crate::asked::{self, reversal};
use crate::change;
use crate::depth::{Policy, Question};
use crate::drive;
use crate::ending::{Ending, GiveUp};
use crate::fault;
use crate::incident::{Attempt, Incident, Outcome};
use crate::memory::Memory;
use crate::place::place;
use crate::strategy::{Bounds, Strategy};
use crate::tell::{Operator, Step, Teller, Why};
use crate::trail::Trail;
use obverse_bytecode::{Depth, ErrorDeclaration, Module, Reversal};
use obverse_geometry::{Axis, Frame};
use obverse_isa::ErrorId;
use obverse_vm::{Alteration, Direction, Event, Limits, Machine, Mark, Observer, Stop};
use obverse_workcell::{Fault, Goal, Motion, Path, Speed, Workcell};

/// How many attempts there may be, at whatever errors, without the run ever getting further.
const STUCK_ATTEMPTS: u32 = 64;
/// How often a way back that is blocked is tried again.
const BLOCKED_TRIES: u32 = 2;

/// What a run recovers with.
pub struct Recovery<'r, C> {
    /// What is done when an error is due.
    pub strategy: Strategy,
    /// What may be spent on an error, where the program does not say.
    pub bounds: Bounds,
    /// What was learned of how far to go back.
    pub memory: &'r mut Memory,
    /// Whether what this run learns is remembered.
    pub remembers: bool,
    /// What it takes a person to put an error right, in seconds: what giving up costs.
    pub person_s: f64,
    /// What perturbations at random follow from.
    pub seed: u64,
    /// Who gives the fresh command after a stop.
    pub operator: &'r mut dyn Operator,
    /// Who knows what will come of going back, for the strategy that asks.
    pub foresight: Option<&'r mut dyn Foresight<C>>,
    /// The errors that were due, oldest first.
    pub incidents: Vec<Incident>,
}

/// Where a run stands with an error that is due.
pub struct Site<'s, 'p, C> {
    /// The machine.
    pub machine: &'s Machine<'p>,
    /// The workcell.
    pub cell: &'s C,
    /// What can be taken back.
    pub trail: &'s Trail<'p>,
    /// The error and what has been tried.
    pub incident: &'s Incident,
    /// How many attempts are left.
    pub attempts_left: u32,
    policy: Option<&'p Reversal>,
    seed: u64,
}

impl<C> Site<'_, '_, C> {
    /// What will be done otherwise at each attempt that is left, if each goes back so many actions.
    #[must_use]
    pub fn changes(&self, actions: usize) -> Vec<Option<Alteration>> {
        let mut incident = self.incident.clone();
        let attempts = 0..self.attempts_left;
        let one = attempts.map(|_| {
            let search = incident.next_search(self.trail, actions);
            let change = self.policy.and_then(|policy| {
                change::of_incident(policy, &incident, self.trail, search, self.seed)
            });
            incident.attempts.push(Attempt { actions, began_s: self.incident.began_s, search });
            change
        });
        one.collect()
    }
}

/// Who sees the world as it is, and knows what will come of going back.
pub trait Foresight<C> {
    /// How many actions it is best to go back; none if it will not help.
    fn depth(&mut self, site: &Site<'_, '_, C>) -> Option<usize>;

    /// An error is due for the first time, by whatever strategy it will be met.
    fn on_error(&mut self, _: &Incident, _: &C) {}
}

/// Run a program forward until it ends, recovering from its errors.
pub fn recover<C: Workcell>(
    machine: &mut Machine<'_>,
    limits: Limits,
    cell: &mut C,
    recovery: &mut Recovery<'_, C>,
    teller: &mut dyn Teller,
) -> Ending {
    let trail = Trail::new(machine.program().module(), cell.joints());
    let begin = machine.executed();
    let mut run = Run {
        machine,
        cell,
        recovery,
        teller,
        trail,
        open: Vec::new(),
        given_up: Vec::new(),
        furthest: 0,
        attempts: 0,
    };
    let ending = run.until_ended(begin.saturating_add(limits.instructions));
    run.close_all(&ending);
    ending
}

/// A run under way.
struct Run<'r, 'p, 'o, C> {
    machine: &'r mut Machine<'p>,
    cell: &'r mut C,
    recovery: &'r mut Recovery<'o, C>,
    teller: &'r mut dyn Teller,
    trail: Trail<'p>,
    /// The incidents that are open, innermost last.
    open: Vec<Incident>,
    /// Errors that were given up where the run goes on without going back.
    given_up: Vec<GivenUp>,
    /// The most actions that the run has ever begun.
    furthest: u64,
    /// How many attempts there have been since it was last that far.
    attempts: u32,
}

/// An error that was given up at a place. What the program does about it then is counted in its own
/// variables, which going back would restore: so there is no going back for it until it is past.
struct GivenUp {
    error: ErrorId,
    entry: u32,
    number: u64,
    /// How many calls were under way where it was due.
    depth: usize,
}

/// Tells events on, and notes them on the trail.
struct Watch<'w, 'm> {
    trail: &'w mut Trail<'m>,
    teller: &'w mut dyn Teller,
}

impl Observer for Watch<'_, '_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        self.trail.note(event, cell);
        self.teller.on_event(event, cell);
    }
}

/// What to do about an error that is due.
enum Plan {
    Back { actions: usize, why: Why },
    InPlace { backed_up_m: Option<f64> },
    Restart,
}

impl<'p, C: Workcell> Run<'_, 'p, '_, C> {
    fn module(&self) -> &'p Module {
        self.machine.program().module()
    }

    fn until_ended(&mut self, allowed: u64) -> Ending {
        loop {
            let left = allowed.saturating_sub(self.machine.executed());
            let stop = if left == 0 { Stop::Budget } else { self.forward(left) };
            self.close_passed();
            let ended = match stop {
                Stop::Due { error, pc } => self.due(error, pc),
                Stop::Fault { fault, pc, direction: Direction::Forward } => self.fault(fault, pc),
                stop => drive::ending(stop, self.machine),
            };
            if let Some(ending) = ended {
                return ending;
            }
        }
    }

    /// Forward until something stops it. While an error is open the machine goes step by step, so
    /// that it does as the program says again as soon as it is past.
    fn forward(&mut self, left: u64) -> Stop {
        let mut watch = Watch { trail: &mut self.trail, teller: &mut *self.teller };
        let Some(incident) = self.open.last() else {
            let limits = Limits::instructions(left);
            return self.machine.run(Direction::Forward, limits, self.cell, &mut watch);
        };
        let allowed = self.machine.executed().saturating_add(left);
        while watch.trail.count() <= incident.number + 1 {
            if self.machine.executed() >= allowed {
                return Stop::Budget;
            }
            match self.machine.step(Direction::Forward, self.cell, &mut watch) {
                Ok(()) | Err(Stop::Raised { .. }) => {}
                Err(stop) => return stop,
            }
        }
        Stop::Raised { error: incident.error, pc: incident.pc }
    }

    /// A fault that the program names becomes an error of it.
    fn fault(&mut self, fault: Fault, pc: u32) -> Option<Ending> {
        let direction = Direction::Forward;
        let error = fault::error_of(self.module(), &fault);
        let raised = error.filter(|error| {
            let step = Step::Fault { fault: &fault, pc, error: *error };
            self.teller.on_step(&step, self.cell);
            self.may_move(&fault)
                && fault::raise(self.machine, *error, pc, self.cell, &mut self.trail)
        });
        if raised.is_some() { None } else { Some(Ending::Fault { fault, pc, direction }) }
    }

    /// Whether the arm may move; after a stop, only by a fresh command.
    fn may_move(&mut self, fault: &Fault) -> bool {
        if !self.cell.is_stopped() {
            return true;
        }
        let is_released = self.recovery.operator.release(fault);
        if is_released {
            self.cell.release();
            self.teller.on_step(&Step::Released, self.cell);
        }
        is_released
    }

    /// An error is due: go back for it, or give it up.
    fn due(&mut self, error: ErrorId, pc: u32) -> Option<Ending> {
        let index = self.incident(error, pc);
        let planned = self.plan(index);
        let done = planned.and_then(|plan| self.carry_out(index, plan));
        match done {
            Ok(()) => None,
            Err(why) => self.give_up(index, why),
        }
    }

    /// The incident of an error that is due: the open one at the same place, or a new one.
    fn incident(&mut self, error: ErrorId, pc: u32) -> usize {
        let newest = self.trail.actions().last();
        let entry = newest.map_or(pc, |action| action.entry);
        let number = newest.map_or(self.trail.count(), |action| action.number);
        let is_it = |open: &Incident| open.error == error && open.entry == entry;
        if let Some(index) = self.open.iter().position(is_it) {
            self.open[index].number = number;
            return index;
        }
        self.open.push(Incident {
            error,
            pc,
            place: place(self.module(), newest.map_or(pc, |action| action.pc)),
            number,
            entry,
            began_s: self.cell.now_s(),
            began_way_m: self.trail.way_m(),
            attempts: Vec::new(),
            outcome: None,
        });
        if let (Some(foresight), Some(incident)) =
            (self.recovery.foresight.as_mut(), self.open.last())
        {
            foresight.on_error(incident, self.cell);
        }
        self.open.len() - 1
    }

    fn plan(&mut self, index: usize) -> Result<Plan, GiveUp> {
        asked::check(self.declared(&self.open[index]), self.recovery.strategy)?;
        self.check_progress(index)?;
        let incident = &self.open[index];
        self.check_bounds(incident)?;
        let policy = reversal(self.declared(incident));
        let times = incident.attempts.len() as u32;
        let within = |most: u32| if times < most { Ok(()) } else { Err(GiveUp::Attempts(most)) };
        let asked = match self.recovery.strategy {
            Strategy::Stop | Strategy::Explicit => return Err(GiveUp::Strategy),
            Strategy::Retry { times } => {
                within(times)?;
                return Ok(Plan::InPlace { backed_up_m: None });
            }
            Strategy::BackUp { distance_m, times } => {
                within(times)?;
                return Ok(Plan::InPlace { backed_up_m: Some(distance_m) });
            }
            Strategy::Restart { times } => {
                within(times)?;
                return Ok(Plan::Restart);
            }
            Strategy::Oracle => return self.foresee(index),
            Strategy::Declared => Policy::of(policy.ok_or(GiveUp::Strategy)?),
            Strategy::Fixed { actions } => {
                let most = u32::try_from(actions).unwrap_or(u32::MAX);
                Policy { depth: Depth::Fixed, extent: obverse_bytecode::Extent::Actions(most) }
            }
            Strategy::Escalating => Policy::unbounded(Depth::Escalating { doubling: false }),
            Strategy::Learned => Policy::unbounded(Depth::Learned),
        };
        let question = Question {
            trail: &self.trail,
            error: &self.declared(incident).name,
            place: &incident.place,
            tried: &incident.depths(),
            now_s: self.cell.now_s(),
            joints: self.cell.joints(),
            give_up_s: self.recovery.person_s,
            attempts_left: self.attempts_left(incident),
        };
        let (actions, why) = question.answer(asked, self.recovery.memory)?;
        Ok(Plan::Back { actions, why })
    }

    fn foresee(&mut self, index: usize) -> Result<Plan, GiveUp> {
        let incident = &self.open[index];
        let site = Site {
            machine: self.machine,
            cell: &*self.cell,
            trail: &self.trail,
            incident,
            attempts_left: self.attempts_left(incident),
            policy: reversal(self.declared(incident)),
            seed: self.recovery.seed,
        };
        let foresight = self.recovery.foresight.as_mut().ok_or(GiveUp::Strategy)?;
        let actions = foresight.depth(&site).ok_or(GiveUp::WouldNotHelp)?;
        Ok(Plan::Back { actions, why: Why::Foreseen })
    }

    fn check_progress(&mut self, index: usize) -> Result<(), GiveUp> {
        let trail = &self.trail;
        self.given_up.retain(|old| !trail.is_past(old.number, old.entry, old.depth));
        let Incident { error, entry, .. } = self.open[index];
        if self.given_up.iter().any(|old| (old.error, old.entry) == (error, entry)) {
            return Err(GiveUp::Before);
        }
        if trail.count() > self.furthest {
            self.furthest = trail.count();
            self.attempts = 0;
        }
        if self.attempts >= STUCK_ATTEMPTS {
            return Err(GiveUp::Stuck(self.attempts));
        }
        Ok(())
    }

    fn check_bounds(&self, incident: &Incident) -> Result<(), GiveUp> {
        let Bounds { attempts, time_s, distance_m } = self.bounds(incident);
        if incident.attempts.len() as u64 >= u64::from(attempts) {
            Err(GiveUp::Attempts(attempts))
        } else if self.cell.now_s() - incident.began_s >= time_s {
            Err(GiveUp::Time(time_s))
        } else if self.trail.way_m() - incident.began_way_m >= distance_m {
            Err(GiveUp::Distance(distance_m))
        } else {
            Ok(())
        }
    }

    fn attempts_left(&self, incident: &Incident) -> u32 {
        self.bounds(incident).attempts.saturating_sub(incident.attempts.len() as u32)
    }

    /// What may be spent on an incident.
    fn bounds(&self, incident: &Incident) -> Bounds {
        let said = self.declared(incident).bounds;
        let own = self.recovery.bounds;
        Bounds {
            attempts: said.attempts.unwrap_or(own.attempts),
            time_s: said.time_s.unwrap_or(own.time_s),
            distance_m: said.distance_m.unwrap_or(own.distance_m),
        }
    }

    fn declared(&self, incident: &Incident) -> &'p ErrorDeclaration {
        &self.module().errors[incident.error.index()]
    }

    fn carry_out(&mut self, index: usize, plan: Plan) -> Result<(), GiveUp> {
        let incident = &self.open[index];
        let began_s = self.cell.now_s();
        let actions = if let Plan::Back { actions, .. } = plan { actions } else { 0 };
        let search = incident.next_search(&self.trail, actions);
        let policy = reversal(self.declared(incident)).filter(|_| actions > 0);
        let seed = self.recovery.seed;
        let change = policy
            .and_then(|policy| change::of_incident(policy, incident, &self.trail, search, seed));
        match plan {
            Plan::Back { actions, why } => self.back(index, actions, why)?,
            Plan::InPlace { backed_up_m } => self.in_place(index, backed_up_m)?,
            Plan::Restart => self.restart(index)?,
        }
        self.machine.alter(change);
        self.attempts += 1;
        self.open[index].attempts.push(Attempt { actions, began_s, search });
        let step = Step::Again { incident: &self.open[index], change };
        self.teller.on_step(&step, self.cell);
        Ok(())
    }

    /// Take the run back, in the world.
    fn back(&mut self, index: usize, actions: usize, why: Why) -> Result<(), GiveUp> {
        let known = self.trail.actions();
        let Some(to) = known.len().checked_sub(actions).and_then(|at| known.get(at)) else {
            return Err(GiveUp::NoWayBack { never: self.trail.never() });
        };
        let (mark, pc) = (to.steps, to.pc);
        let incident = &self.open[index];
        self.teller.on_step(&Step::Back { incident, actions, to: pc, why }, self.cell);
        self.pass_round_trip(index, mark)?;
        let mut tries = 0;
        loop {
            let mut watch = Watch { trail: &mut self.trail, teller: &mut *self.teller };
            match self.machine.reverse_to(Mark::at(mark), self.cell, &mut watch) {
                Stop::AtMark | Stop::OffMark | Stop::AtStart => {
                    self.trail.cut(self.machine.state().steps());
                    return Ok(());
                }
                Stop::Fault { fault, pc, .. } => {
                    let step = Step::Blocked { incident: &self.open[index], fault: &fault, pc };
                    self.teller.on_step(&step, self.cell);
                    if !self.may_move(&fault) {
                        return Err(GiveUp::Blocked);
                    }
                    tries += 1;
                    if tries > BLOCKED_TRIES {
                        return self.forward_from_there();
                    }
                }
                _ => return Err(GiveUp::NoWayBack { never: self.trail.never() }),
            }
        }
    }

    /// Motions that ended where they began are taken back in the program alone: going there again
    /// and back would press anew on what had stopped them, for nothing.
    fn pass_round_trip(&mut self, index: usize, since: u64) -> Result<(), GiveUp> {
        let Some(motion) = self.trail.round_trip(since, &self.cell.joints()) else {
            return Ok(());
        };
        let (steps, pc) = (motion.steps, motion.pc);
        let step = Step::RoundTrip { incident: &self.open[index], pc };
        self.teller.on_step(&step, self.cell);
        self.unwind(steps)
    }

    /// The way back is blocked: what was half undone is done again, and the run goes forward from
    /// there.
    fn forward_from_there(&mut self) -> Result<(), GiveUp> {
        self.trail.cut(self.machine.state().steps());
        let mut watch = Watch { trail: &mut self.trail, teller: &mut *self.teller };
        match self.machine.step(Direction::Forward, self.cell, &mut watch) {
            Ok(()) | Err(Stop::Raised { .. }) => Ok(()),
            Err(_) => Err(GiveUp::Blocked),
        }
    }

    /// Take the program alone back to the start of the action that failed.
    fn in_place(&mut self, index: usize, backed_up_m: Option<f64>) -> Result<(), GiveUp> {
        let Some(action) = self.trail.actions().last() else {
            return Err(GiveUp::NoWayBack { never: self.trail.never() });
        };
        let steps = action.steps;
        let step = Step::InPlace { incident: &self.open[index], backed_up_m };
        self.teller.on_step(&step, self.cell);
        if let Some(distance_m) = backed_up_m {
            self.back_up(distance_m);
        }
        self.unwind(steps)
    }

    /// The tool straight back, as far as it goes.
    fn back_up(&mut self, distance_m: f64) {
        let from = self.cell.joints();
        let goal = Goal::Displaced { from, distance_m, axis: Axis::MinusZ, frame: Frame::Tcp };
        let tool = self.cell.initial_tool();
        let motion =
            Motion { goal, path: Path::Linear, speed: Speed::Normal, tool, force_limit_n: None };
        // One that cannot be made is left out, as the recoveries do that this stands for.
        if let Err(fault) = self.cell.execute(&motion) {
            self.may_move(&fault);
        }
    }

    fn restart(&mut self, index: usize) -> Result<(), GiveUp> {
        if let Some(never) = self.trail.never() {
            return Err(GiveUp::NoWayBack { never: Some(never) });
        }
        let step = Step::InPlace { incident: &self.open[index], backed_up_m: None };
        self.teller.on_step(&step, self.cell);
        self.unwind(0)
    }

    fn unwind(&mut self, steps: u64) -> Result<(), GiveUp> {
        match self.machine.unwind_to(Mark::at(steps), self.cell) {
            Ok(()) | Err(Stop::AtStart) => {
                self.trail.cut(self.machine.state().steps());
                Ok(())
            }
            Err(_) => Err(GiveUp::NoWayBack { never: self.trail.never() }),
        }
    }

    fn give_up(&mut self, index: usize, why: GiveUp) -> Option<Ending> {
        self.machine.alter(None);
        let incident = self.open.remove(index);
        let Incident { error, pc, entry, number, .. } = incident;
        let depth = self.machine.state().frames().len();
        self.given_up.push(GivenUp { error, entry, number, depth });
        if why != GiveUp::NoRecovery {
            self.teller.on_step(&Step::GivenUp { incident: &incident, why }, self.cell);
        }
        self.close(incident, Outcome::GivenUp(why));
        // What was raised is still due: the code behind it is what follows.
        let is_due = self.machine.state().raised().contains(&error);
        let is_programs =
            self.recovery.strategy.goes_on_when_given_up() || why == GiveUp::NoRecovery;
        let goes_on = is_programs && is_due;
        if goes_on { None } else { Some(Ending::GivenUp { error, pc, why }) }
    }

    /// The errors that the run has got past are open no more.
    fn close_passed(&mut self) {
        while let Some(incident) = self.open.last() {
            if self.trail.count() <= incident.number + 1 {
                return;
            }
            self.machine.alter(None);
            if let Some(incident) = self.open.pop() {
                self.close(incident, Outcome::Recovered);
            }
        }
    }

    fn close_all(&mut self, ending: &Ending) {
        let is_over = *ending == Ending::Finished;
        while let Some(incident) = self.open.pop() {
            let outcome =
                if is_over { Outcome::Recovered } else { Outcome::GivenUp(GiveUp::Strategy) };
            self.close(incident, outcome);
        }
    }

    fn close(&mut self, mut incident: Incident, outcome: Outcome) {
        incident.outcome = Some((outcome, self.cell.now_s()));
        let depths = incident.depths();
        if self.recovery.remembers && !depths.contains(&0) {
            let error = &self.declared(&incident).name;
            let was_enough = outcome == Outcome::Recovered;
            self.recovery.memory.learn(error, &incident.place, &depths, was_enough);
        }
        if outcome == Outcome::Recovered {
            self.teller.on_step(&Step::Recovered { incident: &incident }, self.cell);
        }
        self.recovery.incidents.push(incident);
    }
}
