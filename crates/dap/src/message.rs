//! What a client asks: the requests that are understood, with what they are given.
//!
//! Whatever else a client sends along is passed over, as the protocol wants it.

use crate::arguments::given;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::PathBuf;

/// A request.
#[derive(Clone, Debug, Deserialize)]
pub struct Request {
    /// Its number.
    pub seq: i64,
    /// What is asked for.
    pub command: String,
    /// What it is given.
    #[serde(default)]
    pub arguments: Value,
}

impl Request {
    /// What it is given, as what it must be.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn given<T: DeserializeOwned>(&self) -> Result<T, String> {
        given(&format!("`{}`", self.command), &self.arguments)
    }
}

/// The request that bytes are.
///
/// # Errors
/// Why they are none.
pub fn request(bytes: &[u8]) -> Result<Request, String> {
    let message: Value = serde_json::from_slice(bytes).map_err(|error| {
        let (line, column) = (error.line(), error.column());
        format!("this is no message of the protocol: no JSON from line {line}, column {column} on")
    })?;
    match message.get("type").and_then(Value::as_str) {
        Some("request") => given("a request", &message),
        Some(kind) => Err(format!("a client sends requests, and this is of type `{kind}`")),
        None => Err("this is no message of the protocol: it has no `type`".to_owned()),
    }
}

/// What `initialize` is given.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Client {
    #[serde(rename = "linesStartAt1")]
    pub(crate) lines_from_1: bool,
    #[serde(rename = "columnsStartAt1")]
    pub(crate) columns_from_1: bool,
    pub(crate) path_format: Option<String>,
    pub(crate) supports_invalidated_event: bool,
}

impl Default for Client {
    fn default() -> Self {
        Self {
            lines_from_1: true,
            columns_from_1: true,
            path_format: None,
            supports_invalidated_event: false,
        }
    }
}

impl Client {
    /// That it names files as they are named here.
    pub(crate) fn check(self) -> Result<Self, String> {
        match self.path_format.as_deref() {
            None | Some("path") => Ok(self),
            Some(other) => {
                Err(format!("`pathFormat` must be `path`, and is `{other}`: files have paths here"))
            }
        }
    }

    /// A line from 1, as the client counts.
    pub(crate) fn line(&self, line: usize) -> usize {
        line - usize::from(!self.lines_from_1 && line > 0)
    }

    /// A column from 1, as the client counts.
    pub(crate) fn column(&self, column: usize) -> usize {
        column - usize::from(!self.columns_from_1 && column > 0)
    }

    /// A line of the client's, from 1.
    pub(crate) fn line_of(&self, line: usize) -> usize {
        line.saturating_add(usize::from(!self.lines_from_1))
    }
}

/// What `launch` is given.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Launch {
    /// The program.
    pub program: PathBuf,
    /// The workcell file, in place of the one that the program names.
    pub cell: Option<PathBuf>,
    /// What all chance in the workcell follows from.
    #[serde(default)]
    pub seed: u64,
    /// The program after which it begins, run in the same workcell first.
    pub after: Option<PathBuf>,
    /// Files of values for parameters of actions, in place of their defaults.
    #[serde(default)]
    pub parameters: Vec<PathBuf>,
    /// How errors are recovered from whose recovery is reversal.
    pub strategy: Option<String>,
    /// The file that keeps what is learned of how far to go back.
    pub memory: Option<PathBuf>,
    /// About how many instructions a request runs at the most.
    pub limit: Option<u64>,
    /// Whether to stop before the first action.
    #[serde(default)]
    pub stop_on_entry: bool,
    /// Whether to stay at the end of the program, from where one can go back.
    #[serde(default = "yes")]
    pub stop_at_end: bool,
    /// Whether to run without any stop.
    #[serde(default)]
    pub no_debug: bool,
}

fn yes() -> bool {
    true
}

/// What `attach` is given.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Attach {
    /// The tape file of a run, which is opened at its end.
    pub tape: PathBuf,
    /// The program that it must be of; a tape has its own.
    pub program: Option<PathBuf>,
    /// Files of values for parameters of that program.
    #[serde(default)]
    pub parameters: Vec<PathBuf>,
    /// The workcell file in which to try what would have been, in place of the tape's.
    pub cell: Option<PathBuf>,
    /// How errors are recovered from in what is tried.
    pub strategy: Option<String>,
    /// About how many instructions a request runs at the most.
    pub limit: Option<u64>,
}

/// What a client wants to debug.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// A program, from its start.
    Launch(Launch),
    /// A tape, at its end.
    Attach(Attach),
}

/// A source as a client names it.
#[derive(Clone, Debug, Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Source {
    pub(crate) name: Option<String>,
    pub(crate) path: Option<String>,
    pub(crate) source_reference: Option<u64>,
}

#[derive(Deserialize)]
pub(crate) struct SetBreakpoints {
    pub(crate) source: Source,
    pub(crate) breakpoints: Option<Vec<Value>>,
    /// In place of breakpoints, from older clients.
    #[serde(default)]
    pub(crate) lines: Vec<usize>,
}

/// What breakpoints of any kind are given without a source.
#[derive(Deserialize)]
pub(crate) struct SetPoints {
    #[serde(default)]
    pub(crate) breakpoints: Vec<Value>,
}

/// A breakpoint of any kind; which parts must be there is for its kind to say.
#[derive(Clone, Debug, Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Asked {
    pub(crate) line: Option<usize>,
    pub(crate) name: Option<String>,
    pub(crate) instruction_reference: Option<String>,
    pub(crate) offset: i64,
    pub(crate) data_id: Option<String>,
    pub(crate) access_type: Option<String>,
    pub(crate) condition: Option<String>,
    pub(crate) hit_condition: Option<String>,
    pub(crate) log_message: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SetExceptions {
    #[serde(default)]
    pub(crate) filters: Vec<String>,
    #[serde(default)]
    pub(crate) filter_options: Vec<FilterOption>,
}

/// A filter of errors, for some of them.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct FilterOption {
    pub(crate) filter_id: String,
    pub(crate) condition: Option<String>,
}

/// The thread that most requests name.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct ThreadId {
    pub(crate) thread_id: u64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct DataInfo {
    pub(crate) name: String,
    pub(crate) frame_id: Option<usize>,
    pub(crate) variables_reference: Option<u64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct StackTrace {
    #[serde(default)]
    pub(crate) start_frame: Option<usize>,
    pub(crate) levels: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct FrameId {
    pub(crate) frame_id: usize,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Variables {
    pub(crate) variables_reference: u64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SetVariable {
    pub(crate) variables_reference: u64,
    pub(crate) name: String,
    pub(crate) value: String,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Evaluate {
    pub(crate) expression: String,
    pub(crate) frame_id: Option<usize>,
    pub(crate) context: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Completions {
    pub(crate) text: String,
    pub(crate) column: usize,
    pub(crate) line: Option<usize>,
    pub(crate) frame_id: Option<usize>,
}

#[derive(Deserialize)]
pub(crate) struct Step {
    pub(crate) granularity: Option<String>,
}

#[derive(Deserialize)]
pub(crate) struct GotoTargets {
    pub(crate) source: Source,
    pub(crate) line: usize,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Goto {
    pub(crate) target_id: usize,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Disassemble {
    pub(crate) memory_reference: String,
    #[serde(default)]
    pub(crate) offset: i64,
    #[serde(default)]
    pub(crate) instruction_offset: i64,
    pub(crate) instruction_count: usize,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SourceText {
    pub(crate) source: Option<Source>,
    #[serde(default)]
    pub(crate) source_reference: u64,
}
