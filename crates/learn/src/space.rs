//! The space of the parameters, and a sample that fills it evenly: Halton's sequence (Halton 1960),
//! a prime for each parameter. It knows nothing of what the values do.

/// The bases of the sequence: the most parameters that are searched at a time.
const PRIMES: [u32; 8] = [2, 3, 5, 7, 11, 13, 17, 19];

/// The most parameters that are searched at a time. In more, a sample that can be afforded says
/// little of what lies between.
pub const MAX_AXES: usize = PRIMES.len();

/// How many steps a range is divided into: values that people can read.
const STEPS: f64 = 1000.0;

/// A parameter that is searched.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its name.
    pub name: String,
    /// The unit of its values; empty for a number without one.
    pub unit: String,
    /// The least value.
    pub low: f64,
    /// The most.
    pub high: f64,
    /// Whether its values are whole numbers.
    pub is_integer: bool,
    /// What it is where nothing is said.
    pub default: f64,
}

impl Axis {
    /// The value at a share of the range, as it is written.
    fn at(&self, share: f64) -> f64 {
        if self.is_integer {
            let count = self.high - self.low + 1.0;
            return (self.low + libm::floor(share * count)).min(self.high);
        }
        let value = self.low + (self.high - self.low) * share;
        let step = libm::pow(10.0, libm::ceil(libm::log10((self.high - self.low) / STEPS)));
        let rounded: f64 = format!("{:.*}", places(step), value).parse().unwrap_or(value);
        rounded.clamp(self.low, self.high)
    }

    /// Where in the range a value lies: 0 at its least, 1 at its most.
    #[must_use]
    pub fn share(&self, value: f64) -> f64 {
        let span = self.high - self.low;
        if span > 0.0 { (value - self.low) / span } else { 0.0 }
    }
}

/// How many digits behind the point a step needs.
fn places(step: f64) -> usize {
    let digits = -libm::floor(libm::log10(step) + 1e-9);
    if digits.is_finite() { digits.clamp(0.0, 12.0) as usize } else { 0 }
}

/// The sequence's value of an index, from 1, to a base.
fn halton(index: u32, base: u32) -> f64 {
    let (mut left, mut part, mut value) = (index, 1.0, 0.0);
    while left > 0 {
        part /= f64::from(base);
        value += part * f64::from(left % base);
        left /= base;
    }
    value
}

/// So many candidates at the most, no two the same: the defaults first, then the sample.
#[must_use]
pub fn candidates(axes: &[Axis], count: usize) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = vec![axes.iter().map(|axis| axis.default).collect()];
    // Whole numbers repeat: what is asked for may be more than there are.
    let tries = u32::try_from(count.saturating_mul(8)).unwrap_or(u32::MAX);
    for index in 1..=tries {
        if found.len() >= count {
            break;
        }
        let point: Vec<f64> =
            axes.iter().zip(PRIMES).map(|(axis, base)| axis.at(halton(index, base))).collect();
        if !found.contains(&point) {
            found.push(point);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(low: f64, high: f64, is_integer: bool) -> Axis {
        let (name, unit) = ("a".to_owned(), String::new());
        Axis { name, unit, low, high, is_integer, default: low }
    }

    #[test]
    fn the_sequence_is_that_of_the_literature() {
        let first = |base| (1..=4).map(|index| halton(index, base)).collect::<Vec<_>>();
        assert_eq!(first(2), [0.5, 0.25, 0.75, 0.125]);
        let thirds = [1.0 / 3.0, 2.0 / 3.0, 1.0 / 9.0, 4.0 / 9.0];
        assert!(first(3).iter().zip(thirds).all(|(found, third)| (found - third).abs() < 1e-12));
    }

    #[test]
    fn candidates_fill_the_ranges_and_begin_with_the_defaults() {
        let axes = [axis(5.0, 60.0, false), axis(0.05, 3.0, false), axis(1.0, 4.0, true)];
        let found = candidates(&axes, 100);
        assert_eq!((found.len(), &found[0]), (100, &vec![5.0, 0.05, 1.0]));
        for (index, axis) in axes.iter().enumerate() {
            let shares: Vec<f64> = found.iter().map(|point| axis.share(point[index])).collect();
            assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)));
            for tenth in 0..10 {
                let low = f64::from(tenth) / 10.0;
                let inside = shares.iter().filter(|share| (low..=low + 0.1).contains(*share));
                assert!(axis.is_integer || inside.count() >= 5, "{tenth} of {axis:?}");
            }
        }
    }

    #[test]
    fn whole_numbers_are_not_tried_twice() {
        let found = candidates(&[axis(1.0, 3.0, true)], 50);
        assert_eq!(found, [[1.0], [2.0], [3.0]]);
        assert_eq!(candidates(&[axis(2.0, 2.0, false)], 9), [[2.0]]);
    }

    #[test]
    fn values_are_short() {
        let axis = axis(5.0, 60.0, false);
        let is_short =
            |point: &Vec<f64>| (point[0] * 10.0 - (point[0] * 10.0).round()).abs() < 1e-9;
        assert!(candidates(&[axis], 40).iter().all(is_short));
    }
}
