//! The loop of a run that recovers: forward, and back where an error is due, until it ends.

use crate::asked::reversal;
use crate::change;
use crate::drive;
use crate::driven::{Direct, Driven};
use crate::ending::{Ending, GiveUp};
use crate::fault;
use crate::incident::{Attempt, Incident, Outcome};
use crate::memory::Memory;
use crate::noted;
use crate::passage::Passage;
use crate::recovering::{Advance, GivenUp, Phase, Recovering};
use crate::strategy::{Bounds, Strategy};
use crate::tell::{Operator, Step, Teller};
use crate::trail::Trail;
use obverse_bytecode::{self as bytecode, Continuation, Module, Otherwise, Reversal};
use obverse_isa::ErrorId;
use obverse_vm::{Alteration, Direction, Event, Limits, Machine, Observer, Stop};
use obverse_workcell::{Fault, Workcell};

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
    pub(crate) policy: Option<&'p Reversal>,
    pub(crate) seed: u64,
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
    let module = driven.machine().program().module();
    let mut at = Recovering::new(module, driven.cell().joints());
    let allowed = driven.machine().executed().saturating_add(limits.instructions);
    loop {
        let left = allowed.saturating_sub(driven.machine().executed());
        if let Advance::Ended(ending) = at.advance(driven, left, recovery, teller) {
            return ending;
        }
    }
}

/// A run under way, with all that has to do with it.
pub(crate) struct Run<'r, 'p, 'o, C> {
    pub(crate) driven: &'r mut dyn Driven<'p, C>,
    pub(crate) recovery: &'r mut Recovery<'o, C>,
    pub(crate) teller: &'r mut dyn Teller,
    pub(crate) at: &'r mut Recovering<'p>,
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

