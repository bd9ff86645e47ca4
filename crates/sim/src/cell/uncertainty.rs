//! What may go wrong in a workcell by itself, and how often: the checked numbers of its file.
//!
//! Probabilities are from 0 to 1. Knows nothing of how any of it is drawn or what follows from it.

use super::OffsetSpec;

/// How a held item slips in the gripper while the arm moves. Of the probabilities that apply to a
/// motion the largest counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipSpec {
    /// That it slips, by motion.
    pub probability: f64,
    /// That it slips in a motion that meets more than `contact_n`.
    pub in_contact: f64,
    /// The contact force above which `in_contact` holds, in newtons.
    pub contact_n: f64,
    /// That it slips in a motion that is faster than `fast_m_per_s`.
    pub fast: f64,
    /// The speed of the tool centre point above which `fast` holds, in metres a second.
    pub fast_m_per_s: f64,
    /// How far it slips, in the frame of the tool centre point.
    pub offset: OffsetSpec,
    /// That what slips is lost altogether.
    pub lost: f64,
}

/// What presents an item when it is asked to.
#[derive(Clone, Debug, PartialEq)]
pub struct FeederSpec {
    /// Its name.
    pub name: String,
    /// The item that it presents, by its place in the list; it lies where that should be.
    pub item: usize,
    /// The output that asks it.
    pub output: u16,
    /// The level to which that output changes to ask.
    pub asks_level: bool,
    /// The time from asking until the part is there, in seconds.
    pub delay_s: f64,
    /// Whether a part is there at the start.
    pub is_ready: bool,
    /// How many parts it can present when asked; endlessly many if none is said.
    pub parts: Option<u32>,
    /// That nothing comes, by asking.
    pub empty: f64,
    /// That the part lies askew, by part.
    pub askew: f64,
    /// How a part lies that lies askew, in its own frame.
    pub askew_offset: OffsetSpec,
    /// How near the part must be to its place to be seen there, in metres.
    pub near_m: f64,
}

/// What is wrong with the wire of an input.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct InputFlaw {
    /// That it stays at its level when it should change, until it should change again.
    pub stick: f64,
    /// That it flickers when it changes.
    pub bounce: f64,
    /// For how long, in seconds.
    pub bounce_s: f64,
}

/// What may go wrong in any motion, and on the wires.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ChanceSpec {
    /// That a motion stops short of its goal, by motion.
    pub stops_short: f64,
    /// That a protective stop ends it.
    pub protective_stop: f64,
    /// That an emergency stop ends it.
    pub emergency_stop: f64,
    /// That an output stays where it is when it is set to another level, by output; those behind
    /// the last never do.
    pub output_sticks: Vec<f64>,
    /// By input; those behind the last are as they should be.
    pub input_flaws: Vec<InputFlaw>,
}

/// When things fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallSpec {
    /// How high above something an item may be let go without falling, in metres.
    pub support_m: f64,
    /// The force from the side that knocks over an item that stands, in newtons.
    pub knock_n: f64,
}
