//! What a workcell file may say, and how it is told that it may not.

use super::*;
use obverse_geometry::tolerance::same_pose;

const LEAST: &str = "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n";

fn error(more: &str) -> CellError {
    Cell::parse(&format!("{LEAST}{more}")).expect_err(more)
}

/// Where the error is in the text after [`LEAST`], and that its message says a word.
fn expect(more: &str, line: usize, column: usize, word: &str) {
    let error = error(more);
    assert_eq!((error.line, error.column), (line + 2, column), "{error}");
    assert!(error.message.contains(word), "{error}");
}

#[test]
fn the_least_cell_has_an_arm_and_defaults() {
    let cell = Cell::parse(LEAST).unwrap();
    assert_eq!(cell.arm.home.0, [0.0, -1.5, 1.5, 0.0, 0.0, 0.0]);
    assert_eq!(cell.arm.limits_rad, [(-TAU, TAU); 6]);
    assert_eq!(cell.speeds, DEFAULT_SPEEDS);
    assert_eq!((cell.output_count, cell.inputs.len(), cell.tools.len()), (8, 8, 1));
    assert_eq!((cell.items.len(), cell.fixtures.len(), cell.gripper), (0, 0, None));
}

#[test]
fn units_become_metres_radians_and_newtons() {
    let cell = Cell::parse(&format!(
        "{LEAST}
        [speed]
        slow = {{ tool_mm_per_s = 20, joint_deg_per_s = 90 }}
        [contact]
        stiffness_n_per_mm = 60
        [[tool]]
        name = \"hand\"
        tcp = {{ xyz_mm = [0, 0, 100], rotation_vector_deg = [0, 90, 0] }}
        body = [{{ cylinder = {{ diameter_mm = 20, length_mm = 50 }} }}]
        "
    ))
    .unwrap();
    assert_eq!(cell.speeds[1].tool_m_per_s, 0.02);
    assert_eq!(cell.speeds[1].joint_rad_per_s, PI / 2.0);
    assert_eq!(cell.speeds[0], DEFAULT_SPEEDS[0]);
    assert_eq!(cell.contact.stiffness_n_per_m, 60_000.0);
    let expected = Pose::from_rotation_vector([0.0, 0.0, 0.1], [0.0, PI / 2.0, 0.0]);
    assert!(same_pose(&cell.tools[0].tcp, &expected));
    let Shape::Cylinder { diameter_m, length_m } = cell.tools[0].parts[0].shape else {
        panic!("not a cylinder");
    };
    assert_eq!((diameter_m, length_m), (0.02, 0.05));
}

#[test]
fn what_was_taught_lies_where_the_gripper_grasps_it() {
    let cell = Cell::parse(&format!(
        "{LEAST}
        [[tool]]
        name = \"hand\"
        tcp = {{ xyz_mm = [0, 0, 100] }}
        [gripper]
        output = 0
        near_mm = 1
        near_deg = 1
        [[item]]
        name = \"part\"
        place = {{ taught_at_rad = [0.1, -1.2, 1.5, 0.2, 0.3, 0.4] }}
        grasp = {{ xyz_mm = [0, 10, -20], rotation_vector_deg = [0, 0, 45] }}
        "
    ))
    .unwrap();
    let joints = JointConfiguration([0.1, -1.2, 1.5, 0.2, 0.3, 0.4]);
    let tcp = crate::kinematics::forward(&joints).compose(&cell.tools[0].tcp);
    assert!(same_pose(&cell.items[0].pose.compose(&cell.items[0].grasp), &tcp));
}

#[test]
fn keys_that_mean_nothing_are_refused_in_place() {
    expect("colour = 1", 1, 1, "colour");
    expect("[contact]\nfriction = 0.1\nfrictoin = 0.1", 3, 1, "frictoin");
    expect("[[item]]\nname = \"a\"\nplace = { xyz_mm = [0, 0, 0], z = 1 }", 3, 31, "z");
}

