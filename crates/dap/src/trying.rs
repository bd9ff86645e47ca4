//! Trying by what is typed what would have been: a what-if, and what is other in it.

use crate::console::{Done, Result, Typed};
use crate::debuggee::Debuggee;
use obverse_debugger::{Mode, Subject};

pub(crate) fn what_if(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    it.refuse_moving()?;
    it.session.what_if().map_err(|why| why.to_string())?;
    Ok(it.moved())
}

pub(crate) fn leave(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    it.session.leave_what_if().map_err(|why| why.to_string())?;
    Ok(it.moved())
}

/// What is told of a change, where a what-if that begins with it shows another moment.
fn changed(was: Mode, told: String) -> Done {
    if was == Mode::WhatIf { Done::Told(told) } else { Done::Moved(told) }
}

pub(crate) fn set(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    let asked = typed.rest.split_once('=').ok_or("write `set NAME = VALUE`, as in `set x = 3`")?;
    let (name, value) = (asked.0.trim(), asked.1);
    let named = it.expression(typed, name)?;
    let subject = match named.subjects()[..] {
        [subject] if subject.name(it.session.module()) == name => subject.clone(),
        _ => return Err(format!("`{name}` is nothing that can be given a value")),
    };
    let was = it.session.mode();
    let value = it.assign(&subject, typed.function, value)?;
    Ok(changed(was, format!("{name} is {value}")))
}

pub(crate) fn input(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    let (name, level) = typed.rest.rsplit_once(' ').unwrap_or((typed.rest, ""));
    let (level, words) = match level {
        "high" => (Some(true), "high from here on"),
        "low" => (Some(false), "low from here on"),
        "real" => (None, "as it is"),
        _ => return Err("say `input NAME high`, `low`, or `real` for what it is".to_owned()),
    };
    let asked = it.expression(typed, &format!("input {}", name.trim()))?;
    let [Subject::Input(bit)] = asked.subjects()[..] else {
        return Err(format!("`{name}` is no input"));
    };
    let (bit, count) = (*bit, it.session.recording().facts.inputs);
    if bit >= count {
        return Err(format!("the workcell has {count} inputs, numbered from 0"));
    }
    let was = it.session.mode();
    it.in_what_if(|session| session.force_input(bit, level))?;
    Ok(changed(was, format!("input {bit} reads {words}")))
}

pub(crate) fn seed(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    let wrong = || format!("`{}` is no seed: say a whole number", typed.rest);
    let seed: u64 = typed.rest.parse().map_err(|_| wrong())?;
    let was = it.session.mode();
    it.in_what_if(|session| session.change_workcell(|cell| cell.reseed(seed)))?;
    Ok(changed(was, format!("chance and noise follow from seed {seed} from here on")))
}
