//! Jumping by what is typed: to a moment, which is then shown, and commands nothing.

use crate::console::{Done, Result, Typed};
use crate::debuggee::Debuggee;
use crate::words;
use obverse_bytecode::text::nearest;
use obverse_debugger::{Change, Declined, Moment};
use obverse_isa::CheckpointId;

impl Debuggee<'_, '_, '_> {
    /// What is shown, and where that is.
    pub(crate) fn here(&self) -> String {
        let pc = self.session.machine().state().pc();
        let line = words::line(self.session.module(), pc);
        format!("{}: {line}", words::mode(&self.session))
    }

    pub(crate) fn moved(&self) -> Done {
        Done::Moved(self.here())
    }

    fn jump_to_last_error(&mut self) -> Result {
        let gone = self.session.go_to_last_error();
        gone.map_err(|_| "no error was raised before this moment".to_owned())?;
        Ok(self.moved())
    }

    fn jump_to_checkpoint(&mut self, name: &str) -> Result {
        let checkpoints = &self.session.module().checkpoints;
        let Some(index) = checkpoints.iter().position(|known| known == name) else {
            let marks = self.session.bookmarks().keys();
            let known = marks.chain(checkpoints).map(String::as_str);
            let meant = nearest(name, known.chain(["start", "end", "error"]));
            let hint = meant.map(|meant| format!("; `{meant}`?")).unwrap_or_default();
            return Err(format!("`{name}` is no moment, bookmark or checkpoint{hint}"));
        };
        let gone = self.session.go_to_checkpoint(CheckpointId(index as u16));
        let none = || format!("checkpoint {name} was not passed before this moment");
        gone.map_err(|why| why.words_or(none))?;
        Ok(self.moved())
    }
}

pub(crate) fn goto(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    let session = &mut it.session;
    let gone = match typed.rest {
        "" => return Err("say where to: a moment, start, end, error, or a name".to_owned()),
        "error" => return it.jump_to_last_error(),
        "end" => {
            session.go_to_end();
            Ok(())
        }
        "start" => session.go_to(Moment(0)),
        number if number.starts_with(|c: char| c.is_ascii_digit() || c == '-') => {
            let moment = number.parse().map_err(|_| format!("`{number}` is no moment"))?;
            session.go_to(Moment(moment))
        }
        name if session.bookmarks().contains_key(name) => session.go_to_bookmark(name),
        name => return it.jump_to_checkpoint(name),
    };
    gone.map_err(|why| why.to_string())?;
    Ok(it.moved())
}

pub(crate) fn last(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    let rest = typed.rest;
    if rest == "error" {
        return it.jump_to_last_error();
    }
    let expression = it.expression(typed, rest)?;
    let change = loop {
        match it.session.go_to_last_change(&expression) {
            // For whatever the client said meanwhile; and looked for again.
            Err(Declined::Interrupted) if it.goes_on_meanwhile() => {}
            change => break change,
        }
    };
    let none = || format!("{rest} did not change before this moment");
    let changed = change.map_err(|why| why.words_or(none))?;
    let Change { before, after, .. } = changed;
    let here = it.here();
    Ok(Done::Moved(format!("{here}: {rest} was {before} until here, and became {after}")))
}

pub(crate) fn undo(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    it.session.undo_jump().map_err(|why| why.to_string())?;
    Ok(it.moved())
}

pub(crate) fn bookmark(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    let name = typed.rest;
    if name.is_empty() {
        let marks = it.session.bookmarks().iter();
        let lines: Vec<String> = marks.map(|(name, at)| format!("{at:>8} {name}")).collect();
        let none = "there are no bookmarks".to_owned();
        return Ok(Done::Told(if lines.is_empty() { none } else { lines.join("\n") }));
    }
    let is_name = name.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c));
    if !is_name || name.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
        return Err(format!("`{name}` is no name: letters, digits, `_`, `-`, a letter first"));
    }
    if ["start", "end", "error"].contains(&name) {
        return Err(format!("`goto {name}` means something else already"));
    }
    it.session.bookmark(name);
    Ok(Done::Told(format!("{name} is moment {}", it.session.moment())))
}
