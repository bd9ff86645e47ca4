//! What falls: an item that is let go over nothing, one that is pushed from the side, one that
//! slipped out of the gripper.
//!
//! A thing that falls comes to lie on its side on whatever is below it, or is gone if nothing is.
//! It is geometry alone: where it comes to lie follows from what stands in the cell and, where
//! nothing pushed it, from a draw.

use crate::cell::Part;
use crate::collision::{Body, Obstacle};
use nalgebra::Vector3;
use obverse_geometry::Pose;
use std::f64::consts::FRAC_PI_2;

/// Millimetres in a metre.
const MM: f64 = 1e3;
/// Nothing falls farther than this, in millimetres.
const FALL_MAX_MM: f64 = 3_000.0;
/// A thing lies on another when no more than this is between them, in millimetres.
const TOUCH_MM: f64 = 0.01;
/// How often the way down is looked at, at most.
const LOOKS_MAX: u32 = 400;

/// A thing of parts and what it may lie on.
pub(crate) struct Falling<'a> {
    bodies: Vec<Body>,
    obstacles: Vec<&'a Obstacle>,
    /// How far the thing reaches from its origin, in millimetres.
    extent_mm: f64,
}

impl<'a> Falling<'a> {
    pub(crate) fn new(parts: &[Part], obstacles: Vec<&'a Obstacle>) -> Self {
        let bodies: Vec<Body> = parts.iter().map(Body::of).collect();
        let extents = bodies.iter().map(|body| body.extent_mm(&Vector3::zeros()));
        let extent_mm = extents.fold(0.0, f64::max);
        Self { bodies, obstacles, extent_mm }
    }

    /// The distance to the nearest of all obstacles, in millimetres.
    fn apart_mm(&self, pose: &Pose) -> f64 {
        let mut nearest_mm = f64::INFINITY;
        for body in &self.bodies {
            for obstacle in &self.obstacles {
                if obstacle.at_least_mm(body, pose) < nearest_mm {
                    nearest_mm = nearest_mm.min(obstacle.gap(body, pose).distance_mm);
                }
            }
        }
        nearest_mm
    }

    /// Whether something is not farther below than a height. A thing without a body needs nothing.
    pub(crate) fn is_supported(&self, pose: &Pose, height_m: f64) -> bool {
        if self.bodies.is_empty() {
            return true;
        }
        let mut pose = *pose;
        let mut left_mm = height_m * MM;
        for _ in 0..LOOKS_MAX {
            let apart_mm = self.apart_mm(&pose);
            if apart_mm <= TOUCH_MM {
                return true;
            }
            if left_mm <= 0.0 {
                return false;
            }
            let step_mm = apart_mm.min(left_mm);
            pose.translation_m.z -= step_mm / MM;
            left_mm -= step_mm;
        }
        true
    }

    /// Where it comes to lie when it falls from there towards a side (a unit vector in the plane);
    /// none if it falls out of the cell.
    pub(crate) fn lies(&self, from: &Pose, towards: [f64; 2]) -> Option<Pose> {
        let mut pose = on_its_side(from, towards);
        if self.bodies.is_empty() {
            return Some(pose);
        }
        // It turns over its edge, and not about its middle.
        let [x, y] = towards.map(|part| part * self.extent_mm / MM);
        pose = pose.displaced(Vector3::new(x, y, 0.0));
        // What lies in the way while it turns over gives way: it lands on that.
        let mut raised_mm = 0.0;
        while self.apart_mm(&pose) <= TOUCH_MM && raised_mm < 2.0 * self.extent_mm {
            pose.translation_m.z += 0.25 * self.extent_mm / MM;
            raised_mm += 0.25 * self.extent_mm;
        }
        let mut fallen_mm = 0.0;
        for _ in 0..LOOKS_MAX {
            let apart_mm = self.apart_mm(&pose);
            if apart_mm <= TOUCH_MM {
                return Some(pose);
            }
            fallen_mm += apart_mm;
            if fallen_mm > FALL_MAX_MM {
                return None;
            }
            pose.translation_m.z -= apart_mm / MM;
        }
        Some(pose)
    }
}

/// Turned over by a right angle about where it stands.
fn on_its_side(from: &Pose, [x, y]: [f64; 2]) -> Pose {
    let over = Pose::from_rotation_vector([0.0; 3], [-y * FRAC_PI_2, x * FRAC_PI_2, 0.0]);
    Pose { rotation: over.rotation * from.rotation, translation_m: from.translation_m }
}
