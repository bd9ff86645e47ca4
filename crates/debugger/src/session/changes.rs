//! Finding the last change of something.
//!
//! What only commands change is looked for in the recording first, and then in one piece. Anything
//! else is looked for from the newest piece back, each piece forward once; in between the
//! instructions that can change it, the machine runs as fast as ever.

use super::search::is_over;
use super::{Declined, PIECE, SeenIn, Session, look_at};
use crate::condition::Expression;
use crate::recording::{Moment, Order, Recording, World};
use crate::replay::Cursor;
use crate::rewound::{Halted, Rewound};
use crate::subject::{Look, Subject, Value};
use crate::writers::{commands, writers_beside_steps};
use obverse_bytecode::Module;
use obverse_vm::{Event, Observer, State, Stops};
use obverse_workcell::Workcell;

/// A change of something.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The moment before the instruction that changed it.
    pub moment: Moment,
    /// What it was.
    pub before: Value,
    /// What it became.
    pub after: Value,
}

impl<'p, C: Workcell> Session<'p, C> {
    /// To right before the last change of something; again, to the one before that.
    ///
    /// # Errors
    /// If it did not change before, or somebody interrupts.
    pub fn go_to_last_change(&mut self, expression: &Expression) -> Result<Change, Declined> {
        let change = self.last_change(expression)?;
        self.jumped();
        self.show(Some(change.moment));
        Ok(change)
    }

    /// The last change of something before what is shown.
    ///
    /// # Errors
    /// If it did not change before, or somebody interrupts.
    pub fn last_change(&self, expression: &Expression) -> Result<Change, Declined> {
        let view = self.view.clone().unwrap_or_else(|| self.run.rewound());
        let subjects = expression.subjects();
        let is_world = subjects.iter().all(|subject| subject.is_of_the_workcell());
        let change = if is_world {
            self.last_command(view, expression)
        } else {
            self.last_change_between(view, expression)?
        };
        change.ok_or(Declined::NotBefore)
    }

    fn last_change_between(
        &self,
        mut shown: Rewound<'p>,
        expression: &Expression,
    ) -> Result<Option<Change>, Declined> {
        let module = self.module();
        let stops = Stops::new(module, writers_beside_steps(module, expression));
        let mut end = shown.moment();
        loop {
            shown.go_before(self.run.timeline(), end);
            let begin = shown.moment();
            let found = self.change_in(&mut shown, end, expression, &stops)?;
            if found.is_some() || begin == Moment(0) {
                return Ok(found);
            }
            end = begin;
        }
    }

    /// The last change from what is shown on to a moment.
    fn change_in(
        &self,
        shown: &mut Rewound<'p>,
        end: Moment,
        expression: &Expression,
        stops: &Stops,
    ) -> Result<Option<Change>, Declined> {
        let (module, recording) = (self.module(), self.run.recording());
        let mut looked = look_at(module, recording, shown, |look| {
            Looked::at(expression, shown.moment(), end, look)
        });
        loop {
            let to = shown.moment().after(PIECE).min(end);
            let mut passing = Passing::new(module, recording, shown, &mut looked);
            shown.walk_past(recording, to, stops, &mut passing);
            look_at(module, recording, shown, |look| looked.stand(shown.moment(), look));
            let is_before_one = stops.has(shown.machine().state().pc());
            let is_forward = shown.order(recording) == Some(Order::Forward)
                && !shown.machine().state().is_compensating();
            let halted = shown.walk_on(recording, to, Some(stops));
            look_at(module, recording, shown, |look| {
                if is_forward && !is_before_one {
                    looked.stand(shown.moment(), look);
                }
                looked.look(shown.moment(), look);
            });
            if self.take_interrupt() {
                return Err(Declined::Interrupted);
            }
            if is_over(&halted, shown, to, end) {
                return Ok(looked.change);
            }
        }
    }

    /// The last command that changed something of the workcell, and then its moment.
    fn last_command(&self, view: Rewound<'p>, expression: &Expression) -> Option<Change> {
        let (module, recording) = (self.module(), self.run.recording());
        let mut limit = view.cursor().frame();
        let now = view.moment();
        loop {
            let frame = last_frame(module, recording, &view, expression, limit)?;
            let mut shown = view.clone();
            shown.go_before_frame(self.run.timeline(), frame);
            let pcs = (0..).zip(&module.code).filter(|(_, instr)| commands(instr));
            let stops = Stops::new(module, pcs.map(|(pc, _)| pc));
            let value = |shown: &Rewound<'p>| {
                look_at(module, recording, shown, |look| expression.value(look))
            };
            let mut before = (shown.moment(), value(&shown));
            while shown.cursor().frame() < frame {
                before = (shown.moment(), value(&shown));
                let halted = shown.walk_on(recording, now, Some(&stops));
                if matches!(halted, Halted::There | Halted::Lost) {
                    break;
                }
            }
            let after = value(&shown);
            if shown.cursor().frame() >= frame && before.0 < now && before.1 != after {
                let (moment, before) = before;
                return Some(Change { moment, before, after });
            }
            // Commanded beside the program, or taken back within one instruction.
            limit = frame - 1;
        }
    }
}

