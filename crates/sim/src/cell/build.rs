//! From the keys of a workcell file to a [`Cell`]: units, defaults, and every check that needs more
//! than one number. Nothing is built before its numbers were read and checked.

use super::file::{
    ArmFile, CellFile, ContactFile, FixtureFile, ForceSensorFile, GripperFile, HoleFile,
    InputsFile, ItemFile, LevelFile, OffsetFile, OutputsFile, PartFile, PoseFile, RuleFile,
    SpeedFile, SpeedsFile, ToolFile,
};
use super::number::{CoordinateMm, JointRad, MUST_BE_FROM, TurnDeg};
use super::uncertainty_build::{centres, falling};
use super::{
    ArmSpec, Cell, CellCode, CellError, ContactSpec, DEFAULT_SPEEDS, FILE_BYTES_MAX, FixtureSpec,
    ForceSensorSpec, GripperSpec, HoleSpec, InputRule, ItemSpec, OffsetSpec, Part, PegSpec, Shape,
    SpeedSpec, ToolSpec,
};
use super::{key, seat};
use obverse_geometry::{JointConfiguration, Pose};
use std::f64::consts::PI;
use toml::Spanned;

const TOOLS_MAX: usize = 64;
const ITEMS_MAX: usize = 1_000;
const FIXTURES_MAX: usize = 1_000;
const HOLES_MAX: usize = 64;
const PARTS_MAX: usize = 64;
const PINS_MAX: u16 = 1_024;
const CHANGES_MAX: usize = 10_000;
const WINDOW_MAX: u32 = 1_000;
const NAME_CHARACTERS_MAX: usize = 64;

/// How near the mouth of a hole must be to the face of its part, in metres.
const ON_FACE_M: f64 = 1e-6;
/// How far the axis of a hole may be from the normal of the face.
const STRAIGHT: f64 = 1e-6;

pub(super) const MM: f64 = 1e-3;
pub(super) const DEG: f64 = PI / 180.0;
/// How far bodies that are pressed on each other may give way, in metres.
const GIVE_M: f64 = 0.8e-3;

pub(super) fn parse(text: &str) -> Result<Cell, CellError> {
    if text.len() > FILE_BYTES_MAX {
        let message = format!("the file has {} bytes, at most {FILE_BYTES_MAX}", text.len());
        return Err(CellError::at(text, 0, message).of(CellCode::TooMany));
    }
    let file: CellFile = toml::from_str(text).map_err(|error| {
        let byte = error.span().map_or(0, |span| span.start);
        let code = kind_of(text, error.message());
        CellError::at(text, byte, said(text, byte, error.message(), code)).of(code)
    })?;
    Builder { text }.cell(&file)
}

/// What is wrong with a text that the reader refuses.
fn kind_of(text: &str, message: &str) -> CellCode {
    if toml::from_str::<toml::Table>(text).is_err() {
        CellCode::Toml
    } else if message.contains(MUST_BE_FROM) {
        CellCode::Range
    } else {
        CellCode::Key
    }
}

/// What the reader says, with the key that it is about: of a value it says none.
fn said(text: &str, byte: usize, message: &str, code: CellCode) -> String {
    let names_key = message.contains("field `") || code == CellCode::Toml;
    match key::key_of(text, byte).filter(|_| !names_key) {
        Some(key) => format!("`{key}`: {message}"),
        None => message.to_owned(),
    }
}

pub(super) struct Builder<'a> {
    text: &'a str,
}

