//! The one place that asks parry: how far two convex bodies are apart, in millimetres.
//!
//! What moves is a *core* with a margin around it, and only the distance from the core is asked
//! for. So parry never sees bodies that touch or overlap by less than the margin (where its normals
//! are zero or random), and the depth to which two bodies are pressed into each other is a distance
//! like any other. A core with its margin is the body itself but for its edges, which are rounded
//! with the margin. Poses come in metres and nalgebra's types; millimetres and glam's types stay
//! inside. Knows nothing of robots and paths.

use crate::cell::{Part, Shape};
use nalgebra::{Matrix3, Vector3};
use obverse_geometry::Pose;
use parry3d_f64::math as glam;
use parry3d_f64::query::gjk::{self, CsoPoint, GJKResult, VoronoiSimplex};
use parry3d_f64::shape::{Cuboid, Cylinder, Segment, SupportMap};

/// Millimetres in a metre.
const MM: f64 = 1e3;
/// The margin of a body that has room for it, in millimetres.
const MARGIN_MM: f64 = 1.0;

/// A convex shape of parry, around its own centre.
#[derive(Clone, Copy, Debug)]
enum Core {
    Segment(Segment),
    Cuboid(Cuboid),
    Cylinder(Cylinder),
}

impl Core {
    fn support(&self) -> &dyn SupportMap {
        match self {
            Self::Segment(segment) => segment,
            Self::Cuboid(cuboid) => cuboid,
            Self::Cylinder(cylinder) => cylinder,
        }
    }

    /// The shape of a part less a margin all around.
    fn of(shape: &Shape, margin_mm: f64) -> Self {
        match shape {
            Shape::Cuboid { size_m } => {
                let [x, y, z] = size_m.map(|edge| edge * (0.5 * MM) - margin_mm);
                Self::Cuboid(Cuboid::new(glam::Vector::new(x, y, z)))
            }
            Shape::Cylinder { diameter_m, length_m } => Self::Cylinder(Cylinder::new(
                length_m * (0.5 * MM) - margin_mm,
                diameter_m * (0.5 * MM) - margin_mm,
            )),
        }
    }
}

/// Half the edges of the box around a shape, in millimetres.
fn half_box_mm(shape: &Shape) -> Vector3<f64> {
    match shape {
        Shape::Cuboid { size_m } => Vector3::from(*size_m) * (0.5 * MM),
        Shape::Cylinder { diameter_m, length_m } => {
            Vector3::new(*diameter_m, *diameter_m, *length_m) * (0.5 * MM)
        }
    }
}

/// Parry's cylinders stand along y, ours along z.
fn upright(shape: &Shape) -> Pose {
    match shape {
        Shape::Cuboid { .. } => Pose::identity(),
        Shape::Cylinder { .. } => Pose {
            rotation: Matrix3::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0),
            translation_m: Vector3::zeros(),
        },
    }
}

fn to_parry(pose: &Pose) -> glam::Pose {
    let column = |index: usize| {
        let [x, y, z]: [f64; 3] = pose.rotation.column(index).into_owned().into();
        glam::Vector::new(x, y, z)
    };
    let axes = glam::Mat3::from_cols(column(0), column(1), column(2));
    let [x, y, z]: [f64; 3] = (pose.translation_m * MM).into();
    glam::Pose::from_parts(glam::Vector::new(x, y, z), glam::Rotation::from_mat3(&axes))
}

/// A convex body that moves: a core and the margin around it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body {
    core: Core,
    /// Where the core's own frame is, in the frame that carries the body.
    local: Pose,
    margin_mm: f64,
    /// The distance from its centre to its farthest point.
    radius_mm: f64,
}

impl Body {
    /// The body of a part.
    pub(crate) fn of(part: &Part) -> Self {
        let half = half_box_mm(&part.shape);
        let margin_mm = MARGIN_MM.min(0.5 * half.min());
        let radius_mm = match part.shape {
            Shape::Cuboid { .. } => half.norm(),
            Shape::Cylinder { .. } => libm::hypot(half.x, half.z),
        };
        Self {
            core: Core::of(&part.shape, margin_mm),
            local: part.pose.compose(&upright(&part.shape)),
            margin_mm,
            radius_mm,
        }
    }

    /// A ball-ended bar between two points of the frame that carries it.
    pub(crate) fn bar(ends_m: [Vector3<f64>; 2], radius_m: f64) -> Self {
        let middle = (ends_m[0] + ends_m[1]) * 0.5;
        let [x, y, z]: [f64; 3] = ((ends_m[1] - middle) * MM).into();
        let end = glam::Vector::new(x, y, z);
        Self {
            core: Core::Segment(Segment::new(-end, end)),
            local: Pose::identity().displaced(middle),
            margin_mm: radius_m * MM,
            radius_mm: end.length() + radius_m * MM,
        }
    }

