//! What `launch` and `attach` can be given: one list, by which a request is checked, and which the
//! command line's help and the editors' packages repeat.

use crate::message::{Request, Wanted};
use obverse_bytecode::text::nearest;
use serde_json::Value;

/// What an argument must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Text, the path of a file for one.
    Text,
    /// Several of them.
    Texts,
    /// A whole number, from 0.
    Number,
    /// Whether something holds.
    Flag,
}

impl Kind {
    /// What it is called in a JSON schema.
    #[must_use]
    pub fn schema(self) -> &'static str {
        match self {
            Self::Text => "string",
            Self::Texts => "array",
            Self::Number => "integer",
            Self::Flag => "boolean",
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Texts => "a list of texts",
            Self::Number => "a whole number from 0",
            Self::Flag => "true or false",
        }
    }

    fn is(self, value: &Value) -> bool {
        match self {
            Self::Text => value.is_string(),
            Self::Texts => value.as_array().is_some_and(|all| all.iter().all(Value::is_string)),
            Self::Number => value.is_u64(),
            Self::Flag => value.is_boolean(),
        }
    }
}

/// An argument.
#[derive(Clone, Copy, Debug)]
pub struct Argument {
    /// Its name.
    pub name: &'static str,
    /// What it must be.
    pub kind: Kind,
    /// Whether nothing can be begun without it.
    pub is_required: bool,
    /// What it says, with what holds without it in parentheses.
    pub about: &'static str,
}

const fn argument(name: &'static str, kind: Kind, about: &'static str) -> Argument {
    Argument { name, kind, is_required: false, about }
}

const fn required(name: &'static str, about: &'static str) -> Argument {
    Argument { name, kind: Kind::Text, is_required: true, about }
}

/// What `launch` understands.
pub const LAUNCH: &[Argument] = &[
    required("program", "the program: source, assembly text or module"),
    argument("cell", Kind::Text, "the workcell file, in place of the one that the program names"),
    argument("seed", Kind::Number, "what all chance in the workcell follows from (0)"),
    argument(
        "after",
        Kind::Text,
        "the program after which it begins, run in the same workcell first",
    ),
    argument(
        "parameters",
        Kind::Texts,
        "files of values for parameters of actions, in place of their defaults",
    ),
    argument(
        "strategy",
        Kind::Text,
        "how errors are recovered from whose recovery is reversal (declared)",
    ),
    argument("memory", Kind::Text, "the file that keeps what is learned of how far to go back"),
    argument(
        "limit",
        Kind::Number,
        "pause after about so many instructions of one request (never)",
    ),
    argument("stopOnEntry", Kind::Flag, "stop before the first action (false)"),
    argument(
        "stopAtEnd",
        Kind::Flag,
        "stay at the end of the program, from where one can go back (true)",
    ),
];

/// What `attach` understands.
pub const ATTACH: &[Argument] = &[
    required("tape", "the tape file, which is opened at its end"),
    argument("program", Kind::Text, "the program that it must be of; a tape has its own"),
    argument("parameters", Kind::Texts, "files of values for parameters of that program"),
    argument("cell", Kind::Text, "the workcell file to try otherwise in, in place of the tape's"),
    argument("strategy", Kind::Text, "how errors are recovered from in what is tried (declared)"),
    argument(
        "limit",
        Kind::Number,
        "pause after about so many instructions of one request (never)",
    ),
];

/// The protocol's own.
const NO_DEBUG: Argument = argument("noDebug", Kind::Flag, "run without any stop");

/// What editors keep beside it in a configuration, and send along.
const OF_EDITORS: [&str; 16] = [
    "type",
    "name",
    "request",
    "presentation",
    "preLaunchTask",
    "postDebugTask",
    "preRestartTask",
    "postRestartTask",
    "internalConsoleOptions",
    "suppressMultipleSessionWarning",
    "debugServer",
    "serverReadyAction",
    "windows",
    "linux",
    "osx",
    "cwd",
];

