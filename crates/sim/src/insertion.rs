//! The held peg over and in the holes of fixtures: between the arm's frames and a peg's contact.
//!
//! Knows which hole a peg is at, and which has a seat; the contact itself is in `peg` and `seat`.

use crate::cell::{Cell, ContactSpec, HoleSpec, PegSpec};
use crate::gripper::Inventory;
use crate::peg::{Contact, Fit, Held};
use crate::route::Route;
use crate::seat::{Around, Seat};
use crate::seating::{self, Approach, Carried, Seating};
use crate::world::{Hole, Owner, World};
use nalgebra::Vector3;
use obverse_geometry::Pose;

/// Millimetres in a metre.
const MM: f64 = 1e3;
/// How far the end of a peg can be pressed into a face, in millimetres.
const PRESS_MM: f64 = 1.0;

/// A peg that is held, in the frame of the tool mount.
pub(crate) struct HeldPeg {
    spec: PegSpec,
    tip_m: Vector3<f64>,
    axis: Vector3<f64>,
    /// The motion as each seat sees it.
    approaches: Vec<SeatApproach>,
}

/// A motion over one seat of a part.
struct SeatApproach {
    fixture: usize,
    /// The part, by its place among the parts of all fixtures, and the hole, by its place in it.
    standing: usize,
    hole: usize,
    approach: Approach,
}

/// A peg that comes to a hole from above.
pub(crate) enum AtHole {
    /// Over the face, at least so far, in millimetres.
    Over(f64),
    /// Below the face, in the hole or on its edge.
    In {
        /// The force on the peg, in the base frame.
        force_n: Vector3<f64>,
        /// How far it can go on before anything but a slow change happens.
        steady_mm: f64,
        /// The part of the motion that may pass before it is looked at again, where a seat says so.
        stride: Option<f64>,
    },
}

/// Where a route has brought the mount, over the holes of which part.
pub(crate) struct Over<'a> {
    /// The part, by its place among the parts of all fixtures.
    pub(crate) standing: usize,
    pub(crate) holes: &'a [Hole],
    pub(crate) fraction: f64,
    pub(crate) mount: &'a Pose,
}

impl HeldPeg {
    pub(crate) fn of(cell: &Cell, items: &Inventory) -> Option<Self> {
        let (index, in_mount) = items.held_in_mount()?;
        let spec = cell.items[index].peg?;
        let axis = in_mount.rotation.column(2).into_owned();
        let tip_m = in_mount.translation_m + axis * (0.5 * spec.length_m);
        Some(Self { spec, tip_m, axis, approaches: Vec::new() })
    }

    /// Look ahead at the seats that a motion may come to, with an item that was left in one so.
    pub(crate) fn approach(
        &mut self,
        world: &World,
        route: &Route,
        items: &Inventory,
        left: Option<&Seating>,
    ) {
        let Some((_, item)) = items.held_in_mount() else { return };
        let carried = Carried { item, tip_m: self.tip_m };
        for (standing, part) in world.fixed.iter().enumerate() {
            let Owner::Fixture(fixture) = part.owner else { continue };
            for (hole, drilled) in part.holes.iter().enumerate() {
                let Some(seat) = self.seat(&drilled.spec) else { continue };
                if !seating::comes_near(drilled, &carried, route) {
                    continue;
                }
                let left =
                    left.filter(|left| (left.fixture, left.hole) == (fixture, drilled.spec.number));
                let approach = Approach::new(drilled, seat, carried, route, left);
                self.approaches.push(SeatApproach { fixture, standing, hole, approach });
            }
        }
    }

    /// How the peg is left in a seat where a motion ends.
    pub(crate) fn left(
        &self,
        fraction: f64,
        mount: &Pose,
        contact: &ContactSpec,
    ) -> Option<Seating> {
        self.approaches.iter().find_map(|over| {
            let Hole { spec, .. } = &over.approach.hole;
            let held = self.held_in(&over.approach.hole, mount)?;
            let around = around(&fit(&self.spec, spec, contact), &held, contact);
            let left = over.approach.left(&around, fraction, mount)?;
            Some(Seating {
                fixture: over.fixture,
                hole: spec.number,
                depth_m: left.depth_m,
                turned_rad: left.turned_rad,
                crossed: left.crossed,
                is_seated: left.is_seated,
                is_held: true,
            })
        })
    }

    /// The seat of a hole, as far as it acts on this peg: none presses what is too thin for it.
    fn seat(&self, hole: &HoleSpec) -> Option<Seat> {
        let is_loose = self.spec.diameter_m <= hole.diameter_m;
        hole.seat.filter(|seat| !(is_loose && matches!(seat, Seat::Press(_))))
    }