impl Builder<'_> {
    pub(super) fn error<T>(&self, place: &Spanned<T>, message: impl Into<String>) -> CellError {
        CellError::at(self.text, place.span().start, message)
    }

    fn cell(&self, file: &CellFile) -> Result<Cell, CellError> {
        self.at_most("tools", file.tool.len(), TOOLS_MAX)?;
        self.at_most("items", file.item.len(), ITEMS_MAX)?;
        self.at_most("fixtures", file.fixture.len(), FIXTURES_MAX)?;
        self.unique(file.tool.iter().map(|tool| &tool.name))?;
        self.unique(file.item.iter().map(|item| &item.name))?;
        self.unique(file.fixture.iter().map(|fixture| &fixture.name))?;
        let tools = self.tools(&file.tool)?;
        let output_count = self.pins(&file.outputs.count)?;
        let gripper =
            file.gripper.as_ref().map(|g| self.gripper(g, &tools, output_count)).transpose()?;
        let tcp = gripper.and_then(|g| tools.get(usize::from(g.tool))).unwrap_or(&tools[0]).tcp;
        let fixtures = self.fixtures(&file.fixture, &tcp)?;
        let items = file.item.iter().map(|item| self.item(item, &tcp, &fixtures));
        let items = items.collect::<Result<Vec<_>, _>>()?;
        let mut inputs = self.inputs(&file.inputs, output_count)?;
        let cell = Cell {
            arm: self.arm(&file.arm)?,
            speeds: speeds(file),
            feeders: self.feeders(file, &items, output_count, &mut inputs)?,
            chance: self.chance(file, output_count)?,
            falling: file.falling.as_ref().map(falling),
            goals: self.goals(file, &tcp, (&items, &fixtures))?,
            items,
            fixtures,
            inputs,
            contact: self.contact(&file.contact)?,
            force_sensor: self.force_sensor(&file.force_sensor)?,
            gripper,
            tools,
            output_count,
        };
        self.free(file, &cell)?;
        Ok(cell)
    }

    pub(super) fn at_most(&self, what: &str, count: usize, limit: usize) -> Result<(), CellError> {
        if count <= limit {
            return Ok(());
        }
        let message = format!("there are {count} {what}, at most {limit}");
        Err(CellError::at(self.text, 0, message).of(CellCode::TooMany))
    }

    pub(super) fn unique<'n>(
        &self,
        names: impl Iterator<Item = &'n Spanned<String>>,
    ) -> Result<(), CellError> {
        let mut seen = std::collections::BTreeSet::new();
        for name in names {
            let characters = name.get_ref().chars().count();
            if characters == 0 || characters > NAME_CHARACTERS_MAX {
                let message =
                    format!("a name has 1 to {NAME_CHARACTERS_MAX} characters, not {characters}");
                return Err(self.error(name, message).of(CellCode::Range));
            }
            if !seen.insert(name.get_ref()) {
                let message = format!("the name `{}` is taken already", name.get_ref());
                return Err(self.error(name, message).of(CellCode::Twice));
            }
        }
        Ok(())
    }

    fn arm(&self, file: &ArmFile) -> Result<ArmSpec, CellError> {
        let mut arm = ArmSpec { home: joints(file.home_rad.get_ref()), ..ArmSpec::default() };
        if let Some(limits) = &file.limits_deg {
            for (range, limit) in arm.limits_rad.iter_mut().zip(limits) {
                let [low, high] = limit.get_ref();
                if low.0 >= high.0 {
                    let message = format!("the range {} to {} deg is empty", low.0, high.0);
                    return Err(self.error(limit, message));
                }
                *range = (low.0 * DEG, high.0 * DEG);
            }
        }
        for (number, (joint, (low, high))) in (1..).zip(arm.home.0.into_iter().zip(arm.limits_rad))
        {
            if joint < low || joint > high {
                let message = format!(
                    "joint {number} is at {joint} rad at home, outside its range of {low:.4} to \
                     {high:.4} rad"
                );
                return Err(self.error(&file.home_rad, message));
            }
        }
        Ok(arm)
    }

    fn tools(&self, files: &[ToolFile]) -> Result<Vec<ToolSpec>, CellError> {
        if files.is_empty() {
            let name = "flange".to_owned();
            return Ok(vec![ToolSpec { name, tcp: Pose::identity(), parts: Vec::new() }]);
        }
        files
            .iter()
            .map(|file| {
                Ok(ToolSpec {
                    name: file.name.get_ref().clone(),
                    tcp: pose(&file.tcp),
                    parts: self.parts(&file.body)?,
                })
            })
            .collect()
    }

    fn parts(&self, body: &[Spanned<PartFile>]) -> Result<Vec<Part>, CellError> {
        if let Some(part) = body.get(PARTS_MAX) {
            let message = format!("a body has at most {PARTS_MAX} parts");
            return Err(self.error(part, message).of(CellCode::TooMany));
        }
        body.iter().map(|part| self.part(part)).collect()
    }

    fn part(&self, file: &Spanned<PartFile>) -> Result<Part, CellError> {
        let PartFile { at, cuboid_mm, cylinder } = file.get_ref();
        let shape = match (cuboid_mm, cylinder) {
            (Some(size), None) => Shape::Cuboid { size_m: size.map(|edge| edge.0 * MM) },
            (None, Some(cylinder)) => Shape::Cylinder {
                diameter_m: cylinder.diameter_mm.0 * MM,
                length_m: cylinder.length_mm.0 * MM,
            },
            _ => return Err(self.error(file, "a part has one of `cuboid_mm` and `cylinder`")),
        };
        Ok(Part { pose: pose(at), shape })
    }

    fn pins(&self, count: &Spanned<u16>) -> Result<u16, CellError> {
        if *count.get_ref() > PINS_MAX {
            let message = format!("{} are too many, at most {PINS_MAX}", count.get_ref());
            return Err(self.error(count, message).of(CellCode::TooMany));
        }
        Ok(*count.get_ref())
    }

    pub(super) fn output(&self, output: &Spanned<u16>, count: u16) -> Result<u16, CellError> {
        if *output.get_ref() >= count {
            let message =
                format!("there is no output {}: outputs are 0 to below {count}", output.get_ref());
            return Err(self.error(output, message).of(CellCode::UnknownName));
        }
        Ok(*output.get_ref())
    }

    fn gripper(
        &self,
        file: &GripperFile,
        tools: &[ToolSpec],
        output_count: u16,
    ) -> Result<GripperSpec, CellError> {
        let tool = match &file.tool {
            None => 0,
            Some(name) => {
                let found = tools.iter().position(|tool| &tool.name == name.get_ref());
                let index = found.and_then(|index| u16::try_from(index).ok());
                index.ok_or_else(|| {
                    let message = format!("there is no tool `{}`", name.get_ref());
                    self.error(name, message).of(CellCode::UnknownName)
                })?
            }
        };
        Ok(GripperSpec {
            tool,
            output: self.output(&file.output, output_count)?,
            closed_level: level(file.closed),
            near_m: file.near_mm.0 * MM,
            near_rad: file.near_deg.0 * DEG,
            centres: centres(file.centres),
            grasp_offset: offset(&file.grasp_offset),
            slip: file.slip.as_ref().map(|slip| self.slip(slip)).transpose()?,
        })
    }

    fn inputs(&self, file: &InputsFile, outputs: u16) -> Result<Vec<InputRule>, CellError> {
        let count = self.pins(&file.count)?;
        let mut rules = vec![None; usize::from(count)];
        for rule in &file.rule {
            let number = *rule.input.get_ref();
            let Some(slot) = rules.get_mut(usize::from(number)) else {
                let message = format!("there is no input {number}: inputs are 0 to below {count}");
                return Err(self.error(&rule.input, message).of(CellCode::UnknownName));
            };
            if slot.is_some() {
                let message = format!("input {number} has a rule already");
                return Err(self.error(&rule.input, message).of(CellCode::Twice));
            }
            *slot = Some(self.rule(rule, outputs)?);
        }
        Ok(rules.into_iter().map(|rule| rule.unwrap_or(InputRule::Constant(false))).collect())
    }

    fn rule(&self, file: &RuleFile, outputs: u16) -> Result<InputRule, CellError> {
        if let (None, Some(delay)) = (&file.follows_output, &file.delay_s) {
            return Err(self.error(delay, "a delay belongs to `follows_output`"));
        }
        match (&file.level, &file.follows_output, &file.changes, file.holding) {
            (Some(constant), None, None, None) => Ok(InputRule::Constant(level(*constant))),
            (None, Some(output), None, None) => Ok(InputRule::FollowsOutput {
                output: self.output(output, outputs)?,
                delay_s: file.delay_s.as_ref().map_or(0.0, |delay| delay.get_ref().0),
            }),
            (None, None, Some(changes), None) => {
                if changes.get_ref().len() > CHANGES_MAX {
                    let message = format!("an input changes at most {CHANGES_MAX} times");
                    return Err(self.error(changes, message).of(CellCode::TooMany));
                }
                let mut list: Vec<(f64, bool)> = Vec::with_capacity(changes.get_ref().len());
                for change in changes.get_ref() {
                    let at_s = change.at_s.get_ref().0;
                    if list.last().is_some_and(|(before_s, _)| *before_s >= at_s) {
                        return Err(self.error(&change.at_s, "the times of changes must increase"));
                    }
                    list.push((at_s, level(change.level)));
                }
                Ok(InputRule::At(list))
            }
            (None, None, None, Some(true)) => Ok(InputRule::Holding),
            _ => Err(self.error(
                &file.input,
                "a rule has one of `level`, `follows_output`, `changes` and `holding = true`",
            )),
        }
    }

    fn item(
        &self,
        file: &ItemFile,
        tcp: &Pose,
        fixtures: &[FixtureSpec],
    ) -> Result<ItemSpec, CellError> {
        let grasp = pose(&file.grasp);
        let mut parts = self.parts(&file.body)?;
        let mut peg = None;
        if let Some(spec) = &file.peg {
            let (diameter_m, length_m) = (spec.diameter_mm.0 * MM, spec.length_mm.0 * MM);
            let chamfer_m = spec.chamfer_mm.get_ref().0 * MM;
            if chamfer_m * 2.0 >= diameter_m || chamfer_m >= length_m {
                return Err(self.error(
                    &spec.chamfer_mm,
                    "the chamfer takes the whole tip: it must be below half the diameter and \
                     below the length",
                ));
            }
            peg = Some(PegSpec { diameter_m, length_m, chamfer_m });
            // The body of the peg stands first.
            let shape = Shape::Cylinder { diameter_m, length_m };
            parts.insert(0, Part { pose: Pose::identity(), shape });
        }
        // An item that was taught lies so that the gripper there grasps it.
        let held =
            if file.place.taught_at_rad.is_some() { grasp.inverse() } else { Pose::identity() };
        let stand = self.stand(file.on.as_ref(), &file.place, tcp, fixtures)?;
        let (pose, on) = stand.inside(&held);
        Ok(ItemSpec {
            name: file.name.get_ref().clone(),
            pose,
            on,
            offset: offset(&file.offset),
            grasp,
            parts,
            peg,
        })
    }

    fn fixtures(&self, files: &[FixtureFile], tcp: &Pose) -> Result<Vec<FixtureSpec>, CellError> {
        let mut fixtures = Vec::with_capacity(files.len());
        for file in files {
            let fixture = self.fixture(file, tcp, &fixtures)?;
            fixtures.push(fixture);
        }
        self.apart(files, &fixtures)?;
        Ok(fixtures)
    }

    fn fixture(
        &self,
        file: &FixtureFile,
        tcp: &Pose,
        before: &[FixtureSpec],
    ) -> Result<FixtureSpec, CellError> {
        if let Some(hole) = file.hole.get(HOLES_MAX) {
            let message = format!("a fixture has at most {HOLES_MAX} holes");
            return Err(self.error(hole, message).of(CellCode::TooMany));
        }
        let parts = self.parts(&file.body)?;
        let holes = file.hole.iter().enumerate();
        let holes = holes.map(|(number, hole)| self.hole(hole, number, &parts));
        let stand = self.stand(file.on.as_ref(), &file.place, tcp, before)?;
        Ok(FixtureSpec {
            name: file.name.get_ref().clone(),
            pose: stand.pose,
            on: stand.on,
            offset: offset(&file.offset),
            holes: holes.collect::<Result<_, _>>()?,
            parts,
        })
    }

    fn hole(
        &self,
        file: &Spanned<HoleFile>,
        number: usize,
        parts: &[Part],
    ) -> Result<HoleSpec, CellError> {
        let HoleFile { mouth, diameter_mm, depth_mm, chamfer_mm, .. } = file.get_ref();
        let depth_m = depth_mm.0 * MM;
        let seat = seat::of(file.get_ref(), depth_m).map_err(|why| self.error(file, why))?;
        let mut hole = HoleSpec {
            number,
            seat,
            part: 0,
            mouth: pose(mouth),
            diameter_m: diameter_mm.0 * MM,
            depth_m,
            chamfer_m: chamfer_mm.map_or(0.0, |chamfer| chamfer.0 * MM),
        };
        hole.part = parts.iter().position(|part| is_drilled(part, &hole)).ok_or_else(|| {
            self.error(
                file,
                "the hole is in no cuboid of this fixture: its mouth must lie on a face, its z \
                 point straight into it, and all of the hole and its chamfer be inside",
            )
        })?;
        Ok(hole)
    }

    fn contact(&self, file: &ContactFile) -> Result<ContactSpec, CellError> {
        let default = ContactSpec::default();
        let contact = ContactSpec {
            stiffness_n_per_m: file
                .stiffness_n_per_mm
                .map_or(default.stiffness_n_per_m, |stiffness| stiffness.0 / MM),
            lateral_n_per_m: file
                .lateral_stiffness_n_per_mm
                .map_or(default.lateral_n_per_m, |stiffness| stiffness.0 / MM),
            angular_nm_per_rad: file
                .angular_stiffness_nm_per_deg
                .map_or(default.angular_nm_per_rad, |stiffness| stiffness.0 / DEG),
            friction: file.friction.map_or(default.friction, |friction| friction.0),
            stop_force_n: file
                .stop_force_n
                .as_ref()
                .map_or(default.stop_force_n, |force| force.get_ref().0),
        };
        let give_n = contact.stiffness_n_per_m * GIVE_M;
        match &file.stop_force_n {
            None => Ok(ContactSpec { stop_force_n: contact.stop_force_n.min(give_n), ..contact }),
            Some(force) if contact.stop_force_n > give_n => {
                let give_mm = GIVE_M / MM;
                let message = format!(
                    "bodies give way by {give_mm} mm at most, which at this stiffness is {give_n} N"
                );
                Err(self.error(force, message))
            }
            Some(_) => Ok(contact),
        }
    }

    fn force_sensor(&self, file: &ForceSensorFile) -> Result<ForceSensorSpec, CellError> {
        let mut sensor = ForceSensorSpec::default();
        if let Some(window) = &file.window {
            if !(1..=WINDOW_MAX).contains(window.get_ref()) {
                let message = format!("the window is 1 to {WINDOW_MAX} samples");
                return Err(self.error(window, message).of(CellCode::Range));
            }
            sensor.window = *window.get_ref();
        }
        sensor.noise_n = file.noise_n.map_or(sensor.noise_n, |noise| noise.0);
        sensor.bias_n = file.bias_n.map_or(sensor.bias_n, |bias| bias.0);
        sensor.bias_uniform_n = file.bias_uniform_n.map_or(0.0, |bias| bias.0);
        sensor.bias_normal_n = file.bias_normal_n.map_or(0.0, |bias| bias.0);
        sensor.sample_s = file.sample_s.map_or(sensor.sample_s, |sample| sample.0);
        Ok(sensor)
    }
}

