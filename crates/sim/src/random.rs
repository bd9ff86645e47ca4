//! Random numbers by counter: the draw of a number in a stream is a pure function of the seed.
//!
//! Nothing is advanced, so that draws may be asked in any order and again, and that what the world
//! draws never moves what a program draws. Knows nothing of what the numbers are for beyond the
//! names of the streams.

/// What a draw is for. Streams are independent of each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stream {
    /// Draws of programs.
    Dice,
    /// Noise of the force sensor, by sample.
    Force,
    /// Where items truly lie, uniform part, by item and axis.
    ItemUniform,
    /// Where items truly lie, normal part, by item and axis.
    ItemNormal,
    /// Where fixtures truly stand, uniform part, by fixture and axis.
    FixtureUniform,
    /// Where fixtures truly stand, normal part, by fixture and axis.
    FixtureNormal,
    /// How far a grasp moves an item, uniform part, by grasp and axis.
    GraspUniform,
    /// How far a grasp moves an item, normal part, by grasp and axis.
    GraspNormal,
    /// Whether what is held slips, by motion.
    Slip,
    /// Whether what slips is lost, by motion.
    SlipLost,
    /// How far it slips, uniform part, by motion and axis.
    SlipUniform,
    /// How far it slips, normal part, by motion and axis.
    SlipNormal,
    /// Whether a feeder has nothing, by feeder and asking.
    FeederEmpty,
    /// Whether a part lies askew, by feeder and part.
    FeederAskew,
    /// How a part lies that lies askew, uniform part, by feeder, part and axis.
    AskewUniform,
    /// How a part lies that lies askew, normal part, by feeder, part and axis.
    AskewNormal,
    /// Where a part truly lies that a feeder presents, uniform part, by feeder, part and axis.
    PartUniform,
    /// Where a part truly lies that a feeder presents, normal part, by feeder, part and axis.
    PartNormal,
    /// Whether an output sticks, by output and change.
    OutputStick,
    /// Whether an input sticks, by input and change.
    InputStick,
    /// Whether an input flickers, by input and change.
    InputBounce,
    /// The level of an input that flickers, by input and time.
    InputFlicker,
    /// The bias of the force sensor in this run: uniform part.
    BiasUniform,
    /// The bias of the force sensor in this run: normal part.
    BiasNormal,
    /// Whether a motion stops short, by motion.
    StopsShort,
    /// Whether a protective stop ends a motion, by motion.
    ProtectiveStop,
    /// Whether an emergency stop ends a motion, by motion.
    EmergencyStop,
    /// Where a motion ends that is ended so, by motion.
    StopAt,
    /// How an item comes to lie that falls, by fall.
    Fall,
}

/// The golden ratio's fraction, by which SplitMix64 steps.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
fn mix(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

/// 64 random bits: the draw of number `counter` in a stream.
#[must_use]
pub fn bits(seed: u64, stream: Stream, counter: u64) -> u64 {
    let key = mix(seed.wrapping_add(STEP.wrapping_mul(stream as u64 + 1)));
    mix(key.wrapping_add(mix(counter.wrapping_add(1).wrapping_mul(STEP))))
}

/// Uniform in [0, 1).
#[must_use]
pub fn unit(seed: u64, stream: Stream, counter: u64) -> f64 {
    // 53 bits, so that every value is a multiple of 2^-53 and 1 is never reached.
    (bits(seed, stream, counter) >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

/// Uniform in [-1, 1).
#[must_use]
pub fn signed(seed: u64, stream: Stream, counter: u64) -> f64 {
    2.0 * unit(seed, stream, counter) - 1.0
}

/// Normal with mean 0 and standard deviation 1 (Box and Muller), at most 6.7 away from 0.
#[must_use]
pub fn normal(seed: u64, stream: Stream, counter: u64) -> f64 {
    const HALF: f64 = 1.0 / (1_u64 << 32) as f64;
    let both = bits(seed, stream, counter);
    // Half a step above zero, where the logarithm exists.
    let first = ((both >> 32) as f64 + 0.5) * HALF;
    let second = (both & 0xffff_ffff) as f64 * HALF;
    libm::sqrt(-2.0 * libm::log(first)) * libm::cos(std::f64::consts::TAU * second)
}

/// Whether something of a probability happens. What never happens costs no draw.
#[must_use]
pub fn happens(probability: f64, seed: u64, stream: Stream, counter: u64) -> bool {
    probability > 0.0 && unit(seed, stream, counter) < probability
}

/// A counter of which each of up to 65536 things has its own.
#[must_use]
pub fn counter_of(thing: usize, count: u64) -> u64 {
    ((thing as u64) << 48) ^ count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_fixed_by_seed_stream_and_counter() {
        assert_eq!(bits(1, Stream::Dice, 0), bits(1, Stream::Dice, 0));
        assert_ne!(bits(1, Stream::Dice, 0), bits(2, Stream::Dice, 0));
        assert_ne!(bits(1, Stream::Dice, 0), bits(1, Stream::Force, 0));
        assert_ne!(bits(1, Stream::Dice, 0), bits(1, Stream::Dice, 1));
    }

    #[test]
    fn uniform_draws_have_the_mean_and_variance_of_their_range() {
        let count = 20_000_u32;
        let draws: Vec<f64> = (0..count).map(|n| unit(7, Stream::Dice, u64::from(n))).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(count);
        let variance = draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(count);
        assert!(draws.iter().all(|x| (0.0..1.0).contains(x)));
        assert!((mean - 0.5).abs() < 0.01, "mean {mean}");
        assert!((variance - 1.0 / 12.0).abs() < 0.003, "variance {variance}");
    }

    #[test]
    fn normal_draws_have_mean_zero_and_variance_one() {
        let count = 20_000_u32;
        let draws: Vec<f64> =
            (0..count).map(|n| normal(7, Stream::ItemNormal, u64::from(n))).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(count);
        let variance = draws.iter().map(|x| x * x).sum::<f64>() / f64::from(count);
        assert!(mean.abs() < 0.03, "mean {mean}");
        assert!((variance - 1.0).abs() < 0.04, "variance {variance}");
    }
}
