//! What a finished assembly is: goals are judged by how things truly are, and a file whose goals
//! cannot be is refused in place.

mod common;

use common::{AT_PIN, lift, pin_on_plate, push, shift};
use obverse_geometry::JointConfiguration;
use obverse_sim::{Cell, CellCode, Miss, Sim};
use obverse_workcell::{Arm, Clock, DigitalIo, Motion, Speed};

/// A pin over a block with a plain hole and one that it snaps into, and a goal in each of them.
const HOLES: &str = r#"
    [arm]
    home_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6]
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
    [[fixture]]
    name = "block"
    place = { taught_at_rad = [3.1, -1.57, 1.56, -1.56, -1.57, -6], xyz_mm = [0, 0, 50] }
    body = [{ cuboid_mm = [90, 60, 60], at = { xyz_mm = [0, 0, 30] } }]
    [[fixture.hole]]
    mouth = { xyz_mm = [-30, 0, 0] }
    diameter_mm = 10.2
    depth_mm = 15
    chamfer_mm = 1
    [[fixture.hole]]
    diameter_mm = 10.1
    depth_mm = 15
    chamfer_mm = 1
    snap = { at_mm = 12, travel_mm = 3, peak_n = 15, hold_n = 25 }
    [contact]
    stiffness_n_per_mm = 60
    stop_force_n = 48
"#;
const OVER: JointConfiguration = JointConfiguration([3.1, -1.57, 1.56, -1.56, -1.57, -6.0]);

fn over_holes(goal: &str) -> Sim {
    let cell = Cell::parse(&format!("{HOLES}\n[[goal]]\nitem = \"pin\"\n{goal}")).expect("a cell");
    let mut sim = Sim::new(&cell, 1);
    sim.set_output(0, true).unwrap();
    sim
}

fn misses(sim: &Sim) -> Vec<Miss> {
    sim.missed_goals().iter().map(|missed| missed.why).collect()
}

#[test]
fn what_is_in_its_hole_must_be_let_go_and_as_deep_as_it_should() {
    let deep = "fixture = \"block\"\nhole = 2\ndepth_mm = [14, 15.1]";
    let mut sim = over_holes(deep);
    assert_eq!(misses(&sim), [Miss::Held]);
    sim.execute(&push(OVER, 0.040, 20.0)).unwrap();
    assert_eq!(misses(&sim), [Miss::Held], "it is in, and in the gripper still");
    sim.set_output(0, false).unwrap();
    assert_eq!(sim.missed_goals(), []);
    // A weak push ends on the lip: in the hole, and not deep enough.
    let mut sim = over_holes(deep);
    sim.execute(&push(OVER, 0.040, 8.0)).unwrap();
    sim.set_output(0, false).unwrap();
    let missed = sim.missed_goals();
    assert!(matches!(missed[0].why, Miss::Depth { is_m, .. } if is_m > 9e-3 && is_m < 12e-3));
    let text = missed[0].to_string();
    let words = "`pin` in hole 2 of `block`: it is 1";
    assert!(
        text.starts_with(words) && text.ends_with("mm deep, and must be 14.00 to 15.10 mm"),
        "{text}"
    );
}

#[test]
fn a_seat_must_hold_what_sits_in_it() {
    let mut sim = over_holes("fixture = \"block\"\nhole = 2\ndepth_mm = [5, 15.1]");
    sim.execute(&push(OVER, 0.040, 8.0)).unwrap();
    sim.set_output(0, false).unwrap();
    assert_eq!(misses(&sim), [Miss::NotSeated], "deep enough, and not snapped in");
}

#[test]
fn what_stands_in_another_hole_is_beside_its_own() {
    let mut sim = over_holes("fixture = \"block\"\nhole = 1\ndepth_mm = [0, 15.1]");
    sim.execute(&push(OVER, 0.040, 20.0)).unwrap();
    sim.set_output(0, false).unwrap();
    let [Miss::Beside { by_m }] = misses(&sim)[..] else { panic!("{:?}", misses(&sim)) };
    assert!((by_m - 0.03).abs() < 1e-3, "{by_m}");
}

#[test]
fn a_place_has_tolerances_and_moves_with_its_fixture() {
    let goal = |within: &str| {
        let goal = "[[goal]]\nitem = \"pin\"\non = \"plate\"\n";
        let place = "place = { taught_at_rad = [0.4, -1.4, 1.6, -1.77, -1.57, 0.3] }\n";
        let plate = "offset = { fixed_mm = [0, 0, 5] }";
        pin_on_plate("", "on = \"plate\"", plate, &format!("{goal}{place}{within}"))
    };
    let near = goal("within_mm = 1\nwithin_deg = 1");
    assert_eq!(Sim::new(&near, 1).missed_goals(), [], "it lies with the plate, which is out");
    let moved_by = |cell: &Cell, by_m: f64| {
        let mut sim = Sim::new(cell, 1);
        sim.set_output(0, true).unwrap();
        sim.execute(&lift(AT_PIN, 0.02)).unwrap();
        sim.execute(&shift(sim.joints(), by_m)).unwrap();
        sim.execute(&Motion { speed: Speed::Slow, ..lift(sim.joints(), -0.02) }).unwrap();
        sim.set_output(0, false).unwrap();
        sim
    };
    let sim = moved_by(&near, 0.004);
    let [Miss::Off { by_m, .. }] = misses(&sim)[..] else { panic!("{:?}", misses(&sim)) };
    assert!((by_m - 0.004).abs() < 1e-5, "{by_m}");
    assert_eq!(moved_by(&goal("within_mm = 5\nwithin_deg = 1"), 0.004).missed_goals(), []);
}