    /// How deep it can be pressed and the depth still be known, in millimetres.
    pub(crate) fn margin_mm(&self) -> f64 {
        self.margin_mm
    }

    /// The distance of its farthest point from a point of the frame that carries it.
    pub(crate) fn extent_mm(&self, from_m: &Vector3<f64>) -> f64 {
        (self.local.translation_m - from_m).norm() * MM + self.radius_mm
    }
}

/// A convex body that stands still.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Obstacle {
    core: Core,
    pose: glam::Pose,
    /// From the base frame into the frame of the box around it.
    to_box: Pose,
    half_box_mm: Vector3<f64>,
}

/// Two bodies that are close to each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    /// Below zero, the depth to which they are pressed into each other; not below the margin.
    pub(crate) distance_mm: f64,
    /// The unit vector from the obstacle to the body where they are nearest; where they are pressed
    /// beyond the margin, from middle to middle.
    pub(crate) normal: Vector3<f64>,
}

impl Obstacle {
    /// The obstacle that a part makes in a body at `pose`.
    pub(crate) fn of(part: &Part, pose: &Pose) -> Self {
        let placed = pose.compose(&part.pose);
        Self {
            core: Core::of(&part.shape, 0.0),
            pose: to_parry(&placed.compose(&upright(&part.shape))),
            to_box: placed.inverse(),
            half_box_mm: half_box_mm(&part.shape),
        }
    }

    /// A distance that is not above the true one, from bounding volumes: cheap.
    pub(crate) fn at_least_mm(&self, body: &Body, carrier: &Pose) -> f64 {
        let middle = carrier.rotation * body.local.translation_m + carrier.translation_m;
        let Core::Segment(bar) = body.core else {
            return self.outside_mm(&middle) - body.radius_mm;
        };
        // A bar is long: three balls in a row, each around a third of it.
        let third_m = Vector3::new(bar.b.x, bar.b.y, bar.b.z) * (2.0 / 3.0 / MM);
        let aside = carrier.rotation * (body.local.rotation * third_m);
        let nearest_mm = self
            .outside_mm(&middle)
            .min(self.outside_mm(&(middle + aside)))
            .min(self.outside_mm(&(middle - aside)));
        nearest_mm - body.margin_mm - (body.radius_mm - body.margin_mm) / 3.0
    }

    /// The distance of a point from the box around the obstacle.
    fn outside_mm(&self, point_m: &Vector3<f64>) -> f64 {
        let inside = (self.to_box.rotation * point_m + self.to_box.translation_m) * MM;
        (inside.abs() - self.half_box_mm).sup(&Vector3::zeros()).norm()
    }

    /// The distance of a body that `carrier` carries.
    pub(crate) fn gap(&self, body: &Body, carrier: &Pose) -> Gap {
        let moving = to_parry(&carrier.compose(&body.local));
        let relative = self.pose.inv_mul(&moving);
        let mut simplex = VoronoiSimplex::new();
        let towards = (-relative.translation).try_normalize().unwrap_or(glam::Vector::X);
        let (still, core) = (self.core.support(), body.core.support());
        simplex.reset(CsoPoint::from_shapes(&relative, still, core, towards));
        match gjk::closest_points(&relative, still, core, f64::MAX, true, &mut simplex) {
            GJKResult::ClosestPoints(on_obstacle, on_body, _) => {
                let between = on_body - on_obstacle;
                let apart = between.length();
                let normal = self.pose.rotation * (between / apart.max(f64::MIN_POSITIVE));
                Gap {
                    distance_mm: apart - body.margin_mm,
                    normal: Vector3::new(normal.x, normal.y, normal.z),
                }
            }
            GJKResult::Intersection => self.beyond_margin(-body.margin_mm, &moving),
            // It did not converge: what the bounding volumes say holds in any case.
            GJKResult::NoIntersection(_) | GJKResult::Proximity(_) => {
                let distance_mm = self.at_least_mm(body, carrier).max(-body.margin_mm);
                self.beyond_margin(distance_mm, &moving)
            }
        }
    }

