//! How a motion is carried out: along its route to the first thing that ends it.
//!
//! Puts together the route, the search for contact and the clock, and turns what ended the motion
//! into a report or a fault.

use crate::bodies::Mover;
use crate::robot::LINK_NAMES;
use crate::route::{self, Route};
use crate::sensor::Sensor;
use crate::sim::{Sim, tcp_of};
use crate::sweep::{End, Outcome, Sweep};
use crate::world::Owner;
use obverse_geometry::Pose;
use obverse_workcell::{Fault, Motion, MotionEnd, MotionReport};

impl Sim {
    /// Carry out a motion, to be stopped at the fraction `interruption` of its way if given.
    pub(crate) fn travel(
        &mut self,
        motion: &Motion,
        interruption: Option<f64>,
    ) -> Result<MotionReport, Fault> {
        let world = self.world.clone();
        let tool = route::tool(&world.cell, motion.tool)?;
        let route = Route::plan(&world.cell, &self.joints, motion)?;
        let until = interruption.unwrap_or(1.0);
        let left = self.items.held().and_then(|item| self.seatings[item].as_ref());
        let mut sweep = Sweep::new(&world, &route, &self.items, tool, left);
        sweep.looks_max = self.looks_max;
        let outcome = sweep.run(until, self.now_s, self.force_n, motion.force_limit_n);
        if let Some(item) = self.items.held() {
            self.seatings[item] = sweep.left(outcome.fraction);
        }
        self.joints = route.joints_at(outcome.fraction);
        let duration_s = route.profile.time_at_s(outcome.fraction);
        self.now_s += duration_s;
        self.force_n = outcome.force_n;
        let end = match outcome.end {
            End::Reached if interruption.is_some() => return Err(self.protective_stop(until)),
            End::Reached => MotionEnd::Reached,
            End::Force => MotionEnd::StoppedByForce,
            End::GivenUp => {
                self.stopped = true;
                return Err(Fault::Stopped);
            }
            End::Collision { mover, owner, force_n } => {
                self.stopped = true;
                return Err(Fault::Collision {
                    body: self.mover_name(mover, &tool.name),
                    with: self.owner_name(owner),
                    fraction: outcome.fraction,
                    force_n,
                });
            }
        };
        self.last_motion = self.report(end, &route, &tool.tcp, &outcome, duration_s);
        Ok(self.last_motion)
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
        let sensor = Sensor { spec: &self.world.cell.force_sensor, seed: self.world.seed };
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
