//! Seats: what a hole does to an item beside guiding it. Quasi-static, exact and without time.
//!
//! The hand gives way along the axis of the hole with a stiffness `K`. So an item that is held at a
//! depth `z` may truly be at another, `s`, and the hand feels `K (z - s)`: against the insertion
//! when the item is pushed, against the retreat when it is pulled. A seat says where `s` is. It
//! knows how deep the item truly was when the motion began, `s0`, and takes the motion for one that
//! goes one way; so the force follows from places alone, however a motion is cut into pieces.
//!
//! - *snap*: a lip rises over `travel` up to the depth `at`, and the force with it, to `peak`. Then
//!   the item snaps in, and the force is gone. Pulled, it goes back as far as `at`, where it holds
//!   up to `hold`.
//! - *press*: an item that is thicker than the hole is held by friction all around. From the throat
//!   on the force grows with the depth. Pulled, the item stays where it is up to `hold`, wherever
//!   that is. What the wall gives way by is as much again as the item is too thick: within that the
//!   item may lean and be aside, and rubs (see [`peg`](crate::peg)); beyond, it wedges.
//! - *thread* or *bayonet*: at the depth `at` the item sits on the beginning of the thread and goes
//!   no further. Turned there by the right hand about the axis into the hole, it catches, and goes
//!   on by the pitch each turn (by nothing in a bayonet), until after `turns` it is tight. What has
//!   caught is held both ways until it is turned back. Turned on an axis too far aside or too
//!   tilted it catches across, and is tight after a part of a turn. The torque of turning what is
//!   tight is given as the force at the item's circumference, added to that along the axis: the
//!   guard of a motion knows forces alone.
//!
//! Metres, newtons and radians. Knows one seat and one item, and no arm, path or sensor.

use std::f64::consts::TAU;

/// What a hole does to an item beside guiding it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seat {
    /// It snaps in.
    Snap(Snap),
    /// It is pressed in.
    Press(Press),
    /// It is screwed in, or turned to lock.
    Thread(Thread),
}

/// A lip that an item snaps behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// The depth of the item's end when it snaps in, in metres.
    pub at_m: f64,
    /// The way over which the force rises before, in metres.
    pub travel_m: f64,
    /// What it rises to, in newtons.
    pub peak_n: f64,
    /// The pull that brings the item out again, in newtons.
    pub hold_n: f64,
}

/// A hole that is narrower than the item.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// How the force grows with the depth, in newtons a metre.
    pub force_n_per_m: f64,
    /// The pull that moves the item out again, in newtons.
    pub hold_n: f64,
}

/// A thread, or with no pitch a bayonet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thread {
    /// The depth of the item's end where the thread begins, in metres.
    pub at_m: f64,
    /// How far a turn leads, in metres.
    pub pitch_m: f64,
    /// How far the item turns until it is tight, in radians.
    pub turns_rad: f64,
    /// How far aside the item may be when it catches, in metres.
    pub catch_m: f64,
    /// How much it may be tilted then, in radians.
    pub catch_rad: f64,
    /// How far an item turns that has caught across, in radians.
    pub cross_rad: f64,
    /// How the force at the circumference grows when what is tight is turned on, in newtons a
    /// radian.
    pub tighten_n_per_rad: f64,
    /// How the tool gives way along its axis, if not as the arm does, in newtons a metre.
    pub give_n_per_m: Option<f64>,
}

/// What surrounds a seat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around {
    /// The stiffness of the hand along the axis, in newtons a metre.
    pub give_n_per_m: f64,
    /// The depth of the item's end at which its side passes the narrowest place, in metres.
    pub throat_m: f64,
    /// The greatest depth of the item's end, in metres.
    pub bottom_m: f64,
}

/// How an item was in a seat when a motion began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// How deep its end truly was, in metres.
    pub depth_m: f64,
    /// How far it was turned in the thread, in radians.
    pub turned_rad: f64,
    /// Whether it has caught across, or will if it does.
    pub crossed: bool,
}

/// How an item is held over a seat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// How deep its end would be if nothing held it, in metres.
    pub depth_m: f64,
    /// How far it has been turned since the motion began or, if later, it came to the thread, in
    /// radians by the right hand about the axis into the hole.
    pub turned_rad: f64,
}

/// How an item is in a seat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seated {
    /// How deep its end truly is, in metres.
    pub depth_m: f64,
    /// How far it is turned in the thread, in radians.
    pub turned_rad: f64,
    /// The force out of the hole, against the insertion; below zero it holds the item back.
    pub axial_n: f64,
    /// The torque of turning what is tight, as the force at the circumference.
    pub twist_n: f64,
}

