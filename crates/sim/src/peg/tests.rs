//! The stages of an insertion and where they change, against closed forms and brute force.

use super::*;
use crate::random::{Stream, signed, unit};

/// A peg of 20 mm with a chamfer of 0.5 mm over a hole of 20.2 mm with one of 1 mm, 60 mm deep.
const FIT: Fit = Fit {
    peg_radius_mm: 10.0,
    peg_chamfer_mm: 0.5,
    hole_radius_mm: 10.1,
    hole_chamfer_mm: 1.0,
    depth_mm: 60.0,
    friction: 0.2,
    stiffness_n_per_mm: 50.0,
    lateral_n_per_mm: 8.0,
    angular_nmm_per_rad: 100_000.0,
    press_mm: 1.0,
};

/// Upright, offset along x, the end at a depth.
fn upright(offset_mm: f64, depth_mm: f64) -> Held {
    Held { tip_mm: Vector3::new(offset_mm, 0.0, depth_mm), axis: Vector3::z() }
}

/// Tilted about the middle of the mouth, so that the side passes it centred.
fn tilted(tilt_rad: f64, depth_mm: f64) -> Held {
    let (sin, cos) = libm::sincos(tilt_rad);
    Held {
        tip_mm: Vector3::new(sin, 0.0, cos) * (depth_mm / cos),
        axis: Vector3::new(sin, 0.0, cos),
    }
}

#[test]
fn a_centred_peg_goes_to_the_bottom_without_force() {
    assert_eq!(FIT.contact(&upright(0.0, -0.001)).stage, Stage::Above);
    for depth in 1..=60 {
        let contact = FIT.contact(&upright(0.0, f64::from(depth)));
        assert_eq!((contact.stage, contact.axial_n), (Stage::Free, 0.0), "at {depth} mm");
    }
    let bottom = FIT.contact(&upright(0.0, 60.1));
    assert_eq!(bottom.stage, Stage::Bottom);
    assert!((bottom.axial_n - 5.0).abs() < 1e-9, "{bottom:?}");
}

#[test]
fn an_offset_beyond_clearance_and_chamfers_lands_on_the_face() {
    // 0.1 mm of clearance and 1.5 mm of chamfers.
    let landed = FIT.contact(&upright(1.601, 0.1));
    assert_eq!(landed.stage, Stage::Face);
    assert!((landed.axial_n - 5.0).abs() < 1e-9);
    assert_eq!(FIT.contact(&upright(1.599, 0.1)).stage, Stage::Chamfer);
}

#[test]
fn without_chamfers_only_the_clearance_is_left() {
    let sharp = Fit { peg_chamfer_mm: 0.0, hole_chamfer_mm: 0.0, ..FIT };
    assert_eq!(sharp.contact(&upright(0.101, 0.1)).stage, Stage::Face);
    assert_eq!(sharp.contact(&upright(0.099, 0.1)).stage, Stage::Free);
}

#[test]
fn an_offset_within_the_chamfer_is_pushed_aside_and_slides_in() {
    // The chamfers narrow by one millimetre a millimetre: first touch where 1.6 - z = 0.9.
    let offset = 0.9;
    assert_eq!(FIT.contact(&upright(offset, 0.699)).stage, Stage::Free);
    let crossing = FIT.contact(&upright(offset, 1.1));
    assert_eq!(crossing.stage, Stage::Chamfer);
    let pushed_mm = offset - (1.6 - 1.1);
    assert!((crossing.lateral_n.x + 8.0 * pushed_mm).abs() < 1e-6, "{crossing:?}");
    assert!((crossing.axial_n - 8.0 * pushed_mm * 1.2 / 0.8).abs() < 1e-6);
    // Past the chamfers it is pushed aside by all but the clearance, and rubs.
    let inside = FIT.contact(&upright(offset, 30.0));
    assert_eq!(inside.stage, Stage::OnePoint);
    assert!((inside.lateral_n.x + 8.0 * 0.8).abs() < 1e-6);
    assert!((inside.axial_n - 0.2 * 8.0 * 0.8).abs() < 1e-6);
}

