//! The seat of a hole in a workcell file: its keys, and what they must be together.

use super::file::HoleFile;
use super::number::{
    ForceLimitN, ForceN, NearDeg, NearMm, PitchMm, SizeMm, StiffnessNPerMm, TighteningNPerDeg,
    Turns,
};
use crate::seat::{Press, Seat, Snap, Thread};
use serde::Deserialize;
use std::f64::consts::{PI, TAU};

const MM: f64 = 1e-3;
const DEG: f64 = PI / 180.0;
/// The part of a turn after which an item is tight that has caught across a thread, if it is not
/// said.
const CROSS_TURNS: f64 = 0.25;
/// How the force at the circumference grows when what is tight is turned on, if it is not said, in
/// newtons a degree.
const TIGHTEN_N_PER_DEG: f64 = 2.0;

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SnapFile {
    at_mm: SizeMm,
    travel_mm: SizeMm,
    peak_n: ForceLimitN,
    hold_n: ForceN,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PressFile {
    force_n_per_mm: StiffnessNPerMm,
    hold_n: ForceN,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ThreadFile {
    at_mm: SizeMm,
    pitch_mm: PitchMm,
    turns: Turns,
    catch_mm: NearMm,
    catch_deg: NearDeg,
    cross_turns: Option<Turns>,
    tighten_n_per_deg: Option<TighteningNPerDeg>,
    give_n_per_mm: Option<StiffnessNPerMm>,
}

/// The seat of a hole of a depth, if it has one; why there is no such seat.
pub(super) fn of(file: &HoleFile, depth_m: f64) -> Result<Option<Seat>, String> {
    match (&file.snap, &file.press, &file.thread) {
        (None, None, None) => Ok(None),
        (Some(snap), None, None) => snap.checked(depth_m).map(|snap| Some(Seat::Snap(snap))),
        (None, Some(press), None) => Ok(Some(Seat::Press(press.in_metres()))),
        (None, None, Some(thread)) => {
            thread.checked(depth_m).map(|thread| Some(Seat::Thread(thread)))
        }
        _ => Err("a hole has at most one of `snap`, `press` and `thread`".to_owned()),
    }
}

impl SnapFile {
    fn checked(&self, depth_m: f64) -> Result<Snap, String> {
        let snap = Snap {
            at_m: self.at_mm.0 * MM,
            travel_m: self.travel_mm.0 * MM,
            peak_n: self.peak_n.0,
            hold_n: self.hold_n.0,
        };
        if snap.at_m > depth_m {
            return Err(format!(
                "an item cannot snap in at {} mm, which is below the bottom of the hole",
                self.at_mm.0
            ));
        }
        if snap.travel_m > snap.at_m {
            return Err(format!(
                "the force cannot rise over {} mm before {} mm: that begins above the hole",
                self.travel_mm.0, self.at_mm.0
            ));
        }
        Ok(snap)
    }
}

impl PressFile {
    fn in_metres(&self) -> Press {
        Press { force_n_per_m: self.force_n_per_mm.0 / MM, hold_n: self.hold_n.0 }
    }
}

impl ThreadFile {
    fn checked(&self, depth_m: f64) -> Result<Thread, String> {
        let cross_turns = self.cross_turns.map_or(CROSS_TURNS.min(self.turns.0), |turns| turns.0);
        let tighten = self.tighten_n_per_deg.map_or(TIGHTEN_N_PER_DEG, |force| force.0);
        let thread = Thread {
            at_m: self.at_mm.0 * MM,
            pitch_m: self.pitch_mm.0 * MM,
            turns_rad: self.turns.0 * TAU,
            catch_m: self.catch_mm.0 * MM,
            catch_rad: self.catch_deg.0 * DEG,
            cross_rad: cross_turns * TAU,
            tighten_n_per_rad: tighten / DEG,
            give_n_per_m: self.give_n_per_mm.map(|give| give.0 / MM),
        };
        let end_mm = self.at_mm.0 + self.pitch_mm.0 * self.turns.0;
        if end_mm * MM > depth_m {
            return Err(format!(
                "the thread leads to {end_mm} mm, which is below the bottom of the hole"
            ));
        }
        if thread.cross_rad > thread.turns_rad {
            return Err(format!(
                "an item that has caught across cannot turn {cross_turns} times where one that \
                 has not turns {} times",
                self.turns.0
            ));
        }
        Ok(thread)
    }
}