impl Seat {
    /// How an item is in the seat that was there at the start and is now held so.
    #[must_use]
    pub fn seated(&self, around: &Around, start: &Start, hand: &Hand) -> Seated {
        let around = &Around { give_n_per_m: self.give_n_per_m(around), ..*around };
        let (depth_m, turned_rad, twist_n) = match self {
            Self::Snap(snap) => (snap.depth_m(around, start, hand), 0.0, 0.0),
            Self::Press(press) => (press.depth_m(around, start, hand), 0.0, 0.0),
            Self::Thread(thread) => thread.place(start, hand),
        };
        let depth_m = depth_m.min(around.bottom_m);
        let axial_n = around.give_n_per_m * (hand.depth_m - depth_m);
        Seated { depth_m, turned_rad, axial_n, twist_n }
    }

    /// How far along the axis an item that is held at a depth can be moved before its contact
    /// changes at once.
    #[must_use]
    pub fn steady_m(&self, around: &Around, hand: &Hand) -> f64 {
        let give = self.give_n_per_m(around);
        let changes_m = match self {
            Self::Snap(snap) => [
                snap.at_m - snap.travel_m,
                snap.at_m - snap.hold_n / give,
                snap.at_m,
                snap.at_m + snap.peak_n / give,
            ],
            Self::Press(press) => {
                let (throat, out) = (around.throat_m, around.throat_m - press.hold_n / give);
                [throat, out, throat, out]
            }
            Self::Thread(thread) => [thread.at_m; 4],
        };
        let away = changes_m.map(|change_m| (change_m - hand.depth_m).abs());
        away.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// How far an item can be turned before its contact changes at once.
    #[must_use]
    pub fn steady_rad(&self, start: &Start, hand: &Hand) -> f64 {
        let Self::Thread(thread) = self else { return f64::INFINITY };
        let wanted_rad = start.turned_rad + hand.turned_rad;
        wanted_rad.abs().min((thread.most_rad(start) - wanted_rad).abs())
    }

    fn give_n_per_m(&self, around: &Around) -> f64 {
        match self {
            Self::Thread(Thread { give_n_per_m: Some(give), .. }) => *give,
            _ => around.give_n_per_m,
        }
    }
}

impl Snap {
    fn depth_m(&self, around: &Around, start: &Start, hand: &Hand) -> f64 {
        let (give, z) = (around.give_n_per_m, hand.depth_m);
        let is_in = start.depth_m >= self.at_m;
        if is_in {
            // Behind the lip it is free; it comes out where the lip holds no more.
            let out = give * (self.at_m - z) > self.hold_n;
            return if out { z } else { z.max(self.at_m) };
        }
        let begin_m = self.at_m - self.travel_m;
        let snaps = give * (z - self.at_m) > self.peak_n;
        if snaps || z <= begin_m {
            return z;
        }
        // The hand and the lip are two springs one behind the other.
        let lip = self.peak_n / self.travel_m;
        ((give * z + lip * begin_m) / (give + lip)).min(self.at_m)
    }
}

impl Press {
    fn depth_m(&self, around: &Around, start: &Start, hand: &Hand) -> f64 {
        let (give, z, throat_m) = (around.give_n_per_m, hand.depth_m, around.throat_m);
        let wall = self.force_n_per_m;
        // As deep as the push has brought it, and as far out as the pull.
        let pushed_m = if z > throat_m { (give * z + wall * throat_m) / (give + wall) } else { z };
        let pulled_m = z + self.hold_n / give;
        let depth_m = start.depth_m.max(pushed_m).min(pulled_m);
        if depth_m > throat_m { depth_m } else { z }
    }
}

impl Thread {
    /// How deep, how far turned, and the force at the circumference.
    fn place(&self, start: &Start, hand: &Hand) -> (f64, f64, f64) {
        let wanted_rad = start.turned_rad + hand.turned_rad;
        if wanted_rad <= 0.0 {
            return (hand.depth_m.min(self.at_m), 0.0, 0.0);
        }
        let turned_rad = wanted_rad.min(self.most_rad(start));
        let twist_n = self.tighten_n_per_rad * (wanted_rad - turned_rad);
        (self.at_m + self.lead_m(turned_rad), turned_rad, twist_n)
    }

    /// How far an item turns until it is tight.
    fn most_rad(&self, start: &Start) -> f64 {
        if start.crossed { self.cross_rad } else { self.turns_rad }
    }

    /// How far a turn leads.
    fn lead_m(&self, turned_rad: f64) -> f64 {
        self.pitch_m * (turned_rad / TAU)
    }

    /// How far an item is turned whose end lies at a depth.
    #[must_use]
    pub fn turned_at_rad(&self, depth_m: f64) -> f64 {
        if self.pitch_m <= 0.0 {
            return 0.0;
        }
        (TAU * (depth_m - self.at_m) / self.pitch_m).clamp(0.0, self.turns_rad)
    }

    /// Whether an item that is so far aside and so tilted catches across.
    #[must_use]
    pub fn is_crossed(&self, aside_m: f64, tilt_rad: f64) -> bool {
        aside_m > self.catch_m || tilt_rad > self.catch_rad
    }
}

#[cfg(test)]
mod tests;
