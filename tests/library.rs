//! The library at work: every action of every file in a cell, where what it is for is so in truth
//! afterwards, and going back leads to the start, or to what its head says cannot be taken back.

use obverse_bytecode::{Verified, verify};
use obverse_compiler::{compile, library};
use obverse_recovery::{Ending, drive};
use obverse_sim::{Cell, Sim};
use obverse_vm::{Direction, Limits, Machine};

/// The gripper holds, or can take, a pin; its end is 20 mm over the mouth of a hole in a block.
/// What stands for `HOLE`, `OFFSET` and `MORE` is said by each use.
const CELL: &str = r#"
[arm]
home_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6]
[outputs]
count = 4
[inputs]
count = 4
[[tool]]
name = "hand"
tcp = { xyz_mm = [0, 0, 100] }
[gripper]
output = 0
near_mm = 3
near_deg = 5
[[item]]
name = "pin"
place = { taught_at_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6] }
grasp = { xyz_mm = [0, 0, -10] }
peg = { diameter_mm = 10, length_mm = 40, chamfer_mm = 0.5 }
[[item]]
name = "spot"
place = { taught_at_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6], xyz_mm = [-60, 0, 1000] }
grasp = { xyz_mm = [0, 0, 1000] }
[[fixture]]
name = "block"
place = { taught_at_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6], xyz_mm = [0, 0, 50] }
body = [{ cuboid_mm = [60, 60, 60], at = { xyz_mm = [0, 0, 30] } }]
offset = OFFSET
hole = [HOLE]
[contact]
stiffness_n_per_mm = 60
stop_force_n = 48
MORE
"#;

const PLAIN: &str = "{ diameter_mm = 10.2, depth_mm = 15, chamfer_mm = 1 }";

/// Keyframes count from the origin of the item, and the gripper takes the pin 10 mm above it.
const PRELUDE: &str = "
io grip    { set 0 high; sleep 0.3 s }
io release { set 0 low;  sleep 0.3 s }
item pin {
  keyframe above = [0, 0, -60] mm
  keyframe grasp = [0, 0, -10] mm
}
item spot {
  keyframe above = [0, 0, -50] mm
  keyframe put   = [0, 0, 0] mm
}
";

/// Where the pin must be in the end.
const HELD: &str = "held = true";
const AT_SPOT: &str = "place = { taught_at_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6], \
     xyz_mm = [-60, 0, 10] }\nwithin_mm = 0.5\nwithin_deg = 0.5";

/// A file of the library at work.
struct Use {
    file: &'static str,
    /// What the program declares, beside the prelude.
    declares: &'static str,
    /// What it does.
    does: &'static str,
    hole: &'static str,
    offset: &'static str,
    /// More of the workcell, and what is so in the end.
    more: &'static str,
    goal: &'static str,
    /// Whether it can be taken back to the start.
    goes_back: bool,
}

const NOTHING: Use = Use {
    file: "",
    declares: "",
    does: "",
    hole: PLAIN,
    offset: "{}",
    more: "",
    goal: "",
    goes_back: true,
};

