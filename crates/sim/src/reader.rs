//! The samples of the force sensor along a route, and the guard that listens to them.
//!
//! Knows when samples are due and what the force is between two looks; not where it comes from.

use crate::route::Route;
use crate::sensor::{Average, Sensor};

/// What a contact force may grow by rounding, in newtons.
pub(crate) const ROUNDING_N: f64 = 1e-6;

/// A force at a fraction of a route.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    pub(crate) fraction: f64,
    pub(crate) force_n: f64,
}

/// A sample that is due.
#[derive(Clone, Copy, Debug)]
struct Due {
    number: u64,
    fraction: f64,
}

/// The sensor's samples along a route.
pub(crate) struct Reader<'a> {
    sensor: Sensor<'a>,
    route: &'a Route,
    average: Average,
    limit_n: Option<f64>,
    /// When the motion started.
    start_s: f64,
    /// The next sample; none while nothing touches and nothing needs to be read.
    next: Option<Due>,
    /// The least contact force at any sample so far.
    least_n: f64,
    peak_n: f64,
}

impl<'a> Reader<'a> {
    /// For a motion that starts at a time, with a contact force.
    pub(crate) fn new(
        sensor: Sensor<'a>,
        route: &'a Route,
        limit_n: Option<f64>,
        start_s: f64,
        force_n: f64,
    ) -> Self {
        let average = Average::settled(&sensor, force_n, sensor.number_at(start_s));
        let least_n = force_n;
        Self { sensor, route, average, limit_n, start_s, next: None, least_n, peak_n: 0.0 }
    }

    /// The largest reading so far.
    pub(crate) fn peak_n(&self) -> f64 {
        self.peak_n
    }

    /// Begin to take samples after `fraction`.
    pub(crate) fn start(&mut self, fraction: f64) {
        if self.next.is_none() {
            let now_s = self.start_s + self.route.profile.time_at_s(fraction);
            self.next = Some(self.due(self.sensor.number_at(now_s) + 1));
        }
    }

    /// Nothing touches any more.
    pub(crate) fn rest(&mut self) {
        if let Some(due) = self.next.take() {
            self.average = Average::settled(&self.sensor, 0.0, due.number);
        }
    }

    fn due(&self, number: u64) -> Due {
        let time_s = self.sensor.time_s(number) - self.start_s;
        Due { number, fraction: self.route.profile.fraction_at(time_s) }
    }

    /// Take the samples between two looks; in between the force is taken in proportion. The
    /// fraction at which a reading exceeds the limit, if one does.
    pub(crate) fn pass(&mut self, from: Look, to: Look) -> Option<f64> {
        if self.limit_n.is_none() {
            // Nobody listens: it will do to know the largest force.
            self.peak_n = self.peak_n.max(self.sensor.noiseless_n(to.force_n));
            return None;
        }
        while let Some(due) = self.next
            && due.fraction <= to.fraction
        {
            let way = to.fraction - from.fraction;
            let share = if way > 0.0 { (due.fraction - from.fraction) / way } else { 1.0 };
            let force_n = from.force_n + (to.force_n - from.force_n) * share.clamp(0.0, 1.0);
            if self.sample(force_n) {
                return Some(due.fraction);
            }
            // Past the end of the route no sample is due.
            let mut next = self.due(due.number + 1);
            if due.fraction >= 1.0 {
                next.fraction = f64::INFINITY;
            }
            self.next = Some(next);
        }
        None
    }

    /// Take a sample; whether the reading exceeds the limit by more than a force that the motion
    /// found and is getting away from.
    pub(crate) fn sample(&mut self, force_n: f64) -> bool {
        let number = self.next.map_or(0, |due| due.number);
        let reading_n = self.average.take(&self.sensor, force_n, number);
        self.peak_n = self.peak_n.max(reading_n);
        let found = self.least_n > 0.0 && force_n <= self.least_n + ROUNDING_N;
        self.least_n = self.least_n.min(force_n);
        !found && self.limit_n.is_some_and(|limit_n| reading_n > limit_n)
    }
}
