//! An action whose body is made by Rust: a search on a round spiral, whose points the language
//! cannot compute, as it knows neither roots nor angles' sines.
//!
//! What is made is text of the language, statement by statement. So it is checked and lowered as
//! any other, is read at the places that a run shows, and goes back like any other code. Knows
//! nothing of how that is done.

use std::f64::consts::PI;
use std::fmt::Write;
use std::sync::LazyLock;

/// The most points that are searched.
const POINTS: u32 = 24;
/// The angle between two points of a spiral that fills a circle evenly (Vogel 1979), in radians.
const GOLDEN_ANGLE_RAD: f64 = PI * (3.0 - 2.236_067_977_499_79);

const HEAD: &str = "\
// `insert_with_round_search`: feels for the hole in the direction of the tool, first where it is
// and then on a round spiral about it that fills a circle evenly; where what is held goes in as far
// as `entry`, pushes it home.
//
// It needs nothing of the program but that the item is in the gripper, in front of the hole. Its
// body is made by Rust, from the points of the spiral. Class: after forward; going back the item is
// drawn out, and nothing is felt for.

error round_failed {
  recover by reversing learned up to 8 actions, perturbed 0.5 mm
  otherwise operator
  then return to action
}

var round_depth = 20 mm
var round_entry = 10 mm
var round_force = 8 N

advanced move round_feel {
  distance round_entry forward in tcp
  stop if force > round_force
  speed very slow
  succeeds if distance > 0.95 * round_entry
  on success { return to initial position }
  on failure { return to initial position }
}

advanced move round_push {
  distance round_depth forward in tcp
  stop if force > round_force
  speed slow
  succeeds if distance > 0.95 * round_depth
  on failure { throw round_failed }
}

// The point of a number is the root of that many times `pitch` from the middle.
action insert_with_round_search(depth: length in 1 mm to 200 mm = 20 mm,
    entry: length in 0.5 mm to 100 mm = 10 mm, force_limit: force in 1 N to 60 N = 8 N,
    pitch: length in 0.05 mm to 3 mm = 0.4 mm, points: int in 0 to 24 = 12) {
  round_depth = depth
  round_entry = entry
  round_force = force_limit
  skip in reverse { advance round_feel }
  // The last motion is the way back, which is as long.
  var is_found = distance > 0.95 * entry
";

const END: &str = "  requires is_found else throw round_failed
  advance round_push
}
";

/// The text of the file.
pub(super) fn text() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(|| format!("{HEAD}{}{END}", search()));
    &TEXT
}

/// Statements that go from point to point until the hole is found.
fn search() -> String {
    let mut statements = String::new();
    for number in 1..=POINTS {
        let [to, from] = [number, number - 1].map(point);
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        // Writing to a text cannot fail.
        let _ = write!(
            statements,
            "  if not is_found and points >= {number} {{
    move {x:.4} * pitch x in tcp
    move {y:.4} * pitch y in tcp
    skip in reverse {{ advance round_feel }}
    is_found = distance > 0.95 * entry
  }}
"
        );
    }
    statements
}

/// The point of a number, in pitches from the middle.
fn point(number: u32) -> [f64; 2] {
    let (radius, angle) = (libm::sqrt(f64::from(number)), f64::from(number) * GOLDEN_ANGLE_RAD);
    [radius * libm::cos(angle), radius * libm::sin(angle)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_apart_and_fill_a_circle() {
        let points: Vec<[f64; 2]> = (0..=POINTS).map(point).collect();
        let far = |a: &[f64; 2], b: &[f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
        for (index, one) in points.iter().enumerate() {
            let others = points.iter().enumerate().filter(|(other, _)| *other != index);
            let nearest = others.map(|(_, other)| far(one, other)).fold(f64::INFINITY, f64::min);
            assert!((0.9..2.0).contains(&nearest), "point {index}: {nearest}");
        }
    }
}
