//! A round peg in a round blind hole: quasi-static contact, exact and without time.
//!
//! Given where the arm holds the peg, [`Fit::contact`] says how it touches the hole and with what
//! force. Millimetres, newtons and radians. Knows one peg and one hole, and no arm, path or sensor.
//!
//! # Geometry
//!
//! The frame is the hole's: the origin in the middle of its mouth, z into it. The peg has radius
//! `r` and the hole `R`; both have chamfers of 45 degrees, `wp` and `wh` wide. Two such chamfers
//! act as one: the *rim* of the peg, the circle of radius `r` where its chamfer ends, moves in a
//! cone of radius `R + wh - z` that narrows to the bore at `z = wh`, the *throat*. The cone reaches
//! up to `z = -wp`, where the end of the peg passes the face; a rim that is wider there than
//! `R + wh + wp` lands on the face.
//!
//! A peg tilted by an angle `t` fits if its rim fits the bore and the throat goes around its side.
//! Seen along the hole, the rim is an ellipse of half axes `r cos t` (in the direction of the tilt)
//! and `r`, and the section of the side at the throat is one of `r / cos t` and `r`; both must lie
//! in the circle of radius `R`. Between the two the side is straight, and a circle is convex, so
//! that nothing else can touch. Their centres are `h tan t` apart with `h` the depth of the rim
//! below the throat, and both fit at once while
//!
//! ```text
//! h tan t + r / cos t + r cos t <= 2 R                      (for small t:  h t <= 2 (R - r))
//! ```
//!
//! # Forces
//!
//! The grasp gives way sideways with a stiffness `Kx`, and in tilt about the rim with `Kt` (the
//! remote centre of compliance of D. E. Whitney, *Quasi-static assembly of compliantly supported
//! rigid parts*, J. Dyn. Sys. Meas. Control 104, 1982, whose stages these are). With friction `m`:
//!
//! - *face*: the end lands beside the hole; what the arm goes on is pressed: `F = K p`.
//! - *chamfer*: the rim slides down the cone and the peg is pushed aside by `d`. From the balance
//!   on a slope of 45 degrees, `Fx = Kx d` and `Fz = Fx (1 + m) / (1 - m)`.
//! - *throat*: while a tilted rim passes it, the higher side hangs on the throat by two points that
//!   move apart, and the peg goes aside faster than down. The steeper that is, the more force.
//! - *one point*: the rim or the throat pushes the peg aside by `d`: `Fz = m Kx d`.
//! - *two points*: the tilt exceeds what fits at this depth by `a`, and is righted by a couple
//!   `Kt a = f1 h` of throat and wall, `f1 - f2 = Fx` and `Fz = m (f1 + f2)`. The moments of the
//!   friction on two opposite sides cancel.
//! - *wedged*: two points first touch at a depth `h <= 2 m r`. Then the line between them lies in
//!   both cones of friction, the couple can no longer right the peg, and it is stuck there however
//!   hard it is pushed: `F = K p` again. For small angles that is a tilt above
//!   `(R - r) / (m r)`, Whitney's wedging angle. A peg that is thicker than the hole is stuck where
//!   the cone has its width.
//! - *bottom*: the end meets the bottom: `F = K p` added to what the wall takes.

mod ellipse;

use ellipse::{Ellipse, Excess, Turn};
use nalgebra::{Vector2, Vector3};

/// Overlaps within this are none, in millimetres.
const ROUNDING_MM: f64 = 1e-7;
/// How often the peg is pushed off what it overlaps before the rest is left.
const PUSHES_MAX: u32 = 32;
/// A step down, in search of how fast the peg is pushed aside.
const SLOPE_STEP_MM: f64 = 1e-3;
/// No edge is so sharp that it takes more force than what these two leave.
const EDGE_COS_MIN: f64 = 0.1;
const EDGE_BALANCE_MIN: f64 = 0.1;
/// Steps of Newton's method for the tilt that fits.
const NEWTON_STEPS: u32 = 6;

/// A peg, a hole and how they touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Radius of the peg.
    pub peg_radius_mm: f64,
    /// Width of the chamfer at the peg's end, 45 degrees.
    pub peg_chamfer_mm: f64,
    /// Radius of the hole.
    pub hole_radius_mm: f64,
    /// Width of the chamfer at the hole's mouth, 45 degrees.
    pub hole_chamfer_mm: f64,
    /// Depth of the hole.
    pub depth_mm: f64,
    /// Coefficient of friction, below 1.
    pub friction: f64,
    /// Of two bodies pressed on each other.
    pub stiffness_n_per_mm: f64,
    /// Of the grasp against a push from the side.
    pub lateral_n_per_mm: f64,
    /// Of the grasp against tilt.
    pub angular_nmm_per_rad: f64,
    /// How far the end can be pressed into the face. What is deeper than this has gone in: a peg
    /// that was pushed aside in the hole does not land on the face again.
    pub press_mm: f64,
}

