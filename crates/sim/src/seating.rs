//! A held item on its way over a seat: how it came, and how it is left.
//!
//! Between the route of a motion and the places of a [`seat`](crate::seat). What is true of an item
//! in a seat outlasts a motion, and the grip of the hand: [`Seating`] keeps it.

use crate::cell::HoleSpec;
use crate::line::Line;
use crate::route::Route;
use crate::seat::{Around, Hand, Seat, Seated, Start, Thread};
use crate::world::Hole;
use nalgebra::Vector3;
use obverse_geometry::Pose;
use std::f64::consts::TAU;

/// Halvings of a route in search of where an item comes to a thread.
const BISECTIONS: u32 = 48;
/// How far an item is turned between two looks, at least and at most, in radians.
const LOOK_RAD: (f64, f64) = (0.02, 0.3);
/// How far it is moved along the axis between two looks, at least and at most, in metres.
const LOOK_M: (f64, f64) = (1e-5, 0.25e-3);
/// How far the item's end may stray from a straight line where it passes the mouth of a hole, on a
/// line and by joints, in metres.
const STRAYS_M: (f64, f64) = (2e-3, 0.1);
/// A turn this near to the last is tight, in radians.
const TIGHT_RAD: f64 = 0.1;

/// How an item is in a seat, known to observers alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seating {
    /// The fixture, by its place in the cell's list.
    pub fixture: usize,
    /// The hole, by its place in the fixture's list of holes.
    pub hole: usize,
    /// How deep the item's end truly is, in metres.
    pub depth_m: f64,
    /// How far it is turned in the thread, in radians.
    pub turned_rad: f64,
    /// Whether it has caught across the thread.
    pub crossed: bool,
    /// Whether it is in as it should be: snapped in, tight, or held by the press.
    pub is_seated: bool,
    /// Whether a hand still pulls or pushes at it.
    pub(crate) is_held: bool,
}

/// An item in the frame of the tool mount, as far as it meets a hole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried {
    /// The item.
    pub(crate) item: Pose,
    /// The middle of its end.
    pub(crate) tip_m: Vector3<f64>,
}

impl Carried {
    /// The middle of its end in the frame of a hole, and how far it is turned about its axis.
    fn in_hole(&self, hole: &Hole, mount: &Pose) -> (Vector3<f64>, f64) {
        let from_mount = hole.from_base.compose(mount);
        let tip_m = from_mount.rotation * self.tip_m + from_mount.translation_m;
        let turn = from_mount.rotation * self.item.rotation;
        let sin = turn[(1, 0)] - turn[(0, 1)];
        (tip_m, libm::atan2(sin, turn[(0, 0)] + turn[(1, 1)]))
    }

    fn depth_m(&self, hole: &Hole, mount: &Pose) -> f64 {
        self.in_hole(hole, mount).0.z
    }
}

/// A motion of a held item, seen from one seat.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach {
    pub(crate) hole: Hole,
    pub(crate) seat: Seat,
    carried: Carried,
    start: Start,
    /// How far the item is turned about the axis at the start, in radians, and by the whole motion.
    twist_rad: f64,
    turn_rad: f64,
    /// How far it was turned, since the start of the motion, when it came to the thread.
    caught_rad: f64,
    /// How far the motion goes along and across the axis, if it is a straight line.
    way_m: Option<f64>,
}

impl Approach {
    /// A motion over a seat, of an item that was left in it so, if it was.
    pub(crate) fn new(
        hole: &Hole,
        seat: Seat,
        carried: Carried,
        route: &Route,
        left: Option<&Seating>,
    ) -> Self {
        let axis = hole.mouth.rotation.column(2).into_owned();
        let (tip_m, twist_rad) = carried.in_hole(hole, &route.mount_at(0.0));
        let left = left.filter(|_| is_inside(&hole.spec, &tip_m));
        let depth_m = left.filter(|left| left.is_held).map_or(tip_m.z, |left| left.depth_m);
        let turned_rad = left.map_or(0.0, |left| left.turned_rad);
        let mut approach = Self {
            hole: *hole,
            seat,
            carried,
            start: Start { depth_m, turned_rad, crossed: left.is_some_and(|left| left.crossed) },
            twist_rad,
            turn_rad: route.turn_about_rad(&axis),
            caught_rad: 0.0,
            way_m: route.line.as_ref().map(Line::length_m),
        };
        if let Seat::Thread(thread) = &seat {
            approach.come_to(thread, route, left.is_some());
        }
        approach
    }

