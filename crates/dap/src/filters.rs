//! Which errors stop a run: those that are due, where they are raised, all of them or some.

use crate::message::FilterOption;
use obverse_bytecode::Module;
use obverse_bytecode::text::nearest;
use obverse_debugger::{Breakpoint, Expression, Subject};
use obverse_isa::ErrorId;
use obverse_vm::Direction;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// The filter of errors that are due.
const DUE: &str = "due";
/// The filter of errors where they are raised.
const RAISED: &str = "raised";
/// What the filter of one error begins with.
const ERROR: &str = "error ";
/// What the condition of a filter is.
const CONDITION: &str = "The names of errors, as in `pin_jams, rack_is_empty`; without any, all.";

/// A filter that a client has set.
pub(crate) struct Filter {
    /// Whether it stops where an error is raised, and not only where it is due.
    is_raised: bool,
    /// The errors that it is for; none is all of them.
    errors: Option<BTreeSet<usize>>,
}

impl Filter {
    /// That of all errors that are due.
    pub(crate) fn due() -> Self {
        Self { is_raised: false, errors: None }
    }

    /// The filter that is asked for.
    pub(crate) fn of(module: &Module, asked: &FilterOption) -> Result<Self, String> {
        let named = asked.condition.as_deref().map(|names| errors(module, names)).transpose()?;
        let named = named.filter(|named| !named.is_empty());
        match asked.filter_id.as_str() {
            DUE => Ok(Self { is_raised: false, errors: named }),
            RAISED => Ok(Self { is_raised: true, errors: named }),
            id => {
                let name = id.strip_prefix(ERROR).ok_or_else(|| {
                    format!("there is no filter `{id}`: there are `{DUE}`, `{RAISED}`")
                })?;
                Ok(Self { is_raised: true, errors: Some(BTreeSet::from([error(module, name)?])) })
            }
        }
    }

    /// Whether it is for an error.
    pub(crate) fn is_of(&self, error: usize) -> bool {
        self.errors.as_ref().is_none_or(|errors| errors.contains(&error))
    }

    /// The errors that it stops at where they are raised.
    pub(crate) fn raised(&self, module: &Module) -> BTreeSet<usize> {
        let all = (0..module.errors.len()).filter(|_| self.is_raised);
        all.filter(|error| self.is_of(*error)).collect()
    }
}

/// The errors of some names.
fn errors(module: &Module, names: &str) -> Result<BTreeSet<usize>, String> {
    let names = names.split(|c: char| c == ',' || c.is_whitespace());
    names.filter(|name| !name.is_empty()).map(|name| error(module, name)).collect()
}

fn error(module: &Module, name: &str) -> Result<usize, String> {
    let found = module.errors.iter().position(|error| error.name == name);
    found.ok_or_else(|| {
        let meant = nearest(name, module.errors.iter().map(|error| error.name.as_str()));
        let meant = meant.map(|meant| format!("; `{meant}`?")).unwrap_or_default();
        format!("the program declares no error `{name}`{meant}")
    })
}

/// What stops a run behind whatever raises an error.
pub(crate) fn where_raised(module: &Module, error: usize) -> Breakpoint {
    let expression = Expression::of(module, Subject::Error(ErrorId(error as u16)));
    let mut breakpoint = Breakpoint::on_change(expression);
    // Going back over where it was raised is no news.
    breakpoint.direction = Some(Direction::Forward);
    breakpoint.condition = {
        let name = format!("error {}", module.errors[error].name);
        Expression::condition(module, 0, &name).ok()
    };
    breakpoint
}

/// What a client can be asked about errors: those of a program, once there is one.
pub(crate) fn offered(module: Option<&Module>) -> Value {
    let filter = |filter: &str, label: &str, description: &str, default: bool| {
        json!({
            "filter": filter, "label": label, "description": description, "default": default,
        })
    };
    let mut all = vec![
        filter(DUE, "Errors that are due", "Stop where the program responds to an error.", true),
        filter(RAISED, "Errors when raised", "Stop behind whatever raises an error.", false),
    ];
    for general in &mut all {
        general["supportsCondition"] = json!(true);
        general["conditionDescription"] = json!(CONDITION);
    }
    for error in module.map(|module| &module.errors).into_iter().flatten() {
        let description = format!("Stop where `{}` is raised, and where it is due.", error.name);
        let label = format!("Error {}", error.name);
        all.push(filter(&format!("{ERROR}{}", error.name), &label, &description, false));
    }
    json!(all)
}
