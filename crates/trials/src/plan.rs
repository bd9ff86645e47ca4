//! What a campaign is: how many assemblies, from which seed, by which strategies, of what. Two
//! campaigns of the same plan have the same results, byte for byte.

use crate::strategy::Strategy;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// The most assemblies of a campaign by each strategy.
pub const MAX_RUNS: u64 = 10_000_000;

/// What a campaign is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The version of Obverse: another one may compute otherwise.
    pub version: String,
    /// The program's name, for people.
    pub program: String,
    /// A digest of the compiled program.
    pub program_digest: String,
    /// A digest of the workcell file.
    pub cell_digest: String,
    /// How many goals of the workcell file a finished assembly is judged by; with none, what the
    /// program itself believes is all that is known.
    pub goals: u32,
    /// How many of the program's errors have a sequence written against them; with none, the
    /// strategy that goes by them does what stopping does.
    pub sequences: u32,
    /// A digest of what the strategy that learns goes by; none where it is not compared.
    pub memory_digest: Option<String>,
    /// The strategies, in the order of the tables.
    pub strategies: Vec<Strategy>,
    /// What the seeds of the assemblies follow from.
    pub seed: u64,
    /// How many assemblies are made by each strategy.
    pub runs: u64,
    /// How long a person takes, each time that one has to come, in seconds.
    pub person_s: f64,
    /// How often a person releases a stopped arm in one assembly.
    pub releases: u32,
    /// After how many instructions an assembly is given up.
    pub instructions: u64,
}

/// The golden ratio's fraction, by which SplitMix64 steps.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// What the seeds of a campaign are for. The seeds of either are apart from the other's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Assemblies that count.
    Trial = 1,
    /// Assemblies that are learned from.
    Learning = 2,
    /// Runs that choose among parameters.
    Parameters = 3,
    /// Runs that confirm what was chosen.
    Confirmation = 4,
}

/// The seed of an assembly of a campaign: below 2^53, so that every reader of JSON keeps it.
#[must_use]
pub fn seed_of(campaign: u64, purpose: Purpose, run: u64) -> u64 {
    let stream = mix(campaign.wrapping_add(STEP.wrapping_mul(purpose as u64)));
    mix(stream.wrapping_add(run.wrapping_add(1).wrapping_mul(STEP))) >> 11
}

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
fn mix(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

impl Plan {
    /// What makes another campaign of another plan, in words; none if they are the same.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<String> {
        let list = |plan: &Self| {
            plan.strategies.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
        };
        let digest = |digest: &Option<String>| digest.clone().unwrap_or_else(|| "none".to_owned());
        let rows = [
            ("version of Obverse", self.version.clone(), other.version.clone()),
            ("program", self.program.clone(), other.program.clone()),
            ("compiled program", self.program_digest.clone(), other.program_digest.clone()),
            ("workcell", self.cell_digest.clone(), other.cell_digest.clone()),
            ("list of strategies", list(self), list(other)),
            ("seed", self.seed.to_string(), other.seed.to_string()),
            ("number of runs", self.runs.to_string(), other.runs.to_string()),
            ("number of releases", self.releases.to_string(), other.releases.to_string()),
            ("price of a person", self.person_s.to_string(), other.person_s.to_string()),
            (
                "limit of instructions",
                self.instructions.to_string(),
                other.instructions.to_string(),
            ),
            // Last, since what is learned follows from most of the others.
            ("memory", digest(&self.memory_digest), digest(&other.memory_digest)),
        ];
        let (what, mine, theirs) = rows.into_iter().find(|(_, mine, theirs)| mine != theirs)?;
        Some(format!("its {what} is {theirs}, and not {mine}"))
    }
}

/// A part of a campaign: one of so many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// Which, from 1.
    pub index: u32,
    /// Of how many.
    pub count: u32,
}

impl Shard {
    /// All of a campaign.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// Whether there can be such a shard.
    #[must_use]
    pub fn is_valid(self) -> bool {
        (1..=self.count).contains(&self.index)
    }

    /// The runs of this shard of a campaign of so many.
    #[must_use]
    pub fn runs(self, runs: u64) -> Range<u64> {
        let cut = |index: u32| {
            let cut = u128::from(runs) * u128::from(index) / u128::from(self.count.max(1));
            u64::try_from(cut).unwrap_or(runs).min(runs)
        };
        cut(self.index.saturating_sub(1))..cut(self.index)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/');
        let number = |part: &str| part.parse::<u32>().ok();
        let shard = parts
            .and_then(|(index, count)| Some(Self { index: number(index)?, count: number(count)? }));
        let shard = shard.filter(|shard| shard.is_valid());
        shard.ok_or_else(|| format!("`{text}` is no shard: the second of four is 2/4"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn shards_cover_each_run_once() {
        for (runs, count) in [(0, 1), (1, 3), (10, 3), (1000, 7), (5, 5)] {
            let shards = (1..=count).map(|index| Shard { index, count });
            let covered: Vec<u64> = shards.flat_map(|shard| shard.runs(runs)).collect();
            assert_eq!(covered, (0..runs).collect::<Vec<_>>(), "{runs} runs, {count} shards");
        }
    }

    #[test]
    fn a_shard_is_one_of_so_many() {
        assert_eq!("2/4".parse(), Ok(Shard { index: 2, count: 4 }));
        for wrong in ["", "2", "0/4", "5/4", "a/4", "1/0", "-1/4", "1/4/2"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn seeds_differ_by_campaign_purpose_and_run_and_fit_a_double() {
        let mut seeds = BTreeSet::new();
        for campaign in 0..4 {
            for purpose in [Purpose::Trial, Purpose::Learning] {
                seeds.extend((0..1000).map(|run| seed_of(campaign, purpose, run)));
            }
        }
        assert_eq!(seeds.len(), 8000);
        assert!(seeds.iter().all(|seed| *seed < 1 << 53));
    }
}
