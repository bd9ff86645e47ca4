//! A small cell, and programs checked in it.

use obverse_bytecode::{Module, assemble, verify};
use obverse_geometry::Pose;
use obverse_preflight::{Graded, MoveReport, Reason, Report, check};
use obverse_sim::cell::{FixtureSpec, OffsetSpec, Part, Shape};
use obverse_sim::{Cell, Plan};

/// A part to take and a spot beside it; the arm points down over them.
pub(crate) const CELL: &str = r#"
[arm]
home_rad = [3.1416, -1.5708, 1.5708, -1.5708, -1.5708, 0]
limits_deg = [[-360, 360], [-360, 360], [-360, 360], [-360, 360], [-360, 360], [-180, 180]]

[outputs]
count = 8
[inputs]
count = 8

[[tool]]
name = "gripper"
tcp = { xyz_mm = [0, 0, 140] }
body = [{ cylinder = { diameter_mm = 30, length_mm = 130 }, at = { xyz_mm = [0, 0, 65] } }]

[[tool]]
name = "probe"
tcp = { xyz_mm = [0, 0, 180] }

[gripper]
tool = "gripper"
output = 0
near_mm = 5
near_deg = 10

[[item]]
name = "part"
place = { xyz_mm = [450, 150, 60], rotation_vector_deg = [180, 0, 0] }
body = [{ cuboid_mm = [20, 20, 60], at = { xyz_mm = [0, 0, 35] } }]

[[item]]
name = "spot"
place = { xyz_mm = [450, -150, 60], rotation_vector_deg = [180, 0, 0] }
grasp = { xyz_mm = [0, 0, 1000] }
"#;

/// The cell whose part has no body, so that something else may be where it lies.
pub(crate) fn bodiless() -> String {
    let body = "body = [{ cuboid_mm = [20, 20, 60], at = { xyz_mm = [0, 0, 35] } }]\n";
    assert!(CELL.contains(body), "the part has one");
    CELL.replace(body, "")
}

/// The cell with a block at a place, of a height, in millimetres; where the part lies, that has no
/// body.
pub(crate) fn with_wall(x: i32, y: i32, height: i32) -> String {
    let middle = height / 2;
    let cell = if (x, y) == (450, 150) { bodiless() } else { CELL.to_owned() };
    format!(
        "{cell}
[[fixture]]
name = \"wall\"
place = {{ xyz_mm = [{x}, {y}, {middle}] }}
body = [{{ cuboid_mm = [60, 60, {height}] }}]
"
    )
}

/// The bare cell with a crowd of bodies far from the arm.
pub(crate) fn crowded() -> Cell {
    let mut cell = Cell::bare();
    let speck = |number: u32| Part {
        pose: Pose::from_rotation_vector([50.0 + f64::from(number), 0.0, 0.0], [0.0; 3]),
        shape: Shape::Cuboid { size_m: [0.01; 3] },
    };
    let (pose, offset) = (Pose::identity(), OffsetSpec::default());
    let parts = (0..125_000).map(speck).collect();
    let name = "dust".to_owned();
    cell.fixtures.push(FixtureSpec { name, pose, on: None, offset, parts, holes: Vec::new() });
    cell
}

/// More moves than are looked at in a crowd.
pub(crate) const MANY_MOVES: &str = "
sequence main {
  for place from 1 to 30 { move 0.1 mm * real(place) up in base }
}";

/// What was found of a program.
pub(crate) struct Found {
    pub(crate) report: Report,
    lines: Vec<usize>,
}

impl Found {
    pub(crate) fn of(cell: &str, program: &str) -> Self {
        let cell = Cell::parse(cell).unwrap_or_else(|error| panic!("{error}"));
        Self::in_cell(&cell, program)
    }

    pub(crate) fn in_cell(cell: &Cell, program: &str) -> Self {
        let compiled = obverse_compiler::compile("program.obv", program);
        let Some(module) = compiled.module else { panic!("{:?}", compiled.diagnostics) };
        Self::of_module(cell, module)
    }

    pub(crate) fn of_assembly(cell: &str, text: &str) -> Self {
        let cell = Cell::parse(cell).unwrap_or_else(|error| panic!("{error}"));
        let module = assemble(text).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"));
        Self::of_module(&cell, module)
    }

    fn of_module(cell: &Cell, module: Module) -> Self {
        let program = verify(module).expect("a module that verifies");
        let report = check(&program, Plan::new(cell)).expect("a cell with all that is needed");
        let line =
            |found: &MoveReport| program.module().place_of(found.pc).map_or(0, |place| place.1);
        let lines = report.moves.iter().map(line).collect();
        Self { report, lines }
    }

    /// What was found of a move, by its number, going forward.
    pub(crate) fn forward(&self, number: usize) -> &Graded {
        self.report.moves[number].forward.as_ref().expect("a way there")
    }

    /// The same in reverse.
    pub(crate) fn reverse(&self, number: usize) -> &Graded {
        self.report.moves[number].reverse.as_ref().expect("a way back")
    }

    /// The first move of a line.
    pub(crate) fn at_line(&self, line: usize) -> &MoveReport {
        let at = self.lines.iter().position(|found| *found == line);
        &self.report.moves[at.unwrap_or_else(|| panic!("no move in line {line}"))]
    }
}

/// The reasons of a move, forward and in reverse.
pub(crate) fn reasons(found: &MoveReport) -> (Option<Reason>, Option<Reason>) {
    let reason = |graded: &Option<Graded>| graded.as_ref().map(|graded| graded.verdict.reason);
    (reason(&found.forward), reason(&found.reverse))
}