/// Where a peg is held, in the frame of the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// The middle of its end.
    pub tip_mm: Vector3<f64>,
    /// The unit vector along its axis to the end; within [`Fit::TILT_MAX_COS`] of the hole's.
    pub axis: Vector3<f64>,
}

/// How a peg touches a hole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Above the face.
    Above,
    /// On the face beside the hole.
    Face,
    /// On the chamfer.
    Chamfer,
    /// In the hole, touching nothing.
    Free,
    /// Touching the wall or the throat.
    OnePoint,
    /// Touching wall and throat on opposite sides.
    TwoPoint,
    /// Stuck between wall and throat, or too thick.
    Wedged,
    /// On the bottom.
    Bottom,
}

/// The contact of a peg and a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// How they touch.
    pub stage: Stage,
    /// The force on the peg out of the hole, against the insertion.
    pub axial_n: f64,
    /// The force on the peg from the side, in the hole's x and y.
    pub lateral_n: Vector2<f64>,
}

/// The peg in the plane of its tilt: x in the direction of the tilt, y across.
struct Tilted {
    /// Unit vector of the direction of the tilt.
    along: Vector2<f64>,
    sin: f64,
    cos: f64,
    /// The middle of the rim, x and y.
    rim: Vector2<f64>,
    /// The depth of the middle of the rim.
    rim_z: f64,
    /// The depth of the lowest point of the end.
    lowest: f64,
}

impl Fit {
    /// The cosine of the greatest tilt at which a peg counts as going into the hole (15 degrees).
    pub const TILT_MAX_COS: f64 = 0.965_925_826_289_068_3;

    /// The contact of a peg that is held there.
    #[must_use]
    pub fn contact(&self, held: &Held) -> Contact {
        let peg = self.tilted(held);
        if peg.lowest <= 0.0 {
            return Contact { stage: Stage::Above, axial_n: 0.0, lateral_n: Vector2::zeros() };
        }
        if let Some(pressed_mm) = self.pressed_on_face(held, &peg) {
            let axial_n = self.stiffness_n_per_mm * pressed_mm;
            return Contact { stage: Stage::Face, axial_n, lateral_n: Vector2::zeros() };
        }
        let mut contact = self.in_hole(&peg);
        let below_mm = peg.lowest - self.depth_mm;
        if below_mm > 0.0 {
            contact.stage = Stage::Bottom;
            contact.axial_n += self.stiffness_n_per_mm * below_mm;
        }
        let [x, y] = contact.lateral_n.into();
        contact.lateral_n = peg.along * x + across(&peg.along) * y;
        contact
    }

    /// The depth of the lowest point of the peg's end; below zero above the face.
    #[must_use]
    pub fn lowest_mm(&self, held: &Held) -> f64 {
        held.tip_mm.z + (self.peg_radius_mm - self.peg_chamfer_mm) * held.axis.xy().norm()
    }

    /// How far a peg can be moved before anything but a slow change of its contact can happen:
    /// the way to chamfer, bottom or wedge while it is in the bore, zero elsewhere.
    #[must_use]
    pub fn steady_mm(&self, held: &Held) -> f64 {
        let peg = self.tilted(held);
        let below_throat = peg.rim_z - self.hole_chamfer_mm;
        let to_chamfer = below_throat - self.peg_radius_mm * peg.sin;
        let to_bottom = self.depth_mm - peg.lowest;
        let two_points = self.two_point_depth(peg.sin, peg.cos);
        let wedges = two_points <= 2.0 * self.friction * self.peg_radius_mm;
        let to_wedge = if wedges { two_points - below_throat } else { f64::INFINITY };
        to_chamfer.min(to_bottom).min(to_wedge).max(0.0)
    }

    /// The depth below the throat at which a peg of this tilt touches on two sides.
    #[must_use]
    pub fn two_point_depth_mm(&self, tilt_rad: f64) -> f64 {
        let (sin, cos) = libm::sincos(tilt_rad.abs());
        self.two_point_depth(sin, cos)
    }