/// What a request wants to debug, and what of it is passed over.
///
/// # Errors
/// What is missing, or is something else than it must be, by name.
pub(crate) fn wanted(request: &Request) -> Result<(Wanted, Vec<String>), String> {
    let is_attach = request.command == "attach";
    let known = if is_attach { ATTACH } else { LAUNCH };
    let mut given = request.arguments.as_object().cloned().unwrap_or_default();
    given.retain(|_, value| !value.is_null());
    for argument in known.iter().chain([&NO_DEBUG]) {
        check(&request.command, argument, given.get(argument.name))?;
    }
    let names: Vec<String> = given.keys().cloned().collect();
    let request = Request { arguments: Value::Object(given), ..request.clone() };
    let wanted = match is_attach {
        true => Wanted::Attach(request.given()?),
        false => Wanted::Launch(request.given()?),
    };
    Ok((
        wanted,
        names.iter().filter_map(|name| passed_over(&request.command, known, name)).collect(),
    ))
}

/// What is told of an argument that is not understood; nothing of what editors add.
fn passed_over(command: &str, known: &[Argument], name: &str) -> Option<String> {
    let names = || known.iter().map(|argument| argument.name);
    let is_private = name.starts_with(['_', '$']) || name == NO_DEBUG.name;
    if is_private || names().any(|known| known == name) || OF_EDITORS.contains(&name) {
        return None;
    }
    let meant = match nearest(name, names()) {
        Some(meant) => format!("`{meant}`?"),
        None => format!("it understands {}", names().collect::<Vec<_>>().join(", ")),
    };
    Some(format!("`{command}` does not understand `{name}`, and passes it over: {meant}"))
}

fn check(command: &str, argument: &Argument, value: Option<&Value>) -> Result<(), String> {
    let Argument { name, kind, is_required, about } = argument;
    match value {
        None if *is_required => Err(format!("`{command}` must say `{name}`: {about}")),
        Some(value) if !kind.is(value) => {
            let shown: String = value.to_string().chars().take(60).collect();
            Err(format!("`{name}` of `{command}` must be {}, and is {shown}", kind.words()))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    //! What is passed over, and what is refused, is named.

    use super::*;
    use serde_json::json;

    fn of(command: &str, arguments: Value) -> Result<(Wanted, Vec<String>), String> {
        wanted(&Request { seq: 1, command: command.to_owned(), arguments })
    }

    #[test]
    fn what_is_not_understood_is_named_with_what_was_meant() {
        let given = json!({ "program": "x", "stoponEntry": true, "workcell": "y" });
        let (_, told) = of("launch", given).expect("it is understood");
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].contains("`stoponEntry`") && told[0].ends_with("`stopOnEntry`?"));
        assert!(told[1].contains("`workcell`") && told[1].contains("program, cell, seed"));
        let (_, told) = of("attach", json!({ "tape": "x", "seed": 3 })).expect("it is understood");
        assert!(told[0].contains("`attach` does not understand `seed`"), "{told:?}");
    }

    #[test]
    fn what_editors_add_is_passed_over_in_silence() {
        let mut given = json!({ "program": "x", "noDebug": false, "__sessionId": "1", "$x": 1 });
        for name in OF_EDITORS {
            given[name] = json!({ "order": 1 });
        }
        assert_eq!(of("launch", given).expect("it is understood").1, Vec::<String>::new());
    }

    #[test]
    fn what_has_the_wrong_type_is_refused_by_name() {
        let values =
            [json!("x"), json!(3), json!(-1), json!(1.5), json!(true), json!([1]), json!({})];
        for (command, known) in [("launch", LAUNCH), ("attach", ATTACH)] {
            let whole = json!({ known[0].name: "x" });
            assert!(of(command, whole.clone()).is_ok());
            let why = of(command, json!({})).expect_err("it lacks something");
            assert!(why.contains(&format!("`{}`", known[0].name)), "{why}");
            for argument in known.iter().filter(|argument| argument.name != "strategy") {
                for value in &values {
                    let mut given = whole.clone();
                    given[argument.name] = value.clone();
                    match of(command, given) {
                        Ok(_) => assert!(argument.kind.is(value), "{} {value}", argument.name),
                        Err(why) => {
                            assert!(!argument.kind.is(value), "{why}");
                            assert!(why.starts_with(&format!("`{}`", argument.name)), "{why}");
                        }
                    }
                }
            }
        }
    }
}