#[test]
fn numbers_out_of_range_are_refused_in_place() {
    expect("[contact]\nfriction = 1.5", 2, 12, "coefficient of friction");
    expect("[contact]\nfriction = nan", 2, 12, "NaN");
    expect("[force_sensor]\nnoise_n = -1", 2, 11, "from 0");
    expect("[force_sensor]\nsample_s = inf", 2, 12, "sampling time");
    expect("[force_sensor]\nwindow = 0", 2, 10, "1 to 1000");
    expect("[outputs]\ncount = 70000", 2, 9, "70000");
    expect("[outputs]\ncount = 2000", 2, 9, "at most 1024");
    let body = "[[fixture]]\nname = \"f\"\nplace = {}\nbody = [{ cuboid_mm = [1, -2, 3] }]";
    expect(body, 4, 23, "a size in mm");
    let spread = "[[item]]\nname = \"i\"\nplace = {}\noffset = { normal_mm = [0, -1, 0] }";
    expect(spread, 4, 24, "a spread in mm");
}

#[test]
fn limits_must_be_ranges_that_hold_the_home() {
    let limits = |first: &str| {
        let others = "[-360, 360], [-360, 360], [-360, 360], [-360, 360], [-360, 360]";
        format!("[arm]\nhome_rad = [0, 0, 0, 0, 0, 0]\nlimits_deg = [{first}, {others}]")
    };
    assert!(Cell::parse(&limits("[-10, 10]")).is_ok());
    let reversed = Cell::parse(&limits("[10, -10]")).unwrap_err();
    assert_eq!((reversed.line, reversed.column), (3, 15), "{reversed}");
    let outside = Cell::parse(&limits("[5, 10]")).unwrap_err();
    assert_eq!((outside.line, outside.column), (2, 12), "{outside}");
    assert!(outside.message.contains("joint 1"), "{outside}");
}

#[test]
fn names_are_unique_and_of_a_reasonable_length() {
    let item = |name: &str| format!("[[item]]\nname = \"{name}\"\nplace = {{}}\n");
    expect(&(item("a") + &item("a")), 5, 8, "taken");
    expect(&item(""), 2, 8, "1 to 64");
    expect(&item(&"x".repeat(65)), 2, 8, "65");
}

#[test]
fn what_is_named_must_be_there() {
    let gripper = "[gripper]\ntool = \"hand\"\noutput = 0\nnear_mm = 1\nnear_deg = 1";
    expect(gripper, 2, 8, "no tool `hand`");
    expect("[gripper]\noutput = 8\nnear_mm = 1\nnear_deg = 1", 2, 10, "no output 8");
    let rule = |rule: &str| format!("[inputs]\ncount = 2\nrule = [\n{rule}\n]");
    expect(&rule("{ input = 2, level = \"low\" }"), 4, 11, "no input 2");
    expect(&rule("{ input = 0, follows_output = 9 }"), 4, 31, "no output 9");
}

#[test]
fn an_input_has_one_rule_of_one_kind() {
    let rule = |rule: &str| format!("[inputs]\ncount = 2\nrule = [\n{rule}\n]");
    expect(&rule("{ input = 0 }"), 4, 11, "one of");
    expect(&rule("{ input = 0, level = \"low\", holding = true }"), 4, 11, "one of");
    expect(&rule("{ input = 0, holding = true, delay_s = 1 }"), 4, 40, "delay");
    let twice = "{ input = 0, holding = true },\n{ input = 0, holding = true }";
    expect(&rule(twice), 5, 11, "already");
    let back = "{ at_s = 2, level = \"high\" }, { at_s = 1, level = \"low\" }";
    let changes = format!("{{ input = 0, changes = [{back}] }}");
    expect(&rule(&changes), 4, 64, "increase");
}

#[test]
fn a_part_is_a_box_or_a_cylinder() {
    let part = |part: &str| format!("[[fixture]]\nname = \"f\"\nplace = {{}}\nbody = [{part}]");
    expect(&part("{}"), 4, 9, "one of");
    let both = "{ cuboid_mm = [1, 1, 1], cylinder = { diameter_mm = 1, length_mm = 1 } }";
    expect(&part(both), 4, 9, "one of");
    let many = "{ cuboid_mm = [1, 1, 1] }, ".repeat(65);
    let error = error(&part(&many));
    assert!(error.message.contains("at most 64"), "{error}");
}