#[test]
fn what_fell_or_is_not_held_misses_its_goal() {
    let goal = "[[goal]]\nitem = \"pin\"\nheld = true\n";
    let mut sim = Sim::new(&pin_on_plate("", "", "", goal), 1);
    assert_eq!(misses(&sim), [Miss::NotHeld]);
    sim.set_output(0, true).unwrap();
    assert_eq!(sim.missed_goals(), []);
    let place = "[[goal]]\nitem = \"pin\"\nplace = {}\nwithin_mm = 1000\nwithin_deg = 180\n";
    let mut sim = Sim::new(&pin_on_plate("", "", "", &format!("{place}[falling]")), 1);
    sim.set_output(0, true).unwrap();
    sim.execute(&lift(AT_PIN, 0.05)).unwrap();
    sim.set_output(0, false).unwrap();
    assert_eq!(misses(&sim), [Miss::Dropped]);
}

/// A feeder brings one part after another under one name.
#[test]
fn a_goal_that_a_part_has_met_stays_met_when_the_next_one_comes() {
    let feeder =
        "[[feeder]]\nname = \"tray\"\nitem = \"pin\"\noutput = 3\nready = true\ndelay_s = 0.1\n";
    let goal = "[[goal]]\nitem = \"pin\"\n\
                place = { taught_at_rad = [0.4, -1.4, 1.6, -1.77, -1.57, 0.3] }\n\
                within_mm = 1\nwithin_deg = 1\n";
    let mut sim = Sim::new(&pin_on_plate("", "", "", &format!("{feeder}{goal}")), 1);
    assert_eq!(sim.missed_goals(), []);
    sim.set_output(3, true).unwrap();
    sim.wait(0.1).unwrap();
    sim.set_output(0, true).unwrap();
    sim.execute(&lift(AT_PIN, 0.05)).unwrap();
    assert_eq!(sim.missed_goals(), [], "the first one is there still");
    // Where the first one was taken away before, nothing is met.
    let mut sim = Sim::new(&pin_on_plate("", "", "", &format!("{feeder}{goal}")), 1);
    sim.set_output(0, true).unwrap();
    sim.execute(&lift(AT_PIN, 0.05)).unwrap();
    sim.set_output(0, false).unwrap();
    sim.set_output(3, true).unwrap();
    assert_eq!(misses(&sim), [Miss::Gone]);
}

#[test]
fn goals_that_cannot_be_are_refused_in_place() {
    let refused = |goal: &str, words: &str, code: CellCode| {
        let text = format!("{HOLES}\n[[goal]]\n{goal}");
        let error = Cell::parse(&text).expect_err(goal);
        assert!(error.message.contains(words), "{goal}: {error}");
        let lines = HOLES.lines().count();
        assert!(error.line > lines && error.code == code, "{goal}: {error}, {:?}", error.code);
    };
    let (unknown, key, not_so) = (CellCode::UnknownName, CellCode::Key, CellCode::Contradiction);
    refused("item = \"peg\"\nheld = true", "no item `peg`", unknown);
    refused("item = \"pin\"", "one of `held = true`, `fixture` and `place`", not_so);
    refused("item = \"pin\"\nheld = false", "one of", not_so);
    refused("item = \"pin\"\nheld = true\nplace = {}", "one of", not_so);
    refused("item = \"pin\"\nheld = true\nwithin_mm = 1", "`within_mm` belongs to", not_so);
    refused("item = \"pin\"\nplace = {}\nwithin_mm = 1", "how near", key);
    let place = "item = \"pin\"\nplace = {}\nwithin_mm = 1\nwithin_deg = 1\n";
    refused(&format!("{place}depth_mm = [1, 2]"), "`depth_mm` belongs to", not_so);
    refused(&format!("{place}on = \"table\""), "no fixture `table`", unknown);
    refused("item = \"pin\"\nfixture = \"table\"", "no fixture `table`", unknown);
    refused("item = \"pin\"\nfixture = \"block\"", "has 2 holes: say `hole`", not_so);
    refused(
        "item = \"pin\"\nfixture = \"block\"\nhole = 0",
        "no hole 0: its holes are 1 to 2",
        unknown,
    );
    refused("item = \"pin\"\nfixture = \"block\"\nhole = 3", "no hole 3", unknown);
    refused("item = \"pin\"\nfixture = \"block\"\nhole = 1", "`depth_mm`", key);
    let hole =
        |depth: &str| format!("item = \"pin\"\nfixture = \"block\"\nhole = 1\ndepth_mm = {depth}");
    refused(&hole("[15, 16]"), "nothing can be 15 to 16 mm deep in a hole of 15 mm", not_so);
    refused(&hole("[9, 8]"), "nothing can be 9 to 8 mm deep", not_so);
    refused(&hole("[9]"), "length", key);
    refused(&format!("{}\nwithin_mm = -1", hole("[8, 9]")), "from 0", CellCode::Range);
    refused(&format!("{}\nnear_mm = 1", hole("[8, 9]")), "near_mm", key);
    let thing = format!(
        "{HOLES}\n[[item]]\nname = \"box\"\nplace = {{}}\n[[goal]]\nitem = \"box\"\n\
                         fixture = \"block\"\nhole = 1\ndepth_mm = [1, 2]"
    );
    let error = Cell::parse(&thing).expect_err("it has no peg");
    assert!(error.message.contains("has no `peg`"), "{error}");
    let many = format!("{HOLES}{}", "\n[[goal]]\nitem = \"pin\"\nheld = true".repeat(1_001));
    assert_eq!(Cell::parse(&many).expect_err("many").code, CellCode::TooMany);
}
