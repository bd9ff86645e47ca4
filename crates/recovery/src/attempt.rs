//! One attempt at an error: the run taken back, in the world or in the program alone, and what is
//! done otherwise from there. Whether there is to be one, and which, is decided elsewhere.

use crate::asked::reversal;
use crate::change;
use crate::ending::GiveUp;
use crate::fault;
use crate::incident::Attempt;
use crate::plan::Plan;
use crate::recover::{Run, Watch};
use crate::recovering::{Advance, Leg, Phase, Trial, Way};
use crate::tell::{Step, Why};
use obverse_geometry::{Axis, Frame};
use obverse_isa::{ErrorId, Instr};
use obverse_vm::{Mark, Stop};
use obverse_workcell::{Fault, Goal, Motion, Path, Speed, Workcell};

/// How often a way back that is blocked is tried again.
pub(crate) const BLOCKED_TRIES: u32 = 2;
/// The shortest way that a tool is backed up by, in metres.
const BACK_UP_MIN_M: f64 = 0.005;

impl<C: Workcell> Run<'_, '_, '_, C> {
    /// Begin an attempt. It counts, unless it could not be begun.
    pub(crate) fn begin(&mut self, index: usize, plan: Plan) -> Result<(), GiveUp> {
        let trial = self.trial(index, &plan);
        match plan {
            Plan::Back { actions, why } => self.begin_way(index, actions, why, trial),
            Plan::InPlace { backed_up_m } => {
                let done = self.in_place(index, backed_up_m).map(|()| 0);
                self.finish(index, trial, done)
            }
            Plan::Restart => {
                let done = self.restart(index).map(|()| 0);
                self.finish(index, trial, done)
            }
        }
    }

    /// What an attempt will be.
    pub(crate) fn trial(&self, index: usize, plan: &Plan) -> Trial {
        let incident = &self.at.open[index];
        let planned = if let Plan::Back { actions, .. } = *plan { actions } else { 0 };
        let search = incident.next_search(&self.at.trail, planned);
        let policy = reversal(self.declared(incident)).filter(|_| planned > 0);
        let seed = self.recovery.seed;
        Trial {
            planned,
            began_s: self.driven.cell().now_s(),
            search,
            is_anew: search.is_anew || matches!(plan, Plan::Restart),
            change: policy.and_then(|policy| {
                change::of_incident(policy, incident, &self.at.trail, search, seed)
            }),
        }
    }

    /// An attempt has come to where the run goes forward again, so many actions having been taken
    /// back, or it was in vain.
    fn finish(
        &mut self,
        index: usize,
        trial: Trial,
        done: Result<usize, GiveUp>,
    ) -> Result<(), GiveUp> {
        if let Err(why @ GiveUp::NoWayBack { .. }) = done {
            return Err(why);
        }
        let Trial { planned, began_s, search, is_anew, change } = trial;
        if is_anew {
            self.settle_passed();
        }
        self.at.attempts += 1;
        let actions = done.unwrap_or(planned);
        self.at.open[index].attempts.push(Attempt { actions, began_s, search });
        done?;
        self.driven.alter(change);
        self.say_of(index, |incident| Step::Again { incident, change });
        Ok(())
    }

    /// Begin to take the run back, in the world.
    fn begin_way(
        &mut self,
        index: usize,
        actions: usize,
        why: Why,
        trial: Trial,
    ) -> Result<(), GiveUp> {
        let known = self.at.trail.actions();
        let count = known.len();
        let Some(to) = count.checked_sub(actions).and_then(|at| known.get(at)) else {
            return Err(GiveUp::NoWayBack { never: self.at.trail.never() });
        };
        let (mark, to) = (to.steps, to.pc);
        self.say_of(index, |incident| Step::Back { incident, actions, to, why });
        self.pass_round_trip(index, mark)?;
        self.at.phase = Phase::Way(Way { index, mark, count, tries: 0, leg: Leg::Back, trial });
        Ok(())
    }

    /// Go on with a way back.
    pub(crate) fn go_on_way(&mut self, way: Way) -> Advance {
        match way.leg.clone() {
            Leg::Back => self.go_back(way),
            Leg::Blocked { fault, pc } => self.try_again(way, &fault, pc),
            Leg::Again { actions } => self.do_again(way, actions),
            Leg::Stuck { actions, fault, pc } => self.get_unstuck(way, actions, &fault, pc),
        }
    }

    fn go_back(&mut self, way: Way) -> Advance {
        let mut watch = Watch { trail: &mut self.at.trail, teller: &mut *self.teller };
        match self.driven.reverse_to(Mark::at(way.mark), &mut watch) {
            Stop::Budget => {
                self.at.phase = Phase::Way(way);
                Advance::On
            }
            Stop::AtMark | Stop::OffMark | Stop::AtStart => {
                self.at.trail.cut(self.driven.machine().state().steps());
                self.notice_again(Some(self.at.open[way.index].error));
                let taken = way.count - self.at.trail.actions().len();
                self.come_to_end(way, Ok(taken))
            }
            Stop::Fault { fault, pc, direction } => {
                let index = way.index;
                self.say_of(index, |incident| Step::Blocked { incident, fault: &fault, pc });
                let leg = Leg::Blocked { fault: fault.clone(), pc };
                self.at.phase = Phase::Way(Way { leg, ..way });
                Advance::Stopped(Stop::Fault { fault, pc, direction })
            }
            _ => {
                let never = self.at.trail.never();
                self.come_to_end(way, Err(GiveUp::NoWayBack { never }))
            }
        }
    }

    /// An attempt is over that took the run back, or was to.
    fn come_to_end(&mut self, way: Way, done: Result<usize, GiveUp>) -> Advance {
        let ended = match self.finish(way.index, way.trial, done) {
            Ok(()) => None,
            Err(why) => self.give_up(way.index, why),
        };
        self.goes_on_unless(ended)
    }

    /// A way back that was blocked is tried again, or gone forward from there.
    fn try_again(&mut self, way: Way, fault: &Fault, pc: u32) -> Advance {
        if !self.may_move(fault) {
            return self.come_to_end(way, Err(GiveUp::Blocked));
        }
        let tries = way.tries + 1;
        let leg = if tries > BLOCKED_TRIES {
            Leg::Again { actions: self.cut_into_act(way.index, way.count, pc) }
        } else {
            Leg::Back
        };
        self.at.phase = Phase::Way(Way { leg, tries, ..way });
        Advance::On
    }

    /// The way back is blocked: what was half undone is done again, and the run goes forward from
    /// there.
    fn do_again(&mut self, way: Way, actions: usize) -> Advance {
        let mut watch = Watch { trail: &mut self.at.trail, teller: &mut *self.teller };
        match self.driven.step(&mut watch) {
            Ok(()) | Err(Stop::Raised { .. }) => self.come_to_end(way, Ok(actions)),
            Err(Stop::Fault { fault, pc, direction }) => {
                let error = self.error_of(way.index, &fault);
                self.say(&Step::Fault { fault: &fault, pc, error });
                let leg = Leg::Stuck { actions, fault: fault.clone(), pc };
                self.at.phase = Phase::Way(Way { leg, ..way });
                Advance::Stopped(Stop::Fault { fault, pc, direction })
            }
            Err(_) => self.come_to_end(way, Err(GiveUp::Blocked)),
        }
    }

    /// That was blocked too: the fault is an error of the program, or what was tried to be
    /// recovered from is pending again.
    fn get_unstuck(&mut self, way: Way, actions: usize, fault: &Fault, pc: u32) -> Advance {
        let is_named = fault::error_of(self.module(), fault).is_some();
        let error = self.error_of(way.index, fault);
        let is_raised = self.raise(fault, pc, error);
        let is_done = is_raised && is_named;
        self.come_to_end(way, if is_done { Ok(actions) } else { Err(GiveUp::Blocked) })
    }

    /// The error that a fault is, or that of an incident.
    fn error_of(&self, index: usize, fault: &Fault) -> ErrorId {
        fault::error_of(self.module(), fault).unwrap_or(self.at.open[index].error)
    }

    /// Motions that ended where they began are taken back in the program alone: going there again
    /// and back would press anew on what had stopped them, for nothing.
    fn pass_round_trip(&mut self, index: usize, since: u64) -> Result<(), GiveUp> {
        let Some(motion) = self.at.trail.round_trip(since, &self.driven.cell().joints()) else {
            return Ok(());
        };
        let (steps, pc) = (motion.steps, motion.pc);
        self.say_of(index, |incident| Step::RoundTrip { incident, pc });
        self.unwind(index, steps)
    }

    /// The trail ends before the act whose return is blocked: how many of so many actions have been
    /// taken back.
    fn cut_into_act(&mut self, index: usize, count: usize, pc: u32) -> usize {
        let prefix = self.module().code.get(pc as usize).map_or(0, Instr::prefix);
        let before = self.driven.machine().state().steps().saturating_sub(1 + u64::from(prefix));
        self.at.trail.cut_into(before, pc);
        self.notice_again(Some(self.at.open[index].error));
        count - self.at.trail.actions().len()
    }

    /// Take the program alone back to the start of the action that failed.
    fn in_place(&mut self, index: usize, back_up_m: Option<f64>) -> Result<(), GiveUp> {
        let Some(action) = self.at.trail.newest_of(&self.at.open[index].branches) else {
            return Err(GiveUp::NoWayBack { never: self.at.trail.never() });
        };
        let steps = action.steps;
        let backed_up_m = back_up_m.map(|distance_m| self.back_up(distance_m));
        self.say_of(index, |incident| Step::InPlace { incident, backed_up_m });
        self.unwind(index, steps)
    }

    /// The tool straight back, as far as it goes, and how far that was, in metres.
    fn back_up(&mut self, distance_m: f64) -> f64 {
        let (began_m, tool) = (self.driven.cell().way_m(), self.driven.machine().tool());
        let gone_m = |cell: &C| cell.way_m() - began_m;
        let mut step_m = distance_m;
        while step_m >= BACK_UP_MIN_M && gone_m(self.driven.cell()) + BACK_UP_MIN_M <= distance_m {
            let (from, before_m) = (self.driven.cell().joints(), self.driven.cell().way_m());
            let (axis, frame) = (Axis::MinusZ, Frame::Tcp);
            let goal = Goal::Displaced { from, distance_m: step_m, axis, frame };
            let (path, speed) = (Path::Linear, Speed::Normal);
            let motion = Motion { goal, path, speed, tool, force_limit_n: None };
            if let Err(fault) = self.driven.execute(&motion) {
                let has_moved = self.driven.cell().way_m() > before_m;
                if !self.may_move(&fault) || has_moved {
                    break;
                }
                step_m /= 2.0;
            }
            step_m = step_m.min(distance_m - gone_m(self.driven.cell()));
        }
        gone_m(self.driven.cell())
    }

    fn restart(&mut self, index: usize) -> Result<(), GiveUp> {
        if let Some(never) = self.at.trail.never() {
            return Err(GiveUp::NoWayBack { never: Some(never) });
        }
        self.say_of(index, |incident| Step::InPlace { incident, backed_up_m: None });
        self.unwind(index, 0)
    }

    fn unwind(&mut self, index: usize, steps: u64) -> Result<(), GiveUp> {
        match self.driven.unwind_to(Mark::at(steps)) {
            Ok(()) | Err(Stop::AtStart) => {
                self.at.trail.cut(self.driven.machine().state().steps());
                self.notice_again(Some(self.at.open[index].error));
                Ok(())
            }
            Err(_) => Err(GiveUp::NoWayBack { never: self.at.trail.never() }),
        }
    }
}
