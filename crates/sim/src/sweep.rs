//! Contact along a route: the first place where force or a collision ends a motion.
//!
//! Every pair of a moving body and a standing one is looked at only when it could matter: from a
//! distance and an upper bound on the way of the body follows a fraction of the route before which
//! the two cannot meet (conservative advancement, so that nothing is ever stepped over). Bodies
//! that touch are followed in small steps, with the samples of the force sensor in between. A
//! contact force follows from how deep two bodies are pressed, and so from the place alone: going
//! back the same way finds the same forces. Knows nothing of commands and of what follows from a
//! stop.

use crate::bodies::{Mover, Moving, Place, moving, resting};
use crate::cell::ToolSpec;
use crate::gripper::Inventory;
use crate::insertion::{AtHole, HeldPeg, Over};
use crate::reader::{Look, ROUNDING_N, Reader};
use crate::route::Route;
use crate::seating::Seating;
use crate::sensor::Sensor;
use crate::world::{Owner, Standing, World};
use nalgebra::Vector3;

/// Millimetres in a metre.
const MM: f64 = 1e3;
/// Bodies nearer than this are followed as touching, in millimetres.
const SKIN_MM: f64 = 0.05;
/// Bodies farther apart than this are told apart by their bounding volumes alone.
const NEAR_MM: f64 = 5.0;
/// The way of a touching body between two looks, in millimetres: less than any margin.
const STEP_MM: f64 = 0.25;
/// The way of a peg in the bore of a hole between two looks, at most, in millimetres.
const BORE_STRIDE_MM: f64 = 5.0;
/// The part of a route by which links are looked at early, if another one is looked at anyway.
const EARLY: f64 = 0.1;
/// The pieces of a route in which pairs are told apart beforehand.
const PIECES: usize = 4;
/// Halvings of a step in search of the place where a force is exceeded.
const BISECTIONS: u32 = 32;

/// How a motion went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outcome {
    /// How far along the route it came.
    pub(crate) fraction: f64,
    pub(crate) end: End,
    /// The largest filtered force, if any was read on the way.
    pub(crate) peak_n: f64,
    /// The contact force at the end.
    pub(crate) force_n: f64,
}

/// What ended a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    /// The end of the route, or of the part of it that was asked for.
    Reached,
    /// The filtered force exceeded the limit.
    Force,
    /// It takes more looks than are allowed.
    GivenUp,
    /// A body met something and was pressed too hard.
    Collision { mover: Mover, owner: Owner, force_n: f64 },
}

/// A body that moves and one that stands.
struct Pair {
    moving: usize,
    standing: usize,
    /// The fraction of the route up to which the two cannot touch.
    due: f64,
    touching: bool,
    /// The part of the route that may pass before they must be looked at again, if they touch.
    stride: f64,
    /// The force on the moving body, in the base frame.
    force_n: Vector3<f64>,
    /// The least force between the two so far: less than that may always be gone back to.
    least_n: f64,
    /// Whether they press on each other where the route begins.
    begins_pressed: bool,
}

impl Pair {
    fn new(moving: usize, standing: usize) -> Self {
        Self {
            moving,
            standing,
            due: 0.0,
            touching: false,
            stride: 0.0,
            force_n: Vector3::zeros(),
            least_n: f64::INFINITY,
            begins_pressed: false,
        }
    }
}

/// A push from the side against an item that stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Push {
    /// The item, by its place in the cell's list.
    pub(crate) item: usize,
    /// The force on it along x and y of the base frame.
    pub(crate) towards_n: [f64; 2],
    /// The magnitude of that.
    pub(crate) force_n: f64,
}

/// What a look at all pairs found.
struct Seen {
    touching: bool,
    /// The magnitude of all contact forces together.
    force_n: f64,
    /// The fraction of the route at which to look next.
    next: f64,
    /// The first pair that is pressed too hard.
    collided: Option<usize>,
}