#[test]
fn offset_and_force_turn_together_about_the_axis() {
    let along_x = FIT.contact(&upright(0.5, 10.0));
    for step in 0..12 {
        let (sin, cos) = libm::sincos(f64::from(step) * 0.55);
        let tip_mm = Vector3::new(0.5 * cos, 0.5 * sin, 10.0);
        let turned = FIT.contact(&Held { tip_mm, axis: Vector3::z() });
        let expected = Vector2::new(cos, sin) * along_x.lateral_n.x;
        assert!((turned.lateral_n - expected).norm() < 1e-9);
        assert!((turned.axial_n - along_x.axial_n).abs() < 1e-9);
    }
}

#[test]
fn a_tilted_peg_touches_twice_at_the_depth_of_the_closed_form() {
    let tilt = 0.005;
    let depth = FIT.two_point_depth_mm(tilt);
    assert!((depth - 2.0 * 0.1 / tilt).abs() < 0.01, "{depth}");
    // The rim is half a millimetre over the end and the throat a millimetre below the mouth.
    let end = depth + 1.5;
    assert_ne!(FIT.contact(&tilted(tilt, end - 0.01)).stage, Stage::TwoPoint);
    assert_eq!(FIT.contact(&tilted(tilt, end + 0.01)).stage, Stage::TwoPoint);
}

#[test]
fn two_points_right_the_tilt_against_the_grasp() {
    let (tilt, depth) = (0.005, 55.0);
    let contact = FIT.contact(&tilted(tilt, depth));
    let below_throat = depth - 1.5;
    let righted = tilt - 0.2 / below_throat;
    let couple_n = 100_000.0 * righted / below_throat;
    assert_eq!(contact.stage, Stage::TwoPoint);
    // What the throat and the wall take differs by the push from the side.
    let expected = 0.2 * (2.0 * couple_n + contact.lateral_n.x.abs());
    assert!((contact.axial_n - expected).abs() < 0.01 * expected, "{contact:?} {expected}");
}

#[test]
fn a_tilt_beyond_the_wedging_angle_is_stuck_at_the_computed_depth() {
    // Wedging where the two points first touch at 2 m r = 4 mm or less: above 0.2 mm / 4 mm.
    let steep = 0.06;
    let stuck = FIT.two_point_depth_mm(steep);
    assert!(stuck < 4.0);
    let below = tilted(steep, 1.0 + stuck + 0.5 * libm::cos(steep) + 0.1);
    let contact = FIT.contact(&below);
    assert_eq!(contact.stage, Stage::Wedged);
    assert!((contact.axial_n - 50.0 * 0.1).abs() < 1e-6, "{contact:?}");
    // A little less tilt, and the couple can still right it.
    let gentle = 0.045;
    let passed = tilted(gentle, FIT.two_point_depth_mm(gentle) + 1.7);
    assert_eq!(FIT.contact(&passed).stage, Stage::TwoPoint);
}

#[test]
fn a_peg_that_is_too_thick_is_stuck_in_the_chamfer() {
    let thick = Fit { peg_radius_mm: 10.3, ..FIT };
    // The rim, half a millimetre over the end, meets the cone where that is 10.3 mm wide.
    assert_eq!(thick.contact(&upright(0.0, 1.29)).stage, Stage::Free);
    let contact = thick.contact(&upright(0.0, 1.4));
    assert_eq!(contact.stage, Stage::Wedged);
    assert!((contact.axial_n - 50.0 * 0.1).abs() < 1e-6, "{contact:?}");
}

#[test]
fn the_push_is_continuous_where_a_tilted_rim_passes_the_throat() {
    // The higher side passes the throat 0.5 mm after the lower one, against which it is pushed.
    let fit = Fit { hole_radius_mm: 10.3, ..FIT };
    let at = |depth_mm: f64, offset_mm: f64| {
        let mut held = tilted(0.05, depth_mm);
        held.tip_mm.x += offset_mm;
        fit.contact(&held)
    };
    let pushes: Vec<f64> =
        (0..200).map(|step| at(1.0 + 0.01 * f64::from(step), 0.9).lateral_n.x).collect();
    let jump = pushes.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    assert!(jump < 8.0 * 0.03, "{jump} N within 0.01 mm: {pushes:?}");
}

