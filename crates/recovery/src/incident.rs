//! An error at a place, and what has been tried against it.
//!
//! An incident is open from when its error is due until the run has passed the action that failed,
//! or gives it up. The same error at the same place while it is open is the same incident.

use crate::ending::GiveUp;
use obverse_isa::ErrorId;

/// One way back and forward again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt {
    /// How many actions it went back; 0 where the arm stayed.
    pub actions: usize,
    /// When it began, in seconds of the workcell's clock.
    pub began_s: f64,
}

/// What became of an incident.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The run got past it.
    Recovered,
    /// It was given up.
    GivenUp(GiveUp),
}

/// An error at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Incident {
    /// The error.
    pub error: ErrorId,
    /// Where it was due first.
    pub pc: u32,
    /// The place of the action that failed, in words that a person knows it by.
    pub place: String,
    /// The action that failed: how many actions of the run lie before it.
    pub number: u64,
    /// The source entry of the action that failed, by its first instruction.
    pub entry: u32,
    /// When it was due first, in seconds of the workcell's clock.
    pub began_s: f64,
    /// How far the arm had gone by then, in metres.
    pub began_way_m: f64,
    /// What has been tried.
    pub attempts: Vec<Attempt>,
    /// What became of it, and when, in seconds of the workcell's clock.
    pub outcome: Option<(Outcome, f64)>,
}

impl Incident {
    /// How far each attempt went back.
    #[must_use]
    pub fn depths(&self) -> Vec<usize> {
        self.attempts.iter().map(|attempt| attempt.actions).collect()
    }

    /// How far the attempt went back that was enough; none unless it was recovered from.
    #[must_use]
    pub fn depth_enough(&self) -> Option<usize> {
        match self.outcome {
            Some((Outcome::Recovered, _)) => self.attempts.last().map(|attempt| attempt.actions),
            _ => None,
        }
    }

    /// How long it was open, in seconds of the workcell's clock; none while it is.
    #[must_use]
    pub fn duration_s(&self) -> Option<f64> {
        self.outcome.map(|(_, ended_s)| ended_s - self.began_s)
    }
}
