//! What a recovery would know at a moment of a recording: the trail that led there, found by going
//! through the recording once more. What had been tried by then is not known: it begins anew.

use crate::recording::{Moment, Order};
use crate::replay::Replay;
use crate::rewound::Rewound;
use crate::run::Run;
use obverse_recovery::Recovering;
use obverse_workcell::Workcell;

/// A run that has come to a moment of a recording, as a recovery sees it.
pub(crate) fn retraced<'p, C: Workcell>(run: &Run<'p, C>, at: &Rewound<'p>) -> Recovering<'p> {
    let recording = run.recording();
    let mut shown = Rewound::at(run.machine(), run.timeline().before(Moment(0)));
    let mut recovering = Recovering::new(run.machine().program().module(), recording.start.joints);
    while shown.moment() < at.moment() {
        let pc = shown.machine().state().pc();
        if shown.advance_some(recording, at.moment(), &mut recovering).is_none() {
            break;
        }
        match shown.order(recording) {
            Some(Order::Reverse | Order::Unwind) => recovering.cut_to(shown.machine()),
            Some(Order::Raise(_)) => {
                let mut cursor = shown.cursor().clone();
                let cell = Replay::new(recording, &mut cursor);
                recovering.note_raised(shown.machine(), pc, &cell);
            }
            Some(Order::Leave | Order::SetGlobal(..) | Order::SetLocal(..)) => {
                recovering.begin_anew();
            }
            _ => {}
        }
    }
    let taken = at.cursor().frame().checked_sub(1);
    let last = taken.and_then(|newest| recording.log.frames.get(newest));
    recovering.stand_as(at.machine(), last.and_then(|frame| recording.log.fault(frame)));
    recovering
}

/// Whether the machine was to do otherwise than the program says, at a moment of a recording.
pub(crate) fn is_altered(run: &Run<'_, impl Workcell>, at: &Rewound<'_>) -> bool {
    let until = run.recording().stretches.iter().take(at.stretch() + 1);
    let mut alterations = until.rev().filter_map(|stretch| match stretch.order {
        Order::Alter(alteration) => Some(alteration.is_some()),
        _ => None,
    });
    alterations.next().unwrap_or(false)
}
