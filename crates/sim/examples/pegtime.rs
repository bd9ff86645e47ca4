use nalgebra::Vector3;
use obverse_sim::peg::*;
use std::time::Instant;
fn main() {
    let fit = Fit {
        peg_radius_mm: 10.0,
        peg_chamfer_mm: 0.5,
        hole_radius_mm: 10.1,
        hole_chamfer_mm: 1.0,
        depth_mm: 60.0,
        friction: 0.15,
        stiffness_n_per_mm: 50.0,
        lateral_n_per_mm: 8.0,
        angular_nmm_per_rad: 115000.0,
        press_mm: 1.0,
    };
    for (ox, oy, tilt) in [
        (0.0, 0.0, 0.0),
        (0.3, 0.2, 0.0),
        (0.3, 0.2, 0.002),
        (0.05, 0.02, 0.002),
        (0.3, -0.2, 0.004),
    ] {
        let a = Vector3::new(f64::sin(tilt) * 0.6, f64::sin(tilt) * 0.8, f64::cos(tilt));
        let t = Instant::now();
        let n = 200000;
        let mut acc = 0.0;
        for i in 0..n {
            let z = 2.0 + 55.0 * (i as f64 / n as f64);
            let h = Held { tip_mm: Vector3::new(ox, oy, 0.0) + a * z, axis: a };
            acc += fit.contact(&h).axial_n;
        }
        println!("{ox} {oy} {tilt}: {:?} {acc}", t.elapsed() / n);
    }
}
