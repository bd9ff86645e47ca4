//! The force-torque sensor: samples with bias and noise, read through a running average.
//!
//! Noise is bounded, and drawn by the number of the sample since the workcell started, so that a
//! reading depends on the time and not on how often it was read. Knows nothing of what presses.

use crate::cell::ForceSensorSpec;
use crate::random::{self, Stream};

/// The sensor of a workcell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sensor<'a> {
    pub(crate) spec: &'a ForceSensorSpec,
    pub(crate) seed: u64,
}

impl Sensor<'_> {
    /// The number of the last sample that was taken at a time.
    pub(crate) fn number_at(&self, now_s: f64) -> u64 {
        // A cast of a float saturates, and times are not negative.
        (now_s / self.spec.sample_s) as u64
    }

    /// When a sample is taken.
    pub(crate) fn time_s(&self, number: u64) -> f64 {
        number as f64 * self.spec.sample_s
    }

    /// The greatest reading that comes from nothing.
    pub(crate) fn idle_max_n(&self) -> f64 {
        self.spec.bias_n.abs() + self.spec.noise_n
    }

    /// The reading at a time when the force has not changed for a whole window.
    pub(crate) fn settled_n(&self, force_n: f64, now_s: f64) -> f64 {
        Average::settled(self, force_n, self.number_at(now_s)).reading_n()
    }

    /// The reading of a force without the noise.
    pub(crate) fn noiseless_n(&self, force_n: f64) -> f64 {
        (force_n + self.spec.bias_n).abs()
    }

    fn sample_n(&self, force_n: f64, number: u64) -> f64 {
        if self.spec.noise_n == 0.0 {
            return force_n + self.spec.bias_n;
        }
        let noise = random::signed(self.seed, Stream::Force, number);
        force_n + self.spec.bias_n + self.spec.noise_n * noise
    }
}

/// The running average over the last samples.
#[derive(Clone, Debug)]
pub(crate) struct Average {
    samples_n: Vec<f64>,
    oldest: usize,
    sum_n: f64,
}

impl Average {
    /// As after a whole window with the same force, up to the sample `number`.
    pub(crate) fn settled(sensor: &Sensor<'_>, force_n: f64, number: u64) -> Self {
        let window = u64::from(sensor.spec.window);
        let first = number.saturating_sub(window - 1);
        let samples_n: Vec<f64> =
            (first..first + window).map(|n| sensor.sample_n(force_n, n)).collect();
        let sum_n = samples_n.iter().sum();
        Self { samples_n, oldest: 0, sum_n }
    }

    /// Take a sample, and read.
    pub(crate) fn take(&mut self, sensor: &Sensor<'_>, force_n: f64, number: u64) -> f64 {
        let oldest = &mut self.samples_n[self.oldest];
        let sample_n = sensor.sample_n(force_n, number);
        self.sum_n += sample_n - *oldest;
        *oldest = sample_n;
        self.oldest += 1;
        if self.oldest == self.samples_n.len() {
            self.oldest = 0;
        }
        self.reading_n()
    }

    fn reading_n(&self) -> f64 {
        (self.sum_n / self.samples_n.len() as f64).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEC: ForceSensorSpec = ForceSensorSpec {
        noise_n: 0.5,
        bias_n: 0.2,
        bias_uniform_n: 0.0,
        bias_normal_n: 0.0,
        window: 4,
        sample_s: 0.01,
    };

    #[test]
    fn a_force_that_sets_in_is_read_a_window_later() {
        let quiet = ForceSensorSpec { noise_n: 0.0, bias_n: 0.0, ..SPEC };
        let sensor = Sensor { spec: &quiet, seed: 1 };
        let mut average = Average::settled(&sensor, 0.0, 10);
        let readings: Vec<f64> = (11..16).map(|n| average.take(&sensor, 8.0, n)).collect();
        assert_eq!(readings, [2.0, 4.0, 6.0, 8.0, 8.0]);
    }

    #[test]
    fn noise_is_bounded_repeatable_and_changes_with_time() {
        let sensor = Sensor { spec: &SPEC, seed: 1 };
        let read = |now_s| sensor.settled_n(0.0, now_s);
        assert_eq!(read(0.5), read(0.5));
        assert_ne!(read(0.5), read(0.6));
        assert!((0..500).all(|step| read(0.1 * f64::from(step)) <= sensor.idle_max_n()));
    }

    #[test]
    fn the_first_readings_need_no_samples_from_before_the_start() {
        let sensor = Sensor { spec: &SPEC, seed: 1 };
        assert!(sensor.settled_n(3.0, 0.0) > 2.0);
    }
}