/// An expression that is looked at along a run, and its last change.
struct Looked<'e> {
    expression: &'e Expression,
    /// Whether it may be another with every step.
    is_of_steps: bool,
    moment: Moment,
    steps: u64,
    value: Value,
    change: Option<Change>,
    /// What changes from here on is not asked for.
    end: Moment,
}

impl<'e> Looked<'e> {
    fn at(expression: &'e Expression, moment: Moment, end: Moment, look: &Look<'_>) -> Self {
        Self {
            expression,
            end,
            is_of_steps: expression.subjects().contains(&&Subject::Steps),
            moment,
            steps: look.state.steps(),
            value: expression.value(look),
            change: None,
        }
    }

    /// Nothing has changed since but how many steps there were, one by one.
    fn stand(&mut self, moment: Moment, look: &Look<'_>) {
        let steps = look.state.steps();
        if self.is_of_steps && steps > self.steps {
            let over = (self.steps.cast_signed(), steps.cast_signed());
            if let Some((at, before, after)) = self.expression.last_change_over(look, over) {
                let moment = self.moment.after(at.cast_unsigned() - self.steps);
                self.note(moment, before, after);
            }
            self.value = self.expression.value(look);
        }
        (self.moment, self.steps) = (moment, steps);
    }

    /// Anything may have changed, in one step.
    fn look(&mut self, moment: Moment, look: &Look<'_>) {
        let value = self.expression.value(look);
        if value != self.value && moment > self.moment {
            let before = std::mem::replace(&mut self.value, value.clone());
            self.note(self.moment, before, value);
        }
        (self.moment, self.steps) = (moment, look.state.steps());
    }

    fn note(&mut self, moment: Moment, before: Value, after: Value) {
        if moment < self.end {
            self.change = Some(Change { moment, before, after });
        }
    }
}

/// Looks at an expression while a machine goes past what may change it. Meanwhile the workcell is
/// neither asked nor commanded if that may.
struct Passing<'l, 'e, 'r> {
    looked: &'l mut Looked<'e>,
    module: &'r Module,
    recording: &'r Recording,
    /// Where in the recording, if that matters.
    cursor: Option<Cursor>,
    /// What is to be added to the machine's count for the moment.
    offset: u64,
}

impl<'l, 'e, 'r> Passing<'l, 'e, 'r> {
    fn new(
        module: &'r Module,
        recording: &'r Recording,
        shown: &Rewound<'_>,
        looked: &'l mut Looked<'e>,
    ) -> Self {
        let is_asked = |subject: &&Subject| {
            subject.is_of_the_workcell() || matches!(subject, Subject::Input(_))
        };
        let asks = looked.expression.subjects().iter().any(is_asked);
        let cursor = asks.then(|| shown.cursor().clone());
        let offset = shown.moment().0.wrapping_sub(shown.machine().executed());
        Self { looked, module, recording, cursor, offset }
    }

    fn with<T>(
        &mut self,
        state: &State,
        executed: u64,
        look: impl FnOnce(&mut Looked<'e>, Moment, &Look<'_>) -> T,
    ) -> T {
        let (recording, cursor) = (self.recording, self.cursor.as_ref());
        let world = cursor.map_or(&recording.start, Cursor::world);
        let world = SeenIn { recording, world, cursor };
        let moment = Moment(executed.wrapping_add(self.offset));
        look(self.looked, moment, &Look { module: self.module, state, world: &world })
    }
}

impl Observer for Passing<'_, '_, '_> {
    fn on_event(&mut self, _: &Event, _: &dyn Workcell) {}

    fn before_stop(&mut self, state: &State, executed: u64) {
        self.with(state, executed, Looked::stand);
    }

    fn behind_stop(&mut self, state: &State, executed: u64) {
        self.with(state, executed, Looked::look);
    }
}

/// The newest command, of the first so many, after which an expression is another than before it.
fn last_frame(
    module: &Module,
    recording: &Recording,
    view: &Rewound<'_>,
    expression: &Expression,
    limit: usize,
) -> Option<usize> {
    let log = &recording.log;
    let mut world = recording.start.clone();
    let state = view.machine().state();
    let value = |world: &World| {
        let seen = SeenIn { recording, world, cursor: None };
        expression.value(&Look { module, state, world: &seen })
    };
    let mut before = value(&world);
    let mut last = None;
    for (index, frame) in log.frames.iter().take(limit).enumerate() {
        log.apply(frame, &mut world);
        let after = value(&world);
        if after != before {
            last = Some(index + 1);
        }
        before = after;
    }
    last
}