pub(super) fn level(file: LevelFile) -> bool {
    matches!(file, LevelFile::High)
}

pub(super) fn joints(file: &[JointRad; 6]) -> JointConfiguration {
    JointConfiguration(file.map(|joint| joint.0))
}

pub(super) fn pose_of(xyz_mm: Option<[CoordinateMm; 3]>, turn_deg: Option<[TurnDeg; 3]>) -> Pose {
    Pose::from_rotation_vector(
        xyz_mm.map_or([0.0; 3], |xyz| xyz.map(|axis| axis.0 * MM)),
        turn_deg.map_or([0.0; 3], |turn| turn.map(|axis| axis.0 * DEG)),
    )
}

pub(super) fn pose(file: &PoseFile) -> Pose {
    pose_of(file.xyz_mm, file.rotation_vector_deg)
}

/// Whether a hole is drilled into a part: straight into a face, and all of it inside.
fn is_drilled(part: &Part, hole: &HoleSpec) -> bool {
    let Shape::Cuboid { size_m } = &part.shape else { return false };
    let mouth = part.pose.inverse().compose(&hole.mouth);
    let into = mouth.rotation.column(2);
    let radius_m = 0.5 * hole.diameter_m + hole.chamfer_m;
    let mut faces = 0;
    for axis in 0..3 {
        let (at, half) = (mouth.translation_m[axis], 0.5 * size_m[axis]);
        if into[axis].abs() > 1.0 - STRAIGHT {
            // On the face that z points away from, and not through the part.
            let face = -half * into[axis].signum();
            let inside = hole.depth_m < 2.0 * half;
            faces += usize::from((at - face).abs() <= ON_FACE_M && inside);
        } else if into[axis].abs() > STRAIGHT || at.abs() + radius_m > half {
            return false;
        }
    }
    faces == 1
}