    /// Where the peg is held in the frame of a hole, if it points into it.
    fn held_in(&self, hole: &Hole, mount: &Pose) -> Option<Held> {
        let from_mount = hole.from_base.compose(mount);
        let axis = from_mount.rotation * self.axis;
        if axis.z < Fit::TILT_MAX_COS {
            return None;
        }
        let tip_m = from_mount.rotation * self.tip_m + from_mount.translation_m;
        Some(Held { tip_mm: tip_m * MM, axis })
    }

    /// How the peg meets the holes of one part, if it points into them: over them or in one. None
    /// where it meets the part as if that had no holes.
    pub(crate) fn at(&self, over: &Over<'_>, contact: &ContactSpec) -> Option<AtHole> {
        let mut over_mm: Option<f64> = None;
        for (number, hole) in over.holes.iter().enumerate() {
            let Some(held) = self.held_in(hole, over.mount) else { continue };
            let fit = fit(&self.spec, &hole.spec, contact);
            let lowest_mm = fit.lowest_mm(&held);
            if lowest_mm <= 0.0 {
                // All of the part is below the face.
                over_mm = Some(over_mm.map_or(-lowest_mm, |over| over.max(-lowest_mm)));
            } else if held.tip_mm.xy().norm() <= fit.hole_radius_mm + fit.hole_chamfer_mm {
                let (found, stride) = self.contact(over, number, &fit, &held, contact);
                let push = Vector3::new(found.lateral_n.x, found.lateral_n.y, -found.axial_n);
                let force_n = hole.mouth.rotation * push;
                return Some(AtHole::In { force_n, steady_mm: fit.steady_mm(&held), stride });
            }
        }
        over_mm.map(AtHole::Over)
    }

    /// The contact with a hole, and with the seat in it if it has one.
    fn contact(
        &self,
        over: &Over<'_>,
        hole: usize,
        fit: &Fit,
        held: &Held,
        contact: &ContactSpec,
    ) -> (Contact, Option<f64>) {
        let place = (over.standing, hole);
        let found = self.approaches.iter().find(|seen| (seen.standing, seen.hole) == place);
        let Some(SeatApproach { approach, .. }) = found else { return (fit.contact(held), None) };
        let around = around(fit, held, contact);
        let (seated, hand, stride) = approach.seated(&around, over.fraction, over.mount);
        let aside_mm = (seated.depth_m - hand.depth_m) * MM;
        let truly = Held { tip_mm: held.tip_mm + held.axis * (aside_mm / held.axis.z), ..*held };
        let mut found = fit.contact(&truly);
        // What rubs acts against the way that the item is pushed or pulled.
        let rubs_n = found.axial_n + seated.twist_n;
        found.axial_n = seated.axial_n + if seated.axial_n < 0.0 { -rubs_n } else { rubs_n };
        (found, stride)
    }
}

/// What surrounds the seat of a hole, for a peg that is held so.
fn around(fit: &Fit, held: &Held, contact: &ContactSpec) -> Around {
    let below_tip_mm = fit.lowest_mm(held) - held.tip_mm.z;
    Around {
        give_n_per_m: contact.stiffness_n_per_m,
        throat_m: (fit.hole_chamfer_mm + fit.peg_chamfer_mm) / MM,
        bottom_m: (fit.depth_mm - below_tip_mm) / MM,
    }
}

fn fit(peg: &PegSpec, hole: &HoleSpec, contact: &ContactSpec) -> Fit {
    let peg_radius_mm = 0.5 * peg.diameter_m * MM;
    let mut hole_radius_mm = 0.5 * hole.diameter_m * MM;
    if matches!(hole.seat, Some(Seat::Press(_))) && peg_radius_mm > hole_radius_mm {
        // The wall gives way by as much again as the peg is too thick.
        hole_radius_mm = 2.0 * peg_radius_mm - hole_radius_mm;
    }
    Fit {
        peg_radius_mm,
        peg_chamfer_mm: peg.chamfer_m * MM,
        hole_radius_mm,
        hole_chamfer_mm: hole.chamfer_m * MM,
        depth_mm: hole.depth_m * MM,
        friction: contact.friction,
        stiffness_n_per_mm: contact.stiffness_n_per_m / MM,
        lateral_n_per_mm: contact.lateral_n_per_m / MM,
        angular_nmm_per_rad: contact.angular_nm_per_rad * MM,
        press_mm: PRESS_MM,
    }
}