#[test]
fn a_hole_is_drilled_straight_into_a_face() {
    let hole = |hole: &str| {
        format!(
            "[[fixture]]\nname = \"f\"\nplace = {{}}\nbody = [{{ cuboid_mm = [50, 50, 40] }}]\n\
             hole = [{hole}]"
        )
    };
    let down = "rotation_vector_deg = [180, 0, 0]";
    let parse = |text: &str| Cell::parse(&format!("{LEAST}{}", hole(text)));
    let good =
        format!("{{ mouth = {{ xyz_mm = [0, 0, 20], {down} }}, diameter_mm = 20, depth_mm = 30 }}");
    assert_eq!(parse(&good).unwrap().fixtures[0].holes[0].part, 0);
    for bad in [
        // In the air, the wrong way round, through the part, too near to the edge, slanted.
        good.replace("[0, 0, 20]", "[0, 0, 21]"),
        good.replace("180", "0"),
        good.replace("depth_mm = 30", "depth_mm = 40"),
        good.replace("[0, 0, 20]", "[16, 0, 20]"),
        good.replace("180", "175"),
    ] {
        let error = parse(&bad).expect_err(&bad);
        assert_eq!((error.line, error.column), (7, 9), "{error}");
    }
}

#[test]
fn a_peg_keeps_some_of_its_end() {
    let peg = "[[item]]\nname = \"p\"\nplace = {}\n\
               peg = { diameter_mm = 10, length_mm = 30, chamfer_mm = 5 }";
    expect(peg, 4, 56, "the whole tip");
}

#[test]
fn the_stop_force_is_within_what_bodies_give() {
    expect("[contact]\nstiffness_n_per_mm = 10\nstop_force_n = 20", 3, 16, "8 N");
    let soft = format!("{LEAST}[contact]\nstiffness_n_per_mm = 10");
    assert_eq!(Cell::parse(&soft).unwrap().contact.stop_force_n, 8.0);
}

#[test]
fn hostile_files_are_refused_without_harm() {
    assert!(Cell::parse(&"#".repeat(FILE_BYTES_MAX + 1)).is_err());
    assert!(Cell::parse(&format!("x = {}", "[".repeat(100_000))).is_err());
    assert!(Cell::parse(&format!("x = {}", "{a=".repeat(100_000))).is_err());
    for text in ["", "\u{0}", "[arm", "arm = 1", "[arm]\nhome_rad = [1]", "[arm]\nhome_rad = 'é"] {
        let error = Cell::parse(text).expect_err(text);
        assert!(error.line >= 1 && error.column >= 1);
    }
    let items: String = (0..1_001)
        .map(|number| format!("[[item]]\nname = \"i{number}\"\nplace = {{}}\n"))
        .collect();
    assert!(error(&items).message.contains("at most 1000"));
}

#[test]
fn columns_count_characters() {
    expect("[[item]]\nname = \"é\" # é\nplace = { xyz_mm = [\"ü\", 0, 0] }", 3, 21, "invalid");
}

/// A cell with something of everything, and `more` lines behind it.
fn expect_with(more: &str, column: usize, word: &str) {
    let item = "[[item]]\nname = \"pin\"\nplace = {}\n";
    let line = item.lines().count() + more.lines().count();
    expect(&format!("{item}{more}"), line, column, word);
}

const GRIPPER: &str = "[gripper]\noutput = 0\nnear_mm = 1\nnear_deg = 1\n";
const FEEDER: &str = "[[feeder]]\nname = \"tray\"\nitem = \"pin\"\noutput = 3\n";

#[test]
fn probabilities_and_spreads_out_of_range_are_refused_in_place() {
    expect("[chance]\nstops_short = 1.01", 2, 15, "a probability");
    expect("[chance]\nprotective_stop = -0.1", 2, 19, "from 0 to 1");
    expect("[chance]\nemergency_stop = nan", 2, 18, "NaN");
    expect("[chance]\nfire = 0.1", 2, 1, "fire");
    expect("[falling]\nknock_n = 0", 2, 11, "force limit");
    expect("[falling]\nsupport_mm = inf", 2, 14, "a distance");
    expect("[force_sensor]\nbias_normal_n = -1", 2, 17, "a force");
    expect_with(&format!("{FEEDER}empty = 2"), 9, "a probability");
    expect_with(&format!("{FEEDER}parts = -1"), 9, "-1");
    let spread = "grasp_offset = { normal_mm = [0, -1, 0] }";
    expect_with(&format!("{GRIPPER}{spread}"), 30, "a spread in mm");
    expect("[outputs]\ncount = 2\nstick = [{ output = 1 }]", 3, 10, "probability");
}

