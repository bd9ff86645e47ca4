//! An error at a place, and what has been tried against it.
//!
//! An incident is open from when its error is due until the run has passed the action that failed,
//! or gives it up. The same error due at the same instruction, or in the same action, while
//! it is open is the same incident.

use crate::ending::GiveUp;
use crate::trail::Trail;
use obverse_isa::ErrorId;

/// One way back and forward again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt {
    /// How many actions it went back; 0 where the arm stayed.
    pub actions: usize,
    /// When it began, in seconds of the workcell's clock.
    pub began_s: f64,
    /// What was done otherwise.
    pub search: Search,
}

/// Where an attempt searches, in a pattern around the middle.
///
/// What only moves the arm leaves the world as it was: the same again would fail again, and the
/// search goes on. Where more is done anew (a part gripped, a feeder asked) the world is another,
/// and nothing speaks for aside: the search begins in the middle, one further out each time that
/// did not help.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Whether more than motions of the arm is done anew.
    pub is_anew: bool,
    /// The point of the pattern; 0 is its middle.
    pub point: u32,
}

impl Search {
    /// That of the attempt after others.
    #[must_use]
    pub fn after(earlier: impl DoubleEndedIterator<Item = Self>, is_anew: bool) -> Self {
        let mut earlier = earlier;
        let point = if is_anew {
            earlier.filter(|search| search.is_anew).count() as u32
        } else {
            earlier.next_back().map_or(0, |newest| newest.point) + 1
        };
        Self { is_anew, point }
    }
}

/// What became of an incident.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The run got past it.
    Recovered,
    /// It was given up.
    GivenUp(GiveUp),
    /// The run ended in something else before either: what would have come of the last attempt
    /// nobody knows.
    Lost,
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
    /// The branches in which it was due.
    pub branches: Vec<usize>,
    /// Whether it was due in the cleanup.
    pub is_in_cleanup: bool,
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

    /// Whether an error that is due at an instruction, in the action of an entry, is this one: at
    /// the same instruction, or in the same action.
    #[must_use]
    pub fn is_again(&self, error: ErrorId, pc: u32, entry: u32) -> bool {
        self.error == error && (self.pc == pc || self.entry == entry)
    }

    /// Whether the run has begun an action behind the one that failed.
    #[must_use]
    pub fn is_past(&self, trail: &Trail<'_>) -> bool {
        trail.has_passed(self.number, self.entry, &self.branches)
    }

    /// Where the next attempt searches, if it goes back so many actions of the trail.
    #[must_use]
    pub fn next_search(&self, trail: &Trail<'_>, actions: usize) -> Search {
        let earlier = self.attempts.iter().map(|attempt| attempt.search);
        Search::after(earlier, trail.takes_back_more_than_moves(actions))
    }

    /// How far the attempt went back that was enough; none unless it was recovered from.
    #[must_use]
    pub fn depth_enough(&self) -> Option<usize> {
        match self.outcome {
            Some((Outcome::Recovered, _)) => self.attempts.last().map(|attempt| attempt.actions),
            _ => None,
        }
    }

    /// What is learned of it: how far each attempt went back of which it is known what came of it,
    /// and whether the last was enough. Nothing where the arm stayed, and nothing while it is open.
    #[must_use]
    pub fn lesson(&self) -> Option<(Vec<usize>, bool)> {
        let (outcome, _) = self.outcome?;
        let mut depths = self.depths();
        // The error was due again after every attempt but the last, of which it depends.
        if matches!(outcome, Outcome::Lost | Outcome::GivenUp(GiveUp::Blocked)) {
            depths.pop();
        }
        let is_something = !depths.is_empty() && !depths.contains(&0);
        is_something.then_some((depths, outcome == Outcome::Recovered))
    }

    /// How long it was open, in seconds of the workcell's clock; none while it is.
    #[must_use]
    pub fn duration_s(&self) -> Option<f64> {
        self.outcome.map(|(_, ended_s)| ended_s - self.began_s)
    }
}

#[cfg(test)]
mod tests {
    use super::{Attempt, Incident, Outcome, Search};
    use crate::ending::GiveUp;
    use obverse_isa::ErrorId;

    fn lesson(depths: &[usize], outcome: Outcome) -> Option<(Vec<usize>, bool)> {
        let search = Search { is_anew: false, point: 0 };
        let attempt = |&actions: &usize| Attempt { actions, began_s: 0.0, search };
        let incident = Incident {
            error: ErrorId(0),
            pc: 0,
            place: String::new(),
            number: 0,
            entry: 0,
            branches: Vec::new(),
            is_in_cleanup: false,
            began_s: 0.0,
            began_way_m: 0.0,
            attempts: depths.iter().map(attempt).collect(),
            outcome: Some((outcome, 1.0)),
        };
        incident.lesson()
    }

    #[test]
    fn of_an_attempt_that_something_else_ended_nothing_is_learned() {
        assert_eq!(lesson(&[1, 2], Outcome::Recovered), Some((vec![1, 2], true)));
        let given_up = Outcome::GivenUp(GiveUp::Attempts(2));
        assert_eq!(lesson(&[1, 2], given_up), Some((vec![1, 2], false)));
        for unknown in [Outcome::Lost, Outcome::GivenUp(GiveUp::Blocked)] {
            assert_eq!(lesson(&[1, 2], unknown), Some((vec![1], false)), "{unknown:?}");
            assert_eq!(lesson(&[4], unknown), None, "{unknown:?}");
        }
        assert_eq!(lesson(&[0, 0], Outcome::Recovered), None, "the arm stayed");
    }

    #[test]
    fn a_search_goes_on_until_more_than_the_arm_is_taken_back_and_then_begins_in_the_middle() {
        let mut made: Vec<Search> = Vec::new();
        for is_anew in [false, false, true, false, true, true, false] {
            made.push(Search::after(made.iter().copied(), is_anew));
        }
        let points: Vec<u32> = made.iter().map(|search| search.point).collect();
        assert_eq!(points, [1, 2, 0, 1, 1, 2, 3]);
    }
}
