//! The keys of a workcell file that say what may go wrong in it, as serde reads them.

use super::file::{LevelFile, OffsetFile};
use super::number::{ForceLimitN, ForceN, NearMm, Probability, TimeS, ToolSpeedMmPerS};
use serde::Deserialize;
use toml::Spanned;

/// Along which axes of the tool centre point a grasp centres what it takes.
#[derive(Clone, Copy, Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub(super) enum CentresFile {
    #[default]
    Nothing,
    X,
    Y,
    Xy,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SlipFile {
    pub(super) probability: Option<Probability>,
    pub(super) in_contact: Option<Probability>,
    pub(super) contact_n: Option<Spanned<ForceN>>,
    pub(super) fast: Option<Spanned<Probability>>,
    pub(super) fast_mm_per_s: Option<Spanned<ToolSpeedMmPerS>>,
    #[serde(default)]
    pub(super) offset: OffsetFile,
    pub(super) lost: Option<Probability>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FeederFile {
    pub(super) name: Spanned<String>,
    pub(super) item: Spanned<String>,
    pub(super) output: Spanned<u16>,
    #[serde(default)]
    pub(super) asks: LevelFile,
    pub(super) input: Option<Spanned<u16>>,
    pub(super) delay_s: Option<TimeS>,
    #[serde(default)]
    pub(super) ready: bool,
    pub(super) parts: Option<u32>,
    pub(super) empty: Option<Probability>,
    pub(super) askew: Option<Spanned<Probability>>,
    #[serde(default)]
    pub(super) askew_offset: OffsetFile,
    pub(super) near_mm: Option<NearMm>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputStickFile {
    pub(super) output: Spanned<u16>,
    pub(super) probability: Probability,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InputStickFile {
    pub(super) input: Spanned<u16>,
    pub(super) probability: Probability,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BounceFile {
    pub(super) input: Spanned<u16>,
    pub(super) probability: Option<Probability>,
    pub(super) for_s: TimeS,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct ChanceFile {
    pub(super) stops_short: Option<Probability>,
    pub(super) protective_stop: Option<Probability>,
    pub(super) emergency_stop: Option<Probability>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FallingFile {
    pub(super) support_mm: Option<NearMm>,
    pub(super) knock_n: Option<ForceLimitN>,
}
