//! What is watched while the workcell acts: at which instant a condition comes to hold.
//!
//! Time is passed from one instant to the next at which an input that is watched may change, so
//! that nothing is stepped over. While nothing moves no force changes either: it is looked at where
//! an act begins and ends, and along a motion by its guard. Knows nothing of programs.

use crate::cell::InputRule;
use crate::sim::Sim;
use obverse_workcell::{Condition, DigitalIo, Fault, ForceTorque, Watch, Watching};

/// How often an act is looked at, at the most: a wire may flicker for as long as its file says.
const LOOKS_MAX: u32 = 1_000_000;

/// What is watched.
#[derive(Clone, Debug, Default)]
pub(crate) struct Watched {
    watches: Vec<Watch>,
    /// By watch: whether it held when it was looked at last.
    held: Vec<bool>,
    /// Whether acts look at present.
    pub(crate) is_on: bool,
    /// What has come to hold in the act under way and stops nothing, and where.
    noticed: Option<(Watch, f64)>,
}

/// Which conditions are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Of {
    /// All of them.
    All,
    /// Those of inputs: the force is another one by now.
    Inputs,
}

impl Watched {
    /// The least force that stops a motion, of those that did not when it began, in newtons.
    pub(crate) fn stops_above_n(&self) -> Option<f64> {
        let forces = self.watches.iter().zip(&self.held).filter(|_| self.is_on);
        let limits = forces.filter_map(|(watch, held)| match watch.condition {
            Condition::Force { above_n } if watch.stops && !held => Some(above_n),
            _ => None,
        });
        limits.min_by(f64::total_cmp)
    }

    /// A motion was stopped by such a force.
    pub(crate) fn stopped_above(&mut self, limit_n: f64, fraction: f64) -> Option<Fault> {
        let condition = Condition::Force { above_n: limit_n };
        let is_it = |watch: &Watch| watch.stops && watch.condition == condition;
        let index = self.watches.iter().position(is_it)?;
        self.held[index] = true;
        Some(Fault::Watched { watch: self.watches[index], fraction })
    }

    /// A motion read so much force on its way: what that is more than, and stops nothing.
    pub(crate) fn read(&mut self, peak_n: f64, fraction: f64) {
        let is_more = |watch: &Watch| match watch.condition {
            Condition::Force { above_n } => !watch.stops && peak_n > above_n,
            Condition::Input { .. } => false,
        };
        let mut watches = self.watches.iter().zip(&mut self.held);
        let came = watches.find(|(watch, held)| self.is_on && !**held && is_more(watch));
        if let (Some((watch, held)), None) = (came, self.noticed) {
            *held = true;
            self.noticed = Some((*watch, fraction));
        }
    }

    /// What was noticed in the act that ends.
    pub(crate) fn take_noticed(&mut self) -> Result<(), Fault> {
        let noticed = self.noticed.take();
        noticed.map_or(Ok(()), |(watch, fraction)| Err(Fault::Watched { watch, fraction }))
    }
}

impl Watching for Sim {
    fn watch(&mut self, watches: &[Watch]) {
        self.watched.is_on = !watches.is_empty();
        self.watched.noticed = None;
        if self.watched.is_on && self.watched.watches != watches {
            self.watched.watches = watches.to_vec();
            self.watched.held = vec![false; watches.len()];
        }
    }

    fn watch_again(&mut self, number: u16) {
        let watches = self.watched.watches.iter().zip(&mut self.watched.held);
        let own = watches.filter(|(watch, _)| watch.number == number);
        own.for_each(|(_, held)| *held = false);
    }
}

impl Sim {
    /// Look at what is watched, after a fraction of the act.
    ///
    /// # Errors
    /// The first condition that has come to hold and stops the act.
    pub(crate) fn look(&mut self, of: Of, fraction: f64) -> Result<(), Fault> {
        if !self.watched.is_on {
            return Ok(());
        }
        for index in 0..self.watched.watches.len() {
            let watch = self.watched.watches[index];
            let holds = match watch.condition {
                Condition::Input { bit, level } => self.input(bit) == Ok(level),
                Condition::Force { .. } if of == Of::Inputs => continue,
                Condition::Force { above_n } => self.force_n() > above_n,
            };
            let came = holds && !self.watched.held[index];
            if came && watch.stops {
                self.watched.held[index] = true;
                return Err(Fault::Watched { watch, fraction });
            }
            // What cannot be told yet has not been seen: it is told in the next act.
            let is_told = !came || self.watched.noticed.is_none();
            self.watched.held[index] = holds && is_told;
            if came && is_told {
                self.watched.noticed = Some((watch, fraction));
            }
        }
        Ok(())
    }

    /// Let time pass until then, and look at every instant at which an input may change; `fraction`
    /// says how far the act is after so many seconds. What else the time brings is not settled.
    ///
    /// # Errors
    /// What stops the act, at that instant.
    pub(crate) fn pass(&mut self, end_s: f64, fraction: impl Fn(f64) -> f64) -> Result<(), Fault> {
        let begin_s = self.now_s;
        for _ in 0..LOOKS_MAX {
            let next_s = if self.watched.is_on { self.next_change_s() } else { None };
            let Some(next_s) = next_s.filter(|next_s| *next_s <= end_s) else { break };
            self.now_s = next_s;
            self.settle();
            self.look(Of::Inputs, fraction(next_s - begin_s))?;
        }
        self.now_s = end_s;
        Ok(())
    }

    /// When an input stops an act that would last until then, if one does.
    pub(crate) fn stopped_at_s(&self, end_s: f64) -> Option<f64> {
        if !self.watched.is_on {
            return None;
        }
        let mut ahead = self.clone();
        let stopped = ahead.pass(end_s, |_| 0.0).is_err();
        stopped.then_some(ahead.now_s)
    }

    /// The first instant after now at which an input that is watched may change.
    fn next_change_s(&self) -> Option<f64> {
        let changes = self.watched.watches.iter().filter_map(|watch| match watch.condition {
            Condition::Input { bit, .. } => self.next_change_of_s(usize::from(bit)),
            Condition::Force { .. } => None,
        });
        changes.min_by(f64::total_cmp)
    }

    fn next_change_of_s(&self, input: usize) -> Option<f64> {
        let rule = self.world.cell.inputs.get(input)?;
        let now_s = self.now_s;
        let of_rule = match rule {
            InputRule::At(changes) => {
                let after = changes.partition_point(|(at_s, _)| *at_s <= now_s);
                changes.get(after).map(|(at_s, _)| *at_s)
            }
            InputRule::FollowsOutput { output, delay_s } => {
                let output = self.outputs.get(usize::from(*output));
                output.and_then(|output| output.next_seen_s(*delay_s, now_s))
            }
            InputRule::PartThere { feeder } => {
                self.feeders.get(*feeder).and_then(|feeder| feeder.due_after_s(now_s))
            }
            InputRule::Constant(_) | InputRule::Holding => None,
        };
        let of_wire = self.wires.get(input).and_then(|wire| wire.next_flicker_s(now_s));
        of_rule.into_iter().chain(of_wire).min_by(f64::total_cmp)
    }
}