#[test]
fn a_rim_that_hangs_on_the_throat_takes_the_force_of_the_steeper_slope() {
    // Without friction and offset along the tilt, aside by c dip / z: the slope is c dip / z^2.
    let fit = Fit { friction: 0.0, peg_chamfer_mm: 0.0, ..FIT };
    let (clearance_mm, tilt, z) = (0.1, 0.03, 0.15);
    let dip_mm = 10.0 * tilt;
    let mut held = tilted(tilt, 1.0 + z);
    held.tip_mm.x = 1.0;
    let contact = fit.contact(&held);
    let slope = clearance_mm * dip_mm / (z * z);
    assert!(slope > 1.3, "{slope}");
    let found = contact.axial_n / contact.lateral_n.norm();
    assert!((found - slope).abs() < 0.1 * slope, "{found} is not {slope}: {contact:?}");
}

#[test]
fn without_friction_nothing_wedges() {
    let slippery = Fit { friction: 0.0, ..FIT };
    let contact = slippery.contact(&tilted(0.06, 10.0));
    assert_eq!((contact.stage, contact.axial_n), (Stage::TwoPoint, 0.0));
}

#[test]
fn force_never_jumps_on_the_way_in() {
    // Along any straight insertion, small steps change little, but on the face, which is stiff.
    for number in 0..40 {
        let at = |counter: u64| number * 4 + counter;
        let offset = Vector2::new(signed(3, Stream::Dice, at(0)), signed(3, Stream::Dice, at(1)));
        let tilt = 0.008 * unit(3, Stream::Dice, at(2));
        let (sin, cos) = libm::sincos(tilt);
        let (lean_y, lean_x) = libm::sincos(6.3 * unit(3, Stream::Dice, at(3)));
        let axis = Vector3::new(sin * lean_x, sin * lean_y, cos);
        let mut before: Option<f64> = None;
        for step in 0..3_000 {
            let along = axis * (f64::from(step) * 0.02 - 0.2);
            let tip_mm = Vector3::new(offset.x, offset.y, 0.0) + along;
            let contact = FIT.contact(&Held { tip_mm, axis });
            let force = contact.axial_n;
            // Leaving the chamfer the slope gives way to the wall: the one jump, downwards.
            if let Some(last) = before {
                let most = if contact.stage == Stage::Face { 1.001 } else { 0.4 };
                assert!(force < last + most, "{last} N to {force} N at {tip_mm:?} {contact:?}");
            }
            before = Some(force);
        }
    }
}

#[test]
fn the_pushed_peg_fits_and_no_lesser_push_does() {
    for number in 0..60 {
        let at = |counter: u64| 7 * number + counter;
        let tilt = 0.004 * unit(5, Stream::Dice, at(0));
        let (sin, cos) = libm::sincos(tilt);
        let (lean_y, lean_x) = libm::sincos(6.3 * unit(5, Stream::Dice, at(1)));
        let axis = Vector3::new(sin * lean_x, sin * lean_y, cos);
        let depth = 2.0 + 40.0 * unit(5, Stream::Dice, at(2));
        let x = 1.2 * signed(5, Stream::Dice, at(3));
        let y = 1.2 * signed(5, Stream::Dice, at(4));
        let held = Held { tip_mm: Vector3::new(x, y, depth), axis };
        let contact = FIT.contact(&held);
        assert!(matches!(contact.stage, Stage::OnePoint | Stage::Free), "{contact:?}");
        let push = contact.lateral_n / FIT.lateral_n_per_mm;
        let moved = |share: f64| {
            let mut moved = held;
            moved.tip_mm += Vector3::new(push.x, push.y, 0.0) * share;
            moved
        };
        assert!(sampled_excess(&moved(1.0)) < 1e-6, "{contact:?}");
        if push.norm() > 0.01 {
            assert!(sampled_excess(&moved(0.99)) > 0.0, "{contact:?}");
        }
    }
}

/// How far the peg is in the material, by points on its side.
fn sampled_excess(held: &Held) -> f64 {
    let side = held.axis.cross(&Vector3::x()).normalize();
    let front = side.cross(&held.axis);
    let mut worst = f64::NEG_INFINITY;
    for angle in 0..360 {
        let (sin, cos) = libm::sincos(f64::from(angle) * std::f64::consts::PI / 180.0);
        for height in 0..80 {
            let up = FIT.peg_chamfer_mm + f64::from(height) * 0.6;
            let point =
                held.tip_mm - held.axis * up + (side * sin + front * cos) * FIT.peg_radius_mm;
            if point.z > FIT.hole_chamfer_mm {
                worst = worst.max(point.xy().norm() - FIT.hole_radius_mm);
            }
        }
    }
    worst
}