    /// Find where the item comes to the thread, and whether it will catch there as it should.
    fn come_to(&mut self, thread: &Thread, route: &Route, is_known: bool) {
        if !is_known && self.start.depth_m > thread.at_m {
            self.start.turned_rad = thread.turned_at_rad(self.start.depth_m);
        }
        if self.start.turned_rad > 0.0 {
            return;
        }
        let depth_m = |fraction| self.carried.depth_m(&self.hole, &route.mount_at(fraction));
        let (mut above, mut at) = (0.0, 1.0);
        if depth_m(above) >= thread.at_m {
            at = 0.0;
        } else if depth_m(at) < thread.at_m {
            // It never comes there.
            self.caught_rad = f64::INFINITY;
            return;
        }
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (above + at);
            if depth_m(middle) >= thread.at_m {
                at = middle;
            } else {
                above = middle;
            }
        }
        let mount = route.mount_at(at);
        let (tip_m, _) = self.carried.in_hole(&self.hole, &mount);
        let axis = (self.hole.from_base.rotation * mount.rotation * self.carried.item.rotation)
            .column(2)
            .into_owned();
        let tilt_rad = libm::atan2(axis.xy().norm(), axis.z);
        self.caught_rad = self.turned_rad(at, &mount);
        self.start.crossed = thread.is_crossed(tip_m.xy().norm(), tilt_rad);
    }

    /// How far the item has been turned about the axis since the start of the motion.
    fn turned_rad(&self, fraction: f64, mount: &Pose) -> f64 {
        let (_, twist_rad) = self.carried.in_hole(&self.hole, mount);
        let apart = twist_rad - self.twist_rad;
        apart + TAU * libm::round((self.turn_rad * fraction - apart) / TAU)
    }

    fn hand(&self, fraction: f64, mount: &Pose) -> Hand {
        let depth_m = self.carried.depth_m(&self.hole, mount);
        let turned_rad = self.turned_rad(fraction, mount) - self.caught_rad;
        Hand { depth_m, turned_rad }
    }

    /// How the item is in the seat at a fraction of the motion, and the part of the motion that may
    /// pass before it is looked at again, if that does not follow from the way of its body.
    pub(crate) fn seated(
        &self,
        around: &Around,
        fraction: f64,
        mount: &Pose,
    ) -> (Seated, Hand, Option<f64>) {
        let hand = self.hand(fraction, mount);
        let seated = self.seat.seated(around, &self.start, &hand);
        let steady_m = self.seat.steady_m(around, &hand).clamp(LOOK_M.0, LOOK_M.1);
        let stride = self.way_m.map(|way_m| {
            let steady_rad = self.seat.steady_rad(&self.start, &hand).clamp(LOOK_RAD.0, LOOK_RAD.1);
            let by_turn = steady_rad / self.turn_rad.abs();
            by_turn.min(steady_m / way_m)
        });
        (seated, hand, stride)
    }

    /// How the item is left in the seat by a motion that ends there.
    pub(crate) fn left(&self, around: &Around, fraction: f64, mount: &Pose) -> Option<Left> {
        let (tip_m, _) = self.carried.in_hole(&self.hole, mount);
        if !is_inside(&self.hole.spec, &tip_m) {
            return None;
        }
        let hand = self.hand(fraction, mount);
        let Seated { depth_m, turned_rad, .. } = self.seat.seated(around, &self.start, &hand);
        let crossed = self.start.crossed && turned_rad > 0.0;
        let is_seated = match &self.seat {
            Seat::Snap(snap) => depth_m >= snap.at_m,
            Seat::Press(_) => depth_m > around.throat_m,
            Seat::Thread(thread) => !crossed && turned_rad + TIGHT_RAD >= thread.turns_rad,
        };
        Some(Left { depth_m, turned_rad, crossed, is_seated })
    }
}

/// What a motion leaves of an item in a seat.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Left {
    pub(crate) depth_m: f64,
    pub(crate) turned_rad: f64,
    pub(crate) crossed: bool,
    pub(crate) is_seated: bool,
}

/// Whether a motion begins in a hole or may lead into it, by where the item's end passes the mouth.
pub(crate) fn comes_near(hole: &Hole, carried: &Carried, route: &Route) -> bool {
    let tip_m = |fraction| carried.in_hole(hole, &route.mount_at(fraction)).0;
    let (from, to) = (tip_m(0.0), tip_m(1.0));
    if from.z > 0.0 {
        return is_inside(&hole.spec, &from);
    }
    if to.z <= 0.0 {
        return false;
    }
    let passes = from + (to - from) * (from.z / (from.z - to.z));
    let strays_m = if route.line.is_some() { STRAYS_M.0 } else { STRAYS_M.1 };
    passes.xy().norm() <= 0.5 * hole.spec.diameter_m + hole.spec.chamfer_m + strays_m
}

/// Whether the end of an item is below the mouth of a hole, within its edge.
fn is_inside(hole: &HoleSpec, tip_m: &Vector3<f64>) -> bool {
    tip_m.z > 0.0 && tip_m.xy().norm() <= 0.5 * hole.diameter_m + hole.chamfer_m
}
