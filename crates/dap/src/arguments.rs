//! What `launch` and `attach` can be given: one list, by which a request is checked, and which the
//! command line's help and the editors' packages repeat.

use crate::message::{Request, Wanted};
use obverse_bytecode::text::nearest;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::Path;

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
    /// A whole number of either sign.
    Signed,
    /// Anything with parts of its own.
    Parts,
    /// Several of these.
    List,
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
            Self::Signed => "integer",
            Self::Parts => "object",
            Self::List => "array",
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Texts => "a list of texts",
            Self::Number => "a whole number from 0",
            Self::Flag => "true or false",
            Self::Signed => "a whole number",
            Self::Parts => "an object",
            Self::List => "a list",
        }
    }

    fn is(self, value: &Value) -> bool {
        match self {
            Self::Text => value.is_string(),
            Self::Texts => value.as_array().is_some_and(|all| all.iter().all(Value::is_string)),
            Self::Number => value.is_u64(),
            Self::Flag => value.is_boolean(),
            Self::Signed => value.is_i64(),
            Self::Parts => value.is_object(),
            Self::List => value.is_array(),
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
const OF_EDITORS: [&str; 15] = [
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
];

/// The folder that relative paths are in, which editors send along for other debuggers.
const CWD: Argument = argument("cwd", Kind::Text, "the folder that relative paths are in");

/// What of a request is a path.
const PATHS: [&str; 6] = ["program", "tape", "cell", "after", "memory", "parameters"];

/// What a request wants to debug, and what of it is passed over.
///
/// # Errors
/// What is missing, or is something else than it must be, by name.
pub(crate) fn wanted(request: &Request) -> Result<(Wanted, Vec<String>), String> {
    let is_attach = request.command == "attach";
    let known = if is_attach { ATTACH } else { LAUNCH };
    let mut given = request.arguments.as_object().cloned().unwrap_or_default();
    given.retain(|_, value| !value.is_null());
    for argument in known.iter().chain([&NO_DEBUG, &CWD]) {
        check(&request.command, argument, given.get(argument.name))?;
    }
    let names: Vec<String> = given.keys().cloned().collect();
    if let Some(Value::String(folder)) = given.remove(CWD.name) {
        let paths = given.iter_mut().filter(|(name, _)| PATHS.contains(&name.as_str()));
        paths.for_each(|(_, path)| lead_from(&folder, path));
    }
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

/// A path, or several, as they are from a folder.
fn lead_from(folder: &str, path: &mut Value) {
    match path {
        Value::String(path) => {
            let led = Path::new(folder).join(&*path);
            // Both were text, and so is what is made of them.
            led.to_str().unwrap_or_default().clone_into(path);
        }
        Value::Array(all) => all.iter_mut().for_each(|path| lead_from(folder, path)),
        _ => {}
    }
}

/// What is told of an argument that is not understood; nothing of what editors add.
fn passed_over(command: &str, known: &[Argument], name: &str) -> Option<String> {
    let names = || known.iter().map(|argument| argument.name);
    let is_own = [NO_DEBUG.name, CWD.name].contains(&name);
    let is_private = name.starts_with(['_', '$']) || is_own;
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
        Some(value) if !kind.is(value) => Err(must_be(name, &format!("`{command}`"), *kind, value)),
        _ => Ok(()),
    }
}

fn must_be(name: &str, of: &str, kind: Kind, value: &Value) -> String {
    let shown: String = value.to_string().chars().take(60).collect();
    format!("`{name}` of {of} must be {}, and is {shown}", kind.words())
}

/// What the parts of all other requests must be: a name means the same in each.
const PARTS: [(&str, Kind); 38] = [
    ("seq", Kind::Signed),
    ("command", Kind::Text),
    ("linesStartAt1", Kind::Flag),
    ("columnsStartAt1", Kind::Flag),
    ("pathFormat", Kind::Text),
    ("supportsInvalidatedEvent", Kind::Flag),
    ("source", Kind::Parts),
    ("name", Kind::Text),
    ("path", Kind::Text),
    ("sourceReference", Kind::Number),
    ("breakpoints", Kind::List),
    ("lines", Kind::List),
    ("line", Kind::Number),
    ("column", Kind::Number),
    ("condition", Kind::Text),
    ("hitCondition", Kind::Text),
    ("logMessage", Kind::Text),
    ("instructionReference", Kind::Text),
    ("dataId", Kind::Text),
    ("accessType", Kind::Text),
    ("filters", Kind::Texts),
    ("filterOptions", Kind::List),
    ("filterId", Kind::Text),
    ("threadId", Kind::Number),
    ("frameId", Kind::Number),
    ("startFrame", Kind::Number),
    ("levels", Kind::Number),
    ("variablesReference", Kind::Number),
    ("value", Kind::Text),
    ("expression", Kind::Text),
    ("context", Kind::Text),
    ("text", Kind::Text),
    ("granularity", Kind::Text),
    ("targetId", Kind::Number),
    ("memoryReference", Kind::Text),
    ("offset", Kind::Signed),
    ("instructionOffset", Kind::Signed),
    ("instructionCount", Kind::Number),
];

/// What something that a client sends says, as what it must be.
///
/// # Errors
/// Which part of it is missing or is something else than it must be.
pub(crate) fn given<T: DeserializeOwned>(of: &str, value: &Value) -> Result<T, String> {
    let whole = match value {
        Value::Null => Value::Object(serde_json::Map::new()),
        Value::Object(_) => value.clone(),
        _ => return Err(format!("what {of} is given must be an object")),
    };
    let wrong = wrong_part(of, &whole);
    serde_json::from_value(whole).map_err(|error| {
        let error = error.to_string();
        let missing = error.strip_prefix("missing field `").and_then(|it| it.split('`').next());
        let missing = missing.map(|name| format!("{of} must say `{name}`"));
        wrong.or(missing).unwrap_or_else(|| format!("{of} is given what it cannot be"))
    })
}

/// What is wrong with the first part, of itself or within another, that is not what it must be.
fn wrong_part(of: &str, whole: &Value) -> Option<String> {
    let parts = whole.as_object()?;
    let wrong = |(name, value): (&String, &Value)| {
        let (_, kind) = PARTS.iter().find(|(known, _)| known == name)?;
        match kind {
            _ if value.is_null() => None,
            Kind::Parts if value.is_object() => wrong_part(of, value),
            Kind::List if value.is_array() => {
                value.as_array()?.iter().find_map(|part| wrong_part(of, part))
            }
            kind if !kind.is(value) => Some(must_be(name, of, *kind, value)),
            _ => None,
        }
    };
    parts.iter().find_map(wrong)
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
    fn relative_paths_are_in_the_folder_that_is_named() {
        let given = json!({
            "program": "a.obv", "cell": "/b.toml", "parameters": ["c.toml"], "cwd": "/x/y",
        });
        let (Wanted::Launch(launch), told) = of("launch", given).expect("it is understood") else {
            panic!("it is a launch");
        };
        assert_eq!((launch.program, told.len()), ("/x/y/a.obv".into(), 0));
        assert_eq!(
            (launch.cell, launch.parameters),
            (Some("/b.toml".into()), vec!["/x/y/c.toml".into()])
        );
        assert!(of("launch", json!({ "program": "a", "cwd": 3 })).is_err());
    }

    #[test]
    fn parts_of_requests_are_refused_by_name() {
        use crate::message::{Asked, Evaluate, SetBreakpoints};
        fn why<T: DeserializeOwned>(value: Value) -> String {
            given::<T>("`it`", &value).map(|_| ()).expect_err("it is wrong")
        }
        let of_source = json!({ "source": { "path": 3 }, "breakpoints": [] });
        let told = why::<SetBreakpoints>(of_source);
        assert_eq!(told, "`path` of `it` must be text, and is 3");
        assert_eq!(why::<SetBreakpoints>(json!({})), "`it` must say `source`");
        assert_eq!(why::<Evaluate>(json!([1])), "what `it` is given must be an object");
        let told = why::<Asked>(json!({ "line": "x", "condition": null }));
        assert_eq!(told, "`line` of `it` must be a whole number from 0, and is \"x\"");
        let lines = json!({ "source": {}, "lines": [true] });
        assert_eq!(why::<SetBreakpoints>(lines), "`it` is given what it cannot be");
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
