//! Ellipses in circles: a round peg's rim and its sections, seen along the hole.
//!
//! Knows distances from the axis of a hole and where they are greatest; not what touches what.

use super::ROUNDING_MM;
use nalgebra::Vector2;

/// Steps of Newton's method, which most often needs two.
const NEWTON_STEPS: u32 = 6;
/// A step within this is the last: the next would be about its square.
const LAST_STEP_RAD: f64 = 1e-4;
/// Halvings of an arc in search of a point on it.
const BISECTIONS: u32 = 48;

/// How far something is beyond a wall, and the unit vector to where it is farthest.
pub(super) type Excess = (f64, Vector2<f64>);

/// A point of an ellipse by its eccentric angle.
#[derive(Clone, Copy)]
pub(super) struct Turn {
    pub(super) cos: f64,
    pub(super) sin: f64,
}

impl Turn {
    /// Turned by a small angle: exactly a rotation, by the angle up to its cube.
    fn by(self, angle: f64) -> Self {
        let half = 0.5 * angle;
        let shrink = 1.0 / (1.0 + half * half);
        let (cos, sin) = ((1.0 - half * half) * shrink, angle * shrink);
        Self { cos: self.cos * cos - self.sin * sin, sin: self.sin * cos + self.cos * sin }
    }
}

/// An ellipse with its axes along and across the tilt, seen from the axis of the hole.
pub(super) struct Ellipse {
    pub(super) middle: Vector2<f64>,
    pub(super) along: f64,
    pub(super) across: f64,
}

impl Ellipse {
    fn point(&self, turn: Turn) -> Vector2<f64> {
        self.middle + Vector2::new(self.along * turn.cos, self.across * turn.sin)
    }

    /// The distance of a point of the ellipse from the axis of the hole.
    pub(super) fn radius(&self, turn: Turn) -> f64 {
        self.point(turn).norm()
    }

    /// The point farthest from the axis of the hole: Newton's method on the squared distance.
    pub(super) fn farthest(&self) -> Turn {
        self.climb(0.0)
    }

    /// The point with the greatest distance from the axis of the hole plus `slope` times the cosine
    /// of its angle, for a slope that is small against the ellipse.
    pub(super) fn climb(&self, slope: f64) -> Turn {
        let stretch = self.across * self.across - self.along * self.along;
        let y = self.middle.y * self.across;
        let pull = |turn: Turn| {
            let weight = if slope == 0.0 { 0.0 } else { slope * self.radius(turn) };
            self.middle.x * self.along + weight
        };
        let mut turn = self.first_guess(pull(Turn { cos: 0.0, sin: 1.0 }), y, stretch);
        for _ in 0..NEWTON_STEPS {
            let Turn { cos, sin } = turn;
            let x = pull(turn);
            let rise = y * cos - x * sin + stretch * sin * cos;
            let bend = -x * cos - y * sin + stretch * (cos * cos - sin * sin);
            if bend >= 0.0 {
                break;
            }
            let angle = (-rise / bend).clamp(-0.5, 0.5);
            turn = turn.by(angle);
            if angle.abs() < LAST_STEP_RAD {
                break;
            }
        }
        turn
    }

    /// On a circle the direction of the middle. In an ellipse that is nearly centred the two ends
    /// of the longer axis are nearly as far, and the one on the side of the middle is taken.
    fn first_guess(&self, x: f64, y: f64, stretch: f64) -> Turn {
        let length = (x * x + y * y).sqrt();
        let end = |side: f64| if side < 0.0 { -1.0 } else { 1.0 };
        if length > stretch.abs() {
            let scale = 1.0 / length;
            Turn { cos: x * scale, sin: y * scale }
        } else if stretch > 0.0 {
            Turn { cos: 0.0, sin: end(y) }
        } else {
            Turn { cos: end(x), sin: 0.0 }
        }
    }

    /// How far the ellipse is beyond a circle.
    pub(super) fn beyond(&self, circle: f64) -> Excess {
        // The circle around it is within a rounding of it, or inside: no need to look closer.
        let around = self.middle.norm() + self.along.max(self.across);
        if around <= circle + ROUNDING_MM {
            return (around - circle, Vector2::x());
        }
        self.excess_at(self.farthest(), circle)
    }

    /// How far a point of the ellipse is beyond a circle.
    pub(super) fn excess_at(&self, turn: Turn, circle: f64) -> Excess {
        let point = self.point(turn);
        let radius = point.norm();
        (radius - circle, point / radius)
    }

    /// Between a point outside the mouth and one inside, the one on its edge.
    pub(super) fn edge_of_mouth(&self, mouth: f64, outside: Turn, inside: Turn) -> Turn {
        let (mut out, mut into) = (outside, inside);
        for _ in 0..BISECTIONS {
            let mut middle = Vector2::new(out.cos + into.cos, out.sin + into.sin);
            if middle == Vector2::zeros() {
                // Opposite to each other: either side will do.
                middle = Vector2::new(-out.sin, out.cos);
            }
            let length = middle.norm();
            let turn = Turn { cos: middle.x / length, sin: middle.y / length };
            if self.radius(turn) > mouth {
                out = turn;
            } else {
                into = turn;
            }
        }
        out
    }
}
