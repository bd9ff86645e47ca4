//! Errors that are due, faults, and how a run that goes on after them ends: what is said of them,
//! and the commands that are about them alone.

use super::{Answer, Done, Front, walk};
use crate::report;
use obverse_debugger::{Halt, Mode, Session};
use obverse_recovery::{Ending, Intended, Intent};
use obverse_sim::Sim;
use obverse_vm::{Direction, Stop};
use serde_json::{Value, json};

/// What lets a held arm move.
const HELD: &str = "the arm is held: nothing moves before a `release`";

pub(super) fn recover(front: &mut Front<'_>, _: &str) -> Done {
    let names = front.breakpoint_names();
    let mut declined = None;
    let halt = front.drive(|session| match session.recover() {
        Ok(halt) => halt,
        Err(why) => {
            declined = Some(why);
            Halt::Done
        }
    });
    if let Some(why) = declined {
        return Err(why.to_string());
    }
    Ok(walk::walked(front, &halt, Direction::Forward, &names))
}

pub(super) fn release(front: &mut Front<'_>, _: &str) -> Done {
    if !front.session.is_held() {
        return Err("no stop holds the arm".to_owned());
    }
    front.session.release().map_err(|why| why.to_string())?;
    Ok(Answer::line("the arm may move again; nothing has moved"))
}

impl<'p> Front<'p> {
    /// Go on. An arm that a stop holds is released first, as often as that was allowed beforehand
    /// and the run goes on then.
    pub(super) fn drive(&mut self, mut go: impl FnMut(&mut Session<'p, Sim>) -> Halt) -> Halt {
        loop {
            let halt = go(&mut self.session);
            if halt != Halt::Held || !self.releases() || self.session.release().is_err() {
                return halt;
            }
            self.releases_left -= 1;
        }
    }

    /// Whether going on releases an arm that is held. What is only tried, or is by hand, does not.
    fn releases(&self) -> bool {
        self.releases_left > 0 && self.session.tries() == 0 && !self.session.is_over()
    }

    /// An error that is due: what the program wants done, and who does it.
    pub(super) fn due_words(&mut self, error: usize, pc: u32) -> Vec<String> {
        let (module, name) = (self.module, &self.module.errors[error].name);
        let mut lines = vec![format!("error {name} is due at {}", report::line_of(module, pc))];
        let Some(intent) = self.session.intent() else { return lines };
        lines.push(format!("next: {}", intent.words(module)));
        let is_attempt = matches!(intent.what, Intended::Back { .. } | Intended::InPlace);
        if is_attempt && !std::mem::replace(&mut self.is_told_how, true) {
            let how = "`continue` goes that way, `step` by statements, `recover` until it is past; \
                       `reverse-next` goes back by hand";
            lines.push(how.to_owned());
        }
        lines
    }

    /// What comes of a fault or a trap, and what must be done before.
    pub(super) fn fault_words(&self, direction: Direction) -> Vec<String> {
        let is_live = self.session.mode() != Mode::Rewound;
        let then = match self.session.is_over() {
            true => "the run ends in this; `continue` tries it again",
            false => "`continue` goes on as the program says",
        };
        let held = (is_live && self.session.is_held()).then(|| match self.releases() {
            true => format!("the arm is held; going on releases it ({} left)", self.releases_left),
            false => HELD.to_owned(),
        });
        let then = (is_live && direction == Direction::Forward).then(|| then.to_owned());
        held.into_iter().chain(then).collect()
    }

    /// The end of a run, and what is not as it should be then.
    pub(super) fn end_words(&self, ending: &Ending) -> Vec<String> {
        let mut lines = vec![report::ending_words(self.module, ending)];
        let sim = self.session.run().cell().filter(|_| *ending == Ending::Finished);
        let missed = sim.map(obverse_sim::Sim::missed_goals).unwrap_or_default();
        if !missed.is_empty() {
            lines[0].push_str(", and it is not as it should be");
            lines.extend(missed.iter().map(|missed| format!("  {missed}")));
        }
        lines
    }
}

/// Why a run ended or does not move, in words.
pub(super) fn halted(front: &Front<'_>, halt: &Halt) -> Vec<String> {
    match halt {
        Halt::Ended(ending @ Ending::GivenUp { .. }) => vec![
            report::ending_words(front.module, ending),
            "the run ends here, and a person is called: `reverse-next` goes back by hand, `goto` \
             and `last` show what was"
                .to_owned(),
        ],
        Halt::Ended(ending) => vec![report::ending_words(front.module, ending)],
        _ => vec![HELD.to_owned()],
    }
}

/// What will be done about an error, for machines.
pub(super) fn intent(front: &mut Front<'_>, halt: &Halt) -> Value {
    let is_due = matches!(halt, Halt::Stopped(Stop::Due { .. }));
    let Some(intent) = front.session.intent().filter(|_| is_due) else { return Value::Null };
    let Intent { incident, what, .. } = &intent;
    let mut object = json!({
        "error": obverse_recovery::name(front.module, incident),
        "attempts": incident.attempts.len(),
        "text": intent.words(front.module),
    });
    match what {
        Intended::Back { actions, to, change, .. } => {
            object["does"] = json!("back");
            object["actions"] = json!(actions);
            object["to"] = report::place(front.module, Some(*to));
            object["change"] = json!(change.map(obverse_recovery::changed));
        }
        Intended::InPlace => object["does"] = json!("in_place"),
        Intended::GiveUp(why) => {
            object["does"] = json!("given_up");
            object["why"] = json!(why.code());
        }
    }
    object
}
