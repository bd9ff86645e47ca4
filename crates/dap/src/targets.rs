//! The moments that a client can go to on a line.

use crate::debuggee::{Answer, Debuggee};
use crate::message::{Goto, GotoTargets, Request};
use crate::places;
use obverse_debugger::{Breakpoint, Halt, Moment, Places, Walk};
use obverse_vm::Direction;
use serde_json::{Value, json};

/// The most moments that are offered of a line.
const MAX_TARGETS: usize = 50;

/// A moment that is offered.
struct Target {
    moment: Moment,
    pc: u32,
    label: String,
}

impl Debuggee<'_, '_, '_> {
    /// The moments at which something was done on a line, newest first; of a line that does
    /// nothing itself, those at which it was come to.
    pub(crate) fn goto_targets(&mut self, asked: &GotoTargets) -> Answer {
        let file = places::file(self.loaded, &asked.source)?;
        let line = self.server.client.line_of(asked.line);
        let mut found = self.done_on(file, line);
        if found.is_empty() {
            found = self.come_to(file, line);
        }
        self.targets = found.iter().map(|target| target.moment).collect();
        let target = |(id, target): (usize, &Target)| {
            json!({
                "id": id,
                "label": format!("moment {}: {}", target.moment, target.label),
                "line": asked.line,
                "instructionPointerReference": target.pc.to_string(),
            })
        };
        let targets: Vec<Value> = found.iter().enumerate().map(target).collect();
        Ok(json!({ "targets": targets }))
    }

    fn done_on(&self, file: &str, line: usize) -> Vec<Target> {
        let mut actions = self.session.history();
        actions.retain(|action| places::is_on(action.place.as_ref(), file, line));
        let newest = actions.into_iter().rev().take(MAX_TARGETS);
        let target = |action: obverse_debugger::session::Action| {
            let is_back = action.direction == Direction::Reverse;
            let back = if is_back { "going back over " } else { "" };
            let label = format!("{back}{}", action.text);
            Target { moment: action.moment, pc: action.pc, label }
        };
        newest.map(target).collect()
    }

    /// Gone through from the end as a person would, by a breakpoint that is the only one meanwhile.
    fn come_to(&mut self, file: &str, line: usize) -> Vec<Target> {
        let module = self.session.module();
        let places = Places::of_line(module, Some(file), line);
        let Ok(places) = places.map_err(drop).and_then(|places| match places.line {
            Some(found) if found == line => Ok(places),
            _ => Err(()),
        }) else {
            return Vec::new();
        };
        let text = places::line_text(module, file, line);
        let others: Vec<u32> = self
            .session
            .breakpoints()
            .iter()
            .filter(|breakpoint| breakpoint.is_enabled)
            .map(|breakpoint| breakpoint.id)
            .collect();
        self.enable(&others, false);
        let id = self.session.add_breakpoint(Breakpoint::at(places));
        let end = self.session.recording().end;
        let mut found = Vec::new();
        // It is there: it is the end.
        let _ = self.session.go_to(end);
        // A few moments are looked for at once: whoever says something waits for them.
        self.server.inbox.hush();
        while found.len() < MAX_TARGETS {
            self.session.begin_command();
            match self.session.go(Direction::Reverse, Walk::Continue) {
                Halt::Hits(_) => {
                    let (moment, pc) = (self.session.moment(), self.session.position().pc);
                    found.push(Target { moment, pc, label: text.clone() });
                }
                _ => break,
            }
        }
        self.server.inbox.ring(self.session.interrupter());
        // These were there before.
        let _ = self.session.undo_jump();
        let _ = self.session.drop_breakpoint(id);
        self.enable(&others, true);
        found
    }

    fn enable(&mut self, ids: &[u32], is_enabled: bool) {
        for id in ids {
            let _ = self.session.change_breakpoint(*id, |it| it.is_enabled = is_enabled);
        }
    }

    pub(crate) fn jump(&mut self, request: &Request) -> Answer {
        self.refuse_moving()?;
        let asked: Goto = request.given()?;
        let moment = self.targets.get(asked.target_id).copied();
        let moment = moment.ok_or("ask for `gotoTargets` first: there is no such target")?;
        self.session.go_to(moment).map_err(|why| why.to_string())?;
        Ok(Value::Null)
    }
}
