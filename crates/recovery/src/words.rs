//! The steps of a recovery in words, and what will be done about an error.

use crate::asked::sequence;
use crate::ending::GiveUp;
use crate::incident::Incident;
use crate::recovering::{Intended, Intent};
use crate::tell::{Step, Why};
use obverse_bytecode::text::{line_of, said};
use obverse_bytecode::{Module, Otherwise};
use obverse_vm::Alteration;

/// The name of the error of an incident.
#[must_use]
pub fn name<'m>(module: &'m Module, incident: &Incident) -> &'m str {
    &module.errors[incident.error.index()].name
}

/// A step of a recovery in words.
#[must_use]
pub fn words(module: &Module, step: &Step<'_>) -> String {
    match step {
        Step::Fault { fault, pc, error } => {
            let error = &module.errors[error.index()].name;
            format!("{} is error {error}: {fault}", line_of(module, *pc))
        }
        Step::PassedOver { fault, pc } => {
            format!("the cleanup goes on behind {}: {fault}", line_of(module, *pc))
        }
        Step::Released => "released by hand".to_owned(),
        Step::Back { incident, actions, to, why } => {
            let to = format!("`{}` ({})", said(module, *to), line_of(module, *to));
            let far = counted(*actions, "action");
            format!("{}: back {far}, to {to}{}", name(module, incident), reason(*why))
        }
        Step::RoundTrip { pc, .. } => {
            format!("`{}` ended where it began: nothing to undo", said(module, *pc))
        }
        Step::InPlace { incident, backed_up_m: None } => {
            format!("{}: again from where the arm is", name(module, incident))
        }
        Step::InPlace { incident, backed_up_m: Some(distance_m) } => {
            let far_mm = distance_m * 1e3;
            format!("{}: backed up {far_mm:.0} mm, and again", name(module, incident))
        }
        Step::Blocked { pc, fault, .. } => {
            let place = line_of(module, *pc);
            format!("the way back is blocked at {place}: {fault}")
        }
        Step::Again { incident, change } => {
            let how = change.map(|change| format!(", {}", changed(change))).unwrap_or_default();
            format!("forward again, attempt {}{how}", incident.attempts.len())
        }
        Step::Recovered { incident } => {
            let tried = counted(incident.attempts.len(), "attempt");
            let took_s = incident.duration_s().unwrap_or(0.0);
            let far = incident.depth_enough().filter(|&actions| actions > 0);
            let far = far.map(|actions| format!(", {} back", counted(actions, "action")));
            let far = far.unwrap_or_default();
            format!("past {} after {tried}{far}, {took_s:.2} s", name(module, incident))
        }
        Step::GivenUp { incident, why: GiveUp::Explicit } => {
            let sequence = sequence_name(module, incident);
            format!("{}: as the program says, {sequence}", name(module, incident))
        }
        Step::GivenUp { incident, why } => {
            format!("{} is given up: {why}", name(module, incident))
        }
        Step::Operator { incident } => {
            format!("an operator is called: {} at {}", name(module, incident), incident.place)
        }
    }
}

fn reason(why: Why) -> String {
    match why {
        Why::Said | Why::Place => String::new(),
        Why::Further => ", further than before".to_owned(),
        Why::Learned { known: 0, chance, .. } => {
            format!(": nothing is known here yet, and {:.0} % believed", chance * 1e2)
        }
        Why::Learned { chance, expected_s, known } => format!(
            ": enough with {:.0} %, {expected_s:.1} s expected, from {}",
            chance * 1e2,
            counted(known as usize, "incident")
        ),
        Why::AsFarAsPossible => ", as far as can be taken back".to_owned(),
        Why::Foreseen => ", which will be enough".to_owned(),
    }
}

/// What is done otherwise, in words.
#[must_use]
pub fn changed(change: Alteration) -> String {
    let mut parts = Vec::new();
    if let Some(aside) = change.aside {
        let [x, y] = aside.by_m;
        parts.push(format!("{:.2} mm aside", x.hypot(y) * 1e3));
    }
    if change.slower > 0 {
        parts.push("slower".to_owned());
    }
    if let Some(factor) = change.force_factor {
        parts.push(format!("with {:.0} % of the force", factor * 1e2));
    }
    parts.join(", ")
}

fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

impl Intent {
    /// What will be done, in words.
    #[must_use]
    pub fn words(&self, module: &Module) -> String {
        let attempt = self.incident.attempts.len() + 1;
        match self.what {
            Intended::Back { actions, to, why, change } => {
                let far = counted(actions, "action");
                let place = format!("`{}` ({})", said(module, to), line_of(module, to));
                let how = change.map(|change| format!(", {}", changed(change)));
                let (why, how) = (reason(why), how.unwrap_or_default());
                format!("back {far}, to {place}{why}, and forward again, attempt {attempt}{how}")
            }
            Intended::InPlace => format!("again from where the arm is, attempt {attempt}"),
            Intended::GiveUp(why @ GiveUp::NoRecovery) => why.to_string(),
            Intended::GiveUp(GiveUp::Explicit) => {
                format!("as the program says, {}", sequence_name(module, &self.incident))
            }
            Intended::GiveUp(why) => {
                let error = &module.errors[self.incident.error.index()];
                let then = match error.otherwise {
                    _ if !self.goes_on => "an operator is called".to_owned(),
                    Otherwise::Using(_) => sequence_name(module, &self.incident).to_owned(),
                    Otherwise::Operator => "an operator is called".to_owned(),
                    Otherwise::Stop => "the program stops".to_owned(),
                };
                format!("it is given up: {why}; then {then}")
            }
        }
    }
}

/// The name of the sequence that a program has against an error.
fn sequence_name<'m>(module: &'m Module, incident: &Incident) -> &'m str {
    let sequence = sequence(&module.errors[incident.error.index()]);
    let function = sequence.and_then(|sequence| module.functions.get(sequence.index()));
    function.map_or("", |function| &function.name)
}
