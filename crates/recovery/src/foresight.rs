//! Who knows what will come of going back: tries every depth on a copy of the world.
//!
//! It is what other strategies are measured against, since it knows what only the world knows; no
//! real cell has it.

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
pub struct Clairvoyant;

impl<C: Workcell + Clone> Foresight<C> for Clairvoyant {
    fn depth(&mut self, site: &Site<'_, '_, C>) -> Option<usize> {
        let depths = 1..=site.trail.actions().len().min(DEPTHS_MAX);
        let seen = depths.filter_map(|depth| Some((look(site, depth)?, depth)));
        let best = seen.min_by(|((one, one_s), _), ((other, other_s), _)| {
            one.cmp(other).then(one_s.total_cmp(other_s))
        });
        best.map(|(_, depth)| depth)
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

/// Where it leads to go back so many actions at each attempt, and how long that takes in seconds of
/// the workcell's clock; none if the error would not be got past.
fn look<C: Workcell + Clone>(site: &Site<'_, '_, C>, depth: usize) -> Option<(Leads, f64)> {
    let (mut machine, mut cell) = (site.machine.clone(), site.cell.clone());
    let mut watch = Watch(site.trail.clone());
    for change in site.changes(depth) {
        back(&mut machine, &mut cell, &mut watch.0, depth)?;
        machine.alter(change);
        let leads = forward(&mut machine, &mut cell, &mut watch, site)?;
        if leads != Leads::Again {
            return Some((leads, cell.now_s() - site.cell.now_s()));
        }
    }
    None
}

fn back<C: Workcell>(
    machine: &mut Machine<'_>,
    cell: &mut C,
    trail: &mut Trail<'_>,
    depth: usize,
) -> Option<()> {
    let actions = trail.actions();
    let to = actions[actions.len().checked_sub(depth)?].steps;
    if let Some(motion) = trail.round_trip(to, &cell.joints()) {
        machine.unwind_to(Mark::at(motion.steps), cell).ok()?;
    }
    let stop = machine.reverse_to(Mark::at(to), cell, &mut ());
    trail.cut(machine.state().steps());
    matches!(stop, Stop::AtMark | Stop::OffMark | Stop::AtStart).then_some(())
}

/// Where going forward leads; none if to the end of the run.
fn forward<C: Workcell>(
    machine: &mut Machine<'_>,
    cell: &mut C,
    watch: &mut Watch<'_>,
    site: &Site<'_, '_, C>,
) -> Option<Leads> {
    let allowed = machine.executed().saturating_add(STEPS_MAX);
    while !site.incident.is_past(&watch.0) && machine.executed() < allowed {
        match machine.step(Direction::Forward, cell, watch) {
            Ok(()) | Err(Stop::Raised { .. }) => {}
            Err(Stop::Finished) if machine.state().raised().is_empty() => break,
            Err(Stop::Due { error, pc }) => {
                let newest = watch.0.newest_of(&site.incident.branches);
                let entry = newest.map_or(pc, |action| action.entry);
                let is_again = site.incident.is_again(error, pc, entry);
                return Some(if is_again { Leads::Again } else { Leads::Elsewhere });
            }
            Err(Stop::Fault { fault, pc, .. }) if !cell.is_stopped() => {
                let error = fault::error_of(machine.program().module(), &fault)?;
                let mut driven = Direct { machine: &mut *machine, cell: &mut *cell };
                if !fault::raise(&mut driven, error, pc, &mut watch.0) {
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