    fn two_point_depth(&self, sin: f64, cos: f64) -> f64 {
        if sin <= 0.0 {
            return f64::INFINITY;
        }
        let room = 2.0 * self.hole_radius_mm - self.peg_radius_mm * (1.0 / cos + cos);
        room * cos / sin
    }

    fn tilted(&self, held: &Held) -> Tilted {
        let lean = held.axis.xy();
        let sin = lean.norm();
        let along = if sin > 0.0 { lean / sin } else { Vector2::x() };
        let rim = held.tip_mm - held.axis * self.peg_chamfer_mm;
        Tilted {
            along,
            sin,
            cos: held.axis.z,
            rim: Vector2::new(rim.xy().dot(&along), rim.xy().dot(&across(&along))),
            rim_z: rim.z,
            lowest: self.lowest_mm(held),
        }
    }

    /// How deep the end is pressed into the face, if it landed there.
    fn pressed_on_face(&self, held: &Held, peg: &Tilted) -> Option<f64> {
        if peg.lowest > self.press_mm {
            return None;
        }
        let mouth = self.hole_radius_mm + self.hole_chamfer_mm + self.peg_chamfer_mm;
        let rim = self.rim(peg, peg.rim);
        let farthest = rim.farthest();
        if rim.radius(farthest) <= mouth {
            return None;
        }
        // The lowest point of the end that is beside the mouth lies on the arc around the farthest
        // one: its lowest point, or where the arc leaves the mouth on the lower side.
        let lowest = Turn { cos: -1.0, sin: 0.0 };
        let deepest = if rim.radius(lowest) > mouth {
            lowest
        } else {
            rim.edge_of_mouth(mouth, farthest, lowest)
        };
        let end_radius = self.peg_radius_mm - self.peg_chamfer_mm;
        let pressed_mm = held.tip_mm.z - end_radius * peg.sin * deepest.cos;
        (pressed_mm > 0.0).then_some(pressed_mm)
    }

    /// Contact in the cone and the bore, sideways along and across the tilt.
    fn in_hole(&self, peg: &Tilted) -> Contact {
        let below_throat = peg.rim_z - self.hole_chamfer_mm;
        let too_narrow = below_throat - (self.hole_radius_mm - self.peg_radius_mm);
        if self.peg_radius_mm > self.hole_radius_mm && too_narrow > 0.0 {
            return self.stuck(too_narrow);
        }
        let two_points = self.two_point_depth(peg.sin, peg.cos);
        if below_throat > 0.0 && below_throat > two_points {
            if two_points <= 2.0 * self.friction * self.peg_radius_mm {
                return self.stuck(below_throat - two_points.max(0.0));
            }
            return self.two_points(peg, below_throat);
        }
        let (pushed, stage) = self.pushed_aside(peg, below_throat);
        let lateral_n = pushed * self.lateral_n_per_mm;
        let straddles = below_throat > 0.0 && below_throat < self.peg_radius_mm * peg.sin;
        let slope = match stage {
            Stage::Chamfer | Stage::OnePoint if straddles => {
                self.slope_at_throat(peg, below_throat, &pushed)
            }
            Stage::Chamfer => (1.0 + self.friction) / (1.0 - self.friction),
            _ => self.friction,
        };
        Contact { stage, axial_n: slope * lateral_n.norm(), lateral_n }
    }

    /// The force along the hole for one from the side, while one side of the rim has passed the
    /// throat and the other has not. There the rim touches the throat on both sides of the push,
    /// and as it goes down the two points move apart: aside by `s` for each step down, which may be
    /// much more than the one of the chamfer. From the balance along and across, with the normals
    /// at an angle `a` to the push: `(s + m q) / (1 - m s q)`, where `q` is one for `a = 0`.
    fn slope_at_throat(&self, peg: &Tilted, below_throat: f64, pushed: &Vector2<f64>) -> f64 {
        let length = pushed.norm();
        if length <= ROUNDING_MM {
            return self.friction;
        }
        let aside = pushed / length;
        let below =
            Tilted { rim_z: peg.rim_z + SLOPE_STEP_MM, lowest: peg.lowest + SLOPE_STEP_MM, ..*peg };
        let (further, _) = self.pushed_aside(&below, below_throat + SLOPE_STEP_MM);
        let s = ((further.dot(&aside) - length) / SLOPE_STEP_MM).max(0.0);
        let ((_, outwards), _) = self.at_rim(peg, peg.rim + pushed);
        let cos = (-outwards.dot(&aside)).clamp(EDGE_COS_MIN, 1.0);
        let q = ((1.0 + s * s * cos * cos) / (1.0 + s * s)).sqrt() / cos;
        (s + self.friction * q) / (1.0 - self.friction * s * q).max(EDGE_BALANCE_MIN)
    }

