//! One attempt at an error: the run taken back, in the world or in the program alone, and what is
//! done otherwise from there. Whether there is to be one, and which, is decided elsewhere.

use crate::asked::reversal;
use crate::change;
use crate::ending::GiveUp;
use crate::fault;
use crate::incident::Attempt;
use crate::recover::{Plan, Run, Watch};
use crate::tell::{Step, Why};
use obverse_geometry::{Axis, Frame};
use obverse_isa::Instr;
use obverse_vm::{Mark, Stop};
use obverse_workcell::{Goal, Motion, Path, Speed, Workcell};

/// How often a way back that is blocked is tried again.
const BLOCKED_TRIES: u32 = 2;
/// The shortest way that a tool is backed up by, in metres.
const BACK_UP_MIN_M: f64 = 0.005;

impl<C: Workcell> Run<'_, '_, '_, C> {
    /// Make an attempt. It counts, unless it could not be begun.
    pub(crate) fn carry_out(&mut self, index: usize, plan: Plan) -> Result<(), GiveUp> {
        let incident = &self.open[index];
        let began_s = self.driven.cell().now_s();
        let planned = if let Plan::Back { actions, .. } = plan { actions } else { 0 };
        let search = incident.next_search(&self.trail, planned);
        let policy = reversal(self.declared(incident)).filter(|_| planned > 0);
        let is_anew = search.is_anew || matches!(plan, Plan::Restart);
        let seed = self.recovery.seed;
        let change = policy
            .and_then(|policy| change::of_incident(policy, incident, &self.trail, search, seed));
        let done = match plan {
            Plan::Back { actions, why } => self.back(index, actions, why),
            Plan::InPlace { backed_up_m } => self.in_place(index, backed_up_m).map(|()| 0),
            Plan::Restart => self.restart(index).map(|()| 0),
        };
        if let Err(why @ GiveUp::NoWayBack { .. }) = done {
            return Err(why);
        }
        if is_anew {
            self.settle_passed();
        }
        self.attempts += 1;
        let actions = done.unwrap_or(planned);
        self.open[index].attempts.push(Attempt { actions, began_s, search });
        done?;
        self.driven.alter(change);
        self.say_of(index, |incident| Step::Again { incident, change });
        Ok(())
    }

    /// Take the run back, in the world: how many actions it was taken back.
    fn back(&mut self, index: usize, actions: usize, why: Why) -> Result<usize, GiveUp> {
        let known = self.trail.actions();
        let count = known.len();
        let Some(to) = count.checked_sub(actions).and_then(|at| known.get(at)) else {
            return Err(GiveUp::NoWayBack { never: self.trail.never() });
        };
        let (mark, to) = (to.steps, to.pc);
        self.say_of(index, |incident| Step::Back { incident, actions, to, why });
        self.pass_round_trip(index, mark)?;
        let mut tries = 0;
        loop {
            let mut watch = Watch { trail: &mut self.trail, teller: &mut *self.teller };
            match self.driven.reverse_to(Mark::at(mark), &mut watch) {
                Stop::AtMark | Stop::OffMark | Stop::AtStart => {
                    self.trail.cut(self.driven.machine().state().steps());
                    return Ok(count - self.trail.actions().len());
                }
                Stop::Fault { fault, pc, .. } => {
                    self.say_of(index, |incident| Step::Blocked { incident, fault: &fault, pc });
                    if !self.may_move(&fault) {
                        return Err(GiveUp::Blocked);
                    }
                    tries += 1;
                    if tries > BLOCKED_TRIES {
                        let taken = self.cut_into_act(count, pc);
                        return self.forward_from_there(index).map(|()| taken);
                    }
                }
                _ => return Err(GiveUp::NoWayBack { never: self.trail.never() }),
            }
        }
    }

    /// Motions that ended where they began are taken back in the program alone: going there again
    /// and back would press anew on what had stopped them, for nothing.
    fn pass_round_trip(&mut self, index: usize, since: u64) -> Result<(), GiveUp> {
        let Some(motion) = self.trail.round_trip(since, &self.driven.cell().joints()) else {
            return Ok(());
        };
        let (steps, pc) = (motion.steps, motion.pc);
        self.say_of(index, |incident| Step::RoundTrip { incident, pc });
        self.unwind(steps)
    }

    /// The trail ends before the act whose return is blocked: how many of so many actions have been
    /// taken back.
    fn cut_into_act(&mut self, count: usize, pc: u32) -> usize {
        let prefix = self.module().code.get(pc as usize).map_or(0, Instr::prefix);
        let before = self.driven.machine().state().steps().saturating_sub(1 + u64::from(prefix));
        self.trail.cut_into(before, pc);
        count - self.trail.actions().len()
    }

    /// The way back is blocked: what was half undone is done again, and the run goes forward from
    /// there. If that is blocked too, the fault is an error of the program, or what was tried to be
    /// recovered from is pending again.
    fn forward_from_there(&mut self, index: usize) -> Result<(), GiveUp> {
        let mut watch = Watch { trail: &mut self.trail, teller: &mut *self.teller };
        match self.driven.step(&mut watch) {
            Ok(()) | Err(Stop::Raised { .. }) => Ok(()),
            Err(Stop::Fault { fault, pc, .. }) => {
                let named = fault::error_of(self.module(), &fault);
                let error = named.unwrap_or(self.open[index].error);
                let is_raised = self.raise(&fault, pc, error);
                if is_raised && named.is_some() { Ok(()) } else { Err(GiveUp::Blocked) }
            }
            Err(_) => Err(GiveUp::Blocked),
        }
    }

    /// Take the program alone back to the start of the action that failed.
    fn in_place(&mut self, index: usize, back_up_m: Option<f64>) -> Result<(), GiveUp> {
        let Some(action) = self.trail.newest_of(&self.open[index].branches) else {
            return Err(GiveUp::NoWayBack { never: self.trail.never() });
        };
        let steps = action.steps;
        let backed_up_m = back_up_m.map(|distance_m| self.back_up(distance_m));
        self.say_of(index, |incident| Step::InPlace { incident, backed_up_m });
        self.unwind(steps)
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
        if let Some(never) = self.trail.never() {
            return Err(GiveUp::NoWayBack { never: Some(never) });
        }
        self.say_of(index, |incident| Step::InPlace { incident, backed_up_m: None });
        self.unwind(0)
    }

    fn unwind(&mut self, steps: u64) -> Result<(), GiveUp> {
        match self.driven.unwind_to(Mark::at(steps)) {
            Ok(()) | Err(Stop::AtStart) => {
                self.trail.cut(self.driven.machine().state().steps());
                Ok(())
            }
            Err(_) => Err(GiveUp::NoWayBack { never: self.trail.never() }),
        }
    }
}
