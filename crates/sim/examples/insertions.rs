//! Insertions of a peg as this crate has them, for a comparison with another physics.
//!
//! Reads trials as JSON Lines from the standard input and writes for each, in the same order, how
//! deep the peg came and the greatest force against it. The peg is pushed along its own axis by a
//! hand that gives way about the middle of its rim; it counts from where the axis meets the mouth.

use nalgebra::Vector3;
use obverse_sim::peg::{Fit, Held};
use serde::Deserialize;
use std::io::{self, BufRead, Write};

/// The way between two looks.
const STEP_MM: f64 = 0.01;

/// One trial: the geometry, how the hand gives way, and how the peg is held.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Trial {
    peg_radius_mm: f64,
    peg_chamfer_mm: f64,
    clearance_mm: f64,
    hole_chamfer_mm: f64,
    depth_mm: f64,
    friction: f64,
    axial_n_per_mm: f64,
    lateral_n_per_mm: f64,
    angular_nmm_per_rad: f64,
    force_limit_n: f64,
    /// Where the axis of the peg meets the mouth.
    offset_mm: [f64; 2],
    /// In the direction of x.
    tilt_rad: f64,
}

impl Trial {
    fn fit(&self) -> Fit {
        Fit {
            peg_radius_mm: self.peg_radius_mm,
            peg_chamfer_mm: self.peg_chamfer_mm,
            hole_radius_mm: self.peg_radius_mm + self.clearance_mm,
            hole_chamfer_mm: self.hole_chamfer_mm,
            depth_mm: self.depth_mm + 10.0,
            friction: self.friction,
            stiffness_n_per_mm: self.axial_n_per_mm,
            lateral_n_per_mm: self.lateral_n_per_mm,
            angular_nmm_per_rad: self.angular_nmm_per_rad,
            press_mm: 1.0,
        }
    }

    /// How deep the peg came along its axis, and the greatest force against it.
    fn insert(&self) -> (f64, f64, String) {
        let fit = self.fit();
        let (sin, cos) = libm::sincos(self.tilt_rad);
        let axis = Vector3::new(sin, 0.0, cos);
        let mouth = Vector3::new(self.offset_mm[0], self.offset_mm[1], 0.0);
        let (mut most_n, mut way_mm) = (0.0_f64, -2.0);
        let mut stage = String::new();
        while way_mm < self.depth_mm {
            let contact = fit.contact(&Held { tip_mm: mouth + axis * way_mm, axis });
            stage = format!("{:?}", contact.stage);
            most_n = most_n.max(contact.axial_n);
            if contact.axial_n > self.force_limit_n {
                break;
            }
            way_mm += STEP_MM;
        }
        (way_mm, most_n, stage)
    }
}

fn main() -> io::Result<()> {
    let (input, mut output) = (io::stdin().lock(), io::stdout().lock());
    for line in input.lines() {
        let trial: Trial = serde_json::from_str(&line?)?;
        let (way_mm, most_n, stage) = trial.insert();
        let inserted = way_mm >= trial.depth_mm;
        let report = serde_json::json!({
            "inserted": inserted, "depth_mm": way_mm, "force_n": most_n, "stage": stage,
        });
        writeln!(output, "{report}")?;
    }
    Ok(())
}
