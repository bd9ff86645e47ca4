//! The loop of a run that recovers: forward, and back where an error is due, until it ends.

use crate::asked::{self, reversal};
use crate::change;
use crate::depth::{Policy, Question};
use crate::drive;
use crate::driven::{Direct, Driven};
use crate::ending::{Ending, GiveUp};
use crate::fault;
use crate::incident::{Attempt, Incident, Outcome};
use crate::memory::Memory;
use crate::noted;
use crate::passage::Passage;
use crate::place::place;
use crate::strategy::{Bounds, Strategy};
use crate::tell::{Operator, Step, Teller, Why};
use crate::trail::{Action, Trail};
use obverse_bytecode::{
    Continuation, Depth, ErrorDeclaration, Module, Otherwise, Reversal,
};
use obverse_isa::ErrorId;
use obverse_vm::{Alteration, Direction, Event, Limits, Machine, Observer, Stop};
use obverse_workcell::{Fault, Workcell};

/// How many attempts there may be, at whatever errors, without the run ever getting further.
const STUCK_ATTEMPTS: u32 = 64;

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
    recover_in(&mut Direct { machine, cell }, limits, recovery, teller)
}

/// The same, of a machine and a workcell that are driven in a way of their own.
pub fn recover_in<C: Workcell>(
    driven: &mut dyn Driven<'_, C>,
    limits: Limits,
    recovery: &mut Recovery<'_, C>,
    teller: &mut dyn Teller,
) -> Ending {
    let trail = Trail::new(driven.machine().program().module(), driven.cell().joints());
    let begin = driven.machine().executed();
    let mut run = Run {
        driven,
        recovery,
        teller,
        trail,
        open: Vec::new(),
        passed: Vec::new(),
        given_up: Vec::new(),
        furthest: 0,
        attempts: 0,
        is_stopping: false,
        left: None,
        amiss: None,
    };
    let ending = run.until_ended(begin.saturating_add(limits.instructions));
    run.close_all(&ending);
    ending
}

/// A run under way.
pub(crate) struct Run<'r, 'p, 'o, C> {
    pub(crate) driven: &'r mut dyn Driven<'p, C>,
    pub(crate) recovery: &'r mut Recovery<'o, C>,
    pub(crate) teller: &'r mut dyn Teller,
    pub(crate) trail: Trail<'p>,
    /// The incidents that are open, innermost last.
    pub(crate) open: Vec<Incident>,
    /// Incidents that the run got past on its way forward again for another that is open still. If
    /// that fails and leads back over them, the world being as it was, they were not got past.
    passed: Vec<Incident>,
    /// Errors that were given up where the run goes on without going back.
    given_up: Vec<GivenUp>,
    /// The most actions that the run has ever begun.
    furthest: u64,
    /// How many attempts there have been since it was last that far.
    pub(crate) attempts: u32,
    /// Whether the program has come to its end with errors pending.
    is_stopping: bool,
    /// How the run ended, where all was left for the cleanup.
    left: Option<Ending>,
    /// What was passed over in the cleanup first.
    amiss: Option<Ending>,
}

/// An error that was given up where it was due. There is no going back for it until it is past,
/// wherever the program goes on.
struct GivenUp {
    error: ErrorId,
    pc: u32,
    entry: u32,
    /// What the trail knows by that the run has not got past it.
    passage: u64,
}

/// Tells events on, and notes them on the trail.
pub(crate) struct Watch<'w, 'm> {
    pub(crate) trail: &'w mut Trail<'m>,
    pub(crate) teller: &'w mut dyn Teller,
}

impl Observer for Watch<'_, '_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        self.trail.note(event, cell);
        self.teller.on_event(event, cell);
    }
}

/// What to do about an error that is due.
pub(crate) enum Plan {
    Back { actions: usize, why: Why },
    InPlace { backed_up_m: Option<f64> },
    Restart,
}