#[test]
fn chances_that_end_a_motion_are_one_at_most() {
    let chance = "[chance]\nstops_short = 0.5\nprotective_stop = 0.4\nemergency_stop = ";
    assert!(Cell::parse(&format!("{LEAST}{chance}0.1")).is_ok());
    expect(&format!("{chance}0.2"), 1, 1, "add up to 1.1000");
    let thirds = "[chance]\nstops_short = 0.1\nprotective_stop = 0.2\nemergency_stop = 0.7";
    assert!(Cell::parse(&format!("{LEAST}{thirds}")).is_ok(), "0.1 + 0.2 + 0.7 > 1 in binary");
}

#[test]
fn what_the_reader_says_of_a_value_names_its_key() {
    let place = "[[fixture]]\nname = \"f\"\nplace = { xyz_mm = [0, 0] }";
    expect(place, 3, 20, "`xyz_mm`: ");
    let body = "[[fixture]]\nname = \"f\"\nplace = {}\nbody = [{ cuboid_mm = [1, -2, 3] }]";
    expect(body, 4, 23, "`cuboid_mm`: -2");
    expect("[outputs]\ncount = \"many\"", 2, 9, "`count`: ");
    let unknown = error("[contact]\nfriction = 0.1\nfrictoin = 0.1");
    assert!(unknown.message.starts_with("unknown field `frictoin`"), "{unknown}");
}

/// Two fixtures of which the second is moved from where it only touches the first.
#[test]
fn fixtures_touch_and_do_not_overlap() {
    let fixtures = |body: &str, place: &str| {
        format!(
            "[[fixture]]\nname = \"table\"\nplace = {{ xyz_mm = [400, 0, -20] }}\n\
             body = [{{ cuboid_mm = [800, 800, 40] }}]\n\
             [[fixture]]\nname = \"nest\"\nplace = {{ xyz_mm = {place} }}\nbody = [{body}]"
        )
    };
    let parse = |text: &str| Cell::parse(&format!("{LEAST}{text}"));
    let bodies =
        ["{ cuboid_mm = [60, 60, 20] }", "{ cylinder = { diameter_mm = 60, length_mm = 20 } }"];
    for body in bodies {
        for apart in ["[300, 0, 10]", "[830, 0, -20]", "[300, 0, 500]", "[300, -430, -10]"] {
            assert!(parse(&fixtures(body, apart)).is_ok(), "{body} at {apart}");
        }
        for within in ["[300, 0, 9.9]", "[829, 0, -20]", "[300, 0, -20]", "[400, 0, -20]"] {
            let error = parse(&fixtures(body, within)).expect_err(within);
            assert_eq!((error.line, error.column, error.code), (8, 8, CellCode::Overlap));
            assert!(error.message.contains("`table` and `nest` overlap"), "{error}");
        }
    }
    // The parts of one body may.
    let both = "{ cuboid_mm = [60, 60, 20] }, { cuboid_mm = [20, 90, 20] }";
    assert!(parse(&fixtures(both, "[300, 0, 10]")).is_ok());
}

#[test]
fn holes_do_not_run_into_each_other() {
    let holes = |second: &str| {
        format!(
            "[[fixture]]\nname = \"f\"\nplace = {{ xyz_mm = [400, 0, 0] }}\n\
             body = [{{ cuboid_mm = [50, 50, 40], at = {{ xyz_mm = [0, 0, 20] }} }}]\n\
             hole = [\n{{ diameter_mm = 10, depth_mm = 30 }},\n\
             {{ mouth = {{ {second} }}, diameter_mm = 8, depth_mm = 22 }},\n]"
        )
    };
    let beside = "xyz_mm = [25, 0, 35], rotation_vector_deg = [0, -90, 0]";
    for good in ["xyz_mm = [9, 0, 0]", beside] {
        let parsed = Cell::parse(&format!("{LEAST}{}", holes(good)));
        assert!(parsed.is_ok(), "{good}: {parsed:?}");
    }
    for bad in ["xyz_mm = [8, 0, 0]", "xyz_mm = [0, 0, 0]", &beside.replace("35", "20")] {
        let error = error(&holes(bad));
        let place = (error.line, error.column, error.code);
        assert_eq!(place, (9, 1, CellCode::Overlap), "{bad}: {error}");
        assert!(error.message.contains("`hole` 1 and 2 of `f`"), "{error}");
    }
}

