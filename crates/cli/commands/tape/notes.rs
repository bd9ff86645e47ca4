//! What a tape notes of recoveries, in words and for machines. What a file says is only shown.

use crate::report;
use crate::story::said;
use obverse_bytecode::Module;
use obverse_tape::{Note, Noted};
use serde_json::{Value, json};

/// A note on one line: when, the error, and what happened.
pub(super) fn line(module: &Module, note: &Note) -> String {
    let place = report::line_of(module, note.pc);
    format!("{:>9.2} s  {} at {place}: {}", note.time_s, error(module, note), words(module, note))
}

fn error<'m>(module: &'m Module, note: &Note) -> &'m str {
    module.errors.get(usize::from(note.error)).map_or("unknown", |error| &error.name)
}

fn words(module: &Module, note: &Note) -> String {
    match &note.what {
        Noted::Fault => "raised by a fault".to_owned(),
        Noted::Back { actions, to } => {
            let plural = if *actions == 1 { "" } else { "s" };
            let to = format!("`{}` ({})", said(module, *to), report::line_of(module, *to));
            format!("back {actions} action{plural}, to {to}")
        }
        Noted::InPlace { backed_up_m: None } => "again from where the arm was".to_owned(),
        Noted::InPlace { backed_up_m: Some(far_m) } => {
            format!("backed up {:.0} mm, and again", far_m * 1e3)
        }
        Noted::Blocked { at } => format!("blocked at {}", report::line_of(module, *at)),
        Noted::Again { slower, force_factor, aside_m } => {
            let aside = aside_m.map(|[x, y]| format!(", {:.2} mm aside", x.hypot(y) * 1e3));
            let slower = (*slower > 0).then(|| ", slower".to_owned());
            let force = force_factor.map(|by| format!(", with {:.0} % of the force", by * 1e2));
            let changes: String = [aside, slower, force].into_iter().flatten().collect();
            format!("forward again, attempt {}{changes}", note.attempts)
        }
        Noted::Recovered => format!("past it, attempts: {}", note.attempts),
        Noted::GivenUp { why } if why == "explicit" => "left to its sequence".to_owned(),
        Noted::GivenUp { why } => format!("given up ({why}), attempts: {}", note.attempts),
    }
}

/// A note for machines.
pub(super) fn object(module: &Module, note: &Note) -> Value {
    let (code, details) = match &note.what {
        Noted::Fault => ("fault", json!({})),
        Noted::Back { actions, to } => {
            ("back", json!({ "actions": actions, "to": report::place(module, Some(*to)) }))
        }
        Noted::InPlace { backed_up_m } => ("in_place", json!({ "backed_up_m": backed_up_m })),
        Noted::Blocked { at } => ("blocked", json!({ "at": report::place(module, Some(*at)) })),
        Noted::Again { slower, force_factor, aside_m } => {
            ("again", json!({ "slower": slower, "force_factor": force_factor, "aside_m": aside_m }))
        }
        Noted::Recovered => ("recovered", json!({})),
        Noted::GivenUp { why } => ("given_up", json!({ "why": why })),
    };
    json!({
        "type": "note",
        "step": code,
        "error": error(module, note),
        "due": report::place(module, Some(note.pc)),
        "attempts": note.attempts,
        "steps": note.steps,
        "time_s": note.time_s,
        "details": details,
    })
}