pub(super) fn offset(file: &OffsetFile) -> OffsetSpec {
    fn six(xyz: Option<[f64; 3]>, turn: Option<[f64; 3]>) -> [f64; 6] {
        let [x, y, z] = xyz.unwrap_or_default().map(|axis| axis * MM);
        let [a, b, c] = turn.unwrap_or_default().map(|axis| axis * DEG);
        [x, y, z, a, b, c]
    }
    OffsetSpec {
        fixed: six(file.fixed_mm.map(|v| v.map(|x| x.0)), file.fixed_deg.map(|v| v.map(|x| x.0))),
        uniform: six(
            file.uniform_mm.map(|v| v.map(|x| x.0)),
            file.uniform_deg.map(|v| v.map(|x| x.0)),
        ),
        normal: six(
            file.normal_mm.map(|v| v.map(|x| x.0)),
            file.normal_deg.map(|v| v.map(|x| x.0)),
        ),
    }
}

fn speeds(file: &CellFile) -> [SpeedSpec; 5] {
    let SpeedsFile { very_slow, slow, normal, fast, very_fast } = &file.speed;
    let mut speeds = DEFAULT_SPEEDS;
    for (speed, file_speed) in speeds.iter_mut().zip([very_slow, slow, normal, fast, very_fast]) {
        if let Some(SpeedFile { tool_mm_per_s, joint_deg_per_s }) = file_speed {
            speed.tool_m_per_s = tool_mm_per_s.0 * MM;
            speed.joint_rad_per_s = joint_deg_per_s.0 * DEG;
        }
        if let Some(tool) = file.acceleration.tool_mm_per_s2 {
            speed.tool_m_per_s2 = tool.0 * MM;
        }
        if let Some(joint) = file.acceleration.joint_deg_per_s2 {
            speed.joint_rad_per_s2 = joint.0 * DEG;
        }
    }
    speeds
}

impl Default for OutputsFile {
    fn default() -> Self {
        Self { count: Spanned::new(0..0, 8), stick: Vec::new() }
    }
}

impl Default for InputsFile {
    fn default() -> Self {
        let count = Spanned::new(0..0, 8);
        Self { count, rule: Vec::new(), stick: Vec::new(), bounce: Vec::new() }
    }
}