/// A block with a hole on a table, a tool, and items by their texts.
fn block_and(items: &str) -> String {
    format!(
        "[[tool]]\nname = \"hand\"\ntcp = {{ xyz_mm = [0, 0, 100] }}\n\
         body = [{{ cuboid_mm = [60, 60, 80], at = {{ xyz_mm = [0, 0, 40] }} }}]\n\
         [gripper]\ntool = \"hand\"\noutput = 0\nnear_mm = 5\nnear_deg = 10\n\
         [[fixture]]\nname = \"table\"\nplace = {{ xyz_mm = [400, 0, -20] }}\n\
         body = [{{ cuboid_mm = [800, 800, 40] }}]\n\
         [[fixture]]\nname = \"block\"\n\
         place = {{ xyz_mm = [400, 0, 50], rotation_vector_deg = [180, 0, 0] }}\n\
         body = [{{ cuboid_mm = [80, 80, 50], at = {{ xyz_mm = [0, 0, 25] }} }}]\n\
         hole = [{{ diameter_mm = 10.1, depth_mm = 40 }}]\n{items}"
    )
}

fn item(name: &str, place: &str, body: &str) -> String {
    format!("[[item]]\nname = \"{name}\"\nplace = {{ {place} }}\n{body}\n")
}

#[test]
fn an_item_lies_on_things_and_in_holes_and_not_in_a_fixture() {
    let peg = "peg = { diameter_mm = 10, length_mm = 60, chamfer_mm = 0 }";
    let fat = "peg = { diameter_mm = 14, length_mm = 60, chamfer_mm = 0 }";
    let pin = "body = [{ cylinder = { diameter_mm = 10, length_mm = 60 } }]";
    let bar = "body = [{ cuboid_mm = [6, 7, 60] }]";
    let down = "rotation_vector_deg = [180, 0, 0]";
    let at = |place: &str, body: &str| {
        Cell::parse(&format!("{LEAST}{}", block_and(&item("pin", place, body))))
    };
    for (xyz, body) in [
        ("[200, 0, 30]", peg),
        ("[200, 0, 29.6]", peg),
        // In the hole, to its bottom, and a body that is no peg.
        ("[400, 0, 60]", peg),
        ("[400, 0, 40]", peg),
        ("[400, 0, 40]", pin),
        ("[400, 0, 45]", bar),
        ("[400, 0, 80]", fat),
    ] {
        let parsed = at(&format!("xyz_mm = {xyz}, {down}"), body);
        assert!(parsed.is_ok(), "{xyz}, {body}: {parsed:?}");
    }
    for (xyz, body, of) in [
        ("[200, 0, 20]", peg, "table"),
        ("[200, 0, -20]", peg, "table"),
        ("[420, 0, 60]", peg, "block"),
        ("[400, 0, 35]", peg, "block"),
        ("[400, 0, 70]", fat, "block"),
        ("[200, 0, 20]", pin, "table"),
    ] {
        let error = at(&format!("xyz_mm = {xyz}, {down}"), body).expect_err(xyz);
        assert_eq!((error.line, error.column, error.code), (22, 8, CellCode::Overlap), "{error}");
        let said = format!("the item `pin` is in the fixture `{of}`");
        assert!(error.message.starts_with(&said), "{xyz}: {error}");
    }
}

