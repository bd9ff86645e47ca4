//! What is given another value by hand: in a what-if, which leaves the run as it was.

use crate::debuggee::{Answer, Debuggee};
use crate::message::{Request, SetVariable};
use crate::shown;
use obverse_debugger::{Declined, Expression, Mode, Session, Subject, Value as Known};
use obverse_sim::Sim;
use serde_json::json;

impl Debuggee<'_, '_, '_> {
    pub(crate) fn set_variable(&mut self, request: &Request) -> Answer {
        let asked: SetVariable = request.given()?;
        let subject = self.named(asked.variables_reference, &asked.name)?;
        let function = self.function_of_variables(asked.variables_reference);
        let value = self.assign(&subject, function, &asked.value)?;
        if self.server.client.supports_invalidated_event {
            self.server.out.event("invalidated", json!({ "areas": ["all"] }));
        }
        let kind = shown::type_name(&value);
        Ok(json!({ "value": value.to_string(), "type": kind, "variablesReference": 0 }))
    }

    /// Give something a value: in a what-if, which begins here if none has.
    pub(crate) fn assign(
        &mut self,
        subject: &Subject,
        function: usize,
        text: &str,
    ) -> Result<Known, String> {
        self.refuse_moving()?;
        let module = self.session.module();
        if !shown::can_be_set(subject) {
            let name = subject.name(module);
            return Err(format!("`{name}` can only be looked at: variables and inputs can be set"));
        }
        let expression =
            Expression::parse(module, function, text).map_err(|error| error.to_string())?;
        let value = self.session.look(|look| expression.value(look));
        let done = self.in_what_if(|session| match (subject, &value) {
            (Subject::Input(bit), Known::Bool(level)) => session.force_input(*bit, Some(*level)),
            (Subject::Global(_) | Subject::Local(..), _) => session.assign(subject, &value),
            _ => Err(Declined::NotAssignable),
        });
        done.map_err(|why| format!("`{}`: {why}", subject.name(module)))?;
        match subject {
            Subject::Input(_) => Ok(value),
            _ => Ok(self.session.look(|look| subject.read(look))),
        }
    }

    /// Change something in a what-if, which begins here if none has; if it cannot be changed, none
    /// begins.
    pub(crate) fn in_what_if(
        &mut self,
        change: impl FnOnce(&mut Session<'_, Sim>) -> Result<(), Declined>,
    ) -> Result<(), String> {
        self.refuse_moving()?;
        let is_new = self.session.mode() != Mode::WhatIf;
        if is_new {
            self.session.what_if().map_err(|why| why.to_string())?;
        }
        if let Err(why) = change(&mut self.session) {
            if is_new {
                self.session.leave_what_if().map_err(|why| why.to_string())?;
            }
            return Err(why.to_string());
        }
        if is_new {
            let text = "what follows is a what-if, in a copy of the workcell; `leave` goes back to \
                        the run, which stays as it was";
            self.server.out.tell("console", text);
        }
        Ok(())
    }
}