const USES: &[Use] = &[
    Use { file: "pick", does: "call pick(pin)", goal: HELD, ..NOTHING },
    Use { file: "place", does: "io grip call place(spot)", goal: AT_SPOT, ..NOTHING },
    Use {
        file: "feeder",
        declares: "output feeder = 1 input part_there = 1",
        does: "call pick_from_feeder(pin)",
        more: "[[feeder]]\nname = \"tray\"\nitem = \"pin\"\noutput = 1\ninput = 1\ndelay_s = 0.5",
        goal: HELD,
        ..NOTHING
    },
    Use { file: "regrasp", does: "io grip call regrasp(spot)", goal: HELD, ..NOTHING },
    Use {
        file: "insert",
        does: "io grip call insert_with_spiral_search(depth: 34 mm, entry: 25 mm, pitch: 0.5 mm) \
               io release",
        offset: "{ fixed_mm = [1.4, 0, 0] }",
        goal: "fixture = \"block\"\ndepth_mm = [13, 15.1]",
        ..NOTHING
    },
    Use {
        file: "round",
        does: "io grip call insert_with_round_search(depth: 34 mm, entry: 25 mm, pitch: 0.5 mm) \
               io release",
        offset: "{ fixed_mm = [1.4, 0, 0] }",
        goal: "fixture = \"block\"\ndepth_mm = [13, 15.1]",
        ..NOTHING
    },
    Use {
        file: "tilt",
        does: "io grip call insert_with_tilt(depth: 34 mm, entry: 25 mm, aside: 2 mm, steps: 10) \
               io release",
        offset: "{ fixed_mm = [1.4, 0, 0] }",
        goal: "fixture = \"block\"\ndepth_mm = [13, 15.1]",
        ..NOTHING
    },
    Use {
        file: "press",
        does: "io grip move 19 mm forward in tcp call press(depth: 16 mm, force_limit: 40 N) \
               io release",
        hole: "{ diameter_mm = 9.98, depth_mm = 15, chamfer_mm = 1, \
               press = { force_n_per_mm = 3, hold_n = 30 } }",
        goal: "fixture = \"block\"\ndepth_mm = [10, 15.1]",
        goes_back: false,
        ..NOTHING
    },
    Use {
        file: "snap",
        does: "io grip move 19 mm forward in tcp call snap(depth: 14 mm, force_limit: 25 N) \
               io release",
        hole: "{ diameter_mm = 10.1, depth_mm = 12.5, chamfer_mm = 1, \
               snap = { at_mm = 12.4, travel_mm = 3, peak_n = 15, hold_n = 25 } }",
        goal: "fixture = \"block\"\ndepth_mm = [12.3, 12.6]",
        ..NOTHING
    },
    Use {
        file: "turn",
        declares: "advanced move set_on { distance 30 mm forward in tcp stop if force > 3 N \
                   speed slow }",
        does: "io grip advance set_on call turn_home(by: 640 deg, lead: 2.4 mm, force_limit: 20 N) \
               io release",
        hole: "{ diameter_mm = 10.1, depth_mm = 15, chamfer_mm = 1, thread = { at_mm = 3, \
               pitch_mm = 1.5, turns = 1.6, catch_mm = 0.3, catch_deg = 1, give_n_per_mm = 10 } }",
        goal: "fixture = \"block\"\ndepth_mm = [5.3, 5.5]",
        ..NOTHING
    },
    // What it has measured says where the pin is put, which else would be 3 mm too high.
    Use {
        file: "probe",
        declares: "joints over = [3.1, -1.57, 1.56, -1.56, -1.57, -6] rad",
        does: "io grip move 20 mm x in tcp call probe(expected: 20 mm) move to over linearly \
               move probe_offset forward in tcp move 34 mm forward in tcp io release",
        offset: "{ fixed_mm = [0, 0, 3] }",
        goal: "fixture = \"block\"\ndepth_mm = [13.4, 14.9]",
        ..NOTHING
    },
];

fn load(used: &Use) -> (Verified, Cell) {
    let Use { file, declares, does, .. } = used;
    let source =
        format!("import library \"{file}\"\n{PRELUDE}{declares}\nsequence main {{ {does} }}\n");
    let compiled = compile("main.obv", &source);
    let module = compiled.module.unwrap_or_else(|| panic!("{file}: {:#?}", compiled.diagnostics));
    let goal = format!("{}\n[[goal]]\nitem = \"pin\"\n{}", used.more, used.goal);
    let cell = CELL.replace("HOLE", used.hole).replace("OFFSET", used.offset);
    let cell = Cell::parse(&cell.replace("MORE", &goal));
    let cell = cell.unwrap_or_else(|error| panic!("{file}: {error}"));
    (verify(module).unwrap_or_else(|errors| panic!("{file}: {errors:?}")), cell)
}

#[test]
fn every_file_is_at_work_here() {
    let mut used: Vec<&str> = USES.iter().map(|used| used.file).collect();
    used.sort_unstable();
    let all: Vec<&str> = library::FILES.iter().map(|(name, _)| *name).collect();
    assert_eq!(used, all);
}

#[test]
fn what_an_action_is_for_is_so_afterwards_and_goes_back() {
    for used in USES {
        let file = used.file;
        let (program, cell) = load(used);
        let mut sim = Sim::new(&cell, 1);
        let mut machine = Machine::new(&program, &sim).unwrap();
        let start = machine.digest(&sim);
        assert_ne!(sim.missed_goals(), [], "{file}: it is so before anything is done");
        let there = drive(&mut machine, Direction::Forward, Limits::NONE, &mut sim, &mut ());
        assert_eq!(there, Ending::Finished, "{file}");
        assert_eq!(sim.missed_goals(), [], "{file}");
        let back = drive(&mut machine, Direction::Reverse, Limits::NONE, &mut sim, &mut ());
        if used.goes_back {
            assert_eq!(back, Ending::AtStart, "{file}");
            assert_eq!(machine.digest(&sim), start, "{file}");
        } else {
            assert!(matches!(back, Ending::Refused(_)), "{file}: {back:?}");
        }
    }
}
