//! Where ways through the program meet: which states have been there, and what to forget so that
//! every loop comes to an end.
//!
//! As long as there are few, states stay apart, so that a loop over the places of a pallet is
//! looked at place by place. Beyond that, states with the same workcell are made one by forgetting
//! the values in which they differ, and at last the workcell is forgotten, too. A state can forget
//! only so often, so that this ends.

use crate::reason::Reason;
use crate::state::State;
use crate::trace::{Deed, Node, NodeId, Trace};
use crate::worlds::WorldId;
use std::collections::HashMap;

/// How many states of one place stay apart where all decisions are known. [`Reason::TooManyRounds`]
/// names it, too.
const MAX_CERTAIN: usize = 512;
/// The same where ways part by what is only known when the program runs.
const MAX_UNCERTAIN: usize = 16;
/// With so many workcells more at one place, the workcell is forgotten.
const MAX_WORLDS: usize = 16;

/// A state that was at a place, and the merge in the trace that stands for it.
struct Visit {
    state: State,
    node: NodeId,
}

/// The states that were at the places where ways meet.
#[derive(Default)]
pub(crate) struct Seen {
    places: HashMap<Vec<usize>, Vec<Visit>>,
}

impl Seen {
    /// A state comes to a place where ways meet; what goes on from there, if it brings anything
    /// new.
    pub(crate) fn meet(
        &mut self,
        mut state: State,
        nothing_known: WorldId,
        trace: &mut Trace,
    ) -> Option<State> {
        let visits = self.places.entry(state.place()).or_default();
        let covers = |visit: &&Visit| visit.state.covers(&state, nothing_known);
        if let Some(visit) = visits.iter().rev().find(covers) {
            trace.lead(visit.node, state.last);
            return None;
        }
        let mut from = vec![state.last];
        let limit = if state.is_certain { MAX_CERTAIN } else { MAX_UNCERTAIN };
        if visits.len() >= limit {
            if !visits.iter().any(|visit| is_alike(visit, &state))
                && visits.len() >= limit + MAX_WORLDS
            {
                state.world = nothing_known;
            }
            let alike = visits.iter().rev().find(|visit| is_alike(visit, &state));
            let other = alike.or_else(|| visits.last().filter(|_| state.world == nothing_known));
            if let Some(other) = other {
                if state.is_certain {
                    state.since = Some(Reason::TooManyRounds);
                }
                state.forget_differences(&other.state);
                from.push(other.node);
            }
        }
        let world = state.world;
        let node = trace.add(Node { deed: Deed::Merge, before: world, after: world, from });
        state.last = node;
        visits.push(Visit { state: state.clone(), node });
        Some(state)
    }
}

/// Whether two states at one place differ in values alone.
fn is_alike(visit: &Visit, state: &State) -> bool {
    visit.state.world == state.world
}