#[test]
fn two_items_are_not_in_one_place_unless_a_feeder_brings_one() {
    let body = "body = [{ cuboid_mm = [20, 20, 20] }]";
    let two = |second: &str, more: &str| {
        let items = item("a", "xyz_mm = [200, 100, 10]", body) + &item("b", second, body);
        Cell::parse(&format!("{LEAST}{}{more}", block_and(&items)))
    };
    assert!(two("xyz_mm = [220, 100, 10]", "").is_ok(), "they touch");
    assert!(two("xyz_mm = [200, 100, 30]", "").is_ok(), "one lies on the other");
    for within in ["[200, 100, 10]", "[210, 100, 10]", "[205, 105, 25]"] {
        let error = two(&format!("xyz_mm = {within}"), "").expect_err(within);
        assert_eq!((error.line, error.code), (26, CellCode::Overlap), "{error}");
        assert!(error.message.starts_with("the item `b` is in the item `a`"), "{error}");
    }
    let feeder = "[[feeder]]\nname = \"chute\"\nitem = \"b\"\noutput = 1\n";
    let same = "xyz_mm = [200, 100, 10]";
    assert!(two(same, feeder).is_ok(), "it is not there yet");
    assert!(two(same, &format!("{feeder}ready = true\n")).is_err(), "it is there");
}

#[test]
fn the_arm_is_free_at_home() {
    let wall = |name: &str, xyz: &str| {
        format!(
            "[[fixture]]\nname = \"{name}\"\nplace = {{ xyz_mm = {xyz} }}\n\
             body = [{{ cuboid_mm = [100, 600, 100] }}]\n"
        )
    };
    // At home the arm reaches to about (-0.42, -0.19, 0.42), from a shoulder at 0.09 over the base.
    for (xyz, of) in [
        ("[-250, 0, 520]", "the forearm of the arm"),
        ("[0, 0, 300]", "the upper arm of the arm"),
        ("[0, 0, 60]", "the shoulder of the arm"),
    ] {
        let error = error(&wall("wall", xyz));
        assert_eq!((error.line, error.column, error.code), (2, 12, CellCode::Overlap), "{error}");
        let said = format!("at home {of} is in the fixture `wall`");
        assert!(error.message.starts_with(&said), "{error}");
    }
    assert!(Cell::parse(&format!("{LEAST}{}", wall("wall", "[0, 0, -50]"))).is_ok());
    // The tool in an item; and not in the one that it could grip.
    let home = crate::kinematics::forward(&Cell::parse(LEAST).unwrap().arm.home);
    let ahead = |mm: f64| home.translation_m + home.rotation.column(2) * (mm * 1e-3);
    let at = |mm: f64| {
        let [x, y, z]: [f64; 3] = (ahead(mm) * 1e3).into();
        let turn = home.rotation_vector_rad().map(f64::to_degrees);
        format!("xyz_mm = [{x}, {y}, {z}], rotation_vector_deg = {turn:?}")
    };
    let body = "body = [{ cuboid_mm = [20, 20, 60] }]";
    let with = |mm: f64| format!("{LEAST}{}", block_and(&item("part", &at(mm), body)));
    let error = Cell::parse(&with(60.0)).expect_err("the tool is in it");
    let said = "at home the tool `hand` is in the item `part`";
    assert!(error.message.starts_with(said), "{error}");
    assert!(Cell::parse(&with(100.0)).is_ok(), "it is in the gripper");
    assert!(Cell::parse(&with(200.0)).is_ok(), "it is out of the way");
}

/// A thousand fixtures of many parts, all in one stripe.
#[test]
fn looking_for_what_overlaps_ends() {
    let parts = "{cuboid_mm=[9,9,1]},".repeat(40);
    let fixture = |number: usize| {
        let place = format!("{{xyz_mm=[900,0,{}]}}", number * 2);
        format!("[[fixture]]\nname=\"{number}\"\nplace={place}\nbody=[{parts}]\n")
    };
    let text: String = (0..1000).map(fixture).collect();
    assert!(Cell::parse(&format!("{LEAST}{text}")).is_ok());
}

#[test]
fn a_slip_is_of_something() {
    let slip = |slip: &str| format!("{GRIPPER}slip = {slip}");
    expect_with(&slip("{ probability = 0.1 }"), 8, "`offset`");
    expect_with(&slip("{ fast = 0.1, lost = 1 }"), 17, "`fast_mm_per_s`");
    expect_with(&slip("{ fast_mm_per_s = 10, lost = 1 }"), 26, "`fast`");
    expect_with(&slip("{ contact_n = 10, lost = 1 }"), 22, "`in_contact`");
}

