//! Who knows what will come of going back: tries every depth on a copy of the world.
//!
//! It is what other strategies are measured against, since it knows what only the world knows; no
//! real cell has it.

use crate::attempt::BLOCKED_TRIES;
use crate::driven::Direct;
use crate::fault;
use crate::recover::{Foresight, Site};
use crate::trail::Trail;
use obverse_vm::{Direction, Event, Machine, Mark, Observer, Stop};
use obverse_workcell::Workcell;

/// The most depths that are tried.
const DEPTHS_MAX: usize = 16;
/// The most instructions that one try may take.
const STEPS_MAX: u64 = 1_000_000;

/// Knows the world that it is asked about, and all that chance has in store.
#[derive(Clone, Copy, Debug, Default)]
pub struct Clairvoyant {
    /// How often a person will still give the fresh command after a stop.
    pub releases: u32,
}

impl<C: Workcell + Clone> Foresight<C> for Clairvoyant {
    fn depth(&mut self, site: &Site<'_, '_, C>) -> Option<usize> {
        let depths = 1..=site.trail.actions().len().min(DEPTHS_MAX);
        let seen = depths.filter_map(|depth| Some((look(site, depth, self.releases)?, depth)));
        let best = seen.min_by(|(one, _), (other, _)| {
            let worse = |seen: &Seen| (seen.leads, seen.releases);
            worse(one).cmp(&worse(other)).then(one.takes_s.total_cmp(&other.takes_s))
        });
        best.map(|(_, depth)| depth)
    }
}

/// What was seen of going back so far.
struct Seen {
    leads: Leads,
    /// How often a person has to release the arm on the way.
    releases: u32,
    /// How long it takes by the workcell's clock, in seconds.
    takes_s: f64,
}

/// A copy of a workcell and of who releases a stopped arm in it.
struct Copied<C> {
    cell: C,
    /// How often it will still be released.
    releases: u32,
}

impl<C: Workcell> Copied<C> {
    /// Whether the arm may move; after a stop, because it is released.
    fn may_move(&mut self) -> bool {
        if !self.cell.is_stopped() {
            return true;
        }
        let is_released = self.releases > 0;
        if is_released {
            self.releases -= 1;
            self.cell.release();
        }
        is_released
    }
}

/// Where going forward again leads, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Leads {
    /// Past the error.
    Past,
    /// To another error, of which nothing is foreseen.
    Elsewhere,
    /// To the error again.
    Again,
}

/// Where it leads to go back so many actions at each attempt; none if the error would not be got
/// past.
fn look<C: Workcell + Clone>(site: &Site<'_, '_, C>, depth: usize, releases: u32) -> Option<Seen> {
    let mut machine = site.machine.clone();
    let mut copied = Copied { cell: site.cell.clone(), releases };
    let mut watch = Watch(site.trail.clone());
    for change in site.changes(depth) {
        back(&mut machine, &mut copied, &mut watch.0, depth)?;
        machine.alter(change);
        let leads = forward(&mut machine, &mut copied, &mut watch, site)?;
        if leads != Leads::Again {
            let takes_s = copied.cell.now_s() - site.cell.now_s();
            return Some(Seen { leads, releases: releases - copied.releases, takes_s });
        }
    }
    None
}

fn back<C: Workcell>(
    machine: &mut Machine<'_>,
    copied: &mut Copied<C>,
    trail: &mut Trail<'_>,
    depth: usize,
) -> Option<()> {
    let actions = trail.actions();
    let to = actions[actions.len().checked_sub(depth)?].steps;
    if let Some(motion) = trail.round_trip(to, &copied.cell.joints()) {
        machine.unwind_to(Mark::at(motion.steps), &mut copied.cell).ok()?;
    }
    for _ in 0..=BLOCKED_TRIES {
        match machine.reverse_to(Mark::at(to), &mut copied.cell, &mut ()) {
            Stop::AtMark | Stop::OffMark | Stop::AtStart => {
                trail.cut(machine.state().steps());
                return Some(());
            }
            Stop::Fault { .. } if copied.may_move() => {}
            _ => return None,
        }
    }
    None
}

/// Where going forward leads; none if to the end of the run.
fn forward<C: Workcell>(
    machine: &mut Machine<'_>,
    copied: &mut Copied<C>,
    watch: &mut Watch<'_>,
    site: &Site<'_, '_, C>,
) -> Option<Leads> {
    let allowed = machine.executed().saturating_add(STEPS_MAX);
    while !site.incident.is_past(&watch.0) && machine.executed() < allowed {
        match machine.step(Direction::Forward, &mut copied.cell, watch) {
            Ok(()) | Err(Stop::Raised { .. }) => {}
            Err(Stop::Finished) if machine.state().raised().is_empty() => break,
            Err(Stop::Due { error, pc }) => {
                let newest = watch.0.newest_of(&site.incident.branches);
                let entry = newest.map_or(pc, |action| action.entry);
                let is_again = site.incident.is_again(error, pc, entry);
                return Some(if is_again { Leads::Again } else { Leads::Elsewhere });
            }
            Err(Stop::Fault { fault, pc, .. }) => {
                let error = fault::error_of(machine.program().module(), &fault)?;
                let is_free = copied.may_move();
                let mut driven = Direct { machine: &mut *machine, cell: &mut copied.cell };
                if !is_free || !fault::raise(&mut driven, error, pc, &mut watch.0) {
                    return None;
                }
            }
            Err(_) => return None,
        }
    }
    Some(Leads::Past)
}

struct Watch<'m>(Trail<'m>);

impl Observer for Watch<'_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        self.0.note(event, cell);
    }
}