impl<'p, C: Workcell> Run<'_, 'p, '_, C> {
    pub(crate) fn module(&self) -> &'p Module {
        self.driven.machine().program().module()
    }

    /// What comes next of the run, for about so many instructions.
    pub(crate) fn advance(&mut self, most: u64) -> Advance {
        match std::mem::replace(&mut self.at.phase, Phase::Forward) {
            Phase::Forward | Phase::Ended => self.go_forward(most),
            Phase::Due { error, pc } => {
                let ended = self.due(error, pc);
                self.goes_on_unless(ended)
            }
            Phase::Faulted { fault, pc } => {
                let ended = self.fault(fault, pc);
                self.goes_on_unless(ended)
            }
            Phase::Leaving(ending) => self.goes_on_unless(Some(ending)),
            Phase::Way(way) => self.go_on_way(way),
        }
    }

    /// It goes on, unless it has ended in something: then what is left of it is the cleanup.
    pub(crate) fn goes_on_unless(&mut self, ended: Option<Ending>) -> Advance {
        let Some(ending) = ended.and_then(|ending| self.clean_up(ending)) else {
            return Advance::On;
        };
        self.close_all(&ending);
        (self.at.phase, self.at.is_raised) = (Phase::Ended, false);
        Advance::Ended(ending)
    }

    fn go_forward(&mut self, most: u64) -> Advance {
        self.close_passed();
        let stop = if most == 0 { Stop::Budget } else { self.forward(most) };
        self.close_passed();
        match stop {
            Stop::Budget if most > 0 => Advance::On,
            Stop::Due { error, pc } => {
                (self.at.phase, self.at.is_raised) = (Phase::Due { error, pc }, false);
                Advance::Stopped(stop)
            }
            Stop::Fault { fault, pc, direction: Direction::Forward } => self.faulted(fault, pc),
            Stop::Trap(trap) if self.can_leave() => {
                self.at.phase = Phase::Leaving(Ending::Trap(trap));
                Advance::Stopped(stop)
            }
            stop => {
                let ended = drive::ending(stop, self.driven.machine());
                self.goes_on_unless(ended)
            }
        }
    }

    /// The workcell did not do as commanded: something follows that, or the run has ended.
    fn faulted(&mut self, fault: Fault, pc: u32) -> Advance {
        let direction = Direction::Forward;
        if self.tell_fault(&fault, pc) || self.can_leave() {
            self.at.phase = Phase::Faulted { fault: fault.clone(), pc };
            return Advance::Stopped(Stop::Fault { fault, pc, direction });
        }
        self.goes_on_unless(Some(Ending::Fault { fault, pc, direction }))
    }

    /// Whether there is a cleanup that can follow.
    fn can_leave(&self) -> bool {
        let (machine, cell) = (self.driven.machine(), self.driven.cell());
        self.module().cleanup.is_some() && !machine.is_cleaning_up() && !cell.is_stopped()
    }

    /// How the run ended, if it has: wherever it was, what is left of it is the cleanup. It is left
    /// out where a stop holds the arm, and where the run was cut off.
    fn clean_up(&mut self, ending: Ending) -> Option<Ending> {
        match ending {
            Ending::Budget => return Some(ending),
            Ending::Finished => {
                return Some(self.at.left.take().or(self.at.amiss.take()).unwrap_or(ending));
            }
            Ending::Unhandled(_) => return Some(self.at.left.take().unwrap_or(ending)),
            _ => {}
        }
        if self.driven.cell().is_stopped() || !self.driven.leave() {
            return Some(self.at.left.take().unwrap_or(ending));
        }
        self.driven.alter(None);
        self.close_all(&ending);
        self.at.trail.begin_anew();
        self.at.left = Some(ending);
        None
    }

    /// Forward until something stops it. While an error is open the machine goes step by step, so
    /// that it does as the program says again as soon as it is past.
    fn forward(&mut self, most: u64) -> Stop {
        let mut watch = Watch { trail: &mut self.at.trail, teller: &mut *self.teller };
        if self.at.open.is_empty() {
            return self.driven.run(Direction::Forward, most, &mut watch);
        }
        match self.driven.step(&mut watch) {
            Ok(()) | Err(Stop::Raised { .. }) => {}
            Err(stop) => return stop,
        }
        let state = self.driven.machine().state();
        self.at.is_stopping |= state.frames().len() == 1 && !state.raised().is_empty();
        Stop::Budget
    }

    /// Say of a fault what comes of it, if it does not end the run. Whether it does not.
    fn tell_fault(&mut self, fault: &Fault, pc: u32) -> bool {
        if self.driven.machine().is_cleaning_up() {
            return true;
        }
        let error = fault::error_of(self.module(), fault);
        error.iter().for_each(|&error| self.say(&Step::Fault { fault, pc, error }));
        error.is_some()
    }

    /// What was told of a fault comes to be: it becomes an error of the program that names it, and
    /// the cleanup goes on behind it. How the run ended, if neither could be.
    fn fault(&mut self, fault: Fault, pc: u32) -> Option<Ending> {
        let direction = Direction::Forward;
        let is_passed = if self.driven.machine().is_cleaning_up() {
            let is_passed = self.may_move(&fault) && self.driven.pass_over_fault();
            if is_passed {
                self.say(&Step::PassedOver { fault: &fault, pc });
            }
            let fault = fault.clone();
            self.at.amiss.get_or_insert(Ending::Fault { fault, pc, direction });
            is_passed
        } else {
            let error = fault::error_of(self.module(), &fault);
            self.at.is_raised = error.is_some_and(|error| self.raise(&fault, pc, error));
            self.at.is_raised
        };
        if is_passed { None } else { Some(Ending::Fault { fault, pc, direction }) }
    }

    /// Let a fault be an error of the program. Whether it could be.
    pub(crate) fn raise(&mut self, fault: &Fault, pc: u32, error: ErrorId) -> bool {
        let is_raised =
            self.may_move(fault) && fault::raise(self.driven, error, pc, &mut self.at.trail);
        if let (true, Fault::Watched { watch, .. }) = (is_raised, fault) {
            self.at.noticed.push((self.driven.machine().state().steps(), watch.number));
        }
        is_raised
    }

    /// The run was taken back, for an error or by hand: what was noticed since, of other errors, is
    /// to be noticed again if it holds still. It happened in the world, which is not taken back.
    pub(crate) fn notice_again(&mut self, own: Option<ErrorId>) {
        let steps = self.driven.machine().state().steps();
        let first = self.at.noticed.partition_point(|(noticed, _)| *noticed <= steps);
        for (_, number) in self.at.noticed.split_off(first) {
            if own != Some(ErrorId(number)) {
                self.driven.watch_again(number);
            }
        }
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
        let step = step(&self.at.open[index]);
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
        let done = planned.and_then(|plan| self.begin(index, plan));
        match done {
            Ok(()) => None,
            Err(why) => self.give_up(index, why),
        }
    }

    pub(crate) fn give_up(&mut self, index: usize, why: GiveUp) -> Option<Ending> {
        self.driven.alter(None);
        let incident = self.at.open.remove(index);
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
        let is_bounded = begins_anew || reversal(declared).is_some();
        if is_bounded {
            self.at.trail.begin_anew();
        }
        let is_answering = is_bounded
            && (matches!(declared.recovery, bytecode::Recovery::Using(_))
                || matches!(declared.otherwise, Otherwise::Using(_)));
        let depth = self.driven.machine().state().frames().len();
        let Incident { error, pc, entry, number, .. } = *incident;
        let passage = self.at.trail.await_passage(Passage {
            entry,
            depth,
            is_ahead: begins_anew,
            is_answering,
        });
        self.at.given_up.push(GivenUp { error, pc, entry, number, passage });
    }

    /// The errors that the run has got past are open no more.
    fn close_passed(&mut self) {
        let is_cleaning_up = self.driven.machine().is_cleaning_up();
        while let Some(incident) = self.at.open.last() {
            let is_over = is_cleaning_up && !incident.is_in_cleanup;
            if !is_over && !incident.is_past(&self.at.trail) {
                return;
            }
            self.driven.alter(None);
            let is_lost = is_over && self.at.is_stopping;
            let outcome = if is_lost { Outcome::Lost } else { Outcome::Recovered };
            if let Some(incident) = self.at.open.pop() {
                self.close(incident, outcome);
            }
        }
    }

    pub(crate) fn close_all(&mut self, ending: &Ending) {
        let is_over = *ending == Ending::Finished;
        while let Some(incident) = self.at.open.pop() {
            let outcome = if is_over { Outcome::Recovered } else { Outcome::Lost };
            self.close(incident, outcome);
        }
    }

    fn close(&mut self, mut incident: Incident, outcome: Outcome) {
        incident.outcome = Some((outcome, self.driven.cell().now_s()));
        if outcome == Outcome::Recovered {
            self.say(&Step::Recovered { incident: &incident });
        }
        if outcome == Outcome::Recovered && !self.at.open.is_empty() {
            self.at.passed.push(incident);
            return;
        }
        if self.at.open.is_empty() {
            self.settle_passed();
        }
        self.settle(incident);
    }

    /// What was got past will not come again: what was done anew since has changed the world, or
    /// nothing is open that could lead back over it.
    pub(crate) fn settle_passed(&mut self) {
        for incident in std::mem::take(&mut self.at.passed) {
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
