//! Errors in a live run: what is done about them is what the program says, piece by piece, so that
//! a session can be halted anywhere on the way and go on from there.
//!
//! Forward is the way that the run goes: where an error is due, back first, and then forward again.
//! Who goes back by hand puts aside what was tried.

use super::{Declined, Halt, Session, Walk};
use crate::hops::Hops;
use crate::recording::Moment;
use crate::retrace::retraced;
use crate::rewound::Rewound;
use crate::run::Run;
use obverse_recovery::{
    Advance, Bounds, Driven, Ending, Incident, Intent, Memory, PERSON_S, Recovering, Recovery,
    Strategy, Teller, Unattended,
};
use obverse_vm::{Direction, Event, Observer, Stop, Stops};
use obverse_workcell::{Safety, Workcell};

/// What a session does about errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Policy {
    /// What is done when an error is due.
    pub strategy: Strategy,
    /// What may be spent on an error, where the program does not say.
    pub bounds: Bounds,
    /// What it takes a person to put an error right, in seconds: what giving up costs.
    pub person_s: f64,
    /// What perturbations at random follow from.
    pub seed: u64,
}

impl Policy {
    /// What the program says, with this seed.
    #[must_use]
    pub fn declared(seed: u64) -> Self {
        let (strategy, bounds) = (Strategy::Declared, Bounds::default());
        Self { strategy, bounds, person_s: PERSON_S, seed }
    }
}

/// How a run stands with its errors.
#[derive(Clone)]
pub(super) struct Standing<'p> {
    pub(super) at: Recovering<'p>,
    /// The errors that were due, oldest first.
    incidents: Vec<Incident>,
    /// Whether the run was taken back by hand since it last went forward.
    is_taken_back: bool,
    /// How the run ended, where the strategy leaves it to a person: nothing goes on from there but
    /// by hand.
    given_up: Option<Ending>,
}

impl<'p> Standing<'p> {
    /// Of a run at its start.
    pub(super) fn of(run: &Run<'p, impl Workcell>) -> Self {
        let module = run.machine().program().module();
        let at = Recovering::new(module, run.recording().start.joints);
        Self { at, incidents: Vec::new(), is_taken_back: false, given_up: None }
    }
}

/// Tells events on, and notes them on the trail.
struct ByHand<'w, 'p> {
    at: &'w mut Recovering<'p>,
    teller: &'w mut dyn Teller,
}

impl Observer for ByHand<'_, '_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        self.at.on_event(event, cell);
        self.teller.on_event(event, cell);
    }
}

impl<'p, C: Workcell> Session<'p, C> {
    /// Let errors be met so, by what was learned before.
    pub fn recover_by(&mut self, policy: Policy, memory: Memory) {
        self.policy = policy;
        self.noted = memory.clone();
        self.memory = memory;
        self.known_until.clear();
    }

    /// What was learned; of what is tried, nothing is.
    #[must_use]
    pub fn memory(&self) -> &Memory {
        self.left.first().map_or(&self.memory, |left| &left.memory)
    }

    /// What was known at a moment: what the run has learned since is not for what is tried there.
    pub(super) fn known_at(&self, moment: Moment) -> Memory {
        let left = self.left.iter();
        let parted = left.map(|left| left.shown.unwrap_or(left.run.recording().end)).min();
        let moment = parted.map_or(moment, |parted| parted.min(moment));
        let then = self.known_until.iter().find(|(until, _)| *until > moment);
        then.map_or(&self.memory, |(_, known)| known).clone()
    }

    /// The errors that were due in the run and are over, oldest first.
    #[must_use]
    pub fn incidents(&self) -> &[Incident] {
        &self.standing.incidents
    }

    /// Whether an error is due in the live run, or the run is not past one yet.
    #[must_use]
    pub fn is_recovering(&self) -> bool {
        !self.standing.is_taken_back && self.standing.at.is_under_way()
    }

    /// Whether the live run is over; who goes on all the same does so by hand.
    #[must_use]
    pub fn is_over(&self) -> bool {
        !self.standing.is_taken_back && self.standing.at.is_over()
    }

    /// What will be done about the error that is due, if one is in the live run that is shown.
    pub fn intent(&mut self) -> Option<Intent> {
        if self.view.is_some() || !self.is_recovering() {
            return None;
        }
        self.with(None, |at, hops, recovery, _| at.intent(hops, recovery))?
    }

