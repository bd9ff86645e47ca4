//! How a motion is carried out: along its route to the first thing that ends it.
//!
//! Puts together the route, the search for contact and the clock, and turns what ended the motion
//! into a report or a fault.

use crate::bodies::Mover;
use crate::faults::Interruption;
use crate::mishaps::Travelled;
use crate::robot::LINK_NAMES;
use crate::route::{self, Route};
use crate::sensor::Sensor;
use crate::sim::{Sim, tcp_of};
use crate::sweep::{End, Outcome, Sweep};
use crate::watching::Of;
use crate::world::Owner;
use obverse_geometry::Pose;
use obverse_workcell::{Fault, Motion, MotionEnd, MotionReport};

impl Sim {
    /// Carry out a motion, to be stopped on its way if an interruption is given.
    pub(crate) fn travel(
        &mut self,
        motion: &Motion,
        interruption: Option<Interruption>,
    ) -> Result<MotionReport, Fault> {
        let world = self.world.clone();
        let tool = route::tool(&world.cell, motion.tool)?;
        let route = Route::plan(&world.cell, &self.joints, motion)?;
        let began_m = tcp_of(&self.joints, &tool.tcp).translation_m;
        let profile = route.profile;
        let begin_s = self.now_s;
        let cut_s = self.stopped_at_s(begin_s + profile.duration_s());
        let cut = cut_s.map_or(f64::INFINITY, |cut_s| profile.fraction_at(cut_s - begin_s));
        let until = interruption.map_or(1.0, |interruption| interruption.fraction).min(cut);
        let left = self.items.held().and_then(|item| self.seatings[item].as_ref());
        let mut sweep = Sweep::new(&world, &route, &self.items, tool, left);
        sweep.looks_max = self.looks_max;
        let watched_n = self.watched.stops_above_n();
        let limit_n = least(motion.force_limit_n, watched_n);
        let outcome = sweep.run(until, begin_s, self.force_n, limit_n);
        if let Some(item) = self.items.held() {
            self.seatings[item] = sweep.left(outcome.fraction);
        }
        let is_cut = outcome.end == End::Reached && cut <= until;
        let duration_s = profile.time_at_s(outcome.fraction);
        let end_s = cut_s.filter(|_| is_cut).unwrap_or(begin_s + duration_s);
        let passed = self.pass(end_s, |passed_s| profile.fraction_at(passed_s));
        self.joints = route.joints_at(outcome.fraction);
        self.way_m += (tcp_of(&self.joints, &tool.tcp).translation_m - began_m).norm();
        self.force_n = outcome.force_n;
        let is_watchs = watched_n.is_some() && limit_n != motion.force_limit_n;
        let end = match (passed, outcome.end, watched_n.filter(|_| is_watchs)) {
            (Err(fault), ..) => Err(fault),
            (Ok(()), End::Force, Some(limit_n)) => {
                let fault = self.watched.stopped_above(limit_n, outcome.fraction);
                fault.map_or(Ok(MotionEnd::StoppedByForce), Err)
            }
            _ => self.end(&outcome, interruption, &tool.name),
        };
        let report = end.map(|end| self.report(end, &route, &tool.tcp, &outcome, duration_s));
        let (most_n, pushed) = (sweep.most_n, sweep.pushed);
        self.suffer(&Travelled { route: &route, fraction: outcome.fraction, most_n, pushed, tool });
        self.settle();
        self.last_motion = report?;
        self.watched.read(self.last_motion.peak_force_n, outcome.fraction);
        self.look(Of::All, outcome.fraction)?;
        self.watched.take_noticed()?;
        Ok(self.last_motion)
    }

    /// How the motion ended, which may stop the arm.
    fn end(
        &mut self,
        outcome: &Outcome,
        interruption: Option<Interruption>,
        tool: &str,
    ) -> Result<MotionEnd, Fault> {
        match outcome.end {
            End::Reached => match interruption {
                Some(interruption) => Err(self.interrupt(interruption)),
                None => Ok(MotionEnd::Reached),
            },
            End::Force => Ok(MotionEnd::StoppedByForce),
            End::GivenUp => {
                self.stopped = true;
                Err(Fault::Stopped)
            }
            End::Collision { mover, owner, force_n } => {
                self.stopped = true;
                Err(Fault::Collision {
                    body: self.mover_name(mover, tool),
                    with: self.owner_name(owner),
                    fraction: outcome.fraction,
                    force_n,
                })
            }
        }
    }

    fn report(
        &self,
        end: MotionEnd,
        route: &Route,
        tcp: &Pose,
        outcome: &Outcome,
        duration_s: f64,
    ) -> MotionReport {
        let here_m = tcp_of(&self.joints, tcp).translation_m;
        let origin_m = tcp_of(&route.origin, tcp).translation_m;
        let sensor = Sensor { spec: &self.world.sensor, seed: self.world.seed };
        let settled_n = sensor.settled_n(self.force_n, self.now_s);
        MotionReport {
            end,
            distance_m: (here_m - origin_m).norm(),
            peak_force_n: outcome.peak_n.max(settled_n),
            duration_s,
        }
    }

    fn mover_name(&self, mover: Mover, tool: &str) -> String {
        match mover {
            Mover::Link(index) => LINK_NAMES[index].to_owned(),
            Mover::Tool => tool.to_owned(),
            Mover::Item(index) => self.world.cell.items[index].name.clone(),
        }
    }

    fn owner_name(&self, owner: Owner) -> String {
        match owner {
            Owner::Fixture(index) => self.world.cell.fixtures[index].name.clone(),
            Owner::Item(index) => self.world.cell.items[index].name.clone(),
        }
    }
}

/// The lower of two limits, if there is one.
fn least(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    one.into_iter().chain(other).min_by(f64::total_cmp)
}
