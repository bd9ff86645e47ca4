//! What is done otherwise on the way forward again.

use crate::incident::{Incident, Search};
use crate::trail::{Action, Trail};
use obverse_bytecode::{Pattern, Reversal};
use obverse_vm::{Alteration, Aside};
use std::f64::consts::{PI, TAU};

/// How many points cover the whole circle of a perturbation.
const SPIRAL_POINTS: f64 = 8.0;
/// The angle between two points of a spiral that fills a circle evenly (Vogel 1979), in radians.
const GOLDEN_ANGLE_RAD: f64 = PI * (3.0 - 2.236_067_977_499_79);
/// What `lighter` does to a force limit at each attempt.
const LIGHTER: f64 = 0.8;

/// The changes of the next attempt at an incident, which searches there.
pub(crate) fn of_incident(
    policy: &Reversal,
    incident: &Incident,
    trail: &Trail<'_>,
    search: Search,
    seed: u64,
) -> Option<Alteration> {
    let attempt = incident.attempts.len() as u32 + 1;
    let motion = trail.newest_of(&incident.branches).and_then(Action::motion);
    of_attempt(policy, attempt, search.point, motion, seed ^ incident.number)
}

/// The changes of an attempt, counted from 1, at a point of the search pattern; none where the
/// policy changes nothing. `motion` is the instruction of the motion that failed; what is random
/// follows from the seed.
#[must_use]
pub fn of_attempt(
    policy: &Reversal,
    attempt: u32,
    point: u32,
    motion: Option<u32>,
    seed: u64,
) -> Option<Alteration> {
    let slower = u8::from(policy.slower);
    let force_factor = policy.lighter.then(|| libm::pow(LIGHTER, f64::from(attempt)));
    let perturbation = policy.perturbation.filter(|_| point > 0);
    let aside = perturbation.zip(motion).map(|(perturbation, pc)| {
        let by_m = match perturbation.pattern {
            Pattern::Spiral => spiral_m(perturbation.limit_m, point),
            Pattern::Random => random_m(perturbation.limit_m, seed, point),
        };
        Aside { pc, by_m }
    });
    let change = Alteration { slower, force_factor, aside };
    (change != Alteration::default()).then_some(change)
}

/// The point of a spiral search, in metres, at most `limit_m` from the middle.
fn spiral_m(limit_m: f64, point: u32) -> [f64; 2] {
    let share = (f64::from(point) / SPIRAL_POINTS).min(1.0);
    polar_m(limit_m * libm::sqrt(share), f64::from(point) * GOLDEN_ANGLE_RAD)
}

/// A point drawn evenly from the circle, in metres.
fn random_m(limit_m: f64, seed: u64, point: u32) -> [f64; 2] {
    let key = mix(seed ^ u64::from(point).wrapping_mul(STEP));
    let unit = |bits: u64| (bits >> 11) as f64 / (1_u64 << 53) as f64;
    polar_m(limit_m * libm::sqrt(unit(key)), TAU * unit(mix(key ^ STEP)))
}

fn polar_m(radius_m: f64, angle_rad: f64) -> [f64; 2] {
    [radius_m * libm::cos(angle_rad), radius_m * libm::sin(angle_rad)]
}

/// The golden ratio's fraction.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
fn mix(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn far_m([x, y]: [f64; 2]) -> f64 {
        libm::hypot(x, y)
    }

    #[test]
    fn a_spiral_goes_outwards_and_never_further_than_its_limit() {
        let points: Vec<f64> = (1..=20).map(|attempt| far_m(spiral_m(0.002, attempt))).collect();
        assert!(points.windows(2).all(|pair| pair[0] <= pair[1] + 1e-12));
        assert!(points.iter().all(|&far| far <= 0.002 + 1e-12));
        assert!((points[19] - 0.002).abs() < 1e-12);
    }

    #[test]
    fn what_is_random_follows_from_the_seed_and_keeps_to_its_limit() {
        let draw = |seed| (1..=100).map(|attempt| random_m(0.001, seed, attempt)).collect();
        let (first, again, other): (Vec<_>, Vec<_>, Vec<_>) = (draw(1), draw(1), draw(2));
        assert_eq!(first, again);
        assert_ne!(first, other);
        assert!(first.iter().all(|&point| far_m(point) <= 0.001));
    }
}