    /// Give the command without which nothing moves after a stop.
    ///
    /// # Errors
    /// If no live run is shown.
    pub fn release(&mut self) -> Result<(), Declined> {
        self.require_live()?;
        self.with(None, |at, hops, recovery, teller| at.released(hops, recovery, teller));
        Ok(())
    }

    /// Go on with what is done about an error until the run is past it, or it is given up, or
    /// something else stops it.
    ///
    /// # Errors
    /// If no live run is shown, or no error is due.
    pub fn recover(&mut self) -> Result<Halt, Declined> {
        self.require_live()?;
        if !self.is_recovering() {
            return Err(Declined::NothingDue);
        }
        Ok(self.go(Direction::Forward, Walk::Recover))
    }

    /// Which way the live run goes next.
    pub(super) fn direction(&self) -> Direction {
        match self.standing.is_taken_back {
            true => Direction::Forward,
            false => self.standing.at.direction(),
        }
    }

    /// Go on with the live run, up to the next place that may matter, for about so many
    /// instructions at the most.
    pub(super) fn advance(&mut self, stops: Option<&Stops>, most: u64) -> Option<Advance> {
        self.settle_hand();
        if let Some(ending) = &self.standing.given_up {
            return Some(Advance::Ended(ending.clone()));
        }
        let advance = self.with(stops, |at, hops, recovery, teller| {
            at.advance(hops, most.max(1), recovery, teller)
        });
        if let Some(Advance::Ended(ending @ Ending::GivenUp { .. })) = &advance {
            self.standing.given_up = Some(ending.clone());
        }
        advance
    }

    /// A step of the live run in reverse, by hand.
    pub(super) fn take_back(&mut self) -> Option<Stop> {
        let before = self.run.recording().end;
        let stop = self.with(None, |at, hops, _, teller| {
            hops.run(Direction::Reverse, 1, &mut ByHand { at, teller })
        });
        self.standing.is_taken_back |= self.run.recording().end > before;
        stop.filter(|stop| *stop != Stop::Budget)
    }

    /// What was going on before the run was taken back by hand is put aside.
    fn settle_hand(&mut self) {
        if std::mem::take(&mut self.standing.is_taken_back) {
            self.standing.given_up = None;
            self.with(None, |at, hops, recovery, teller| at.taken_back(hops, recovery, teller));
        }
    }

    /// Whether nothing may move before a person's command.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.run.cell().is_some_and(Safety::is_stopped)
    }

    /// What is known of the errors of a run that goes on from a moment of this one, otherwise.
    pub(super) fn standing_at(&mut self, at: &Rewound<'p>) -> Standing<'p> {
        if self.view.is_none() {
            self.settle_hand();
            return self.standing.clone();
        }
        let at = retraced(&self.run, at);
        Standing { at, incidents: Vec::new(), is_taken_back: false, given_up: None }
    }

    /// A variable was changed by hand: no way leads back over that.
    pub(super) fn note_assigned(&mut self) {
        self.standing.is_taken_back |= self.standing.at.direction() == Direction::Reverse;
        self.settle_hand();
        self.standing.at.begin_anew();
    }

    /// Work on the live run; none of a recording.
    fn with<T>(
        &mut self,
        stops: Option<&Stops>,
        work: impl FnOnce(
            &mut Recovering<'p>,
            &mut Hops<'_, 'p, C>,
            &mut Recovery<'_, C>,
            &mut dyn Teller,
        ) -> T,
    ) -> Option<T> {
        let Policy { strategy, bounds, person_s, seed } = self.policy;
        let learns = self.left.is_empty();
        let met = self.standing.incidents.len();
        let mut recovery = Recovery {
            strategy,
            bounds,
            memory: &mut self.memory,
            // What is tried is nothing that the robot has met.
            remembers: learns,
            person_s,
            seed,
            operator: &mut Unattended,
            foresight: None,
            incidents: std::mem::take(&mut self.standing.incidents),
        };
        let hops = Hops::of(&mut self.run, stops, &self.interrupt);
        let at = &mut self.standing.at;
        let done = hops.map(|mut hops| work(at, &mut hops, &mut recovery, &mut *self.teller));
        self.standing.incidents = recovery.incidents;
        if learns && self.standing.incidents.len() > met && self.memory != self.noted {
            let known = std::mem::replace(&mut self.noted, self.memory.clone());
            self.known_until.push((self.run.recording().end, known));
        }
        done
    }
}