    fn beyond_margin(&self, distance_mm: f64, moving: &glam::Pose) -> Gap {
        let between = moving.translation - self.pose.translation;
        let normal = between.try_normalize().unwrap_or(glam::Vector::Z);
        Gap { distance_mm, normal: Vector3::new(normal.x, normal.y, normal.z) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Stream, signed, unit};

    fn cuboid(size_m: [f64; 3]) -> Part {
        Part { pose: Pose::identity(), shape: Shape::Cuboid { size_m } }
    }

    fn at(x: f64, y: f64, z: f64) -> Pose {
        Pose::identity().displaced(Vector3::new(x, y, z))
    }

    #[test]
    fn a_box_over_a_table_is_as_far_as_it_is_high() {
        let table = Obstacle::of(&cuboid([1.0, 1.0, 0.02]), &at(0.0, 0.0, -0.01));
        let body = Body::of(&cuboid([0.04, 0.04, 0.1]));
        for height_mm in [200.0, 1.0, 0.01, 0.0, -0.01, -0.5] {
            let gap = table.gap(&body, &at(0.1, 0.2, 0.05 + height_mm / MM));
            assert!((gap.distance_mm - height_mm).abs() < 1e-6, "{height_mm}: {gap:?}");
            assert!((gap.normal - Vector3::z()).norm() < 1e-6, "{height_mm}: {gap:?}");
        }
        let deep = table.gap(&body, &at(0.1, 0.2, 0.04));
        assert_eq!(deep.distance_mm, -1.0);
        assert!((deep.normal.norm() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_cylinder_stands_along_z() {
        let shape = Shape::Cylinder { diameter_m: 0.02, length_m: 0.1 };
        let peg = Part { pose: Pose::identity(), shape };
        let wall = Obstacle::of(&cuboid([0.1, 0.1, 0.1]), &at(0.1, 0.0, 0.0));
        let gap = wall.gap(&Body::of(&peg), &at(0.0, 0.0, 0.0));
        assert!((gap.distance_mm - 40.0).abs() < 1e-6, "{gap:?}");
        let post = Obstacle::of(&peg, &at(0.0, 0.0, -0.1));
        let gap = post.gap(&Body::of(&peg), &at(0.0, 0.0, 0.005));
        assert!((gap.distance_mm - 5.0).abs() < 1e-6, "{gap:?}");
    }

    #[test]
    fn a_bar_is_its_axis_and_a_radius() {
        let wall = Obstacle::of(&cuboid([0.1, 0.1, 0.1]), &at(0.1, 0.0, 0.0));
        let bar = Body::bar([Vector3::zeros(), Vector3::new(0.0, 0.0, 0.3)], 0.04);
        let gap = wall.gap(&bar, &at(0.0, 0.0, 0.0));
        assert!((gap.distance_mm - 10.0).abs() < 1e-6, "{gap:?}");
        assert!((gap.normal + Vector3::x()).norm() < 1e-6, "{gap:?}");
    }

    #[test]
    fn bounding_volumes_never_promise_too_much() {
        for number in 0..2_000_u64 {
            let draw = |axis: u64| signed(11, Stream::Dice, number * 16 + axis);
            let size = |axis: u64| 0.01 + 0.2 * unit(11, Stream::Dice, number * 16 + axis);
            let pose = |axis: u64| {
                Pose::from_rotation_vector(
                    [draw(axis) * 0.3, draw(axis + 1) * 0.3, draw(axis + 2) * 0.3],
                    [draw(axis + 2) * 2.0, draw(axis) * 2.0, draw(axis + 1) * 2.0],
                )
            };
            let obstacle = Obstacle::of(&cuboid([size(0), size(1), size(2)]), &pose(3));
            let shape = Shape::Cylinder { diameter_m: size(6), length_m: size(7) };
            let cylinder = Body::of(&Part { pose: pose(8), shape });
            let ends = [pose(8).translation_m, pose(11).translation_m];
            let carrier = pose(11);
            for body in [cylinder, Body::bar(ends, size(6))] {
                let bound = obstacle.at_least_mm(&body, &carrier);
                let gap = obstacle.gap(&body, &carrier).distance_mm;
                assert!(bound <= gap + 1e-6 || gap < 0.0, "{bound} {gap}");
            }
        }
    }

    #[test]
    fn distances_agree_with_points_on_the_surface() {
        let obstacle = cuboid([0.1, 0.06, 0.04]);
        for number in 0..40_u64 {
            let draw = |axis: u64| signed(12, Stream::Dice, number * 8 + axis);
            let carrier = Pose::from_rotation_vector(
                [0.12 + 0.05 * draw(0), 0.1 * draw(1), 0.1 * draw(2)],
                [2.0 * draw(3), 2.0 * draw(4), 2.0 * draw(5)],
            );
            let bar = Body::bar([Vector3::new(0.0, 0.0, -0.04), Vector3::new(0.0, 0.0, 0.04)], 0.0);
            let gap = Obstacle::of(&obstacle, &Pose::identity()).gap(&bar, &carrier).distance_mm;
            let half = Vector3::new(50.0, 30.0, 20.0);
            let sampled = (0..=8_000)
                .map(|step| {
                    let along = Vector3::new(0.0, 0.0, f64::from(step) / 1e5 - 0.04);
                    let point = (carrier.rotation * along + carrier.translation_m) * MM;
                    (point.abs() - half).sup(&Vector3::zeros()).norm()
                })
                .fold(f64::INFINITY, f64::min);
            assert!((gap - sampled).abs() < 0.01, "{gap} and {sampled} of {carrier:?}");
        }
    }
}
