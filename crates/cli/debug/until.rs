//! On to a place that is named for once; and what `start` and `run` are of a run that there is
//! only one of.

use super::{Done, Front, stops, walk};
use obverse_debugger::recording::Moment;
use obverse_debugger::{Breakpoint, Grain, Mode, Places, Walk};
use obverse_vm::Direction;
use std::collections::BTreeSet;

/// On to a place, or until the call is over; without a place, past this line.
pub(super) fn until(front: &mut Front<'_>, rest: &str) -> Done {
    match rest {
        "" => walk::enter(front).unwrap_or_else(|| match further(front) {
            Some(places) => go(front, (places, None), Walk::Finish),
            None => walk::go(front, "", Direction::Forward, Walk::Finish),
        }),
        _ => {
            let found = stops::places(front, rest)?;
            go(front, found, Walk::Finish)
        }
    }
}

/// On to a place, wherever that is.
pub(super) fn advance(front: &mut Front<'_>, rest: &str) -> Done {
    if rest.is_empty() {
        return Err("say where to: a line, a sequence, a checkpoint".to_owned());
    }
    let found = stops::places(front, rest)?;
    go(front, found, Walk::Continue)
}

fn go(front: &mut Front<'_>, (places, told): (Places, Option<String>), walk: Walk) -> Done {
    let names = front.breakpoint_names();
    let halt = front.drive(|session| session.go_until(Breakpoint::at(places.clone()), walk));
    let mut answer = walk::walked(front, &halt, Direction::Forward, &names);
    answer.lines.splice(0..0, told);
    Ok(answer)
}

/// The statements of this call that are written further down than this one; none if there are none.
fn further(front: &Front<'_>) -> Option<Places> {
    let module = front.module;
    let here = module.source_at(front.session.machine().state().pc())?;
    let (_, line, _) = module.place_of(here.first)?;
    let function = module.functions.get(module.function_at(here.first)?)?;
    let own = module.source_map.iter().filter(|entry| {
        (function.first..function.end).contains(&entry.first) && entry.file == here.file
    });
    let below = own.filter(|entry| module.place_of(entry.first).is_some_and(|at| at.1 > line));
    let places = below.filter_map(|entry| Places::of_instruction(module, entry.first).ok());
    let pcs: BTreeSet<u32> = places.flat_map(|places| places.pcs).collect();
    (!pcs.is_empty()).then(|| Places { name: format!("below line {line}"), pcs, line: None })
}

/// Why a run is not begun again.
fn one_run(front: &Front<'_>) -> String {
    format!(
        "there is one run, and this is moment {} of it: `continue` goes on, `goto start` shows its \
         beginning, and `what-if` there runs it anew in a copy of the workcell",
        front.session.moment()
    )
}

/// Into the first sequence.
pub(super) fn start(front: &mut Front<'_>, rest: &str) -> Done {
    if !rest.is_empty() {
        return Err("nothing follows `start`; `--seed` and `--cell` are given at the call".into());
    }
    if front.session.moment() > Moment(0) {
        return Err(one_run(front));
    }
    walk::go(front, "", Direction::Forward, Walk::Step(Grain::Statement))
}

/// Through a run that has not begun.
pub(super) fn run(front: &mut Front<'_>, rest: &str) -> Done {
    if !rest.is_empty() {
        return Err("nothing follows `run`; `--seed` and `--cell` are given at the call".into());
    }
    if front.session.moment() > Moment(0) || front.session.mode() == Mode::Rewound {
        return Err(one_run(front));
    }
    walk::go(front, "", Direction::Forward, Walk::Continue)
}
