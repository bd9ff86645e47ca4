//! The forward kinematics of this crate, for a comparison with another library.
//!
//! Reads six joint angles in radians a line, as a JSON array, and writes for each the pose of the
//! tool mount in the base frame: the rotation by rows, and the position in metres.

use obverse_geometry::JointConfiguration;
use obverse_sim::kinematics::forward;
use std::io::{self, BufRead, Write};

fn main() -> io::Result<()> {
    let (input, mut output) = (io::stdin().lock(), io::stdout().lock());
    for line in input.lines() {
        let joints: [f64; 6] = serde_json::from_str(&line?)?;
        let mount = forward(&JointConfiguration(joints));
        let row = |row: usize| [0, 1, 2].map(|column| mount.rotation[(row, column)]);
        let position_m: [f64; 3] = mount.translation_m.into();
        let report = serde_json::json!({
            "rotation": [row(0), row(1), row(2)],
            "position_m": position_m,
        });
        writeln!(output, "{report}")?;
    }
    Ok(())
}
