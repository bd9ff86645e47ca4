//! The keys of a workcell file, as serde reads them.
//!
//! Units are in the names of the keys; a key that is not listed here is refused. Checks that need
//! more than one value are made in `build`.

use super::goal::GoalFile;
use super::number::{
    BiasN, ChamferMm, CoordinateMm, ForceLimitN, ForceN, Friction, JointAccelerationDegPerS2,
    JointDeg, JointRad, JointSpeedDegPerS, NearDeg, NearMm, SampleS, SizeMm, SpreadDeg, SpreadMm,
    StiffnessNPerMm, StiffnessNmPerDeg, TimeS, ToolAccelerationMmPerS2, ToolSpeedMmPerS, TurnDeg,
};
use super::seat::{PressFile, SnapFile, ThreadFile};
use super::uncertainty_file::{
    BounceFile, CentresFile, ChanceFile, FallingFile, FeederFile, InputStickFile, OutputStickFile,
    SlipFile,
};
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CellFile {
    pub(super) arm: ArmFile,
    #[serde(default)]
    pub(super) speed: SpeedsFile,
    #[serde(default)]
    pub(super) acceleration: AccelerationFile,
    #[serde(default)]
    pub(super) tool: Vec<ToolFile>,
    pub(super) gripper: Option<GripperFile>,
    #[serde(default)]
    pub(super) outputs: OutputsFile,
    #[serde(default)]
    pub(super) inputs: InputsFile,
    #[serde(default)]
    pub(super) item: Vec<ItemFile>,
    #[serde(default)]
    pub(super) fixture: Vec<FixtureFile>,
    #[serde(default)]
    pub(super) contact: ContactFile,
    #[serde(default)]
    pub(super) force_sensor: ForceSensorFile,
    #[serde(default)]
    pub(super) feeder: Vec<FeederFile>,
    #[serde(default = "nothing_by_chance")]
    pub(super) chance: Spanned<ChanceFile>,
    pub(super) falling: Option<FallingFile>,
    #[serde(default)]
    pub(super) goal: Vec<GoalFile>,
}