/// The search along one route.
pub(crate) struct Sweep<'a> {
    world: &'a World,
    route: &'a Route,
    /// Whether the motion has a force limit of its own.
    guarded: bool,
    resting: Vec<Standing>,
    moving: Vec<Moving>,
    pairs: Vec<Pair>,
    peg: Option<HeldPeg>,
    /// The largest contact force that was met.
    pub(crate) most_n: f64,
    /// The hardest push from the side against an item that stands.
    pub(crate) pushed: Option<Push>,
    /// How often all pairs may be looked at, if not as often as it takes.
    pub(crate) looks_max: Option<u32>,
}

impl<'a> Sweep<'a> {
    /// Prepare the search: only pairs that could meet on this route are kept. The held item was
    /// left in a seat so, if it was.
    pub(crate) fn new(
        world: &'a World,
        route: &'a Route,
        items: &Inventory,
        tool: &ToolSpec,
        left: Option<&Seating>,
    ) -> Self {
        let cell = &world.cell;
        let mut sweep = Self {
            world,
            route,
            guarded: false,
            resting: resting(cell, items),
            moving: Vec::new(),
            pairs: Vec::new(),
            peg: HeldPeg::of(cell, items),
            most_n: 0.0,
            pushed: None,
            looks_max: None,
        };
        if let Some(peg) = &mut sweep.peg {
            peg.approach(world, route, items, left);
        }
        if !(world.fixed.is_empty() && sweep.resting.is_empty()) {
            sweep.moving = moving(cell, route, items, tool);
            sweep.pairs = sweep.pair_up();
        }
        sweep
    }