impl<'p, C: Workcell> Run<'_, 'p, '_, C> {
    pub(crate) fn module(&self) -> &'p Module {
        self.driven.machine().program().module()
    }

    fn until_ended(&mut self, allowed: u64) -> Ending {
        loop {
            let left = allowed.saturating_sub(self.driven.machine().executed());
            let stop = if left == 0 { Stop::Budget } else { self.forward(left) };
            self.close_passed();
            let ended = match stop {
                Stop::Due { error, pc } => self.due(error, pc),
                Stop::Fault { fault, pc, direction: Direction::Forward } => self.fault(fault, pc),
                stop => drive::ending(stop, self.driven.machine()),
            };
            if let Some(ending) = ended.and_then(|ending| self.clean_up(ending)) {
                return ending;
            }
        }
    }

    /// How the run ended, if it has: wherever it was, what is left of it is the cleanup. It is left
    /// out where a stop holds the arm, and where the run was cut off.
    fn clean_up(&mut self, ending: Ending) -> Option<Ending> {
        match ending {
            Ending::Budget => return Some(ending),
            Ending::Finished => {
                return Some(self.left.take().or(self.amiss.take()).unwrap_or(ending));
            }
            Ending::Unhandled(_) => return Some(self.left.take().unwrap_or(ending)),
            _ => {}
        }
        if self.driven.cell().is_stopped() || !self.driven.leave() {
            return Some(self.left.take().unwrap_or(ending));
        }
        self.driven.alter(None);
        self.close_all(&ending);
        self.trail.begin_anew();
        self.left = Some(ending);
        None
    }

    /// Forward until something stops it. While an error is open the machine goes step by step, so
    /// that it does as the program says again as soon as it is past.
    fn forward(&mut self, left: u64) -> Stop {
        let was_cleaning_up = self.driven.machine().is_cleaning_up();
        let mut watch = Watch { trail: &mut self.trail, teller: &mut *self.teller };
        let Some(incident) = self.open.last() else {
            return self.driven.run(Direction::Forward, left, &mut watch);
        };
        let allowed = self.driven.machine().executed().saturating_add(left);
        while !incident.is_past(watch.trail)
            && self.driven.machine().is_cleaning_up() == was_cleaning_up
        {
            if self.driven.machine().executed() >= allowed {
                return Stop::Budget;
            }
            match self.driven.step(&mut watch) {
                Ok(()) | Err(Stop::Raised { .. }) => {}
                Err(stop) => return stop,
            }
            let state = self.driven.machine().state();
            self.is_stopping |= state.frames().len() == 1 && !state.raised().is_empty();
        }
        Stop::Raised { error: incident.error, pc: incident.pc }
    }

    /// A fault that the program names becomes an error of it.
    fn fault(&mut self, fault: Fault, pc: u32) -> Option<Ending> {
        let direction = Direction::Forward;
        let is_passed = if self.driven.machine().is_cleaning_up() {
            self.pass_over(&fault, pc)
        } else {
            let error = fault::error_of(self.module(), &fault);
            error.is_some_and(|error| self.raise(&fault, pc, error))
        };
        if is_passed { None } else { Some(Ending::Fault { fault, pc, direction }) }
    }

    /// Let a fault be an error of the program. Whether it could be.
    pub(crate) fn raise(&mut self, fault: &Fault, pc: u32, error: ErrorId) -> bool {
        self.say(&Step::Fault { fault, pc, error });
        self.may_move(fault) && fault::raise(self.driven, error, pc, &mut self.trail)
    }

    /// The cleanup goes on behind what a fault has stopped in it. Whether it can.
    fn pass_over(&mut self, fault: &Fault, pc: u32) -> bool {
        self.say(&Step::PassedOver { fault, pc });
        let is_passed = self.may_move(fault) && self.driven.pass_over_fault();
        let (fault, direction) = (fault.clone(), Direction::Forward);
        self.amiss.get_or_insert(Ending::Fault { fault, pc, direction });
        is_passed
    }

    /// Tell a step, and note it on the tape.
    pub(crate) fn say(&mut self, step: &Step<'_>) {
        noted::say(self.driven, self.teller, step);
    }

    /// Tell a step about the incident of a number, and note it on the tape.
    pub(crate) fn say_of<'s>(
        &'s mut self,
        index: usize,
        step: impl FnOnce(&'s Incident) -> Step<'s>,
    ) {
        let step = step(&self.open[index]);
        noted::say(self.driven, self.teller, &step);
    }

    /// Whether the arm may move; after a stop, only by a fresh command.
    pub(crate) fn may_move(&mut self, fault: &Fault) -> bool {
        if !self.driven.cell().is_stopped() {
            return true;
        }
        let is_released = self.recovery.operator.release(fault);
        if is_released {
            self.driven.release();
            self.say(&Step::Released);
        }
        is_released
    }

    /// An error is due: go back for it, or give it up.
    fn due(&mut self, error: ErrorId, pc: u32) -> Option<Ending> {
        let index = self.incident(error, pc);
        let planned =
            self.plan(index).and_then(|plan| self.check_fits(index, &plan).map(|()| plan));
        let done = planned.and_then(|plan| self.carry_out(index, plan));
        match done {
            Ok(()) => None,
            Err(why) => self.give_up(index, why),
        }
    }

    /// The incident of an error that is due: the open one at the same place, one that was got past
    /// in vain, or a new one.
    fn incident(&mut self, error: ErrorId, pc: u32) -> usize {
        let branches = self.driven.machine().state().branches();
        let newest = self.trail.newest_of(&branches);
        let number = newest.map_or(self.trail.count(), |action| action.number);
        let entry = newest.map_or(pc, |action| action.entry);
        if let Some(index) = self.open.iter().position(|open| open.is_again(error, pc, entry)) {
            self.open[index].number = number;
            return index;
        }
        let is_again = |passed: &Incident| passed.is_again(error, pc, entry);
        if let Some(index) = self.passed.iter().position(is_again) {
            let passed = self.passed.remove(index);
            self.open.push(Incident { number, branches, outcome: None, ..passed });
            return self.open.len() - 1;
        }
        self.open.push(Incident {
            error,
            pc,
            entry,
            branches,
            is_in_cleanup: self.driven.machine().is_cleaning_up(),
            place: place(self.module(), newest.map_or(pc, |action| action.pc)),
            number,
            began_s: self.driven.cell().now_s(),
            began_way_m: self.driven.cell().way_m(),
            attempts: Vec::new(),
            outcome: None,
        });
        if let (Some(foresight), Some(incident)) =
            (self.recovery.foresight.as_mut(), self.open.last())
        {
            foresight.on_error(incident, self.driven.cell());
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
            costs_s: &|depth| {
                let takes = self.trail.there_and_back(depth, self.driven.cell());
                takes.unwrap_or_default().0
            },
            give_up_s: self.recovery.person_s,
            attempts_left: self.attempts_left(incident),
        };
        let (actions, why) = question.answer(asked, self.recovery.memory)?;
        // What other branches have done since is taken back with it.
        let actions = actions.max(self.trail.back_to_newest_of(&incident.branches));
        let before = incident.attempts.last().map_or(0, |attempt| attempt.actions);
        let why = if why == Why::Further && actions <= before { Why::Said } else { why };
        Ok(Plan::Back { actions, why })
    }

    fn foresee(&mut self, index: usize) -> Result<Plan, GiveUp> {
        let incident = &self.open[index];
        let site = Site {
            machine: self.driven.machine(),
            cell: self.driven.cell(),
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
        self.given_up.retain(|old| trail.is_awaited(old.passage));
        let incident = &self.open[index];
        if self.given_up.iter().any(|old| incident.is_again(old.error, old.pc, old.entry)) {
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
        } else if self.driven.cell().now_s() - incident.began_s >= time_s {
            Err(GiveUp::Time(time_s))
        } else if self.driven.cell().way_m() - incident.began_way_m >= distance_m {
            Err(GiveUp::Distance(distance_m))
        } else {
            Ok(())
        }
    }

    /// An attempt that would go beyond a bound, by what it took so far, is not begun.
    fn check_fits(&self, index: usize, plan: &Plan) -> Result<(), GiveUp> {
        let incident = &self.open[index];
        let Bounds { time_s, distance_m, .. } = self.bounds(incident);
        let actions = self.trail.actions();
        let since = |action: Option<&Action>| {
            action.map(|action| {
                (
                    self.driven.cell().now_s() - action.began_s,
                    self.driven.cell().way_m() - action.began_way_m,
                )
            })
        };
        let takes = match plan {
            Plan::Back { actions, .. } => self.trail.there_and_back(*actions, self.driven.cell()),
            Plan::InPlace { .. } => since(actions.last()),
            Plan::Restart => since(actions.first()),
        };
        let (takes_s, way_m) = takes.unwrap_or_default();
        if self.driven.cell().now_s() - incident.began_s + takes_s > time_s {
            Err(GiveUp::Time(time_s))
        } else if self.driven.cell().way_m() - incident.began_way_m + way_m > distance_m {
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

    pub(crate) fn declared(&self, incident: &Incident) -> &'p ErrorDeclaration {
        &self.module().errors[incident.error.index()]
    }

    fn give_up(&mut self, index: usize, why: GiveUp) -> Option<Ending> {
        self.driven.alter(None);
        let incident = self.open.remove(index);
        let Incident { error, pc, .. } = incident;
        self.await_passage(&incident);
        // Where the program asks for nothing, there is nothing to tell.
        let is_asked = why != GiveUp::NoRecovery;
        let follows = self.recovery.strategy.goes_on_when_given_up() || !is_asked;
        if is_asked {
            self.say(&Step::GivenUp { incident: &incident, why });
        }
        if !follows || self.declared(&incident).otherwise == Otherwise::Operator {
            self.say(&Step::Operator { incident: &incident });
        }
        self.close(incident, Outcome::GivenUp(why));
        // Where it is due, the code behind it is what follows; elsewhere there is none.
        let is_due = self.driven.machine().state().raised().contains(&error);
        let goes_on = follows && is_due && self.driven.machine().state().pc() == pc + 1;
        if goes_on { None } else { Some(Ending::GivenUp { error, pc, why }) }
    }

    /// There is no going back for an error that was given up until the run is past it. Nor is there
    /// for any other over what the program does about it then, where going back was tried before or
    /// the program begins something anew: that is counted in variables of the program, which going
    /// back would restore.
    fn await_passage(&mut self, incident: &Incident) {
        let declared = self.declared(incident);
        let begins_anew =
            matches!(declared.continuation, Continuation::Sequence | Continuation::Program);
        if begins_anew || reversal(declared).is_some() {
            self.trail.begin_anew();
        }
        let depth = self.driven.machine().state().frames().len();
        let Incident { error, pc, entry, .. } = *incident;
        let passage = self.trail.await_passage(Passage { entry, depth, is_ahead: begins_anew });
        self.given_up.push(GivenUp { error, pc, entry, passage });
    }

    /// The errors that the run has got past are open no more.
    fn close_passed(&mut self) {
        let is_cleaning_up = self.driven.machine().is_cleaning_up();
        while let Some(incident) = self.open.last() {
            let is_over = is_cleaning_up && !incident.is_in_cleanup;
            if !is_over && !incident.is_past(&self.trail) {
                return;
            }
            self.driven.alter(None);
            let is_lost = is_over && self.is_stopping;
            let outcome = if is_lost { Outcome::Lost } else { Outcome::Recovered };
            if let Some(incident) = self.open.pop() {
                self.close(incident, outcome);
            }
        }
    }

    fn close_all(&mut self, ending: &Ending) {
        let is_over = *ending == Ending::Finished;
        while let Some(incident) = self.open.pop() {
            let outcome = if is_over { Outcome::Recovered } else { Outcome::Lost };
            self.close(incident, outcome);
        }
    }

    fn close(&mut self, mut incident: Incident, outcome: Outcome) {
        incident.outcome = Some((outcome, self.driven.cell().now_s()));
        if outcome == Outcome::Recovered {
            self.say(&Step::Recovered { incident: &incident });
        }
        if outcome == Outcome::Recovered && !self.open.is_empty() {
            self.passed.push(incident);
            return;
        }
        if self.open.is_empty() {
            self.settle_passed();
        }
        self.settle(incident);
    }

    /// What was got past will not come again: what was done anew since has changed the world, or
    /// nothing is open that could lead back over it.
    pub(crate) fn settle_passed(&mut self) {
        for incident in std::mem::take(&mut self.passed) {
            self.settle(incident);
        }
    }

    fn settle(&mut self, incident: Incident) {
        let lesson = incident.lesson().filter(|_| self.recovery.remembers);
        if let Some((depths, was_enough)) = lesson {
            let error = &self.declared(&incident).name;
            self.recovery.memory.learn(error, &incident.place, &depths, was_enough);
        }
        self.recovery.incidents.push(incident);
    }
}
