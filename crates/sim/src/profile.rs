//! How a motion's way is spread over time: a trapezoid of speed, or a triangle if the way is short.
//!
//! Knows lengths and times, not what moves.

/// Speed over time: up with constant acceleration, constant, down again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    length: f64,
    acceleration: f64,
    /// The greatest speed reached.
    speed: f64,
    /// The time of speeding up, which is also that of slowing down.
    ramp_s: f64,
    duration_s: f64,
}

impl Profile {
    /// For a way of `length` (in metres or radians) under a greatest speed and an acceleration,
    /// both above zero.
    #[must_use]
    pub fn new(length: f64, speed: f64, acceleration: f64) -> Self {
        if length <= 0.0 {
            return Self { length: 0.0, acceleration, speed, ramp_s: 0.0, duration_s: 0.0 };
        }
        let speed = speed.min((length * acceleration).sqrt());
        let ramp_s = speed / acceleration;
        Self { length, acceleration, speed, ramp_s, duration_s: ramp_s + length / speed }
    }

    /// How long the whole way takes, in seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The greatest speed on the way, in its length a second.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// The fraction of the way that is behind at a time.
    #[must_use]
    pub fn fraction_at(&self, time_s: f64) -> f64 {
        if time_s >= self.duration_s {
            return 1.0;
        }
        let time_s = time_s.max(0.0);
        let left_s = self.duration_s - time_s;
        let way = if time_s < self.ramp_s {
            0.5 * self.acceleration * time_s * time_s
        } else if left_s < self.ramp_s {
            self.length - 0.5 * self.acceleration * left_s * left_s
        } else {
            self.speed * (time_s - 0.5 * self.ramp_s)
        };
        (way / self.length).clamp(0.0, 1.0)
    }

    /// The time at which a fraction of the way is behind, in seconds.
    #[must_use]
    pub fn time_at_s(&self, fraction: f64) -> f64 {
        if fraction >= 1.0 || self.length <= 0.0 {
            return self.duration_s;
        }
        let way = fraction.max(0.0) * self.length;
        let left = self.length - way;
        let ramp = 0.5 * self.speed * self.ramp_s;
        if way < ramp {
            (2.0 * way / self.acceleration).sqrt()
        } else if left < ramp {
            self.duration_s - (2.0 * left / self.acceleration).sqrt()
        } else {
            0.5 * self.ramp_s + way / self.speed
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_way_takes_its_length_over_speed_and_one_ramp() {
        let profile = Profile::new(10.0, 2.0, 4.0);
        assert!((profile.duration_s() - (10.0 / 2.0 + 2.0 / 4.0)).abs() < 1e-12);
    }

    #[test]
    fn a_short_way_never_reaches_the_speed() {
        let profile = Profile::new(0.25, 100.0, 4.0);
        assert!((profile.duration_s() - 0.5).abs() < 1e-12);
        assert!((profile.fraction_at(0.25) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn no_way_takes_no_time() {
        let profile = Profile::new(0.0, 2.0, 4.0);
        assert_eq!((profile.duration_s(), profile.fraction_at(0.0)), (0.0, 1.0));
    }

    #[test]
    fn time_and_fraction_are_inverse_to_each_other() {
        for profile in [Profile::new(10.0, 2.0, 4.0), Profile::new(0.25, 100.0, 4.0)] {
            for step in 0..=100 {
                let fraction = f64::from(step) / 100.0;
                let back = profile.fraction_at(profile.time_at_s(fraction));
                assert!((back - fraction).abs() < 1e-9, "{fraction} came back as {back}");
            }
        }
    }
}
