//! The held peg over and in the holes of fixtures: between the arm's frames and a peg's contact.
//!
//! Knows which hole a peg is at; the contact itself is in `peg`.

use crate::cell::{Cell, ContactSpec, HoleSpec, PegSpec};
use crate::gripper::Inventory;
use crate::peg::{Fit, Held};
use crate::world::Hole;
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
    },
}

impl HeldPeg {
    pub(crate) fn of(cell: &Cell, items: &Inventory) -> Option<Self> {
        let (index, in_mount) = items.held_in_mount()?;
        let spec = cell.items[index].peg?;
        let axis = in_mount.rotation.column(2).into_owned();
        let tip_m = in_mount.translation_m + axis * (0.5 * spec.length_m);
        Some(Self { spec, tip_m, axis })
    }

    /// How the peg meets the holes of one part, if it points into them: over them or in one. None
    /// where it meets the part as if that had no holes.
    pub(crate) fn at(&self, holes: &[Hole], mount: &Pose, contact: &ContactSpec) -> Option<AtHole> {
        let mut over_mm: Option<f64> = None;
        for hole in holes {
            let from_mount = hole.from_base.compose(mount);
            let axis = from_mount.rotation * self.axis;
            if axis.z < Fit::TILT_MAX_COS {
                continue;
            }
            let tip_m = from_mount.rotation * self.tip_m + from_mount.translation_m;
            let held = Held { tip_mm: tip_m * MM, axis };
            let fit = fit(&self.spec, &hole.spec, contact);
            let lowest_mm = fit.lowest_mm(&held);
            if lowest_mm <= 0.0 {
                // All of the part is below the face.
                over_mm = Some(over_mm.map_or(-lowest_mm, |over| over.max(-lowest_mm)));
            } else if held.tip_mm.xy().norm() <= fit.hole_radius_mm + fit.hole_chamfer_mm {
                let contact = fit.contact(&held);
                let push = Vector3::new(contact.lateral_n.x, contact.lateral_n.y, -contact.axial_n);
                let force_n = hole.mouth.rotation * push;
                return Some(AtHole::In { force_n, steady_mm: fit.steady_mm(&held) });
            }
        }
        over_mm.map(AtHole::Over)
    }
}

fn fit(peg: &PegSpec, hole: &HoleSpec, contact: &ContactSpec) -> Fit {
    Fit {
        peg_radius_mm: 0.5 * peg.diameter_m * MM,
        peg_chamfer_mm: peg.chamfer_m * MM,
        hole_radius_mm: 0.5 * hole.diameter_m * MM,
        hole_chamfer_mm: hole.chamfer_m * MM,
        depth_mm: hole.depth_m * MM,
        friction: contact.friction,
        stiffness_n_per_mm: contact.stiffness_n_per_m / MM,
        lateral_n_per_mm: contact.lateral_n_per_m / MM,
        angular_nmm_per_rad: contact.angular_nm_per_rad * MM,
        press_mm: PRESS_MM,
    }
}