#[test]
fn a_feeder_presents_an_item_on_lines_that_are_there() {
    let of = |from: &str, to: &str| FEEDER.replace(from, to);
    let error = error(&of("\"pin\"", "\"nut\""));
    assert!(error.message.contains("no item `nut`"), "{error}");
    expect_with(&of("output = 3", "output = 9"), 10, "no output 9");
    expect_with(&format!("{FEEDER}input = 8"), 9, "no input 8");
    expect_with(&format!("{FEEDER}askew = 0.1"), 9, "`askew_offset`");
    let ruled = "[inputs]\ncount = 2\nrule = [{ input = 1, level = \"low\" }]\n";
    expect_with(&format!("{ruled}{FEEDER}input = 1"), 9, "has a rule");
    let twice = format!("{FEEDER}{}", of("tray", "box"));
    let message = Cell::parse(&format!("{LEAST}[[item]]\nname = \"pin\"\nplace = {{}}\n{twice}"));
    assert!(message.unwrap_err().message.contains("another feeder presents `pin`"));
}

#[test]
fn wires_are_flawed_once() {
    let stick = "stick = [{ output = 0, probability = 0.1 }, { output = 0, probability = 0.2 }]";
    expect(&format!("[outputs]\ncount = 1\n{stick}"), 3, 56, "twice");
    let stick = "stick = [{ input = 0, probability = 0.1 }, { input = 0, probability = 0.2 }]";
    expect(&format!("[inputs]\ncount = 1\n{stick}"), 3, 54, "twice");
    let bounce = "bounce = [{ input = 0, for_s = 0.1 }, { input = 0, for_s = 0.2 }]";
    expect(&format!("[inputs]\ncount = 1\n{bounce}"), 3, 49, "twice");
    expect("[inputs]\ncount = 1\nbounce = [{ input = 1, for_s = 1 }]", 3, 21, "no input 1");
}

#[test]
fn nothing_stands_on_itself_or_on_what_is_not_there() {
    let fixture = |name: &str, on: &str| {
        format!("[[fixture]]\nname = \"{name}\"\non = \"{on}\"\nplace = {{}}\n")
    };
    expect(&fixture("a", "a"), 3, 6, "no fixture `a` before this");
    expect(&(fixture("a", "b") + &fixture("b", "a")), 3, 6, "no fixture `b` before this");
    expect("[[item]]\nname = \"i\"\non = \"a\"\nplace = {}", 3, 6, "no fixture `a`");
}

#[test]
fn what_stands_on_a_fixture_is_placed_in_its_frame() {
    let cell = Cell::parse(&format!(
        "{LEAST}
        [[fixture]]
        name = \"pallet\"
        place = {{ xyz_mm = [500, 0, 0], rotation_vector_deg = [0, 0, 90] }}
        [[fixture]]
        name = \"nest\"
        on = \"pallet\"
        place = {{ xyz_mm = [100, 0, 0] }}
        [[item]]
        name = \"pin\"
        on = \"nest\"
        place = {{ xyz_mm = [0, 10, 50] }}
        [[item]]
        name = \"taught\"
        on = \"nest\"
        place = {{ taught_at_rad = [0, -1.5, 1.5, 0, 0, 0] }}
        "
    ))
    .unwrap();
    let at = |item: usize| cell.items[item].pose.translation_m;
    let expected = nalgebra::Vector3::new(0.49, 0.1, 0.05);
    assert!((at(0) - expected).norm() < 1e-12, "{}", at(0));
    let taught = crate::kinematics::forward(&cell.arm.home);
    assert!(same_pose(&cell.items[1].pose, &taught));
}

#[test]
fn the_examples_of_the_pages_are_what_they_say() {
    for code in CellCode::ALL.iter().filter(|code| code.as_str().starts_with("C01")) {
        let wrong = Cell::parse(code.page().wrong).expect_err(code.as_str());
        assert_eq!(wrong.code, *code, "{wrong}");
        let right = Cell::parse(code.page().right);
        assert!(right.is_ok(), "{}: {right:?}", code.as_str());
    }
    assert!(CellCode::ALL.iter().map(|code| code.as_str()).is_sorted_by(|a, b| a < b));
}
