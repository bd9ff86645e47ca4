//! What was found out about each move, visit by visit.

use crate::reason::{Grade, Reason};
use crate::verdict::Verdict;
use obverse_vm::Direction;
use std::collections::BTreeMap;
use std::rc::Rc;

/// What was found out about a move in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Graded {
    /// The worst that was found, or that it is fine.
    pub verdict: Verdict,
    /// The calls on the way to it, outermost first, as the instructions that make them.
    pub calls: Vec<u32>,
    /// On how many ways it was looked at.
    pub visits: usize,
    /// It is fine as planned, and not known for this reason where a guarded move ends otherwise, or
    /// what the gripper holds or an input that never changes in the cell is not as planned.
    pub elsewhere: Option<Reason>,
    /// Whether a run faults there on every way that leads to it.
    pub always_fails: bool,
}

/// What a visit found: from the least to the most telling.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    NotKnownElsewhere,
    Fine,
    NotKnown,
    Wrong(Grade),
}

#[derive(Debug)]
struct Finding {
    verdict: Rc<Verdict>,
    calls: Rc<[u32]>,
    is_planned: bool,
}

/// The visits of a move: the first one of each kind.
#[derive(Debug, Default)]
struct Tally {
    visits: usize,
    not_wrong: usize,
    /// What was found, each reason once.
    reasons: Vec<Reason>,
    first: Vec<Finding>,
}

/// What was found out, by instruction and direction.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    tallies: BTreeMap<(u32, bool), Tally>,
}

impl Finding {
    fn rank(&self) -> Rank {
        match self.verdict.grade() {
            Grade::Reachable => Rank::Fine,
            Grade::NotKnown if self.is_planned => Rank::NotKnown,
            Grade::NotKnown => Rank::NotKnownElsewhere,
            wrong => Rank::Wrong(wrong),
        }
    }
}

impl Notes {
    /// A move was looked at on a way.
    pub(crate) fn add(
        &mut self,
        pc: u32,
        direction: Direction,
        verdict: &Rc<Verdict>,
        calls: &Rc<[u32]>,
        is_planned: bool,
    ) {
        let tally = self.tallies.entry((pc, direction == Direction::Reverse)).or_default();
        tally.visits += 1;
        tally.not_wrong += usize::from(!verdict.grade().is_wrong());
        if !tally.reasons.contains(&verdict.reason) {
            tally.reasons.push(verdict.reason);
        }
        let finding = Finding { verdict: verdict.clone(), calls: calls.clone(), is_planned };
        let rank = finding.rank();
        if tally.first.iter().all(|known| known.rank() != rank) {
            tally.first.push(finding);
        }
    }

    /// Whether something would be known of a move if more rounds of a loop were followed.
    pub(crate) fn lacks_rounds(&self) -> bool {
        let is_lacking = |tally: &Tally| {
            let mut not_known = tally.reasons.iter().filter(|one| one.grade() == Grade::NotKnown);
            not_known.clone().any(|reason| *reason == Reason::TooManyRounds)
                && not_known.all(|one| matches!(one, Reason::TooManyRounds | Reason::AfterFailure))
        };
        self.tallies.values().any(is_lacking)
    }

    /// What comes of all visits of a move, if there were any.
    pub(crate) fn of(&self, pc: u32, direction: Direction) -> Option<Graded> {
        let tally = self.tallies.get(&(pc, direction == Direction::Reverse))?;
        let worst = tally.first.iter().max_by_key(|finding| finding.rank())?;
        let elsewhere = tally
            .first
            .iter()
            .find(|finding| finding.rank() == Rank::NotKnownElsewhere)
            .filter(|_| worst.rank() == Rank::Fine);
        Some(Graded {
            verdict: Verdict::clone(&worst.verdict),
            calls: worst.calls.to_vec(),
            visits: tally.visits,
            elsewhere: elsewhere.map(|finding| finding.verdict.reason),
            always_fails: tally.not_wrong == 0,
        })
    }
}