    fn stuck(&self, pressed_mm: f64) -> Contact {
        let axial_n = self.stiffness_n_per_mm * pressed_mm;
        Contact { stage: Stage::Wedged, axial_n, lateral_n: Vector2::zeros() }
    }

    /// The least way that the hole pushes the peg aside, and what pushes.
    fn pushed_aside(&self, peg: &Tilted, below_throat: f64) -> (Vector2<f64>, Stage) {
        let rim = |push| self.at_rim(peg, peg.rim + push);
        let throat = |push| (self.at_throat(peg, peg.rim + push, below_throat), Stage::OnePoint);
        let unpushed = Vector2::zeros();
        let (at_rim, at_throat) = (rim(unpushed), throat(unpushed));
        if at_rim.0.0.max(at_throat.0.0) <= ROUNDING_MM {
            return (unpushed, Stage::Free);
        }
        // Pushed off one alone, the peg most often clears the other.
        let mut nearest = (unpushed, Stage::Free);
        if at_rim.0.0 > ROUNDING_MM {
            nearest = push_off(at_rim, rim);
            if throat(nearest.0).0.0 <= ROUNDING_MM {
                return nearest;
            }
        }
        if at_throat.0.0 > ROUNDING_MM {
            let off_throat = push_off(at_throat, throat);
            if rim(off_throat.0).0.0 <= ROUNDING_MM {
                return off_throat;
            }
            if at_throat.0.0 > at_rim.0.0 {
                nearest = off_throat;
            }
        }
        self.between(peg, below_throat, nearest)
    }

    /// The place where both rim and throat just touch: Newton's method for two equations.
    fn between(
        &self,
        peg: &Tilted,
        below_throat: f64,
        from: (Vector2<f64>, Stage),
    ) -> (Vector2<f64>, Stage) {
        let (mut push, mut stage) = from;
        for _ in 0..PUSHES_MAX {
            let (rim, at) = self.at_rim(peg, peg.rim + push);
            let throat = self.at_throat(peg, peg.rim + push, below_throat);
            if rim.0.abs().max(throat.0.abs()) <= ROUNDING_MM {
                break;
            }
            stage = at;
            let turned = rim.1.perp(&throat.1);
            let step = across(&rim.1) * throat.0 - across(&throat.1) * rim.0;
            // One of the two is touched already, and inside it the place is within the clearance.
            let farthest = 2.0 * (self.hole_radius_mm - self.peg_radius_mm).abs();
            push -= if step.norm() < farthest * turned.abs() {
                step / turned
            } else if rim.0 > throat.0 {
                rim.1 * rim.0
            } else {
                throat.1 * throat.0
            };
        }
        (push, stage)
    }

    fn two_points(&self, peg: &Tilted, below_throat: f64) -> Contact {
        let held_slope = peg.sin / peg.cos;
        let slope = self.fitting_slope(below_throat, held_slope);
        // The difference of the two angles, by their tangents.
        let righted_rad = libm::atan((held_slope - slope) / (1.0 + held_slope * slope));
        let cos = 1.0 / (1.0 + slope * slope).sqrt();
        let rim = Vector2::new(self.hole_radius_mm - self.peg_radius_mm * cos, 0.0);
        let lateral_n = (rim - peg.rim) * self.lateral_n_per_mm;
        let couple_n = self.angular_nmm_per_rad * righted_rad / below_throat;
        // The grasp pushes against the wall with the opposite of what the hole gives.
        let throat_n = couple_n.max(lateral_n.x);
        let wall_n = throat_n - lateral_n.x;
        // What pushes across the tilt is taken where the peg leans harder.
        let (harder_n, softer_n) = (throat_n.max(wall_n), throat_n.min(wall_n));
        let axial_n = self.friction * (softer_n + libm::hypot(harder_n, lateral_n.y));
        Contact { stage: Stage::TwoPoint, axial_n, lateral_n }
    }

    /// The tangent of the greatest tilt that fits with the rim so deep below the throat.
    fn fitting_slope(&self, below_throat: f64, held_slope: f64) -> f64 {
        let mut slope = held_slope;
        for _ in 0..NEWTON_STEPS {
            let secant = (1.0 + slope * slope).sqrt();
            let over = below_throat * slope + self.peg_radius_mm * (secant + 1.0 / secant)
                - 2.0 * self.hole_radius_mm;
            let steep = below_throat
                + self.peg_radius_mm * (slope / secant - slope / (secant * secant * secant));
            slope -= over / steep;
        }
        slope.max(0.0)
    }

