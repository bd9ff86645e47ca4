//! What a client is shown of the moment that the session shows: calls, scopes, variables.
//!
//! A reference to variables is a number that says which they are, so that nothing has to be kept.

use crate::debuggee::Debuggee;
use crate::message::StackTrace;
use crate::places;
use obverse_bytecode::FunctionKind;
use obverse_debugger::session::{FrameView, Variable};
use obverse_debugger::{Subject, Value as Known};
use obverse_isa::{ErrorId, Setting};
use serde_json::{Value, json};

/// Variables of the program.
const GLOBALS: u64 = 1;
/// What is seen of the workcell.
const WORKCELL: u64 = 2;
/// Settings.
const SETTINGS: u64 = 3;
/// The errors, and which are pending.
const ERRORS: u64 = 4;
/// The six joints.
const JOINTS: u64 = 5;
/// Local variables of the outermost call; of each further one, one more.
const LOCALS: u64 = 100;

impl Debuggee<'_, '_, '_> {
    /// The calls under way, innermost first.
    pub(crate) fn stack(&self, asked: &StackTrace) -> Value {
        let frames = self.session.frames();
        let start = asked.start_frame.unwrap_or(0);
        let levels = asked.levels.filter(|levels| *levels > 0).unwrap_or(usize::MAX);
        let shown = frames.iter().rev().skip(start).take(levels);
        let shown: Vec<Value> = shown.map(|frame| self.frame(frame)).collect();
        json!({ "stackFrames": shown, "totalFrames": frames.len() })
    }

    fn frame(&self, frame: &FrameView) -> Value {
        let mut shown = json!({
            "id": frame.index + 1,
            "name": frame.name,
            "line": 0,
            "column": 0,
            "instructionPointerReference": frame.pc.to_string(),
        });
        let module = self.session.module();
        let function = module.functions.get(usize::from(frame.function));
        if function.is_some_and(|function| function.kind == FunctionKind::Start) {
            shown["name"] = json!("the start");
            // An editor shows the variables of what is not subtle, and here is nothing else.
            if self.session.frames().len() > 1 {
                shown["presentationHint"] = json!("subtle");
            }
        }
        if let Some(place) = &frame.place {
            shown["line"] = json!(self.server.client.line(place.line));
            shown["column"] = json!(self.server.client.column(place.column));
            shown["source"] = places::source(self.loaded, &place.file);
        }
        shown
    }

    /// The scopes of a call.
    pub(crate) fn scopes(&self, frame: usize) -> Result<Value, String> {
        let depth = self.session.frames().len();
        if frame == 0 || frame > depth {
            return Err(format!("there is no call {frame}: {depth} are under way"));
        }
        let scope = |name: &str, reference: u64| {
            let mut scope = json!({ "name": name, "expensive": false });
            scope["variablesReference"] = json!(reference);
            scope
        };
        let mut locals = scope("Locals", LOCALS + frame as u64 - 1);
        locals["presentationHint"] = json!("locals");
        let mut scopes = vec![locals, scope("Globals", GLOBALS), scope("Workcell", WORKCELL)];
        scopes.push(scope("Settings", SETTINGS));
        if !self.session.module().errors.is_empty() {
            scopes.push(scope("Errors", ERRORS));
        }
        Ok(json!({ "scopes": scopes }))
    }

    /// The variables of a reference.
    pub(crate) fn known(&self, reference: u64) -> Result<Vec<Variable>, String> {
        let module = self.session.module();
        let is_setting = |it: &Variable| matches!(it.subject, Some(Subject::Setting(_)));
        let subjects = |all: Vec<Subject>| {
            self.session.look(|look| {
                let variable = |subject: Subject| Variable {
                    name: subject.name(module),
                    value: subject.read(look),
                    subject: Some(subject),
                };
                all.into_iter().map(variable).collect::<Vec<_>>()
            })
        };
        Ok(match reference {
            GLOBALS => self.session.globals(),
            WORKCELL => {
                let inputs = (0..self.session.recording().facts.inputs).map(Subject::Input);
                let seen = self.session.workcell().into_iter().filter(|it| !is_setting(it));
                seen.chain(subjects(inputs.collect())).collect()
            }
            SETTINGS => subjects(Setting::ALL.iter().map(|it| Subject::Setting(*it)).collect()),
            ERRORS => {
                let all = (0..module.errors.len()).map(|it| Subject::Error(ErrorId(it as u16)));
                subjects(all.collect())
            }
            JOINTS => subjects((0..6).map(Subject::Joint).collect()),
            _ => {
                let frame = reference.checked_sub(LOCALS).and_then(|it| usize::try_from(it).ok());
                let depth = self.session.frames().len();
                let frame = frame.filter(|frame| *frame < depth);
                let missing = || format!("nothing is called {reference} any more");
                self.session.locals(frame.ok_or_else(missing)?)
            }
        })
    }

    /// The same as a client is shown them.
    pub(crate) fn variables(&self, reference: u64) -> Result<Value, String> {
        let shown: Vec<Value> = self.known(reference)?.iter().map(variable).collect();
        Ok(json!({ "variables": shown }))
    }

    /// The variable of a reference that has a name.
    pub(crate) fn named(&self, reference: u64, name: &str) -> Result<Subject, String> {
        let known = self.known(reference)?;
        let found = known.into_iter().find(|variable| variable.name == name);
        let missing = || format!("nothing is called `{name}` here");
        let outer = || format!("`{name}` belongs to a call further out of the same sequence");
        found.ok_or_else(missing)?.subject.ok_or_else(outer)
    }

    /// The function whose names hold in a call; in the innermost if none is named.
    pub(crate) fn function_of(&self, frame: Option<usize>) -> usize {
        let frames = self.session.frames();
        let named = frame.and_then(|frame| frames.get(frame.checked_sub(1)?));
        named.or(frames.last()).map_or(0, |frame| usize::from(frame.function))
    }

    /// The function whose names hold among variables.
    pub(crate) fn function_of_variables(&self, reference: u64) -> usize {
        let frame = reference.checked_sub(LOCALS).and_then(|it| usize::try_from(it).ok());
        self.function_of(frame.map(|frame| frame.saturating_add(1)))
    }
}

fn variable(variable: &Variable) -> Value {
    let is_arm = variable.subject == Some(Subject::Joints);
    let mut shown = json!({
        "name": variable.name,
        "value": variable.value.to_string(),
        "type": type_name(&variable.value),
        "variablesReference": if is_arm { JOINTS } else { 0 },
    });
    if !variable.subject.as_ref().is_some_and(can_be_set) {
        shown["presentationHint"] = json!({ "attributes": ["readOnly"] });
    }
    if variable.subject.is_some() {
        shown["evaluateName"] = json!(variable.name);
    }
    shown
}

/// Whether a person can give it another value.
pub(crate) fn can_be_set(subject: &Subject) -> bool {
    matches!(subject, Subject::Input(_) | Subject::Global(_) | Subject::Local(..))
}

/// What a value is, in a word.
pub(crate) fn type_name(value: &Known) -> &'static str {
    match value {
        Known::Int(_) => "integer",
        Known::Real(_) | Known::Quantity(..) | Known::Unlimited => "real",
        Known::Bool(_) => "truth value",
        Known::Joints(_) => "joints",
        Known::Name(_) => "name",
        Known::Absent | Known::Wrong(_) => "",
    }
}