    /// The pairs that could meet: from the middle of a piece of the route no body goes farther than
    /// half its way along the piece.
    fn pair_up(&self) -> Vec<Pair> {
        let mut whole = Place::at(self.route, 0.5);
        let mut pairs = Vec::with_capacity(32);
        for (moving, body) in self.moving.iter().enumerate() {
            for standing in 0..self.world.fixed.len() + self.resting.len() {
                if self.apart_mm(moving, standing, &mut whole) <= 0.5 * body.way_mm + SKIN_MM {
                    pairs.push(Pair::new(moving, standing));
                }
            }
        }
        let middle = |piece: usize| (piece as f64 + 0.5) / PIECES as f64;
        let mut pieces: [Place<'_>; PIECES] =
            std::array::from_fn(|piece| Place::at(self.route, middle(piece)));
        pairs.retain_mut(|pair| {
            let half_mm = 0.5 * self.moving[pair.moving].way_mm / PIECES as f64;
            let first = pieces.iter_mut().position(|place| {
                self.apart_mm(pair.moving, pair.standing, place) <= half_mm + SKIN_MM
            });
            pair.due = first.map_or(1.0, |piece| piece as f64 / PIECES as f64);
            first.is_some()
        });
        pairs
    }

    /// A distance that is not above the true one.
    fn apart_mm(&self, moving: usize, standing: usize, place: &mut Place<'_>) -> f64 {
        let (body, carrier) = self.moving[moving].at(place);
        self.standing(standing).obstacle.at_least_mm(body, carrier)
    }

    fn standing(&self, index: usize) -> &Standing {
        let fixed = self.world.fixed.len();
        if index < fixed { &self.world.fixed[index] } else { &self.resting[index - fixed] }
    }

    /// Follow the route up to the fraction `until`, from the time `now_s` and a contact force
    /// `force_n` at its start.
    pub(crate) fn run(
        &mut self,
        until: f64,
        now_s: f64,
        force_n: f64,
        limit_n: Option<f64>,
    ) -> Outcome {
        let outcome = self.search(until, now_s, force_n, limit_n);
        self.note(outcome.force_n);
        outcome
    }

    fn search(&mut self, until: f64, now_s: f64, force_n: f64, limit_n: Option<f64>) -> Outcome {
        let sensor = Sensor { spec: &self.world.sensor, seed: self.world.seed };
        // Where noise alone may exceed the limit, every sample counts.
        let watched = limit_n.is_some_and(|limit| limit <= sensor.idle_max_n());
        if self.pairs.is_empty() && !watched {
            return Outcome { fraction: until, end: End::Reached, peak_n: 0.0, force_n: 0.0 };
        }
        self.guarded = limit_n.is_some();
        let mut reader = Reader::new(sensor, self.route, limit_n, now_s, force_n);
        let mut before = Look { fraction: 0.0, force_n };
        let (mut fraction, mut looks) = (0.0, 0);
        loop {
            if self.looks_max.is_some_and(|looks_max| looks >= looks_max) {
                let (peak_n, force_n) = (reader.peak_n(), before.force_n);
                return Outcome { fraction, end: End::GivenUp, peak_n, force_n };
            }
            looks += 1;
            let seen = self.look(fraction);
            // A guard that reads late still stops the motion, but where it began pressed already.
            if let Some(index) = seen.collided.filter(|index| self.pairs[*index].begins_pressed) {
                return self.collide(index, before, fraction, &mut reader);
            }
            let here = Look { fraction, force_n: seen.force_n };
            if let Some(stop) = reader.pass(before, here) {
                return self.stop(stop, &reader);
            }
            if let Some(index) = seen.collided {
                return self.collide(index, before, fraction, &mut reader);
            }
            if fraction >= until {
                let (peak_n, force_n) = (reader.peak_n(), seen.force_n);
                return Outcome { fraction, end: End::Reached, peak_n, force_n };
            }
            if seen.touching || watched {
                reader.start(fraction);
            } else {
                reader.rest();
            }
            self.note(here.force_n);
            before = here;
            fraction = seen.next.max(fraction + f64::EPSILON).min(until);
        }
    }

    /// Take note of the forces where the motion has come to.
    fn note(&mut self, force_n: f64) {
        self.most_n = self.most_n.max(force_n);
        if force_n <= 0.0 || self.resting.is_empty() {
            return;
        }
        for pair in &self.pairs {
            let Owner::Item(item) = self.standing(pair.standing).owner else { continue };
            let [x, y] = [-pair.force_n.x, -pair.force_n.y];
            let push = Push { item, towards_n: [x, y], force_n: libm::hypot(x, y) };
            if self.pushed.is_none_or(|most| push.force_n > most.force_n) {
                self.pushed = Some(push);
            }
        }
    }

    /// How the held item is left in a seat at a fraction of the route.
    pub(crate) fn left(&self, fraction: f64) -> Option<Seating> {
        let peg = self.peg.as_ref()?;
        peg.left(fraction, &self.route.mount_at(fraction), &self.world.cell.contact)
    }

    /// Look at every pair that is due.
    fn look(&mut self, fraction: f64) -> Seen {
        let mut place = Place::at(self.route, fraction);
        let mut pairs = std::mem::take(&mut self.pairs);
        let mut seen = Seen { touching: false, force_n: 0.0, next: 1.0, collided: None };
        let mut sum_n = Vector3::zeros();
        for (index, pair) in pairs.iter_mut().enumerate() {
            let early = self.moving[pair.moving].is_link() && place.knows_links();
            let horizon = if early { fraction + EARLY } else { fraction };
            if pair.touching || pair.due <= horizon {
                self.look_at(pair, &mut place);
                let force_n = pair.force_n.norm();
                pair.begins_pressed |= fraction <= 0.0 && force_n > 0.0;
                pair.least_n = pair.least_n.min(force_n);
            }
            if pair.touching {
                seen.touching = true;
                sum_n += pair.force_n;
                seen.next = seen.next.min(fraction + pair.stride);
                if seen.collided.is_none() && self.is_collided(pair) {
                    seen.collided = Some(index);
                }
            } else {
                seen.next = seen.next.min(pair.due);
            }
        }
        self.pairs = pairs;
        seen.force_n = sum_n.norm();
        seen
    }

    /// Look again at a fraction that was passed already; the force there.
    fn look_again(&mut self, fraction: f64) -> f64 {
        for pair in &mut self.pairs {
            pair.due = pair.due.min(fraction);
        }
        self.look(fraction).force_n
    }

    fn look_at(&self, pair: &mut Pair, place: &mut Place<'_>) {
        let moving = &self.moving[pair.moving];
        let standing = self.standing(pair.standing);
        let (fraction, mount) = (place.fraction, place.mount);
        let (body, carrier) = moving.at(place);
        let mut apart_mm = standing.obstacle.at_least_mm(body, carrier);
        let (mut stride_mm, mut seat_stride) = (STEP_MM, None);
        pair.force_n = Vector3::zeros();
        if apart_mm < NEAR_MM {
            let contact = &self.world.cell.contact;
            let peg = self.peg.as_ref().filter(|_| moving.is_peg);
            let (number, holes) = (pair.standing, &standing.holes);
            let over = Over { standing: number, holes, fraction, mount: &mount };
            match peg.and_then(|peg| peg.at(&over, contact)) {
                Some(AtHole::Over(over_mm)) => apart_mm = over_mm.max(apart_mm),
                Some(AtHole::In { force_n, steady_mm, stride }) => {
                    (apart_mm, seat_stride) = (0.0, stride);
                    pair.force_n = force_n;
                    stride_mm = steady_mm.clamp(STEP_MM, BORE_STRIDE_MM);
                }
                None => {
                    let gap = standing.obstacle.gap(body, carrier);
                    let pressed_m = -gap.distance_mm.min(0.0) / MM;
                    pair.force_n = gap.normal * (contact.stiffness_n_per_m * pressed_m);
                    apart_mm = gap.distance_mm;
                }
            }
        }
        pair.touching = apart_mm <= SKIN_MM;
        pair.stride = seat_stride.unwrap_or(stride_mm / moving.way_mm);
        pair.due = fraction + (apart_mm - 0.5 * SKIN_MM) / moving.way_mm;
    }

    /// Whether a pair is pressed too hard, and harder than it was before on this route. A guard
    /// reads late, and so a motion that has one may press harder, up to what a body gives; but not
    /// a pair that it begins in contact with, or a row of such motions would press ever harder.
    fn is_collided(&self, pair: &Pair) -> bool {
        let moving = &self.moving[pair.moving];
        let reads_late = self.guarded && !pair.begins_pressed;
        let stop_n = if reads_late { moving.give_n } else { moving.stop_n };
        pair.force_n.norm() > stop_n.max(pair.least_n + ROUNDING_N)
    }

    /// The motion ends where the reading exceeded the limit.
    fn stop(&mut self, fraction: f64, reader: &Reader<'_>) -> Outcome {
        let force_n = self.look_again(fraction);
        Outcome { fraction, end: End::Force, peak_n: reader.peak_n(), force_n }
    }

    /// Go back to where the force of a pair became too much; there the motion ends, if the guard
    /// has not stopped it before.
    fn collide(
        &mut self,
        index: usize,
        before: Look,
        fraction: f64,
        reader: &mut Reader<'_>,
    ) -> Outcome {
        let mut pairs = std::mem::take(&mut self.pairs);
        let (mut low, mut high) = (before.fraction, fraction);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            self.look_at(&mut pairs[index], &mut Place::at(self.route, middle));
            if self.is_collided(&pairs[index]) {
                high = middle;
            } else {
                low = middle;
            }
        }
        self.pairs = pairs;
        let force_n = self.look_again(high);
        if let Some(stop) = reader.pass(before, Look { fraction: high, force_n }) {
            return self.stop(stop, reader);
        }
        let end = if reader.sample(force_n) {
            End::Force
        } else {
            let pair = &self.pairs[index];
            End::Collision {
                mover: self.moving[pair.moving].mover,
                owner: self.standing(pair.standing).owner,
                force_n: pair.force_n.norm(),
            }
        };
        Outcome { fraction: high, end, peak_n: reader.peak_n(), force_n }
    }
}

#[cfg(test)]
mod tests;
