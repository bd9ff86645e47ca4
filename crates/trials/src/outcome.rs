//! How an assembly ended, as data that is the same whoever computed it and wherever.

use crate::strategy::Strategy;
use serde::{Deserialize, Serialize};

/// How one assembly ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The program ended, no error is pending, and the assembly is as the workcell file says that
    /// it should be.
    Succeeded,
    /// The program ended and believes that all is well, and the assembly is not as it should be.
    FalseSuccess,
    /// Recovery was given up, for a reason that is named, and the arm holds.
    GivenUp,
    /// The workcell did not do as commanded, and the program maps that to no error.
    Fault,
    /// The machine refuses to go on.
    Trap,
    /// As many instructions as were allowed have been run.
    Limit,
}

/// What a stop of the workcell, without which there would have been no error or no blocked way
/// back, asked of a person: the fresh command before which nothing moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stop {
    /// It was given.
    Released,
    /// It was not: the error could not be dealt with, and the arm holds.
    Held,
}

/// An error that came up, and what was done about it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Incident {
    /// The error's name.
    pub error: String,
    /// Where it came up: file and line.
    pub place: String,
    /// How many actions it went back by at each attempt, in order; 0 is in place.
    pub depths: Vec<u32>,
    /// Whether the program went on past that place afterwards.
    pub recovered: bool,
    /// What a stop of the workcell asked of a person for it, if one came with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<Stop>,
    /// Whether that was by what the program does where going back has been given up: no depth of
    /// going back was enough then.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub otherwise: bool,
    /// What is learned of it: how far the attempts went back of which it is known what came of
    /// them, and whether the last was enough. Learning comes before the campaign, and so no file
    /// holds it.
    #[serde(skip)]
    pub lesson: Option<(Vec<usize>, bool)>,
    /// What truly was the matter, where the workcell can tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<String>,
}

/// What came of one assembly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// How it ended.
    pub ending: Ending,
    /// Why it ended so, if not by success: which bound was met, which fault, which goal was missed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
    /// How often something was tried again.
    pub attempts: u32,
    /// How long it took by the workcell's clock, in seconds.
    pub makespan_s: f64,
    /// How often a person gave the fresh command without which nothing moves after a stop.
    pub releases: u32,
    /// How long a person was busy with it on top of that, in seconds.
    pub person_s: f64,
    /// How many instructions were run or reversed.
    pub instructions: u64,
    /// The errors that came up, in order.
    pub incidents: Vec<Incident>,
}

impl Outcome {
    /// How long it took altogether, in seconds: the cell stands still while a person is at it.
    #[must_use]
    pub fn total_s(&self) -> f64 {
        self.makespan_s + self.person_s
    }

    /// Whether a person had to come, to set it right or to release the arm; also who finds later
    /// that the assembly is not as it should be.
    #[must_use]
    pub fn takes_a_person(&self) -> bool {
        self.ending != Ending::Succeeded || self.releases > 0
    }

    /// What brought a person, in words; none where nobody had to come. It is one thing: what the
    /// assembly ended in, or else that the arm was released.
    #[must_use]
    pub fn brought_a_person(&self) -> Option<String> {
        let why = self.why.as_deref().unwrap_or("for no reason that is known");
        let is_held = self.incidents.iter().any(|incident| incident.stop == Some(Stop::Held));
        Some(match self.ending {
            Ending::Succeeded if self.releases == 0 => return None,
            Ending::Succeeded => "released after a stop, and ended well".to_owned(),
            Ending::FalseSuccess => "not as it should be".to_owned(),
            Ending::GivenUp => format!("given up: {why}"),
            Ending::Fault if is_held => format!("held by a stop: {why}"),
            Ending::Fault => format!("ended in a fault: {why}"),
            Ending::Trap => format!("ended in a trap: {why}"),
            Ending::Limit => "the limit of instructions".to_owned(),
        })
    }

    /// Whether an error of it was put right: the run went on past it, no person had to release the
    /// arm for it, and the assembly did not end in what only seems to be right, since then any of
    /// its errors may be why. What became of its other errors changes nothing.
    #[must_use]
    pub fn puts_right(&self, incident: &Incident) -> bool {
        incident.recovered && incident.stop.is_none() && self.ending != Ending::FalseSuccess
    }
}

/// What came of one assembly, and which it was.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Which assembly of the campaign, from 0.
    pub run: u64,
    /// What all chance in it follows from: `obverse run --seed`.
    pub seed: u64,
    /// How errors were answered.
    pub strategy: Strategy,
    /// What came of it.
    #[serde(flatten)]
    pub outcome: Outcome,
}
