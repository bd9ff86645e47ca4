//! What is to be done about an error that is due: which incident it is of, whether its bounds and
//! what was tried leave anything to do, how far to go back. Nothing moves here.

use crate::asked::{self, reversal};
use crate::depth::{Policy, Question};
use crate::ending::GiveUp;
use crate::incident::Incident;
use crate::place::place;
use crate::recover::{Run, Site};
use crate::recovering::{Intended, Intent};
use crate::strategy::{Bounds, Strategy};
use crate::tell::Why;
use crate::trail::Action;
use obverse_bytecode::{Depth, ErrorDeclaration};
use obverse_isa::ErrorId;
use obverse_workcell::Workcell;

/// How many attempts there may be, at whatever errors, without the run ever getting further.
const STUCK_ATTEMPTS: u32 = 64;

/// What to do about an error that is due.
pub(crate) enum Plan {
    Back { actions: usize, why: Why },
    InPlace { backed_up_m: Option<f64> },
    Restart,
}

impl<'p, C: Workcell> Run<'_, 'p, '_, C> {
    /// The incident of an error that is due: the open one at the same place, one that was got past
    /// in vain, or a new one.
    pub(crate) fn incident(&mut self, error: ErrorId, pc: u32) -> usize {
        let branches = self.driven.machine().state().branches();
        let newest = self.at.trail.newest_of(&branches);
        let number = newest.map_or(self.at.trail.count(), |action| action.number);
        let entry = newest.map_or(pc, |action| action.entry);
        if let Some(index) = self.at.open.iter().position(|open| open.is_again(error, pc, entry)) {
            self.at.open[index].number = number;
            return index;
        }
        let is_again = |passed: &Incident| passed.is_again(error, pc, entry);
        if let Some(index) = self.at.passed.iter().position(is_again) {
            let passed = self.at.passed.remove(index);
            self.at.open.push(Incident { number, branches, outcome: None, ..passed });
            return self.at.open.len() - 1;
        }
        self.at.open.push(Incident {
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
            (self.recovery.foresight.as_mut(), self.at.open.last())
        {
            foresight.on_error(incident, self.driven.cell());
        }
        self.at.open.len() - 1
    }

    pub(crate) fn plan(&mut self, index: usize) -> Result<Plan, GiveUp> {
        asked::check(self.declared(&self.at.open[index]), self.recovery.strategy)?;
        self.check_progress(index)?;
        let incident = &self.at.open[index];
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
            trail: &self.at.trail,
            error: &self.declared(incident).name,
            place: &incident.place,
            tried: &incident.depths(),
            costs_s: &|depth| {
                let takes = self.at.trail.there_and_back(depth, self.driven.cell());
                takes.unwrap_or_default().0
            },
            give_up_s: self.recovery.person_s,
            attempts_left: self.attempts_left(incident),
        };
        let (actions, why) = question.answer(asked, self.recovery.memory)?;
        // What other branches have done since is taken back with it.
        let actions = actions.max(self.at.trail.back_to_newest_of(&incident.branches));
        let before = incident.attempts.last().map_or(0, |attempt| attempt.actions);
        let why = if why == Why::Further && actions <= before { Why::Said } else { why };
        Ok(Plan::Back { actions, why })
    }

    fn foresee(&mut self, index: usize) -> Result<Plan, GiveUp> {
        let incident = &self.at.open[index];
        let site = Site {
            machine: self.driven.machine(),
            cell: self.driven.cell(),
            trail: &self.at.trail,
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
        let trail = &self.at.trail;
        self.at.given_up.retain(|old| trail.is_awaited(old.passage));
        let incident = &self.at.open[index];
        if self.at.given_up.iter().any(|old| incident.is_again(old.error, old.pc, old.entry)) {
            return Err(GiveUp::Before);
        }
        if trail.count() > self.at.furthest {
            self.at.furthest = trail.count();
            self.at.attempts = 0;
        }
        if self.at.attempts >= STUCK_ATTEMPTS {
            return Err(GiveUp::Stuck(self.at.attempts));
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
    pub(crate) fn check_fits(&self, index: usize, plan: &Plan) -> Result<(), GiveUp> {
        let incident = &self.at.open[index];
        let Bounds { time_s, distance_m, .. } = self.bounds(incident);
        let actions = self.at.trail.actions();
        let since = |action: Option<&Action>| {
            action.map(|action| {
                (
                    self.driven.cell().now_s() - action.began_s,
                    self.driven.cell().way_m() - action.began_way_m,
                )
            })
        };
        let takes = match plan {
            Plan::Back { actions, .. } => {
                self.at.trail.there_and_back(*actions, self.driven.cell())
            }
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

    /// What will be done about an error that is due.
    pub(crate) fn intent(&mut self, error: ErrorId, pc: u32) -> Intent {
        let index = self.incident(error, pc);
        let planned =
            self.plan(index).and_then(|plan| self.check_fits(index, &plan).map(|()| plan));
        let what = match planned {
            Ok(plan @ Plan::Back { actions, why }) => {
                let change = self.trial(index, &plan).change;
                let actions_known = self.at.trail.actions();
                let to = actions_known.len().checked_sub(actions);
                match to.and_then(|at| actions_known.get(at)) {
                    Some(to) => Intended::Back { actions, to: to.pc, why, change },
                    None => {
                        let never = self.at.trail.never();
                        Intended::GiveUp(GiveUp::NoWayBack { never })
                    }
                }
            }
            Ok(Plan::InPlace { .. } | Plan::Restart) => Intended::InPlace,
            Err(why) => Intended::GiveUp(why),
        };
        let goes_on = self.recovery.strategy.goes_on_when_given_up();
        Intent { incident: self.at.open[index].clone(), what, goes_on }
    }
}