    fn rim(&self, peg: &Tilted, middle: Vector2<f64>) -> Ellipse {
        Ellipse { middle, along: self.peg_radius_mm * peg.cos, across: self.peg_radius_mm }
    }

    /// How far the rim is beyond bore or cone, and on which of them.
    fn at_rim(&self, peg: &Tilted, middle: Vector2<f64>) -> (Excess, Stage) {
        let rim = self.rim(peg, middle);
        let (bore, throat_z) = (self.hole_radius_mm, self.hole_chamfer_mm);
        let dip = self.peg_radius_mm * peg.sin;
        if peg.rim_z - dip >= throat_z {
            return (rim.beyond(bore), Stage::OnePoint);
        }
        // Bore below the throat, cone above it, nothing above the face. The maximum is at that of
        // one of the two, or where they end.
        let mut worst = ((f64::NEG_INFINITY, Vector2::x()), Stage::Free);
        let mut candidate = |turn: Turn| {
            let above_throat = throat_z - (peg.rim_z - dip * turn.cos);
            let (wall, stage) = if above_throat <= 0.0 {
                (bore, Stage::OnePoint)
            } else if above_throat <= throat_z + self.peg_chamfer_mm + ROUNDING_MM {
                (bore + above_throat, Stage::Chamfer)
            } else {
                return;
            };
            let excess = rim.excess_at(turn, wall);
            if excess.0 > worst.0.0 {
                worst = (excess, stage);
            }
        };
        candidate(rim.farthest());
        if dip > 0.0 {
            candidate(rim.climb(-dip));
            for edge_z in [throat_z, -self.peg_chamfer_mm] {
                let cos = (peg.rim_z - edge_z) / dip;
                if cos.abs() < 1.0 {
                    let sin = (1.0 - cos * cos).sqrt();
                    candidate(Turn { cos, sin });
                    candidate(Turn { cos, sin: -sin });
                }
            }
        }
        worst
    }

    /// How far the section of the side at the throat is beyond the bore, and in which direction.
    fn at_throat(&self, peg: &Tilted, rim: Vector2<f64>, below_throat: f64) -> Excess {
        if below_throat <= 0.0 {
            return (f64::NEG_INFINITY, Vector2::x());
        }
        let middle = Vector2::new(rim.x - below_throat * peg.sin / peg.cos, rim.y);
        let along = self.peg_radius_mm / peg.cos;
        let section = Ellipse { middle, along, across: self.peg_radius_mm };
        let excess = section.beyond(self.hole_radius_mm);
        let dip = self.peg_radius_mm * peg.sin;
        if excess.0 <= ROUNDING_MM || below_throat >= dip {
            return excess;
        }
        // Where the rim is still above the throat, the throat has no side of the peg to touch: what
        // counts is the rest of the section, at its far end or where the rim passes the throat.
        let cos = below_throat / dip;
        let sin = (1.0 - cos * cos).sqrt();
        let farthest = section.farthest();
        let far = if farthest.cos <= cos { farthest } else { Turn { cos: -1.0, sin: 0.0 } };
        let ends = [Turn { cos, sin }, Turn { cos, sin: -sin }];
        ends.into_iter().fold(section.excess_at(far, self.hole_radius_mm), |worst, end| {
            let excess = section.excess_at(end, self.hole_radius_mm);
            if excess.0 > worst.0 { excess } else { worst }
        })
    }
}

/// The push that takes the peg off one wall, from how it touches it unpushed, and the stage it
/// touched it in last.
fn push_off(
    unpushed: (Excess, Stage),
    wall: impl Fn(Vector2<f64>) -> (Excess, Stage),
) -> (Vector2<f64>, Stage) {
    let (mut push, mut stage) = (Vector2::zeros(), Stage::Free);
    let ((mut excess, mut outwards), mut at) = unpushed;
    for _ in 0..PUSHES_MAX {
        if excess <= ROUNDING_MM {
            break;
        }
        stage = at;
        push -= outwards * excess;
        ((excess, outwards), at) = wall(push);
    }
    (push, stage)
}

/// The direction a quarter turn on.
fn across(along: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-along.y, along.x)
}

#[cfg(test)]
mod tests;