fn nothing_by_chance() -> Spanned<ChanceFile> {
    Spanned::new(0..0, ChanceFile::default())
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArmFile {
    pub(super) home_rad: Spanned<[JointRad; 6]>,
    pub(super) limits_deg: Option<[Spanned<[JointDeg; 2]>; 6]>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct SpeedsFile {
    pub(super) very_slow: Option<SpeedFile>,
    pub(super) slow: Option<SpeedFile>,
    pub(super) normal: Option<SpeedFile>,
    pub(super) fast: Option<SpeedFile>,
    pub(super) very_fast: Option<SpeedFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpeedFile {
    pub(super) tool_mm_per_s: ToolSpeedMmPerS,
    pub(super) joint_deg_per_s: JointSpeedDegPerS,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct AccelerationFile {
    pub(super) tool_mm_per_s2: Option<ToolAccelerationMmPerS2>,
    pub(super) joint_deg_per_s2: Option<JointAccelerationDegPerS2>,
}

/// A pose in the frame that the key above it says: a position and a rotation vector.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct PoseFile {
    pub(super) xyz_mm: Option<[CoordinateMm; 3]>,
    pub(super) rotation_vector_deg: Option<[TurnDeg; 3]>,
}

/// Where a thing stands: a pose in the base frame or, for what was taught with the arm, in the
/// frame of the tool centre point with the joints at `taught_at_rad`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlaceFile {
    pub(super) taught_at_rad: Option<[JointRad; 6]>,
    pub(super) xyz_mm: Option<[CoordinateMm; 3]>,
    pub(super) rotation_vector_deg: Option<[TurnDeg; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ToolFile {
    pub(super) name: Spanned<String>,
    #[serde(default)]
    pub(super) tcp: PoseFile,
    #[serde(default)]
    pub(super) body: Vec<Spanned<PartFile>>,
}

/// A convex part of a body: a box or a cylinder along z, around `at`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PartFile {
    #[serde(default)]
    pub(super) at: PoseFile,
    pub(super) cuboid_mm: Option<[SizeMm; 3]>,
    pub(super) cylinder: Option<CylinderFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderFile {
    pub(super) diameter_mm: SizeMm,
    pub(super) length_mm: SizeMm,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GripperFile {
    pub(super) tool: Option<Spanned<String>>,
    pub(super) output: Spanned<u16>,
    #[serde(default)]
    pub(super) closed: LevelFile,
    pub(super) near_mm: NearMm,
    pub(super) near_deg: NearDeg,
    #[serde(default)]
    pub(super) centres: CentresFile,
    #[serde(default)]
    pub(super) grasp_offset: OffsetFile,
    pub(super) slip: Option<Spanned<SlipFile>>,
}

#[derive(Clone, Copy, Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub(super) enum LevelFile {
    Low,
    #[default]
    High,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputsFile {
    pub(super) count: Spanned<u16>,
    #[serde(default)]
    pub(super) stick: Vec<OutputStickFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InputsFile {
    pub(super) count: Spanned<u16>,
    #[serde(default)]
    pub(super) rule: Vec<RuleFile>,
    #[serde(default)]
    pub(super) stick: Vec<InputStickFile>,
    #[serde(default)]
    pub(super) bounce: Vec<BounceFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RuleFile {
    pub(super) input: Spanned<u16>,
    pub(super) level: Option<LevelFile>,
    pub(super) follows_output: Option<Spanned<u16>>,
    pub(super) delay_s: Option<Spanned<TimeS>>,
    pub(super) changes: Option<Spanned<Vec<ChangeFile>>>,
    pub(super) holding: Option<bool>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChangeFile {
    pub(super) at_s: Spanned<TimeS>,
    pub(super) level: LevelFile,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ItemFile {
    pub(super) name: Spanned<String>,
    pub(super) on: Option<Spanned<String>>,
    pub(super) place: PlaceFile,
    #[serde(default)]
    pub(super) offset: OffsetFile,
    #[serde(default)]
    pub(super) grasp: PoseFile,
    #[serde(default)]
    pub(super) body: Vec<Spanned<PartFile>>,
    pub(super) peg: Option<PegFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PegFile {
    pub(super) diameter_mm: SizeMm,
    pub(super) length_mm: SizeMm,
    pub(super) chamfer_mm: Spanned<ChamferMm>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FixtureFile {
    pub(super) name: Spanned<String>,
    pub(super) on: Option<Spanned<String>>,
    pub(super) place: PlaceFile,
    #[serde(default)]
    pub(super) offset: OffsetFile,
    #[serde(default)]
    pub(super) body: Vec<Spanned<PartFile>>,
    #[serde(default)]
    pub(super) hole: Vec<Spanned<HoleFile>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HoleFile {
    #[serde(default)]
    pub(super) mouth: PoseFile,
    pub(super) diameter_mm: SizeMm,
    pub(super) depth_mm: SizeMm,
    #[serde(default)]
    pub(super) chamfer_mm: Option<ChamferMm>,
    pub(super) snap: Option<SnapFile>,
    pub(super) press: Option<PressFile>,
    pub(super) thread: Option<ThreadFile>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct OffsetFile {
    pub(super) fixed_mm: Option<[CoordinateMm; 3]>,
    pub(super) fixed_deg: Option<[TurnDeg; 3]>,
    pub(super) uniform_mm: Option<[SpreadMm; 3]>,
    pub(super) uniform_deg: Option<[SpreadDeg; 3]>,
    pub(super) normal_mm: Option<[SpreadMm; 3]>,
    pub(super) normal_deg: Option<[SpreadDeg; 3]>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct ContactFile {
    pub(super) stiffness_n_per_mm: Option<StiffnessNPerMm>,
    pub(super) lateral_stiffness_n_per_mm: Option<StiffnessNPerMm>,
    pub(super) angular_stiffness_nm_per_deg: Option<StiffnessNmPerDeg>,
    pub(super) friction: Option<Friction>,
    pub(super) stop_force_n: Option<Spanned<ForceLimitN>>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct ForceSensorFile {
    pub(super) noise_n: Option<ForceN>,
    pub(super) bias_n: Option<BiasN>,
    pub(super) bias_uniform_n: Option<ForceN>,
    pub(super) bias_normal_n: Option<ForceN>,
    pub(super) window: Option<Spanned<u32>>,
    pub(super) sample_s: Option<SampleS>,
}
