//! Shares, means and quantiles, with how far they can be trusted.

/// The share of intervals that hold what they are of.
pub const CONFIDENCE: f64 = 0.95;

/// The quantile of the normal distribution that leaves 2.5 % on either side.
const Z95: f64 = 1.959_963_984_540_054;

/// Where a value lies with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Not below.
    pub low: f64,
    /// Not above.
    pub high: f64,
}

/// The Wilson interval of a share at 95 % (Wilson 1927), without correction for continuity; none of
/// nothing.
#[must_use]
pub fn wilson(successes: u64, trials: u64) -> Option<Interval> {
    wilson_weighted(successes as f64, trials as f64)
}

/// The same for weighted trials, of which there are as many as weigh as much.
#[must_use]
pub fn wilson_weighted(successes: f64, count: f64) -> Option<Interval> {
    if count <= 0.0 {
        return None;
    }
    let share = (successes / count).min(1.0);
    let square = Z95 * Z95 / count;
    let middle = share + square / 2.0;
    let half = Z95 * libm::sqrt(share * (1.0 - share) / count + square / (4.0 * count));
    let bound = |value: f64| (value / (1.0 + square)).clamp(0.0, 1.0);
    // At the ends the formula is exact, and rounding must not say otherwise.
    let low = if share <= 0.0 { 0.0 } else { bound(middle - half) };
    let high = if share >= 1.0 { 1.0 } else { bound(middle + half) };
    Some(Interval { low, high })
}

/// The mean; none of nothing.
#[must_use]
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Where the mean of what the values are a sample of lies with 95 % confidence, by the normal
/// approximation; none of fewer than two.
#[must_use]
pub fn mean_interval(values: &[f64]) -> Option<Interval> {
    let mean = mean(values).filter(|_| values.len() > 1)?;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    let count = values.len() as f64;
    let half = Z95 * libm::sqrt(squares / (count - 1.0) / count);
    Some(Interval { low: mean - half, high: mean + half })
}

/// The smallest value of a sorted sample that at least this share of it does not exceed (nearest
/// rank); none of nothing.
#[must_use]
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let rank = libm::ceil(share * sorted.len() as f64) as usize;
    sorted.get(rank.max(1) - 1).or(sorted.last()).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn percent(interval: Interval) -> (f64, f64) {
        let rounded = |share: f64| (share * 1000.0).round() / 10.0;
        (rounded(interval.low), rounded(interval.high))
    }

    #[test]
    fn wilson_gives_the_published_interval_of_18_of_22() {
        assert_eq!(wilson(18, 22).map(percent), Some((61.5, 92.7)));
    }

    /// Newcombe 1998, table I: 81 of 263, 15 of 148, 0 of 20 and 1 of 29.
    #[test]
    fn wilson_gives_the_intervals_of_the_literature() {
        let close = |found: Option<Interval>, low: f64, high: f64| {
            let found = found.expect("there are trials");
            let is_close = (found.low - low).abs() < 5e-5 && (found.high - high).abs() < 5e-5;
            assert!(is_close, "{found:?}, and not {low} to {high}");
        };
        close(wilson(81, 263), 0.2553, 0.3662);
        close(wilson(15, 148), 0.0624, 0.1605);
        close(wilson(0, 20), 0.0, 0.1611);
        close(wilson(1, 29), 0.0061, 0.1718);
    }

    #[test]
    fn wilson_reaches_the_ends_exactly_and_says_nothing_of_nothing() {
        assert_eq!(wilson(0, 0), None);
        assert_eq!(wilson(0, 7).map(|interval| interval.low), Some(0.0));
        assert_eq!(wilson(7, 7).map(|interval| interval.high), Some(1.0));
    }

    #[test]
    fn quantiles_are_values_that_occurred() {
        let values: Vec<f64> = (1..=100).map(f64::from).collect();
        assert_eq!(quantile(&values, 0.95), Some(95.0));
        assert_eq!(quantile(&values, 0.5), Some(50.0));
        assert_eq!(quantile(&values, 0.0), Some(1.0));
        assert_eq!(quantile(&values, 1.0), Some(100.0));
        assert_eq!(quantile(&[7.0], 0.95), Some(7.0));
        assert_eq!(quantile(&[], 0.5), None);
    }

    #[test]
    fn the_interval_of_a_mean_is_that_of_the_normal_approximation() {
        // Of 1 to 9 the mean is 5 and the sample variance 7.5.
        let values: Vec<f64> = (1..=9).map(f64::from).collect();
        let found = mean_interval(&values).expect("there are two values and more");
        let half = 1.959_964 * (7.5_f64 / 9.0).sqrt();
        assert!((found.low - (5.0 - half)).abs() < 1e-5, "{found:?}");
        assert!((found.high - (5.0 + half)).abs() < 1e-5, "{found:?}");
        assert_eq!(mean_interval(&[3.0]), None);
        assert_eq!(mean(&[]), None);
    }
}
