//! What moves on a route and what stands still: bodies, and how far a route carries each.
//!
//! Knows the arm's links, the tool, the held item and the items that lie about; not what happens
//! when two of them meet.

use crate::cell::{Cell, Part, ToolSpec};
use crate::collision::{Body, Obstacle};
use crate::gripper::Inventory;
use crate::kinematics::links;
use crate::line::Line;
use crate::robot;
use crate::route::Route;
use crate::world::{Owner, Standing};
use nalgebra::Vector3;
use obverse_geometry::{JOINT_COUNT, Pose};

/// Millimetres in a metre.
const MM: f64 = 1e3;
/// Between the knots of a line a link may move faster than from knot to knot.
const KNOT_RESERVE: f64 = 1.5;
/// How much of its margin a body may be pressed before the force counts as too much for it.
const PRESSED_SHARE: f64 = 0.8;

/// Whose a moving body is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mover {
    /// A link of the arm.
    Link(usize),
    /// A part of the tool.
    Tool,
    /// A part of the held item, by the item's place in the cell's list.
    Item(usize),
}

/// What carries a moving body.
enum Carrier {
    /// It is a link itself.
    Link(usize),
    /// The tool mount.
    Mount(Body),
}

/// A body that moves on a route.
pub(crate) struct Moving {
    pub(crate) mover: Mover,
    carrier: Carrier,
    /// Whether it is the body of the held peg.
    pub(crate) is_peg: bool,
    /// An upper bound on the way of any point of it along the whole route, in millimetres.
    pub(crate) way_mm: f64,
    /// Pressed harder than this it has collided, in newtons, but for a guard that reads late.
    pub(crate) stop_n: f64,
    /// Pressed harder than this by any motion it has collided: its margin is used up.
    pub(crate) give_n: f64,
}

impl Moving {
    /// The body, and the pose of the frame that it is given in.
    pub(crate) fn at<'p>(&'p self, place: &'p mut Place<'_>) -> (&'p Body, &'p Pose) {
        match &self.carrier {
            Carrier::Link(index) => {
                if place.links.is_empty() {
                    place.find_links();
                }
                (&place.links[*index], &place.base)
            }
            Carrier::Mount(body) => (body, &place.mount),
        }
    }

    pub(crate) fn is_link(&self) -> bool {
        matches!(self.carrier, Carrier::Link(_))
    }
}

/// Where the robot is at a fraction of a route.
pub(crate) struct Place<'a> {
    route: &'a Route,
    pub(crate) fraction: f64,
    base: Pose,
    pub(crate) mount: Pose,
    /// The bodies of the links; empty until someone asks.
    links: Vec<Body>,
}

impl<'a> Place<'a> {
    pub(crate) fn at(route: &'a Route, fraction: f64) -> Self {
        let mut place = Self {
            route,
            fraction,
            base: Pose::identity(),
            mount: Pose::identity(),
            links: Vec::new(),
        };
        match &route.line {
            Some(line) => place.mount = line.mount_at(fraction),
            None => place.mount = place.find_links(),
        }
        place
    }

    /// Find the links; the mount that comes with them.
    fn find_links(&mut self) -> Pose {
        let frames = links(&self.route.joints_at(self.fraction));
        self.links.extend((0..JOINT_COUNT).map(|index| robot::link(index, &frames)));
        frames.mount
    }

    /// Whether the links are known here, so that looking at another costs little.
    pub(crate) fn knows_links(&self) -> bool {
        !self.links.is_empty()
    }
}

/// The parts of the items that are not held.
pub(crate) fn resting(cell: &Cell, items: &Inventory) -> Vec<Standing> {
    let mut parts = Vec::new();
    for (index, pose) in items.lying() {
        for part in &cell.items[index].parts {
            let obstacle = Obstacle::of(part, pose);
            parts.push(Standing { owner: Owner::Item(index), obstacle, holes: Vec::new() });
        }
    }
    parts
}

/// The links of the arm, the parts of the tool and those of the held item.
pub(crate) fn moving(
    cell: &Cell,
    route: &Route,
    items: &Inventory,
    tool: &ToolSpec,
) -> Vec<Moving> {
    let ways = Ways::of(route);
    let contact = &cell.contact;
    let link = |index| Moving {
        mover: Mover::Link(index),
        carrier: Carrier::Link(index),
        is_peg: false,
        way_mm: ways.link_mm(index),
        stop_n: contact.stop_force_n,
        give_n: f64::INFINITY,
    };
    let carried = |mover, part: &Part, is_peg| {
        let body = Body::of(part);
        let give_n = PRESSED_SHARE * body.margin_mm() * contact.stiffness_n_per_m / MM;
        let way_mm = ways.carried_mm(&body, &tool.tcp);
        let stop_n = contact.stop_force_n.min(give_n);
        Moving { mover, carrier: Carrier::Mount(body), is_peg, way_mm, stop_n, give_n }
    };
    let mut moving = Vec::with_capacity(16);
    moving.extend((0..JOINT_COUNT).map(link));
    moving.extend(tool.parts.iter().map(|part| carried(Mover::Tool, part, false)));
    if let Some((index, in_mount)) = items.held_in_mount() {
        let item = &cell.items[index];
        for (number, part) in item.parts.iter().enumerate() {
            let part = Part { pose: in_mount.compose(&part.pose), shape: part.shape };
            // The first part of a peg is the peg.
            moving.push(carried(Mover::Item(index), &part, item.peg.is_some() && number == 0));
        }
    }
    moving
}

/// Upper bounds on the way of any point of a body along a whole route, in millimetres.
enum Ways<'a> {
    /// From the turn of each joint.
    Joints([f64; JOINT_COUNT]),
    /// From the line of the tool, and for each link from the ways of its ends between knots.
    Line { line: &'a Line, links_mm: [f64; JOINT_COUNT] },
}

impl<'a> Ways<'a> {
    fn of(route: &'a Route) -> Self {
        let Some(line) = &route.line else {
            let turn = |joint: usize| (route.to.0[joint] - route.from.0[joint]).abs();
            return Self::Joints(std::array::from_fn(turn));
        };
        let mut links_mm = [0.0_f64; JOINT_COUNT];
        let mut before: Option<(f64, [[Vector3<f64>; 2]; JOINT_COUNT])> = None;
        for knot in line.knots() {
            let frames = links(&knot.joints);
            let ends_m = std::array::from_fn(|index| robot::link_ends_m(index, &frames));
            if let Some((fraction, from_m)) = &before {
                let part = knot.fraction - fraction;
                for ((way_mm, from), to) in links_mm.iter_mut().zip(from_m).zip(&ends_m) {
                    let chord_m = (to[0] - from[0]).norm().max((to[1] - from[1]).norm());
                    *way_mm = way_mm.max(KNOT_RESERVE * chord_m * MM / part);
                }
            }
            before = Some((knot.fraction, ends_m));
        }
        Self::Line { line, links_mm }
    }

    fn link_mm(&self, index: usize) -> f64 {
        match self {
            Self::Joints(turns) => robot::link_way_mm(index, turns),
            Self::Line { links_mm, .. } => links_mm[index],
        }
    }

    fn carried_mm(&self, body: &Body, tcp: &Pose) -> f64 {
        match self {
            Self::Joints(turns) => robot::mount_way_mm(body.extent_mm(&Vector3::zeros()), turns),
            Self::Line { line, .. } => {
                line.length_m() * MM + line.angle_rad() * body.extent_mm(&tcp.translation_m)
            }
        }
    }
}
